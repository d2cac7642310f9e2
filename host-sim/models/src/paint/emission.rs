//! The light that materials send out.
//!
//! In a file a texture may say where a material sends out light, and colours do not change this light. A stream has one light for each material, and
//! the colours of its triangles multiply it. A material takes the light whose products come nearest to that of the file: the one of least squared
//! distance over the area of its triangles. Without colours, this is the mean.

use super::{
    area,
    facet::{Facet, Facets},
    fit::{Fitting, POINTS},
};
use crate::{
    fields::quoted,
    mesh::{Mesh, Soup, Source},
    mtl::Material,
    texture::Texture,
    vector::V3,
};
use microphong::{format::Gain, stream::MAX_GAIN};
use std::collections::HashMap;

/// Light that differs from that of the file by less than this, in the root of the mean square, is the same: less cannot be seen.
const SAME: f64 = 1.0 / 255.0;

/// Where a material sends out its light.
#[derive(Clone, Debug)]
pub(crate) enum Emission {
    /// Everywhere alike.
    Even,
    /// Where a texture says, by whose colours the light is multiplied.
    By(Texture),
    /// Where a texture says that is not read.
    Unread,
}

/// What became of the light that materials send out.
#[derive(Debug, Default)]
pub(crate) struct Emitted {
    /// The names of materials whose light is not that of the file everywhere.
    changed: Vec<String>,
    /// Whether light is left out, because nothing that is read says where it is sent out.
    pub(crate) is_left_out: bool,
}

impl Emitted {
    /// A sentence for the user on light that is changed.
    pub(crate) fn sentence(&self) -> Option<String> {
        let names = self.changed.join(", ");
        (!names.is_empty()).then(|| {
            format!("the light that these materials send out is only near to that of the file, because a stream has one for each material: {names}")
        })
    }
}

/// Gives each material of a mesh the one light that comes nearest to what it sends out. `sources` says where the soup has the colours of triangles, if
/// they have any, and `textures` are those of the materials.
pub(crate) fn emit(
    mesh: &Mesh,
    sources: &[[Source; 3]],
    soup: &Soup,
    materials: &mut [Option<Material>],
    textures: &[Option<Texture>],
    emissions: &[Emission],
) -> Emitted {
    let mut emitted = Emitted::default();
    let emits = |material: &Option<Material>| material.as_ref().is_some_and(|material| material.emission != [0.0; 3]);
    if emissions.is_empty() || !materials.iter().any(emits) {
        return emitted;
    }
    let of_light: Vec<_> = emissions.iter().map(Emission::texture).collect();
    let facets = |textures| Facets { soup, textures, sources: sources.to_vec(), parts: HashMap::new() };
    let lit = Lit { mesh, colours: facets(textures), light: facets(&of_light), fitting: Fitting::new() };
    let sums = lit.sums(materials, emissions);
    for ((material, emission), sums) in materials.iter_mut().zip(emissions).zip(sums) {
        let Some(material) = material.as_mut().filter(|material| material.emission != [0.0; 3]) else { continue };
        match (sums, emission) {
            (Some(sums), _) => {
                material.emission = sums.nearest();
                emitted.changed.extend((sums.distance() > SAME).then(|| quoted(&material.name)));
            }
            // It has no triangle.
            (None, Emission::Even) => {}
            (None, _) => {
                material.emission = [0.0; 3];
                emitted.is_left_out = true;
            }
        }
    }
    emitted
}

impl Emission {
    fn texture(&self) -> Option<Texture> {
        match self {
            Self::By(texture) => Some(texture.clone()),
            Self::Even | Self::Unread => None,
        }
    }
}

/// The triangles of a mesh, with the colours that they have, and the light that they send out.
struct Lit<'a> {
    mesh: &'a Mesh,
    colours: Facets<'a>,
    light: Facets<'a>,
    fitting: Fitting,
}

impl Lit<'_> {
    /// The sums over all triangles of each material; `None` where nothing says where it sends out light.
    fn sums(&self, materials: &[Option<Material>], emissions: &[Emission]) -> Vec<Option<Sums>> {
        let mut sums = vec![None; materials.len()];
        for triangle in 0..self.mesh.triangles.len() {
            let number = self.mesh.submesh(triangle).material;
            let full = materials[number].as_ref().map_or([0.0; 3], |material| material.emission);
            if full == [0.0; 3] {
                continue;
            }
            let Some(shares) = emissions.get(number).and_then(|emission| self.shares(emission, triangle)) else { continue };
            let colours = self.colours.of(self.mesh, triangle).map_or([[1.0; 3]; POINTS], |facet| self.fitting.seen(&facet));
            let area = area(self.mesh, triangle);
            let sums: &mut Sums = sums[number].get_or_insert_default();
            for (share, colour) in shares.iter().zip(&colours) {
                sums.add(area, [0, 1, 2].map(|k| (full[k] * share[k]).min(1.0)), *colour);
            }
        }
        sums
    }

    /// The share of a material's light that it sends out at each point of a triangle.
    fn shares(&self, emission: &Emission, triangle: usize) -> Option<[V3; POINTS]> {
        match emission {
            Emission::Even => Some([[1.0; 3]; POINTS]),
            Emission::By(_) => {
                let facet = self.light.of(self.mesh, triangle).filter(|facet| facet.texture.is_some())?;
                // Colours of vertices do not change it.
                Some(self.fitting.seen(&Facet { is_white: true, ..facet }))
            }
            Emission::Unread => None,
        }
    }
}

/// Sums over points of triangles, for each channel.
#[derive(Clone, Default)]
struct Sums {
    /// The area that all points stand for.
    area: f64,
    /// The squares of the light that is sent out.
    light: V3,
    /// The squares of the colours.
    colours: V3,
    /// The products of both.
    products: V3,
}

impl Sums {
    fn add(&mut self, area: f64, light: V3, colour: V3) {
        self.area += area;
        for k in 0..3 {
            self.light[k] += area * light[k] * light[k];
            self.colours[k] += area * colour[k] * colour[k];
            self.products[k] += area * light[k] * colour[k];
        }
    }

    /// The light whose products with the colours come nearest to the light that is sent out.
    fn nearest(&self) -> V3 {
        let most = Gain::from_bits(MAX_GAIN).to_num();
        [0, 1, 2].map(|k| if self.colours[k] > 0.0 { (self.products[k] / self.colours[k]).min(most) } else { 0.0 })
    }

    /// How far these products are from it: the root of the mean square.
    fn distance(&self) -> f64 {
        let nearest = self.nearest();
        let square = |k: usize| self.light[k] - 2.0 * nearest[k] * self.products[k] + nearest[k] * nearest[k] * self.colours[k];
        ((square(0) + square(1) + square(2)).max(0.0) / (3.0 * self.area)).sqrt()
    }
}
