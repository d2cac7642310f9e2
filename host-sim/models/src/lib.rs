//! Models and scenes, from their files to triangle streams.

pub mod bytes;
pub mod contents;
pub mod convert;
pub mod convex;
pub mod distance;
mod faults;
mod fields;
mod files;
mod foreign;
pub mod gltf;
pub mod import;
pub mod levels;
pub mod look;
mod mend;
pub mod mesh;
pub mod mtl;
mod names;
pub mod number;
pub mod obj;
pub mod paint;
mod pbr;
pub mod ply;
pub mod polygon;
pub mod quantise;
pub mod records;
pub mod scene;
pub mod script;
pub mod shapes;
pub mod stl;
mod text;
mod texture;
pub mod threemf;
mod transform;
mod turn;
pub mod view;

pub use microphong_render::vector;
