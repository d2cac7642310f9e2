//! Methods that interpolate levels of light: what is computed at nodes is walked, and a pixel only looks up its colour.

#[doc(hidden)]
pub mod flat;
#[doc(hidden)]
pub mod gouraud;
#[doc(hidden)]
pub mod six_point;
