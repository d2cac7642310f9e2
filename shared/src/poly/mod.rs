//! Polynomials over a triangle: fitted once, then walked by additions.
//!
//! `Basis` turns node values into derivatives, [`plane::Plane`], [`quadric::Quadric`] and
//! [`cubic::Cubic`] hold them as integers for the rows of a triangle, and
//! their walkers run along one span. Coefficients are rounded once; every later
//! step is exact modulo 2^32 (2^64), so neither rows, nor bands, nor clipping change a
//! bit of a value, and nothing drifts.
//!
//! Methods say what they interpolate by [`field`]s; [`hyperbolic`] interpolates the same in perspective.

pub mod basis;
pub mod cubic;
pub mod field;
pub mod hyperbolic;
pub mod plane;
pub mod quadric;
mod sliver;
mod small;
pub mod terms;

use crate::format::MAX_LIGHTS;

/// A polynomial of one triangle, standing on one row.
pub trait Patch: Copy {
    /// What runs along a span of that row.
    type Walker: Walker;

    /// Moves down `rows` rows, exactly.
    fn jump(&mut self, rows: i32);

    /// Moves down one row.
    fn step_row(&mut self);

    /// A walker that stands on column `x`; its first step leads to `x - 1`.
    fn enter(&self, x: i32) -> Self::Walker;

    /// Words that [`Self::keep`] takes.
    const WORDS: usize = 0;

    /// Writes all that it is to the first `words`; false if it cannot, or they are too few.
    #[inline(always)]
    fn keep(&self, _words: &mut [u32]) -> bool {
        false
    }

    /// What has been kept.
    #[inline(always)]
    #[must_use]
    fn kept(_words: &[u32]) -> Option<Self> {
        None
    }
}

/// Runs along a span from right to left.
pub trait Walker {
    /// What it has at a pixel.
    type Value;

    /// Moves one pixel to the left.
    fn step(&mut self);

    /// The value at the current pixel.
    fn value(&self) -> Self::Value;
}

/// The same everywhere.
#[derive(Clone, Copy, Debug, Default)]
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
    #[inline(always)]
    fn keep(&self, _: &mut [u32]) -> bool {
        true
    }
    #[inline(always)]
    fn kept(_: &[u32]) -> Option<Self> {
        Some(Self)
    }
}

impl Walker for Constant {
    type Value = ();
    #[inline(always)]
    fn step(&mut self) {}
    #[inline(always)]
    fn value(&self) {}
}

/// A value that goes along with a polynomial, the same everywhere.
#[derive(Clone, Copy, Debug, Default)]
pub struct Held<T>(pub T);

impl<T: Copy> Patch for Held<T> {
    type Walker = Self;
    #[inline(always)]
    fn jump(&mut self, _: i32) {}
    #[inline(always)]
    fn step_row(&mut self) {}
    #[inline(always)]
    fn enter(&self, _: i32) -> Self {
        *self
    }
}

impl<T: Copy> Walker for Held<T> {
    type Value = T;
    #[inline(always)]
    fn step(&mut self) {}
    #[inline(always)]
    fn value(&self) -> T {
        self.0
    }
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

    #[inline(always)]
    fn keep(&self, words: &mut [u32]) -> bool {
        let Some((first, rest)) = words.split_at_mut_checked(A::WORDS) else { return false };
        self.0.keep(first) && self.1.keep(rest)
    }

    #[inline(always)]
    fn kept(words: &[u32]) -> Option<Self> {
        let (first, rest) = words.split_at_checked(A::WORDS)?;
        Some((A::kept(first)?, B::kept(rest)?))
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
}

/// One polynomial per light.
#[derive(Clone, Copy, Debug, Default)]
pub struct PerLight<P> {
    patches: [P; MAX_LIGHTS],
    lights: usize,
}

impl<P: Copy> PerLight<P> {
    /// The polynomial that `fit` makes for each of `lights`; `zero` stands in for lights that there are not.
    #[must_use]
    pub fn new<L>(lights: &[L], zero: P, fit: impl Fn(&L) -> P) -> Self {
        let mut patches = [zero; MAX_LIGHTS];
        for (patch, light) in patches.iter_mut().zip(lights) {
            *patch = fit(light);
        }
        Self { patches, lights: lights.len() }
    }
}

impl<P: Patch> Patch for PerLight<P>
where
    P::Walker: Copy,
{
    type Walker = PerLight<P::Walker>;

    fn jump(&mut self, rows: i32) {
        self.patches.iter_mut().take(self.lights).for_each(|patch| patch.jump(rows));
    }

    fn step_row(&mut self) {
        self.patches.iter_mut().take(self.lights).for_each(Patch::step_row);
    }

    fn enter(&self, x: i32) -> Self::Walker {
        let [first, ..] = &self.patches;
        let mut walkers = [first.enter(x); MAX_LIGHTS];
        for (walker, patch) in walkers.iter_mut().zip(&self.patches).take(self.lights).skip(1) {
            *walker = patch.enter(x);
        }
        PerLight { patches: walkers, lights: self.lights }
    }
}

impl<W: Walker> Walker for PerLight<W> {
    type Value = heapless::Vec<W::Value, MAX_LIGHTS>;

    fn step(&mut self) {
        self.patches.iter_mut().take(self.lights).for_each(Walker::step);
    }

    fn value(&self) -> Self::Value {
        let mut values = heapless::Vec::new();
        for walker in self.patches.iter().take(self.lights) {
            let _ = values.push(walker.value());
        }
        values
    }
}
