//! One triangle into one band: edges, depth plane, and the rows between them.

use crate::{
    arch::product::HALVES,
    format::{DEPTH, DEPTH_NODE, DEPTH_WALK},
    geometry::projection::ScreenVertex,
    interpolate::{Constant, Patch, Walker, plane::Plane},
    raster::{
        active::{ActiveTriangle, ActiveTriangles},
        band::Band,
        canvas::{Canvas, SpanShader},
        pixel_shader::PixelShader,
        span::{DepthTest, fill},
    },
    setup::{
        edge::{COLUMN, COLUMNS},
        edge_walker::{EdgeState, EdgeWalker, LeftRight},
        gradients::Gradients,
    },
};
use core::hint::black_box;

/// A triangle on the screen, its top corner first, clockwise on a screen whose y runs down.
#[derive(Clone, Copy, Debug)]
pub struct ScreenTriangle {
    /// `[x, y]`, 1/16 pixel.
    pub corners: [[i32; 2]; 3],
    pub(crate) depth: [i32; 3],
    /// Which of the mesh's corners is the top one.
    pub turned: usize,
    /// Its rows in a band; without antialiasing.
    rows: RowRange,
}

/// A triangle's way through the rows of a band.
#[derive(Clone, Copy, Debug)]
struct RowRange {
    sides: EdgeWalker,
    /// Standing on the first row, if it is known already.
    inv_depth: Option<Plane<1>>,
    /// For [`ActiveTriangles`]; 0: it is not handed on.
    key: u32,
    /// By the band above: patches stand on the first row already.
    resumed: bool,
}

impl RowRange {
    #[inline(always)]
    const fn of(sides: EdgeWalker, key: u32) -> Self {
        Self { sides, inv_depth: None, key, resumed: false }
    }
}

/// What steps from row to row.
pub(crate) struct Rows<'b, D, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>> {
    /// Pixels and inverse depth of the band, as many of each in a row as it is wide.
    pub(crate) pixels: &'b mut [T::Pixel],
    pub(crate) buffer: &'b mut [u16],
    pub(crate) width: usize,
    /// Where the coming row starts in them.
    pub(crate) start: usize,
    pub(crate) sides: LeftRight,
    /// Pixels of the coming row.
    pub(crate) count: u32,
    /// Rows to come.
    pub(crate) height: u32,
    /// Pixels of the rows that are done.
    pub(crate) filled: u32,
    /// Depth at column 0, unless nothing is hidden.
    pub(crate) depth: D,
    pub(crate) patch: P,
    pub(crate) shader: T,
}

/// All bits of the number of pixels in a row.
const ROW: u32 = 2 * COLUMNS - 1;

impl ScreenTriangle {
    /// None at all.
    pub(crate) const NONE: Self = Self { corners: [[0; 2]; 3], depth: [0; 3], turned: 0, rows: RowRange::of(EdgeWalker::NONE, 0) };

    /// Turns the corners until the top one is first; the order around the triangle stays.
    #[inline(never)]
    #[must_use]
    pub fn new(corners: [&ScreenVertex; 3], [width, top, bottom]: [i32; 3]) -> Self {
        let (turned, corners) = turned(corners);
        let places = places(corners);
        let sides = EdgeWalker::new(places, [top, bottom], width);
        Self { corners: places, depth: depths(corners), turned, rows: RowRange::of(sides, 0) }
    }

    /// The same without antialiasing, of a triangle that has been [`turned`] and whose sides can be walked from end to end.
    #[inline(always)]
    #[must_use]
    pub(crate) fn word_sized<C>((turned, corners): (usize, [&ScreenVertex; 3]), key: u32, band: &Band<'_, C>) -> Self {
        let places = places(corners);
        let sides = EdgeWalker::end_to_end(places, band.range());
        Self { corners: places, depth: depths(corners), turned, rows: RowRange::of(sides, key) }
    }

    /// Of one that the band above handed on: nothing else is known of it.
    #[inline(always)]
    #[must_use]
    pub(crate) fn resumed<C>(active_triangle: &ActiveTriangle, turned: usize, band: &Band<'_, C>) -> Self {
        let rows = RowRange {
            sides: active_triangle.edges.walker(band.range()),
            inv_depth: active_triangle.inv_depth(),
            key: active_triangle.key,
            resumed: true,
        };
        Self { corners: [[0; 2]; 3], depth: [0; 3], turned, rows }
    }

    /// No row lies in the band.
    #[inline(always)]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.sides.row >= self.rows.sides.end
    }

    /// No pixel's centre lies in it, among the rows of the band, which is `width` columns wide.
    #[must_use]
    pub(crate) fn covers_nothing(&self, width: i32) -> bool {
        let sides = &self.rows.sides;
        let (mut row, mut stop, mut pair) = (sides.row, sides.stop, sides.pair);
        loop {
            while row < stop {
                if pair.columns() > 0 {
                    return false;
                }
                pair.skip(1);
                row += 1;
            }
            if stop >= sides.end {
                return true;
            }
            stop = sides.next(row, &mut pair, self.corners, width);
        }
    }

    /// Works out depth, unless that is left to those who need it.
    #[inline(always)]
    pub(crate) fn set_up_depth(&mut self, gradients: &Gradients) {
        self.rows.inv_depth = Some(self.plane(gradients, self.rows.sides.row));
    }

    /// Draws the rows that lie in `band` and returns how many pixels they have.
    #[inline(always)]
    pub fn draw<P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
        &self,
        gradients: &Gradients,
        patch: P,
        shader: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let inv_depth = match self.rows.inv_depth {
            Some(inv_depth) => inv_depth,
            None => self.late_plane(*gradients),
        };
        self.walk(gradients, inv_depth, patch, shader, band)
    }

    /// As [`Self::draw`], without depth: where nothing else is.
    #[inline(always)]
    pub fn draw_alone<P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
        &self,
        gradients: &Gradients,
        patch: P,
        shader: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        self.walk(gradients, Constant, patch, shader, band)
    }

    /// Of one whose rows are not walked: it is drawn by areas.
    #[inline(never)]
    #[must_use]
    pub fn without_rows(corners: [&ScreenVertex; 3]) -> Self {
        let (turned, corners) = turned(corners);
        Self { corners: places(corners), depth: depths(corners), turned, rows: RowRange::of(EdgeWalker::NONE, 0) }
    }

    /// Draws the rows that lie in `canvas` the general way and returns how many pixels they have; `shader` stands on the anchor's row.
    #[inline(never)]
    pub fn draw_spans(&self, gradients: &Gradients, shader: &mut dyn SpanShader, canvas: &mut dyn Canvas) -> u32 {
        let sides = &self.rows.sides;
        let (mut row, mut stop, mut pair) = (sides.row, sides.stop, sides.pair);
        let mut depth = self.plane(gradients, row);
        shader.jump(row.wrapping_sub(gradients.row()));
        let [width, ..] = canvas.bounds();
        let mut pixels = 0u32;
        loop {
            while row < stop {
                let (end, count) = ((pair.right.x >> COLUMN) as i32, pair.columns());
                if count > 0 {
                    canvas.draw_row(row, end, count as usize, depth.enter(end), shader);
                    pixels = pixels.wrapping_add(count);
                }
                pair.skip(1);
                depth.step_row();
                shader.step_row();
                row += 1;
            }
            if stop >= sides.end {
                return pixels;
            }
            stop = sides.next(row, &mut pair, self.corners, width);
        }
    }

    /// Walks down its sides; `depth` stands on the first row.
    #[inline(always)]
    fn walk<D: Patch<Walker: DepthTest>, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
        &self,
        gradients: &Gradients,
        depth: D,
        patch: P,
        shader: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let sides = &self.rows.sides;
        let (mut row, mut stop) = (sides.row, sides.stop);
        let mut rows = Rows::new(band, row, sides.pair, depth, patch, shader);
        if !self.rows.resumed && row != gradients.row() {
            rows.patch.jump(row.wrapping_sub(gradients.row()));
        }
        loop {
            if row < stop {
                rows.height = stop.wrapping_sub(row) as u32;
                rows.count = rows.sides.columns();
                fill_rows(&mut rows);
            }
            if stop >= sides.end {
                break;
            }
            row = stop;
            stop = sides.next(row, &mut rows.sides, self.corners, rows.width as i32);
        }
        let filled = rows.filled;
        if self.rows.key != 0 && sides.goes_on() {
            let Rows { sides: pair, depth, patch, .. } = rows;
            save_active((self.rows.key, sides.state(pair, T::ID)), &depth, &patch, &mut band.active);
        }
        filled
    }

    #[cold]
    #[inline(never)]
    fn late_plane(self, gradients: Gradients) -> Plane<1> {
        self.plane(&gradients, self.rows.sides.row)
    }

    /// Depth, standing on `row`.
    #[inline(always)]
    pub fn plane(&self, gradients: &Gradients, row: i32) -> Plane<1> {
        let [a, b, c] = self.depth;
        let node = |depth: i32| (depth + (1 << (DEPTH - DEPTH_NODE - 1))) >> (DEPTH - DEPTH_NODE);
        let mut depth = Plane::fit::<DEPTH_NODE>(gradients, [[node(a), node(b), node(c)]], 16 + DEPTH_WALK - DEPTH_NODE);
        depth.jump(row.wrapping_sub(gradients.row()));
        depth
    }
}

/// How many places on the top corner is, and the corners from there on.
#[inline(always)]
#[must_use]
pub(crate) fn turned(corners: [&ScreenVertex; 3]) -> (usize, [&ScreenVertex; 3]) {
    let [a, b, c] = corners;
    let by = if b.y < a.y || c.y < a.y { if c.y < b.y { 2 } else { 1 } } else { 0 };
    (by, turn(corners, by))
}

#[inline(always)]
fn places([a, b, c]: [&ScreenVertex; 3]) -> [[i32; 2]; 3] {
    [[a.x, a.y], [b.x, b.y], [c.x, c.y]]
}

#[inline(always)]
fn depths([a, b, c]: [&ScreenVertex; 3]) -> [i32; 3] {
    [a.depth, b.depth, c.depth]
}

/// The three of them, `by` places on.
#[inline(always)]
#[must_use]
pub fn turn<A: Copy>([a, b, c]: [A; 3], by: usize) -> [A; 3] {
    match by {
        0 => [a, b, c],
        1 => [b, c, a],
        _ => [c, a, b],
    }
}

/// Hands a triangle on to the next band, walked to its first row there.
#[inline(never)]
fn save_active<D: Patch, P: Patch>((key, edges): (u32, EdgeState), depth: &D, patch: &P, active: &mut ActiveTriangles<'_>) {
    active.put(|active_triangle| active_triangle.save((key, edges), depth, patch));
}

/// Fills the rows to come; there is at least one.
///
/// On Armv7-M all that lives longer than a row stays in memory, behind one pointer that the compiler knows nothing of: measured, the
/// pixel loop then owns the registers and comes out as by hand. `count` comes from there too, written a row earlier: derived in the row,
/// the compiler would count in two registers instead of one. Where registers are few or many, or nothing is walked, a copy on the stack
/// is shorter.
#[inline(never)]
pub(crate) fn fill_rows<D: Patch<Walker: DepthTest>, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
    mut rows: &mut Rows<'_, D, P, T>,
) {
    if Rows::<D, P, T>::LOCAL {
        rows.fill_here();
        return;
    }
    loop {
        rows = black_box(rows);
        rows.fill();
        rows.step();
        rows.height = rows.height.wrapping_sub(1);
        if rows.height == 0 {
            return;
        }
    }
}

impl<'b, D: Patch<Walker: DepthTest>, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>> Rows<'b, D, P, T> {
    /// Whether rows are filled in a copy, see [`fill_rows`].
    const LOCAL: bool = HALVES || cfg!(not(target_arch = "arm")) || size_of::<P>() == 0;

    /// Whether pixels are counted a row ahead there, so that what is counted need not wait for the pixel loop.
    const AHEAD: bool = Self::LOCAL && cfg!(target_arch = "arm") && P::WORDS <= 6;

    /// No rows yet, from `row` of the band on.
    #[inline(always)]
    pub(crate) fn new(band: &'b mut Band<'_, T::Pixel>, row: i32, sides: LeftRight, depth: D, patch: P, shader: T) -> Self {
        let (width, start) = (band.width, band.start(row));
        Self { pixels: band.pixels, buffer: band.depth, width, start, sides, count: 0, height: 0, filled: 0, depth, patch, shader }
    }

    /// Fills one row; its sides step to the next.
    #[inline(always)]
    fn fill(&mut self) {
        // On Armv6-M one register is to count and to index two buffers: the compiler has to know that twice the number is no overflow.
        let count = if HALVES { self.count & ROW } else { self.count } as usize;
        // Measured: loops that leave no register free are shorter if pixels are counted behind them.
        let late = !HALVES && P::WORDS > 6;
        if !Self::AHEAD && !late {
            self.filled = self.filled.wrapping_add(self.count);
        }
        let (left, right) = ((self.sides.left.x >> COLUMN) as usize, self.sides.right.x >> COLUMN);
        self.sides.skip(1);
        self.count = self.sides.columns();
        let start = self.start.wrapping_add(left);
        let end = start.wrapping_add(count);
        self.start = self.start.wrapping_add(self.width);
        if count > 0
            && let Some(pixels) = self.pixels.get_mut(start..end)
            && let Some(buffer) = D::Walker::depth(self.buffer, start..end)
        {
            fill(pixels, buffer, self.depth.enter(right as i32), self.patch.enter(right as i32), self.shader);
            if !Self::AHEAD && late {
                self.filled = self.filled.wrapping_add(count as u32);
            }
        }
    }

    /// Fills them in a copy that is nobody else's.
    #[inline(always)]
    fn fill_here(&mut self) {
        let Rows { width, start, sides, count, height, filled, depth, patch, shader, .. } = *self;
        let (pixels, buffer) = (&mut *self.pixels, &mut *self.buffer);
        let mut rows = Rows { pixels, buffer, width, start, sides, count, height, filled, depth, patch, shader };
        let ahead = |count: u32| if Self::AHEAD { count } else { 0 };
        rows.filled = rows.filled.wrapping_add(ahead(rows.count));
        loop {
            // Not to be counted in two registers.
            if !HALVES && cfg!(target_arch = "arm") {
                rows.count = black_box(rows.count);
            }
            rows.fill();
            rows.step();
            rows.filled = rows.filled.wrapping_add(ahead(rows.count));
            rows.height = rows.height.wrapping_sub(1);
            if rows.height == 0 {
                break;
            }
        }
        // Without that of the row behind the last.
        self.filled = rows.filled.wrapping_sub(ahead(rows.count));
        let Rows { start, sides, depth, patch, shader, .. } = rows;
        (self.start, self.sides, self.depth, self.patch, self.shader) = (start, sides, depth, patch, shader);
    }

    /// Steps to the next row.
    #[inline(always)]
    fn step(&mut self) {
        self.depth.step_row();
        self.patch.step_row();
    }
}
