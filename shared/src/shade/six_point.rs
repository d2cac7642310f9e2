//! The six-point quadratic (Szirmay-Kalos et al.; Vlasic 2002, 4.2): lit at the
//! corners and at the edges' midpoints, quadratic in between.
//!
//! Cost: two additions a pixel and channel. Continuous: both neighbours light the
//! same midpoint. Good for wide highlights or fine meshes; a highlight narrower
//! than a triangle is flattened.

use super::{Facet, RANGE, Shading};
use crate::{band::Band, palette::Palette, pixel::Pixel};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let palette = shading.palette;
    if !palette.three_channels {
        let nodes = match shading.constant {
            Some(_) => constant(facet, palette, |cosines| palette.level(cosines)),
            None => lit(facet, shading).map(|[level, ..]| level),
        };
        shading.draw_one::<6, RANGE>(facet, nodes, band)
    } else {
        let nodes = match shading.constant {
            Some(_) => constant(facet, palette, |cosines| palette.levels(core::iter::once(cosines))),
            None => lit(facet, shading),
        };
        let nodes = [nodes.map(|[r, ..]| r), nodes.map(|[_, g, _]| g), nodes.map(|[.., b]| b)];
        shading.draw_three::<6, RANGE>(facet, nodes, band)
    }
}

/// Six nodes under one constant light.
#[inline(always)]
fn constant<C: Pixel, N>(facet: &Facet<'_>, palette: &Palette<C>, light: impl Fn([i32; 2]) -> N) -> [N; 6] {
    let dark = facet.is_dark(palette);
    facet.six_cosines().map(|[light_cosine, half]| light([light_cosine, if dark { i32::MIN } else { half }]))
}

/// Node levels under any lights: corners are lit already, midpoints are lit here.
fn lit<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>) -> [[i32; 3]; 6] {
    let [a, b, c] = facet.corners.map(|corner| corner.light);
    let [.., ab, bc, ca] = facet.six_nodes();
    [a, b, c, shading.levels(&ab), shading.levels(&bc), shading.levels(&ca)]
}
