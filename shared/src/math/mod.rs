//! Integer mathematics, one function a file: method, domain, error and the test that proves it.

#[cfg(feature = "all-shaders")]
pub mod angle;
#[cfg(feature = "all-shaders")]
pub mod arc;
pub mod power;
pub mod product;
pub mod quotient;
pub mod recip;
pub mod rsqrt;
pub mod steps;
pub mod vector;
pub mod wide;
pub mod zeros;

/// `value / 2^bits` rounded to nearest; for negative `bits` a left shift that wraps.
#[inline(always)]
#[must_use]
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

/// [`scale`] in 128 bits; `bits` is at most 126.
#[inline(never)]
#[must_use]
pub fn scale_wide(value: i128, bits: i32) -> i128 {
    if bits > 0 {
        let bits = bits.unsigned_abs().min(126);
        value.wrapping_add(1 << (bits - 1)) >> bits
    } else {
        value.wrapping_shl(bits.unsigned_abs())
    }
}
