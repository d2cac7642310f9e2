//! Gouraud on the four triangles between corners and edge midpoints.

use super::pseudo_phong::split;
use crate::{Facet, Frame, Shade};

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    split(frame, facet, 1)
}
