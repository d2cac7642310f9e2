//! Textures at a pixel: the nearest texel, and its colour.

use crate::{
    arch::product::HALVES,
    features::TEXTURED,
    format::{COSINE, TEXTURE},
    lighting::albedo::Albedo,
    stream::{
        MeshTexture,
        record::{Colour, TextureCorners},
    },
};
use microphong_kernels as kernels;
use zerocopy::IntoBytes;

/// A value for a mesh with a texture: there is room for none in a program without the feature.
pub type IfTextured<T> = [T; TEXTURED];

/// A place in a texture: columns to the right and rows downwards, in widths and heights of it, Q4.12.
pub(crate) type TextureCoordinates = [i32; 2];

/// A place of which a texel is cut: fractions of width and height, in all bits of a word.
pub(crate) type Aligned = [u32; 2];

/// Fraction bits of a walked place, which is a sixteenth of [`TextureCoordinates`] in the format of cosines.
pub(crate) const WALKED: u32 = COSINE - 4;
/// Bits by which a [`TextureCoordinates`] at a corner is shifted to have [`WALKED`] fraction bits.
pub(crate) const FINER: u32 = WALKED - TEXTURE;

/// A texture, from which pixels take their colours.
#[derive(Clone, Copy, Debug)]
pub struct Sampler<'f> {
    palette: &'f [Colour],
    texels: &'f [u8],
    /// The bits of an aligned place that the number of a row takes.
    rows: u32,
    /// The number of columns.
    width: u32,
    /// The binary logarithms of width and height.
    size: [u8; 2],
    is_gray: bool,
    /// Whether it may have holes.
    pub(crate) has_holes: bool,
}

/// The texture of a triangle.
#[derive(Clone, Copy)]
pub(crate) struct Textured<'f> {
    pub(crate) sampler: &'f Sampler<'f>,
    /// Where the corners lie in it.
    pub(crate) places: [TextureCoordinates; 3],
    /// Whether the camera is a perspective one.
    pub(crate) in_perspective: bool,
}

impl<'f> Sampler<'f> {
    /// The texture of a mesh, and where its triangles lie in it. Pixel formats of greys take the luma of its colours.
    pub(crate) fn new(texture: MeshTexture<'f>, is_gray: bool) -> (Self, &'f [TextureCorners]) {
        let MeshTexture { palette, texels, size, has_holes, corners } = texture;
        let [width, height] = size;
        (Self { palette, texels, rows: !(u32::MAX >> height), width: 1 << width, size, is_gray, has_holes }, corners)
    }

    /// A walked place with [`WALKED`] fraction bits.
    #[inline(always)]
    pub(crate) fn aligned([u, v]: [u32; 2]) -> Aligned {
        [u << (32 - WALKED), v << (32 - WALKED)]
    }

    /// The texture as kernels read it in a row that adds this to levels, see [`kernels::Texels::new`].
    #[inline(never)]
    pub(crate) fn in_kernels(&self, rounding: [i32; 3]) -> Option<kernels::Texels<'f>> {
        let (palette, _) = self.palette.as_bytes().as_chunks();
        kernels::Texels::new(palette, self.texels, self.size, rounding)
    }

    /// The colour of the texel at a place, which is rounded down to whole texels.
    #[inline]
    pub(crate) fn texel(&self, [u, v]: Aligned) -> Colour {
        let [width, height] = self.size;
        let row = v & self.rows;
        // Shares of the number of texels and of the width, which are powers of two.
        let texel = if HALVES {
            (row >> 1 >> (31 - u32::from(width) - u32::from(height))) + (u >> 1 >> (31 - u32::from(width)))
        } else {
            ((u64::from(row) * self.texels.len() as u64 + u64::from(u) * u64::from(self.width)) >> 32) as u32
        } as usize;
        // A checked stream has all texels, and all of their colours.
        let colour = self.texels.get(texel).and_then(|&index| self.palette.get(usize::from(index)));
        *colour.unwrap_or(&Colour::new([0; 3]))
    }

    /// The colour of a texel, as that of a surface.
    #[inline]
    pub(crate) fn albedo(&self, texel: Colour) -> Albedo {
        Albedo::new(texel, self.is_gray)
    }

    /// The largest difference between corners at these places, in texels, Q12.3.
    pub(crate) fn range(&self, &[[u0, v0], [u1, v1], [u2, v2]]: &[TextureCoordinates; 3]) -> u32 {
        let [width, height] = self.size;
        let range = |a: i32, b: i32, c: i32, bits: u8| ((a.max(b).max(c) - a.min(b).min(c)) << bits) as u32 >> (TEXTURE - 3);
        range(u0, u1, u2, width).max(range(v0, v1, v2, height)) + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texture of two by four texels with a palette of eight greys, which begins with texel 0 on the left of the first row.
    fn texture(palette: &[Colour; 8]) -> Sampler<'_> {
        let texture = MeshTexture { palette, texels: &[0, 1, 2, 3, 4, 5, 6, 7], size: [1, 2], has_holes: false, corners: &[] };
        let (sampler, _) = Sampler::new(texture, false);
        sampler
    }

    #[test]
    fn texels_are_found_by_rows_and_repeat() {
        let palette = core::array::from_fn(|k| Colour::new([k as u8; 3]));
        let at = |u: f64, v: f64| {
            let place = [u, v].map(|c| (c * f64::from(1u32 << WALKED)) as i64 as u32);
            let texture = texture(&palette);
            let Colour { channels: [red, ..], .. } = texture.texel(Sampler::aligned(place));
            red
        };
        assert_eq!([at(0.0, 0.0), at(0.6, 0.0), at(0.0, 0.3), at(0.99, 0.99)], [0, 1, 2, 7]);
        assert_eq!([at(3.6, 15.0), at(-0.1, -0.1), at(1.0, 2.5)], [1, 7, 4]);
    }

    #[test]
    fn ranges_are_in_eighths_of_texels() {
        let palette = [Colour::new([0; 3]); 8];
        assert_eq!(texture(&palette).range(&[[0, 0], [1 << 12, 0], [0, 1 << 11]]), 17);
        assert_eq!(texture(&palette).range(&[[0; 2], [0, 0xFFFF], [0; 2]]), 512);
    }
}
