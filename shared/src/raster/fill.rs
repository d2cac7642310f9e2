//! The inner loop.

use crate::{
    poly::{Constant, Walker, plane::Linear},
    tone::Tone,
};

/// Decides whether a pixel is seen.
pub trait Sight: Walker {
    /// Whether the current pixel is nearer than `depth`, which it then takes.
    fn passes(&self, depth: &mut u16) -> bool;
}

/// A nearness to be tested; what is seen is in the upper half.
impl Sight for Linear<1> {
    #[inline(always)]
    fn passes(&self, depth: &mut u16) -> bool {
        let nearness = (self.value()[0] >> 16) as u16;
        let passes = nearness > *depth;
        if passes {
            *depth = nearness;
        }
        passes
    }
}

/// Nothing hides it.
impl Sight for Constant {
    #[inline(always)]
    fn passes(&self, _: &mut u16) -> bool {
        true
    }
}

/// Shades the pixels of one span from right to left where they are nearer than what is there.
///
/// `sight` and `walker` stand one pixel right of the span. They step first and the index counts down
/// to zero: the loop ends on its own subtraction, and every slice is checked
/// once, before it.
///
/// Head-room: nearness and the walked values wrap freely; at a pixel centre inside
/// the triangle they are back in range (see [`crate::poly`]).
#[inline(always)]
pub fn fill<S: Sight, W: Walker, T: Tone<W::Value>>(
    pixels: &mut [T::Pixel],
    depth: &mut [u16],
    mut sight: S,
    mut walker: W,
    tone: &T,
    left: usize,
) {
    let mut i = pixels.len();
    let Some(depth) = depth.get_mut(..i) else { return };
    while i > 0 {
        i -= 1;
        sight.step();
        walker.step();
        if sight.passes(&mut depth[i]) {
            pixels[i] = tone.tone(walker.value(), left + i);
        }
    }
}
