//! The highlight as a map around H: the normal's coordinates across it, linear or quadratic (Vlasic 2002, 4.3 and 5).

use super::environment::diffuse;
use crate::{
    Facet, Frame, Light, Shade,
    light::highlight,
    poly::{SIX, blend, quadratic as quadratic_weights, sum},
    scene::direction,
};
use microphong_models::vector::{V3, cross, dot, scale, sub};

/// The normal's coordinates across H, along the axis that is nearest to the eye's vertical, and square to it.
///
/// Their square is sin² of the angle to H, behind H too: there they are put on the unit circle, where there is no light.
fn coordinates(frame: &Frame, light: &Light, position: V3, normal: V3) -> [f64; 2] {
    let half = frame.rays(light, position).half;
    let up = frame.axes[1];
    let x = direction(sub(up, scale(half, dot(up, half))));
    let y = cross(half, x);
    let across = sub(normal, scale(half, dot(normal, half)));
    let (u, v) = (dot(x, across), dot(y, across));
    if dot(normal, half) >= 0.0 {
        return [u, v];
    }
    let length = u.hypot(v);
    if length > 0.0 { [u / length, v / length] } else { [1.0, 0.0] }
}

/// `cos^e` from the coordinates: cos² = 1 - u² - v².
fn map([u, v]: [f64; 2], exponent: f64) -> f64 {
    highlight(1.0 - u * u - v * v, exponent / 2.0)
}

/// Coordinates and diffuse light linear between the corners.
pub(super) fn linear<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let exponent = frame.material(facet).exponent;
    let lights: Vec<([[f64; 2]; 3], [f64; 3])> = (frame.lights.iter())
        .map(|light| {
            let corners = [0, 1, 2].map(|k| coordinates(frame, light, facet.positions[k], facet.normals[k]));
            (corners, diffuse(facet, light))
        })
        .collect();
    Box::new(move |p| {
        let weights = facet.weights(p);
        frame.levels(
            facet,
            facet.at(p),
            lights.iter().map(|(corners, diffuse)| [sum(&weights, diffuse), map(blend(&weights, corners), exponent)]),
        )
    })
}

/// Coordinates and N·L quadratic through six nodes.
pub(super) fn quadratic<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let exponent = frame.material(facet).exponent;
    let fit = |light: &Light| {
        SIX.map(|node| {
            let (position, normal) = (facet.position(node), facet.node(node));
            let [u, v] = coordinates(frame, light, position, normal);
            [dot(normal, light.place.from(position)), u, v]
        })
    };
    let fits: Vec<_> = frame.lights.iter().map(fit).collect();
    Box::new(move |p| {
        let weights = quadratic_weights(facet.weights(p));
        let reflected = fits.iter().map(|fit| blend(&weights, fit)).map(|[diffuse, u, v]| [diffuse, map([u, v], exponent)]);
        frame.levels(facet, facet.at(p), reflected)
    })
}
