//! The highlight as a picture of the surroundings: a sphere map, its coordinates linear (Vlasic 2002, 4.2).

use crate::{
    Facet, Frame, Light, Place, Shade,
    light::highlight,
    poly::{blend, sum},
    scene::direction,
};
use microphong_models::vector::{V3, add, apply, dot, scale, sub};

/// Coordinates of the view mirrored at the normal, `W = 2 (n·v) n - v`: `(Wx, Wy) / |W + (0, 0, 1)|`.
fn coordinates(normal: V3, view: V3) -> [f64; 2] {
    let mirrored = sub(scale(normal, 2.0 * dot(normal, view)), view);
    let [x, y, _] = direction(add(mirrored, [0.0, 0.0, 1.0]));
    [x, y]
}

/// The unit vector that these coordinates stand for.
fn mirrored([u, v]: [f64; 2]) -> V3 {
    let square = u * u + v * v;
    let k = (1.0 - square).max(0.0).sqrt();
    [2.0 * k * u, 2.0 * k * v, 1.0 - 2.0 * square]
}

/// Shades in the eye's axes. One map serves the whole object: a near light shines as if from the origin.
pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let to_eye = |v: V3| apply(&frame.axes, v);
    let exponent = frame.material(facet).exponent;
    let corners = [0, 1, 2].map(|k| coordinates(to_eye(facet.normals[k]), to_eye(frame.viewer.from(facet.positions[k]))));
    let lights: Vec<(V3, [f64; 3])> = (frame.lights.iter())
        .map(|light| {
            let towards = match light.place {
                Place::Far(towards) => towards,
                Place::Near(position) => direction(position),
            };
            (to_eye(towards), diffuse(facet, light))
        })
        .collect();
    Box::new(move |p| {
        let weights = facet.weights(p);
        let mirrored = mirrored(blend(&weights, &corners));
        let reflected = |(towards, diffuse): &(V3, [f64; 3])| [sum(&weights, diffuse), highlight(dot(mirrored, *towards), exponent / 4.0)];
        frame.levels(facet, facet.at(p), lights.iter().map(reflected))
    })
}

/// The corners' `max(0, N·L)`, as Gouraud has them.
pub(super) fn diffuse(facet: &Facet, light: &Light) -> [f64; 3] {
    let least = if light.is_sky { -1.0 } else { 0.0 };
    [0, 1, 2].map(|k| dot(facet.normals[k], light.place.from(facet.positions[k])).max(least))
}
