//! The highlight's power function, x^n, from a table.

use crate::format::COSINE;
use core::num::{NonZeroU32, NonZeroU64};

/// Intervals of the table.
const SIZE: usize = 2048;

/// x^n on [1 - 8/n, 1] in 2048 intervals (on [0, 1] for n < 8); below that it is less than e^-8 and taken as 0.
///
/// Restricting the domain makes the error independent of n (Bishop & Weimer 1986
/// use the whole of [0, 1], where the error grows with n). Entries are unsigned Q0.16.
#[derive(Clone, Copy, Debug)]
pub struct Power {
    table: [u16; SIZE + 1],
    /// max(n, 8): turns 1 - x into an index.
    scale: u32,
}

/// Exponents below it use the whole domain.
const EIGHT: NonZeroU32 = NonZeroU32::new(8).unwrap();

/// Fraction bits of an entry.
pub const POWER: u32 = 16;

impl Power {
    /// An empty table, for static memory: all zeros, so that it takes no flash.
    pub const EMPTY: Self = Self { table: [0; SIZE + 1], scale: 0 };

    /// Computes the table for exponent `n`, 1 to 1024, in integers: the same bits on every machine.
    pub fn fill(&mut self, n: u16) {
        let scale = EIGHT.max(NonZeroU32::new(n.into()).unwrap_or(EIGHT));
        self.scale = scale.get();
        for (i, entry) in self.table.iter_mut().enumerate() {
            // x = 1 - 8 i / (2048 max(n, 8)), Q1.31: products of two fit 64 bits.
            let below = ((i as u64) << 23) / NonZeroU64::from(scale);
            let x = (1u64 << 31).saturating_sub(below);
            let (mut result, mut base, mut n) = (1u64 << 31, x, n);
            while n > 0 {
                if n & 1 == 1 {
                    result = (result * base) >> 31;
                }
                base = (base * base) >> 31;
                n >>= 1;
            }
            *entry = ((result + (1 << 14)) >> 15).min(0xffff) as u16;
        }
        // The lowest entry is what everything below the domain gets.
        if let Some(last) = self.table.last_mut() {
            *last = 0;
        }
    }

    /// 1 - cosine in table steps with 12 fraction bits; beyond the table for small cosines.
    #[inline(always)]
    fn position(&self, cosine: i32) -> u32 {
        let defect = (1i32 << COSINE).saturating_sub(cosine).max(0) as u32;
        // defect * n / 8 * 2048 / 2^30, with 12 fraction bits.
        u32::try_from((u64::from(defect) * u64::from(self.scale)) >> (COSINE - 20)).unwrap_or(u32::MAX)
    }

    /// cosine^n, unsigned Q0.16, by linear interpolation; `cosine` in Q2.30.
    /// Error: at most [`ERROR`] of full intensity (tests::error).
    #[must_use]
    pub fn at(&self, cosine: i32) -> u32 {
        let position = self.position(cosine);
        let i = (position >> 12) as usize;
        match (self.table.get(i), self.table.get(i + 1)) {
            (Some(&a), Some(&b)) => u32::from(a) - ((u32::from(a.saturating_sub(b)) * (position & 0xfff)) >> 12),
            _ => 0,
        }
    }

    /// cosine^n, unsigned Q0.16, from the nearest entry: for the pixel loop.
    /// Error: at most [`NEAREST_ERROR`] of full intensity (tests::error).
    #[inline(always)]
    #[must_use]
    pub fn nearest(&self, cosine: i32) -> u32 {
        let i = (self.position(cosine) + (1 << 11)) >> 12;
        self.table.get(i as usize).copied().unwrap_or(0).into()
    }

    /// The table with what an index takes: entry `((top - cosine) * factor) >> 32` is the nearest to `cosine`, Q5.27.
    #[must_use]
    pub fn pixel(&self) -> PixelPower<'_> {
        let scale = NonZeroU32::new(self.scale).unwrap_or(EIGHT);
        PixelPower { table: &self.table, top: (1 << 27) + ((1 << 18) / scale) as i32, factor: scale.get() << 13 }
    }

    /// Smallest cosine, Q2.30, whose power is not taken as 0.
    #[must_use]
    pub fn dark_below(&self) -> i32 {
        (1i32 << COSINE) - ((8u64 << COSINE) / NonZeroU64::from(NonZeroU32::new(self.scale).unwrap_or(EIGHT))) as i32
    }
}

/// [`Power::nearest`] for the pixel loop: one product, one load.
#[derive(Clone, Copy, Debug)]
pub struct PixelPower<'a> {
    table: &'a [u16; SIZE + 1],
    top: i32,
    factor: u32,
}

impl PixelPower<'_> {
    /// cosine^n, unsigned Q0.16; `cosine` in Q5.27. Error: [`NEAREST_ERROR`].
    #[inline(always)]
    #[must_use]
    pub fn at(&self, cosine: i32) -> u32 {
        let defect = self.top.wrapping_sub(cosine).max(0) as u32;
        let i = (u64::from(defect) * u64::from(self.factor)) >> 32;
        self.table.get(i as usize).copied().unwrap_or(0).into()
    }
}

/// Error of [`Power::at`]: the cut at e^-8 and rounding to 16 bits, together 0.09 LSB.
pub const ERROR: f64 = 3.6e-4;
/// Error of [`Power::nearest`]: half a step of the table, 0.5 LSB.
pub const NEAREST_ERROR: f64 = 2.1e-3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error() {
        for n in [1u16, 2, 5, 7, 8, 9, 20, 50, 128, 500, 1024] {
            let mut power = Power::EMPTY;
            power.fill(n);
            let (mut at, mut nearest, mut pixel) = (0f64, 0f64, 0f64);
            for i in 0..200_000u32 {
                let cosine = (1 << 30) - (i * 5_368) as i32;
                let exact = (f64::from(cosine) / 2f64.powi(30)).max(0.0).powi(n.into());
                at = at.max((f64::from(power.at(cosine)) / 65_536.0 - exact).abs());
                nearest = nearest.max((f64::from(power.nearest(cosine)) / 65_536.0 - exact).abs());
                pixel = pixel.max((f64::from(power.pixel().at(cosine >> 3)) / 65_536.0 - exact).abs());
            }
            assert!(at <= ERROR, "n = {n}: {at}");
            assert!(nearest <= NEAREST_ERROR, "n = {n}: {nearest}");
            assert!(pixel <= NEAREST_ERROR, "n = {n}: {pixel}");
            assert_eq!(power.at(power.dark_below() - (1 << 15)), 0, "n = {n}");
        }
    }
}
