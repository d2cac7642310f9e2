//! Gouraud shading (Gouraud 1971): light at the corners, interpolated linearly.
//!
//! Cost: one addition a pixel and channel, two in perspective where a quadratic is needed. Continuous. Error against Phong: at
//! most 255 ks n (1 - c)/(1 + 2c) for the highlight and 255 kd 1.165 (1 - c)/(1 + 2c)
//! for diffuse light, c the smallest cosine between two corners' normals.

use crate::{
    features::{PERSPECTIVE, VERTEX_COLOURS},
    format::{CHANNEL, FULL, LEVEL},
    geometry::projection::ScreenVertex,
    interpolate::{
        by_column::ByColumn,
        field::{Field, Nodes},
        plane::Plane,
        squares::Squares,
    },
    lighting::{
        albedo::{Albedo, IfColoured, Parts},
        constant_lights::Tint,
        material_tables::MaterialTables,
        reflectance::Reflectance,
    },
    math::vector::{map, zip},
    method::{
        Facts, LEVEL_RANGE, LinearWay, Loops, Method, Shading, Style, TriangleSetup, VertexLight, channels, fit_levels, indices, largest,
        largest_range, node::mixed, texture, three_levels,
    },
    pixel::{Pixel, ramps::Ramps},
    raster::{
        band::Band,
        canvas::Canvas,
        pixel_shader::{PixelShader, Ramp, Rgb},
    },
    setup::gradients::Gradients,
};

static FACTS: Facts = Facts { name: "gouraud", id: 1, source: "Gouraud 1971", vertex_light: VertexLight::ReflectionOrLevels, ..Facts::OWN };

/// Gouraud shading.
pub struct Gouraud;

impl Method for Gouraud {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn needs_highlight_tables(&self) -> bool {
        false
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        if setup.has_texture() {
            return setup.draw_parts(corner_parts(setup, shading), canvas);
        }
        shading.draw_levels::<3, LEVEL_RANGE>(setup, corner_levels(setup, shading), canvas)
    }
}

impl Loops for Gouraud {
    const APART: bool = true;
    const DECLINES: bool = false;
    fn take(style: Style) -> bool {
        style.is_plain
    }

    #[inline(always)]
    fn draw<C: Pixel, const THREE: bool>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        let [a, b, c] = setup.corners;
        if setup.has_texture() {
            return texture::fill(setup, shading, &corner_parts(setup, shading), tables, band);
        }
        if PERSPECTIVE {
            match setup.linear_way(|| largest_range(corner_levels(setup, shading))) {
                LinearWay::Plane => {}
                LinearWay::Quadratic(middles) => return Some(draw_seen(setup, shading, middles, tables, band)),
                LinearWay::InSpace => return draw_in_space(setup, shading, tables, band),
            }
        }
        // In colours, meshes with colours at their corners have three channels.
        if C::GRAY && setup.albedos().is_some() {
            return Some(Shading::fill_one(setup, || corner_levels(setup, shading).map(|[level, ..]| level), tables, band));
        }
        if !THREE {
            return Some(setup.fill(|| one::<C>(setup.gradients, [a.light[2], b.light[2], c.light[2]]), Ramp(tables.ramps), band));
        }
        // Each of these is drawn by a call of its own: by measurement, what they have in common is set up sooner.
        if shading.constant.is_none() {
            let channels = || {
                let [[r0, g0, b0], [r1, g1, b1], [r2, g2, b2]] = setup.levels();
                [[r0, r1, r2], [g0, g1, g2], [b0, b1, b2]]
            };
            return Some(shading.fill_three(setup, channels, 0, |plane| plane, band));
        }
        Some(draw_three(setup, shading, 0, tables, band))
    }
}

/// Draws a triangle of one channel, with all levels `raise` higher. Returns the number of its pixels in `band`.
#[inline(never)]
pub(crate) fn draw_one<C: Pixel>(setup: &TriangleSetup<'_>, raise: i32, tables: MaterialTables<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let [a, b, c] = setup.corners;
    let levels = || [a.light[2] + raise, b.light[2] + raise, c.light[2] + raise];
    setup.fill(|| fit_levels::<3, C>(setup.gradients, levels()), Ramp(tables.ramps), band)
}

/// Whether a triangle of three channels under one constant light is a ramp of the table of colours: no corner has a highlight.
#[inline]
pub(crate) fn has_ramp(setup: &TriangleSetup<'_>, reflectance: &Reflectance) -> bool {
    let [a, b, c] = setup.corners;
    a.light[2] | b.light[2] | c.light[2] == 0 && reflectance.has_ramp()
}

/// Draws a triangle of three channels under one constant light, with all levels `raise` higher. Returns the number of its pixels in `band`.
#[inline(always)]
pub(crate) fn draw_three<C: Pixel>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    raise: i32,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> u32 {
    let ([a, b, c], reflectance) = (setup.corners, tables.reflectance.reflectance());
    // By the table of colours where the light has no highlight.
    if has_ramp(setup, reflectance) {
        let level = |[cosine, ..]: [i32; 4]| reflectance.ramp_level(cosine) + raise;
        let levels = || [level(a.light), level(b.light), level(c.light)];
        return setup.fill(|| one::<C>(setup.gradients, levels()), Ramp(tables.ramps), band);
    }
    if VERTEX_COLOURS
        && let Some(&[albedo, second, third]) = setup.albedos()
        && albedo == second
        && albedo == third
        && a.light[2] | b.light[2] | c.light[2] == 0
        && let Some((level, tint)) = tables.tint_of(albedo, raise)
    {
        let nodes = [level.at(a.light[0]), level.at(b.light[0]), level.at(c.light[0])];
        if largest(&nodes) <= FULL {
            return draw_tinted(setup, nodes, tint, band);
        }
    }
    let channels = || {
        let [[r0, g0, b0], [r1, g1, b1], [r2, g2, b2]] = reflections([a, b, c], setup.albedos, reflectance);
        [[r0, r1, r2], [g0, g1, g2], [b0, b1, b2]]
    };
    shading.fill_three(setup, channels, raise, |plane| plane, band)
}

/// Draws a triangle of one colour, under light without a hue that has these levels at the corners: each channel is a product of one walked level.
/// Returns the number of its pixels in `band`.
#[inline(never)]
fn draw_tinted<C: Pixel>(setup: &TriangleSetup<'_>, nodes: [i32; 3], tint: Tint<C>, band: &mut Band<'_, C>) -> u32 {
    setup.fill(|| Nodes::<3, 1, LEVEL_RANGE>::new([nodes], CHANNEL - LEVEL).fit(setup.gradients), tint, band)
}

impl<C: Pixel> PixelShader<[u32; 1]> for Tint<C> {
    type Pixel = C;

    #[inline]
    fn shade(&self, [level]: [u32; 1]) -> C {
        self.lit(level)
    }
}

/// Draws a triangle by the quadratic through the levels at the corners and at these shares of the edges. Returns the number of its pixels in `band`.
#[inline(never)]
fn draw_seen<C: Pixel>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    [ab, bc, ca]: [u16; 3],
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> u32 {
    let six = |[a, b, c]: [i32; 3]| [a, b, c, mixed(a, b, ab), mixed(b, c, bc), mixed(c, a, ca)];
    let (corners, reflectance) = (setup.corners, shading.reflectance);
    if shading.constant.is_some() && reflectance.three_channels() && has_ramp(setup, &reflectance) {
        let levels = || six(corners.map(|corner| reflectance.ramp_level(corner.light[0])));
        return Shading::fill_one(setup, levels, tables, band);
    }
    let levels = || channels(corner_levels(setup, shading));
    if C::GRAY || !reflectance.three_channels() {
        return Shading::fill_one(setup, || six(levels()[0]), tables, band);
    }
    shading.fill_three(setup, || levels().map(six), 0, ByColumn, band)
}

/// Draws a triangle that reaches so far that the light at each pixel is that of the point in space. Returns the number of its pixels in
/// `band`; `None` if it reaches too far.
#[inline(never)]
fn draw_in_space<C: Pixel>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32> {
    let (seen, reflectance) = (setup.in_space(())?, shading.reflectance);
    let channels = channels(corner_levels(setup, shading));
    if !C::GRAY && reflectance.three_channels() {
        let levels = || seen.with(three_levels::<3, C>(channels, 0).slant());
        return Some(setup.fill(levels, Rgb::new(reflectance.quarter), band));
    }
    let patch = || seen.with(indices::<3, C>(channels[0]).slant());
    Some(if C::Ramps::CHECKERED {
        setup.fill(|| Squares::new(patch(), setup.gradients.row()), Ramp(tables.ramps), band)
    } else {
        setup.fill(patch, Ramp(tables.ramps), band)
    })
}

/// A function of its own: measured, the loop that draws the triangle has more registers then.
#[inline(never)]
fn one<C: Pixel>(gradients: &Gradients, levels: [i32; 3]) -> Plane<1> {
    fit_levels::<3, C>(gradients, levels)
}

/// The levels at the corners.
fn corner_levels(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [[i32; 3]; 3] {
    if shading.constant.is_some() {
        return reflected(setup, &shading.reflectance);
    }
    setup.levels()
}

/// The parts of light at the corners of a triangle with a texture.
#[inline(never)]
pub(crate) fn corner_parts(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [Parts; 3] {
    if shading.constant.is_none() {
        return map(setup.corners, |corner| Parts::unpacked(corner.light));
    }
    map(setup.corners, |ScreenVertex { light: [cosine, _, highlight, _], .. }| {
        shading.reflectance.reflected_parts(*cosine, *highlight as u32)
    })
}

/// The levels at the corners under one constant light.
pub(crate) fn reflected(setup: &TriangleSetup<'_>, reflectance: &Reflectance) -> [[i32; 3]; 3] {
    if reflectance.three_channels() || setup.albedos().is_some() {
        reflections(setup.corners, setup.albedos, reflectance)
    } else {
        setup.corners.map(|corner| [corner.light[2]; 3])
    }
}

/// The levels at corners whose light is [`VertexLight::ReflectionOrLevels`] of one constant light in three channels.
#[inline(never)]
fn reflections([a, b, c]: [&ScreenVertex; 3], albedos: IfColoured<Option<&[Albedo; 3]>>, reflectance: &Reflectance) -> [[i32; 3]; 3] {
    if let Some(albedos) = albedos.first().copied().flatten() {
        let lit = |albedo: Albedo, [cosine, _, highlight, _]: [i32; 4]| albedo.lit(reflectance.reflected_parts(cosine, highlight as u32));
        return zip(*albedos, [a.light, b.light, c.light], lit);
    }
    let level = |[cosine, _, highlight, _]: [i32; 4]| reflectance.reflection(cosine, highlight as u32);
    [level(a.light), level(b.light), level(c.light)]
}
