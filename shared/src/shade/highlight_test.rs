//! Phong shading where a highlight can be, Gouraud shading elsewhere.
//!
//! N·H is linear under constant light, and no interpolated normal is shorter than rho: N·H over |N| is at most the
//! largest of the corners over rho. Where that stays below the cosine whose power is taken as 0, for each light,
//! only diffuse light is left, and it changes slowly. Near lights have no such bound at a fair price: Phong everywhere.
//!
//! Cost: three comparisons a triangle and light, then that of [`super::gouraud`] or [`super::phong`]. Not continuous where
//! the two meet. Error against Phong: Gouraud's of diffuse light. Domain: any lights.

use super::{Facet, Shading, gouraud, phong};
use crate::{
    band::Band,
    pixel::Pixel,
    scene::{Source, cosine},
};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    if !is_dark(facet, shading) {
        return phong::draw(facet, shading, band);
    }
    if shading.constant.is_none() {
        return gouraud::draw(facet, shading, band);
    }
    let levels = || facet.corners.map(|corner| shading.palette.one_light([corner.light[0], corner.light[1]]));
    gouraud::draw_levels(levels, facet, shading, band)
}

/// No light's highlight reaches a visible level anywhere on the triangle.
fn is_dark<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>) -> bool {
    if shading.constant.is_some() {
        return facet.is_dark(shading.palette);
    }
    let limit = facet.dark_below(shading.palette);
    let corners = facet.corner_nodes();
    shading.lighting.is_constant()
        && shading.lighting.sources.iter().all(|source| match *source {
            Source::Directional { half, .. } => corners.iter().all(|corner| cosine(corner.normal, half) < limit),
            Source::Point(_) => false,
        })
}
