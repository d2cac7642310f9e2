//! The lens of the camera, which projects eye space to the screen. All objects of a frame share it.

use crate::{
    arch::{
        product::{product, upper},
        quotient::long,
    },
    format::{DEPTH, SUBPIXEL, UNIT},
    math::{
        recip::{quotient, recip},
        scale,
    },
    stream::record::{Camera, PERSPECTIVE},
};
use embedded_graphics_core::geometry::Size;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Largest distance of screen coordinates from the viewport's centre, in 1/16 pixel.
///
/// It is twice the widest viewport. Triangles that merely cross the border of the viewport are not clipped.
pub const GUARD: i32 = 4096 << SUBPIXEL;

/// Largest distance of a coordinate in eye space from that of the exact convex body, up to a common shift, in units of its last place: 1/2
/// by its own rounding, and √3 times 0.86 by rounding in the mesh.
const MOVED: u32 = 2;

/// Inverse depth of a vertex at the near plane, Q0.28: less than one, so that rounding cannot wrap it.
const NEAREST: i32 = (1 << DEPTH) - (1 << 10);

/// Inverse depth of a vertex at the far plane of parallel rays or beyond, Q0.28: more than nothing, so that rounding cannot wrap it, and less
/// than what the depth buffer tells from nothing.
const FARTHEST: i32 = 1 << 10;

/// Fraction bits of [`Lens::unit_per_pixel`].
const PER_PIXEL: u32 = 14;

/// The projection from eye space to a viewport. It lies in the renderer's memory.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct Lens {
    /// Half of the viewport's smaller side, in 1/16 pixel, times the focal length, Q.16.
    focal: i64,
    /// Parallel rays: inverse depth per unit of distance, Q.14.
    inv_depth: i64,
    /// Centre of the viewport, 1/16 pixel.
    centre: [i32; 2],
    pub(crate) near: i32,
    /// Parallel rays: depth where inverse depth is 0.
    pub(crate) far: i32,
    /// Whether rays meet in the eye: 0 or 1.
    is_perspective: u32,
    /// Perspective: [`Self::focal`] as a mantissa of 31 bits, and its fraction bits.
    focal_mantissa: i32,
    focal_exponent: u32,
    /// Perspective: [`Self::near`] as a mantissa of 31 bits.
    near_mantissa: i32,
    /// Perspective: the shift that puts depth into the upper half of the product of `near` and 1/z.
    depth_shift: u32,
    /// Units, Q.30, that 25/32 of 1/16 pixel are at the distance 2^-14, rounded up; with [`PER_PIXEL`] more fraction bits.
    unit_per_pixel: u32,
}

impl Lens {
    /// The projection of `camera` onto a viewport of `size` pixels.
    pub fn new(camera: &Camera, size: Size) -> Self {
        let smaller = size.width.min(size.height);
        let focal = (i64::from(smaller) << (SUBPIXEL - 1)) * i64::from(camera.focal);
        let near = camera.near.max(1);
        let bits = 64 - focal.leading_zeros();
        let shift = near.leading_zeros() - 1;
        let is_perspective = camera.projection == PERSPECTIVE;
        // A focal length is not 0. The quotient may be too small by one part of 2^28.
        let unit_per_pixel = quotient(25 << (30 + 16 - UNIT - 5 + PER_PIXEL), focal.unsigned_abs());
        Self {
            focal,
            inv_depth: if is_perspective { 0 } else { long((NEAREST as u64) << UNIT, (camera.far - near).max(1) as u64) as i64 },
            centre: [(size.width << (SUBPIXEL - 1)) as i32, (size.height << (SUBPIXEL - 1)) as i32],
            near,
            far: camera.far,
            is_perspective: is_perspective.into(),
            focal_mantissa: if bits > 31 { focal >> (bits - 31) } else { focal << (31 - bits) } as i32,
            // The focal length is Q.16; at 31 bits its fraction bits are these.
            focal_exponent: 16 + 31 - bits,
            near_mantissa: near << shift,
            depth_shift: shift + 30 - DEPTH,
            unit_per_pixel: u32::try_from(unit_per_pixel + (unit_per_pixel >> 27) + 1).unwrap_or(u32::MAX),
        }
    }

    /// Projects a point of eye space to `[x, y, inv_depth]` on the screen, and tells whether it lies behind the near plane and within the guard band.
    /// Other points are moved there; only clipping, which rounds, may use them.
    #[inline(always)]
    pub fn project(&self, eye: [i32; 3]) -> ([i32; 3], bool) {
        let [x, y, z] = eye;
        let (behind, z) = (z >= self.near, z.max(self.near));
        let (x, y, depth) = if self.is_perspective() {
            let reciprocal = Reciprocal::of(z);
            (self.place(x, reciprocal), self.place(y, reciprocal), self.depth(reciprocal))
        } else {
            (self.parallel_place(x), self.parallel_place(y), self.parallel_depth(z))
        };
        let inside = |c: i32| c.wrapping_add(GUARD) as u32 <= 2 * GUARD as u32;
        let within = behind && inside(x) && inside(y);
        let [x, y] = if within { [x, y] } else { [limited(x), limited(y)] };
        ([self.centre[0] + x, self.centre[1] - y, depth.min(NEAREST)], within)
    }

    /// Projects a box of eye space behind the near plane, given by `[least, most]` coordinates. Returns `[left, right]` and `[top, bottom]`, in 1/16
    /// pixel, and the largest inverse depth, Q0.28.
    pub fn project_box(&self, [across, up, [nearest, farthest]]: [[i32; 2]; 3]) -> ([[i32; 2]; 2], i32) {
        // Each side is seen farthest out where it is nearest, or, across the middle of the screen, farthest.
        let (near, far) = (Reciprocal::of(nearest), Reciprocal::of(farthest));
        let place = |c: i32, reciprocal| {
            let place = if self.is_perspective() { self.place(c, reciprocal) } else { self.parallel_place(c) };
            place.clamp(-GUARD, GUARD)
        };
        let range =
            |[least, most]: [i32; 2]| [place(least, if least < 0 { near } else { far }), place(most, if most < 0 { far } else { near })];
        let ([left, right], [below, above], [x, y]) = (range(across), range(up), self.centre);
        let inv_depth = if self.is_perspective() { self.depth(near) } else { self.parallel_depth(nearest) };
        ([[x + left, x + right], [y - above, y - below]], inv_depth.min(NEAREST))
    }

    /// Perspective: a coordinate in eye space at a depth, from the middle of the screen.
    #[inline(always)]
    fn place(&self, c: i32, Reciprocal { r, zeros }: Reciprocal) -> i32 {
        // c focal is below 2^(21 + 31); 31 bits of it times r stay below 2^62.
        shifted(product((product(c, self.focal_mantissa) >> 21) as i32, r), 41 - zeros + self.focal_exponent)
    }

    /// Perspective: inverse depth, Q0.28. Domain: behind the near plane.
    #[inline(always)]
    fn depth(&self, Reciprocal { r, zeros }: Reciprocal) -> i32 {
        // Behind the near plane a depth has no more leading zeros than `near`: the shift is positive.
        upper(self.near_mantissa, r) >> ((self.depth_shift - zeros) & 31)
    }

    /// [`Self::place`] under parallel rays.
    #[inline]
    fn parallel_place(&self, c: i32) -> i32 {
        narrowed::<{ UNIT + 16 }>(i64::from(c) * self.focal + (1 << (UNIT + 15)))
    }

    /// [`Self::depth`] under parallel rays.
    #[inline]
    fn parallel_depth(&self, z: i32) -> i32 {
        narrowed::<UNIT>(i64::from(self.far - z) * self.inv_depth).max(FARTHEST)
    }

    /// Whether the camera is perspective, so that rays meet in the eye.
    #[inline]
    pub fn is_perspective(&self) -> bool {
        self.is_perspective != 0
    }

    /// Pixels of the viewport.
    pub fn size(&self) -> Size {
        let [width, height] = self.centre;
        Size::new(width as u32 >> (SUBPIXEL - 1), height as u32 >> (SUBPIXEL - 1))
    }

    /// Largest distance by which rounding may move a vertex at the distance `reach` from the eye, Q.30, saturating at 32 bits.
    ///
    /// In eye space that is half a unit in the last place along each axis, √3/2 = 0.87 in all; on the screen along both axes half of 1/16
    /// pixel, with 2^-7 to spare for the arithmetic on the way: √2 · 65/128 = 0.72 of 1/16 pixel. With room for a rotation that is rounded
    /// they are one unit and 25/32.
    pub fn displacement(&self, reach: u32) -> u32 {
        let pixel = (u64::from(reach) * u64::from(self.unit_per_pixel)) >> PER_PIXEL;
        u32::try_from(pixel + 1 + (1 << (30 - UNIT))).unwrap_or(u32::MAX)
    }

    /// Largest distance along x or y by which rounding may move a point of a mesh that is marked as [`crate::stream::record::CLOSED_CONVEX`] and lies
    /// behind the near plane; `times` this distance, in 1/16 pixel, rounded up.
    pub fn moved(&self, times: u32) -> u32 {
        let focal = (self.focal >> 16) as u32;
        let (beside, unit) = if self.is_perspective() {
            // The point moves sideways by focal / z, and for its depth by as much as it lies off the axis.
            let [x, y] = self.centre;
            (x.max(y).unsigned_abs(), self.near.unsigned_abs())
        } else {
            (0, 1 << UNIT)
        };
        let within = times.wrapping_mul(MOVED).wrapping_mul(focal.wrapping_add(beside));
        // Screen coordinates are rounded to the nearest, with 2^-7 to spare for the arithmetic before.
        let rounded = times.wrapping_mul(65).div_ceil(128);
        within.checked_div(unit).map_or(u32::MAX, |within| within.saturating_add(1).saturating_add(rounded))
    }

    /// The distance of `eye` from a clip plane (near, then the guard band's left, right, bottom, top); negative outside.
    pub fn distance(&self, eye: [i32; 3], plane: usize) -> i64 {
        let [x, y, z] = eye.map(i64::from);
        let along = match plane {
            0 => return z - i64::from(self.near),
            1 => -x,
            2 => x,
            3 => -y,
            _ => y,
        };
        // along * focal / z <= GUARD, z being 1 without perspective.
        let z = if self.is_perspective() { z } else { 1 << UNIT };
        ((i64::from(GUARD) * z) << 16) - along * self.focal
    }
}

/// 1/z = r 2^(zeros - 62), relative error 2^-29 wherever the near plane lies.
#[derive(Clone, Copy)]
struct Reciprocal {
    r: i32,
    zeros: u32,
}

impl Reciprocal {
    #[inline(always)]
    fn of(z: i32) -> Self {
        let zeros = z.leading_zeros();
        Self { r: recip((z as u32) << (zeros & 31)) as i32, zeros }
    }
}

/// `value / 2^bits`, rounded to the nearest, saturating at 32 bits.
#[inline(always)]
fn shifted(value: i64, bits: u32) -> i32 {
    match bits.checked_sub(33) {
        Some(bits) => (((value >> 32) as i32 >> (bits & 31)) + 1) >> 1,
        None => slightly_shifted(value, bits),
    }
}

/// [`shifted`] where a part of the lower half remains, as for very near points.
#[cold]
#[inline(never)]
fn slightly_shifted(value: i64, bits: u32) -> i32 {
    scale(value, bits as i32).clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

/// Clamps a coordinate to the guard band.
#[cold]
#[inline(never)]
fn limited(c: i32) -> i32 {
    c.clamp(-GUARD, GUARD)
}

/// `value / 2^BITS`, rounded down. A value that does not fit 32 bits becomes a number near the end that it exceeds: only the upper half is compared,
/// because a comparison of long numbers takes longer.
#[inline(always)]
fn narrowed<const BITS: u32>(value: i64) -> i32 {
    const { assert!(BITS > 0 && BITS < 32) };
    let upper = ((value >> 32) as i32).clamp(-1 << (BITS - 1), (1 << (BITS - 1)) - 1);
    upper << (32 - BITS) | (value as u32 >> BITS) as i32
}

/// Number of clip planes of [`Lens::distance`].
pub const PLANES: usize = 5;

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{
        format::ROTATION,
        stream::record::{ORTHOGRAPHIC, VIEWER_INFINITE},
    };

    /// A camera at the origin of the world that looks along -z.
    pub(crate) const CAMERA: Camera = Camera {
        rotation: [[1 << ROTATION, 0, 0], [0, 1 << ROTATION, 0], [0, 0, -1 << ROTATION]],
        translation: [0; 3],
        axis: [0, 1 << ROTATION, 0],
        period: 0,
        projection: PERSPECTIVE,
        viewer: VIEWER_INFINITE,
        focal: 1 << 16,
        near: 1 << 12,
        far: 1 << 15,
    };

    /// Narrowed values are exact as far as a screen or a depth reaches, and all others stay beyond.
    #[test]
    fn narrowed_values_saturate() {
        const REACH: i64 = 1 << (DEPTH + 1);
        let checked = |value: i64| {
            let within =
                |narrowed: i32, bits: u32| assert_eq!(i64::from(narrowed).clamp(-REACH, REACH), (value >> bits).clamp(-REACH, REACH));
            within(narrowed::<{ UNIT + 16 }>(value), UNIT + 16);
            within(narrowed::<UNIT>(value), UNIT);
        };
        for bits in 0..63 {
            for value in [(1i64 << bits) - 1, 1 << bits, 3 << bits >> 1, (1 << bits) + 12_345] {
                checked(value);
                checked(-value);
            }
        }
        checked(i64::MAX);
        checked(i64::MIN);
    }

    /// A vertex beyond the far plane of parallel rays has no depth, even if rounding makes its depth smaller than the plane's; it must not wrap to
    /// the nearest depth.
    #[test]
    fn depth_beyond_the_far_plane_cannot_wrap() {
        let lens = Lens::new(&Camera { projection: ORTHOGRAPHIC, ..CAMERA }, Size::new(64, 64));
        for z in [1 << 15, 1 << 16, 1 << 20] {
            let ([.., depth], _) = lens.project([0, 0, z]);
            // A quarter of a step of the depth buffer away from both.
            let step = 1 << (DEPTH - 16);
            assert!(depth >= step / 4 && depth <= step - step / 4, "{z}: {depth}");
        }
    }

    /// Screen coordinates are right to 1/16 pixel wherever the near plane lies.
    #[test]
    fn projection_keeps_its_precision() {
        for near in [1 << 8, 1 << 12, 3 << 13, 5 << 14] {
            for focal in [1u32 << 12, 1 << 16, 140_000, 16 << 16] {
                let lens = Lens::new(&Camera { focal, near, far: 0, ..CAMERA }, Size::new(640, 480));
                assert_eq!(lens.size(), Size::new(640, 480));
                for k in 0..2_000i32 {
                    let eye = [
                        (k * 7_919) % 90_000 - 45_000,
                        (k * 104_729) % 90_000 - 45_000,
                        near + k.wrapping_mul(1_299_709).rem_euclid(200_000),
                    ];
                    let place = |c: i32| f64::from(c) / f64::from(eye[2]) * f64::from(focal) / 65_536.0 * 240.0 * 16.0;
                    let exact = [320.0 * 16.0 + place(eye[0]), 240.0 * 16.0 - place(eye[1])];
                    let ([x, y, depth], inside) = lens.project(eye);
                    if inside {
                        assert!(
                            (f64::from(x) - exact[0]).abs() <= 0.51 && (f64::from(y) - exact[1]).abs() <= 0.51,
                            "{eye:?}: {x} {y} {exact:?}"
                        );
                        let inv_depth = f64::from(near) / f64::from(eye[2]) * 2f64.powi(DEPTH as i32);
                        assert!((f64::from(depth) - inv_depth).abs() <= 1_025.0, "{eye:?}: {depth} {inv_depth}");
                    }
                }
            }
        }
    }

    /// What rounding moves is no less than the formula says, and more by a thousandth at most.
    #[test]
    fn displacement_is_rounded_up() {
        for (focal, side) in [(1u32 << 12, 1u32), (1 << 16, 64), (140_000, 240), (140_000, 2048), (16 << 16, 2048)] {
            let lens = Lens::new(&Camera { focal, ..CAMERA }, Size::new(side, side));
            for reach in [1u32, 20_000, 1 << 17, 1 << 22] {
                // 25/32 of 1/16 pixel at that distance, and one unit of the last place.
                let pixel = f64::from(reach) * 25.0 / 32.0 / (f64::from(side) * 8.0 * f64::from(focal) / 65_536.0) * 2f64.powi(16);
                let exact = (pixel + 2f64.powi(16)).min(f64::from(u32::MAX));
                let found = f64::from(lens.displacement(reach));
                assert!(found >= exact && found <= exact * 1.001 + 2.0, "{focal} {side} {reach}: {found} {exact}");
            }
        }
    }
}
