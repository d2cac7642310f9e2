//! The area of a pixel that a triangle covers, by areas under edges that are summed with a sign.
//!
//! An edge leaves to its right the area `F(c + 1) - F(c)` of column `c`, where `F(c)` is the integral of `max(c - x, 0)` over the part of
//! the edge in one row: half a square between its ends, linear beyond them, so one division of exact integers. The coverage of a triangle
//! is the sum of these areas over its left edges minus that over its right edges.
//!
//! `F` is the exact integral rounded down, and it depends on nothing but the edge from its upper to its lower end.
//! So the two triangles at an edge get contributions that cancel to the last bit: in a closed patch the coverages of
//! any pixel add up to exactly one. A single coverage differs from the exact one by less than three units.
//!
//! The centroid of the covered part follows from first moments, which are summed in the same way but rounded: its error is about 2^-16
//! pixel over the coverage.

use crate::format::COVERAGE;

/// Fraction bits of places within a pixel.
const PLACE: u32 = 16;
const ONE: i64 = 1 << PLACE;

/// An edge from its upper to its lower end.
#[derive(Clone, Copy, Debug)]
struct ContourEdge {
    x: i64,
    y: i64,
    dx: i64,
    /// The height of the edge, never negative.
    dy: i64,
    /// Whether the triangle lies to the right of the edge.
    left: bool,
}

/// The edges of a triangle, from which its coverage of pixels follows.
#[derive(Clone, Copy, Debug)]
pub struct TriangleCoverage {
    edges: [ContourEdge; 3],
    /// Fraction bits of coordinates, at most 10.
    bits: u32,
}

impl TriangleCoverage {
    /// The coverage of a triangle with these corners, clockwise on a screen whose y runs down. Coordinates have `bits` fraction bits, 4 to
    /// 10, and differ by less than 2^18.
    #[must_use]
    pub fn new([a, b, c]: [[i32; 2]; 3], bits: u32) -> Self {
        let edge = |start: [i32; 2], end: [i32; 2]| {
            let left = end[1] < start[1];
            let ([x, y], [u, v]) = if left { (end, start) } else { (start, end) };
            let [x, y, u, v] = [x, y, u, v].map(i64::from);
            ContourEdge { x, y, dx: u - x, dy: v - y, left }
        };
        Self { edges: [edge(a, b), edge(b, c), edge(c, a)], bits: bits.clamp(4, 10) }
    }

    /// The rows that the triangle touches, half open.
    #[must_use]
    pub fn rows(&self) -> [i32; 2] {
        let [a, b, c] = self.edges;
        let top = a.y.min(b.y).min(c.y);
        let bottom = (a.y + a.dy).max(b.y + b.dy).max(c.y + c.dy);
        [(top >> self.bits) as i32, ((bottom + (1 << self.bits) - 1) >> self.bits) as i32]
    }

    /// The part of the triangle in `row`.
    #[must_use]
    pub fn row(&self, row: i32) -> CoverageRow {
        let segments = self.edges.map(|edge| EdgeSegment::new(&edge, row, self.bits));
        let mut row = CoverageRow { segments, columns: [i32::MAX, i32::MIN], inner: [i32::MIN, i32::MAX] };
        let mut heights = [0; 2];
        for segment in segments.iter().filter(|segment| segment.height > 0) {
            let whole = segment.dy << self.bits;
            // Columns that the segment touches, half open; a column that it only meets at the border is not touched.
            let (first, end) = (segment.low.div_euclid(whole.max(1)) as i32, -(-segment.high).div_euclid(whole.max(1)) as i32);
            row.columns = [row.columns[0].min(first), row.columns[1].max(end)];
            if segment.left {
                heights[0] += segment.height;
                row.inner[0] = row.inner[0].max(end);
            } else {
                heights[1] += segment.height;
                row.inner[1] = row.inner[1].min(first);
            }
        }
        let [start, end] = row.inner;
        // A row without its full height, or without room between its edges, has no inner pixel.
        if heights != [1 << self.bits; 2] || start >= end {
            row.inner = [row.columns[1]; 2];
        }
        row
    }
}

/// The part of an edge in one row of pixels.
#[derive(Clone, Copy, Debug)]
struct EdgeSegment {
    height: i64,
    /// Columns of the left and right end, over `dy`.
    low: i64,
    high: i64,
    dx: i64,
    dy: i64,
    bits: u32,
    left: bool,
    /// The left and the right end in the row, [`PLACE`] fraction bits.
    ends: [[i64; 2]; 2],
    /// Where the segment crosses the rows of points of a [`Mask`]; far to the right for rows that it does not cross.
    crossings: [i64; 4],
    /// `F` at the current column, and the height at which the edge enters it.
    integral: i64,
    entry: i64,
}

impl EdgeSegment {
    fn new(edge: &ContourEdge, row: i32, bits: u32) -> Self {
        let top = i64::from(row) << bits;
        let (from, to) = (edge.y.max(top), (edge.y + edge.dy).min(top + (1 << bits)));
        let at = |y: i64| edge.x * edge.dy + edge.dx * (y - edge.y);
        let end = |y: i64| [(at(y) << (PLACE - bits)).div_euclid(edge.dy.max(1)), (y - top) << (PLACE - bits)];
        let (l, r) = if edge.dx < 0 { (to, from) } else { (from, to) };
        let ends @ [[x0, y0], [x1, y1]] = [end(l), end(r)];
        let crossing = |k: i64| {
            let y = (2 * k + 1) << (PLACE - 3);
            // Half open, so that neighbours share out the points.
            let crossed = y0.min(y1) <= y && y < y0.max(y1);
            let height = if y1 > y0 { (y - y0, y1 - y0) } else { (y0 - y, y0 - y1) };
            if crossed { x0 + (height.0 * (x1 - x0)).div_euclid(height.1.max(1)) } else { i64::MAX >> 2 }
        };
        Self {
            height: (to - from).max(0),
            low: at(l),
            high: at(r),
            dx: edge.dx.abs(),
            dy: edge.dy,
            bits,
            left: edge.left,
            ends,
            crossings: [crossing(0), crossing(1), crossing(2), crossing(3)],
            integral: 0,
            entry: 0,
        }
    }

    /// `F` at the left border of `column`, [`COVERAGE`] fraction bits, rounded down.
    fn integral(&self, column: i32) -> i64 {
        let column = i64::from(column);
        let right = ((column << self.bits) * self.dy) - self.low;
        // From squared coordinates to areas.
        let (up, down) = (COVERAGE.saturating_sub(2 * self.bits), (2 * self.bits).saturating_sub(COVERAGE));
        if right <= 0 {
            0
        } else if right >= self.high - self.low {
            let mean = -((self.height * (self.low + self.high)) << up);
            (self.height << (COVERAGE - self.bits)) * column + mean.div_euclid(((2 * self.dy) << down).max(1))
        } else {
            ((right * right) << up).div_euclid(((2 * self.dy * self.dx) << down).max(1))
        }
    }

    /// The height at which the segment crosses the vertical line at `x`.
    fn crossing(&self, x: i64) -> i64 {
        let [[x0, y0], [x1, y1]] = self.ends;
        if x <= x0 {
            y0
        } else if x >= x1 {
            y1
        } else {
            y0 + ((x - x0) * (y1 - y0)).div_euclid((x1 - x0).max(1))
        }
    }

    fn enter(&mut self, column: i32) {
        self.integral = self.integral(column);
        self.entry = self.crossing(i64::from(column) << PLACE);
    }

    /// The area of `column` to the right of the segment; steps to the next column.
    fn area(&mut self, column: i32) -> Moments {
        let border = i64::from(column) << PLACE;
        let [[x0, y0], [x1, _]] = self.ends;
        let (next, leave) = (self.integral(column + 1), self.crossing(border + ONE));
        let [a, b] = [border, border + ONE].map(|x| (x.max(x0).min(x1) - border).clamp(0, ONE));
        // Where the segment has passed on the left, the area is as wide as the column; where it crosses the column, it is what lies to its
        // right.
        let (beside, within) = ((self.entry - y0).abs(), (leave - self.entry).abs());
        let rest = within * (2 * ONE - a - b);
        let area = Moments {
            coverage: next - self.integral,
            size: (beside << (PLACE + 1)) + rest,
            x: (beside << (2 * PLACE)) + within * (ONE * ONE - (a * a + a * b + b * b) / 3),
            y: ((beside * (self.entry + y0)) << PLACE) + ((rest >> 1) * (self.entry + leave))
                - within * ((b - a) * (leave - self.entry) / 6),
        };
        (self.integral, self.entry) = (next, leave);
        area
    }

    /// The points of `column` that lie to the right of the segment.
    fn mask(&self, column: i32) -> Mask {
        let border = i64::from(column) << PLACE;
        let [a, b, c, d] = self.crossings.map(|x| {
            // Points lie at odd sixteenths.
            let left = ((x - border + (1 << (PLACE - 4)) - 1) >> (PLACE - 3)).clamp(0, 8);
            (0xFF_u32 << left) & 0xFF
        });
        a | b << 8 | c << 16 | d << 24
    }
}

/// A set of 8 x 4 points of a pixel that are covered. It tells where in the pixel an area lies. Neighbouring triangles share no point.
pub type Mask = u32;

/// An area and its moments about the upper left corner of a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    /// The area, rounded alike on both sides of every edge.
    coverage: i64,
    /// Twice the area, 32 fraction bits, and twice its first moments `x` and `y`, 48 fraction bits.
    size: i64,
    x: i64,
    y: i64,
}

/// A triangle in one row of pixels.
#[derive(Clone, Copy, Debug)]
pub struct CoverageRow {
    segments: [EdgeSegment; 3],
    /// Columns that the triangle touches, half open.
    pub columns: [i32; 2],
    /// Columns that the triangle covers wholly, half open.
    pub inner: [i32; 2],
}

/// The part of a pixel that a triangle covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fragment {
    /// The area, [`COVERAGE`] fraction bits; by rounding it may be negative, -2 units at least.
    pub coverage: i32,
    /// Where the area lies in the pixel.
    pub mask: Mask,
    /// The centroid relative to the centre of the pixel, to the right and down, 16 fraction bits.
    pub centroid: [i32; 2],
}

impl CoverageRow {
    /// Moves to `column`.
    pub fn enter(&mut self, column: i32) {
        self.segments.iter_mut().for_each(|segment| segment.enter(column));
    }

    /// The covered part of `column`, to which the row has been moved; steps to the next column.
    pub fn step(&mut self, column: i32) -> Fragment {
        let (mut sum, mut mask) = (Moments::default(), 0);
        for segment in self.segments.iter_mut().filter(|segment| segment.height > 0) {
            let area = segment.area(column);
            mask ^= segment.mask(column);
            let add = |to: &mut i64, part: i64| *to += if segment.left { part } else { -part };
            add(&mut sum.coverage, area.coverage);
            add(&mut sum.size, area.size);
            add(&mut sum.x, area.x);
            add(&mut sum.y, area.y);
        }
        // An area that is not positive is rounding alone.
        let place = |moment: i64| if sum.size > 0 { (moment / sum.size.max(1)).clamp(0, ONE) - ONE / 2 } else { 0 };
        Fragment { coverage: sum.coverage as i32, mask, centroid: [place(sum.x), place(sum.y)].map(|c| c as i32) }
    }
}
