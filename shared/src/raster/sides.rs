//! The sides of a triangle, in pieces in which both are walked.

use super::edge::{COLUMN, Column, Edge, SHORT, first_centre};

/// What is left of a triangle's rows in a band.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    /// The next rows, from `row` to `stop`, exclusively, and their sides in the first of them.
    pub(super) row: i32,
    pub(super) stop: i32,
    pub(super) left: Column,
    pub(super) right: Column,
    /// Where the rows end.
    end: i32,
    /// Takes the place of one of the sides of a short triangle at `stop`.
    below: Column,
    width: i32,
    corners: [[i32; 2]; 3],
}

impl Sides {
    /// Of a triangle, its top corner first, clockwise, in the rows from `top` to `bottom` of a band of `width` columns.
    #[inline(always)]
    pub(super) fn new(corners: [[i32; 2]; 3], [top, bottom]: [i32; 2], width: i32) -> Self {
        let [upper, right, left] = corners;
        let (high, low) = (right[1].min(left[1]), right[1].max(left[1]));
        let first = first_centre(upper[1]);
        let mut sides = Self {
            row: first.max(top),
            stop: first_centre(high),
            left: Edge::new(upper, left).walk(),
            right: Edge::new(upper, right).walk(),
            end: first_centre(low).min(bottom),
            below: if turns_right(corners) { Edge::new(right, left) } else { Edge::new(left, right) }.walk(),
            width,
            corners,
        };
        if !is_walkable(corners, width) || low - upper[1] > SHORT {
            sides.next_tall();
        } else if sides.row > first {
            sides.skip(sides.row - first);
        } else if sides.stop <= first {
            sides.turn();
        }
        sides.stop = sides.stop.min(sides.end);
        sides
    }

    /// The upper rows of a short triangle lie above the band.
    #[cold]
    #[inline(never)]
    fn skip(&mut self, rows: i32) {
        self.left.skip(rows);
        self.right.skip(rows);
        if self.row >= self.stop {
            self.below.skip(self.row - self.stop);
            self.turn();
        }
    }

    /// Below the middle corner of a short triangle.
    #[inline(always)]
    fn turn(&mut self) {
        *(if turns_right(self.corners) { &mut self.right } else { &mut self.left }) = self.below;
        self.stop = self.end;
    }

    /// Goes on with the rows from `stop`, whose sides have been walked to; false after the last ones.
    #[inline(always)]
    pub(super) fn next(&mut self, left: Column, right: Column) -> bool {
        self.row = self.stop;
        if self.row >= self.end {
            return false;
        }
        (self.left, self.right) = (left, right);
        let [upper, right, left] = self.corners;
        if is_walkable(self.corners, self.width) && right[1].max(left[1]) - upper[1] <= SHORT {
            self.turn();
        } else {
            self.next_tall();
            self.stop = self.stop.min(self.end);
        }
        true
    }

    /// The next rows of a triangle that is clipped, or very tall: as many as stay exact, or one.
    #[cold]
    #[inline(never)]
    fn next_tall(&mut self) {
        let ([top, right, left], row) = (self.corners, self.row);
        let middle = first_centre(right[1].min(left[1]));
        // Left of the middle corner's row both edges leave the top; below it, the side of that corner is another edge.
        let (stop, left, right) = if row < middle {
            (middle, Edge::new(top, left), Edge::new(top, right))
        } else if turns_right(self.corners) {
            (self.end, Edge::new(top, left), Edge::new(right, left))
        } else {
            (self.end, Edge::new(left, right), Edge::new(top, right))
        };
        let exact = if is_walkable(self.corners, self.width) { left.exact_rows().min(right.exact_rows()) } else { 0 };
        let by_itself = |edge: Edge| Column { x: (edge.column(row).max(0).min(self.width) as u32) << COLUMN, step: 0 };
        if exact > 0 {
            (self.stop, self.left, self.right) = (stop.min(row + exact), left.walk_from(row), right.walk_from(row));
        } else {
            (self.stop, self.left, self.right) = (row + 1, by_itself(left), by_itself(right));
        }
    }
}

/// No corner lies beside the band.
#[inline(always)]
fn is_walkable([[a, _], [b, _], [c, _]]: [[i32; 2]; 3], width: i32) -> bool {
    let inside = |x: i32| (x as u32) < (width as u32) << 4;
    inside(a) && inside(b) && inside(c)
}

/// The corner in the middle is on the right side.
#[inline(always)]
fn turns_right([_, right, left]: [[i32; 2]; 3]) -> bool {
    right[1] < left[1]
}
