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

    /// Another edge takes the place of the one that ends at the middle corner.
    #[inline(always)]
    fn turn(&mut self, corners: [[i32; 2]; 3], below: Column) {
        *(if turns_right(corners) { &mut self.right } else { &mut self.left }) = below;
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
    /// Those of the coming row.
    pub(super) pair: Pair,
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
    pub(super) fn new(corners: [[i32; 2]; 3], [top, bottom]: [i32; 2], width: i32) -> Self {
        let [upper, right, left] = corners;
        let (high, low) = (right[1].min(left[1]), right[1].max(left[1]));
        let first = first_centre(upper[1]);
        let small = is_walkable(corners, width) && is_narrow(corners) && low - upper[1] <= SHORT;
        let (row, stop, end) = (first.max(top), first_centre(high), first_centre(low).min(bottom));
        if !small {
            return Self::large(row, end, corners, width);
        }
        let mut sides = Self {
            pair: Pair { left: Edge::new(upper, left).walk(), right: Edge::new(upper, right).walk() },
            row,
            stop: stop.min(end),
            end,
            below: if turns_right(corners) { Edge::new(right, left) } else { Edge::new(left, right) }.walk(),
            small,
        };
        if row > first {
            sides.skip(row - first, stop, corners);
        } else if stop <= first {
            sides.turn(corners);
        }
        sides
    }

    #[cold]
    #[inline(never)]
    fn large(row: i32, end: i32, corners: [[i32; 2]; 3], width: i32) -> Self {
        let mut sides = Self { pair: Pair::default(), row, stop: row, end, below: Column::default(), small: false };
        sides.next_large(corners, width);
        sides
    }

    /// The upper rows of a small triangle lie above the band; `turn` is the row of its middle corner.
    #[cold]
    #[inline(never)]
    fn skip(&mut self, rows: i32, turn: i32, corners: [[i32; 2]; 3]) {
        self.pair.skip(rows);
        if self.row >= turn {
            self.below.skip(self.row - turn);
            self.turn(corners);
        }
    }

    /// Below the middle corner of a small triangle.
    #[inline(always)]
    fn turn(&mut self, corners: [[i32; 2]; 3]) {
        self.pair.turn(corners, self.below);
        self.stop = self.end;
    }

    /// Goes on with the rows from `stop`, to which both sides have been walked: `pair`; false after the last ones.
    #[inline(always)]
    pub(super) fn next(&mut self, pair: &mut Pair, corners: [[i32; 2]; 3], width: i32) -> bool {
        self.row = self.stop;
        if self.row >= self.end {
            return false;
        }
        if self.small {
            pair.turn(corners, self.below);
            self.stop = self.end;
        } else {
            self.next_large(corners, width);
            *pair = self.pair;
        }
        true
    }

    /// The next rows of a triangle that is clipped, or large: as many as stay exact, or one.
    #[cold]
    #[inline(never)]
    fn next_large(&mut self, corners: [[i32; 2]; 3], width: i32) {
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
        let (stop, pair) = if exact > 0 {
            (stop.min(row + exact), Pair { left: left.walk_from(row), right: right.walk_from(row) })
        } else {
            (row + 1, Pair { left: by_itself(left), right: by_itself(right) })
        };
        (self.stop, self.pair) = (stop.min(self.end), pair);
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
