//! The inner loop.

use crate::{poly::Walker, tone::Tone};

/// Shades the pixels of one span from right to left where they are nearer than what is there.
///
/// `z` is the depth one pixel right of the span and `dz` its derivative along x;
/// `walker` stands there too. The walkers step first and the index counts down
/// to zero: the loop ends on its own subtraction, and every slice is checked
/// once, before it.
///
/// Head-room: `z` and the walked values wrap freely; at a pixel centre inside
/// the triangle they are back in range (see [`crate::poly`]).
#[inline(always)]
pub fn fill<W: Walker, T: Tone<W::Value>>(
    pixels: &mut [T::Pixel],
    depth: &mut [u16],
    mut z: u32,
    dz: u32,
    mut walker: W,
    tone: T,
    left: usize,
) {
    let mut i = pixels.len();
    let Some(depth) = depth.get_mut(..i) else { return };
    while i > 0 {
        i -= 1;
        z = z.wrapping_sub(dz);
        walker.step();
        let nearness = (z >> 16) as u16;
        if nearness > depth[i] {
            depth[i] = nearness;
            pixels[i] = tone.tone(walker.value(), left + i);
        }
    }
}
