//! The transformation of an object from its own space to eye space, in one frame.

use crate::{
    format::{POSITION, ROTATION, UNIT},
    math::vector::{add, dot, map, normalise, sub, transposed},
    scene::{Pose, orbit},
    stream::record::Camera,
};

/// Farthest coordinate of a near light or viewer in object space, Q7.25: 59 units, so that a vertex, which is less than 4 units from the
/// origin, differs from it by less than 64. At the scale 1 none is farther than 56.
const FARTHEST: i64 = (FARTHEST_UNITS as i64) << POSITION;
/// The distance, in units of object space, to which near lights and viewers that are farther away are moved.
pub const FARTHEST_UNITS: u32 = 59;

/// The transformation of an object from its own space to eye space: it is scaled, rotated and moved. The world is the space of an object without a
/// pose.
#[derive(Clone, Copy, Debug)]
pub struct ModelView {
    /// Object to eye space, Q2.30.
    pub rotation: [[i32; 3]; 3],
    /// Translation after rotation, Q18.14.
    pub translation: [i32; 3],
    /// Scale before rotation, a [`crate::format::Scale`].
    pub scale: u32,
    /// Object space to the world, Q2.30.
    to_world: [[i32; 3]; 3],
    /// Position of the object in the world, Q18.14.
    position: [i32; 3],
    /// 1 over the scale, Q16.16, rounded down.
    pub inverse_scale: u32,
}

impl ModelView {
    /// The transformation of the world to eye space in frame `number` of the camera's orbit.
    pub fn new(camera: &Camera, number: u32) -> Self {
        let one = 1 << ROTATION;
        Self {
            rotation: orbit::rotation(camera, number),
            translation: camera.translation,
            scale: 1 << 16,
            to_world: [[one, 0, 0], [0, one, 0], [0, 0, one]],
            position: [0; 3],
            inverse_scale: 1 << 16,
        }
    }

    /// The transformation of an object with this `pose` in the world.
    pub fn of(&self, pose: &Pose) -> Self {
        if *pose == Pose::IDENTITY {
            return *self;
        }
        let (to_world, position, scale) = (pose.matrix(), map(pose.position(), |c| c.to_bits()), pose.scale().to_bits());
        let columns = transposed(to_world);
        let rounded = |a, b| ((dot(a, b) + (1 << (ROTATION - 1))) >> ROTATION) as i32;
        Self {
            rotation: map(self.rotation, |row| map(columns, |column| rounded(row, column))),
            translation: add(map(self.rotation, |row| rounded(row, position)), self.translation),
            scale,
            to_world,
            position,
            inverse_scale: inverse(scale),
        }
    }

    /// Converts a direction of eye space to object space, in the format of `v`, rounded down.
    pub fn to_object(&self, v: [i32; 3]) -> [i32; 3] {
        rotated_back(self.rotation, v)
    }

    /// Converts a direction of the world to object space, in the format of `v`, rounded down.
    pub fn world_to_object(&self, v: [i32; 3]) -> [i32; 3] {
        rotated_back(self.to_world, v)
    }

    /// Converts a point of eye space or of the world, Q18.14, to object space, Q7.25, rounded down. A vector from the object's centre that is too
    /// long for this is shortened, see [`FARTHEST`]. For an object of radius 1 this changes the direction of a point 56 units away or farther by at
    /// most 1/56 rad.
    #[inline(never)]
    pub fn point_to_object(&self, point: [i32; 3], is_eye_space: bool) -> [i32; 3] {
        let point = self.unlimited(point, is_eye_space);
        if point.iter().all(|c| c.abs() <= FARTHEST) {
            return point.map(|c| c as i32);
        }
        // Below 2^36.
        normalise(point.map(|c| (c >> 6) as i32)).map(|c| ((i64::from(c) * FARTHEST) >> ROTATION) as i32)
    }

    /// The eye in object space, Q7.25; see [`FARTHEST`].
    pub fn eye(&self) -> [i32; 3] {
        self.point_to_object([0; 3], true)
    }

    /// Converts a length of the world to units of object space, in its format, rounded down.
    pub fn in_object_units(&self, length: i32) -> i32 {
        ((i64::from(length) * i64::from(self.inverse_scale)) >> 16) as i32
    }

    /// Converts `length` of the world to units of object space, in its format, rounded up.
    pub fn most_in_object_units(&self, length: u32) -> u64 {
        // The inverse is rounded down; at the scale 1 it is exact, and the length as well.
        let inexact = u32::from(self.scale != 1 << 16);
        ((u64::from(length) * u64::from(self.inverse_scale + inexact)) >> 16) + u64::from(inexact)
    }

    /// [`Self::point_to_object`] for a point at any distance.
    #[inline(always)]
    fn unlimited(&self, point: [i32; 3], is_eye_space: bool) -> [i64; 3] {
        let (rotation, centre) = if is_eye_space { (self.rotation, self.translation) } else { (self.to_world, self.position) };
        let way = sub(point, centre);
        // Q.44, then Q.30 of the world, then Q.46 of object space.
        map(transposed(rotation), |column| ((dot(column, way) >> UNIT) * i64::from(self.inverse_scale)) >> (ROTATION + 16 - POSITION))
    }

    /// The squared length, Q.38, of the vector from the object's centre to a point, if the point is so far away that [`Self::point_to_object`]
    /// shortens the vector to [`FARTHEST_UNITS`].
    pub fn shortened(&self, point: [i32; 3], is_eye_space: bool) -> Option<u64> {
        let way = self.unlimited(point, is_eye_space);
        let shorter = way.map(|c| (c >> 6) as i32);
        way.iter().any(|c| c.abs() > FARTHEST).then(|| dot(shorter, shorter) as u64)
    }
}

/// `v` rotated by the inverse of `rotation`, in its format, rounded down.
#[inline(never)]
fn rotated_back(rotation: [[i32; 3]; 3], v: [i32; 3]) -> [i32; 3] {
    map(transposed(rotation), |column| (dot(column, v) >> ROTATION) as i32)
}

/// 1 over a scale, Q16.16, rounded down: 2^32 over its bits, of which 2^32 - 1 lacks one where they are a power of two.
fn inverse(scale: u32) -> u32 {
    u32::MAX.checked_div(scale).unwrap_or(0) + u32::from(scale.is_power_of_two())
}
