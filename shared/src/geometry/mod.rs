//! The way from object space to the screen, and which triangles need not be drawn.

pub mod bin;
pub mod clip;
pub mod cull;
pub mod depth_elision;
pub mod pose;
pub mod projection;
pub mod viewport;
