//! Tables of colours: the pixel for each level of light.
//!
//! A display of five or six bits a channel shows steps where light changes slowly. Its formats have two tables, rounded a quarter of a step down and
//! up. A picture takes them by turns, like the squares of a checkerboard, and the eye sees half steps. No pixel computes its place on the board: half
//! of the range of a walked level is added to the level's step from column to column and from row to row ([`crate::interpolate::Patch`] is exact
//! modulo 2^32), and the highest bit selects the table.

use crate::{
    format::{RAMP, WALK},
    pixel::dither::{HALF, SQUARES},
};
use core::fmt::Debug;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// The tables of colours of a material. `T` is the type of their entries.
pub trait Ramps<T: Copy>: Copy + FromBytes + IntoBytes + Immutable + KnownLayout + Debug + Sync {
    /// Whether there is a table for each kind of square of a checkerboard.
    const CHECKERED: bool;
    /// Fraction bits of a level while it is walked along a span: [`WALK`], or one less if the highest bit selects the square of the checkerboard.
    const BITS: u32;

    /// The tables for the two kinds of squares, or one table twice.
    fn squares(&self) -> [&[T; RAMP]; 2];

    /// The colour of a walked level with [`Self::BITS`] fraction bits. The level includes bias and half a step for rounding. The bit above it selects
    /// the square of the checkerboard.
    fn walked(&self, level: u32) -> T;

    /// Fills the tables. `colour` makes an entry by its number and a [`crate::pixel::dither::threshold`].
    fn fill(&mut self, dither: bool, colour: impl FnMut(usize, u32) -> T);
}

/// A table of 512 colours, which map light levels to pixels without dither. It is the type [`Pixel::Ramps`](crate::pixel::Pixel::Ramps) of
/// most formats. `T` is the type of an entry.
pub type Rounded<T> = [[T; RAMP]; 1];

/// Two tables of 512 colours each, which map light levels to pixels. One is rounded up and one down, and pixels or rows use them in turn,
/// so that the display seems to have finer steps (dither). It is the type [`Pixel::Ramps`](crate::pixel::Pixel::Ramps) of formats with five
/// to seven bits a channel. `T` is the type of an entry.
pub type InTurn<T> = [[T; RAMP]; 2];

impl<T: Copy + Debug + FromBytes + IntoBytes + Immutable + KnownLayout + Sync> Ramps<T> for Rounded<T> {
    const CHECKERED: bool = false;
    const BITS: u32 = WALK;

    #[inline]
    fn squares(&self) -> [&[T; RAMP]; 2] {
        let [rounded] = self;
        [rounded; 2]
    }

    #[inline]
    fn walked(&self, level: u32) -> T {
        let [rounded] = self;
        rounded[(level >> Self::BITS) as usize % RAMP]
    }

    fn fill(&mut self, _: bool, mut colour: impl FnMut(usize, u32) -> T) {
        let [rounded] = self;
        rounded.iter_mut().enumerate().for_each(|(level, stored)| *stored = colour(level, HALF));
    }
}

impl<T: Copy + Debug + FromBytes + IntoBytes + Immutable + KnownLayout + Sync> Ramps<T> for InTurn<T> {
    const CHECKERED: bool = true;
    const BITS: u32 = WALK - 1;

    #[inline]
    fn squares(&self) -> [&[T; RAMP]; 2] {
        let [first, second] = self;
        [first, second]
    }

    fn walked(&self, level: u32) -> T {
        self.as_flattened()[(level >> Self::BITS) as usize % (2 * RAMP)]
    }

    fn fill(&mut self, dither: bool, mut colour: impl FnMut(usize, u32) -> T) {
        for (table, threshold) in self.iter_mut().zip(if dither { SQUARES } else { [HALF; 2] }) {
            table.iter_mut().enumerate().for_each(|(level, stored)| *stored = colour(level, threshold));
        }
    }
}
