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
use microphong::method::{
    Canvas, Facts, Highlight, HighlightField, Method, Shading, TriangleSetup, VertexLight,
    cosines::{
        duff::is_curved,
        renq::{Scaled, length},
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
        if is_curved(setup) {
            return shade(setup, shading, canvas);
        }
        draw_products(setup, shading, length(setup, shading.exponent), Scaled, canvas)
    }
}
