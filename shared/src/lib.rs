//! Phong-quality shading of triangle meshes on microcontrollers, by integer forward differences.
#![no_std]
#![forbid(unsafe_code)]

pub mod format;
pub mod pixel;
pub mod render;
pub mod scene;
pub mod shade;
pub mod stream;

pub use render::{Frame, Memory, Renderer, SetupError, Stats, Workspace};
pub use shade::Shader;
pub use stream::{Stream, StreamError};
