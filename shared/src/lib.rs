//! Phong-quality shading of triangle meshes on microcontrollers, by integer forward differences.
//!
//! Per-pixel normalisation and powers are replaced by polynomials that are walked with integer additions.
//! The way of the data, each module using only those above it:
//!
//! | module | what it does |
//! |---|---|
//! | [`format`](mod@format) | names every number format |
//! | [`math`] | reciprocal, root, power, vectors, in integers |
//! | [`shader`] | the names of the methods |
//! | [`stream`] | bytes in flash to a checked view of meshes, lights and camera |
//! | [`scene`] | one frame's camera and lights, in object space |
//! | [`vertex`], [`cull`], [`clip`], [`bin`] | object space to the screen, and what need not be drawn |
//! | [`poly`] | fits polynomials to a triangle and walks them |
//! | [`pixel`], [`dither`], [`palette`], [`tone`] | levels of light to pixels |
//! | [`sample`] | what is seen through one pixel when it is antialiased |
//! | [`band`], [`relay`], [`raster`] | exact coverage, the inner loop, and what a band hands on to the next |
//! | [`shade`] | the methods: which polynomials, which tone |
//! | [`render`] | the loop nest: frame, band, triangle, row |
//! | [`display`] | frames onto embedded-graphics displays |
#![no_std]
#![forbid(unsafe_code)]

pub mod band;
pub mod bin;
pub mod clip;
pub mod convex;
pub mod cull;
pub mod display;
pub mod dither;
mod draw;
pub mod format;
pub mod math;
pub mod palette;
pub mod pixel;
pub mod poly;
pub mod raster;
pub mod relay;
pub mod render;
pub mod sample;
pub mod scene;
pub mod shade;
pub mod shader;
pub mod stream;
pub mod tone;
pub mod vertex;

pub use display::Picture;
pub use fixed;
pub use render::{Frame, Memory, Renderer, SetupError, Stats, Workspace};
pub use shader::Shader;
pub use stream::{Stream, StreamError};
