//! Quadratics and cubics on very thin triangles, by exact fractions.
//!
//! Across a sliver a polynomial bends so sharply that its derivatives on the screen cancel one another; any that are
//! rounded before they meet lose the value. Here nothing is rounded before the last division. Slow, and rare.

use crate::{math::wide::Wide, setup::terms::Terms};

/// A triangle from its first corner: the two edges that leave it, and where values are wanted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sliver {
    /// Fraction bits of all coordinates.
    pub(crate) bits: u32,
    /// `[x, y]` of corner 1 and of corner 2, from corner 0.
    pub(crate) edges: [[i32; 2]; 2],
    /// From corner 0 to the anchor.
    pub(crate) offset: [i32; 2],
}

impl Sliver {
    /// `[c, dx, dy, dxx, dxy, dyy]` of the quadratic through six nodes at the anchor, with `extra` more bits than the nodes.
    ///
    /// Every coefficient is the exact one rounded, modulo 2^64.
    #[cold]
    #[inline(never)]
    pub(crate) fn quadratic(&self, nodes: [i32; 6], extra: u32) -> [i64; 6] {
        let [i0, i1, i2, i01, i12, i20] = nodes.map(Wide::from);
        let (c1, c2) = (4 * i01 - 3 * i0 - i1, 4 * i20 - 3 * i0 - i2);
        let (ss, st, tt) = (2 * (i0 + i1 - 2 * i01), 4 * (i0 - i01 - i20 + i12), 2 * (i0 + i2 - 2 * i20));
        let [[x1, y1], [x2, y2]] = self.edges.map(|edge| edge.map(Wide::from));
        let [ox, oy] = self.offset.map(Wide::from);
        let det = x1 * y2 - x2 * y1;
        // The anchor's barycentric coordinates and their gradients per unit, all times det.
        let (s, t) = (y2 * ox - x2 * oy, x1 * oy - y1 * ox);
        let (sx, sy, tx, ty) = (y2, -x2, -y1, x1);
        // At most 2^29 · 2^56 · 2^28 · 2^13: within 128 bits. The divisor is not 0: the triangle has an area.
        let divisor = det * det;
        let half = Wide(divisor.0 >> 1);
        let over = |numerator: Wide, order: u32| (numerator.shifted(extra + order * self.bits) + half).divided(divisor).0.0 as i64;
        let along = |ds: Wide, dt: Wide| (c1 * ds + c2 * dt) * det + 2 * ss * s * ds + st * (s * dt + t * ds) + 2 * tt * t * dt;
        [
            over(i0 * det * det + (c1 * s + c2 * t) * det + ss * s * s + st * s * t + tt * t * t, 0),
            over(along(sx, tx), 1),
            over(along(sy, ty), 1),
            over(ss * sx * sx + st * sx * tx + tt * tx * tx, 2),
            over(2 * ss * sx * sy + st * (sx * ty + sy * tx) + 2 * tt * tx * ty, 2),
            over(ss * sy * sy + st * sy * ty + tt * ty * ty, 2),
        ]
    }

    /// The terms of the cubic through ten nodes at the anchor, with `extra` more bits than the nodes.
    ///
    /// Every coefficient is the exact one, rounded down, modulo 2^128.
    #[cold]
    #[inline(never)]
    pub(crate) fn cubic(&self, nodes: [i32; 10], extra: u32) -> Terms<Wide> {
        let [[x1, y1], [x2, y2]] = self.edges.map(|edge| edge.map(Wide::from));
        let [ox, oy] = self.offset.map(Wide::from);
        let det = x1 * y2 - x2 * y1;
        // det is below 2^28, as slivers have less than 1/128 of their square; all together below 2^105.
        let common = Terms::of(nodes.map(Wide::from), [y2, -x2], [-y1, x1]).map(|c, degree| (degree..3).fold(c, |c, _| c * det));
        let divisor = 4 * det * det * det;
        let over = |numerator: Wide, bits: u32| {
            // Long division, 35 bits at a time.
            let (whole, rest) = numerator.divided(divisor);
            let (upper, rest) = rest.shifted(bits / 2).divided(divisor);
            let (lower, _) = rest.shifted(bits - bits / 2).divided(divisor);
            whole.shifted(bits) + upper.shifted(bits - bits / 2) + lower
        };
        let at_anchor = common.moved_across(|a, b| a + b * ox).moved_down(|a, b| a + b * oy);
        at_anchor.map(|c, degree| over(c, extra + degree * self.bits))
    }
}
