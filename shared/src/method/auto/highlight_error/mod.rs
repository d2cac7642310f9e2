//! Errors of interpolated highlights: the largest errors on triangles of all sizes, as tables.
//!
//! The error of interpolating (N·H/|N|)^n on a triangle is about the same function of its size n (1 - ρ) and its depth n (1 - w) for all exponents n,
//! where ρ is the smallest length of N on the triangle, and w the largest N·H at a corner over ρ. Tables have a part for each range of exponents, and
//! a column for each fourth of the depth.
//!
//! Errors of linear interpolation grow with the size, and more slowly where triangles reach into the tail of a highlight. They lie below two straight
//! lines, which are in [`LINEAR`]. For quadratics [`CURVED`] has a row for each octave of the size. Errors between rows lie below the straight line
//! between these.
//!
//! `microphong bounds` computes all tables: each entry is the largest error that a search found on any triangle of at most a size and at least a
//! depth, plus a margin. `tests/suite/bounds.rs` searches again. The error of larger triangles is at most the brightest highlight, or 4/3 of it by
//! the quadratic.

mod table;

use crate::{arch::product::unsigned_product, format::NORMAL_LENGTH};
pub use table::{CURVED, LINEAR};

/// Number of kinds of errors in the tables.
pub const KINDS: usize = 4;
/// Number of rows, one for each octave of n (1 - ρ).
pub const ROWS: usize = 14;
/// Number of rows behind them, for all larger sizes: two, between which interpolation changes nothing.
pub const ROWS_BEHIND: usize = 2;
/// Number of columns, each a fourth of a unit of n (1 - w).
pub const COLUMNS: usize = 32;
/// Number of columns in a unit of n (1 - w).
pub const COLUMNS_A_UNIT: u32 = 4;
/// Size n (1 - ρ) of the first row, which holds for all smaller sizes.
pub const LEAST_SIZE: f64 = 1.0 / (1 << LEAST_SIZE_BITS) as f64;
const LEAST_SIZE_BITS: u32 = 11;
/// Size n (1 - ρ) of the largest triangles in [`LINEAR`].
pub const LINEAR_SIZE: f64 = (1 << LINEAR_SIZE_BITS) as f64;
const LINEAR_SIZE_BITS: u32 = 1;
/// The smallest exponent of each part.
pub const LEAST_EXPONENTS: [u16; 3] = [1, 5, 16];
/// The largest exponent at which bounds need not include the rounding of normals at corners, because it changes highlights by less than half of
/// 1/255.
pub(crate) const EXACT: u16 = 64;
/// The exponent for which the table holds errors of [`Kind::Cosines`] without a factor.
pub const USUAL_EXPONENT: u16 = 16;
/// Fraction bits of an error, as a part of the whole highlight. The largest number stands for any error.
pub const SHARE: u32 = 15;
/// Fraction bits of a rate, in whole highlights to a unit of the size.
pub const RATE: u32 = 10;

/// A kind of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Linear interpolation between corners is too dark.
    LinearBelow,
    /// Linear interpolation between corners is too bright.
    LinearAbove,
    /// The quadratic through six points is off, in either direction.
    Quadratic,
    /// The power of the quadratic through N·H at six points is off, in either direction. The error is multiplied by the exponent over
    /// [`USUAL_EXPONENT`], because it becomes smaller as highlights become narrower.
    Cosines,
}

/// Growth of an error of linear interpolation with the size of triangles. The error lies below two straight lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Growth {
    /// Slope of the first line, which goes through zero; unsigned Q6.[`RATE`], rounded up.
    pub rate: u16,
    /// Value of the second line at size zero, unsigned Q1.15, rounded up.
    pub base: u16,
    /// Slope of the second line, unsigned Q6.[`RATE`], rounded up.
    pub slope: u16,
}

/// The errors [`Kind::LinearBelow`] and [`Kind::LinearAbove`] of one part, by column.
pub type LinearTable = [[Growth; 2]; COLUMNS];

/// The errors [`Kind::Quadratic`] and [`Kind::Cosines`] of one part by row and column, unsigned Q1.15, rounded up.
pub type Curved = [[[u16; 2]; COLUMNS]; ROWS + ROWS_BEHIND];

/// The part of the table for an exponent.
pub(crate) fn part(exponent: u16) -> u8 {
    LEAST_EXPONENTS.iter().rposition(|&least| exponent >= least).unwrap_or(0) as u8
}

/// The logarithm of the size of the first row.
const FIRST: u32 = NORMAL_LENGTH - LEAST_SIZE_BITS;

/// A place in the tables.
#[derive(Clone, Copy)]
pub(crate) struct TablePlace {
    part: usize,
    column: usize,
    /// n (1 - ρ), at least [`LEAST_SIZE`], 15 fraction bits.
    size: u32,
}

impl TablePlace {
    /// The place for triangles whose normals are shorter than 1 by up to `short`, where the highlight of an exponent is brightest at N·H =
    /// `cosine`; both Q1.15. Domain: `short` up to 1/5; n (1 - `cosine`) up to 8, beyond which highlights are not drawn.
    #[inline]
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

    /// Largest amounts by which linear interpolation of a highlight is too dark and too bright. The level at the highlight's peak is `specular`,
    /// Q9.7.
    #[inline]
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

    /// The entry of [`CURVED`] for a kind of error, interpolated between two rows; `None` behind the last row.
    #[inline]
    fn entry(self, kind: Kind) -> Option<u32> {
        let size = self.size;
        let zeros = size.leading_zeros();
        let row = (31 - FIRST).wrapping_sub(zeros) as usize;
        let [less, more] = CURVED[self.part].get(row..)?.first_chunk()?;
        let entry = |row: &[[u16; 2]; COLUMNS]| u32::from(row[self.column][kind as usize - Kind::Quadratic as usize]);
        let (less, more) = (entry(less), entry(more));
        Some(less + (((more - less) * (size << zeros << 1 >> 16)) >> 16) + 1).filter(|_| row < ROWS - 1)
    }

    /// The largest error of [`Kind::Quadratic`] for a highlight with the level `specular` at its peak, Q9.7.
    #[inline]
    pub(crate) fn error_of_quadratic(self, specular: u32) -> u32 {
        match self.entry(Kind::Quadratic) {
            Some(entry) => ((specular * entry) >> SHARE) + 1,
            None => 2 * self.brightest(specular),
        }
    }

    /// The largest error of [`Kind::Cosines`] for a highlight with the level `specular` at its peak, Q9.7. `narrowed` is `specular` times
    /// [`USUAL_EXPONENT`] over the exponent. No error exceeds `specular`, because a power is between 0 and 1.
    #[inline]
    pub(crate) fn error_of_cosines(self, specular: u32, narrowed: u32) -> u32 {
        match self.entry(Kind::Cosines) {
            Some(entry) => (unsigned_product(narrowed, entry) >> SHARE) as u32 + 1,
            None => specular,
        }
    }

    /// Upper bound for the level of the brightest highlight on the triangle: w^n is at most 2^-n(1 - w).
    #[inline]
    pub(crate) fn brightest(self, specular: u32) -> u32 {
        (specular >> (self.column as u32 / COLUMNS_A_UNIT)) + 1
    }

    /// Error of light at corners whose normals are longer or shorter than 1 by up to 2^-15, at an exponent above [`EXACT`]. It is this times the
    /// exponent times the brightest highlight on the triangle, w^n, which is at most 2^-n(1 - w).
    #[inline]
    pub(crate) fn rounding(self, exponent: u16, specular: u32) -> u32 {
        if exponent <= EXACT {
            return 0;
        }
        ((specular * u32::from(exponent)) >> 15 >> (self.column as u32 / COLUMNS_A_UNIT)) + 1
    }
}
