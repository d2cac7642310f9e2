//! Gouraud where no highlight can be, Phong elsewhere.

use super::{Decide, gouraud};
use crate::{Facet, Frame, Shade, light::phong};
use microphong_models::vector::dot;

/// The largest N·H on a triangle is at most the corners' largest over r, the least length of an interpolated normal.
/// A triangle on which it stays below `1 - 8/e` for every light counts as dark: to the power of e that is less than
/// exp(-8), a twelfth of a level.
///
/// Near lights or a near viewer: always Phong. What decides counts in 1/255 of a cosine.
pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet, decide: &'f Decide<'f>) -> Shade<'f> {
    if !frame.is_constant() {
        return phong(frame, facet);
    }
    let threshold = (1.0 - 8.0 / frame.material(facet).exponent.max(8.0)).max(0.0);
    let largest = frame.lights.iter().filter(|light| !light.is_sky).flat_map(|light| {
        let half = frame.rays(light, facet.positions[0]).half;
        facet.normals.map(|normal| dot(normal, half))
    });
    let excess = largest.fold(f64::MIN, f64::max) - facet.min_normal_length * threshold;
    if decide(255.0 * excess) { phong(frame, facet) } else { gouraud::shade(frame, facet) }
}
