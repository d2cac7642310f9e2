//! Phong-quality shading of triangle meshes on microcontrollers, by integer forward differences.
//!
//! ```no_run
//! use embedded_graphics_core::{Drawable, draw_target::DrawTarget, geometry::OriginDimensions, pixelcolor::Rgb565, prelude::RgbColor};
//! use microphong::{Layout, Picture, Renderer, Shader, Stream};
//!
//! /// Pictures 240 pixels wide, drawn 40 rows at a time.
//! const LAYOUT: Layout = Layout::new(240, 40);
//!
//! /// Draws all frames of a mesh file, such as `include_stream!("mesh.tri")`, on any display of embedded-graphics.
//! fn animate<D>(display: &mut D, file: &[u8]) -> Result<(), D::Error>
//! where
//!     D: DrawTarget<Color = Rgb565> + OriginDimensions,
//! {
//!     // A microcontroller has both in a `static`; nothing is allocated.
//!     let mut memory = [0; LAYOUT.words::<Rgb565>()];
//!     let mut band = [Rgb565::BLACK; LAYOUT.band()];
//!
//!     let stream = Stream::parse(file).expect("the file is damaged");
//!     // What `convert` asks for unless told otherwise. The program contains the code of the methods in this list and of no others.
//!     let shaders = [Shader::AUTO];
//!     let mut renderer = Renderer::new(stream, display.size(), &LAYOUT, &mut memory, &shaders).expect("the layout fits the display");
//!     for number in 0..u32::from(stream.header.frames) {
//!         Picture::new(&mut renderer, &mut band, number).expect("a band has a row").draw(display)?;
//!     }
//!     Ok(())
//! }
//! ```
//!
//! The command `microphong convert mesh.obj -o mesh.tri`, from the repository of this crate, makes such a file.
//!
//! # Words
//!
//! | word | meaning |
//! |---|---|
//! | stream | a mesh file that the command `microphong convert` writes: meshes, materials, lights, a camera, an animation |
//! | band | a group of rows of the picture that is drawn at once, as many as the program has memory for. A frame is drawn band by band |
//! | level | the intensity of light at a point, from 0 to 255 in each channel |
//! | node | a point of a triangle where light is computed exactly: a corner, or the midpoint of an edge |
//! | method, shader | a way to compute the light of pixels from the light at nodes, such as Gouraud or Phong shading |
//! | walk | to compute a polynomial pixel by pixel with additions only (forward differences) |
//! | active triangle | a triangle that continues from one band into the next |
//! | clipped | cut at the near plane, or far outside of the picture |
//! | error budget | the largest error of a pixel, in 1/255 of full intensity, that [`Shader::AUTO`] may make |
//! | L, H, N, V, R | unit vectors: towards the light, half way between light and viewer, normal, towards the viewer, and L mirrored at N |
//!
//! # Modules
//!
//! The interface is the crate's root, [`stream`], [`pixel`], [`format`](mod@format) and, for shading methods of your own, [`method`]. Everything that
//! this documentation hides may change in any release. The modules follow the data from the file to the display. Each uses only modules above it in
//! this table, and a test checks that.
//!
//! | module | what it does |
//! |---|---|
//! | `features` | the parts of the core that a program can do without |
//! | [`format`](mod@format) | the number formats of the interface |
//! | `arch` | wide products, quotients and counts of zeros, as short as each processor can |
//! | `math` | reciprocal, root, lookup table of highlights, vectors, in integers |
//! | [`pixel`] | pixel formats, ordered dither, curves of displays |
//! | [`stream`] | mesh files in flash, checked and read in place |
//! | `scene` | what is drawn: objects in the world, lights, a camera |
//! | `requirements` | the features that a mesh file needs |
//! | `geometry` | object space to the screen, and what need not be drawn |
//! | `lighting` | lights, and what materials reflect of them |
//! | `setup` | edges and gradients of a triangle |
//! | `interpolate` | polynomials, fitted to a triangle and walked by additions |
//! | `raster` | bands, active triangles, and the loops that fill rows |
//! | [`method`] | the shading methods, and what a method of your own needs |
//! | `mesh` | the triangles of one mesh in one frame |
//! | `edges` | smooth outlines of a finished band |
//! | `placement` | where an object is in one frame |
//! | `shader` | a method together with its loops: [`Shader`] |
//! | `error` | why a renderer cannot draw: [`RenderError`] |
//! | `memory` | the memory that rendering takes: [`Layout`] |
//! | `band_target` | a band for embedded-graphics to draw on: [`BandTarget`] |
//! | `text` | labels, by fonts of embedded-graphics |
//! | `frame` | one frame, band by band: [`Frame`] |
//! | `renderer` | the frames of a scene: [`Renderer`] |
//! | `display` | frames onto embedded-graphics displays: [`Picture`] |
#![no_std]
#![forbid(unsafe_code)]

mod arch;
mod band_target;
mod display;
mod edges;
mod error;
#[doc(hidden)]
pub mod features;
pub mod format;
mod frame;
#[doc(hidden)]
pub mod math;
mod memory;
mod mesh;
pub mod method;
pub mod pixel;
mod placement;
mod requirements;
#[doc(hidden)]
pub mod scene;
mod shader;
pub mod stream;
#[cfg(feature = "text")]
mod text;

// No part of the interface: public for the tests, tools and other packages of this repository alone.
#[doc(hidden)]
pub mod geometry;
#[doc(hidden)]
pub mod interpolate;
#[doc(hidden)]
pub mod lighting;
#[doc(hidden)]
pub mod raster;
#[doc(hidden)]
pub mod renderer;
#[doc(hidden)]
pub mod setup;

pub use band_target::BandTarget;
pub use display::Picture;
pub use error::{MAX_SIDE, RenderError};
pub use fixed;
pub use frame::{Frame, FrameInTwo, FramePart, Preparation, PreparationPart, Skips, Stats};
pub use memory::Layout;
pub use raster::counts::Counts;
#[doc(inline)]
pub use renderer::Renderer;
#[doc(inline)]
pub use scene::{Background, Object, Outlines, Pose, Scene, SceneError};
pub use shader::Shader;
#[doc(inline)]
pub use stream::{
    Stream, StreamError,
    record::{Light, Material},
};
