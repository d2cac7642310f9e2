//! The lights of one frame, and what materials reflect of them.

pub mod constant_lights;
pub mod lights;
pub mod material_tables;
pub mod output;
pub mod reflectance;
