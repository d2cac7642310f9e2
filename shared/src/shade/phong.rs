//! Per-pixel Phong shading with the half vector (Phong 1975; Blinn 1977): the honest yardstick.
//!
//! Normals, lights and viewer are linear over the screen, so every dot product
//! between them is linear or exactly quadratic and can be walked; only the roots
//! that normalise are taken at each pixel (Duff's form, see Bishop & Weimer 1986).
//! Cost: one constant light 4 additions, 1 root from a table, 2 products and the highlight's power from a
//! table; otherwise 6 additions and 2 roots, and 6 additions and 2 roots more for each light.
//! Error: that of the tables, [`crate::math::power::NEAREST_ERROR`] of the highlight above all.

use super::{Facet, Shading};
use crate::{
    band::Band,
    dither::threshold,
    format::{EDGE, MAX_LIGHTS},
    math::{
        rsqrt::{half_rsqrt, rsqrt},
        vector::{add, dot, sub, wide},
    },
    palette::{Glossy, Palette},
    pixel::Pixel,
    poly::{
        Patch, Walker,
        plane::{Linear, Plane},
        quadric::{Quadratic, Quadric},
    },
    scene::{Source, Viewer},
    tone::Tone,
};

/// Fraction bits of a dot product at a node; walked with 30.
const NODE: u32 = 24;
/// Nodes are in [-1, 1].
const BITS: u32 = NODE + 1;
/// Fraction bits that walked dot products have more.
const EXTRA: u32 = 30 - NODE;

pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let lit = Lit { palette: shading.palette, dither: shading.dither, row: 0 };
    // The table of roots begins at |N|² = 1/4.
    if shading.constant.is_none() || facet.triangle.rho < 1 << (EDGE - 1) {
        facet.outline.draw(&facet.basis, General::fit(facet, shading), lit, band)
    } else if shading.dither || shading.palette.three_channels {
        facet.outline.draw(&facet.basis, Constant::fit(facet), lit, band)
    } else {
        facet.outline.draw(&facet.basis, Constant::fit(facet), Gloss(shading.palette.glossy()), band)
    }
}

/// 1/sqrt(x) for `x` in Q2.30, (0, 2]: mantissa in Q2.30 and the power of two to multiply it by.
#[inline(always)]
fn root(x: u32) -> (i64, u32) {
    let shift = x.max(1).leading_zeros() & !1;
    // x = m 2^-shift, m in [1, 4): the root's exponent is half of it.
    (rsqrt(x << (shift & 31)).into(), shift / 2)
}

/// `value / sqrt(x)`, Q2.30 each; at most 2 by saturation.
#[inline(always)]
fn over(value: i32, (mantissa, shift): (i64, u32)) -> i32 {
    let product = (i64::from(value) * mantissa) >> (30 - shift);
    product.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

/// One constant light: N·L and N·H are linear, |N|² quadratic. Two planes of one channel: the compiler
/// makes a loop of one plane of two, and keeps it in memory.
#[derive(Clone, Copy)]
struct Constant {
    light: Plane<1>,
    half: Plane<1>,
    square: Quadric<1>,
}

impl Constant {
    fn fit(facet: &Facet<'_>) -> Self {
        let [a, b, c] = facet.corners.map(|corner| corner.light);
        // |N|² - 1 is zero at the corners.
        let middle = facet.square.map(|square| (i32::from(square) - (1 << EDGE)) << (NODE - EDGE));
        let nodes = [0, 0, 0, middle[0], middle[1], middle[2]];
        Self {
            light: Plane::fit(&facet.basis, [[a[0], b[0], c[0]]], 0),
            half: Plane::fit(&facet.basis, [[a[1], b[1], c[1]]], 0),
            square: Quadric::fit::<BITS>(&facet.basis, [nodes], EXTRA).raised([1 << 30]),
        }
    }
}

impl Patch for Constant {
    type Walker = ConstantWalker;

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        self.light.jump(rows);
        self.half.jump(rows);
        self.square.jump(rows);
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.light.step_row();
        self.half.step_row();
        self.square.step_row();
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> ConstantWalker {
        ConstantWalker { light: self.light.enter(x), half: self.half.enter(x), square: self.square.enter(x) }
    }
}

/// Walks [`Constant`].
struct ConstantWalker {
    light: Linear<1>,
    half: Linear<1>,
    square: Quadratic<1>,
}

impl Walker for ConstantWalker {
    type Value = Cosines;

    #[inline(always)]
    fn step(&mut self) {
        self.light.step();
        self.half.step();
        self.square.step();
    }

    #[inline(always)]
    fn value(&self) -> Cosines {
        let ([light], [half], [square]) = (self.light.value(), self.half.value(), self.square.value());
        let half_root = half_rsqrt(square) as i32;
        // Upper half of Q2.30 times Q2.30, and half of a root: Q5.27.
        let over = |cosine: u32| ((i64::from(cosine as i32) * i64::from(half_root)) >> 32) as i32;
        Cosines([over(light), over(half)])
    }
}

/// N·L and N·H of one light, Q5.27.
struct Cosines([i32; 2]);

impl IntoIterator for Cosines {
    type Item = [i32; 2];
    type IntoIter = core::iter::Once<[i32; 2]>;

    /// Of one light, Q2.30.
    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        core::iter::once(self.0.map(|cosine| cosine.clamp(-(1 << 27), 1 << 27) << 3))
    }
}

/// Lights a pixel in a material of one channel.
#[derive(Clone, Copy)]
struct Gloss<'a, C>(Glossy<'a, C>);

impl<C: Pixel> Tone<Cosines> for Gloss<'_, C> {
    type Pixel = C;

    #[inline(always)]
    fn tone(&self, Cosines(cosines): Cosines, _: usize) -> C {
        self.0.colour(cosines)
    }
}

/// Any lights: every dot product of N, V and each L is quadratic over the screen.
#[derive(Clone, Copy)]
struct General {
    /// N·N, V·V, N·V.
    view: Quadric<3>,
    /// N·L, L·L, V·L of each light.
    lights: [Quadric<3>; MAX_LIGHTS],
    count: usize,
}

/// A vector at the three corners, all shifted alike so that none is longer than 1 (Q2.14).
fn fitted(vectors: [[i32; 3]; 3]) -> [[i32; 3]; 3] {
    let largest = vectors.as_flattened().iter().fold(1, |m, c| m | c.unsigned_abs());
    // The largest component below 2^27: lengths below 2^28, dot products of two fit 56 bits.
    let zeros = largest.leading_zeros();
    vectors.map(|v| v.map(|c| if zeros >= 5 { c << (zeros - 5) } else { c >> (5 - zeros) }))
}

/// Six nodes of the product of two linear vector fields (fractions of 28 bits each), [`NODE`] bits.
fn product(a: &[[i32; 3]; 3], b: &[[i32; 3]; 3]) -> [i32; 6] {
    let ([a0, a1, a2], [b0, b1, b2]) = (*a, *b);
    let corner = |a, b| (dot(a, b) >> (56 - NODE)) as i32;
    let middle = |a, c, b, d| (dot(add(a, c), add(b, d)) >> (58 - NODE)) as i32;
    [corner(a0, b0), corner(a1, b1), corner(a2, b2), middle(a0, a1, b0, b1), middle(a1, a2, b1, b2), middle(a2, a0, b2, b0)]
}

impl General {
    fn fit<C>(facet: &Facet<'_>, shading: &Shading<'_, C>) -> Self {
        let positions = facet.vertices.map(|vertex| wide(vertex.position));
        let normals = fitted(facet.vertices.map(|vertex| wide(vertex.normal)));
        let view = fitted(match shading.lighting.viewer {
            Viewer::Infinite(towards) => [towards; 3],
            Viewer::Local(eye) => positions.map(|p| sub(eye, p)),
        });
        let walked = |nodes: [[i32; 6]; 3]| Quadric::fit::<BITS>(&facet.basis, nodes, EXTRA);
        let common = walked([product(&normals, &normals), product(&view, &view), product(&normals, &view)]);
        let mut patch = Self { view: common, lights: [common; MAX_LIGHTS], count: shading.lighting.sources.len() };
        for (light, source) in patch.lights.iter_mut().zip(&shading.lighting.sources) {
            let towards = fitted(match *source {
                Source::Directional { towards, .. } => [towards; 3],
                Source::Point(position) => positions.map(|p| sub(position, p)),
            });
            *light = walked([product(&normals, &towards), product(&towards, &towards), product(&view, &towards)]);
        }
        patch
    }
}

impl Patch for General {
    type Walker = GeneralWalker;

    fn jump(&mut self, rows: i32) {
        self.view.jump(rows);
        self.lights.iter_mut().take(self.count).for_each(|light| light.jump(rows));
    }

    fn step_row(&mut self) {
        self.view.step_row();
        self.lights.iter_mut().take(self.count).for_each(Patch::step_row);
    }

    fn enter(&self, x: i32) -> GeneralWalker {
        let view = self.view.enter(x);
        let mut lights = [view; MAX_LIGHTS];
        for (walker, light) in lights.iter_mut().zip(&self.lights).take(self.count) {
            *walker = light.enter(x);
        }
        GeneralWalker { view, lights, count: self.count }
    }
}

/// Walks [`General`].
struct GeneralWalker {
    view: Quadratic<3>,
    lights: [Quadratic<3>; MAX_LIGHTS],
    count: usize,
}

impl Walker for GeneralWalker {
    type Value = heapless::Vec<[i32; 2], MAX_LIGHTS>;

    fn step(&mut self) {
        self.view.step();
        self.lights.iter_mut().take(self.count).for_each(Walker::step);
    }

    fn value(&self) -> Self::Value {
        let [nn, vv, nv] = self.view.value();
        let (normal, view) = (root(nn), root(vv));
        let nv = over(nv as i32, view);
        let mut cosines = heapless::Vec::new();
        for light in self.lights.iter().take(self.count) {
            let [nl, ll, vl] = light.value();
            let light = root(ll);
            let nl = over(nl as i32, light);
            let vl = over(over(vl as i32, light), view);
            // N·(L + V) / |L + V| with |L + V|² = 2 + 2 L·V: half of either, so that both stay in range.
            let half = root((1i32 << 30).saturating_add(vl).max(1) as u32);
            let sum = (((i64::from(nl) + i64::from(nv)) >> 1) * SQRT_2) >> 30;
            let nh = over(sum.clamp(i32::MIN.into(), i32::MAX.into()) as i32, half);
            let _ = cosines.push([over(nl, normal), over(nh, normal)]);
        }
        cosines
    }
}

/// Square root of two, Q2.30.
const SQRT_2: i64 = 1_518_500_250;

/// Lights a pixel from its cosines.
#[derive(Clone, Copy)]
struct Lit<'a, C> {
    palette: &'a Palette<C>,
    dither: bool,
    row: usize,
}

impl<C: Pixel, V: IntoIterator<Item = [i32; 2]>> Tone<V> for Lit<'_, C> {
    type Pixel = C;

    #[inline(always)]
    fn tone(&self, cosines: V, x: usize) -> C {
        let levels = self.palette.pixel_levels(cosines.into_iter());
        if self.dither { self.palette.dithered(levels, threshold(x, self.row)) } else { self.palette.colour(levels) }
    }

    fn start(&mut self, row: i32) {
        self.row = row as usize;
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.row += 1;
    }
}
