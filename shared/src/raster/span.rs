//! The inner loop over the pixels of a span.

use crate::{
    interpolate::{Constant, Walker, plane::LinearWalker},
    raster::pixel_shader::PixelShader,
};
use core::ops::Range;

/// A depth test that is walked along a span.
pub(crate) trait DepthTest: Walker {
    /// The part of the depth buffer that the test needs for these pixels.
    fn depth(depth: &mut [u16], pixels: Range<usize>) -> Option<&mut [u16]>;

    /// Whether pixel `i` of `depth` passes the test.
    fn is_nearer(&self, depth: &[u16], i: usize) -> bool;

    /// Stores the depth of pixel `i`.
    fn store(&self, depth: &mut [u16], i: usize);

    /// Whether pixel `i` of `depth` passes the test; if so, its depth is stored.
    #[inline(always)]
    fn passes(&self, depth: &mut [u16], i: usize) -> bool {
        let passes = self.is_nearer(depth, i);
        if passes {
            self.store(depth, i);
        }
        passes
    }
}

/// The test of an inverse depth, of which the upper half is stored.
impl DepthTest for LinearWalker<1> {
    #[inline]
    fn depth(depth: &mut [u16], pixels: Range<usize>) -> Option<&mut [u16]> {
        depth.get_mut(pixels)
    }

    #[inline(always)]
    fn is_nearer(&self, depth: &[u16], i: usize) -> bool {
        let inv_depth = (self.value()[0] >> 16) as u16;
        depth.get(i).is_some_and(|&depth| inv_depth > depth)
    }

    #[inline(always)]
    fn store(&self, depth: &mut [u16], i: usize) {
        if let Some(depth) = depth.get_mut(i) {
            *depth = (self.value()[0] >> 16) as u16;
        }
    }
}

/// No test: every pixel passes.
impl DepthTest for Constant {
    #[inline]
    fn depth(_: &mut [u16], _: Range<usize>) -> Option<&mut [u16]> {
        Some(&mut [])
    }

    #[inline]
    fn is_nearer(&self, _: &[u16], _: usize) -> bool {
        true
    }

    #[inline]
    fn store(&self, _: &mut [u16], _: usize) {}
}

/// Shades the pixels of one span that pass the depth test, from right to left.
///
/// `test` and `walker` stand one pixel right of the span. They step first and the index counts down
/// to zero: the loop ends on its own subtraction, and every slice is checked
/// once, before it.
///
/// Head-room: inverse depth and the walked values wrap freely; at a pixel centre inside
/// the triangle they are back in range (see [`crate::interpolate`]).
#[inline(always)]
pub(crate) fn fill<S: DepthTest, W: Walker, T: PixelShader<W::Value>>(
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
        if W::HAS_HOLES {
            if test.is_nearer(depth, i) {
                let value = walker.value();
                if W::covers(&value) {
                    pixels[i] = shader.shade(value);
                    test.store(depth, i);
                }
            }
        } else if test.passes(depth, i) {
            pixels[i] = shader.shade(walker.value());
        }
    }
}
