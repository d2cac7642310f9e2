//! N·L and N·H by their Taylor quadratics about the centroid, near lights and viewer included (Bishop & Weimer 1986,
//! finite eye).
//!
//! The directions L, and L + V for H, are linear between the corners. All else is as in [`crate::taylor`]. The centroid's |L| counts as at least
//! 1/16, and |L + V| as at least 1/8.
//!
//! Cost and error are those of [`crate::taylor`], plus the error of directions that are not linear: the method is useless on coarse meshes with near
//! lights. Domain: any lights.

use crate::{
    taylor,
    taylor::{Series, VECTOR},
};
use microphong::{
    format::COSINE,
    math::vector::add,
    method::{Canvas, Facts, Highlight, HighlightField, Method, Shading, Source, TriangleSetup, VertexLight, point},
};

static FACTS: Facts = Facts {
    name: "taylor-finite",
    id: 12,
    source: "Bishop & Weimer 1986",
    vertex_light: VertexLight::None,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Plane,
    near_lights: true,
    perspective: true,
};

/// Taylor quadratics for any lights.
pub struct TaylorFinite;

impl Method for TaylorFinite {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        taylor::draw_by(setup, shading, canvas, directions(setup, shading))
    }
}

/// L and L + V of a light, linear between the corners.
fn directions(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> impl Fn(&Source) -> [Series; 2] {
    let positions = setup.vertices().map(|vertex| point(vertex.position));
    let shortened = |v: [i32; 3], bits: u32| v.map(|c| c >> (COSINE - VECTOR + bits));
    let viewer = positions.map(|position| shortened(shading.lighting.viewer().towards(position), 1));
    move |source| {
        let towards = positions.map(|position| source.towards(position));
        let ([a, b, c], [va, vb, vc]) = (towards.map(|towards| shortened(towards, 1)), viewer);
        [Series::new(towards.map(|towards| shortened(towards, 0))), Series::new([add(a, va), add(b, vb), add(c, vc)])]
    }
}
