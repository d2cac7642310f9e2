//! Leading zeros.
//!
//! Most machines count them in one instruction; Armv6-M has none, and a table is quicker than its library.

use super::product::HALVES;

/// Of numbers of six bits, the zeros above them in these.
static ZEROS: [u8; 64] = {
    let mut table = [6; 64];
    let mut i = 1u8;
    while i < 64 {
        table[i as usize] = i.leading_zeros() as u8 - 2;
        i += 1;
    }
    table
};

/// Zeros above the first bit of `x`, which is less than 2^24.
#[inline(always)]
#[must_use]
pub fn leading_zeros(x: u32) -> u32 {
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
        for x in (0..1 << 12).chain((1 << 12..1 << 24).step_by(97)).chain((12..24).flat_map(|bit| [(1 << bit) - 1, 1 << bit])) {
            assert_eq!(by_table(x), x.leading_zeros(), "{x}");
        }
    }
}
