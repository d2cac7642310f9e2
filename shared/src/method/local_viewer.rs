//! Phong shading under one directional light and a local viewer, in loops of its own.
//!
//! The vector V from the surface to the viewer is linear over a triangle, as its normal N is. So N·L and L·V are linear, and N·V, |N|² and |V|²
//! exactly quadratic; all are walked. V is measured in units of its length at the farthest corner, so it is 1/2 to 1 long unless the viewer is close.
//! Three squares then lie in the table of reciprocal roots, without counting of leading zeros: |V|², |N|², and a quarter of |L + V|², which is 2 + 2
//! L·V where V has the length 1.
//!
//! Many triangles have no highlight, as the coefficients of these polynomials tell. They are drawn as under an infinitely far viewer.
//!
//! Cost: 8 products to evaluate the polynomials, 3 roots from a table, 7 products more and the table of highlights. Error: the tables' error; the
//! three roots err by at most 4.5e-6 together, which is 0.07 of 1/255 at the exponent 64. Beyond this exponent the general loop draws.

use crate::{
    arch::product::upper,
    format::{COSINE, UNIT},
    interpolate::{by_column::ByColumn, field::Nodes, plane::Plane, quadric::Quadric},
    lighting::{
        constant_lights::{LitColours, OneLightRamp, OneLightRgb, Shades, WithHighlight, node},
        lights::point,
        material_tables::MaterialTables,
    },
    math::{
        highlight_lut::CosineLookup,
        rsqrt::{HalfRsqrt, LEAST},
        vector::{dot, over_longest, sub, wide},
    },
    method::{
        CornerCosines, Shading, Style, TriangleSetup, duff, largest,
        lighting_model::{BITS, fitted, linear, quadratic, signed},
        lit::{AtPixel, FromValues, LitShader},
        node::{FRACTION, field_product, is_steep, map_six},
    },
    pixel::{Pixel, dither::ByRows},
    raster::band::Band,
    stream::record::Vertex,
};

/// One, Q2.30.
const ONE: i32 = 1 << COSINE;
/// Cosines of N and H where there is no highlight.
const BEHIND: [i32; 3] = [-ONE; 3];

/// Fraction bits of N·H.
const HALF: u32 = 25;

/// Whether there are loops for `style`.
pub(crate) fn take(style: Style) -> bool {
    style.local_viewer && !style.by_canvas && !style.perspective
}

/// Draws `setup` as seen from `eye`, Q7.25, and returns the number of its pixels in `band`. If it has no highlight, returns the cosines by which it
/// is drawn as under an infinitely far viewer. `None` if the general loop has to draw it.
#[inline(never)]
pub(crate) fn draw<C: Pixel>(
    setup: &TriangleSetup<'_>,
    eye: [i32; 3],
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<Result<u32, CornerCosines>> {
    let [source] = shading.lighting.sources() else { return None };
    let &[towards, _] = source.directional()?;
    let light = setup.corner_cosines(towards);
    // What the band above has saved has no highlight: polynomials of all others are too long.
    if setup.place.is_none() {
        let products = Products::new(setup, eye, towards)?;
        if products.largest_half(light) >= setup.highlight_threshold(tables.reflectance) >> (COSINE - HALF) {
            if is_steep(shading.exponent) || !setup.gradients.walks_in_words() {
                return None;
            }
            let length = duff::tabled(setup)?;
            let patch = products.patch(setup, light, length);
            let (lookup, lengths) = (shading.reflectance.table()?.by_cosine(), HalfRsqrt::get());
            let colours = match tables.one_light_rgb() {
                Some(colours) => Either::Rgb(colours),
                None => Either::Ramp(tables.one_light_ramp()?),
            };
            let shader = LitShader::of::<WithHighlight>(colours, FromProducts { lookup, lengths });
            return Some(Ok(setup.screen.draw(setup.gradients, patch, shader, band)));
        }
    }
    Some(Err([light, BEHIND]))
}

/// Products of N, L and V at the corners or at six nodes of a triangle, Q2.30; the longest V is 1.
struct Products {
    /// N·V.
    nv: [i32; 6],
    /// |V|², at least 1/4.
    vv: [i32; 6],
    /// L·V, at least -1/4.
    lv: [i32; 3],
}

/// The quadratics |N|², |V|² and N·V, and the planes N·L and L·V: more than there are registers.
type Walked = ByColumn<(Quadric<1>, ((Quadric<1>, Quadric<1>), (Plane<1>, Plane<1>)))>;

impl Products {
    /// The products under a light in the direction `towards`, Q2.30. `None` if lengths leave the table of reciprocal roots: where the
    /// viewer is close, or opposite of the light.
    #[inline(never)]
    fn new(setup: &TriangleSetup<'_>, eye: [i32; 3], towards: [i32; 3]) -> Option<Self> {
        let [a, b, c] = setup.vertices();
        let half = |[x, y, z]: [i32; 3]| [x >> 1, y >> 1, z >> 1];
        let (eye, view) = (half(eye), |vertex: &Vertex| half(point(vertex.position)));
        let [u, v, w] = over_longest::<FRACTION>([sub(eye, view(a)), sub(eye, view(b)), sub(eye, view(c))]);
        let view = [u, v, w];
        let vv = field_product(&view, &view);
        let cosine = |v| (dot(towards, v) >> FRACTION) as i32;
        let lv = [cosine(u), cosine(v), cosine(w)];
        if least(coefficients(vv)) < ONE / 4 || lv[0].min(lv[1]).min(lv[2]) < -ONE / 4 {
            return None;
        }
        let normal = |vertex: &Vertex| {
            let [x, y, z] = wide(vertex.normal);
            [x << (FRACTION - UNIT), y << (FRACTION - UNIT), z << (FRACTION - UNIT)]
        };
        let nv = field_product(&[normal(a), normal(b), normal(c)], &view);
        Some(Self { nv, vv, lv })
    }

    /// A bound of N·H on the triangle, Q7.25, from N·L at the corners.
    fn largest_half(&self, light: [i32; 3]) -> i32 {
        let lengths = HalfRsqrt::get();
        let half_reciprocal = lengths.rsqrt(above_least(least(coefficients(self.vv)))) as i32;
        let [a, b, c, ab, bc, ca] = coefficients(self.nv);
        let nv = a.max(b).max(c).max(ab).max(bc).max(ca).max(0);
        // Where L·V is positive it grows by the division, which is left out.
        let lv = self.lv[0].min(self.lv[1]).min(self.lv[2]);
        half(lengths, largest(&light), upper(nv, half_reciprocal), upper(lv, half_reciprocal).min(lv >> 3))
    }

    /// The polynomials of all products.
    #[inline(never)]
    fn patch(&self, setup: &TriangleSetup<'_>, light: [i32; 3], length: Nodes<6, 1, { duff::HAVERSINE_RANGE }>) -> Walked {
        let vv = Nodes::<6, 1, { BITS - 2 }>::new([map_six(self.vv, |square| (above_least(square) >> 8) as i32)], 8);
        let fit = |nodes: [i32; 6]| fitted(&quadratic([nodes]), setup.gradients);
        let plane = |corners| fitted(&linear([corners]), setup.gradients);
        ByColumn((fitted(&length, setup.gradients), ((fitted(&vv, setup.gradients), fit(self.nv)), (plane(light), plane(self.lv)))))
    }
}

/// The coefficients of the quadratic through six nodes, Q2.30, in the form of Bernstein: their least and their largest are bounds.
fn coefficients([a, b, c, ab, bc, ca]: [i32; 6]) -> [i32; 6] {
    let middle = |a: i32, b: i32, ab: i32| ab + (ab - ((a >> 1) + (b >> 1)));
    [a, b, c, middle(a, b, ab), middle(b, c, bc), middle(c, a, ca)]
}

/// The least of six values.
fn least([a, b, c, ab, bc, ca]: [i32; 6]) -> i32 {
    a.min(b).min(c).min(ab).min(bc).min(ca)
}

/// |V|², Q2.30, as the table of reciprocal roots is indexed.
#[inline]
fn above_least(square: i32) -> u32 {
    ((square as u32) << 2).wrapping_sub(LEAST)
}

/// N·H, Q7.25, from N·L, Q2.30, and N·V and L·V, Q5.27, where V has the length 1 and N any.
#[inline]
fn half(lengths: &HalfRsqrt, nl: i32, nv: i32, lv: i32) -> i32 {
    // |L + V|² / 4 = (1 + L·V) / 2, of which half the reciprocal root is 1 / |L + V|.
    let quarter = (1u32 << 31).wrapping_add((lv as u32) << 4);
    upper((nl >> 3) + nv, lengths.rsqrt(quarter.wrapping_sub(LEAST)) as i32)
}

/// Values at the pixel are walked products.
#[derive(Clone, Copy)]
struct FromProducts<'a> {
    lookup: CosineLookup<'a>,
    lengths: &'a HalfRsqrt,
}

/// The values of [`Walked`].
type Value = ([u32; 1], (([u32; 1], [u32; 1]), ([u32; 1], [u32; 1])));

/// N·L, Q5.27, and a highlight.
type CosineAndHighlight = (i32, u32);

impl AtPixel<Value> for FromProducts<'_> {
    type Common = ();
    type Values = CosineAndHighlight;

    // The cosine counts as one of Q2.30, so that the level has three bits less than 20.
    const BITS: u32 = 17;

    #[inline]
    fn at(&self, ([nn], (([vv], [nv]), ([nl], [lv]))): Value) -> ((), CosineAndHighlight) {
        let (normal, view) = (self.lengths.rsqrt(nn) as i32, self.lengths.rsqrt(vv) as i32);
        let half = half(self.lengths, signed(nl), upper(signed(nv), view), upper(signed(lv), view));
        ((), (upper(signed(nl), normal), self.lookup.at(upper(half << (COSINE - HALF), normal))))
    }
}

impl FromValues<(), CosineAndHighlight> for WithHighlight {
    #[inline]
    fn from_values((): &(), full: u16, (cosine, highlight): CosineAndHighlight) -> Self {
        Self(node(full, cosine, 20), highlight)
    }
}

/// The colours of a material in one channel or three, which are told apart at each pixel: a loop for each would be much code.
#[derive(Clone, Copy)]
enum Either<'a, C: Pixel> {
    Ramp(OneLightRamp<'a, C>),
    Rgb(OneLightRgb<'a, C>),
}

impl<C: Pixel> ByRows for Either<'_, C> {
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

    fn diffuse(&self) -> u16 {
        match self {
            Self::Ramp(colours) => colours.diffuse(),
            Self::Rgb(colours) => colours.diffuse(),
        }
    }
}

impl<C: Pixel> Shades<WithHighlight> for Either<'_, C> {
    fn colour(&self, bits: u32, light: WithHighlight) -> C {
        match self {
            Self::Ramp(colours) => colours.colour(bits, light),
            Self::Rgb(colours) => colours.colour(bits, light),
        }
    }
}
