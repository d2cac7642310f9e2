//! The cosine between two interpolated vectors by its second-order Taylor expansion about the centroid (Bishop and
//! Weimer 1986, finite eye).

use crate::{Facet, Frame, Shade, frame::mixed};
use microphong_models::vector::{V3, add, dot, length, scale, sub};

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
        frame.lit(facet, facet.at(p), corners.iter().map(|fields| [0, 1].map(|k| expansion(normal, expand(&fields[k], weights)).min(1.0))))
    })
}

#[cfg(test)]
mod tests {
    use super::{super::taylor, *};
    use crate::{Light, Material, Place};
    use microphong_models::vector::scale;

    const NORMALS: [V3; 3] = [[0.3, -0.2, 0.85], [0.4, 0.1, -0.3], [-0.2, 0.5, 0.25]];
    const TOWARDS: [V3; 3] = [[-0.5, 0.6, 1.2], [0.3, 0.2, 0.1], [0.1, -0.4, 0.2]];

    /// The change of a linear field.
    fn change([_, a, b]: [V3; 3], x: f64, y: f64) -> V3 {
        add(scale(a, x), scale(b, y))
    }

    fn exact(x: f64, y: f64) -> f64 {
        let [n, w] = [NORMALS, TOWARDS].map(|field| add(field[0], change(field, x, y)));
        dot(n, w) / (length(n) * length(w))
    }

    #[test]
    fn the_expansion_is_that_of_the_cosine() {
        let found = |x, y| expansion([NORMALS[0], change(NORMALS, x, y)], [TOWARDS[0], change(TOWARDS, x, y)]);
        taylor::tests::expands(found, exact).unwrap();
        // The term that mixes both lengths.
        let mixed = |x, y| {
            let [(c, m), (f, q)] = [NORMALS, TOWARDS].map(|field| (field[0], change(field, x, y)));
            dot(c, m) * dot(f, q) * dot(c, f) / (dot(c, c) * dot(f, f) * length(c) * length(f))
        };
        assert!(taylor::tests::expands(|x, y| found(x, y) - mixed(x, y), exact).is_err());
    }

    #[test]
    fn constant_directions_give_the_simpler_expansion() {
        for (x, y) in [(0.0, 0.0), (0.3, -0.2), (-0.5, 0.4)] {
            let m = change(NORMALS, x, y);
            let simple = taylor::expansion(crate::scene::direction(TOWARDS[0]), NORMALS[0], m);
            assert!((expansion([NORMALS[0], m], [TOWARDS[0], [0.0; 3]]) - simple).abs() < 1e-12);
        }
    }

    /// The vector that is linear in between is L + V, both of unit length, not H.
    #[test]
    fn the_sum_of_light_and_view_is_interpolated() {
        let normals = [[-0.3, -0.2, 1.0], [0.35, -0.1, 1.0], [0.0, 0.4, 1.0]].map(crate::scene::direction);
        let positions = [[-0.8, -0.6, 0.0], [0.1, 0.9, 0.0], [0.8, -0.4, 0.0]];
        let facet = Facet::new([[10.0, 90.0], [40.0, 5.0], [95.0, 70.0]], [0, 1, 2], normals, positions);
        let glossy = Material { ambient: [0.0; 3], diffuse: [0.0; 3], specular: [1.0; 3], exponent: 1.0 };
        let frame = Frame {
            size: (100, 100),
            facets: vec![facet.clone()],
            lights: vec![Light::even(Place::Near([-0.9, 1.0, 1.0]), [1.0; 3])],
            viewer: Place::Near([0.5, 0.0, 1.5]),
            axes: Facet::CORNERS,
            materials: vec![glossy],
            background: [[0.0; 3]; 2],
            is_gray: false,
        };
        let sums = positions.map(|p| {
            let rays = frame.rays(&frame.lights[0], p);
            add(rays.light, rays.view)
        });
        let place = |x: f64, y: f64| [145.0 / 3.0 + 50.0 * x, 55.0 + 50.0 * y];
        let shade = shade(&frame, &facet);
        let exact = |x, y| {
            let [n, w] = [facet.normals, sums].map(|field| mixed(&field, facet.weights(place(x, y))));
            dot(n, w) / (length(n) * length(w))
        };
        taylor::tests::expands(|x, y| shade(place(x, y))[0] / 255.0, exact).unwrap();
    }
}
