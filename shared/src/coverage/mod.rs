//! The exact area that a triangle covers of a pixel, and the surfaces that are seen through one pixel.

pub mod area;
pub mod sample;
