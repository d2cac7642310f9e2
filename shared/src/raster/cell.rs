//! Parts of a triangle, for methods that shade it piece by piece.
//!
//! A triangle split at the midpoints of its edges falls into four copies of half its
//! size, the one in the middle turned by 180 degrees; these can be split again. The
//! corners of all these *cells* are exact in the finer coordinates used here, so
//! their edges lie exactly on the triangle's edges and on each other. The top-left
//! rule then gives every pixel of the triangle to one cell: no crack, no overlap,
//! and no pixel more or less than the triangle has.

use super::{
    area::Contour,
    edge::COLUMN,
    sides::Pair,
    smooth::{Part, Shape, coarse},
    triangle::{Outline, Rows, fill_rows},
};
use crate::{
    band::Band,
    format::{FINE, SPLITS, SUBPIXEL},
    math::vector::zip,
    poly::{
        Patch, Walker,
        basis::{Basis, NEAR},
        plane::Plane,
    },
    tone::Tone,
};

/// From a pixel's border to its centre.
const CENTRE: i32 = 1 << (FINE - 1);

/// The place of a part of a triangle: its corner `k` has the barycentric coordinates `origin` plus or minus 1 at
/// coordinate `k`, all over 2^`level`.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    level: u32,
    origin: [i32; 3],
    turned: bool,
}

impl Cell {
    /// The triangle itself.
    pub const WHOLE: Self = Self { level: 0, origin: [0; 3], turned: false };

    /// How often the triangle was split: barycentric coordinates are over 2 to this power.
    #[inline(always)]
    #[must_use]
    pub fn level(&self) -> u32 {
        self.level
    }

    fn sign(&self) -> i32 {
        if self.turned { -1 } else { 1 }
    }

    /// Barycentric coordinates of the corners.
    #[inline]
    #[must_use]
    pub fn corners(&self) -> [[i32; 3]; 3] {
        let ([a, b, c], sign) = (self.origin, self.sign());
        [[a + sign, b, c], [a, b + sign, c], [a, b, c + sign]]
    }

    /// The four cells between corners and edge midpoints. Cell `k` < 3 keeps corner `k` in its place; corner `k` of the
    /// last one is the midpoint of the edge opposite.
    #[inline]
    #[must_use]
    pub fn split(&self) -> [Self; 4] {
        let ([a, b, c], sign) = (self.origin.map(|c| c * 2), self.sign());
        let cell = |origin, turned| Self { level: self.level + 1, origin, turned };
        [
            cell([a + sign, b, c], self.turned),
            cell([a, b + sign, c], self.turned),
            cell([a, b, c + sign], self.turned),
            cell([a + sign, b + sign, c + sign], !self.turned),
        ]
    }
}

/// A cell in its place on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'o> {
    outline: &'o Outline,
    cell: Cell,
    /// Clockwise, [`FINE`] fraction bits.
    corners: [[i32; 2]; 3],
    /// Its first row and the one after its last, on the grid of the corners.
    rows: [i32; 2],
    /// Likewise.
    columns: [i32; 2],
}

/// First row whose centre is not above `c`, or column whose centre is not left of it.
fn first_centre(c: i32) -> i32 {
    c.wrapping_add(CENTRE - 1) >> FINE
}

/// The half-open range of centres between the least and the largest of three coordinates.
fn range([a, b, c]: [i32; 3]) -> [i32; 2] {
    [first_centre(a.min(b).min(c)), first_centre(a.max(b).max(c))]
}

impl Outline {
    /// Where `cell` lies.
    #[inline]
    #[must_use]
    pub fn piece(&self, cell: &Cell) -> Piece<'_> {
        let finer = SPLITS.saturating_sub(cell.level);
        let place = |weights: [i32; 3]| {
            let along = |k: usize| {
                let [a, b, c] = zip(self.corners, weights, |corner, weight| corner[k].wrapping_mul(weight));
                a.wrapping_add(b).wrapping_add(c) << finer
            };
            [along(0), along(1)]
        };
        let corners = cell.corners().map(place);
        Piece { outline: self, cell: *cell, corners, rows: range(corners.map(|c| c[1])), columns: range(corners.map(|c| c[0])) }
    }

    /// The triangle's depth on row 0; all its pieces share it.
    #[must_use]
    pub fn depth(&self, basis: &Basis) -> Plane<1> {
        self.plane(basis, 0)
    }
}

impl Piece<'_> {
    /// Its box has a pixel in `band`.
    #[inline]
    #[must_use]
    pub fn meets<C>(&self, band: &Band<'_, C>) -> bool {
        let ([top, bottom], [left, right]) = match self.outline.part {
            Part::Centres | Part::Inner => (self.rows, self.columns),
            // A pixel that it touches has one of the finer places, or has it next to it.
            Part::Rim(finer) => {
                let touched = |[from, to]: [i32; 2]| [(from >> finer).wrapping_sub(1), (to >> finer).wrapping_add(2)];
                (touched(self.rows), touched(self.columns))
            }
        };
        top.max(band.top) < bottom.min(band.top.wrapping_add(band.rows)) && left.max(0) < right.min(band.width as i32)
    }

    /// For fitting on it, from the triangle's.
    #[must_use]
    pub fn basis(&self, triangle: &Basis) -> Basis {
        let extent = |[from, to]: [i32; 2]| to.wrapping_sub(from);
        let near = extent(self.rows).max(extent(self.columns)) < NEAR / 2;
        triangle.part(self.corners[0], self.cell.level, self.cell.turned, near)
    }

    /// Draws the rows that lie in `band` and returns how many pixels they have. `basis` is the piece's own, `depth` the triangle's.
    #[inline]
    pub fn draw<P: Patch, T: Tone<<P::Walker as Walker>::Value>>(
        &self,
        basis: &Basis,
        depth: Plane<1>,
        patch: P,
        tone: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        if cfg!(feature = "antialias") && self.outline.part != Part::Centres {
            return self.smooth(basis, patch, tone, band);
        }
        let [a, b, c] = self.corners;
        let (first, end) = (self.rows[0].max(band.top), self.rows[1].min(band.top.wrapping_add(band.rows)));
        let width = i64::from(band.width as i32);
        let mut rows = Rows::new(band, first, Pair::NONE, depth, patch, tone);
        rows.depth.jump(first);
        rows.patch.jump(first.wrapping_sub(basis.row()));
        rows.tone.start(first);
        let mut lines = [Line::new(a, b, first), Line::new(b, c, first), Line::new(c, a, first)];
        for _ in first..end {
            let (mut left, mut right) = (0, width);
            for line in &mut lines {
                match line.side {
                    Side::Left => left = left.max(line.column),
                    Side::Right => right = right.min(line.column),
                    Side::None => {}
                }
                line.step_row();
            }
            rows.sides.left.x = (left.min(width) as u32) << COLUMN;
            rows.sides.right.x = (right.max(0) as u32) << COLUMN;
            rows.count = right.saturating_sub(left).max(0) as u32;
            rows.height = 1;
            fill_rows(&mut rows);
        }
        rows.filled
    }

    /// [`Self::draw`] with antialiasing.
    #[inline(never)]
    fn smooth<P: Patch, T: Tone<<P::Walker as Walker>::Value>>(
        &self,
        basis: &Basis,
        patch: P,
        tone: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        // Corners of a piece have only so many fraction bits as it was split more.
        let (bits, level) = (FINE - SUBPIXEL, self.cell.level.min(SPLITS));
        let piece =
            Contour::new(self.corners.map(|c| coarse(c, self.outline.finer(), bits).map(|c| c >> (SPLITS - level))), SUBPIXEL + level);
        let [a, b, c] = self.corners;
        let mut owned = |row: i32| {
            let mut columns = [i32::MIN, i32::MAX];
            if (self.rows[0]..self.rows[1]).contains(&row) {
                for line in [Line::new(a, b, row), Line::new(b, c, row), Line::new(c, a, row)] {
                    let column = line.column as i32;
                    match line.side {
                        Side::Left => columns[0] = columns[0].max(column),
                        Side::Right => columns[1] = columns[1].min(column),
                        Side::None => {}
                    }
                }
            } else {
                columns = [0; 2];
            }
            columns
        };
        let shape = Shape { outline: self.outline, piece: Some(piece), corners: self.corners, bits: FINE };
        shape.draw(basis, patch, tone, band, &mut owned)
    }
}

/// Where the inside is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    /// Left of an edge that runs up.
    Left,
    /// Right of an edge that runs down.
    Right,
    /// A level edge bounds rows, not columns.
    None,
}

/// The straight line through an edge, walked down exactly, quotient and remainder apart.
#[derive(Clone, Copy, Debug)]
struct Line {
    side: Side,
    /// First column whose centre is not left of the line.
    column: i64,
    /// What rounding up added, as the numerator over `whole`.
    rest: i64,
    column_step: i64,
    rest_step: i64,
    whole: i64,
}

impl Line {
    /// Through the edge from `a` to `b`, standing on `row`.
    #[inline]
    fn new(a: [i32; 2], b: [i32; 2], row: i32) -> Self {
        let (side, [x, y], lower) = match b[1].cmp(&a[1]) {
            core::cmp::Ordering::Less => (Side::Left, b, a),
            core::cmp::Ordering::Greater => (Side::Right, a, b),
            core::cmp::Ordering::Equal => (Side::None, a, b),
        };
        let (dx, dy) = (lower[0].wrapping_sub(x), lower[1].wrapping_sub(y).max(1));
        let whole = i64::from(dy) << FINE;
        let down = (row << FINE).wrapping_add(CENTRE).wrapping_sub(y);
        let column = i64::from(x.wrapping_sub(CENTRE)) * i64::from(dy) + i64::from(dx) * i64::from(down) + whole - 1;
        Self {
            side,
            column: column.div_euclid(whole),
            rest: column.rem_euclid(whole),
            column_step: dx.div_euclid(dy).into(),
            rest_step: i64::from(dx.rem_euclid(dy)) << FINE,
            whole,
        }
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.column += self.column_step;
        self.rest += self.rest_step;
        if self.rest >= self.whole {
            self.rest -= self.whole;
            self.column += 1;
        }
    }
}
