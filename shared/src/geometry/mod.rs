//! Geometry: from object space to the screen, and culling.

pub(crate) mod bin;
pub(crate) mod clip;
pub mod cull;
pub(crate) mod depth_elision;
pub mod detail;
pub mod lens;
pub mod model_view;
pub(crate) mod pixel_rect;
pub mod projection;
pub(crate) mod region;
pub mod viewport;
