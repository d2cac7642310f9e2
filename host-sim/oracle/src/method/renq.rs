//! Phong without a division: linear N·L and N·H times the six-point fit of 1/|N|.

use crate::{
    Facet, Frame, Levels, Shade,
    poly::{SIX, blend, quadratic, sum},
};
use microphong_models::vector::dot;

/// N·L and N·H of the interpolated normal, not normalised: `scale` then takes their length away.
///
/// Under constant directions they are linear, and their six-point fit is exact; else it is a fit.
pub(super) struct Numerators<'f> {
    frame: &'f Frame,
    facet: &'f Facet,
    fits: Vec<[[f64; 2]; 6]>,
}

impl<'f> Numerators<'f> {
    pub(super) fn new(frame: &'f Frame, facet: &'f Facet) -> Self {
        let fit = |light| SIX.map(|node| frame.cosines(light, facet.position(node), facet.normal(node)));
        Self { frame, facet, fits: frame.lights.iter().map(fit).collect() }
    }

    /// The colour at a pixel where the six nodes have these weights and 1/|N| is `scale`.
    pub(super) fn lit(&self, p: [f64; 2], weights: &[f64; 6], scale: f64) -> Levels {
        self.frame.lit(self.facet, self.facet.at(p), self.fits.iter().map(|fit| blend(weights, fit).map(|cosine| cosine * scale)))
    }
}

/// Shorter normals count as so long: opposite normals have no direction half-way.
const SHORTEST: f64 = 1e-6;

/// 1/|N| at the six nodes; corners count as unit vectors.
pub(super) fn reciprocals(facet: &Facet) -> [f64; 6] {
    let middle = |i, j| 1.0 / facet.middle(i, j).max(SHORTEST);
    [1.0, 1.0, 1.0, middle(0, 1), middle(1, 2), middle(2, 0)]
}

/// |N|², exactly quadratic, at the six nodes. At corners it differs from 1 by the rounding of the stored normals, of which a highlight of
/// exponent 1024 makes several levels.
pub(super) fn squares(facet: &Facet) -> [f64; 6] {
    let corner = |i: usize| dot(facet.normals[i], facet.normals[i]);
    let middle = |i, j| facet.middle(i, j).powi(2);
    [corner(0), corner(1), corner(2), middle(0, 1), middle(1, 2), middle(2, 0)]
}

/// 1/sqrt of an interpolated [`squares`].
pub(super) fn rsqrt(square: f64) -> f64 {
    1.0 / square.max(SHORTEST * SHORTEST).sqrt()
}

/// Length of the interpolated normal below which no quadratic is close to 1/|N|; it is computed there.
pub(super) const CURVED: f64 = 0.5;

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let (numerators, reciprocals, squares) = (Numerators::new(frame, facet), reciprocals(facet), squares(facet));
    Box::new(move |p| {
        let weights = quadratic(facet.weights(p));
        let scale = if facet.min_normal_length < CURVED { rsqrt(sum(&weights, &squares)) } else { sum(&weights, &reciprocals) };
        numerators.lit(p, &weights, scale)
    })
}
