//! Per-pixel Phong shading (Phong 1975), highlights by the half vector (Blinn 1977).
//!
//! Normals, lights and viewer are linear over the screen. Every dot product of them is therefore linear or exactly quadratic and can be walked. Only
//! the roots that normalise are taken at each pixel. One constant light is drawn by [`crate::method::cosines::duff`], one light where it or the viewer
//! is near by `near`, and other near lights by `summed`.
//!
//! Cost: one constant light as `duff`; otherwise 6 additions and 2 roots, and 6 additions and 2 roots more for each light. Error: the tables' error,
//! mainly [`crate::math::highlight_lut::NEAREST_ERROR`] of the highlight. Domain: any lights and viewer.

use crate::{
    features::SUMS_LIGHTS,
    lighting::{
        lights::{Source, Viewer, point},
        material_tables::MaterialTables,
        reflectance::Reflection,
    },
    math::{
        highlight_lut::CosineLookup,
        rsqrt::Root,
        vector::{sub, wide},
    },
    method::{
        Facts, HighlightField, Loops, Method, Shading, Style, TriangleSetup, VertexLight,
        cosines::{
            duff,
            near::{self, Drawn},
            scale::Lengths,
            summed,
        },
        lighting_model::LightingModel,
        node::{field_product, is_steep},
        products::{quadratic, signed},
    },
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas},
};

static FACTS: Facts = Facts {
    name: "phong",
    id: 3,
    source: "Phong 1975; Blinn 1977",
    vertex_light: VertexLight::Cosines,
    highlight_levels: true,
    highlight_field: HighlightField::Quadratic,
    ..Facts::OWN
};

/// Phong shading: the normal is normalised at every pixel.
pub struct Phong;

impl Method for Phong {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        if shading.lighting.is_constant() { duff::shade_constant(setup, shading, canvas) } else { draw_by(setup, shading, Blinn, canvas) }
    }
}

impl Loops for Phong {
    fn take(style: Style) -> bool {
        duff::take(style) || near::take(style)
    }

    #[inline(always)]
    fn draw<C: Pixel, const THREE: bool>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        let mut cosines = None;
        if !shading.lighting.is_constant() {
            if C::GRAY || !near::suits(setup, shading, tables.reflectance) {
                return None;
            }
            if SUMS_LIGHTS && (tables.reflectance.lights != 1 || setup.albedos().is_some()) {
                return summed::draw::<C, true>(setup, shading, &Lengths::of(setup, is_steep(shading.exponent))?, tables, band);
            }
            match near::draw(setup, shading, tables, band)? {
                Drawn::Pixels(pixels) => return Some(pixels),
                Drawn::Constantly(corners) => cosines = Some(corners),
            }
        }
        duff::draw(setup, || cosines.unwrap_or_else(|| setup.corner_lights()), shading, tables, band)
    }
}

/// Shades by walked products of vectors.
pub fn draw_by<F>(setup: &TriangleSetup<'_>, shading: &Shading<'_>, model: F, canvas: &mut dyn Canvas) -> u32
where
    F: LightingModel<[u32; 3], [u32; 3]>,
{
    let positions = setup.vertices().map(|vertex| point(vertex.position));
    let normals = fitted(setup.vertices().map(|vertex| wide(vertex.normal)));
    let view = fitted(match shading.lighting.viewer() {
        Viewer::Infinite(towards) => [towards; 3],
        Viewer::Local(eye) => positions.map(|p| sub(eye, p)),
    });
    let common = quadratic([field_product(&normals, &normals), field_product(&view, &view), field_product(&normals, &view)]);
    let fit = |source: &Source| {
        let towards = fitted(match (source.directional(), source.point()) {
            (Some([towards, _]), _) => [*towards; 3],
            (None, position) => positions.map(|p| sub(position.unwrap_or_default(), p)),
        });
        quadratic([field_product(&normals, &towards), field_product(&towards, &towards), field_product(&view, &towards)])
    };
    shading.draw_lit(setup, fit, common, model, canvas)
}

/// A vector at the three corners, all shifted alike such that the longest is just below 1, in fractions of 28 bits.
fn fitted(vectors: [[i32; 3]; 3]) -> [[i32; 3]; 3] {
    let largest = vectors.as_flattened().iter().fold(1, |m, c| m | c.unsigned_abs());
    // The largest component below 2^27: lengths below 2^28, dot products of two fit 56 bits.
    let zeros = largest.leading_zeros();
    vectors.map(|v| v.map(|c| if zeros >= 5 { c << (zeros - 5) } else { c >> (5 - zeros) }))
}

/// Factors at a pixel that all lights share: they normalise the normal and the direction to the viewer.
#[derive(Clone, Copy, Default)]
pub struct Common {
    /// 1 over the length of the normal.
    pub normal: Root,
    /// 1 over the distance of the viewer.
    pub view: Root,
    /// N·V, Q2.30; the normal is not normalised.
    pub nv: i32,
}

impl Common {
    /// Computes the factors from walked N·N, V·V and N·V.
    pub fn new([nn, vv, nv]: [u32; 3]) -> Self {
        let (normal, view) = (Root::of(nn), Root::of(vv));
        Self { normal, view, nv: view.divide(signed(nv)) }
    }

    /// Computes N·L (the normal not normalised) and L·V from walked N·L, L·L and V·L.
    pub fn light(&self, [nl, ll, vl]: [u32; 3]) -> [i32; 2] {
        let light = Root::of(ll);
        [light.divide(signed(nl)), self.view.divide(light.divide(signed(vl)))]
    }
}

/// Highlights by the half vector.
#[derive(Clone, Copy)]
struct Blinn;

impl LightingModel<[u32; 3], [u32; 3]> for Blinn {
    type Common = Common;

    fn common(&self, products: [u32; 3]) -> Common {
        Common::new(products)
    }

    fn reflect(&self, _: usize, common: &Common, products: [u32; 3], lut: CosineLookup<'_>) -> Reflection {
        let [nl, vl] = common.light(products);
        // N·(L + V) / |L + V| with |L + V|² = 2 + 2 L·V: half of the sum over half of its length.
        let length = Root::of(((1 << 29) + (vl >> 1)).max(1) as u32);
        let nh = length.divide((nl >> 1) + (common.nv >> 1));
        Reflection { diffuse: common.normal.divide(nl) >> 3, highlight: lut.at(common.normal.divide(nh) >> 3) }
    }
}
