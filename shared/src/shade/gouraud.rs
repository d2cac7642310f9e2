//! Gouraud shading (Gouraud 1971): lit at the corners, linear in between.
//!
//! Cost: one addition a pixel and channel. Continuous. Error against Phong: at
//! most 255 ks n (1 - c)/(1 + 2c) for the highlight and 255 kd 1.165 (1 - c)/(1 + 2c)
//! for diffuse light, c the smallest cosine between two corners' normals.

#[cfg(feature = "fast-loops")]
use super::Method;
use super::{Facet, RANGE, Shading};
use crate::{band::Band, pixel::Pixel};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let [a, b, c] = facet.corners;
    draw_levels(|| [a.light, b.light, c.light], facet, shading, band)
}

/// Under one light, on one channel.
#[cfg(feature = "fast-loops")]
pub(crate) struct Plain;

#[cfg(feature = "fast-loops")]
impl Method for Plain {
    #[inline(always)]
    fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> Option<u32> {
        let [a, b, c] = facet.corners;
        Some(shading.draw_plain::<3, RANGE>(facet, || [a.light[0], b.light[0], c.light[0]], band))
    }
}

/// Draws `facet` from the levels at its corners.
#[inline(always)]
pub(super) fn draw_levels<C: Pixel>(
    levels: impl FnOnce() -> [[i32; 3]; 3],
    facet: &Facet<'_>,
    shading: &Shading<'_, C>,
    band: &mut Band<'_, C>,
) -> u32 {
    shading.draw_levels::<3, RANGE>(facet, levels, band)
}
