//! Gouraud shading of the four triangles between corners and edge midpoints.
//!
//! The poor man's quadratic: the six nodes of [`super::six_point`], linear in
//! between. Cost: one addition a pixel and channel; three more nodes and four times
//! Gouraud's set-up a triangle. Continuous. A quarter of Gouraud's error.

use super::{Facet, Shading, split::Cells};
use crate::{band::Band, pixel::Pixel, raster::cell::Cell};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let cells = Cells::new(facet, shading);
    cells.linear_parts(&Cell::WHOLE, &cells.corners(), 1, band)
}
