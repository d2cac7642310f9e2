//! From walked values to pixels.

use crate::{
    dither::{quantise, threshold},
    format::{BIAS, RAMP, WALK},
    pixel::Pixel,
};
use core::marker::PhantomData;

/// Turns the value at one pixel into its colour.
pub trait Tone<V>: Copy {
    /// What is stored.
    type Pixel;

    /// So few instructions that a test of depth would be a large share of them: worth a loop without one.
    const CHEAP: bool = false;

    /// Tells it from other tones of the same method, where that is worth knowing when a band hands a triangle on.
    const MARK: u8 = 0;

    /// The colour at column `x` of the current row.
    fn tone(&self, value: V, x: usize) -> Self::Pixel;

    /// Starts on `row`.
    #[inline(always)]
    fn start(&mut self, _row: i32) {}

    /// Moves down one row.
    #[inline(always)]
    fn step_row(&mut self) {}
}

/// One colour.
#[derive(Clone, Copy, Debug)]
pub struct Solid<C>(pub C);

impl<C: Copy> Tone<()> for Solid<C> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn tone(&self, (): (), _: usize) -> C {
        self.0
    }
}

/// One walked level under a table of colours; the guards at both ends clamp for nothing.
#[derive(Clone, Copy, Debug)]
pub struct Ramp<'a, C>(pub &'a [C; RAMP]);

impl<C: Pixel> Tone<[u32; 1]> for Ramp<'_, C> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn tone(&self, [level]: [u32; 1], _: usize) -> C {
        C::ramped::<WALK>(self.0, level)
    }
}

/// Three walked levels, scaled so that their upper bits are the channels; half a step is in them already.
#[derive(Clone, Copy, Debug)]
pub struct Rgb<C>(pub PhantomData<C>);

impl<C: Pixel> Tone<[u32; 3]> for Rgb<C> {
    type Pixel = C;

    #[inline(always)]
    fn tone(&self, levels: [u32; 3], _: usize) -> C {
        C::mixed(levels)
    }
}

/// A tone of levels with a threshold that changes from pixel to pixel instead of rounding.
#[derive(Clone, Copy, Debug)]
pub struct Dithered<C> {
    /// Channels at full level, Q0.8 of an 8-bit channel scaled to the output's depth; used for one walked level.
    pub base: [u16; 3],
    row: usize,
    pixel: PhantomData<C>,
}

impl<C: Pixel> Dithered<C> {
    /// A dither for one walked level that scales `base`, or for three levels.
    #[must_use]
    pub fn new(base: [u16; 3]) -> Self {
        Self { base, row: 0, pixel: PhantomData }
    }
}

/// A biased, walked level as unsigned Q8.8.
#[inline(always)]
fn fine_level(walked: u32) -> u32 {
    ((walked >> (WALK - 8)) as i32 - (BIAS << 8)).clamp(0, 255 << 8) as u32
}

impl<C: Pixel> Tone<[u32; 1]> for Dithered<C> {
    type Pixel = C;

    #[inline(always)]
    fn tone(&self, [level]: [u32; 1], x: usize) -> C {
        let level = fine_level(level);
        quantise(self.base.map(|base| (level * u32::from(base)) >> 8), threshold(x, self.row))
    }

    fn start(&mut self, row: i32) {
        self.row = row as usize;
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.row += 1;
    }
}

impl<C: Pixel> Tone<[u32; 3]> for Dithered<C> {
    type Pixel = C;

    #[inline(always)]
    fn tone(&self, levels: [u32; 3], x: usize) -> C {
        quantise(levels.map(fine_level), threshold(x, self.row))
    }

    fn start(&mut self, row: i32) {
        self.row = row as usize;
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.row += 1;
    }
}
