//! Projection of object space to the screen.

use crate::{
    arch::{
        product::{product, upper},
        quotient::long,
    },
    format::{DEPTH, ROTATION, SUBPIXEL, UNIT},
    geometry::{area::Area, model_view::ModelView},
    math::{
        recip::{quotient, recip},
        scale,
        vector::{add, cross, narrow_dot, wide},
    },
    stream::record::{Camera, PERSPECTIVE},
};
use embedded_graphics_core::geometry::Size;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// A lit vertex on the screen.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct ScreenVertex {
    /// Column, 1/16 pixel.
    pub x: i32,
    /// Row, 1/16 pixel, downwards.
    pub y: i32,
    /// Inverse depth, Q0.28.
    pub depth: i32,
    /// What [`crate::method::VertexLight`] says: N·L and N·H of a constant light in Q2.30, and of a second one, or light levels in Q9.7.
    pub light: [i32; 4],
    /// Whether position and light are those of this frame.
    pub state: State,
}

impl ScreenVertex {
    /// Light levels, Q9.7, of a vertex that has these.
    #[inline(always)]
    #[must_use]
    pub fn levels(&self) -> [i32; 3] {
        let [r, g, b, _] = self.light;
        [r, g, b]
    }
}

/// The state of a cached vertex in this frame.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct State(u32);

impl State {
    /// The vertex is not transformed: no triangle that faces the camera has used it.
    pub const IDLE: Self = Self(0);
    /// Position and light are those of this frame.
    pub const READY: Self = Self(1);
    /// The vertex lies in front of the near plane or beyond the guard band: its triangles are clipped.
    pub const OUTSIDE: Self = Self(2);
}

/// Largest distance from the viewport's centre that screen coordinates may have, in 1/16 pixel.
///
/// Twice the widest viewport: triangles that only cross its border are not clipped but walked.
pub const GUARD: i32 = 4096 << SUBPIXEL;

/// Largest distance of a coordinate in eye space from that of the exact convex body, up to a common shift, in units of its last place: 1/2
/// by its own rounding, and √3 times 0.86 by rounding in the mesh.
const MOVED: u32 = 2;

/// Inverse depth of a vertex at the near plane, Q0.28: less than one, so that rounding cannot wrap it.
const NEAREST: i32 = (1 << DEPTH) - (1 << 10);

/// Inverse depth of a vertex at the far plane of parallel rays or beyond, Q0.28: more than nothing, so that rounding cannot wrap it, and less
/// than what the depth buffer tells from nothing.
const FARTHEST: i32 = 1 << 10;

/// Depths that the buffer tells apart: by no more may a pixel be nearer than the corners of its triangle are, by what is rounded.
const SPARE: u16 = 4;

/// The transformation from object space to the screen in one frame, in memory of the renderer.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct View {
    /// Half of the viewport's smaller side, in 1/16 pixel, times the focal length, Q.16.
    focal: i64,
    /// Parallel rays: inverse depth per unit of distance, Q.14.
    inv_depth: i64,
    /// Object to eye space, as exact as positions are: the rotation times the scale, of which [`Self::shift`] has a power of two.
    rotation: [[i32; 3]; 3],
    /// Fraction bits of `rotation`: 14 at the scale 1, and its entries below 2^14 in size at any.
    shift: u32,
    translation: [i32; 3],
    /// Centre of the viewport, 1/16 pixel.
    centre: [i32; 2],
    near: i32,
    /// Parallel rays: depth where inverse depth is 0.
    far: i32,
    /// Whether rays meet in the eye: 0 or 1.
    is_perspective: u32,
    /// Perspective: [`Self::focal`] as a mantissa of 31 bits, and its fraction bits.
    focal_mantissa: i32,
    focal_exponent: u32,
    /// Perspective: [`Self::near`] as a mantissa of 31 bits.
    near_mantissa: i32,
    /// Perspective: the shift that puts depth into the upper half of the product of `near` and 1/z.
    depth_shift: u32,
    /// [`crate::format::Scale`] of the object.
    scale: u32,
    /// [`ModelView::inverse_scale`].
    inverse_scale: u32,
}

impl View {
    /// How `model_view` is seen on a viewport of `size` pixels.
    #[must_use]
    pub fn new(camera: &Camera, model_view: &ModelView, size: Size) -> Self {
        let scale = model_view.scale.max(1);
        // The scale is a mantissa of at most 1, Q1.30, times a power of two: 2^(exponent - 16).
        let exponent = 32 - (scale - 1).leading_zeros();
        let mantissa = i64::from(scale) << (ROTATION - exponent.min(ROTATION));
        let round = |c: i32| (((c as i64 * mantissa) >> ROTATION) as i32 + (1 << (ROTATION - UNIT - 1))) >> (ROTATION - UNIT);
        let smaller = size.width.min(size.height);
        let focal = (i64::from(smaller) << (SUBPIXEL - 1)) * i64::from(camera.focal);
        let near = camera.near.max(1);
        let bits = 64 - focal.leading_zeros();
        let shift = near.leading_zeros() - 1;
        let is_perspective = camera.projection == PERSPECTIVE;
        Self {
            focal,
            inv_depth: if is_perspective { 0 } else { long((NEAREST as u64) << UNIT, (camera.far - near).max(1) as u64) as i64 },
            rotation: model_view.rotation.map(|row| row.map(round)),
            shift: UNIT + 16 - exponent,
            translation: model_view.translation,
            centre: [(size.width << (SUBPIXEL - 1)) as i32, (size.height << (SUBPIXEL - 1)) as i32],
            near,
            far: camera.far,
            is_perspective: is_perspective.into(),
            focal_mantissa: if bits > 31 { focal >> (bits - 31) } else { focal << (31 - bits) } as i32,
            // The focal length is Q.16; at 31 bits its fraction bits are these.
            focal_exponent: 16 + 31 - bits,
            near_mantissa: near << shift,
            depth_shift: shift + 30 - DEPTH,
            scale,
            inverse_scale: model_view.inverse_scale,
        }
    }

    /// Object to eye space, Q18.14.
    #[inline(always)]
    #[must_use]
    pub fn to_eye(&self, position: [i16; 3]) -> [i32; 3] {
        let [x, y, z] = self.rotation;
        let along = |row| narrow_dot(row, wide(position)) >> (self.shift & 31);
        add([along(x), along(y), along(z)], self.translation)
    }

    /// Eye space to `[x, y, inv_depth]` on the screen, and whether the point lies behind the near plane and within the guard band. Other
    /// points are moved there; only clipping, which rounds, may use them.
    #[inline(always)]
    #[must_use]
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
    #[inline(always)]
    fn parallel_place(&self, c: i32) -> i32 {
        saturated((i64::from(c) * self.focal + (1 << (UNIT + 15))) >> (UNIT + 16))
    }

    /// [`Self::depth`] under parallel rays.
    #[inline(always)]
    fn parallel_depth(&self, z: i32) -> i32 {
        saturated((i64::from(self.far - z) * self.inv_depth) >> UNIT).max(FARTHEST)
    }

    /// Whether the camera is perspective, so that rays meet in the eye.
    #[must_use]
    pub fn is_perspective(&self) -> bool {
        self.is_perspective != 0
    }

    /// How many bits the units of [`Self::viewer`] are smaller than those of object space; negative if they are larger.
    #[must_use]
    pub fn viewer_exponent(&self) -> i32 {
        UNIT as i32 - self.shift as i32
    }

    /// `length` of the world in units of object space, in its format, rounded up. Domain: below 2^44.
    #[must_use]
    pub fn in_object_units(&self, length: u64) -> u64 {
        // The inverse is rounded down.
        if self.scale == 1 << 16 { length } else { ((length * (u64::from(self.inverse_scale) + 1)) >> 16) + 1 }
    }

    /// The object's scale, [`crate::format::Scale`].
    #[must_use]
    pub fn scale(&self) -> u32 {
        self.scale
    }

    /// `length` of the world in units of object space, in its format, rounded down; as far as 32 bits hold it.
    #[must_use]
    pub fn least_in_object_units(&self, length: u32) -> u32 {
        u32::try_from((u64::from(length) * u64::from(self.inverse_scale)) >> 16).unwrap_or(u32::MAX)
    }

    /// Where the origin of object space lies in eye space, Q18.14.
    #[must_use]
    pub fn origin(&self) -> [i32; 3] {
        self.translation
    }

    /// The eye in object space, Q18.14, or the direction towards the viewer under parallel rays, Q2.14, both in units that are as large as
    /// [`Self::viewer_exponent`] says: those of object space at the scale 1. It is consistent with [`Self::to_eye`], whose rounding down is
    /// half a unit in the last place on average.
    #[must_use]
    pub fn viewer(&self) -> [i32; 3] {
        // Cramer's rule: the columns of the adjugate matrix, Q.28, over the determinant, Q.42.
        let [a, b, c] = self.rotation;
        let columns = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant: i64 = c.iter().zip(columns[2]).map(|(&c, k)| i64::from(c) * k).sum();
        // Homogeneous, Q.15. Below 2^22 in size: all sums, and what they are shifted to, stay below 2^63.
        let from = if self.is_perspective() { self.translation.map(|c| 2 * i64::from(c) - 1) } else { [0, 0, 1 << 15] };
        let along = |k: usize| columns.iter().zip(from).map(|(column, t)| column.get(k).unwrap_or(&0) * t).sum::<i64>();
        // A rotation's determinant is not 0. Coordinates are below 2^23, so that quotients are off by less than 2^-5 before they are rounded.
        [0, 1, 2].map(|k| {
            let along = along(k) << 13;
            let size = quotient(along.unsigned_abs(), determinant.unsigned_abs()) as i32;
            if (along < 0) == (determinant < 0) { -size } else { size }
        })
    }

    /// Upper bound of the distance between the eye and a vertex of a mesh in the ball of `radius` about the origin, Q18.14; 1 under
    /// parallel rays. It includes 1/32 to spare, since a rotation is rounded.
    #[must_use]
    pub fn reach(&self, radius: u16) -> u32 {
        let [x, y, z] = self.translation.map(i32::unsigned_abs);
        let radius = ((u64::from(radius) * u64::from(self.scale) + 0xFFFF) >> 16) as u32;
        let reach = if self.is_perspective() { x + y + z + radius } else { 1 << UNIT };
        reach + (reach >> 5) + 1
    }

    /// The pixels of a viewport of `size` that the ball of `radius`, [`crate::format::Radius`], about the origin of object space can reach; none
    /// if no part of it can be seen. And how near a pixel of what is in it can be, in the format of the depth buffer. Errs on the side of more.
    #[must_use]
    pub fn reached(&self, radius: u16, size: Size) -> (Area, u16) {
        let (radius, [x, y, z]) = (self.ball(radius), self.translation);
        let (nearest, farthest) = (z.saturating_sub(radius), z.saturating_add(radius));
        if farthest < self.near || !self.is_perspective() && nearest > self.far {
            return (Area::NONE, 0);
        }
        if nearest < self.near {
            return (Area::whole(size), u16::MAX);
        }
        // Each side of the square about it is seen farthest out where it is nearest, or, across the middle of the screen, farthest.
        let [near, far] = [nearest, farthest].map(Reciprocal::of);
        let place = |c: i32, reciprocal| limited(if self.is_perspective() { self.place(c, reciprocal) } else { self.parallel_place(c) });
        let range = |c: i32| {
            let (least, most) = (c.saturating_sub(radius), c.saturating_add(radius));
            [place(least, if least < 0 { near } else { far }), place(most, if most < 0 { far } else { near })]
        };
        let ([left, right], [below, above], [x, y]) = (range(x), range(y), self.centre);
        // A pixel more, for what is rounded on the way.
        let pixels = |least: i32, most: i32, side: u32| {
            [(least >> SUBPIXEL) - 2, (most >> SUBPIXEL) + 3].map(|c| c.clamp(0, i32::from(side as u16)) as u16)
        };
        let area = Area { columns: pixels(x + left, x + right, size.width), rows: pixels(y - above, y - below, size.height) };
        let inv_depth = if self.is_perspective() { self.depth(near) } else { self.parallel_depth(nearest) };
        (area, ((inv_depth.min(NEAREST) >> (DEPTH - 16)) as u16).saturating_add(SPARE))
    }

    /// The radius of a ball in object space, [`crate::format::Radius`], in the world, Q18.14, with what is rounded on the way.
    fn ball(&self, radius: u16) -> i32 {
        let radius = ((u64::from(radius) * u64::from(self.scale)) >> 16) as i32;
        radius + (radius >> 5) + 4
    }

    /// How far rounding may move a vertex as far from the eye as `reach`, Q.30.
    ///
    /// In eye space that is half a unit in the last place along each axis, √3/2 = 0.87 in all; on the screen along both axes half of 1/16
    /// pixel, with 2^-7 to spare for the arithmetic on the way: √2 · 65/128 = 0.72 of 1/16 pixel. With room for a rotation that is rounded
    /// they are one unit and 25/32.
    #[must_use]
    pub fn displacement(&self, reach: u32) -> u64 {
        // A focal length is not 0. The quotient may be too small by less than one part of 2^27, and by what is rounded.
        let pixel = quotient((25 * u64::from(reach)) << (30 + 16 - UNIT - 5), self.focal.unsigned_abs());
        pixel.saturating_add((pixel >> 27) + 1 + (1 << (30 - UNIT))).min(u64::from(u32::MAX))
    }

    /// How far rounding may move a point of a mesh that is marked as [`crate::stream::record::CLOSED_CONVEX`] along x or y, seen in a
    /// viewport of `size` pixels behind the near plane; `times` that, 1/16 pixel, rounded up.
    #[must_use]
    pub fn moved(&self, size: Size, times: u32) -> u32 {
        let focal = (self.focal >> 16) as u32;
        let (beside, unit) = if self.is_perspective() {
            // The point moves sideways by focal / z, and for its depth by as much as it lies off the axis.
            (size.width.max(size.height) << (SUBPIXEL - 1), self.near.unsigned_abs())
        } else {
            (0, 1 << UNIT)
        };
        let within = times.wrapping_mul(MOVED).wrapping_mul(focal.wrapping_add(beside));
        // Screen coordinates are rounded to the nearest, with 2^-7 to spare for the arithmetic before.
        let rounded = times.wrapping_mul(65).div_ceil(128);
        within.checked_div(unit).map_or(u32::MAX, |within| within.saturating_add(1).saturating_add(rounded))
    }

    /// How far `eye` lies on the inner side of a clip plane (near, then the guard band's left, right, bottom, top); negative outside.
    #[must_use]
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

/// `value / 2^bits` rounded to nearest, as far as 32 bits hold it.
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
    saturated(scale(value, bits as i32))
}

/// Clamps a coordinate to the guard band.
#[cold]
#[inline(never)]
fn limited(c: i32) -> i32 {
    c.clamp(-GUARD, GUARD)
}

/// The nearest value that 32 bits hold.
#[inline(always)]
fn saturated(value: i64) -> i32 {
    value.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

/// Number of clip planes of [`View::distance`].
pub const PLANES: usize = 5;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::record::{ORTHOGRAPHIC, VIEWER_INFINITE};

    /// It stands at the origin of the world and looks along -z.
    const CAMERA: Camera = Camera {
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

    /// The eye is the point that goes to the origin, the direction towards the viewer the one that goes to -z.
    #[test]
    fn viewer_inverts_the_way_to_eye_space() {
        for number in 0..50 {
            let mut camera = Camera {
                translation: [3_000 - 977 * number, 12_345, 50_000 + 4_001 * number],
                axis: [619_925_131, 619_925_131, 619_925_131],
                period: 50,
                focal: 1 << 17,
                far: 1 << 18,
                ..CAMERA
            };
            let pose = ModelView::new(&camera, number as u32);
            let exact = |view: &View, last: f64| {
                let viewer = view.viewer().map(i64::from);
                [0, 1, 2].map(|k| {
                    let along: i64 = view.rotation[k].iter().zip(viewer).map(|(&r, v)| i64::from(r) * v).sum();
                    along as f64 / 16_384.0 + last * (f64::from(pose.translation[k]) - 0.5)
                })
            };
            let eye = exact(&View::new(&camera, &pose, Size::new(64, 64)), 1.0);
            assert!(eye.iter().all(|c| c.abs() < 1.8), "{number}: {eye:?}");
            camera.projection = ORTHOGRAPHIC;
            let [x, y, z] = exact(&View::new(&camera, &pose, Size::new(64, 64)), 0.0);
            assert!(x.abs() < 1.8 && y.abs() < 1.8 && (z + 16_384.0).abs() < 1.8, "{number}: {x} {y} {z}");
        }
    }

    /// Between vertices beyond the far plane of parallel rays, a depth that rounding makes less than theirs is still none, and not the nearest.
    #[test]
    fn depth_beyond_the_far_plane_cannot_wrap() {
        let camera = Camera { projection: ORTHOGRAPHIC, ..CAMERA };
        let view = View::new(&camera, &ModelView::new(&camera, 0), Size::new(64, 64));
        for z in [1 << 15, 1 << 16, 1 << 20] {
            let ([.., depth], _) = view.project([0, 0, z]);
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
                let camera = Camera { focal, near, far: 0, ..CAMERA };
                let view = View::new(&camera, &ModelView::new(&camera, 0), Size::new(640, 480));
                for k in 0..2_000i32 {
                    let eye = [
                        (k * 7_919) % 90_000 - 45_000,
                        (k * 104_729) % 90_000 - 45_000,
                        near + k.wrapping_mul(1_299_709).rem_euclid(200_000),
                    ];
                    let place = |c: i32| f64::from(c) / f64::from(eye[2]) * f64::from(focal) / 65_536.0 * 240.0 * 16.0;
                    let exact = [320.0 * 16.0 + place(eye[0]), 240.0 * 16.0 - place(eye[1])];
                    let ([x, y, depth], inside) = view.project(eye);
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
}
