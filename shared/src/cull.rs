//! Triangles that face away, told apart in object space: three products, no vertex touched. Those that it lets through are
//! told apart by their extent on the screen.

use crate::{
    format::{ROTATION, UNIT},
    math::{
        product::product,
        vector::{narrow_dot, wide},
        zeros::leading_zeros,
    },
    scene::Pose,
    stream::record::{Camera, LEAN, PERSPECTIVE, Triangle},
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
        self.height(triangle) >= Self::FRONT
    }

    /// Least [`Self::height`] above triangles that may show their front.
    pub(crate) const FRONT: i32 = -SLACK;

    /// How high the eye lies above the plane of `triangle`.
    #[inline(always)]
    #[must_use]
    pub(crate) fn height(&self, triangle: &Triangle) -> i32 {
        let plane = i32::from(triangle.offset).wrapping_mul(self.offset_scale);
        narrow_dot(self.vector, wide(triangle.normal)).wrapping_sub(plane)
    }

    /// Least [`Self::height`] above triangles that might show their front if their plane leaned as [`crate::stream::record::CLOSED_CONVEX`] allows.
    #[must_use]
    pub(crate) fn leaning(&self) -> i32 {
        // From the eye to any point of the body: its own distance from the origin and, with room to spare, a radius.
        let [x, y, z] = self.vector.map(i32::abs);
        let reach = x + y + z + 2 * self.offset_scale;
        Self::FRONT - (reach << (UNIT - LEAN))
    }
}

/// What a triangle takes up on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Least column, 1/16 pixel.
    pub left: i32,
    /// Largest column.
    pub right: i32,
    /// Least row.
    pub top: i32,
    /// Largest row.
    pub bottom: i32,
    /// Twice the signed area, 1/256 pixel², as far as 32 bits hold it; positive seen from the front.
    pub area: i32,
}

impl Extent {
    /// Of corners `[x, y]` that run clockwise seen from the front.
    #[inline(always)]
    #[must_use]
    pub fn new([[x0, y0], [x1, y1], [x2, y2]]: [[i32; 2]; 3]) -> Self {
        let (left, right) = (x0.min(x1).min(x2), x0.max(x1).max(x2));
        let (top, bottom) = (y0.min(y1).min(y2), y0.max(y1).max(y2));
        let (x1, y1, x2, y2) = (x1 - x0, y1 - y0, x2 - x0, y2 - y0);
        // Products of 64 bits are calls on an M0+.
        let area = if (right - left) | (bottom - top) < 1 << 15 { x1 * y2 - x2 * y1 } else { large_area([x1, y1], [x2, y2]) };
        Self { left, right, top, bottom, area }
    }

    /// Small and stout, see [`is_small`].
    #[inline(always)]
    #[must_use]
    pub(crate) fn is_small(&self) -> bool {
        is_small(((self.right - self.left) | (self.bottom - self.top)) as u32, self.area)
    }

    /// Its longest side is no longer: the larger of width and height and half of the other, since
    /// x² + y² <= (x + y/2)² where y <= x.
    #[inline(always)]
    #[must_use]
    pub fn length(&self) -> i32 {
        let (width, height) = (self.right - self.left, self.bottom - self.top);
        width.max(height) + ((width.min(height) + 1) >> 1)
    }
}

/// Bits of the sides of a small triangle, 1/16 pixel.
const SMALL: u32 = 10;

/// Whether a triangle is so small and stout, not even nearly [`crate::poly::basis::MAX_THINNESS`], that its polynomials are set up in
/// words: by its box's width or height, whichever is larger or both in one, and twice its area.
#[inline(always)]
pub(crate) fn is_small(size: u32, area: i32) -> bool {
    // 2^(2 bits) <= 128 area.
    size < 1 << SMALL && area > 1 && 64 - 2 * leading_zeros(size) + leading_zeros(area as u32) <= 38
}

#[cold]
#[inline(never)]
fn large_area([x1, y1]: [i32; 2], [x2, y2]: [i32; 2]) -> i32 {
    let area = product(x1, y2) - product(x2, y1);
    area.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}
