//! Goldman's scanlines: unit normals at the ends of each row, linear in between, their length by one step of Newton's
//! iteration per pixel (Goldman, Fundamentals of computer graphics; his forward difference of |N|² corrected).
//!
//! On a row N·L and N·V are linear and |N|² is 1 - 2(1 - c) t(1 - t), c the cosine between the ends. The length of one
//! pixel's normal is the first guess at the next one's, from the right end to the left, starting from 1. Highlights by
//! the reflected light, R·V = 2(N·L)(N·V)/|N|² - L·V, which need no root.
//!
//! Cost: a row has 2 divisions and 2 unit vectors to set up; a pixel takes 4 additions, 4 products and a division, and a visible one another division
//! and 5 products, with the highlight's table. Error of the length: (1/2) of the square of its change from pixel to pixel. Domain: directional lights
//! and an infinitely far viewer.

use crate::{
    divisor::Divisor,
    scanline::{self, Edges, Rows},
};
use microphong::{
    math::vector::{dot, normalise, wide},
    method::{
        Canvas, Constant, CosineLookup, Facts, Highlight, HighlightField, Lighting, LightingModel, Method, Patch, Reflection, Shading,
        Source, TriangleSetup, VertexLight, Viewer, Walker, cosine,
    },
};

static FACTS: Facts = Facts {
    name: "goldman",
    id: 8,
    source: "Goldman, Fundamentals of computer graphics",
    vertex_light: VertexLight::None,
    highlight: Highlight::Reflected,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: false,
    perspective: false,
};

/// Goldman's scanlines.
pub struct Goldman;

impl Method for Goldman {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    // A near viewer is refused before drawing.
    let Viewer::Infinite(view) = shading.lighting.viewer() else { return 0 };
    let edges = Edges::new(setup);
    let (rows, normals) = (edges.rows(setup), setup.vertices().map(|vertex| wide(vertex.normal).map(|c| c << 16)));
    // The normal itself: its products with the axes.
    let one = 1 << 30;
    let chords = Chords { rows, normals, along: [[one, 0, 0], [0, one, 0], [0, 0, one]] };
    scanline::draw(setup, shading, |_| Constant, chords, Many { lighting: shading.lighting, view }, canvas)
}

/// Normals along rows, multiplied by `M` vectors.
#[derive(Clone, Copy)]
struct Chords<'e, const M: usize> {
    rows: Rows<'e>,
    normals: [[i32; 3]; 3],
    along: [[i32; 3]; M],
}

impl<const M: usize> Patch for Chords<'_, M> {
    type Walker = Chord<M>;

    fn jump(&mut self, rows: i32) {
        self.rows.jump(rows);
    }

    fn step_row(&mut self) {
        self.rows.jump(1);
    }

    fn enter(&self, x: i32) -> Chord<M> {
        let span = self.rows.span(x);
        let [l, r] = span.ends.map(|end| normalise(end.lerp(self.normals)));
        let t = i64::from(span.last) + i64::from(span.step);
        let ends = self.along.map(|v| [l, r].map(|end| dot(end, v) >> 30));
        let times = |[l, r]: [i64; 2], t: i64| ((r - l).wrapping_mul(t) + (1 << 29)) >> 30;
        span.enter(Chord {
            t: t as i32,
            step: span.step,
            haversine: (((1 << 30) - (dot(l, r) >> 30)) >> 1) as i32,
            length: 1 << 30,
            inverse: Divisor::new(1 << 30),
            square: 1 << 30,
            products: ends.map(|ends| ends[0].wrapping_add(times(ends, t)) as i32),
            steps: ends.map(|ends| times(ends, span.step.into()) as i32),
        })
    }
}

/// Walks from the right end of a row to the left.
#[derive(Clone, Copy)]
struct Chord<const M: usize> {
    /// Share of the way from the left end to the right one, Q2.30, and what a pixel adds to it.
    t: i32,
    step: i32,
    /// A quarter of the squared distance between the ends' normals, Q2.30.
    haversine: i32,
    /// |N| by Newton's iteration, and 1/|N|.
    length: i32,
    inverse: Divisor,
    /// |N|², Q2.30.
    square: i32,
    /// Products of N with the vectors, Q2.30.
    products: [i32; M],
    steps: [i32; M],
}

impl<const M: usize> Walker for Chord<M> {
    /// Products with the normal, 1/|N|, |N|².
    type Value = ([i32; M], Divisor, i32);

    #[inline(always)]
    fn step(&mut self) {
        self.t = self.t.wrapping_sub(self.step);
        for (product, step) in self.products.iter_mut().zip(self.steps) {
            *product = product.wrapping_sub(step);
        }
        // t (1 - t), at most a quarter.
        let between = (i64::from(self.t) * i64::from((1i32 << 30).wrapping_sub(self.t))) >> 30;
        self.square = (1 << 30) - ((between.wrapping_mul(self.haversine.into())) >> 28) as i32;
        self.length = ((i64::from(self.length) + i64::from(self.inverse.divide(self.square))) >> 1) as i32;
        self.inverse = Divisor::new(self.length.max(1) as u32);
    }

    #[inline(always)]
    fn value(&self) -> Self::Value {
        (self.products, self.inverse, self.square)
    }
}

/// N·L and R·V from N·L and N·V of a normal that is not normalised, and L·V.
#[inline(always)]
fn reflect([nl, nv]: [i32; 2], lv: i32, inverse: Divisor, square: Divisor, lut: CosineLookup<'_>) -> Reflection {
    // The product is divided, not a factor: it is at most |N|².
    let both = square.divide(((i64::from(nl) * i64::from(nv)) >> 30) as i32);
    let mirrored = if i64::from(nl) + i64::from(nv) > 0 { (2 * i64::from(both) - i64::from(lv)) >> 3 } else { -1 };
    Reflection { diffuse: inverse.divide(nl) >> 3, highlight: lut.at(mirrored as i32) }
}

/// Any lights; the products are the normal.
#[derive(Clone, Copy)]
struct Many<'f> {
    lighting: &'f Lighting,
    view: [i32; 3],
}

impl LightingModel<([i32; 3], Divisor, i32), ()> for Many<'_> {
    type Common = ([i32; 3], Divisor, Divisor);

    fn common(&self, (normal, inverse, square): ([i32; 3], Divisor, i32)) -> Self::Common {
        (normal, inverse, Divisor::new(square.max(1) as u32))
    }

    fn reflect(&self, light: usize, &(normal, inverse, square): &Self::Common, (): (), lut: CosineLookup<'_>) -> Reflection {
        let Some(&[towards, _]) = self.lighting.sources().get(light).and_then(Source::directional) else {
            return Reflection { diffuse: 0, highlight: 0 };
        };
        let products = [towards, self.view].map(|v| cosine(normal, v));
        reflect(products, cosine(towards, self.view), inverse, square, lut)
    }
}
