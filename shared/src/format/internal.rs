//! The number formats within the core and in streams.
//!
//! In the loops a value is a plain integer. Its number of fraction bits is one of the constants below.

use fixed::types::{I4F12, I28F4, U0F16, U1F15, U2F14, U4F12, U14F2};

/// Screen coordinate, pixels, Q28.4: pixel centres lie at 8/16. Corners are rounded to the nearest sixteenth.
pub type Subpixel = I28F4;
/// Radius in units of object space, unsigned Q2.14 in [0, 4).
pub type Radius = U2F14;
/// Largest distance between two surfaces, in units of object space, unsigned Q2.14 in [0, 4).
pub type GeometricError = U2F14;
/// Haversine of the angle between two unit normals, (1 - N1·N2)/2 = 1 - |N1+N2|²/4; unsigned Q0.16 in [0, 1).
pub type Haversine = U0F16;
/// Smallest length of an interpolated normal, unsigned Q1.15 in [0, 1].
pub type NormalLength = U1F15;
/// 1 over the smallest altitude of a triangle, per unit of object space, unsigned Q14.2 in [0, 16384).
pub type InverseAltitude = U14F2;
/// Length in a picture, as a fraction of the picture's smaller side, Q4.12 in [-8, 8).
pub type Share = I4F12;
/// Place in a texture, in widths or heights of it, unsigned Q4.12 in [0, 16).
pub type TextureCoordinate = U4F12;

/// Fraction bits of [`Subpixel`].
pub const SUBPIXEL: u32 = 4;
/// Sixteenths of a pixel from its corner to its centre.
pub const CENTRE: i32 = 1 << (SUBPIXEL - 1);
/// Largest number of times that a triangle can be split.
pub const SPLITS: u32 = 6;
/// Fraction bits of a screen coordinate within a triangle. They keep the corners of its parts exact after [`SPLITS`] splits.
pub const FINE: u32 = SUBPIXEL + SPLITS;
/// Fraction bits of [`Unit`](super::Unit), [`Length`](super::Length), [`GeometricError`] and [`Gain`](super::Gain).
pub const UNIT: u32 = 14;
/// Fraction bits of a point in object space where light is computed, and of a point light or viewer there: Q7.25. Streams keep points within 56
/// units. Close to a light each bit of the distance counts.
pub const POSITION: u32 = 25;
/// Fraction bits of [`Rotation`](super::Rotation).
pub const ROTATION: u32 = 30;
/// Fraction bits of a dot product of unit vectors, N·L or N·H: Q2.30.
pub const COSINE: u32 = 30;
/// Fraction bits of a light level at a node, in 1/255 of full intensity (LSB): Q9.7 held in an `i32`.
pub const LEVEL: u32 = 7;
/// The largest light level of a node: 255.
pub const FULL: i32 = 255 << LEVEL;
/// Fraction bits of a level while it is walked along a span. Levels are unsigned Q9.23, or Q9.22 below one more bit: see
/// [`crate::pixel::ramps::Ramps::BITS`].
pub const WALK: u32 = 23;
/// Fraction bits of a level of one of three channels while it is walked: signed Q10.22. The range holds all overshoots without a bias, so one
/// instruction of Armv7-M converts a level to a channel.
pub const CHANNEL: u32 = 22;
/// The bias of walked levels: 0..=127 are below black, 128..=383 the 256 levels, 384..=511 above white.
///
/// The quadratic of six points stays within 5/3 of half the nodes' range from its middle (its Lebesgue constant). Nodes in [0, 255] therefore give
/// values in [-85, 340].
pub const BIAS: i32 = 128;
/// Fraction bits of depth at a vertex, Q0.28: 1 at the near plane, 0 infinitely far.
pub const DEPTH: u32 = 28;
/// Fraction bits of depth at the corners of a triangle, 16 times finer than the depth buffer.
pub const DEPTH_NODE: u32 = 20;
/// Fraction bits of depth while it is walked. The depth buffer keeps the 16 bits above them.
pub const DEPTH_WALK: u32 = 16;
/// Fraction bits of a cosine in the loop over pixels: Q5.27. Sums and overshoots fit.
pub const PIXEL_COSINE: u32 = 27;
/// Fraction bits of the reciprocal length of the sum of two unit normals, 1/|N1+N2|, unsigned Q1.17 in [1/2, 1). A stream stores this number minus
/// 1/2.
pub const INVERSE_SUM_LENGTH: u32 = 17;
/// Fraction bits of [`Haversine`].
pub const HAVERSINE: u32 = 16;
/// Fraction bits of [`NormalLength`].
pub const NORMAL_LENGTH: u32 = 15;
/// Fraction bits of [`InverseAltitude`].
pub const INVERSE_ALTITUDE: u32 = 2;
/// Fraction bits of [`TextureCoordinate`].
pub const TEXTURE: u32 = 12;
/// Number of entries in a table of colours: 256 levels, and [`BIAS`] more at each end.
pub const RAMP: usize = 512;
/// Fraction bits of an [`Intensity`](super::Intensity).
pub const INTENSITY: u32 = 8;
