//! Dither by rows, for levels of several channels.
//!
//! Channels that are walked side by side have no table to choose, and a threshold would be one addition in each channel at every pixel. So rows take
//! turns: levels are a quarter of a step lower on even rows, and a quarter of a step higher on odd rows.

use crate::{
    interpolate::{Patch, Raised},
    pixel::{Pixel, ramps::Ramps, steps},
};
use core::marker::PhantomData;

/// A polynomial for the levels of three channels. If the pixel format `C` has a checkerboard, every other row is higher.
#[derive(Clone, Copy, Debug)]
pub struct ByRow<P, C> {
    patch: P,
    /// Height of the next row above this one, with [`crate::format::CHANNEL`] fraction bits, as if all channels had eight bits.
    higher: i32,
    format: PhantomData<C>,
}

impl<P: Raised, C: Pixel> ByRow<P, C> {
    /// Whether the pixel format has a checkerboard.
    const IS_ON: bool = C::Ramps::CHECKERED;

    /// Dithers `patch` by rows. The next row is `higher` than the first, in units of a channel of eight bits.
    #[inline(always)]
    #[must_use]
    pub fn new(patch: P, higher: i32) -> Self {
        Self { patch, higher, format: PhantomData }
    }

    #[inline(always)]
    fn turn(&mut self) {
        self.patch.raise(steps(C::DEPTH, self.higher));
        self.higher = -self.higher;
    }
}

impl<P: Raised, C: Pixel> Patch for ByRow<P, C> {
    type Walker = P::Walker;

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        self.patch.jump(rows);
        if Self::IS_ON && rows & 1 != 0 {
            self.turn();
        }
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.patch.step_row();
        if Self::IS_ON {
            self.turn();
        }
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> P::Walker {
        self.patch.enter(x)
    }

    const WORDS: usize = P::WORDS + if Self::IS_ON { 1 } else { 0 };

    #[inline(always)]
    fn save(&self, words: &mut [u32]) -> bool {
        if !Self::IS_ON {
            return self.patch.save(words);
        }
        let Some((higher, words)) = words.split_first_mut() else { return false };
        *higher = self.higher as u32;
        self.patch.save(words)
    }

    #[inline(always)]
    fn load(words: &[u32]) -> Option<Self> {
        let (higher, words) = if Self::IS_ON { words.split_first()? } else { (&0, words) };
        Some(Self { patch: P::load(words)?, higher: *higher as i32, format: PhantomData })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpolate::{Walker, plane::Plane};
    use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};

    fn levels<C: Pixel>(rows: &ByRow<Plane<3>, C>) -> [u32; 3] {
        rows.enter(0).value()
    }

    /// Every other row is higher, after steps and after jumps, and by twice as much in a channel that has one bit less.
    #[test]
    fn rows_take_turns() {
        let begun = ByRow::<_, Rgb565>::new(Plane::<3>::default(), 12);
        let mut stepped = begun;
        for row in 0..6 {
            let mut jumped = begun;
            jumped.jump(row);
            let higher = if row % 2 == 0 { [0; 3] } else { [96, 48, 96] };
            assert_eq!((levels(&stepped), levels(&jumped)), (higher, higher), "row {row}");
            jumped.jump(-row);
            assert_eq!(levels(&jumped), [0; 3]);
            // The band below goes on from here.
            let mut words = [0; ByRow::<Plane<3>, Rgb565>::WORDS];
            assert!(stepped.save(&mut words));
            stepped = ByRow::load(&words).unwrap();
            stepped.step_row();
        }
        let mut fine = ByRow::<_, Rgb888>::new(Plane::<3>::default(), 12);
        fine.step_row();
        assert_eq!(levels(&fine), [0; 3], "eight bits have no checkerboard");
    }
}
