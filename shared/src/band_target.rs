//! A band as a target of embedded-graphics.

use core::convert::Infallible;
use embedded_graphics_core::{
    draw_target::DrawTarget,
    geometry::{Dimensions, Point},
    pixelcolor::PixelColor,
    primitives::Rectangle,
};

/// A band as a target of embedded-graphics, in the coordinates of the display: what is drawn on it is sent with the picture, so that nothing
/// flickers. What lies outside of the band is left out; the next band has its part of it.
#[derive(Debug)]
pub struct BandTarget<'b, C> {
    pixels: &'b mut [C],
    area: Rectangle,
}

impl<'b, C> BandTarget<'b, C> {
    /// The band in the front of `pixels`, and its area: that of [`crate::Frame::next_band`], moved to where the picture lies on the display.
    #[must_use]
    pub fn new(pixels: &'b mut [C], area: Rectangle) -> Self {
        Self { pixels, area }
    }

    /// The pixels from a point on to the right, at most so many; none outside of the band.
    pub(crate) fn row(&mut self, from: Point, count: u32) -> &mut [C] {
        if !self.area.contains(from) {
            return &mut [];
        }
        let (Point { x, y }, width) = (from - self.area.top_left, self.area.size.width as usize);
        let (first, left) = (y as usize * width + x as usize, width.saturating_sub(x as usize));
        self.pixels.get_mut(first..).and_then(|rest| rest.get_mut(..left.min(count as usize))).unwrap_or_default()
    }
}

impl<C> Dimensions for BandTarget<'_, C> {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl<C: PixelColor> DrawTarget for BandTarget<'_, C> {
    type Color = C;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = embedded_graphics_core::Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for embedded_graphics_core::Pixel(point, color) in pixels {
            self.row(point, 1).fill(color);
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, color: C) -> Result<(), Infallible> {
        let area = area.intersection(&self.area);
        for y in area.rows() {
            self.row(Point::new(area.top_left.x, y), area.size.width).fill(color);
        }
        Ok(())
    }
}
