//! The six-point quadratic (Szirmay-Kalos et al.; Vlasic 2002, 4.2): lit at the
//! corners and at the edges' midpoints, quadratic in between.
//!
//! Cost: two additions a pixel and channel. Continuous: both neighbours light the
//! same midpoint. Good for wide highlights or fine meshes; a highlight narrower
//! than a triangle is flattened.

use super::{Facet, Shading};
use crate::{
    band::Band,
    format::EDGE,
    math::vector::{add, wide},
    palette::Palette,
    pixel::Pixel,
    poly::quadric::Quadric,
    stream::record::Vertex,
};

/// Levels of a node are in [0, 255] in Q9.7.
const BITS: u32 = 15;

pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let palette = shading.palette;
    if !palette.three_channels {
        let nodes = match shading.constant {
            Some(_) => constant(facet, palette, |cosines| palette.level(cosines)),
            None => lit(facet, shading).map(|[level, ..]| level),
        };
        let patch = Quadric::fit::<BITS>(&facet.basis, [nodes], super::EXTRA);
        shading.draw_one(facet, patch, Quadric::raised, band)
    } else {
        let nodes = match shading.constant {
            Some(_) => constant(facet, palette, |cosines| palette.levels(core::iter::once(cosines))),
            None => lit(facet, shading),
        };
        let nodes = [nodes.map(|[r, ..]| r), nodes.map(|[_, g, _]| g), nodes.map(|[.., b]| b)];
        let patch = Quadric::fit::<BITS>(&facet.basis, nodes, super::EXTRA);
        shading.draw_three(facet, patch, Quadric::raised, band)
    }
}

/// Six nodes under one constant light: cosines at midpoints follow from those at the corners.
#[inline(always)]
fn constant<C: Pixel, N>(facet: &Facet<'_>, palette: &Palette<C>, light: impl Fn([i32; 2]) -> N) -> [N; 6] {
    let [a, b, c] = facet.corners.map(|corner| corner.light);
    let highest = a[1].max(b[1]).max(c[1]);
    // N·H is linear and |N| at least rho: nowhere on the triangle does the highlight reach a visible level.
    let limit = (i64::from(palette.dark_below()) * i64::from(facet.triangle.rho)) >> EDGE;
    let dark = i64::from(highest) < limit;
    let node = |light_cosine: i32, half: i32| light([light_cosine, if dark { i32::MIN } else { half }]);
    let middle = |a: [i32; 3], b: [i32; 3], rsum: u16| {
        let cosine = |a: i32, b: i32| (((i64::from(a) + i64::from(b)) * i64::from(rsum)) >> EDGE) as i32;
        node(cosine(a[0], b[0]), cosine(a[1], b[1]))
    };
    let [ab, bc, ca] = facet.rsum;
    [node(a[0], a[1]), node(b[0], b[1]), node(c[0], c[1]), middle(a, b, ab), middle(b, c, bc), middle(c, a, ca)]
}

/// Node levels under any lights: corners are lit already, midpoints are lit here.
fn lit<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>) -> [[i32; 3]; 6] {
    let [a, b, c] = facet.corners.map(|corner| corner.light);
    let [u, v, w] = facet.vertices;
    let middle = |a: &Vertex, b: &Vertex, rsum: u16| {
        let position = add(wide(a.position), wide(b.position)).map(|c| c >> 1);
        let normal = add(wide(a.normal), wide(b.normal));
        shading.palette.levels(shading.lighting.cosines(position, normal, rsum))
    };
    let [uv, vw, wu] = facet.rsum;
    [a, b, c, middle(u, v, uv), middle(v, w, vw), middle(w, u, wu)]
}
