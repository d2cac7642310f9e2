//! The names of the shading methods; what they do is in [`crate::shade`].

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
    /// Normals interpolated and normalised at every pixel.
    Phong,
}

impl Shader {
    /// Every method; the index is what a stream stores.
    pub const ALL: [Self; 4] = [Self::Flat, Self::Gouraud, Self::SixPoint, Self::Phong];

    /// The name on the command line and in logs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Gouraud => "gouraud",
            Self::SixPoint => "six-point",
            Self::Phong => "phong",
        }
    }

    /// Whether vertices need their light before triangles are drawn.
    #[must_use]
    pub(crate) const fn lights_vertices(self) -> bool {
        !matches!(self, Self::Flat)
    }
}
