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

impl<'f> Painting<'f> {
    /// The colours of `mesh`. Pixel formats of greys take their luma.
    pub(crate) fn of(stream: &Stream<'f>, mesh: &Mesh, is_gray: bool) -> Self {
        Self([(); COLOURED].map(|()| stream.colours_of(mesh).map(|colours| (colours, is_gray))))
    }

    /// The colours at the corners of the triangle of this index, clockwise on the screen, which is against the order of the stream.
    #[inline(always)]
    pub(super) fn corners(&self, triangle: impl Fn() -> Option<usize>) -> Corners {
        self.0.map(|colours| {
            let (MeshColours { palette, corners }, is_gray) = colours?;
            let [a, c, b] = corners.get(triangle()?)?.colours;
            let albedo = |index: u8| palette.get(usize::from(index)).map(|&colour| Albedo::new(colour, is_gray));
            Some([albedo(a)?, albedo(b)?, albedo(c)?])
        })
    }
}

/// Colours in the order of corners that are turned by `by`.
#[inline(always)]
pub(super) fn turned(corners: Corners, by: usize) -> Corners {
    corners.map(|albedos| albedos.map(|albedos| turn(albedos, by)))
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
    corners.each_ref().map(Option::as_ref)
}
