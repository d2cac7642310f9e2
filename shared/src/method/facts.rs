//! Properties of shading methods.

use crate::{math::highlight_lut::Highlight, setup::steepness::Steepness};

/// The properties of a shading method, which [`Method::facts`](crate::method::Method::facts) returns. For a method of your own, begin with
/// [`Self::OWN`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// The name of the method in error messages and logs, and in the options of the command-line tool `microphong`.
    pub name: &'static str,
    /// The number of the method, by which a stream (mesh file) asks for it. No two methods of a program may have the same number. Numbers
    /// from [`Facts::FIRST_FREE`] on are free for methods of your own.
    pub id: u16,
    /// The author and the year of the publication in which the method was described; it may be empty.
    pub source: &'static str,
    /// The light that the renderer computes at each vertex, once for all triangles around it. The method reads it from
    /// [`ScreenVertex::light`](crate::method::ScreenVertex::light).
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
    /// Whether the method can draw point lights, and highlights for a local viewer (with the exact direction from each point to the eye).
    /// If not, the renderer refuses scenes that have them.
    pub near_lights: bool,
    /// Whether the method supports perspective-correct interpolation. Methods that draw whole triangles with
    /// [`Area::draw`](crate::method::Area::draw) do.
    pub perspective: bool,
}

impl Facts {
    /// The first value of [`Facts::id`] that is free for your own methods: 32,768. Smaller values are reserved for this crate.
    pub const FIRST_FREE: u16 = 0x8000;

    /// Properties that suit most methods of your own: `Facts { name: "mine", ..Facts::OWN }`. The renderer computes light levels at
    /// vertices; point lights and perspective-correct interpolation are supported. A second method of your own also needs another `id`.
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

/// The form of light that the renderer computes at each vertex for a shading method, in
/// [`ScreenVertex::light`](crate::method::ScreenVertex::light). N is the normal, L the direction to the light, and H the half vector
/// between light and viewer. Cosines are Q2.30, and light levels are Q9.7 from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexLight {
    /// No light is computed at vertices.
    None,
    /// N·L and N·H of one directional light, or of each of two on a material of several colours, if the viewer is infinitely distant. In all other
    /// scenes the four numbers are 0.
    #[doc(hidden)]
    Cosines,
    /// N·L and N·H, if there is just one light, which is directional, and the viewer is infinitely distant. In all other scenes it is like
    /// [`Self::Levels`].
    #[doc(hidden)]
    CosinesOrLevels,
    /// Like [`Self::CosinesOrLevels`], with a third number beside N·L and N·H: the light level on a material that is drawn in one channel, and the
    /// strength of the highlight (unsigned Q0.16) on one that is drawn in three.
    #[doc(hidden)]
    ReflectionOrLevels,
    /// Like [`Self::ReflectionOrLevels`] if there is just one light, which is directional, and the viewer is infinitely distant. If a light or the
    /// viewer is near, it is like [`Self::Levels`], and in all other scenes like [`Self::Cosines`].
    #[doc(hidden)]
    CosinesAndReflection,
    /// The light levels of red, green and blue, for any number and kind of lights: see [`TriangleSetup::levels`](crate::method::TriangleSetup::levels).
    Levels,
}
