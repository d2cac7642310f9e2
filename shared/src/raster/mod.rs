//! Which pixels a triangle covers, and the loops that fill them.

pub mod active;
pub mod band;
pub mod canvas;
pub mod pixel_shader;
pub mod span;
pub mod triangle;
