//! Products of the normal, of the way to what is near, and of the direction to the other of light and viewer.
//!
//! P is the vector from the surface to what is near, the light or the viewer. It is linear over a triangle, as the normal N is. F is the direction to
//! the other, which is the same everywhere. So N·F and F·P are linear, and N·P, |N|² and |P|² exactly quadratic. The half vector of light and viewer is
//! the same whichever of them is near. P is measured in units of its length at the farthest corner, so it is 1/2 to 1 long unless what is near is
//! close. Three squares then lie in the table of reciprocal roots, without counting of leading zeros: |P|², |N|², and a quarter of |F + P|², which is
//! 2 + 2 F·P where P has the length 1.

use crate::{
    arch::product::upper,
    format::{COSINE, UNIT},
    interpolate::{by_column::ByColumn, field::Nodes, plane::Plane, quadric::Quadric},
    lighting::{lights::point, reflectance::Reflectance},
    math::{
        rsqrt::{HalfRsqrt, LEAST, Root},
        vector::{dot, map, over_longest, sub, wide},
    },
    method::{
        TriangleSetup, largest,
        node::{FRACTION, coefficients, field_product, map_six},
        products::{FIELD_BITS, fitted, linear, quadratic},
    },
    stream::record::Vertex,
};

/// One, Q2.30.
const ONE: i32 = 1 << COSINE;

/// Fraction bits of N·H.
pub(super) const HALF: u32 = 25;

/// Products of N, F and P at the corners or at six nodes of a triangle, Q2.30; the longest P is 1.
pub(super) struct Products {
    /// N·P.
    np: [i32; 6],
    /// |P|², at least 1/4.
    pp: [i32; 6],
    /// F·P.
    fp: [i32; 3],
}

/// The quadratics |N|², |P|² and N·P, and the planes N·F and F·P: more than there are registers.
pub(super) type HighlightProducts = ByColumn<(Quadric<1>, ((Quadric<1>, Quadric<1>), (Plane<1>, Plane<1>)))>;
/// The quadratics |N|², |P|² and N·P.
pub(super) type DiffuseProducts = ByColumn<(Quadric<1>, (Quadric<1>, Quadric<1>))>;

impl Products {
    /// The products for what is near at `near`, Q7.25, and the other in the direction `fixed`, Q2.30. `None` if |P| leaves the table of reciprocal
    /// roots, where what is near is close.
    #[inline(never)]
    pub(super) fn new(setup: &TriangleSetup<'_>, near: [i32; 3], fixed: [i32; 3]) -> Option<Self> {
        let vertices = setup.vertices();
        let ways = ways(vertices, near);
        let pp = field_product(&ways, &ways);
        if least(coefficients(pp)) < ONE / 4 {
            return None;
        }
        let np = field_product(&map(vertices, |vertex| map(wide(vertex.normal), |c| c << (FRACTION - UNIT))), &ways);
        Some(Self { np, pp, fp: along(ways, fixed) })
    }

    /// Whether |F + P| lies in the table of reciprocal roots; it does not where what is near lies opposite of the other.
    pub(super) fn have_half(&self) -> bool {
        let [a, b, c] = self.fp;
        is_before(a.min(b).min(c))
    }

    /// The largest N·P may be this.
    pub(super) fn largest_np(&self) -> i32 {
        let [a, b, c, ab, bc, ca] = coefficients(self.np);
        a.max(b).max(c).max(ab).max(bc).max(ca)
    }

    /// The least |P|² may be this.
    pub(super) fn least_pp(&self) -> u32 {
        least(coefficients(self.pp)).max(0) as u32
    }

    /// The largest N·P over |P| may be this, Q5.27.
    pub(super) fn largest_cosine(&self) -> i32 {
        // The division by |P|, which is at most 1, makes a negative product less.
        let np = self.largest_np();
        if np < 0 { np >> 3 } else { upper(np, self.most_reciprocal()) }
    }

    /// A lower bound of products with P over |P|, Q5.27, where the products are at least `least`, Q2.30.
    pub(super) fn least_over(&self, least: i32) -> i32 {
        // A positive product grows by the division, which is left out.
        upper(least, self.most_reciprocal()).min(least >> 3)
    }

    /// Half the largest 1 over |P|, Q2.30.
    fn most_reciprocal(&self) -> i32 {
        HalfRsqrt::get().rsqrt(above_least(least(coefficients(self.pp)))) as i32
    }

    /// Whether a highlight may be visible on the triangle, from N·F at the corners.
    pub(super) fn may_have_highlight(&self, setup: &TriangleSetup<'_>, fixed: [i32; 3], reflectance: &Reflectance) -> bool {
        let [a, b, c] = self.fp;
        is_visible(setup, reflectance, [largest(&fixed), self.largest_cosine(), self.least_over(a.min(b).min(c))])
    }

    /// The polynomials of all products.
    #[inline(never)]
    pub(super) fn patch(&self, setup: &TriangleSetup<'_>, fixed: [i32; 3], length: Quadric<1>) -> HighlightProducts {
        ByColumn((length, (self.quadratics(setup), self.planes(setup, fixed))))
    }

    /// The polynomials without those that highlights alone need.
    #[inline(never)]
    pub(super) fn diffuse_patch(&self, setup: &TriangleSetup<'_>, length: Quadric<1>) -> DiffuseProducts {
        ByColumn((length, self.quadratics(setup)))
    }

    /// The polynomials of |P|² and N·P.
    #[inline(never)]
    pub(super) fn quadratics(&self, setup: &TriangleSetup<'_>) -> (Quadric<1>, Quadric<1>) {
        let pp = Nodes::<6, 1, { FIELD_BITS - 2 }>::new([map_six(self.pp, |square| (above_least(square) >> 8) as i32)], 8);
        (fitted(&pp, setup.gradients), fitted(&quadratic([self.np]), setup.gradients))
    }

    /// The polynomials of N·F, which is this at the corners, and of F·P.
    #[inline(never)]
    pub(super) fn planes(&self, setup: &TriangleSetup<'_>, fixed: [i32; 3]) -> (Plane<1>, Plane<1>) {
        (fitted(&linear([fixed]), setup.gradients), fitted(&linear([self.fp]), setup.gradients))
    }
}

/// The vectors from vertices to what is near at `near`, Q7.25, in units of the longest one, with [`FRACTION`] fraction bits.
#[inline(never)]
pub(super) fn ways(vertices: [&Vertex; 3], near: [i32; 3]) -> [[i32; 3]; 3] {
    let half = |v: [i32; 3]| map(v, |c| c >> 1);
    let near = half(near);
    over_longest::<FRACTION>(map(vertices, |vertex| sub(near, half(point(vertex.position)))))
}

/// The products of [`ways`] with a direction, Q2.30.
pub(super) fn along(ways: [[i32; 3]; 3], direction: [i32; 3]) -> [i32; 3] {
    map(ways, |way| (dot(direction, way) >> FRACTION) as i32)
}

/// Whether |F + P| lies in the table of reciprocal roots where F·P is at least `least`, Q2.30.
pub(super) fn is_before(least: i32) -> bool {
    least >= -ONE / 4
}

/// Whether a highlight may be visible where N·F is at most `nf`, Q2.30, and N·P at most `np` and F·P at least `fp`, Q5.27, where F and P have the
/// length 1.
#[inline(never)]
pub(super) fn is_visible(setup: &TriangleSetup<'_>, reflectance: &Reflectance, [nf, np, fp]: [i32; 3]) -> bool {
    let largest = if fp >= -ONE / 16 {
        half(HalfRsqrt::get(), nf, np, fp)
    } else {
        // Half the sum over half its length, with as many fraction bits.
        let quarter = ((1 << 29) + (fp << 2)).max(1) as u32;
        Root::of(quarter).divide((nf >> 1) + (np << 2)) >> (COSINE - HALF)
    };
    largest >= setup.highlight_threshold(reflectance) >> (COSINE - HALF)
}

/// The least of six values.
pub(super) fn least([a, b, c, ab, bc, ca]: [i32; 6]) -> i32 {
    a.min(b).min(c).min(ab).min(bc).min(ca)
}

/// |P|², Q2.30, as the table of reciprocal roots is indexed.
#[inline]
fn above_least(square: i32) -> u32 {
    ((square as u32) << 2).wrapping_sub(LEAST)
}

/// N·H, Q7.25, from N·F, Q2.30, and N·P and F·P, Q5.27, where P has the length 1 and N any.
#[inline]
pub(super) fn half(lengths: &HalfRsqrt, nf: i32, np: i32, fp: i32) -> i32 {
    // |F + P|² / 4 = (1 + F·P) / 2, of which half the reciprocal root is 1 / |F + P|.
    let quarter = (1u32 << 31).wrapping_add((fp as u32) << 4);
    upper((nf >> 3) + np, lengths.rsqrt(quarter.wrapping_sub(LEAST)) as i32)
}
