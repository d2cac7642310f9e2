//! The cubic through the colours of ten nodes: corners, thirds of the edges, centroid (Vlasic 2002).

use crate::{
    Facet, Frame, Shade,
    poly::{TEN, blend, cubic},
};

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let nodes = TEN.map(|node| frame.node(facet, node));
    Box::new(move |p| blend(&cubic(facet.weights(p)), &nodes).map(|level| level.clamp(0.0, 255.0)))
}
