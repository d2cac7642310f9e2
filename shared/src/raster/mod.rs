//! Which pixels a triangle covers, and the loops that fill them.

#[cfg(feature = "all-shaders")]
pub mod cell;
pub mod edge;
pub mod fill;
pub mod triangle;
