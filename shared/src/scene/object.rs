//! One object of a scene.

use crate::{
    scene::{bounding_volume::BoundingVolume, pose::Pose},
    stream::{
        Stream,
        record::{Mesh, OWN_MATERIALS},
    },
};
use core::ops::Range;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// An object of a [`Scene`](crate::Scene): one or more meshes that move together. Several objects can share meshes.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Object {
    pub(crate) pose: Pose,
    /// Index of the object's first [`Mesh`], and one past the last.
    meshes: [u16; 2],
    /// Material of all meshes of the object, or [`OWN_MATERIALS`].
    pub(crate) material: u16,
    pub(crate) hidden: u16,
    /// Number of triangles of the object's meshes, coarser levels included.
    pub(crate) span: u32,
    /// Number of triangles of the object's meshes, without coarser levels.
    pub(crate) triangles: u32,
    pub(crate) vertices: u32,
    /// Whether the object's meshes have coarser levels.
    pub(crate) has_levels: u16,
    pub(crate) bounds: BoundingVolume,
    /// Whether the object has moved since the latest frame.
    pub(crate) has_moved: u32,
}

impl Object {
    /// Creates an object that consists of `meshes` of a stream. Returns `None` if the stream does not have them, or if the range divides a
    /// mesh from its coarser levels.
    pub(crate) fn new(stream: &Stream<'_>, meshes: Range<u16>) -> Option<Self> {
        let (first, end) = (usize::from(meshes.start), usize::from(meshes.end));
        let all = stream.meshes.get(first..end)?;
        // Coarser levels belong to their mesh.
        let starts = |index: usize| stream.meshes.get(index).is_none_or(|mesh| mesh.error == 0);
        if all.is_empty() || !starts(first) || !starts(end) {
            return None;
        }
        let (mut span, mut triangles, mut vertices) = (0u32, 0u32, 0u32);
        for mesh in all {
            span = span.saturating_add(mesh.triangles);
            if mesh.error == 0 {
                (triangles, vertices) = (triangles.saturating_add(mesh.triangles), vertices.saturating_add(mesh.vertices.into()));
            }
        }
        // Coarser levels have vertices of their meshes.
        let whole = all.iter().filter(|mesh| mesh.error == 0);
        let corners = whole.flat_map(|mesh| stream.vertices_of(mesh).unwrap_or_default()).map(|vertex| vertex.position);
        let mut bounds = BoundingVolume::around(corners);
        if all.len() == stream.meshes.len() {
            bounds.radius = stream.header.radius;
        }
        Some(Self {
            pose: Pose::IDENTITY,
            meshes: [meshes.start, meshes.end],
            material: OWN_MATERIALS,
            hidden: 0,
            span,
            triangles,
            vertices,
            bounds,
            has_levels: all.iter().any(|mesh| mesh.error > 0).into(),
            has_moved: 1,
        })
    }

    /// Returns the rotation, position and scale of the object in the world.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Returns the indices of the object's meshes in the mesh file, see [`Stream::meshes`].
    #[must_use]
    pub fn meshes(&self) -> Range<u16> {
        let [first, end] = self.meshes;
        first..end
    }

    /// Returns the index of the material that all meshes of the object have, or `None` if each mesh has its own.
    #[must_use]
    pub fn material(&self) -> Option<u16> {
        (self.material != OWN_MATERIALS).then_some(self.material)
    }

    /// Returns `true` unless the object is hidden by [`Scene::set_visible`](crate::Scene::set_visible) or by the animation in the stream
    /// (mesh file).
    #[must_use]
    pub fn is_visible(&self) -> bool {
        self.hidden == 0
    }

    /// Moves, shows or hides the object.
    pub(crate) fn place(&mut self, pose: Pose, hidden: bool) {
        self.has_moved |= u32::from((self.pose, self.hidden) != (pose, hidden.into()));
        (self.pose, self.hidden) = (pose, hidden.into());
    }

    /// Index of the material of `mesh` on this object.
    #[inline]
    pub(crate) fn material_of(&self, mesh: &Mesh) -> usize {
        usize::from(if self.material == OWN_MATERIALS { mesh.material } else { self.material })
    }
}
