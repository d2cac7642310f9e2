//! Angles, in radians: sine and cosine, polar coordinates.

/// Fraction bits of an angle: Q4.28 in [-8, 8).
pub const ANGLE: u32 = 28;

/// A quarter of a turn, pi/2.
const QUARTER: i32 = 421_657_428;

/// `[sine, cosine]`, Q2.30, of any angle.
///
/// Reduced to an eighth of a turn, then Taylor's series up to the 11th and 12th power. Error: at most [`ERROR`] (tests::sines).
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

/// Error of [`sin_cos`].
pub const ERROR: f64 = 1.0 / (1u32 << 29) as f64;

/// Turns of [`polar`].
const TURNS: usize = 28;

/// Arc tangents of 2^-i, Q3.29.
static TANGENTS: [i32; TURNS] = {
    let mut table = [0; TURNS];
    // pi/4: half a quarter, with one more bit.
    table[0] = QUARTER;
    let mut i = 1;
    while i < TURNS {
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

/// Radius (same format as `x` and `y`) and angle in [-pi, pi] of the point `[x, y]`; `[0, 0]` of the origin.
///
/// Turned to the x axis in ever smaller steps (CORDIC; Volder 1959).
/// Error: at most [`POLAR_ERROR`] of the radius, and of the angle (tests::polar).
#[inline]
#[must_use]
pub fn polar([x, y]: [i32; 2]) -> [i32; 2] {
    let largest = x.unsigned_abs() | y.unsigned_abs();
    if largest == 0 {
        return [0; 2];
    }
    // Below 2^29: the turns lengthen by 1.65, the diagonal by 1.42.
    let zeros = largest.leading_zeros();
    let fit = |c: i32| if zeros >= 3 { c.wrapping_shl(zeros - 3) } else { c >> (3 - zeros) };
    let (x, y) = (fit(x), fit(y));
    let half = if y < 0 { -2 * QUARTER } else { 2 * QUARTER };
    let (mut x, mut y, mut angle) = if x < 0 { (-x, -y, half) } else { (x, y, 0) };
    let mut turned = 0;
    for (i, tangent) in TANGENTS.iter().enumerate() {
        let (dx, dy) = (x >> i, y >> i);
        if y > 0 {
            (x, y, turned) = (x + dy, y - dx, turned + tangent);
        } else {
            (x, y, turned) = (x - dy, y + dx, turned - tangent);
        }
    }
    angle += (turned + 1) >> (29 - ANGLE);
    // 1/1.646760258, Q0.32.
    const SHORTEN: i64 = 2_608_131_496;
    let radius = (i64::from(x) * SHORTEN) >> 32;
    let radius = if zeros >= 3 { radius >> (zeros - 3) } else { radius << (3 - zeros) };
    [radius.min(i32::MAX.into()) as i32, angle]
}

/// Error of [`polar`].
pub const POLAR_ERROR: f64 = 1.0 / (1u32 << 24) as f64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines() {
        let mut worst = 0f64;
        for angle in (i32::MIN..i32::MAX).step_by(40_009) {
            let exact = f64::from(angle) / f64::from(1 << ANGLE);
            let [sine, cosine] = sin_cos(angle).map(|c| f64::from(c) / f64::from(1 << 30));
            worst = worst.max((sine - exact.sin()).abs()).max((cosine - exact.cos()).abs());
        }
        assert!(worst <= ERROR, "{worst}");
    }

    #[test]
    fn polar() {
        let (mut radius, mut angle) = (0f64, 0f64);
        for seed in 1..200_000i32 {
            let c = |k: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> (seed % 12);
            let [x, y] = [c(1_664_525), c(22_695_477)];
            let (exact, [r, a]) = (f64::from(x).hypot(f64::from(y)), super::polar([x, y]));
            let to = f64::from(y).atan2(f64::from(x));
            if exact < f64::from(i32::MAX) {
                // A radius is cut off to an integer.
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
