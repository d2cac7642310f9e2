//! The simulator as a library: what the `microphong` command is made of.

pub mod bench;
pub mod board;
pub mod bytes;
pub mod compare;
pub mod convex;
pub mod image;
pub mod level;
pub mod look;
pub mod mesh;
pub mod number;
pub mod obj;
pub mod oracle;
pub mod output;
mod page;
pub mod papers;
pub mod quantise;
pub mod render;
pub mod scene;
pub mod shapes;
pub mod vector;
pub mod verify;
pub mod view;
