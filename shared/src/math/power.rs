//! The highlight's power function, x^n, from a table.

use crate::{
    format::{COSINE, PIXEL_COSINE},
    math::product::{product, unsigned_product, upper_by_half_word},
};
use core::num::{NonZeroU32, NonZeroU64};

/// Intervals of the table.
pub(super) const SIZE: usize = 2048;

/// x^n on [1 - 8/n, 1] in 2048 intervals (on [0, 1] for n < 8); below that it is less than e^-8 and taken as 0.
///
/// Restricting the domain makes the error independent of n (Bishop & Weimer 1986
/// use the whole of [0, 1], where the error grows with n). Entries are unsigned Q0.16, or multiples of such above a floor.
#[derive(Clone, Copy, Debug)]
pub struct Power {
    pub(super) table: [u16; SIZE + 1],
    /// 4 max(n, 8): 1 - x times 64 of it is an index.
    pub(super) scale: u32,
    /// What every entry has more.
    floor: u16,
}

/// What is raised to a power, as a function of what a table is looked up by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// x.
    Itself,
    /// The root of x.
    Root,
    /// The fourth root of x.
    FourthRoot,
    /// x², continued by a line of the same slope below 1/2: x - 1/4.
    Square,
}

impl Base {
    /// How often the root is taken.
    const fn roots(self) -> u32 {
        match self {
            Self::Itself | Self::Square => 0,
            Self::Root => 1,
            Self::FourthRoot => 2,
        }
    }
}

/// [`Base::Square`] of `x`, Q2.30.
#[must_use]
pub fn square(x: i32) -> i32 {
    if x >= 1 << (COSINE - 1) { (product(x, x) >> COSINE) as i32 } else { x - (1 << (COSINE - 2)) }
}

/// Four times the exponent up to which the whole domain is used.
const WHOLE: NonZeroU32 = NonZeroU32::new(4 * 8).unwrap();

/// Fraction bits of an entry.
pub const POWER: u32 = 16;

impl Power {
    /// An empty table, for static memory: all zeros, so that it takes no flash.
    pub const EMPTY: Self = Self { table: [0; SIZE + 1], scale: 0, floor: 0 };

    /// Computes the table of `floor + full base^n`, `n` from 1 to 1024, in integers: the same bits on every machine.
    /// `floor + full` is at most 2^16.
    pub fn fill(&mut self, n: u16, base: Base, full: u32, floor: u16) {
        let n4 = u32::from(n) << 2;
        let scale = WHOLE.max(NonZeroU32::new(if base == Base::Square { n4 << 1 } else { n4 >> base.roots() }).unwrap_or(WHOLE));
        self.scale = scale.get();
        self.floor = floor;
        for (i, entry) in self.table.iter_mut().enumerate() {
            // x = 1 - 8 i / (2048 max(n, 8)), Q1.31: products of two fit 64 bits.
            let below = ((i as u64) << 25) / NonZeroU64::from(scale);
            let x = (1u64 << 31).saturating_sub(below);
            let x = match base {
                Base::Square => (square((x >> 1) as i32).max(0) as u64) << 1,
                _ => (0..base.roots()).fold(x, |x, _| (x << 31).isqrt()),
            };
            let (mut result, mut base, mut n) = (1u64 << 31, x, n);
            while n > 0 {
                if n & 1 == 1 {
                    result = (result * base) >> 31;
                }
                base = (base * base) >> 31;
                n >>= 1;
            }
            *entry = (u64::from(floor) + ((result * u64::from(full) + (1 << 30)) >> 31)).min(0xffff) as u16;
        }
        // The lowest entry is what everything below the domain gets, in the pixel loop the one above it.
        let [.., lower, lowest] = &mut self.table;
        *lowest = floor;
        if scale > WHOLE {
            *lower = floor;
        }
    }

    /// 1 - cosine in table steps with 12 fraction bits; beyond the table for small cosines.
    #[inline(always)]
    fn position(&self, cosine: i32) -> u32 {
        let defect = (1i32 << COSINE).saturating_sub(cosine).max(0) as u32;
        // defect * 4 n / 32 * 2048 / 2^30, with 12 fraction bits.
        u32::try_from(unsigned_product(defect, self.scale) >> (COSINE - 18)).unwrap_or(u32::MAX)
    }

    /// cosine^n, unsigned Q0.16, by linear interpolation, without the floor; `cosine` in Q2.30.
    /// Error: at most [`ERROR`] of full intensity (tests::error).
    #[must_use]
    pub fn at(&self, cosine: i32) -> u32 {
        let position = self.position(cosine);
        let i = (position >> 12) as usize;
        match (self.table.get(i), self.table.get(i + 1)) {
            (Some(&a), Some(&b)) => u32::from(a) - ((u32::from(a.saturating_sub(b)) * (position & 0xfff)) >> 12) - u32::from(self.floor),
            _ => 0,
        }
    }

    /// The table for the pixel loop: entry `((top - cosine) * factor) >> 37` is the nearest to `cosine`, Q5.27.
    #[must_use]
    pub fn pixel(&self) -> PixelPower<'_> {
        let scale = NonZeroU32::new(self.scale).unwrap_or(WHOLE);
        PixelPower { table: &self.table, top: (1 << PIXEL_COSINE) + ((1 << 20) / scale) as i32, factor: (scale.get() << 16) as i32 }
    }

    /// What every entry has more.
    #[must_use]
    pub fn floor(&self) -> u32 {
        self.floor.into()
    }

    /// The entry that the pixel loop takes for small cosines.
    #[inline(always)]
    #[must_use]
    pub fn least(&self) -> u32 {
        self.table[SIZE - 1].into()
    }

    /// Smallest cosine, Q2.30, whose power is not taken as 0.
    #[must_use]
    pub fn dark_below(&self) -> i32 {
        (1i32 << COSINE) - ((32u64 << COSINE) / NonZeroU64::from(NonZeroU32::new(self.scale).unwrap_or(WHOLE))) as i32
    }
}

/// The nearest entry: one product, one load.
#[derive(Clone, Copy, Debug)]
pub struct PixelPower<'a> {
    table: &'a [u16; SIZE + 1],
    top: i32,
    factor: i32,
}

impl PixelPower<'_> {
    /// cosine^n, unsigned Q0.16, with the floor; `cosine` in Q5.27. Error: [`NEAREST_ERROR`].
    #[inline(always)]
    #[must_use]
    pub fn at(&self, cosine: i32) -> u32 {
        let fine = upper_by_half_word(self.top.wrapping_sub(cosine), self.factor);
        // One instruction shifts and clamps, and nothing is left to check.
        self.table[(fine >> 5).clamp(0, SIZE as i32 - 1) as usize].into()
    }
}

/// Error of [`Power::at`]: the cut at e^-8 and rounding to 16 bits, together 0.09 LSB.
pub const ERROR: f64 = 3.6e-4;
/// Error of [`PixelPower::at`]: half a step of the table, 0.5 LSB.
pub const NEAREST_ERROR: f64 = 2.1e-3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error() {
        for n in [1u16, 2, 5, 7, 8, 9, 20, 50, 128, 500, 1024] {
            for base in [Base::Itself, Base::Root, Base::FourthRoot, Base::Square] {
                if n >> base.roots() == 0 {
                    continue;
                }
                let mut power = Power::EMPTY;
                power.fill(n, base, 1 << 16, 0);
                let (mut at, mut nearest) = (0f64, 0f64);
                for i in 0..200_000u32 {
                    let cosine = (1 << 30) - (i * 5_368) as i32;
                    let x = f64::from(cosine) / 2f64.powi(30);
                    let x = match base {
                        Base::Square if x >= 0.5 => x * x,
                        Base::Square => (x - 0.25).max(0.0),
                        _ => x.max(0.0).powf(1.0 / f64::from(1 << base.roots())),
                    };
                    let exact = x.powi(n.into());
                    at = at.max((f64::from(power.at(cosine)) / 65_536.0 - exact).abs());
                    nearest = nearest.max((f64::from(power.pixel().at(cosine >> 3)) / 65_536.0 - exact).abs());
                }
                assert!(at <= ERROR, "n = {n}, {base:?}: {at}");
                assert!(nearest <= NEAREST_ERROR, "n = {n}, {base:?}: {nearest}");
                assert_eq!(power.at(power.dark_below() - (1 << 15)), 0, "n = {n}, {base:?}");
            }
        }
    }
}
