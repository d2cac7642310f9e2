//! Gouraud shading of the four triangles between corners and edge midpoints.
//!
//! The poor man's quadratic: the six nodes of [`microphong::method::levels::six_point`], linear in
//! between. Cost: one addition a pixel and channel; three more nodes and four times
//! Gouraud's set-up a triangle. Continuous. A quarter of Gouraud's error.

use crate::{split::SubTriangles, sub_triangle::SubTriangle};
use microphong::method::{Canvas, Facts, Highlight, HighlightField, Method, Shading, TriangleSetup, VertexLight};

static FACTS: Facts = Facts {
    name: "gouraud4",
    id: 5,
    source: "Vlasic 2002",
    vertex_light: VertexLight::Levels,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: false,
};

/// Gouraud shading of four parts.
pub struct Gouraud4;

impl Method for Gouraud4 {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let sub_triangles = SubTriangles::new(setup, shading);
    sub_triangles.linear_parts(&SubTriangle::WHOLE, &sub_triangles.corners(), 1, canvas)
}
