//! The number formats of the interface.
//!
//! Nothing in this crate is a floating-point number while it draws. A fraction is an integer that is divided by a power of two. In the format `Qm.f`
//! an integer has `m` bits before the point, the sign included, and `f` bits behind it. Numbers of the interface are types of the crate [`fixed`]
//! under a name that says what they measure: `Gain::from_num(0.5)` rounds to the nearest.

mod internal;

use fixed::types::{I2F14, I2F30, I18F14, U0F32, U2F14, U5F3, U16F16};
#[doc(hidden)]
pub use internal::*;

/// Component of a position, in units of object space, or component of a unit normal; Q2.14 in [-2, 2).
pub type Unit = I2F14;
/// Distance or coordinate in units of object space, Q18.14; streams use [-32, 32].
pub type Length = I18F14;
/// Reflectance, or colour of a light, in one channel; 1 is full intensity. Unsigned Q2.14 in [0, 4); streams use [0, 2].
pub type Gain = U2F14;
/// Entry of a rotation matrix or component of a unit axis, Q2.30 in [-1, 1].
pub type Rotation = I2F30;
/// Focal length, in units of half the viewport's smaller side, unsigned Q16.16; streams use [1/16, 16].
pub type Focal = U16F16;
/// Size of an object relative to its mesh, unsigned Q16.16; scenes use [1/16, 8].
pub type Scale = U16F16;
/// Angle as a fraction of a turn, unsigned Q0.32 in [0, 1). A sum of angles wraps at a whole turn.
pub type Angle = U0F32;
/// Largest error of a pixel, in 1/255 of full intensity, unsigned Q5.3.
pub type ErrorBudget = U5F3;
/// Light of three channels at a pixel, Q24.8 in 1/255 of full intensity, in [0, 256). Values above 255 count as 255. One channel is in the first
/// place.
pub type Intensity = [i32; 3];

/// Smallest error budget: 1/2 of 1/255.
pub const LEAST_BUDGET: ErrorBudget = ErrorBudget::from_bits(1 << 2);
/// Largest error budget: 16 of 1/255.
pub const LARGEST_BUDGET: ErrorBudget = ErrorBudget::from_bits(16 << 3);
/// Largest number of lights in one scene.
pub const MAX_LIGHTS: usize = 8;
