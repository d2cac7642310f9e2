//! From a mesh to its picture: scenes, the triangle streams that boards draw, and what the core renderer makes of them.

pub mod bytes;
pub mod choices;
pub mod convex;
pub mod distance;
mod foreign;
pub mod gltf;
pub mod image;
pub mod import;
pub mod legend;
pub mod levels;
pub mod look;
pub mod mesh;
pub mod mtl;
pub mod number;
pub mod obj;
pub mod output;
mod pbr;
pub mod ply;
pub mod polygon;
pub mod quantise;
pub mod render;
pub mod scene;
pub mod shader;
pub mod shapes;
pub mod stl;
pub mod vector;
pub mod view;
