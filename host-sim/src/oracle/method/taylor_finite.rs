//! The cosine between two interpolated vectors by its second-order Taylor expansion about the centroid (Bishop and
//! Weimer 1986, finite eye).

use crate::{
    oracle::{Facet, Frame, Shade, frame::mixed},
    vector::{V3, add, dot, length, scale, sub},
};

/// The expansion of `N·W / (|N| |W|)` at `N = c + m`, `W = f + q`, about `c` and `f`.
///
/// With `|N|² = s² (1 + 2α + β)`, α first, β second order: `1/|N| = (1 - α - β/2 + 3α²/2)/s`; likewise for W. The
/// product of the three series, cut after second order. Lengths count as at least 1/16, the result as at most 1.
pub(super) fn expansion([c, m]: [V3; 2], [f, q]: [V3; 2]) -> f64 {
    let [s, r] = [length(c).max(1.0 / 16.0), length(f).max(1.0 / 16.0)];
    let (alpha, beta) = (dot(c, m) / (s * s), dot(m, m) / (s * s));
    let (gamma, delta) = (dot(f, q) / (r * r), dot(q, q) / (r * r));
    let (zeroth, first, second) = (dot(c, f), dot(c, q) + dot(m, f), dot(m, q));
    let scale = [-alpha - gamma, 1.5 * (alpha * alpha + gamma * gamma) - (beta + delta) / 2.0 + alpha * gamma];
    (zeroth + first + second + zeroth * scale[0] + first * scale[0] + zeroth * scale[1]) / (s * r)
}

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    // Linear in between: L of unit length, and (L + V)/2, along H.
    let corners: Vec<[[V3; 3]; 2]> = (frame.lights.iter())
        .map(|light| {
            let rays = facet.positions.map(|position| frame.rays(light, position));
            [rays.map(|rays| rays.light), rays.map(|rays| scale(add(rays.light, rays.view), 0.5))]
        })
        .collect();
    let expand = |v: &[V3; 3], weights: V3| {
        let centre = mixed(v, Facet::CENTRE);
        [centre, sub(mixed(v, weights), centre)]
    };
    Box::new(move |p| {
        let weights = facet.weights(p);
        let normal = expand(&facet.normals, weights);
        frame.lit(facet, corners.iter().map(|fields| [0, 1].map(|k| expansion(normal, expand(&fields[k], weights)).min(1.0))))
    })
}
