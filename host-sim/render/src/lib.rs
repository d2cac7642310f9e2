//! Pictures of triangle streams, drawn by the core.

pub mod board;
pub mod chip;
pub mod choices;
mod cuts;
pub mod image;
pub mod legend;
pub mod neighbours;
pub mod program;
pub mod render;
pub mod shader;
pub mod vector;

pub use microphong_output as output;
