//! Polynomials over a triangle: fitted once, then walked by additions.
//!
//! `Basis` turns node values into derivatives, [`plane::Plane`] and
//! [`quadric::Quadric`] hold them as integers for the rows of a triangle, and
//! their walkers run along one span. Coefficients are rounded once; every later
//! step is exact modulo 2^32, so neither rows, nor bands, nor clipping change a
//! bit of a value, and nothing drifts.

pub mod basis;
pub mod plane;
pub mod quadric;

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
}

impl Walker for Constant {
    type Value = ();
    #[inline(always)]
    fn step(&mut self) {}
    #[inline(always)]
    fn value(&self) {}
}
