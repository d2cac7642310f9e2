//! Bands of a picture as targets that embedded-graphics can draw on.

use core::{convert::Infallible, marker::PhantomData};
use embedded_graphics_core::{
    draw_target::DrawTarget,
    geometry::{Dimensions, Point},
    pixelcolor::PixelColor,
    primitives::Rectangle,
};

/// A [`DrawTarget`] for one band (group of rows drawn at once) of a picture. Text, shapes and images of embedded-graphics drawn on it are
/// sent to the display together with the picture, so nothing flickers. Coordinates are pixels of the display; pixels outside of the band
/// are discarded. `C` is the type of the pixels, and `F` the type of the colours that are drawn on it: `C`, or a pixel format of the display if
/// `C` is [`Light`](crate::pixel::Light) or [`LightGray`](crate::pixel::LightGray).
#[derive(Debug)]
pub struct BandTarget<'b, C, F = C> {
    pixels: &'b mut [C],
    area: Rectangle,
    colour: PhantomData<F>,
}

impl<'b, C, F> BandTarget<'b, C, F> {
    /// Creates a target that draws into `pixels`, the pixels of one band (group of rows drawn at once) in row-major order. `area` is the
    /// position of the band on the display: the rectangle that [`Frame::next_band`](crate::Frame::next_band) returned, moved by the
    /// position of the picture's upper left corner.
    #[must_use]
    pub fn new(pixels: &'b mut [C], area: Rectangle) -> Self {
        Self { pixels, area, colour: PhantomData }
    }

    /// At most `count` pixels of the band, from a point to the right. Empty if the point is outside of the band.
    pub(crate) fn row(&mut self, from: Point, count: u32) -> &mut [C] {
        if !self.area.contains(from) {
            return &mut [];
        }
        let (Point { x, y }, width) = (from - self.area.top_left, self.area.size.width as usize);
        let (first, left) = (y as usize * width + x as usize, width.saturating_sub(x as usize));
        self.pixels.get_mut(first..).and_then(|rest| rest.get_mut(..left.min(count as usize))).unwrap_or_default()
    }
}

impl<C, F> Dimensions for BandTarget<'_, C, F> {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl<C: Copy + From<F>, F: PixelColor> DrawTarget for BandTarget<'_, C, F> {
    type Color = F;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = embedded_graphics_core::Pixel<F>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for embedded_graphics_core::Pixel(point, color) in pixels {
            self.row(point, 1).fill(color.into());
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, color: F) -> Result<(), Infallible> {
        let area = area.intersection(&self.area);
        for y in area.rows() {
            self.row(Point::new(area.top_left.x, y), area.size.width).fill(color.into());
        }
        Ok(())
    }
}
