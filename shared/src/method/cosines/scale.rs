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
    format::{COSINE, HAVERSINE, NORMAL_LENGTH},
    interpolate::{
        field::{Field, Nodes},
        quadric::Quadric,
    },
    math::{recip::recip, rsqrt::LEAST},
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

/// The squared lengths of normals of unit length at six nodes.
pub(super) type UnitSquare = Nodes<6, 1, HAVERSINE_BITS>;

/// The lengths that the normals at the corners have, Q2.30; `None` if all are 1.
#[derive(Clone, Copy)]
pub(super) struct Lengths(Option<[i32; 3]>);

/// Whether interpolated normals stay in the table of roots, if no edge bends by more than 90 degrees: no normal is shorter than 1/2.
pub(super) fn is_flat(setup: &TriangleSetup<'_>) -> bool {
    let [ab, bc, ca] = setup.edges(setup.triangle.haversine);
    setup.triangle.min_normal_length >= 1 << (NORMAL_LENGTH - 1) && ab.max(bc).max(ca) < 1 << HAVERSINE_BITS
}

/// The field |N|² minus [`LEAST`], Q0.32, of normals of unit length at the corners.
#[inline(always)]
pub(super) fn unit_square(setup: &TriangleSetup<'_>) -> UnitSquare {
    let [ab, bc, ca] = setup.edges(setup.triangle.haversine);
    let nodes = [0, 0, 0, -i32::from(ab), -i32::from(bc), -i32::from(ca)];
    Nodes::new([nodes], 32 - HAVERSINE).biased([0u32.wrapping_sub(LEAST) as i32])
}

impl Lengths {
    /// The lengths for this triangle. `None` if an interpolated normal may leave the table of roots.
    #[inline(always)]
    pub(super) fn of(setup: &TriangleSetup<'_>) -> Option<Self> {
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
            return (least >= i64::from(ONE / 2)).then_some(Self(Some(lengths)));
        }
        Some(Self(None))
    }

    /// The cosines of a direction with the normals at the corners, Q2.30, as they are interpolated.
    #[inline(always)]
    pub(super) fn apply(&self, cosines: &[i32; 3]) -> [i32; 3] {
        match self.0 {
            Some(lengths) if PERSPECTIVE => scaled(lengths, *cosines),
            _ => *cosines,
        }
    }

    /// The field |N|² minus [`LEAST`], Q0.32.
    #[inline(always)]
    pub(super) fn square(&self, setup: &TriangleSetup<'_>) -> Quadric<1> {
        match self.0 {
            Some(lengths) if PERSPECTIVE => scaled_square(setup, lengths),
            _ => unit_square(setup).fit(setup.gradients),
        }
    }
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
fn scaled_square(setup: &TriangleSetup<'_>, [a, b, c]: [i32; 3]) -> Quadric<1> {
    let [ab, bc, ca] = setup.edges(setup.triangle.haversine);
    // |(l M + m N) / 2|² = ((l + m) / 2)² - l m h, where 1 - h is the square of half of M + N.
    let middle = |l: i32, m: i32, haversine: u16| {
        let half = (l >> 1) + (m >> 1);
        by(half, half) - (product(by(l, m), haversine.into()) >> HAVERSINE) as i32
    };
    let squares = [by(a, a), by(b, b), by(c, c), middle(a, b, ab), middle(b, c, bc), middle(c, a, ca)];
    // Rounded to the bits of a node. The sum wraps where a square is 1, and is a word again without the least.
    let node = |square: i32| (((square as u32) << 2).wrapping_sub(LEAST).wrapping_add(1 << (31 - FIELD_NODE)) >> (32 - FIELD_NODE)) as i32;
    fitted(&Nodes::<6, 1, { FIELD_BITS - 2 }>::new([map_six(squares, node)], 32 - FIELD_NODE), setup.gradients)
}
