//! Gouraud shading (Gouraud 1971): lit at the corners, linear in between.
//!
//! Cost: one addition a pixel and channel. Continuous. Error against Phong: at
//! most 255 ks n (1 - c)/(1 + 2c) for the highlight and 255 kd 1.165 (1 - c)/(1 + 2c)
//! for diffuse light, c the smallest cosine between two corners' normals.

use crate::{
    interpolate::{field::Field, plane::Plane},
    lighting::materials::{Highlight, MaterialTables},
    method::{Costs, Facts, Loops, Method, RANGE, Shading, Style, TriangleSetup, VertexLight, level_field},
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas, pixel_shader::Ramp},
    setup::gradients::Gradients,
};

static FACTS: Facts = Facts {
    name: "gouraud",
    id: 1,
    source: "Gouraud 1971",
    vertex_light: VertexLight::Levels,
    highlight: Highlight::Half,
    highlight_levels: false,
    near_lights: true,
    perspective: true,
    costs: Costs::new(1, 0, 0, 10),
};

/// Gouraud shading.
pub struct Gouraud;

impl Method for Gouraud {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        let [a, b, c] = setup.corners;
        shading.draw_levels::<3, RANGE>(setup, [a.light, b.light, c.light], canvas)
    }
}

impl Loops for Gouraud {
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
        let [a, b, c] = setup.corners;
        Some(if !C::GRAY && shading.reflectance.three_channels() {
            three(setup, band)
        } else {
            setup.fill(|| one(setup.gradients, [a.light[0], b.light[0], c.light[0]]), Ramp(tables.ramp), band)
        })
    }
}

/// In a function of its own: by measurement, what draws the triangle has more registers then.
#[inline(never)]
fn one(gradients: &Gradients, levels: [i32; 3]) -> Plane<1> {
    level_field(levels).fit(gradients)
}

#[inline(always)]
fn three<C: Pixel>(setup: &TriangleSetup<'_>, band: &mut Band<'_, C>) -> u32 {
    let [a, b, c] = setup.corners;
    let channels = || {
        let ([r0, g0, b0], [r1, g1, b1], [r2, g2, b2]) = (a.light, b.light, c.light);
        [[r0, r1, r2], [g0, g1, g2], [b0, b1, b2]]
    };
    Shading::fill_three(setup, channels, |plane| plane, band)
}
