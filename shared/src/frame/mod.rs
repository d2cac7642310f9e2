//! One frame: preparation before its rows are drawn, and drawing in one part or in two.

mod colours;
mod context;
mod part;
mod preparation;
mod skips;
mod smoother;

pub(crate) use colours::{ColourSettings, Colours};
pub(crate) use context::Settings;
pub use part::Stats;
pub(crate) use preparation::{Halves, Prepared, Seams};
pub use preparation::{Preparation, PreparationPart};
pub use skips::Skips;

use crate::{
    error::RenderError,
    pixel::{Output, Pixel},
};
use context::Context;
use core::ops::Range;
use embedded_graphics_core::primitives::Rectangle;
use part::FrameRows;

/// One frame, ready to be drawn from the top, band by band (a band is a group of rows). [`Renderer::frame`](crate::Renderer::frame) and
/// [`Renderer::draw`](crate::Renderer::draw) create one. Programs with an embedded-graphics display can use [`Picture`](crate::Picture) instead.
#[derive(Debug)]
pub struct Frame<'r, C: Pixel> {
    context: Context<'r>,
    part: FrameRows<'r>,
    colours: Colours<'r, C>,
}

impl<'r, C: Pixel> Frame<'r, C> {
    pub(crate) fn new(Prepared { context, part }: Prepared<'r>, colours: Colours<'r, C>) -> Self {
        Self { context, part, colours }
    }

    /// Draws the next band (group of rows) into `pixels` in row-major order, and returns its rectangle in the picture. Returns `None` after
    /// the last band.
    ///
    /// The band takes the first `area.size.width * area.size.height` pixels of `pixels`, where `area` is the rectangle. The buffer should
    /// have [`Layout::band`](crate::Layout::band) pixels; if it is shorter, the band has fewer rows. With partial redraw the rectangle may
    /// be narrower than the picture.
    ///
    /// # Errors
    /// Returns [`RenderError::Band`] if `pixels` is shorter than one row of the picture.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Result<Option<Rectangle>, RenderError> {
        self.next_band_over(pixels, |_, _| ())
    }

    /// Draws the next band (group of rows) like [`Self::next_band`], over something that the program draws, for example an image. `under`
    /// is called with the pixels of the band, which already contain the background, and with the rectangle of the band in the picture, which
    /// is always as wide as the picture. [`BandTarget::new`](crate::BandTarget::new) turns the two into an embedded-graphics draw target.
    /// With antialiasing, or lines along outlines, the rows that are drawn at once are not those of the band that is returned. `under` may be called
    /// several times, also for the same rows, so it must draw the same each time.
    ///
    /// With partial redraw, call [`Renderer::invalidate`](crate::Renderer::invalidate) with the area in which the result of `under`
    /// changes. [`Self::rows`] does not include rows in which only `under` draws.
    ///
    /// # Errors
    /// Returns [`RenderError::Band`] if `pixels` is shorter than one row of the picture.
    pub fn next_band_over(&mut self, pixels: &mut [C], under: impl FnMut(&mut [C], Rectangle)) -> Result<Option<Rectangle>, RenderError> {
        self.part.next_band(&self.context, &self.colours, pixels, under)
    }

    /// Returns the pass that makes pixels of the display of a finished band, if the renderer draws other pixels than the display stores:
    /// [`Light`](crate::pixel::Light) or [`LightGray`](crate::pixel::LightGray).
    #[must_use]
    pub fn output(&self) -> Output {
        self.colours.settings.output
    }

    /// Returns the rectangle that the frame draws, in pixels of the picture. It is the whole picture, unless
    /// [`Renderer::set_partial_redraw`](crate::Renderer::set_partial_redraw) is on: then it is the rectangle around all pixels that may
    /// have changed since the last frame.
    #[must_use]
    pub fn area(&self) -> Rectangle {
        self.context.region.hull().rectangle()
    }

    /// Returns `true` if the frame draws the whole picture. With [`Renderer::set_partial_redraw`](crate::Renderer::set_partial_redraw) a
    /// frame may draw only a part.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.context.region.is_whole()
    }

    /// Returns the rows that triangles of this frame can reach. The other rows of [`Self::area`] contain only the background, and texts that never
    /// move.
    #[must_use]
    pub fn rows(&self) -> Range<u32> {
        self.part.rows.clone()
    }

    /// Returns the row above which about `share / 65,536` of the triangles end. [`Self::in_two`] takes this row to divide the work between
    /// two processors in this proportion; 32,768 divides it equally.
    #[must_use]
    pub fn row_at(&self, share: u16) -> u32 {
        self.part.bins.row_at(self.part.entries, share)
    }

    /// Draws only these `rows` of the picture, to save time. The result is right only if the display still shows the other rows of the previous
    /// frame, and no triangle lies in them in the previous frame or in this one; see [`Self::rows`]. Call it before the first [`Self::next_band`].
    pub fn limit(&mut self, rows: Range<u32>) {
        self.part.limit(rows);
    }

    /// Returns `true` if all rows of the frame have been drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.part.is_complete(&self.context)
    }

    /// Returns counts of what has been drawn. They are complete when [`Self::next_band`] has returned `None`.
    #[must_use]
    pub fn stats(&self) -> Stats {
        self.part.stats.culled()
    }

    /// Divides the frame into the rows above `row` and the rows from `row` on, so that two processors can draw at the same time. Call this
    /// before the first call of [`Self::next_band`], with a row from [`Self::row_at`].
    ///
    /// The layout has to be for two [`Layout::processors`](crate::Layout::processors), and [`Layout::triangles`](crate::Layout::triangles)
    /// at least twice the number of visible triangles. Otherwise the upper part gets all rows.
    #[must_use]
    pub fn in_two(self, row: u32) -> FrameInTwo<'r, C> {
        let Self { context, part, colours } = self;
        FrameInTwo { parts: part.in_two(row, &context), context, colours }
    }
}

/// A frame that is divided into an upper and a lower part, so that two processors can draw it at the same time. [`Frame::in_two`] creates
/// it.
#[derive(Debug)]
pub struct FrameInTwo<'r, C: Pixel> {
    context: Context<'r>,
    colours: Colours<'r, C>,
    parts: [FrameRows<'r>; 2],
}

impl<'r, C: Pixel> FrameInTwo<'r, C> {
    /// Returns the upper part and the lower part. Each can be moved to its own processor.
    #[must_use]
    pub fn parts(&mut self) -> [FramePart<'_, 'r, C>; 2] {
        let Self { context, colours, parts } = self;
        parts.each_mut().map(|part| FramePart { context, colours, part })
    }

    /// Returns counts of what both parts have drawn. They are complete when [`FramePart::next_band`] has returned `None` for both.
    #[must_use]
    pub fn stats(&self) -> Stats {
        let [upper, lower] = self.parts.each_ref().map(|part| part.stats);
        upper.and(lower).culled()
    }
}

/// The upper or the lower part of a frame, for one of two processors to draw. [`FrameInTwo::parts`] returns both.
#[derive(Debug)]
pub struct FramePart<'f, 'r, C: Pixel> {
    context: &'f Context<'r>,
    colours: &'f Colours<'r, C>,
    part: &'f mut FrameRows<'r>,
}

impl<C: Pixel> FramePart<'_, '_, C> {
    /// Draws the next band (group of rows) of this part into `pixels`, and returns its rectangle in the picture. Returns `None` after the
    /// last band. See [`Frame::next_band`].
    ///
    /// # Errors
    /// Returns [`RenderError::Band`] if `pixels` is shorter than one row of the picture.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Result<Option<Rectangle>, RenderError> {
        self.next_band_over(pixels, |_, _| ())
    }

    /// Draws the next band (group of rows) of this part like [`Self::next_band`], over something that `under` draws into the pixels of the
    /// band. See [`Frame::next_band_over`].
    ///
    /// # Errors
    /// Returns [`RenderError::Band`] if `pixels` is shorter than one row of the picture.
    pub fn next_band_over(&mut self, pixels: &mut [C], under: impl FnMut(&mut [C], Rectangle)) -> Result<Option<Rectangle>, RenderError> {
        self.part.next_band(self.context, self.colours, pixels, under)
    }

    /// Returns the pass that makes pixels of the display of a finished band. See [`Frame::output`].
    #[must_use]
    pub fn output(&self) -> Output {
        self.colours.settings.output
    }
}
