//! Number formats of the public interface.
//!
//! Drawing uses no floating-point numbers. A fraction is an integer that is divided by a power of two. In the format `Qm.f`
//! an integer has `m` bits before the point, the sign included, and `f` bits behind it. Numbers of the interface are types of the crate [`fixed`]
//! under a name that says what they measure: `Gain::from_num(0.5)` rounds to the nearest.

mod internal;

use fixed::types::{I2F14, I2F30, I18F14, U0F32, U2F14, U5F3, U5F11, U16F16};
#[doc(hidden)]
pub use internal::*;

/// A coordinate of a vertex in units of object space, or a component of a unit normal: 16 bits, from -2 to 2 in steps of 1/16,384.
pub type Unit = I2F14;
/// A distance or a coordinate in units of object space or of the world: 32 bits, in steps of 1/16,384. Positions in a scene are within 16
/// units of the origin along each axis.
pub type Length = I18F14;
/// A reflectance of a material, or the intensity of a light, in one colour channel: 16 bits, in steps of 1/16,384. 1 is full intensity, and
/// values up to 2 are allowed.
pub type Gain = U2F14;
/// The distance at which a point light ends, in units of the world: 16 bits, from 0 to less than 32 in steps of 1/2,048.
pub type Reach = U5F11;
/// An entry of a rotation matrix, or a component of a quaternion or unit vector, from -1 to 1: 32 bits, in steps of 2^-30.
pub type Rotation = I2F30;
/// The focal length of a camera, from 1/16 to 16. For a perspective camera, the tangent of half the field of view of the smaller side of the picture
/// is 1 / focal. An orthographic camera shows 1 / focal units in half of this side. Unsigned Q16.16.
pub type Focal = U16F16;
/// The size of an object relative to its mesh, from 1/16 to 8: 32 bits, in steps of 1/65,536.
pub type Scale = U16F16;
/// An angle as a fraction of a turn, from 0 to less than 1: 32 bits, in steps of 2^-32 of a turn. `Angle::from_bits(1 << 30)` is a quarter
/// of a turn. Wrapping addition gives the sum of two angles.
pub type Angle = U0F32;
/// An error budget: the largest difference of a pixel from Phong shading, in units of 1/255 of full intensity. It has 8 bits, in steps of
/// 1/8; budgets from 1/2 to 16 are allowed.
pub type ErrorBudget = U5F3;
/// The light at a pixel: red, green and blue. Full intensity is 255 · 256 = 65,280; larger values count as full. If all colours of a material are
/// shades of one colour, or the pixel format is grey, only the first number counts.
pub type Intensity = [i32; 3];

/// The smallest [`ErrorBudget`]: a pixel may differ from Phong shading by 1/2, in units of 1/255 of full intensity.
pub const LEAST_BUDGET: ErrorBudget = ErrorBudget::from_bits(1 << 2);
/// The largest [`ErrorBudget`]: a pixel may differ from Phong shading by 16, in units of 1/255 of full intensity.
pub const LARGEST_BUDGET: ErrorBudget = ErrorBudget::from_bits(16 << 3);
/// The largest number of lights in a scene: 8.
pub const MAX_LIGHTS: usize = 8;
