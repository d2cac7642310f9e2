//! Fields that only methods of the literature need.

use microphong::method::{Field, Gradients, Patch, Point, Steepness, Surface, Walker};

/// A field with its own steepness: light depends on it more or less steeply than on other fields of its triangle.
#[derive(Clone, Copy, Debug)]
pub struct Steep<F> {
    /// The field.
    pub field: F,
    /// How steeply light depends on the field.
    pub steepness: Steepness,
}

impl<F: Field> Field for Steep<F> {
    type Patch = F::Patch;

    fn fit(&self, gradients: &Gradients) -> F::Patch {
        self.field.fit(&gradients.steep(self.steepness))
    }
}

impl<F: Surface> Surface for Steep<F> {
    type Value = F::Value;

    #[inline(always)]
    fn at(&self, point: &Point) -> F::Value {
        self.field.at(point)
    }
}

/// A field with one value everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Held<T>(pub T);

impl<T: Copy> Field for Held<T> {
    type Patch = Self;

    #[inline(always)]
    fn fit(&self, _: &Gradients) -> Self {
        *self
    }
}

impl<T: Copy> Surface for Held<T> {
    type Value = T;

    fn at(&self, _: &Point) -> T {
        self.0
    }
}

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
