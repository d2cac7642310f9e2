//! Triangles that face away, told apart in object space: three products, no vertex touched.

use crate::{
    format::{ROTATION, UNIT},
    scene::Pose,
    stream::record::{Camera, PERSPECTIVE, Triangle},
};

/// Where the camera is, as planes see it.
#[derive(Clone, Copy, Debug)]
pub struct Facing {
    /// Perspective: the eye; orthographic: the direction towards the viewer; Q.10.
    vector: [i32; 3],
    /// Shift that takes a plane's offset to the dot product's format.
    offset_shift: Option<u32>,
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
            Self { vector: pose.eye().map(|c| (c + (1 << (UNIT - EYE - 1))) >> (UNIT - EYE)), offset_shift: Some(EYE) }
        } else {
            let towards = pose.to_object([0, 0, -(1 << ROTATION)]);
            Self { vector: towards.map(|c| (c >> (ROTATION - EYE - 1)).wrapping_add(1) >> 1), offset_shift: None }
        }
    }

    /// Whether `triangle` may show its front. Errs on the side of true: the signed area on the screen decides.
    #[inline(always)]
    #[must_use]
    pub fn may_face(&self, triangle: &Triangle) -> bool {
        let [x, y, z] = self.vector;
        let [a, b, c] = triangle.normal.map(i32::from);
        let dot = x.wrapping_mul(a).wrapping_add(y.wrapping_mul(b)).wrapping_add(z.wrapping_mul(c));
        let plane = self.offset_shift.map_or(0, |shift| i32::from(triangle.offset) << shift);
        dot >= plane - SLACK
    }
}
