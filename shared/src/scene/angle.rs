//! Sine and cosine of an angle, in integers.

use crate::format::{Angle, ROTATION};

/// Largest error of the sine and cosine of a rotation's angle: eight units of Q2.30.
pub const SIN_COS_ERROR: f64 = 8.0 / (1u32 << 30) as f64;

/// π/2, Q2.30.
const QUARTER: i64 = 1_686_629_713;

/// Fraction bits of [`SINE`] and [`COSINE`].
const INVERSE: u32 = 32;

/// The inverse of each divisor in the series of Taylor of the sine, unsigned Q0.32. A divisor is the product of the next two factors of a factorial.
const SINE: [i64; 5] = inverses([6, 20, 42, 72, 110]);
/// The inverses of the divisors in the series of the cosine.
const COSINE: [i64; 5] = inverses([2, 12, 30, 56, 90]);

const fn inverses([a, b, c, d, e]: [i64; 5]) -> [i64; 5] {
    const ONE: i64 = 1 << INVERSE;
    [(ONE + a / 2) / a, (ONE + b / 2) / b, (ONE + c / 2) / c, (ONE + d / 2) / d, (ONE + e / 2) / e]
}

/// Sine and cosine, Q2.30.
///
/// Domain: every angle. Error: at most [`SIN_COS_ERROR`] (tests::sines_and_cosines). Source: the series of Taylor about the nearest quarter
/// of a turn, up to the ninth power of the sine and the tenth of the cosine, of which the next terms are below 2e-9 there.
pub(crate) fn sin_cos(angle: Angle) -> [i32; 2] {
    let quarter = angle.to_bits().wrapping_add(1 << 29) >> 30;
    // At most an eighth of a turn, in radians, Q2.30: bits of Q0.32 turns are four times as fine.
    let x = (i64::from(angle.to_bits().wrapping_sub(quarter << 30) as i32) * QUARTER) >> ROTATION;
    let (one, square) = (1i64 << ROTATION, (x * x) >> ROTATION);
    // 1 - x²/d0 (1 - x²/d1 (1 - ...)).
    let series =
        |inverses: [i64; 5]| inverses.iter().rev().fold(one, |sum, inverse| one - ((((square * sum) >> ROTATION) * inverse) >> INVERSE));
    let sin = ((x * series(SINE)) >> ROTATION) as i32;
    let cos = series(COSINE) as i32;
    match quarter {
        1 => [cos, -sin],
        2 => [-sin, -cos],
        3 => [-cos, sin],
        _ => [sin, cos],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_and_cosines() {
        let mut worst = 0f64;
        for k in (0..1 << 20).map(|k: u32| k << 12 | k >> 8).chain([u32::MAX, 1 << 29, (1 << 29) - 1]) {
            let turns = f64::from(k) / 2f64.powi(32);
            let (sin, cos) = (turns * core::f64::consts::TAU).sin_cos();
            let [s, c] = sin_cos(Angle::from_bits(k)).map(|c| f64::from(c) / 2f64.powi(30));
            worst = worst.max((s - sin).abs()).max((c - cos).abs());
        }
        assert!(worst <= SIN_COS_ERROR, "{:.2} units", worst * 2f64.powi(30));
    }
}
