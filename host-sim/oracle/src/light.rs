//! Light that a point of a surface reflects: Phong's sum over the lights.

use super::{
    Levels, Shade,
    frame::{Facet, Frame},
    scene::{Light, Material, direction},
};
use microphong::math::highlight_lut;
use microphong_models::vector::{V3, add, dot};

/// Error of one light's level by rounding of two gains, two products and a cosine of 15 bits, in levels of 7 fraction bits.
const ROUNDING: f64 = 3.0 / 128.0;

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

    /// Largest error of integers, in levels, where a method compares light with its interpolation.
    ///
    /// Light at a point has the error of the table of highlights, and rounding of gains and cosines. The quadratic at the centre weighs its six nodes
    /// by 5/3 in all. Nodes on the parabola of an edge that is not split have up to 5/4 times the error of others. The light they are compared with
    /// has an error, too: 5/3 · 5/4 + 1 is 3.1. A light whose range ends before the triangle has no error.
    #[must_use]
    pub fn undecided(&self, facet: &Facet) -> f64 {
        let specular = self.material(facet).specular;
        let largest = |light: &Light| (0..3).map(|k| light.colour[k] * specular[k]).fold(0.0, f64::max);
        let arrives = |light: &&Light| light.reaches(facet.positions);
        self.lights.iter().filter(arrives).map(|light| 3.1 * (255.0 * highlight_lut::ERROR * largest(light) + ROUNDING)).sum()
    }

    /// The one channel in which a facet is shaded: the brightest, if all light that its material reflects has one hue, to 1/1024 of the largest
    /// channel. Such a material is interpolated in one channel under a table of colours.
    #[must_use]
    pub fn only_channel(&self, facet: &Facet) -> Option<usize> {
        let material = self.material(facet);
        let product = |a: V3, b: V3| [0, 1, 2].map(|k| a[k] * b[k]);
        let lit = self.lights.iter().flat_map(|light| [material.diffuse, material.specular].map(|gain| product(light.colour, gain)));
        let colours: Vec<V3> = lit.chain([material.ambient]).collect();
        let brightest = |colour: &V3| (0..3).max_by(|&i, &j| colour[i].total_cmp(&colour[j])).unwrap_or(0);
        let largest = |colour: &V3| colour[brightest(colour)];
        let base = colours.iter().max_by(|a, b| largest(a).total_cmp(&largest(b)))?;
        let alike = |colour: &V3| {
            let (a, b) = (largest(colour), largest(base));
            (0..3).all(|k| (colour[k] * b - base[k] * a).abs() <= a * b / 1024.0)
        };
        colours.iter().all(alike).then(|| brightest(base))
    }

    /// `255 (ka + Σ colour (kd d + ks s))` over all lights, each with its `[d, s]`, d from 0 to 1: what approximation lifts above
    /// one counts as one. Ranges and cones weaken lights as at `position`.
    pub(super) fn levels(&self, facet: &Facet, position: V3, reflected: impl IntoIterator<Item = [f64; 2]>) -> Levels {
        let material = self.material(facet);
        let mut sum = material.ambient;
        for (light, [diffuse, specular]) in self.lights.iter().zip(reflected) {
            let (strength, specular) = (light.strength(position), if light.is_sky { 0.0 } else { specular });
            for (k, channel) in sum.iter_mut().enumerate() {
                *channel += light.colour[k] * strength * (material.diffuse[k] * light.diffuse(diffuse) + material.specular[k] * specular);
            }
        }
        sum.map(|channel| (255.0 * channel).clamp(0.0, 255.0))
    }

    /// The level from each light's `[N·L, N·H]`.
    pub(super) fn lit(&self, facet: &Facet, position: V3, cosines: impl IntoIterator<Item = [f64; 2]>) -> Levels {
        let exponent = self.material(facet).exponent;
        self.levels(facet, position, cosines.into_iter().map(|[diffuse, half]| [diffuse, highlight(half, exponent)]))
    }

    /// The light of a node of a polynomial: Phong's, but that a corner's normal stays as it stands.
    pub(super) fn node(&self, facet: &Facet, weights: V3) -> Levels {
        let (position, normal) = (facet.position(weights), facet.node(weights));
        self.lit(facet, position, self.lights.iter().map(|light| self.cosines(light, position, normal)))
    }
}

/// `max(0, cosine)^exponent`; what approximation lifts above one counts as one.
pub(super) fn highlight(cosine: f64, exponent: f64) -> f64 {
    cosine.clamp(0.0, 1.0).powf(exponent)
}

/// The highlight of Phong (1975), from N·L, N·V and L·V: `(R·V)^(exponent / 4)`, where R is the reflected light.
///
/// Mirrored about N, the half vector's angle doubles; a quarter of Blinn's exponent makes highlights of the same size.
/// R·V also grows where the normal points away from both, which is not a highlight.
pub(super) fn reflection(light: f64, view: f64, between: f64, exponent: f64) -> f64 {
    let cosine = 2.0 * light * view - between;
    if light + view > 0.0 { highlight(cosine, exponent / 4.0) } else { 0.0 }
}

/// Phong shading with Blinn's half vector (Phong 1975, Blinn 1977): the normal is interpolated and normalised, and position, light and viewer are
/// computed at every point. All other methods approximate it.
#[must_use]
pub fn phong<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    Box::new(move |p| {
        let weights = facet.weights(p);
        let (position, normal) = (facet.position(weights), direction(facet.normal(weights)));
        frame.lit(facet, position, frame.lights.iter().map(|light| frame.cosines(light, position, normal)))
    })
}
