//! What a point of a surface reflects: Phong's sum over the lights.

use super::{
    Levels, Shade,
    frame::{Facet, Frame},
    scene::{Light, Material, direction},
};
use microphong_render::vector::{V3, add, dot};

/// The unit vectors that shading is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rays {
    /// L.
    pub(super) light: V3,
    /// V.
    pub(super) view: V3,
    /// H, half-way between them.
    pub(super) half: V3,
}

impl Frame {
    /// L, V and H of a light at a position.
    pub(super) fn rays(&self, light: &Light, position: V3) -> Rays {
        let (light, view) = (light.place.from(position), self.viewer.from(position));
        Rays { light, view, half: direction(add(light, view)) }
    }

    /// `[N·L, N·H]` of a light.
    pub(super) fn cosines(&self, light: &Light, position: V3, normal: V3) -> [f64; 2] {
        let rays = self.rays(light, position);
        [dot(normal, rays.light), dot(normal, rays.half)]
    }

    /// The facet's material.
    pub(super) fn material(&self, facet: &Facet) -> Material {
        let black = Material { ambient: [0.0; 3], diffuse: [0.0; 3], specular: [0.0; 3], exponent: 1.0 };
        self.materials.get(facet.material).copied().unwrap_or(black)
    }

    /// `255 (ka + Σ colour (kd d + ks s))` over all lights, each with its `[d, s]`, d from 0 to 1: what approximation lifts above
    /// one counts as one.
    pub(super) fn levels(&self, facet: &Facet, reflected: impl IntoIterator<Item = [f64; 2]>) -> Levels {
        let material = self.material(facet);
        let mut sum = material.ambient;
        for (light, [diffuse, specular]) in self.lights.iter().zip(reflected) {
            for (k, channel) in sum.iter_mut().enumerate() {
                *channel += light.colour[k] * (material.diffuse[k] * diffuse.clamp(0.0, 1.0) + material.specular[k] * specular);
            }
        }
        sum.map(|channel| (255.0 * channel).clamp(0.0, 255.0))
    }

    /// The same from each light's `[N·L, N·H]`.
    pub(super) fn lit(&self, facet: &Facet, cosines: impl IntoIterator<Item = [f64; 2]>) -> Levels {
        let exponent = self.material(facet).exponent;
        self.levels(facet, cosines.into_iter().map(|[diffuse, half]| [diffuse, highlight(half, exponent)]))
    }

    /// The light of a node of a polynomial: Phong's, but that a corner's normal stays as it stands.
    pub(super) fn node(&self, facet: &Facet, weights: V3) -> Levels {
        let (position, normal) = (facet.position(weights), facet.node(weights));
        self.lit(facet, self.lights.iter().map(|light| self.cosines(light, position, normal)))
    }
}

/// `max(0, cosine)^exponent`; what approximation lifts above one counts as one.
pub(super) fn highlight(cosine: f64, exponent: f64) -> f64 {
    cosine.clamp(0.0, 1.0).powf(exponent)
}

/// The highlight that Phong (1975) drew: `(R·V)^(exponent / 4)`, R the light reflected; from N·L, N·V and L·V.
///
/// Mirrored about N, the half vector's angle doubles; a quarter of Blinn's exponent makes highlights of the same size.
/// R·V also grows where the normal points away from both, which is not a highlight.
pub(super) fn reflection(light: f64, view: f64, between: f64, exponent: f64) -> f64 {
    let cosine = 2.0 * light * view - between;
    if light + view > 0.0 { highlight(cosine, exponent / 4.0) } else { 0.0 }
}

/// Phong shading with Blinn's half vector (Phong 1975, Blinn 1977): the normal interpolated and normalised, position,
/// light and viewer anew at every point. All other methods approximate it.
#[must_use]
pub fn phong<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    Box::new(move |p| {
        let weights = facet.weights(p);
        let (position, normal) = (facet.position(weights), direction(facet.normal(weights)));
        frame.lit(facet, frame.lights.iter().map(|light| frame.cosines(light, position, normal)))
    })
}
