//! Textures of a stream, made of the images of a file.

use super::{
    facet::Facets,
    palette::{BLOCKS, MOST, blocks, indexed},
};
use crate::{
    coat::{Coat, Texels, TextureSize},
    mesh::{Mesh, Rgb},
    texture::Image,
};
use microphong::stream::record::{self, Colour, PALETTE};
use std::{collections::HashMap, iter, sync::Arc};

/// The textures of some triangles.
pub(super) struct Textures {
    /// The number of the texture that is made of each image.
    numbers: HashMap<*const Image, usize>,
    /// The textures, of which no two are equal.
    all: Vec<Arc<Texels>>,
}

impl Textures {
    /// The textures of these triangles, with as many colours as a stream has room for beside a palette of colours at corners.
    pub(super) fn of(mesh: &Mesh, facets: &Facets<'_>, takes: &[bool], largest: TextureSize) -> Self {
        let mut numbers = HashMap::new();
        let mut images = Vec::new();
        for triangle in (0..takes.len()).filter(|&triangle| takes[triangle]) {
            if let Some((image, _)) = facets.of(mesh, triangle).and_then(|facet| facet.texture) {
                numbers.entry(std::ptr::from_ref(image)).or_insert_with(|| {
                    images.push(resampled(image, largest));
                    images.len() - 1
                });
            }
        }
        let mut all = Vec::new();
        for most in iter::successors(Some(MOST), |most| Some(most / 2).filter(|&most| most >= PALETTE)) {
            let reduce = |(size, pixels): &([u8; 2], Vec<Option<Rgb>>)| {
                let has_holes = pixels.contains(&None);
                let colours: Vec<Rgb> = pixels.iter().copied().flatten().collect();
                let (mut palette, indices) = indexed(&colours, most - usize::from(has_holes));
                let hole = has_holes.then_some(palette.len() as u8);
                palette.extend(hole.map(|_| [0; 3]));
                let mut indices = indices.into_iter();
                let index = |pixel: &Option<Rgb>| pixel.and_then(|_| indices.next()).or(hole).unwrap_or_default();
                Arc::new(Texels { size: *size, palette, indices: pixels.iter().map(index).collect(), hole })
            };
            all = images.iter().map(reduce).collect();
            if all.iter().map(|texels: &Arc<Texels>| blocks(&texels.palette)).sum::<usize>() <= BLOCKS - MOST / PALETTE {
                break;
            }
        }
        let mut textures = Self { numbers, all: Vec::new() };
        let mut known = HashMap::new();
        let number_of = |texels: Arc<Texels>| {
            *known.entry(texels).or_insert_with_key(|texels| {
                textures.all.push(Arc::clone(texels));
                textures.all.len() - 1
            })
        };
        let new: Vec<usize> = all.into_iter().map(number_of).collect();
        textures.numbers.values_mut().for_each(|number| *number = new[*number]);
        textures
    }

    /// The texture that is made of an image, and its number.
    pub(super) fn find(&self, image: &Image) -> Option<(usize, &Texels)> {
        let number = *self.numbers.get(&std::ptr::from_ref(image))?;
        Some((number, &self.all[number]))
    }

    /// The number of blocks of colours of all textures.
    pub(super) fn blocks(&self) -> usize {
        self.all.iter().map(|texels| blocks(&texels.palette)).sum()
    }

    /// Width and height of each texture.
    pub(super) fn sizes(&self) -> Vec<[u32; 2]> {
        self.all.iter().map(|texels| texels.sides()).collect()
    }

    /// Bytes of flash of all textures and of their palettes.
    pub(super) fn bytes(&self) -> usize {
        let of = |texels: &Arc<Texels>| size_of::<record::Texture>() + texels.indices.len() + texels.palette.len() * size_of::<Colour>();
        self.all.iter().map(of).sum()
    }

    /// All of them, by their numbers.
    pub(super) fn coats(&self) -> impl Iterator<Item = Coat> {
        self.all.iter().map(|texels| Coat::Texture(Arc::clone(texels)))
    }
}

/// The binary logarithms of width and height of the texture of an image, and its pixels, of which some are holes.
fn resampled(image: &Image, largest: TextureSize) -> ([u8; 2], Vec<Option<Rgb>>) {
    let size = image.size().map(|pixels| largest.side(pixels));
    (size, image.resampled(size.map(|side| 1 << side)))
}
