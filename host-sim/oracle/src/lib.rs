//! Every shading method in 64-bit floating point, written a second time.
//!
//! The core shades in integers. This package says what the result should be. The two share no shading code: from the core come only the parsed
//! records of a stream, the pose of a frame, and the positions of corners on the screen. All else is the methods' definition, one file each, as plain
//! as formulas allow.

mod condition;
mod frame;
mod light;
mod method;
pub mod papers;
mod placed;
mod poly;
mod scanline;
mod scene;
mod texture;
mod visible;

pub use frame::{Facet, Frame, MOST_MIXTURES};
pub use light::phong;
pub(crate) use method::angular;
pub use method::{MOST_OUTCOMES, NAMES, Unsupported, chosen, decides, method, outcomes};
pub(crate) use poly::{SIX, TEN, cubic, quadratic, sum};
pub use scene::{Light, Material, Place};
pub use texture::Texture;
pub use visible::Sight;

/// Red, green and blue; 255 is full. Clamped to [0, 255].
pub type Levels = [f64; 3];

/// The shading of one triangle, at any point of the screen; pixel centres lie at .5. A little outside the triangle it
/// goes on smoothly.
pub type Shade<'f> = Box<dyn Fn([f64; 2]) -> Levels + 'f>;
