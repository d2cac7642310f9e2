//! The quadratic through the colours of corners and edge midpoints (Szirmay-Kalos and others 2000, Vlasic 2002). In perspective it is a quadratic on
//! the screen, and the midpoints are those of the edges on the screen.

use crate::{
    Facet, Frame, Shade,
    poly::{SIX, blend, quadratic},
};

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    if !facet.has_screen_nodes() {
        let nodes = SIX.map(|node| frame.node(facet, node));
        return Box::new(move |p| blend(&quadratic(facet.weights(p)), &nodes).map(|level| level.clamp(0.0, 255.0)));
    }
    let nodes = SIX.map(|node| frame.node(facet, facet.seen(node)));
    Box::new(move |p| blend(&quadratic(facet.flat_weights(p)), &nodes).map(|level| level.clamp(0.0, 255.0)))
}
