//! Flat shading: one colour per triangle, lit at its centroid with the plane's normal.
//!
//! Cost: nothing per pixel; one evaluation of the lights per triangle. Not continuous across edges.

use super::{Facet, Shading, node::Node};
use crate::{
    band::Band,
    format::UNIT,
    math::vector::{add, wide},
    pixel::Pixel,
    poly::Constant,
    poly::plane::Plane,
    tone::{Dithered, Solid},
};

pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let [a, b, c] = facet.vertices.map(|vertex| wide(vertex.position));
    let centroid = add(a, add(b, c)).map(|sum| sum / 3);
    let normal = wide(facet.triangle.normal).map(|c| c << (30 - UNIT));
    let levels = shading.levels(&Node { position: centroid, normal });
    if shading.dither {
        // A field without slope: dither changes from pixel to pixel all the same.
        let nodes = levels.map(|level| [level; 3]);
        if !shading.palette.three_channels {
            let patch = Plane::fit(&facet.basis, [nodes[0]], super::EXTRA).raised(super::lift(0));
            facet.outline.draw(&facet.basis, patch, Dithered::new(shading.palette.base), band)
        } else {
            let patch = Plane::fit(&facet.basis, nodes, super::EXTRA).raised(super::lift(0));
            facet.outline.draw(&facet.basis, patch, Dithered::new(shading.palette.base), band)
        }
    } else {
        facet.outline.draw(&facet.basis, Constant, Solid(shading.palette.colour(levels)), band)
    }
}
