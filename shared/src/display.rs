//! Frames drawn to embedded-graphics displays, in whole bands and never in single pixels, and what is drawn over them.

use crate::{Frame, Renderer, Stats, error::RenderError, pixel::Pixel};
use core::{cell::RefCell, convert::Infallible, fmt};
use embedded_graphics_core::{
    Drawable,
    draw_target::DrawTarget,
    geometry::{Dimensions, Point},
    pixelcolor::PixelColor,
    primitives::Rectangle,
};

/// A band as a target of embedded-graphics, in the coordinates of the picture: what is drawn on it lies over the picture and is sent with it, so
/// that nothing flickers. What lies outside of the band is left out; the next band has its part of it.
#[derive(Debug)]
pub struct BandTarget<'b, C> {
    pixels: &'b mut [C],
    area: Rectangle,
}

impl<'b, C> BandTarget<'b, C> {
    /// The band that [`Frame::next_band`] has drawn into the front of `pixels`, and its area.
    #[must_use]
    pub fn new(pixels: &'b mut [C], area: Rectangle) -> Self {
        Self { pixels, area }
    }

    /// The pixels from a point on to the right, at most so many; none outside of the band.
    fn row(&mut self, from: Point, count: u32) -> &mut [C] {
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

impl<C: Pixel + PixelColor> Frame<'_, C> {
    /// Draws all bands of the frame and `over` them, handing each to `target` in one `fill_contiguous`.
    ///
    /// `band` holds at least one row.
    ///
    /// # Errors The display's.
    fn draw_to<D: DrawTarget<Color = C>>(
        mut self,
        target: &mut D,
        band: &mut [C],
        over: impl Fn(&mut BandTarget<'_, C>),
    ) -> Result<Stats, D::Error> {
        while let Ok(Some(area)) = self.next_band(band) {
            over(&mut BandTarget::new(band, area));
            target.fill_contiguous(&area, band.iter().copied().take((area.size.width * area.size.height) as usize))?;
        }
        Ok(self.stats())
    }
}

/// One frame as a [`Drawable`], to be drawn like any other shape of embedded-graphics. Its output is the frame's [`Stats`].
#[derive(Debug)]
pub struct Picture<'r, 'a, C: Pixel> {
    parts: RefCell<(&'r mut Renderer<'a, C>, &'r mut [C])>,
    /// Number of the frame; `None` for the scene as it is.
    number: Option<u32>,
}

impl<'r, 'a, C: Pixel> Picture<'r, 'a, C> {
    /// Frame `number` of `renderer`. `band` should hold as many pixels as [`crate::Layout::band`] says; a shorter one makes bands of fewer
    /// rows.
    ///
    /// # Errors
    /// When `band` does not hold one row.
    pub fn new(renderer: &'r mut Renderer<'a, C>, band: &'r mut [C], number: u32) -> Result<Self, RenderError> {
        renderer.check_band(band)?;
        Ok(Self { parts: RefCell::new((renderer, band)), number: Some(number) })
    }

    /// The scene of `renderer` as it is, see [`crate::Scene`]; `band` as in [`Self::new`].
    ///
    /// # Errors
    /// When `band` does not hold one row.
    pub fn of_scene(renderer: &'r mut Renderer<'a, C>, band: &'r mut [C]) -> Result<Self, RenderError> {
        Ok(Self { number: None, ..Self::new(renderer, band, 0)? })
    }

    /// The same with something drawn over it: `over` is called for each band, and draws text, lines and images as on a display. What it draws
    /// has to be the same for all bands of a picture.
    #[must_use]
    pub fn over<F: Fn(&mut BandTarget<'_, C>)>(self, over: F) -> PictureWithOverlay<'r, 'a, C, F> {
        PictureWithOverlay { picture: self, over }
    }
}

impl<C: Pixel + PixelColor> Picture<'_, '_, C> {
    /// Draws the picture and what lies `over` it.
    fn draw_with<D: DrawTarget<Color = C>>(&self, target: &mut D, over: impl Fn(&mut BandTarget<'_, C>)) -> Result<Stats, D::Error> {
        // The picture is borrowed already only if a display draws it from within its own `fill_contiguous`.
        match self.parts.try_borrow_mut() {
            Ok(mut parts) => {
                let (renderer, band) = &mut *parts;
                let frame = match self.number {
                    Some(number) => renderer.frame(number),
                    None => renderer.draw(),
                };
                frame.draw_to(target, band, over)
            }
            Err(_) => Ok(Stats::default()),
        }
    }
}

impl<C: Pixel + PixelColor> Drawable for Picture<'_, '_, C> {
    type Color = C;
    type Output = Stats;

    fn draw<D: DrawTarget<Color = C>>(&self, target: &mut D) -> Result<Stats, D::Error> {
        self.draw_with(target, |_| ())
    }
}

/// A [`Picture`] with something drawn over it, see [`Picture::over`].
pub struct PictureWithOverlay<'r, 'a, C: Pixel, F> {
    picture: Picture<'r, 'a, C>,
    over: F,
}

impl<C: Pixel + fmt::Debug, F> fmt::Debug for PictureWithOverlay<'_, '_, C, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PictureWithOverlay").field("picture", &self.picture).finish_non_exhaustive()
    }
}

impl<C: Pixel + PixelColor, F: Fn(&mut BandTarget<'_, C>)> Drawable for PictureWithOverlay<'_, '_, C, F> {
    type Color = C;
    type Output = Stats;

    fn draw<D: DrawTarget<Color = C>>(&self, target: &mut D) -> Result<Stats, D::Error> {
        self.picture.draw_with(target, &self.over)
    }
}
