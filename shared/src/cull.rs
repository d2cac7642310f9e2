//! Triangles that face away, told apart in object space: three products, no vertex touched.

use crate::{
    format::{ROTATION, UNIT},
    math::vector::{narrow_dot, wide},
    scene::Pose,
    stream::record::{Camera, PERSPECTIVE, Triangle},
};

/// Where the camera is, as planes see it.
#[derive(Clone, Copy, Debug)]
pub struct Facing {
    /// Perspective: the eye; orthographic: the direction towards the viewer; Q.10.
    vector: [i32; 3],
    /// Takes a plane's offset to the dot product's format; 0 for parallel rays, to which it does not matter.
    offset_scale: i32,
}

/// Fraction bits of `vector`: the dot product with a unit normal then fits 32 bits.
const EYE: u32 = 10;

/// What rounding of eye, normal and offset may add up to, in the dot product's units: 2^-9 of a unit.
const SLACK: i32 = 1 << (EYE + UNIT - 9);

impl Facing {
    /// For the camera of one frame.
    #[must_use]
    pub fn new(camera: &Camera, pose: &Pose) -> Self {
        if camera.projection == PERSPECTIVE {
            Self { vector: pose.eye().map(|c| (c + (1 << (UNIT - EYE - 1))) >> (UNIT - EYE)), offset_scale: 1 << EYE }
        } else {
            let towards = pose.to_object([0, 0, -(1 << ROTATION)]);
            Self { vector: towards.map(|c| (c >> (ROTATION - EYE - 1)).wrapping_add(1) >> 1), offset_scale: 0 }
        }
    }

    /// Whether `triangle` may show its front. Errs on the side of true: the signed area on the screen decides.
    #[inline(always)]
    #[must_use]
    pub fn may_face(&self, triangle: &Triangle) -> bool {
        let plane = i32::from(triangle.offset).wrapping_mul(self.offset_scale);
        narrow_dot(self.vector, wide(triangle.normal)).wrapping_sub(plane) >= -SLACK
    }
}
