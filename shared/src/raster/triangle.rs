//! Drawing of one triangle into one band: edges, plane of depth, and the rows between the edges.

use crate::{
    arch::product::HALVES,
    format::{DEPTH, DEPTH_NODE, DEPTH_WALK, SUBPIXEL},
    geometry::projection::ScreenVertex,
    interpolate::{Constant, Patch, Walker, plane::Plane},
    pixel::Pixel,
    raster::{
        active::{ActiveTriangle, ActiveTriangles},
        band::Band,
        canvas::{Canvas, SpanShader},
        glass::{Behind, RunFiller, Sheet},
        pixel_shader::PixelShader,
        span::{DepthTest, fill},
    },
    setup::{
        edge::{COLUMN, COLUMNS, MAX_STEPPED_HEIGHT},
        edge_walker::{EdgeState, EdgeWalker, LeftRight},
        gradients::Gradients,
    },
};
use core::hint::black_box;
use microphong_kernels as kernels;
use zerocopy::transmute_mut;

/// A triangle on the screen.
#[derive(Clone, Copy, Debug)]
pub struct ScreenTriangle<'f> {
    corners: [&'f ScreenVertex; 3],
    /// The rows of the triangle in a band.
    rows: RowRange,
}

/// The rows of a triangle in a band, from its first one on.
#[derive(Clone, Copy, Debug)]
struct RowRange {
    sides: EdgeWalker,
    /// The plane of depth on the first row, if it is known.
    inv_depth: Option<Plane<1>>,
    /// The key among [`ActiveTriangles`]; 0 if the triangle is not saved for the next band.
    key: u32,
    /// 1 if the band above has saved the triangle, so that patches stand on the first row already. A word: behind a byte the compiler copies
    /// padding, and the corners with it, byte by byte.
    resumed: u32,
}

impl RowRange {
    #[inline]
    const fn of(sides: EdgeWalker, key: u32) -> Self {
        Self { sides, inv_depth: None, key, resumed: 0 }
    }
}

/// The state that steps from row to row.
pub(crate) struct Rows<'b, D, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>> {
    /// Pixels and depth buffer of the band, `width` of each in a row, or the room for a run, see [`RunFiller`].
    pub(crate) pixels: &'b mut [T::Pixel],
    pub(crate) buffer: &'b mut [u16],
    pub(crate) width: usize,
    /// Index of the first pixel of the coming row.
    pub(crate) start: usize,
    pub(crate) sides: LeftRight,
    /// Pixels of the coming row.
    pub(crate) count: u32,
    /// Rows to come.
    pub(crate) height: u32,
    /// Pixels of the rows that are done.
    pub(crate) filled: u32,
    /// The plane of depth, or [`Constant`] without a depth test.
    pub(crate) depth: D,
    pub(crate) patch: P,
    pub(crate) shader: T,
}

const _: () = {
    // Sides of pictures are shorter.
    assert!(COLUMNS as usize == kernels::MAX_WIDTH + 1 && COLUMNS == kernels::MAX_FIRST + 1);
    assert!(MAX_STEPPED_HEIGHT >> SUBPIXEL < kernels::MAX_HEIGHT as i32);
};

/// Whether a kernel walks the fields that a patch has.
const fn is_same(kernel: Option<[usize; 2]>, patch: Option<[usize; 2]>) -> bool {
    matches!((kernel, patch), (Some([planes, quadratics]), Some([p, q])) if planes == p && quadratics == q)
}

/// All bits of the number of pixels in a row.
const ROW: u32 = 2 * COLUMNS - 1;

impl<'f> ScreenTriangle<'f> {
    /// No triangle.
    pub(crate) const NONE: Self = Self { corners: [&ScreenVertex::IDLE; 3], rows: RowRange::of(EdgeWalker::NONE, 0) };

    /// A triangle whose corners have been [`turned`]. Pixels outside of these `columns` and `rows` are not drawn. If edges are stepped from end to
    /// end, these have to be the band's.
    #[inline(never)]
    pub fn new(corners: [&'f ScreenVertex; 3], columns: [i32; 2], rows: [i32; 2]) -> Self {
        Self { corners, rows: RowRange::of(EdgeWalker::new(places(corners), rows, columns), 0) }
    }

    /// A word-sized triangle that has been [`turned`]: its edges can be stepped from end to end.
    #[inline(always)]
    pub(crate) fn word_sized<C>(corners: [&'f ScreenVertex; 3], key: u32, band: &Band<'_, C>) -> Self {
        Self { corners, rows: RowRange::of(EdgeWalker::end_to_end(places(corners), band.range()), key) }
    }

    /// A triangle that the band above has saved.
    #[inline(always)]
    pub(crate) fn resumed<C>(active_triangle: &ActiveTriangle, corners: [&'f ScreenVertex; 3], band: &Band<'_, C>) -> Self {
        let rows = RowRange {
            sides: active_triangle.edges.walker(band.range()),
            inv_depth: active_triangle.inv_depth(),
            key: active_triangle.key,
            resumed: 1,
        };
        Self { corners, rows }
    }

    /// `[x, y]` of the corners in 1/16 pixel, the top one first, clockwise on a screen whose y runs down.
    #[inline(always)]
    pub fn corners(&self) -> [[i32; 2]; 3] {
        places(self.corners)
    }

    /// Whether no row lies in the band.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.rows.sides.row >= self.rows.sides.end
    }

    /// Whether the triangle contains no centre of a pixel in the rows of the band.
    pub(crate) fn covers_nothing(&self) -> bool {
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
            stop = self.next(row, &mut pair);
        }
    }

    /// Computes the plane of depth now; otherwise it is computed when the triangle is drawn.
    #[inline(always)]
    pub(crate) fn set_up_depth(&mut self, gradients: &Gradients) {
        self.rows.inv_depth = Some(self.fit_depth(gradients, self.rows.sides.row));
    }

    /// Draws the triangle's rows in `band`. Returns the number of its pixels there.
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

    /// Draws the triangle's rows in `band` without a depth test, because no other triangle overlaps it. Returns the number of its pixels there.
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

    /// Draws the triangle's rows in `canvas` by the general loop. Returns the number of its pixels there. `shader` stands on the anchor's row.
    #[inline(never)]
    pub fn draw_spans(&self, gradients: &Gradients, shader: &mut dyn SpanShader, canvas: &mut dyn Canvas) -> u32 {
        let sides = &self.rows.sides;
        let (mut row, mut stop, mut pair) = (sides.row, sides.stop, sides.pair);
        let mut depth = self.plane(gradients, row);
        shader.jump(row.wrapping_sub(gradients.row()));
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
            stop = self.next(row, &mut pair);
        }
    }

    /// Continues with the rows from `row`, to which `pair` has been stepped; returns one past the last row to which it can be stepped now.
    #[inline(always)]
    fn next(&self, row: i32, pair: &mut LeftRight) -> i32 {
        self.rows.sides.next(pair).unwrap_or_else(|| self.anew(row, pair))
    }

    #[cold]
    #[inline(never)]
    fn anew(&self, row: i32, pair: &mut LeftRight) -> i32 {
        self.rows.sides.anew(row, pair, self.corners())
    }

    /// Draws row by row down the edges; `depth` stands on the first row.
    #[inline(always)]
    fn walk<D: Patch<Walker: DepthTest>, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
        &self,
        gradients: &Gradients,
        depth: D,
        patch: P,
        shader: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        if T::TRANSPARENT && band.is_transparent() {
            return self.walk_glass(gradients, depth, patch, shader, band);
        }
        if const { is_same(T::KERNEL, P::FIELDS) && (T::ALONE || D::WORDS > 0) } {
            return self.walk_by_kernel(gradients, depth, patch, shader, band);
        }
        let sides = &self.rows.sides;
        let (mut row, mut stop) = (sides.row, sides.stop);
        let mut rows = Rows::new(band, row, sides.pair, depth, patch, shader);
        if self.rows.resumed == 0 && row != gradients.row() {
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
            stop = self.next(row, &mut rows.sides);
        }
        let filled = rows.filled;
        if self.is_saved::<P>() {
            let Rows { sides: pair, depth, patch, .. } = rows;
            self.save(pair, &depth, &patch, T::ID, band);
        }
        filled
    }

    /// [`Self::walk`] of a transparent surface.
    #[inline(never)]
    fn walk_glass<D: Patch<Walker: DepthTest>, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
        &self,
        gradients: &Gradients,
        depth: D,
        patch: P,
        shader: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let (start, width, sides) = (band.start(self.rows.sides.row), band.width, self.rows.sides.pair);
        let Some(Sheet { glass: Some(glass), pixels, depth: buffer }) = band.sheet.first_mut() else { return 0 };
        let mut rows = Rows { pixels, buffer, width: 0, start: 0, sides, count: 0, height: 0, filled: 0, depth, patch, shader };
        let depth = if D::WORDS > 0 { Some(&*band.depth) } else { None };
        self.fill_glass(
            gradients,
            &mut rows,
            &mut Behind { glass: *glass, pixels: band.pixels, depth, start, width, active: &mut band.active },
        )
    }

    /// Draws the rows of a transparent surface. The depth stands on the first row, and the polynomial of a triangle that is not resumed on the anchor's.
    #[inline(never)]
    fn fill_glass<C: Pixel>(&self, gradients: &Gradients, surface: &mut dyn RunFiller<C>, behind: &mut Behind<'_, '_, C>) -> u32 {
        let RowRange { sides, key, resumed, .. } = &self.rows;
        let (mut row, mut stop, mut pair, mut filled) = (sides.row, sides.stop, sides.pair, 0u32);
        surface.start_at(row, if *resumed == 0 { row.wrapping_sub(gradients.row()) } else { 0 });
        loop {
            while row < stop {
                behind.cover(surface, pair);
                filled = filled.wrapping_add(pair.columns());
                pair.skip(1);
                row += 1;
            }
            if stop >= sides.end {
                break;
            }
            stop = self.next(row, &mut pair);
        }
        if *key != 0 && sides.goes_on() {
            surface.save((*key, sides), pair, behind.active);
        }
        filled
    }

    /// [`Self::walk`] by a kernel in assembler.
    #[inline(always)]
    fn walk_by_kernel<D: Patch, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
        &self,
        gradients: &Gradients,
        mut depth: D,
        mut patch: P,
        mut shader: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let row = self.rows.sides.row;
        if self.rows.resumed == 0 && row != gradients.row() {
            patch.jump(row.wrapping_sub(gradients.row()));
        }
        shader.start_at(row);
        if !const { matches!(T::KERNEL, Some([_, quadratics]) if quadratics > 0) } {
            return self.fill_and_save(&mut depth, &mut patch, shader, band);
        }
        let mut fields = kernels::Fields::default();
        patch.lend(&mut fields);
        let (Some(lit), Some(plane)) = (shader.lit(), depth.planes().first_mut()) else { return 0 };
        let mut pair = self.rows.sides.pair;
        let filled = self.fill_lit(&mut pair, plane, &mut fields, &lit, band);
        if self.is_saved::<P>() {
            self.save(pair, &depth, &patch, T::ID, band);
        }
        filled
    }

    /// Fills rows by a kernel, and saves the triangle if it goes on.
    #[inline(never)]
    fn fill_and_save<D: Patch, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
        &self,
        depth: &mut D,
        patch: &mut P,
        shader: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let sides = &self.rows.sides;
        let mut pair = sides.pair;
        // The first case is the usual one. It has no closure, because the compiler would keep the state of a closure in memory.
        let filled = match sides.below() {
            Some(turn) => {
                let (pixels, rows) = part([sides.row, sides.stop], &mut pair, turn, band);
                shader.fill(pixels, rows, depth.planes(), patch).unwrap_or(0)
            }
            None => self.fill_parts(&mut pair, band, &mut |pixels, rows, is_odd| {
                let mut shader = shader;
                if is_odd {
                    shader.step_row();
                }
                shader.fill(pixels, rows, depth.planes(), patch).unwrap_or(0)
            }),
        };
        if self.is_saved::<P>() {
            self.save(pair, depth, patch, T::ID, band);
        }
        filled
    }

    /// Fills rows by a kernel that computes light at each pixel. All methods and numbers of lights share this code.
    #[inline(never)]
    fn fill_lit<C: Pixel>(
        &self,
        pair: &mut LeftRight,
        depth: &mut kernels::Plane,
        fields: &mut kernels::Fields<'_>,
        lit: &kernels::Lit<'_>,
        band: &mut Band<'_, C>,
    ) -> u32 {
        let sides = &self.rows.sides;
        match sides.below() {
            Some(turn) => {
                let (pixels, rows) = part([sides.row, sides.stop], pair, turn, band);
                C::fill_lit(pixels, rows, depth, fields, lit).unwrap_or(0)
            }
            None => self.fill_parts(pair, band, &mut |pixels, rows, is_odd| {
                C::fill_lit(pixels, rows, depth, fields, &if is_odd { lit.from_second_row() } else { *lit }).unwrap_or(0)
            }),
        }
    }

    /// Whether the triangle goes on in the next band, and there is room for its polynomial.
    #[inline(always)]
    fn is_saved<P: Patch>(&self) -> bool {
        P::WORDS <= ActiveTriangle::WORDS && self.rows.key != 0 && self.rows.sides.goes_on()
    }

    /// Saves the triangle for the next band.
    #[inline(always)]
    fn save<D: Patch, P: Patch, C>(&self, pair: LeftRight, depth: &D, patch: &P, shader: u8, band: &mut Band<'_, C>) {
        save_active((self.rows.key, self.rows.sides.state(pair, shader)), depth, patch, &mut band.active);
    }

    /// Fills the rows of a triangle by a kernel part by part, because sides are computed again for some rows. The last argument of `fill` is true if an
    /// odd number of rows lies above the part.
    #[cold]
    #[inline(never)]
    fn fill_parts<C: Pixel>(
        &self,
        pair: &mut LeftRight,
        band: &mut Band<'_, C>,
        fill: &mut dyn FnMut(&mut [C], kernels::Rows<'_>, bool) -> u32,
    ) -> u32 {
        let sides = &self.rows.sides;
        let (mut row, mut stop, mut filled) = (sides.row, sides.stop, 0u32);
        loop {
            let (pixels, rows) = part([row, stop], pair, kernels::Turn::default(), band);
            filled = filled.wrapping_add(fill(pixels, rows, row.wrapping_sub(sides.row) & 1 != 0));
            if stop >= sides.end {
                return filled;
            }
            row = stop;
            stop = self.next(row, pair);
        }
    }

    #[cold]
    #[inline(never)]
    fn late_plane(self, gradients: Gradients) -> Plane<1> {
        self.plane(&gradients, self.rows.sides.row)
    }

    /// The plane of depth, standing on `row`.
    #[inline(never)]
    pub fn plane(&self, gradients: &Gradients, row: i32) -> Plane<1> {
        self.fit_depth(gradients, row)
    }

    #[inline(always)]
    fn fit_depth(&self, gradients: &Gradients, row: i32) -> Plane<1> {
        let [a, b, c] = self.corners;
        let node = |corner: &ScreenVertex| (corner.depth + (1 << (DEPTH - DEPTH_NODE - 1))) >> (DEPTH - DEPTH_NODE);
        let mut depth = Plane::fit::<DEPTH_NODE>(gradients, &[[node(a), node(b), node(c)]], 16 + DEPTH_WALK - DEPTH_NODE, [0]);
        depth.jump(row.wrapping_sub(gradients.row()));
        depth
    }
}

/// Index of the top corner, and the corners from there on.
#[inline(always)]
pub fn turned(corners: [&ScreenVertex; 3]) -> (usize, [&ScreenVertex; 3]) {
    let [a, b, c] = corners;
    let by = if b.y < a.y || c.y < a.y { if c.y < b.y { 2 } else { 1 } } else { 0 };
    (by, turn(corners, by))
}

#[inline(always)]
fn places([a, b, c]: [&ScreenVertex; 3]) -> [[i32; 2]; 3] {
    [[a.x, a.y], [b.x, b.y], [c.x, c.y]]
}

/// Rotates three values by `by` places.
#[inline(always)]
pub fn turn<A: Copy>([a, b, c]: [A; 3], by: usize) -> [A; 3] {
    match by {
        0 => [a, b, c],
        1 => [b, c, a],
        _ => [c, a, b],
    }
}

/// The pixels of the band, and the rows from `row` to `stop` and those below the turn, for a kernel.
///
/// They are within its limits. An edge that is stepped from end to end has at most [`MAX_STEPPED_HEIGHT`]. Of others a part has at most as many rows as
/// its longer edge, and as [`crate::setup::edge::Edge::exact_rows`]: of a height of h rows min(h, 8192 / h), at most 90.
#[inline(always)]
fn part<'a, C: Pixel>(
    [row, stop]: [i32; 2],
    pair: &'a mut LeftRight,
    turn: kernels::Turn,
    band: &'a mut Band<'_, C>,
) -> (&'a mut [C], kernels::Rows<'a>) {
    let (first, height) = (row.wrapping_sub(band.top) as u32, stop.wrapping_sub(row) as u32);
    (band.pixels, kernels::Rows { depth: band.depth, width: band.width, first, sides: transmute_mut!(pair), height, turn })
}

/// Saves a triangle for the next band, stepped to its first row there.
#[inline(never)]
fn save_active<D: Patch, P: Patch>((key, edges): (u32, EdgeState), depth: &D, patch: &P, active: &mut ActiveTriangles<'_>) {
    active.put(|active_triangle| active_triangle.save((key, edges), depth, patch));
}

/// Fills the rows to come; there is at least one.
///
/// On Armv7-M everything that lives longer than a row stays in memory, behind one pointer that is opaque to the compiler: by measurement
/// the pixel loop then has all registers. `count` is read from there too, written a row earlier: if it were derived in the row, the
/// compiler would count in two registers instead of one. On other processors, or where nothing is walked, a copy on the stack takes fewer
/// instructions.
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

/// Rows of a transparent surface, which lie in the room for a run.
impl<D: Patch<Walker: DepthTest>, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>> RunFiller<T::Pixel> for Rows<'_, D, P, T> {
    fn run(&mut self) -> (&mut [T::Pixel], &mut [u16]) {
        (self.pixels, self.buffer)
    }

    fn fill_run(&mut self, run: LeftRight, is_last: bool) {
        let row = if is_last { None } else { Some((self.depth, self.patch, self.shader)) };
        (self.start, self.sides, self.count, self.height) = (((run.left.x >> COLUMN) as usize).wrapping_neg(), run, run.columns(), 1);
        fill_rows(self);
        if let Some(row) = row {
            (self.depth, self.patch, self.shader) = row;
            self.shader.take_back();
        }
    }

    fn start_at(&mut self, row: i32, down: i32) {
        if down != 0 {
            self.patch.jump(down);
        }
        self.shader.start_at(row);
    }

    fn save(&self, (key, sides): (u32, &EdgeWalker), pair: LeftRight, active: &mut ActiveTriangles<'_>) {
        if P::WORDS <= ActiveTriangle::WORDS {
            save_active((key, sides.state(pair, T::ID)), &self.depth, &self.patch, active);
        }
    }
}

impl<'b, D: Patch<Walker: DepthTest>, P: Patch, T: PixelShader<<P::Walker as Walker>::Value>> Rows<'b, D, P, T> {
    /// Whether rows are filled in a local copy, see [`fill_rows`].
    const LOCAL: bool = HALVES || cfg!(not(target_arch = "arm")) || size_of::<P>() == 0;

    /// Whether pixels are counted a row ahead in that copy, so that the count need not be kept during the pixel loop.
    const AHEAD: bool = Self::LOCAL && cfg!(target_arch = "arm") && P::WORDS <= 6;

    /// The state before the first row, which is `row` of the picture.
    #[inline(always)]
    pub(crate) fn new(band: &'b mut Band<'_, T::Pixel>, row: i32, sides: LeftRight, depth: D, patch: P, mut shader: T) -> Self {
        let (width, start) = (band.width, band.start(row));
        shader.start_at(row);
        Self { pixels: band.pixels, buffer: band.depth, width, start, sides, count: 0, height: 0, filled: 0, depth, patch, shader }
    }

    /// Fills one row and steps the edges to the next.
    #[inline(always)]
    fn fill(&mut self) {
        // On Armv6-M one register counts and indexes both buffers, for which the compiler has to know that twice the count does not
        // overflow.
        let count = if HALVES { self.count & ROW } else { self.count } as usize;
        // By measurement, loops that leave no register free are shorter if pixels are counted after them.
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
            // By measurement, loops have more registers if raised values are entered before depth, and others after it.
            let (test, walker) = match self.shader.raise() {
                Some(by) => {
                    let walker = self.patch.raised(&by).enter(right as i32);
                    (self.depth.enter(right as i32), walker)
                }
                None => (self.depth.enter(right as i32), self.patch.enter(right as i32)),
            };
            fill(pixels, buffer, test, walker, self.shader);
            if !Self::AHEAD && late {
                self.filled = self.filled.wrapping_add(count as u32);
            }
        }
    }

    /// Fills all rows in a local copy.
    #[inline(always)]
    fn fill_here(&mut self) {
        let Rows { width, start, sides, count, height, filled, depth, patch, shader, .. } = *self;
        let pixels = &mut *self.pixels;
        // Cut to the length of the pixels, it needs no test of its own in each row. On x86-64, by measurement, that costs an instruction a
        // pixel.
        let length = if cfg!(target_arch = "arm") { pixels.len() } else { self.buffer.len() };
        let Some(buffer) = D::Walker::depth(self.buffer, 0..length) else { return };
        let mut rows = Rows { pixels, buffer, width, start, sides, count, height, filled, depth, patch, shader };
        let ahead = |count: u32| if Self::AHEAD { count } else { 0 };
        rows.filled = rows.filled.wrapping_add(ahead(rows.count));
        loop {
            // This keeps the compiler from counting in two registers.
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
        // The count of the row behind the last is taken back.
        self.filled = rows.filled.wrapping_sub(ahead(rows.count));
        let Rows { start, sides, depth, patch, shader, .. } = rows;
        (self.start, self.sides, self.depth, self.patch, self.shader) = (start, sides, depth, patch, shader);
    }

    /// Steps to the next row.
    #[inline(always)]
    fn step(&mut self) {
        self.depth.step_row();
        self.patch.step_row();
        self.shader.step_row();
    }
}
