//! Reciprocal square root.

use super::product::{unsigned_by_fraction, unsigned_product, upper};

/// First guesses for [`rsqrt`], indexed by the argument's upper eight bits (64..=255), Q0.16.
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

/// 1/sqrt(m) in Q2.30 for `m` in [1, 4), unsigned Q2.30: between 2^29 and 2^30.
///
/// Table of 192 entries and two Newton steps, y (3 - m y²) / 2.
/// Error: at most [`ERROR`] relative, in 2^-30 (tests::error).
#[inline]
#[must_use]
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

/// Largest error of [`rsqrt`], in units of its result.
pub const ERROR: f64 = 8.0;

/// sqrt(w), Q2.30, for `w` in [1/4, 1), Q2.30.
///
/// The table's reciprocal root y, one Newton step y + y (1 - m y²) / 2 in few bits, then one of the root itself: s + s (1 - s/sqrt(w)) / 2
/// (Goldschmidt 1964). Error: at most [`ROOT_ERROR`], in 2^-30 (tests::root_error).
#[inline]
#[must_use]
pub fn sqrt(w: i32) -> i32 {
    let m = (w as u32) << 2;
    let seed = SEED.get((m >> 24).wrapping_sub(64) as usize).copied().unwrap_or(0);
    let seed = u32::from(seed);
    let square = (seed.wrapping_mul(seed).wrapping_add(1 << 15) >> 16) as u16;
    // What m y² lacks of 1, Q2.30: less than 2^23.
    let lack = (1i32 << 30).wrapping_sub(unsigned_by_fraction(m, square) as i32);
    let y = (seed << 14).wrapping_add(((seed as i32).wrapping_mul(lack >> 9) >> 8) as u32) as i32;
    // sqrt(w) = 2 w / sqrt(4 w).
    let s = upper(w << 1, y) << 2;
    // What s / sqrt(w) lacks of 1, Q5.27: less than 2^13.
    let lack = (1 << 27) - upper(s, y);
    s + ((s >> 15).wrapping_mul(lack) >> 13)
}

/// Largest error of [`sqrt`], in units of its result.
pub const ROOT_ERROR: f64 = 4.0;

/// 1/(2 sqrt(x)) in Q2.30 at x = k/4096.
const fn half_root(k: u128) -> u32 {
    // 2^30 / (2 sqrt(k / 4096)) = sqrt(2^70 / k).
    ((1u128 << 70) / k).isqrt() as u32
}

/// Knots of [`Halves::rsqrt`] at x = (510 + i)/2048, Q2.30, but for their lower ten bits: these say how much less it is 1/1024 of the
/// way to the next one. As many as eleven bits can tell apart.
///
/// Knots are lower by half of what chords lie above the curve, and by half a place between knots, for places are cut off, and take half
/// of what rounding the slope comes to at its end; their lower bits, which count as well, are rounded to the nearest.
static HALVES: Halves = Halves({
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

/// The least argument of [`Halves::rsqrt`], Q0.32: 2^-10 less than a quarter, as much as walking may err there.
pub const LEAST: u32 = (1 << 30) - (1 << 22);

/// The table of 1/(2 sqrt(x)) for x in [1/4, 1] and a little around: for the pixel loop, where its address had better come from memory.
#[derive(Debug)]
pub struct Halves([u32; 2048]);

impl Halves {
    /// There is one.
    #[must_use]
    pub fn get() -> &'static Self {
        &HALVES
    }

    /// 1/(2 sqrt(x)) in Q2.30 for `x` in [1/4, 1] by linear interpolation; `above` is x less [`LEAST`], Q0.32.
    ///
    /// Error: at most [`HALF_ERROR`] relative (tests::half_error). Arguments outside give something in range.
    #[inline(always)]
    #[must_use]
    pub fn rsqrt(&self, above: u32) -> u32 {
        // Interval in the upper bits, place in it in the ten below them.
        let knot = self.0[(above >> 21) as usize];
        knot.wrapping_sub((knot & 0x3FF).wrapping_mul((above >> 11) & 0x3FF))
    }
}

/// Relative error of [`Halves::rsqrt`]: a quarter LSB at exponent 1024.
pub const HALF_ERROR: f64 = 1.5e-6;

/// 1/sqrt(x) for any x > 0, as a mantissa from [`rsqrt`] and an exponent: `mantissa * 2^-exponent`.
#[inline]
#[must_use]
pub fn rsqrt_wide(x: u64) -> (u32, u32) {
    let shift = x.leading_zeros() & !1;
    let m = ((x << (shift & 63)) >> 32) as u32;
    // x = m * 2^(32 - shift) with m = Q2.30 * 2^30: the root's exponent is half of it.
    (rsqrt(m), 30 + (62 - shift.min(62)) / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error() {
        let mut worst = 0f64;
        let mut m = 1u64 << 30;
        while m < 1 << 32 {
            let exact = 2f64.powi(30) / (m as f64 / 2f64.powi(30)).sqrt();
            worst = worst.max((f64::from(rsqrt(m as u32)) - exact).abs());
            m += 65_521;
        }
        assert!(worst <= ERROR, "{worst}");
    }

    #[test]
    fn root_error() {
        let mut worst = 0f64;
        for w in ((1i32 << 28)..1 << 30).step_by(509).chain((1 << 30) - 1_000..1 << 30) {
            let exact = (f64::from(w) * 2f64.powi(30)).sqrt();
            worst = worst.max((f64::from(sqrt(w)) - exact).abs());
        }
        assert!(worst <= ROOT_ERROR, "{worst}");
    }

    #[test]
    fn half_error() {
        let mut worst = 0f64;
        for x in ((1u32 << 28)..=1 << 30).step_by(4_093) {
            let exact = 2f64.powi(29) / (f64::from(x) / 2f64.powi(30)).sqrt();
            // One is 2^32, which wraps.
            worst = worst.max((f64::from(Halves::get().rsqrt((x << 2).wrapping_sub(LEAST))) / exact - 1.0).abs());
        }
        assert!(worst <= HALF_ERROR, "{worst}");
    }

    #[test]
    fn wide() {
        for x in [1u64, 2, 3, 4, 100, 65_535, 1 << 20, (1 << 40) + 12_345, 1 << 60, u64::MAX] {
            let (m, e) = rsqrt_wide(x);
            let got = f64::from(m) / 2f64.powi(e as i32);
            let exact = 1.0 / (x as f64).sqrt();
            assert!((got / exact - 1.0).abs() < 1e-7, "{x}: {got} {exact}");
        }
    }
}
