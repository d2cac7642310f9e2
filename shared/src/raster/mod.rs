//! Bands, active triangles, and the loops that fill rows.

pub mod active;
pub(crate) mod background;
pub mod band;
pub mod canvas;
pub mod counts;
pub mod glass;
mod gradient;
pub mod pixel_shader;
pub(crate) mod span;
pub mod triangle;
