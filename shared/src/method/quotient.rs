//! One constant light, by linear numerators over a length: level and highlight are walked in the units
//! of their tables, so that a pixel takes one product for each.

use crate::{
    arch::product::upper,
    format::COSINE,
    interpolate::{
        Constant,
        field::{Field, Nodes},
        plane::Plane,
    },
    lighting::{
        materials::MaterialTables,
        one_light::{OneLight, OneLightRgb, node},
    },
    math::{highlight_lookup, highlight_lookup::QuotientLookup},
    method::TriangleSetup,
    pixel::Pixel,
    raster::{
        band::Band,
        pixel_shader::{PixelShader, Solid},
    },
};

/// Fraction bits of a diffuse level at a node: levels, with a sign, then have [`RANGE`] bits.
const NODE: u32 = 10;
/// Bits of the range of diffuse levels at nodes.
const RANGE: u32 = 20;
/// Fraction bits of a walked diffuse level.
const LEVEL: u32 = 22;
/// Fraction bits of a level at a pixel, which is the upper half of the product of a walked level and half a reciprocal length, Q2.30.
const PIXEL: u32 = LEVEL - 3;
/// Bits of the range of numerators at nodes, in steps of the table.
const STEPS: u32 = 26;

/// Diffuse light and highlight from numerators and a length. `R` computes half a reciprocal length, Q2.30, from walked values. Unless it is
/// `EXACT`, cosines may exceed 1 and then count as 1.
#[derive(Clone, Copy)]
struct DiffuseAndHighlight<'a, T, R, const EXACT: bool> {
    colours: T,
    lookup: QuotientLookup<'a>,
    half_reciprocal: R,
}

impl<T: OneLight, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<(([u32; 1], [u32; 1]), V)>
    for DiffuseAndHighlight<'_, T, R, EXACT>
{
    type Pixel = T::Pixel;

    const CHEAP: bool = T::TABLED;

    #[inline(always)]
    fn shade(&self, (([light], [half]), length): (([u32; 1], [u32; 1]), V)) -> T::Pixel {
        let half_reciprocal = (self.half_reciprocal)(length);
        let diffuse = quotient::<EXACT, T>(self.colours, light, half_reciprocal);
        let highlight = self.lookup.at(upper(half as i32, half_reciprocal));
        self.colours.colour::<PIXEL>(diffuse, highlight)
    }
}

/// Diffuse light from a numerator and a length, where there is no highlight.
#[derive(Clone, Copy)]
struct DiffuseOnly<T, R, const EXACT: bool> {
    colours: T,
    half_reciprocal: R,
}

impl<T: OneLight, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<([u32; 1], V)> for DiffuseOnly<T, R, EXACT> {
    type Pixel = T::Pixel;

    const CHEAP: bool = T::TABLED;

    #[inline(always)]
    fn shade(&self, ([light], length): ([u32; 1], V)) -> T::Pixel {
        let diffuse = quotient::<EXACT, T>(self.colours, light, (self.half_reciprocal)(length));
        self.colours.without_highlight::<PIXEL>(diffuse)
    }
}

/// The diffuse level of a numerator times half a reciprocal length.
#[inline(always)]
fn quotient<const EXACT: bool, T: OneLight>(colours: T, light: u32, half_reciprocal: i32) -> i32 {
    let diffuse = upper(light as i32, half_reciprocal);
    if EXACT { diffuse } else { diffuse.min(node(colours.diffuse(), 1 << COSINE, PIXEL)) }
}

/// Draws `setup` under one constant light; `None` if its levels do not fit their formats. `half_reciprocal` computes half a reciprocal
/// length, Q2.30, from the walked field `length`, `EXACT` or not.
#[inline(always)]
pub(super) fn draw<const EXACT: bool, F: Field, C: Pixel>(
    setup: &TriangleSetup<'_>,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    match tables.one_light_rgb() {
        Some(rgb) => Some(draw_rgb::<EXACT, _, _>(setup, length, half_reciprocal, rgb, tables, band)),
        None => Some(draw_in::<EXACT, _, _>(setup, length, half_reciprocal, tables.one_light_ramp()?, tables, band)),
    }
}

/// [`draw_in`] in three channels, once for triangles of all sizes: a call is a small share of what they take.
#[inline(never)]
fn draw_rgb<const EXACT: bool, F: Field, C: Pixel>(
    setup: &TriangleSetup<'_>,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    colours: OneLightRgb<'_, C>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> u32 {
    draw_in::<EXACT, _, _>(setup, length, half_reciprocal, colours, tables, band)
}

/// [`draw`] in these `colours`.
#[inline(always)]
fn draw_in<const EXACT: bool, F: Field, T: OneLight>(
    setup: &TriangleSetup<'_>,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    colours: T,
    tables: MaterialTables<'_, T::Pixel>,
    band: &mut Band<'_, T::Pixel>,
) -> u32
where
    T::Pixel: Pixel,
{
    let (reflectance, full) = (tables.reflectance, colours.diffuse());
    if setup.has_no_highlight(reflectance) {
        let [a, b, c] = setup.corners;
        if a.light[0].max(b.light[0]).max(c.light[0]) <= 0 {
            return setup.fill(|| Constant, Solid(colours.without_highlight::<PIXEL>(0)), band);
        }
        return setup.fill(|| diffuse_patch(setup, full, length), DiffuseOnly::<_, _, EXACT> { colours, half_reciprocal }, band);
    }
    let lookup = QuotientLookup::new(&reflectance.highlight_lut);
    setup.fill(|| patch(setup, full, lookup, length), DiffuseAndHighlight::<_, _, EXACT> { colours, lookup, half_reciprocal }, band)
}

/// The numerator of diffuse light, of a material with the level `full` at cosine 1.
#[inline(always)]
fn diffuse(setup: &TriangleSetup<'_>, full: u16) -> Plane<1> {
    let [a, b, c] = setup.corners;
    let nodes = [node(full, a.light[0], NODE), node(full, b.light[0], NODE), node(full, c.light[0], NODE)];
    Nodes::<3, 1, RANGE>::new([nodes], LEVEL - NODE).fit(setup.gradients)
}

/// The numerator of diffuse light, and the length.
#[inline(never)]
fn diffuse_patch<F: Field>(setup: &TriangleSetup<'_>, full: u16, length: impl FnOnce() -> F) -> (Plane<1>, F::Patch) {
    (diffuse(setup, full), length().fit(setup.gradients))
}

/// The numerators of diffuse light and of the highlight, and the length.
#[inline(never)]
fn patch<F: Field>(
    setup: &TriangleSetup<'_>,
    full: u16,
    lookup: QuotientLookup<'_>,
    length: impl FnOnce() -> F,
) -> ((Plane<1>, Plane<1>), F::Patch) {
    let [a, b, c] = setup.corners;
    let half = [lookup.node(a.light[1]), lookup.node(b.light[1]), lookup.node(c.light[1])];
    // Two planes of one channel, because the compiler keeps one plane of two channels in memory.
    let half = Nodes::<3, 1, STEPS>::new([half], highlight_lookup::EXTRA).fit(setup.gradients);
    ((diffuse(setup, full), half), length().fit(setup.gradients))
}
