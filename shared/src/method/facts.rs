//! The facts about a shading method.

use crate::{lighting::reflectance::Highlight, setup::steepness::Steepness};

/// The facts about a method, which stand in its own file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// The name on the command line and in logs.
    pub name: &'static str,
    /// The number by which a stream names the method. It never changes, and no two methods of one program may share it; numbers from
    /// [`Facts::FIRST_FREE`] on are free for methods of your own.
    pub id: u16,
    /// Author and year of the source.
    pub source: &'static str,
    /// The light that the method needs at vertices.
    pub vertex_light: VertexLight,
    /// The quantity that is raised to the exponent of the material.
    pub highlight: Highlight,
    /// Whether the table of highlights may hold levels, because the method looks up nothing else in it.
    pub highlight_levels: bool,
    /// What the highlight at a pixel is computed of, which says how exactly that has to be fitted and walked.
    pub highlight_field: HighlightField,
    /// Whether the method can shade under near lights and for a near viewer.
    pub near_lights: bool,
    /// Whether the method can interpolate in perspective: it then interpolates over whole triangles, and neither along rows of the screen
    /// nor over parts that are split there.
    pub perspective: bool,
    /// Operations of the method's formulas.
    pub costs: Costs,
}

impl Facts {
    /// The first number that is never given to a method of microphong.
    pub const FIRST_FREE: u16 = 0x8000;

    /// Facts of most methods of your own, `Facts { name: "mine", ..Facts::OWN }`: levels at vertices, any lights, perspective; operations
    /// are not counted.
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

    /// How steeply light follows the fields of this method under this exponent.
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

/// Operations of a method's formulas, counted by hand; `microphong bench` counts instructions.
///
/// One white directional light and an infinitely far viewer, one channel. Material gains are folded into what is walked or looked up. A
/// table that is interpolated counts as one load, one multiplication and one addition if its index spreads (reciprocal roots), as a load
/// alone if its entries are that fine (powers). Divisions and roots count as multiplications. In set-up a linear field takes 10
/// operations, a lit node 30, a quadratic 45.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Costs {
    /// Additions per pixel.
    pub adds: u32,
    /// Multiplications and divisions per pixel.
    pub multiplies: u32,
    /// Table look-ups per pixel.
    pub loads: u32,
    /// Operations to set up one triangle; where it depends on the triangle, one that is not split further.
    pub setup: u32,
    /// Operations to set up one row of a triangle, beyond the forward differences of its edges.
    pub row: u32,
}

impl Costs {
    /// Operations of a method without work per row.
    #[must_use]
    pub const fn new(adds: u32, multiplies: u32, loads: u32, setup: u32) -> Self {
        Self { adds, multiplies, loads, setup, row: 0 }
    }

    /// Adds operations per row.
    #[must_use]
    pub const fn per_row(self, row: u32) -> Self {
        Self { row, ..self }
    }
}

/// What the highlight at a pixel is computed of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HighlightField {
    /// Nothing: the pixel takes a level that is interpolated.
    Level,
    /// Planes.
    Plane,
    /// Quadratics.
    Quadratic,
    /// A quadratic through roots, which is squared first: the highlight follows it twice as steeply.
    Root,
}

/// The light at a vertex that is computed once for all triangles around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexLight {
    /// Nothing.
    None,
    /// `[N·L, N·H]` under one constant light, those of both under two on a material of three channels, else nothing.
    Cosines,
    /// `[N·L, N·H]` under one constant light, else levels.
    CosinesOrLevels,
    /// `[N·L, N·H, highlight]` under one constant light on a material of three channels, else levels. The highlight is unsigned Q0.16, and 0 where
    /// none can be seen.
    ReflectionOrLevels,
    /// `[N·L, N·H, r]` under one constant light, where r is the level of a material of one channel, and the highlight on one of three; else
    /// as [`Self::Cosines`].
    CosinesAndReflection,
    /// Levels.
    Levels,
}
