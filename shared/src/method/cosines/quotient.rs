//! Loops under constant lights that divide linear numerators by the length |N|. Level and highlight are walked in the units of their tables, so that
//! each takes one product a pixel.

use crate::{
    arch::product::upper,
    features::VERTEX_COLOURS,
    format::FULL,
    interpolate::{
        Constant, Patch, Walker,
        by_column::ByColumn,
        field::{Field, Nodes},
        plane::Plane,
        quadric::Quadric,
    },
    lighting::{
        albedo::{Albedo, SHARE},
        constant_lights::{
            COLOUR, Coloured, ColouredRgb, DiffuseOnly, KERNEL_BITS, LitColours, MayHaveHighlight, OneLightRamp, OneLightRgb, Shades,
            SurfaceColour, WithHighlight, node,
        },
        material_tables::MaterialTables,
    },
    math::{highlight_lookup, highlight_lookup::QuotientLookup, highlight_lut::HighlightLut, rsqrt::HalfRsqrt, vector::map},
    method::{
        CornerCosines, LinearWay, TriangleSetup,
        cosines::{
            lit::{AtPixel, FromValues, LitShader},
            scale::Lengths,
            two_lights::TwoLights,
        },
        largest,
    },
    pixel::Pixel,
    raster::{
        band::Band,
        pixel_shader::{Solid, has_kernels},
    },
};
use microphong_kernels as kernels;

/// Fraction bits of a diffuse level at a node. With a sign, levels then have [`DIFFUSE_RANGE`] bits.
pub(super) const DIFFUSE_NODE: u32 = 10;
/// Bits of the range of diffuse levels at nodes.
pub(super) const DIFFUSE_RANGE: u32 = 20;
/// Fraction bits of a walked diffuse level.
pub(super) const DIFFUSE: u32 = 22;
/// Fraction bits of a level at a pixel, which is the upper half of the product of a walked level and half a reciprocal length, Q2.30.
pub(super) const PIXEL: u32 = DIFFUSE - 3;
/// Bits of the range of shares of a colour at nodes, which are Q1.[`SHARE_NODE`] in [0, 1].
const SHARES: u32 = SHARE_NODE + 1;
/// Fraction bits of a share of a colour at a node.
const SHARE_NODE: u32 = SHARE - 1;
/// Bits of the range of numerators at nodes, in steps of the table.
const STEPS: u32 = 26;

const _: () = assert!(PIXEL == KERNEL_BITS);

/// Half a reciprocal length, Q2.30.
pub(super) struct HalfReciprocal(pub(super) i32);

/// Values at the pixel are numerators without highlights and a squared length.
#[derive(Clone, Copy)]
pub(super) struct Quotient<'a>(pub(super) &'a HalfRsqrt);

/// Values at the pixel are numerators with highlights and a squared length.
#[derive(Clone, Copy)]
pub(super) struct QuotientWithHighlight<'a>(pub(super) QuotientLookup<'a>, pub(super) &'a HalfRsqrt);

impl<V> AtPixel<(V, [u32; 1])> for Quotient<'_> {
    type Common = HalfReciprocal;
    type Values = V;

    const BITS: u32 = PIXEL;

    #[inline(always)]
    fn at(&self, (values, [square]): (V, [u32; 1])) -> (HalfReciprocal, V) {
        (HalfReciprocal(self.0.rsqrt(square) as i32), values)
    }

    const IS_QUOTIENT: bool = true;

    #[inline(always)]
    fn lookup(&self) -> Option<kernels::Lookup<'_>> {
        Some(kernels::Lookup { roots: Some(self.0.knots()), ..Default::default() })
    }
}

impl<'a, V> AtPixel<(V, [u32; 1])> for QuotientWithHighlight<'a> {
    type Common = (QuotientLookup<'a>, HalfReciprocal);
    type Values = V;

    const BITS: u32 = PIXEL;

    #[inline(always)]
    fn at(&self, (values, [square]): (V, [u32; 1])) -> (Self::Common, V) {
        ((self.0, HalfReciprocal(self.1.rsqrt(square) as i32)), values)
    }

    const IS_QUOTIENT: bool = true;

    #[inline(always)]
    fn lookup(&self) -> Option<kernels::Lookup<'_>> {
        Some(self.0.in_kernels(self.1))
    }
}

impl FromValues<HalfReciprocal, [u32; 1]> for DiffuseOnly {
    #[inline(always)]
    fn from_values(&HalfReciprocal(half_reciprocal): &HalfReciprocal, _: u16, [light]: [u32; 1]) -> Self {
        Self(upper(light as i32, half_reciprocal))
    }
}

impl FromValues<(QuotientLookup<'_>, HalfReciprocal), [u32; 1]> for DiffuseOnly {
    #[inline(always)]
    fn from_values((_, half_reciprocal): &(QuotientLookup<'_>, HalfReciprocal), full: u16, light: [u32; 1]) -> Self {
        Self::from_values(half_reciprocal, full, light)
    }
}

impl FromValues<(QuotientLookup<'_>, HalfReciprocal), ([u32; 1], [u32; 1])> for WithHighlight {
    #[inline(always)]
    fn from_values(
        (lookup, HalfReciprocal(half_reciprocal)): &(QuotientLookup<'_>, HalfReciprocal),
        _: u16,
        ([light], [half]): ([u32; 1], [u32; 1]),
    ) -> Self {
        Self(upper(light as i32, *half_reciprocal), lookup.at(upper(half as i32, *half_reciprocal)))
    }
}

/// A light whose highlight is looked up before the diffuse level is computed. By measurement, loops of two lights have more registers then, and loops
/// of one light fewer.
#[derive(Clone, Copy)]
struct HighlightFirst(WithHighlight);

impl From<HighlightFirst> for WithHighlight {
    #[inline(always)]
    fn from(HighlightFirst(light): HighlightFirst) -> Self {
        light
    }
}

impl FromValues<(QuotientLookup<'_>, HalfReciprocal), ([u32; 1], [u32; 1])> for HighlightFirst {
    #[inline(always)]
    fn from_values(
        (lookup, HalfReciprocal(half_reciprocal)): &(QuotientLookup<'_>, HalfReciprocal),
        _: u16,
        ([light], [half]): ([u32; 1], [u32; 1]),
    ) -> Self {
        let highlight = lookup.at(upper(half as i32, *half_reciprocal));
        Self(WithHighlight(upper(light as i32, *half_reciprocal), highlight))
    }
}

impl MayHaveHighlight for HighlightFirst {
    const HIGHLIGHTS: usize = 1;
}

/// Draws `setup` under one light with these `cosines` and `lengths` of normals; `None` if its levels do not fit their formats.
#[inline(always)]
pub(super) fn draw<C: Pixel>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    lengths: &Lengths,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let (rgb, lut) = (tables.one_light_rgb(), tables.reflectance.table()?);
    if VERTEX_COLOURS
        && !C::GRAY
        && let Some(albedos) = setup.albedos()
    {
        if setup.has_texture() {
            return draw_textured(setup, cosines, lengths, tables, band);
        }
        return draw_coloured(setup, cosines, lengths, albedos, tables, band);
    }
    // Without a highlight three channels are drawn by a table of colours, which rounds otherwise: that is no matter of leaving it out.
    let has_no_highlight = match rgb {
        Some(_) => largest(&cosines[1]) < setup.highlight_threshold(tables.reflectance),
        None => setup.leaves_out_highlight(tables.reflectance, &cosines[1]),
    };
    let ramp = if rgb.is_some() { tables.diffuse_ramp() } else { Some(tables.one_light_ramp()?) };
    Some(match (ramp, rgb) {
        // Boards with displays of greys have little flash: no loop of its own for that there.
        (Some(ramp), _) if !C::GRAY && has_no_highlight => draw_diffuse(setup, &cosines[0], lengths, ramp, tables, band),
        (_, Some(rgb)) => draw_rgb(setup, cosines, lengths, rgb, lut, band),
        (ramp, None) => draw_in(setup, cosines, lengths, ramp?, lut, band),
    })
}

/// Draws as [`draw_in`] does, in three channels. It is compiled once for triangles of all sizes, because a call is a small share of their time.
#[inline(never)]
fn draw_rgb<C: Pixel>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    lengths: &Lengths,
    colours: OneLightRgb<'_, C>,
    lut: &HighlightLut,
    band: &mut Band<'_, C>,
) -> u32 {
    draw_in(setup, cosines, lengths, colours, lut, band)
}

/// Draws as [`draw_in`] does, on a surface whose corners have colours.
#[inline(never)]
fn draw_coloured<C: Pixel>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    lengths: &Lengths,
    albedos: &[Albedo; 3],
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    if !is_plane(setup, albedos) {
        return None;
    }
    if let Some(albedo) = Albedo::one(albedos) {
        let sums = &tables.painted_sums(albedo);
        if setup.leaves_out_highlight(tables.reflectance, &cosines[1]) {
            setup.count(band.top, &mut band.counts.without_highlight, 1);
            let (colours, at) = (OneLightRgb::of(sums), Quotient(HalfRsqrt::get()));
            let patch = || diffuse_patch(setup, colours.diffuse(), &cosines[0], lengths);
            return Some(setup.fill(patch, LitShader::of::<DiffuseOnly>(colours, at), band));
        }
        return Some(draw_rgb(setup, cosines, lengths, OneLightRgb::of(sums), tables.reflectance.table()?, band));
    }
    draw_painted(setup, cosines, lengths, || colour(setup, albedos), tables, band)
}

/// Draws as [`draw_in`] does, on a surface whose `colour` changes from pixel to pixel.
#[inline(always)]
fn draw_painted<C: Pixel, P: Patch<Walker: Walker<Value: SurfaceColour>>>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    lengths: &Lengths,
    colour: impl Fn() -> P,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    // A kernel takes as many instructions where red and blue have the same levels, so it draws the general colours.
    let neutral = if const { has_kernels::<C>() && matches!(P::FIELDS, Some([_, 0])) } { None } else { tables.neutral_rgb() };
    match neutral {
        Some(colours) => draw_painted_in(setup, cosines, lengths, colour, colours, tables, band),
        None => draw_painted_in(setup, cosines, lengths, colour, ColouredRgb::of(&tables.coloured()), tables, band),
    }
}

/// Draws as [`draw_painted`] does, in these `colours`.
#[inline(always)]
fn draw_painted_in<C: Pixel, P: Patch<Walker: Walker<Value: SurfaceColour>>, T>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    lengths: &Lengths,
    colour: impl Fn() -> P,
    colours: T,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32>
where
    T: Shades<Coloured<DiffuseOnly>> + Shades<Coloured<WithHighlight>> + LitColours<Pixel = C>,
{
    let (lookup, full) = (QuotientLookup::new(tables.reflectance.table()?), colours.diffuse());
    if setup.leaves_out_highlight(tables.reflectance, &cosines[1]) {
        setup.count(band.top, &mut band.counts.without_highlight, 1);
        let patch = || ((plane(setup, full, lengths, &cosines[0]), colour()), lengths.square(setup));
        return Some(setup.fill(patch, LitShader::of::<Coloured<DiffuseOnly>>(colours, Quotient(HalfRsqrt::get())), band));
    }
    let patch = || {
        let ((diffuse, highlight), square) = patch(setup, full, lookup, cosines, lengths);
        (((diffuse, highlight), colour()), square)
    };
    Some(setup.fill(patch, LitShader::of::<Coloured<WithHighlight>>(colours, QuotientWithHighlight(lookup, HalfRsqrt::get())), band))
}

/// Draws as [`draw_in`] does, on a surface with a texture.
#[inline(never)]
fn draw_textured<C: Pixel>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    lengths: &Lengths,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let texels = setup.texels()?;
    draw_painted(setup, cosines, lengths, || texels, tables, band)
}

/// Whether colours can be interpolated by a plane on the screen.
#[inline(never)]
pub(super) fn is_plane(setup: &TriangleSetup<'_>, albedos: &[Albedo; 3]) -> bool {
    matches!(setup.linear_way(|| (Albedo::range(albedos) * FULL as u32) >> SHARE), LinearWay::Plane)
}

/// The colour of a surface whose corners have these colours, Q1.[`COLOUR`].
#[inline(never)]
pub(super) fn colour(setup: &TriangleSetup<'_>, albedos: &[Albedo; 3]) -> Plane<3> {
    let [a, b, c] = map(*albedos, |albedo| map(albedo.shares(), |share| (share + 1) >> 1));
    let nodes = [[a[0], b[0], c[0]], [a[1], b[1], c[1]], [a[2], b[2], c[2]]];
    Nodes::<3, 3, SHARES>::new(nodes, COLOUR - SHARE_NODE).fit(setup.gradients)
}

/// Draws `setup` under two constant lights.
#[inline(never)]
pub(super) fn draw_two<C: Pixel>(
    setup: &TriangleSetup<'_>,
    lengths: &Lengths,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let TwoLights { colours, cosines: [first, second], highlights } = TwoLights::on(setup, tables)?;
    let full = colours.diffuse();
    let lookup = QuotientLookup::new(tables.reflectance.table()?);
    let at = QuotientWithHighlight(lookup, HalfRsqrt::get());
    let both = |[towards, half]: &CornerCosines| (plane(setup, full, lengths, towards), numerator(setup, lookup, lengths, half));
    setup.count(band.top, &mut band.counts.without_highlight, 2 - highlights);
    Some(match highlights {
        1 if setup.leaves_out_light(tables.reflectance, &second[0]) => {
            setup.count(band.top, &mut band.counts.without_light, 1);
            draw_rgb(setup, &first, lengths, colours.first(), tables.reflectance.table()?, band)
        }
        0 => {
            let patch = || ((plane(setup, full, lengths, &first[0]), plane(setup, full, lengths, &second[0])), lengths.square(setup));
            setup.fill(patch, LitShader::of::<(DiffuseOnly, DiffuseOnly)>(colours, Quotient(HalfRsqrt::get())), band)
        }
        1 => {
            let patch = || (ByColumn((both(&first), plane(setup, full, lengths, &second[0]))), lengths.square(setup));
            setup.fill(patch, LitShader::of::<(HighlightFirst, DiffuseOnly)>(colours, at), band)
        }
        _ => {
            let patch = || (ByColumn((both(&first), both(&second))), lengths.square(setup));
            setup.fill(patch, LitShader::of::<(HighlightFirst, HighlightFirst)>(colours, at), band)
        }
    })
}

/// Draws a triangle with a highlight in these `colours`.
#[inline(always)]
fn draw_in<T: Shades<WithHighlight>>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    lengths: &Lengths,
    colours: T,
    lut: &HighlightLut,
    band: &mut Band<'_, T::Pixel>,
) -> u32 {
    let lookup = QuotientLookup::new(lut);
    let patch = || patch(setup, colours.diffuse(), lookup, cosines, lengths);
    setup.fill(patch, LitShader::of::<WithHighlight>(colours, QuotientWithHighlight(lookup, HalfRsqrt::get())), band)
}

/// Draws a triangle without a highlight by a table of colours.
#[inline(always)]
fn draw_diffuse<C: Pixel>(
    setup: &TriangleSetup<'_>,
    towards: &[i32; 3],
    lengths: &Lengths,
    colours: OneLightRamp<'_, C>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> u32 {
    if setup.leaves_out_light(tables.reflectance, towards) {
        setup.count(band.top, &mut band.counts.without_light, 1);
        return setup.fill(|| Constant, Solid::new(colours.unlit()), band);
    }
    setup.count(band.top, &mut band.counts.without_highlight, 1);
    let patch = || diffuse_patch(setup, colours.diffuse(), towards, lengths);
    setup.fill(patch, LitShader::of::<DiffuseOnly>(colours, Quotient(HalfRsqrt::get())), band)
}

/// The numerator of diffuse light. `full` is the material's level at cosine 1.
#[inline(always)]
fn diffuse(setup: &TriangleSetup<'_>, full: u16, lengths: &Lengths, towards: &[i32; 3]) -> Plane<1> {
    let [a, b, c] = lengths.apply(towards);
    let nodes = [node(full, a, DIFFUSE_NODE), node(full, b, DIFFUSE_NODE), node(full, c, DIFFUSE_NODE)];
    Nodes::<3, 1, DIFFUSE_RANGE>::new([nodes], DIFFUSE - DIFFUSE_NODE).fit(setup.gradients)
}

/// A function of its own around [`diffuse`].
#[inline(never)]
pub(super) fn plane(setup: &TriangleSetup<'_>, full: u16, lengths: &Lengths, towards: &[i32; 3]) -> Plane<1> {
    diffuse(setup, full, lengths, towards)
}

/// The numerator of the highlight.
#[inline(always)]
fn highlight(setup: &TriangleSetup<'_>, lookup: QuotientLookup<'_>, lengths: &Lengths, half: &[i32; 3]) -> Plane<1> {
    let [a, b, c] = lengths.apply(half);
    let half = [lookup.node(a), lookup.node(b), lookup.node(c)];
    Nodes::<3, 1, STEPS>::new([half], highlight_lookup::NUMERATOR_EXTRA).fit(setup.gradients)
}

/// A function of its own around [`highlight`].
#[inline(never)]
pub(super) fn numerator(setup: &TriangleSetup<'_>, lookup: QuotientLookup<'_>, lengths: &Lengths, half: &[i32; 3]) -> Plane<1> {
    highlight(setup, lookup, lengths, half)
}

/// The numerator of diffuse light, and |N|².
#[inline(never)]
fn diffuse_patch(setup: &TriangleSetup<'_>, full: u16, towards: &[i32; 3], lengths: &Lengths) -> (Plane<1>, Quadric<1>) {
    (diffuse(setup, full, lengths, towards), lengths.square(setup))
}

/// The numerators of diffuse light and of the highlight, and |N|².
#[inline(never)]
fn patch(
    setup: &TriangleSetup<'_>,
    full: u16,
    lookup: QuotientLookup<'_>,
    [towards, half]: &CornerCosines,
    lengths: &Lengths,
) -> ((Plane<1>, Plane<1>), Quadric<1>) {
    // Two planes of one channel, because the compiler keeps one plane of two channels in memory.
    ((diffuse(setup, full, lengths, towards), highlight(setup, lookup, lengths, half)), lengths.square(setup))
}
