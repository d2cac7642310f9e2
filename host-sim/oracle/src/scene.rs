//! What shines, from where it is seen, and what it shines on.

use microphong_render::vector::{V3, sub, unit};

/// Where a light or a viewer is, object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Infinitely far: the unit vector towards it.
    Far(V3),
    /// At a position.
    Near(V3),
}

impl Place {
    /// Unit vector from `position` towards it.
    #[must_use]
    pub fn from(&self, position: V3) -> V3 {
        match *self {
            Self::Far(towards) => towards,
            Self::Near(place) => direction(sub(place, position)),
        }
    }
}

/// A light without fall-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is.
    pub place: Place,
    /// Red, green, blue; 1 is full.
    pub colour: V3,
}

/// How a surface reflects light; per channel, 1 is all of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// What is there without lights.
    pub ambient: V3,
    /// Evenly.
    pub diffuse: V3,
    /// In the highlight.
    pub specular: V3,
    /// Exponent of the highlight. A larger exponent makes a smaller highlight.
    pub exponent: f64,
}

/// The vector `v`, of any length but zero, with length one; a vector without direction becomes zero.
pub(super) fn direction(v: V3) -> V3 {
    unit(v).unwrap_or_default()
}
