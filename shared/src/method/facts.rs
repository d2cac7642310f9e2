//! Properties of shading methods.

use crate::{lighting::reflectance::Highlight, setup::steepness::Steepness};

/// Properties of a shading method. They stand in the method's own file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Name of the method on the command line and in logs.
    pub name: &'static str,
    /// Number of the method in streams. It never changes, and no two methods of a program may have the same one. Numbers from [`Facts::FIRST_FREE`]
    /// on are free for methods of your own.
    pub id: u16,
    /// Author and year of the source.
    pub source: &'static str,
    /// Light that is computed at vertices, once for all triangles around each.
    pub vertex_light: VertexLight,
    /// The quantity that is raised to the exponent of the material.
    #[doc(hidden)]
    pub highlight: Highlight,
    /// Whether the table of highlights may hold levels. It may if the method looks up nothing else in it.
    #[doc(hidden)]
    pub highlight_levels: bool,
    /// What the highlight at a pixel is computed from. This tells how exactly it has to be fitted and walked.
    #[doc(hidden)]
    pub highlight_field: HighlightField,
    /// Whether the method can draw point lights and a near viewer.
    pub near_lights: bool,
    /// Whether the method can interpolate in perspective. Such a method interpolates over whole triangles, not along rows of the screen and not over
    /// parts of a triangle that are split on the screen.
    pub perspective: bool,
    /// Numbers of operations in the method's formulas.
    #[doc(hidden)]
    pub costs: Costs,
}

impl Facts {
    /// First method number that is free for methods of your own.
    pub const FIRST_FREE: u16 = 0x8000;

    /// Facts of most methods of your own: `Facts { name: "mine", ..Facts::OWN }`. They say that light levels are computed at vertices, under any
    /// lights, with perspective. Operations are not counted.
    pub const OWN: Self = Self {
        name: "own",
        id: Self::FIRST_FREE,
        source: "",
        vertex_light: VertexLight::Levels,
        highlight: Highlight::Half,
        highlight_levels: false,
        highlight_field: HighlightField::Level,
        near_lights: true,
        perspective: true,
        costs: Costs::new(0, 0, 0, 0),
    };

    /// How steeply light depends on the interpolated fields of this method, for a material of this exponent.
    pub(crate) const fn steepness(&self, exponent: u16) -> Steepness {
        let steepness = Steepness::new(exponent as u32);
        match self.highlight_field {
            HighlightField::Level => Steepness::NONE,
            HighlightField::Plane => steepness.of_planes(),
            HighlightField::Quadratic => steepness,
            HighlightField::Root => Steepness::new(2 * exponent as u32),
        }
    }
}

/// Numbers of operations in a method's formulas, counted by hand. `microphong bench` counts instructions.
///
/// The numbers are for one white directional light, an infinitely far viewer, and one channel. Gains of the material are part of walked values or
/// tables. A look-up in an interpolated table counts as one load, one multiplication and one addition (reciprocal roots), in a fine table as one load
/// (powers). Divisions and roots count as multiplications. Setting up a linear field takes 10 operations, a lit node 30, a quadratic 45.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Costs {
    /// Additions per pixel.
    pub adds: u32,
    /// Multiplications and divisions per pixel.
    pub multiplies: u32,
    /// Table look-ups per pixel.
    pub loads: u32,
    /// Operations to set up one triangle that is not split.
    pub setup: u32,
    /// Operations to set up one row of a triangle, beyond the forward differences of its edges.
    pub row: u32,
}

impl Costs {
    /// Operations of a method that has none for each row.
    #[must_use]
    pub const fn new(adds: u32, multiplies: u32, loads: u32, setup: u32) -> Self {
        Self { adds, multiplies, loads, setup, row: 0 }
    }

    /// Adds operations for each row.
    #[must_use]
    pub const fn per_row(self, row: u32) -> Self {
        Self { row, ..self }
    }
}

/// What the highlight at a pixel is computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HighlightField {
    /// An interpolated level: no highlight is computed at the pixel.
    Level,
    /// Fields that are linear over the triangle.
    Plane,
    /// Fields that are quadratic over the triangle.
    Quadratic,
    /// A quadratic through square roots, which is squared at the pixel. The highlight depends on it twice as steeply.
    Root,
}

/// Light at a vertex, computed once for all triangles around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexLight {
    /// No light is computed at vertices.
    None,
    /// Under one constant light `[N·L, N·H]`, and under two on a material of three channels these values of both. Otherwise nothing.
    Cosines,
    /// Under one constant light `[N·L, N·H]`, otherwise levels.
    CosinesOrLevels,
    /// Under one constant light on a material of three channels `[N·L, N·H, highlight]`, otherwise levels. The highlight is unsigned Q0.16, and 0
    /// where none can be seen.
    ReflectionOrLevels,
    /// Under one constant light `[N·L, N·H, r]`, where r is the level on a material of one channel, and the highlight on one of three. Otherwise as
    /// [`Self::Cosines`].
    CosinesAndReflection,
    /// Light levels of all channels.
    Levels,
}
