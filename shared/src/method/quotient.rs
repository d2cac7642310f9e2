//! One constant light on a material of one channel, by linear numerators over a length: level and highlight are walked in the units
//! of their tables, so that a pixel takes one product for each.

use crate::{
    arch::product::upper,
    format::COSINE,
    interpolate::{
        Constant,
        field::{Field, Nodes},
    },
    lighting::materials::{MaterialTables, OneLightRamp},
    math::{highlight_lookup, highlight_lookup::QuotientLookup},
    method::TriangleSetup,
    pixel::Pixel,
    raster::{
        band::Band,
        pixel_shader::{PixelShader, Solid},
    },
};

/// Fraction bits of a diffuse level at a node: the levels of a ramp, with a sign, then have [`RANGE`] bits.
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
struct OneLight<'a, C: Pixel, R, const EXACT: bool> {
    ramp: OneLightRamp<'a, C>,
    lookup: QuotientLookup<'a>,
    half_reciprocal: R,
}

impl<C: Pixel, R: Copy, const EXACT: bool> Clone for OneLight<'_, C, R, EXACT> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C: Pixel, R: Copy, const EXACT: bool> Copy for OneLight<'_, C, R, EXACT> {}

impl<C: Pixel, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<(([u32; 1], [u32; 1]), V)> for OneLight<'_, C, R, EXACT> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn shade(&self, (([light], [half]), length): (([u32; 1], [u32; 1]), V)) -> C {
        let half_reciprocal = (self.half_reciprocal)(length);
        let diffuse = self.ramp.quotient::<EXACT>(light, half_reciprocal);
        let highlight = self.lookup.at(upper(half as i32, half_reciprocal));
        self.ramp.colour::<PIXEL>(diffuse, highlight)
    }
}

/// Diffuse light from a numerator and a length, where there is no highlight.
struct DiffuseOnly<'a, C: Pixel, R, const EXACT: bool> {
    ramp: OneLightRamp<'a, C>,
    /// The entry of the table where there is no highlight.
    floor: u32,
    half_reciprocal: R,
}

impl<C: Pixel, R: Copy, const EXACT: bool> Clone for DiffuseOnly<'_, C, R, EXACT> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C: Pixel, R: Copy, const EXACT: bool> Copy for DiffuseOnly<'_, C, R, EXACT> {}

impl<C: Pixel, V, R: Fn(V) -> i32 + Copy, const EXACT: bool> PixelShader<([u32; 1], V)> for DiffuseOnly<'_, C, R, EXACT> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn shade(&self, ([light], length): ([u32; 1], V)) -> C {
        let diffuse = self.ramp.quotient::<EXACT>(light, (self.half_reciprocal)(length));
        self.ramp.colour::<PIXEL>(diffuse, self.floor)
    }
}

impl<C: Pixel> OneLightRamp<'_, C> {
    /// The diffuse level of a numerator times half a reciprocal length.
    #[inline(always)]
    fn quotient<const EXACT: bool>(&self, light: u32, half_reciprocal: i32) -> u32 {
        let diffuse = upper(light as i32, half_reciprocal).max(0);
        (if EXACT { diffuse } else { diffuse.min(self.node(1 << COSINE, PIXEL)) }) as u32
    }
}

/// Draws `setup` under one constant light on a material of one channel; `None` if the table of highlights does not hold levels.
/// `half_reciprocal` computes half a reciprocal length, Q2.30, from the walked field `length`, `EXACT` or not.
#[inline(always)]
pub(super) fn draw<const EXACT: bool, F: Field, C: Pixel>(
    setup: &TriangleSetup<'_>,
    length: impl FnOnce() -> F,
    half_reciprocal: impl Fn(F::Value) -> i32 + Copy,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let ramp = tables.one_light_ramp()?;
    let reflectance = tables.reflectance;
    let lookup = QuotientLookup::new(&reflectance.highlight_lut);
    let [a, b, c] = setup.corners;
    let light = || {
        let nodes = [ramp.node(a.light[0], NODE), ramp.node(b.light[0], NODE), ramp.node(c.light[0], NODE)];
        Nodes::<3, 1, RANGE>::new([nodes], LEVEL - NODE).fit(setup.gradients)
    };
    if setup.has_no_highlight(reflectance) {
        let floor = reflectance.highlight_lut.least();
        if a.light[0].max(b.light[0]).max(c.light[0]) <= 0 {
            return Some(setup.fill(|| Constant, Solid(ramp.colour::<PIXEL>(0, floor)), band));
        }
        let patch = || (light(), length().fit(setup.gradients));
        return Some(setup.fill(patch, DiffuseOnly::<_, _, EXACT> { ramp, floor, half_reciprocal }, band));
    }
    let patch = || {
        let half = [lookup.node(a.light[1]), lookup.node(b.light[1]), lookup.node(c.light[1])];
        // Two planes of one channel, because the compiler keeps one plane of two channels in memory.
        ((light(), Nodes::<3, 1, STEPS>::new([half], highlight_lookup::EXTRA).fit(setup.gradients)), length().fit(setup.gradients))
    };
    Some(setup.fill(patch, OneLight::<_, _, EXACT> { ramp, lookup, half_reciprocal }, band))
}
