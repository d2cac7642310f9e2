//! The set-up of a triangle: its edges, which are stepped from row to row, and the gradients by which polynomials are fitted.

pub(crate) mod edge;
pub(crate) mod edge_walker;
pub mod gradients;
mod sliver;
pub mod steepness;
pub(crate) mod word_sized;
