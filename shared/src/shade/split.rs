//! What the methods share that split a triangle into cells and shade each by itself.

use super::{Area, Facet, Shading};
use crate::{
    band::Band,
    math::vector::{add, zip},
    pixel::Pixel,
    poly::{basis::Basis, field::Field, plane::Plane},
    raster::cell::{Cell, Piece},
    tone::Tone,
};

/// Light of three channels, Q9.7.
pub(super) type Levels = [i32; 3];

/// Nodes are in [0, 255], those on a parabola a little outside.
const BITS: u32 = 16;

/// A triangle that is drawn cell by cell.
pub(super) struct Cells<'a, 'f, C> {
    facet: &'a Facet<'f>,
    shading: &'a Shading<'f, C>,
    basis: Basis,
    depth: Plane<1>,
}

/// A cell on the screen, ready for fitting.
struct Part<'p> {
    piece: &'p Piece<'p>,
    basis: Basis,
    depth: Plane<1>,
}

impl Area for Part<'_> {
    #[inline(always)]
    fn draw<F: Field, T: Tone<F::Value>>(&self, field: impl FnOnce() -> F, tone: T, band: &mut Band<'_, T::Pixel>) -> u32 {
        self.piece.draw(&self.basis, self.depth, field().fit(&self.basis), tone, band)
    }

    #[inline(always)]
    fn draw_either<F: Field, T: Tone<F::Value>, U: Tone<F::Value, Pixel = T::Pixel>>(
        &self,
        field: impl FnOnce() -> F,
        first: bool,
        tones: (T, U),
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let patch = field().fit(&self.basis);
        if first {
            self.piece.draw(&self.basis, self.depth, patch, tones.0, band)
        } else {
            self.piece.draw(&self.basis, self.depth, patch, tones.1, band)
        }
    }
}

/// Light at the corners of a cell and at the middles of its edges 01, 12, 20.
#[derive(Clone, Copy)]
pub(super) struct Six {
    pub(super) corners: [Levels; 3],
    pub(super) middles: [Levels; 3],
}

/// What the edges of part `k` of [`Cell::split`] have of what is known at the halves of a cell's edges 01, 12, 20, and at
/// the edges that cut off its corners 0, 1, 2.
#[inline]
pub(super) fn edges<A: Copy>(halves: [[A; 2]; 3], cuts: [A; 3], k: usize) -> [A; 3] {
    let [[ab, ba], [bc, cb], [ca, ac]] = halves;
    let [a, b, c] = cuts;
    match k {
        0 => [ab, a, ac],
        1 => [ba, bc, b],
        2 => [c, cb, ca],
        _ => [c, a, b],
    }
}

/// What the corners of part `k` of [`Cell::split`] have of what is known at a cell's corners and edge middles.
#[inline]
pub(super) fn corners<A: Copy>([a, b, c]: [A; 3], [ab, bc, ca]: [A; 3], k: usize) -> [A; 3] {
    match k {
        0 => [a, ab, ca],
        1 => [ab, b, bc],
        2 => [ca, bc, c],
        _ => [bc, ca, ab],
    }
}

impl<'a, 'f, C: Pixel> Cells<'a, 'f, C> {
    pub(super) fn new(facet: &'a Facet<'f>, shading: &'a Shading<'f, C>) -> Self {
        Self { facet, shading, basis: facet.basis.parted(), depth: facet.outline.depth(facet.basis) }
    }

    /// Whether anything of `cell` may be seen in `band`.
    pub(super) fn meets(&self, cell: &Cell, band: &Band<'_, C>) -> bool {
        self.facet.outline.piece(cell).meets(band)
    }

    /// Light at the triangle's corners.
    pub(super) fn corners(&self) -> [Levels; 3] {
        self.facet.corners.map(|corner| corner.light)
    }

    /// Light at the triangle's corners and edge midpoints.
    pub(super) fn six(&self) -> Six {
        Six { corners: self.corners(), middles: self.middles(&Cell::WHOLE) }
    }

    /// Light at a point with the barycentric coordinates `weights / 2^bits`.
    fn light(&self, weights: [i32; 3], bits: u32) -> Levels {
        self.shading.levels(&self.facet.node(weights, bits))
    }

    /// Light at the middles of the edges 01, 12, 20.
    pub(super) fn middles(&self, cell: &Cell) -> [Levels; 3] {
        let [a, b, c] = cell.corners();
        [[a, b], [b, c], [c, a]].map(|[a, b]| self.light(add(a, b), cell.level() + 1))
    }

    /// Light on edge `k` at a quarter and three quarters of the way.
    pub(super) fn quarters(&self, cell: &Cell, k: usize) -> [Levels; 2] {
        let [a, b, c] = cell.corners();
        let [a, b] = match k {
            0 => [a, b],
            1 => [b, c],
            _ => [c, a],
        };
        [[a, b], [b, a]].map(|[near, far]| self.light(zip(near, far, |n, f| 3 * n + f), cell.level() + 2))
    }

    /// Light in the middle of the edges that cut off the corners 0, 1, 2 when `cell` is split.
    pub(super) fn cuts(&self, cell: &Cell) -> [Levels; 3] {
        let [a, b, c] = cell.corners();
        [[a, b, c], [b, c, a], [c, a, b]].map(|[a, b, c]| self.light(add(add(a, a), add(b, c)), cell.level() + 2))
    }

    /// Whether the quadratic through `six` misses the light in the centre of `cell` by more than `tolerance` in any channel.
    pub(super) fn misses_centre(&self, cell: &Cell, six: &Six, tolerance: i32) -> bool {
        let [a, b, c] = cell.corners();
        let exact = self.shading.levels(&self.facet.third(add(a, add(b, c)), cell.level()));
        let sum = |[a, b, c]: [Levels; 3]| add(a, add(b, c));
        // Lagrange's weights are -1/9 and 4/9.
        let fitted = zip(sum(six.middles), sum(six.corners), |m, c| 4 * m - c);
        differ(fitted, exact.map(|level| 9 * level), 9 * tolerance)
    }

    /// `piece`, unless nothing of it may be seen in `band`.
    fn part<'p>(&self, piece: &'p Piece<'p>, band: &Band<'_, C>) -> Option<Part<'p>> {
        piece.meets(band).then(|| Part { piece, basis: piece.basis(&self.basis), depth: self.depth })
    }

    /// Draws `cell` linear between its corners.
    #[inline(never)]
    pub(super) fn linear(&self, cell: &Cell, corners: &[Levels; 3], band: &mut Band<'_, C>) -> u32 {
        let piece = self.facet.outline.piece(cell);
        let Some(part) = self.part(&piece, band) else { return 0 };
        self.shading.draw_levels::<3, BITS>(&part, || *corners, band)
    }

    /// Draws `cell` quadratic between its nodes.
    #[inline(never)]
    pub(super) fn quadratic(&self, cell: &Cell, six: &Six, band: &mut Band<'_, C>) -> u32 {
        let piece = self.facet.outline.piece(cell);
        let Some(part) = self.part(&piece, band) else { return 0 };
        let ([a, b, c], [ab, bc, ca]) = (six.corners, six.middles);
        self.shading.draw_levels::<6, BITS>(&part, || [a, b, c, ab, bc, ca], band)
    }

    /// Draws `cell` linear between the corners of the parts that `depth` splits make of it; `corners` is its own light.
    ///
    /// Each split lights three points, so a part costs the light of one. Parts outside the band cost nothing.
    #[inline(never)]
    pub(super) fn linear_parts(&self, cell: &Cell, corners: &[Levels; 3], depth: u32, band: &mut Band<'_, C>) -> u32 {
        if depth == 0 {
            return self.linear(cell, corners, band);
        }
        if !self.meets(cell, band) {
            return 0;
        }
        let middles = self.middles(cell);
        let mut pixels = 0;
        for (k, part) in cell.split().iter().enumerate() {
            pixels += self.linear_parts(part, &self::corners(*corners, middles, k), depth - 1, band);
        }
        pixels
    }
}

/// Whether two lights differ by more than `tolerance` in any channel.
pub(super) fn differ(a: Levels, b: Levels, tolerance: i32) -> bool {
    zip(a, b, |a, b| a.abs_diff(b) > tolerance.unsigned_abs()).contains(&true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        raster::triangle::Outline,
        stream::record::{Triangle, Vertex},
        vertex::{ScreenVertex, State},
    };
    use zerocopy::FromZeros;

    /// Points of an edge by the weights of its ends are the same, bit for bit, in both triangles that share it,
    /// whichever corners its ends are there and whatever lies opposite: so both light and split it alike.
    #[test]
    fn neighbours_agree_on_their_edge() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 48) as i16 / 2
        };
        let screen = [[0, 0], [160, 90], [20, 200]].map(|[x, y]| ScreenVertex { x, y, depth: 0, light: [0; 3], state: State::Ready });
        let [a, b, c] = &screen;
        let band =
            Band::<u8> { pixels: &mut [], depth: &mut [], width: 0, top: 0, rows: 0, blend: None, relay: crate::relay::Relay::default() };
        let outline = Outline::new([a, b, c], crate::raster::smooth::Part::Centres, &band);
        let basis = Basis::small(outline.corners).unwrap();
        let triangle = Triangle { corners: [0, 2, 1], ..Triangle::new_zeroed() };
        for _ in 0..1_000 {
            let mut vertex = || Vertex { position: [random(), random(), random()], normal: [random(), random(), random()] };
            let [p, q, r, s] = [vertex(), vertex(), vertex(), vertex()];
            let facet = |vertices| Facet {
                outline: &outline,
                basis: &basis,
                corners: [a, b, c],
                triangle: &triangle,
                vertices,
                contested: true,
                perspective: false,
                place: None,
            };
            let corners = [[p, q, r], [q, p, s], [s, q, p], [p, s, q]];
            let [one, others @ ..] = corners.each_ref().map(|corners| facet(corners.as_slice()));
            for (k, other) in others.iter().enumerate() {
                for bits in 0..=5 {
                    for w in 0..=1 << bits {
                        let v = (1 << bits) - w;
                        let node = one.node([v, w, 0], bits);
                        // Split once more or less, it is the same point.
                        let same = other.node([[w, v, 0], [0, w, v], [v, 0, w]][k].map(|w| 2 * w), bits + 1);
                        assert_eq!((node.position, node.normal), (same.position, same.normal));
                    }
                }
            }
        }
    }
}
