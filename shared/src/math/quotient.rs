//! Quotients of words.
//!
//! Armv6-M does not divide: a quotient is a call of 200 instructions there. A table and a product are a quarter of that, and what they
//! leave over is made good, so the bits are the same.

use super::product::{HALVES, unsigned_product};

/// Largest divisor of [`quotient`].
pub const LARGEST: usize = 1424;

/// 2^32 / d, rounded down, by d; one less for 1.
static INVERSES: [u32; LARGEST + 1] = {
    let mut table = [u32::MAX; LARGEST + 1];
    let mut d = 2;
    while d <= LARGEST {
        table[d] = ((1u64 << 32) / d as u64) as u32;
        d += 1;
    }
    table
};

/// `n / d` rounded down; `d` is 1 to [`LARGEST`], and what is not gives nonsense.
#[inline(always)]
#[must_use]
pub fn quotient(n: i32, d: i32) -> i32 {
    if HALVES { by_table(n, d) } else { n.div_euclid(d.max(1)) }
}

#[inline(never)]
fn by_table(n: i32, d: i32) -> i32 {
    let divisor = d as u32;
    let inverse = INVERSES.get(d as usize).copied().unwrap_or(0);
    // Of a negative number the complement, rounded down, is the complement of the quotient, rounded down.
    let size = (n ^ (n >> 31)) as u32;
    // n / d - n inverse / 2^32 < n / 2^32: too small by one at most.
    let guess = (unsigned_product(size, inverse) >> 32) as u32;
    let left = size.wrapping_sub(guess.wrapping_mul(divisor));
    let exact = guess.wrapping_add(u32::from(left >= divisor)) as i32;
    exact ^ (n >> 31)
}

/// 2^31 / d at the middle of each interval of 128, for `d` from 2^15.
static SEEDS: [u16; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = ((1u32 << 31) / ((i as u32 + 256) * 128 + 64)) as u16;
        i += 1;
    }
    table
};

/// `(2^32 - 1) / d` rounded down; `d` is 2^15 to 2^16 - 1.
#[inline(always)]
#[must_use]
pub fn inverse(d: u32) -> u32 {
    // The bit is set: what divides is not 0.
    if HALVES { inverse_by_table(d) } else { u32::MAX / (d | 1 << 15) }
}

#[inline(always)]
fn inverse_by_table(d: u32) -> u32 {
    // One Newton step: 2 s (1 + e) with e = 1 - s d / 2^31 below 2^-8.
    let seed = u32::from(SEEDS[(d >> 7 & 0xFF) as usize]);
    let error = (1u32 << 31).wrapping_sub(seed.wrapping_mul(d)) as i32;
    let step = (seed as i32).wrapping_mul(error >> 8) >> 22;
    // Too small by 1 to 4.
    let mut quotient = (2 * seed).wrapping_add(step as u32).wrapping_sub(3);
    let mut left = u32::MAX.wrapping_sub(quotient.wrapping_mul(d));
    for _ in 0..4 {
        if left >= d {
            left = left.wrapping_sub(d);
            quotient = quotient.wrapping_add(1);
        }
    }
    quotient
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn every_inverse_is_exact() {
        for d in 1 << 15..1 << 16 {
            assert_eq!(inverse_by_table(d), u32::MAX / d, "{d}");
        }
    }

    #[test]
    fn quotients_are_exact_where_they_step() {
        for d in 1..=LARGEST as i32 {
            for k in [0, 1, 2, i32::MAX / d / 2, i32::MAX / d - 1, i32::MAX / d] {
                for n in [k * d, k * d - 1, (k * d).saturating_add((d - 1) / 2), i32::MAX, i32::MIN, i32::MIN + d] {
                    for n in [n, n.wrapping_neg()] {
                        assert_eq!(by_table(n, d), n.div_euclid(d), "{n} / {d}");
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn quotients_are_exact(n: i32, d in 1..=LARGEST as i32) {
            prop_assert_eq!(by_table(n, d), n.div_euclid(d));
        }
    }
}
