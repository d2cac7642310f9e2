//! Reciprocal of a normalised integer.

/// 2^62 / d for `d` in [2^31, 2^32): between 2^30 and 2^31.
///
/// One 32-bit division of the upper half gives 15 bits, one Newton step the rest.
/// Error: at most [`ERROR`] units (tests::error).
#[inline]
#[must_use]
pub fn recip(d: u32) -> u32 {
    let d = d | 1 << 31;
    // 2^47 / d from the upper 16 bits, rounded up: in (2^15, 2^16].
    let high = (u32::MAX / (d >> 16)) >> 1;
    let x = u64::from(high) << 15;
    // x (2 - d x / 2^62) / 1, with d x / 2^62 close to 1: e is the defect in 2^-31.
    let defect = (1i64 << 31) - ((u64::from(d) * x) >> 31) as i64;
    let x = x as i64 + ((x as i64 * defect) >> 31);
    x as u32
}

/// Largest error of [`recip`], in units of its result: relative 2^-29.
pub const ERROR: u32 = 2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error() {
        let mut worst = 0;
        let mut d = 1u32 << 31;
        while d < u32::MAX - 70_000 {
            for d in [d, d | 0xffff, d.next_multiple_of(1 << 16)] {
                worst = worst.max(((1u64 << 62) / u64::from(d)).abs_diff(recip(d).into()));
            }
            d += 65_521;
        }
        assert!(worst <= u64::from(ERROR), "{worst}");
    }
}
