//! Facets with a texture.
//!
//! At each point such a facet is shaded like one whose colour is everywhere that of the texel which is seen there. Light at nodes is not clamped, because
//! the core multiplies it by texels only at the pixel.

use super::{Facet, Frame, Levels, Shade, frame::mixed};
use microphong::{
    Stream,
    stream::{MeshTexture, record},
};
use microphong_models::vector::V3;
use std::sync::Arc;

/// A texture, and where a facet lies in it.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Places of the corners, in widths and heights.
    places: [[f64; 2]; 3],
    /// Weight of each corner's share of the screen in space.
    shares: V3,
    /// Width and height in texels.
    size: [usize; 2],
    /// Row by row from the top.
    texels: Arc<[V3]>,
}

impl Texture {
    /// The texture of a triangle of a mesh, whose corners in the order `turn` of the record have this inverse depth; `None` if the mesh has none.
    pub(super) fn of(stream: Stream<'_>, mesh: &record::Mesh, id: u32, turn: [usize; 3], inv_depth: V3) -> Option<Self> {
        let MeshTexture { palette, texels, size, corners, .. } = stream.texture_of(mesh)?;
        let record::TextureCorners(corners) = corners[(id - mesh.first_triangle) as usize];
        Some(Self {
            places: turn.map(|corner| corners[corner].map(|c| f64::from(c) / 4096.0)),
            shares: if stream.is_perspective() { inv_depth } else { [1.0; 3] },
            size: size.map(|bits| 1 << bits),
            texels: texels.iter().map(|&texel| palette[usize::from(texel)].channels.map(|c| f64::from(c) / 255.0)).collect(),
        })
    }

    /// The colour at a place in texels.
    fn at(&self, place: [f64; 2]) -> V3 {
        let [column, row] = [0, 1].map(|k| (place[k].floor() as i64).rem_euclid(self.size[k] as i64) as usize);
        self.texels[row * self.size[0] + column]
    }
}

impl Facet {
    /// The place in the texture, in texels, that is seen at a point of the screen.
    fn place(&self, texture: &Texture, p: [f64; 2]) -> [f64; 2] {
        let flat = self.flat_weights(p);
        let parts = [0, 1, 2].map(|k| flat[k] * texture.shares[k]);
        let whole: f64 = parts.iter().sum();
        let at = |k: usize| mixed(&texture.places.map(|place| [place[k], 0.0, 0.0]), parts.map(|part| part / whole))[0];
        [0, 1].map(|k| at(k) * texture.size[k] as f64)
    }

    /// This facet in each of the colours that texels have within `margin` texels of the place that is seen at a point of the screen, the texel there
    /// first; none if it has no texture.
    #[must_use]
    pub fn within(&self, p: [f64; 2], margin: f64) -> Vec<Self> {
        let Some(texture) = &self.texture else { return Vec::new() };
        let [x, y] = self.place(texture, p);
        let beside = [0.0, -margin, margin];
        let mut colours: Vec<V3> = Vec::new();
        for colour in beside.iter().flat_map(|dx| beside.map(|dy| texture.at([x + dx, y + dy]))) {
            if !colours.contains(&colour) {
                colours.push(colour);
            }
        }
        let plain = |colour: V3| Texture { size: [1; 2], texels: Arc::new([colour]), ..texture.clone() };
        colours.into_iter().map(|colour| Self { texture: Some(plain(colour)), ..self.clone() }).collect()
    }
}

/// Shades a facet with a texture by the shading of facets without.
pub(super) fn painted<'f>(facet: &'f Facet, texture: &'f Texture, shade: impl Fn(&Facet, [f64; 2]) -> Levels + 'f) -> Shade<'f> {
    Box::new(move |p| {
        let colour = texture.at(facet.place(texture, p));
        let facet = Facet { texture: None, albedos: Some([colour; 3]), is_painted: true, ..facet.clone() };
        shade(&facet, p).map(|level| level.clamp(0.0, 255.0))
    })
}

/// Shades a facet with a texture by a method that does not tell highlights from other light: it multiplies all of it.
pub(super) fn painted_whole<'f>(
    frame: &'f Frame,
    facet: &'f Facet,
    texture: &'f Texture,
    shade: impl Fn(&Facet, [f64; 2]) -> Levels + 'f,
) -> Shade<'f> {
    let white = Facet { texture: None, albedos: Some([[1.0; 3]; 3]), ..facet.clone() };
    Box::new(move |p| {
        let (colour, levels) = (frame.shown(texture.at(facet.place(texture, p))), shade(&white, p));
        [0, 1, 2].map(|k| colour[k] * levels[k])
    })
}
