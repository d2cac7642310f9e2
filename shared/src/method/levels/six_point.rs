//! The six-point quadratic (Szirmay-Kalos et al.; Vlasic 2002, 4.2): light at the corners and the edges' midpoints, interpolated quadratically.
//!
//! Cost: two additions a pixel and channel. Continuous: both neighbours light the midpoint of their edge alike, but for a strongly curved one in
//! perspective. It is good for wide highlights or fine meshes. A highlight narrower than a triangle is flattened.

use crate::{
    interpolate::by_column::ByColumn,
    lighting::{albedo::Parts, material_tables::MaterialTables},
    method::{
        Facts, LEVEL_RANGE, Loops, Method, Shading, Style, TriangleSetup, VertexLight, channels, levels::gouraud, node::map_six, texture,
    },
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas},
};
use core::array::from_fn;

static FACTS: Facts = Facts {
    name: "six-point",
    id: 2,
    source: "Szirmay-Kalos et al. 2000; Vlasic 2002",
    vertex_light: VertexLight::CosinesOrLevels,
    ..Facts::OWN
};

/// Six-point shading.
pub struct SixPoint;

impl Method for SixPoint {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        let on_screen = setup.on_screen();
        let area = if setup.has_screen_nodes() { &on_screen } else { setup };
        if setup.has_texture() {
            return area.draw_parts(parts(setup, shading), canvas);
        }
        shading.draw_channels::<6, LEVEL_RANGE>(area, &levels(setup, shading), [0; 3], canvas)
    }
}

impl Loops for SixPoint {
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
        if !setup.has_screen_nodes() {
            return None;
        }
        if setup.has_texture() {
            return texture::fill(setup, shading, &parts(setup, shading), tables, band);
        }
        let reflectance = shading.reflectance;
        // One constant light without a highlight is one number also in three channels.
        let one = C::GRAY
            || !reflectance.three_channels()
            || shading.constant.is_some() && reflectance.has_ramp() && setup.has_no_highlight(&reflectance);
        if !one {
            return Some(draw_rgb(setup, shading, band));
        }
        let nodes = || match shading.constant {
            Some(_) => one_level(setup, shading),
            None => lit(&setup.for_lighting(), shading)[0],
        };
        Some(Shading::fill_one(setup, nodes, tables, band))
    }
}

/// Draws `setup` in three channels.
#[inline(never)]
fn draw_rgb<C: Pixel>(setup: &TriangleSetup<'_>, shading: &Shading<'_>, band: &mut Band<'_, C>) -> u32 {
    shading.fill_three(setup, || levels(&setup.for_lighting(), shading), 0, ByColumn, band)
}

/// N·L (Q2.30) and the highlight (unsigned Q0.16) of one constant light at the six nodes.
#[inline]
fn reflected(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> ([i32; 6], [u32; 6]) {
    let light = setup.six_diffuse();
    if setup.has_no_highlight(&shading.reflectance) {
        return (light, [0; 6]);
    }
    (light, map_six(setup.six_half(shading.exponent), |half| shading.reflectance.highlight_at(half)))
}

/// The parts of light at the six nodes of a triangle with a texture.
#[inline(never)]
fn parts(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [Parts; 6] {
    if shading.constant.is_some() {
        let (cosines, highlights) = reflected(setup, shading);
        return from_fn(|k| shading.reflectance.reflected_parts(cosines[k], highlights[k]));
    }
    let ([a, b, c], [ab, bc, ca]) = (gouraud::corner_parts(setup, shading), shading.middle_parts(setup));
    [a, b, c, ab, bc, ca]
}

/// Levels at the six nodes, in three channels.
#[inline(never)]
fn levels(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [[i32; 6]; 3] {
    if shading.constant.is_none() {
        return lit(setup, shading);
    }
    if !shading.reflectance.three_channels() && setup.albedos().is_none() {
        return [one_level(setup, shading); 3];
    }
    three_levels(setup, shading)
}

/// Levels of a material of three channels at the six nodes under one constant light.
#[inline(never)]
fn three_levels(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [[i32; 6]; 3] {
    let (cosines, highlights) = reflected(setup, shading);
    if let Some(colours) = setup.six_colours() {
        let lit = |k: usize| colours[k].lit(shading.reflectance.reflected_parts(cosines[k], highlights[k]));
        return channels([lit(0), lit(1), lit(2), lit(3), lit(4), lit(5)]);
    }
    let level = |channel| shading.reflectance.six(channel, cosines, highlights);
    [level(0), level(1), level(2)]
}

/// Levels of a material of one channel at the six nodes under one constant light.
#[inline(always)]
fn one_level(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [i32; 6] {
    let (light, reflectance) = (setup.six_diffuse(), shading.reflectance);
    if setup.has_no_highlight(&reflectance) {
        return reflectance.six_diffuse_clamped(light);
    }
    reflectance.six(0, light, map_six(setup.six_half(shading.exponent), |half| reflectance.highlight_at(half)))
}

/// Node levels under any lights: corners are lit already, midpoints are lit here.
#[inline]
fn lit(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [[i32; 6]; 3] {
    let [[r0, g0, b0], [r1, g1, b1], [r2, g2, b2]] = setup.levels();
    let [[r3, g3, b3], [r4, g4, b4], [r5, g5, b5]] = shading.middle_levels(setup);
    [[r0, r1, r2, r3, r4, r5], [g0, g1, g2, g3, g4, g5], [b0, b1, b2, b3, b4, b5]]
}
