//! Methods that are alike: one colour in charts.

use microphong_render::shader::Shader;

/// Families of methods, by what they walk along a span and compute at each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Family {
    /// Intensity, linear on triangles or parts of them.
    Linear,
    /// Intensity, quadratic or cubic.
    Curved,
    /// A cosine or its parts as polynomials; a table raises it.
    Cosine,
    /// Places in a map of reflections.
    Map,
    /// Angles, or the vector turned by them.
    Angle,
    /// The vector, normalised or divided by its length at each pixel.
    Vector,
    /// Any of these, for each triangle what an error budget allows.
    Budget,
}

impl Family {
    /// All families, from cheap to dear.
    pub const ALL: [Self; 7] = [Self::Linear, Self::Curved, Self::Cosine, Self::Map, Self::Angle, Self::Vector, Self::Budget];

    /// The family of a method.
    #[must_use]
    pub fn of(shader: Shader) -> Self {
        match shader.name() {
            "flat" | "gouraud" | "gouraud4" | "pseudo-phong" => Self::Linear,
            "six-point" | "six-point-centre" | "six-point-adaptive" | "cubic" => Self::Curved,
            "taylor" | "taylor-finite" | "sqrt6" | "renq" | "renq-newton" => Self::Cosine,
            "environment" | "blinn" | "quadratic-blinn" => Self::Map,
            "goldman" | "slerp" | "angular" | "angular-original" | "hybrid" | "hybrid-original" => Self::Angle,
            "auto" | "auto-linear" => Self::Budget,
            _ => Self::Vector,
        }
    }

    /// The name of the family in a legend.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Linear => "linear intensity",
            Self::Curved => "quadratic or cubic intensity",
            Self::Cosine => "polynomial cosine, then a table",
            Self::Map => "reflection map",
            Self::Angle => "angles and rotation",
            Self::Vector => "vector at each pixel",
            Self::Budget => "by an error budget",
        }
    }

    /// CSS class of the family in a drawing.
    pub(super) const fn class(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Curved => "curved",
            Self::Cosine => "cosine",
            Self::Map => "map",
            Self::Angle => "angle",
            Self::Vector => "vector",
            Self::Budget => "budget",
        }
    }
}
