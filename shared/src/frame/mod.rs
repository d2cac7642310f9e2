//! One frame: preparation before its rows are drawn, and drawing in one part or in two.

mod colours;
mod context;
mod part;
mod preparation;
mod skips;

pub(crate) use colours::{ColourSettings, Colours};
pub(crate) use context::Settings;
pub use part::Stats;
pub use preparation::{Preparation, PreparationPart};
pub(crate) use preparation::{Prepared, Seams};
pub use skips::Skips;

use crate::{error::RenderError, pixel::Pixel};
use context::Context;
use core::ops::Range;
use embedded_graphics_core::primitives::Rectangle;
use part::Part;

/// One frame, drawn band by band from the top.
#[derive(Debug)]
pub struct Frame<'r, C: Pixel> {
    context: Context<'r>,
    part: Part<'r>,
    colours: Colours<'r, C>,
}

impl<'r, C: Pixel> Frame<'r, C> {
    pub(crate) fn new(Prepared { context, part }: Prepared<'r>, colours: Colours<'r, C>) -> Self {
        Self { context, part, colours }
    }

    /// Draws the next band into the front of `pixels`, row by row, and returns its area in the picture; `None` after the last band.
    ///
    /// The first `area.size.width * area.size.height` entries of `pixels` hold the band. If `pixels` is shorter than a whole band, the band has fewer
    /// rows.
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Result<Option<Rectangle>, RenderError> {
        self.next_band_over(pixels, |_, _| ())
    }

    /// Draws the next band as [`Self::next_band`] does, over a background that the program draws. `under` is called with the pixels of the band,
    /// which hold the scene's background, and with its area. A [`crate::BandTarget`] helps to draw there. Antialiased edges blend with the result.
    ///
    /// Partial redraw does not know what `under` draws. [`crate::Renderer::invalidate`] adds an area in which that changes. [`Self::rows`] does not
    /// include rows that only `under` draws.
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band_over(&mut self, pixels: &mut [C], under: impl FnOnce(&mut [C], Rectangle)) -> Result<Option<Rectangle>, RenderError> {
        self.part.next_band(&self.context, &self.colours, pixels, under)
    }

    /// The rectangle that the frame draws. This is the whole picture, or with [`crate::Renderer::set_partial_redraw`] the rectangle around all pixels
    /// that may have changed since the frame before. Some bands may be narrower than the rectangle.
    #[must_use]
    pub fn area(&self) -> Rectangle {
        self.context.region.hull().rectangle()
    }

    /// Whether the frame draws the whole picture.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.context.region.is_whole()
    }

    /// The rows that triangles of this frame can reach. The other rows of [`Self::area`] hold background and labels, which never move. Outside of
    /// that area, other rows of the picture may show objects that stand still.
    #[must_use]
    pub fn rows(&self) -> Range<u32> {
        self.part.rows.clone()
    }

    /// The row above which a `share` of the triangles end, in units of 1/65,536. [`Self::in_two`] divides the work of two processors in about this
    /// proportion there.
    #[must_use]
    pub fn row_at(&self, share: u16) -> u32 {
        self.part.bins.row_at(self.part.entries, share)
    }

    /// Draws only these `rows`. Call it before the first band. It suffices to draw and send rows that triangles reach in this frame or reached in the
    /// frame before, see [`Self::rows`], because the display still shows the rest.
    pub fn limit(&mut self, rows: Range<u32>) {
        self.part.limit(rows);
    }

    /// Whether the last band has been drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.part.is_complete(&self.context)
    }

    /// The counts of what has been drawn. They are complete after the last band.
    #[must_use]
    pub fn stats(&self) -> Stats {
        self.part.stats.culled()
    }

    /// Divides the frame into the rows above `row` and the rest, so that two processors can draw at the same time. Call it before the first band. The
    /// layout has to be for two [`crate::Layout::processors`]. If the triangles fill more than half of their memory, the first part gets all rows.
    #[must_use]
    pub fn in_two(self, row: u32) -> FrameInTwo<'r, C> {
        let Self { context, part, colours } = self;
        FrameInTwo { parts: part.in_two(row, context.settings.size.width as usize), context, colours }
    }
}

/// A frame in two parts, see [`Frame::in_two`].
#[derive(Debug)]
pub struct FrameInTwo<'r, C: Pixel> {
    context: Context<'r>,
    colours: Colours<'r, C>,
    parts: [Part<'r>; 2],
}

impl<'r, C: Pixel> FrameInTwo<'r, C> {
    /// The upper part and the lower one.
    #[must_use]
    pub fn parts(&mut self) -> [FramePart<'_, 'r, C>; 2] {
        let Self { context, colours, parts } = self;
        parts.each_mut().map(|part| FramePart { context, colours, part })
    }

    /// The counts of what has been drawn. They are complete after the last band of both parts.
    #[must_use]
    pub fn stats(&self) -> Stats {
        let [upper, lower] = self.parts.each_ref().map(|part| part.stats);
        upper.and(lower).culled()
    }
}

/// One part of a frame, drawn band by band from its top.
#[derive(Debug)]
pub struct FramePart<'f, 'r, C: Pixel> {
    context: &'f Context<'r>,
    colours: &'f Colours<'r, C>,
    part: &'f mut Part<'r>,
}

impl<C: Pixel> FramePart<'_, '_, C> {
    /// Draws the next band, see [`Frame::next_band`].
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Result<Option<Rectangle>, RenderError> {
        self.next_band_over(pixels, |_, _| ())
    }

    /// Draws the next band over a background that `under` draws, see [`Frame::next_band_over`].
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band_over(&mut self, pixels: &mut [C], under: impl FnOnce(&mut [C], Rectangle)) -> Result<Option<Rectangle>, RenderError> {
        self.part.next_band(self.context, self.colours, pixels, under)
    }
}
