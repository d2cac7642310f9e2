//! Phong's own highlight, `(R·V)^(e/4)`, R the light mirrored about the normal (Phong 1975): exact at every pixel.

use crate::{
    Facet, Frame, Shade,
    light::reflection,
    scene::{Light, direction},
};
use microphong_models::vector::dot;

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let exponent = frame.material(facet).exponent;
    Box::new(move |p| {
        let weights = facet.weights(p);
        let (point, normal) = (facet.point(weights), direction(facet.normal(weights)));
        let reflected = |light: &Light| {
            let rays = frame.rays(light, point.position);
            let (diffuse, view) = (dot(normal, rays.light), dot(normal, rays.view));
            [diffuse, reflection(diffuse, view, dot(rays.light, rays.view), exponent)]
        };
        frame.levels(facet, point, frame.lights.iter().map(reflected))
    })
}
