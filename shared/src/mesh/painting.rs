//! The colours of the triangles of one mesh: at their corners, or by a texture.
//!
//! A triangle with a texture has white corners, and so light is computed as for other colours. The texture colours the ambient and diffuse part of it at
//! each pixel.

use crate::{
    features::{COLOURED, TEXTURED},
    geometry::clip::Attributes,
    lighting::{
        albedo::{Albedo, IfColoured},
        sampler::{IfTextured, Sampler, TextureCoordinates, Textured},
    },
    raster::triangle::turn,
    stream::{
        MeshColours, Stream,
        record::{Colour, Mesh, TextureCorners},
    },
};
use core::array::from_fn;

/// The colours of a mesh, if it has any.
#[derive(Clone, Copy)]
pub(crate) struct Painting<'f> {
    colours: IfColoured<Option<(MeshColours<'f>, bool)>>,
    /// The texture, where the triangles lie in it, and whether the camera is a perspective one.
    texture: IfTextured<Option<(Sampler<'f>, &'f [TextureCorners], bool)>>,
}

/// The colours of a triangle, if it has any. Corners run clockwise on the screen, which is against the order of the stream.
#[derive(Clone, Copy)]
pub(crate) struct Paint {
    albedos: IfColoured<Option<[Albedo; 3]>>,
    places: IfTextured<Option<[TextureCoordinates; 3]>>,
}

impl<'f> Painting<'f> {
    /// The colours of `mesh`. Pixel formats of greys take their luma.
    pub(crate) fn of(stream: &Stream<'f>, mesh: &Mesh, is_gray: bool, in_perspective: impl Fn() -> bool) -> Self {
        Self {
            colours: [(); COLOURED].map(|()| stream.colours_of(mesh).map(|colours| (colours, is_gray))),
            texture: [(); TEXTURED].map(|()| {
                let (sampler, corners) = Sampler::new(stream.texture_of(mesh)?, is_gray);
                Some((sampler, corners, in_perspective()))
            }),
        }
    }

    /// Whether the mesh has a texture.
    pub(super) fn has_texture(&self) -> bool {
        self.texture.iter().any(Option::is_some)
    }

    /// The colours of the triangle of this index, whose corners are turned by `by`.
    #[inline(always)]
    pub(super) fn corners(&self, triangle: impl Fn() -> Option<usize>, by: usize) -> Paint {
        // Not by `map`, which goes through memory at opt-level "s".
        let mut paint = Paint { albedos: [None; COLOURED], places: [None; TEXTURED] };
        if let (Some(albedos), Some(Some((colours, is_gray)))) = (paint.albedos.first_mut(), self.colours.first())
            && let Some(triangle) = triangle()
            && let Some(corners) = corner_colours(colours, triangle, by)
        {
            *albedos = Some(Albedo::all(corners, *is_gray));
        }
        if let (Some(albedos), Some(places), Some(Some((_, corners, _)))) =
            (paint.albedos.first_mut(), paint.places.first_mut(), self.texture.first())
        {
            *albedos = Some([Albedo::WHITE; 3]);
            *places = triangle().and_then(|triangle| places_at(corners.get(triangle)?, by));
        }
        paint
    }

    /// The texture of a triangle with these colours, if it has one.
    #[inline(always)]
    pub(super) fn texture<'s>(&'s self, paint: &Paint) -> IfTextured<Option<Textured<'s>>> {
        from_fn(|k| {
            let (Some((sampler, _, in_perspective)), Some(places)) = (&self.texture[k], paint.places[k]) else { return None };
            Some(Textured { sampler, places, in_perspective: *in_perspective })
        })
    }
}

#[inline(always)]
fn corner_colours(MeshColours { palette, corners }: &MeshColours<'_>, triangle: usize, by: usize) -> Option<[Colour; 3]> {
    let [a, c, b] = corners.get(triangle)?.colours;
    let [i, j, k] = turn([a, b, c], by);
    let colour = |index: u8| palette.get(usize::from(index)).copied();
    Some([colour(i)?, colour(j)?, colour(k)?])
}

fn places_at(&TextureCorners([a, c, b]): &TextureCorners, by: usize) -> Option<[TextureCoordinates; 3]> {
    let [a, b, c] = turn([a, b, c], by);
    let wide = |[u, v]: [u16; 2]| [u.into(), v.into()];
    Some([wide(a), wide(b), wide(c)])
}

impl Paint {
    /// The colours where corners are turned by `by`.
    pub(super) fn turned(mut self, by: usize) -> Self {
        if let Some(Some(albedos)) = self.albedos.first_mut() {
            *albedos = turn(*albedos, by);
        }
        if let Some(Some(places)) = self.places.first_mut() {
            *places = turn(*places, by);
        }
        self
    }

    /// What is interpolated where the triangle is clipped: the place in its texture, or the shares of each channel; zero if it has no colours.
    pub(super) fn attributes(&self) -> IfColoured<[[i32; 3]; 3]> {
        if let Some(Some(places)) = self.places.first() {
            return [places.map(|[u, v]| [u, v, 0]); COLOURED];
        }
        self.albedos.map(|albedos| albedos.map_or([[0; 3]; 3], |albedos| albedos.map(Albedo::shares)))
    }

    /// The colours of a part of the triangle, at whose corners [`Self::attributes`] are these.
    pub(super) fn of_part(&self, [a, b, c]: [Attributes; 3]) -> Self {
        if let Some(Some(places)) = self.places.first() {
            let part: IfColoured<[TextureCoordinates; 3]> = from_fn(|k| [a[k], b[k], c[k]].map(|[u, v, _]| [u, v]));
            return Self { places: [Some(part.first().copied().unwrap_or(*places)); TEXTURED], ..*self };
        }
        Self { albedos: from_fn(|k| self.albedos[k].map(|_| [a[k], b[k], c[k]].map(Albedo::of_shares))), ..*self }
    }

    /// References to the colours of corners.
    #[inline(always)]
    pub(super) fn lent(&self) -> IfColoured<Option<&[Albedo; 3]>> {
        [self.albedos.first().and_then(Option::as_ref); COLOURED]
    }
}
