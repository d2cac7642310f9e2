//! Loops under any lights. The diffuse light of most constant lights is one sum, see [`crate::lighting::summed`]. Lights that end on a triangle are added
//! one by one at each pixel, and so are highlights and near lights. On processors with kernels for it, up to two highlights are walked beside the sum
//! instead, if no light ends on the triangle.
//!
//! Cost: that of three planes and a root for the sum; five products for each light that ends, and for each highlight the same and its table; for near
//! lights see [`super::near::term`].

use crate::{
    arch::product::{product, upper},
    features::VERTEX_COLOURS,
    format::MAX_LIGHTS,
    interpolate::{
        Patch, Walker,
        by_column::{ByColumn, Column},
        field::{Field, Nodes},
        plane::Plane,
    },
    lighting::{
        albedo::{Albedo, SHARE},
        constant_lights::{
            Coloured, DiffuseOnly, LitColours, SUMMED, Summed, SummedColours, SummedRgb, SummedWithHighlights, SurfaceColour, cosine,
        },
        lights::Viewer,
        material_tables::MaterialTables,
        summed::{Sides, at_vertex, part},
    },
    math::{
        highlight_lookup::QuotientLookup,
        highlight_lut::CosineLookup,
        rsqrt::HalfRsqrt,
        vector::{map, wide, zip},
    },
    method::{
        Shading, TriangleSetup,
        cosines::{
            lit::{FromValues, LitShader},
            near::{
                self,
                term::{NearTerm, NearTerms},
            },
            quotient::{
                DIFFUSE, DIFFUSE_NODE, DIFFUSE_RANGE, HalfReciprocal, PIXEL, Quotient, QuotientWithHighlight, colour, is_plane, numerator,
                plane,
            },
            scale::{Lengths, STEEPEST},
        },
        largest,
    },
    pixel::{Pixel, by_rows::ByRows},
    raster::{
        band::Band,
        pixel_shader::{PixelShader, has_kernels},
    },
};
use core::cell::Cell;

/// What is added at each pixel: a numerator, and a factor for each channel by which diffuse light or a highlight is multiplied.
struct Term {
    numerator: Cell<Plane<1>>,
    factors: [i32; 3],
}

/// Room for a term of each light.
type Terms = heapless::Vec<Term, MAX_LIGHTS>;

impl Term {
    /// Adds a term of `numerator`; there is room for all.
    fn add(terms: &mut Terms, numerator: Plane<1>, factors: [i32; 3]) {
        let _ = terms.push(Self { numerator: Cell::new(numerator), factors });
    }

    /// Levels to which the term adds its factors times `value`.
    #[inline]
    fn added(&self, levels: [i32; 3], value: i32) -> [i32; 3] {
        zip(levels, self.factors, |level, factor| level.wrapping_add(factor.wrapping_mul(value)))
    }

    /// Moves the numerator down by `rows`.
    #[inline(always)]
    fn jump(&self, rows: i32) {
        let mut moved = self.numerator.get();
        moved.jump(rows);
        self.numerator.set(moved);
    }

    /// The numerator at a column.
    #[inline(always)]
    fn at(&self, column: i32) -> [u32; 1] {
        self.numerator.get().enter(column).value()
    }
}

/// The lights on a triangle.
#[derive(Default)]
struct SummedLights {
    /// The sum of diffuse light at the corners in each channel, as vertices hold it.
    corners: [[i32; 3]; 3],
    /// The diffuse light of lights that end on the triangle.
    ending: Terms,
    /// The highlights that can be seen there.
    highlights: Terms,
    /// What the sums have of ambient light alone.
    ambient: [i32; 3],
    /// Whether one of these highlights can be seen. They can unless leaving out is switched off.
    is_visible: bool,
    /// Numbers of lights that reach the triangle without a highlight, and of lights that do not reach it.
    without: [u32; 2],
}

impl SummedLights {
    /// Adds the constant lights on the triangle `setup`, whose vertices hold `corners`. They are not returned, because a copy of all terms takes longer
    /// than most of what is computed here.
    #[inline(never)]
    fn add<C: Pixel>(
        &mut self,
        [a, b, c]: [[i32; 4]; 3],
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        lengths: &Lengths,
        lookup: QuotientLookup<'_>,
        tables: MaterialTables<'_, C>,
    ) {
        let (material, full) = (tables.reflectance, tables.summed_colours().diffuse());
        let sides = Sides::of_triangle([a[3], b[3], c[3]], setup.triangle.min_normal_length);
        self.corners = [[a[0], b[0], c[0]], [a[1], b[1], c[1]], [a[2], b[2], c[2]]];
        if VERTEX_COLOURS && setup.albedos().is_some() {
            self.ambient = material.pure_ambient();
        }
        // Highlights that a near viewer sees are near terms.
        let is_far = matches!(shading.lighting.viewer(), Viewer::Infinite(_));
        for (light, source) in shading.lighting.sources().iter().enumerate() {
            let Some(&[towards, half]) = source.directional() else { continue };
            let is_dark = sides.is_dark(light) && setup.leaves_out_light(material, &[0; 3]);
            if !is_dark && !sides.is_bright(light) {
                let towards = setup.corner_cosines(towards);
                let (gains, [a, b, c]) = (material.factors(light).diffuse, map(towards, |cosine| part(source, cosine)));
                for (channel, gain) in self.corners.iter_mut().zip(gains) {
                    let without = |sum: i32, part: i32| sum.wrapping_sub(gain.wrapping_mul(part));
                    *channel = [without(channel[0], a), without(channel[1], b), without(channel[2], c)];
                }
                Term::add(&mut self.ending, plane(setup, full, lengths, &towards), gains);
            }
            let mut has_highlight = is_far && !source.is_sky() && sides.may_have_highlight(light);
            if has_highlight {
                let half = setup.corner_cosines(half);
                has_highlight = !setup.leaves_out_highlight(material, &half);
                if has_highlight {
                    self.is_visible |= largest(&half) >= setup.highlight_threshold(material);
                    Term::add(&mut self.highlights, numerator(setup, lookup, lengths, &half), material.factors(light).specular);
                }
            }
            let [without_highlight, without_light] = &mut self.without;
            *without_highlight += u32::from(!has_highlight && !is_dark);
            *without_light += u32::from(!has_highlight && is_dark);
        }
    }

    /// Whether kernels can draw them: no light ends on the triangle, and at most two have a highlight there.
    #[inline]
    fn suit_kernels(&self) -> bool {
        self.ending.is_empty() && self.highlights.len() <= 2
    }

    /// Puts these lights on a surface of one colour.
    #[inline(never)]
    fn paint(&mut self, near: Option<&mut NearTerms>, albedo: Albedo) {
        let reflected = |level: i32, share: i32| ((product(level, share) + (1 << (SHARE - 1))) >> SHARE) as i32;
        self.corners = zip(self.corners, albedo.shares(), |channel, share| map(channel, |level| reflected(level, share)));
        for term in &mut self.ending {
            term.factors = zip(term.factors, albedo.shares(), reflected);
        }
        for term in near.into_iter().flatten() {
            term.paint(|gains| zip(gains, albedo.shares(), reflected));
        }
    }
}

/// Draws `setup`. `NEAR` tells whether a light or the viewer is near. `None` if a highlight or a near light is too steep, or too near.
#[inline]
pub(super) fn draw<C: Pixel, const NEAR: bool>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    lengths: &Lengths,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    if C::GRAY {
        draw_channels::<C, NEAR, 1>(|[luma, ..]| [luma], setup, shading, lengths, tables, band)
    } else {
        draw_channels::<C, NEAR, 3>(|channels| channels, setup, shading, lengths, tables, band)
    }
}

/// [`draw`] in the channels that `wanted` picks.
#[inline(never)]
fn draw_channels<C: Pixel, const NEAR: bool, const CH: usize>(
    wanted: impl Fn([[i32; 3]; 3]) -> [[i32; 3]; CH],
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    lengths: &Lengths,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32>
where
    Summed: FromValues<HalfReciprocal, [u32; CH]>,
{
    let (lookup, mut colours) = (QuotientLookup::new(tables.reflectance.table()?), tables.summed_colours());
    // The general loop draws colours at corners, and textures, in greys.
    let is_painted = !C::GRAY && setup.albedos().is_some();
    let has_texture = is_painted && setup.has_texture();
    let one_colour = if is_painted && !has_texture { setup.albedos().and_then(Albedo::one) } else { None };
    let mut lights = SummedLights::default();
    let mut near = NearTerms::new();
    let ambient;
    lights.add(
        if NEAR { at_corners(setup, shading) } else { setup.corners.map(|corner| corner.light) },
        setup,
        shading,
        lengths,
        lookup,
        tables,
    );
    if NEAR {
        near::term::add(&mut near, setup, shading)?;
    }
    if VERTEX_COLOURS && let Some(albedo) = one_colour {
        ambient = tables.painted_sums(albedo);
        lights.paint(NEAR.then_some(&mut near), albedo);
        colours = colours.in_ambient(&ambient);
    }
    let lights = &lights;
    if shading.exponent > STEEPEST && lights.is_visible {
        return None;
    }
    let [without_highlight, without_light] = lights.without;
    setup.count(band.top, &mut band.counts.without_highlight, without_highlight);
    setup.count(band.top, &mut band.counts.without_light, without_light);
    let patch = || (sums(setup, lengths, &lights.corners, &wanted), lengths.square(setup));
    let by_cosine = tables.reflectance.table()?.by_cosine();
    let shader =
        OneByOne::<C, NEAR> { colours, lookup, by_cosine, lengths: HalfRsqrt::get(), lights, near: &near, row: setup.gradients.row() };
    if const { !NEAR && !C::GRAY && has_kernels::<C>() }
        && !has_texture
        && lights.suit_kernels()
        && colours.is_fine()
        && !band.is_transparent()
    {
        let of = WithKernels { lights, colours, lookup, colour: if one_colour.is_none() { setup.albedos() } else { None } };
        return of.draw(setup, lengths, band);
    }
    if !NEAR && has_texture {
        let texels = setup.texels()?;
        return Some(setup.fill(|| (Column, (texels, ByColumn(patch()))), shader, band));
    }
    if is_painted && let (Some(albedos), None) = (setup.albedos(), one_colour) {
        return is_plane(setup, albedos).then(|| setup.fill(|| (Column, ByColumn((colour(setup, albedos), patch()))), shader, band));
    }
    if lights.ending.is_empty() && lights.highlights.is_empty() && (!NEAR || near.is_empty()) {
        return Some(setup.fill(patch, LitShader::of::<Summed>(colours, Quotient(HalfRsqrt::get())), band));
    }
    Some(setup.fill(|| (Column, ByColumn(patch())), shader, band))
}

/// What is drawn by kernels that compute light at each pixel. Domain: [`SummedLights::suit_kernels`].
struct WithKernels<'a, C: Pixel> {
    lights: &'a SummedLights,
    colours: SummedColours<'a, C>,
    lookup: QuotientLookup<'a>,
    /// The colours of the corners, unless they are the same.
    colour: Option<&'a [Albedo; 3]>,
}

impl<C: Pixel> WithKernels<'_, C> {
    #[inline(never)]
    fn draw(&self, setup: &TriangleSetup<'_>, lengths: &Lengths, band: &mut Band<'_, C>) -> Option<u32> {
        let &Self { lights, colours, lookup, colour: albedos } = self;
        let (mut factors, mut halves) = ([[0; 3]; 2], [Plane::default(); 2]);
        for ((factors, half), term) in factors.iter_mut().zip(&mut halves).zip(&lights.highlights) {
            (*factors, *half) = (term.factors, term.numerator.get());
        }
        let (shares, halves) = (colours.shares(albedos.map(|_| &lights.ambient), factors), Plane::side_by_side(halves));
        let (colours, at) = (SummedRgb::of(&shares, lights.highlights.len()), QuotientWithHighlight(lookup, HalfRsqrt::get()));
        let diffuse = || sums(setup, lengths, &lights.corners, |channels| channels);
        if VERTEX_COLOURS && let Some(albedos) = albedos {
            let patch = || (((diffuse(), colour(setup, albedos)), halves), lengths.square(setup));
            let shader = LitShader::of::<Coloured<SummedWithHighlights>>(colours, at);
            return is_plane(setup, albedos).then(|| setup.fill(patch, shader, band));
        }
        Some(setup.fill(|| ((diffuse(), halves), lengths.square(setup)), LitShader::of::<SummedWithHighlights>(colours, at), band))
    }
}

/// What all lights have in common at a pixel.
type Common<'a> = (QuotientLookup<'a>, HalfReciprocal);

impl FromValues<Common<'_>, ([u32; 3], [u32; 2])> for SummedWithHighlights {
    #[inline(always)]
    fn from_values((lookup, half_reciprocal): &Common<'_>, full: u16, (sums, [one, two]): ([u32; 3], [u32; 2])) -> Self {
        let highlight = |half: u32| lookup.at(upper(half as i32, half_reciprocal.0));
        Self(Summed::from_values(half_reciprocal, full, sums), [highlight(one), highlight(two)])
    }
}

impl FromValues<Common<'_>, (([u32; 3], [u32; 3]), [u32; 2])> for Coloured<SummedWithHighlights> {
    #[inline(always)]
    fn from_values(common: &Common<'_>, full: u16, ((sums, colour), halves): (([u32; 3], [u32; 3]), [u32; 2])) -> Self {
        Self(SummedWithHighlights::from_values(common, full, (sums, halves)), colour)
    }
}

/// The sums at the corners where a light or the viewer is near, so that vertices hold levels, or nothing.
#[inline(never)]
fn at_corners(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [[i32; 4]; 3] {
    map(setup.vertices(), |vertex| at_vertex(&shading.reflectance, shading.lighting.sources(), wide(vertex.normal)))
}

/// The numerators of sums of diffuse light, in the channels that `wanted` picks.
#[inline(never)]
fn sums<const CH: usize>(
    setup: &TriangleSetup<'_>,
    lengths: &Lengths,
    corners: &[[i32; 3]; 3],
    wanted: impl Fn([[i32; 3]; 3]) -> [[i32; 3]; CH],
) -> Plane<CH> {
    let node = |sum: i32| sum.wrapping_add(1 << (DIFFUSE - DIFFUSE_NODE - 1)) >> (DIFFUSE - DIFFUSE_NODE);
    let nodes = wanted(map(*corners, |channel| map(lengths.apply(&channel), node)));
    Nodes::<3, CH, DIFFUSE_RANGE>::new(nodes, DIFFUSE - DIFFUSE_NODE).fit(setup.gradients)
}

/// In greys all channels are the same.
impl FromValues<HalfReciprocal, [u32; 1]> for Summed {
    #[inline(always)]
    fn from_values(&HalfReciprocal(half_reciprocal): &HalfReciprocal, _: u16, [luma]: [u32; 1]) -> Self {
        Self([upper(luma as i32, half_reciprocal); 3])
    }
}

impl FromValues<HalfReciprocal, [u32; 3]> for Summed {
    #[inline(always)]
    fn from_values(&HalfReciprocal(half_reciprocal): &HalfReciprocal, _: u16, [r, g, b]: [u32; 3]) -> Self {
        let over_length = |sum: u32| upper(sum as i32, half_reciprocal);
        Self([over_length(r), over_length(g), over_length(b)])
    }
}

// The upper half of a product with half a reciprocal length, Q2.30, has three bits less.
const _: () = assert!(SUMMED == DIFFUSE - 3);

/// The value at a pixel: its column, the numerators of the sums, and |N|².
type Value<const CH: usize> = (i32, ([u32; CH], [u32; 1]));

/// Adds lights one by one to the sums. Their numerators stand in memory, since there may be any number; they are evaluated at the column of a pixel.
#[derive(Clone, Copy)]
struct OneByOne<'a, C: Pixel, const NEAR: bool> {
    colours: SummedColours<'a, C>,
    lookup: QuotientLookup<'a>,
    by_cosine: CosineLookup<'a>,
    lengths: &'a HalfRsqrt,
    lights: &'a SummedLights,
    near: &'a [NearTerm],
    /// The row on which the numerators stand before the first row is drawn.
    row: i32,
}

impl<C: Pixel, const NEAR: bool> OneByOne<'_, C, NEAR> {
    #[inline(always)]
    fn jump(&self, rows: i32) {
        self.lights.ending.iter().for_each(|term| term.jump(rows));
        self.lights.highlights.iter().for_each(|term| term.jump(rows));
        if NEAR {
            self.near.iter().for_each(|term| term.jump(rows));
        }
    }

    /// The levels of ambient and diffuse light at a pixel, and the highlights of near lights.
    #[inline(always)]
    fn diffuse<const CH: usize>(&self, column: i32, sums: [u32; CH], half_reciprocal: &HalfReciprocal) -> [[i32; 3]; 2]
    where
        Summed: FromValues<HalfReciprocal, [u32; CH]>,
    {
        let levels = self.colours.levels(Summed::from_values(half_reciprocal, 0, sums));
        let levels = self.lights.ending.iter().fold(levels, |levels, term| {
            let DiffuseOnly(level) = DiffuseOnly::from_values(half_reciprocal, 0, term.at(column));
            term.added(levels, cosine(PIXEL, level))
        });
        let mut light = [levels, [0; 3]];
        if NEAR {
            self.near.iter().for_each(|term| term.add_at(column, half_reciprocal.0, (self.lengths, self.by_cosine), &mut light));
        }
        light
    }

    /// These levels with the highlights at a pixel.
    #[inline]
    fn with_highlights(&self, column: i32, levels: [i32; 3], near: [i32; 3], half_reciprocal: &HalfReciprocal) -> [i32; 3] {
        let levels = if NEAR { zip(levels, near, i32::wrapping_add) } else { levels };
        self.lights.highlights.iter().fold(levels, |levels, term| {
            let [half] = term.at(column);
            term.added(levels, self.lookup.at(upper(half as i32, half_reciprocal.0)) as i32)
        })
    }
}

impl<C: Pixel, const NEAR: bool> ByRows for OneByOne<'_, C, NEAR> {
    #[inline(always)]
    fn step_row(&mut self) {
        self.colours.step_row();
        self.jump(1);
    }

    #[inline]
    fn take_back(&self) {
        self.jump(-1);
    }

    #[inline]
    fn start_at(&mut self, row: i32) {
        self.colours.start_at(row);
        self.jump(row.wrapping_sub(self.row));
    }
}

impl<C: Pixel, const NEAR: bool, const CH: usize> PixelShader<Value<CH>> for OneByOne<'_, C, NEAR>
where
    Summed: FromValues<HalfReciprocal, [u32; CH]>,
{
    type Pixel = C;

    #[inline]
    fn shade(&self, (column, (sums, [square])): Value<CH>) -> C {
        let half_reciprocal = HalfReciprocal(self.lengths.rsqrt(square) as i32);
        let [levels, near] = self.diffuse(column, sums, &half_reciprocal);
        self.colours.mixed(self.with_highlights(column, levels, near, &half_reciprocal))
    }
}

/// The value at a pixel of a surface whose colour is walked: the column, the colour, and what follows in [`Value`].
type ColouredValue<S, const CH: usize> = (i32, (S, ([u32; CH], [u32; 1])));

impl<C: Pixel, S: SurfaceColour, const NEAR: bool, const CH: usize> PixelShader<ColouredValue<S, CH>> for OneByOne<'_, C, NEAR>
where
    Summed: FromValues<HalfReciprocal, [u32; CH]>,
{
    type Pixel = C;

    #[inline]
    fn shade(&self, (column, (colour, (sums, [square]))): ColouredValue<S, CH>) -> C {
        let half_reciprocal = HalfReciprocal(self.lengths.rsqrt(square) as i32);
        let [levels, near] = self.diffuse(column, sums, &half_reciprocal);
        let painted = self.colours.painted(levels, self.lights.ambient, colour.shares());
        self.colours.mixed(self.with_highlights(column, painted, near, &half_reciprocal))
    }
}
