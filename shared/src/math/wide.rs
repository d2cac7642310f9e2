//! Integers of 128 bits whose products are calls.
//!
//! Written out, one product takes a hundred instructions on a 32-bit machine; formulas with forty of them are for
//! rare triangles and must not fill the flash.

use core::ops::{Add, Mul, Neg, Sub};

/// An integer of 128 bits; it wraps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wide(pub i128);

impl From<i32> for Wide {
    #[inline]
    fn from(value: i32) -> Self {
        Self(value.into())
    }
}

impl Mul for Wide {
    type Output = Self;

    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        Self(self.0.wrapping_mul(other.0))
    }
}

impl Mul<Wide> for i128 {
    type Output = Wide;

    #[inline]
    fn mul(self, other: Wide) -> Wide {
        Wide(self) * other
    }
}

impl Add for Wide {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl Sub for Wide {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Wide {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

impl Wide {
    /// Quotient, rounded down, and remainder of a division by a positive number; zeros for others.
    #[inline(never)]
    #[must_use]
    pub fn divided(self, divisor: Self) -> (Self, Self) {
        let quotient = if divisor.0 > 0 { self.0.checked_div_euclid(divisor.0).unwrap_or(0) } else { 0 };
        let rest = if divisor.0 > 0 { self.0.wrapping_sub(quotient.wrapping_mul(divisor.0)) } else { 0 };
        (Self(quotient), Self(rest))
    }

    /// Times 2^`bits`, `bits` below 128.
    #[inline(never)]
    #[must_use]
    pub fn shifted(self, bits: u32) -> Self {
        Self(self.0.wrapping_shl(bits))
    }
}
