//! Quadratic renormalisation made exact by Newton's iteration: q = m (3 - D m²)/2 with m from [`super::renq`] and D = |N|².
//!
//! One step squares m's relative error, delta <= 0.02 e⁴, to 1.5 delta²; where that still shows at the material's
//! exponent, on strongly curved triangles, a second step is taken. No root, no division, no table but the highlight's.
//!
//! Cost: 6 additions a pixel, 5 products (8 with two steps) and the highlight's table; 2 or 4 additions and 2 products
//! more per light. Continuous. Error against Phong under constant light: 0.1 LSB and the table's.
//! Domain: any lights; where |N| falls below 1/2, [`super::duff`]'s root takes over.

use super::{
    Facet, Shading, duff,
    form::{Form, signed},
    renq,
};
use crate::{
    band::Band,
    format::RHO,
    math::{power::PixelPower, product::upper},
    palette::Reflection,
    pixel::Pixel,
};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    if duff::is_curved(facet) {
        duff::draw(facet, shading, band)
    } else if needs_two(facet.triangle.rho, shading.exponent) {
        draw_by(facet, shading, Newton::<2>, band)
    } else {
        draw_by(facet, shading, Newton::<1>, band)
    }
}

/// Shades with the steps of `form`.
fn draw_by<C: Pixel, const STEPS: usize>(facet: &Facet<'_>, shading: &Shading<'_, C>, form: Newton<STEPS>, band: &mut Band<'_, C>) -> u32 {
    let lengths = || (renq::length(facet), duff::square(facet));
    shading.draw_quotients::<false, _>(facet, lengths, |lengths| form.half_reciprocal(lengths), band).unwrap_or_else(|| {
        let nodes = facet.six_linear_nodes();
        shading.draw_lit(facet, |source| shading.six_products(&nodes, source, |p| p), lengths(), form, band)
    })
}

/// Whether one step may leave more than 0.1 LSB: 255 n 1.5 delta² > 0.1 with delta = 0.02 e⁴ and e² = 3 (1 - rho²).
fn needs_two(rho: u16, exponent: u16) -> bool {
    // e² in Q2.30; 255 · 1.5 · 0.02² = 0.153.
    let rho = u64::from(rho);
    let chord2 = 3 * ((1u64 << 30) - ((rho * rho) >> (2 * RHO - 30)));
    let chord4 = (chord2 * chord2) >> 32;
    // e⁸ in Q.26, and 0.1 / 0.153 in Q.26.
    ((chord4 * chord4) >> 30) * u64::from(exponent) > LIMIT
}

/// 0.1 / (255 · 1.5 · 0.02²), Q.26.
const LIMIT: u64 = (0.1 / (255.0 * 1.5 * 0.02 * 0.02) * (1u64 << 26) as f64) as u64;

/// One step from h towards 1/(2 sqrt(D)): h (3 - 4 D h²)/2, Q2.30.
#[inline(always)]
fn newton(h: i32, square: i32) -> i32 {
    // Upper halves of products: h² in Q4.28, D h² in Q6.26. 3 - 4 D h² is about 2: Q3.29.
    let product = upper(upper(h, h), square);
    upper(h, ((3 << 26) - (product << 2)) << 3) << 2
}

/// One Newton step, or two.
#[derive(Clone, Copy)]
struct Newton<const STEPS: usize>;

impl<const STEPS: usize> Newton<STEPS> {
    /// 1/(2|N|), Q2.30.
    #[inline(always)]
    fn half_reciprocal(self, ([length], [square]): ([u32; 1], [u32; 1])) -> i32 {
        let (length, square) = (signed(length), signed(square));
        let once = newton(length, square);
        if STEPS == 1 { once } else { newton(once, square) }
    }
}

impl<const STEPS: usize> Form<([u32; 1], [u32; 1]), [u32; 2]> for Newton<STEPS> {
    type Common = i32;

    #[inline(always)]
    fn common(&self, lengths: ([u32; 1], [u32; 1])) -> i32 {
        self.half_reciprocal(lengths)
    }

    #[inline(always)]
    fn reflect(&self, light: usize, length: &i32, fields: [u32; 2], power: PixelPower<'_>) -> Reflection {
        renq::Scaled.reflect(light, length, fields, power)
    }
}
