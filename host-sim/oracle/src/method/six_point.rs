//! The quadratic through the colours of corners and edge midpoints (Szirmay-Kalos and others 2000, Vlasic 2002).

use crate::{
    Facet, Frame, Shade,
    poly::{SIX, blend, quadratic},
};

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let nodes = SIX.map(|node| frame.node(facet, node));
    Box::new(move |p| blend(&quadratic(facet.weights(p)), &nodes).map(|level| level.clamp(0.0, 255.0)))
}
