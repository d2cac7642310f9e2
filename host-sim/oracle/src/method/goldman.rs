//! Unit normals at the ends of each row, linear in between, their length by one step of Newton's iteration per pixel
//! (Goldman, Fundamentals of computer graphics).

use crate::{
    Facet, Frame, Shade,
    light::reflection,
    scanline::{Span, lerp},
    scene::direction,
};
use microphong_models::vector::{dot, length as length_of};

/// A pixel centre on the right edge is not in the row; the edge's column is rounded, by less than this.
const TIE: f64 = 1e-9;

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let exponent = frame.material(facet).exponent;
    let rays: Vec<_> = frame.lights.iter().map(|light| frame.rays(light, facet.positions[0])).collect();
    Box::new(move |[x, y]| {
        let span = Span::new(&facet.screen, y);
        let ends = [span.left, span.right].map(|end| direction(end.lerp(&facet.normals)));
        let normal = |x: f64| lerp(ends[0], ends[1], span.along(x));
        // From the last pixel of the row to this one, each starting from its neighbour's length.
        let ahead = (span.right.x - TIE - x).floor().max(0.0) as u32;
        let length = (0..=ahead).rev().fold(1.0, |length, k| {
            let normal = normal(x + f64::from(k));
            (length + dot(normal, normal) / length) / 2.0
        });
        let normal = normal(x);
        let exact = length_of(normal).max(1e-6);
        frame.levels(
            facet,
            facet.at([x, y]),
            rays.iter().map(|rays| {
                let (light, view, between) = (dot(rays.light, normal), dot(rays.view, normal), dot(rays.light, rays.view));
                // R·V needs no root: 2 (L·N)(V·N)/|N|² - L·V, so the exact length serves.
                [light / length, reflection(light / exact, view / exact, between, exponent)]
            }),
        )
    })
}
