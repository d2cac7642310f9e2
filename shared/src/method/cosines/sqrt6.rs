//! The six-point quadratic through N·L and through a root of N·H, which is squared and raised to the exponent at the pixel.
//!
//! Near a highlight's centre N·H is nearly quadratic in the angle, and its root is even closer to a quadratic over the whole triangle. Fitting
//! sqrt(N·H) instead of N·H leaves 1.5 to 6 times less error at the same cost. Below 1/4, where the root would grow steep, it goes on as a line of
//! the same slope.
//!
//! Cost: 4 additions a pixel and light and the highlight's table, which also squares; 12 cosines to set up. Triangles
//! without a highlight under one constant light cost as much as by [`crate::method::levels::six_point`]. Continuous, but for a
//! slight jump in perspective between a triangle with nodes on the screen and one with nodes in space.
//! Error against Phong: 2.4 LSB at worst on a sphere of 168 triangles, 0.2 on one of 690 (exponent 50, ks 1/2).
//! Domain: any lights; coarse triangles near a light need splitting.

use crate::{
    features::{LIGHTS, VERTEX_COLOURS},
    format::{LEVEL, WALK},
    interpolate::{
        Constant,
        by_column::ByColumn,
        field::{Field, Nodes},
        quadric::Quadric,
    },
    lighting::{
        albedo::Albedo,
        constant_lights::{Coloured, ColouredRgb, DiffuseOnly, LitColours, OneLightRamp, OneLightRgb, Shades, WithHighlight, node},
        lights::Source,
        material_tables::MaterialTables,
        reflectance::{Reflectance, Reflection},
    },
    math::{
        highlight_lookup::DefectLookup,
        highlight_lut::{CosineLookup, Highlight},
        rsqrt::sqrt,
    },
    method::{
        CornerCosines, Facts, HighlightField, LEVEL_RANGE, Loops, Method, Middles, Shading, Style, TriangleSetup, VertexLight,
        cosines::{
            lit::{AtPixel, FromValues, LitShader},
            quotient::{colour, is_plane},
            two_lights::TwoLights,
        },
        largest,
        lighting_model::{LightingModel, Lit},
        node::map_six,
        products::{FIELD_BITS, FIELD_EXTRA, QuadraticNodes, quadratic, signed},
    },
    pixel::Pixel,
    raster::{
        band::Band,
        canvas::Canvas,
        pixel_shader::{PixelShader, Ramp},
    },
};

/// Numbers of the loops with a highlight and without.
const WITH_HIGHLIGHT: u8 = <WithHighlight as FromValues<DefectLookup<'_>, ([u32; 1], [u32; 1])>>::ID;
const DIFFUSE_ONLY: u8 = <DiffuseOnly as FromValues<(), [u32; 1]>>::ID;

/// Whether the quadratic goes through roots of N·H, or through N·H itself, for a method whose table of highlights is that of [`Highlight::Half`].
/// The latter is set up sooner, and it is less accurate.
type IsRoot = bool;

/// One, Q2.30.
const ONE: i32 = 1 << 30;
/// Below this cosine the root is continued by a line.
const LOWEST: i32 = ONE / 4;

static FACTS: Facts = Facts {
    name: "sqrt6",
    id: 23,
    source: "microphong 2026",
    vertex_light: VertexLight::Cosines,
    highlight: Highlight::Root,
    highlight_levels: true,
    highlight_field: HighlightField::Root,
    ..Facts::OWN
};

/// Six-point shading with a square root of N·H.
pub struct Sqrt6;

impl Method for Sqrt6 {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        let even = setup.on_screen();
        let (setup, middles) = if setup.is_evenly_far() { (&even, setup.middles()) } else { (setup, None) };
        if shading.lighting.is_constant() {
            return shade_constant::<true>(setup, middles, shading, canvas);
        }
        let nodes = setup.six_nodes_at(middles, shading.exponent);
        let fit =
            |source: &_| Lit::<_, QuadraticNodes<1>>::Fully(shading.six_products(&nodes, source, |[light, half]| [light, root(half)]));
        shading.draw_lit_in_part(setup, fit, Constant, LookedUp, canvas)
    }
}

/// [`Method::shade`] under constant lights, with the nodes `middles`.
pub(crate) fn shade_constant<const ROOT: IsRoot>(
    setup: &TriangleSetup<'_>,
    middles: Middles,
    shading: &Shading<'_>,
    canvas: &mut dyn Canvas,
) -> u32 {
    let threshold = setup.highlight_threshold(&shading.reflectance);
    let fit = |source: &Source| {
        let [towards, half] = shading.lighting.directions(source, [0; 3]);
        let (towards, half) = (setup.six_at(middles, setup.corner_cosines(towards)), setup.corner_cosines(half));
        if !source.is_sky() && largest(&half) >= threshold {
            let half = map_six(setup.six_half_at(middles, half, shading.exponent), walked::<ROOT>);
            Lit::Fully(quadratic([towards, half]))
        } else if !source.is_sky() && DiffuseSign::of(towards) == DiffuseSign::Nowhere {
            Lit::Nowhere
        } else {
            Lit::Diffuse(quadratic([towards]))
        }
    };
    shading.draw_lit_in_part(setup, fit, Constant, LookedUp, canvas)
}

impl Loops for Sqrt6 {
    fn take(style: Style) -> bool {
        style.is_plain && !style.has_texture && (style.lights == 1 || style.lights == 2 && !style.is_coloured)
    }

    #[inline(always)]
    fn draw<C: Pixel, const THREE: bool>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        draw_any::<true, C>(setup, shading, tables, band)
    }
}

/// Draws under one light or two.
#[inline(always)]
pub(crate) fn draw_any<const ROOT: IsRoot, C: Pixel>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    // A quadratic on the screen bends too little for triangles that reach far.
    if !setup.is_evenly_far() {
        return None;
    }
    if LIGHTS && tables.reflectance.lights == 2 {
        return draw_two::<ROOT, C>(setup, shading, tables, band);
    }
    let (cosines, rgb) = (&setup.corner_lights(), tables.one_light_rgb());
    // `auto` draws coloured triangles by other methods.
    if VERTEX_COLOURS
        && ROOT
        && !C::GRAY
        && let Some(albedos) = setup.albedos()
    {
        return draw_coloured(setup, cosines, albedos, shading, tables, band);
    }
    let ramp = if rgb.is_some() { tables.diffuse_ramp() } else { Some(tables.one_light_ramp()?) };
    let has_no_highlight = largest(&cosines[1]) < setup.highlight_threshold(tables.reflectance);
    // What a table of colours declines in three channels has been drawn as if it had a highlight.
    let declined = rgb.is_some() && setup.resumed(band) == Some(WITH_HIGHLIGHT);
    if let Some(ramp) = ramp.filter(|_| has_no_highlight && !declined) {
        let drawn = draw_diffuse(setup, cosines, ramp, tables, band);
        if drawn.is_some() || rgb.is_none() {
            setup.count(band.top, &mut band.counts.without_highlight, 1);
            return drawn;
        }
    }
    match rgb {
        Some(rgb) => draw_rgb::<ROOT, C>(setup, cosines, rgb, shading, tables, band),
        None => draw::<ROOT, C, _>(setup, cosines, ramp?, shading, tables, band),
    }
}

/// Draws as [`draw`] does, in three channels. It is compiled once for triangles of all sizes, because a call is a small share of their time.
#[inline(never)]
fn draw_rgb<const ROOT: IsRoot, C: Pixel>(
    setup: &TriangleSetup<'_>,
    corners: &CornerCosines,
    colours: OneLightRgb<'_, C>,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    draw::<ROOT, C, _>(setup, corners, colours, shading, tables, band)
}

/// Draws as [`draw`] does, on a surface whose corners have colours.
#[inline(never)]
fn draw_coloured<C: Pixel>(
    setup: &TriangleSetup<'_>,
    corners: &CornerCosines,
    albedos: &[Albedo; 3],
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    if !is_plane(setup, albedos) {
        return None;
    }
    let Some(albedo) = Albedo::one(albedos) else {
        return match tables.neutral_rgb() {
            Some(colours) => draw_painted(setup, corners, colours, albedos, shading, tables, band),
            None => draw_painted(setup, corners, ColouredRgb::of(&tables.coloured()), albedos, shading, tables, band),
        };
    };
    let sums = &tables.painted_sums(albedo);
    let colours = OneLightRgb::of(sums);
    let [towards, half] = corners;
    if setup.leaves_out_highlight(tables.reflectance, half) {
        setup.count(band.top, &mut band.counts.without_highlight, 1);
        let patch = || diffuse(setup, colours.diffuse(), setup.six_at(setup.middles(), *towards));
        return Some(setup.fill(patch, LitShader::of::<DiffuseOnly>(colours, Diffuse), band));
    }
    draw_rgb::<true, C>(setup, corners, colours, shading, tables, band)
}

/// Draws as [`draw`] does, on a surface whose colour changes from pixel to pixel, in these `colours`.
#[inline(always)]
fn draw_painted<C: Pixel, T>(
    setup: &TriangleSetup<'_>,
    &[towards, half]: &CornerCosines,
    colours: T,
    albedos: &[Albedo; 3],
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32>
where
    T: Shades<Coloured<DiffuseOnly>, Pixel = C> + Shades<Coloured<WithHighlight>, Pixel = C>,
{
    let light = || diffuse(setup, colours.diffuse(), setup.six_at(setup.middles(), towards));
    if setup.leaves_out_highlight(tables.reflectance, &half) {
        setup.count(band.top, &mut band.counts.without_highlight, 1);
        return Some(setup.fill(|| (light(), colour(setup, albedos)), LitShader::of::<Coloured<DiffuseOnly>>(colours, Diffuse), band));
    }
    if setup.resumed(band).is_none() && !setup.gradients.walks_in_words() && !is_exact(setup, half, tables.reflectance) {
        return None;
    }
    let lookup = DefectLookup::new(shading.reflectance.table()?);
    let patch = || ((light(), highlight::<true>(setup, half, lookup, shading.exponent)), colour(setup, albedos));
    Some(setup.fill(patch, LitShader::of::<Coloured<WithHighlight>>(colours, lookup), band))
}

/// Draws `setup` under two constant lights.
#[inline(never)]
fn draw_two<const ROOT: IsRoot, C: Pixel>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let TwoLights { colours, cosines: [first, second], highlights } = TwoLights::on(setup, tables)?;
    let (full, exponent) = (colours.diffuse(), shading.exponent);
    let steeply = |[_, half]: CornerCosines| !is_exact(setup, half, tables.reflectance);
    if setup.place.is_none() && !setup.gradients.walks_in_words() && (highlights > 0 && steeply(first) || highlights > 1 && steeply(second))
    {
        return None;
    }
    let middles = setup.middles();
    let (towards, other) = (setup.six_at(middles, first[0]), setup.six_at(middles, second[0]));
    let is_dark = |cosines| DiffuseSign::of(cosines) == DiffuseSign::Nowhere;
    let lookup = DefectLookup::new(shading.reflectance.table()?);
    let diffuse = |cosines| diffuse(setup, full, cosines);
    let highlight = |[_, half]: CornerCosines| highlight::<ROOT>(setup, half, lookup, exponent);
    setup.count(band.top, &mut band.counts.without_highlight, 2 - highlights);
    Some(match highlights {
        1 if is_dark(other) => {
            setup.count(band.top, &mut band.counts.without_light, 1);
            return draw_rgb::<ROOT, C>(setup, &first, colours.first(), shading, tables, band);
        }
        0 => setup.fill(|| (diffuse(towards), diffuse(other)), LitShader::of::<(DiffuseOnly, DiffuseOnly)>(colours, Diffuse), band),
        1 => {
            let shader = LitShader::of::<(WithHighlight, DiffuseOnly)>(colours, lookup);
            setup.fill(|| ByColumn(((diffuse(towards), highlight(first)), diffuse(other))), shader, band)
        }
        _ => {
            let shader = LitShader::of::<(WithHighlight, WithHighlight)>(colours, lookup);
            setup.fill(|| ByColumn(((diffuse(towards), highlight(first)), (diffuse(other), highlight(second)))), shader, band)
        }
    })
}

/// Draws `setup` with a highlight under one constant light in these `colours`; `None` if levels may leave the walked format.
#[inline(always)]
fn draw<const ROOT: IsRoot, C: Pixel, T: Shades<WithHighlight, Pixel = C>>(
    setup: &TriangleSetup<'_>,
    &[towards, half]: &CornerCosines,
    colours: T,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    if setup.resumed(band).is_none() && !setup.gradients.walks_in_words() && !is_exact(setup, half, tables.reflectance) {
        return None;
    }
    // No nodes are needed of an active triangle.
    let cosines = if setup.resumed(band).is_none() { setup.six_at(setup.middles(), towards) } else { [0; 6] };
    if T::TABLED && setup.resumed(band).is_none() {
        let sign = DiffuseSign::of(cosines);
        if !colours.is_within() || sign == DiffuseSign::Nowhere || sign == DiffuseSign::Steeply {
            return None;
        }
    }
    let lookup = DefectLookup::new(shading.reflectance.table()?);
    let patch = || (diffuse(setup, colours.diffuse(), cosines), highlight::<ROOT>(setup, half, lookup, shading.exponent));
    Some(setup.fill(patch, LitShader::of::<WithHighlight>(colours, lookup), band))
}

/// Draws `setup` without a highlight under one constant light by a table of colours; `None` if levels may leave the walked format.
#[inline(always)]
fn draw_diffuse<C: Pixel>(
    setup: &TriangleSetup<'_>,
    &[towards, _]: &CornerCosines,
    colours: OneLightRamp<'_, C>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let resumed = setup.resumed(band);
    // The pixel shader of an active triangle has been chosen, and no nodes are needed.
    let cosines = if resumed.is_none() { setup.six_at(setup.middles(), towards) } else { [0; 6] };
    let id = match (resumed, DiffuseSign::of(cosines)) {
        (Some(id), _) => id,
        (None, DiffuseSign::Nowhere) => Ramp::<C>::ID,
        (None, _) if !colours.is_within() => return None,
        (None, DiffuseSign::Everywhere) => Ramp::<C>::ID,
        (None, DiffuseSign::Partly) => DIFFUSE_ONLY,
        (None, DiffuseSign::Steeply) => return None,
    };
    Some(if id == Ramp::<C>::ID {
        Shading::fill_one(setup, || tables.reflectance.six_diffuse(cosines), tables, band)
    } else {
        setup.fill(|| diffuse(setup, colours.diffuse(), cosines), LitShader::of::<DiffuseOnly>(colours, Diffuse), band)
    })
}

/// The diffuse level of a material with the level `full` at cosine 1, from the cosines at six nodes.
#[inline(never)]
fn diffuse(setup: &TriangleSetup<'_>, full: u16, cosines: [i32; 6]) -> Quadric<1> {
    Nodes::<6, 1, LEVEL_RANGE>::new([map_six(cosines, |cosine| node(full, cosine, LEVEL))], WALK - LEVEL).fit(setup.gradients)
}

/// 1 minus the root of N·H, or minus N·H, which is `half` at the corners, as the table of highlights is looked up by.
#[inline(never)]
fn highlight<const ROOT: IsRoot>(setup: &TriangleSetup<'_>, half: [i32; 3], lookup: DefectLookup<'_>, exponent: u16) -> Quadric<1> {
    let half = [map_six(map_six(setup.six_half_at(setup.middles(), half, exponent), walked::<ROOT>), |node| lookup.node(node))];
    Nodes::<6, 1, FIELD_BITS>::new(half, FIELD_EXTRA).biased([lookup.half()]).fit(setup.gradients)
}

/// Values at the pixel are walked diffuse levels, and for highlights 1 minus the root of N·H.
impl<V> AtPixel<V> for DefectLookup<'_> {
    type Common = Self;
    type Values = V;

    const BITS: u32 = WALK;

    #[inline(always)]
    fn at(&self, value: V) -> (Self, V) {
        (*self, value)
    }
}

impl FromValues<DefectLookup<'_>, ([u32; 1], [u32; 1])> for WithHighlight {
    const ID: u8 = 2;

    #[inline(always)]
    fn from_values(lookup: &DefectLookup<'_>, _: u16, ([light], [defect]): ([u32; 1], [u32; 1])) -> Self {
        Self(signed(light), lookup.at(signed(defect)))
    }
}

impl FromValues<DefectLookup<'_>, [u32; 1]> for DiffuseOnly {
    #[inline(always)]
    fn from_values(_: &DefectLookup<'_>, full: u16, light: [u32; 1]) -> Self {
        Self::from_values(&(), full, light)
    }
}

/// Values at the pixel are walked diffuse levels alone.
#[derive(Clone, Copy)]
struct Diffuse;

impl<V> AtPixel<V> for Diffuse {
    type Common = ();
    type Values = V;

    const BITS: u32 = WALK;

    #[inline(always)]
    fn at(&self, value: V) -> ((), V) {
        ((), value)
    }
}

impl FromValues<(), [u32; 1]> for DiffuseOnly {
    const ID: u8 = 1;

    #[inline(always)]
    fn from_values((): &(), _: u16, [light]: [u32; 1]) -> Self {
        Self(signed(light))
    }
}

/// The sign of the quadratic through N·L over a triangle. It decides how levels are walked.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DiffuseSign {
    Everywhere,
    Nowhere,
    Partly,
    /// Positive in part, but nodes differ by more than 1, so that levels exceed [`LEVEL_RANGE`], or the quadratic may leave [-1, 1], so that
    /// levels wrap.
    Steeply,
}

impl DiffuseSign {
    /// The sign by the nodes: a quadratic leaves the middle of their range by at most 5/3 of half the range (its Lebesgue constant). Unless
    /// it changes its sign, the level that is 0 where the cosine is negative can be fitted instead of the cosine.
    #[inline(always)]
    fn of([a, b, c, ab, bc, ca]: [i32; 6]) -> Self {
        let (least, most) = (a.min(b).min(c).min(ab).min(bc).min(ca), a.max(b).max(c).max(ab).max(bc).max(ca));
        if least > 0 && least >= most >> 2 {
            Self::Everywhere
        } else if most < 0 && most <= least >> 2 {
            Self::Nowhere
        } else if most.saturating_sub(least) <= ONE && (most - (least >> 2)).max((most >> 2).saturating_sub(least)) <= 3 * (ONE / 4) {
            Self::Partly
        } else {
            Self::Steeply
        }
    }
}

/// sqrt(w) for w >= 1/4, and w + 1/4 below, with the same slope at 1/4; Q2.30. A cosine above 1, of a normal that rounding has made longer
/// than 1, counts as 1.
fn root(w: i32) -> i32 {
    if w < LOWEST {
        return w + LOWEST;
    }
    sqrt(w.min(ONE - 1))
}

/// The walked form of N·H, Q2.30: its [`root`] or N·H itself, but not below the lowest root, so that no polynomial wraps. Far from a highlight only
/// triangles are clamped that are too large for any bound.
fn walked<const ROOT: IsRoot>(w: i32) -> i32 {
    if ROOT { root(w) } else { w.max(LOWEST - ONE) }
}

/// Whether words walk N·H exactly enough all over the triangle. They do where it is the same everywhere, or where no highlight can be seen.
// A call leaves more registers to its callers.
#[inline(never)]
fn is_exact(setup: &TriangleSetup<'_>, half: [i32; 3], reflectance: &Reflectance) -> bool {
    let [a, b, c] = half;
    a == b && b == c || largest(&half) < setup.highlight_threshold(reflectance)
}

/// Looks up highlights at the pixel.
#[derive(Clone, Copy)]
struct LookedUp;

impl LightingModel<(), [u32; 2], [u32; 1]> for LookedUp {
    type Common = ();

    #[inline(always)]
    fn common(&self, (): ()) {}

    #[inline(always)]
    fn reflect(&self, _: usize, (): &(), [light, half]: [u32; 2], lut: CosineLookup<'_>) -> Reflection {
        // The table squares its argument, if that is a root.
        Reflection { diffuse: signed(light) >> 3, highlight: lut.at(signed(half) >> 3) }
    }

    #[inline(always)]
    fn reflect_diffuse(&self, (): &(), [light]: [u32; 1]) -> i32 {
        signed(light) >> 3
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]
        #[test]
        fn quadratics_are_where_their_nodes_say(
            centre in -1.0f64..1.0,
            spread in prop_oneof![0.0f64..0.5, 0.0f64..1.0],
            parts in prop::array::uniform6(prop_oneof![Just(-1.0f64), Just(1.0), -1.0f64..1.0]),
        ) {
            let nodes = parts.map(|part| ((centre + part * spread).clamp(-1.0, 1.0) * f64::from(ONE)) as i32);
            let lit = DiffuseSign::of(nodes);
            for (s, t) in (0..=20).flat_map(|s| (0..=20 - s).map(move |t| (f64::from(s) / 20.0, f64::from(t) / 20.0))) {
                let b = [1.0 - s - t, s, t];
                let n = nodes.map(|node| f64::from(node) / f64::from(ONE));
                let value = (0..3).map(|k| b[k] * (2.0 * b[k] - 1.0) * n[k]).sum::<f64>()
                    + 4.0 * (b[0] * b[1] * n[3] + b[1] * b[2] * n[4] + b[2] * b[0] * n[5]);
                let holds = match lit {
                    DiffuseSign::Everywhere => value > 0.0,
                    DiffuseSign::Nowhere => value < 0.0,
                    DiffuseSign::Partly => value.abs() <= 1.0,
                    DiffuseSign::Steeply => true,
                };
                prop_assert!(holds, "{nodes:?} at {s} {t}: {value}");
            }
        }
    }
}
