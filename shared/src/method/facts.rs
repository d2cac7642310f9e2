//! What is known of a shading method, beside its name.

use crate::lighting::materials::Highlight;

/// What is known of a method; it stands in the method's own file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// The name on the command line and in logs.
    pub name: &'static str,
    /// The number by which a stream names it. It never changes, and no two methods of one program may share it; numbers from
    /// [`Facts::FIRST_FREE`] on are free for methods of your own.
    pub id: u16,
    /// Where it comes from: author and year.
    pub source: &'static str,
    /// What it wants to know of the light at vertices.
    pub vertex_light: VertexLight,
    /// What it raises to the material's exponent.
    pub highlight: Highlight,
    /// The table of highlights may hold levels: the method uses it for nothing else.
    pub highlight_levels: bool,
    /// It can shade under near lights and for a near viewer.
    pub near_lights: bool,
    /// It can interpolate in perspective: it interpolates over whole triangles, not along their rows on the screen, and does not split
    /// them there.
    pub perspective: bool,
    /// Operations of its formulas.
    pub costs: Costs,
}

impl Facts {
    /// The first number that is never given to a method of microphong.
    pub const FIRST_FREE: u16 = 0x8000;

    /// What most methods of your own say, `Facts { name: "mine", ..Facts::OWN }`: levels at vertices, any lights, perspective. Operations
    /// are not counted.
    pub const OWN: Self = Self {
        name: "own",
        id: Self::FIRST_FREE,
        source: "",
        vertex_light: VertexLight::Levels,
        highlight: Highlight::Half,
        highlight_levels: false,
        near_lights: true,
        perspective: true,
        costs: Costs::new(0, 0, 0, 0),
    };
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
    /// Of a method that does nothing per row.
    #[must_use]
    pub const fn new(adds: u32, multiplies: u32, loads: u32, setup: u32) -> Self {
        Self { adds, multiplies, loads, setup, row: 0 }
    }

    /// With so many operations per row.
    #[must_use]
    pub const fn per_row(self, row: u32) -> Self {
        Self { row, ..self }
    }
}

/// What is worked out once for all triangles that share a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexLight {
    /// Nothing.
    None,
    /// `[N·L, N·H]` under one constant light, else nothing.
    Cosines,
    /// `[N·L, N·H]` under one constant light, else levels.
    CosinesOrLevels,
    /// Levels.
    Levels,
}
