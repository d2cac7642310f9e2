//! Where an object is in one frame: computed once, before its triangles are.

use crate::{
    arch::quotient::long,
    format::GeometricError,
    geometry::{cull::Facing, detail::tolerance, model_view::ModelView, projection::View},
    lighting::lights::Lighting,
    scene::{Object, Scene},
    stream::record::Mesh,
};
use core::ops::Range;
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
    /// Triangles of the levels that are drawn.
    pub(crate) triangles: u32,
    /// Coarser levels of its meshes may lie so far from them: [`GeometricError`].
    tolerance: u16,
    /// Whether no part of it can be seen: 0 or 1.
    is_out_of_sight: u16,
}

/// How objects are placed.
pub(crate) struct Placing {
    /// Of the viewport.
    pub(crate) size: Size,
    /// Whether coarser levels of meshes are drawn.
    pub(crate) levels_of_detail: bool,
    pub(crate) leaves_out_back_faces: bool,
}

impl Placement {
    /// Places `object` of a scene that is seen as `world` says. Returns whether other levels of it are drawn than before.
    pub(crate) fn update(&mut self, scene: &Scene<'_>, world: &ModelView, object: &Object, how: &Placing) -> bool {
        if object.hidden != 0 {
            return self.draws(0, GeometricError::ZERO);
        }
        let model_view = world.of(&object.pose);
        self.view = View::new(&scene.camera, &model_view, how.size);
        self.is_out_of_sight = (!self.view.sees(object.radius, how.size)).into();
        let has_levels = object.has_levels != 0 && how.levels_of_detail;
        let tolerance = if has_levels { self.tolerance(scene, object, how.size) } else { GeometricError::ZERO };
        if self.is_out_of_sight == 0 {
            self.facing = if how.leaves_out_back_faces { Facing::new(&self.view, object.radius) } else { Facing::ANY };
            self.lighting = Lighting::new(&scene.camera, scene.lights(), &model_view);
        }
        let triangles = if tolerance == GeometricError::ZERO {
            object.triangles
        } else {
            scene.stream.levels_within(object.meshes(), tolerance).fold(0, |sum, mesh| sum + mesh.triangles)
        };
        self.draws(triangles, tolerance)
    }

    /// The rows that `object` can reach where it was placed; none if it was not seen.
    pub(crate) fn rows(&self, object: &Object, size: Size) -> Range<u32> {
        let seen = self.triangles > 0 && self.is_out_of_sight == 0;
        let [top, bottom] = if seen { self.view.rows(object.radius, size) } else { [0; 2] };
        top.into()..bottom.into()
    }

    fn draws(&mut self, triangles: u32, tolerance: GeometricError) -> bool {
        let before = (self.triangles, self.tolerance);
        (self.triangles, self.tolerance) = (triangles, tolerance.to_bits());
        before != (self.triangles, self.tolerance)
    }

    /// How far coarser levels may lie from the meshes of `object`.
    fn tolerance(&self, scene: &Scene<'_>, object: &Object, size: Size) -> GeometricError {
        let ([.., depth], scale) = (self.view.origin(), u64::from(self.view.scale()));
        let radius = ((u64::from(object.radius) * scale + 0xFFFF) >> 16) as u32;
        let error = tolerance(&scene.camera, depth, radius, size).to_bits();
        GeometricError::from_bits(long(u64::from(error) << 16, scale).min(u16::MAX.into()) as u16)
    }

    /// Its meshes, each at the level that is drawn.
    pub(crate) fn meshes<'a>(&self, scene: &Scene<'a>, object: &Object) -> impl DoubleEndedIterator<Item = &'a Mesh> + use<'a> {
        let none = self.triangles == 0 || self.is_out_of_sight != 0;
        let meshes = if none { 0..0 } else { object.meshes() };
        scene.stream.levels_within(meshes, GeometricError::from_bits(self.tolerance))
    }
}
