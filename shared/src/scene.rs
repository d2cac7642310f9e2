//! One frame's camera and lights, moved into object space: once per frame, instead of every normal out of it.

use crate::{
    format::{COSINE, MAX_LIGHTS, ROTATION, UNIT},
    math::vector::{add, cross, dot, narrow_dot, normalise, sub, transposed, zip},
    stream::{
        Stream,
        record::{Camera, DIRECTIONAL, EYE_SPACE, Light, PERSPECTIVE, VIEWER_LOCAL},
    },
};
use micromath::F32Ext;

/// A light in object space.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// Unit vector towards it, Q2.30, and the unit half vector between it and an infinite viewer.
    Directional {
        /// L.
        towards: [i32; 3],
        /// H; not used with a local viewer.
        half: [i32; 3],
    },
    /// Position, Q18.14.
    Point([i32; 3]),
}

/// Where highlights are seen from, in object space.
#[derive(Clone, Copy, Debug)]
pub enum Viewer {
    /// Unit vector towards it, Q2.30.
    Infinite([i32; 3]),
    /// Position, Q18.14.
    Local([i32; 3]),
}

/// The camera of one frame.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// Object to eye space, Q2.30.
    pub rotation: [[i32; 3]; 3],
    /// Added after rotation, Q18.14.
    pub translation: [i32; 3],
}

impl Pose {
    /// The camera's pose in frame `number`.
    #[must_use]
    pub fn new(camera: &Camera, number: u32) -> Self {
        let mut rotation = camera.rotation;
        if let Some(frame) = number.checked_rem(camera.period.into())
            && frame != 0
        {
            rotation = turned(rotation, camera.axis, frame, camera.period.into());
        }
        Self { rotation, translation: camera.translation }
    }

    /// A direction of eye space in object space; same format.
    #[must_use]
    pub fn to_object(&self, v: [i32; 3]) -> [i32; 3] {
        transposed(self.rotation).map(|column| (dot(column, v) >> ROTATION) as i32)
    }

    /// The eye in object space, Q18.14.
    #[must_use]
    pub fn eye(&self) -> [i32; 3] {
        self.to_object(self.translation.map(|c| -c))
    }
}

/// `rotation` times the rotation by `frame / period` of a turn about `axis`: Rodrigues' formula, row by row.
fn turned(rotation: [[i32; 3]; 3], axis: [i32; 3], frame: u32, period: u32) -> [[i32; 3]; 3] {
    let (sin, cos) = sin_cos(frame, period);
    let limit = 1i64 << ROTATION;
    rotation.map(|row| {
        let along = ((dot(row, axis) >> ROTATION) * (limit - cos)) >> ROTATION;
        let turned = zip(row, axis, |r, a| i64::from(r) * cos + along * i64::from(a));
        zip(turned, cross(row, axis), |t, c| ((t + (c >> ROTATION) * sin) >> ROTATION).clamp(-limit, limit) as i32)
    })
}

/// Sine and cosine of `frame / period` of a turn, Q2.30.
///
/// micromath's polynomial is off by up to 1e-3 but the same on every machine; two
/// Newton steps put the pair back on the unit circle (tests::unit_circle), so a
/// rotation stays one. The angle keeps the error: an orbit may run 0.1 degrees ahead.
fn sin_cos(frame: u32, period: u32) -> (i64, i64) {
    let angle = frame as f32 / period as f32 * core::f32::consts::TAU;
    let one = (1u32 << ROTATION) as f32;
    let (mut sin, mut cos) = ((F32Ext::sin(angle) * one) as i64, (F32Ext::cos(angle) * one) as i64);
    for _ in 0..2 {
        let square = (sin * sin + cos * cos) >> ROTATION;
        let factor = ((3 << ROTATION) - square) >> 1;
        sin = (sin * factor) >> ROTATION;
        cos = (cos * factor) >> ROTATION;
    }
    (sin, cos)
}

/// All lights of one frame.
#[derive(Clone, Debug)]
pub struct Lighting {
    /// In the stream's order.
    pub sources: heapless::Vec<Source, MAX_LIGHTS>,
    /// For highlights.
    pub viewer: Viewer,
    /// The axes of the eye, to the right, up, and towards the viewer: unit vectors, Q2.30.
    pub axes: [[i32; 3]; 3],
    /// The eye in these axes, seen from the object's origin, Q18.14: as exact as the camera, unlike a [`Viewer::Local`].
    pub eye: [i32; 3],
}

impl Lighting {
    /// The stream's lights for `pose`.
    #[must_use]
    pub fn new(stream: &Stream<'_>, pose: &Pose) -> Self {
        let header = stream.header;
        let [right, up, away] = pose.rotation;
        let towards_eye = away.map(|c| -c);
        let viewer = if header.viewer == VIEWER_LOCAL && header.camera.projection == PERSPECTIVE {
            Viewer::Local(pose.eye())
        } else {
            Viewer::Infinite(towards_eye)
        };
        let mut sources = heapless::Vec::new();
        for light in stream.lights {
            // A checked stream has no more lights than there is room for.
            let _ = sources.push(source(light, pose, towards_eye));
        }
        let [x, y, z] = pose.translation;
        Self { sources, viewer, axes: [right, up, towards_eye], eye: [-x, -y, z] }
    }

    /// The two directions that matter if there is just one light, directional, under an infinite viewer:
    /// then N·L and N·H are linear in N, which every method can use.
    #[must_use]
    pub fn constant(&self) -> Option<[[i32; 3]; 2]> {
        match (self.sources.as_slice(), self.viewer) {
            ([Source::Directional { towards, half }], Viewer::Infinite(_)) => Some([*towards, *half]),
            _ => None,
        }
    }

    /// `[N·L, N·H]` of each light, Q2.30, at `position` (Q18.14) with the normal `normal` (Q2.30, at most unit length).
    pub fn cosines(&self, position: [i32; 3], normal: [i32; 3]) -> impl Iterator<Item = [i32; 2]> {
        self.sources.iter().map(move |source| self.directions(source, position).map(|direction| cosine(normal, direction)))
    }

    /// The unit vectors L and H of a light at `position` (Q18.14), Q2.30.
    #[must_use]
    pub fn directions(&self, source: &Source, position: [i32; 3]) -> [[i32; 3]; 2] {
        match (*source, self.viewer) {
            (Source::Directional { towards, half }, Viewer::Infinite(_)) => [towards, half],
            _ => {
                let towards = source.towards(position);
                [towards, half(towards, self.viewer.towards(position))]
            }
        }
    }

    /// All lights are directional and the viewer is infinitely far: L and H are the same everywhere.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        let directional = self.sources.iter().all(|source| matches!(source, Source::Directional { .. }));
        directional && matches!(self.viewer, Viewer::Infinite(_))
    }
}

impl Source {
    /// Unit vector from `position` towards the light, Q2.30.
    #[must_use]
    pub fn towards(&self, position: [i32; 3]) -> [i32; 3] {
        match *self {
            Self::Directional { towards, .. } => towards,
            Self::Point(light) => normalise(sub(light, position)),
        }
    }
}

impl Viewer {
    /// Unit vector from `position` towards the viewer, Q2.30.
    #[must_use]
    pub fn towards(&self, position: [i32; 3]) -> [i32; 3] {
        match *self {
            Self::Infinite(towards) => towards,
            Self::Local(eye) => normalise(sub(eye, position)),
        }
    }
}

/// The product of two vectors no longer than 1, all Q2.30.
#[inline]
#[must_use]
pub fn cosine(a: [i32; 3], b: [i32; 3]) -> i32 {
    (dot(a, b) >> COSINE) as i32
}

/// A unit vector for products with vertex normals: its components, Q2.30, in an upper and a lower part of [`UNIT`] bits.
#[derive(Clone, Copy, Debug)]
pub struct Direction {
    upper: [i32; 3],
    lower: [i32; 3],
}

impl Direction {
    /// Of `v`, Q2.30.
    #[must_use]
    pub fn new(v: [i32; 3]) -> Self {
        Self { upper: v.map(|c| c >> UNIT), lower: v.map(|c| c & ((1 << UNIT) - 1)) }
    }

    /// [`cosine`] of this and a vertex normal, [`crate::format::Unit`]: the same bits, from products of 32 bits.
    #[inline(always)]
    #[must_use]
    pub fn cosine(&self, normal: [i32; 3]) -> i32 {
        narrow_dot(normal, self.upper).wrapping_add(narrow_dot(normal, self.lower) >> UNIT)
    }
}

/// Unit half vector.
fn half(towards: [i32; 3], viewer: [i32; 3]) -> [i32; 3] {
    normalise(add(towards.map(|c| c >> 1), viewer.map(|c| c >> 1)))
}

fn source(light: &Light, pose: &Pose, towards_eye: [i32; 3]) -> Source {
    let vector = if light.kind == DIRECTIONAL {
        normalise(light.vector)
    } else if light.space == EYE_SPACE {
        sub(light.vector, pose.translation)
    } else {
        light.vector
    };
    let vector = if light.space == EYE_SPACE { pose.to_object(vector) } else { vector };
    if light.kind == DIRECTIONAL { Source::Directional { towards: vector, half: half(vector, towards_eye) } } else { Source::Point(vector) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertex_cosines_are_the_same_bits() {
        for seed in 1..20_000i32 {
            let c = |k: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77);
            let direction = normalise([c(1_664_525), c(22_695_477), c(1_103_515_245)]);
            let normal = normalise([c(69_069), c(134_775_813), c(48_271)]).map(|c| c >> 16);
            assert_eq!(Direction::new(direction).cosine(normal), cosine(normal.map(|c| c << 16), direction), "{direction:?} {normal:?}");
        }
    }

    #[test]
    fn unit_circle() {
        for period in [1u32, 2, 3, 7, 36, 120, 1000, 65_535] {
            for frame in (0..period).step_by(1 + period as usize / 1000) {
                let (sin, cos) = sin_cos(frame, period);
                let (s, c) = (sin as f64 / 2f64.powi(30), cos as f64 / 2f64.powi(30));
                assert!((s * s + c * c - 1.0).abs() < 1e-8, "{frame}/{period}: {s} {c}");
                let angle = f64::from(frame) / f64::from(period) * core::f64::consts::TAU;
                assert!((angle.sin() - s).abs() < 2e-3 && (angle.cos() - c).abs() < 2e-3, "{frame}/{period}: {s} {c}");
            }
        }
    }
}
