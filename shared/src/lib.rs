//! Phong-quality shading of triangle meshes on microcontrollers, by integer forward differences.
//!
//! Per-pixel normalisation and powers are replaced by polynomials that are walked with integer additions.
//! The way of the data, each module using only those above it (tests/tests/layers.rs reads the imports):
//!
//! | module | what it does |
//! |---|---|
//! | [`format`](mod@format) | names every number format |
//! | [`arch`] | wide products, quotients and counts of zeros, as short as each processor can |
//! | [`math`] | reciprocal, root, power, vectors, in integers |
//! | [`pixel`] | pixel formats and ordered dither |
//! | [`stream`] | bytes in flash to a checked view of meshes, lights and camera |
//! | [`geometry`] | object space to the screen, and what need not be drawn |
//! | [`lighting`] | lights, and what materials make of them |
//! | [`setup`] | edges and gradients of a triangle |
//! | [`interpolate`] | polynomials, fitted to a triangle and walked by additions |
//! | [`coverage`] | exact areas of pixels, and what is seen through one |
//! | [`raster`] | bands, active triangles, and the loops that fill rows |
//! | [`antialias`] | pixels on the edges of triangles |
//! | [`method`] | the shading methods |
//! | [`mesh`] | the triangles of one mesh in one frame |
//! | [`shader`] | a method, ready to be drawn in a pixel format |
//! | [`error`] | what keeps a renderer from drawing |
//! | [`memory`] | the memory that rendering takes |
//! | [`frame`] | one frame, band by band |
//! | [`renderer`] | the frames of one stream |
//! | [`display`] | frames onto embedded-graphics displays |
#![no_std]
#![forbid(unsafe_code)]

pub mod antialias;
pub mod arch;
pub mod coverage;
pub mod display;
pub mod error;
pub mod format;
pub mod frame;
pub mod geometry;
pub mod interpolate;
pub mod lighting;
pub mod math;
pub mod memory;
pub mod mesh;
pub mod method;
pub mod pixel;
pub mod raster;
pub mod renderer;
pub mod setup;
pub mod shader;
pub mod stream;

pub use display::Picture;
pub use error::RenderError;
pub use fixed;
pub use frame::{Frame, Stats};
pub use memory::Layout;
pub use renderer::Renderer;
pub use shader::Shader;
pub use stream::{Stream, StreamError};
