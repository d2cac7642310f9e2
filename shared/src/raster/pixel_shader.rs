//! From walked values to pixels, in loops that are compiled for one method and one pixel format.

use crate::{
    format::{RAMP, WALK},
    pixel::Pixel,
};
use core::marker::PhantomData;

/// Turns the value at one pixel into its colour.
pub trait PixelShader<V>: Copy {
    /// What is stored.
    type Pixel;

    /// So few instructions that a test of depth would be a large share of them: worth a loop without one.
    const CHEAP: bool = false;

    /// Tells it from other tones of the same method: a band that hands a triangle on says by it which one it is drawn in.
    const ID: u8 = 0;

    /// The colour of a value.
    fn shade(&self, value: V) -> Self::Pixel;
}

/// One colour.
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

/// One walked level under a table of colours; the guards at both ends clamp for nothing.
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

/// Three walked levels, scaled so that their upper bits are the channels; half a step is in them already.
#[derive(Clone, Copy, Debug)]
pub struct Rgb<C>(pub PhantomData<C>);

impl<C: Pixel> PixelShader<[u32; 3]> for Rgb<C> {
    type Pixel = C;

    #[inline(always)]
    fn shade(&self, levels: [u32; 3]) -> C {
        C::mixed(levels)
    }
}
