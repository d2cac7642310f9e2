//! Gouraud shading on equal parts of a triangle, in a number at which none is large on the screen.

use crate::{
    Facet, Frame, Shade,
    poly::{FOUR, blend, quarter, within},
};
use microphong_models::vector::V3;

/// Longest edge of a part, in pixels.
const LONGEST: f64 = 8.0;
/// Largest number of times that a triangle is split.
const DEPTH: u32 = 6;

/// Split into 4^k triangles, k the smallest for which no edge is longer than eight pixels.
pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let [a, b, c] = facet.screen;
    let square = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).powi(2) + (q[1] - p[1]).powi(2);
    // Exact: coordinates are multiples of 1/16.
    let longest = square(a, b).max(square(b, c)).max(square(c, a));
    let depth = (0..DEPTH).find(|&k| longest <= (LONGEST * f64::from(1 << k)).powi(2)).unwrap_or(DEPTH);
    split(frame, facet, depth)
}

/// The colours of the part that a point lies in, linear in between, after `depth` splits.
pub(super) fn split<'f>(frame: &'f Frame, facet: &'f Facet, depth: u32) -> Shade<'f> {
    Box::new(move |p| {
        let (part, weights) = locate(facet.weights(p), depth);
        blend(&weights, &part.map(|corner| frame.node(facet, corner))).map(|level| level.clamp(0.0, 255.0))
    })
}

/// The part that a point lies in after `depth` splits, and its affine coordinates there.
fn locate(mut weights: V3, depth: u32) -> ([V3; 3], V3) {
    let mut part = Facet::CORNERS;
    for _ in 0..depth {
        let (which, inner) = quarter(weights);
        part = FOUR[which].map(|corner| within(&part, corner));
        weights = inner;
    }
    (part, weights)
}
