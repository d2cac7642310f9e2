//! The cheapest of several methods that is guaranteed to stay within an error budget, chosen for each triangle.
//!
//! One colour, linear or quadratic interpolation of levels, or quadratic interpolation of cosines, where [`ErrorBounds`] allow it, else Phong
//! shading. Near lights, a near viewer, and more than two lights are always shaded by Phong. The choice follows from constants of the mesh
//! and from the cosines at the corners, in integers: it is the same on every machine.
//!
//! Error against Phong: at most the budget, and what arithmetic adds to every method. Neighbours by the same method meet without a jump,
//! others within twice the budget.

use crate::{
    interpolate::{Constant, by_column::ByColumn},
    lighting::{
        material_tables::MaterialTables,
        reflectance::{FULL, Highlight, Reflectance},
    },
    method::{
        CornerCosines, Costs, DrawTriangle, Facts, Loops, Method, RANGE, Shading, Style, ThreeChannels, TriangleSetup, Uniform,
        VertexLight, channels,
        duff::Duff,
        error_bound::{Curvature, ErrorBounds},
        gouraud::{self, Gouraud},
        of_levels,
        phong::Phong,
        six_point::SixPoint,
        sqrt6::SixCosines,
    },
    pixel::Pixel,
    raster::{
        band::Band,
        canvas::{Canvas, Shaded},
        counts::Counts,
        pixel_shader::Solid,
    },
};
use core::hint::black_box;

static FACTS: Facts = Facts {
    name: "auto",
    id: 26,
    source: "microphong 2026",
    vertex_light: VertexLight::CosinesAndReflection,
    highlight: Highlight::Half,
    highlight_levels: true,
    near_lights: true,
    perspective: true,
    // At most: those of Phong shading.
    costs: Costs::new(11, 12, 2, 30),
};

static FACTS_WITHOUT_QUADRATICS: Facts = Facts { name: "auto-linear", id: 27, ..FACTS };

/// The cheapest method within the error budget. Among all, or without quadratics, which take half of the flash.
pub struct Auto<const QUADRATICS: bool>;

/// Pixels from which the quadratic takes fewer instructions than Phong shading, which is set up sooner: in one channel, in three, and under
/// two lights.
const WORTH_QUADRATIC: [u32; 3] = [20, 60, 60];
/// The same of quadratic cosines.
const WORTH_COSINES: [u32; 3] = [40, 40, 120];

/// What draws a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// One colour in the middle of these levels, Q9.7.
    Solid([i32; 3]),
    /// Linear interpolation of what the vertices have, under one light.
    Linear,
    /// Linear interpolation of these levels at the corners, Q9.7, under two lights.
    Between([[i32; 3]; 3]),
    /// Levels at six nodes, quadratic in between.
    Quadratic,
    /// Cosines at six nodes, quadratic in between, highlights looked up at the pixel.
    Cosines,
    /// Phong shading.
    Phong,
}

impl Choice {
    /// How many triangles are drawn so.
    fn count(self, counts: &mut Counts) -> &mut u32 {
        let [solid, linear, quadratic, cosines, phong] = &mut counts.choices;
        match self {
            Self::Solid(_) => solid,
            Self::Linear | Self::Between(_) => linear,
            Self::Quadratic => quadratic,
            Self::Cosines => cosines,
            Self::Phong => phong,
        }
    }
}

/// Chooses what draws a triangle.
#[inline(never)]
#[must_use]
pub fn choose<const QUADRATICS: bool>(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Choice {
    let Some(curvature) = Curvature::of(setup.triangle) else { return Choice::Phong };
    if shading.vertices_have_cosines() {
        return among::<QUADRATICS>(setup, shading, curvature, &[setup.corner_lights()], |left| one_light(setup, shading, left));
    }
    if shading.reflectance.has_two_lights() && shading.lighting.is_constant() {
        return among::<QUADRATICS>(setup, shading, curvature, &setup.corners_of_two_lights(), |left| two_lights(setup, shading, left));
    }
    Choice::Phong
}

/// [`choose`] with these `cosines` at the corners; `linear` chooses where linear interpolation leaves so much of the budget.
#[inline(always)]
fn among<const QUADRATICS: bool>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    curvature: Curvature,
    cosines: &[CornerCosines],
    linear: impl FnOnce(u32) -> Choice,
) -> Choice {
    let Shading { error_bounds: bounds, budget, reflectance, .. } = *shading;
    if let Some(left) = bounds.left_by_linear(budget, curvature, cosines) {
        return linear(left);
    }
    let (pixels, style) = (pixels(setup), usize::from(reflectance.three_channels()) + cosines.len() - 1);
    match () {
        () if !QUADRATICS => Choice::Phong,
        () if pixels >= WORTH_QUADRATIC[style] && is_quadratic(shading, curvature, cosines) => Choice::Quadratic,
        () if pixels >= WORTH_COSINES[style] && bounds.cosines(curvature, cosines) <= budget => Choice::Cosines,
        () => Choice::Phong,
    }
}

/// Whether the quadratic is within the budget.
#[inline(never)]
fn is_quadratic(shading: &Shading<'_>, curvature: Curvature, cosines: &[CornerCosines]) -> bool {
    let Shading { error_bounds: bounds, budget, reflectance, .. } = *shading;
    bounds.quadratic(curvature, cosines) <= budget && !(bounds.may_saturate() && bounds.saturates(curvature, cosines, reflectance))
}

/// About how many pixels the triangle covers.
#[inline(always)]
fn pixels(setup: &TriangleSetup<'_>) -> u32 {
    let [a, b, c] = setup.corners;
    // A coarse grid, so that words hold the area.
    let (x1, y1, x2, y2) = ((b.x - a.x) >> 2, (b.y - a.y) >> 2, (c.x - a.x) >> 2, (c.y - a.y) >> 2);
    x1.wrapping_mul(y2).wrapping_sub(x2.wrapping_mul(y1)).unsigned_abs() >> 5
}

/// The least and the largest of three values.
#[inline(always)]
fn extremes(&[a, b, c]: &[i32; 3]) -> [i32; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// One colour or linear interpolation under one constant light, where a linear error is within the budget and leaves so much of it.
#[inline(always)]
fn one_light(setup: &TriangleSetup<'_>, shading: &Shading<'_>, left: u32) -> Choice {
    let ([a, b, c], Shading { reflectance, error_bounds: bounds, .. }) = (setup.corners, *shading);
    // The levels in one channel, the highlights in three.
    let [least, most] = extremes(&[a.light[2], b.light[2], c.light[2]]);
    if !reflectance.three_channels() {
        return linear_or_less(Choice::Linear, most, ((most - least + 1) >> 1) as u32 <= left, || [(least + most) >> 1; 3]);
    }
    let [dark, bright] = extremes(&[a.light[0], b.light[0], c.light[0]]);
    let (dark, bright) = (dark.max(0), bright.max(0));
    let brightest = if bounds.may_saturate() { bounds.brightest(bright, most) } else { 0 };
    let half = (bounds.level(bright - dark, most - least) >> 1) + 1;
    linear_or_less(Choice::Linear, brightest, half <= left, || reflectance.reflection((dark + bright) >> 1, ((least + most) >> 1) as u32))
}

/// [`one_light`] under two.
#[inline(never)]
fn two_lights(setup: &TriangleSetup<'_>, shading: &Shading<'_>, left: u32) -> Choice {
    let levels = setup.corners.map(|corner| shading.reflectance.two_lights(corner.light));
    let [[r0, g0, b0], [r1, g1, b1], [r2, g2, b2]] = levels;
    let ([r, r9], [g, g9], [b, b9]) = (extremes(&[r0, r1, r2]), extremes(&[g0, g1, g2]), extremes(&[b0, b1, b2]));
    let half = ((r9 - r).max(g9 - g).max(b9 - b) + 1) as u32 >> 1;
    linear_or_less(Choice::Between(levels), r9.max(g9).max(b9), half <= left, || [(r + r9) >> 1, (g + g9) >> 1, (b + b9) >> 1])
}

/// Phong shading if levels of the corners may have been clamped at 255, one colour if that `is_solid` enough, else linear interpolation.
#[inline(always)]
fn linear_or_less(linear: Choice, brightest: i32, is_solid: bool, middle: impl FnOnce() -> [i32; 3]) -> Choice {
    match () {
        () if brightest >= FULL => Choice::Phong,
        () if is_solid => Choice::Solid(middle()),
        () => linear,
    }
}

/// Levels at the six nodes under two constant lights, Q9.7, of each channel.
#[inline(never)]
fn six_under_two(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [[i32; 6]; 3] {
    let Shading { reflectance, exponent, .. } = *shading;
    let [[towards, half], [other, other_half]] = setup.corners_of_two_lights();
    let (light, half) = (setup.six_from(towards), setup.six_half_from(half, exponent));
    let (other, other_half) = (setup.six_from(other), setup.six_half_from(other_half, exponent));
    let mut nodes = [[0; 6]; 3];
    for k in 0..6 {
        let [r, g, b] = reflectance.two_lights([light[k], half[k], other[k], other_half[k]]);
        (nodes[0][k], nodes[1][k], nodes[2][k]) = (r, g, b);
    }
    nodes
}

impl<const QUADRATICS: bool> Method for Auto<QUADRATICS> {
    fn facts(&self) -> &'static Facts {
        if QUADRATICS { &FACTS } else { &FACTS_WITHOUT_QUADRATICS }
    }

    fn error_bounds(&self, reflectance: &Reflectance, exponent: u16, lights: usize) -> ErrorBounds {
        ErrorBounds::new(reflectance, exponent, lights)
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        let choice = choose::<QUADRATICS>(setup, shading);
        setup.count_on(canvas, |counts| choice.count(counts), 1);
        match (choice, shading.constant) {
            (Choice::Solid(levels), _) => setup.draw_spans(&mut Shaded::new(Constant, Uniform(of_levels(levels))), canvas),
            (Choice::Linear, _) => shading.draw_levels::<3, RANGE>(setup, gouraud::reflected(setup, shading.reflectance), canvas),
            (Choice::Between(levels), _) => shading.draw_levels::<3, RANGE>(setup, levels, canvas),
            (Choice::Quadratic, Some(_)) if QUADRATICS => SixPoint.shade(setup, shading, canvas),
            (Choice::Quadratic, None) if QUADRATICS => shading.draw_channels::<6, RANGE>(setup, &six_under_two(setup, shading), canvas),
            (Choice::Cosines, _) if QUADRATICS => SixCosines::shade(setup, shading, canvas),
            (Choice::Quadratic | Choice::Cosines | Choice::Phong, _) => Phong.shade(setup, shading, canvas),
        }
    }
}

impl<const QUADRATICS: bool> Loops for Auto<QUADRATICS> {
    type ThreeChannels = ThreeChannels<Self>;

    fn take(style: Style) -> bool {
        Duff::take(style)
    }

    #[inline(always)]
    fn draw<C: Pixel>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        let choice = choose::<QUADRATICS>(setup, shading);
        setup.count(band.top, choice.count(&mut band.counts), 1);
        match choice {
            Choice::Solid(levels) => Some(setup.fill(|| Constant, Solid(tables.colour(levels)), band)),
            Choice::Linear | Choice::Between(_) => by::<Gouraud, _>(setup, shading, tables, band),
            Choice::Quadratic if QUADRATICS => by::<SixPoint, _>(setup, shading, tables, band),
            Choice::Cosines if QUADRATICS => by::<SixCosines, _>(setup, shading, tables, band),
            Choice::Quadratic | Choice::Cosines | Choice::Phong => by::<Phong, _>(setup, shading, tables, band),
        }
    }
}

impl<const QUADRATICS: bool> Loops for ThreeChannels<Auto<QUADRATICS>> {
    type ThreeChannels = Self;

    fn take(style: Style) -> bool {
        Auto::<QUADRATICS>::take(style)
    }

    #[inline(always)]
    fn draw<C: Pixel>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        let choice = choose::<QUADRATICS>(setup, shading);
        setup.count(band.top, choice.count(&mut band.counts), 1);
        match (choice, shading.constant) {
            (Choice::Solid(levels), _) => Some(setup.fill(|| Constant, Solid(tables.colour(levels)), band)),
            (Choice::Linear, _) => by::<ThreeChannels<Gouraud>, _>(setup, shading, tables, band),
            (Choice::Between(levels), _) => Some(Shading::fill_three(setup, || channels(levels), |plane| plane, band)),
            (Choice::Quadratic, Some(_)) if QUADRATICS => by::<SixPoint, _>(setup, shading, tables, band),
            (Choice::Quadratic, None) if QUADRATICS => Some(Shading::fill_three(setup, || six_under_two(setup, shading), ByColumn, band)),
            (Choice::Cosines, _) if QUADRATICS => by::<SixCosines, _>(setup, shading, tables, band),
            (Choice::Quadratic | Choice::Cosines | Choice::Phong, _) => by::<Phong, _>(setup, shading, tables, band),
        }
    }
}

/// Draws by the loops of another method. They are called by address, or the compiler would compile them once more here.
#[inline(always)]
fn by<L: Loops, C: Pixel>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let draw: DrawTriangle<C> = L::draw;
    black_box(draw)(setup, shading, tables, band)
}
