//! What interpolation on the screen is off from interpolation in perspective.
//!
//! A point of the screen has the weights b of the corners on the screen, and in perspective p = b w / Σ b w, where w are the inverse depths. Both sum
//! to 1. So values that are linear over a triangle differ by at most their range times t, the sum of p - b over the corners where it is positive.
//!
//! t is at most (√r - 1) / (√r + 1), where r is the largest w over the least. Proof: let A be the corners where p > b. These have w > Σ b w. Replace the
//! corners of A by one corner with their weight and their mean w, and likewise the others: t stays, and so do the bounds of w. Between two corners
//! t is p - b with p = b w / (b w + (1 - b) v), whose largest value over b is that one. It is less than (r - 1) / 4, since (√r + 1)² >= 4.

/// A bound of the error of linear interpolation on the screen, in the unit of `range`, for values that differ by at most `range` between corners of these
/// inverse depths. Domain: `range` up to 2^15, positive depths. Error: rounded up, by less than 2^-14 of `range` and 1.
#[inline(never)]
pub(super) fn screen_error([a, b, c]: [i32; 3], range: u32) -> u32 {
    let (least, most) = (a.min(b).min(c).max(1) as u32, a.max(b).max(c).max(1) as u32);
    let difference = most - least;
    if difference >= least {
        return range;
    }
    // Both in units of 2^-15 to 2^-16 of the least one, which is rounded down, and their difference up.
    let zeros = least.leading_zeros();
    let (least, difference) = (least << zeros >> 16, (difference << zeros >> 16) + 1);
    (range.min(1 << 15) * difference >> 2).checked_div(least).map_or(range, |error| (error + 1).min(range))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn the_bound_holds(
            depths in prop::array::uniform3(prop_oneof![1i32..1 << 28, (1i32 << 20)..(1 << 20) + 50_000]),
            range in prop_oneof![1u32..1 << 15, 1u32..100],
            weights in prop::array::uniform3(0.0f64..1.0),
            levels in prop::array::uniform3(prop_oneof![Just(0.0f64), Just(1.0), 0.0f64..1.0]),
        ) {
            let w = depths.map(f64::from);
            let sum: f64 = weights.iter().sum();
            prop_assume!(sum > 1e-6);
            let b = weights.map(|weight| weight / sum);
            let middle: f64 = (0..3).map(|k| b[k] * w[k]).sum();
            let error: f64 = (0..3).map(|k| (b[k] * w[k] / middle - b[k]) * levels[k]).sum();
            let (error, bound) = (error.abs() * f64::from(range), f64::from(screen_error(depths, range)));
            prop_assert!(error <= bound, "{error} > {bound}");
            // Not much more than the bound of the proof either.
            let r = w.into_iter().fold(0.0, f64::max) / w.into_iter().fold(f64::MAX, f64::min);
            prop_assert!(bound <= f64::from(range) * ((r - 1.0) / 4.0 * 1.0002 + 1e-4) + 2.0 || bound <= f64::from(range) && r >= 2.0);
        }
    }
}
