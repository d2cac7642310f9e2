//! Interpolation on the screen that is right in perspective.
//!
//! A point of the screen has the weights b of the corners on the screen, and in perspective p = b w / Σ b w, where w are the inverse depths. Both sum
//! to 1. Let r be the largest w over the least. A method that interpolates on the screen keeps its loop in one of these ways:
//!
//! 1. **By a plane**, as without perspective. Values that are linear over a triangle then differ by at most their range times t, the sum of p - b
//!    over the corners where it is positive. t is at most (√r - 1) / (√r + 1). Proof: let A be the corners where p > b. These have w > Σ b w. Replace
//!    the corners of A by one corner with their weight and their mean w, and likewise the others: t stays, and so do the bounds of w. Between two
//!    corners t is p - b with p = b w / (b w + (1 - b) v), whose largest value over b is that one. It is at most (r - 1) / 4, since (√r + 1)² >= 4.
//! 2. **By a quadratic** through the corners and through the values that are seen at the middles of the edges on the screen. It differs from linear
//!    values v by at most 3/32 (r - 1)² of their range R. Proof: let the least w be 1, W = Σ b w, and q the quadratic. W times the error is Σ b w v -
//!    W q, a cubic that is 0 at the six nodes. So it is the sum of e b b' (b - b') over the edges, plus f b0 b1 b2. Along an edge the error is known:
//!    e is (w' - w)² (v' - v) / (w + w'), at most (r - 1)² R / 2. In the centre it gives f = Σ (w' - w) (v' - v) (w + w' - 2 u) / (w + w') over the
//!    edges, where u is the third w. Of the three |w' - w| one is r - 1, and there |w + w' - 2 u| is at most r - 1. The other two sum to r - 1, and
//!    there it is at most 2 (r - 1). w + w' is at least 2. So f is at most 3/2 (r - 1)² R. W is at least 1, and Σ b b' |b - b'| / 2 + 3/2 b0 b1 b2 is
//!    less than 3/32 in the triangle.
//! 3. **At nodes**: methods that compute light at the middles of the edges compute it at the points that are seen at the middles on the screen.
//!    `six-point` is then nearer to Phong shading than without perspective, by measurement, also where triangles reach far. `sqrt6` does so up to r =
//!    9/8; beyond that, by measurement, its quadratic in space is much nearer.

use crate::{
    arch::product::unsigned_product,
    format::COSINE,
    math::{recip::recip, vector::map},
};

/// How values that are linear over a triangle are interpolated on the screen.
#[derive(Clone, Copy)]
pub(crate) enum LinearWay {
    /// By a plane.
    Plane,
    /// By a quadratic through the values at these shares of the edges, see [`middles`].
    Quadratic([u16; 3]),
    /// By the point in space that is seen at each pixel.
    InSpace,
}

/// Points on the edges of a triangle that are nodes of a quadratic on the screen: at these shares of the edges, see [`middles`]. `None` stands for the
/// middles of the edges in space, which they are without perspective.
pub(crate) type Middles = Option<[u16; 3]>;

/// The shares of the edges at which their middles in space lie, Q0.16.
pub(crate) const IN_SPACE: [u16; 3] = [1 << 15; 3];

/// The least of three inverse depths, and how much larger the largest is, in a common unit. The least one has 16 bits and is
/// rounded down, the difference is rounded up. `None` if the largest is at least twice the least.
#[inline(always)]
fn spread([a, b, c]: [i32; 3]) -> Option<[u32; 2]> {
    let (least, most) = (a.min(b).min(c).max(1) as u32, a.max(b).max(c).max(1) as u32);
    let (zeros, difference) = (least.leading_zeros(), most - least);
    (difference < least).then_some([least << zeros >> 16, (difference << zeros >> 16) + 1])
}

/// A bound of the error of interpolation by a plane on the screen, in the unit of `range`, for values that are linear over a triangle and differ by
/// at most `range` between corners of these inverse depths. Domain: `range` up to 2^15, positive depths. Error: rounded up, by less than 2^-14 of
/// `range` and 1.
#[inline(never)]
pub(super) fn plane_error(inv_depth: [i32; 3], range: u32) -> u32 {
    let Some([least, difference]) = spread(inv_depth) else { return range };
    ((range.min(1 << 15) * difference) >> 2).checked_div(least).map_or(range, |error| (error + 1).min(range))
}

/// A bound of the error of a quadratic instead, see [`plane_error`].
#[inline(never)]
pub(super) fn quadratic_error(inv_depth: [i32; 3], range: u32) -> u32 {
    let Some([least, difference]) = spread(inv_depth) else { return range };
    // Times r - 1, which is less than 1.
    let times = |number: u32| (number * difference).checked_div(least).map_or(number, |product| (product + 1).min(number));
    ((3 * times(times(range.min(1 << 15)))) >> 5) + 1
}

/// The fastest way to interpolate such values on the screen so that it is off by at most `most`.
#[inline(never)]
pub(super) fn linear_way(inv_depth: [i32; 3], range: u32, most: u32) -> LinearWay {
    match () {
        () if plane_error(inv_depth, range) <= most => LinearWay::Plane,
        () if quadratic_error(inv_depth, range) <= most => LinearWay::Quadratic(middles(inv_depth)),
        () => LinearWay::InSpace,
    }
}

/// The share of each edge 0-1, 1-2, 2-0, from its first end, at which the point lies that is seen at the middle of the edge on the screen, unsigned
/// Q0.16. Inverse depths are positive. Error: 2^-17 for rounding, and 2^-28 more. Where one corner is
/// more than 2^16 times as near, 2^-16.
#[inline(never)]
pub(super) fn middles(inv_depth: [i32; 3]) -> [u16; 3] {
    map(fine_middles(inv_depth), rounded)
}

/// A share, Q2.30, as unsigned Q0.16.
#[inline(always)]
pub(super) fn rounded(share: u32) -> u16 {
    (((share >> (COSINE - 17)) + 1) >> 1).min(u16::MAX.into()) as u16
}

/// [`middles`] as Q2.30. Error: 2^-28.
#[inline(always)]
pub(super) fn fine_middles([a, b, c]: [i32; 3]) -> [u32; 3] {
    let share = |from: i32, to: i32| {
        let (sum, to) = ((from.max(1) as u32).wrapping_add(to.max(1) as u32), to.max(1) as u32);
        let zeros = sum.leading_zeros();
        (unsigned_product(to << zeros, recip(sum << zeros)) >> (62 - COSINE)) as u32
    };
    [share(a, b), share(b, c), share(c, a)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A quarter of a level, Q9.7.
    const MOST: u32 = 32;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn the_bounds_hold(
            depths in prop::array::uniform3(prop_oneof![1i32..1 << 28, (1i32 << 20)..(1 << 20) + 50_000]),
            range in prop_oneof![1u32..1 << 15, 1u32..100],
            weights in prop::array::uniform3(0.0f64..1.0),
            levels in prop::array::uniform3(prop_oneof![Just(0.0f64), Just(1.0), 0.0f64..1.0]),
        ) {
            let w = depths.map(f64::from);
            let sum: f64 = weights.iter().sum();
            prop_assume!(sum > 1e-6);
            let b = weights.map(|weight| weight / sum);
            let seen = |b: [f64; 3]| {
                let whole: f64 = (0..3).map(|k| b[k] * w[k]).sum();
                (0..3).map(|k| b[k] * w[k] / whole * levels[k]).sum::<f64>()
            };
            let plane: f64 = (0..3).map(|k| b[k] * levels[k]).sum();
            let edges = [(0, 1), (1, 2), (2, 0)];
            let quadratic = (0..3).map(|k| b[k] * (2.0 * b[k] - 1.0) * levels[k]).sum::<f64>()
                + edges.into_iter().map(|(i, j)| {
                    let mut middle = [0.0; 3];
                    (middle[i], middle[j]) = (0.5, 0.5);
                    4.0 * b[i] * b[j] * seen(middle)
                }).sum::<f64>();
            let r = w.into_iter().fold(0.0, f64::max) / w.into_iter().fold(f64::MAX, f64::min);
            let [plane, quadratic] = [plane, quadratic].map(|value| (value - seen(b)).abs() * f64::from(range));
            let bound = f64::from(plane_error(depths, range));
            prop_assert!(plane <= bound, "{plane} > {bound}");
            // No bound is much more than the one of the proof.
            let proven = [(r - 1.0) / 4.0, (r - 1.0).powi(2) * 3.0 / 32.0];
            let proven = proven.map(|error| error * f64::from(range) * 1.001 + f64::from(range) * 2e-4 + 2.0);
            prop_assert!(bound <= proven[0] || bound <= f64::from(range) && r >= 2.0);
            let may_exceed = |bound: f64| bound >= f64::from(MOST) || r >= 2.0;
            let error = match linear_way(depths, range, MOST) {
                LinearWay::Plane => plane,
                LinearWay::Quadratic(_) => {
                    prop_assert!(may_exceed(proven[0]));
                    quadratic
                }
                LinearWay::InSpace => {
                    prop_assert!(may_exceed(proven[1]));
                    0.0
                }
            };
            prop_assert!(error <= f64::from(MOST), "{error}");
            for (((i, j), share), fine) in edges.into_iter().zip(middles(depths)).zip(fine_middles(depths)) {
                let error = |share: f64| (share - w[j] / (w[i] + w[j])).abs();
                prop_assert!(error(f64::from(fine) / 2f64.powi(30)) <= 2f64.powi(-28));
                let error = error(f64::from(share) / 65536.0);
                prop_assert!(error <= 2f64.powi(-17) + 2f64.powi(-27) || w[i].max(w[j]) > 65_000.0 * w[i].min(w[j]) && error <= 2f64.powi(-16));
            }
        }
    }

    /// The last step of the proof, on a grid and between its points by the slope of the polynomial, which is less than 2.
    #[test]
    fn the_cubic_is_small() {
        const STEPS: i32 = 1_000;
        for (i, j) in (0..=STEPS).flat_map(|i| (0..=STEPS - i).map(move |j| (i, j))) {
            let [a, b, c] = [i, j, STEPS - i - j].map(|k| f64::from(k) / f64::from(STEPS));
            let edge = |p: f64, q: f64| p * q * (p - q).abs() / 2.0;
            assert!(edge(a, b) + edge(b, c) + edge(c, a) + 1.5 * a * b * c < 3.0 / 32.0 - 2.0 / f64::from(STEPS), "{a} {b} {c}");
        }
    }
}
