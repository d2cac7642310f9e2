//! Cubic fields.
//!
//! Third differences add up with the third power of the distance, so coefficients have [`FINER`] more fraction bits than
//! the walked format, in 64 bits.

use super::{
    fit::fit,
    terms::{Terms, moved},
};
use microphong::method::{Field, Gradients, Patch, Point, SHARE, Surface, Walker};

/// Fraction bits that a coefficient has more than a walked value. Nine integer bits of the walked format become eleven, so that values that exceed it
/// by a factor of two are clamped instead of wrapped.
pub const FINER: u32 = 30;

/// A cubic in each of `CH` channels, standing on one row.
#[derive(Clone, Copy, Debug)]
pub struct CubicPatch<const CH: usize>([Terms<i64>; CH]);

impl<const CH: usize> CubicPatch<CH> {
    /// The cubic through ten nodes in each channel: the corners 0, 1, 2; two thirds of each of the edges 01, 12, 20, first the one nearer to the
    /// edge's start; and the centroid.
    ///
    /// Nodes lie in a range narrower than 2^15; values are walked with `extra` more fraction bits.
    /// Error: at most 1 + 2^-31 (1 + S + S² + S³) units of the walked format, S the distance in columns plus rows from the
    /// anchor, and for set-up 2^-22 k of the nodes' range, k the length over the height; nothing for set-up where k is
    /// beyond [`microphong::method::MAX_THINNESS`].
    /// Source: Vlasic 2002, 4.2; change of basis without his divisions.
    #[must_use]
    pub fn fit(gradients: &Gradients, nodes: &[[i32; 10]; CH], extra: u32, bias: [i32; CH]) -> Self {
        // The move from the anchor column to column 0 is exact, modulo 2^64.
        let back = i64::from(gradients.column());
        let step = |a: i64, b: i64| a.wrapping_sub(b.wrapping_mul(back));
        let mut terms = nodes.map(|nodes| fit(gradients, nodes, extra + FINER).moved_across(step));
        for (Terms([c, ..], ..), bias) in terms.iter_mut().zip(bias) {
            *c = c.wrapping_add(i64::from(bias) << FINER);
        }
        Self(terms)
    }
}

impl<const CH: usize> Patch for CubicPatch<CH> {
    type Walker = CubicWalker<CH>;

    fn jump(&mut self, rows: i32) {
        let rows = i64::from(rows);
        self.0 = self.0.map(|terms| terms.moved_down(|a, b| a.wrapping_add(b.wrapping_mul(rows))));
    }

    #[inline(always)]
    fn step_row(&mut self) {
        for terms in &mut self.0 {
            *terms = terms.moved_down(i64::wrapping_add);
        }
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> CubicWalker<CH> {
        let x = i64::from(x);
        let step = |a: i64, b: i64| a.wrapping_add(b.wrapping_mul(x));
        CubicWalker(self.0.map(|Terms([c, ..], [dx, ..], [dxx, _], [dxxx])| {
            let [c, dx, dxx, dxxx] = moved([c, dx, dxx, dxxx], &step);
            // Differences towards x - 1.
            let d3 = dxxx.wrapping_mul(-6);
            [c, dxx.wrapping_sub(dx).wrapping_sub(dxxx), dxx.wrapping_mul(2).wrapping_add(d3), d3]
        }))
    }
}

/// Walks a [`CubicPatch`] by three additions of 64 bits a pixel and channel. It holds the value and the first to third differences.
#[derive(Clone, Copy, Debug)]
pub struct CubicWalker<const CH: usize>([[i64; 4]; CH]);

impl<const CH: usize> Walker for CubicWalker<CH> {
    type Value = [u32; CH];

    #[inline(always)]
    fn step(&mut self) {
        for [value, d1, d2, d3] in &mut self.0 {
            *value = value.wrapping_add(*d1);
            *d1 = d1.wrapping_add(*d2);
            *d2 = d2.wrapping_add(*d3);
        }
    }

    /// The value is clamped, because a cubic overshoots the range of its ten nodes by more than the guards of a walked level.
    #[inline(always)]
    fn value(&self) -> [u32; CH] {
        self.0.map(|[value, ..]| (value >> FINER).clamp(0, u32::MAX.into()) as u32)
    }
}

/// A cubic through ten nodes in each of `CH` channels, see [`CubicPatch::fit`].
#[derive(Clone, Copy, Debug)]
pub struct TenNodes<const CH: usize> {
    /// The values at the nodes of each channel.
    pub values: [[i32; 10]; CH],
    /// Fraction bits that a walked value has more than a node.
    pub extra: u32,
    /// What is added to the values of each channel.
    pub bias: [i32; CH],
}

impl<const CH: usize> Field for TenNodes<CH> {
    type Patch = CubicPatch<CH>;

    fn fit(&self, gradients: &Gradients) -> CubicPatch<CH> {
        CubicPatch::fit(gradients, &self.values, self.extra, self.bias)
    }
}

impl<const CH: usize> Surface for TenNodes<CH> {
    type Value = [u32; CH];

    /// The value is clamped, as that of a walked cubic.
    #[inline(always)]
    fn at(&self, point: &Point) -> [u32; CH] {
        let weights = weights(point);
        let mut values = self.bias.map(i64::from);
        for (value, nodes) in values.iter_mut().zip(&self.values) {
            let sum = nodes.iter().zip(weights).map(|(&node, weight)| i64::from(node) * i64::from(weight)).sum::<i64>();
            *value += sum >> SHARE.saturating_sub(self.extra);
        }
        values.map(|value| value.clamp(0, u32::MAX.into()) as u32)
    }
}

/// Lagrange's weights of the ten nodes at a point, Q2.30.
#[inline(always)]
fn weights(point: &Point) -> [i32; 10] {
    const ONE: i64 = 1 << SHARE;
    let [a, b, c] = point.0.map(i64::from);
    let times = |u: i64, v: i64| (u * v) >> SHARE;
    let corner = |u: i64| (times(times(u, 3 * u - ONE), 3 * u - 2 * ONE) >> 1) as i32;
    let edge = |near: i64, far: i64| ((9 * times(times(near, far), 3 * near - ONE)) >> 1) as i32;
    let centre = (27 * times(times(a, b), c)) as i32;
    [corner(a), corner(b), corner(c), edge(a, b), edge(b, a), edge(b, c), edge(c, b), edge(c, a), edge(a, c), centre]
}
