//! Some rows of a frame, drawn band by band from the top. Two parts share nothing that drawing writes, so they can be drawn at the same time.

use crate::{
    edges::{FeatureEdge, find},
    error::RenderError,
    features::{ANTIALIAS, SKIPS},
    frame::{
        colours::Colours,
        context::{Context, PlacedMesh},
        smoother::{Kept, SmoothedBand, Smoother, keep, kept},
    },
    geometry::{
        bin::{Bins, Entry, TriangleKey, Walk},
        pixel_rect::PixelRect,
    },
    memory::halves,
    pixel::Pixel,
    raster::{
        active::{ActiveTriangle, ActiveTriangles, QueueState},
        band::Band,
        counts::Counts,
    },
};
use core::ops::Range;
use embedded_graphics_core::{
    geometry::{Point, Size},
    primitives::Rectangle,
};
use zerocopy::{FromBytes, IntoBytes};

/// Statistics of one frame: how many triangles and pixels were drawn, and what did not fit into memory.
/// [`Frame::stats`](crate::Frame::stats) and the `draw` method of [`Picture`](crate::Picture) return them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stats {
    /// The number of triangles in the frame, at the levels of detail that are drawn, visible or not.
    pub triangles: u32,
    /// The number of triangles that levels of detail have saved: the triangles of the full meshes less [`Self::triangles`].
    pub simplified: u32,
    /// The number of triangles that were not drawn, because they face away, or their bounding box contains no pixel centre of the picture.
    pub culled: u32,
    /// The number of triangles that were drawn: they face the camera, and their bounding box contains a pixel centre of the picture.
    pub drawn: u32,
    /// The number of pixels of all drawn triangles. A pixel counts once for each triangle that covers it, even if a nearer triangle hides
    /// it. An object that nearer objects hide in a whole band (group of rows drawn at once) does not count there.
    pub pixels: u32,
    /// How often the frame went through all triangles of the scene: once, or once for each band (group of rows drawn at once) if
    /// [`Layout::triangles`](crate::Layout::triangles) is too small.
    pub passes: u32,
    /// The number of vertices that the layout has no room for; increase [`Layout::vertices`](crate::Layout::vertices) if it is not 0. Each
    /// triangle that uses one of them transforms it again.
    pub uncached: u32,
    /// How often a triangle that continues from one band (group of rows drawn at once) into the next had to be set up again. If it is
    /// large, increase [`Layout::active_triangles`](crate::Layout::active_triangles).
    pub set_up_anew: u32,
    /// The number of edges in the outlines of the frame, with antialiasing or lines. If it exceeds [`Layout::edges`](crate::Layout::edges), each
    /// band looks for all edges anew.
    pub edges: u32,
    /// Counts of triangles by the way in which they were drawn. All are 0 unless this crate is built with the feature `skips`.
    pub counts: Counts,
}

impl Stats {
    /// Counts all triangles that are not drawn as culled.
    pub(crate) fn culled(self) -> Self {
        Self { culled: self.triangles.saturating_sub(self.drawn), ..self }
    }

    /// Adds the counts of the lower part of a frame to those of the upper part. What is counted once a frame is in the upper part's counts.
    pub(crate) fn and(self, lower: Self) -> Self {
        let (pixels, set_up_anew) = (self.pixels.saturating_add(lower.pixels), self.set_up_anew.saturating_add(lower.set_up_anew));
        Self { pixels, set_up_anew, counts: self.counts.and(lower.counts), ..self }
    }
}

/// The rows that one processor draws, and the memory that it takes for them.
#[derive(Debug)]
pub(crate) struct FrameRows<'r> {
    pub(crate) bins: Bins,
    pub(crate) entries: &'r mut [Entry],
    /// Depth buffer of one band.
    pub(crate) depth: &'r mut [u16],
    /// Antialiasing.
    pub(crate) smoother: Smoother<'r>,
    /// Triangles that are kept for the next band, and triangles that the last band has kept.
    pub(crate) active_triangles: &'r mut [ActiveTriangle],
    pub(crate) queue: QueueState,
    /// Rows that triangles may reach.
    pub(crate) rows: Range<u32>,
    /// First row that no band has returned.
    pub(crate) top: u32,
    /// First row that has not been drawn.
    pub(crate) drawn: u32,
    /// Rows of a band that there is room for.
    pub(crate) band_rows: u32,
    /// One past the last row to be returned.
    pub(crate) bottom: u32,
    pub(crate) stats: Stats,
}

impl<'r> FrameRows<'r> {
    /// See [`crate::Frame::next_band_over`].
    pub(crate) fn next_band<C: Pixel>(
        &mut self,
        context: &Context<'_>,
        colours: &Colours<'_, C>,
        pixels: &mut [C],
        mut under: impl FnMut(&mut [C], Rectangle),
    ) -> Result<Option<Rectangle>, RenderError> {
        let Some(rows) = self.next_rows(context, pixels.len())? else { return Ok(None) };
        let size = context.settings.size;
        // They are drawn in all columns, and sent in those that are wanted.
        let whole = PixelRect { columns: [0, size.width as u16], rows };
        let (area, Range { start: left, end: right }) = (whole.rectangle(), context.region.within(&whole).columns());
        let Size { width, height } = area.size;
        let columns = [left as u16, right as u16];
        let pixels = if ANTIALIAS && context.settings.has_edges() {
            // The row that is held belongs to the next band, of which other columns may be wanted.
            self.draw_smooth(context, colours, pixels, &mut under, context.region.hull().columns, rows.map(u32::from));
            pixels.get_mut(..(width * height) as usize).unwrap_or_default()
        } else {
            let pixels = pixels.get_mut(..(width * height) as usize).unwrap_or_default();
            self.draw_over(context, colours, pixels, &mut under, columns, rows.map(u32::from), 0);
            pixels
        };
        self.top = rows[1].into();
        #[cfg(feature = "text")]
        crate::text::draw(context.scene.stream.labels, size, pixels, area);
        if right - left < width {
            narrow(pixels, width as usize, left as usize..right as usize);
        }
        Ok(Some(Rectangle::new(Point::new(left as i32, area.top_left.y), Size::new(right - left, height))))
    }

    /// Returns the rows of the next band, for which a buffer of `pixels` pixels is long enough; `None` after the last band.
    fn next_rows(&self, context: &Context<'_>, pixels: usize) -> Result<Option<[u16; 2]>, RenderError> {
        let width = context.settings.size.width;
        let fit = u32::try_from(pixels).unwrap_or(u32::MAX).checked_div(width).unwrap_or(0);
        if context.settings.lacking_tables > 0 {
            return Err(RenderError::TooFewHighlightTables { need: context.settings.lacking_tables });
        }
        if fit == 0 {
            return Err(RenderError::Band { need: width as usize });
        }
        let Range { start, end } = context.region.next(self.top).rows();
        let most = if ANTIALIAS && context.settings.has_edges() {
            // The last row of the buffer belongs to the next band, unless the picture ends there.
            let most = fit.min(self.band_rows).min((1 << 16) / width.max(1));
            if start + most >= context.settings.size.height { most } else { most.saturating_sub(1).max(1) }
        } else {
            // Bands end where bins end.
            fit.min(self.band_rows.saturating_sub(start.checked_rem(self.band_rows).unwrap_or(0)))
        };
        let rows = most.min(end.min(self.bottom).saturating_sub(start));
        Ok((rows > 0).then(|| [start as u16, (start + rows) as u16]))
    }

    /// Divides the part into the rows above `row` and the rest: see [`crate::Frame::in_two`].
    pub(crate) fn in_two(self, row: u32, context: &Context<'_>) -> [Self; 2] {
        let (width, smooth) = (context.settings.size.width as usize, ANTIALIAS && context.settings.has_edges());
        let Self { bins, entries, depth, smoother, active_triangles, queue, rows, top, drawn, band_rows, bottom, stats } = self;
        let used = bins.count().map_or(usize::MAX, usize::from);
        let fits = used <= entries.len() / 2 && band_rows >= 2 && (!smooth || context.settings.processors == 2);
        let row = if fits { row.min(bottom).max(top) } else { bottom };
        // Each processor links the triangles of its own rows, so both have a list of all of them.
        let (entries, below) = halves(entries, if fits { used } else { usize::MAX });
        below.iter_mut().zip(entries.iter()).for_each(|(below, entry)| *below = *entry);
        let rows_of = |length: usize| if fits { (length / 2).checked_div(width).unwrap_or(0) * width } else { usize::MAX };
        let (held, of_depth) = (active_triangles.len() / 2, rows_of(depth.len()));
        let (active_triangles, active_below) = halves(active_triangles, held);
        let (depth, depth_below) = halves(depth, of_depth);
        let [smoother, smoother_below] = smoother.in_two(fits);
        let band_rows = if fits { context.settings.rows / 2 } else { band_rows };
        let band_rows = band_rows.min(context.settings.size.height);
        let below = FrameRows {
            bins: bins.clone(),
            entries: below,
            depth: depth_below,
            smoother: smoother_below,
            active_triangles: active_below,
            queue,
            rows: rows.clone(),
            top: row,
            drawn,
            band_rows,
            bottom,
            stats: Stats::default(),
        };
        [FrameRows { bins, entries, depth, smoother, active_triangles, queue, rows, top, drawn, band_rows, bottom: row, stats }, below]
    }

    /// Restricts the part to these `rows`.
    pub(crate) fn limit(&mut self, rows: Range<u32>) {
        (self.top, self.bottom) = (rows.start.max(self.top), rows.end.min(self.bottom));
    }

    /// Whether the last band has been drawn.
    pub(crate) fn is_complete(&self, context: &Context<'_>) -> bool {
        context.region.next(self.top).rows().start >= self.bottom
    }

    /// Draws all triangles in the band from row `top` to row `bottom` over the background and `under`. Only these `columns` are needed. The depth of
    /// the band lies `before` rows behind the beginning of the depth buffer.
    // In the parts of its caller, it would be in the program several times.
    #[inline(never)]
    #[expect(clippy::too_many_arguments, reason = "the band of pixels, its place, and what is drawn there")]
    fn draw_over<C: Pixel>(
        &mut self,
        context: &Context<'_>,
        colours: &Colours<'_, C>,
        pixels: &mut [C],
        under: &mut dyn FnMut(&mut [C], Rectangle),
        columns: [u16; 2],
        [top, bottom]: [u32; 2],
        before: usize,
    ) {
        let size = context.settings.size;
        let area = Rectangle::new(Point::new(0, top as i32), Size::new(size.width, bottom - top));
        context.scene.background().fill(pixels, area, size.height);
        under(pixels, area);
        self.draw(context, colours, pixels, columns, [top, bottom], before * size.width as usize);
        if ANTIALIAS && context.settings.outlines.is_some_and(|outlines| outlines.alone) {
            // What has been drawn hides lines behind it, and is not shown.
            context.scene.background().fill(pixels, area, size.height);
            under(pixels, area);
        }
    }

    /// Draws the rows from `top` to `bottom` with smooth outlines. Only these `columns` are needed. The buffer has one row more, if the picture does not
    /// end there and the band has more than one row.
    #[inline(never)]
    fn draw_smooth<C: Pixel>(
        &mut self,
        context: &Context<'_>,
        colours: &Colours<'_, C>,
        pixels: &mut [C],
        under: &mut dyn FnMut(&mut [C], Rectangle),
        [left, right]: [u16; 2],
        [top, bottom]: [u32; 2],
    ) {
        let Size { width, height } = context.settings.size;
        let columns = [left.saturating_sub(1), right.saturating_add(1).min(width as u16)];
        let row = width as usize;
        let (count, next) = ((bottom - top) as usize, (bottom + 1).min(height));
        // The row that is held comes first, and a row below the band is held next. A buffer of one row holds one after the other.
        let is_single = count == 1 && pixels.len() < 2 * row;
        let is_held = self.smoother.held == Some(top);
        let drawn = if is_held || is_single { top + 1 } else { top };
        if !is_held {
            for first in top.saturating_sub(1)..drawn {
                let pixels = pixels.get_mut(..row).unwrap_or_default();
                self.draw_over(context, colours, pixels, under, columns, [first, first + 1], (first + 1 - top) as usize);
                let Kept { above, held, .. } = kept::<C::Stored>(self.smoother.colours, row);
                keep(if first < top { above } else { held }, pixels, 1);
            }
        }
        let fresh = pixels.get_mut(if is_single { 0 } else { (drawn - top) as usize * row }..).unwrap_or_default();
        let fresh = fresh.get_mut(..(next - drawn) as usize * row).unwrap_or_default();
        if !fresh.is_empty() {
            self.draw_over(context, colours, fresh, under, columns, [drawn, next], (drawn + 1 - top) as usize);
        }
        let Kept { held, .. } = kept::<C::Stored>(self.smoother.colours, row);
        let is_last = next == bottom;
        if drawn > top {
            for (pixel, held) in pixels.iter_mut().zip(held.iter_mut()) {
                let below = pixel.stored();
                *pixel = C::from_stored(*held);
                if is_single && !is_last {
                    *held = below;
                }
            }
        }
        if !is_single && !is_last {
            keep(held, pixels, count + 1);
        }
        let pixels = pixels.get_mut(..count * row).unwrap_or_default();
        // The depth buffer begins with the row above the band.
        let reached = self.rows.start.max(top.saturating_sub(1))..self.rows.end.min(next);
        let known = if reached.start >= reached.end { top..top } else { reached };
        let start = (known.start + 1 - top) as usize * row;
        let depth = self.depth.get(start..start + (known.end - known.start) as usize * row).unwrap_or_default();
        let band = SmoothedBand { width: row, rows: top..bottom, known, depth };
        self.smoother.smooth(context, pixels, &band, colours.settings.output.gamma);
        self.smoother.held = Some(bottom);
        // The depth of the last row and of the one below it comes first in the next band.
        for at in [0, row] {
            if let Some((first, last)) = self.depth.split_at_mut_checked(at + count * row).filter(|_| !is_last)
                && let (Some(to), Some(from)) = (first.get_mut(at..at + row), last.get(..row))
            {
                to.copy_from_slice(from);
            }
        }
    }

    /// Finds the edges that are smoothed, or drawn as lines.
    #[inline(never)]
    pub(crate) fn find_edges(&mut self, context: &Context<'_>) {
        let Self { bins, entries, depth, smoother, rows, stats, .. } = self;
        let hull = context.settings.touched(&context.region.hull());
        // An edge changes pixels beside those of triangles, and a line also rows in which no triangle has a pixel.
        let reach = rows.start.saturating_sub(1)..rows.end.saturating_add(1).min(context.settings.size.height);
        *rows = if rows.start >= rows.end { rows.clone() } else { reach };
        let lines = context.settings.outlines.is_some();
        let within = |row: u32| row.max(hull.rows[0].into()).min(hull.rows[1].into()) as u16;
        let area = if lines { hull } else { PixelRect { rows: [within(rows.start), within(rows.end)], ..hull } };
        let put: &mut dyn FnMut(&FeatureEdge) = &mut |edge| smoother.put(edge, &area);
        let mut rest = bins.count().and_then(|count| entries.get(..count.into())).unwrap_or_default();
        let mut complete = bins.count().is_some();
        for placed in context.meshes().rev() {
            let Some(outlined) = context.outlined(&placed) else { continue };
            let words = placed.mesh.triangles.div_ceil(32) as usize;
            let faces = <[u32]>::mut_from_prefix_with_elems(depth.as_mut_bytes(), words).map_or(&mut [][..], |(faces, _)| faces);
            faces.fill(0);
            // The list begins with the entries of this mesh.
            let count = find::collect(faces, rest, placed.first_triangle, placed.mesh.triangles);
            let (own, others) = (rest.get(..count).unwrap_or_default(), rest.get(count..).unwrap_or_default());
            rest = others;
            if faces.len() == words {
                outlined.outlines(own, placed.first_triangle, faces, put);
            } else {
                complete = false;
            }
        }
        context.each_cut(put);
        stats.edges = smoother.close(complete);
        if lines {
            let of_lines = smoother.rows().unwrap_or_else(|| hull.rows());
            *rows = if rows.start >= rows.end { of_lines } else { rows.start.min(of_lines.start)..rows.end.max(of_lines.end) };
        }
    }

    /// Draws all triangles in the band from row `top` to row `bottom`, whose pixels hold the background. Only these `columns` are needed. The depth of
    /// the band begins with pixel `from` of the depth buffer.
    #[inline(never)]
    fn draw<C: Pixel>(
        &mut self,
        context: &Context<'_>,
        colours: &Colours<'_, C>,
        pixels: &mut [C],
        columns: [u16; 2],
        [top, bottom]: [u32; 2],
        from: usize,
    ) {
        let (width, rows) = (context.settings.size.width as usize, bottom - top);
        let count = width * rows as usize;
        // Whether all triangles found room in the lists.
        let is_binned = self.bins.count().is_some();
        if is_binned && (bottom <= self.rows.start || self.rows.end <= top) {
            // No triangle has a pixel there, and the depth is unknown.
            self.drawn = bottom;
            return;
        }
        if top > self.drawn {
            // What has been saved stands on a row that is left out.
            self.queue = QueueState::default();
        }
        let active = ActiveTriangles::new(self.active_triangles, self.queue);
        let depth = self.depth.get_mut(from..from + count).unwrap_or_default();
        let mut band =
            Band { pixels, depth, width, top: top as i32, rows: rows as i32, active, counts: Counts::default(), sheet: Default::default() };
        band.clear(self.rows.clone());
        // Decision: lists.
        let (pixels, drawn) = if is_binned {
            self.bins.skip(self.entries, top);
            let mut walk = self.bins.band(self.entries, bottom);
            let pixels = draw_binned(context, colours, &mut walk, columns, &mut band);
            self.bins.take_over(walk);
            (pixels, 0)
        } else {
            self.stats.passes += 1;
            draw_all(context, colours, columns, &mut band)
        };
        self.stats.pixels = self.stats.pixels.saturating_add(pixels);
        self.stats.drawn += drawn;
        self.stats.counts = self.stats.counts.and(band.counts);
        self.queue = band.active.queue;
        self.stats.set_up_anew = self.stats.set_up_anew.saturating_add(band.active.overflow);
        self.drawn = bottom;
    }
}

/// Moves these `columns` of rows that are `width` pixels wide to the front of a band.
#[cold]
fn narrow<C: Copy>(pixels: &mut [C], width: usize, columns: Range<usize>) {
    let count = columns.len();
    for row in 0..pixels.len().checked_div(width).unwrap_or(0) {
        let (to, from) = (row * count, row * width + columns.start);
        // Up to where they are now, so that nothing moves to where another pixel waits to be moved.
        if let Some(pixels) = pixels.get_mut(to..from + count)
            && let Some(from) = pixels.len().checked_sub(count)
        {
            pixels.copy_within(from.., 0);
        }
    }
}

/// Draws the triangles of `band`, and returns the number of their pixels there.
fn draw_binned<C: Pixel>(
    context: &Context<'_>,
    colours: &Colours<'_, C>,
    walk: &mut Walk<'_>,
    columns: [u16; 2],
    band: &mut Band<'_, C>,
) -> u32 {
    let mut pixels = 0u32;
    let mut next = walk.next();
    while let Some(key) = next {
        // A scene has both.
        let Some(placed) = context.mesh(key.triangle()) else { break };
        // Decision: hidden object.
        if context.hides(placed.placement, columns, band.range(), band.depth) {
            next = leave_out(&placed, key, walk, &mut band.active, &mut band.counts);
            continue;
        }
        let Some((drawing, loops)) = colours.drawing(context, &placed, columns) else { break };
        band.sheet.iter_mut().for_each(|sheet| sheet.glass = drawing.glass(placed.mesh));
        let (drawn, rest) = (loops.run)(&drawing, key, walk, band);
        pixels = pixels.saturating_add(drawn);
        next = rest;
    }
    pixels
}

/// Leaves out the triangle `key` and all that follow in the same mesh; returns the first one of another.
#[inline(never)]
fn leave_out(
    placed: &PlacedMesh<'_>,
    key: TriangleKey,
    walk: &mut Walk<'_>,
    active: &mut ActiveTriangles<'_>,
    counts: &mut Counts,
) -> Option<TriangleKey> {
    let mut next = Some(key);
    while let Some(key) = next.filter(|key| placed.has(key.triangle())) {
        if SKIPS {
            counts.hidden += 1;
        }
        // What the band above has saved of it stands on the first row of this band: no later band may go on from there.
        let _ = active.take(key.word());
        next = walk.next();
    }
    next
}

/// Draws all triangles into `band`. Returns the number of their pixels there, and the number of triangles that start there.
#[cold]
#[inline(never)]
fn draw_all<C: Pixel>(context: &Context<'_>, colours: &Colours<'_, C>, columns: [u16; 2], band: &mut Band<'_, C>) -> (u32, u32) {
    let (mut pixels, mut drawn) = (0u32, 0);
    for placed in context.meshes() {
        let Some((drawing, loops)) = colours.drawing(context, &placed, columns) else { continue };
        band.sheet.iter_mut().for_each(|sheet| sheet.glass = drawing.glass(placed.mesh));
        for triangle in drawing.pass.triangles.iter().filter(|triangle| placed.placement.facing.may_face(triangle)) {
            let Some(bounds) = drawing.pass.bounds(triangle) else { continue };
            // A triangle is counted in the band where it starts.
            let bottom = band.top + band.rows;
            drawn += u32::from((band.top..bottom).contains(&bounds.top));
            if bounds.bottom > band.top && bounds.top < bottom {
                pixels = pixels.saturating_add((loops.draw)(&drawing, triangle, band));
            }
        }
    }
    (pixels, drawn)
}
