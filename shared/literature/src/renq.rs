//! Quadratic renormalisation: linear N·L and N·H times the six-point quadratic of 1/|N|.
//!
//! 1/|N| is 1 at the corners and 2/|Ni+Nj| at the edges' midpoints whatever the pose, so its nodes are constants of the
//! mesh and no midpoint is lit. With near lights the numerators are quadratics through six points.
//!
//! Cost: 4 additions a pixel, 2 products and the highlight's table; 2 or 4 additions and 2 products more per light.
//! Continuous. Error against Phong: 255 ks n w^n 0.0125 (e/r)^4, w the largest N·H/|N|, e the longest |Ni-Nj|, r
//! the least |N|: 3 LSB at worst on a sphere of 168 triangles, 0.3 on one of 690 (exponent 50, ks 1/2).
//! Domain: any lights; where |N| falls below 1/2, [`microphong::method::cosines::duff`]'s root takes over.

use crate::duff::{draw_products, shade};
use microphong::{
    format::{INVERSE_SUM_LENGTH, UNIT},
    math::{
        rsqrt::rsqrt_wide,
        upper,
        vector::{add, dot, wide},
    },
    method::{
        Canvas, CosineLookup, Facts, Highlight, HighlightField, LightingModel, Method, QuadraticNodes, Reflection, Shading, TriangleSetup,
        VertexLight,
        node::is_steep,
        products::{FIELD_EXTRA, FIELD_NODE},
        signed,
    },
};

static FACTS: Facts = Facts {
    name: "renq",
    id: 24,
    source: "microphong 2026",
    vertex_light: VertexLight::Cosines,
    highlight: Highlight::Half,
    highlight_levels: true,
    highlight_field: HighlightField::Quadratic,
    near_lights: true,
    perspective: true,
};

/// Quadratic renormalisation.
pub struct Renq;

impl Method for Renq {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        if setup.is_curved() {
            return shade(setup, shading, canvas);
        }
        draw_products(setup, shading, length(setup, shading.exponent), Scaled, canvas)
    }
}

/// Half the quadratic through 1/|N| at six nodes, Q2.30.
#[inline(always)]
pub fn length(setup: &TriangleSetup<'_>, exponent: u16) -> QuadraticNodes<1> {
    // 1/|Ni+Nj| - 1/2, zero at the corners. It is at most 1/2 where the normal is as long as methods want it here; the record of a damaged
    // stream may say so of one that is shorter.
    let node = |inverse: u32| {
        (inverse.min(1 << INVERSE_SUM_LENGTH).wrapping_sub(1 << (INVERSE_SUM_LENGTH - 1)) << (FIELD_NODE - INVERSE_SUM_LENGTH)) as i32
    };
    let [ab, bc, ca] = if is_steep(exponent) {
        fine_inverse_sum_lengths(setup).map(|inverse| inverse as i32 - (1 << (FIELD_NODE - 1)))
    } else {
        let [ab, bc, ca] = setup.inverse_sum_lengths();
        [node(ab), node(bc), node(ca)]
    };
    QuadraticNodes::new([[0, 0, 0, ab, bc, ca]], FIELD_EXTRA).biased([1 << 29])
}

/// For each edge 0-1, 1-2, 2-0 the reciprocal length of the sum of the unit normals at its ends, with 24 fraction bits and at most 1. It is more exact
/// than [`TriangleSetup::inverse_sum_lengths`], and takes longer.
#[cold]
#[inline(never)]
fn fine_inverse_sum_lengths(setup: &TriangleSetup<'_>) -> [u32; 3] {
    let [a, b, c] = setup.vertices().map(|vertex| wide(vertex.normal));
    [add(a, b), add(b, c), add(c, a)].map(|sum| {
        let (mantissa, exponent) = rsqrt_wide(dot(sum, sum).max(1) as u64);
        mantissa.checked_shr(exponent.saturating_sub(UNIT + 24)).unwrap_or(0).min(1 << 24)
    })
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
        // Upper halves of Q2.30 times Q2.30 are cosines in Q5.27.
        Reflection { diffuse: upper(signed(light), length), highlight: lut.at(upper(signed(half), length)) }
    }
}
