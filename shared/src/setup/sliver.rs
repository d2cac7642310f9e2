//! Exact fits of polynomials on thin triangles, by fractions.
//!
//! Across a sliver a polynomial bends so sharply that its derivatives on the screen cancel one another, and rounding them separately would lose the
//! value. Here nothing is rounded before the last division. This is slow, but rarely needed.

use crate::math::wide::Wide;
use core::num::NonZeroU32;

/// A triangle, given by the two edges from its first corner, and the anchor relative to this corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sliver {
    /// Fraction bits of all coordinates.
    bits: u32,
    /// Vectors `[x, y]` from corner 0 to corner 1 and to corner 2.
    edges: [[i32; 2]; 2],
    /// Vector from corner 0 to the anchor.
    offset: [i32; 2],
    /// Twice the area.
    area: NonZeroU32,
}

impl Sliver {
    /// The triangle with these edges and the anchor at `offset`, all with `bits` fraction bits. `None` if twice its area does not fit a word; such a
    /// triangle is thousands of pixels long, and not thin.
    pub(crate) fn new(edges: [[i32; 2]; 2], offset: [i32; 2], bits: u32) -> Option<Self> {
        let [[x1, y1], [x2, y2]] = edges.map(|edge| edge.map(i64::from));
        let area = u32::try_from(x1 * y2 - x2 * y1).ok().and_then(NonZeroU32::new)?;
        Some(Self { bits, edges, offset, area })
    }

    /// `[c, dx, dy, dxx, dxy, dyy]` of the quadratic through six nodes at the anchor, with `extra` more bits than the nodes.
    ///
    /// Every coefficient is exact before it is rounded, modulo 2^64.
    #[cold]
    #[inline(never)]
    pub(crate) fn quadratic(&self, nodes: [i32; 6], extra: u32) -> [i64; 6] {
        let [i0, i1, i2, i01, i12, i20] = nodes.map(Wide::from);
        let (c1, c2) = (4 * i01 - 3 * i0 - i1, 4 * i20 - 3 * i0 - i2);
        let (ss, st, tt) = (2 * (i0 + i1 - 2 * i01), 4 * (i0 - i01 - i20 + i12), 2 * (i0 + i2 - 2 * i20));
        let [[x1, y1], [x2, y2]] = self.edges.map(|edge| edge.map(Wide::from));
        let [ox, oy] = self.offset.map(Wide::from);
        let det = Wide(i128::from(self.area.get()));
        // The quadratic in barycentric coordinates s and t as a symmetric form of (s, t, 1), times 2.
        let matrix = [[2 * ss, st, c1], [st, 2 * tt, c2], [c1, c2, 2 * i0]];
        // The anchor's coordinates and their gradients per unit, all times det; those of 1 are 0.
        let (at, x, y) = ([y2 * ox - x2 * oy, x1 * oy - y1 * ox, det], [y2, -y1], [-x2, x1]);
        let times = |v: &[Wide]| matrix.each_ref().map(|row| dot(row, v));
        let (m_at, m_x, m_y) = (times(&at), times(&x), times(&y));
        // Edges are below 2^17, and det is below 2^32. Nine terms of 2^28 and det², and 28 more bits: within 128 bits.
        let half = Wide((det * det).0 >> 1);
        let over = |numerator: i128, order: u32| {
            (Wide(numerator).shifted(extra + order * self.bits) + half).over(self.area).over(self.area).0 as i64
        };
        [
            over(dot(&m_at, &at).0 >> 1, 0),
            over(dot(&m_at, &x).0, 1),
            over(dot(&m_at, &y).0, 1),
            over(dot(&m_x, &x).0 >> 1, 2),
            over(dot(&m_x, &y).0, 2),
            over(dot(&m_y, &y).0 >> 1, 2),
        ]
    }
}

/// The dot product of two vectors. Missing components of the shorter one are 0.
#[inline(never)]
fn dot(a: &[Wide], b: &[Wide]) -> Wide {
    a.iter().zip(b).fold(Wide(0), |sum, (&a, &b)| sum + a * b)
}
