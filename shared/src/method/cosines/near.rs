//! Phong shading under one light where either the light or the viewer is near, in loops of its own.
//!
//! P is the vector from the surface to what is near, the light or the viewer. It is linear over a triangle, as the normal N is. F is the direction to
//! the other, which is the same everywhere. So N·F and F·P are linear, and N·P, |N|² and |P|² exactly quadratic; all are walked. The half vector of
//! light and viewer is the same whichever of them is near. P is measured in units of its length at the farthest corner, so it is 1/2 to 1 long unless
//! what is near is close. Three squares then lie in the table of reciprocal roots, without counting of leading zeros: |P|², |N|², and a quarter of
//! |F + P|², which is 2 + 2 F·P where P has the length 1.
//!
//! Many triangles have no highlight, as the coefficients of these polynomials tell. Under a near light these are drawn from |N|², |P|² and N·P alone.
//! For a near viewer they are drawn as for an infinitely far one.
//!
//! A light with a range is weaker by its squared distance, which is |P|²; a light with a cone is drawn by the general loop.
//!
//! Cost: with a highlight 8 products to evaluate the polynomials, 3 roots from a table, 7 products more and the table of highlights; without one two
//! roots and three products. Error: the tables' error; the three roots err by at most 4.5e-6 together, which is 0.15 of 1/255 at the exponent 128.
//! Beyond this exponent the general loop draws highlights.

use crate::{
    arch::product::upper,
    features::VERTEX_COLOURS,
    format::{COSINE, UNIT},
    interpolate::{by_column::ByColumn, field::Nodes, plane::Plane, quadric::Quadric},
    lighting::{
        albedo::Albedo,
        constant_lights::{Coloured, DiffuseOnly, LitColours, OneLightRamp, OneLightRgb, Shades, WithHighlight, node},
        lights::{Viewer, point},
        material_tables::MaterialTables,
        reflectance::Reflectance,
        shape::{CoarseNearness, Shape},
    },
    math::{
        highlight_lut::CosineLookup,
        rsqrt::{HalfRsqrt, LEAST},
        vector::{dot, map, over_longest, sub, wide},
    },
    method::{
        CornerCosines, Shading, Style, TriangleSetup,
        cosines::{
            lit::{AtPixel, FromValues, LitShader},
            quotient::colour,
            scale::Lengths,
        },
        largest,
        node::{FRACTION, coefficients, field_product, is_steep, map_six},
        products::{FIELD_BITS, fitted, linear, quadratic, signed},
    },
    pixel::{Pixel, by_rows::ByRows},
    raster::band::Band,
    stream::record::Vertex,
};

/// One, Q2.30.
const ONE: i32 = 1 << COSINE;
/// Cosines of N and H where there is no highlight.
const BEHIND: [i32; 3] = [-ONE; 3];

/// The largest exponent of a highlight that these loops draw: their three roots err by 0.15 of 1/255 there.
const STEEPEST: u16 = 128;

/// Fraction bits of N·H.
const HALF: u32 = 25;

/// Whether there are loops for `style`.
pub(crate) fn take(style: Style) -> bool {
    style.one_near && style.is_plain() && !style.perspective
}

/// Whether the loops suit the light and the surface of a triangle. A method that takes more styles than they do asks for it.
pub(crate) fn suits(setup: &TriangleSetup<'_>, shading: &Shading<'_>, reflectance: &Reflectance) -> bool {
    !setup.has_texture() && !setup.perspective && reflectance.lights() == 1 && shading.lighting.has_one_near()
}

/// How a triangle has been drawn, or is to be drawn.
pub(crate) enum Drawn {
    /// The number of its pixels in the band.
    Pixels(u32),
    /// The triangle is to be drawn as under an infinitely far viewer, by these cosines.
    Constantly(CornerCosines),
}

/// Draws `setup` under a near light or for a near viewer. `None` if the general loop has to draw it.
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
            draw_by_near_light(setup, [position, towards], shading, tables, band).map(Drawn::Pixels)
        }
        _ => None,
    }
}

/// Draws `setup` under a light at `position`, Q7.25, where `towards` is the direction to the viewer, Q2.30.
fn draw_by_near_light<C: Pixel>(
    setup: &TriangleSetup<'_>,
    [position, towards]: [[i32; 3]; 2],
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let [source] = shading.lighting.sources() else { return None };
    if let Some((shape, _)) = source.shape() {
        let left = Ranged { nearness: distances(setup, position, shape)?, floor: tables.reflectance.highlights.floor() };
        return draw_weakened(setup, [position, towards], left, shading, tables, band);
    }
    draw_weakened(setup, [position, towards], Whole, shading, tables, band)
}

/// [`draw_by_near_light`] with what its range leaves of it.
fn draw_weakened<C: Pixel>(
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
    if shading.exponent > STEEPEST || !setup.gradients.walks_in_words() {
        return None;
    }
    let patch = products.patch(setup, fixed, Lengths::of(setup, is_steep(shading.exponent))?.square_apart(setup));
    let (lookup, lengths) = (shading.reflectance.table()?.by_cosine(), HalfRsqrt::get());
    let at = FromProducts::<LIGHT, _> { lookup, lengths, left };
    let sums;
    let colours = match (setup.albedos(), tables.one_light_rgb()) {
        (Some(albedos), Some(_)) if VERTEX_COLOURS => match Albedo::one(albedos) {
            Some(albedo) => {
                sums = tables.painted_sums(albedo);
                Either::Rgb(OneLightRgb::of(&sums))
            }
            None => {
                let shader = LitShader::of::<Coloured<WithHighlight>>(tables.coloured_rgb(), at);
                return Some(setup.screen.draw(setup.gradients, (patch, colour(setup, albedos)), shader, band));
            }
        },
        (_, Some(colours)) => Either::Rgb(colours),
        (_, None) => Either::Ramp(tables.one_light_ramp()?),
    };
    Some(setup.screen.draw(setup.gradients, patch, LitShader::of::<WithHighlight>(colours, at), band))
}

/// Products of N, F and P at the corners or at six nodes of a triangle, Q2.30; the longest P is 1.
struct Products {
    /// N·P.
    np: [i32; 6],
    /// |P|², at least 1/4.
    pp: [i32; 6],
    /// F·P, at least -1/4.
    fp: [i32; 3],
}

/// The quadratics |N|², |P|² and N·P, and the planes N·F and F·P: more than there are registers.
type HighlightProducts = ByColumn<(Quadric<1>, ((Quadric<1>, Quadric<1>), (Plane<1>, Plane<1>)))>;
/// The quadratics |N|², |P|² and N·P.
type DiffuseProducts = ByColumn<(Quadric<1>, (Quadric<1>, Quadric<1>))>;

impl Products {
    /// The products for what is near at `near`, Q7.25, and the other in the direction `fixed`, Q2.30. `None` if lengths leave the table of reciprocal
    /// roots: where what is near is close, or opposite of the other.
    #[inline(never)]
    fn new(setup: &TriangleSetup<'_>, near: [i32; 3], fixed: [i32; 3]) -> Option<Self> {
        let [a, b, c] = setup.vertices();
        let half = |[x, y, z]: [i32; 3]| [x >> 1, y >> 1, z >> 1];
        let (near, way) = (half(near), |vertex: &Vertex| half(point(vertex.position)));
        let [u, v, w] = over_longest::<FRACTION>([sub(near, way(a)), sub(near, way(b)), sub(near, way(c))]);
        let way = [u, v, w];
        let pp = field_product(&way, &way);
        let cosine = |v| (dot(fixed, v) >> FRACTION) as i32;
        let fp = [cosine(u), cosine(v), cosine(w)];
        if least(coefficients(pp)) < ONE / 4 || fp[0].min(fp[1]).min(fp[2]) < -ONE / 4 {
            return None;
        }
        let normal = |vertex: &Vertex| {
            let [x, y, z] = wide(vertex.normal);
            [x << (FRACTION - UNIT), y << (FRACTION - UNIT), z << (FRACTION - UNIT)]
        };
        let np = field_product(&[normal(a), normal(b), normal(c)], &way);
        Some(Self { np, pp, fp })
    }

    /// Whether a highlight may be visible on the triangle, from N·F at the corners.
    fn may_have_highlight(&self, setup: &TriangleSetup<'_>, fixed: [i32; 3], reflectance: &Reflectance) -> bool {
        self.largest_half(fixed) >= setup.highlight_threshold(reflectance) >> (COSINE - HALF)
    }

    /// A bound of N·H on the triangle, Q7.25, from N·F at the corners.
    fn largest_half(&self, fixed: [i32; 3]) -> i32 {
        let lengths = HalfRsqrt::get();
        let half_reciprocal = lengths.rsqrt(above_least(least(coefficients(self.pp)))) as i32;
        let [a, b, c, ab, bc, ca] = coefficients(self.np);
        let np = a.max(b).max(c).max(ab).max(bc).max(ca).max(0);
        // Where F·P is positive it grows by the division, which is left out.
        let fp = self.fp[0].min(self.fp[1]).min(self.fp[2]);
        half(lengths, largest(&fixed), upper(np, half_reciprocal), upper(fp, half_reciprocal).min(fp >> 3))
    }

    /// The polynomials of all products.
    #[inline(never)]
    fn patch(&self, setup: &TriangleSetup<'_>, fixed: [i32; 3], length: Quadric<1>) -> HighlightProducts {
        let plane = |corners| fitted(&linear([corners]), setup.gradients);
        let ByColumn((length, quadratics)) = self.diffuse_patch(setup, length);
        ByColumn((length, (quadratics, (plane(fixed), plane(self.fp)))))
    }

    /// The polynomials without those that highlights alone need.
    #[inline(never)]
    fn diffuse_patch(&self, setup: &TriangleSetup<'_>, length: Quadric<1>) -> DiffuseProducts {
        let pp = Nodes::<6, 1, { FIELD_BITS - 2 }>::new([map_six(self.pp, |square| (above_least(square) >> 8) as i32)], 8);
        ByColumn((length, (fitted(&pp, setup.gradients), fitted(&quadratic([self.np]), setup.gradients))))
    }
}

/// The least of six values.
fn least([a, b, c, ab, bc, ca]: [i32; 6]) -> i32 {
    a.min(b).min(c).min(ab).min(bc).min(ca)
}

/// |P|², Q2.30, as the table of reciprocal roots is indexed.
#[inline(always)]
fn above_least(square: i32) -> u32 {
    ((square as u32) << 2).wrapping_sub(LEAST)
}

/// N·H, Q7.25, from N·F, Q2.30, and N·P and F·P, Q5.27, where P has the length 1 and N any.
#[inline(always)]
fn half(lengths: &HalfRsqrt, nf: i32, np: i32, fp: i32) -> i32 {
    // |F + P|² / 4 = (1 + F·P) / 2, of which half the reciprocal root is 1 / |F + P|.
    let quarter = (1u32 << 31).wrapping_add((fp as u32) << 4);
    upper((nf >> 3) + np, lengths.rsqrt(quarter.wrapping_sub(LEAST)) as i32)
}

/// What is left of a near light at a pixel.
trait Left: Copy {
    /// What is left of a cosine, Q5.27, and a highlight at the squared distance |P|², which is walked as the table of reciprocal roots is indexed.
    fn of(&self, light: CosineAndHighlight, square: u32) -> CosineAndHighlight;

    /// What is left of a cosine, Q5.27.
    fn of_diffuse(&self, cosine: i32, square: u32) -> i32;
}

/// A light that is as strong everywhere, or a near viewer.
#[derive(Clone, Copy)]
struct Whole;

impl Left for Whole {
    #[inline(always)]
    fn of(&self, light: CosineAndHighlight, _: u32) -> CosineAndHighlight {
        light
    }

    #[inline(always)]
    fn of_diffuse(&self, cosine: i32, _: u32) -> i32 {
        cosine
    }
}

/// A light that has a range.
#[derive(Clone, Copy)]
struct Ranged {
    nearness: CoarseNearness,
    /// The entry of the table of highlights where there is none.
    floor: u32,
}

impl Ranged {
    /// The strength, Q2.30.
    #[inline(always)]
    fn strength(&self, square: u32) -> i32 {
        // Rounding may carry it a little below the least square, or above 1, which does not fit.
        const BELOW: u32 = 1 << 28;
        self.nearness.strength(square.wrapping_add(BELOW).saturating_add(LEAST - BELOW))
    }
}

impl Left for Ranged {
    #[inline(always)]
    fn of(&self, (cosine, highlight): CosineAndHighlight, square: u32) -> CosineAndHighlight {
        let strength = self.strength(square);
        let above = highlight.wrapping_sub(self.floor);
        (upper(cosine, strength) << 2, self.floor + ((above * (strength as u32 >> 14)) >> 16))
    }

    #[inline(always)]
    fn of_diffuse(&self, cosine: i32, square: u32) -> i32 {
        upper(cosine, self.strength(square)) << 2
    }
}

/// The squared distance of the farthest corner, which |P|² counts as 1, as a part of the light's range.
fn distances(setup: &TriangleSetup<'_>, position: [i32; 3], shape: &Shape) -> Option<CoarseNearness> {
    let half = |vertex: &Vertex| map(sub(position, point(vertex.position)), |c| c >> 1);
    let square = |vertex| {
        let way = half(vertex);
        dot(way, way) as u64
    };
    let [a, b, c] = setup.vertices();
    shape.nearness(square(a).max(square(b)).max(square(c))).coarse()
}

/// Values at the pixel are walked products. `LIGHT` tells whether the light is near and not the viewer.
#[derive(Clone, Copy)]
struct FromProducts<'a, const LIGHT: bool, W> {
    lookup: CosineLookup<'a>,
    lengths: &'a HalfRsqrt,
    left: W,
}

/// The values of [`HighlightProducts`].
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

/// The walked products, and the colour of the surface beside them.
impl<S, const LIGHT: bool, W: Left> AtPixel<(Value, S)> for FromProducts<'_, LIGHT, W> {
    type Common = ();
    type Values = (CosineAndHighlight, S);

    const BITS: u32 = DIFFUSE;

    #[inline(always)]
    fn at(&self, (products, colour): (Value, S)) -> ((), (CosineAndHighlight, S)) {
        let ((), light) = self.at(products);
        ((), (light, colour))
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
        ((), self.left.of_diffuse(upper(np << 3, self.lengths.rsqrt(nn) as i32), pp))
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
    #[inline(always)]
    fn step_row(&mut self) {
        match self {
            Self::Ramp(colours) => colours.step_row(),
            Self::Rgb(colours) => colours.step_row(),
        }
    }
}

impl<C: Pixel> LitColours for Either<'_, C> {
    type Pixel = C;

    const TABLED: bool = false;

    #[inline(always)]
    fn diffuse(&self) -> u16 {
        match self {
            Self::Ramp(colours) => colours.diffuse(),
            Self::Rgb(colours) => colours.diffuse(),
        }
    }
}

impl<C: Pixel> Shades<WithHighlight> for Either<'_, C> {
    #[inline(always)]
    fn colour(&self, bits: u32, light: WithHighlight) -> C {
        match self {
            Self::Ramp(colours) => colours.colour(bits, light),
            Self::Rgb(colours) => colours.colour(bits, light),
        }
    }
}
