//! Angular interpolation (Kuijk and Blake 1989; Disselkoen 1991): normals on great circles along edges and rows, diffuse
//! light and highlights in three parabolas a row, see [`crate::parabola`].
//!
//! Near lights and viewers (Kuijk and Blake): the triangle has one direction, the one at its middle, and normals are turned so that each corner sees
//! this direction as it would see its own.
//!
//! Cost: 3 additions and a comparison a pixel, twice a light. A row has 3 unit vectors, 2 pairs of sine and cosine, 3 arc tangents and 2 divisions to
//! set up, with near lights twice as many. Error: the parabolas', 3.6 of 255 in the highlight and 6 in diffuse light (as printed: 66 and 13), and
//! jumps: light jumps where rows begin on different edges. It also jumps, by the error of the parabolas, where the angle between the normals at both ends
//! of a row falls below 2^-9. Domain: any lights; coarse meshes under near lights are off by up to 45 of 255. Of light from
//! the sky, surfaces that face away from it get half, where they should get less: the parabolas end where a cosine is negative.

use crate::{
    arc::Arc,
    parabola::{Lobe, Parabolas, PiecewiseQuadratic},
    scanline::{self, Edges, Rows},
    slerp::arcs,
};
use microphong::{
    math::vector::{add, dot, normalise, wide, zip},
    method::{
        Canvas, Constant, CosineLookup, Facts, Highlight, HighlightField, Lighting, LightingModel, Method, Patch, Reflection, Shading,
        Source, TriangleSetup, VertexLight, Walker,
    },
};

static FACTS: Facts = Facts {
    name: "angular",
    id: 16,
    source: "Kuijk & Blake 1989, constants refitted",
    vertex_light: VertexLight::None,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: false,
};

static ORIGINAL: Facts = Facts {
    name: "angular-original",
    id: 17,
    source: "Kuijk & Blake 1989",
    vertex_light: VertexLight::None,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: false,
};

/// Highlights in three parabolas a span.
pub struct Angular;

impl Method for Angular {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, Parabolas::refitted, canvas)
    }
}

/// Highlights in three parabolas a span, with the constants as printed.
pub struct AngularOriginal;

impl Method for AngularOriginal {
    fn facts(&self) -> &'static Facts {
        &ORIGINAL
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, Parabolas::printed, canvas)
    }
}

/// Shades by the parabolas that `fit` makes for an exponent.
fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, fit: fn(u16) -> Parabolas, canvas: &mut dyn Canvas) -> u32 {
    let (edges, [one, many]) = (Edges::new(setup), [1, shading.exponent].map(fit));
    let rows = edges.rows(setup);
    let diffuse = |direction| Lobe { direction, parabolas: &one, lut: None };
    let highlight = |direction| Lobe { direction, parabolas: &many, lut: shading.reflectance.table() };
    if shading.lighting.is_constant() {
        let arcs = arcs(setup.vertices().map(|vertex| wide(vertex.normal)));
        let fit = |[towards, half]: [[i32; 3]; 2]| LobesOnRows { rows, arcs, lobes: [diffuse(towards), highlight(half)] };
        let of = |source: &Source| fit(shading.lighting.directions(source, [0; 3]));
        scanline::draw(setup, shading, of, Constant, Both, canvas)
    } else {
        let fit = |source: &Source| {
            let [l, h] = turned(setup, shading.lighting, source);
            let on_rows = |turned: Turned, lobe| LobesOnRows { rows, arcs: arcs(turned.normals), lobes: [lobe] };
            (on_rows(l, diffuse(l.direction)), on_rows(h, highlight(h.direction)))
        };
        scanline::draw(setup, shading, fit, Constant, Both, canvas)
    }
}

/// One direction for a triangle, and normals turned so that each corner sees this direction as it would see its own.
#[derive(Clone, Copy)]
pub struct Turned {
    /// Q2.30.
    pub normals: [[i32; 3]; 3],
    /// Unit vector, Q2.30.
    pub direction: [i32; 3],
}

/// [`Turned`] for L and for H of a light.
pub fn turned(setup: &TriangleSetup<'_>, lighting: &Lighting, source: &Source) -> [Turned; 2] {
    let nodes = setup.corner_nodes();
    let [a, b, c] = nodes.map(|node| node.position);
    let middle = lighting.directions(source, add(a, add(b, c)).map(|c| c / 3));
    let corners = nodes.map(|node| (node.normal, lighting.directions(source, node.position)));
    let [l, h] = middle;
    [
        Turned { normals: corners.map(|(normal, [from, _])| turn(normal, from, l)), direction: l },
        Turned { normals: corners.map(|(normal, [_, from])| turn(normal, from, h)), direction: h },
    ]
}

/// Largest error of a component of a normal that [`turned`] turns, times the length of the sum of the two directions.
pub const TURN_ERROR: f64 = 24.0 / (1u32 << 30) as f64;

/// `normal` turned as the unit vector `from` turns to `to`: by half a turn about `from`, then by half a turn about the middle between both.
///
/// Domain: vectors of Q2.30, `normal` at most of unit length; `from` and `to` are not opposite, as every axis would turn one to the other.
/// Error: at most [`TURN_ERROR`] over |from + to| (tests::turns). Source: two half turns make one turn, by twice the angle between their
/// axes (Rodrigues 1840).
fn turn(normal: [i32; 3], from: [i32; 3], to: [i32; 3]) -> [i32; 3] {
    let middle = normalise(zip(from, to, |f, t| (f >> 1) + (t >> 1)));
    half_turn(half_turn(normal, from), middle)
}

/// `v` after half a turn about the unit vector `axis`: 2 axis (axis·v) - v.
fn half_turn(v: [i32; 3], axis: [i32; 3]) -> [i32; 3] {
    let twice = dot(axis, v) >> 29;
    zip(v, axis, |v, a| ((i64::from(a) * twice - (i64::from(v) << 30)) >> 30) as i32)
}

/// Powers of cosines along rows, between one normal and `M` directions.
#[derive(Clone, Copy)]
struct LobesOnRows<'f, const M: usize> {
    rows: Rows<'f>,
    arcs: [Arc; 3],
    lobes: [Lobe<'f>; M],
}

impl<const M: usize> Patch for LobesOnRows<'_, M> {
    type Walker = PiecewiseQuadratics<M>;

    fn jump(&mut self, rows: i32) {
        self.rows.jump(rows);
    }

    fn step_row(&mut self) {
        self.rows.jump(1);
    }

    fn enter(&self, x: i32) -> PiecewiseQuadratics<M> {
        let span = self.rows.span(x);
        let [l, r] = span.ends.map(|end| end.of(self.arcs).at(end.along));
        let arc = Arc::new(l, r);
        span.enter(PiecewiseQuadratics(self.lobes.map(|lobe| lobe.along(&arc, r, &span))))
    }
}

/// Walks the lobes of `M` directions.
#[derive(Clone, Copy)]
struct PiecewiseQuadratics<const M: usize>([PiecewiseQuadratic; M]);

impl<const M: usize> Walker for PiecewiseQuadratics<M> {
    type Value = [i32; M];

    #[inline(always)]
    fn step(&mut self) {
        self.0.iter_mut().for_each(Walker::step);
    }

    #[inline(always)]
    fn value(&self) -> [i32; M] {
        self.0.map(|quadratic| quadratic.value())
    }
}

/// Diffuse light and highlight as they come, Q2.30.
#[derive(Clone, Copy)]
struct Both;

impl LightingModel<(), [i32; 2]> for Both {
    type Common = ();

    #[inline(always)]
    fn common(&self, (): ()) {}

    #[inline(always)]
    fn reflect(&self, _: usize, (): &(), [diffuse, highlight]: [i32; 2], _: CosineLookup<'_>) -> Reflection {
        Reflection { diffuse: diffuse >> 3, highlight: (highlight >> 14) as u32 }
    }
}

impl LightingModel<(), ([i32; 1], [i32; 1])> for Both {
    type Common = ();

    fn common(&self, (): ()) {}

    fn reflect(&self, light: usize, common: &(), ([diffuse], [highlight]): ([i32; 1], [i32; 1]), lut: CosineLookup<'_>) -> Reflection {
        self.reflect(light, common, [diffuse, highlight], lut)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns() {
        let real = |v: [i32; 3]| v.map(|c| f64::from(c) / f64::from(1 << 30));
        let product = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let mut worst = 0f64;
        for seed in 1..100_000i32 {
            let c = |k: i32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77) >> 2;
            let [normal, from, other] = [
                [c(1_664_525), c(22_695_477), c(1_103_515_245)],
                [c(69_069), c(134_775_813), c(214_013)],
                [c(48_271), c(16_807), c(40_692)],
            ]
            .map(normalise);
            // From any angle between the two to almost half a turn.
            let to = normalise(zip(other, from, |o, f| (o >> (seed % 20)) - (f >> (if seed % 20 == 0 { 31 } else { 1 }))));
            let ([n, f, t], turned) = ([normal, from, to].map(real), real(turn(normal, from, to)));
            let middle = [0, 1, 2].map(|k| f[k] + t[k]);
            let square = product(middle, middle);
            // f·n and the middle's product with the first half turn.
            let half = [0, 1, 2].map(|k| 2.0 * product(f, n) * f[k] / product(f, f) - n[k]);
            let exact = [0, 1, 2].map(|k| 2.0 * product(middle, half) * middle[k] / square - half[k]);
            worst = (0..3).map(|k| (turned[k] - exact[k]).abs() * square.sqrt()).fold(worst, f64::max);
        }
        assert!(worst <= TURN_ERROR, "{:.2} units", worst * f64::from(1 << 30));
    }
}
