//! The six-point quadratic, split where it does not fit, without cracks.
//!
//! Szirmay-Kalos et al. (2000) split where the centre is missed, see
//! [`super::six_point_centre`]. Here an edge decides as well, by its own light at a
//! quarter and three quarters of the way, so both its neighbours decide alike. A
//! triangle is split if one of its edges is, or if its centre is missed; on an edge
//! that is not split all smaller parts keep to its parabola. So the surface is
//! continuous, whatever the neighbours do.
//!
//! Cost: two additions a pixel and channel; seven lights a triangle to decide, and
//! three a split. Error: about the tolerance, 2 LSB, where three splits suffice.

use super::{
    Facet, Shading,
    six_point_centre::{CENTRE, DEPTH},
    split::{Cells, Levels, Six, corners, differ, edges},
};
use crate::{band::Band, format::LEVEL, math::vector::zip, pixel::Pixel, raster::cell::Cell};

/// What an edge's parabola may be wrong by at its quarters, Q9.7.
const EDGE: i32 = 1 << LEVEL;

pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let cells = Cells::new(facet, shading);
    parts(&cells, &Cell::WHOLE, &cells.six(), [false; 3], DEPTH, band)
}

/// Draws a cell by its nodes, or its parts if it may be split and has to be; `locked` edges lie on one that was not split.
#[inline(never)]
fn parts<C: Pixel>(cells: &Cells<'_, '_, C>, cell: &Cell, six: &Six, locked: [bool; 3], depth: u32, band: &mut Band<'_, C>) -> u32 {
    if !cells.meets(cell, band) {
        return 0;
    }
    if depth == 0 {
        return cells.quadratic(cell, six, band);
    }
    let [a, b, c] = six.corners;
    let [ab, bc, ca] = six.middles;
    // Where the middles of each edge's halves will be, and whether on its parabola.
    let halves = [(a, ab, b, 0), (b, bc, c, 1), (c, ca, a, 2)].map(|(a, middle, b, k)| {
        let parabola = [eighths(a, middle, b), eighths(b, middle, a)];
        let [near, far] = parabola;
        if !locked.get(k).is_some_and(|&locked| locked) {
            let lit @ [p, q] = cells.quarters(cell, k);
            let misses = |fitted: Levels, exact: Levels| differ(fitted, exact.map(|level| 8 * level), 8 * EDGE);
            if misses(near, p) || misses(far, q) {
                return (lit, false);
            }
        }
        (parabola.map(|point| point.map(|level| (level + 4) >> 3)), true)
    });
    let fits = halves.map(|(_, fits)| fits);
    if fits == [true; 3] && !cells.misses_centre(cell, six, CENTRE) {
        return cells.quadratic(cell, six, band);
    }
    let cuts = cells.cuts(cell);
    let mut pixels = 0;
    for (k, part) in cell.split().iter().enumerate() {
        let six = Six { corners: corners(six.corners, six.middles, k), middles: edges(halves.map(|(levels, _)| levels), cuts, k) };
        let locked = edges(fits.map(|fits| [fits; 2]), [false; 3], k);
        pixels += parts(cells, part, &six, locked, depth - 1, band);
    }
    pixels
}

/// Eight times the parabola from `a` through `middle` to `b`, a quarter of the way.
fn eighths(a: Levels, middle: Levels, b: Levels) -> Levels {
    zip(zip(a, middle, |a, m| 3 * a + 6 * m), b, |sum, b| sum - b)
}
