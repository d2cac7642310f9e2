//! Points of a triangle where its light is worked out.

use super::Facet;
#[cfg(feature = "all-shaders")]
use crate::math::vector::{normalise, zip};
use crate::{
    format::{EDGE, UNIT},
    math::{
        rsqrt::rsqrt_wide,
        vector::{add, dot, wide},
    },
};

/// Fraction bits of a [`Node`]'s normal that a vertex's has not.
const FINER: u32 = 30 - UNIT;

/// A point of a triangle and the normal there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    /// Object space, Q18.14.
    pub(crate) position: [i32; 3],
    /// Q2.30.
    pub(crate) normal: [i32; 3],
}

impl Facet<'_> {
    /// The corners, their normals as they stand.
    pub(super) fn corner_nodes(&self) -> [Node; 3] {
        self.vertices.map(|vertex| Node { position: wide(vertex.position), normal: wide(vertex.normal).map(|c| c << FINER) })
    }

    /// Corners and edge midpoints (01, 12, 20), unit normals.
    pub(super) fn six_nodes(&self) -> [Node; 6] {
        let sums = self.sums();
        let middle = |k: usize| {
            let (position, sum) = sums[k];
            let rsum = i64::from(self.rsum(k));
            // Q3.14 times Q1.17: one bit more than wanted.
            Node { position, normal: sum.map(|c| ((i64::from(c) * rsum) >> (UNIT + EDGE - 30)) as i32) }
        };
        let [a, b, c] = self.corner_nodes();
        [a, b, c, middle(0), middle(1), middle(2)]
    }

    /// Corners and edge midpoints (01, 12, 20), the normals linear between the corners.
    pub(super) fn six_linear_nodes(&self) -> [Node; 6] {
        let [ab, bc, ca] = self.sums().map(|(position, sum)| Node { position, normal: sum.map(|c| c << (FINER - 1)) });
        let [a, b, c] = self.corner_nodes();
        [a, b, c, ab, bc, ca]
    }

    /// The point with the barycentric coordinates `weights / 2^bits`, which are not negative; unit normal.
    #[cfg(feature = "all-shaders")]
    pub(super) fn node(&self, weights: [i32; 3], bits: u32) -> Node {
        let mean = |v: [[i32; 3]; 3]| {
            let [a, b, c] = zip(v, weights, |v, weight| v.map(|c| c * weight));
            add(a, add(b, c))
        };
        let position = mean(self.vertices.map(|vertex| wide(vertex.position)));
        Node { position: position.map(|c| c >> bits), normal: normalise(mean(self.vertices.map(|vertex| wide(vertex.normal)))) }
    }

    /// The point with the barycentric coordinates `weights / (3 2^bits)`; unit normal.
    #[cfg(feature = "all-shaders")]
    pub(super) fn third(&self, weights: [i32; 3], bits: u32) -> Node {
        let node = self.node(weights, bits);
        Node { position: node.position.map(|c| c / 3), ..node }
    }

    /// Position, and sum of the ends' normals (Q3.14), at the middle of each edge.
    fn sums(&self) -> [([i32; 3], [i32; 3]); 3] {
        let [a, b, c] = self.vertices;
        [(a, b), (b, c), (c, a)].map(|(a, b)| {
            let position = add(wide(a.position), wide(b.position)).map(|c| c >> 1);
            (position, add(wide(a.normal), wide(b.normal)))
        })
    }

    /// 1/|Ni+Nj| of edge `k`, unsigned, [`EDGE`] fraction bits.
    #[inline(always)]
    pub(super) fn rsum(&self, k: usize) -> u32 {
        match self.rsum[k] {
            u16::MAX => self.wide_rsum(k),
            excess => (1 << (EDGE - 1)) + u32::from(excess),
        }
    }

    /// [`Self::rsum`] where a stream's 16 bits do not hold it.
    #[cold]
    #[inline(never)]
    fn wide_rsum(&self, k: usize) -> u32 {
        let (_, sum) = self.sums()[k];
        let (mantissa, exponent) = rsqrt_wide(dot(sum, sum).max(1) as u64);
        ((u64::from(mantissa) << (UNIT + EDGE)) >> exponent) as u32
    }

    /// `[N·L, N·H]`, Q2.30, at the six nodes under one constant light: at midpoints they follow from those at the corners.
    #[inline(always)]
    pub(super) fn six_cosines(&self) -> [[i32; 2]; 6] {
        let [a, b, c] = self.corners.map(|corner| [corner.light[0], corner.light[1]]);
        let middle = |[l, h]: [i32; 2], [m, i]: [i32; 2], k: usize| {
            let rsum = i64::from(self.rsum(k));
            [(l, m), (h, i)].map(|(a, b)| (((i64::from(a) + i64::from(b)) * rsum) >> EDGE) as i32)
        };
        [a, b, c, middle(a, b, 0), middle(b, c, 1), middle(c, a, 2)]
    }
}
