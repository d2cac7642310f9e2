//! The quadratic through the colours of corners and edge midpoints (Szirmay-Kalos and others 2000, Vlasic 2002). In perspective it is a quadratic on
//! the screen, and the midpoints are those of the edges on the screen.

use crate::{
    Facet, Frame, Shade,
    poly::{SIX, blend, quadratic},
};

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let on_screen = facet.has_screen_nodes();
    let nodes = SIX.map(|node| frame.node(facet, if on_screen { facet.seen(node) } else { node }));
    Box::new(move |p| {
        let weights = if on_screen { facet.flat_weights(p) } else { facet.weights(p) };
        blend(&quadratic(weights), &nodes).map(|level| level.clamp(0.0, 255.0))
    })
}
