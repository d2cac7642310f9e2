//! Mixes pixels with the neighbours that are seen beyond an edge.

use crate::{
    edges::walk::{DIRECTION, DOWN, LEFT, UP},
    pixel::{Pixel, gamma::Gamma},
};
use core::array;

/// Pixels of a band around those that are mixed, as they were before.
pub(crate) struct Surroundings<'s, C: Pixel> {
    /// The row above the first one that is mixed.
    pub(crate) above: &'s [C::Stored],
    /// The row below the band.
    pub(crate) below: &'s [C::Stored],
    /// Number of columns.
    pub(crate) width: usize,
    /// The curve of the display.
    pub(crate) gamma: Option<&'static Gamma>,
}

impl<C: Pixel> Surroundings<'_, C> {
    /// Computes the colours of `places`, which are pixels of the band's rows from number `first` on. `marks` are those of these rows.
    #[inline(never)]
    pub(crate) fn mix(&self, pixels: &[C], first: usize, marks: &[u8], places: &[u16], mixed: &mut [C::Stored]) {
        // These begin with the first row, so the index of a pixel above wraps around and is not found.
        let pixels = pixels.get(first.wrapping_mul(self.width)..).unwrap_or_default();
        let ways: [usize; 4] = array::from_fn(|direction| match direction as u8 {
            UP => self.width.wrapping_neg(),
            DOWN => self.width,
            LEFT => 1usize.wrapping_neg(),
            _ => 1,
        });
        for (&place, mixed) in places.iter().zip(mixed) {
            let place = usize::from(place);
            let mark = marks.get(place).copied().unwrap_or(0);
            let Some(&own) = pixels.get(place) else { continue };
            let direction = mark & ((1 << DIRECTION) - 1);
            let at = place.wrapping_add(ways[usize::from(direction)]);
            let beyond = || {
                let row = if direction == UP { self.above.get(place) } else { self.below.get(at.wrapping_sub(pixels.len())) };
                row.copied().map(C::from_stored)
            };
            let neighbour = pixels.get(at).copied().or_else(beyond);
            *mixed = own.mixed_with(neighbour.unwrap_or(own), (mark >> DIRECTION).into(), self.gamma).stored();
        }
    }
}

/// Stores what [`Surroundings::mix`] has computed into the pixels that begin with the marked rows, and removes the marks.
#[inline(never)]
pub(crate) fn store<C: Pixel>(pixels: &mut [C], marks: &mut [u8], places: &[u16], mixed: &[C::Stored]) {
    for (&place, &mixed) in places.iter().zip(mixed) {
        if let (Some(pixel), Some(mark)) = (pixels.get_mut(usize::from(place)), marks.get_mut(usize::from(place))) {
            *pixel = C::from_stored(mixed);
            *mark = 0;
        }
    }
}

/// Draws lines of one colour: adds it to the marked pixels, and removes the marks. `pixels` begin with the marked rows.
///
/// A display of one bit would show a share of the colour as dots. There, of the two pixels that share a line, the one with the larger share gets the
/// colour, so that the line has no gaps.
#[inline(never)]
pub(crate) fn draw<C: Pixel>(pixels: &mut [C], marks: &mut [u8], places: &[u16], colour: C, gamma: Option<&'static Gamma>) {
    for &place in places {
        if let (Some(pixel), Some(mark)) = (pixels.get_mut(usize::from(place)), marks.get_mut(usize::from(place))) {
            if C::DEPTH == [1; 3] {
                if *mark >= 128 {
                    *pixel = colour;
                }
            } else {
                *pixel = pixel.mixed_with(colour, u32::from(*mark).div_ceil(2), gamma);
            }
            *mark = 0;
        }
    }
}
