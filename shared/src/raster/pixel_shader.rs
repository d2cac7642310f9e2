//! Pixel shaders, which convert walked values to pixels in loops that are compiled for one method and one pixel format.

use crate::pixel::{Pixel, dither::ByRows, ramps::Ramps};
use core::marker::PhantomData;

/// Converts the value at a pixel to its colour.
pub trait PixelShader<V>: ByRows {
    /// The pixel that is stored.
    type Pixel: Pixel;

    /// Whether the shader takes so few instructions that a loop without depth test is worth its code.
    const CHEAP: bool = false;

    /// Number of the shader among the method's shaders. It is saved with an active triangle.
    const ID: u8 = 0;

    /// The colour of a value.
    fn shade(&self, value: V) -> Self::Pixel;
}

/// One colour for all pixels, as tables of colours hold it for even rows and for odd ones.
#[derive(Debug)]
pub struct Solid<C: Pixel>(pub [C::Stored; 2]);

impl<C: Pixel> Clone for Solid<C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C: Pixel> Copy for Solid<C> {}

impl<C: Pixel> ByRows for Solid<C> {
    #[inline(always)]
    fn step_row(&mut self) {
        if C::Ramps::CHECKERED {
            let Self([now, next]) = *self;
            *self = Self([next, now]);
        }
    }
}

impl<C: Pixel> PixelShader<()> for Solid<C> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn shade(&self, (): ()) -> C {
        let Self([now, _]) = *self;
        C::from_stored(now)
    }
}

/// One walked level, which is the index of a table of colours. Guards at both ends of the table replace a clamp.
#[derive(Debug)]
pub struct Ramp<'a, C: Pixel>(pub &'a C::Ramps);

impl<C: Pixel> Clone for Ramp<'_, C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C: Pixel> Copy for Ramp<'_, C> {}

impl<C: Pixel> ByRows for Ramp<'_, C> {}

impl<C: Pixel> PixelShader<[u32; 1]> for Ramp<'_, C> {
    type Pixel = C;

    const CHEAP: bool = true;

    fn shade(&self, [level]: [u32; 1]) -> C {
        C::from_stored(C::walked(self.0, level))
    }
}

/// Three walked levels with [`crate::format::CHANNEL`] fraction bits, scaled so that their upper bits are the channels. Constants for rounding or
/// dither have been added.
#[derive(Clone, Copy, Debug)]
pub struct Rgb<C>(pub PhantomData<C>);

impl<C: Pixel> ByRows for Rgb<C> {}

impl<C: Pixel> PixelShader<[u32; 3]> for Rgb<C> {
    type Pixel = C;

    #[inline(always)]
    fn shade(&self, levels: [u32; 3]) -> C {
        let [r, g, b] = levels;
        C::mixed([r as i32, g as i32, b as i32])
    }
}
