//! N·L and N·H by their Taylor quadratics about the centroid, near lights and viewer included (Bishop & Weimer 1986,
//! finite eye).
//!
//! The directions L, and L + V for H, are linear between the corners; the rest is [`super::taylor`]'s. The centroid's |L|
//! counts as 1/16 at least, and |L + V| as 1/8.
//!
//! Cost and error as there, and those of directions that are not linear: useless on coarse meshes with near lights.
//! Domain: any lights.

use super::{
    Facet, Shading,
    taylor::{self, Series, VECTOR},
};
use crate::{
    band::Band,
    format::COSINE,
    math::vector::{add, wide},
    pixel::Pixel,
};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let positions = facet.vertices().map(|vertex| wide(vertex.position));
    let shortened = |v: [i32; 3], bits: u32| v.map(|c| c >> (COSINE - VECTOR + bits));
    let viewer = positions.map(|position| shortened(shading.lighting.viewer.towards(position), 1));
    taylor::draw_by(facet, shading, band, |source| {
        let towards = positions.map(|position| source.towards(position));
        let ([a, b, c], [va, vb, vc]) = (towards.map(|towards| shortened(towards, 1)), viewer);
        [Series::new(towards.map(|towards| shortened(towards, 0))), Series::new([add(a, va), add(b, vb), add(c, vc)])]
    })
}
