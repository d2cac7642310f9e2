//! Disselkoen's hybrid (1991): highlights in three parabolas a row as [`crate::angular`], but normals linear along the
//! edges, and diffuse light by polynomials: here the quadratic through N·L at six points.
//!
//! Cost: 5 additions and a comparison a pixel and light; a row has 3 unit vectors, 2 arc tangents and 2 divisions to set up. Error: the parabolas',
//! 3.6 of 255 in the highlight (as printed: 66), and jumps as those of [`crate::angular`]. Domain: any lights; coarse meshes under near lights are off
//! by up to 45 of 255.

use crate::{
    angular::{Turned, turned},
    arc::Arc,
    parabola::{Lobe, Parabolas, PiecewiseQuadratic},
    scanline::{self, Edges, Rows},
};
use microphong::{
    math::vector::normalise,
    method::{
        Canvas, Constant, CosineLookup, Facts, Field, Highlight, HighlightField, LightingModel, Method, Patch, Reflection, Shading, Source,
        TriangleSetup, VertexLight, cosine, quadratic, signed,
    },
};

static FACTS: Facts = Facts {
    name: "hybrid",
    id: 18,
    source: "Disselkoen 1991, constants refitted",
    vertex_light: VertexLight::Cosines,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: false,
};

static ORIGINAL: Facts = Facts {
    name: "hybrid-original",
    id: 19,
    source: "Disselkoen 1991",
    vertex_light: VertexLight::Cosines,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: false,
};

/// Highlights in three parabolas a span.
pub struct Hybrid;

impl Method for Hybrid {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, Parabolas::refitted, canvas)
    }
}

/// Highlights in three parabolas a span, with the constants as printed.
pub struct HybridOriginal;

impl Method for HybridOriginal {
    fn facts(&self) -> &'static Facts {
        &ORIGINAL
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, Parabolas::printed, canvas)
    }
}

/// Shades by the parabolas that `fit` makes for an exponent.
fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, fit: fn(u16) -> Parabolas, canvas: &mut dyn Canvas) -> u32 {
    let (edges, parabolas) = (Edges::new(setup), fit(shading.exponent));
    let rows = edges.rows(setup);
    let bows = |Turned { normals, direction }| {
        let lobe = Lobe { direction, parabolas: &parabolas, lut: shading.reflectance.table() };
        Bows { rows, normals, lobe }
    };
    let constant = |direction| bows(Turned { normals: setup.corner_nodes().map(|node| node.normal), direction });
    let (nodes, is_constant) = (setup.six_nodes(shading.exponent), shading.lighting.is_constant());
    let fit = |source: &Source| {
        let diffuse = quadratic([nodes.map(|node| cosine(node.normal, source.towards(node.position)))]).fit(setup.gradients);
        let highlight = if is_constant {
            let [_, half] = shading.lighting.directions(source, [0; 3]);
            constant(half)
        } else {
            let [_, half] = turned(setup, shading.lighting, source);
            bows(half)
        };
        (diffuse, highlight)
    };
    scanline::draw(setup, shading, fit, Constant, Both, canvas)
}

/// Highlights along the rows.
#[derive(Clone, Copy)]
struct Bows<'f> {
    rows: Rows<'f>,
    normals: [[i32; 3]; 3],
    lobe: Lobe<'f>,
}

impl Patch for Bows<'_> {
    type Walker = PiecewiseQuadratic;

    fn jump(&mut self, rows: i32) {
        self.rows.jump(rows);
    }

    fn step_row(&mut self) {
        self.rows.jump(1);
    }

    fn enter(&self, x: i32) -> PiecewiseQuadratic {
        let span = self.rows.span(x);
        let [l, r] = span.ends.map(|end| normalise(end.lerp(self.normals)));
        span.enter(self.lobe.along(&Arc::new(l, r), r, &span))
    }
}

/// N·L and the highlight as they come, Q2.30.
#[derive(Clone, Copy)]
struct Both;

impl LightingModel<(), ([u32; 1], i32)> for Both {
    type Common = ();

    #[inline(always)]
    fn common(&self, (): ()) {}

    #[inline(always)]
    fn reflect(&self, _: usize, (): &(), ([diffuse], highlight): ([u32; 1], i32), _: CosineLookup<'_>) -> Reflection {
        Reflection { diffuse: signed(diffuse) >> 3, highlight: (highlight >> 14) as u32 }
    }
}
