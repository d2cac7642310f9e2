//! Shading methods that are chosen at run time, from the core and, with the feature `literature`, from the literature.

use anyhow::{Context, Result};
use microphong::{
    Stream,
    method::{
        Facts, Method,
        auto::Auto,
        cosines::{phong::Phong, sqrt6::Sqrt6},
        levels::{flat::Flat, gouraud::Gouraud, six_point::SixPoint},
    },
    pixel::Pixel,
};
#[cfg(feature = "literature")]
use microphong_literature as literature;
use std::fmt;

/// A shading method in no pixel format yet.
#[derive(Clone, Copy)]
pub struct Shader(&'static dyn Method);

impl Shader {
    /// Flat shading: one colour for each triangle.
    pub const FLAT: Self = Self(&Flat);
    /// Lit at the corners, linear in between.
    pub const GOURAUD: Self = Self(&Gouraud);
    /// Lit at corners and edge midpoints, quadratic in between.
    pub const SIX_POINT: Self = Self(&SixPoint);
    /// Normals interpolated and normalised at every pixel.
    pub const PHONG: Self = Self(&Phong);
    /// The root of N·H quadratic, squared and raised at the pixel.
    pub const SQRT6: Self = Self(&Sqrt6);
    /// Linear numerators times a quadratic reciprocal length.
    #[cfg(feature = "literature")]
    pub const RENQ: Self = Self(&literature::Renq);
    /// Linear numerators times a quadratic reciprocal length, made exact by Newton's iteration.
    #[cfg(feature = "literature")]
    pub const RENQ_NEWTON: Self = Self(&literature::RenqNewton);

    /// The method `auto`: for each triangle the cheapest way within the error budget.
    pub const AUTO: Self = Self(&Auto::<true>);
    /// The method `auto-linear`: `auto` without quadratic interpolation.
    pub const AUTO_LINEAR: Self = Self(&Auto::<false>);

    /// Every method, in the order of their numbers.
    #[cfg(not(feature = "literature"))]
    pub const ALL: [Self; 7] = Self::CORE;
    /// Every method, in the order of their numbers.
    #[cfg(feature = "literature")]
    pub const ALL: [Self; 28] = {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u] = literature::ALL;
        [
            Self::FLAT,
            Self::GOURAUD,
            Self::SIX_POINT,
            Self::PHONG,
            Self(a),
            Self(b),
            Self(c),
            Self(d),
            Self(e),
            Self(f),
            Self(g),
            Self(h),
            Self(i),
            Self(j),
            Self(k),
            Self(l),
            Self(m),
            Self(n),
            Self(o),
            Self(p),
            Self(q),
            Self(r),
            Self(s),
            Self::SQRT6,
            Self(t),
            Self(u),
            Self::AUTO,
            Self::AUTO_LINEAR,
        ]
    };

    /// The methods that the core itself has.
    pub const CORE: [Self; 7] = [Self::FLAT, Self::GOURAUD, Self::SIX_POINT, Self::PHONG, Self::SQRT6, Self::AUTO, Self::AUTO_LINEAR];

    /// A method that is none of these.
    #[must_use]
    pub const fn new(method: &'static dyn Method) -> Self {
        Self(method)
    }

    /// The method with this number in streams.
    #[must_use]
    pub fn by_id(id: u16) -> Option<Self> {
        Self::ALL.into_iter().find(|shader| shader.facts().id == id)
    }

    /// The method that a stream asks for.
    ///
    /// # Errors
    /// When this program does not have the method.
    pub fn of(stream: &Stream<'_>) -> Result<Self> {
        let id = stream.header.shader;
        Self::by_id(id)
            .with_context(|| format!("the stream names shading method number {id}, which this command lacks; choose one with --shader"))
    }

    /// Whether the method chooses by an error budget.
    #[must_use]
    pub fn keeps_budget(self) -> bool {
        [Self::AUTO, Self::AUTO_LINEAR].contains(&self)
    }

    /// Properties of the method.
    #[must_use]
    pub fn facts(self) -> &'static Facts {
        self.0.facts()
    }

    /// The name on the command line and in logs.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.facts().name
    }

    /// Whether the method looks up highlights in tables.
    #[must_use]
    pub fn needs_highlight_tables(self) -> bool {
        self.0.needs_highlight_tables()
    }

    /// The method for a pixel format: with loops of its own if it has any.
    #[must_use]
    pub fn on<C: Pixel>(self) -> microphong::Shader<C> {
        let id = self.facts().id;
        microphong::Shader::ALL.into_iter().find(|shader| shader.facts().id == id).unwrap_or(microphong::Shader::new(self.0))
    }
}

impl PartialEq for Shader {
    fn eq(&self, other: &Self) -> bool {
        self.facts().id == other.facts().id
    }
}

impl Eq for Shader {}

impl fmt::Debug for Shader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
