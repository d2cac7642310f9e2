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
        constant_lights::{OneLight, OneLightRamp, OneLightRgb, TwoLightsRgb, node},
        material_tables::MaterialTables,
    },
    math::{highlight_lookup, highlight_lookup::QuotientLookup},
    method::{CornerCosines, TriangleSetup, largest, lighting_model::fitted, two_lights::TwoLights},
    pixel::{Pixel, dither::ByRows},
    raster::{
        band::Band,
        pixel_shader::{PixelShader, Solid},
    },
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

/// A walked value for each of two lights.
type Walked<V> = (V, V);

/// Diffuse light and highlight from numerators and a length. `R` computes half a reciprocal length, Q2.30, from walked values. Unless it is
/// `EXACT`, cosines may exceed 1 and then count as 1.
#[derive(Clone, Copy)]
struct DiffuseAndHighlight<'a, T, R, const EXACT: bool> {
    colours: T,
    lookup: QuotientLookup<'a>,
    half_reciprocal: R,
}

impl<T: ByRows, R: Copy, const EXACT: bool> ByRows for DiffuseAndHighlight<'_, T, R, EXACT> {
    #[inline(always)]
    fn step_row(&mut self) {
        self.colours.step_row();
    }
}

impl<T: OneLight, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<(([u32; 1], [u32; 1]), V)>
    for DiffuseAndHighlight<'_, T, R, EXACT>
{
    type Pixel = T::Pixel;

    const CHEAP: bool = T::TABLED;

    #[inline(always)]
    fn shade(&self, (([light], [half]), length): (([u32; 1], [u32; 1]), V), threshold: u32) -> T::Pixel {
        let half_reciprocal = (self.half_reciprocal)(length);
        let diffuse = quotient::<EXACT>(self.colours.diffuse(), light, half_reciprocal);
        let highlight = self.lookup.at(upper(half as i32, half_reciprocal));
        self.colours.colour::<PIXEL>(diffuse, highlight, threshold)
    }
}

/// Diffuse light from a numerator and a length, where there is no highlight.
#[derive(Clone, Copy)]
struct DiffuseOnly<T, R, const EXACT: bool> {
    colours: T,
    half_reciprocal: R,
}

impl<T: ByRows, R: Copy, const EXACT: bool> ByRows for DiffuseOnly<T, R, EXACT> {
    #[inline(always)]
    fn step_row(&mut self) {
        self.colours.step_row();
    }
}

impl<C: Pixel, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<([u32; 1], V)> for DiffuseOnly<OneLightRamp<'_, C>, R, EXACT> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn shade(&self, ([light], length): ([u32; 1], V), threshold: u32) -> C {
        let diffuse = quotient::<EXACT>(self.colours.diffuse(), light, (self.half_reciprocal)(length));
        self.colours.without_highlight::<PIXEL>(diffuse, threshold)
    }
}

/// Shades by two lights.
impl<C: Pixel, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<(Walked<([u32; 1], [u32; 1])>, V)>
    for DiffuseAndHighlight<'_, TwoLightsRgb<'_, C>, R, EXACT>
{
    type Pixel = C;

    #[inline(always)]
    fn shade(&self, ((one, two), length): (Walked<([u32; 1], [u32; 1])>, V), _: u32) -> C {
        let half_reciprocal = (self.half_reciprocal)(length);
        let light = |([light], [half]): ([u32; 1], [u32; 1])| {
            let diffuse = quotient::<EXACT>(self.colours.diffuse(), light, half_reciprocal);
            (diffuse, self.lookup.at(upper(half as i32, half_reciprocal)))
        };
        self.colours.colour::<PIXEL>([light(one), light(two)])
    }
}

/// Shades by two lights, of which the second has no highlight.
impl<C: Pixel, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<((([u32; 1], [u32; 1]), [u32; 1]), V)>
    for DiffuseAndHighlight<'_, TwoLightsRgb<'_, C>, R, EXACT>
{
    type Pixel = C;

    #[inline(always)]
    fn shade(&self, ((([light], [half]), [other]), length): ((([u32; 1], [u32; 1]), [u32; 1]), V), _: u32) -> C {
        let half_reciprocal = (self.half_reciprocal)(length);
        let diffuse = |light| quotient::<EXACT>(self.colours.diffuse(), light, half_reciprocal);
        let highlight = self.lookup.at(upper(half as i32, half_reciprocal));
        self.colours.colour::<PIXEL>([(diffuse(light), highlight), (diffuse(other), 0)])
    }
}

/// Shades by two lights without highlights.
impl<C: Pixel, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<(Walked<[u32; 1]>, V)>
    for DiffuseOnly<TwoLightsRgb<'_, C>, R, EXACT>
{
    type Pixel = C;

    #[inline(always)]
    fn shade(&self, (([one], [two]), length): (Walked<[u32; 1]>, V), _: u32) -> C {
        let half_reciprocal = (self.half_reciprocal)(length);
        let light = |light| (quotient::<EXACT>(self.colours.diffuse(), light, half_reciprocal), 0);
        self.colours.colour::<PIXEL>([light(one), light(two)])
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
    let rgb = tables.one_light_rgb();
    // Without a highlight three channels are drawn by a table of colours, which rounds otherwise: that is no matter of leaving it out.
    let has_no_highlight = match rgb {
        Some(_) => largest(&cosines[1]) < setup.highlight_threshold(&tables.reflectance),
        None => setup.leaves_out_highlight(&tables.reflectance, &cosines[1]),
    };
    let ramp = if rgb.is_some() { tables.diffuse_ramp() } else { Some(tables.one_light_ramp()?) };
    match (ramp, rgb) {
        // Boards with displays of greys have little flash: no loop of its own for that there.
        (Some(ramp), _) if !C::GRAY && has_no_highlight => {
            Some(draw_diffuse::<EXACT, _, _>(setup, &cosines[0], length, half_reciprocal, ramp, tables, band))
        }
        (_, Some(rgb)) => draw_rgb::<EXACT, _, _>(setup, cosines, length, half_reciprocal, rgb, tables, band),
        (ramp, None) => draw_in::<EXACT, _, _>(setup, cosines, length, half_reciprocal, ramp?, tables, band),
    }
}

/// Draws as [`draw_in`] does, in three channels. It is compiled once for triangles of all sizes, because a call is a small share of their time.
#[inline(never)]
fn draw_rgb<const EXACT: bool, F: Field, C: Pixel>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    colours: OneLightRgb<'_, C>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    draw_in::<EXACT, _, _>(setup, cosines, length, half_reciprocal, colours, tables, band)
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
    let shader = DiffuseAndHighlight::<_, _, EXACT> { colours, lookup, half_reciprocal };
    let both = |[towards, half]: &CornerCosines| (plane(setup, full, towards), numerator(setup, lookup, half));
    setup.count(band.top, &mut band.counts.without_highlight, 2 - highlights);
    Some(match highlights {
        1 if setup.leaves_out_light(&tables.reflectance, &second[0]) => {
            setup.count(band.top, &mut band.counts.without_light, 1);
            return draw_rgb::<EXACT, _, _>(setup, &first, length, half_reciprocal, colours.first(), tables, band);
        }
        0 => {
            let patch = || ((plane(setup, full, &first[0]), plane(setup, full, &second[0])), fitted(&length(), setup.gradients));
            setup.fill(patch, DiffuseOnly::<_, _, EXACT> { colours, half_reciprocal }, band)
        }
        1 => {
            let patch = || (ByColumn((both(&first), plane(setup, full, &second[0]))), fitted(&length(), setup.gradients));
            setup.fill(patch, shader, band)
        }
        _ => setup.fill(|| (ByColumn((both(&first), both(&second))), fitted(&length(), setup.gradients)), shader, band),
    })
}

/// Draws a triangle with a highlight in these `colours`.
#[inline(always)]
fn draw_in<const EXACT: bool, F: Field, T: OneLight>(
    setup: &TriangleSetup<'_>,
    cosines: &CornerCosines,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    colours: T,
    tables: MaterialTables<'_, T::Pixel>,
    band: &mut Band<'_, T::Pixel>,
) -> Option<u32>
where
    T::Pixel: Pixel,
{
    let lookup = QuotientLookup::new(tables.reflectance.table()?);
    let patch = || patch(setup, colours.diffuse(), lookup, cosines, length);
    Some(setup.fill(patch, DiffuseAndHighlight::<_, _, EXACT> { colours, lookup, half_reciprocal }, band))
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
    if setup.leaves_out_light(&tables.reflectance, towards) {
        setup.count(band.top, &mut band.counts.without_light, 1);
        return setup.fill(|| Constant, Solid(colours.unlit()), band);
    }
    setup.count(band.top, &mut band.counts.without_highlight, 1);
    let patch = || diffuse_patch(setup, colours.diffuse(), towards, length);
    setup.fill(patch, DiffuseOnly::<_, _, EXACT> { colours, half_reciprocal }, band)
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
