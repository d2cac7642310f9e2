//! The six-point quadratic, split where it misses the centre (Szirmay-Kalos et al. 2000).
//!
//! As printed: a triangle is split into four, three times at most, while the
//! quadratic differs from the light at its centroid by more than 2 LSB in any
//! channel. A highlight beside the centre is not noticed, and neighbours that
//! decide differently do not meet: the surface cracks by up to 100 LSB.
//! [`super::six_point_adaptive`] does neither. Cost: two additions a pixel and
//! channel; one more light a triangle, and nine a split.

use super::{
    Facet, Shading,
    split::{Cells, Six, corners, edges},
};
use crate::{band::Band, format::LEVEL, pixel::Pixel, raster::cell::Cell};

/// What the quadratic may be wrong by at the centre, Q9.7.
pub(super) const CENTRE: i32 = 2 << LEVEL;
/// How often a triangle is split at most.
pub(super) const DEPTH: u32 = 3;

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let cells = Cells::new(facet, shading);
    parts(&cells, &Cell::WHOLE, &cells.six(), DEPTH, band)
}

/// Draws a cell by its nodes, or its parts if it has to be split; `depth` is how often it may be, once at least.
#[inline(never)]
fn parts<C: Pixel>(cells: &Cells<'_, '_, C>, cell: &Cell, six: &Six, depth: u32, band: &mut Band<'_, C>) -> u32 {
    if !cells.meets(cell, band) {
        return 0;
    }
    if !cells.misses_centre(cell, six, CENTRE) {
        return cells.quadratic(cell, six, band);
    }
    let halves = [0, 1, 2].map(|k| cells.quarters(cell, k));
    let cuts = cells.cuts(cell);
    let mut pixels = 0;
    for (k, part) in cell.split().iter().enumerate() {
        let six = Six { corners: corners(six.corners, six.middles, k), middles: edges(halves, cuts, k) };
        pixels += if depth > 1 { parts(cells, part, &six, depth - 1, band) } else { cells.quadratic(part, &six, band) };
    }
    pixels
}
