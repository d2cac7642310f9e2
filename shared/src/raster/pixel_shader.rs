//! Pixel shaders: walked values to pixels, in loops that are compiled for one method and one pixel format.

use crate::{
    format::{RAMP, WALK},
    pixel::Pixel,
};
use core::marker::PhantomData;

/// Turns the value at one pixel into its colour.
pub trait PixelShader<V>: Copy {
    /// The pixel that is stored.
    type Pixel;

    /// Whether the shader has so few instructions that a loop without depth test is worth its code.
    const CHEAP: bool = false;

    /// Number of the shader among those of its method, which is saved with an active triangle.
    const ID: u8 = 0;

    /// The colour of a value.
    fn shade(&self, value: V) -> Self::Pixel;
}

/// One colour for all pixels.
#[derive(Clone, Copy, Debug)]
pub struct Solid<C>(pub C);

impl<C: Copy> PixelShader<()> for Solid<C> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn shade(&self, (): ()) -> C {
        self.0
    }
}

/// One walked level, which is an index of a table of colours; guards at both ends of the table take the place of a clamp.
#[derive(Debug)]
pub struct Ramp<'a, C: Pixel>(pub &'a [C::Stored; RAMP]);

impl<C: Pixel> Clone for Ramp<'_, C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C: Pixel> Copy for Ramp<'_, C> {}

impl<C: Pixel> PixelShader<[u32; 1]> for Ramp<'_, C> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn shade(&self, [level]: [u32; 1]) -> C {
        C::ramped::<WALK>(self.0, level)
    }
}

/// Three walked levels with [`crate::format::CHANNEL`] fraction bits, scaled so that their upper bits are the channels; half a step is in
/// them already.
#[derive(Clone, Copy, Debug)]
pub struct Rgb<C>(pub PhantomData<C>);

impl<C: Pixel> PixelShader<[u32; 3]> for Rgb<C> {
    type Pixel = C;

    #[inline(always)]
    fn shade(&self, levels: [u32; 3]) -> C {
        let [r, g, b] = levels;
        C::mixed([r as i32, g as i32, b as i32])
    }
}
