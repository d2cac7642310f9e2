//! The lights of one frame, and their reflection by materials.

pub mod albedo;
pub mod constant_lights;
pub(crate) mod facing;
pub mod highlight_tables;
pub mod lights;
pub mod material_tables;
pub mod reflectance;
pub mod sampler;
pub mod shape;
pub(crate) mod summed;
