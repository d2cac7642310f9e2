//! The lights of one frame in object space. They are moved there once a frame, so that no normal needs to be rotated.

use crate::{
    format::{COSINE, MAX_LIGHTS, UNIT},
    geometry::pose::Pose,
    math::vector::{add, dot, narrow_dot, normalise, sub},
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
    /// A light or viewer at this position, Q18.14.
    Point([i32; 3]),
}

/// Where highlights are seen from, in object space.
#[derive(Clone, Copy, Debug)]
pub enum Viewer {
    /// A viewer that is infinitely far, by the unit vector towards it, Q2.30.
    Infinite([i32; 3]),
    /// A light or viewer at this position, Q18.14.
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
    /// The eye in these axes, relative to the origin of object space, Q18.14. It is as exact as the camera, unlike [`Viewer::Local`].
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

    /// L and H, if there is just one light, directional, under an infinite viewer. N·L and N·H are then linear in N, which every method can
    /// use.
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

    /// Whether all lights are directional and the viewer is infinitely far, so that L and H are the same everywhere.
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

/// Cosine of the angle between two unit vectors, Q2.30, rounded down: their dot product.
///
/// Domain: vectors no longer than 1, Q2.30. Error: less than 1 unit of the last place.
#[inline]
#[must_use]
pub fn cosine(a: [i32; 3], b: [i32; 3]) -> i32 {
    (dot(a, b) >> COSINE) as i32
}

/// A unit vector for products with vertex normals: each component, Q2.30, is kept as an upper part and a lower part of [`UNIT`] bits.
#[derive(Clone, Copy, Debug)]
pub struct Direction {
    upper: [i32; 3],
    lower: [i32; 3],
}

impl Direction {
    /// Splits the unit vector `v`, Q2.30.
    #[must_use]
    pub fn new(v: [i32; 3]) -> Self {
        Self { upper: v.map(|c| c >> UNIT), lower: v.map(|c| c & ((1 << UNIT) - 1)) }
    }

    /// Cosine of the angle to a vertex normal, Q2.30: the bits of [`cosine`], from products of 32 bits.
    ///
    /// Domain: `normal` is no longer than 1, [`crate::format::Unit`]. Exact (tests::vertex_cosines_are_the_same_bits).
    #[inline(always)]
    #[must_use]
    pub fn cosine(&self, normal: [i32; 3]) -> i32 {
        narrow_dot(normal, self.upper).wrapping_add(narrow_dot(normal, self.lower) >> UNIT)
    }
}

/// The unit half vector between two unit vectors, Q2.30; zero if they are opposite. Source: Blinn (1977).
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
}
