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
    let [a, b, c] = facet.vertices;
    let centroid = add(wide(a.position), add(wide(b.position), wide(c.position)));
    let [x, y, z] = wide(facet.triangle.normal);
    let normal = [x << (30 - UNIT), y << (30 - UNIT), z << (30 - UNIT)];
    let levels = shading.levels(&Node { position: [centroid[0] / 3, centroid[1] / 3, centroid[2] / 3], normal });
    if shading.dither {
        // A field without slope: dither changes from pixel to pixel all the same.
        shading.draw_levels::<3, RANGE>(facet, [levels; 3], band)
    } else {
        facet.fill(Constant, Solid(shading.palette.colour(levels)), band)
    }
}
