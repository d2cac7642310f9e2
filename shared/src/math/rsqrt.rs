//! Square roots and reciprocal square roots.

use crate::arch::product::{product, unsigned_by_fraction, unsigned_product, upper};

/// First estimates of 1/sqrt(m), Q0.16, by the upper eight bits (64..=255) of `m`, Q2.30.
static SEED: [u16; 192] = {
    let mut table = [0; 192];
    let mut i = 0;
    while i < 192 {
        // 2^16 / sqrt(m) at the middle of the interval, m in [1, 4).
        let middle = ((i as u128 + 64) << 24) + (1 << 23);
        table[i] = ((1u128 << 62) / middle).isqrt() as u16;
        i += 1;
    }
    table
};

/// Largest error of [`rsqrt`] relative to its result: two and a half units of a result of 1.
pub const ERROR: f64 = 2.5 / (1u64 << 30) as f64;

/// Reciprocal square root 1/sqrt(m), Q2.30: from 1/2 to just below 1.
///
/// Domain: `m` in [1, 4), unsigned Q2.30; less counts as 1. Error: at most [`ERROR`] relative (tests::error; measured on every
/// argument). Source: a table of 192 entries, and two steps of the method of Newton, y (3 - m y²) / 2.
#[inline]
pub fn rsqrt(m: u32) -> u32 {
    let m = m.max(1 << 30);
    let seed = SEED.get((m >> 24) as usize - 64).copied().unwrap_or(0);
    let mut y = u32::from(seed) << 14;
    for _ in 0..2 {
        let square = (unsigned_product(y, y) >> 30) as u32;
        let product = (unsigned_product(m, square) >> 30) as u32;
        y = (unsigned_product(y, (3 << 30) - product) >> 31) as u32;
    }
    y
}

/// Largest error of [`sqrt`]: 4.25 units of its last place.
pub const ROOT_ERROR: f64 = 4.25 / (1u64 << 30) as f64;

/// Square root of `w`, Q2.30.
///
/// Domain: `w` in [1/4, 1), Q2.30. Error: at most [`ROOT_ERROR`] (tests::root_error; measured on every argument).
/// Source: the reciprocal root y of the table, one step of the method of Newton y + y (1 - m y²) / 2 in few bits, then one for the root
/// itself: s + s (1 - s/sqrt(w)) / 2 (Goldschmidt 1964).
#[inline]
pub fn sqrt(w: i32) -> i32 {
    let m = (w as u32) << 2;
    let seed = SEED.get((m >> 24).wrapping_sub(64) as usize).copied().unwrap_or(0);
    let seed = u32::from(seed);
    let square = (seed.wrapping_mul(seed).wrapping_add(1 << 15) >> 16) as u16;
    // The residual 1 - m y², Q2.30: less than 2^23.
    let residual = (1i32 << 30).wrapping_sub(unsigned_by_fraction(m, square) as i32);
    let y = (seed << 14).wrapping_add(((seed as i32).wrapping_mul(residual >> 9) >> 8) as u32) as i32;
    // sqrt(w) = 2 w / sqrt(4 w).
    let s = upper(w << 1, y) << 2;
    // The residual 1 - s / sqrt(w), Q5.27: less than 2^13.
    let residual = (1 << 27) - upper(s, y);
    s + ((s >> 15).wrapping_mul(residual) >> 13)
}

/// Half the reciprocal root, 1/(2 sqrt(x)), in Q2.30 at x = k/4096.
const fn half_root(k: u128) -> u32 {
    // 2^30 / (2 sqrt(k / 4096)) = sqrt(2^70 / k).
    ((1u128 << 70) / k).isqrt() as u32
}

/// Knots of [`HalfRsqrt::rsqrt`] at x = (510 + i)/2048: the value at the knot, Q2.30, in the upper 22 bits, and the slope in the lower ten,
/// by which the value falls in 1/1024 of an interval. There are as many knots as eleven bits can index.
///
/// A knot is lowered to balance the error: by half of the distance of the chord above the curve, and by half a step between knots, since
/// positions are rounded down. It takes half of what rounding the slope adds up to at the end of the interval. The slope bits are part
/// of the value that is read, so the sum of both is rounded to nearest.
static TABLE: HalfRsqrt = HalfRsqrt({
    let mut table = [0; 2048];
    let mut i = 0;
    while i < 2048 {
        let k = 2 * (i as u128 + 510);
        let (here, middle, next) = (half_root(k), half_root(k + 1), half_root(k + 2));
        let slope = (here - next + 512) >> 10;
        let knot = here.wrapping_add(((slope << 10).wrapping_add(next).wrapping_sub(here) as i32 >> 1) as u32)
            - (((here + next) / 2 - middle) >> 1)
            - (slope >> 1);
        table[i] = ((knot - slope + 512) & !0x3FF) | slope;
        i += 1;
    }
    table
});

/// The smallest x that [`HalfRsqrt::rsqrt`] takes, Q0.32: 2^-10 less than a quarter, because forward differences may err by this much.
pub const LEAST: u32 = (1 << 30) - (1 << 22);

/// Table of half the reciprocal root, 1/(2 sqrt(x)), for x in [1/4, 1] and a little around, for the pixel loop.
///
/// The loop takes a reference to it, so that the address of the table is loaded once instead of being built at every pixel.
#[derive(Debug)]
pub struct HalfRsqrt([u32; 2048]);

impl HalfRsqrt {
    /// The table. There is only one.
    pub fn get() -> &'static Self {
        &TABLE
    }

    /// All knots, for kernels in assembler.
    pub fn knots(&self) -> &[u32; 2048] {
        &self.0
    }

    /// Half the reciprocal root, 1/(2 sqrt(x)), Q2.30; `above` is x - [`LEAST`], unsigned Q0.32.
    ///
    /// Domain: x in [1/4, 1]. Error: at most [`HALF_ERROR`] relative; from [`LEAST`] to 1/4, and above 1, at most [`OUTSIDE_ERROR`]
    /// (tests::half_error, on every argument). Source: linear interpolation with balanced error, our own.
    #[inline]
    pub fn rsqrt(&self, above: u32) -> u32 {
        // Interval in the upper bits, place in it in the ten below them.
        let knot = self.0[(above >> 21) as usize];
        knot.wrapping_sub((knot & 0x3FF).wrapping_mul((above >> 11) & 0x3FF))
    }
}

/// Largest error of [`HalfRsqrt::rsqrt`] relative to its result: 0.4 of 1/255 on a highlight of exponent 1024.
pub const HALF_ERROR: f64 = 1.5e-6;
/// Largest error of [`HalfRsqrt::rsqrt`] outside its domain, relative to its result: 2^-10, since slopes below 1/4 take more than ten bits.
pub const OUTSIDE_ERROR: f64 = 1.0 / 1024.0;

/// Largest error of [`rsqrt_wide`] relative to its result.
pub const WIDE_ERROR: f64 = 2.75 / (1u64 << 30) as f64;

/// Reciprocal square root 1/sqrt(x) as `(mantissa, exponent)`: mantissa 2^-exponent, with the mantissa of [`rsqrt`], 2^29 to 2^30.
///
/// Domain: x from 1; 0 counts as 1. Error: at most [`WIDE_ERROR`] relative (tests::wide). Source: [`rsqrt`] of the upper 32 bits.
#[inline]
pub fn rsqrt_wide(x: u64) -> (u32, u32) {
    let shift = x.leading_zeros() & !1;
    let m = ((x << (shift & 63)) >> 32) as u32;
    // x = m * 2^(32 - shift) with m = Q2.30 * 2^30: the root's exponent is half of it.
    (rsqrt(m), 30 + (62 - shift.min(62)) / 2)
}

/// Largest error of [`HalfRsqrt::fine`] relative to its result.
pub const FINE_ERROR: f64 = 2.25 / (1u64 << 30) as f64;

impl HalfRsqrt {
    /// Reciprocal square root 1/sqrt(m), Q2.30: from 1/2 to 1. It is faster than [`rsqrt`], for programs that contain this table.
    ///
    /// Domain: `m` in [1, 4), unsigned Q2.30; less counts as 1. Error: at most [`FINE_ERROR`] relative (tests::fine_error).
    /// Source: [`Self::rsqrt`], and a step of the method of Newton, y + y (1 - m y²) / 2.
    #[inline]
    pub fn fine(&self, m: u32) -> u32 {
        let m = m.max(1 << 30);
        // A quarter of m as Q0.32 has the bits of m.
        let y = self.rsqrt(m.wrapping_sub(LEAST));
        // The residual 1 - m y², Q0.32, of which words keep the sign: less than 2^15.
        let residual = 0u32.wrapping_sub((unsigned_product((unsigned_product(m, y) >> 30) as u32, y) >> 28) as u32) as i32;
        y.wrapping_add((((y >> 15) as i32).wrapping_mul(residual) >> 18) as u32)
    }
}

/// The reciprocal root 1/sqrt(x): a mantissa in Q2.30 and a power of two to multiply it by.
#[derive(Clone, Copy, Default)]
pub struct Root {
    mantissa: u32,
    shift: u32,
}

impl Root {
    /// The reciprocal root of `x` in Q2.30, (0, 2].
    #[inline]
    pub fn of(x: u32) -> Self {
        let shift = x.max(1).leading_zeros() & !1;
        // x = m 2^-shift, m in [1, 4): the root's exponent is half of it.
        Self { mantissa: HalfRsqrt::get().fine(x << (shift & 31)), shift: shift / 2 }
    }

    /// Computes `value / sqrt(x)`, Q2.30 each, saturating at 2. Error: the root's, and less than 2/sqrt(x) units of the last place, because the
    /// quotient is rounded down before it is shifted.
    #[inline]
    pub fn divide(self, value: i32) -> i32 {
        let quotient = (product(value, self.mantissa as i32) >> 30) as i32;
        let shifted = quotient.wrapping_shl(self.shift);
        if shifted.wrapping_shr(self.shift) == quotient { shifted } else { i32::MAX ^ (quotient >> 31) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fine_error() {
        let mut worst = 0f64;
        // Within an interval of the table's positions the error has its extremes at the ends.
        for m in (1u32 << 30..=u32::MAX).step_by(1_021).chain((1u32 << 19..1 << 21).flat_map(|i| [i << 11, (i << 11) + 2047])) {
            let exact = 2f64.powi(30) / (f64::from(m) / 2f64.powi(30)).sqrt();
            worst = worst.max((f64::from(HalfRsqrt::get().fine(m)) / exact - 1.0).abs());
        }
        assert!(worst <= FINE_ERROR, "{worst:e}");
    }

    #[test]
    fn error() {
        let mut worst = 0f64;
        // One argument in so many, and the worst of all.
        for m in ((1u32 << 30)..=u32::MAX).step_by(4_093).chain([4_286_772_629]) {
            let exact = 2f64.powi(30) / (f64::from(m) / 2f64.powi(30)).sqrt();
            worst = worst.max((f64::from(rsqrt(m)) / exact - 1.0).abs());
        }
        assert!(worst <= ERROR, "{worst:e}");
    }

    #[test]
    fn root_error() {
        let mut worst = 0f64;
        // One argument in so many, the largest ones, and the worst of all.
        for w in ((1i32 << 28)..1 << 30).step_by(509).chain((1 << 30) - 1_000..1 << 30).chain([276_831_811]) {
            let exact = (f64::from(w) / 2f64.powi(30)).sqrt();
            worst = worst.max((f64::from(sqrt(w)) / 2f64.powi(30) - exact).abs());
        }
        assert!(worst <= ROOT_ERROR, "{worst:e}");
    }

    #[test]
    fn half_error() {
        let (mut inside, mut outside) = (0f64, 0f64);
        // The lower eleven bits do not count, so the ends of such an interval have its largest errors.
        for x in (0..1u64 << 21).flat_map(|i| [i << 11, (i << 11) + 2047]).map(|above| above + u64::from(LEAST)).chain([1 << 32]) {
            let exact = 2f64.powi(29) / (x as f64 / 2f64.powi(32)).sqrt();
            let error = (f64::from(HalfRsqrt::get().rsqrt((x - u64::from(LEAST)) as u32)) / exact - 1.0).abs();
            let worst = if (1 << 30..=1 << 32).contains(&x) { &mut inside } else { &mut outside };
            *worst = worst.max(error);
        }
        assert!(inside <= HALF_ERROR && outside <= OUTSIDE_ERROR, "{inside:e} {outside:e}");
    }

    #[test]
    fn wide() {
        let mut worst = 0f64;
        let ends = (0..64).flat_map(|bit| [1u64 << bit, (1 << bit) + 1, u64::MAX >> bit]);
        let between = (1..200_000u64).map(|k| k.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> (k % 63)).filter(|&x| x > 0);
        // The worst argument of `rsqrt`, with all bits below it.
        for x in (1..1 << 16).chain(ends).chain(between).chain([(4_286_772_629 << 32) | 0xFFFF_FFFF]) {
            let (m, e) = rsqrt_wide(x);
            let got = f64::from(m) / 2f64.powi(e as i32);
            worst = worst.max((got * (x as f64).sqrt() - 1.0).abs());
        }
        assert!(worst <= WIDE_ERROR, "{worst:e}");
    }
}
