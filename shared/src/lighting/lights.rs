//! The lights of one frame in object space. They are moved there once a frame, so that no normal needs to be rotated.

use crate::{
    arch::product::{HALVES, by_fraction},
    format::{COSINE, MAX_LIGHTS, POSITION, UNIT},
    geometry::pose::Pose,
    math::vector::{add, dot, narrow_dot, normalise, sub, wide},
    stream::{
        Stream,
        record::{DIRECTIONAL, EYE_SPACE, Light, PERSPECTIVE, VIEWER_LOCAL},
    },
};

/// A light in object space.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// A light that is infinitely far, by unit vectors, Q2.30.
    Directional {
        /// The unit vector towards the light, L.
        towards: [i32; 3],
        /// The unit half vector H between L and an infinite viewer; unused under a local viewer.
        half: [i32; 3],
    },
    /// A light at this position, Q7.25.
    Point([i32; 3]),
}

/// Where highlights are seen from, in object space.
#[derive(Clone, Copy, Debug)]
pub enum Viewer {
    /// A viewer that is infinitely far, by the unit vector towards it, Q2.30.
    Infinite([i32; 3]),
    /// A viewer at this position, Q7.25.
    Local([i32; 3]),
}

/// All lights of one frame.
#[derive(Clone, Debug)]
pub struct Lighting {
    /// All lights, in the order of the stream.
    pub sources: heapless::Vec<Source, MAX_LIGHTS>,
    /// Where highlights are seen from.
    pub viewer: Viewer,
    /// The axes of the eye, to the right, up, and towards the viewer: unit vectors, Q2.30.
    pub axes: [[i32; 3]; 3],
    /// The eye in these axes, relative to the origin of object space, Q18.14: exact, unlike [`Viewer::Local`].
    pub eye: [i32; 3],
    /// See [`Self::is_directional`].
    directional: bool,
}

impl Lighting {
    /// The stream's lights for `pose`.
    #[must_use]
    pub fn new(stream: &Stream<'_>, pose: &Pose) -> Self {
        let header = stream.header;
        let [right, up, away] = pose.rotation;
        let towards_eye = away.map(|c| -c);
        let viewer = if header.camera.viewer == VIEWER_LOCAL && header.camera.projection == PERSPECTIVE {
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
        let directional = sources.iter().all(|source| matches!(source, Source::Directional { .. }));
        Self { sources, viewer, axes: [right, up, towards_eye], eye: [-x, -y, z], directional }
    }

    /// L and H, if there is just one light, directional, under an infinite viewer. N·L and N·H are then linear in N, which every method can
    /// use.
    #[must_use]
    pub fn constant(&self) -> Option<[[i32; 3]; 2]> {
        match (self.sources.as_slice(), self.viewer) {
            ([Source::Directional { towards, half }], Viewer::Infinite(_)) => Some([*towards, *half]),
            _ => None,
        }
    }

    /// `[N·L, N·H]` of each light, Q2.30, at `position` (Q7.25) with the normal `normal` (Q2.30, at most unit length).
    pub fn cosines(&self, position: [i32; 3], normal: [i32; 3]) -> impl Iterator<Item = [i32; 2]> {
        self.sources.iter().map(move |source| self.directions(source, position).map(|direction| cosine(normal, direction)))
    }

    /// The unit vectors L and H of a light at `position` (Q7.25), Q2.30.
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

    /// Whether all lights are directional and the viewer is infinitely far, so that L and H are the same everywhere.
    #[inline(always)]
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.directional && !self.viewer.is_local()
    }

    /// Whether all lights are directional.
    #[inline(always)]
    #[must_use]
    pub fn is_directional(&self) -> bool {
        self.directional
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
    /// Whether the viewer is at a position.
    #[inline(always)]
    #[must_use]
    pub fn is_local(&self) -> bool {
        matches!(self, Self::Local(_))
    }

    /// Unit vector from `position` towards the viewer, Q2.30.
    #[must_use]
    pub fn towards(&self, position: [i32; 3]) -> [i32; 3] {
        match *self {
            Self::Infinite(towards) => towards,
            Self::Local(eye) => normalise(sub(eye, position)),
        }
    }
}

/// The position of a vertex as a point where light is computed, Q7.25.
#[inline(always)]
#[must_use]
pub fn point(position: [i16; 3]) -> [i32; 3] {
    let [x, y, z] = wide(position);
    [x << (POSITION - UNIT), y << (POSITION - UNIT), z << (POSITION - UNIT)]
}

/// Cosine of the angle between two unit vectors, Q2.30, rounded down: their dot product.
///
/// Domain: vectors no longer than 1, Q2.30. Error: less than 1 unit of the last place.
#[inline]
#[must_use]
pub fn cosine(a: [i32; 3], b: [i32; 3]) -> i32 {
    (dot(a, b) >> COSINE) as i32
}

/// The dot product of a vector no longer than 2^`BITS` and a unit vector, Q2.30, in the format of the former with its `BITS` bits taken
/// off: rounded down. Exact, from products of 32 bits where longer ones are calls.
#[inline(always)]
fn scaled_dot<const BITS: u32>(v: [i32; 3], unit: [i32; 3]) -> i32 {
    if !HALVES {
        return (dot(v, unit) >> BITS) as i32;
    }
    let [x, y, z] = unit;
    let lower = |c: i32| c & ((1 << BITS) - 1);
    let upper = narrow_dot(v, [x >> BITS, y >> BITS, z >> BITS]);
    upper.wrapping_add(narrow_dot(v, [lower(x), lower(y), lower(z)]) >> BITS)
}

/// [`cosine`] of a vertex normal, [`crate::format::Unit`], and a unit vector: the same bits, sooner.
#[inline(always)]
#[must_use]
pub fn vertex_cosine(normal: [i32; 3], direction: [i32; 3]) -> i32 {
    scaled_dot::<UNIT>(normal, direction)
}

/// A unit normal half-way between two vertices, or at one of them: half the sum of two vertex normals, times a factor.
#[derive(Clone, Copy, Debug)]
pub struct MeanNormal {
    /// The sum, Q3.14.
    sum: [i32; 3],
    /// The factor less one, Q0.16: [`crate::stream::record::Triangle::inverse_sum_length`].
    excess: u16,
}

impl MeanNormal {
    /// Half-way between two vertex normals, with the factor of their edge in the stream.
    #[inline(always)]
    #[must_use]
    pub fn new(a: [i32; 3], b: [i32; 3], excess: u16) -> Self {
        Self { sum: add(a, b), excess }
    }

    /// A vertex normal, or that of a triangle's plane.
    #[inline(always)]
    #[must_use]
    pub fn at(normal: [i32; 3]) -> Self {
        Self::new(normal, normal, 0)
    }

    /// Cosine of the angle to a unit vector, Q2.30. At a vertex the bits of [`vertex_cosine`].
    #[inline(always)]
    #[must_use]
    pub fn cosine(&self, direction: [i32; 3]) -> i32 {
        let mean = scaled_dot::<{ UNIT + 1 }>(self.sum, direction);
        mean.wrapping_add(by_fraction(mean, self.excess))
    }
}

/// The unit half vector between two unit vectors, Q2.30; zero if they are opposite. Source: Blinn (1977).
fn half(towards: [i32; 3], viewer: [i32; 3]) -> [i32; 3] {
    normalise(add(towards.map(|c| c >> 1), viewer.map(|c| c >> 1)))
}

fn source(light: &Light, pose: &Pose, towards_eye: [i32; 3]) -> Source {
    if light.kind == DIRECTIONAL {
        let vector = normalise(light.vector);
        let towards = if light.space == EYE_SPACE { pose.to_object(vector) } else { vector };
        return Source::Directional { towards, half: half(towards, towards_eye) };
    }
    let vector = light.vector;
    let from_centre = || pose.point_to_object(sub(vector, pose.translation));
    Source::Point(if light.space == EYE_SPACE { from_centre() } else { vector.map(|c| c << (POSITION - UNIT)) })
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
            let exact = cosine(normal.map(|c| c << 16), direction);
            assert_eq!(vertex_cosine(normal, direction), exact, "{direction:?} {normal:?}");
            assert_eq!(MeanNormal::at(normal).cosine(direction), exact, "{direction:?} {normal:?}");
        }
    }
}
