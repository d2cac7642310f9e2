//! Lights, viewer and materials.

use microphong_models::vector::{V3, dot, length, sub, unit};

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

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Position of the light, or of the middle of the sky.
    pub place: Place,
    /// Red, green, blue; 1 is full.
    pub colour: V3,
    /// Whether it comes from half of the sky.
    pub is_sky: bool,
    /// The distance at which it ends.
    pub range: Option<f64>,
    /// The unit vector in which it shines, and the cosines to it where its cone ends and where its light is full.
    pub cone: Option<(V3, [f64; 2])>,
}

impl Light {
    /// A light that is equally strong everywhere.
    #[must_use]
    pub const fn even(place: Place, colour: V3) -> Self {
        Self { place, colour, is_sky: false, range: None, cone: None }
    }

    /// What is left of it at a position: 1 if it is as strong as at its source.
    #[must_use]
    pub fn strength(&self, position: V3) -> f64 {
        self.strength_beside(position, [0.0; 2])
    }

    /// [`Self::strength`], where the squared distance and the cosine to the axis of the cone are larger by `more`.
    #[must_use]
    pub fn strength_beside(&self, position: V3, more: [f64; 2]) -> f64 {
        let Place::Near(place) = self.place else { return 1.0 };
        let (way, [square, cosine]) = (sub(position, place), more);
        let part = self.range.map_or(0.0, |range| (dot(way, way) + square) / (range * range));
        let share = |axis, [edge, full]: [f64; 2]| (dot(axis, direction(way)) + cosine - edge) / (full - edge);
        let within = self.cone.map_or(1.0, |(axis, cosines)| share(axis, cosines).clamp(0.0, 1.0));
        (1.0 - part).max(0.0).powi(2) * within.powi(2)
    }

    /// Whether its range may reach a triangle between these corners.
    #[must_use]
    pub fn reaches(&self, corners: [V3; 3]) -> bool {
        let (Place::Near(place), Some(range)) = (self.place, self.range) else { return true };
        let [a, ..] = corners;
        let apart = |from: V3, to: V3| length(sub(from, to));
        let size = corners.into_iter().map(|corner| apart(a, corner)).fold(0.0, f64::max);
        apart(a, place) < range + size
    }

    /// The part of its diffuse light that a surface gets whose cosine to it is `cosine`.
    #[must_use]
    pub fn diffuse(&self, cosine: f64) -> f64 {
        if self.is_sky { f64::midpoint(1.0, cosine).clamp(0.0, 1.0) } else { cosine.clamp(0.0, 1.0) }
    }
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
