//! Phong shading where lights or the viewer are near, in loops of its own.
//!
//! One light, where either it or the viewer is near, is drawn here by the [`products`] of N, F and P. Several lights, and lights with a cone, are added
//! one by one to a sum ([`term`]).
//!
//! Many triangles have no highlight, as the coefficients of these polynomials tell. Under a near light these are drawn from |N|², |P|² and N·P alone.
//! For a near viewer they are drawn as for an infinitely far one. A light with a range is weaker by its squared distance, which is |P|².
//!
//! Cost: with a highlight 8 products to evaluate the polynomials, 3 roots from a table, 7 products more and the table of highlights; without one two
//! roots and three products. Error: the tables' error; the three roots err by at most 4.5e-6 together, which is 0.15 of 1/255 at the exponent 128.
//! Beyond this exponent the general loop draws highlights.

mod products;
pub(super) mod term;

use crate::{
    arch::product::upper,
    features::SUMS_LIGHTS,
    format::COSINE,
    lighting::{
        constant_lights::{DiffuseOnly, LitColours, OneLightRamp, OneLightRgb, Shades, WithHighlight, node},
        lights::{Lighting, Viewer},
        material_tables::MaterialTables,
        reflectance::Reflectance,
        shape::CoarseNearness,
    },
    math::{
        highlight_lut::CosineLookup,
        rsqrt::{HalfRsqrt, LEAST},
    },
    method::{
        CornerCosines, Shading, Style, TriangleSetup,
        cosines::{
            lit::{AtPixel, FromValues, LitShader},
            scale::Lengths,
        },
        node::{farthest, is_steep},
        products::signed,
    },
    pixel::{Pixel, by_rows::ByRows},
    raster::band::Band,
};
use products::{DiffuseProducts, HALF, Products, half};

/// One, Q2.30.
const ONE: i32 = 1 << COSINE;
/// Cosines of N and H where there is no highlight.
const BEHIND: [i32; 3] = [-ONE; 3];

/// The largest exponent of a highlight that these loops draw: their three roots err by 0.15 of 1/255 there.
const STEEPEST: u16 = 128;

/// Whether there are loops for `style`.
pub(crate) fn take(style: Style) -> bool {
    style.near_loops && style.is_plain && !style.perspective
}

/// Whether there are loops for a surface under these lights, of which one or the viewer is near.
pub(crate) fn have_loops(lighting: &Lighting, reflectance: &Reflectance) -> bool {
    match reflectance.lights {
        0 => false,
        1 => lighting.has_one_near(),
        _ => SUMS_LIGHTS,
    }
}

/// Whether there are loops for the lights and the surface of a triangle. A method that takes more styles than they do asks for it.
pub(crate) fn suits(setup: &TriangleSetup<'_>, shading: &Shading<'_>, reflectance: &Reflectance) -> bool {
    !setup.has_texture() && !setup.perspective && have_loops(shading.lighting, reflectance)
}

/// How a triangle has been drawn, or is to be drawn.
pub(crate) enum Drawn {
    /// The number of its pixels in the band.
    Pixels(u32),
    /// The triangle is to be drawn as under an infinitely far viewer, by these cosines.
    Constantly(CornerCosines),
}

/// Draws `setup` under one near light or for a near viewer. `None` if the general loop has to draw it.
#[inline(never)]
pub(crate) fn draw<C: Pixel>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<Drawn> {
    let [source] = shading.lighting.sources() else { return None };
    match (shading.lighting.viewer(), source.directional(), source.point()) {
        (Viewer::Local(eye), Some(&[towards, _]), _) => {
            let light = setup.corner_cosines(towards);
            // What the band above has saved has no highlight: polynomials of all others are too long.
            if setup.place.is_none() {
                let products = Products::new(setup, eye, towards)?;
                if products.may_have_highlight(setup, light, tables.reflectance) {
                    return draw_highlight::<false, C>(setup, &products, light, Whole, shading, tables, band).map(Drawn::Pixels);
                }
            }
            Some(Drawn::Constantly([light, BEHIND]))
        }
        (Viewer::Infinite(towards), None, Some(position)) => {
            let pixels = if let Some((shape, _)) = source.shape() {
                let nearness = shape.nearness(farthest(setup.vertices(), position)).coarse()?;
                let left = Ranged { nearness, floor: tables.reflectance.highlights.floor() };
                draw_by_near_light(setup, [position, towards], left, shading, tables, band)
            } else {
                draw_by_near_light(setup, [position, towards], Whole, shading, tables, band)
            };
            pixels.map(Drawn::Pixels)
        }
        _ => None,
    }
}

/// Draws `setup` under a light at `position`, Q7.25. Its range leaves `left` of it. `towards` is the direction to the viewer, Q2.30.
fn draw_by_near_light<C: Pixel>(
    setup: &TriangleSetup<'_>,
    [position, towards]: [[i32; 3]; 2],
    left: impl Left,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let ramp = if tables.reflectance.three_channels() { tables.diffuse_ramp() } else { tables.one_light_ramp() };
    // What the band above has saved has no highlight: polynomials of all others are too long. It is loaded in place of this one.
    let mut patch = DiffuseProducts::default();
    if setup.place.is_none() {
        let products = Products::new(setup, position, towards)?;
        let view = setup.corner_cosines(towards);
        if ramp.is_none() || products.may_have_highlight(setup, view, tables.reflectance) {
            return draw_highlight::<true, C>(setup, &products, view, left, shading, tables, band);
        }
        patch = products.diffuse_patch(setup, Lengths::of(setup, false)?.square_apart(setup));
    }
    setup.count(band.top, &mut band.counts.without_highlight, 1);
    Some(setup.fill(|| patch, LitShader::of::<DiffuseOnly>(ramp?, Diffuse { lengths: HalfRsqrt::get(), left }), band))
}

/// Draws `setup` with a highlight. `fixed` is N·F at the corners, Q2.30. `LIGHT` tells whether the light is near and not the viewer.
#[inline(never)]
fn draw_highlight<const LIGHT: bool, C: Pixel>(
    setup: &TriangleSetup<'_>,
    products: &Products,
    fixed: [i32; 3],
    left: impl Left,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    if shading.exponent > STEEPEST || !setup.gradients.walks_in_words() || !products.have_half() {
        return None;
    }
    let patch = products.patch(setup, fixed, Lengths::of(setup, is_steep(shading.exponent))?.square_apart(setup));
    let (lookup, lengths) = (shading.reflectance.table()?.by_cosine(), HalfRsqrt::get());
    let at = FromProducts::<LIGHT, _> { lookup, lengths, left };
    let colours = match tables.one_light_rgb() {
        Some(colours) => Either::Rgb(colours),
        None => Either::Ramp(tables.one_light_ramp()?),
    };
    Some(setup.screen.draw(setup.gradients, patch, LitShader::of::<WithHighlight>(colours, at), band))
}

/// What is left of a near light at a pixel.
trait Left: Copy {
    /// What is left of a cosine, Q5.27, and a highlight at the squared distance |P|², which is walked as the table of reciprocal roots is indexed.
    fn of(&self, light: CosineAndHighlight, square: u32) -> CosineAndHighlight;
}

/// A light that is as strong everywhere, or a near viewer.
#[derive(Clone, Copy)]
struct Whole;

impl Left for Whole {
    #[inline]
    fn of(&self, light: CosineAndHighlight, _: u32) -> CosineAndHighlight {
        light
    }
}

/// A light that has a range.
#[derive(Clone, Copy)]
struct Ranged {
    nearness: CoarseNearness,
    /// The entry of the table of highlights where there is none.
    floor: u32,
}

/// |P|², unsigned Q0.32, as it is walked, from the form in which the table of reciprocal roots is indexed.
#[inline]
fn squared(square: u32) -> u32 {
    // Rounding may carry it a little below the least square, or above 1, which does not fit.
    const BELOW: u32 = 1 << 28;
    square.wrapping_add(BELOW).saturating_add(LEAST - BELOW)
}

impl Left for Ranged {
    #[inline]
    fn of(&self, (cosine, highlight): CosineAndHighlight, square: u32) -> CosineAndHighlight {
        let strength = self.nearness.strength(squared(square));
        let above = highlight.wrapping_sub(self.floor);
        (upper(cosine, strength) << 2, self.floor + (above.wrapping_mul(strength as u32 >> 14) >> 16))
    }
}

/// Values at the pixel are walked products. `LIGHT` tells whether the light is near and not the viewer.
#[derive(Clone, Copy)]
struct FromProducts<'a, const LIGHT: bool, W> {
    lookup: CosineLookup<'a>,
    lengths: &'a HalfRsqrt,
    left: W,
}

/// The values of the polynomials that [`Products::patch`] fits.
type Value = ([u32; 1], (([u32; 1], [u32; 1]), ([u32; 1], [u32; 1])));

/// N·L, Q5.27, and a highlight.
type CosineAndHighlight = (i32, u32);

/// Fraction bits of diffuse levels. A cosine in Q5.27 counts as one of Q2.30, so they have three bits less than 20.
const DIFFUSE: u32 = 17;

impl<const LIGHT: bool, W: Left> AtPixel<Value> for FromProducts<'_, LIGHT, W> {
    type Common = ();
    type Values = CosineAndHighlight;

    const BITS: u32 = DIFFUSE;

    #[inline(always)]
    fn at(&self, ([nn], (([pp], [np]), ([nf], [fp]))): Value) -> ((), CosineAndHighlight) {
        let (normal, near) = (self.lengths.rsqrt(nn) as i32, self.lengths.rsqrt(pp) as i32);
        let np = upper(signed(np), near);
        let half = half(self.lengths, signed(nf), np, upper(signed(fp), near));
        let light = if LIGHT { np << 3 } else { signed(nf) };
        ((), self.left.of((upper(light, normal), self.lookup.at(upper(half << (COSINE - HALF), normal))), pp))
    }
}

impl FromValues<(), CosineAndHighlight> for WithHighlight {
    #[inline(always)]
    fn from_values((): &(), full: u16, (cosine, highlight): CosineAndHighlight) -> Self {
        Self(node(full, cosine, 20), highlight)
    }
}

/// Values at the pixel are the walked products of diffuse light from a near light.
#[derive(Clone, Copy)]
struct Diffuse<'a, W> {
    lengths: &'a HalfRsqrt,
    left: W,
}

impl<W: Left> AtPixel<([u32; 1], ([u32; 1], [u32; 1]))> for Diffuse<'_, W> {
    type Common = ();
    /// N·L, Q5.27.
    type Values = i32;

    const BITS: u32 = DIFFUSE;

    #[inline(always)]
    fn at(&self, ([nn], ([pp], [np])): ([u32; 1], ([u32; 1], [u32; 1]))) -> ((), i32) {
        let np = upper(signed(np), self.lengths.rsqrt(pp) as i32);
        // There is no highlight. The compiler drops what would be left of one.
        let (cosine, _) = self.left.of((upper(np << 3, self.lengths.rsqrt(nn) as i32), 0), pp);
        ((), cosine)
    }
}

impl FromValues<(), i32> for DiffuseOnly {
    #[inline(always)]
    fn from_values((): &(), full: u16, cosine: i32) -> Self {
        Self(node(full, cosine, 20))
    }
}

/// The colours of a material in one channel or three, which are told apart at each pixel: a loop for each would be much code.
#[derive(Clone, Copy)]
enum Either<'a, C: Pixel> {
    Ramp(OneLightRamp<'a, C>),
    Rgb(OneLightRgb<'a, C>),
}

impl<C: Pixel> ByRows for Either<'_, C> {
    #[inline]
    fn step_row(&mut self) {
        match self {
            Self::Ramp(colours) => colours.step_row(),
            Self::Rgb(colours) => colours.step_row(),
        }
    }
}

impl<C: Pixel> LitColours for Either<'_, C> {
    type Pixel = C;

    #[inline]
    fn diffuse(&self) -> u16 {
        match self {
            Self::Ramp(colours) => colours.diffuse(),
            Self::Rgb(colours) => colours.diffuse(),
        }
    }
}

impl<C: Pixel> Shades<WithHighlight> for Either<'_, C> {
    #[inline]
    fn colour(&self, bits: u32, light: WithHighlight) -> C {
        match self {
            Self::Ramp(colours) => colours.colour(bits, light),
            Self::Rgb(colours) => colours.colour(bits, light),
        }
    }
}
