//! Where in object space an object is.

use crate::math::vector::{narrow_dot, wide, zip};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// All vertices of an object lie in this box, and in this ball about the origin. In memory of the scene, lengths in the format of vertices.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub(crate) struct BoundingVolume {
    /// The middle of the least box along the axes, rounded down.
    pub(crate) middle: [i16; 3],
    /// From there to the farther sides of the box.
    pub(crate) half: [u16; 3],
    /// Radius of the ball, rounded up, in the format [`crate::format::Radius`].
    pub(crate) radius: u16,
}

impl BoundingVolume {
    /// The box and the ball around vertices at these positions.
    pub(crate) fn around(positions: impl Iterator<Item = [i16; 3]>) -> Self {
        let (mut least, mut most, mut square) = ([i16::MAX; 3], [i16::MIN; 3], 0u32);
        positions.for_each(|position| {
            (least, most) = (zip(least, position, i16::min), zip(most, position, i16::max));
            square = square.max(narrow_dot(wide(position), wide(position)) as u32);
        });
        let middle = zip(least, most, |least, most| ((i32::from(least) + i32::from(most)) >> 1) as i16);
        let half = zip(most, middle, |most, middle| (i32::from(most) - i32::from(middle)).max(0) as u16);
        let root = square.isqrt();
        Self { middle, half, radius: (root + u32::from(root * root < square)).min(u16::MAX.into()) as u16 }
    }
}
