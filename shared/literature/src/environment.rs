//! Highlights as a picture of the surroundings (Vlasic 2002, 4.2; Blinn & Newell 1976): the coordinates of a sphere map
//! linear between the corners.
//!
//! A sphere map keeps the direction W, in which the eye sees the surroundings mirrored, as (u, v) = (Wx, Wy)/m with
//! m = |W + (0, 0, 1)| in the axes of the eye. Instead of a texture the pixel turns (u, v) into W again and raises
//! W·L to a quarter of the exponent. One map serves the whole object: near lights shine as from its origin.
//! Diffuse light is linear between the corners.
//!
//! Cost: 2 additions, a root and 4 products a pixel; an addition, 3 products and the highlight's table per light. Continuous,
//! but where a corner's normal points away from the eye its W is mirrored once more, and triangles along
//! the silhouette sweep the whole map. Error against Phong: large there, else [`microphong::method::levels::gouraud`]'s of diffuse light.
//! Domain: any lights; the highlights of near ones are wrong by design.

use crate::fields::Held;
use microphong::{
    format::{COSINE, POSITION, UNIT},
    math::{
        rsqrt::Root,
        vector::{dot, normalise, zip},
    },
    method::{
        Canvas, CosineLookup, Facts, Highlight, HighlightField, Lighting, LightingModel, Method, Node, Reflection, Shading, Source,
        TriangleSetup, VertexLight, Viewer, cosine, linear, signed,
    },
};

/// The number 1 in Q2.30.
const ONE: i32 = 1 << COSINE;

static FACTS: Facts = Facts {
    name: "environment",
    id: 20,
    source: "Vlasic 2002",
    vertex_light: VertexLight::None,
    highlight: Highlight::Reflected,
    highlight_levels: false,
    highlight_field: HighlightField::Plane,
    near_lights: true,
    perspective: true,
};

/// Highlights from a sphere map.
pub struct Environment;

impl Method for Environment {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let (corners, lighting) = (setup.corner_nodes(), shading.lighting);
    let [a, b, c] = corners.map(|corner| coordinates(lighting, &corner));
    let map = linear([[a[0], b[0], c[0]], [a[1], b[1], c[1]]]);
    let fit = |source: &Source| {
        let to_eye = |v: [i32; 3]| lighting.axes.map(|axis| cosine(axis, v));
        (linear([diffuse(&corners, source)]), Held(to_eye(source.towards([0; 3]))))
    };
    shading.draw_lit(setup, fit, map, Mirror, canvas)
}

/// The corners' N·L, not negative unless the light comes from the sky.
fn diffuse(corners: &[Node; 3], source: &Source) -> [i32; 3] {
    corners.map(|corner| cosine(corner.normal, source.towards(corner.position)).max(source.darkest()))
}

/// (u, v) of W = 2(N·V)N - V, Q2.30; all in the axes of the eye.
fn coordinates(lighting: &Lighting, node: &Node) -> [i32; 2] {
    let normal = lighting.axes.map(|axis| cosine(axis, node.normal));
    let [x, y, z] = match lighting.viewer() {
        Viewer::Infinite(_) => [0, 0, ONE],
        Viewer::Local(_) => normalise_wide(zip(lighting.axes, lighting.eye, |axis, eye| {
            (i64::from(eye) << (COSINE + POSITION - UNIT)) - dot(axis, node.position)
        })),
    };
    // Half of W + (0, 0, 1), Q4.60: where it is small, all its bits count.
    let nv = i64::from(cosine(normal, [x, y, z]));
    let [u, v, _] = normalise_wide(zip(normal, [-x, -y, ONE - z], |n, ahead| i64::from(n) * nv + (i64::from(ahead) << (COSINE - 1))));
    [u, v]
}

/// The unit vector along `v`, Q2.30; zero stays zero.
fn normalise_wide(v: [i64; 3]) -> [i32; 3] {
    let zeros = v.iter().fold(0, |m, c| m | c.unsigned_abs()).leading_zeros();
    // The largest component to 30 bits.
    normalise(v.map(|c| ((c << (zeros.min(63).saturating_sub(2))) >> 32) as i32))
}

/// Looks the light up in the mirrored surroundings.
#[derive(Clone, Copy)]
struct Mirror;

impl LightingModel<[u32; 2], ([u32; 1], [i32; 3])> for Mirror {
    /// W in the axes of the eye, Q2.30.
    type Common = [i32; 3];

    #[inline(always)]
    fn common(&self, map: [u32; 2]) -> [i32; 3] {
        let [u, v] = map.map(signed);
        let square = ((i64::from(u) * i64::from(u) + i64::from(v) * i64::from(v)) >> COSINE) as i32;
        // sqrt(1 - u² - v²) as a value over its own root.
        let rest = ONE.wrapping_sub(square).max(0);
        let root = Root::of(rest as u32).divide(rest);
        let twice = |c: i32| ((i64::from(c) * i64::from(root)) >> (COSINE - 1)) as i32;
        [twice(u), twice(v), ONE.wrapping_sub(square).wrapping_sub(square)]
    }

    #[inline(always)]
    fn reflect(&self, _: usize, mirrored: &[i32; 3], ([diffuse], towards): ([u32; 1], [i32; 3]), lut: CosineLookup<'_>) -> Reflection {
        Reflection { diffuse: signed(diffuse) >> 3, highlight: lut.at((dot(*mirrored, towards) >> (COSINE + 3)) as i32) }
    }
}
