//! Code for methods that split a triangle into sub-triangles and shade each by itself.

use crate::{
    nodes::{node, third},
    sub_triangle::{Parts, SubTriangle},
};
use microphong::{
    math::vector::{add, zip},
    method::{Canvas, Shading, TriangleSetup},
};

/// Light of three channels, Q9.7.
pub type Levels = [i32; 3];

/// Bits of the range of nodes: they are in [0, 255], and those on a parabola a little outside.
const BITS: u32 = 16;

/// A triangle that is drawn sub-triangle by sub-triangle.
pub struct SubTriangles<'a, 'f> {
    setup: &'a TriangleSetup<'f>,
    shading: &'a Shading<'f>,
    parts: Parts<'a>,
}

/// Light at the corners of a sub-triangle and at the middles of its edges 01, 12, 20.
#[derive(Clone, Copy)]
pub struct Six {
    /// Levels at the corners.
    pub corners: [Levels; 3],
    /// Levels at the middles of the edges.
    pub middles: [Levels; 3],
}

/// Selects the values at the edges of part `k` of [`SubTriangle::split`] from those at the halves of the edges 01, 12, 20 of the whole, and
/// at the edges that cut off its corners 0, 1, 2.
#[inline]
pub fn edges<A: Copy>(halves: [[A; 2]; 3], cuts: [A; 3], k: usize) -> [A; 3] {
    let [[ab, ba], [bc, cb], [ca, ac]] = halves;
    let [a, b, c] = cuts;
    match k {
        0 => [ab, a, ac],
        1 => [ba, bc, b],
        2 => [c, cb, ca],
        _ => [c, a, b],
    }
}

/// Selects the values at the corners of part `k` of [`SubTriangle::split`] from those at the corners and edge middles of the whole.
#[inline]
pub fn corners<A: Copy>([a, b, c]: [A; 3], [ab, bc, ca]: [A; 3], k: usize) -> [A; 3] {
    match k {
        0 => [a, ab, ca],
        1 => [ab, b, bc],
        2 => [ca, bc, c],
        _ => [bc, ca, ab],
    }
}

impl<'a, 'f> SubTriangles<'a, 'f> {
    /// The parts of a triangle.
    pub fn new(setup: &'a TriangleSetup<'f>, shading: &'a Shading<'f>) -> Self {
        Self { setup, shading, parts: Parts::new(setup) }
    }

    /// Whether anything of `sub_triangle` may be seen in `canvas`.
    pub fn meets(&self, sub_triangle: &SubTriangle, canvas: &dyn Canvas) -> bool {
        self.parts.meets(sub_triangle, canvas)
    }

    /// Light at the triangle's corners.
    pub fn corners(&self) -> [Levels; 3] {
        self.setup.levels()
    }

    /// Light at the triangle's corners and edge midpoints.
    pub fn six(&self) -> Six {
        Six { corners: self.corners(), middles: self.middles(&SubTriangle::WHOLE) }
    }

    /// Light at a point with the barycentric coordinates `weights / 2^bits`.
    fn light(&self, weights: [i32; 3], bits: u32) -> Levels {
        self.shading.levels(&node(self.setup, weights, bits))
    }

    /// Light at the middles of the edges 01, 12, 20.
    pub fn middles(&self, sub_triangle: &SubTriangle) -> [Levels; 3] {
        let [a, b, c] = sub_triangle.corners();
        [[a, b], [b, c], [c, a]].map(|[a, b]| self.light(add(a, b), sub_triangle.level() + 1))
    }

    /// Light on edge `k` at a quarter and three quarters of the way.
    pub fn quarters(&self, sub_triangle: &SubTriangle, k: usize) -> [Levels; 2] {
        let [a, b, c] = sub_triangle.corners();
        let [a, b] = match k {
            0 => [a, b],
            1 => [b, c],
            _ => [c, a],
        };
        [[a, b], [b, a]].map(|[near, far]| self.light(zip(near, far, |n, f| 3 * n + f), sub_triangle.level() + 2))
    }

    /// Light in the middle of the edges that cut off the corners 0, 1, 2 when `sub_triangle` is split.
    pub fn cuts(&self, sub_triangle: &SubTriangle) -> [Levels; 3] {
        let [a, b, c] = sub_triangle.corners();
        [[a, b, c], [b, c, a], [c, a, b]].map(|[a, b, c]| self.light(add(add(a, a), add(b, c)), sub_triangle.level() + 2))
    }

    /// Whether the quadratic through `six` misses the light in the centre of `sub_triangle` by more than `tolerance` in any channel.
    pub fn misses_centre(&self, sub_triangle: &SubTriangle, six: &Six, tolerance: i32) -> bool {
        let [a, b, c] = sub_triangle.corners();
        let exact = self.shading.levels(&third(self.setup, add(a, add(b, c)), sub_triangle.level()));
        let sum = |[a, b, c]: [Levels; 3]| add(a, add(b, c));
        // Lagrange's weights are -1/9 and 4/9.
        let fitted = zip(sum(six.middles), sum(six.corners), |m, c| 4 * m - c);
        differ(fitted, exact.map(|level| 9 * level), 9 * tolerance)
    }

    /// Draws `sub_triangle` linear between its corners.
    #[inline(never)]
    pub fn linear(&self, sub_triangle: &SubTriangle, corners: &[Levels; 3], canvas: &mut dyn Canvas) -> u32 {
        self.shading.draw_levels::<3, BITS>(&self.parts.part(sub_triangle), *corners, canvas)
    }

    /// Draws `sub_triangle` quadratic between its nodes.
    #[inline(never)]
    pub fn quadratic(&self, sub_triangle: &SubTriangle, six: &Six, canvas: &mut dyn Canvas) -> u32 {
        let ([a, b, c], [ab, bc, ca]) = (six.corners, six.middles);
        self.shading.draw_levels::<6, BITS>(&self.parts.part(sub_triangle), [a, b, c, ab, bc, ca], canvas)
    }

    /// Draws `sub_triangle` linear between the corners of the parts that `depth` splits make of it; `corners` is its own light.
    ///
    /// Each split lights three points, so a part costs the light of one. Parts outside the band cost nothing.
    #[inline(never)]
    pub fn linear_parts(&self, sub_triangle: &SubTriangle, corners: &[Levels; 3], depth: u32, canvas: &mut dyn Canvas) -> u32 {
        if depth == 0 {
            return self.linear(sub_triangle, corners, canvas);
        }
        if !self.meets(sub_triangle, canvas) {
            return 0;
        }
        let middles = self.middles(sub_triangle);
        let mut pixels = 0;
        for (k, part) in sub_triangle.split().iter().enumerate() {
            pixels += self.linear_parts(part, &self::corners(*corners, middles, k), depth - 1, canvas);
        }
        pixels
    }
}

/// Whether two lights differ by more than `tolerance` in any channel.
pub fn differ(a: Levels, b: Levels, tolerance: i32) -> bool {
    zip(a, b, |a, b| a.abs_diff(b) > tolerance.unsigned_abs()).contains(&true)
}
