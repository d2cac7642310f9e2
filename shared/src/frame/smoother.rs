//! Antialiasing of the rows that one processor draws, band by band.
//!
//! A pixel may be mixed with the pixel above or below it, so the last row of a band is finished only when the row below is drawn. It is *held*: its
//! colours are kept, and the next band begins with it. The row above the band is kept as well, as it was before its own pixels were mixed.

use crate::{
    edges::{
        FeatureEdge,
        mix::{Surroundings, draw, store},
        walk::Window,
    },
    frame::context::Context,
    geometry::{
        bin::{Bins, Entry},
        pixel_rect::PixelRect,
    },
    memory::{Smoothing, halves},
    pixel::{Pixel, colour::colour, gamma::Gamma},
    scene::Outlines,
};
use core::{mem, ops::Range};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// The edges of a frame, and memory to smooth a band.
#[derive(Debug)]
pub(crate) struct Smoother<'r> {
    /// The edges of the frame.
    edges: &'r [FeatureEdge],
    /// Edges that are being listed.
    room: &'r mut [FeatureEdge],
    count: usize,
    /// The edges by the rows in which they begin; `None` if some found no room, or antialiasing is off.
    bins: Option<Bins>,
    entries: &'r mut [Entry],
    marks: &'r mut [u8],
    places: &'r mut [u16],
    /// The colours that are kept, as bytes, see [`kept`].
    pub(crate) colours: &'r mut [u8],
    /// The row that is held. Its colours are in [`Kept::held`].
    pub(crate) held: Option<u32>,
}

/// Colours of the rows around a band, and room for mixed ones.
pub(crate) struct Kept<'k, S> {
    pub(crate) above: &'k mut [S],
    pub(crate) held: &'k mut [S],
    mixed: &'k mut [S],
}

/// The rows around a band that is smoothed.
pub(crate) struct SmoothedBand<'b> {
    pub(crate) width: usize,
    /// The rows of the band.
    pub(crate) rows: Range<u32>,
    /// The rows whose depth is known, and their depth.
    pub(crate) known: Range<u32>,
    pub(crate) depth: &'b [u16],
}

impl<'r> Smoother<'r> {
    /// Memory for a frame, whose edges are not yet found. With antialiasing, `bins` are lists for them.
    pub(crate) fn new(memory: &'r mut Smoothing<'_>, bins: Option<Bins>) -> Self {
        let Smoothing { edges, entries, marks, places, colours } = memory;
        Self { edges: &[], room: edges, count: 0, bins, entries, marks, places, colours, held: None }
    }

    /// Adds an edge, if it may mark pixels of `area`.
    pub(crate) fn put(&mut self, edge: &FeatureEdge, area: &PixelRect) {
        let Some(rows) = edge.rows_in(area) else { return };
        match (self.room.get_mut(self.count), &mut self.bins) {
            (Some(room), Some(bins)) => {
                *room = *edge;
                bins.push(self.entries, self.count as u32, false, rows);
            }
            _ => self.bins = None,
        }
        self.count += 1;
    }

    /// Ends the list of edges, and returns how many there are. If it is not `complete`, each band finds its edges anew.
    pub(crate) fn close(&mut self, complete: bool) -> u32 {
        let room = mem::take(&mut self.room);
        self.edges = room.get(..self.count).unwrap_or_default();
        self.bins = self.bins.take().filter(|bins| complete && bins.count().is_some());
        self.count as u32
    }

    /// The rows in which edges may mark pixels, if all edges are listed.
    pub(crate) fn rows(&self) -> Option<Range<u32>> {
        self.bins.as_ref().map(Bins::rows)
    }

    /// Divides the memory between two processors.
    pub(crate) fn in_two(self, divides: bool) -> [Self; 2] {
        let Self { edges, room: _, count, bins, entries, marks, places, colours, .. } = self;
        let (entries, entries_below) = in_two(entries, divides);
        entries_below.iter_mut().zip(entries.iter()).for_each(|(below, entry)| *below = *entry);
        let (marks, marks_below) = in_two(marks, divides);
        let (places, places_below) = in_two(places, divides);
        let (colours, colours_below) = in_two(colours, divides);
        let of =
            |bins, entries, marks, places, colours| Self { edges, room: &mut [], count, bins, entries, marks, places, colours, held: None };
        [of(bins.clone(), entries, marks, places, colours), of(bins, entries_below, marks_below, places_below, colours_below)]
    }

    /// Smooths the pixels of a band. Only the rows whose depth is known have edges.
    #[inline(never)]
    pub(crate) fn smooth<C: Pixel>(
        &mut self,
        context: &Context<'_>,
        pixels: &mut [C],
        band: &SmoothedBand<'_>,
        gamma: Option<&'static Gamma>,
    ) {
        let SmoothedBand { width, rows, known, .. } = band;
        let (first, end) = (rows.start.max(known.start), rows.end.min(known.end));
        let whole = first..end;
        if first < end && self.mark(context, band, &whole, true) {
            self.mix(pixels, band, &whole, (context.settings.outlines, gamma));
        } else {
            // There are more marks than places. A row has room for all of its marks.
            for row in whole {
                let row = row..row + 1;
                self.mark(context, band, &row, false);
                self.mix(pixels, band, &row, (context.settings.outlines, gamma));
            }
        }
        if end <= first || end < rows.end {
            keep(kept::<C::Stored>(self.colours, *width).above, pixels, (rows.end - rows.start) as usize);
        }
    }

    /// Marks the pixels of `rows` at edges. Returns false, with no pixel marked, if the marks found no room.
    #[inline(never)]
    fn mark(&mut self, context: &Context<'_>, band: &SmoothedBand<'_>, rows: &Range<u32>, by_bins: bool) -> bool {
        let Self { edges, bins, entries, marks, places, .. } = self;
        let count = (rows.end - rows.start) as usize * band.width;
        let marks = marks.get_mut(..count).unwrap_or_default();
        let known = (&band.known, band.depth);
        let mut window = Window::new(band.width, known, rows, context.settings.outlines.is_some(), marks, places);
        match bins {
            Some(bins) if by_bins => {
                bins.skip(entries, rows.start);
                let mut walk = bins.band(entries, rows.end);
                for key in walk.by_ref() {
                    if let Some(edge) = edges.get(key.triangle() as usize) {
                        window.walk(edge);
                    }
                }
                bins.take_over(walk);
            }
            Some(_) => edges.iter().for_each(|edge| window.walk(edge)),
            None => context.each_edge(&mut |edge| {
                let [top, bottom] = edge.rows();
                if top < rows.end as i32 && bottom > rows.start as i32 {
                    window.walk(edge);
                }
            }),
        }
        let count = window.close();
        self.count = count.unwrap_or(0);
        count.is_some()
    }

    /// Mixes the marked pixels of `rows`, or draws lines there.
    #[inline(never)]
    fn mix<C: Pixel>(
        &mut self,
        pixels: &mut [C],
        band: &SmoothedBand<'_>,
        rows: &Range<u32>,
        (outlines, gamma): (Option<Outlines>, Option<&'static Gamma>),
    ) {
        let width = band.width;
        let Kept { above, held, mixed } = kept::<C::Stored>(self.colours, width);
        let first = (rows.start - band.rows.start) as usize;
        let places = self.places.get(..self.count).unwrap_or_default();
        if let Some(Outlines { colour: rgb, .. }) = outlines {
            draw(pixels.get_mut(first * width..).unwrap_or_default(), self.marks, places, colour::<C>(rgb), gamma);
            return;
        }
        Surroundings::<C> { above, below: held, width, gamma }.mix(pixels, first, self.marks, places, mixed);
        keep(above, pixels, (rows.end - band.rows.start) as usize);
        store(pixels.get_mut(first * width..).unwrap_or_default(), self.marks, places, mixed);
    }
}

/// Both halves of some memory if it is divided; otherwise the first part has all.
fn in_two<T>(memory: &mut [T], divides: bool) -> (&mut [T], &mut [T]) {
    let length = if divides { memory.len() / 2 } else { memory.len() };
    halves(memory, length)
}

/// The colours that are kept, in rows of `width` pixels.
pub(crate) fn kept<S: FromBytes + IntoBytes + Immutable + KnownLayout>(colours: &mut [u8], width: usize) -> Kept<'_, S> {
    let colours = <[S]>::mut_from_bytes(colours).unwrap_or_default();
    let (above, colours) = halves(colours, width);
    let (held, mixed) = halves(colours, width);
    Kept { above, held, mixed }
}

/// Keeps the last of the first `rows` rows of some pixels in `row`.
pub(crate) fn keep<C: Pixel>(row: &mut [C::Stored], pixels: &[C], rows: usize) {
    let pixels = pixels.get(rows.saturating_sub(1).wrapping_mul(row.len())..).unwrap_or_default();
    row.iter_mut().zip(pixels).for_each(|(row, pixel)| *row = pixel.stored());
}
