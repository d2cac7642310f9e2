//! The projection of an object from its own space to the screen.

use crate::{
    arch::product::product,
    format::{DEPTH, ROTATION, SUBPIXEL, UNIT},
    geometry::{lens::Lens, model_view::ModelView, pixel_rect::PixelRect},
    math::vector::{add, dot, map, narrow_dot, sub, wide, zip},
    scene::BoundingVolume,
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// A vertex of a mesh after projection to the screen, with the light there. A shading method reads it as a corner of a triangle, see
/// [`TriangleSetup::corners`](crate::method::TriangleSetup::corners).
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct ScreenVertex {
    /// The column in units of 1/16 pixel, from the left side of the picture. Pixel centres lie at 8/16.
    pub x: i32,
    /// The row in units of 1/16 pixel, downwards from the upper side of the picture. Pixel centres lie at 8/16.
    pub y: i32,
    /// The inverse depth in Q0.28: 1 at the near plane, 0 infinitely far away (or at the far plane of an orthographic camera). In
    /// perspective it is `near / z`.
    pub depth: i32,
    /// The light at the vertex, in the form that [`Facts::vertex_light`](crate::method::Facts::vertex_light) asks for. Light levels are
    /// Q9.7, from 0 to 255; cosines such as N·L are Q2.30. See [`VertexLight`](crate::method::VertexLight).
    pub light: [i32; 4],
    /// Bookkeeping of the renderer. A shading method has no need of it.
    pub state: State,
}

impl ScreenVertex {
    /// A vertex that is not transformed.
    pub(crate) const IDLE: Self = Self { x: 0, y: 0, depth: 0, light: [0; 4], state: State::IDLE };
}

/// The state of a cached vertex in this frame.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct State(u32);

impl State {
    /// The vertex is not transformed: no triangle that faces the camera has used it.
    pub const IDLE: Self = Self(0);
    /// The position belongs to this frame, and so does the light if a drawn triangle uses the vertex.
    pub const READY: Self = Self(1);
    /// The vertex lies in front of the near plane or beyond the guard band: its triangles are clipped.
    pub const OUTSIDE: Self = Self(2);
}

/// Number of steps of the depth buffer by which rounding may make a pixel nearer than the corners of its triangle.
const SPARE: u16 = 4;

/// A step of refinement in [`View::viewer`] below this leaves less than one unit in the last place.
const LARGEST_STEP: u32 = 32;

/// Steps after one that is larger.
const MORE_STEPS: usize = 3;

/// The transformation from object space to the screen in one frame. It lies in the renderer's memory.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct View {
    /// The rotation from object to eye space times the scale, as exact as positions are. [`Self::shift`] has a power of two of the scale.
    rotation: [[i32; 3]; 3],
    /// Fraction bits of `rotation`: 14 at the scale 1, and its entries below 2^14 in size at any.
    shift: u32,
    /// Position of the origin of object space in eye space, Q18.14.
    pub(crate) origin: [i32; 3],
    /// [`crate::format::Scale`] of the object.
    pub(crate) scale: u32,
    /// The projection from eye space to the screen.
    pub lens: Lens,
}

impl View {
    /// The view of an object at the place `model_view` through `lens`.
    pub fn new(lens: &Lens, model_view: &ModelView) -> Self {
        let scale = model_view.scale.max(1);
        // The scale is a mantissa of at most 1, Q1.30, times a power of two: 2^(exponent - 16).
        let exponent = 32 - (scale - 1).leading_zeros();
        let mantissa = (scale << (ROTATION - exponent.min(ROTATION))) as i32;
        let round = |c| ((product(c, mantissa) >> ROTATION) as i32 + (1 << (ROTATION - UNIT - 1))) >> (ROTATION - UNIT);
        Self {
            lens: *lens,
            rotation: map(model_view.rotation, |row| map(row, round)),
            shift: UNIT + 16 - exponent,
            origin: model_view.translation,
            scale,
        }
    }

    /// Converts a position to eye space, Q18.14.
    #[inline]
    pub fn to_eye(&self, position: [i16; 3]) -> [i32; 3] {
        let [x, y, z] = self.rotation;
        let along = |row| narrow_dot(row, wide(position)) >> (self.shift & 31);
        add([along(x), along(y), along(z)], self.origin)
    }

    /// How many bits the units of [`Self::viewer`] are smaller than those of object space; negative if they are larger.
    pub fn viewer_exponent(&self) -> i32 {
        UNIT as i32 - self.shift as i32
    }

    /// The eye in object space, Q18.14, or the direction towards the viewer under parallel rays, Q2.14, both in units that are as large as
    /// [`Self::viewer_exponent`] says: those of object space at the scale 1. It is consistent with [`Self::to_eye`], whose rounding down is
    /// half a unit in the last place on average, and with this `model_view`, of which the view is.
    ///
    /// Error: less than one and a half units in the last place along each axis of the eye (tests::viewer_inverts_the_way_to_eye_space).
    /// Source: refinement (Wilkinson 1963) of the way back by the transpose, which is the inverse of an exact rotation.
    pub fn viewer(&self, model_view: &ModelView) -> [i32; 3] {
        // Q.14, below 2^21 in size.
        let from = if self.lens.is_perspective() { self.origin } else { [0, 0, 1 << UNIT] };
        // Q.29, less half of its last place.
        let from_finely = |c: i32| if self.lens.is_perspective() { (2 * i64::from(c) - 1) << UNIT } else { i64::from(c) << (UNIT + 1) };
        let back = |v| map(model_view.to_object(v), |c| (product(c, model_view.inverse_scale as i32) >> ((self.shift + 2) & 63)) as i32);
        // What is left of the way there and back, Q.29, below 2^30 in size: the rotation has 2^-14 as its last place, as `viewer` has.
        let rest = |viewer| zip(self.rotation, from, |row, c| (2 * dot(row, viewer) + from_finely(c)) as i32);
        let step = |viewer| map(back(rest(viewer)), |c| (c + (1 << UNIT)) >> (UNIT + 1));
        let first = map(back(from), |c| -c);
        let second = step(first);
        let viewer = sub(first, second);
        // What is too much becomes less by a factor of 2^-12, as the rounded rotation and the inverse of the scale are so exact; of 2^-5 where
        // a camera's rows are as far from unit vectors as a stream may have them.
        if map(second, i32::unsigned_abs).iter().all(|&c| c < LARGEST_STEP) {
            return viewer;
        }
        (0..MORE_STEPS).fold(viewer, |viewer, _| sub(viewer, step(viewer)))
    }

    /// Upper bound of the distance between the eye and a vertex of a mesh in the ball of `radius` about the origin, Q18.14; 1 under
    /// parallel rays. It includes 1/32 to spare, since a rotation is rounded.
    pub fn reach(&self, radius: u16) -> u32 {
        let [x, y, z] = map(self.origin, i32::unsigned_abs);
        let radius = ((u64::from(radius) * u64::from(self.scale) + 0xFFFF) >> 16) as u32;
        let reach = if self.lens.is_perspective() { x + y + z + radius } else { 1 << UNIT };
        reach + (reach >> 5) + 1
    }

    /// The pixels of the viewport that a part of object space can reach, and the nearest depth of such a pixel, in the format of the depth buffer.
    /// None if no part of it can be seen. If in doubt, there are more pixels and nearer depths.
    pub(crate) fn reached(&self, bounds: &BoundingVolume) -> (PixelRect, u16) {
        let sides = self.sides(bounds);
        let (size, [.., [nearest, farthest]]) = (self.lens.size(), sides);
        if farthest < self.lens.near || !self.lens.is_perspective() && nearest > self.lens.far {
            return (PixelRect::NONE, 0);
        }
        if nearest < self.lens.near {
            return (PixelRect::whole(size), u16::MAX);
        }
        let ([columns, rows], inv_depth) = self.lens.project_box(sides);
        // A pixel more, for what is rounded on the way.
        let within = |c: i32, side: u32| c.clamp(0, i32::from(side as u16)) as u16;
        let pixels = |[least, most]: [i32; 2], side| [within((least >> SUBPIXEL) - 2, side), within((most >> SUBPIXEL) + 3, side)];
        let area = PixelRect { columns: pixels(columns, size.width), rows: pixels(rows, size.height) };
        (area, ((inv_depth >> (DEPTH - 16)) as u16).saturating_add(SPARE))
    }

    /// The smallest and the largest coordinate along each axis of eye space, Q18.14, of a vertex within these bounds.
    fn sides(&self, bounds: &BoundingVolume) -> [[i32; 2]; 3] {
        // Half of the box along each axis, and no farther from the origin than the ball. Both products are rounded down, hence 2.
        let (half, ball) = (map(bounds.half, i32::from), self.ball(bounds.radius));
        let half = map(self.rotation, |row| (narrow_dot(map(row, i32::abs), half) >> (self.shift & 31)) + 2);
        let sides = zip(self.to_eye(bounds.middle), half, |middle, half| [middle - half, middle + half]);
        zip(sides, self.origin, |[least, most], origin| [least.max(origin - ball), most.min(origin + ball)])
    }

    /// Converts the radius of a ball in object space, a [`crate::format::Radius`], to eye space, Q18.14, with a margin for rounding.
    ///
    /// 1/64 is spared: squared lengths of a camera's rows are right to 1/256, so that they are 1/512 too long at most; half a turn about an axis
    /// that is too long by as much adds 2/256; and the nine entries, each rounded by half of 2^-14, add less than 2^-12.
    fn ball(&self, radius: u16) -> i32 {
        let radius = ((u64::from(radius) * u64::from(self.scale)) >> 16) as i32;
        radius + (radius >> 6) + 4
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        format::{Angle, Length, Scale},
        geometry::lens::tests::CAMERA,
        scene::Pose,
        stream::record::{Camera, ORTHOGRAPHIC, PERSPECTIVE},
    };
    use embedded_graphics_core::geometry::Size;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 3_000, failure_persistence: None, ..ProptestConfig::default() })]

        /// Vertices lie within the sides of their object in eye space, are seen within the pixels that it can reach, and are no nearer than it can
        /// be.
        #[test]
        fn bounds_reach_as_far_as_vertices(
            vertices in prop::collection::vec(prop::array::uniform3(any::<i16>()), 1..6),
            (bits, is_perspective, is_stretched) in (0u32..13, any::<bool>(), any::<bool>()),
            angles in prop::array::uniform3(any::<u32>()),
            (at, reach) in (prop::array::uniform3(-1.0f64..1.0), 0.1f64..16.0),
            (scale, number) in (1u32 << 12..=1 << 19, 0u32..60),
        ) {
            let vertices = vertices.iter().map(|vertex| vertex.map(|c| c >> bits));
            let projection = if is_perspective { PERSPECTIVE } else { ORTHOGRAPHIC };
            let camera = Camera { projection, focal: 1 << 17, near: 1 << 13, far: 1 << 17, translation: [0, 0, 70_000], ..CAMERA };
            let camera = if is_stretched { stretched(camera) } else { camera };
            let [yaw, pitch, roll] = angles.map(Angle::from_bits);
            let pose = Pose::from_euler(yaw, pitch, roll).at(at.map(|c| Length::from_num(c * reach))).unwrap();
            let (size, model_view) = (Size::new(200, 160), ModelView::new(&camera, number).of(&pose.scaled(Scale::from_bits(scale)).unwrap()));
            let view = View::new(&Lens::new(&camera, size), &model_view);
            let bounds = BoundingVolume::around(vertices.clone());
            let (sides, (area, nearest)) = (view.sides(&bounds), view.reached(&bounds));
            for vertex in vertices {
                let eye = view.to_eye(vertex);
                let is_within = eye.iter().zip(sides).all(|(&c, [least, most])| (least..=most).contains(&c));
                prop_assert!(is_within, "{eye:?} {sides:?}");
                let ([x, y, depth], is_inside) = view.lens.project(eye);
                let (column, row) = (x >> SUBPIXEL, y >> SUBPIXEL);
                let is_seen = is_inside && (0..200).contains(&column) && (0..160).contains(&row) && (is_perspective || eye[2] <= camera.far);
                if is_seen {
                    prop_assert!(area.columns().contains(&(column as u32)) && area.rows().contains(&(row as u32)), "{area:?} {column} {row}");
                    prop_assert!((depth >> (DEPTH - 16)) as u16 <= nearest, "{depth} {nearest}");
                }
            }
        }
    }

    /// Thirds as components of vectors that are longer than unit vectors by as much as a stream may have them.
    fn longer(thirds: [i32; 3]) -> [i32; 3] {
        thirds.map(|c| (f64::from(c) / 3.0 * f64::from(1 << ROTATION) * 1.001_95) as i32)
    }

    /// A camera with such rows, which turns about such an axis.
    fn stretched(camera: Camera) -> Camera {
        Camera { rotation: [[2, -2, 1], [1, 2, 2], [2, 1, -2]].map(longer), axis: longer([2, 1, 2]), period: 60, ..camera }
    }

    /// The eye is the point that goes to the origin, the direction towards the viewer the one that goes to -z.
    #[test]
    fn viewer_inverts_the_way_to_eye_space() {
        let scales = [1 << 16, 1 << 12, 1 << 19, (1 << 16) + 1, (1 << 16) - 1, (1 << 18) + 12_345, (1 << 19) - 1, 54_321, 5_000];
        for (number, scale) in (0..50).flat_map(|number| scales.map(|scale| (number, scale))) {
            let camera = Camera {
                translation: [3_000 - 977 * number, 12_345, 50_000 + 4_001 * number],
                axis: [619_925_131, 619_925_131, 619_925_131],
                period: 50,
                focal: 1 << 17,
                far: 1 << 18,
                ..CAMERA
            };
            let pose = Pose::from_euler(Angle::from_num(f64::from(number) * 0.019), Angle::from_num(0.7), Angle::from_num(0.2));
            let pose = pose.at([0.5, -1.0, 0.25].map(Length::from_num)).unwrap().scaled(Scale::from_bits(scale)).unwrap();
            for camera in [camera, stretched(camera)] {
                assert_eq!(camera.fault(), None);
                let model_view = ModelView::new(&camera, number as u32).of(&pose);
                let off = |camera: &Camera, last: [f64; 3]| {
                    let view = View::new(&Lens::new(camera, Size::new(64, 64)), &model_view);
                    let viewer = view.viewer(&model_view).map(i64::from);
                    let along = view.rotation.map(|row| row.iter().zip(viewer).map(|(&r, v)| i64::from(r) * v).sum::<i64>());
                    zip(along, last, |along, last| along as f64 / 16_384.0 + last)
                };
                let eye = off(&camera, model_view.translation.map(|c| f64::from(c) - 0.5));
                assert!(eye.iter().all(|c| c.abs() < 1.5), "{number} {scale}: {eye:?}");
                let towards = off(&Camera { projection: ORTHOGRAPHIC, ..camera }, [0.0, 0.0, 16_384.0]);
                assert!(towards.iter().all(|c| c.abs() < 1.5), "{number} {scale}: {towards:?}");
            }
        }
    }
}
