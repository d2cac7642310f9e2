//! Dither by rows: even rows of the picture are a quarter of a step darker, odd ones brighter, in formats with a checkerboard.

use crate::pixel::{Pixel, ramps::Ramps};
use core::marker::PhantomData;

/// State that differs between even and odd rows, for dither.
pub trait ByRows: Copy {
    /// Moves down by one row.
    #[inline(always)]
    fn step_row(&mut self) {}

    /// Takes back the last step of another copy, as far as copies share what is stepped.
    #[inline]
    fn take_back(&self) {}

    /// Moves down from the first row of the picture to `row`.
    #[inline]
    fn start_at(&mut self, row: i32) {
        if row & 1 != 0 {
            self.step_row();
        }
    }
}

/// A value for even rows of the picture and one for odd rows. Formats without a checkerboard use the first on all rows.
#[derive(Clone, Copy, Debug)]
pub struct ByTurns<T, C> {
    /// For the current row and for the next.
    values: [T; 2],
    format: PhantomData<C>,
}

impl<T: Copy, C> ByTurns<T, C> {
    /// Makes the pair, on an even row.
    pub fn new(values: [T; 2]) -> Self {
        Self { values, format: PhantomData }
    }

    /// The value for the current row.
    #[inline]
    pub fn now(&self) -> T {
        self.values[0]
    }

    /// A pair of what `f` makes of both values.
    pub fn map<U: Copy>(&self, f: impl Fn(T) -> U) -> ByTurns<U, C> {
        ByTurns::new(self.both().map(f))
    }

    /// The value for the current row and the one for the next.
    pub fn both(&self) -> [T; 2] {
        self.values
    }
}

impl<T: Copy, C: Pixel> ByRows for ByTurns<T, C> {
    #[inline]
    fn step_row(&mut self) {
        if C::Ramps::CHECKERED {
            let [now, next] = self.values;
            self.values = [next, now];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};

    /// The value on each of six rows, stepped from the first, and begun there.
    fn rows<C: Pixel>() -> [[u8; 2]; 6] {
        let mut stepped = ByTurns::<u8, C>::new([0, 1]);
        core::array::from_fn(|row| {
            let mut begun = ByTurns::<u8, C>::new([0, 1]);
            begun.start_at(row as i32);
            let values = [stepped.now(), begun.now()];
            stepped.step_row();
            values
        })
    }

    #[test]
    fn rows_take_turns() {
        assert_eq!(rows::<Rgb565>(), [[0; 2], [1; 2], [0; 2], [1; 2], [0; 2], [1; 2]]);
        assert_eq!(rows::<Rgb888>(), [[0; 2]; 6], "eight bits have no checkerboard");
    }
}
