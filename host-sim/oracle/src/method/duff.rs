//! Phong by a quadratic under a root: |N|² is walked, not N (Duff 1979; Bishop and Weimer 1986, the form before their series).

use super::renq::{Numerators, rsqrt, squares};
use crate::{
    Facet, Frame, Shade,
    poly::{quadratic, sum},
};

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let (numerators, squares) = (Numerators::new(frame, facet), squares(facet));
    Box::new(move |p| {
        let weights = quadratic(facet.weights(p));
        numerators.lit(p, &weights, rsqrt(sum(&weights, &squares)))
    })
}
