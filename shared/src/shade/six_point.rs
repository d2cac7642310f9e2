//! The six-point quadratic (Szirmay-Kalos et al.; Vlasic 2002, 4.2): lit at the
//! corners and at the edges' midpoints, quadratic in between.
//!
//! Cost: two additions a pixel and channel. Continuous: both neighbours light the
//! same midpoint. Good for wide highlights or fine meshes; a highlight narrower
//! than a triangle is flattened.

#[cfg(feature = "fast-loops")]
use super::Method;
use super::{Facet, RANGE, Shading, node::zip_six};
use crate::{band::Band, palette::Palette, pixel::Pixel};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let palette = shading.palette;
    if !palette.three_channels {
        let nodes = || match shading.constant {
            Some(_) => one_level(facet, palette),
            None => lit(facet, shading).map(|[level, ..]| level),
        };
        shading.draw_one::<6, RANGE>(facet, nodes, band)
    } else {
        let nodes = || match shading.constant {
            Some(_) => zip_six(facet.six_cosines(0), facet.six_cosines(1), |l, h| palette.levels(core::iter::once([l, h]))),
            None => lit(facet, shading),
        };
        shading.draw_three::<6, RANGE>(facet, nodes, band)
    }
}

/// Under one light, on one channel.
#[cfg(feature = "fast-loops")]
pub(crate) struct Plain;

#[cfg(feature = "fast-loops")]
impl Method for Plain {
    #[inline(always)]
    fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> Option<u32> {
        Some(shading.draw_plain::<6, RANGE>(facet, || one_level(facet, shading.palette), band))
    }
}

/// Levels of a material of one channel at six nodes under one constant light.
#[inline(always)]
fn one_level<C: Pixel>(facet: &Facet<'_>, palette: &Palette<C>) -> [i32; 6] {
    let light = facet.six_cosines(0);
    if facet.is_dark(palette) { palette.six_matte(light) } else { palette.six(light, facet.six_cosines(1)) }
}

/// Node levels under any lights: corners are lit already, midpoints are lit here.
fn lit<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>) -> [[i32; 3]; 6] {
    let [a, b, c] = facet.corners.map(|corner| corner.light);
    let [.., ab, bc, ca] = facet.six_nodes();
    [a, b, c, shading.levels(&ab), shading.levels(&bc), shading.levels(&ca)]
}
