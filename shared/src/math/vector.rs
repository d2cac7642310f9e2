//! Vectors: dot products, cross products and unit vectors.

use crate::{
    arch::product::{HALVES, product, rounded},
    math::rsqrt::rsqrt_wide,
};

/// Dot product of two vectors, in the product of their formats. Domain: the sum fits 64 bits, as for components below 2^30. Exact.
#[inline]
pub fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
    if HALVES { dot_by_calls(a, b) } else { product(a[0], b[0]) + product(a[1], b[1]) + product(a[2], b[2]) }
}

/// The dot product on processors where a wide product is a call. The sum of three is then a call as well, because flash is worth more than the time.
#[inline(never)]
fn dot_by_calls(a: [i32; 3], b: [i32; 3]) -> i64 {
    zip(a, b, product).into_iter().sum()
}

/// Converts a vertex normal or position to `i32`, in the same format.
#[inline]
pub fn wide(v: [i16; 3]) -> [i32; 3] {
    map(v, i32::from)
}

/// Dot product of two vectors, in the product of their formats. Domain: the sum fits 32 bits; else it wraps modulo 2^32. Exact.
#[inline]
pub fn narrow_dot([a0, a1, a2]: [i32; 3], [b0, b1, b2]: [i32; 3]) -> i32 {
    a0.wrapping_mul(b0).wrapping_add(a1.wrapping_mul(b1)).wrapping_add(a2.wrapping_mul(b2))
}

/// Applies `f` to each component. It is written out, because `map` of an array is a loop through memory at opt-level "s".
#[inline]
pub fn map<A, R>([a0, a1, a2]: [A; 3], f: impl Fn(A) -> R) -> [R; 3] {
    [f(a0), f(a1), f(a2)]
}

/// Applies `f` to each pair of components.
///
/// The components are written out, so that no index is checked.
#[inline]
pub fn zip<A, B, R>([a0, a1, a2]: [A; 3], [b0, b1, b2]: [B; 3], f: impl Fn(A, B) -> R) -> [R; 3] {
    [f(a0, b0), f(a1, b1), f(a2, b2)]
}

/// The transpose of a matrix.
pub fn transposed<A>([[a, b, c], [d, e, f], [g, h, i]]: [[A; 3]; 3]) -> [[A; 3]; 3] {
    [[a, d, g], [b, e, h], [c, f, i]]
}

/// Computes `a - b`, in their format. It wraps modulo 2^32 if it overflows.
#[inline]
pub fn sub(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    zip(a, b, i32::wrapping_sub)
}

/// Computes `a + b`, in their format. It wraps modulo 2^32 if it overflows.
#[inline]
pub fn add(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    zip(a, b, i32::wrapping_add)
}

/// Cross product of two vectors, in the product of their formats. Domain: components above -2^31. Exact.
pub fn cross([a0, a1, a2]: [i32; 3], [b0, b1, b2]: [i32; 3]) -> [i64; 3] {
    let minor = |a: i32, b: i32, c: i32, d: i32| product(a, d) - product(b, c);
    [minor(a1, a2, b1, b2), minor(a2, a0, b2, b0), minor(a0, a1, b0, b1)]
}

/// Largest error of the length of a vector from [`normalise`].
pub const LENGTH_ERROR: f64 = 4.0 / (1u32 << 30) as f64;
/// Largest error of a component of a vector from [`normalise`].
pub const COMPONENT_ERROR: f64 = 5.0 / (1u32 << 30) as f64;

/// The unit vector along `v`, Q2.30; zero stays zero.
///
/// Domain: every vector of `i32`, in any format: it is first shifted to 30 bits. Error: at most [`LENGTH_ERROR`] of the length, and
/// [`COMPONENT_ERROR`] of a component (tests::unit). Source: a product with the reciprocal root of the squared length.
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

/// Divides three vectors by the length of the longest. The results have `BITS` fraction bits, at most 30.
///
/// Domain: components below 2^30 in size, the longest vector not shorter than 2. Error: that of [`normalise`], and less than 2 units of the
/// last place.
pub fn over_longest<const BITS: u32>([u, v, w]: [[i32; 3]; 3]) -> [[i32; 3]; 3] {
    let (mantissa, exponent) = rsqrt_wide(dot(u, u).max(dot(v, v)).max(dot(w, w)) as u64);
    let left = (32 + BITS).wrapping_sub(exponent) & 31;
    let over = |c: i32| rounded(product(c, mantissa as i32), left);
    let over = |[x, y, z]: [i32; 3]| [over(x), over(y), over(z)];
    [over(u), over(v), over(w)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longest() {
        for seed in (1..100_000i32).filter(|&seed| seed != 77) {
            let c = |k: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> (2 + seed % 6);
            let vectors = [3, 5, 7].map(|k| [c(1_664_525 * k), c(22_695_477 * k), c(69_069 * k)]);
            let size = |v: [i32; 3]| v.iter().map(|&c| f64::from(c).powi(2)).sum::<f64>().sqrt();
            let longest = vectors.map(size).into_iter().fold(0.0, f64::max);
            for (exact, over) in vectors.iter().flatten().zip(over_longest::<28>(vectors).iter().flatten()) {
                let error = f64::from(*over) - f64::from(*exact) / longest * f64::from(1 << 28);
                assert!(error.abs() < 2.0, "{seed}: {error}");
            }
        }
    }

    #[test]
    fn unit() {
        let (mut length, mut component) = (0f64, 0f64);
        let mut check = |v: [i32; 3]| {
            let size = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
            let (real, unit) = (v.map(f64::from), normalise(v).map(|c| f64::from(c) / f64::from(1 << 30)));
            length = length.max((size(unit) - 1.0).abs());
            component = (0..3).map(|k| (unit[k] - real[k] / size(real)).abs()).fold(component, f64::max);
        };
        for seed in 1..300_000i32 {
            // Long and short vectors, and components of different size.
            let c = |k: i32, shift: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> (seed / shift % 31);
            let even = [c(1_664_525, 1), c(22_695_477, 1), c(1_103_515_245, 1)];
            let uneven = [c(1_664_525, 1), c(22_695_477, 31), c(1_103_515_245, 961)];
            [even, uneven].into_iter().filter(|&v| v != [0; 3]).for_each(&mut check);
        }
        for i in 1..21 * 21 * 21 {
            check([i % 21, i / 21 % 21, i / 441]);
        }
        let ends = [i32::MIN, i32::MAX, 1 << 29, 1, 0];
        for i in 0..124 {
            check([ends[i % 5], ends[i / 5 % 5], ends[i / 25]]);
        }
        assert_eq!(normalise([0; 3]), [0; 3]);
        assert!(length <= LENGTH_ERROR && component <= COMPONENT_ERROR, "{length:e} {component:e}");
    }
}
