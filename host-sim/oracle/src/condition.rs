//! Condition number of shading at a point: by how much it magnifies rounding errors of its inputs.

use super::{Facet, Frame, Place, light::highlight, scene::direction};
use microphong_models::vector::{V3, add, dot, length, sub};

/// Corners, middles of edges and the centre: where methods take the normals and lights between which they interpolate.
const NODES: [V3; 7] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], Facet::CENTRE];
/// The exponent up to which |N|² follows from the constants of edges, which have 16 fraction bits. Beyond it, |N|² follows from the normals.
const STEEP: f64 = 64.0;
/// Error of a walked square, in units of the largest at a corner.
const WALKED: f64 = 1.0 / (1u64 << 24) as f64;

impl Place {
    /// The squared distance of the farthest corner from this light or viewer, divided by the squared distance of `position`.
    fn closeness(&self, facet: &Facet, position: V3) -> f64 {
        let Self::Near(place) = *self else { return 1.0 };
        let square = |from: V3| dot(sub(place, from), sub(place, from));
        facet.positions.into_iter().map(square).fold(0.0, f64::max) / square(position)
    }
}

impl Frame {
    /// The condition number of the cosines of a light at the point of a facet with these affine coordinates: 1 at best.
    ///
    /// Cosines are quotients by roots of squares: |N|², and where directions differ from point to point, |L + V|² and the squared
    /// distances of light and viewer. What a square is off by counts the more, the smaller it is.
    #[must_use]
    pub fn condition(&self, facet: &Facet, weights: V3, light: &Place) -> f64 {
        let (normal, position) = (facet.normal(weights), facet.position(weights));
        let normal = 1.0 / dot(normal, normal);
        if self.is_constant() {
            return normal;
        }
        let half = length(add(light.from(position), self.viewer.from(position))) / 2.0;
        normal.max(light.closeness(facet, position).max(self.viewer.closeness(facet, position)) / (half * half))
    }

    /// Largest error of cosines of the condition number 1. These numbers are not proven: each is about twice the largest error of millions of random
    /// pixels.
    fn unit(&self, exponent: f64) -> f64 {
        let bits = match (self.is_constant(), exponent > STEEP) {
            // Four quadratics are walked, over the whole span of a triangle.
            (false, _) => 15,
            (true, false) => 16,
            (true, true) => 18,
        };
        f64::from(-bits).exp2()
    }

    /// Largest change of a point's light, in levels, if the walked square of a light's distance has the error of a word. A cone divides by the distance,
    /// so that the error counts the more, the closer the light is in comparison with the farthest corner.
    #[must_use]
    pub fn weakening(&self, facet: &Facet, point: [f64; 2]) -> f64 {
        let (weights, material) = (facet.weights(point), self.material(facet));
        let (position, albedo) = (facet.position(weights), facet.albedo(weights));
        let mut levels = [0.0; 3];
        for light in self.lights.iter().filter(|light| light.range.is_some() || light.cone.is_some()) {
            let Place::Near(place) = light.place else { continue };
            let (closeness, way) = (light.place.closeness(facet, position), sub(position, place));
            let errors = [closeness * dot(way, way), closeness].map(|error| WALKED * error);
            let strength = |sign: f64| light.strength_beside(position, [-sign * errors[0], sign * errors[1]]);
            let change = strength(1.0) - strength(-1.0);
            for (k, level) in levels.iter_mut().enumerate() {
                *level += 255.0 * light.colour[k] * change * (albedo[k] * material.diffuse[k] + material.specular[k]);
            }
        }
        levels.into_iter().fold(0.0, f64::max)
    }

    /// Whether rounding decides on which side of the horizon the half vector of a light is at a point: highlights by R·V, of low exponents,
    /// begin there at once.
    #[must_use]
    pub fn is_at_horizon(&self, facet: &Facet, point: [f64; 2]) -> bool {
        let (weights, unit) = (facet.weights(point), self.unit(self.material(facet).exponent));
        let (position, normal) = (facet.position(weights), direction(facet.normal(weights)));
        let half = |light| self.cosines(light, position, normal)[1].abs();
        self.lights.iter().any(|light| half(light) < unit * self.condition(facet, weights, &light.place))
    }

    /// Largest change of a point's light, in levels, if cosines have the errors that their condition number makes of rounding. If `whole`, it is the
    /// largest of the point and all nodes of the facet.
    #[must_use]
    pub fn sensitivity(&self, facet: &Facet, point: [f64; 2], whole: bool) -> f64 {
        let (weights, material) = (facet.weights(point), self.material(facet));
        let (position, albedo, normal) = (facet.position(weights), facet.albedo(weights), direction(facet.normal(weights)));
        let at = |cosine: f64| highlight(cosine, material.exponent);
        let mut levels = [0.0; 3];
        for light in &self.lights {
            let condition = |weights| self.condition(facet, weights, &light.place);
            let shortest = 1.0 / facet.shortest_normal().powi(2);
            let worst = if whole { NODES.into_iter().map(condition).fold(shortest, f64::max) } else { 0.0 };
            let change = (self.unit(material.exponent) * worst.max(condition(weights))).min(2.0);
            let [_, half] = self.cosines(light, position, normal);
            let highlight = at(half + change) - at(half - change);
            for (k, level) in levels.iter_mut().enumerate() {
                *level += 255.0 * light.colour[k] * (albedo[k] * material.diffuse[k] * change + material.specular[k] * highlight);
            }
        }
        levels.into_iter().fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Light, Material};

    /// The walked distance matters where a cone ends and the light is much closer than the farthest corner; lights without a shape have none.
    #[test]
    fn cones_of_close_lights_are_sensitive() {
        let normal = [0.0, 0.0, 1.0];
        let facet = Facet::new(
            [[0.0, 60.0], [30.0, 0.0], [60.0, 60.0]],
            [0, 1, 2],
            [normal; 3],
            [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        );
        let point = [30.0, 40.0];
        let [x, y, z] = facet.position(facet.weights(point));
        let weakening = |height: f64, cone| {
            // At the point, the cosine to the axis is 1/√2: in the middle of the cone's edge.
            let place = Place::Near([x + height, y, z + height]);
            let light = Light { cone, ..Light::even(place, [1.0; 3]) };
            let material = Material { ambient: [0.0; 3], diffuse: [0.5; 3], specular: [0.5; 3], exponent: 8.0 };
            let viewer = Place::Far(normal);
            Frame {
                size: (60, 60),
                facets: Vec::new(),
                lights: vec![light],
                viewer,
                axes: Facet::CORNERS,
                materials: vec![material],
                background: [[0.0; 3]; 2],
                is_gray: false,
            }
            .weakening(&facet, point)
        };
        let cone = Some(([0.0, 0.0, -1.0], [0.6, 0.8]));
        let [far, close] = [1.0, 0.01].map(|height| weakening(height, cone));
        assert!(far < 0.01 && close > 1_000.0 * far, "{far} {close}");
        assert!(weakening(0.01, None) == 0.0);
    }

    /// The condition number grows where normals are short, and where light and view are nearly opposite. A facet has the largest of its nodes.
    #[test]
    fn it_grows_where_shading_is_ill_conditioned() {
        let facet = |bend: f64| {
            let normals = [[bend, 0.0, 1.0], [-bend, 0.0, 1.0], [0.0, 0.0, 1.0]].map(direction);
            Facet::new([[0.0, 60.0], [30.0, 0.0], [60.0, 60.0]], [0, 1, 2], normals, [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
        };
        let frame = |light: Place, viewer: Place| Frame {
            size: (60, 60),
            facets: Vec::new(),
            lights: vec![Light::even(light, [1.0; 3])],
            viewer,
            axes: Facet::CORNERS,
            materials: vec![Material { ambient: [0.0; 3], diffuse: [0.5; 3], specular: [1.0; 3], exponent: 8.0 }],
            background: [[0.0; 3]; 2],
            is_gray: false,
        };
        let above = Place::Far([0.0, 0.0, 1.0]);
        let far = frame(above, above);
        let (middle, corner) = ([15.0, 30.0], [59.0, 59.5]);
        let [gentle, quarter, eighth] = [0.3, 4.0, 8.0].map(|bend| far.sensitivity(&facet(bend), middle, false));
        // Normals of a length of about 1/4 and 1/8.
        assert!(gentle < 0.1 && (3.0..5.0).contains(&(eighth / quarter)), "{gentle} {quarter} {eighth}");
        let [here, whole] = [false, true].map(|whole| far.sensitivity(&facet(8.0), corner, whole));
        assert!(whole > 10.0 * here, "{here} {whole}");
        let [beside, opposite] = [[3.0, 0.0, 0.3], [0.1, 0.4, -8.0]].map(|light| {
            frame(Place::Near(light), Place::Near([0.0, 0.5, 8.0])).condition(&facet(0.3), Facet::CENTRE, &Place::Near(light))
        });
        assert!(opposite > 10.0 * beside, "{beside} {opposite}");
    }
}
