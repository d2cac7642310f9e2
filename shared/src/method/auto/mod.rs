//! The method `auto`: for each triangle the cheapest way that is guaranteed to stay within an error budget.
//!
//! A triangle is drawn in one colour, by linear or quadratic interpolation of levels, or by quadratic interpolation of cosines, if [`ErrorBounds`]
//! allow it, and otherwise by Phong shading. Under near lights, for a near viewer, and under more than two lights the choice is between one colour,
//! linear interpolation and Phong shading. Lights with a cone leave Phong shading alone. The choice follows from constants of the mesh and from the
//! light at the corners, in integers, so it is the same on every machine.
//!
//! Bounds tell by how much linear interpolation may be too dark, and by how much too bright. If one of the two exceeds the budget but their mean does
//! not, all levels of the triangle are raised or lowered until both are within the budget.
//!
//! Error against Phong: at most the budget, plus the arithmetic error of every method. At an edge between triangles drawn in one way light does not
//! jump, unless their levels are raised; at others it jumps by at most twice the budget.

mod choice;
pub mod costs;
#[doc(hidden)]
pub mod error_bound;
#[doc(hidden)]
pub mod highlight_error;
mod near;
mod way;

use crate::{
    format::FULL,
    interpolate::{Constant, by_column::ByColumn},
    lighting::{
        albedo::{Albedo, Parts},
        material_tables::MaterialTables,
        reflectance::{LitMaterial, Reflectance},
    },
    math::vector::{map, zip},
    method::{
        DrawTriangle, Facts, HighlightField, LEVEL_RANGE, Loops, Method, Shading, Style, TriangleSetup, VertexLight,
        auto::error_bound::ErrorBounds,
        channels,
        cosines::{phong::Phong, sqrt6},
        draw_uniform,
        levels::{gouraud, six_point::SixPoint},
        texture,
    },
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas, pixel_shader::Solid},
};
pub use choice::choose;
use choice::{choose_lit, corner_levels, extremes, is_uniform, uniform_parts};
use core::hint::black_box;
pub use way::Choice;

static FACTS: Facts = Facts {
    name: "auto",
    id: 26,
    source: "microphong 2026",
    vertex_light: VertexLight::CosinesAndReflection,
    highlight_levels: true,
    highlight_field: HighlightField::Quadratic,
    // At most: those of Phong shading.
    ..Facts::OWN
};

static FACTS_WITHOUT_QUADRATICS: Facts = Facts { name: "auto-linear", id: 27, ..FACTS };

/// The cheapest way within the error budget, with or without quadratics, which take two fifths of the flash.
pub struct Auto<const QUADRATICS: bool>;

/// The mean of the smallest and the largest light number `k` at the corners, where values below `floor` count as `floor`.
#[inline]
fn half_way(setup: &TriangleSetup<'_>, k: usize, floor: i32) -> i32 {
    let [a, b, c] = setup.corners;
    let [least, most] = extremes([a.light[k].max(floor), b.light[k].max(floor), c.light[k].max(floor)]);
    // The sum of two cosines of 1 would not fit.
    least + ((most - least) >> 1)
}

/// Levels by which a choice raises each channel, Q9.7. Where the table of colours can be interpolated, one level stands for all channels, and each
/// rises by its share of diffuse light. Elsewhere all channels rise alike.
#[inline(never)]
pub fn raises(choice: Choice, setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [i32; 3] {
    let (Choice::Solid(raise) | Choice::Linear(raise)) = choice else { return [0; 3] };
    let reflectance = shading.reflectance;
    let by_table = shading.vertices_have_cosines() && reflectance.three_channels() && gouraud::has_ramp(setup, &reflectance);
    if by_table { reflectance.ramp_rise(raise) } else { [raise; 3] }
}

/// The parts of light half-way between the extremes at the corners, under one constant light.
fn half_way_parts(setup: &TriangleSetup<'_>, reflectance: &Reflectance) -> Parts {
    reflectance.reflected_parts(half_way(setup, 0, 0), half_way(setup, 2, 0) as u32)
}

/// [`middle`] from the levels at the corners, not raised.
#[inline(never)]
fn middle_of_levels(setup: &TriangleSetup<'_>, shading: &Shading<'_>, uniform: Option<&Parts>) -> [i32; 3] {
    if let Some(&parts) = uniform {
        return setup.albedos().map_or(Albedo::WHITE, Albedo::half_way).lit(parts);
    }
    map(channels(corner_levels(setup, shading, None)).map(extremes), |[least, most]| (least + most) >> 1)
}

/// The means of the smallest and the largest level at the corners, raised.
#[inline(never)]
fn middle(setup: &TriangleSetup<'_>, shading: &Shading<'_>, uniform: Option<&Parts>, raises: [i32; 3]) -> [i32; 3] {
    let reflectance = shading.reflectance;
    let levels = match (shading.vertices_have_cosines(), reflectance.three_channels()) {
        _ if reflectance.sums_lights() || !shading.lighting.is_constant() => middle_of_levels(setup, shading, uniform),
        _ if let Some(albedos) = setup.albedos() => Albedo::half_way(albedos).lit(half_way_parts(setup, &reflectance)),
        (false, _) if is_uniform(setup) => reflectance.two_lights(setup.corners[0].light),
        // Otherwise one colour is chosen under two lights only where no highlight can be seen.
        (false, _) => reflectance.two_lights([half_way(setup, 0, 0), i32::MIN, half_way(setup, 2, 0), i32::MIN]),
        (true, true) => reflectance.reflection(half_way(setup, 0, 0), half_way(setup, 2, 0) as u32),
        (true, false) => [half_way(setup, 2, 0); 3],
    };
    zip(levels, raises, |level, raise| (level + raise).clamp(0, FULL))
}

/// The colour of these levels, by a table of colours if that is faster.
#[inline(never)]
fn solid<C: Pixel>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    uniform: Option<&Parts>,
    raise: i32,
    tables: MaterialTables<'_, C>,
) -> [C::Stored; 2] {
    let reflectance = shading.reflectance;
    if shading.vertices_have_cosines() && setup.albedos().is_none() {
        if !reflectance.three_channels() {
            return tables.tint(half_way(setup, 2, 0) + raise);
        }
        if gouraud::has_ramp(setup, &reflectance) {
            return tables.tint(reflectance.ramp_level(half_way(setup, 0, 0)) + raise);
        }
    }
    tables.colour(middle(setup, shading, uniform, [raise; 3]))
}

/// Levels of each channel at the six nodes under two constant lights, Q9.7.
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

    fn error_bounds(&self, reflectance: LitMaterial<'_>, exponent: u16, lights: usize) -> ErrorBounds {
        ErrorBounds::new(reflectance, exponent, lights)
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        let uniform = uniform_parts(setup, shading);
        let uniform = uniform.as_ref();
        let choice = choose_lit::<QUADRATICS>(setup, shading, uniform);
        setup.count_on(canvas, |counts| choice.count(counts), 1);
        let reflectance = shading.reflectance;
        let raises = raises(choice, setup, shading);
        match (choice, shading.constant) {
            // Nothing is raised.
            (Choice::Solid(_), _) if setup.has_texture() => setup.draw_parts([half_way_parts(setup, &reflectance); 3], canvas),
            (Choice::Linear(_), _) if setup.has_texture() => setup.draw_parts(gouraud::corner_parts(setup, shading), canvas),
            (Choice::Solid(_), _) => draw_uniform(setup, middle(setup, shading, uniform, raises), canvas),
            (Choice::Linear(_), constant) => {
                let levels =
                    if constant.is_some() { gouraud::reflected(setup, &reflectance) } else { corner_levels(setup, shading, uniform) };
                shading.draw_channels::<3, LEVEL_RANGE>(setup, &channels(levels), raises, canvas)
            }
            (Choice::Quadratic, Some(_)) if QUADRATICS => SixPoint.shade(setup, shading, canvas),
            (Choice::Quadratic, None) if QUADRATICS => {
                shading.draw_channels::<6, LEVEL_RANGE>(setup, &six_under_two(setup, shading), [0; 3], canvas)
            }
            (Choice::Cosines, _) if QUADRATICS => sqrt6::shade_constant::<false>(setup, None, shading, canvas),
            (Choice::Quadratic | Choice::Cosines | Choice::Phong, _) => Phong.shade(setup, shading, canvas),
        }
    }
}

impl<const QUADRATICS: bool> Loops for Auto<QUADRATICS> {
    const APART: bool = true;
    fn take(style: Style) -> bool {
        Phong::take(style) || style.is_near && style.is_plain
    }

    #[inline(always)]
    fn draw<C: Pixel, const THREE: bool>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        let uniform = uniform_parts(setup, shading);
        let uniform = uniform.as_ref();
        // The band above has chosen already.
        let choice = setup.saved_choice(band).and_then(Choice::unpacked);
        let choice = choice.unwrap_or_else(|| choose_lit::<QUADRATICS>(setup, shading, uniform));
        band.active.choice = choice.packed();
        setup.count(band.top, choice.count(&mut band.counts), 1);
        // Under two lights vertices have levels of all channels, where there are three.
        let under_two = THREE && shading.constant.is_none();
        if setup.has_texture() {
            let parts = match choice {
                Choice::Solid(_) => [half_way_parts(setup, &shading.reflectance); 3],
                Choice::Linear(_) => gouraud::corner_parts(setup, shading),
                Choice::Quadratic | Choice::Cosines | Choice::Phong => return by(Phong::draw::<C, false>, setup, shading, tables, band),
            };
            return texture::fill(setup, shading, &parts, tables, band);
        }
        match choice {
            Choice::Solid(raise) => Some(setup.fill(|| Constant, Solid::face(solid(setup, shading, uniform, raise, tables)), band)),
            Choice::Linear(raise) if under_two => {
                let channels = || channels(corner_levels(setup, shading, uniform));
                Some(shading.fill_three(setup, channels, raise, |plane| plane, band))
            }
            // In greys vertices have no levels where lights are summed.
            Choice::Linear(raise) if C::GRAY && tables.reflectance.sums_lights() => {
                let levels = || corner_levels(setup, shading, uniform).map(|[level, ..]| level + raise);
                Some(Shading::fill_one(setup, levels, tables, band))
            }
            Choice::Linear(raise) if THREE => Some(gouraud::draw_three(setup, shading, raise, tables, band)),
            Choice::Linear(raise) => Some(gouraud::draw_one(setup, raise, tables, band)),
            Choice::Quadratic if QUADRATICS && under_two => {
                Some(shading.fill_three(setup, || six_under_two(setup, shading), 0, ByColumn, band))
            }
            Choice::Quadratic if QUADRATICS => by(SixPoint::draw::<C, false>, setup, shading, tables, band),
            Choice::Cosines if QUADRATICS => by(sqrt6::draw_any::<false, C>, setup, shading, tables, band),
            Choice::Quadratic | Choice::Cosines | Choice::Phong => by(Phong::draw::<C, false>, setup, shading, tables, band),
        }
    }
}

/// Draws by the loops of another method. They are called by address, because the compiler would compile them again here.
#[inline]
fn by<C: Pixel>(
    draw: DrawTriangle<C>,
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    black_box(draw)(setup, shading, tables, band)
}
