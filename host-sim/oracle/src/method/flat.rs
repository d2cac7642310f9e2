//! One colour per triangle: the light of its plane at its centroid.

use crate::{Facet, Frame, Shade};

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let centre = facet.point(Facet::CENTRE);
    let levels = frame.lit(facet, centre, frame.lights.iter().map(|light| frame.cosines(light, centre.position, facet.plane)));
    Box::new(move |_| levels)
}
