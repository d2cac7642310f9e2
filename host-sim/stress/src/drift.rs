//! Orbits over all 2^32 frames: nothing accumulates.

use crate::{Family, Verdict, random::Random};
use microphong::{
    geometry::model_view::ModelView,
    scene::{ORBIT_ERROR, ROTATION_ERROR},
    stream::record::{Camera, PERSPECTIVE},
};
use microphong_models::vector::{V3, apply, dot, length, product, rotation, sub};
use std::f64::consts::TAU;

/// Frames of random orbits.
pub struct Drift;

/// Largest error of a rotation's entries: the angle's error, and the rounding of a camera's matrix.
pub const LIMIT: f64 = ORBIT_ERROR + 4.0 * ROTATION_ERROR;

impl Family for Drift {
    fn name(&self) -> &'static str {
        "drift"
    }

    fn about(&self) -> &'static str {
        "the camera of each of 2^32 frames has a rotation as exact as in the first frame"
    }

    fn limit(&self) -> Option<(f64, &'static str)> {
        Some((LIMIT, "radians"))
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let (start, axis) = (rotation(random.direction(), random.between(0.0, TAU)), random.direction());
        let fixed = |c: f64| (c * f64::from(1 << 30)).round() as i32;
        let camera = Camera {
            rotation: start.map(|row| row.map(fixed)),
            translation: [0, 0, 3 << 14],
            axis: axis.map(fixed),
            period: random.pick(1..65_536) as u16,
            projection: PERSPECTIVE,
            viewer: microphong::stream::record::VIEWER_INFINITE,
            focal: 1 << 16,
            near: 1 << 14,
            far: 0,
        };
        let frame = random.bits() as u32;
        let pose = ModelView::new(&camera, frame);
        let turn = f64::from(frame % u32::from(camera.period)) / f64::from(camera.period) * TAU;
        let worst = error(&pose, &product(&start, &rotation(axis, turn)));
        let mut verdict = Verdict::of(worst, LIMIT, None);
        if let Some(what) = &mut verdict.failure {
            *what += &format!(" in frame {frame} of an orbit of {} about {axis:?}", camera.period);
        }
        verdict
    }
}

/// The difference of a pose from these rows, and from a rotation.
#[must_use]
pub fn error(pose: &ModelView, exact: &[V3; 3]) -> f64 {
    let rows: [V3; 3] = pose.rotation.map(|row| row.map(|c| f64::from(c) / f64::from(1 << 30)));
    let mut worst = 0f64;
    for point in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        worst = worst.max(length(sub(apply(&rows, point), apply(exact, point))));
    }
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let square = dot(rows[i], rows[j]) - f64::from(u8::from(i == j));
        worst = worst.max(square.abs());
    }
    worst
}
