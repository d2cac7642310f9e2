//! Where an object is in one frame: computed once, before its triangles are.

use crate::{
    format::GeometricError,
    geometry::{area::Area, cull::Facing, detail::tolerance, model_view::ModelView, projection::View},
    lighting::lights::{Directions, Lighting},
    scene::{Object, Scene},
    stream::record::Mesh,
};
use embedded_graphics_core::geometry::Size;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// An object in one frame, in memory of the renderer.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Debug)]
#[repr(C)]
pub(crate) struct Placement {
    pub(crate) view: View,
    pub(crate) facing: Facing,
    pub(crate) lighting: Lighting,
    /// Triangles of a frame are numbered throughout, those of coarser levels as well: this many belong to objects before.
    pub(crate) first_triangle: u32,
    /// This many vertices belong to objects before.
    pub(crate) first_vertex: u32,
    /// Triangles of the levels at which it is drawn where it can be seen.
    triangles: u32,
    /// The pixels that it can reach; none where it is out of sight.
    pub(crate) area: Area,
    /// Coarser levels of its meshes may lie so far from them: [`GeometricError`].
    tolerance: u16,
    /// For alignment.
    reserved: [u16; 3],
    /// Triangles of it that the frame has, at the levels that are drawn.
    pub(crate) drawn: u32,
}

/// How objects are placed.
pub(crate) struct Placing {
    /// Of the viewport.
    pub(crate) size: Size,
    /// Whether coarser levels of meshes are drawn.
    pub(crate) levels_of_detail: bool,
    pub(crate) leaves_out_back_faces: bool,
    /// The world as it is seen.
    pub(crate) world: ModelView,
    /// Of the lights in the world.
    pub(crate) directions: Directions,
}

impl Placement {
    /// Places `object` of a scene.
    pub(crate) fn update(&mut self, scene: &Scene<'_>, object: &Object, how: &Placing) {
        (self.area, self.triangles) = (Area::NONE, 0);
        if !object.is_visible() {
            return;
        }
        let model_view = how.world.of(&object.pose);
        self.view = View::new(&scene.camera, &model_view, how.size);
        self.area = self.view.area(object.radius, how.size);
        if self.area.is_empty() {
            return;
        }
        self.facing = if how.leaves_out_back_faces { Facing::new(&self.view, object.radius) } else { Facing::ANY };
        self.lighting.place(&scene.camera, scene.lights(), &how.directions, &model_view);
        let has_levels = object.has_levels != 0 && how.levels_of_detail;
        let tolerance = if has_levels { self.tolerance(scene, object, how.size) } else { GeometricError::ZERO };
        self.tolerance = tolerance.to_bits();
        self.triangles = if tolerance == GeometricError::ZERO {
            object.triangles
        } else {
            scene.stream.levels_within(object.meshes(), tolerance).fold(0, |sum, mesh| sum + mesh.triangles)
        };
    }

    /// The frame has it if it reaches into `area`. Returns whether more or fewer triangles of it are drawn than before.
    pub(crate) fn draw_within(&mut self, area: &Area) -> bool {
        let before = self.drawn;
        self.drawn = if self.area.meets(area) { self.triangles } else { 0 };
        before != self.drawn
    }

    /// How far coarser levels may lie from the meshes of `object`.
    fn tolerance(&self, scene: &Scene<'_>, object: &Object, size: Size) -> GeometricError {
        let ([.., depth], scale) = (self.view.origin(), u64::from(self.view.scale()));
        let radius = ((u64::from(object.radius) * scale + 0xFFFF) >> 16) as u32;
        let error = tolerance(&scene.camera, depth, radius, size).to_bits();
        GeometricError::from_bits(self.view.least_in_object_units(error.into()).min(u16::MAX.into()) as u16)
    }

    /// Its meshes, each at the level that is drawn.
    pub(crate) fn meshes<'a>(&self, scene: &Scene<'a>, object: &Object) -> impl DoubleEndedIterator<Item = &'a Mesh> + use<'a> {
        let meshes = if self.drawn == 0 { 0..0 } else { object.meshes() };
        scene.stream.levels_within(meshes, GeometricError::from_bits(self.tolerance))
    }
}
