//! What is worked out once for a triangle: its edges, to be walked from row to row, and the gradients by which polynomials are fitted.

pub mod edge;
pub(crate) mod edge_walker;
pub mod gradients;
mod sliver;
pub mod terms;
pub(crate) mod word_sized;
