//! Reciprocals of normalised integers, and division by fixed-point numbers.

use crate::arch::{
    product::{product, unsigned_product},
    quotient::inverse,
};

/// Largest error of [`recip`], in units of its result: 2^-28.4 relative to it.
pub const ERROR: u32 = 3;

/// Reciprocal `2^62 / d`: 1/x in Q2.30 for x in [1, 2), where `d` is x in Q1.31.
///
/// Domain: `d` from 2^31; the first bit counts as set. The result is 2^30 - 2 to 2^31 - 1, so it fits an `i32` too.
/// Error: at most [`ERROR`] units below the exact quotient, at most 1 above it (tests::error; measured on every argument).
/// Source: the method of Newton; one 32-bit division of the upper half gives the first 15 bits, one step the rest.
#[inline]
#[must_use]
pub fn recip(d: u32) -> u32 {
    let d = d | 1 << 31;
    // 2^47 / d from the upper 16 bits, rounded up: in (2^15, 2^16].
    let high = inverse(d >> 16) >> 1;
    let x = high << 15;
    // x (2 - d x / 2^62) / 1, with d x / 2^62 so close to 1 that the residual, in 2^-31, fits 18 bits.
    let residual = (1u32 << 31).wrapping_sub((unsigned_product(d, x) >> 31) as u32) as i32;
    x.wrapping_add((product(x as i32, residual) >> 31) as u32)
}

/// Largest error of [`quotient`] relative to its result, before that is rounded down to an integer.
pub const QUOTIENT_ERROR: f64 = 1.0 / (1u32 << 28) as f64;

/// Approximates `n / d`, for long numbers whose quotient need not be exact.
///
/// Domain: all numbers; 0 where `d` is 0. Error: at most [`QUOTIENT_ERROR`] relative, and 1 unit for rounding (tests::quotients). Source: a
/// product of the upper word of `n` with the reciprocal of that of `d`.
#[must_use]
pub fn quotient(n: u64, d: u64) -> u64 {
    let (bits, zeros) = (n.leading_zeros(), d.leading_zeros());
    if n == 0 || d == 0 {
        return 0;
    }
    let upper = |number: u64, zeros: u32| (number << (zeros & 63) >> 32) as u32;
    let product = unsigned_product(upper(n, bits), recip(upper(d, zeros)));
    (2 * product).checked_shr(63 + bits - zeros).unwrap_or(0)
}

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
        let product = product(value, self.inverse as i32) >> (32 - self.zeros.min(31));
        product.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error() {
        let (mut low, mut high) = (0f64, 0f64);
        let mut check = |d: u32| {
            // Times d, so that the exact quotient needs no rounding.
            let over = i128::from(recip(d)) * i128::from(d) - (1 << 62);
            let error = over as f64 / f64::from(d);
            (low, high) = (low.max(-error), high.max(error));
            assert!((1 << 30) - 2 <= recip(d) && recip(d) < 1 << 31, "{d}");
        };
        for d in ((1u32 << 31)..u32::MAX - 70_000).step_by(2_039) {
            [d, d | 0xffff, d.next_multiple_of(1 << 16)].into_iter().for_each(&mut check);
        }
        // The worst of all arguments.
        check(2_147_614_719);
        check(u32::MAX);
        assert!(low <= f64::from(ERROR) && high <= 1.0, "{low} {high}");
    }

    #[test]
    fn quotients() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed ^ seed >> 29) >> (seed >> 58)
        };
        for _ in 0..300_000 {
            let (n, d) = (random(), random().max(1));
            let (exact, quotient) = (n as f64 / d as f64, quotient(n, d));
            assert!((quotient as f64 - exact).abs() <= exact * QUOTIENT_ERROR + 1.0, "{n} {d}");
        }
        assert_eq!([quotient(5, 0), quotient(0, 5), quotient(u64::MAX, 0)], [0; 3]);
    }

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
