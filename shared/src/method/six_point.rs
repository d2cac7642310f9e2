//! The six-point quadratic (Szirmay-Kalos et al.; Vlasic 2002, 4.2): lit at the
//! corners and at the edges' midpoints, quadratic in between.
//!
//! Cost: two additions a pixel and channel. Continuous: both neighbours light the
//! same midpoint. Good for wide highlights or fine meshes; a highlight narrower
//! than a triangle is flattened.

use crate::{
    lighting::materials::{Highlight, MaterialTables, Reflectance},
    method::{Costs, Facts, Loops, Method, RANGE, Shading, Style, TriangleSetup, VertexLight, channels, first, node::zip_six},
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas},
};

static FACTS: Facts = Facts {
    name: "six-point",
    id: 2,
    source: "Szirmay-Kalos et al. 2000; Vlasic 2002",
    vertex_light: VertexLight::CosinesOrLevels,
    highlight: Highlight::Half,
    highlight_levels: false,
    near_lights: true,
    perspective: true,
    costs: Costs::new(2, 0, 0, 135),
};

/// Six-point shading.
pub struct SixPoint;

impl Method for SixPoint {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        shading.draw_levels::<6, RANGE>(setup, levels(setup, shading), canvas)
    }
}

impl Loops for SixPoint {
    fn take(style: Style) -> bool {
        !style.dithered_or_antialiased && !style.perspective
    }

    #[inline(always)]
    fn draw<C: Pixel>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        Some(if !C::GRAY && shading.reflectance.three_channels() {
            three(setup, shading, band)
        } else {
            let nodes = || match shading.constant {
                Some(_) => one_level(setup, shading.reflectance),
                None => first(lit(&setup.for_lighting(), shading)),
            };
            Shading::fill_one(setup, nodes, tables, band)
        })
    }
}

#[inline(always)]
fn three<C: Pixel>(setup: &TriangleSetup<'_>, shading: &Shading<'_>, band: &mut Band<'_, C>) -> u32 {
    Shading::fill_three(setup, || channels(lit(&setup.for_lighting(), shading)), band)
}

/// Levels at the six nodes.
#[inline(never)]
fn levels(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [[i32; 3]; 6] {
    if shading.vertices_have_cosines() {
        return zip_six(setup.six_cosines(0), setup.six_cosines(1), |l, h| [shading.reflectance.level([l, h]); 3]);
    }
    lit(setup, shading)
}

/// Levels of a material of one channel at the six nodes under one constant light.
#[inline(always)]
fn one_level(setup: &TriangleSetup<'_>, reflectance: &Reflectance) -> [i32; 6] {
    let light = setup.six_cosines(0);
    if setup.has_no_highlight(reflectance) { reflectance.six_diffuse(light) } else { reflectance.six(light, setup.six_cosines(1)) }
}

/// Node levels under any lights: corners are lit already, midpoints are lit here.
#[inline(always)]
fn lit(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> [[i32; 3]; 6] {
    let [a, b, c] = setup.corners;
    let [ab, bc, ca] = shading.middle_levels(setup);
    [a.light, b.light, c.light, ab, bc, ca]
}
