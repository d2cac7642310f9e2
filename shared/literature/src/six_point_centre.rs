//! The six-point quadratic, split where it misses the centre (Szirmay-Kalos et al. 2000).
//!
//! As printed: a triangle is split into four, three times at most, while the
//! quadratic differs from the light at its centroid by more than 2 LSB in any
//! channel. A highlight beside the centre is not noticed, and neighbours that
//! decide differently do not meet: the surface cracks by up to 100 LSB.
//! [`crate::six_point_adaptive`] does neither. Cost: two additions a pixel and
//! channel; one more light a triangle, and nine a split.

use crate::{
    split::{Six, SubTriangles, corners, edges},
    sub_triangle::SubTriangle,
};
use microphong::{
    format::LEVEL,
    method::{Canvas, Facts, Highlight, HighlightField, Method, Shading, TriangleSetup, VertexLight},
};

/// Largest error of the quadratic at the centre, Q9.7.
pub const CENTRE: i32 = 2 << LEVEL;
/// Largest number of times that a triangle is split.
pub const DEPTH: u32 = 3;

static FACTS: Facts = Facts {
    name: "six-point-centre",
    id: 14,
    source: "Szirmay-Kalos et al. 2000",
    vertex_light: VertexLight::Levels,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: false,
};

/// Six-point shading, split as printed.
pub struct SixPointCentre;

impl Method for SixPointCentre {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let sub_triangles = SubTriangles::new(setup, shading);
    parts(&sub_triangles, &SubTriangle::WHOLE, &sub_triangles.six(), DEPTH, canvas)
}

/// Draws a sub-triangle by its nodes, or its parts if it has to be split; `depth` is how often it may be, once at least.
#[inline(never)]
fn parts(sub_triangles: &SubTriangles<'_, '_>, sub_triangle: &SubTriangle, six: &Six, depth: u32, canvas: &mut dyn Canvas) -> u32 {
    if !sub_triangles.meets(sub_triangle, canvas) {
        return 0;
    }
    if !sub_triangles.misses_centre(sub_triangle, six, CENTRE) {
        return sub_triangles.quadratic(sub_triangle, six, canvas);
    }
    let halves = [0, 1, 2].map(|k| sub_triangles.quarters(sub_triangle, k));
    let cuts = sub_triangles.cuts(sub_triangle);
    let mut pixels = 0;
    for (k, part) in sub_triangle.split().iter().enumerate() {
        let six = Six { corners: corners(six.corners, six.middles, k), middles: edges(halves, cuts, k) };
        pixels += if depth > 1 { parts(sub_triangles, part, &six, depth - 1, canvas) } else { sub_triangles.quadratic(part, &six, canvas) };
    }
    pixels
}
