//! Normals turned at constant speed: on great circles along the edges, then along the rows (Shoemake 1985; Goldman,
//! Fundamentals of computer graphics).
//!
//! On a row the normal is l cos a + q sin a, q at a right angle to l and a linear, and so is every product with it: sine
//! and cosine are turned from pixel to pixel by the addition theorem, and no root is needed.
//!
//! Cost: 4 products a pixel, and 4 a light with the highlight's table; a row has 2 divisions, a unit vector, 4 pairs of
//! sine and cosine and an arc tangent to set up, a triangle 6 unit vectors and 3 arc tangents. Rows at different angles
//! see different normals at one point: a picture turns with the camera, but not its light. Domain: directional lights
//! and an infinitely far viewer.

use crate::{
    angle::sin_cos,
    arc::Arc,
    scanline::{self, Edges, Rows},
};
use microphong::{
    math::vector::{dot, normalise, wide},
    method::{
        Canvas, Constant, CosineLookup, Facts, Highlight, HighlightField, Lighting, LightingModel, Method, Patch, Reflection, Shading,
        Source, TriangleSetup, VertexLight, Walker, cosine,
    },
};

static FACTS: Facts = Facts {
    name: "slerp",
    id: 9,
    source: "Shoemake 1985; Kuijk & Blake 1989",
    vertex_light: VertexLight::None,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: false,
    perspective: false,
};

/// Normals turned at constant speed.
pub struct Slerp;

impl Method for Slerp {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let edges = Edges::new(setup);
    let (rows, arcs) = (edges.rows(setup), arcs(setup.vertices().map(|vertex| wide(vertex.normal))));
    // The normal itself: its products with the axes.
    let one = 1 << 30;
    let arcs = Arcs { rows, arcs, along: [[one, 0, 0], [0, one, 0], [0, 0, one]] };
    scanline::draw(setup, shading, |_| Constant, arcs, Many(shading.lighting), canvas)
}

/// The arcs along the three edges between normals of any length.
pub fn arcs(normals: [[i32; 3]; 3]) -> [Arc; 3] {
    let [a, b, c] = normals.map(normalise);
    [Arc::new(a, b), Arc::new(b, c), Arc::new(c, a)]
}

/// Normals along rows, multiplied by `M` vectors.
#[derive(Clone, Copy)]
struct Arcs<'e, const M: usize> {
    rows: Rows<'e>,
    arcs: [Arc; 3],
    along: [[i32; 3]; M],
}

impl<const M: usize> Patch for Arcs<'_, M> {
    type Walker = Turning<M>;

    fn jump(&mut self, rows: i32) {
        self.rows.jump(rows);
    }

    fn step_row(&mut self) {
        self.rows.jump(1);
    }

    fn enter(&self, x: i32) -> Turning<M> {
        let span = self.rows.span(x);
        let [l, r] = span.ends.map(|end| end.of(self.arcs).at(end.along));
        let row = Arc::new(l, r);
        let [last, step] = [span.last, span.step].map(|t| ((i64::from(row.angle) * i64::from(t)) >> 30) as i32);
        span.enter(Turning {
            place: sin_cos(last.wrapping_add(step)),
            step: sin_cos(step),
            products: self.along.map(|v| [row.across, row.start].map(|axis| (dot(axis, v) >> 30) as i32)),
        })
    }
}

/// Walks from the right end of a row to the left.
#[derive(Clone, Copy)]
struct Turning<const M: usize> {
    /// Sine and cosine of the angle from the left end, Q2.30, and of what a pixel adds to it.
    place: [i32; 2],
    step: [i32; 2],
    /// Factors of sine and cosine in each product.
    products: [[i32; 2]; M],
}

/// `a b + c d`, Q2.30, rounded.
#[inline(always)]
fn sum([a, c]: [i32; 2], [b, d]: [i32; 2]) -> i32 {
    ((i64::from(a) * i64::from(b) + i64::from(c) * i64::from(d) + (1 << 29)) >> 30) as i32
}

impl<const M: usize> Walker for Turning<M> {
    /// Products with the normal, Q2.30.
    type Value = [i32; M];

    #[inline(always)]
    fn step(&mut self) {
        let [sine, cosine] = self.step;
        self.place = [sum(self.place, [cosine, -sine]), sum(self.place, [sine, cosine])];
    }

    #[inline(always)]
    fn value(&self) -> [i32; M] {
        self.products.map(|factors| sum(factors, self.place))
    }
}

/// Any lights; the products are the normal.
#[derive(Clone, Copy)]
struct Many<'f>(&'f Lighting);

impl LightingModel<[i32; 3], ()> for Many<'_> {
    type Common = [i32; 3];

    fn common(&self, normal: [i32; 3]) -> [i32; 3] {
        normal
    }

    fn reflect(&self, light: usize, &normal: &[i32; 3], (): (), lut: CosineLookup<'_>) -> Reflection {
        let Some(directions) = self.0.sources().get(light).and_then(Source::directional) else {
            return Reflection { diffuse: 0, highlight: 0 };
        };
        let [diffuse, half] = directions.map(|v| cosine(normal, v) >> 3);
        Reflection { diffuse, highlight: lut.at(half) }
    }
}
