//! Pseudo-Phong shading: Gouraud's on triangles a few pixels large.
//!
//! A triangle is split into 4^k copies of itself, k at most 6 and the least for
//! which no edge is longer than 8 pixels, each lit at its corners with the
//! interpolated, normalised normal. What Phong shading on machines that only know
//! Gouraud's amounts to. Cost: one addition a pixel and channel, but a light and a
//! set-up for every 32 pixels or fewer. Neighbours may be split unequally, then
//! they meet in chords of the same curve.

use super::{Facet, Shading, split::Cells};
use crate::{
    band::Band,
    format::{SPLITS, SUBPIXEL},
    pixel::Pixel,
    raster::cell::Cell,
};

/// Logarithm of the longest edge of a part, 8 pixels in 1/16 pixel.
const LONGEST: u32 = 3 + SUBPIXEL;

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let cells = Cells::new(facet, shading);
    cells.linear_parts(&Cell::WHOLE, &cells.corners(), splits(facet), band)
}

/// How often the triangle is split.
fn splits(facet: &Facet<'_>) -> u32 {
    let ([a, b, c], finer) = (facet.corners, facet.outline.finer());
    let longest = [(a, b), (b, c), (c, a)].into_iter().fold(0, |longest, (a, b)| {
        let (x, y) = (i64::from(a.x) - i64::from(b.x), i64::from(a.y) - i64::from(b.y));
        longest.max(x * x + y * y)
    });
    (0..SPLITS).find(|k| longest <= 1 << (2 * (LONGEST + finer + k))).unwrap_or(SPLITS)
}
