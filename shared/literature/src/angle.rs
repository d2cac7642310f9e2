//! Sine, cosine and polar coordinates, with angles in radians.

/// Fraction bits of an angle in radians, Q4.28: [-8, 8).
pub const ANGLE: u32 = 28;

/// A quarter of a turn, pi/2, Q4.28.
const QUARTER: i32 = 421_657_428;

/// Largest error of [`sin_cos`]: 1.25 units of its last place.
pub const ERROR: f64 = 1.25 / (1u32 << 30) as f64;

/// `[sine, cosine]`, Q2.30, of an angle in radians, Q4.28.
///
/// Domain: every `i32`. Error: at most [`ERROR`] (tests::sines). Source: the series of Taylor (1715) up to the 11th and 12th power,
/// after reduction of the angle to an eighth of a turn.
#[inline]
#[must_use]
pub fn sin_cos(angle: i32) -> [i32; 2] {
    // 2/pi, Q0.32.
    const PER_QUARTER: i64 = 2_734_261_102;
    let quarters = (i64::from(angle) * PER_QUARTER + (1 << (ANGLE + 31))) >> (ANGLE + 32);
    // pi/2 times 2^31, three bits finer than the angle.
    let x = (i64::from(angle) << 3) - quarters * 3_373_259_426;
    // x² as Q0.32: x is at most 0.79.
    let square = (x * x) >> 30;
    let series = |factorials: [u32; 5]| {
        let sum = factorials.into_iter().fold(0, |sum, factorial| i64::from(factorial) - ((square * sum) >> 32));
        (1 << 32) - ((square * sum) >> 32)
    };
    // 2^32 over 11!, 9!, ... 3! and over 10!, 8!, ... 2!.
    let sine = (x * series([108, 11_836, 852_176, 35_791_394, 715_827_883]) + (1 << 32)) >> 33;
    let cosine = (series([1_184, 106_522, 5_965_232, 178_956_971, 1 << 31]) + 2) >> 2;
    let [sine, cosine] = [sine as i32, cosine as i32];
    match quarters & 3 {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        2 => [-sine, -cosine],
        _ => [-cosine, sine],
    }
}

/// Iterations of [`polar`].
const ITERATIONS: usize = 28;

/// Arc tangents of 2^-i in radians, Q3.29.
static ARC_TANGENTS: [i32; ITERATIONS] = {
    let mut table = [0; ITERATIONS];
    // pi/4: half a quarter, with one more bit.
    table[0] = QUARTER;
    let mut i = 1;
    while i < ITERATIONS {
        // x - x³/3 + x⁵/5 ... in Q0.60.
        let (mut sum, mut power, mut k) = (0i64, (1i64 << 60) >> i, 1);
        while power > 0 {
            sum += if k & 2 == 0 { power / k } else { -power / k };
            power >>= 2 * i;
            k += 2;
        }
        table[i] = ((sum + (1 << 30)) >> 31) as i32;
        i += 1;
    }
    table
};

/// Largest error of an angle from [`polar`], in radians, and of a radius relative to itself.
pub const POLAR_ERROR: f64 = 3.0 / (1u32 << 26) as f64;

/// `[radius, angle]` of the point `[x, y]`; `[0, 0]` for the origin.
///
/// The radius has the format of `x` and `y`, the angle is in radians, Q4.28, from -pi to pi. Domain: every `i32`; a radius that does
/// not fit is the largest `i32`. Error: at most [`POLAR_ERROR`] of the angle, and of the radius relative to itself, which is then
/// rounded down to an integer (tests::polar). Source: Volder (1959), CORDIC in its vectoring mode.
#[inline]
#[must_use]
pub fn polar([x, y]: [i32; 2]) -> [i32; 2] {
    let largest = x.unsigned_abs() | y.unsigned_abs();
    if largest == 0 {
        return [0; 2];
    }
    // Below 2^29: the iterations lengthen a vector 1.65 times, and its diagonal is up to 1.42 times as long as its sides.
    let zeros = largest.leading_zeros();
    let fit = |c: i32| if zeros >= 3 { c.wrapping_shl(zeros - 3) } else { c >> (3 - zeros) };
    let (x, y) = (fit(x), fit(y));
    let half = if y < 0 { -2 * QUARTER } else { 2 * QUARTER };
    let (mut x, mut y, mut angle) = if x < 0 { (-x, -y, half) } else { (x, y, 0) };
    let mut turned = 0;
    for (i, tangent) in ARC_TANGENTS.iter().enumerate() {
        let (dx, dy) = (x >> i, y >> i);
        if y > 0 {
            (x, y, turned) = (x + dy, y - dx, turned + tangent);
        } else {
            (x, y, turned) = (x - dy, y + dx, turned - tangent);
        }
    }
    angle += (turned + 1) >> (29 - ANGLE);
    // One over the gain of the iterations, 1/1.646760258, Q0.32.
    const INVERSE_GAIN: i64 = 2_608_131_496;
    let radius = (i64::from(x) * INVERSE_GAIN) >> 32;
    let radius = if zeros >= 3 { radius >> (zeros - 3) } else { radius << (3 - zeros) };
    [radius.min(i32::MAX.into()) as i32, angle]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines() {
        let mut worst = 0f64;
        for angle in (i32::MIN..i32::MAX).step_by(4_001) {
            let exact = f64::from(angle) / f64::from(1 << ANGLE);
            let [sine, cosine] = sin_cos(angle).map(|c| f64::from(c) / f64::from(1 << 30));
            worst = worst.max((sine - exact.sin()).abs()).max((cosine - exact.cos()).abs());
        }
        assert!(worst <= ERROR, "{worst}");
    }

    #[test]
    fn polar() {
        let (mut radius, mut angle) = (0f64, 0f64);
        for seed in 1..1_000_000i32 {
            let c = |k: i32, shift: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> (seed / shift % 12);
            let [x, y] = [c(1_664_525, 1), c(22_695_477, 12)];
            let (exact, [r, a]) = (f64::from(x).hypot(f64::from(y)), super::polar([x, y]));
            let to = f64::from(y).atan2(f64::from(x));
            if exact < f64::from(i32::MAX) {
                // Rounding a radius down to an integer costs up to 1.
                radius = radius.max(((f64::from(r) - exact).abs() - 1.0) / exact);
            }
            angle = angle.max((f64::from(a) / f64::from(1 << ANGLE) - to).abs());
        }
        assert!(radius <= POLAR_ERROR && angle <= POLAR_ERROR, "{radius} {angle}");
        assert_eq!(super::polar([0, 0]), [0, 0]);
        for corner in [[i32::MIN, i32::MIN], [i32::MIN, i32::MAX], [i32::MAX, i32::MIN], [0, i32::MIN], [i32::MIN, 0]] {
            assert!(super::polar(corner)[0] > 0);
        }
    }
}
