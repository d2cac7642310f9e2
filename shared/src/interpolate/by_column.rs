//! Polynomials that are evaluated at the columns of visible pixels, for loops that walk more values than there are registers.

use crate::{
    arch::SATURATES,
    interpolate::{Patch, Walker},
};
use core::hint::black_box;
use microphong_kernels::{Fields, Plane};

/// Whether evaluation is faster than stepping through all columns. By measurement it is where a product and a sum are one instruction. On a Cortex-M3
/// a value that is stepped in memory takes four instructions for a plane and seven for a quadratic, at every pixel of a span. Evaluation takes two
/// and four, at pixels that pass the depth test.
const EVALUATES: bool = SATURATES;

/// A polynomial that is evaluated at each column. The values are bit for bit those of stepping.
#[derive(Clone, Copy, Debug, Default)]
pub struct ByColumn<P>(pub P);

impl<P: Patch<Walker: Copy>> Patch for ByColumn<P> {
    type Walker = AtColumn<P>;

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        self.0.jump(rows);
    }

    #[inline]
    fn step_row(&mut self) {
        self.0.step_row();
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> AtColumn<P> {
        AtColumn { patch: self.0, walker: self.0.enter(x), x }
    }

    #[inline]
    fn raised(self, by: &<P::Walker as Walker>::Value) -> Self {
        Self(self.0.raised(by))
    }

    const WORDS: usize = P::WORDS;

    const FIELDS: Option<[usize; 2]> = P::FIELDS;

    #[inline]
    fn planes(&mut self) -> &mut [Plane] {
        self.0.planes()
    }

    #[inline]
    fn lend<'a>(&'a mut self, fields: &mut Fields<'a>) {
        self.0.lend(fields);
    }

    #[inline]
    fn save(&self, words: &mut [u32]) {
        self.0.save(words);
    }

    #[inline]
    fn load(words: &[u32]) -> Option<Self> {
        P::load(words).map(Self)
    }
}

/// The number of the column itself, for pixel shaders that evaluate polynomials of their own. Nothing that is walked beside it is saved for the next
/// band, because their polynomials would not be.
#[derive(Clone, Copy, Debug)]
pub struct Column;

impl Patch for Column {
    type Walker = ColumnWalker;

    #[inline(always)]
    fn jump(&mut self, _: i32) {}

    #[inline]
    fn step_row(&mut self) {}

    #[inline(always)]
    fn enter(&self, x: i32) -> ColumnWalker {
        ColumnWalker(x)
    }
}

/// A column of a span.
#[derive(Clone, Copy, Debug)]
pub struct ColumnWalker(i32);

impl Walker for ColumnWalker {
    type Value = i32;

    #[inline]
    fn step(&mut self) {
        self.0 = self.0.wrapping_sub(1);
    }

    #[inline(always)]
    fn value(&self) -> i32 {
        self.0
    }
}

/// A column together with the polynomial or its walker. The compiler removes what is not used.
#[derive(Clone, Copy, Debug)]
pub struct AtColumn<P: Patch> {
    patch: P,
    walker: P::Walker,
    x: i32,
}

impl<P: Patch> Walker for AtColumn<P> {
    type Value = <P::Walker as Walker>::Value;

    #[inline]
    fn step(&mut self) {
        if EVALUATES {
            self.x = self.x.wrapping_sub(1);
        } else {
            self.walker.step();
        }
    }

    #[inline(always)]
    fn value(&self) -> Self::Value {
        if EVALUATES {
            // Opaque, or the compiler makes steps of the products.
            self.patch.enter(black_box(self.x)).value()
        } else {
            self.walker.value()
        }
    }

    const HAS_HOLES: bool = P::Walker::HAS_HOLES;

    #[inline]
    fn may_have_holes(&self) -> bool {
        self.walker.may_have_holes()
    }

    #[inline]
    fn covers(value: &Self::Value) -> bool {
        P::Walker::covers(value)
    }
}
