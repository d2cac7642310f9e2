//! The names of the shading methods; what they do is in [`crate::shade`].

use crate::math::power::Base;

/// A shading method, chosen at run time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Shader {
    /// One colour per triangle.
    Flat,
    /// Lit at the corners, linear in between.
    Gouraud,
    /// Lit at corners and edge midpoints, quadratic in between.
    #[default]
    SixPoint,
    /// Normals interpolated and normalised at every pixel, highlight by the half vector.
    Phong,
    /// As [`Self::Phong`], highlight by the reflected light.
    PhongRv,
    /// Gouraud shading of the four triangles between corners and midpoints.
    Gouraud4,
    /// Gouraud shading of triangles a few pixels large.
    PseudoPhong,
    /// Gouraud shading where no highlight meets the triangle, Phong shading where one does.
    HighlightTest,
    /// Squared length by forward differences, its root by Newton's iteration from pixel to pixel.
    Goldman,
    /// Normals turned at constant speed along edges and spans.
    Slerp,
    /// Linear numerators, quadratic squared length, its reciprocal root from a table.
    Duff,
    /// Taylor quadratics about the centroid, for constant lights.
    Taylor,
    /// Taylor quadratics about the centroid, for near lights and viewers.
    TaylorFinite,
    /// As [`Self::SixPoint`], triangles split without cracks until the quadratic fits.
    SixPointAdaptive,
    /// As [`Self::SixPoint`], triangles split where the quadratic misses their centre.
    SixPointCentre,
    /// Lit at ten points, cubic in between.
    Cubic,
    /// Highlights in three parabolas a span, normals turned along the edges.
    Angular,
    /// [`Self::Angular`] with the constants as printed.
    AngularOriginal,
    /// Highlights in three parabolas a span, normals linear along the edges.
    Hybrid,
    /// [`Self::Hybrid`] with the constants as printed.
    HybridOriginal,
    /// Highlights from a sphere map, coordinates linear.
    Environment,
    /// Highlights from a map around the half vector, coordinates linear.
    Blinn,
    /// [`Self::Blinn`] with quadratic coordinates.
    QuadraticBlinn,
    /// The root of N·H quadratic, squared and raised at the pixel.
    Sqrt6,
    /// Linear numerators times a quadratic reciprocal length.
    Renq,
    /// [`Self::Renq`] with as many Newton steps as the triangle needs.
    RenqNewton,
}

impl Shader {
    /// Every method; the index is what a stream stores.
    pub const ALL: [Self; 26] = [
        Self::Flat,
        Self::Gouraud,
        Self::SixPoint,
        Self::Phong,
        Self::PhongRv,
        Self::Gouraud4,
        Self::PseudoPhong,
        Self::HighlightTest,
        Self::Goldman,
        Self::Slerp,
        Self::Duff,
        Self::Taylor,
        Self::TaylorFinite,
        Self::SixPointAdaptive,
        Self::SixPointCentre,
        Self::Cubic,
        Self::Angular,
        Self::AngularOriginal,
        Self::Hybrid,
        Self::HybridOriginal,
        Self::Environment,
        Self::Blinn,
        Self::QuadraticBlinn,
        Self::Sqrt6,
        Self::Renq,
        Self::RenqNewton,
    ];

    /// The methods that every build has; the others come with the feature `all-shaders`.
    pub const BASIC: [Self; 4] = [Self::Flat, Self::Gouraud, Self::SixPoint, Self::Phong];

    /// The name on the command line and in logs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Gouraud => "gouraud",
            Self::SixPoint => "six-point",
            Self::Phong => "phong",
            Self::PhongRv => "phong-rv",
            Self::Gouraud4 => "gouraud4",
            Self::PseudoPhong => "pseudo-phong",
            Self::HighlightTest => "highlight-test",
            Self::Goldman => "goldman",
            Self::Slerp => "slerp",
            Self::Duff => "duff",
            Self::Taylor => "taylor",
            Self::TaylorFinite => "taylor-finite",
            Self::SixPointAdaptive => "six-point-adaptive",
            Self::SixPointCentre => "six-point-centre",
            Self::Cubic => "cubic",
            Self::Angular => "angular",
            Self::AngularOriginal => "angular-original",
            Self::Hybrid => "hybrid",
            Self::HybridOriginal => "hybrid-original",
            Self::Environment => "environment",
            Self::Blinn => "blinn",
            Self::QuadraticBlinn => "quadratic-blinn",
            Self::Sqrt6 => "sqrt6",
            Self::Renq => "renq",
            Self::RenqNewton => "renq-newton",
        }
    }

    /// Whether this build has the method.
    #[must_use]
    pub const fn is_built_in(self) -> bool {
        cfg!(feature = "all-shaders") || matches!(self, Self::Flat | Self::Gouraud | Self::SixPoint | Self::Phong)
    }

    /// Whether it works with directional lights and an infinitely far viewer only.
    #[must_use]
    pub const fn needs_constant_light(self) -> bool {
        matches!(self, Self::Goldman | Self::Slerp | Self::Taylor)
    }

    /// Whether it has a perspective-correct form: it interpolates over whole triangles, not along their rows on the screen,
    /// and does not split them there.
    #[must_use]
    pub const fn has_perspective(self) -> bool {
        !matches!(
            self,
            Self::Gouraud4
                | Self::PseudoPhong
                | Self::SixPointAdaptive
                | Self::SixPointCentre
                | Self::Goldman
                | Self::Slerp
                | Self::Angular
                | Self::AngularOriginal
                | Self::Hybrid
                | Self::HybridOriginal
        )
    }

    /// What it raises to the exponent for a highlight.
    #[must_use]
    pub const fn highlight(self) -> Highlight {
        match self {
            Self::PhongRv | Self::Goldman | Self::Environment => Highlight::Reflected,
            Self::Blinn | Self::QuadraticBlinn => Highlight::HalfSquared,
            Self::Sqrt6 => Highlight::Root,
            _ => Highlight::Half,
        }
    }

    /// Whether the highlight's table may hold levels: it shades in no other way than by that table.
    #[must_use]
    pub const fn walks_levels(self) -> bool {
        matches!(self, Self::Phong | Self::HighlightTest | Self::Duff | Self::Sqrt6 | Self::Renq | Self::RenqNewton)
    }

    /// What it wants to know of the light at vertices; under one `constant` light cosines are enough for some.
    #[must_use]
    pub(crate) const fn vertex_light(self, constant: bool) -> VertexLight {
        match self {
            Self::Flat | Self::PhongRv | Self::Goldman | Self::Slerp | Self::Taylor | Self::TaylorFinite => VertexLight::None,
            Self::Angular | Self::AngularOriginal | Self::Environment | Self::Blinn | Self::QuadraticBlinn => VertexLight::None,
            // The levels that they draw are worked out at the pixel.
            Self::Phong | Self::Duff | Self::Sqrt6 | Self::Renq | Self::RenqNewton | Self::Hybrid | Self::HybridOriginal if !constant => {
                VertexLight::None
            }
            Self::Phong | Self::Duff | Self::Sqrt6 | Self::Renq | Self::RenqNewton | Self::Hybrid | Self::HybridOriginal => {
                VertexLight::Cosines
            }
            // Cosines at midpoints follow from those at vertices.
            Self::SixPoint | Self::HighlightTest if constant => VertexLight::Cosines,
            _ => VertexLight::Levels,
        }
    }
}

/// What is worked out once for all triangles that share a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum VertexLight {
    /// Nothing.
    None,
    /// `[N·L, N·H]` of the one constant light.
    Cosines,
    /// Levels.
    Levels,
}

/// What is raised to the exponent `n` of a material, such that highlights have the same width by all methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Highlight {
    /// (N·H)^n (Blinn 1977).
    #[default]
    Half,
    /// ((N·H)²)^(n/2).
    HalfSquared,
    /// (z²)^n of z = sqrt(N·H).
    Root,
    /// (R·V)^(n/4): with L, N and V in a plane the angle of R and V is twice that of N and H (Phong 1975).
    Reflected,
}

impl Highlight {
    /// What of it is raised to the material's exponent.
    #[must_use]
    pub const fn base(self) -> Base {
        match self {
            Self::Half => Base::Itself,
            Self::HalfSquared => Base::Root,
            Self::Root => Base::Square,
            Self::Reflected => Base::FourthRoot,
        }
    }
}
