//! The triangles of a mesh, of which every point has a colour by the file.

use super::split::Part;
use crate::{
    coat::{self, Place},
    mesh::{Mesh, Soup, Source},
    texture::{Image, Texture},
    vector::V3,
};
use std::collections::HashMap;

/// A triangle may lie over fewer than this many repetitions of its texture.
pub(super) const REPEATS: f64 = 16.0;

/// A triangle of which every point has a colour.
#[derive(Clone, Copy)]
pub(super) struct Facet<'a> {
    /// The colours of the corners, by which the texture is multiplied.
    pub(super) corners: [V3; 3],
    /// Whether they are white, so that the texture has all of the colour.
    pub(super) is_white: bool,
    /// The image of the texture, and the places of the corners on it.
    pub(super) texture: Option<(&'a Image, [[f64; 2]; 3])>,
}

impl Facet<'_> {
    /// The colour at a point, which has these shares of the corners.
    pub(super) fn at(&self, [p, q, r]: [f64; 3]) -> V3 {
        let Some((image, places)) = self.texture else { return mixed(&self.corners, [p, q, r]) };
        let texel = image.at(between(&places, [p, q, r]));
        if self.is_white {
            return texel;
        }
        let own = mixed(&self.corners, [p, q, r]);
        [own[0] * texel[0], own[1] * texel[1], own[2] * texel[2]]
    }

    /// Whether the texture has a hole at a point, which has these shares of the corners.
    pub(super) fn is_hole_at(&self, shares: [f64; 3]) -> bool {
        self.texture.is_some_and(|(image, places)| image.is_hole_at(between(&places, shares)))
    }

    /// The places of the corners in its texture as a stream has them; `None` if it has no texture, or the texture repeats itself too often.
    pub(super) fn places(&self) -> Option<[Place; 3]> {
        let (_, corners) = self.texture?;
        let reaches_far = |axis: usize| corners.iter().any(|corner| (corner[axis] - corners[0][axis]).abs() >= REPEATS);
        let places = corners.map(coat::place);
        (!reaches_far(0) && !reaches_far(1) && coat::texture_corners(places).is_some()).then_some(places)
    }

    /// The part of the triangle whose corners have these shares of its corners.
    pub(super) fn part(&self, corners: &Part) -> Self {
        let place = |places: &[[f64; 2]; 3], shares: [f64; 3]| [0, 1].map(|axis| (0..3).map(|k| places[k][axis] * shares[k]).sum());
        Facet {
            corners: corners.map(|shares| mixed(&self.corners, shares)),
            texture: self.texture.map(|(texture, places)| (texture, corners.map(|shares| place(&places, shares)))),
            ..*self
        }
    }
}

/// The place at a point of a triangle between its corners. It is called for many points.
fn between([a, b, c]: &[[f64; 2]; 3], [p, q, r]: [f64; 3]) -> [f64; 2] {
    [a[0] * p + b[0] * q + c[0] * r, a[1] * p + b[1] * q + c[1] * r]
}

/// The colour at a point of a triangle between its corners. It is called for many points.
pub(super) fn mixed([a, b, c]: &[V3; 3], [p, q, r]: [f64; 3]) -> V3 {
    [a[0] * p + b[0] * q + c[0] * r, a[1] * p + b[1] * q + c[1] * r, a[2] * p + b[2] * q + c[2] * r]
}

/// The triangles of a mesh, as the soup colours them.
#[derive(Clone)]
pub(super) struct Facets<'a> {
    pub(super) soup: &'a Soup,
    /// The textures of materials.
    pub(super) textures: &'a [Option<Texture>],
    /// For each triangle of the mesh, or for the triangle that it was split from.
    pub(super) sources: Vec<[Source; 3]>,
    /// Triangles that are parts of the ones that they were split from.
    pub(super) parts: HashMap<usize, Part>,
}

impl<'a> Facets<'a> {
    /// The colours of a triangle; `None` if it has neither a texture nor colours at its corners.
    pub(super) fn of(&self, mesh: &Mesh, triangle: usize) -> Option<Facet<'a>> {
        let [a, b, c] = *self.sources.get(triangle)?;
        let colour = |source: Source| Some(self.soup.colours[source.colour? as usize]);
        let texture = self.textures.get(mesh.submesh(triangle).material).and_then(Option::as_ref).and_then(|texture| {
            let place = |source: Source| Some(texture.place(self.soup.places[source.place? as usize]));
            Some((&*texture.image, [place(a)?, place(b)?, place(c)?]))
        });
        let corners = colour(a).zip(colour(b)).zip(colour(c)).map(|((a, b), c)| [a, b, c]);
        if corners.is_none() && texture.is_none() {
            return None;
        }
        let corners = corners.unwrap_or([[1.0; 3]; 3]);
        let facet = Facet { is_white: corners == [[1.0; 3]; 3], corners, texture };
        match self.parts.is_empty() {
            true => Some(facet),
            false => Some(self.parts.get(&triangle).map_or(facet, |part| facet.part(part))),
        }
    }
}
