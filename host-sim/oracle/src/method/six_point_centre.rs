//! Six-point, split where the centre is not met (Szirmay-Kalos and others 2000).
//!
//! Only the centre decides, so one side of an edge may be split and the other not: surfaces crack, as printed.

use super::Decide;
use crate::{
    Facet, Frame, Levels, Shade,
    poly::{FOUR, SIX, blend, quadratic, quarter, within},
};

/// Largest error of the quadratic at the centre, in levels.
pub(super) const CENTRE: f64 = 2.0;
/// Largest number of times that a triangle is split.
pub(super) const DEPTH: u32 = 3;

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet, decide: &'f Decide<'f>) -> Shade<'f> {
    let only = frame.only_channel(facet);
    Box::new(move |p| {
        let (mut part, mut weights) = (Facet::CORNERS, facet.weights(p));
        // The part of the part, and so on, in which the point lies.
        for depth in 0.. {
            let colour = |weights| frame.node(facet, within(&part, weights));
            let nodes = SIX.map(colour);
            let fitted = blend(&quadratic(Facet::CENTRE), &nodes);
            if depth == DEPTH || !decide(distance(fitted, colour(Facet::CENTRE), only) - CENTRE) {
                return blend(&quadratic(weights), &nodes).map(|level| level.clamp(0.0, 255.0));
            }
            let (which, inner) = quarter(weights);
            (part, weights) = (FOUR[which].map(|corner| within(&part, corner)), inner);
        }
        unreachable!("the deepest part is drawn whole")
    })
}

/// The difference in the channel that is interpolated alone, or in the one that differs most.
pub(super) fn distance(a: Levels, b: Levels, only: Option<usize>) -> f64 {
    (0..3).filter(|&k| only.is_none_or(|only| k == only)).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
}
