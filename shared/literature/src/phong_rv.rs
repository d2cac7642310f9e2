//! Per-pixel Phong shading with the reflected light (Phong 1975): highlights by R·V, R = 2(N·L)N - L.
//!
//! The exponent is a quarter of the half vector's. Highlights then have the width of the half vector's where L, N and V lie in a plane; elsewhere
//! they are rounder. It walks what [`microphong::method::cosines::phong`] walks.
//!
//! Cost: 6 additions and 2 roots, and for each light 6 additions, a root and 4 products. Domain: any lights and viewer.
//! Error against the half vector: the difference of the two models.

use microphong::method::{
    Canvas, CosineLookup, Facts, Highlight, HighlightField, LightingModel, Method, Reflection, Shading, TriangleSetup, VertexLight,
    cosines::{phong, phong::Common},
};

static FACTS: Facts = Facts {
    name: "phong-rv",
    id: 4,
    source: "Phong 1975",
    vertex_light: VertexLight::None,
    highlight: Highlight::Reflected,
    highlight_levels: false,
    highlight_field: HighlightField::Quadratic,
    near_lights: true,
    perspective: true,
};

/// Phong shading with the reflected light.
pub struct PhongRv;

impl Method for PhongRv {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    phong::draw_by(setup, shading, Mirrored, canvas)
}

/// Highlights by the reflected light.
#[derive(Clone, Copy)]
struct Mirrored;

impl LightingModel<[u32; 3], [u32; 3]> for Mirrored {
    type Common = Common;

    fn common(&self, products: [u32; 3]) -> Common {
        let common = Common::new(products);
        Common { nv: common.normal.divide(common.nv), ..common }
    }

    fn reflect(&self, _: usize, common: &Common, products: [u32; 3], lut: CosineLookup<'_>) -> Reflection {
        let [nl, lv] = common.light(products);
        let nl = common.normal.divide(nl);
        Reflection { diffuse: nl >> 3, highlight: lut.at(mirrored(nl, common.nv, lv)) }
    }
}

/// R·V = 2 (N·L)(N·V) - L·V from cosines in Q2.30, as Q5.27; negative where the half vector is behind the surface.
#[inline(always)]
pub fn mirrored(nl: i32, nv: i32, lv: i32) -> i32 {
    if i64::from(nl) + i64::from(nv) <= 0 {
        return -1;
    }
    ((((i64::from(nl) * i64::from(nv)) >> 29) - i64::from(lv)) >> 3) as i32
}
