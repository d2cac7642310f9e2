//! Count of leading zeros.
//!
//! Most machines count leading zeros in one instruction. Armv6-M has none, and a table is faster than its library.

use crate::arch::product::HALVES;

/// Leading zeros of a number in a field of six bits.
static ZEROS: [u8; 64] = {
    let mut table = [6; 64];
    let mut i = 1u8;
    while i < 64 {
        table[i as usize] = i.leading_zeros() as u8 - 2;
        i += 1;
    }
    table
};

/// Count of leading zeros of `x` in 32 bits.
///
/// Domain: `x` is less than 2^24. Exact (tests::zeros_are_counted, on every argument).
/// Source: a table of six bits at a time, where the machine has no instruction for it (Warren, Hacker's Delight 5-3).
#[inline]
pub(crate) fn leading_zeros(x: u32) -> u32 {
    if HALVES { by_table(x) } else { x.leading_zeros() }
}

#[inline(never)]
fn by_table(x: u32) -> u32 {
    let (mut x, mut zeros) = (x, 26);
    while x >= 64 {
        (x, zeros) = (x >> 6, zeros - 6);
    }
    zeros + u32::from(ZEROS[x as usize & 63])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_counted() {
        for x in 0..1 << 24 {
            assert_eq!(by_table(x), x.leading_zeros(), "{x}");
        }
    }
}
