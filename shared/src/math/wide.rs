//! Integers of 128 bits whose products are function calls.
//!
//! One product takes a hundred instructions on a 32-bit processor when it is inlined. Formulas with forty products are needed for rare triangles
//! only, and must not fill the flash.

use crate::arch::quotient::by_word;
use core::{
    num::NonZeroU32,
    ops::{Add, Mul, Neg, Sub},
};

/// An integer of 128 bits. Sums, differences and products are exact modulo 2^128.
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
    /// The quotient by a word, rounded down, in long division by words: a quarter of the instructions of a division of `i128`. Exact
    /// (tests::divisions).
    #[inline(never)]
    pub fn over(self, divisor: NonZeroU32) -> Self {
        // Of a negative number: what is left of its size is below it, so that its complement is divided.
        let sign = (self.0 >> 127) as u128;
        let size = self.0 as u128 ^ sign;
        let (mut quotient, mut rest) = (0u128, 0);
        for word in [96, 64, 32, 0] {
            let digit;
            (digit, rest) = by_word([rest, (size >> word) as u32], divisor);
            quotient = quotient << 32 | u128::from(digit);
        }
        Self((quotient ^ sign) as i128)
    }

    /// Multiplies by 2^`bits`, modulo 2^128. Domain: `bits` is less than 128. Exact.
    #[inline(never)]
    pub fn shifted(self, bits: u32) -> Self {
        Self(self.0.wrapping_shl(bits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn divisions(value: i128, divisor in 1..=u32::MAX, bits in 0..32u32) {
            let divisor = NonZeroU32::new(divisor >> bits).unwrap_or(NonZeroU32::MIN);
            prop_assert_eq!(Wide(value).over(divisor), Wide(value.div_euclid(divisor.get().into())));
        }
    }
}
