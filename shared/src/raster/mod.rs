//! Which pixels a triangle covers, and the loops that fill them.

pub mod area;
#[cfg(feature = "all-shaders")]
pub mod cell;
pub mod edge;
pub mod fill;
pub(crate) mod sides;
pub mod smooth;
pub mod triangle;
