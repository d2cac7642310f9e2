//! Reciprocal of a normalised integer.

use super::{
    product::{product, unsigned_product},
    quotient::inverse,
};

/// 2^62 / d for `d` in [2^31, 2^32): between 2^30 and 2^31 - 1, so that it fits an `i32` too (tests::error).
///
/// One 32-bit division of the upper half gives 15 bits, one Newton step the rest.
/// Error: at most [`ERROR`] units (tests::error).
#[inline]
#[must_use]
pub fn recip(d: u32) -> u32 {
    let d = d | 1 << 31;
    // 2^47 / d from the upper 16 bits, rounded up: in (2^15, 2^16].
    let high = inverse(d >> 16) >> 1;
    let x = high << 15;
    // x (2 - d x / 2^62) / 1, with d x / 2^62 so close to 1 that the defect, in 2^-31, fits 18 bits.
    let defect = (1u32 << 31).wrapping_sub((unsigned_product(d, x) >> 31) as u32) as i32;
    x.wrapping_add((product(x as i32, defect) >> 31) as u32)
}

/// A number to divide by, Q2.30.
#[cfg(feature = "all-shaders")]
#[derive(Clone, Copy, Debug)]
pub struct Divisor {
    /// 1/x, scaled up until its first bit is set.
    inverse: u32,
    zeros: u32,
}

#[cfg(feature = "all-shaders")]
impl Divisor {
    /// `x` in Q2.30; 0 counts as the smallest number.
    #[inline(always)]
    #[must_use]
    pub fn new(x: u32) -> Self {
        let zeros = x.max(1).leading_zeros();
        Self { inverse: recip(x << (zeros & 31)), zeros }
    }

    /// `value / x`, same format as `value`; at most what fits by saturation.
    #[inline(always)]
    #[must_use]
    pub fn divide(self, value: i32) -> i32 {
        let product = product(value, self.inverse as i32) >> (32 - self.zeros.min(31));
        product.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    }
}

/// Largest error of [`recip`], in units of its result: relative 2^-29.
pub const ERROR: u32 = 2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error() {
        let mut worst = 0;
        let mut d = 1u32 << 31;
        while d < u32::MAX - 70_000 {
            for d in [d, d | 0xffff, d.next_multiple_of(1 << 16)] {
                worst = worst.max(((1u64 << 62) / u64::from(d)).abs_diff(recip(d).into()));
                assert!(recip(d) < 1 << 31, "{d}");
            }
            d += 65_521;
        }
        assert!(worst <= u64::from(ERROR), "{worst}");
    }
}
