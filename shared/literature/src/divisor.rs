//! Division by fixed-point numbers.

use microphong::math::recip::recip;

/// Largest error of [`Divisor::divide`] relative to its result, before that is rounded down to an integer.
pub const DIVIDE_ERROR: f64 = 2.25 / (1u32 << 30) as f64;

/// A positive number to divide by, from Q2.30.
#[derive(Clone, Copy, Debug, Default)]
pub struct Divisor {
    /// [`recip`] of the number, shifted left until its first bit is set.
    inverse: u32,
    /// Places that the number was shifted by.
    zeros: u32,
}

impl Divisor {
    /// The divisor `x`, unsigned Q2.30; 0 counts as the smallest number, 2^-30.
    #[inline]
    #[must_use]
    pub fn new(x: u32) -> Self {
        let zeros = x.max(1).leading_zeros();
        Self { inverse: recip(x << (zeros & 31)), zeros }
    }

    /// `value / x` in the format of `value`, rounded down; a quotient that does not fit saturates.
    ///
    /// Domain: every `i32`. Error: at most [`DIVIDE_ERROR`] relative, and 1 unit for rounding (tests::divisions). Source: a product
    /// with the reciprocal.
    #[inline]
    #[must_use]
    pub fn divide(self, value: i32) -> i32 {
        let product = (i64::from(value) * i64::from(self.inverse as i32)) >> (32 - self.zeros.min(31));
        product.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn divisions() {
        let mut worst = 0f64;
        for seed in 1..500_000i32 {
            let c = |k: i32, shift: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> (seed / shift % 28);
            let (value, x) = (c(1_664_525, 1), (c(22_695_477, 28) as u32).max(1));
            let exact = f64::from(value) * f64::from(1 << 30) / f64::from(x);
            let got = f64::from(Divisor::new(x).divide(value));
            if exact.abs() < f64::from(i32::MAX) {
                worst = worst.max(((got - exact).abs() - 1.0) / exact.abs().max(1.0));
            } else {
                // Next to the largest number that fits, the error of the quotient shows.
                assert!((got - exact.clamp(f64::from(i32::MIN), f64::from(i32::MAX))).abs() <= 1.0 + DIVIDE_ERROR * 2f64.powi(31));
            }
        }
        assert!(worst <= DIVIDE_ERROR, "{worst:e}");
    }
}
