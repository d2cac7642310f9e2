//! Loops under constant lights that divide linear numerators by a length. Level and highlight are walked in the units of their tables, so that each
//! takes one product a pixel.

use crate::{
    arch::product::upper,
    format::COSINE,
    interpolate::{
        Constant,
        by_column::ByColumn,
        field::{Field, Nodes},
        plane::Plane,
    },
    lighting::{
        constant_lights::{DiffuseOnly, LitColours, OneLightRamp, OneLightRgb, Shades, WithHighlight, node},
        material_tables::MaterialTables,
    },
    math::{highlight_lookup, highlight_lookup::QuotientLookup, highlight_lut::HighlightLut},
    method::{
        CornerCosines, TriangleSetup,
        cosines::{
            lit::{AtPixel, FromValues, LitShader},
            two_lights::TwoLights,
        },
        largest,
        lighting_model::fitted,
    },
    pixel::Pixel,
    raster::{band::Band, pixel_shader::Solid},
};

/// Fraction bits of a diffuse level at a node. With a sign, levels then have [`RANGE`] bits.
const NODE: u32 = 10;
/// Bits of the range of diffuse levels at nodes.
const RANGE: u32 = 20;
/// Fraction bits of a walked diffuse level.
const LEVEL: u32 = 22;
/// Fraction bits of a level at a pixel, which is the upper half of the product of a walked level and half a reciprocal length, Q2.30.
const PIXEL: u32 = LEVEL - 3;
/// Bits of the range of numerators at nodes, in steps of the table.
const STEPS: u32 = 26;

/// Half a reciprocal length, Q2.30. Unless it is `EXACT`, cosines may exceed 1 and then count as 1.
struct HalfReciprocal<const EXACT: bool>(i32);

/// Values at the pixel are numerators without highlights and a length, from which `R` computes half a reciprocal length.
#[derive(Clone, Copy)]
struct Quotient<R, const EXACT: bool>(R);

/// Values at the pixel are numerators with highlights and a length.
#[derive(Clone, Copy)]
struct QuotientWithHighlight<'a, R, const EXACT: bool>(QuotientLookup<'a>, R);

impl<L, V, R: Fn(L) -> i32 + Copy, const EXACT: bool> AtPixel<(V, L)> for Quotient<R, EXACT> {
    type Common = HalfReciprocal<EXACT>;
    type Values = V;

    const BITS: u32 = PIXEL;

    #[inline(always)]
    fn at(&self, (values, length): (V, L)) -> (Self::Common, V) {
        (HalfReciprocal(self.0(length)), values)
    }
}

impl<'a, L, V, R: Fn(L) -> i32 + Copy, const EXACT: bool> AtPixel<(V, L)> for QuotientWithHighlight<'a, R, EXACT> {
    type Common = (QuotientLookup<'a>, HalfReciprocal<EXACT>);
    type Values = V;

    const BITS: u32 = PIXEL;

    #[inline(always)]
    fn at(&self, (values, length): (V, L)) -> (Self::Common, V) {
        ((self.0, HalfReciprocal(self.1(length))), values)
    }
}

impl<const EXACT: bool> FromValues<HalfReciprocal<EXACT>, [u32; 1]> for DiffuseOnly {
    #[inline(always)]
    fn from_values(&HalfReciprocal(half_reciprocal): &HalfReciprocal<EXACT>, full: u16, [light]: [u32; 1]) -> Self {
        Self(quotient::<EXACT>(full, light, half_reciprocal))
    }
}

impl<const EXACT: bool> FromValues<(QuotientLookup<'_>, HalfReciprocal<EXACT>), [u32; 1]> for DiffuseOnly {
    #[inline(always)]
    fn from_values((_, half_reciprocal): &(QuotientLookup<'_>, HalfReciprocal<EXACT>), full: u16, light: [u32; 1]) -> Self {
        Self::from_values(half_reciprocal, full, light)
    }
}

impl<const EXACT: bool> FromValues<(QuotientLookup<'_>, HalfReciprocal<EXACT>), ([u32; 1], [u32; 1])> for WithHighlight {
    #[inline(always)]
    fn from_values(
        (lookup, HalfReciprocal(half_reciprocal)): &(QuotientLookup<'_>, HalfReciprocal<EXACT>),
        full: u16,
        ([light], [half]): ([u32; 1], [u32; 1]),
    ) -> Self {
        Self(quotient::<EXACT>(full, light, *half_reciprocal), lookup.at(upper(half as i32, *half_reciprocal)))
    }
}

/// A light whose highlight is looked up before the diffuse level is computed. By measurement, loops of two lights have more registers then, and loops
/// of one light fewer.
struct HighlightFirst(WithHighlight);

impl From<HighlightFirst> for WithHighlight {
    #[inline(always)]
    fn from(HighlightFirst(light): HighlightFirst) -> Self {
        light
    }
}

impl<const EXACT: bool> FromValues<(QuotientLookup<'_>, HalfReciprocal<EXACT>), ([u32; 1], [u32; 1])> for HighlightFirst {
    #[inline(always)]
    fn from_values(
        (lookup, HalfReciprocal(half_reciprocal)): &(QuotientLookup<'_>, HalfReciprocal<EXACT>),
        full: u16,
        ([light], [half]): ([u32; 1], [u32; 1]),
    ) -> Self {
        let highlight = lookup.at(upper(half as i32, *half_reciprocal));
        Self(WithHighlight(quotient::<EXACT>(full, light, *half_reciprocal), highlight))
    }
}

/// The diffuse level from a numerator and half a reciprocal length. `full` is the material's level at cosine 1.
#[inline(always)]
fn quotient<const EXACT: bool>(full: u16, light: u32, half_reciprocal: i32) -> i32 {
    let diffuse = upper(light as i32, half_reciprocal);
    if EXACT { diffuse } else { diffuse.min(node(full, 1 << COSINE, PIXEL)) }
}

/// Draws `setup` under one light with these `cosines`; `None` if its levels do not fit their formats. `half_reciprocal` computes half a reciprocal
/// length, Q2.30, from the walked field `length`. Whether it is exact is told by `EXACT`.
#[inline(always)]
pub(super) fn draw<const EXACT: bool, F: Field, C: Pixel>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let (rgb, lut) = (tables.one_light_rgb(), tables.reflectance.table()?);
    // Without a highlight three channels are drawn by a table of colours, which rounds otherwise: that is no matter of leaving it out.
    let has_no_highlight = match rgb {
        Some(_) => largest(&cosines[1]) < setup.highlight_threshold(tables.reflectance),
        None => setup.leaves_out_highlight(tables.reflectance, &cosines[1]),
    };
    let ramp = if rgb.is_some() { tables.diffuse_ramp() } else { Some(tables.one_light_ramp()?) };
    Some(match (ramp, rgb) {
        // Boards with displays of greys have little flash: no loop of its own for that there.
        (Some(ramp), _) if !C::GRAY && has_no_highlight => {
            draw_diffuse::<EXACT, _, _>(setup, &cosines[0], length, half_reciprocal, ramp, tables, band)
        }
        (_, Some(rgb)) => draw_rgb::<EXACT, _, _>(setup, cosines, length, half_reciprocal, rgb, lut, band),
        (ramp, None) => draw_in::<EXACT, _, _>(setup, cosines, length, half_reciprocal, ramp?, lut, band),
    })
}

/// Draws as [`draw_in`] does, in three channels. It is compiled once for triangles of all sizes, because a call is a small share of their time.
#[inline(never)]
fn draw_rgb<const EXACT: bool, F: Field, C: Pixel>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    colours: OneLightRgb<'_, C>,
    lut: &HighlightLut,
    band: &mut Band<'_, C>,
) -> u32 {
    draw_in::<EXACT, _, _>(setup, cosines, length, half_reciprocal, colours, lut, band)
}

/// Draws `setup` under two constant lights.
#[inline(never)]
pub(super) fn draw_two<const EXACT: bool, F: Field, C: Pixel>(
    setup: &TriangleSetup<'_>,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let TwoLights { colours, cosines: [first, second], highlights } = TwoLights::on(setup, tables)?;
    let full = colours.diffuse();
    let lookup = QuotientLookup::new(tables.reflectance.table()?);
    let at = QuotientWithHighlight::<_, EXACT>(lookup, half_reciprocal);
    let both = |[towards, half]: &CornerCosines| (plane(setup, full, towards), numerator(setup, lookup, half));
    setup.count(band.top, &mut band.counts.without_highlight, 2 - highlights);
    Some(match highlights {
        1 if setup.leaves_out_light(tables.reflectance, &second[0]) => {
            setup.count(band.top, &mut band.counts.without_light, 1);
            draw_rgb::<EXACT, _, _>(setup, &first, length, half_reciprocal, colours.first(), tables.reflectance.table()?, band)
        }
        0 => {
            let patch = || ((plane(setup, full, &first[0]), plane(setup, full, &second[0])), fitted(&length(), setup.gradients));
            setup.fill(patch, LitShader::of::<(DiffuseOnly, DiffuseOnly)>(colours, Quotient::<_, EXACT>(half_reciprocal)), band)
        }
        1 => {
            let patch = || (ByColumn((both(&first), plane(setup, full, &second[0]))), fitted(&length(), setup.gradients));
            setup.fill(patch, LitShader::of::<(HighlightFirst, DiffuseOnly)>(colours, at), band)
        }
        _ => {
            let patch = || (ByColumn((both(&first), both(&second))), fitted(&length(), setup.gradients));
            setup.fill(patch, LitShader::of::<(HighlightFirst, HighlightFirst)>(colours, at), band)
        }
    })
}

/// Draws a triangle with a highlight in these `colours`.
#[inline(always)]
fn draw_in<const EXACT: bool, F: Field, T: Shades<WithHighlight>>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    colours: T,
    lut: &HighlightLut,
    band: &mut Band<'_, T::Pixel>,
) -> u32
where
    T::Pixel: Pixel,
{
    let lookup = QuotientLookup::new(lut);
    let patch = || patch(setup, colours.diffuse(), lookup, cosines, length);
    setup.fill(patch, LitShader::of::<WithHighlight>(colours, QuotientWithHighlight::<_, EXACT>(lookup, half_reciprocal)), band)
}

/// Draws a triangle without a highlight by a table of colours.
#[inline(always)]
fn draw_diffuse<const EXACT: bool, F: Field, C: Pixel>(
    setup: &TriangleSetup<'_>,
    towards: &[i32; 3],
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    colours: OneLightRamp<'_, C>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> u32 {
    if setup.leaves_out_light(tables.reflectance, towards) {
        setup.count(band.top, &mut band.counts.without_light, 1);
        return setup.fill(|| Constant, Solid::new(colours.unlit()), band);
    }
    setup.count(band.top, &mut band.counts.without_highlight, 1);
    let patch = || diffuse_patch(setup, colours.diffuse(), towards, length);
    setup.fill(patch, LitShader::of::<DiffuseOnly>(colours, Quotient::<_, EXACT>(half_reciprocal)), band)
}

/// The numerator of diffuse light. `full` is the material's level at cosine 1.
#[inline(always)]
fn diffuse(setup: &TriangleSetup<'_>, full: u16, &[a, b, c]: &[i32; 3]) -> Plane<1> {
    let nodes = [node(full, a, NODE), node(full, b, NODE), node(full, c, NODE)];
    Nodes::<3, 1, RANGE>::new([nodes], LEVEL - NODE).fit(setup.gradients)
}

/// A function of its own around [`diffuse`].
#[inline(never)]
fn plane(setup: &TriangleSetup<'_>, full: u16, towards: &[i32; 3]) -> Plane<1> {
    diffuse(setup, full, towards)
}

/// The numerator of the highlight.
#[inline(always)]
fn highlight(setup: &TriangleSetup<'_>, lookup: QuotientLookup<'_>, &[a, b, c]: &[i32; 3]) -> Plane<1> {
    let half = [lookup.node(a), lookup.node(b), lookup.node(c)];
    Nodes::<3, 1, STEPS>::new([half], highlight_lookup::EXTRA).fit(setup.gradients)
}

/// A function of its own around [`highlight`].
#[inline(never)]
fn numerator(setup: &TriangleSetup<'_>, lookup: QuotientLookup<'_>, half: &[i32; 3]) -> Plane<1> {
    highlight(setup, lookup, half)
}

/// The numerator of diffuse light, and the length.
#[inline(never)]
fn diffuse_patch<F: Field>(setup: &TriangleSetup<'_>, full: u16, towards: &[i32; 3], length: impl FnOnce() -> F) -> (Plane<1>, F::Patch) {
    (diffuse(setup, full, towards), length().fit(setup.gradients))
}

/// The numerators of diffuse light and of the highlight, and the length.
#[inline(never)]
fn patch<F: Field>(
    setup: &TriangleSetup<'_>,
    full: u16,
    lookup: QuotientLookup<'_>,
    [towards, half]: &CornerCosines,
    length: impl FnOnce() -> F,
) -> ((Plane<1>, Plane<1>), F::Patch) {
    // Two planes of one channel, because the compiler keeps one plane of two channels in memory.
    ((diffuse(setup, full, towards), highlight(setup, lookup, half)), length().fit(setup.gradients))
}
