//! One triangle into one band: edges, depth plane, and the rows between them.

use super::{
    edge::{COLUMN, COLUMNS, first_centre},
    fill::{Sight, fill},
    sides::{Pair, Rest, Sides},
    smooth::{Part, Shape},
};
use crate::{
    band::Band,
    cull::Extent,
    format::{CENTRE, DEPTH, DEPTH_NODE, DEPTH_WALK, SUBPIXEL},
    math::product::HALVES,
    poly::{Constant, Patch, Walker, basis::Basis, plane::Plane},
    relay::{Leg, Relay},
    tone::Tone,
    vertex::ScreenVertex,
};
use core::hint::black_box;

/// A triangle on the screen, its top corner first, clockwise on a screen whose y runs down.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    /// `[x, y]`, 1/16 pixel.
    pub corners: [[i32; 2]; 3],
    pub(super) depth: [i32; 3],
    /// Which of the mesh's corners is the top one.
    pub turned: usize,
    /// Which of its pixels are drawn.
    pub part: Part,
    /// Its rows in a band; without antialiasing.
    course: Course,
}

/// A triangle's way through the rows of a band.
#[derive(Clone, Copy, Debug)]
struct Course {
    sides: Sides,
    /// Standing on the first row, if it is known already.
    nearness: Option<Plane<1>>,
    /// For [`Relay`]; 0: it is not handed on.
    key: u32,
    /// By the band above: patches stand on the first row already.
    handed_on: bool,
}

impl Course {
    #[inline(always)]
    const fn of(sides: Sides, key: u32) -> Self {
        Self { sides, nearness: None, key, handed_on: false }
    }
}

/// What steps from row to row.
pub(super) struct Rows<'b, D, P: Patch, T: Tone<<P::Walker as Walker>::Value>> {
    /// Pixels and nearness of the band, as many of each in a row as it is wide.
    pub(super) pixels: &'b mut [T::Pixel],
    pub(super) buffer: &'b mut [u16],
    pub(super) width: usize,
    /// Where the coming row starts in them.
    pub(super) start: usize,
    pub(super) sides: Pair,
    /// Pixels of the coming row.
    pub(super) count: u32,
    /// Rows to come.
    pub(super) height: u32,
    /// Pixels of the rows that are done.
    pub(super) filled: u32,
    /// Depth at column 0, unless nothing is hidden.
    pub(super) depth: D,
    pub(super) patch: P,
    pub(super) tone: T,
}

/// All bits of the number of pixels in a row.
const ROW: u32 = 2 * COLUMNS - 1;

/// Columns and rows that a triangle can touch, half open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// First column.
    pub left: i32,
    /// First row.
    pub top: i32,
    /// One past the last column.
    pub right: i32,
    /// One past the last row.
    pub bottom: i32,
}

impl Bounds {
    /// Of a triangle: pixels whose centres its box contains.
    #[inline(always)]
    #[must_use]
    pub fn new(extent: &Extent) -> Self {
        Self {
            left: first_centre(extent.left),
            top: first_centre(extent.top),
            right: first_centre(extent.right),
            bottom: first_centre(extent.bottom),
        }
    }

    /// Of corners: pixels that their box touches.
    #[must_use]
    pub fn touched(corners: impl Iterator<Item = [i32; 3]>) -> Self {
        let none = Self { left: i32::MAX, top: i32::MAX, right: i32::MIN, bottom: i32::MIN };
        // A centre as far beyond the box as it can be.
        let reach = |c: i32| [first_centre(c - (CENTRE - 1)), first_centre(c + CENTRE)];
        corners.fold(none, |bounds, [x, y, _]| {
            let ([left, right], [top, bottom]) = (reach(x), reach(y));
            Self {
                left: bounds.left.min(left),
                top: bounds.top.min(top),
                right: bounds.right.max(right),
                bottom: bounds.bottom.max(bottom),
            }
        })
    }

    /// Of one point `[x, y, _]`.
    #[must_use]
    pub fn at([x, y, _]: [i32; 3]) -> Self {
        Self { left: first_centre(x), top: first_centre(y), right: first_centre(x), bottom: first_centre(y) }
    }

    /// Grows until `point` lies inside.
    pub fn include(&mut self, point: [i32; 3]) {
        let other = Self::at(point);
        self.left = self.left.min(other.left);
        self.top = self.top.min(other.top);
        self.right = self.right.max(other.right);
        self.bottom = self.bottom.max(other.bottom);
    }

    /// Without what lies outside a viewport.
    #[inline(always)]
    #[must_use]
    pub fn clipped(self, width: i32, height: i32) -> Self {
        Self { left: self.left.max(0), top: self.top.max(0), right: self.right.min(width), bottom: self.bottom.min(height) }
    }

    /// `[left, top, right, bottom]`.
    #[inline(always)]
    #[must_use]
    pub fn sides(self) -> [i32; 4] {
        [self.left, self.top, self.right, self.bottom]
    }

    /// No pixel at all.
    #[inline(always)]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }
}

impl Outline {
    /// Turns the corners until the top one is first; the order around the triangle stays.
    #[inline(never)]
    #[must_use]
    pub fn new<C>(corners: [&ScreenVertex; 3], part: Part, band: &Band<'_, C>) -> Self {
        let (turned, corners) = turned(corners);
        let places = places(corners);
        let sides = if part == Part::Centres { Sides::new(places, band.range(), band.width as i32) } else { Sides::NONE };
        Self { corners: places, depth: depths(corners), turned, part, course: Course::of(sides, 0) }
    }

    /// The same without antialiasing, of a triangle that has been [`turned`] and whose sides can be walked from end to end.
    #[inline(always)]
    #[must_use]
    pub(crate) fn simple<C>((turned, corners): (usize, [&ScreenVertex; 3]), key: u32, band: &Band<'_, C>) -> Self {
        let places = places(corners);
        let sides = Sides::simple(places, band.range());
        Self { corners: places, depth: depths(corners), turned, part: Part::Centres, course: Course::of(sides, key) }
    }

    /// Of one that the band above handed on: nothing else is known of it.
    #[inline(always)]
    #[must_use]
    pub(crate) fn handed_on<C>(leg: &Leg, turned: usize, band: &Band<'_, C>) -> Self {
        let course = Course { sides: leg.rest.sides(band.range()), nearness: leg.nearness, key: leg.key, handed_on: true };
        Self { corners: [[0; 2]; 3], depth: [0; 3], turned, part: Part::Centres, course }
    }

    /// No row lies in the band.
    #[inline(always)]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.part == Part::Centres && self.course.sides.row >= self.course.sides.end
    }

    /// Works out depth, unless that is left to those who need it.
    #[inline(always)]
    pub(crate) fn see(&mut self, basis: &Basis) {
        self.course.nearness = Some(self.plane(basis, self.course.sides.row));
    }

    /// Its grid is finer than the pixels' by 2 to this power.
    #[inline]
    #[must_use]
    pub fn finer(&self) -> u32 {
        if let Part::Rim(finer) = self.part { finer } else { 0 }
    }

    /// Draws the rows that lie in `band` and returns how many pixels they have.
    #[inline(always)]
    pub fn draw<P: Patch, T: Tone<<P::Walker as Walker>::Value>>(
        &self,
        basis: &Basis,
        patch: P,
        tone: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        if cfg!(feature = "antialias") && self.part != Part::Centres {
            let shape = Shape { outline: self, piece: None, corners: self.corners, bits: SUBPIXEL };
            return shape.draw(basis, patch, tone, band, &mut |_| [i32::MIN, i32::MAX]);
        }
        let nearness = match self.course.nearness {
            Some(nearness) => nearness,
            None => self.late_plane(*basis),
        };
        self.walk(basis, nearness, patch, tone, band)
    }

    /// As [`Self::draw`], without depth: where nothing else is, and without antialiasing.
    #[inline(always)]
    pub fn draw_alone<P: Patch, T: Tone<<P::Walker as Walker>::Value>>(
        &self,
        basis: &Basis,
        patch: P,
        tone: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        self.walk(basis, Constant, patch, tone, band)
    }

    /// Walks down its sides; `depth` stands on the first row.
    #[inline(always)]
    fn walk<D: Patch<Walker: Sight>, P: Patch, T: Tone<<P::Walker as Walker>::Value>>(
        &self,
        basis: &Basis,
        depth: D,
        patch: P,
        tone: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let sides = &self.course.sides;
        let (mut row, mut stop) = (sides.row, sides.stop);
        let mut rows = Rows::new(band, row, sides.pair, depth, patch, tone);
        if !self.course.handed_on && row != basis.row() {
            rows.patch.jump(row.wrapping_sub(basis.row()));
        }
        rows.tone.start(row);
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
        if self.course.key != 0 && sides.goes_on() {
            let Rows { sides: pair, depth, patch, .. } = rows;
            hand_on((self.course.key, sides.rest(pair, T::MARK)), &depth, &patch, &mut band.relay);
        }
        filled
    }

    #[cold]
    #[inline(never)]
    fn late_plane(self, basis: Basis) -> Plane<1> {
        self.plane(&basis, self.course.sides.row)
    }

    /// Depth, standing on `row`.
    #[inline(always)]
    pub(super) fn plane(&self, basis: &Basis, row: i32) -> Plane<1> {
        let [a, b, c] = self.depth;
        let node = |depth: i32| (depth + (1 << (DEPTH - DEPTH_NODE - 1))) >> (DEPTH - DEPTH_NODE);
        let mut depth = Plane::fit::<DEPTH_NODE>(basis, [[node(a), node(b), node(c)]], 16 + DEPTH_WALK - DEPTH_NODE);
        depth.jump(row.wrapping_sub(basis.row()));
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
fn hand_on<D: Patch, P: Patch>((key, rest): (u32, Rest), depth: &D, patch: &P, relay: &mut Relay<'_>) {
    relay.put(|leg| leg.keep((key, rest), depth, patch));
}

/// Fills the rows to come; there is at least one.
///
/// On Armv7-M all that lives longer than a row stays in memory, behind one pointer that the compiler knows nothing of: measured, the
/// pixel loop then owns the registers and comes out as by hand. `count` comes from there too, written a row earlier: derived in the row,
/// the compiler would count in two registers instead of one. Where registers are few or many, or nothing is walked, a copy on the stack
/// is shorter.
#[inline(never)]
pub(super) fn fill_rows<D: Patch<Walker: Sight>, P: Patch, T: Tone<<P::Walker as Walker>::Value>>(mut rows: &mut Rows<'_, D, P, T>) {
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

impl<'b, D: Patch<Walker: Sight>, P: Patch, T: Tone<<P::Walker as Walker>::Value>> Rows<'b, D, P, T> {
    /// Whether rows are filled in a copy, see [`fill_rows`].
    const LOCAL: bool = HALVES || cfg!(not(target_arch = "arm")) || size_of::<P>() == 0;

    /// Whether pixels are counted a row ahead there, so that what is counted need not wait for the pixel loop.
    const AHEAD: bool = Self::LOCAL && cfg!(target_arch = "arm") && P::WORDS <= 6;

    /// No rows yet, from `row` of the band on.
    #[inline(always)]
    pub(super) fn new(band: &'b mut Band<'_, T::Pixel>, row: i32, sides: Pair, depth: D, patch: P, tone: T) -> Self {
        let (width, start) = (band.width, band.start(row));
        Self { pixels: band.pixels, buffer: band.depth, width, start, sides, count: 0, height: 0, filled: 0, depth, patch, tone }
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
            fill(pixels, buffer, self.depth.enter(right as i32), self.patch.enter(right as i32), self.tone, left);
            if !Self::AHEAD && late {
                self.filled = self.filled.wrapping_add(count as u32);
            }
        }
    }

    /// Fills them in a copy that is nobody else's.
    #[inline(always)]
    fn fill_here(&mut self) {
        let Rows { width, start, sides, count, height, filled, depth, patch, tone, .. } = *self;
        let (pixels, buffer) = (&mut *self.pixels, &mut *self.buffer);
        let mut rows = Rows { pixels, buffer, width, start, sides, count, height, filled, depth, patch, tone };
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
        let Rows { start, sides, depth, patch, tone, .. } = rows;
        (self.start, self.sides, self.depth, self.patch, self.tone) = (start, sides, depth, patch, tone);
    }

    /// Steps to the next row.
    #[inline(always)]
    fn step(&mut self) {
        self.depth.step_row();
        self.patch.step_row();
        self.tone.step_row();
    }
}
