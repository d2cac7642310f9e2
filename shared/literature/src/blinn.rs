//! The highlight as a map around H (Vlasic 2002, 4.3): the normal's coordinates across H linear between the corners.
//!
//! With the unit vectors x (upwards as far as H allows) and y = H × x the normal has the coordinates (u, v) = (x·N, y·N),
//! and (N·H)² = 1 - u² - v². Their square grows on towards H, so a line through them misses the highlight's middle by less
//! than one through N·H does. Behind H the square would shrink again: corners there are put on the unit circle, where
//! there is no light. Diffuse light is linear between the corners.
//!
//! Cost: 3 additions, 2 squares and the highlight's table a pixel and light. Continuous. Error against Phong: 17 LSB on a
//! sphere of 168 triangles, 9 on one of 690 (exponent 50, ks 1/2). Domain: any lights; the map turns quickly where H is
//! nearly upright.

use microphong::{
    format::{COSINE, PIXEL_COSINE},
    math::vector::{cross, normalise, zip},
    method::{
        Canvas, Constant, CosineLookup, Facts, Highlight, HighlightField, Lighting, LightingModel, Method, Node, Reflection, Shading,
        Source, TriangleSetup, VertexLight, cosine, linear, signed,
    },
};

static FACTS: Facts = Facts {
    name: "blinn",
    id: 21,
    source: "Vlasic 2002",
    vertex_light: VertexLight::None,
    highlight: Highlight::HalfSquared,
    highlight_levels: false,
    highlight_field: HighlightField::Plane,
    near_lights: true,
    perspective: true,
};

/// Highlights from a map around the half vector.
pub struct Blinn;

impl Method for Blinn {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let corners = setup.corner_nodes();
    let fit = |source: &Source| {
        let [diffuse, u, v] = coordinates(shading.lighting, source, corners);
        linear([diffuse.map(|diffuse| diffuse.max(source.darkest())), u, v])
    };
    shading.draw_lit(setup, fit, Constant, Across, canvas)
}

/// `[N·L, u, v]` at each node, Q2.30.
pub fn coordinates<const NODES: usize>(lighting: &Lighting, source: &Source, nodes: [Node; NODES]) -> [[i32; NODES]; 3] {
    let [_, up, _] = lighting.axes;
    let map = |node: Node| Map::new(lighting.directions(source, node.position), up);
    // Constant light has one map.
    let [first, ..] = &nodes[..] else { return [[0; NODES]; 3] };
    let fixed = lighting.is_constant().then(|| map(*first));
    let values = nodes.map(|node| fixed.unwrap_or_else(|| map(node)).at(node.normal));
    [values.map(|[d, ..]| d), values.map(|[_, u, _]| u), values.map(|[.., v]| v)]
}

/// L, H and the two axes across H, unit vectors in Q2.30.
#[derive(Clone, Copy)]
struct Map {
    towards: [i32; 3],
    half: [i32; 3],
    x: [i32; 3],
    y: [i32; 3],
}

impl Map {
    fn new([towards, half]: [[i32; 3]; 2], up: [i32; 3]) -> Self {
        let along = i64::from(cosine(up, half));
        let x = normalise(zip(up, half, |u, h| (i64::from(u) - ((along * i64::from(h)) >> COSINE)) as i32));
        Self { towards, half, x, y: cross(half, x).map(|c| (c >> COSINE) as i32) }
    }

    /// `[N·L, u, v]` of a normal, Q2.30.
    fn at(&self, normal: [i32; 3]) -> [i32; 3] {
        let [u, v] = [self.x, self.y].map(|axis| cosine(axis, normal));
        let [u, v] = if cosine(self.half, normal) >= 0 { [u, v] } else { on_circle([u, v]) };
        [cosine(self.towards, normal), u, v]
    }
}

/// Scaled to length one; (1, 0) if there is no direction.
fn on_circle([u, v]: [i32; 2]) -> [i32; 2] {
    match normalise([u, v, 0]) {
        [0, 0, _] => [1 << COSINE, 0],
        [u, v, _] => [u, v],
    }
}

/// Looks the highlight up at the normal's place across H.
#[derive(Clone, Copy)]
pub struct Across;

impl LightingModel<(), [u32; 3]> for Across {
    type Common = ();

    #[inline(always)]
    fn common(&self, (): ()) {}

    #[inline(always)]
    fn reflect(&self, _: usize, (): &(), [diffuse, u, v]: [u32; 3], lut: CosineLookup<'_>) -> Reflection {
        // Q4.60 to Q5.27.
        let square = |c: u32| i64::from(signed(c)) * i64::from(signed(c));
        let squares = ((square(u) + square(v)) >> (2 * COSINE - PIXEL_COSINE)) as i32;
        Reflection { diffuse: signed(diffuse) >> 3, highlight: lut.at((1 << PIXEL_COSINE) - squares) }
    }
}
