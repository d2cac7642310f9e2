//! Facets with a texture.
//!
//! At each point such a facet is shaded like one whose colour is everywhere that of the texel which is seen there. Light at nodes is not clamped, because
//! the core multiplies it by texels only at the pixel.
//!
//! A texel can be a hole, where the facet covers nothing. The core rounds places in a texture, so that a pixel near the border of a texel may show
//! another one. There a facet may cover a pixel at which the exact place is a hole. It then has the colour of a texel beside the hole.

use super::{Facet, Frame, Levels, Shade, frame::mixed, visible::Certainty};
use microphong::{
    Stream,
    stream::{MeshTexture, record},
};
use microphong_models::vector::V3;
use std::sync::Arc;

/// How far a place in a texture may be off, in texels: a quarter by its interpolation on the screen, and the rest by the arithmetic of large and thin
/// triangles.
const BESIDE: f64 = 0.5;

/// A texture, and where a facet lies in it.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Places of the corners, in widths and heights.
    places: [[f64; 2]; 3],
    /// Weight of each corner's share of the screen in space.
    shares: V3,
    /// Width and height in texels.
    size: [usize; 2],
    /// Row by row from the top; `None` is a hole.
    texels: Arc<[Option<V3>]>,
    /// Whether one of them may be a hole.
    has_holes: bool,
}

impl Texture {
    /// The texture of a triangle of a mesh, whose corners in the order `turn` of the record have this inverse depth; `None` if the mesh has none.
    pub(super) fn of(stream: Stream<'_>, mesh: &record::Mesh, id: u32, turn: [usize; 3], inv_depth: V3) -> Option<Self> {
        let MeshTexture { palette, texels, size, has_holes, corners } = stream.texture_of(mesh)?;
        let record::TextureCorners(corners) = corners[(id - mesh.first_triangle) as usize];
        let shown = |colour: &record::Colour| (colour.hole == 0).then(|| colour.channels.map(|c| f64::from(c) / 255.0));
        Some(Self {
            places: turn.map(|corner| corners[corner].map(|c| f64::from(c) / 4096.0)),
            shares: if stream.is_perspective() { inv_depth } else { [1.0; 3] },
            size: size.map(|bits| 1 << bits),
            texels: texels.iter().map(|&texel| shown(&palette[usize::from(texel)])).collect(),
            has_holes,
        })
    }

    /// The texel at a place in texels; `None` is a hole.
    fn at(&self, place: [f64; 2]) -> Option<V3> {
        let [column, row] = [0, 1].map(|k| (place[k].floor() as i64).rem_euclid(self.size[k] as i64) as usize);
        self.texels[row * self.size[0] + column]
    }

    /// The texel at a place in texels, and then those that rounding may take for it.
    fn near(&self, [x, y]: [f64; 2]) -> impl Iterator<Item = Option<V3>> {
        let beside = [0.0, -BESIDE, BESIDE];
        beside.into_iter().flat_map(move |dx| beside.map(|dy| self.at([x + dx, y + dy])))
    }

    /// The colour at a place in texels. In a hole it is that of a texel which rounding may take for it, and black if all of these are holes.
    fn colour(&self, place: [f64; 2]) -> V3 {
        self.near(place).flatten().next().unwrap_or_default()
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

    /// Whether the facet covers a point of the screen within its edges, or has a hole there.
    pub(super) fn covers(&self, p: [f64; 2]) -> Certainty {
        let Some(texture) = self.texture.as_ref().filter(|texture| texture.has_holes) else { return Certainty::Always };
        let mut is_covered = texture.near(self.place(texture, p)).map(|texel| texel.is_some());
        let exactly = is_covered.next() == Some(true);
        Certainty::of(exactly, is_covered.any(|other| other != exactly))
    }

    /// This facet in each of the colours that the texel which is seen at a point of the screen may have, the exact one first; the facet itself if it
    /// has no texture.
    #[must_use]
    pub fn within(&self, p: [f64; 2]) -> Vec<Self> {
        let Some(texture) = &self.texture else { return vec![self.clone()] };
        let mut colours: Vec<V3> = Vec::new();
        for colour in texture.near(self.place(texture, p)).flatten() {
            if !colours.contains(&colour) {
                colours.push(colour);
            }
        }
        let plain = |colour: V3| Texture { size: [1; 2], texels: Arc::new([Some(colour)]), ..texture.clone() };
        colours.into_iter().map(|colour| Self { texture: Some(plain(colour)), ..self.clone() }).collect()
    }
}

/// Shades a facet with a texture by the shading of facets without.
pub(super) fn painted<'f>(facet: &'f Facet, texture: &'f Texture, shade: impl Fn(&Facet, [f64; 2]) -> Levels + 'f) -> Shade<'f> {
    Box::new(move |p| {
        let colour = texture.colour(facet.place(texture, p));
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
        let (colour, levels) = (frame.shown(texture.colour(facet.place(texture, p))), shade(&white, p));
        [0, 1, 2].map(|k| colour[k] * levels[k])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Material, Place, phong};

    const RED: V3 = [1.0, 0.0, 0.0];

    /// A triangle over 16 x 16 pixels with a texture of four columns, the two in the middle red and the others holes, and behind it a plate.
    fn frame(has_plate: bool) -> Frame {
        let screen = [[0.0, 0.0], [32.0, 0.0], [0.0, 32.0]];
        let facet =
            |inv_depth: f64| Facet { inv_depth: [inv_depth; 3], ..Facet::new(screen, [0, 1, 2], [[0.0, 0.0, 1.0]; 3], [[0.0; 3]; 3]) };
        let texels = Arc::new([None, Some(RED), Some(RED), None]);
        let texture = Texture { places: [[0.0; 2], [2.0, 0.0], [0.0, 2.0]], shares: [1.0; 3], size: [4, 1], texels, has_holes: true };
        let pierced = Facet { texture: Some(texture), ..facet(0.5) };
        Frame {
            size: (16, 16),
            facets: [pierced].into_iter().chain(has_plate.then(|| facet(0.25))).collect(),
            lights: Vec::new(),
            viewer: Place::Far([0.0, 0.0, 1.0]),
            axes: Facet::CORNERS,
            materials: vec![Material { ambient: [0.5; 3], diffuse: [0.0; 3], specular: [0.0; 3], exponent: 1.0 }],
            background: [[0.0; 3]; 2],
            is_gray: false,
        }
    }

    /// Holes show what is behind them. Within half a texel of their borders, which are two pixels here, both may be seen, what is exact first.
    #[test]
    fn holes_show_what_is_behind_them() {
        for has_plate in [true, false] {
            let visible = frame(has_plate).visible();
            let (red, behind) = (vec![0], if has_plate { vec![1] } else { Vec::new() });
            let expected = |x: usize| match x {
                0..2 | 14.. => vec![behind.clone()],
                2..4 | 12..14 => vec![behind.clone(), red.clone()],
                4..6 | 10..12 => vec![red.clone(), behind.clone()],
                _ => vec![red.clone()],
            };
            for (k, sights) in visible.iter().enumerate() {
                assert_eq!(*sights, expected(k % 16), "column {}", k % 16);
            }
        }
    }

    /// Where a facet covers a pixel only if its place is rounded, it has the colour of the texel beside the hole, and no other.
    #[test]
    fn facets_have_no_colour_of_holes() {
        let frame = frame(false);
        let facet = &frame.facets[0];
        for x in 2..14 {
            let centre = [f64::from(x) + 0.5, 3.5];
            assert_eq!(phong(&frame, facet)(centre), [127.5, 0.0, 0.0], "column {x}");
            assert_eq!(facet.within(centre).len(), 1, "column {x}");
        }
        assert!(facet.within([0.5, 3.5]).is_empty());
    }
}
