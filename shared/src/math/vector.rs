//! Dot products and unit vectors.

use super::rsqrt::rsqrt_wide;

/// Dot product of two vectors in 64 bits.
#[inline(always)]
#[must_use]
pub fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
    i64::from(a[0]) * i64::from(b[0]) + i64::from(a[1]) * i64::from(b[1]) + i64::from(a[2]) * i64::from(b[2])
}

/// A vertex normal or position as `i32`.
#[inline(always)]
#[must_use]
pub fn wide(v: [i16; 3]) -> [i32; 3] {
    v.map(i32::from)
}

/// `a - b`; the caller's ranges keep it from overflowing.
#[inline(always)]
#[must_use]
pub fn sub(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [a[0].wrapping_sub(b[0]), a[1].wrapping_sub(b[1]), a[2].wrapping_sub(b[2])]
}

/// `a + b`; the caller's ranges keep it from overflowing.
#[inline(always)]
#[must_use]
pub fn add(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [a[0].wrapping_add(b[0]), a[1].wrapping_add(b[1]), a[2].wrapping_add(b[2])]
}

/// The unit vector along `v`, Q2.30; zero stays zero.
///
/// `v` is first shifted to 30 bits, so its length does not matter. Error of the length: at most 2^-27 (tests::length).
#[must_use]
pub fn normalise(v: [i32; 3]) -> [i32; 3] {
    let largest = v.iter().fold(0, |m, c| m | c.unsigned_abs());
    if largest == 0 {
        return [0; 3];
    }
    // Components below 2^29 in size: the squared length fits 61 bits.
    let zeros = largest.leading_zeros();
    let v = v.map(|c| if zeros >= 3 { c.wrapping_shl(zeros - 3) } else { c >> (3 - zeros) });
    let (mantissa, exponent) = rsqrt_wide(dot(v, v) as u64);
    v.map(|c| ((i64::from(c) * i64::from(mantissa)) >> (exponent - 30)) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn length() {
        let mut worst = 0f64;
        for seed in 1..20_000i32 {
            let c = |k: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> (seed % 25);
            let v = [c(1_664_525), c(22_695_477), c(1_103_515_245)];
            if v.iter().all(|c| c.unsigned_abs() < 4) {
                continue;
            }
            let unit = normalise(v).map(|c| f64::from(c) / 2f64.powi(30));
            let length = unit.iter().map(|c| c * c).sum::<f64>().sqrt();
            worst = worst.max((length - 1.0).abs());
        }
        assert!(worst < 2f64.powi(-27), "{worst}");
    }
}
