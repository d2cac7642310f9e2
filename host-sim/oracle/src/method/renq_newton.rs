//! Phong without a division: as renq, its 1/|N| made better by Newton's iteration with the exact |N|².

use super::renq::{CURVED, Numerators, reciprocals, rsqrt, squares};
use crate::{
    Facet, Frame, Shade, phong,
    poly::{quadratic, sum},
};

/// What one step may leave, in levels.
const ENOUGH: f64 = 0.1;

/// `m (3 - D m²) / 2`, once or twice; the exact root where normals differ so much that interpolated ones get shorter than 1/2.
///
/// Newton's step leaves 1.5 δ² of a relative error δ; that of the fit is at most 0.02 c⁴ with c² = 3 (1 - r²), r the least length of
/// normals: c is the chord between two of three that are equally far from one another. A highlight multiplies it by its exponent.
///
/// Under near lights and for a near viewer no quadratic is exact: there it is Phong shading.
pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    if !frame.is_constant() {
        return phong(frame, facet);
    }
    let (numerators, reciprocals, squares) = (Numerators::new(frame, facet), reciprocals(facet), squares(facet));
    let delta = 0.02 * (3.0 * (1.0 - facet.min_normal_length * facet.min_normal_length)).powi(2);
    let left = 255.0 * frame.material(facet).exponent * 1.5 * delta * delta;
    let steps = if left > ENOUGH { 2 } else { 1 };
    Box::new(move |p| {
        let weights = quadratic(facet.weights(p));
        let square = sum(&weights, &squares);
        let newton = |m: f64| m * (3.0 - square * m * m) / 2.0;
        let scale =
            if facet.min_normal_length < CURVED { rsqrt(square) } else { (0..steps).fold(sum(&weights, &reciprocals), |m, _| newton(m)) };
        numerators.lit(&weights, scale)
    })
}
