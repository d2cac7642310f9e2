//! N·L and N·H by their Taylor quadratics about the centroid (Bishop & Weimer 1986, infinite eye).
//!
//! The expansion does not depend on the axes. So it is computed at six points of the triangle, without the sixteen coefficients of the printed
//! formulas, and the quadratic through these points is walked. Let N = s (c + n) and W = r (d + w), with c and d of length one, and W = L or H, which
//! is constant here (w = 0). The cosine, cut after second order, is
//!
//! (c·d + c·w + n·d + n·w) + (c·d + c·w + n·d)(-a - b) + c·d (3/2 (a² + b²) - (n² + w²)/2 + a b), a = c·n, b = d·w.
//!
//! Far from the centroid the expansion leaves [-1, 1] and more. Values are walked with fewer fraction bits, as the triangle and the light need, and
//! count as 1 beyond. The centroid's |N| counts as at least 1/16.
//!
//! Cost: 4 additions a pixel and light, 4 comparisons and shifts, the highlight's table; 12 expansions to set up. Not
//! continuous. Error against Phong: 12 LSB on a sphere of 168 triangles, 1.5 on one of 690 (exponent 50, ks 1/2);
//! useless on coarser ones. Domain: constant lights.

use crate::fields::{Held, Steep};
use microphong::{
    format::{COSINE, NORMAL_LENGTH, UNIT},
    math::{
        rsqrt::rsqrt_wide,
        vector::{add, dot, sub, wide},
    },
    method::{
        Canvas, Constant, CosineLookup, Facts, Highlight, HighlightField, LightingModel, Method, QuadraticNodes, Reflection, Shading,
        Source, Steepness, TriangleSetup, VertexLight,
        products::{FIELD_EXTRA, FIELD_NODE},
        signed, tiles,
    },
};

/// Fraction bits of the vectors that [`Series::new`] takes.
pub const VECTOR: u32 = 26;

static FACTS: Facts = Facts {
    name: "taylor",
    id: 11,
    source: "Bishop & Weimer 1986",
    vertex_light: VertexLight::None,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Plane,
    near_lights: false,
    perspective: true,
};

/// Taylor quadratics for constant lights.
pub struct Taylor;

impl Method for Taylor {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    draw_by(setup, shading, canvas, constant)
}

/// L and H of a light that is infinitely far, as all are: near lights are refused before.
fn constant(source: &Source) -> [Series; 2] {
    source.directional().copied().unwrap_or_default().map(Series::constant)
}

/// The expansions of N·L and N·H of a light at the six nodes, and by how many bits they have to be shifted to be walked.
fn expanded(normal: &Series, directions: [Series; 2]) -> ([[i64; 6]; 2], u32) {
    let values = directions.map(|direction| expansions(normal, &direction));
    let largest = values.as_flattened().iter().fold(0, |m, v| v.unsigned_abs().max(m));
    // Nodes stay below 6/5, so that quadratics stay below 2.
    (values, (64 - (largest - largest / 6).leading_zeros()).saturating_sub(VECTOR))
}

/// The series of the normals.
fn normals(setup: &TriangleSetup<'_>) -> Series {
    Series::new(setup.vertices().map(|vertex| wide(vertex.normal).map(|c| c << (VECTOR - UNIT))))
}

/// How steeply highlights depend on the cosines, which are walked with fewer bits the more they are shifted. Expansions are below four times the
/// square of 1 plus the distance of normals from the centroid's, which the smallest length of a normal tells. Directions of near lights may be
/// equally far away.
fn steepness(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Steepness {
    let shift = match setup.triangle.min_normal_length >> (NORMAL_LENGTH - 4) {
        13.. => 2,
        8.. => 5,
        _ => 11,
    };
    let shift = if shading.lighting.is_constant() { shift } else { shift.max(6) };
    Steepness::new(u32::from(shading.exponent) << shift)
}

/// Shades with the directions that `directions` makes of a light, along L and H.
pub fn draw_by(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    canvas: &mut dyn Canvas,
    directions: impl Fn(&Source) -> [Series; 2],
) -> u32 {
    let (normal, unshifted) = (normals(setup), setup.gradients.steepness());
    let fit = |source: &Source| {
        let (values, shift) = expanded(&normal, directions(source));
        let bits = shift + VECTOR - FIELD_NODE;
        let nodes = values.map(|nodes| nodes.map(|node| (node >> bits) as i32));
        let steepness = if shift == 0 { unshifted } else { Steepness::new(u32::from(shading.exponent) << shift) };
        (Steep { field: QuadraticNodes::new(nodes, FIELD_EXTRA), steepness }, Held(shift))
    };
    tiles::shade_steeply(steepness(setup, shading), setup, canvas, |setup, canvas| shading.draw_lit(setup, fit, Constant, Clamped, canvas))
}

/// A vector that is linear over the triangle, divided by its length at the centroid.
#[derive(Clone, Copy)]
pub struct Series {
    /// The vector at the centroid, [`VECTOR`] fraction bits.
    centre: [i32; 3],
    /// The differences to it at corners and midpoints (01, 12, 20), [`VECTOR`] fraction bits: below 22.
    away: [[i32; 3]; 6],
}

impl Series {
    /// The series of the vectors at the corners, no longer than 1, in fractions of [`VECTOR`] bits.
    pub fn new(corners: [[i32; 3]; 3]) -> Self {
        /// Square of three times the least length at the centroid, 1/16.
        const LEAST: u64 = (3 << (VECTOR - 4)) * (3 << (VECTOR - 4));
        let [a, b, c] = corners;
        let sum = add(a, add(b, c));
        let (mantissa, exponent) = rsqrt_wide((dot(sum, sum) as u64).max(LEAST));
        let scaled = |v: [i32; 3]| v.map(|c| ((i64::from(c) * i64::from(mantissa)) >> (exponent - VECTOR)) as i32);
        let [a, b, c] = corners.map(|v| scaled(sub(v.map(|c| 3 * c), sum)));
        let middle = |a, b| add(a, b).map(|c| c >> 1);
        Self { centre: scaled(sum), away: [a, b, c, middle(a, b), middle(b, c), middle(c, a)] }
    }

    /// The series of a constant unit vector, Q2.30.
    fn constant(v: [i32; 3]) -> Self {
        Self { centre: v.map(|c| c >> (COSINE - VECTOR)), away: [[0; 3]; 6] }
    }
}

/// The expansion of the cosine between two vectors at the six nodes, [`VECTOR`] fraction bits.
fn expansions(normal: &Series, direction: &Series) -> [i64; 6] {
    // No vector exceeds 22, no sum of two products 45, no sum of squares 2^11: products of two stay below 2^11 of 2^52.
    let product = |a: [i32; 3], b: [i32; 3]| dot(a, b) >> VECTOR;
    let times = |a: i64, b: i64| (a * b) >> VECTOR;
    let (c, d) = (normal.centre, direction.centre);
    let zeroth = product(c, d);
    let at = |n: [i32; 3], w: [i32; 3]| {
        let (a, b) = (product(c, n), product(d, w));
        let first = product(c, w) + product(n, d);
        let squares = 3 * (times(a, a) + times(b, b)) - product(n, n) - product(w, w);
        zeroth + first + product(n, w) - times(zeroth + first, a + b) + times(zeroth, squares / 2 + times(a, b))
    };
    let ([n0, n1, n2, n3, n4, n5], [w0, w1, w2, w3, w4, w5]) = (normal.away, direction.away);
    [at(n0, w0), at(n1, w1), at(n2, w2), at(n3, w3), at(n4, w4), at(n5, w5)]
}

/// Shades by cosines of any size, which have been shifted.
#[derive(Clone, Copy)]
struct Clamped;

impl LightingModel<(), ([u32; 2], u32)> for Clamped {
    type Common = ();

    #[inline(always)]
    fn common(&self, (): ()) {}

    #[inline(always)]
    fn reflect(&self, _: usize, (): &(), (fields, shift): ([u32; 2], u32), lut: CosineLookup<'_>) -> Reflection {
        let limit = (1 << COSINE) >> shift;
        let clamped = |cosine: u32| (signed(cosine).clamp(-limit, limit) << shift) >> 3;
        let [diffuse, half] = fields;
        let (diffuse, half) = (clamped(diffuse), clamped(half));
        Reflection { diffuse, highlight: lut.at(half) }
    }
}
