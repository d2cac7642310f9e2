//! The left and right side of a triangle, stepped from row to row.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use microphong_kernels::Turn;

use crate::{
    format::SUBPIXEL,
    geometry::viewport::first_centre,
    setup::edge::{COLUMN, Edge, EdgeX, MAX_STEPPED_HEIGHT, MAX_STEPPED_WIDTH},
};

/// The columns where a row begins and ends.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct LeftRight {
    pub(crate) left: EdgeX,
    pub(crate) right: EdgeX,
}

impl LeftRight {
    /// Number of columns in the row.
    #[inline]
    pub(crate) fn columns(&self) -> u32 {
        (self.right.x >> COLUMN).wrapping_sub(self.left.x >> COLUMN)
    }

    /// A row without columns.
    pub(crate) const NONE: Self = Self { left: EdgeX::NONE, right: EdgeX::NONE };

    /// Moves down `rows` rows.
    #[inline]
    pub(crate) fn skip(&mut self, rows: i32) {
        self.left.skip(rows);
        self.right.skip(rows);
    }
}

/// The edge below the middle corner.
#[derive(Clone, Copy, Debug)]
struct LowerEdge {
    column: EdgeX,
    /// Whether the edge is on the right side.
    right: bool,
}

/// Continuation at the row to which edges can be stepped.
#[derive(Clone, Copy, Debug)]
enum Then {
    /// All edges are stepped from end to end: the lower one replaces one of the other two.
    Lower(LowerEdge),
    /// Edges are computed again, within these columns.
    Anew([i32; 2]),
}

/// The state of an [`EdgeWalker`] at the end of a band, for the next one.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct EdgeState {
    /// Begin and end of the next band's first row.
    pair: LeftRight,
    /// The edge below the middle corner, and the row `turn` where it begins; `low` is one past the last row of the triangle.
    column: EdgeX,
    turn: i32,
    low: i32,
    /// Not 0 if that edge is on the right side.
    right: u8,
    /// The pixel shader, see [`crate::raster::pixel_shader::PixelShader::ID`].
    pub(crate) shader: u8,
    /// Padding, so that no byte is undefined.
    unused: u16,
}

impl EdgeState {
    /// The state without a triangle; all zeros.
    pub(crate) const NONE: Self = Self { pair: LeftRight::NONE, column: EdgeX::NONE, turn: 0, low: 0, right: 0, shader: 0, unused: 0 };

    /// The edges in the rows from `top` to `bottom` of the next band.
    #[inline]
    pub(crate) fn walker(self, [top, bottom]: [i32; 2]) -> EdgeWalker {
        let Self { pair, column, turn, low, right, .. } = self;
        let end = low.min(bottom);
        EdgeWalker {
            pair,
            row: top,
            stop: turn.max(top).min(end),
            end,
            low,
            turn,
            then: Then::Lower(LowerEdge { column, right: right != 0 }),
        }
    }
}

/// The edges of a triangle within the rows of a band.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeWalker {
    /// Begin and end of the first row.
    pub(crate) pair: LeftRight,
    /// The first row.
    pub(crate) row: i32,
    /// One past the last row to which `pair` can be stepped.
    pub(crate) stop: i32,
    /// One past the last row in the band.
    pub(crate) end: i32,
    /// One past the last row of the triangle, in any band.
    low: i32,
    /// First row of the edge below the middle corner.
    turn: i32,
    /// Continuation at the row `stop`.
    then: Then,
}

impl EdgeWalker {
    /// Edges without rows; all zeros.
    pub(crate) const NONE: Self = Self { pair: LeftRight::NONE, row: 0, stop: 0, end: 0, low: 0, turn: 0, then: Then::Anew([0; 2]) };

    /// The edges of a triangle in the rows from `top` to `bottom` of a band and between two `columns`. Corners are clockwise, the top one first. A
    /// triangle that is small enough is stepped from end to end, whatever the columns.
    pub(crate) fn new(corners: [[i32; 2]; 3], [top, bottom]: [i32; 2], columns: [i32; 2]) -> Self {
        let [[_, upper], [_, right], [_, left]] = corners;
        let low = right.max(left);
        if is_walkable(corners, columns) && is_steppable(corners) && low - upper <= MAX_STEPPED_HEIGHT {
            return Self::end_to_end(corners, [top, bottom]);
        }
        let (row, end) = (first_centre(upper).max(top), first_centre(low).min(bottom));
        let mut sides = Self { row, stop: row, end, low: end, then: Then::Anew(columns), ..Self::NONE };
        (sides.stop, sides.pair) = sides.next_large(row, corners, columns);
        sides
    }

    /// The edges of a triangle that can be stepped from end to end: no corner lies beside the band, and height and width are at most
    /// [`MAX_STEPPED_HEIGHT`] and [`MAX_STEPPED_WIDTH`].
    #[inline(always)]
    pub(crate) fn end_to_end(corners: [[i32; 2]; 3], [top, bottom]: [i32; 2]) -> Self {
        let [upper, right, left] = corners;
        let first = first_centre(upper[1]);
        let (turn, low) = (first_centre(right[1].min(left[1])), first_centre(right[1].max(left[1])));
        let mut pair = LeftRight { left: Edge::new(upper, left).walk(), right: Edge::new(upper, right).walk() };
        let turns_right = turns_right(corners);
        let mut column = if turns_right { Edge::new(right, left) } else { Edge::new(left, right) }.walk();
        let row = first.max(top);
        if row > first {
            pair.skip(row.wrapping_sub(first));
            column.skip(row.wrapping_sub(turn).max(0));
        }
        let end = low.min(bottom);
        Self { pair, row, stop: turn.max(row).min(end), end, low, turn, then: Then::Lower(LowerEdge { column, right: turns_right }) }
    }

    /// Whether rows follow in the next band to which the edges can be stepped.
    #[inline]
    pub(crate) fn goes_on(&self) -> bool {
        self.low > self.end
    }

    /// The state for the next band; `pair` has been stepped to the end. `shader` is the [`crate::raster::pixel_shader::PixelShader::ID`].
    #[inline]
    pub(crate) fn state(&self, pair: LeftRight, shader: u8) -> EdgeState {
        // If the band ends at or above the middle corner, the lower edge is still to come.
        let turn = if self.stop < self.end { self.low } else { self.turn };
        // Others are not saved.
        let LowerEdge { column, right } =
            if let Then::Lower(lower) = self.then { lower } else { LowerEdge { column: EdgeX::NONE, right: false } };
        EdgeState { pair, column, turn, low: self.low, right: right.into(), shader, unused: 0 }
    }

    /// The rows below the middle corner of edges that are stepped from end to end, for a kernel.
    #[inline]
    pub(crate) fn below(&self) -> Option<Turn> {
        let Then::Lower(LowerEdge { column: EdgeX { x, step }, right }) = self.then else { return None };
        Some(Turn { height: self.end.wrapping_sub(self.stop) as u32, is_right: right, line: [x, step] })
    }

    /// Continues below the middle corner, to which `pair` has been stepped; returns one past the last row to which it can be stepped now. `None` if edges
    /// are computed again there, by [`Self::anew`].
    #[inline]
    pub(crate) fn next(&self, pair: &mut LeftRight) -> Option<i32> {
        let Then::Lower(LowerEdge { column, right }) = self.then else { return None };
        *(if right { &mut pair.right } else { &mut pair.left }) = column;
        Some(self.end)
    }

    /// Computes edges again for the rows from `row`, as [`Self::next`] continues others.
    pub(crate) fn anew(&self, row: i32, pair: &mut LeftRight, corners: [[i32; 2]; 3]) -> i32 {
        let Then::Anew(columns) = self.then else { return self.end };
        let stop;
        (stop, *pair) = self.next_large(row, corners, columns);
        stop
    }

    /// The next rows of a large triangle, or of one that is cut by the columns: as many as stay exact, or one.
    #[cold]
    #[inline(never)]
    fn next_large(self, row: i32, corners: [[i32; 2]; 3], columns: [i32; 2]) -> (i32, LeftRight) {
        let [top, right, left] = corners;
        let middle = first_centre(right[1].min(left[1]));
        // Above the middle corner both edges leave the top corner; below it, an edge from the middle corner replaces one of them.
        let (stop, left, right) = if row < middle {
            (middle, Edge::new(top, left), Edge::new(top, right))
        } else if turns_right(corners) {
            (self.end, Edge::new(top, left), Edge::new(right, left))
        } else {
            (self.end, Edge::new(left, right), Edge::new(top, right))
        };
        let exact = if is_walkable(corners, columns) { left.exact_rows().min(right.exact_rows()) } else { 0 };
        let by_itself = |edge: Edge| EdgeX { x: (edge.column(row).max(columns[0]).min(columns[1]) as u32) << COLUMN, step: 0 };
        let (stop, pair) = if exact > 0 {
            (stop.min(row + exact), LeftRight { left: left.walk_from(row), right: right.walk_from(row) })
        } else {
            (row + 1, LeftRight { left: by_itself(left), right: by_itself(right) })
        };
        (stop.min(self.end), pair)
    }
}

/// Whether no corner lies beside these columns.
#[inline]
fn is_walkable([[a, _], [b, _], [c, _]]: [[i32; 2]; 3], [first, end]: [i32; 2]) -> bool {
    let inside = |x: i32| (x.wrapping_sub(first << SUBPIXEL) as u32) < (end.wrapping_sub(first) as u32) << SUBPIXEL;
    inside(a) && inside(b) && inside(c)
}

/// Whether the width of every edge fits one word.
#[inline]
fn is_steppable([[a, _], [b, _], [c, _]]: [[i32; 2]; 3]) -> bool {
    let narrow = |from: i32, to: i32| (to.wrapping_sub(from).wrapping_add(MAX_STEPPED_WIDTH) as u32) <= 2 * MAX_STEPPED_WIDTH as u32;
    narrow(a, b) && narrow(b, c) && narrow(c, a)
}

/// Whether the middle corner is on the right side.
#[inline]
fn turns_right([_, right, left]: [[i32; 2]; 3]) -> bool {
    right[1] < left[1]
}
