//! Six-point, split where the centre is not met (Szirmay-Kalos and others 2000).
//!
//! Only the centre decides, so one side of an edge may be split and the other not: surfaces crack, as printed.

use crate::{
    Facet, Frame, Levels, Shade,
    poly::{FOUR, SIX, blend, quadratic, quarter, within},
};
use microphong_render::vector::V3;

/// What the quadratic may be wrong by at the centre, in levels.
pub(super) const CENTRE: f64 = 2.0;
/// How often a triangle is split at most.
pub(super) const DEPTH: u32 = 3;

/// A triangle drawn whole, by its six colours, or in four parts.
#[derive(Clone, Debug)]
pub(super) enum Tree {
    /// Values at [`SIX`].
    Whole([Levels; 6]),
    /// The [`FOUR`].
    Split(Box<[Tree; 4]>),
}

impl Tree {
    /// The colour at a point.
    pub(super) fn at(&self, weights: V3) -> Levels {
        match self {
            Self::Whole(nodes) => blend(&quadratic(weights), nodes),
            Self::Split(parts) => {
                let (which, inner) = quarter(weights);
                parts[which].at(inner)
            }
        }
    }
}

/// The channel that differs most.
pub(super) fn distance(a: Levels, b: Levels) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet, lean: f64) -> Shade<'f> {
    let tree = build(&|weights| frame.node(facet, weights), &Facet::CORNERS, DEPTH, CENTRE + lean);
    Box::new(move |p| tree.at(facet.weights(p)).map(|level| level.clamp(0.0, 255.0)))
}

/// `part` of the triangle, split `depth` times at most.
fn build(colour: &impl Fn(V3) -> Levels, part: &[V3; 3], depth: u32, tolerance: f64) -> Tree {
    let nodes = SIX.map(|node| colour(within(part, node)));
    let fitted = blend(&quadratic(Facet::CENTRE), &nodes);
    if depth > 0 && distance(fitted, colour(within(part, Facet::CENTRE))) > tolerance {
        Tree::Split(Box::new(FOUR.map(|inner| build(colour, &inner.map(|corner| within(part, corner)), depth - 1, tolerance))))
    } else {
        Tree::Whole(nodes)
    }
}
