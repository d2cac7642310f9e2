//! The lights of one frame in object space. They are transformed once a frame for each object, so that no normal needs to be rotated.

use crate::{
    arch::product::{HALVES, by_fraction, upper},
    features::{ALWAYS_CONSTANT, LIGHT_SHAPES, LIGHTS, NEAR_LIGHTS},
    format::{COSINE, MAX_LIGHTS, POSITION, UNIT},
    geometry::model_view::ModelView,
    lighting::{
        facing::Facing,
        shape::{STRENGTH, Shape},
    },
    math::vector::{add, dot, map, narrow_dot, normalise, sub, wide},
    stream::record::{Camera, EYE_SPACE, Light, POINT, SKY},
};
use zerocopy::{FromBytes, FromZeros as _, Immutable, IntoBytes, KnownLayout};

/// Number of lights that there is room for. Without the feature `lights` a scene has just one; it is black if the mesh file has none.
pub(super) const ROOM: usize = if LIGHTS { MAX_LIGHTS } else { 1 };
/// Number of shapes in a light. A program without them has no memory for them.
pub(crate) const SHAPES: usize = if LIGHT_SHAPES { 1 } else { 0 };

/// A light in object space. It lies in the renderer's memory.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct Source {
    /// For a directional light, and for light from the sky, the unit vector L towards it, and the unit half vector H between L and an infinitely far
    /// viewer, which is unused under a local viewer; Q2.30. For a point light its position, Q7.25, and the axis of its cone, Q2.30.
    vectors: [[i32; 3]; 2],
    /// The kind of light, as in [`Light::kind`].
    kind: u32,
    /// The range and the cone of a point light.
    shape: [Shape; SHAPES],
}

/// Position from which highlights are seen, in object space.
#[derive(Clone, Copy, Debug)]
pub enum Viewer {
    /// An infinitely far viewer, by the unit vector towards it, Q2.30.
    Infinite([i32; 3]),
    /// A viewer at this position, Q7.25.
    Local([i32; 3]),
}

/// All lights of one object in one frame. They lie in the renderer's memory.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Debug)]
#[repr(C)]
pub struct Lighting {
    /// The lights of the scene, in its order; the first `count` are used.
    sources: [Source; ROOM],
    /// The memory of a renderer needs sizes that are multiples of 8.
    reserved: [u32; ROOM % 2],
    count: u32,
    /// Whether no light is a point light: 0 or 1.
    directional: u32,
    /// See [`Viewer`].
    viewer: [i32; 3],
    is_local: u32,
    /// The axes of the eye, to the right, up, and towards the viewer: unit vectors, Q2.30.
    pub axes: [[i32; 3]; 3],
    /// The eye in these axes, relative to the origin of object space and in its units, Q18.14: exact at the scale 1, unlike
    /// [`Viewer::Local`].
    pub eye: [i32; 3],
}

/// The directions of a scene's lights in the world. They are computed once a frame; for each object they are only rotated.
pub struct Directions {
    /// L and H of each light, Q2.30; point lights have none.
    vectors: [[[i32; 3]; 2]; ROOM],
    /// Whether no light is a point light.
    are_directional: bool,
}

impl Directions {
    /// Directions of the lights of a scene, at most [`ROOM`], where `world` maps the world to eye space.
    pub fn new(lights: &[Light], world: &ModelView) -> Self {
        let mut vectors = [[[0; 3]; 2]; ROOM];
        for (direction, light) in vectors.iter_mut().zip(lights).filter(|(_, light)| light.kind != POINT) {
            let unit = normalise(light.vector);
            let towards = if light.space == EYE_SPACE { world.to_object(unit) } else { unit };
            *direction = [towards, half(towards, towards_eye(world))];
        }
        Self { vectors, are_directional: lights.iter().all(|light| light.kind != POINT) }
    }
}

/// The direction towards the eye of an infinitely far viewer: a unit vector, Q2.30.
fn towards_eye(ModelView { rotation: [.., away], .. }: &ModelView) -> [i32; 3] {
    map(*away, |c| -c)
}

impl Lighting {
    /// The lights of a scene in its `world`.
    pub fn new(camera: &Camera, lights: &[Light], world: &ModelView) -> Self {
        let mut lighting = Self::new_zeroed();
        lighting.place(camera, lights, &Directions::new(lights, world), world);
        lighting
    }

    /// Sets the lights of a scene, whose directions are known, for an object at the place `model_view`.
    pub fn place(&mut self, camera: &Camera, lights: &[Light], directions: &Directions, model_view: &ModelView) {
        for ((source, light), towards) in self.sources.iter_mut().zip(lights).zip(&directions.vectors) {
            *source = Source::new(light, towards, model_view);
        }
        self.count = lights.len() as u32;
        if !LIGHTS && lights.is_empty() {
            self.sources.zero();
            self.count = 1;
        }
        self.directional = directions.are_directional.into();
        let is_local = NEAR_LIGHTS && camera.has_local_viewer();
        let ([right, up, _], towards_eye) = (model_view.rotation, towards_eye(model_view));
        (self.is_local, self.viewer) = (is_local.into(), if is_local { model_view.eye() } else { towards_eye });
        self.axes = [right, up, towards_eye];
        let [x, y, z] = map(model_view.translation, |c| model_view.in_object_units(c));
        self.eye = [-x, -y, z];
    }

    /// All lights, in the order of the scene.
    #[inline]
    pub fn sources(&self) -> &[Source] {
        self.sources.get(..self.count as usize).unwrap_or_default()
    }

    /// Position from which highlights are seen.
    #[inline]
    pub fn viewer(&self) -> Viewer {
        if self.is_local() { Viewer::Local(self.viewer) } else { Viewer::Infinite(self.viewer) }
    }

    /// L and H, if there is just one light, it is directional, and the viewer infinitely far. N·L and N·H are then linear in N, which every method
    /// can use.
    pub fn constant(&self) -> Option<&[[i32; 3]; 2]> {
        match self.sources() {
            _ if ALWAYS_CONSTANT => self.sources.first().map(|source| &source.vectors),
            [source] if self.is_constant() && !source.is_sky() => source.directional(),
            _ => None,
        }
    }

    /// Computes how each light falls on a surface at `position` (Q7.25) with the normal `normal` (Q2.30, at most unit length), and adds it to `facing`.
    pub(crate) fn incident(&self, position: [i32; 3], normal: [i32; 3], mut facing: Option<&mut Facing>) -> impl Iterator<Item = Incident> {
        self.sources().iter().enumerate().map(move |(light, source)| {
            let incident = source.incident(self.directions(source, position).map(|direction| cosine(normal, direction)), position);
            if let Some(facing) = &mut facing {
                facing.add(light, source.is_sky(), [incident.towards, incident.half]);
            }
            incident
        })
    }

    /// The unit vectors L and H of a light at `position` (Q7.25), Q2.30.
    pub fn directions(&self, source: &Source, position: [i32; 3]) -> [[i32; 3]; 2] {
        match source.directional() {
            Some(directions) if !self.is_local() => *directions,
            _ => {
                let towards = source.towards(position);
                [towards, half(towards, self.viewer().towards(position))]
            }
        }
    }

    /// Whether no light is a point light and the viewer is infinitely far, so that L and H are the same everywhere.
    #[inline]
    pub fn is_constant(&self) -> bool {
        !NEAR_LIGHTS || self.directional & !self.is_local & 1 != 0
    }

    /// Whether a light has a cone, at whose edge it bends so much that nothing can be interpolated.
    pub(crate) fn has_cone(&self) -> bool {
        self.sources().iter().any(|source| source.shape().is_some_and(|(shape, _)| shape.has_cone()))
    }

    /// Whether either all lights or the viewer are near, and the other is infinitely far, and the light has no other shape than a range. Domain: one
    /// light.
    pub(crate) fn has_one_near(&self) -> bool {
        NEAR_LIGHTS && (self.directional != 0) == self.is_local() && !self.has_cone() && !self.sources().iter().any(Source::is_sky)
    }

    #[inline]
    fn is_local(&self) -> bool {
        NEAR_LIGHTS && self.is_local != 0
    }
}

impl Source {
    /// Transforms `light`, whose L and H in the world are known, to an object at the place `model_view`.
    fn new(light: &Light, directions: &[[i32; 3]; 2], model_view: &ModelView) -> Self {
        let kind = light.kind.into();
        if !NEAR_LIGHTS || light.kind != POINT {
            let [towards, half] = *directions;
            return Self { vectors: [model_view.world_to_object(towards), model_view.world_to_object(half)], kind, ..Self::new_zeroed() };
        }
        let is_eye_space = light.space == EYE_SPACE;
        let point = model_view.point_to_object(light.vector, is_eye_space);
        let (mut axis, mut shape) = ([0; 3], <[Shape; SHAPES]>::new_zeroed());
        if let Some(shape) = shape.first_mut() {
            (*shape, axis) = Shape::new(light, model_view, model_view.shortened(light.vector, is_eye_space));
        }
        Self { vectors: [point, axis], kind, shape }
    }

    /// How the light falls on a surface at `position` (Q7.25), where N·L and N·H are `cosines`.
    fn incident(&self, [towards, half]: [i32; 2], position: [i32; 3]) -> Incident {
        let [point, _] = self.vectors;
        match self.shape() {
            _ if self.is_sky() => Incident { towards: part_of_sky(towards, COSINE), half, strength: 1 << STRENGTH },
            Some((shape, axis)) => Incident { towards, half, strength: shape.strength(axis, sub(point, position)) },
            _ => Incident::from([towards, half]),
        }
    }

    /// The range and the cone of a point light that has one, and the axis of the cone, Q2.30.
    #[inline]
    pub(crate) fn shape(&self) -> Option<(&Shape, [i32; 3])> {
        let [_, axis] = self.vectors;
        self.shape.first().filter(|shape| !shape.is_even()).map(|shape| (shape, axis))
    }

    /// Whether the light comes from the sky.
    #[inline]
    pub fn is_sky(&self) -> bool {
        LIGHT_SHAPES && self.kind == u32::from(SKY)
    }

    /// The smallest N·L, Q2.30, that counts: a surface with this N·L gets no light. It is 0, and -1 for light from the sky.
    #[inline]
    pub fn darkest(&self) -> i32 {
        if self.is_sky() { -(1 << COSINE) } else { 0 }
    }

    /// The unit vectors L and H, Q2.30, of a directional light. H is unused under a local viewer.
    #[inline]
    pub fn directional(&self) -> Option<&[[i32; 3]; 2]> {
        (!self.is_point()).then_some(&self.vectors)
    }

    /// The position, Q7.25, of a point light.
    #[inline]
    pub fn point(&self) -> Option<[i32; 3]> {
        let [point, _] = self.vectors;
        self.is_point().then_some(point)
    }

    #[inline]
    fn is_point(&self) -> bool {
        NEAR_LIGHTS && self.kind == u32::from(POINT)
    }

    /// Unit vector from `position` towards the light, Q2.30.
    pub fn towards(&self, position: [i32; 3]) -> [i32; 3] {
        let [vector, _] = self.vectors;
        if self.is_point() { normalise(sub(vector, position)) } else { vector }
    }
}

impl Viewer {
    /// Unit vector from `position` towards the viewer, Q2.30.
    pub fn towards(&self, position: [i32; 3]) -> [i32; 3] {
        match *self {
            Self::Infinite(towards) => towards,
            Self::Local(eye) => normalise(sub(eye, position)),
        }
    }
}

/// Converts the position of a vertex to a point where light is computed, Q7.25.
#[inline]
pub fn point(position: [i16; 3]) -> [i32; 3] {
    map(wide(position), |c| c << (POSITION - UNIT))
}

/// Cosine of the angle between two unit vectors, Q2.30, rounded down: their dot product.
///
/// Domain: vectors no longer than 1, Q2.30. Error: less than 1 unit of the last place.
#[inline]
pub fn cosine(a: [i32; 3], b: [i32; 3]) -> i32 {
    (dot(a, b) >> COSINE) as i32
}

/// The dot product of a vector no longer than 2^`BITS` and a unit vector, Q2.30, in the format of the former with its `BITS` bits taken
/// off: rounded down. Exact, from products of 32 bits where longer ones are calls.
#[inline]
fn scaled_dot<const BITS: u32>(v: [i32; 3], unit: [i32; 3]) -> i32 {
    if !HALVES {
        return (dot(v, unit) >> BITS) as i32;
    }
    let [x, y, z] = unit;
    let lower = |c: i32| c & ((1 << BITS) - 1);
    let upper = narrow_dot(v, [x >> BITS, y >> BITS, z >> BITS]);
    upper.wrapping_add(narrow_dot(v, [lower(x), lower(y), lower(z)]) >> BITS)
}

/// [`cosine`] of a vertex normal, [`crate::format::Unit`], and a unit vector. The result has the same bits and is computed faster.
#[inline]
pub fn vertex_cosine(normal: [i32; 3], direction: [i32; 3]) -> i32 {
    scaled_dot::<UNIT>(normal, direction)
}

/// A unit normal that is a vector times a factor.
pub trait UnitNormal {
    /// Cosine of the angle to a unit vector, both Q2.30.
    fn cosine(&self, direction: [i32; 3]) -> i32;
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
    #[inline]
    pub fn new(a: [i32; 3], b: [i32; 3], excess: u16) -> Self {
        Self { sum: add(a, b), excess }
    }

    /// A vertex normal, or the normal of a triangle's plane.
    #[inline]
    pub fn at(normal: [i32; 3]) -> Self {
        Self::new(normal, normal, 0)
    }
}

impl UnitNormal for MeanNormal {
    /// At a vertex the bits of [`vertex_cosine`].
    #[inline]
    fn cosine(&self, direction: [i32; 3]) -> i32 {
        let mean = scaled_dot::<{ UNIT + 1 }>(self.sum, direction);
        mean.wrapping_add(by_fraction(mean, self.excess))
    }
}

/// An interpolated normal over its length.
#[derive(Clone, Copy, Debug)]
pub struct InterpolatedNormal {
    /// The normal as it is interpolated, Q2.30.
    pub vector: [i32; 3],
    /// Half of its reciprocal length, Q2.30.
    pub half_reciprocal: i32,
}

impl UnitNormal for InterpolatedNormal {
    #[inline]
    fn cosine(&self, direction: [i32; 3]) -> i32 {
        over_length(cosine(self.vector, direction), self.half_reciprocal)
    }
}

/// A cosine with an interpolated normal, Q2.30, divided by the normal's length. Half of the reciprocal length is Q2.30. Error: 2^-27.
#[inline]
pub(crate) fn over_length(cosine: i32, half_reciprocal: i32) -> i32 {
    upper(cosine, half_reciprocal) << 3
}

/// How a light falls on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Incident {
    /// N·L, Q2.30. For light from the sky (1 + N·L)/2.
    pub towards: i32,
    /// N·H, Q2.30.
    pub half: i32,
    /// What range and cone leave of the light: up to 1 << [`STRENGTH`].
    pub strength: u32,
}

impl From<[i32; 2]> for Incident {
    /// The light of a directional light, by N·L and N·H.
    #[inline]
    fn from([towards, half]: [i32; 2]) -> Self {
        Self { towards, half, strength: 1 << STRENGTH }
    }
}

/// The part of the sky's half about the direction L that a surface sees, (1 + N·L)/2, from N·L in any format with `1 << bits` as one.
#[inline]
pub(crate) fn part_of_sky(cosine: i32, bits: u32) -> i32 {
    (cosine >> 1) + (1 << (bits - 1))
}

/// The unit half vector between two unit vectors, Q2.30; zero if they are opposite. Source: Blinn (1977).
fn half(towards: [i32; 3], viewer: [i32; 3]) -> [i32; 3] {
    normalise(add(towards.map(|c| c >> 1), viewer.map(|c| c >> 1)))
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
