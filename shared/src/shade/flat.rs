//! Flat shading: one colour per triangle, lit at its centroid with the plane's normal.
//!
//! Cost: nothing per pixel; one evaluation of the lights per triangle. Not continuous across edges.

use super::{Facet, RANGE, Shading, node::Node};
use crate::{
    band::Band,
    format::UNIT,
    math::vector::{add, wide},
    pixel::Pixel,
    poly::Constant,
    tone::Solid,
};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let [a, b, c] = facet.vertices.map(|vertex| wide(vertex.position));
    let centroid = add(a, add(b, c)).map(|sum| sum / 3);
    let normal = wide(facet.triangle.normal).map(|c| c << (30 - UNIT));
    let levels = shading.levels(&Node { position: centroid, normal });
    if shading.dither {
        // A field without slope: dither changes from pixel to pixel all the same.
        shading.draw_levels::<3, RANGE>(facet, [levels; 3], band)
    } else {
        facet.outline.draw(facet.basis, Constant, Solid(shading.palette.colour(levels)), band)
    }
}
