//! Arcs of great circles between unit vectors, at constant speed: spherical linear interpolation (Shoemake 1985).

use crate::angle::{polar, sin_cos};
use microphong::math::vector::{dot, normalise, zip};

/// Largest error of a component of [`Arc::at`].
pub const ERROR: f64 = 7.0 / (1u32 << 27) as f64;

/// The shorter arc of the great circle through two unit vectors.
#[derive(Clone, Copy, Debug)]
pub struct Arc {
    /// The unit vector at which the arc starts, Q2.30.
    pub start: [i32; 3],
    /// The unit vector at a right angle to `start` in the plane of the arc, Q2.30; zero if start and end are equal.
    pub across: [i32; 3],
    /// The angle from start to end in radians, Q4.28 (see [`crate::angle::ANGLE`]).
    pub angle: i32,
    /// The sine of that angle, Q2.30.
    pub sine: i32,
}

impl Arc {
    /// An arc whose vectors are all zero.
    pub const ZERO: Self = Self { start: [0; 3], across: [0; 3], angle: 0, sine: 0 };

    /// The shorter arc from `start` to `end`.
    ///
    /// Domain: unit vectors, Q2.30, at most 3 radians apart: between nearly opposite ones the direction of the arc is ill-conditioned.
    #[must_use]
    pub fn new(start: [i32; 3], end: [i32; 3]) -> Self {
        // Of the difference, which is small with the angle: the vectors' lengths are not exactly 1.
        let apart = zip(end, start, i32::saturating_sub);
        let along = dot(apart, start) >> 30;
        let height = zip(apart, start, |d, s| (i64::from(d) - ((along * i64::from(s)) >> 30)) as i32);
        let across = normalise(height);
        let sine = (dot(height, across) >> 30) as i32;
        let [_, angle] = polar([(dot(start, end) >> 30) as i32, sine]);
        Self { start, across, angle, sine }
    }

    /// The unit vector, Q2.30, at the share `t` of the angle from start to end.
    ///
    /// Domain: `t` from 0 to 1, Q2.30. Error of a component: at most [`ERROR`] (tests::shares).
    /// Source: Shoemake (1985), in an orthonormal basis: start cos(t angle) + across sin(t angle).
    #[must_use]
    pub fn at(&self, t: i32) -> [i32; 3] {
        let [sine, cosine] = sin_cos(((i64::from(self.angle) * i64::from(t)) >> 30) as i32);
        zip(self.start, self.across, |s, a| ((i64::from(s) * i64::from(cosine) + i64::from(a) * i64::from(sine)) >> 30) as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares() {
        let real = |v: [i32; 3]| v.map(|c| f64::from(c) / f64::from(1 << 30));
        let mut worst = 0f64;
        for seed in 1..60_000i32 {
            let c = |k: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> 2;
            let start = normalise([c(1_664_525), c(22_695_477), c(1_103_515_245)]);
            // Vectors from far apart to hardly apart, a third of them on the other side.
            let end = normalise(zip(start, [c(69_069), c(134_775_813), c(214_013)], |s, d| {
                (if seed % 3 == 0 { -s } else { s } >> 1) + (d >> (seed / 3 % 24))
            }));
            let (arc, a, b) = (Arc::new(start, end), real(start), real(end));
            let cosine: f64 = (0..3).map(|k| a[k] * b[k]).sum();
            let height = [0, 1, 2].map(|k| b[k] - cosine * a[k]);
            let sine = height.iter().map(|c| c * c).sum::<f64>().sqrt();
            let angle = sine.atan2(cosine);
            if angle > 3.0 {
                continue;
            }
            for t in [0.0, 0.25, 0.5, 0.9, 1.0] {
                let exact = [0, 1, 2].map(|k| a[k] * (t * angle).cos() + height[k] / sine.max(1e-12) * (t * angle).sin());
                let got = real(arc.at((t * f64::from(1 << 30)) as i32));
                worst = (0..3).map(|k| (got[k] - exact[k]).abs()).fold(worst, f64::max);
            }
        }
        assert!(worst <= ERROR, "{worst:e}");
    }
}
