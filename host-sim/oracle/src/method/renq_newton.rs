//! Phong without a division: as renq, its 1/|N| made better by Newton's iteration with the exact |N|².

use super::renq::{CURVED, Numerators, reciprocals, rsqrt, squares};
use crate::{
    Facet, Frame, Shade, phong,
    poly::{quadratic, sum},
};

/// Largest error that one step may leave, in levels.
const ENOUGH: f64 = 0.1;

/// One or two steps `m (3 - D m²) / 2`. The exact root is taken where normals differ so much that interpolated ones become shorter than 1/2.
///
/// Newton's step leaves 1.5 δ² of a relative error δ. The fit's error is at most 0.02 c⁴ with c² = 3 (1 - r²), where r is the smallest length of
/// normals, and c the chord between two of three equally distant ones. A highlight multiplies it by its exponent.
///
/// Under near lights and for a near viewer no quadratic is exact, so these are drawn by Phong shading.
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
        numerators.lit(p, &weights, scale)
    })
}
