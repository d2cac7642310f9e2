//! The lights of one frame, and what materials reflect of them.

pub mod lights;
pub mod materials;
pub mod one_light;
