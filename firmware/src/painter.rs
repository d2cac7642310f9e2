//! Draws the rows of a frame and hands them to the display.

use crate::{Display, Failure, check};
use core::mem;
use embedded_graphics::primitives::Rectangle;
use microphong::{
    Frame, RenderError, Renderer, Stats,
    pixel::{PictureCrc, Pixel},
};

/// Prepares frames and draws their rows, by one processor or several.
pub trait Painter<D: Display> {
    /// Does what comes before the rows of frame `number`.
    fn prepare<'r>(&mut self, renderer: &'r mut Renderer<'_, D::Color>, number: u32) -> Frame<'r, D::Color> {
        renderer.frame(number)
    }

    /// Draws `frame` onto `display`, and adds its pixels to a checksum if there is one.
    ///
    /// # Errors
    /// When there is no room to draw into.
    fn draw(&mut self, display: &mut D, frame: Frame<'_, D::Color>, crc: Option<&mut PictureCrc>) -> Result<Stats, Failure>;

    /// Logs the time and the counts of the frames.
    fn report(&self) {}
}

/// A painter in which one processor draws all rows.
#[derive(Debug)]
pub struct OneCore<C: 'static> {
    /// The band that is drawn next.
    pub band: &'static mut [C],
}

impl<D: Display> Painter<D> for OneCore<D::Color> {
    fn draw(&mut self, display: &mut D, mut frame: Frame<'_, D::Color>, crc: Option<&mut PictureCrc>) -> Result<Stats, Failure> {
        let output = frame.output();
        rows(|band| frame.next_band(band), &mut self.band, |area, band| display.send(area, band, output), crc)?;
        Ok(frame.stats())
    }
}

/// Draws bands one after another by `next` and hands each to `send`, which gives memory for the next one.
pub(crate) fn rows<C: Pixel>(
    mut next: impl FnMut(&mut [C]) -> Result<Option<Rectangle>, RenderError>,
    band: &mut &'static mut [C],
    mut send: impl FnMut(Rectangle, &'static mut [C]) -> &'static mut [C],
    mut crc: Option<&mut PictureCrc>,
) -> Result<(), RenderError> {
    while let Some(area) = next(band)? {
        if let Some(crc) = &mut crc {
            check(crc, part(band, area));
        }
        *band = send(area, mem::take(band));
    }
    Ok(())
}

/// The pixels of `area` in a band.
pub(crate) fn part<C>(band: &[C], area: Rectangle) -> &[C] {
    &band[..(area.size.width * area.size.height) as usize]
}
