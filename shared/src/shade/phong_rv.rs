//! Per-pixel Phong shading with the reflected light (Phong 1975): highlights by R·V, R = 2(N·L)N - L.
//!
//! The exponent is a quarter of the half vector's, which gives highlights of the same width
//! where L, N and V lie in a plane; elsewhere they are rounder. Walks what [`super::phong`] walks.
//!
//! Cost: 6 additions and 2 roots, and for each light 6 additions, a root and 4 products. Domain: any lights and viewer.
//! Error against the half vector: that of the model.

use super::{
    Facet, Shading,
    form::Form,
    phong::{self, Common},
};
use crate::{band::Band, math::power::PixelPower, palette::Reflection, pixel::Pixel};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    phong::draw_by(facet, shading, Mirrored, band)
}

/// Highlights by the reflected light.
#[derive(Clone, Copy)]
struct Mirrored;

impl Form<[u32; 3], [u32; 3]> for Mirrored {
    type Common = Common;

    fn common(&self, products: [u32; 3]) -> Common {
        let common = Common::new(products);
        Common { nv: common.normal.divide(common.nv), ..common }
    }

    fn reflect(&self, _: usize, common: &Common, products: [u32; 3], power: PixelPower<'_>) -> Reflection {
        let [nl, lv] = common.light(products);
        let nl = common.normal.divide(nl);
        Reflection { diffuse: nl >> 3, highlight: power.at(mirrored(nl, common.nv, lv)) }
    }
}

/// R·V = 2 (N·L)(N·V) - L·V from cosines in Q2.30, as Q5.27; negative where the half vector is behind the surface.
#[inline(always)]
pub(super) fn mirrored(nl: i32, nv: i32, lv: i32) -> i32 {
    if i64::from(nl) + i64::from(nv) <= 0 {
        return -1;
    }
    ((((i64::from(nl) * i64::from(nv)) >> 29) - i64::from(lv)) >> 3) as i32
}
