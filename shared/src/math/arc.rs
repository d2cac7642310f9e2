//! Arcs of great circles: between unit vectors, at constant speed (Shoemake 1985).

use super::{
    angle::{polar, sin_cos},
    vector::{dot, normalise, zip},
};

/// The shorter arc between two unit vectors.
#[derive(Clone, Copy, Debug)]
pub struct Arc {
    /// Where it starts, Q2.30.
    pub start: [i32; 3],
    /// The unit vector at a right angle to `start` in the arc's plane; zero if there is no such plane.
    pub across: [i32; 3],
    /// From start to end, see [`super::angle::ANGLE`].
    pub angle: i32,
    /// Sine of the angle, Q2.30.
    pub sine: i32,
}

impl Arc {
    /// No arc: at zero everywhere.
    pub const ZERO: Self = Self { start: [0; 3], across: [0; 3], angle: 0, sine: 0 };

    /// From `start` to `end`, unit vectors in Q2.30.
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

    /// A share `t` (Q2.30, from 0 to 1) of the way from start to end. Error: 2^-26 (tests::ways).
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
    fn ways() {
        let real = |v: [i32; 3]| v.map(|c| f64::from(c) / f64::from(1 << 30));
        let mut worst = 0f64;
        for seed in 1..20_000i32 {
            let c = |k: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> 2;
            let start = normalise([c(1_664_525), c(22_695_477), c(1_103_515_245)]);
            // From far to hardly apart.
            let end = normalise(zip(start, [c(69_069), c(134_775_813), c(214_013)], |s, d| (s >> 1) + (d >> (seed % 24))));
            let (arc, a, b) = (Arc::new(start, end), real(start), real(end));
            let cosine: f64 = (0..3).map(|k| a[k] * b[k]).sum();
            let height = [0, 1, 2].map(|k| b[k] - cosine * a[k]);
            let sine = height.iter().map(|c| c * c).sum::<f64>().sqrt();
            let angle = sine.atan2(cosine);
            for t in [0.0, 0.25, 0.5, 0.9, 1.0] {
                let exact = [0, 1, 2].map(|k| a[k] * (t * angle).cos() + height[k] / sine.max(1e-12) * (t * angle).sin());
                let got = real(arc.at((t * f64::from(1 << 30)) as i32));
                worst = (0..3).map(|k| (got[k] - exact[k]).abs()).fold(worst, f64::max);
            }
        }
        assert!(worst < 2f64.powi(-24), "{worst:e}");
    }
}
