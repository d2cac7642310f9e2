//! What a vertex under near lights tells of the triangles around it, besides its levels: which lights it faces, and how near it is to a highlight.

use crate::format::COSINE;

/// For each light, as a bit of its number, whether N·L is positive, and the largest N·H of all lights. Both stand in the upper half of a word.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Facing(u32);

/// Place of the bits of the lights.
const FACED: u32 = 16;
/// Place of the largest N·H, Q0.8 rounded up; 255 stands for 1.
const HALF: u32 = 24;

impl Facing {
    /// Adds light number `light` with this N·L and N·H, Q2.30. Light from the sky has no highlight.
    #[inline]
    pub(crate) fn add(&mut self, light: usize, is_sky: bool, [towards, half]: [i32; 2]) {
        self.0 |= u32::from(towards > 0) << ((FACED + light as u32) & 31);
        if !is_sky {
            let half = (half.clamp(0, (1 << COSINE) - 1) as u32 >> (COSINE - 8)) + 1;
            self.0 = (self.0 & !(u32::MAX << HALF)) | half.max(self.0 >> HALF).min(255) << HALF;
        }
    }

    /// The light of a vertex, whose last number has a free upper half, with this in it.
    #[inline]
    pub(crate) fn beside(self, [r, g, b, rest]: [i32; 4]) -> [i32; 4] {
        [r, g, b, rest | self.0 as i32]
    }

    /// The lights that some corner faces and another does not, as bits, and the largest N·H at the corners, Q1.15 rounded up.
    #[inline]
    pub(crate) fn of_corners([a, b, c]: [i32; 3]) -> (u32, u32) {
        let mixed = ((a | b | c) & !(a & b & c)) as u32 >> FACED & 0xff;
        let half = (a as u32 >> HALF).max(b as u32 >> HALF).max(c as u32 >> HALF);
        // 255 may stand for 1.
        (mixed, (half + ((half + 1) >> 8)) << 7)
    }
}
