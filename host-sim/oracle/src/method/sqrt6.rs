//! Six-point fits of N·L and of a root of N·H: a root bends less than the cosine near the highlight.

use crate::{
    Facet, Frame, Shade,
    frame::SurfacePoint,
    poly::{SIX, blend, quadratic},
};

/// `sqrt(w)` from 1/4 upwards, continued by its tangent. A cosine above 1, of a normal that rounding has made longer than 1, counts as 1.
fn root(w: f64) -> f64 {
    if w >= 0.25 { w.min(1.0).sqrt() } else { w + 0.25 }
}

/// The inverse of [`root`].
fn square(z: f64) -> f64 {
    if z >= 0.5 { z * z } else { z - 0.25 }
}

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    fitted(frame, facet, root, square)
}

/// `sqrt6` without the root: N·H itself is interpolated.
pub(super) fn by_cosines<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    fitted(frame, facet, |w| w, |w| w)
}

/// N·H is interpolated as a function of it, and that undone.
fn fitted<'f>(frame: &'f Frame, facet: &'f Facet, function: fn(f64) -> f64, inverse: fn(f64) -> f64) -> Shade<'f> {
    // In perspective it is a quadratic on the screen through midpoints there, unless the triangle reaches too far.
    let [least, most] = [f64::min, f64::max].map(|choose| facet.shares.into_iter().reduce(choose).unwrap_or(1.0));
    let on_screen = facet.has_screen_nodes() && 8.0 * most <= 9.0 * least;
    let fit = |light| {
        SIX.map(|node| {
            let node = if on_screen { facet.seen(node) } else { node };
            let [diffuse, half] = frame.cosines(light, facet.position(node), facet.node(node));
            [diffuse, function(half)]
        })
    };
    let fits: Vec<_> = frame.lights.iter().map(fit).collect();
    Box::new(move |p| {
        let weights = if on_screen { facet.flat_weights(p) } else { facet.weights(p) };
        // The albedo is that of the point that is seen. The position, by which lights weaken, is linear on the screen if the quadratic is.
        let point = SurfacePoint { position: facet.position(weights), ..facet.at(p) };
        let weights = quadratic(weights);
        let cosines = fits.iter().map(|fit| blend(&weights, fit)).map(|[diffuse, half]| [diffuse, inverse(half)]);
        frame.lit(facet, point, cosines)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_undoes_root_and_both_are_smooth() {
        for w in (-100..=100).map(|k| f64::from(k) / 100.0) {
            assert!((square(root(w)) - w).abs() < 1e-12, "{w}");
        }
        let slope = |w: f64| (root(w + 1e-6) - root(w)) / 1e-6;
        assert!((slope(0.25 - 1e-6) - 1.0).abs() < 1e-5 && (slope(0.25) - 1.0).abs() < 1e-5);
    }
}
