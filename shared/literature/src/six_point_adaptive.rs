//! The six-point quadratic, split where it does not fit, without cracks.
//!
//! Szirmay-Kalos et al. (2000) split where the centre is missed, see
//! [`crate::six_point_centre`]. Here an edge decides as well, by its own light at a
//! quarter and three quarters of the way, so both its neighbours decide alike. A
//! triangle is split if one of its edges is, or if its centre is missed; on an edge
//! that is not split all smaller parts keep to its parabola. So the surface is
//! continuous, whatever the neighbours do.
//!
//! Cost: two additions a pixel and channel; seven lights a triangle to decide, and
//! three a split. Error: about the tolerance, 2 LSB, where three splits suffice.

use crate::{
    six_point_centre::{CENTRE, DEPTH},
    split::{Levels, Six, SubTriangles, corners, differ, edges},
    sub_triangle::SubTriangle,
};
use microphong::{
    format::LEVEL,
    math::vector::zip,
    method::{Canvas, Facts, Highlight, HighlightField, Method, Shading, TriangleSetup, VertexLight},
};

/// Largest error of an edge's parabola at its quarters, Q9.7.
const EDGE: i32 = 1 << LEVEL;

static FACTS: Facts = Facts {
    name: "six-point-adaptive",
    id: 13,
    source: "microphong 2026, after Szirmay-Kalos et al. 2000",
    vertex_light: VertexLight::Levels,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: false,
};

/// Six-point shading, split without cracks.
pub struct SixPointAdaptive;

impl Method for SixPointAdaptive {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let sub_triangles = SubTriangles::new(setup, shading);
    parts(&sub_triangles, &SubTriangle::WHOLE, &sub_triangles.six(), [false; 3], DEPTH, canvas)
}

/// The edges of a sub-triangle, halved.
struct Halves {
    /// The middle of the first half of each edge, and of the second.
    middles: [[Levels; 2]; 3],
    /// Whether the edge's parabola fits; then they lie on it.
    fits: [bool; 3],
}

/// Draws a sub-triangle by its nodes, or its parts if it has to be split; `depth` is how often it may be, once at least.
/// `locked` edges lie on one that was not split.
#[inline(never)]
fn parts(
    sub_triangles: &SubTriangles<'_, '_>,
    sub_triangle: &SubTriangle,
    six: &Six,
    locked: [bool; 3],
    depth: u32,
    canvas: &mut dyn Canvas,
) -> u32 {
    if !sub_triangles.meets(sub_triangle, canvas) {
        return 0;
    }
    let Halves { middles, fits } = halves(sub_triangles, sub_triangle, six, locked);
    if fits == [true; 3] && !sub_triangles.misses_centre(sub_triangle, six, CENTRE) {
        return sub_triangles.quadratic(sub_triangle, six, canvas);
    }
    let cuts = sub_triangles.cuts(sub_triangle);
    let mut pixels = 0;
    for (k, part) in sub_triangle.split().iter().enumerate() {
        let six = Six { corners: corners(six.corners, six.middles, k), middles: edges(middles, cuts, k) };
        let locked = edges(fits.map(|fits| [fits; 2]), [false; 3], k);
        pixels += if depth > 1 {
            parts(sub_triangles, part, &six, locked, depth - 1, canvas)
        } else {
            sub_triangles.quadratic(part, &six, canvas)
        };
    }
    pixels
}

/// A function of its own, so that its variables are off the stack before parts are drawn.
#[inline(never)]
fn halves(sub_triangles: &SubTriangles<'_, '_>, sub_triangle: &SubTriangle, six: &Six, locked: [bool; 3]) -> Halves {
    let [a, b, c] = six.corners;
    let [ab, bc, ca] = six.middles;
    let [lock_ab, lock_bc, lock_ca] = locked;
    let half = |k: usize, locked: bool, a: Levels, middle: Levels, b: Levels| {
        let parabola @ [near, far] = [eighths(a, middle, b), eighths(b, middle, a)];
        if !locked {
            let lit @ [p, q] = sub_triangles.quarters(sub_triangle, k);
            let misses = |fitted: Levels, exact: Levels| differ(fitted, exact.map(|level| 8 * level), 8 * EDGE);
            if misses(near, p) || misses(far, q) {
                return (lit, false);
            }
        }
        (parabola.map(|point| point.map(|level| (level + 4) >> 3)), true)
    };
    let halves = [half(0, lock_ab, a, ab, b), half(1, lock_bc, b, bc, c), half(2, lock_ca, c, ca, a)];
    Halves { middles: halves.map(|(middles, _)| middles), fits: halves.map(|(_, fits)| fits) }
}

/// Eight times the parabola from `a` through `middle` to `b`, a quarter of the way.
fn eighths(a: Levels, middle: Levels, b: Levels) -> Levels {
    zip(zip(a, middle, |a, m| 3 * a + 6 * m), b, |sum, b| sum - b)
}
