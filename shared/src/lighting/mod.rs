//! The lights of one frame, and what materials make of them.

pub mod lights;
pub mod materials;
