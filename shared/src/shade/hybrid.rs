//! Disselkoen's hybrid (1991): highlights in three parabolas a row as [`super::angular`], but normals linear along the
//! edges, and diffuse light by polynomials: here the quadratic through N·L at six points.
//!
//! Cost: 5 additions and a comparison a pixel and light; a row has 3 unit vectors, 2 arc tangents and 2 divisions to
//! set up. Error: that of the parabolas, 3.6 LSB of the highlight (as printed: 66), and jumps where rows begin on
//! different edges. Domain: any lights; coarse meshes under near lights are off by up to 45 LSB.

use super::{
    Facet, Shading,
    angular::{Turned, turned},
    form::{Form, quadratic, signed},
    parabola::{Bow, Lobe, Parabolas},
    scanline::{Edges, Rows},
};
use crate::{
    band::Band,
    math::{arc::Arc, power::PixelPower, vector::normalise},
    palette::Reflection,
    pixel::Pixel,
    poly::{Constant, Patch, field::Field, quadric::Quadric},
    scene::{Source, cosine},
};

/// Shades by the parabolas that `fit` makes for an exponent.
#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, fit: fn(u16) -> Parabolas, band: &mut Band<'_, C>) -> u32 {
    let (edges, parabolas) = (Edges::new(facet), fit(shading.exponent));
    let rows = edges.rows(facet);
    let bows = |Turned { normals, direction }| {
        let lobe = Lobe { direction, parabolas: &parabolas, power: Some(&shading.palette.power) };
        Bows { rows, normals, lobe }
    };
    let constant = |direction| bows(Turned { normals: facet.corner_nodes().map(|node| node.normal), direction });
    if let Some([_, half]) = shading.constant
        && let Some(gloss) = shading.gloss(Both)
    {
        let diffuse = quadratic([facet.six_cosines(0)]).fit(facet.basis);
        return facet.outline.draw(facet.basis, ((diffuse, constant(half)), Constant), gloss, band);
    }
    let (nodes, is_constant) = (facet.six_nodes(), shading.lighting.is_constant());
    let fit = |source: &Source| {
        let diffuse = quadratic([nodes.map(|node| cosine(node.normal, source.towards(node.position)))]).fit(facet.basis);
        let highlight = if is_constant {
            let [_, half] = shading.lighting.directions(source, [0; 3]);
            constant(half)
        } else {
            let [_, half] = turned(facet, shading.lighting, source);
            bows(half)
        };
        (diffuse, highlight)
    };
    shading.draw_rows(facet, ((Quadric::default(), constant([0; 3])), fit), Constant, Both, band)
}

/// Highlights along the rows.
#[derive(Clone, Copy)]
struct Bows<'f> {
    rows: Rows<'f>,
    normals: [[i32; 3]; 3],
    lobe: Lobe<'f>,
}

impl Patch for Bows<'_> {
    type Walker = Bow;

    fn jump(&mut self, rows: i32) {
        self.rows.jump(rows);
    }

    fn step_row(&mut self) {
        self.rows.jump(1);
    }

    fn enter(&self, x: i32) -> Bow {
        let span = self.rows.span(x);
        let [l, r] = span.ends.map(|end| normalise(end.lerp(self.normals)));
        span.enter(self.lobe.along(&Arc::new(l, r), r, &span))
    }
}

/// N·L and the highlight as they come, Q2.30.
#[derive(Clone, Copy)]
struct Both;

impl Form<(), ([u32; 1], i32)> for Both {
    type Common = ();

    #[inline(always)]
    fn common(&self, (): ()) {}

    #[inline(always)]
    fn reflect(&self, _: usize, (): &(), ([diffuse], highlight): ([u32; 1], i32), _: PixelPower<'_>) -> Reflection {
        Reflection { diffuse: signed(diffuse) >> 3, highlight: (highlight >> 14) as u32 }
    }
}
