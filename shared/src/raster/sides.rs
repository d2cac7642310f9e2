//! The sides of a triangle, in pieces in which both are walked.

use super::edge::{COLUMN, Column, Edge, NARROW, SHORT, first_centre};

/// The sides of a row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pair {
    pub(super) left: Column,
    pub(super) right: Column,
}

impl Pair {
    /// Columns between them.
    #[inline(always)]
    pub(super) fn columns(&self) -> u32 {
        (self.right.x >> COLUMN).wrapping_sub(self.left.x >> COLUMN)
    }

    /// Moves down `rows` rows.
    #[inline(always)]
    pub(super) fn skip(&mut self, rows: i32) {
        self.left.skip(rows);
        self.right.skip(rows);
    }
}

/// What is left of a triangle's rows in a band.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    /// The coming row, and where the rows end that its sides can be walked to.
    pub(super) row: i32,
    pub(super) stop: i32,
    /// Where the rows end.
    end: i32,
    /// Takes the place of one of the sides of a small triangle at `stop`.
    below: Column,
    /// Walked from end to end: no corner beside the band, few rows and columns.
    small: bool,
}

impl Sides {
    /// Of a triangle, its top corner first, clockwise, in the rows from `top` to `bottom` of a band of `width` columns.
    #[inline(always)]
    pub(super) fn new(corners: [[i32; 2]; 3], [top, bottom]: [i32; 2], width: i32) -> (Self, Pair) {
        let [upper, right, left] = corners;
        let (high, low) = (right[1].min(left[1]), right[1].max(left[1]));
        let first = first_centre(upper[1]);
        let small = is_walkable(corners, width) && is_narrow(corners) && low - upper[1] <= SHORT;
        let mut sides =
            Self { row: first.max(top), stop: first_centre(high), end: first_centre(low).min(bottom), below: Column::default(), small };
        let mut pair = Pair::default();
        if small {
            pair = Pair { left: Edge::new(upper, left).walk(), right: Edge::new(upper, right).walk() };
            sides.below = if turns_right(corners) { Edge::new(right, left) } else { Edge::new(left, right) }.walk();
            if sides.row > first {
                sides.skip(&mut pair, sides.row - first, corners);
            } else if sides.stop <= first {
                sides.turn(&mut pair, corners);
            }
        } else {
            sides.next_large(&mut pair, corners, width);
        }
        sides.stop = sides.stop.min(sides.end);
        (sides, pair)
    }

    /// The upper rows of a small triangle lie above the band.
    #[cold]
    #[inline(never)]
    fn skip(&mut self, pair: &mut Pair, rows: i32, corners: [[i32; 2]; 3]) {
        pair.skip(rows);
        if self.row >= self.stop {
            self.below.skip(self.row - self.stop);
            self.turn(pair, corners);
        }
    }

    /// Below the middle corner of a small triangle.
    #[inline(always)]
    fn turn(&mut self, pair: &mut Pair, corners: [[i32; 2]; 3]) {
        *(if turns_right(corners) { &mut pair.right } else { &mut pair.left }) = self.below;
        self.stop = self.end;
    }

    /// Goes on with the rows from `stop`, to which both sides have been walked; false after the last ones.
    #[inline(always)]
    pub(super) fn next(&mut self, pair: &mut Pair, corners: [[i32; 2]; 3], width: i32) -> bool {
        self.row = self.stop;
        if self.row >= self.end {
            return false;
        }
        if self.small {
            self.turn(pair, corners);
        } else {
            self.next_large(pair, corners, width);
            self.stop = self.stop.min(self.end);
        }
        true
    }

    /// The next rows of a triangle that is clipped, or large: as many as stay exact, or one.
    #[cold]
    #[inline(never)]
    fn next_large(&mut self, pair: &mut Pair, corners: [[i32; 2]; 3], width: i32) {
        let ([top, right, left], row) = (corners, self.row);
        let middle = first_centre(right[1].min(left[1]));
        // Left of the middle corner's row both edges leave the top; below it, the side of that corner is another edge.
        let (stop, left, right) = if row < middle {
            (middle, Edge::new(top, left), Edge::new(top, right))
        } else if turns_right(corners) {
            (self.end, Edge::new(top, left), Edge::new(right, left))
        } else {
            (self.end, Edge::new(left, right), Edge::new(top, right))
        };
        let exact = if is_walkable(corners, width) { left.exact_rows().min(right.exact_rows()) } else { 0 };
        let by_itself = |edge: Edge| Column { x: (edge.column(row).max(0).min(width) as u32) << COLUMN, step: 0 };
        if exact > 0 {
            (self.stop, *pair) = (stop.min(row + exact), Pair { left: left.walk_from(row), right: right.walk_from(row) });
        } else {
            (self.stop, *pair) = (row + 1, Pair { left: by_itself(left), right: by_itself(right) });
        }
    }
}

/// No corner lies beside the band.
#[inline(always)]
fn is_walkable([[a, _], [b, _], [c, _]]: [[i32; 2]; 3], width: i32) -> bool {
    let inside = |x: i32| (x as u32) < (width as u32) << 4;
    inside(a) && inside(b) && inside(c)
}

/// Every edge can be walked in one word.
#[inline(always)]
fn is_narrow([[a, _], [b, _], [c, _]]: [[i32; 2]; 3]) -> bool {
    let narrow = |from: i32, to: i32| (to.wrapping_sub(from).wrapping_add(NARROW) as u32) <= 2 * NARROW as u32;
    narrow(a, b) && narrow(b, c) && narrow(c, a)
}

/// The corner in the middle is on the right side.
#[inline(always)]
fn turns_right([_, right, left]: [[i32; 2]; 3]) -> bool {
    right[1] < left[1]
}
