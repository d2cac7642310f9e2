//! Lengths of the normals at the corners of a triangle, for loops that divide by the length of the interpolated normal.
//!
//! On the screen the normals N are interpolated with their unit lengths. In perspective, the normal at a point with weights b of the corners is the sum
//! of b w N over the sum of b w, where w are the inverse depths. The light depends on its direction alone. So if the normals w N are interpolated
//! linearly on the screen, the light is that of interpolation in perspective, and no pixel takes an instruction more. w is divided by the largest of
//! the three, so that lengths are at most 1.
//!
//! Cost: three products for each cosine that is fitted, and two divisions for the triangle. Error: cosines and squares are rounded to 2^-24, and the
//! scaled lengths to 2^-28, which moves a point by less than 2^-27 of the triangle.

use crate::{
    arch::product::{product, unsigned_product},
    features::PERSPECTIVE,
    format::{COSINE, HAVERSINE, NORMAL_LENGTH, UNIT},
    interpolate::{
        field::{Field, Nodes},
        quadric::Quadric,
    },
    math::{
        recip::recip,
        rsqrt::LEAST,
        vector::{add, narrow_dot, wide},
    },
    method::{
        TriangleSetup,
        node::map_six,
        products::{FIELD_BITS, FIELD_NODE, fitted},
    },
};

/// One, Q2.30.
const ONE: i32 = 1 << COSINE;
/// Bits of the haversine of an edge whose normals are at most 90 degrees apart. They are so few that triangles are set up in words, see
/// [`crate::setup::word_sized`].
const HAVERSINE_BITS: u32 = HAVERSINE - 1;

/// The largest exponent of a highlight that loops draw: [`crate::math::rsqrt::HALF_ERROR`] makes an error of 0.1 of 1/255 there.
pub(super) const STEEPEST: u16 = 256;

/// The lengths of normals over a triangle.
#[derive(Clone, Copy)]
pub(super) struct Lengths {
    /// The lengths that the normals at the corners have, Q2.30; `None` if all are 1.
    scaled: Option<[i32; 3]>,
    /// Whether a steep highlight shows that the components of normals are rounded.
    is_steep: bool,
}

/// Whether interpolated normals stay in the table of roots, if no edge bends by more than 90 degrees: no normal is shorter than 1/2.
pub(super) fn is_flat(setup: &TriangleSetup<'_>) -> bool {
    let [ab, bc, ca] = setup.edges(setup.triangle.haversine);
    setup.triangle.min_normal_length >= 1 << (NORMAL_LENGTH - 1) && ab.max(bc).max(ca) < 1 << HAVERSINE_BITS
}

/// The field |N|² minus [`LEAST`], Q0.32, of normals of unit length at the corners.
#[inline]
pub(super) fn unit_square(setup: &TriangleSetup<'_>) -> Nodes<6, 1, HAVERSINE_BITS> {
    let [ab, bc, ca] = setup.edges(setup.triangle.haversine);
    let nodes = [0, 0, 0, -i32::from(ab), -i32::from(bc), -i32::from(ca)];
    Nodes::new([nodes], 32 - HAVERSINE).biased([0u32.wrapping_sub(LEAST) as i32])
}

/// Six nodes of |N|² - 1, with [`FIELD_NODE`] fraction bits, where normals are of unit length at the corners. For steep highlights they are exact.
#[inline]
pub(super) fn squares(setup: &TriangleSetup<'_>, is_steep: bool) -> [i32; 6] {
    if is_steep {
        return exact_squares(setup);
    }
    // Zero at the corners.
    let [ab, bc, ca] = setup.edges(setup.triangle.haversine).map(|haversine| -(i32::from(haversine) << (FIELD_NODE - HAVERSINE)));
    [0, 0, 0, ab, bc, ca]
}

/// [`squares`] by the normals themselves, which are of unit length but for the rounding of their components.
#[cold]
#[inline(never)]
fn exact_squares(setup: &TriangleSetup<'_>) -> [i32; 6] {
    let [a, b, c] = setup.vertices().map(|vertex| wide(vertex.normal));
    let square = |v: [i32; 3]| narrow_dot(v, v);
    // Products of normals have 28 fraction bits. Half-way between two, the normal is half their sum, and its square a quarter.
    let node = |square: i32, bits: u32| (square.wrapping_sub(1 << bits).wrapping_add(1 << (bits - FIELD_NODE - 1))) >> (bits - FIELD_NODE);
    let corner = |v: [i32; 3]| node(square(v), 2 * UNIT);
    let middle = |a: [i32; 3], b: [i32; 3]| node(square(add(a, b)), 2 * UNIT + 2);
    [corner(a), corner(b), corner(c), middle(a, b), middle(b, c), middle(c, a)]
}

impl Lengths {
    /// The lengths for this triangle. `None` if an interpolated normal may leave the table of roots.
    #[inline]
    pub(super) fn of(setup: &TriangleSetup<'_>, is_steep: bool) -> Option<Self> {
        if !is_flat(setup) {
            return None;
        }
        if PERSPECTIVE
            && setup.place.is_none()
            && let Some(inv_depth) = setup.inv_depth()
        {
            let lengths = over_largest(inv_depth);
            let [a, b, c] = lengths;
            let least = product(a.min(b).min(c), i32::from(setup.triangle.min_normal_length)) >> NORMAL_LENGTH;
            return (least >= i64::from(ONE / 2)).then_some(Self { scaled: Some(lengths), is_steep });
        }
        Some(Self { scaled: None, is_steep })
    }

    /// The cosines of a direction with the normals at the corners, Q2.30, as they are interpolated.
    #[inline]
    pub(super) fn apply(&self, cosines: &[i32; 3]) -> [i32; 3] {
        match self.scaled {
            Some(lengths) if PERSPECTIVE => scaled(lengths, *cosines),
            _ => *cosines,
        }
    }

    /// The field |N|² minus [`LEAST`], Q0.32.
    #[inline(always)]
    pub(super) fn square(&self, setup: &TriangleSetup<'_>) -> Quadric<1> {
        match self.scaled {
            Some(lengths) if PERSPECTIVE => scaled_square(setup, lengths, self.is_steep),
            _ if self.is_steep => exact_square(setup),
            _ => unit_square(setup).fit(setup.gradients),
        }
    }

    /// [`Self::square`] in a function of its own.
    #[inline(never)]
    pub(super) fn square_apart(&self, setup: &TriangleSetup<'_>) -> Quadric<1> {
        self.square(setup)
    }
}

/// The field of exact squares.
#[inline(never)]
fn exact_square(setup: &TriangleSetup<'_>) -> Quadric<1> {
    let nodes = map_six(exact_squares(setup), |square| square.wrapping_add((1 << FIELD_NODE) - (LEAST >> (32 - FIELD_NODE)) as i32));
    fit(setup, nodes)
}

/// The field of these nodes, with [`FIELD_NODE`] fraction bits.
fn fit(setup: &TriangleSetup<'_>, nodes: [i32; 6]) -> Quadric<1> {
    fitted(&Nodes::<6, 1, { FIELD_BITS - 2 }>::new([nodes], 32 - FIELD_NODE), setup.gradients)
}

/// Inverse depths divided by the largest of them, Q2.30.
#[inline(never)]
fn over_largest([a, b, c]: [i32; 3]) -> [i32; 3] {
    let largest = a.max(b).max(c).max(1) as u32;
    let zeros = largest.leading_zeros();
    let inverse = recip(largest << zeros);
    [a, b, c].map(|w| (unsigned_product((w.max(0) as u32) << zeros, inverse) >> 32) as i32)
}

#[inline(never)]
fn scaled(lengths: [i32; 3], cosines: [i32; 3]) -> [i32; 3] {
    let ([a, b, c], [l, m, n]) = (cosines, lengths);
    [by(a, l), by(b, m), by(c, n)]
}

/// A product of two numbers in Q2.30.
fn by(a: i32, b: i32) -> i32 {
    (product(a, b) >> COSINE) as i32
}

#[inline(never)]
fn scaled_square(setup: &TriangleSetup<'_>, [l, m, n]: [i32; 3], is_steep: bool) -> Quadric<1> {
    let [a, b, c, ab, bc, ca] = map_six(squares(setup, is_steep), |square| square << (COSINE - FIELD_NODE));
    // |l M|² = l² + l² (M² - 1). Half-way the square is |(l M + m N) / 2|², and twice M·N is 4 |(M + N) / 2|² - M² - N².
    let middle = |l: i32, m: i32, a: i32, b: i32, ab: i32| {
        let half = (l >> 1) + (m >> 1);
        by(half, half) - by(by(l, m), ((a + b) >> 2) - ab)
    };
    let mut squares = [by(l, l), by(m, m), by(n, n), middle(l, m, a, b, ab), middle(m, n, b, c, bc), middle(n, l, c, a, ca)];
    if is_steep {
        let [x, y, z, xy, yz, zx] = squares;
        let (a, b, c) = (by(x, a), by(y, b), by(z, c));
        squares = [x + a, y + b, z + c, xy + ((a + b) >> 2), yz + ((b + c) >> 2), zx + ((c + a) >> 2)];
    }
    // Rounded to the bits of a node. The sum wraps where a square is 1, and is a word again without the least.
    let node = |square: i32| (((square as u32) << 2).wrapping_sub(LEAST).wrapping_add(1 << (31 - FIELD_NODE)) >> (32 - FIELD_NODE)) as i32;
    fit(setup, map_six(squares, node))
}
