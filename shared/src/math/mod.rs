//! Mathematics in integers.
//!
//! Formats are written Qm.f: m integer bits, the sign included, and f fraction bits. Each function states its meaning, format, domain, error and
//! source. An error bound is a constant next to the function, and the test that the documentation names asserts this constant. "Exact" means that the
//! result is the integer that the formula gives, for every argument of the domain.

pub(crate) mod highlight_lookup;
pub mod highlight_lut;
pub mod recip;
pub mod rsqrt;
pub mod vector;
pub mod wide;

/// For the crate of the literature.
pub use crate::arch::product::upper;

/// `value / 2^bits`, rounded to nearest, halves up; for negative `bits` a left shift that wraps modulo 2^64.
///
/// Domain: `value + 2^(bits - 1)` fits 64 bits. Above 62 bits, and below -63, the result is 0. Exact (tests::scaling).
#[inline]
pub fn scale(value: i64, bits: i32) -> i64 {
    if bits > 62 {
        0
    } else if bits > 0 {
        value.wrapping_add(1 << (bits - 1)) >> bits
    } else if bits > -64 {
        value.wrapping_shl(bits.unsigned_abs())
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling() {
        for value in [0, 1, -1, 5, -5, 0x1234_5678_9ABC, -0x1234_5678_9ABC, (1 << 62) - 1, -(1 << 62)] {
            for bits in 1..63 {
                let nearest = (i128::from(value) + (1 << (bits - 1))).div_euclid(1 << bits);
                assert_eq!(i128::from(scale(value, bits)), nearest, "{value} {bits}");
            }
            for bits in 0..64u32 {
                let left = i128::from(value) << bits;
                assert_eq!(scale(value, -(bits as i32)), left as i64, "{value} -{bits}");
            }
            assert_eq!([scale(value, 63), scale(value, -64)], [0; 2]);
        }
    }
}
