//! The animation of a stream whose camera orbits.

use crate::{
    format::{Angle, ROTATION},
    math::vector::{cross, dot, zip},
    scene::angle::{SIN_COS_ERROR, sin_cos},
    stream::record::Camera,
};

/// Rows of the rotation from the world to the eye in frame `number`, Q2.30.
pub(crate) fn rotation(camera: &Camera, number: u32) -> [[i32; 3]; 3] {
    match number.checked_rem(camera.period.into()) {
        Some(frame) if frame != 0 => turned(camera.rotation, camera.axis, frame, camera.period.into()),
        _ => camera.rotation,
    }
}

/// `rotation` times the rotation by `frame / period` of a turn about `axis`, all Q2.30.
///
/// Domain: `rotation` is a rotation matrix and `axis` a unit vector, to within rounding. Error: at most [`ORBIT_ERROR`] of the angle, and at most
/// [`ROTATION_ERROR`] of the dot products of rows (tests::rotations_stay_rotations). Source: the formula of Rodrigues (1840), row by row.
fn turned(rotation: [[i32; 3]; 3], axis: [i32; 3], frame: u32, period: u32) -> [[i32; 3]; 3] {
    let turns = (u64::from(frame) << 32).checked_div(period.into()).unwrap_or(0);
    let [sin, cos] = sin_cos(Angle::from_bits(turns as u32)).map(i64::from);
    let limit = 1i64 << ROTATION;
    rotation.map(|row| {
        let along = ((dot(row, axis) >> ROTATION) * (limit - cos)) >> ROTATION;
        let turned = zip(row, axis, |r, a| i64::from(r) * cos + along * i64::from(a));
        zip(turned, cross(row, axis), |t, c| ((t + (c >> ROTATION) * sin) >> ROTATION).clamp(-limit, limit) as i32)
    })
}

/// Largest difference between an orbit's angle in a frame and `frame / period` of a turn, in radians: the error of sine and cosine, and the angle's
/// rounding to 2^-32 of a turn.
pub const ORBIT_ERROR: f64 = SIN_COS_ERROR + core::f64::consts::TAU / (1u64 << 32) as f64;
/// Largest change of the dot products of a matrix's rows, 1 and 0 for an exact rotation, when an orbit turns it: 24 units of Q2.30.
pub const ROTATION_ERROR: f64 = 24.0 / (1u32 << 30) as f64;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::normalise;

    #[test]
    fn rotations_stay_rotations() {
        let mut worst = 0f64;
        for seed in (1..20_000i32).filter(|&seed| seed != 77) {
            let c = |k: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77);
            let x = normalise([c(1_664_525), c(22_695_477), c(1_103_515_245)]);
            let across = |a: [i32; 3], b: [i32; 3]| normalise(cross(a, b).map(|c| (c >> 31) as i32));
            let y = across(x, normalise([c(69_069), c(134_775_813), c(48_271)]));
            let axis = normalise([c(134_775_813), c(48_271), c(69_069)]);
            // Neither matrix is exact: turning must leave its products as they are.
            let rotation = [x, y, across(x, y)];
            let turned = turned(rotation, axis, seed.unsigned_abs() % 97, 97);
            let [before, after] = [rotation, turned].map(|rows| rows.map(|row| row.map(|c| f64::from(c) / 2f64.powi(30))));
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                let product = |rows: [[f64; 3]; 3]| rows[i].iter().zip(rows[j]).map(|(a, b)| a * b).sum::<f64>();
                worst = worst.max((product(after) - product(before)).abs());
            }
        }
        assert!(worst <= ROTATION_ERROR, "{worst:e}");
    }
}
