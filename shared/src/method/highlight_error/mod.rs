//! How much interpolation is off from a highlight: the largest errors on triangles of all sizes, as tables.
//!
//! What interpolation is off from (N·H/|N|)^n on a triangle is about the same function of its size n (1 - ρ) and its depth n (1 - w) for all
//! exponents n, where ρ is the least length of N on the triangle, and w the largest N·H at a corner over ρ. Tables have a part for each range
//! of exponents, and a column for each fourth of the depth.
//!
//! Errors of linear interpolation grow with the size, and more slowly where triangles reach into the tail of a highlight: they lie below two
//! straight lines, which [`LINEAR`] has. For quadratics [`CURVED`] has a row for each octave of the size, between which straight lines are no less than the errors.
//!
//! All are computed by `microphong bounds`: the largest error that a search found on any triangle of at most a size and at least a depth, and
//! a margin; `tests/suite/bounds.rs` searches anew. What is larger than the search went is off by no more than the brightest highlight, by
//! the quadratic 4/3 of it.

mod table;

use crate::{arch::product::unsigned_product, format::NORMAL_LENGTH};
pub use table::{CURVED, LINEAR};

/// Errors that the tables know.
pub const KINDS: usize = 4;
/// Rows for octaves of n (1 - ρ).
pub const ROWS: usize = 14;
/// Rows behind them, for all that is larger: two, between which interpolation changes nothing.
pub const ROWS_BEHIND: usize = 2;
/// Columns, each a fourth of a unit of n (1 - w).
pub const COLUMNS: usize = 32;
/// Columns to a unit of n (1 - w).
pub const COLUMNS_A_UNIT: u32 = 4;
/// n (1 - ρ) of the first row, which holds for all that is smaller.
pub const LEAST_SIZE: f64 = 1.0 / (1 << LEAST_SIZE_BITS) as f64;
const LEAST_SIZE_BITS: u32 = 11;
/// n (1 - ρ) of the largest triangles of [`LINEAR`].
pub const LINEAR_SIZE: f64 = (1 << LINEAR_SIZE_BITS) as f64;
const LINEAR_SIZE_BITS: u32 = 1;
/// The least exponent of each part.
pub const LEAST_EXPONENTS: [u16; 3] = [1, 5, 16];
/// The largest exponent at which what rounding of normals does to the highlights at corners is left to what arithmetic may add: it is less than
/// half an LSB.
pub(crate) const EXACT: u16 = 64;
/// The exponent for which errors of [`Kind::Cosines`] stand in the table as they are.
pub const USUAL_EXPONENT: u16 = 16;
/// Fraction bits of an error, a share of the whole highlight; the largest stands for any error.
pub const SHARE: u32 = 15;
/// Fraction bits of a rate, in whole highlights to a unit of the size.
pub const RATE: u32 = 10;

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

/// How an error of linear interpolation grows with the size of triangles: it lies below two straight lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Growth {
    /// The error over the size on the first line, which goes through zero; unsigned Q6.[`RATE`], rounded up.
    pub rate: u16,
    /// The second line where the size is zero, unsigned Q1.15, rounded up.
    pub base: u16,
    /// How steep the second line is, unsigned Q6.[`RATE`], rounded up.
    pub slope: u16,
}

/// The errors [`Kind::LinearBelow`] and [`Kind::LinearAbove`] of one part, by column.
pub type Linear = [[Growth; 2]; COLUMNS];

/// The errors [`Kind::Quadratic`] and [`Kind::Cosines`] of one part by row and column, unsigned Q1.15, rounded up.
pub type Curved = [[[u16; 2]; COLUMNS]; ROWS + ROWS_BEHIND];

/// The part of the table for an exponent.
#[must_use]
pub(crate) fn part(exponent: u16) -> u8 {
    LEAST_EXPONENTS.iter().rposition(|&least| exponent >= least).unwrap_or(0) as u8
}

/// The logarithm of the size of the first row.
const FIRST: u32 = NORMAL_LENGTH - LEAST_SIZE_BITS;

/// A place in the tables.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    part: usize,
    column: usize,
    /// n (1 - ρ), at least [`LEAST_SIZE`], 15 fraction bits.
    size: u32,
}

impl Place {
    /// The place for triangles whose normals are shorter than 1 by up to `short`, where the highlight of an exponent is brightest at N·H =
    /// `cosine`; both Q1.15. Domain: `short` up to 1/5; n (1 - `cosine`) up to 8, beyond which highlights are not drawn.
    #[inline(always)]
    #[must_use]
    pub(crate) fn new(part: u8, short: u32, cosine: u32, exponent: u16) -> Self {
        let exponent = u32::from(exponent);
        let depth = (1u32 << NORMAL_LENGTH).saturating_sub(cosine).wrapping_mul(exponent);
        let column = depth >> (NORMAL_LENGTH - COLUMNS_A_UNIT.ilog2());
        Self {
            // Both change nothing, and spare the compiler tests.
            part: usize::from(part).min(LEAST_EXPONENTS.len() - 1),
            column: column as usize % COLUMNS,
            size: (short * exponent).max(1 << FIRST),
        }
    }

    /// By how much linear interpolation of a highlight with the level `specular` at its peak, Q9.7, is too dark and too bright at most.
    #[inline(always)]
    #[must_use]
    pub(crate) fn linear(self, specular: u32) -> [u32; 2] {
        if self.size > 1 << (NORMAL_LENGTH + LINEAR_SIZE_BITS) {
            return [self.brightest(specular); 2];
        }
        let [below, above] = &LINEAR[self.part][self.column];
        let level = |growth: &Growth| {
            let of_size = |rate: u16| (self.size * u32::from(rate)) >> (RATE + NORMAL_LENGTH - SHARE);
            let share = of_size(growth.rate).min(of_size(growth.slope) + u32::from(growth.base));
            ((specular * (share + 1)) >> SHARE) + 1
        };
        [level(below), level(above)]
    }

    /// The entry of a kind of [`CURVED`], between two rows; `None` behind the last one.
    #[inline(always)]
    fn entry(self, kind: Kind) -> Option<u32> {
        let size = self.size;
        let zeros = size.leading_zeros();
        let row = (31 - FIRST).wrapping_sub(zeros) as usize;
        let [less, more] = CURVED[self.part].get(row..)?.first_chunk()?;
        let entry = |row: &[[u16; 2]; COLUMNS]| u32::from(row[self.column][kind as usize - Kind::Quadratic as usize]);
        let (less, more) = (entry(less), entry(more));
        Some(less + (((more - less) * (size << zeros << 1 >> 16)) >> 16) + 1).filter(|_| row < ROWS - 1)
    }

    /// The largest error of [`Kind::Quadratic`], of a highlight with the level `specular` at its peak, Q9.7.
    #[inline(always)]
    #[must_use]
    pub(crate) fn error_of_quadratic(self, specular: u32) -> u32 {
        match self.entry(Kind::Quadratic) {
            Some(entry) => ((specular * entry) >> SHARE) + 1,
            None => 2 * self.brightest(specular),
        }
    }

    /// The largest error of [`Kind::Cosines`], of a highlight with the level `specular` at its peak, and `narrowed`, the same times
    /// [`USUAL_EXPONENT`] over the exponent; Q9.7. No error exceeds `specular`, because a power is between 0 and 1.
    #[inline(always)]
    #[must_use]
    pub(crate) fn error_of_cosines(self, specular: u32, narrowed: u32) -> u32 {
        match self.entry(Kind::Cosines) {
            Some(entry) => (unsigned_product(narrowed, entry) >> SHARE) as u32 + 1,
            None => specular,
        }
    }

    /// The level of the brightest highlight on the triangle, at most: w^n is no more than 2^-n(1 - w).
    #[inline(always)]
    #[must_use]
    pub(crate) fn brightest(self, specular: u32) -> u32 {
        (specular >> (self.column as u32 / COLUMNS_A_UNIT)) + 1
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
