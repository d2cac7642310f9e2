//! Pseudo-Phong shading: Gouraud shading on triangles a few pixels large.
//!
//! A triangle is split into 4^k copies of itself, each lit at its corners with the interpolated, normalised normal. k is the smallest number, at most
//! 6, for which no edge is longer than 8 pixels. Machines that only know Gouraud shading can approximate Phong shading in this way. Cost: one
//! addition a pixel and channel, but a light and a set-up for every 32 pixels or fewer. Neighbours may be split unequally; they then meet in chords
//! of one curve.

use crate::{split::SubTriangles, sub_triangle::SubTriangle};
use microphong::{
    format::{SPLITS, SUBPIXEL},
    method::{Canvas, Facts, Highlight, HighlightField, Method, Shading, TriangleSetup, VertexLight},
};

/// Logarithm of the longest edge of a part, 8 pixels in 1/16 pixel.
const LONGEST: u32 = 3 + SUBPIXEL;

static FACTS: Facts = Facts {
    name: "pseudo-phong",
    id: 6,
    source: "Szirmay-Kalos et al. 2000",
    vertex_light: VertexLight::Levels,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: false,
};

/// Gouraud shading of small parts.
pub struct PseudoPhong;

impl Method for PseudoPhong {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let sub_triangles = SubTriangles::new(setup, shading);
    sub_triangles.linear_parts(&SubTriangle::WHOLE, &sub_triangles.corners(), splits(setup), canvas)
}

/// Number of times that the triangle is split.
fn splits(setup: &TriangleSetup<'_>) -> u32 {
    let [a, b, c] = setup.corners;
    let longest = [(a, b), (b, c), (c, a)].into_iter().fold(0, |longest, (a, b)| {
        let (x, y) = (i64::from(a.x) - i64::from(b.x), i64::from(a.y) - i64::from(b.y));
        longest.max(x * x + y * y)
    });
    (0..SPLITS).find(|k| longest <= 1 << (2 * (LONGEST + k))).unwrap_or(SPLITS)
}
