//! Exact areas that triangles cover of pixels, and the surfaces that are seen through one pixel.

pub mod area;
pub mod sample;
