//! Gouraud shading (Gouraud 1971): lit at the corners, linear in between.
//!
//! Cost: one addition a pixel and channel. Continuous. Error against Phong: at
//! most 255 ks n (1 - c)/(1 + 2c) for the highlight and 255 kd 1.165 (1 - c)/(1 + 2c)
//! for diffuse light, c the smallest cosine between two corners' normals.

use super::{Facet, Shading};
use crate::{band::Band, math::vector::transposed, pixel::Pixel, poly::plane::Plane};

pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let levels = transposed(facet.corners.map(|corner| shading.corner_levels(corner)));
    if !shading.palette.three_channels {
        shading.draw_one(facet, Plane::fit(&facet.basis, [levels[0]], super::EXTRA), Plane::raised, band)
    } else {
        shading.draw_three(facet, Plane::fit(&facet.basis, levels, super::EXTRA), Plane::raised, band)
    }
}
