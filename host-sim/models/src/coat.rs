//! What gives triangles their colours: a palette for the colours at their corners, or a texture.

use crate::mesh::Rgb;
use microphong::{
    format::TEXTURE,
    stream::record::{LARGEST_TEXTURE, TextureCorners},
};
use std::sync::Arc;

/// What triangles of a mesh have their colours from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Coat {
    /// The colours of corners, at most 256.
    Palette(Vec<Rgb>),
    /// A texture that lies over the triangles.
    Texture(Arc<Texels>),
}

impl Coat {
    /// All of its colours.
    #[must_use]
    pub fn palette(&self) -> &[Rgb] {
        match self {
            Self::Palette(palette) => palette,
            Self::Texture(texels) => &texels.palette,
        }
    }
}

/// What a corner has of a [`Coat`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// A colour, as an index of the palette.
    Colour(u8),
    /// A place in the texture.
    Place(Place),
}

/// A texture as a stream has it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Texels {
    /// The binary logarithms of width and height.
    pub size: [u8; 2],
    /// The colours, at most 256.
    pub palette: Vec<Rgb>,
    /// The colour of each texel as an index of the palette, row by row from the top.
    pub indices: Vec<u8>,
    /// The colour of the palette that is a hole, if there is one.
    pub hole: Option<u8>,
}

impl Texels {
    /// Width and height.
    #[must_use]
    pub fn sides(&self) -> [u32; 2] {
        self.size.map(|side| 1 << side)
    }

    /// The colour of the texel at a point, in units of a [`Place`], as a renderer takes it.
    #[must_use]
    pub fn at(&self, point: [f64; 2]) -> Rgb {
        let texel = |axis: usize| {
            let side = f64::from(self.sides()[axis]);
            (point[axis] / ONE * side).floor().rem_euclid(side) as usize
        };
        self.palette[usize::from(self.indices[texel(1) << self.size[0] | texel(0)])]
    }
}

/// The largest width and height of textures, as a binary logarithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureSize(u8);

impl TextureSize {
    /// All of them.
    pub const ALL: [Self; 6] = [Self(3), Self(4), Self(5), Self(6), Self(7), Self(LARGEST_TEXTURE)];

    /// The size of this number of texels; `None` if it is not one of them.
    #[must_use]
    pub fn of(texels: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|size| size.texels() == texels)
    }

    /// The numbers of texels of all of them.
    #[must_use]
    pub fn names() -> String {
        Self::ALL.map(|size| size.texels().to_string()).join(", ")
    }

    /// The number of texels of a side.
    #[must_use]
    pub const fn texels(self) -> u32 {
        1 << self.0
    }

    /// The binary logarithm of the power of two that is nearest to the side of an image, or of this size if that is less.
    pub(crate) fn side(self, pixels: usize) -> u8 {
        (0..self.0).find(|&side| 2 * pixels < 3 << side).unwrap_or(self.0)
    }
}

impl Default for TextureSize {
    fn default() -> Self {
        Self(7)
    }
}

/// A place in a texture: the distances from its left and from its upper side, in units of 1/4,096 of its width and height. It wraps around at 2^32, which is a
/// whole number of textures: there the texture is the same.
pub type Place = [i32; 2];

/// The width of a texture in units of a [`Place`].
const ONE: f64 = (1 << TEXTURE) as f64;

/// The place that is nearest to this one, which counts in widths and heights of the texture.
pub(crate) fn place(coordinates: [f64; 2]) -> Place {
    coordinates.map(|c| (c * ONE).round() as i64 as i32)
}

/// The record of a triangle whose corners have these places. They are shifted by whole numbers, so that the least ones lie in the first texture. `None` if
/// others reach the sixteenth texture after it, where the coordinates of a stream end.
#[must_use]
pub fn texture_corners(places: [Place; 3]) -> Option<TextureCorners> {
    let mut corners = [[0; 2]; 3];
    for axis in 0..2 {
        let first = places[0][axis];
        let offsets = places.map(|place| i64::from(place[axis].wrapping_sub(first)));
        let least = offsets.into_iter().min().unwrap_or_default();
        let start = (i64::from(first) + least).rem_euclid(1 << TEXTURE);
        for (corner, offset) in corners.iter_mut().zip(offsets) {
            corner[axis] = u16::try_from(start + offset - least).ok()?;
        }
    }
    Some(TextureCorners(corners))
}
