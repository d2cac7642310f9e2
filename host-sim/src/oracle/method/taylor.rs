//! N·L and N·H by their second-order Taylor expansion about the centroid (Bishop and Weimer 1986, infinite eye).

use crate::{
    oracle::{Facet, Frame, Shade},
    vector::{V3, dot, length, sub},
};

/// The expansion of `v·N / |N|` at `N = c + m`, about `c`:
///
/// `T = a/s + v·m/s - a (c·m)/s³ + 3a (c·m)²/(2 s⁵) - (v·m)(c·m)/s³ - a (m·m)/(2 s³)`, where `a = v·c`, `s = |c|`,
/// at least 1/16. Far from the centroid the expansion leaves [-1, 1]; more than 1 counts as 1.
pub(super) fn expansion(v: V3, c: V3, m: V3) -> f64 {
    let (a, s) = (dot(v, c), length(c).max(1.0 / 16.0));
    let (vm, cm, mm) = (dot(v, m), dot(c, m), dot(m, m));
    a / s + vm / s - a * cm / s.powi(3) + 3.0 * a * cm * cm / (2.0 * s.powi(5)) - vm * cm / s.powi(3) - a * mm / (2.0 * s.powi(3))
}

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let centre = facet.normal(Facet::CENTRE);
    let rays: Vec<_> = frame.lights.iter().map(|light| frame.rays(light, facet.position(Facet::CENTRE))).collect();
    Box::new(move |p| {
        let away = sub(facet.normal(facet.weights(p)), centre);
        frame.lit(facet, rays.iter().map(|rays| [rays.light, rays.half].map(|v| expansion(v, centre, away).min(1.0))))
    })
}
