//! The inner loop.

use crate::{
    interpolate::{Constant, Walker, plane::Linear},
    raster::pixel_shader::PixelShader,
};
use core::ops::Range;

/// Decides whether a pixel is seen.
pub trait DepthTest: Walker {
    /// What it needs of the depth buffer for these pixels.
    fn depth(depth: &mut [u16], pixels: Range<usize>) -> Option<&mut [u16]>;

    /// Whether pixel `i` of `depth` is seen, which then is as deep as this.
    fn passes(&self, depth: &mut [u16], i: usize) -> bool;
}

/// An inverse depth to be tested; what is stored of it is the upper half.
impl DepthTest for Linear<1> {
    #[inline(always)]
    fn depth(depth: &mut [u16], pixels: Range<usize>) -> Option<&mut [u16]> {
        depth.get_mut(pixels)
    }

    #[inline(always)]
    fn passes(&self, depth: &mut [u16], i: usize) -> bool {
        let inv_depth = (self.value()[0] >> 16) as u16;
        let Some(depth) = depth.get_mut(i) else { return false };
        let passes = inv_depth > *depth;
        if passes {
            *depth = inv_depth;
        }
        passes
    }
}

/// Nothing hides it.
impl DepthTest for Constant {
    #[inline(always)]
    fn depth(_: &mut [u16], _: Range<usize>) -> Option<&mut [u16]> {
        Some(&mut [])
    }

    #[inline(always)]
    fn passes(&self, _: &mut [u16], _: usize) -> bool {
        true
    }
}

/// Shades the pixels of one span from right to left where they are seen.
///
/// `test` and `walker` stand one pixel right of the span. They step first and the index counts down
/// to zero: the loop ends on its own subtraction, and every slice is checked
/// once, before it.
///
/// Head-room: inverse depth and the walked values wrap freely; at a pixel centre inside
/// the triangle they are back in range (see [`crate::interpolate`]).
#[inline(always)]
pub fn fill<S: DepthTest, W: Walker, T: PixelShader<W::Value>>(
    pixels: &mut [T::Pixel],
    depth: &mut [u16],
    mut test: S,
    mut walker: W,
    shader: T,
) {
    let mut i = pixels.len();
    let Some(depth) = S::depth(depth, 0..i) else { return };
    while i > 0 {
        i -= 1;
        test.step();
        walker.step();
        if test.passes(depth, i) {
            pixels[i] = shader.shade(walker.value());
        }
    }
}
