//! Rows of a triangle between its true edges, for methods that interpolate along edges first, then along rows.
//!
//! A row is what a plane sees of it at the height of its pixel centres. Everything follows from the corners and the
//! row alone, so neither bands nor the viewport's border change a bit: where a border cuts a row off, walkers start at
//! the triangle's edge and walk in.

use microphong::{
    format::{CENTRE, SUBPIXEL},
    math::{recip::recip, vector::zip},
    method::{Canvas, Constant, LightingModel, Lit, Patch, Shading, Source, TriangleSetup, Walker},
};

/// Draws the triangle `setup` under any number of lights, by a lighting `model` that computes the light at each pixel from polynomials along rows:
/// `of` returns one for each light, and `common` is one for all lights together. Returns the number of pixels drawn.
pub fn draw<K: Patch, P: Patch, F>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    of: impl Fn(&Source) -> P,
    common: K,
    model: F,
    canvas: &mut dyn Canvas,
) -> u32
where
    F: LightingModel<<K::Walker as Walker>::Value, <P::Walker as Walker>::Value>,
{
    shading.draw_patches(setup, |source| Lit::<P, Constant>::Fully(of(source)), common, model, canvas)
}

/// The edges of a triangle: 0 from its top to its right corner, 1 on to its left one, 2 back to the top.
#[derive(Clone, Copy, Debug)]
pub struct Edges {
    edges: [ScannedEdge; 3],
    /// Heights of the top, right and left corner.
    heights: [i32; 3],
    /// Twice the area, 1/256 pixel².
    area: i64,
}

/// An edge, 1/16 pixel.
#[derive(Clone, Copy, Debug)]
struct ScannedEdge {
    start: [i32; 2],
    run: [i32; 2],
    /// Height, upwards or downwards, at least 1.
    height: i32,
    /// 2^62 / (height 2^zeros).
    inverse: u32,
    zeros: u32,
}

impl ScannedEdge {
    fn new(start: [i32; 2], end: [i32; 2]) -> Self {
        let run = [end[0].wrapping_sub(start[0]), end[1].wrapping_sub(start[1])];
        let height = run[1].wrapping_abs().max(1);
        let zeros = height.leading_zeros();
        Self { start, run, height, inverse: recip((height as u32) << (zeros & 31)), zeros }
    }

    /// Place of a height along the edge, Q2.30 from 0 to 1. Error: 2^-28.
    fn along(&self, y: i32) -> i32 {
        let way = i64::from(y.wrapping_sub(self.start[1]).wrapping_abs().max(0).min(self.height));
        ((way * i64::from(self.inverse)) >> (32 - self.zeros.min(31))).min(1 << 30) as i32
    }

    /// Distance of a point from the edge, towards the inside, times the edge's height; exact.
    fn inside(&self, [x, y]: [i32; 2]) -> i64 {
        let [dx, dy] = self.run.map(i64::from);
        dx * i64::from(y.wrapping_sub(self.start[1])) - dy * i64::from(x.wrapping_sub(self.start[0]))
    }
}

impl Edges {
    /// The edges of `setup`.
    pub fn new(setup: &TriangleSetup<'_>) -> Self {
        let [top, right, left] = setup.corners.map(|corner| [corner.x, corner.y]);
        let edges = [ScannedEdge::new(top, right), ScannedEdge::new(right, left), ScannedEdge::new(left, top)];
        let [first, ..] = edges;
        Self { edges, heights: [top[1], right[1], left[1]], area: first.inside(left) }
    }

    /// The rows, starting with that on which shading begins.
    pub fn rows(&self, setup: &TriangleSetup<'_>) -> Rows<'_> {
        Rows { edges: self, row: setup.gradients.row() }
    }
}

/// The rows of a triangle, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'e> {
    edges: &'e Edges,
    row: i32,
}

/// A row between its ends.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// The left end and the right one.
    pub ends: [End; 2],
    /// Place of the row's last pixel between the left and the right end, Q2.30 from 0 to 1. Error: 2^-28.
    pub last: i32,
    /// Distance from one pixel to the next in this measure. At most 1, which means that there is no next pixel.
    pub step: i32,
    /// Pixels between it and the first one wanted.
    ahead: u32,
}

/// The point at which a row leaves the triangle.
#[derive(Clone, Copy, Debug)]
pub struct End {
    edge: usize,
    /// Place along this edge, Q2.30 from 0 to 1.
    pub along: i32,
}

impl Rows<'_> {
    /// Moves down.
    pub fn jump(&mut self, rows: i32) {
        self.row = self.row.wrapping_add(rows);
    }

    /// The row, to be entered right of column `x - 1`.
    pub fn span(&self, x: i32) -> Span {
        let Edges { edges: [first, second, third], heights: [top, right, left], area } = self.edges;
        let y = (self.row << SUBPIXEL).wrapping_add(CENTRE);
        // The left and the right edge, and the height at which they meet.
        let ((l, from), (r, to), apex) = if y < *right.min(left) {
            ((third, 2), (first, 0), top)
        } else if right < left {
            ((third, 2), (second, 1), left)
        } else {
            ((second, 1), (first, 0), right)
        };
        // Widths of a pixel, measured like distances from edges.
        let [pixel_l, pixel_r] = [l, r].map(|edge| i64::from(edge.height) << SUBPIXEL);
        let centre = [(x.wrapping_sub(1) << SUBPIXEL).wrapping_add(CENTRE), y];
        let (inside_l, inside_r) = (l.inside(centre), r.inside(centre));
        let cut = inside_l >= 0 && inside_r > pixel_r;
        let ahead = if cut { (inside_r - 1) / pixel_r.max(1) } else { 0 };
        // The edges are apart by this over both their heights: the same two edges make up the triangle's area.
        let whole = i64::from(y.wrapping_sub(*apex).wrapping_abs()).wrapping_mul(*area).max(1);
        let zeros = whole.leading_zeros() & 63;
        let inverse = u64::from(recip(((whole << zeros) as u64 >> 32) as u32));
        let share = |part: i64| {
            let part = part.wrapping_mul(r.height.into()).max(0).min(whole);
            ((((part << zeros) as u64 >> 32) * inverse) >> 32).min(1 << 30) as i32
        };
        Span {
            ends: [End { edge: from, along: l.along(y) }, End { edge: to, along: r.along(y) }],
            last: share(inside_l.wrapping_add(ahead.wrapping_mul(pixel_l))),
            step: share(pixel_l),
            ahead: ahead as u32,
        }
    }
}

impl Span {
    /// `walker`, which stands right of the row's last pixel, where it is wanted.
    pub fn enter<W: Walker>(&self, mut walker: W) -> W {
        for _ in 0..self.ahead {
            walker.step();
        }
        walker
    }
}

impl End {
    /// The value of three that belongs to this edge.
    pub fn of<A>(&self, [a, b, c]: [A; 3]) -> A {
        match self.edge {
            0 => a,
            1 => b,
            _ => c,
        }
    }

    /// Linear between the corners' vectors.
    pub fn lerp(&self, [a, b, c]: [[i32; 3]; 3]) -> [i32; 3] {
        let (start, end) = self.of([(a, b), (b, c), (c, a)]);
        zip(start, end, |s, e| ((i64::from(s) << 30).wrapping_add((i64::from(e) - i64::from(s)) * i64::from(self.along)) >> 30) as i32)
    }
}
