//! The contents of a model file of any format, as a reader hands them over.

use crate::{faults::Faults, mesh::Soup, mtl::Material, paint::Emission, texture::Texture};
use std::collections::BTreeSet;

/// What becomes of the colours that a file has in textures and at its vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colours {
    /// Colours are left out, and images are not read.
    None,
    /// Triangles have colours at their corners.
    #[default]
    Corners,
    /// Triangles have a texture where colours at their corners are far from it, and other triangles have these.
    Texture,
}

impl Colours {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::None, Self::Corners, Self::Texture];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Corners => "corners",
            Self::Texture => "texture",
        }
    }
}

/// The contents of a model file of any format.
#[derive(Clone, Debug, Default)]
pub struct Contents {
    /// The polygons.
    pub soup: Soup,
    /// The names of objects by which [`Submesh::object`](crate::mesh::Submesh::object) counts. A name is empty where the file gives none.
    pub objects: Vec<String>,
    /// Materials by which [`Submesh::material`](crate::mesh::Submesh::material) counts; `None` where polygons have none.
    pub materials: Vec<Option<Material>>,
    /// The textures of the materials, as far as they are known.
    pub(crate) textures: Vec<Option<Texture>>,
    /// Where materials send out their light, as far as a file says it. Elsewhere the colours of triangles multiply this light, as they do all light.
    pub(crate) emissions: Vec<Emission>,
    /// Contents that are left out, in words.
    pub ignored: BTreeSet<&'static str>,
    /// Wrong elements that are left out.
    pub faults: Faults,
    /// What else the user should know, in sentences.
    pub remarks: Vec<String>,
}
