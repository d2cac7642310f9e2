//! Quadratic renormalisation: linear N·L and N·H, multiplied by the six-point quadratic of 1/|N|.
//!
//! 1/|N| is 1 at the corners and 2/|Ni+Nj| at the edges' midpoints in every pose. Its nodes are therefore constants of the mesh, and no midpoint is
//! lit. Under near lights the numerators are quadratics through six points.
//!
//! Cost: 4 additions a pixel, 2 products and the highlight's table; 2 or 4 additions and 2 products more per light.
//! Continuous. Error against Phong: 255 ks n w^n 0.0125 (e/r)^4, w the largest N·H/|N|, e the longest |Ni-Nj|, r
//! the least |N|: 3 LSB at worst on a sphere of 168 triangles, 0.3 on one of 690 (exponent 50, ks 1/2).
//! Domain: any lights; where |N| falls below 1/2, [`crate::method::cosines::duff`]'s root takes over.

use crate::{
    arch::product::upper,
    format::INVERSE_SUM_LENGTH,
    lighting::reflectance::Reflection,
    math::highlight_lut::CosineLookup,
    method::{
        TriangleSetup,
        lighting_model::{FIELD_EXTRA, FIELD_NODE, LightingModel, QuadraticNodes, signed},
        node::is_steep,
    },
};

/// Half the quadratic through 1/|N| at six nodes, Q2.30.
#[inline(always)]
pub fn length(setup: &TriangleSetup<'_>, exponent: u16) -> QuadraticNodes<1> {
    // 1/|Ni+Nj| - 1/2, zero at the corners. It is at most 1/2 where the normal is as long as methods want it here; the record of a damaged
    // stream may say so of one that is shorter.
    let node = |inverse: u32| {
        (inverse.min(1 << INVERSE_SUM_LENGTH).wrapping_sub(1 << (INVERSE_SUM_LENGTH - 1)) << (FIELD_NODE - INVERSE_SUM_LENGTH)) as i32
    };
    let [ab, bc, ca] = if is_steep(exponent) {
        setup.fine_inverse_sum_lengths().map(|inverse| inverse as i32 - (1 << (FIELD_NODE - 1)))
    } else {
        let [ab, bc, ca] = setup.inverse_sum_lengths();
        [node(ab), node(bc), node(ca)]
    };
    QuadraticNodes::new([[0, 0, 0, ab, bc, ca]], FIELD_EXTRA).biased([1 << 29])
}

/// Shades by numerators times a reciprocal length.
#[derive(Clone, Copy)]
pub struct Scaled;

impl LightingModel<[u32; 1], [u32; 2]> for Scaled {
    /// 1/(2|N|), Q2.30.
    type Common = i32;

    #[inline(always)]
    fn common(&self, [length]: [u32; 1]) -> i32 {
        signed(length)
    }

    #[inline(always)]
    fn reflect(&self, _: usize, &length: &i32, [light, half]: [u32; 2], lut: CosineLookup<'_>) -> Reflection {
        Reflection { diffuse: over(signed(light), length), highlight: lut.at(over(signed(half), length)) }
    }
}

/// A numerator times half a reciprocal length, Q2.30 each: the upper half is a cosine in Q5.27.
#[inline(always)]
fn over(cosine: i32, half: i32) -> i32 {
    upper(cosine, half)
}
