//! Products of vectors as fields: linear or quadratic polynomials through their values at nodes.

use crate::{
    format::COSINE,
    interpolate::field::{Field, Nodes},
    setup::gradients::Gradients,
};

/// Fraction bits of a field at a node. A walked field has [`COSINE`] fraction bits.
pub const FIELD_NODE: u32 = 24;
/// Fraction bits that a walked field has more than a node.
pub const FIELD_EXTRA: u32 = COSINE - FIELD_NODE;
/// Bits of the range of nodes, which lie in [-2, 2].
pub const FIELD_BITS: u32 = FIELD_NODE + 2;

/// [`Field::fit`] in a function of its own, so that all methods share its code.
#[inline(never)]
pub(crate) fn fitted<F: Field>(field: &F, gradients: &Gradients) -> F::Patch {
    field.fit(gradients)
}

/// A linear field: it goes through the values at the three corners.
pub type LinearNodes<const CH: usize> = Nodes<3, CH, FIELD_BITS>;
/// A quadratic field: it goes through the values at three corners and three midpoints of edges.
pub type QuadraticNodes<const CH: usize> = Nodes<6, CH, FIELD_BITS>;

/// The quadratic through values at six nodes, Q2.30.
#[inline]
pub fn quadratic<const CH: usize>(nodes: [[i32; 6]; CH]) -> QuadraticNodes<CH> {
    Nodes::new(rounded(nodes), FIELD_EXTRA)
}

/// The plane through values at three nodes, Q2.30.
#[inline]
pub fn linear<const CH: usize>(nodes: [[i32; 3]; CH]) -> LinearNodes<CH> {
    Nodes::new(rounded(nodes), FIELD_EXTRA)
}

/// From Q2.30 to [`FIELD_NODE`] fraction bits.
fn rounded<const N: usize, const CH: usize>(nodes: [[i32; N]; CH]) -> [[i32; N]; CH] {
    nodes.map(|nodes| nodes.map(|node| (node + (1 << (FIELD_EXTRA - 1))) >> FIELD_EXTRA))
}

/// Converts a walked field to a signed number, Q2.30.
#[inline]
pub fn signed(field: u32) -> i32 {
    field as i32
}
