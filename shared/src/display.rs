//! Frames drawn to embedded-graphics displays, in whole bands and never in single pixels.

use crate::{Frame, Renderer, Stats, error::RenderError, pixel::Pixel};
use core::cell::RefCell;
use embedded_graphics_core::{Drawable, draw_target::DrawTarget, pixelcolor::PixelColor};

impl<C: Pixel + PixelColor> Frame<'_, C> {
    /// Draws all bands of the frame, handing each to `target` in one `fill_contiguous`.
    ///
    /// `band` holds at least one row.
    ///
    /// # Errors The display's.
    fn draw_to<D: DrawTarget<Color = C>>(mut self, target: &mut D, band: &mut [C]) -> Result<Stats, D::Error> {
        while let Ok(Some(area)) = self.next_band(band) {
            target.fill_contiguous(&area, band.iter().copied().take((area.size.width * area.size.height) as usize))?;
        }
        Ok(self.stats())
    }
}

/// One frame as a [`Drawable`], to be drawn like any other shape of embedded-graphics. Its output is the frame's [`Stats`].
#[derive(Debug)]
pub struct Picture<'r, 'a, C: Pixel> {
    parts: RefCell<(&'r mut Renderer<'a, C>, &'r mut [C])>,
    number: u32,
}

impl<'r, 'a, C: Pixel> Picture<'r, 'a, C> {
    /// Frame `number` of `renderer`. `band` should hold as many pixels as [`crate::Layout::band`] says; a shorter one makes bands of fewer
    /// rows.
    ///
    /// # Errors
    /// When `band` does not hold one row.
    pub fn new(renderer: &'r mut Renderer<'a, C>, band: &'r mut [C], number: u32) -> Result<Self, RenderError> {
        renderer.check_band(band)?;
        Ok(Self { parts: RefCell::new((renderer, band)), number })
    }
}

impl<C: Pixel + PixelColor> Drawable for Picture<'_, '_, C> {
    type Color = C;
    type Output = Stats;

    fn draw<D: DrawTarget<Color = C>>(&self, target: &mut D) -> Result<Stats, D::Error> {
        // The picture is borrowed already only if a display draws it from within its own `fill_contiguous`.
        match self.parts.try_borrow_mut() {
            Ok(mut parts) => {
                let (renderer, band) = &mut *parts;
                renderer.frame(self.number).draw_to(target, band)
            }
            Err(_) => Ok(Stats::default()),
        }
    }
}
