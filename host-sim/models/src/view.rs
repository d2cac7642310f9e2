//! Views: camera and projection of a scene.

use crate::vector::{V3, add, apply, cross, product, rotation, unit};
use std::f64::consts::TAU;

/// Kinds of projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Rays meet in the eye.
    Perspective,
    /// Rays are parallel.
    Orthographic,
}

/// A camera as a stream describes it, in `f64`.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Rows from object to eye space (x right, y up, z away), frame 0.
    pub rotation: [V3; 3],
    /// Position of the object's centre in eye space.
    pub translation: V3,
    /// Unit axis of the orbit, object space.
    pub axis: V3,
    /// Frames per revolution; 0 stands still.
    pub period: u16,
    /// Kind of projection.
    pub projection: Projection,
    /// Focal length, see [`microphong::stream::record::Camera::focal`].
    pub focal: f64,
    /// Nearest distance drawn.
    pub near: f64,
    /// Farthest distance drawn, orthographic only.
    pub far: f64,
}

/// The axis of object space that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Up {
    /// x up, front towards +z.
    X,
    /// y up, front towards +z.
    Y,
    /// z up, front towards -y.
    Z,
    /// -x up, front towards +z.
    MinusX,
    /// -y up, front towards +z.
    MinusY,
    /// -z up, front towards +y.
    MinusZ,
}

impl Up {
    /// All axes.
    pub const ALL: [Self; 6] = [Self::X, Self::Y, Self::Z, Self::MinusX, Self::MinusY, Self::MinusZ];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::MinusX => "-x",
            Self::MinusY => "-y",
            Self::MinusZ => "-z",
        }
    }

    /// The directions up and to the front.
    const fn axes(self) -> [V3; 2] {
        match self {
            Self::X => [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            Self::Y => [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            Self::Z => [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
            Self::MinusX => [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            Self::MinusY => [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
            Self::MinusZ => [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        }
    }
}

/// Turns per orbit at which the picture is measured.
const STEPS: u32 = 72;

impl View {
    /// An eye at `distance`, `azimuth` to the right of the front and `elevation` above the horizon, radians.
    #[must_use]
    pub fn orbit(up: Up, azimuth: f64, elevation: f64, distance: f64, period: u16) -> Self {
        let [up, front] = up.axes();
        // Seen from the front, right is up x front.
        let right = cross(up, front);
        let rows = [right, up, front];
        let (tilt, turn) = (rotation([1.0, 0.0, 0.0], elevation), rotation([0.0, 1.0, 0.0], -azimuth));
        Self::facing(product(&tilt, &product(&turn, &rows)), distance, up, period)
    }

    /// `rows` turn the object to x right, y up and z towards the eye.
    #[must_use]
    pub fn facing(rows: [V3; 3], distance: f64, axis: V3, period: u16) -> Self {
        let away = rows[2].map(|c| -c);
        Self {
            rotation: [rows[0], rows[1], away],
            translation: [0.0, 0.0, distance],
            axis: unit(axis).unwrap_or([0.0, 1.0, 0.0]),
            period,
            projection: Projection::Perspective,
            focal: 1.0,
            near: (distance - 1.5).max(1.0 / 32.0),
            far: distance + 1.5,
        }
    }

    /// Replaces the projection by parallel rays, where half of the smaller side shows `1 / focal` units.
    #[must_use]
    pub fn parallel(self) -> Self {
        Self { projection: Projection::Orthographic, ..self }
    }

    /// Replaces the focal length.
    #[must_use]
    pub fn focal(self, focal: f64) -> Self {
        Self { focal, ..self }
    }

    /// `point` of object space in eye space after `turn` of a revolution.
    #[must_use]
    pub fn eye_space(&self, point: V3, turn: f64) -> V3 {
        add(apply(&self.rotation, apply(&rotation(self.axis, turn * TAU), point)), self.translation)
    }

    /// Chooses focal length, height and near plane such that all frames show all points inside a picture of
    /// `size`, `margin` (a share of it) away from its edges.
    #[must_use]
    pub fn fit(mut self, points: &[V3], size: (u32, u32), margin: f64) -> Self {
        let side = f64::from(size.0.min(size.1));
        let (wide, high) = (f64::from(size.0) / side * (1.0 - margin), f64::from(size.1) / side * (1.0 - margin));
        // Moving the object changes its perspective a little: a few rounds settle it.
        for _ in 0..4 {
            let bounds = self.bounds(points);
            self.translation[1] -= (bounds.low + bounds.high) / 2.0 * self.depth_of(self.translation[2]);
        }
        let bounds = self.bounds(points);
        let tall = bounds.high.max(-bounds.low);
        self.focal = (wide / bounds.across.max(1e-3)).min(high / tall.max(1e-3)).clamp(1.0 / 16.0, 16.0);
        self.near = (bounds.nearest * 0.98).max(1.0 / 64.0);
        self.far = bounds.farthest * 1.02;
        self
    }

    fn depth_of(&self, z: f64) -> f64 {
        if self.projection == Projection::Perspective { z.max(1.0 / 64.0) } else { 1.0 }
    }

    fn bounds(&self, points: &[V3]) -> Bounds {
        let steps = if self.period == 0 { 1 } else { STEPS };
        let mut bounds = Bounds { across: 0.0, low: f64::MAX, high: f64::MIN, nearest: f64::MAX, farthest: 0.0 };
        for step in 0..steps {
            let turn = f64::from(step) / f64::from(steps);
            let rows = product(&self.rotation, &rotation(self.axis, turn * TAU));
            for &point in points {
                let [x, y, z] = add(apply(&rows, point), self.translation);
                let depth = self.depth_of(z);
                bounds.across = bounds.across.max((x / depth).abs());
                bounds.low = bounds.low.min(y / depth);
                bounds.high = bounds.high.max(y / depth);
                bounds.nearest = bounds.nearest.min(z);
                bounds.farthest = bounds.farthest.max(z);
            }
        }
        bounds
    }
}

/// Bounds of the points of all frames in the picture plane, and their depth.
struct Bounds {
    across: f64,
    low: f64,
    high: f64,
    nearest: f64,
    farthest: f64,
}
