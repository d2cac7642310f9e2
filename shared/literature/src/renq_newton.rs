//! Quadratic renormalisation, corrected by Newton's iteration: q = m (3 - D m²)/2 with m from [`crate::renq`] and D = |N|².
//!
//! A step squares m's relative error, delta <= 0.02 e⁴, e² = 3 (1 - min |N|²), to 1.5 delta². Two steps are taken, so that no error shows at any
//! exponent. The method needs no root, no division, and no table but the highlight's.
//!
//! Cost: 6 additions a pixel, 8 products and the highlight's table; 2 additions and 2 products more per light. Continuous.
//! Error against Phong under constant light: 0.1 LSB and the table's. Domain: any lights. Where |N| falls below 1/2, under near lights, and for a
//! local viewer, the method draws as [`microphong::method::cosines::phong`].

use crate::{duff::draw_products, renq};
use microphong::{
    math::upper,
    method::{
        Canvas, CosineLookup, Facts, Highlight, HighlightField, LightingModel, Method, Reflection, Shading, TriangleSetup, VertexLight,
        cosines::{duff, phong::Phong},
        signed,
    },
};

static FACTS: Facts = Facts {
    name: "renq-newton",
    id: 25,
    source: "microphong 2026",
    vertex_light: VertexLight::Cosines,
    highlight: Highlight::Half,
    highlight_levels: true,
    highlight_field: HighlightField::Quadratic,
    near_lights: true,
    perspective: true,
};

/// Quadratic renormalisation, corrected by Newton's iteration.
pub struct RenqNewton;

impl Method for RenqNewton {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        if !shading.lighting.is_constant() || setup.is_curved() {
            return Phong.shade(setup, shading, canvas);
        }
        let lengths = (renq::length(setup, shading.exponent), duff::square(setup, shading.exponent));
        draw_products(setup, shading, lengths, Newton, canvas)
    }
}

/// One step from h towards 1/(2 sqrt(D)): h (3 - 4 D h²)/2, Q2.30.
#[inline(always)]
fn newton(h: i32, square: i32) -> i32 {
    // Upper halves of products: h² in Q4.28, D h² in Q6.26. 3 - 4 D h² is about 2: Q3.29.
    let product = upper(upper(h, h), square);
    upper(h, ((3 << 26) - (product << 2)) << 3) << 2
}

/// Two Newton steps. One is often enough, but the second costs little beside all else at a pixel, and triangles need not be told apart.
#[derive(Clone, Copy)]
struct Newton;

impl LightingModel<([u32; 1], [u32; 1]), [u32; 2]> for Newton {
    /// 1/(2|N|), Q2.30.
    type Common = i32;

    #[inline(always)]
    fn common(&self, ([length], [square]): ([u32; 1], [u32; 1])) -> i32 {
        let square = signed(square);
        newton(newton(signed(length), square), square)
    }

    #[inline(always)]
    fn reflect(&self, light: usize, length: &i32, fields: [u32; 2], lut: CosineLookup<'_>) -> Reflection {
        renq::Scaled.reflect(light, length, fields, lut)
    }
}
