//! Culling of triangles that face away, in object space, by four products and without touching vertices. Other triangles are culled by their extent
//! on the screen.
//!
//! Corners that are drawn are rounded in eye space and on the screen, and rounding may turn a thin triangle that faces away to the front. If it were
//! culled, a closed mesh would have a hole there, because its neighbours leave those pixels to it. So a triangle is culled only where no rounding can
//! turn it:
//!
//! Write `a` for the triangle's least altitude, `D` for a distance from the eye that no vertex exceeds, and `r` for how far
//! rounding moves a corner in object space at most; a rounded corner is taken for the point where the ray through its place on
//! the screen has the depth that the corner was rounded to. Move the corners along straight lines to the rounded ones. If the
//! triangle turns over, then on the way it is seen edge-on: some plane through the eye passes within `r` of each exact corner.
//! A triangle is in no direction narrower than `a`.
//!
//! - If that plane meets the exact triangle, in `q`, distances from it span at most `2 r` on the triangle, so the planes meet
//!   under an angle whose sine is at most `2 r / a`. The eye, in the one plane and at most `D` from `q`, is no
//!   higher over the other one than `2 r D / a`.
//! - Else distances from it span less than `r`. Let `q` be the triangle's point nearest to the eye. It lies within `r` of
//!   that plane, so the eye is no higher than `r + r |q| / a`. The triangle lies in a ball of radius `D` about the eye, no
//!   point of it nearer than `q`, so in a ball of radius `sqrt(D² - q²)`: there `a` is at most 1.5 such radii. Hence
//!   `a + |q| <= 1.81 D`, and the height is below `2 r D / a` again.
//!
//! Parallel rays have a direction instead of the eye. The plane then contains it, and the product of direction and unit normal
//! is no larger than the angle's sine: the same with `D = 1`, since a direction has length one.
//!
//! So the eye of a triangle that is culled lies lower than `-2 r D / a`. A frame has one `r D`, a record has `1 / a`. Where
//! `1 / a` is too large for a record, the slack is still almost `2 D`, for `r` is no less than the last place of a coordinate:
//! no eye is as low as that.
//!
//! The promise is about triangles that are drawn whole. One that is clipped is decided by its own plane too, but it is drawn in
//! parts, which may be thinner than it is: one of them may turn over and be lost.

use crate::{
    arch::{product::product, zeros::leading_zeros},
    format::{INVERSE_ALTITUDE, UNIT},
    geometry::{model_view::ModelView, projection::View},
    math::vector::{map, narrow_dot, wide},
    stream::record::{LEAN, Triangle},
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// The position of the camera, against which the planes of triangles are tested. It lies in the renderer's memory. Lengths are in units of object
/// space, or, if the eye is too far away for this, in such units times a power of two.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct Facing {
    /// With perspective the eye, with parallel rays the direction towards the viewer; Q.10.
    vector: [i32; 3],
    /// Factor from the format of a plane's offset to that of the dot product; 0 for parallel rays, which do not depend on the offset.
    offset_scale: i32,
    /// `2 r D`, by which heights may be off for each unit of [`Triangle::inverse_altitude`], Q.16.
    slack: i32,
    /// `D`, Q18.14.
    reach: i32,
}

/// Fraction bits of `vector`: the dot product with a unit normal then fits 32 bits.
const EYE: u32 = 10;

/// Bits of the whole units of the eye's coordinates: below 64, so that with the slack a height fits 32 bits.
const FARTHEST_EYE: u32 = 6;

/// Fraction bits of a height: the slack of any triangle then fits 32 bits.
const HEIGHT: u32 = 18;

/// Fraction bits of `slack`.
const PER_ALTITUDE: u32 = HEIGHT - INVERSE_ALTITUDE;

/// Largest `slack`: with the largest [`Triangle::inverse_altitude`] and a height it stays below 2^31.
const MAX_SLACK: u64 = (1 << 14) - 1;

/// The largest error of a height by rounding of eye and normal: 2^-9 of a unit.
///
/// The eye is off by at most 15.6 units in the last place of a [`crate::format::Unit`]: √3 times half a step of
/// [`EYE`] and one of 2^-14. A unit normal is off by at most 2.6, √3 times one and a half: under parallel rays that adds up, in
/// perspective [`Triangle::offset`] makes up for it. A height is rounded down by less than one. 2^-9 is 32 of these units.
const SLACK: i32 = 1 << (HEIGHT - 9);

impl Facing {
    /// A test that culls nothing: all heights are 0.
    pub const ANY: Self = Self { vector: [0; 3], offset_scale: 0, slack: 0, reach: 0 };

    /// The test for a mesh in the ball of `radius` about the origin, [`crate::stream::record::Header::radius`], at the place `model_view`, seen as
    /// `view` says.
    pub fn new(view: &View, model_view: &ModelView, radius: u16) -> Self {
        let (vector, reach) = (view.viewer(model_view), view.reach(radius));
        // In object space: rounding moves a corner by as much more as the object is small.
        let moved = model_view.most_in_object_units(view.lens.displacement(reach));
        let (right, larger, offset_scale, reach) = if view.lens.is_perspective() {
            // The eye is taken to units that are larger than those of object space by a power of two, and so large that 32 bits hold it.
            let [x, y, z] = map(vector, i32::unsigned_abs);
            let farthest = (x | y | z) >> UNIT;
            let finer = view.viewer_exponent();
            let right = (32 - farthest.leading_zeros()).saturating_sub(FARTHEST_EYE).max(finer.max(0).unsigned_abs());
            let larger = right.saturating_add_signed(-finer).min(31);
            let reach = (model_view.most_in_object_units(reach) as u32 + ((1 << larger) - 1)) >> larger;
            (right, larger, (1 << EYE) >> larger, reach)
        } else {
            (0, 0, 0, reach)
        };
        // 2 r D, from Q.30 and Q.14, rounded up. A direction that is not scaled by a power of two is up to twice as long as a unit vector.
        let doubled = u64::from(!view.lens.is_perspective() && !view.scale.is_power_of_two());
        let slack = (((2 * moved * u64::from(reach)) >> (30 + UNIT - PER_ALTITUDE)) + 1) << doubled;
        if slack > MAX_SLACK || larger > EYE {
            // There are so few pixels that any triangle may turn over.
            return Self::ANY;
        }
        let right = right + UNIT - EYE;
        let vector = map(vector, |c| (c + (1 << (right - 1))) >> right);
        Self { vector, offset_scale, slack: slack as i32, reach: reach as i32 }
    }

    /// Whether `triangle` may show its front. If in doubt the answer is yes, and the signed area on the screen decides.
    #[inline]
    pub fn may_face(&self, triangle: &Triangle) -> bool {
        self.height(triangle) >= Self::FRONT
    }

    /// Smallest [`Self::height`] above triangles that may show their front.
    pub(crate) const FRONT: i32 = -SLACK;

    /// The height of the eye above the plane of `triangle`, plus the slack that makes up for its rounded corners.
    #[inline]
    pub(crate) fn height(&self, triangle: &Triangle) -> i32 {
        let plane = i32::from(triangle.offset).wrapping_mul(self.offset_scale);
        let height = narrow_dot(self.vector, wide(triangle.normal)).wrapping_sub(plane) >> (EYE + UNIT - HEIGHT);
        height.wrapping_add(self.slack.wrapping_mul(triangle.inverse_altitude.into()))
    }

    /// Smallest [`Self::height`] above triangles that could show their front if their plane leaned as far as [`crate::stream::record::CLOSED_CONVEX`]
    /// allows.
    pub(crate) fn leaning(&self) -> i32 {
        // An angle of 2^-LEAN, seen from as far as any vertex is.
        Self::FRONT - ((self.reach << (HEIGHT - UNIT)) >> LEAN)
    }
}

/// The bounding box and area of a triangle on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Leftmost column, in 1/16 pixel.
    pub left: i32,
    /// Rightmost column, in 1/16 pixel.
    pub right: i32,
    /// Uppermost row, in 1/16 pixel.
    pub top: i32,
    /// Lowest row, in 1/16 pixel.
    pub bottom: i32,
    /// Twice the signed area, 1/256 pixel², as far as 32 bits hold it; positive seen from the front.
    pub area: i32,
}

impl Extent {
    /// The extent of corners `[x, y]` that run clockwise as seen from the front.
    #[inline]
    pub fn new([[x0, y0], [x1, y1], [x2, y2]]: [[i32; 2]; 3]) -> Self {
        // From the first corner, because comparisons with zero are single instructions.
        let (x1, y1, x2, y2) = (x1 - x0, y1 - y0, x2 - x0, y2 - y0);
        let (left, right) = (x0 + x1.min(0).min(x2), x0 + x1.max(0).max(x2));
        let (top, bottom) = (y0 + y1.min(0).min(y2), y0 + y1.max(0).max(y2));
        // Products of 64 bits are calls on an M0+.
        let area = if (right - left) | (bottom - top) < 1 << 15 { x1 * y2 - x2 * y1 } else { large_area([x1, y1], [x2, y2]) };
        Self { left, right, top, bottom, area }
    }

    /// Whether the triangle is word-sized, see [`fits_words`].
    #[inline]
    pub(crate) fn fits_words(&self) -> bool {
        fits_words(((self.right - self.left) | (self.bottom - self.top)) as u32, self.area)
    }

    /// An upper bound of the longest side: the larger of width and height plus half of the other, since x² + y² <= (x + y/2)² where y <= x.
    #[inline]
    pub fn length(&self) -> i32 {
        let (width, height) = (self.right - self.left, self.bottom - self.top);
        width.max(height) + ((width.min(height) + 1) >> 1)
    }
}

/// Bits of the sides of a word-sized triangle, in 1/16 pixel.
const WORD_SIDE: u32 = 10;

/// Whether a triangle is word-sized: so small, and so far from [`crate::setup::gradients::MAX_THINNESS`], that its polynomials are set up in words.
/// `size` is the larger of width and height of its bounding box, or the bitwise or of both. `area` is twice its area.
#[inline]
pub(crate) fn fits_words(size: u32, area: i32) -> bool {
    // 2^(2 bits) <= 128 area.
    size < 1 << WORD_SIDE && area > 1 && 64 - 2 * leading_zeros(size) + leading_zeros(area as u32) <= 38
}

#[cold]
#[inline(never)]
fn large_area([x1, y1]: [i32; 2], [x2, y2]: [i32; 2]) -> i32 {
    let area = product(x1, y2) - product(x2, y1);
    area.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}
