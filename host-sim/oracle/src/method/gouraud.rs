//! Colours of the corners, linear in between (Gouraud 1971).

use crate::{Facet, Frame, Shade, poly::blend};

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let nodes = Facet::CORNERS.map(|corner| frame.node(facet, corner));
    Box::new(move |p| blend(&facet.weights(p), &nodes).map(|level| level.clamp(0.0, 255.0)))
}
