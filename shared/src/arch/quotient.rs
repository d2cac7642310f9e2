//! Quotients of words.
//!
//! Armv6-M has no division: a quotient is a call of 200 instructions there. A product with a reciprocal from a table takes a quarter of
//! that, and a correction by the remainder makes it exact, so both ways give the same bits (Granlund & Montgomery 1994).

use crate::arch::product::{HALVES, unsigned_product};
use core::num::NonZeroU32;

/// Largest divisor of [`slope`].
pub(crate) const LARGEST: usize = 1424;

/// Largest divisor in the table: edges of 32 rows. Few are higher, and the table with all of them would take three times the flash.
const TABLED: usize = 512;
const _: () = assert!(LARGEST.div_ceil(4) <= TABLED);

/// Reciprocals 2^32 / d, rounded down, by d; 2^32 - 1 for 1.
static INVERSES: [u32; TABLED + 1] = {
    let mut table = [u32::MAX; TABLED + 1];
    let mut d = 2;
    while d <= TABLED {
        table[d] = ((1u64 << 32) / d as u64) as u32;
        d += 1;
    }
    table
};

/// Fraction bits of a [`slope`].
pub(crate) const SLOPE: u32 = 21;

/// Slope n / d, rounded down, with [`SLOPE`] fraction bits: `n 2^21 / d`.
///
/// Domain: `n` is -1023 to 1023, `d` is 1 to [`LARGEST`]; other arguments give a number without meaning. Exact
/// (tests::every_slope_is_exact, on every argument). Source: a reciprocal from a table, corrected by the remainder.
#[inline]
pub(crate) fn slope(n: i32, d: i32) -> i32 {
    if HALVES { by_table(n, d) } else { (n << SLOPE).div_euclid(d.max(1)) }
}

#[inline(never)]
fn by_table(n: i32, d: i32) -> i32 {
    let (size, divisor) = (n.unsigned_abs(), d as u32);
    let tabled = INVERSES.get(d as usize);
    // Or that of the next multiple of four: too small by less than a hundredth.
    let inverse = tabled.copied().unwrap_or_else(|| INVERSES.get(divisor.div_ceil(4) as usize).copied().unwrap_or(0) >> 2);
    // The upper half of n 2^21 inverse, by halves of the inverse. Of a tabled inverse less than n 2^21 / 2^32 is missing: too small by one
    // at most.
    let mut quotient = (size.wrapping_mul(inverse >> 16) << (SLOPE - 16)).wrapping_add(size.wrapping_mul(inverse & 0xFFFF) >> (32 - SLOPE));
    let mut rest = (size << SLOPE).wrapping_sub(quotient.wrapping_mul(divisor));
    if tabled.is_none() {
        for _ in 0..4 {
            // All but a hundredth of what is missing, by the upper bits of the rest and of the inverse.
            let more = (rest >> 10).wrapping_mul(inverse >> 8) >> 14;
            quotient = quotient.wrapping_add(more);
            rest = rest.wrapping_sub(more.wrapping_mul(divisor));
        }
    }
    if rest >= divisor {
        quotient = quotient.wrapping_add(1);
        rest = rest.wrapping_sub(divisor);
    }
    match (n < 0, rest) {
        (false, _) => quotient as i32,
        (true, 0) => quotient.wrapping_neg() as i32,
        (true, _) => !quotient as i32,
    }
}

/// First estimates of 2^31 / d, at the middle of each interval of 128, for `d` from 2^15.
static SEEDS: [u16; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = ((1u32 << 31) / ((i as u32 + 256) * 128 + 64)) as u16;
        i += 1;
    }
    table
};

/// Reciprocal `(2^32 - 1) / d`, rounded down: 1/x with 17 fraction bits for x in [1, 2), where `d` is x in Q1.15.
///
/// Domain: `d` is 2^15 to 2^16 - 1. Exact (tests::every_inverse_is_exact, on every argument). Source: one step of the method of Newton
/// from a table, corrected by the remainder.
#[inline]
pub(crate) fn inverse(d: u32) -> u32 {
    // Setting the bit, which is set, shows the compiler that the divisor is not 0.
    if HALVES { inverse_by_table(d) } else { u32::MAX / (d | 1 << 15) }
}

#[inline]
fn inverse_by_table(d: u32) -> u32 {
    // One step: 2 s (1 + e) with the residual e = 1 - s d / 2^31, less than 2^-8.
    let seed = u32::from(SEEDS[(d >> 7 & 0xFF) as usize]);
    let error = (1u32 << 31).wrapping_sub(seed.wrapping_mul(d)) as i32;
    let step = (seed as i32).wrapping_mul(error >> 8) >> 22;
    // Too small by 1 to 4.
    let mut quotient = (2 * seed).wrapping_add(step as u32).wrapping_sub(3);
    let mut rest = u32::MAX.wrapping_sub(quotient.wrapping_mul(d));
    for _ in 0..4 {
        if rest >= d {
            rest = rest.wrapping_sub(d);
            quotient = quotient.wrapping_add(1);
        }
    }
    quotient
}

/// Quotient `n 2^16 / d`, rounded down, and the rest. `reciprocal` is the [`inverse`] of `d`, shifted left by `zeros` so that its upper bit is the
/// 16th.
///
/// Domain: `n` is at most `d`, and `d` is 1 to 2^16 - 1. Exact (tests::fractions_are_exact). Source: the reciprocal, corrected by the remainder.
#[inline]
pub(crate) fn fraction(n: u32, d: u32, (reciprocal, zeros): (u32, u32)) -> (u32, u32) {
    if HALVES { fraction_by_inverse(n, d, (reciprocal, zeros)) } else { ((n << 16) / d.max(1), (n << 16) % d.max(1)) }
}

#[inline]
fn fraction_by_inverse(n: u32, d: u32, (reciprocal, zeros): (u32, u32)) -> (u32, u32) {
    // Too small by less than 2.
    let mut quotient = n.wrapping_mul(reciprocal) >> (16 - zeros);
    let mut rest = (n << 16).wrapping_sub(quotient.wrapping_mul(d));
    for _ in 0..2 {
        if rest >= d {
            (quotient, rest) = (quotient + 1, rest - d);
        }
    }
    (quotient, rest)
}

/// Quotient `n / d` of long numbers, rounded down; 0 if `d` is 0. Exact (tests::long_quotients_are_exact).
#[inline]
pub(crate) fn long(n: u64, d: u64) -> u64 {
    if cfg!(target_pointer_width = "32") { long_by_words(n, d) } else { n.checked_div(d).unwrap_or(0) }
}

/// [`long`] where processors have no division of long numbers.
///
/// Source: Warren, Hacker's Delight 9-5. Where it matters how long it takes and not all bits count, see [`crate::math::recip::quotient`].
#[inline(never)]
fn long_by_words(n: u64, d: u64) -> u64 {
    let (upper, lower) = ((n >> 32) as u32, n as u32);
    if let Ok(divisor) = u32::try_from(d) {
        let Some(divisor) = NonZeroU32::new(divisor) else { return 0 };
        let (quotient, rest) = (upper / divisor, upper % divisor);
        return u64::from(quotient) << 32 | u64::from(by_word([rest, lower], divisor).0);
    }
    // By the upper word of the divisor, whose first bit is set: the quotient, of a word, is right or one too large.
    let zeros = d.leading_zeros();
    let divisor = NonZeroU32::new((d << zeros >> 32) as u32).unwrap_or(NonZeroU32::MIN);
    let (estimate, _) = by_word([upper >> 1, (n >> 1) as u32], divisor);
    let quotient = (u64::from(estimate) << zeros >> 31).saturating_sub(1);
    let rest = n.wrapping_sub(quotient.wrapping_mul(d));
    if rest >= d { quotient + 1 } else { quotient }
}

/// [`long`] of a number with a sign, rounded down.
#[inline]
pub(crate) fn signed_long(n: i64, d: u64) -> i64 {
    // Of a negative number: what is left of its size is below it, so that its complement is divided.
    let sign = n >> 63;
    long((n ^ sign) as u64, d) as i64 ^ sign
}

/// `(quotient, remainder)` of the number with the words `upper` and `lower`, by a word above `upper`, so that the quotient fits one.
/// Exact (tests::quotients_by_words_are_exact).
///
/// Source: Knuth, The Art of Computer Programming 4.3.1, Algorithm D; Warren, Hacker's Delight 9-3, in digits of half a word.
#[inline(never)]
pub(crate) fn by_word([upper, lower]: [u32; 2], divisor: NonZeroU32) -> (u32, u32) {
    let up = divisor.leading_zeros();
    let divisor = divisor.get() << up;
    let number = (u64::from(upper) << 32 | u64::from(lower)) << up;
    let (mut rest, mut quotient) = ((number >> 32) as u32, 0);
    for half in [number as u32 >> 16, number as u32 & 0xFFFF] {
        // By the upper half of the divisor, whose first bit is set, a digit is too large by two at most.
        let mut digit = (rest / (divisor >> 16 | 1 << 15)).min(0xFFFF);
        let mut left = (u64::from(rest) << 16 | u64::from(half)).wrapping_sub(unsigned_product(digit, divisor));
        while (left as i64) < 0 {
            digit -= 1;
            left = left.wrapping_add(divisor.into());
        }
        (rest, quotient) = (left as u32, quotient << 16 | digit);
    }
    (quotient, rest >> up)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn quotients_by_words_are_exact(upper: u32, lower: u32, divisor: u32, bits in 0..32u32, close: bool) {
            let divisor = (divisor >> bits).max(1);
            let upper = if close { divisor - 1 } else { upper % divisor };
            let number = u64::from(upper) << 32 | u64::from(lower);
            let exact = ((number / u64::from(divisor)) as u32, (number % u64::from(divisor)) as u32);
            prop_assert_eq!(by_word([upper, lower], NonZeroU32::new(divisor).unwrap()), exact);
        }

        #[test]
        fn long_quotients_are_exact(n: u64, d: u64, few in 0..64u32, fewer in 0..64u32) {
            let (n, d) = (n >> few, d >> fewer);
            prop_assert_eq!(long_by_words(n, d), n.checked_div(d).unwrap_or(0));
            let (n, d) = (n as i64, d >> 1);
            prop_assert_eq!(signed_long(n, d), if d == 0 { n >> 63 } else { n.div_euclid(d as i64) });
        }
    }

    #[test]
    fn every_inverse_is_exact() {
        for d in 1 << 15..1 << 16 {
            assert_eq!(inverse_by_table(d), u32::MAX / d, "{d}");
        }
    }

    #[test]
    fn fractions_are_exact() {
        for d in (1..1u32 << 16).step_by(13).chain(1..300).chain(65_300..1 << 16) {
            let zeros = d.leading_zeros() - 16;
            for n in (0..=d).step_by(1 + d as usize / 61).chain([d / 2, d - 1, d]) {
                let quotient = ((u64::from(n) << 16) / u64::from(d)) as u32;
                let expected = (quotient, ((u64::from(n) << 16) - u64::from(quotient) * u64::from(d)) as u32);
                let by_inverse = fraction_by_inverse(n, d, (inverse_by_table(d << zeros), zeros));
                assert_eq!([by_inverse, fraction(n, d, (inverse(d << zeros), zeros))], [expected; 2], "{n} / {d}");
            }
        }
    }

    #[test]
    fn every_slope_is_exact() {
        for d in 1..=LARGEST as i32 {
            for n in -1023..1024 {
                assert_eq!(by_table(n, d), (n << SLOPE).div_euclid(d), "{n} / {d}");
            }
        }
    }
}
