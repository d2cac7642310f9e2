//! Duff's form (Duff 1979; see Bishop & Weimer 1986): linear N·L and N·H over the root of a quadratic.
//!
//! Under a constant light N·L and N·H are exactly linear and |N|² exactly quadratic over a triangle, so only
//! the reciprocal root is approximated, by a table of 1,537 knots. Near lights and viewers have numerators that
//! are not linear: there they are the quadratics through six points.
//!
//! Cost: 4 additions a pixel, a root from a table, 2 products and the highlight's table; 2 or 4 additions and 2 products more per light. Error: the
//! tables' error, mainly [`crate::math::highlight_lut::NEAREST_ERROR`] of the highlight. Domain: any lights; under near lights as exact as six points
//! are.

use crate::{
    arch::product::upper,
    features::SUMS_CONSTANT_LIGHTS,
    interpolate::field::Field,
    lighting::{
        lights::Source,
        material_tables::MaterialTables,
        reflectance::{Reflection, SUMMED},
    },
    math::{
        highlight_lut::CosineLookup,
        rsqrt::{HalfRsqrt, Root},
    },
    method::{
        CornerCosines, Shading, Style, TriangleSetup,
        cosines::{
            quotient,
            scale::{self, Lengths, STEEPEST},
            summed,
        },
        largest,
        lighting_model::{LightingModel, Lit},
        node::is_steep,
        products::{FIELD_EXTRA, QuadraticNodes, linear, signed},
    },
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas},
};

/// Shades by linear numerators over a root, under constant lights.
pub fn shade_constant(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let exponent = shading.exponent;
    // The faster root is worth its code only where little else is done at a pixel.
    if !scale::is_flat(setup) || is_steep(exponent) || setup.inv_depth().is_some() {
        return draw_constant(setup, shading, square(setup, exponent), Rooted, canvas);
    }
    let reflectance = shading.reflectance;
    let fit = |source: &Source| {
        // Both are linear, so that corners tell.
        let [towards, half] = shading.constant_cosines(setup, source);
        if !source.is_sky() && !setup.leaves_out_highlight(&reflectance, &half) {
            Lit::Fully(linear([towards, half]))
        } else if !source.is_sky() && setup.leaves_out_light(&reflectance, &towards) {
            Lit::Nowhere
        } else {
            Lit::Diffuse(linear([towards]))
        }
    };
    shading.draw_lit_in_part(setup, fit, scale::unit_square(setup), Tabled, canvas)
}

/// Shades by `model`. `common` and N·L and N·H of each light are interpolated; normals are not normalised, so these are linear under constant lights.
pub fn draw_constant<K: Field, F>(setup: &TriangleSetup<'_>, shading: &Shading<'_>, common: K, model: F, canvas: &mut dyn Canvas) -> u32
where
    F: LightingModel<K::Value, [u32; 2]>,
{
    shading.draw_lit(setup, |source| linear(shading.constant_cosines(setup, source)), common, model, canvas)
}

/// Whether there are loops for `style`.
pub(crate) fn take(style: Style) -> bool {
    style.lights > 0 && style.is_plain
}

/// Draws `setup` by loops under one light with the cosines `corners`, or several.
#[inline(always)]
pub(crate) fn draw<C: Pixel>(
    setup: &TriangleSetup<'_>,
    corners: impl Fn() -> CornerCosines,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let reflectance = tables.reflectance;
    let has_highlight = || match reflectance.lights {
        1 => largest(&corners()[1]) >= setup.highlight_threshold(reflectance),
        2 => setup.corners_of_two_lights().iter().any(|[_, half]| largest(half) >= setup.highlight_threshold(reflectance)),
        _ => true,
    };
    let is_steep = is_steep(shading.exponent) && has_highlight();
    // Summed lights are asked for their highlights later.
    if is_steep && shading.exponent > STEEPEST && reflectance.lights != SUMMED {
        return None;
    }
    // |N|² has two more bits than other quadratics, and its root is half as steep.
    if setup.gradients.is_any() && !setup.gradients.steep(setup.gradients.steepness().halved(3)).walks_in_words() {
        return None;
    }
    let lengths = Lengths::of(setup, is_steep)?;
    if SUMS_CONSTANT_LIGHTS && reflectance.lights > 1 {
        // In greys the light of two is summed as well.
        return if C::GRAY || reflectance.sums_lights() {
            summed::draw::<C, false>(setup, shading, &lengths, tables, band)
        } else {
            quotient::draw_two(setup, &lengths, tables, band)
        };
    }
    quotient::draw(setup, &corners(), &lengths, tables, band)
}

/// |N|², Q2.30: exactly quadratic, and for steep highlights exact.
#[inline(always)]
pub fn square(setup: &TriangleSetup<'_>, exponent: u16) -> QuadraticNodes<1> {
    QuadraticNodes::new([scale::squares(setup, is_steep(exponent))], FIELD_EXTRA).biased([1 << 30])
}

/// Normalises by 1/|N| from a table, for |N|² in [1/4, 1]; |N|² minus [`crate::math::rsqrt::LEAST`] is walked.
#[derive(Clone, Copy)]
struct Tabled;

impl LightingModel<[u32; 1], [u32; 2], [u32; 1]> for Tabled {
    type Common = i32;

    #[inline(always)]
    fn common(&self, [square]: [u32; 1]) -> i32 {
        HalfRsqrt::get().rsqrt(square) as i32
    }

    #[inline(always)]
    fn reflect(&self, _: usize, &half_root: &i32, [light, half]: [u32; 2], lut: CosineLookup<'_>) -> Reflection {
        // Upper half of Q2.30 times Q2.30, and half of a root: Q5.27.
        let over = |cosine: u32| upper(signed(cosine), half_root);
        Reflection { diffuse: over(light), highlight: lut.at(over(half)) }
    }

    #[inline(always)]
    fn reflect_diffuse(&self, &half_root: &i32, [light]: [u32; 1]) -> i32 {
        upper(signed(light), half_root)
    }
}

/// Normalises by 1/|N| from [`Root`], for every |N|².
#[derive(Clone, Copy)]
pub struct Rooted;

impl LightingModel<[u32; 1], [u32; 2]> for Rooted {
    type Common = Root;

    fn common(&self, [square]: [u32; 1]) -> Root {
        Root::of(square)
    }

    fn reflect(&self, _: usize, root: &Root, fields: [u32; 2], lut: CosineLookup<'_>) -> Reflection {
        let [diffuse, half] = fields.map(|cosine| root.divide(signed(cosine)) >> 3);
        Reflection { diffuse, highlight: lut.at(half) }
    }
}
