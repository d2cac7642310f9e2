//! Polynomials over a triangle: fitted once, then walked by additions.
//!
//! `Gradients` turns node values into derivatives, [`plane::Plane`] and [`quadric::Quadric`] hold them as integers for the rows of a
//! triangle, and their walkers run along one span. Coefficients are rounded once; every later step is exact modulo 2^32, so neither rows, nor
//! bands, nor clipping change a bit of a value, and nothing drifts.
//!
//! Methods describe what they interpolate by [`field`]s. [`perspective`] interpolates fields in perspective.

pub mod by_column;
pub mod field;
pub mod perspective;
pub mod plane;
pub mod quadric;
pub(crate) mod squares;
pub mod wide_quadric;

use microphong_kernels::Fields;

/// A polynomial of one triangle, standing on one row.
pub trait Patch: Copy {
    /// The walker along a span of that row.
    type Walker: Walker;

    /// Moves down `rows` rows, exactly.
    fn jump(&mut self, rows: i32);

    /// Moves down one row.
    fn step_row(&mut self);

    /// A walker that stands on column `x`; its first step leads to `x - 1`.
    fn enter(&self, x: i32) -> Self::Walker;

    /// The polynomial with `by` added to its values. Only polynomials of levels are raised, for dither; others need not implement it.
    #[inline(always)]
    fn raised(self, _by: &<Self::Walker as Walker>::Value) -> Self {
        self
    }

    /// Number of words that [`Self::save`] writes. By default it is more than there is room for, so that the polynomial is not saved.
    const WORDS: usize = 1 << 8;

    /// Writes the polynomial to the first of `words`, which are no fewer than [`Self::WORDS`].
    #[inline(always)]
    fn save(&self, _words: &mut [u32]) {}

    /// The number of planes and the number of quadratics, for kernels. It is `None` if the polynomial has other parts; no kernel draws it then.
    const FIELDS: Option<[usize; 2]> = None;

    /// The planes of a polynomial that is one field of planes. Others return none.
    #[inline(always)]
    fn planes(&mut self) -> &mut [microphong_kernels::Plane] {
        &mut []
    }

    /// Lends its planes to a kernel as numerators, and its quadratics.
    #[inline(always)]
    fn lend<'a>(&'a mut self, _fields: &mut Fields<'a>) {}

    /// The polynomial that has been saved in `words`.
    #[inline(always)]
    fn load(_words: &[u32]) -> Option<Self> {
        None
    }
}

/// A polynomial that can carry a checkerboard in its highest bit.
pub trait Checkerboard: Patch {
    /// Adds half of the range of 2^32 at every other pixel, in all channels: where one of column and row is even and the other odd. The polynomial
    /// stands on `row`. Values have one bit less then; higher bits wrap.
    fn checkered(self, row: i32) -> Self;
}

/// Half of the range of a walked value.
const HALF_RANGE: i32 = i32::MIN;

/// Calls `f` for each channel. It is written out, because a loop over channels goes through memory at opt-level "s".
#[inline(always)]
pub(crate) fn each_channel<const CH: usize>(mut f: impl FnMut(usize)) {
    match CH {
        1 => f(0),
        2 => (f(0), f(1)).0,
        3 => {
            f(0);
            f(1);
            f(2);
        }
        _ => (0..CH).for_each(f),
    }
}

/// Runs along a span from right to left.
pub trait Walker: Clone {
    /// The value at a pixel.
    type Value;

    /// Moves one pixel to the left.
    fn step(&mut self);

    /// The value at the current pixel.
    fn value(&self) -> Self::Value;

    /// Whether a pixel may be a hole, so that [`Self::covers`] has to be asked.
    const HAS_HOLES: bool = false;

    /// Whether this surface may have a hole.
    #[inline(always)]
    fn may_have_holes(&self) -> bool {
        Self::HAS_HOLES
    }

    /// Whether the surface covers a pixel that has this value: false if it has a hole there.
    #[inline(always)]
    fn covers(_: &Self::Value) -> bool {
        true
    }
}

/// A polynomial without a value, for methods that interpolate nothing.
#[derive(Clone, Copy, Debug)]
pub struct Constant;

impl Patch for Constant {
    type Walker = Self;
    #[inline(always)]
    fn jump(&mut self, _: i32) {}
    #[inline(always)]
    fn step_row(&mut self) {}
    #[inline(always)]
    fn enter(&self, _: i32) -> Self {
        Self
    }

    const WORDS: usize = 0;

    #[inline(always)]
    fn load(_: &[u32]) -> Option<Self> {
        Some(Self)
    }

    const FIELDS: Option<[usize; 2]> = Some([0, 0]);
}

impl Walker for Constant {
    type Value = ();
    #[inline(always)]
    fn step(&mut self) {}
    #[inline(always)]
    fn value(&self) {}
}

/// Two polynomials side by side.
impl<A: Patch, B: Patch> Patch for (A, B) {
    type Walker = (A::Walker, B::Walker);

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        self.0.jump(rows);
        self.1.jump(rows);
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.0.step_row();
        self.1.step_row();
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> Self::Walker {
        (self.0.enter(x), self.1.enter(x))
    }

    const WORDS: usize = A::WORDS + B::WORDS;

    const FIELDS: Option<[usize; 2]> = match (A::FIELDS, B::FIELDS) {
        (Some([planes, quadratics]), Some([more_planes, more_quadratics])) => Some([planes + more_planes, quadratics + more_quadratics]),
        _ => None,
    };

    #[inline(always)]
    fn lend<'a>(&'a mut self, fields: &mut Fields<'a>) {
        self.0.lend(fields);
        self.1.lend(fields);
    }

    #[inline(always)]
    fn save(&self, words: &mut [u32]) {
        if let Some((first, rest)) = words.split_at_mut_checked(A::WORDS) {
            self.0.save(first);
            self.1.save(rest);
        }
    }

    #[inline(always)]
    fn load(words: &[u32]) -> Option<Self> {
        let (first, rest) = words.split_at_checked(A::WORDS)?;
        Some((A::load(first)?, B::load(rest)?))
    }
}

impl<A: Walker, B: Walker> Walker for (A, B) {
    type Value = (A::Value, B::Value);

    #[inline(always)]
    fn step(&mut self) {
        self.0.step();
        self.1.step();
    }

    #[inline(always)]
    fn value(&self) -> Self::Value {
        (self.0.value(), self.1.value())
    }

    const HAS_HOLES: bool = A::HAS_HOLES || B::HAS_HOLES;

    #[inline(always)]
    fn may_have_holes(&self) -> bool {
        self.0.may_have_holes() || self.1.may_have_holes()
    }

    #[inline(always)]
    fn covers((a, b): &Self::Value) -> bool {
        A::covers(a) && B::covers(b)
    }
}

#[cfg(test)]
mod tests {
    use super::{Checkerboard, Patch, Walker, plane::Plane, quadric::Quadric, squares::Squares};
    use proptest::prelude::*;

    /// Checks that `checkered` is half of the range higher than `plain` where one of column and row is even and the other odd. Both stand on `row`.
    fn check<P, Q>(mut plain: P, mut checkered: Q, mut row: i32, x: i32, jump: i32) -> Result<(), TestCaseError>
    where
        P: Patch<Walker: Walker<Value = [u32; 1]>>,
        Q: Patch<Walker: Walker<Value = [u32; 1]>>,
    {
        for step in 0..6 {
            let (mut walker, mut expected) = (checkered.enter(x), plain.enter(x));
            for column in (x - 5..x).rev() {
                walker.step();
                expected.step();
                let square = ((column ^ row) as u32 & 1) << 31;
                prop_assert_eq!(walker.value()[0], expected.value()[0] ^ square, "column {}, row {}", column, row);
            }
            if step == 3 {
                plain.jump(jump);
                checkered.jump(jump);
                row += jump;
            } else {
                plain.step_row();
                checkered.step_row();
                row += 1;
            }
        }
        Ok(())
    }

    proptest! {
        /// The highest bit alternates from column to column and from row to row, also after a jump, and all other bits stay unchanged.
        #[test]
        fn the_highest_bit_is_a_checkerboard(words: [u32; 6], row in -3000..3000, x in -3000..3000, jump in -3000..3000) {
            let (plane, quadric) = (Plane::<1>::load(&words).expect("three words"), Quadric::<1>::load(&words).expect("six words"));
            check(plane, plane.checkered(row), row, x, jump)?;
            check(quadric, quadric.checkered(row), row, x, jump)?;
            check(quadric, Squares::new(quadric, row), row, x, jump)?;
        }
    }
}
