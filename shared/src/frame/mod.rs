//! One frame: what happens before its rows are drawn, and how it is drawn in one part or in two.

mod context;
mod part;
mod preparation;
mod skips;

pub(crate) use context::Settings;
pub use part::Stats;
pub(crate) use preparation::Seams;
pub use preparation::{Preparation, PreparationPart};
pub use skips::Skips;

use crate::{error::RenderError, pixel::Pixel};
use context::Context;
use core::ops::Range;
use embedded_graphics_core::primitives::Rectangle;
use part::Part;

/// One frame, drawn band by band from the top.
#[derive(Debug)]
pub struct Frame<'r, C: Pixel> {
    context: Context<'r, C>,
    part: Part<'r>,
}

impl<'r, C: Pixel> Frame<'r, C> {
    /// Draws the next band into the front of `pixels`, row by row, and returns the area that it fills; `None` after the last.
    ///
    /// The first `area.size.width * area.size.height` entries of `pixels` are the band. A slice shorter than a band gets fewer rows.
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Result<Option<Rectangle>, RenderError> {
        self.next_band_over(pixels, |_, _| ())
    }

    /// Draws the next band as [`Self::next_band`] does, over something of the program's own: `under` is given the pixels of the band, which are
    /// the background of the scene, and its area, and draws what is to be seen where no triangle is, as on a [`crate::BandTarget`].
    /// Antialiased edges blend with it.
    ///
    /// No frame knows what another one had under it: where that changes, the frame has to be drawn with partial redraw turned off, and
    /// [`Self::rows`] does not tell the rows that it reaches.
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band_over(&mut self, pixels: &mut [C], under: impl FnOnce(&mut [C], Rectangle)) -> Result<Option<Rectangle>, RenderError> {
        self.part.next_band(&self.context, pixels, under)
    }

    /// What the frame has: the whole picture, or the rectangle around what may differ from the one that the renderer drew before, where that is
    /// asked for, see [`crate::Renderer::set_partial_redraw`]; bands may leave out some of it.
    #[must_use]
    pub fn area(&self) -> Rectangle {
        self.context.region.hull().rectangle()
    }

    /// Whether the frame has the whole picture.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.context.region.is_whole()
    }

    /// The rows that triangles of this frame can reach; all other rows of what it has are background, and labels, which never move. What of the
    /// picture it has not may show objects that stand still in other rows.
    #[must_use]
    pub fn rows(&self) -> Range<u32> {
        self.part.rows.clone()
    }

    /// The row above which a `share` of the triangles end, of 2^16: about where [`Self::in_two`] has to divide the frame for two processors
    /// to share the work so.
    #[must_use]
    pub fn row_at(&self, share: u16) -> u32 {
        self.part.bins.row_at(self.part.entries, share)
    }

    /// Draws only these `rows` of its area; to be called before the first band. It is enough to draw and send the rows that triangles reach in this
    /// frame or reached in the frame before, see [`Self::rows`]: a display that shows the frame before has the rest.
    pub fn limit(&mut self, rows: Range<u32>) {
        self.part.limit(rows);
    }

    /// Whether the last band has been drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.part.is_complete(&self.context)
    }

    /// The counts so far; they are complete after the last band.
    #[must_use]
    pub fn stats(&self) -> Stats {
        self.part.stats.culled()
    }

    /// Divides the frame, before its first band, into the rows above `row` and those from there on, for two processors to draw at the same
    /// time. The memory for bands is divided as well: that of a layout for two [`crate::Layout::processors`] gives each its bands. Where
    /// triangles take more than half of the room that there is for them, the first part has all rows.
    #[must_use]
    pub fn in_two(self, row: u32) -> FrameInTwo<'r, C> {
        let Self { context, part } = self;
        FrameInTwo { parts: part.in_two(row, context.settings.size.width as usize), context }
    }
}

/// A frame in two parts, see [`Frame::in_two`].
#[derive(Debug)]
pub struct FrameInTwo<'r, C: Pixel> {
    context: Context<'r, C>,
    parts: [Part<'r>; 2],
}

impl<'r, C: Pixel> FrameInTwo<'r, C> {
    /// The upper part and the lower one.
    #[must_use]
    pub fn parts(&mut self) -> [FramePart<'_, 'r, C>; 2] {
        let Self { context, parts } = self;
        parts.each_mut().map(|part| FramePart { context, part })
    }

    /// The counts so far; they are complete after the last band of both parts.
    #[must_use]
    pub fn stats(&self) -> Stats {
        let [upper, lower] = self.parts.each_ref().map(|part| part.stats);
        upper.and(lower).culled()
    }
}

/// One part of a frame, drawn band by band from its top.
#[derive(Debug)]
pub struct FramePart<'f, 'r, C: Pixel> {
    context: &'f Context<'r, C>,
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

    /// Draws the next band over what `under` draws, see [`Frame::next_band_over`].
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band_over(&mut self, pixels: &mut [C], under: impl FnOnce(&mut [C], Rectangle)) -> Result<Option<Rectangle>, RenderError> {
        self.part.next_band(self.context, pixels, under)
    }
}
