//! Lights, viewer and materials.

use microphong_models::vector::{V3, sub, unit};

/// Position of a light or viewer, in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Infinitely far: the unit vector towards it.
    Far(V3),
    /// Near, at a position.
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
    /// Position of the light.
    pub place: Place,
    /// Red, green, blue; 1 is full.
    pub colour: V3,
}

/// Reflectances of a surface for each channel, where 1 reflects all light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Colour that is there without lights.
    pub ambient: V3,
    /// Evenly.
    pub diffuse: V3,
    /// Reflectance in the highlight.
    pub specular: V3,
    /// Exponent of the highlight. A larger exponent makes a smaller highlight.
    pub exponent: f64,
}

/// The vector `v`, of any length but zero, with length one; a vector without direction becomes zero.
pub(super) fn direction(v: V3) -> V3 {
    unit(v).unwrap_or_default()
}
