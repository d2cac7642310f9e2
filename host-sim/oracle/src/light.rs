//! Light that a point of a surface reflects: Phong's sum over the lights.

use super::{
    Levels, Shade,
    frame::{Facet, Frame, SurfacePoint},
    scene::{Light, Material, direction},
    texture::painted,
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
    /// channel. Such a material is interpolated in one channel under a table of colours. A facet with colours always has three channels. Greys have
    /// one.
    #[must_use]
    pub fn only_channel(&self, facet: &Facet) -> Option<usize> {
        match facet.albedos {
            _ if self.is_gray => return Some(0),
            Some(_) => return None,
            None => {}
        }
        let material = self.material(facet);
        let product = |a: V3, b: V3| [0, 1, 2].map(|k| a[k] * b[k]);
        // A sky has no highlight.
        let gains = |light: &Light| [material.diffuse, if light.is_sky { [0.0; 3] } else { material.specular }];
        let lit = self.lights.iter().flat_map(|light| gains(light).map(|gain| product(light.colour, gain)));
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

    /// Light in the channels of the pixels: in greys Rec. 601's luma, by the weights of 8 bits.
    pub(super) fn shown(&self, [r, g, b]: V3) -> V3 {
        if self.is_gray { [(77.0 * r + 150.0 * g + 29.0 * b) / 256.0; 3] } else { [r, g, b] }
    }

    /// `255 (albedo ka + Σ colour (albedo kd d + ks s))` over all lights, each with its `[d, s]`, d from 0 to 1: what approximation lifts above
    /// one counts as one. The albedo is that of `point`, and ranges and cones weaken lights as there.
    pub(super) fn levels(&self, facet: &Facet, point: SurfacePoint, reflected: impl IntoIterator<Item = [f64; 2]>) -> Levels {
        let (material, SurfacePoint { position, albedo }) = (self.material(facet), point);
        let product = |a: V3, b: V3| [0, 1, 2].map(|k| a[k] * b[k]);
        let albedo = self.shown(albedo);
        let mut sum = product(albedo, self.shown(material.ambient));
        for (light, [diffuse, specular]) in self.lights.iter().zip(reflected) {
            let (strength, specular) = (light.strength(position), if light.is_sky { 0.0 } else { specular });
            let [gains, highlights] = [material.diffuse, material.specular].map(|gain| self.shown(product(light.colour, gain)));
            for (k, channel) in sum.iter_mut().enumerate() {
                *channel += strength * (albedo[k] * gains[k] * light.diffuse(diffuse) + highlights[k] * specular);
            }
        }
        let most = if facet.is_painted { f64::INFINITY } else { 255.0 };
        sum.map(|channel| (255.0 * channel).clamp(0.0, most))
    }

    /// The level from each light's `[N·L, N·H]`.
    pub(super) fn lit(&self, facet: &Facet, point: SurfacePoint, cosines: impl IntoIterator<Item = [f64; 2]>) -> Levels {
        let exponent = self.material(facet).exponent;
        self.levels(facet, point, cosines.into_iter().map(|[diffuse, half]| [diffuse, highlight(half, exponent)]))
    }

    /// The light of a node of a polynomial: Phong's, but that a corner's normal stays as it stands.
    pub(super) fn node(&self, facet: &Facet, weights: V3) -> Levels {
        let (point, normal) = (facet.point(weights), facet.node(weights));
        self.lit(facet, point, self.lights.iter().map(|light| self.cosines(light, point.position, normal)))
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
    if let Some(texture) = &facet.texture {
        return painted(facet, texture, |facet, p| phong(frame, facet)(p));
    }
    Box::new(move |p| {
        let weights = facet.weights(p);
        let (point, normal) = (facet.point(weights), direction(facet.normal(weights)));
        frame.lit(facet, point, frame.lights.iter().map(|light| frame.cosines(light, point.position, normal)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NAMES, Place, method};
    use microphong_models::vector::unit;

    const NEAR: bool = true;
    const FAR: bool = false;
    const WHITE: [V3; 3] = [[1.0; 3]; 3];
    /// Corners of one channel each, and of none.
    const GRADIENT: [V3; 3] = [[1.0, 0.2, 0.0], [0.0, 1.0, 0.4], [0.5, 0.0, 1.0]];
    const MATERIAL: Material = Material { ambient: [0.05, 0.1, 0.15], diffuse: [0.5, 0.4, 0.3], specular: [0.3, 0.2, 0.1], exponent: 20.0 };

    /// A bent triangle with these colours.
    fn facet(albedos: Option<[V3; 3]>) -> Facet {
        let normals = [[-0.3, -0.2, 1.0], [0.35, -0.1, 1.0], [0.0, 0.4, 1.0]].map(|v| unit(v).expect("a direction"));
        let positions = [[-0.8, -0.6, 0.0], [0.1, 0.9, 0.1], [0.8, -0.4, 0.2]];
        Facet { albedos, ..Facet::new([[10.0, 90.0], [40.0, 5.0], [95.0, 70.0]], [0, 1, 2], normals, positions) }
    }

    /// Two lights, of which the second is near or from the sky.
    fn frame(material: Material, is_near: bool) -> Frame {
        let far = Light::even(Place::Far(direction([0.3, 0.4, 0.8])), [0.7, 0.8, 0.9]);
        let sky = Light { is_sky: true, ..Light::even(Place::Far(direction([0.0, 1.0, 0.2])), [0.3, 0.2, 0.1]) };
        let close = Light { range: Some(4.0), ..Light::even(Place::Near([-0.9, 1.0, 1.0]), [0.3, 0.2, 0.1]) };
        Frame {
            size: (100, 100),
            facets: Vec::new(),
            lights: vec![far, if is_near { close } else { sky }],
            viewer: Place::Far([0.0, 0.0, 1.0]),
            axes: Facet::CORNERS,
            materials: vec![material],
            background: [[0.0; 3]; 2],
            is_gray: false,
        }
    }

    /// The levels of a facet by each method that can draw it, at three points.
    fn all(frame: &Frame, facet: &Facet) -> Vec<(&'static str, Levels)> {
        let drawn = NAMES.into_iter().filter_map(|name| Some((name, method(name, frame, facet).ok()?)));
        drawn.flat_map(|(name, shade)| [[48.0, 55.0], [26.5, 50.5], [90.5, 70.5]].map(|point| (name, shade(point)))).collect()
    }

    fn assert_equal(found: &[(&str, Levels)], expected: &[(&str, Levels)]) {
        assert!(found.len() == expected.len() && found.len() >= 3 * 20, "{} of {}", found.len(), expected.len());
        for ((name, a), (other, b)) in found.iter().zip(expected) {
            assert!(name == other && (0..3).all(|k| (a[k] - b[k]).abs() < 1e-9), "{name}: {a:?}, not {b:?}");
        }
    }

    /// Lights far and near, and facets without perspective and with it.
    fn scenes(material: Material, albedos: Option<[V3; 3]>) -> impl Iterator<Item = (Frame, Facet)> {
        let shares = [[1.0; 3], [1.0, 0.6, 0.4], [0.55, 0.5, 0.52]];
        shares.into_iter().flat_map(move |shares| [FAR, NEAR].map(|near| (frame(material, near), Facet { shares, ..facet(albedos) })))
    }

    /// A triangle with white corners looks like one without colours.
    #[test]
    fn white_corners_change_nothing() {
        for ((frame, white), (_, plain)) in scenes(MATERIAL, Some(WHITE)).zip(scenes(MATERIAL, None)) {
            assert_equal(&all(&frame, &white), &all(&frame, &plain));
        }
    }

    /// One colour at all corners multiplies the ambient and the diffuse reflectance of the material, and leaves highlights as they are.
    #[test]
    fn one_colour_multiplies_the_material() {
        let colour = [0.9, 0.35, 0.0];
        let product = |gain: V3| [0, 1, 2].map(|k| gain[k] * colour[k]);
        let multiplied = Material { ambient: product(MATERIAL.ambient), diffuse: product(MATERIAL.diffuse), ..MATERIAL };
        for ((frame, facet), (other, plain)) in scenes(MATERIAL, Some([colour; 3])).zip(scenes(multiplied, None)) {
            assert_equal(&all(&frame, &facet), &all(&other, &plain));
        }
    }

    /// In ambient light alone a surface shows its colours: by all methods but `flat` those of the point that is seen, and by `flat` their mean.
    #[test]
    fn gradients_are_linear_in_space() {
        let frame = Frame { lights: Vec::new(), ..frame(Material { ambient: [1.0, 0.5, 1.0], ..MATERIAL }, FAR) };
        let seen = |shares, [a, b, c]: V3, name| {
            let facet = Facet { shares, ..facet(Some(GRADIENT)) };
            let [p, q, r] = facet.screen;
            let point = [0, 1].map(|k| a * p[k] + b * q[k] + c * r[k]);
            method(name, &frame, &facet).ok().map(|shade| shade(point))
        };
        let assert_close = |name: &str, found: Levels, expected: V3| {
            let expected = [expected[0], 0.5 * expected[1], expected[2]];
            assert!((0..3).all(|k| (found[k] - 255.0 * expected[k]).abs() < 1e-9), "{name}: {found:?}");
        };
        for name in NAMES {
            let expected = if name == "flat" { [0.5, 0.4, 1.4 / 3.0] } else { [0.45, 0.34, 0.62] };
            assert_close(name, seen([1.0; 3], [0.2, 0.3, 0.5], name).expect("lights are far"), expected);
        }
        for name in ["phong", "gouraud", "sqrt6", "duff"] {
            // The weights in space are 1/4, 3/8 and 3/8.
            assert_close(name, seen([1.0, 0.5, 0.25], [0.1, 0.3, 0.6], name).expect("it draws in perspective"), [0.4375, 0.425, 0.525]);
        }
    }

    /// Methods that interpolate light interpolate the light of coloured nodes.
    #[test]
    fn light_and_colour_are_multiplied_at_nodes() {
        for near in [FAR, NEAR] {
            let (frame, facet) = (frame(MATERIAL, near), facet(Some(GRADIENT)));
            let [a, b, _] = facet.screen;
            let middle = [0, 1].map(|k| 0.5 * (a[k] + b[k]));
            let shade = |name, point| method(name, &frame, &facet).expect("a method")(point);
            let ([first, second], exact) = ([a, b].map(|corner| shade("phong", corner)), shade("phong", middle));
            let apart = |a: Levels, b: Levels| [0, 1, 2].map(|k| (a[k] - b[k]).abs()).into_iter().fold(0.0, f64::max);
            let mean = [0, 1, 2].map(|k| 0.5 * (first[k] + second[k]));
            assert!(
                apart(shade("gouraud", middle), mean) < 1e-9 && apart(shade("six-point", middle), exact) < 1e-9 && apart(mean, exact) > 1.0
            );
        }
    }

    /// In greys the luma of a colour multiplies the luma of ambient and of diffuse light. So all is grey if the colours are all of one luma.
    #[test]
    fn greys_have_the_luma_of_colours() {
        let luma = |[r, g, b]: V3| (77.0 * r + 150.0 * g + 29.0 * b) / 256.0;
        let [red, blue] = [[0.9, 0.2, 0.1], [0.0, 0.5, 1.0]];
        let colours = [red, blue, red];
        for near in [FAR, NEAR] {
            let frame = frame(MATERIAL, near).in_greys();
            let found = all(&frame, &facet(Some(colours)));
            assert!(found.iter().all(|(_, [r, g, b])| r == g && g == b));
            assert_equal(&found, &all(&frame, &facet(Some(colours.map(|colour| [luma(colour); 3])))));
            assert_eq!(frame.only_channel(&facet(Some(colours))), Some(0));
        }
    }

    /// A coloured facet has three channels, also if its material is grey, as are its colours.
    #[test]
    fn coloured_facets_have_three_channels() {
        let frame = frame(Material { ambient: [0.1; 3], diffuse: [0.5; 3], specular: [0.2; 3], exponent: 8.0 }, FAR);
        let grey = Frame { lights: frame.lights.iter().map(|&light| Light { colour: [1.0; 3], ..light }).collect(), ..frame };
        assert_eq!([None, Some(WHITE)].map(|albedos| grey.only_channel(&facet(albedos)).is_some()), [true, false]);
    }

    /// Under skies alone a material of one hue has one channel, whatever its highlights look like.
    #[test]
    fn highlights_count_only_where_lights_have_them() {
        let glossy = Material { ambient: [0.1, 0.05, 0.05], diffuse: [0.8, 0.4, 0.4], specular: [0.4; 3], exponent: 8.0 };
        let frame = frame(glossy, FAR);
        let lit_by = |is_sky| {
            let lights = frame.lights.iter().map(|&light| Light { colour: [1.0; 3], is_sky, ..light }).collect();
            Frame { lights, ..frame.clone() }.only_channel(&facet(None))
        };
        assert_eq!([false, true].map(lit_by), [None, Some(0)]);
    }
}
