//! Methods that interpolate cosines, and compute light from them at the pixel.

#[doc(hidden)]
pub mod duff;
mod lit;
pub(crate) mod near;
#[doc(hidden)]
pub mod phong;
mod quotient;
mod scale;
#[doc(hidden)]
pub mod sqrt6;
mod summed;
mod two_lights;
