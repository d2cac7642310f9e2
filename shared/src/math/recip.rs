//! Reciprocals of normalised integers.

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
pub fn quotient(n: u64, d: u64) -> u64 {
    let (bits, zeros) = (n.leading_zeros(), d.leading_zeros());
    if n == 0 || d == 0 {
        return 0;
    }
    let upper = |number: u64, zeros: u32| (number << (zeros & 63) >> 32) as u32;
    let product = unsigned_product(upper(n, bits), recip(upper(d, zeros)));
    (2 * product).checked_shr(63 + bits - zeros).unwrap_or(0)
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
}
