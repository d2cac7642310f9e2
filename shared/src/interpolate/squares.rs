//! A checkerboard beside polynomials that cannot carry it in a coefficient.

use crate::interpolate::{HALF_RANGE, Patch, Walker};

/// A polynomial to which half of the range of 2^32 is added at every other pixel, as by [`Checkerboard`](super::Checkerboard).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Squares<P> {
    inner: P,
    /// What is added now: at column 0 of the current row, or where a walker stands.
    now: u32,
}

impl<P> Squares<P> {
    /// `patch`, which stands on `row`.
    pub(crate) fn new(patch: P, row: i32) -> Self {
        Self { inner: patch, now: HALF_RANGE.wrapping_mul(row) as u32 }
    }

    #[inline]
    fn step(&mut self, by: i32) {
        self.now = self.now.wrapping_add(HALF_RANGE.wrapping_mul(by) as u32);
    }
}

impl<P: Patch<Walker: Walker<Value = [u32; 1]>>> Patch for Squares<P> {
    type Walker = Squares<P::Walker>;

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        self.inner.jump(rows);
        self.step(rows);
    }

    #[inline]
    fn step_row(&mut self) {
        self.inner.step_row();
        self.step(1);
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> Self::Walker {
        let mut walker = Squares { inner: self.inner.enter(x), now: self.now };
        walker.now = walker.now.wrapping_add(HALF_RANGE.wrapping_mul(x) as u32);
        walker
    }
}

impl<W: Walker<Value = [u32; 1]>> Walker for Squares<W> {
    type Value = [u32; 1];

    #[inline]
    fn step(&mut self) {
        self.inner.step();
        self.now ^= HALF_RANGE as u32;
    }

    #[inline(always)]
    fn value(&self) -> [u32; 1] {
        let [value] = self.inner.value();
        [value.wrapping_add(self.now)]
    }
}
