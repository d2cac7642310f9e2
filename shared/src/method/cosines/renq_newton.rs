//! Quadratic renormalisation, corrected by Newton's iteration: q = m (3 - D m²)/2 with m from [`crate::method::cosines::renq`] and D = |N|².
//!
//! One step squares m's relative error, delta <= 0.02 e⁴, e² = 3 (1 - min |N|²), to 1.5 delta²; where that still shows at the material's
//! exponent, on strongly curved triangles, a second step is taken. No root, no division, no table but the highlight's.
//!
//! Cost: 6 additions a pixel, 5 products (8 with two steps) and the highlight's table; 2 or 4 additions and 2 products
//! more per light. Continuous. Error against Phong under constant light: 0.1 LSB and the table's.
//! Domain: any lights; where |N| falls below 1/2, [`crate::method::cosines::duff`]'s root takes over. Under near lights, and for a local viewer, no
//! quadratic through six points is exact: there it is [`crate::method::cosines::phong`].

use crate::{
    arch::product::{unsigned_product, upper},
    format::NORMAL_LENGTH,
    lighting::{material_tables::MaterialTables, reflectance::Reflection},
    math::highlight_lut::CosineLookup,
    method::{
        Facts, HighlightField, Loops, Method, Shading, Style, TriangleSetup, VertexLight,
        cosines::{duff, phong::Phong, quotient, renq},
        lighting_model::{LightingModel, signed},
    },
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas},
};

static FACTS: Facts = Facts {
    name: "renq-newton",
    id: 25,
    source: "microphong 2026",
    vertex_light: VertexLight::Cosines,
    highlight_levels: true,
    highlight_field: HighlightField::Quadratic,
    ..Facts::OWN
};

/// Quadratic renormalisation, corrected by Newton's iteration.
pub struct RenqNewton;

impl Method for RenqNewton {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        if !shading.lighting.is_constant() || duff::is_curved(setup) {
            return Phong.shade(setup, shading, canvas);
        }
        // Always two steps, although one is often enough: so the general loop needs one shader.
        duff::draw_constant(
            setup,
            shading,
            (renq::length(setup, shading.exponent), duff::square(setup, shading.exponent)),
            Newton::<2>,
            canvas,
        )
    }
}

impl Loops for RenqNewton {
    fn take(style: Style) -> bool {
        style.lights == 1 && style.is_plain()
    }

    #[inline(always)]
    fn draw<C: Pixel, const THREE: bool>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        // Strongly curved triangles, rare: a root for each pixel.
        let is_exact = || setup.place.is_some() || setup.gradients.walks_in_words();
        if duff::is_curved(setup) || needs_two(setup.triangle.min_normal_length, shading.exponent) || !is_exact() {
            return None;
        }
        let lengths = || (renq::length(setup, shading.exponent), duff::square(setup, shading.exponent));
        quotient::draw::<false, _, C>(setup, &setup.corner_lights(), lengths, |lengths| Newton::<1>.half_reciprocal(lengths), tables, band)
    }
}

/// Whether one step may leave more than 0.1 LSB: 255 n 1.5 delta² > 0.1 with delta = 0.02 e⁴ and e² = 3 (1 - r²), r the least length
/// of normals: on a grid, no triangle with r² of at least 1/2 has more than 0.0202 e⁴, and none where this decides more than 0.015 e⁴.
fn needs_two(min_length: u16, exponent: u16) -> bool {
    // e² in Q2.30, e⁴ in Q.28, e⁸ in Q.24; 255 · 1.5 · 0.02² = 0.153.
    let length = u32::from(min_length);
    let chord2 = 3 * ((1 << 30) - ((length * length) >> (2 * NORMAL_LENGTH - 30)));
    let upper = |a: u32, b: u32| (unsigned_product(a, b) >> 32) as u32;
    let chord4 = upper(chord2, chord2);
    unsigned_product(upper(chord4, chord4), u32::from(exponent)) > LIMIT
}

/// 0.1 / (255 · 1.5 · 0.02²), Q.24.
const LIMIT: u64 = (0.1 / (255.0 * 1.5 * 0.02 * 0.02) * (1u64 << 24) as f64) as u64;

/// One step from h towards 1/(2 sqrt(D)): h (3 - 4 D h²)/2, Q2.30.
#[inline(always)]
fn newton(h: i32, square: i32) -> i32 {
    // Upper halves of products: h² in Q4.28, D h² in Q6.26. 3 - 4 D h² is about 2: Q3.29.
    let product = upper(upper(h, h), square);
    upper(h, ((3 << 26) - (product << 2)) << 3) << 2
}

/// One Newton step, or two.
#[derive(Clone, Copy)]
struct Newton<const STEPS: usize>;

impl<const STEPS: usize> Newton<STEPS> {
    /// 1/(2|N|), Q2.30.
    #[inline(always)]
    fn half_reciprocal(self, ([length], [square]): ([u32; 1], [u32; 1])) -> i32 {
        let (length, square) = (signed(length), signed(square));
        let once = newton(length, square);
        if STEPS == 1 { once } else { newton(once, square) }
    }
}

impl<const STEPS: usize> LightingModel<([u32; 1], [u32; 1]), [u32; 2]> for Newton<STEPS> {
    type Common = i32;

    #[inline(always)]
    fn common(&self, lengths: ([u32; 1], [u32; 1])) -> i32 {
        self.half_reciprocal(lengths)
    }

    #[inline(always)]
    fn reflect(&self, light: usize, length: &i32, fields: [u32; 2], lut: CosineLookup<'_>) -> Reflection {
        renq::Scaled.reflect(light, length, fields, lut)
    }
}
