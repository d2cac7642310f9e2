//! Edges of a triangle against pixel centres: the top-left rule, exactly.
//!
//! A pixel belongs to a triangle if its centre lies inside, or on a left or top edge. Both edges of a span ask the same question: *which is the first
//! column whose centre is not left of me?* So spans are half open, and neighbours get one answer along their common edge: no gap, and no pixel twice.
//!
//! ```text
//!   centres   +   +   +   +      x = 2.5 on a left edge:  column 2 is in
//!   column    0   1   2   3      x = 2.5 on a right edge: column 2 is out
//! ```

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::{
    arch::quotient::{LARGEST, SLOPE, signed_long, slope},
    format::{CENTRE, SUBPIXEL},
};

/// Fraction bits of a stepped column.
pub(crate) const COLUMN: u32 = SLOPE;

/// Number of columns that a stepped column can distinguish. No viewport is wider.
pub(crate) const COLUMNS: u32 = 1 << (32 - COLUMN);

/// Largest height of an edge that is stepped from end to end, in 1/16 pixel: 89 rows.
pub(crate) const MAX_STEPPED_HEIGHT: i32 = 89 << SUBPIXEL;
const _: () = assert!(MAX_STEPPED_HEIGHT as usize <= LARGEST);

/// Largest width of an edge that fits a word with [`COLUMN`] fraction bits, in 1/16 pixel: 64 columns.
pub(crate) const MAX_STEPPED_WIDTH: i32 = (1 << (31 - COLUMN)) - 1;

/// Smallest height of an edge whose column is divided in each row, in 1/16 pixel. No viewport is as high.
const MIN_DIVIDED_HEIGHT: i32 = 1 << (32 - COLUMN + SUBPIXEL);

/// An edge from an upper to a lower point, 1/16 pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    x: i32,
    y: i32,
    dx: i32,
    dy: i32,
}

/// A column that is stepped from row to row.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, Default)]
#[repr(C)]
pub(crate) struct EdgeX {
    /// Unsigned Q11.21, such that the integer part is the first column not left of the edge.
    pub x: u32,
    /// Added for the next row.
    pub step: u32,
}

/// Converts a coordinate in 1/16 pixel to the format of a stepped column. All ones below the integer part turn its floor into a ceiling.
#[inline]
fn walked(sixteenths: i32) -> u32 {
    ((sixteenths << (COLUMN - SUBPIXEL)) as u32).wrapping_add((1 << COLUMN) - 1)
}

impl EdgeX {
    /// No column.
    pub(crate) const NONE: Self = Self { x: 0, step: 0 };

    /// Moves down `rows` rows.
    #[inline]
    pub(crate) fn skip(&mut self, rows: i32) {
        self.x = self.x.wrapping_add(self.step.wrapping_mul(rows as u32));
    }
}

impl Edge {
    /// The edge from `upper` to `lower`, each `[x, y]` in 1/16 pixel.
    #[inline]
    pub(crate) fn new(upper: [i32; 2], lower: [i32; 2]) -> Self {
        Self { x: upper[0], y: upper[1], dx: lower[0].wrapping_sub(upper[0]), dy: lower[1].wrapping_sub(upper[1]) }
    }

    /// First column whose centre is not left of the edge at the centre of `row`, for any edge and any row.
    #[inline]
    pub(crate) fn column(&self, row: i32) -> i32 {
        let dy = i64::from(self.dy.max(1));
        let t = i64::from((row << SUBPIXEL) + CENTRE) - i64::from(self.y);
        let numerator = i64::from(self.x - CENTRE) * dy + i64::from(self.dx) * t;
        // Ceiling of numerator / (16 dy). Those of most edges fit words.
        match (i32::try_from(-numerator), i32::try_from(dy << SUBPIXEL)) {
            (Ok(negated), Ok(divisor)) => -negated.div_euclid(divisor.max(1)),
            _ => -signed_long(-numerator, (dy << SUBPIXEL) as u64) as i32,
        }
    }

    /// The column at the centre of the edge's first row, ready to be stepped to its end. A horizontal edge has no row, and a step without meaning. Domain: edges of at most [`MAX_STEPPED_HEIGHT`] and
    /// [`MAX_STEPPED_WIDTH`], whose columns lie in [0, [`COLUMNS`]).
    ///
    /// A true position is a multiple of 1/(256 h) columns, h the height in rows. The start is too small by less than
    /// 2 · 2^-21 and each step by less than 2^-21, so in row n the integer part is right while (n + 3) 256 h < 2^21.
    #[inline]
    pub(crate) fn walk(&self) -> EdgeX {
        let step = slope(self.dx, self.dy);
        // From the start to the first centre, less than a row: step down / 16, rounded down.
        let down = CENTRE.wrapping_sub(self.y) & (2 * CENTRE - 1);
        let across = (step >> SUBPIXEL).wrapping_mul(down).wrapping_add((step & (2 * CENTRE - 1)).wrapping_mul(down) >> SUBPIXEL);
        EdgeX { x: walked(self.x.wrapping_sub(CENTRE)).wrapping_add(across as u32), step: step as u32 }
    }

    /// Number of rows over which the stepped column of a larger edge stays exact; 0 if the edge cannot be stepped.
    ///
    /// The bound is the one in [`Self::walk`], except that the start is too small by less than 2^-21.
    #[inline]
    pub(crate) fn exact_rows(&self) -> i32 {
        if self.dy < MIN_DIVIDED_HEIGHT { (1 << (COLUMN + SUBPIXEL - 8)) / self.dy.max(1) - 2 } else { 0 }
    }

    /// The column at the centre of `row`, ready to be stepped. Domain: edges with `exact_rows() > 0` whose columns lie in [0, [`COLUMNS`]), and rows
    /// of the edge.
    pub(crate) fn walk_from(&self, row: i32) -> EdgeX {
        let dy = self.dy.max(1) as u32;
        let whole = self.dx.div_euclid(self.dy.max(1));
        let rest = self.dx.wrapping_sub(whole.wrapping_mul(self.dy.max(1))) as u32;
        let t = (row << SUBPIXEL).wrapping_add(CENTRE).wrapping_sub(self.y) as u32;
        // dx t / dy = whole t + rest t / dy, split so that every product fits 32 bits.
        let part = rest.wrapping_mul(t);
        let (quotient, rest_t) = (part / dy, part % dy);
        let sixteenths = (self.x - CENTRE).wrapping_add(whole.wrapping_mul(t as i32)).wrapping_add(quotient as i32);
        EdgeX {
            x: walked(sixteenths).wrapping_add((rest_t << (COLUMN - SUBPIXEL)) / dy),
            step: ((whole << COLUMN) as u32).wrapping_add(fraction(rest, dy)),
        }
    }
}

/// `rest / dy` with [`COLUMN`] fraction bits, rounded down, in two steps that fit words. Domain: `rest` is below `dy`, and that below
/// [`MIN_DIVIDED_HEIGHT`].
#[inline]
fn fraction(rest: u32, dy: u32) -> u32 {
    let dy = dy.max(1);
    let upper = rest << (COLUMN - SUBPIXEL);
    ((upper / dy) << SUBPIXEL) + ((upper % dy) << SUBPIXEL) / dy
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::viewport::first_centre;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn walked_columns_are_the_exact_ones(
            x0 in 0i32..32_000,
            dx in prop_oneof![-32_000i32..32_000, -1030i32..1030],
            y0 in -3000i32..3000,
            height in prop_oneof![1i32..MIN_DIVIDED_HEIGHT, 1i32..2048],
        ) {
            let edge = Edge::new([x0, y0], [(x0 + dx).clamp(0, 32_000), y0 + height]);
            let (mut row, end) = (first_centre(y0), first_centre(y0 + height));
            while row < end {
                let is_stepped = height <= MAX_STEPPED_HEIGHT && edge.dx.abs() <= MAX_STEPPED_WIDTH;
                let (mut column, rows) = if is_stepped { (edge.walk(), end - row) } else { (edge.walk_from(row), edge.exact_rows()) };
                for row in row..end.min(row + rows) {
                    prop_assert_eq!((column.x >> COLUMN) as i32, edge.column(row).rem_euclid(1 << 11));
                    column.skip(1);
                }
                row += rows;
            }
        }
    }
}
