//! The place of an object in one frame, computed once before its triangles are drawn.

use crate::{
    features::{OBJECTS, TRANSPARENCY},
    format::GeometricError,
    geometry::{
        cull::Facing, detail::tolerance, lens::Lens, model_view::ModelView, pixel_rect::PixelRect, projection::View, region::Region,
    },
    lighting::lights::{Directions, Lighting},
    scene::{Object, Scene},
    stream::record::Mesh,
};
use core::cell::Cell;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// One past the largest number of a triangle in a frame.
const NUMBERS: u32 = 1 << 31;
/// Numbers of transparent triangles are not smaller, numbers of all others are.
const FIRST_TRANSPARENT: u32 = NUMBERS / 2;

/// An object in one frame. It lies in the renderer's memory.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Debug)]
#[repr(C)]
pub(crate) struct Placement {
    pub(crate) view: View,
    pub(crate) facing: Facing,
    pub(crate) lighting: Lighting,
    /// Number of triangles of objects before this one, coarser levels included. See [`Self::first_number`].
    pub(crate) first_triangle: u32,
    /// Number of vertices of objects before this one.
    pub(crate) first_vertex: u32,
    /// Number of triangles at the levels at which the object is drawn if it can be seen.
    triangles: u32,
    /// The pixels that the object can reach; none if it is out of sight.
    pub(crate) area: PixelRect,
    /// Largest distance of coarser levels from their meshes, a [`GeometricError`].
    tolerance: u16,
    /// The smallest depth that a pixel of the object can have, in the format of the depth buffer.
    pub(crate) nearest: u16,
    /// The depth of the object's origin, which decides the order of drawing. Objects out of sight come last.
    depth: i32,
    /// Number of triangles of the object that the frame draws, at the levels that are drawn.
    pub(crate) drawn: u32,
}

/// Settings and camera by which objects are placed.
pub(crate) struct Placing {
    /// Projection of the camera onto the viewport.
    pub(crate) lens: Lens,
    /// Whether coarser levels of meshes are drawn.
    pub(crate) levels_of_detail: bool,
    pub(crate) leaves_out_back_faces: bool,
    /// The transformation of the world to eye space.
    pub(crate) world: ModelView,
    /// Directions of the lights in the world.
    pub(crate) directions: Directions,
}

impl Placement {
    /// Places `object` of a scene.
    pub(crate) fn update(&mut self, scene: &Scene<'_>, object: &Object, how: &Placing) {
        (self.area, self.triangles, self.depth) = (PixelRect::NONE, 0, i32::MAX);
        if !object.is_visible() {
            return;
        }
        let model_view = how.world.of(&object.pose);
        self.view = View::new(&how.lens, &model_view);
        (self.area, self.nearest) = self.view.reached(&object.bounds);
        if self.area.is_empty() {
            return;
        }
        [.., self.depth] = self.view.origin;
        self.facing = if how.leaves_out_back_faces { Facing::new(&self.view, &model_view, object.bounds.radius) } else { Facing::ANY };
        self.lighting.place(&scene.camera, scene.lights(), &how.directions, &model_view);
        let has_levels = object.has_levels != 0 && how.levels_of_detail;
        let tolerance = if has_levels { self.tolerance(scene, object, &model_view) } else { GeometricError::ZERO };
        self.tolerance = tolerance.to_bits();
        self.triangles = if tolerance == GeometricError::ZERO {
            object.triangles
        } else {
            scene.stream.levels_within(object.meshes(), tolerance).fold(0, |sum, mesh| sum + mesh.triangles)
        };
    }

    /// The number in the frame of the first triangle of `object`, coarser levels included. Triangles are drawn in the order of their numbers. Objects are
    /// numbered from the nearest to the farthest. Transparent triangles have other numbers: they come after all others, the farthest object first.
    #[inline]
    pub(crate) fn first_number(&self, object: &Object, is_transparent: bool) -> u32 {
        if is_transparent { NUMBERS - self.first_triangle - object.span } else { self.first_triangle }
    }

    /// Draws the object in the frame if the pixels that it changes, in the rectangle `touched`, reach into `region`. Returns whether the number of
    /// its triangles changes.
    pub(crate) fn draw_within(&mut self, region: &Region, touched: &PixelRect) -> bool {
        let before = self.drawn;
        self.drawn = if region.within(touched).is_empty() { 0 } else { self.triangles };
        before != self.drawn
    }

    /// Largest distance of coarser levels from the meshes of `object`.
    fn tolerance(&self, scene: &Scene<'_>, object: &Object, model_view: &ModelView) -> GeometricError {
        let ([.., depth], scale) = (self.view.origin, u64::from(self.view.scale));
        let radius = ((u64::from(object.bounds.radius) * scale + 0xFFFF) >> 16) as u32;
        let error = tolerance(&scene.camera, depth, radius, self.view.lens.size()).to_bits();
        GeometricError::from_bits(model_view.in_object_units(error.into()).min(u16::MAX.into()) as u16)
    }

    /// The object's meshes, each at the level that is drawn.
    pub(crate) fn meshes<'a>(&self, scene: &Scene<'a>, object: &Object) -> impl DoubleEndedIterator<Item = &'a Mesh> + use<'a> {
        let meshes = if self.drawn == 0 { 0..0 } else { object.meshes() };
        scene.stream.levels_within(meshes, GeometricError::from_bits(self.tolerance))
    }
}

/// Places of the objects of a scene in one frame, and the order in which they are drawn. The nearest is first, so that it hides later ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placements<'r> {
    /// Places in the order of the scene.
    placements: &'r [Placement],
    /// Indices of the places in the order of drawing.
    order: &'r [u32],
}

impl<'r> Placements<'r> {
    /// Places of the objects of `scene`. The memory may have room for more objects.
    pub(crate) fn new(scene: &Scene<'_>, placements: &'r [Placement], order: &'r [u32]) -> Self {
        let count = scene.objects().len();
        Self { placements: placements.get(..count).unwrap_or_default(), order: order.get(..count).unwrap_or_default() }
    }

    /// Sorts indices by the depth of their objects. Equally near objects stay in the order of the scene. Returns whether the order has changed.
    pub(crate) fn sort(placements: &[Placement], order: &mut [u32]) -> bool {
        if !OBJECTS {
            return false;
        }
        let key = |index: &Cell<u32>| {
            let index = index.get();
            (placements.get(index as usize).map_or(i32::MAX, |placement| placement.depth), index)
        };
        let (order, mut has_changed) = (Cell::from_mut(order).as_slice_of_cells(), false);
        // Few change places from one frame to the next.
        for (end, next) in order.iter().enumerate() {
            let moved = key(next);
            for pair in order.get(..=end).unwrap_or_default().windows(2).rev() {
                let [before, last] = pair else { break };
                if key(before) <= moved {
                    break;
                }
                before.swap(last);
                has_changed = true;
            }
        }
        has_changed
    }

    /// The objects in the order of drawing.
    pub(crate) fn objects(self, scene: &'r Scene<'_>) -> impl DoubleEndedIterator<Item = (&'r Placement, &'r Object)> {
        self.order.iter().filter_map(move |&index| self.object(scene, index))
    }

    /// The object that has the triangle of the frame with this number, and the first such number of the object.
    pub(crate) fn with_triangle(self, scene: &'r Scene<'_>, number: u32) -> Option<(&'r Placement, &'r Object, u32)> {
        let is_transparent = TRANSPARENCY && number >= FIRST_TRANSPARENT;
        let index = if OBJECTS {
            // Objects follow one another without a gap: it is the last one that does not start behind the triangle.
            let place = if is_transparent { !number & (NUMBERS - 1) } else { number };
            let starts = |&index: &u32| self.placements.get(index as usize).is_some_and(|placement| placement.first_triangle <= place);
            *self.order.get(self.order.partition_point(starts).wrapping_sub(1))?
        } else {
            0
        };
        let (placement, object) = self.object(scene, index)?;
        Some((placement, object, placement.first_number(object, is_transparent)))
    }

    /// The object with this index in the scene.
    pub(crate) fn object(self, scene: &'r Scene<'_>, index: u32) -> Option<(&'r Placement, &'r Object)> {
        Some((self.placements.get(index as usize)?, scene.objects().get(index as usize)?))
    }

    /// Number of triangles at the levels that are drawn.
    pub(crate) fn drawn(self) -> u32 {
        self.placements.iter().fold(0, |sum, placement| sum + placement.drawn)
    }
}
