//! The colours at the corners of the triangles of one mesh.

use crate::{
    features::COLOURED,
    lighting::albedo::{Albedo, IfColoured},
    raster::triangle::turn,
    stream::{MeshColours, Stream, record::Mesh},
};
use core::array::from_fn;

/// The colours of a mesh, if it has any.
#[derive(Clone, Copy)]
pub(crate) struct Painting<'f>(IfColoured<Option<(MeshColours<'f>, bool)>>);

/// The colours at the corners of a triangle, if it has any.
pub(crate) type Corners = IfColoured<Option<[Albedo; 3]>>;

/// A triangle without colours.
const NONE: Corners = [None; COLOURED];

impl<'f> Painting<'f> {
    /// The colours of `mesh`. Pixel formats of greys take their luma.
    pub(crate) fn of(stream: &Stream<'f>, mesh: &Mesh, is_gray: bool) -> Self {
        Self([(); COLOURED].map(|()| stream.colours_of(mesh).map(|colours| (colours, is_gray))))
    }

    /// The colours at the corners of the triangle of this index, clockwise on the screen, which is against the order of the stream, and turned by `by`.
    #[inline(always)]
    pub(super) fn corners(&self, triangle: impl Fn() -> Option<usize>, by: usize) -> Corners {
        // Not by `map`, which goes through memory at opt-level "s".
        let mut corners = NONE;
        if let (Some(corners), Some(Some((colours, is_gray)))) = (corners.first_mut(), self.0.first()) {
            *corners = triangle().and_then(|triangle| albedos(colours, *is_gray, triangle, by));
        }
        corners
    }
}

#[inline(always)]
fn albedos(MeshColours { palette, corners }: &MeshColours<'_>, is_gray: bool, triangle: usize, by: usize) -> Option<[Albedo; 3]> {
    let [a, c, b] = corners.get(triangle)?.colours;
    let [i, j, k] = turn([a, b, c], by);
    let colour = |index: u8| palette.get(usize::from(index)).copied();
    Some(Albedo::all([colour(i)?, colour(j)?, colour(k)?], is_gray))
}

/// Colours in the order of corners that are turned by `by`.
pub(super) fn turned(mut corners: Corners, by: usize) -> Corners {
    if let Some(Some(albedos)) = corners.first_mut() {
        *albedos = turn(*albedos, by);
    }
    corners
}

/// The shares of each channel at the corners; black if they have no colours.
pub(super) fn shares(corners: &Corners) -> IfColoured<[[i32; 3]; 3]> {
    corners.map(|albedos| albedos.map_or([[0; 3]; 3], |albedos| albedos.map(Albedo::shares)))
}

/// The colours of these shares, if the triangle has `corners` with colours.
pub(super) fn of_shares(corners: &Corners, [a, b, c]: [IfColoured<[i32; 3]>; 3]) -> Corners {
    from_fn(|k| corners[k].map(|_| [a[k], b[k], c[k]].map(Albedo::of_shares)))
}

/// References to what may be there.
#[inline(always)]
pub(super) fn lent(corners: &Corners) -> IfColoured<Option<&[Albedo; 3]>> {
    [corners.first().and_then(Option::as_ref); COLOURED]
}
