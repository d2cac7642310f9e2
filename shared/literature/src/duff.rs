//! Duff's form (Duff 1979; see Bishop & Weimer 1986): linear N·L and N·H over the root of a quadratic.
//!
//! Under a constant light N·L and N·H are exactly linear and |N|² exactly quadratic over a triangle, so only
//! the reciprocal root is approximated, by a table of 1,537 knots. Near lights and viewers have numerators that
//! are not linear: there they are the quadratics through six points.
//!
//! Cost: 4 additions a pixel, a root from a table, 2 products and the highlight's table; 2 or 4 additions and 2 products more per light. Error: the
//! tables' error, mainly [`microphong::math::highlight_lut::NEAREST_ERROR`] of the highlight. Domain: any lights; under near lights as exact as six
//! points are.

use crate::nodes::six_linear_nodes;
use microphong::method::{
    Canvas, Facts, Field, Highlight, HighlightField, LightingModel, Method, Shading, TriangleSetup, VertexLight,
    cosines::duff::{Rooted, draw_constant, shade_constant, square},
};

static FACTS: Facts = Facts {
    name: "duff",
    id: 10,
    source: "Duff 1979",
    vertex_light: VertexLight::Cosines,
    highlight: Highlight::Half,
    highlight_levels: true,
    highlight_field: HighlightField::Quadratic,
    near_lights: true,
    perspective: true,
};

/// Duff's form of Phong shading.
pub struct Duff;

impl Method for Duff {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        shade(setup, shading, canvas)
    }
}

/// Shades by linear numerators over a root, or by quadratic numerators under near lights.
pub fn shade(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    if shading.lighting.is_constant() {
        return shade_constant(setup, shading, canvas);
    }
    draw_products(setup, shading, square(setup, shading.exponent), Rooted, canvas)
}

/// Shades by `model`. `common` and N·L and N·H of each light are interpolated; normals are not normalised. N·L and N·H are linear under constant
/// lights, otherwise quadratics through six points.
pub fn draw_products<K: Field, F>(setup: &TriangleSetup<'_>, shading: &Shading<'_>, common: K, model: F, canvas: &mut dyn Canvas) -> u32
where
    F: LightingModel<K::Value, [u32; 2]>,
{
    if shading.lighting.is_constant() {
        return draw_constant(setup, shading, common, model, canvas);
    }
    let nodes = six_linear_nodes(setup);
    shading.draw_lit(setup, |source| shading.six_products(&nodes, source, |p| p), common, model, canvas)
}
