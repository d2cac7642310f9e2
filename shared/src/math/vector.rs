//! Dot products and unit vectors.

use super::{product::product, rsqrt::rsqrt_wide};

/// Dot product of two vectors in 64 bits.
#[inline(always)]
#[must_use]
pub fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
    product(a[0], b[0]) + product(a[1], b[1]) + product(a[2], b[2])
}

/// A vertex normal or position as `i32`. Written out: `map` is a loop through memory at opt-level "s".
#[inline(always)]
#[must_use]
pub fn wide([x, y, z]: [i16; 3]) -> [i32; 3] {
    [x.into(), y.into(), z.into()]
}

/// Dot product of two vectors whose product fits 32 bits.
#[inline(always)]
#[must_use]
pub fn narrow_dot([a0, a1, a2]: [i32; 3], [b0, b1, b2]: [i32; 3]) -> i32 {
    a0.wrapping_mul(b0).wrapping_add(a1.wrapping_mul(b1)).wrapping_add(a2.wrapping_mul(b2))
}

/// `f` of each pair of components. Written out: no index, so no check of one.
#[inline(always)]
#[must_use]
pub fn zip<A, B, R>([a0, a1, a2]: [A; 3], [b0, b1, b2]: [B; 3], f: impl Fn(A, B) -> R) -> [R; 3] {
    [f(a0, b0), f(a1, b1), f(a2, b2)]
}

/// Rows of a matrix to columns, or the other way.
#[inline(always)]
#[must_use]
pub fn transposed<A>([[a, b, c], [d, e, f], [g, h, i]]: [[A; 3]; 3]) -> [[A; 3]; 3] {
    [[a, d, g], [b, e, h], [c, f, i]]
}

/// `a - b`; the caller's ranges keep it from overflowing.
#[inline(always)]
#[must_use]
pub fn sub(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    zip(a, b, i32::wrapping_sub)
}

/// `a + b`; the caller's ranges keep it from overflowing.
#[inline(always)]
#[must_use]
pub fn add(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    zip(a, b, i32::wrapping_add)
}

/// Cross product of two vectors in 64 bits.
#[must_use]
pub fn cross([a0, a1, a2]: [i32; 3], [b0, b1, b2]: [i32; 3]) -> [i64; 3] {
    let minor = |a: i32, b: i32, c: i32, d: i32| product(a, d) - product(b, c);
    [minor(a1, a2, b1, b2), minor(a2, a0, b2, b0), minor(a0, a1, b0, b1)]
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
    v.map(|c| (product(c, mantissa as i32) >> (exponent - 30)) as i32)
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
