//! How much interpolation is off from a highlight: the largest errors on triangles of all sizes, as a table.
//!
//! What interpolation is off from (N·H/|N|)^n on a triangle is about the same function of n e² and of n (1 - w) for all exponents n, where
//! e is the longest distance between two corners' normals, and w the largest N·H at a corner over the least length of N. The table has a
//! row for each octave of n e², between which straight lines are no less than the errors, a column for each fourth of n (1 - w), and one
//! part for each range of exponents.
//!
//! Behind the last row is one for all larger triangles: there linear interpolation is off by no more than the brightest highlight, the
//! quadratic by 4/3 of it. All others are computed by `microphong bounds`: the largest error that a search found on any triangle of at most
//! this size and at least so far from the peak, and a margin; `tests/suite/bounds.rs` searches anew.

mod table;

use crate::{
    arch::product::unsigned_product,
    format::{COSINE, HAVERSINE},
};
pub use table::ERRORS;

/// Errors that the table knows.
pub const KINDS: usize = 4;
/// Rows for octaves of n e².
pub const ROWS: usize = 13;
/// Columns, each a fourth of a unit of n (1 - w).
pub const COLUMNS: usize = 32;
/// Columns to a unit of n (1 - w).
pub const COLUMNS_A_UNIT: u32 = 4;
/// n e² of the first row, which holds for all that is smaller.
pub const LEAST_SIZE: f64 = 1.0 / 256.0;
/// The least exponent of each part.
pub const LEAST_EXPONENTS: [u16; 3] = [1, 5, 16];
/// The largest exponent at which what rounding of normals does to the highlights at corners is left to what arithmetic may add: it is less than
/// half an LSB.
const EXACT: u16 = 64;
/// The exponent for which errors of [`Kind::Cosines`] stand in the table as they are.
pub const USUAL_EXPONENT: u16 = 16;
/// Fraction bits of an entry, a share of the whole highlight; the largest entry stands for any error.
pub const SHARE: u32 = 15;

/// A kind of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// By how much linear interpolation between corners is too dark.
    LinearBelow,
    /// By how much it is too bright.
    LinearAbove,
    /// How far the quadratic through six points is off.
    Quadratic,
    /// How far the power of the quadratic through N·H at six points is off, times the exponent over [`USUAL_EXPONENT`]: as highlights become
    /// narrower, this error becomes smaller.
    Cosines,
}

/// The errors of one kind, unsigned Q1.15, rounded up.
pub type Errors = [[u16; COLUMNS]; ROWS + 1];

/// The part of the table for an exponent.
#[must_use]
pub(crate) fn part(exponent: u16) -> u8 {
    LEAST_EXPONENTS.iter().rposition(|&least| exponent >= least).unwrap_or(0) as u8
}

/// A place between two rows of the table.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    errors: &'static [Errors; KINDS],
    /// The row before, and the column.
    row: usize,
    column: usize,
    /// How far it lies behind that row, unsigned Q0.16.
    beyond: u32,
}

impl Place {
    /// The place for triangles whose widest edge has the haversine `h`, Q0.16, between normals, where the highlight of an exponent is
    /// brightest at N·H = `cosine`, Q2.30. Domain: `h` up to 1/4; n (1 - `cosine`) up to 8, beyond which highlights are not drawn.
    #[inline(always)]
    #[must_use]
    pub(crate) fn new(part: u8, h: u32, cosine: i32, exponent: u16) -> Self {
        // n e² is 4 h n, and the first row lies at 2^-8: there h n is 2^6.
        const FIRST: u32 = HAVERSINE - 10;
        let size = (h * u32::from(exponent)).max(1 << FIRST);
        let zeros = size.leading_zeros();
        let row = (31 - FIRST).saturating_sub(zeros) as usize;
        let (row, beyond) = if row < ROWS - 1 { (row, (size << zeros << 1) >> 16) } else { (ROWS - 1, 1 << 16) };
        let below = ((1 << COSINE) - cosine).max(0) as u32 >> 4;
        let column = (below.wrapping_mul(exponent.into()) >> (COSINE - 4 - COLUMNS_A_UNIT.ilog2())) as usize;
        Self { errors: ERRORS.get(usize::from(part)).unwrap_or(&ERRORS[0]), row, column: column % COLUMNS, beyond }
    }

    /// The largest error of a kind but [`Kind::Cosines`], of a highlight with the level `specular` at its peak, Q9.7.
    #[inline(always)]
    #[must_use]
    pub(crate) fn error(self, kind: Kind, specular: u32) -> u32 {
        match self.errors[kind as usize].get(self.row..) {
            Some([less, more, ..]) => {
                let (less, more) = (u32::from(less[self.column]), u32::from(more[self.column]));
                ((specular * (less + (((more - less) * self.beyond) >> 16) + 1)) >> SHARE) + 1
            }
            _ => u32::MAX >> 1,
        }
    }

    /// The largest error of [`Kind::Cosines`], of a highlight with the level `specular` at its peak, and `narrowed`, the same times
    /// [`USUAL_EXPONENT`] over the exponent; Q9.7. No error exceeds `specular`, because a power is between 0 and 1.
    #[inline(always)]
    #[must_use]
    pub(crate) fn error_of_cosines(self, specular: u32, narrowed: u32) -> u32 {
        match self.errors[Kind::Cosines as usize].get(self.row..) {
            Some([less, more, ..]) if more[self.column] < u16::MAX => {
                let (less, more) = (u32::from(less[self.column]), u32::from(more[self.column]));
                (unsigned_product(narrowed, less + (((more - less) * self.beyond) >> 16) + 1) >> SHARE) as u32 + 1
            }
            _ => specular,
        }
    }

    /// What corners may be off because their normals are longer or shorter than 1 by up to 2^-15, at an exponent above [`EXACT`]: by that
    /// times the exponent of the brightest highlight on the triangle, w^n, which is no more than 2^-n(1 - w).
    #[inline(always)]
    #[must_use]
    pub(crate) fn rounding(self, exponent: u16, specular: u32) -> u32 {
        if exponent <= EXACT {
            return 0;
        }
        ((specular * u32::from(exponent)) >> 15 >> (self.column as u32 / COLUMNS_A_UNIT)) + 1
    }
}
