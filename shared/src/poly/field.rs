//! What a method interpolates, whichever way it gets from the corners to the pixels.
//!
//! A field knows values at nodes of a triangle, not where they lie on the screen. [`Field::fit`] makes it a polynomial of
//! the screen's coordinates, to be walked by additions; [`Field::surface`] one of the place in the triangle, for
//! [`super::hyperbolic`].

use super::{
    Constant, Held, Patch, PerLight, Walker,
    basis::Basis,
    cubic::Cubic,
    hyperbolic::{Point, Surface},
    plane::Plane,
    quadric::Quadric,
};
use crate::{format::MAX_LIGHTS, scene::Source};

/// Values all over a triangle.
pub trait Field {
    /// What it has at a point.
    type Value;
    /// It on the screen, without perspective.
    type Patch: Patch<Walker: Walker<Value = Self::Value> + Copy> + Default;
    /// It on the triangle.
    type Surface: Surface<Value = Self::Value> + Default;

    /// Spreads it evenly over the triangle that `basis` stands for.
    fn fit(&self, basis: &Basis) -> Self::Patch;

    /// Spreads it evenly over the triangle in space.
    fn surface(&self) -> Self::Surface;
}

/// The polynomial through three, six or ten nodes in each of `CH` channels: see [`Plane::fit`], [`Quadric::fit`] (of which
/// `BITS` is) and [`Cubic::fit`].
#[derive(Clone, Copy, Debug)]
pub struct Nodes<const N: usize, const CH: usize, const BITS: u32 = 32> {
    pub(super) values: [[i32; N]; CH],
    pub(super) extra: u32,
    pub(super) bias: [i32; CH],
}

impl<const N: usize, const CH: usize, const BITS: u32> Nodes<N, CH, BITS> {
    /// Through `values[channel][k]` at node `k`, taken with `extra` more fraction bits than they have.
    #[inline(always)]
    #[must_use]
    pub fn new(values: [[i32; N]; CH], extra: u32) -> Self {
        Self { values, extra, bias: [0; CH] }
    }

    /// Plus `bias` in every channel.
    #[inline(always)]
    #[must_use]
    pub fn raised(self, bias: [i32; CH]) -> Self {
        Self { bias, ..self }
    }
}

impl<const N: usize, const CH: usize, const BITS: u32> Default for Nodes<N, CH, BITS> {
    fn default() -> Self {
        Self::new([[0; N]; CH], 0)
    }
}

impl<const CH: usize, const BITS: u32> Field for Nodes<3, CH, BITS> {
    type Value = [u32; CH];
    type Patch = Plane<CH>;
    type Surface = Self;

    #[inline(always)]
    fn fit(&self, basis: &Basis) -> Plane<CH> {
        Plane::fit::<BITS>(basis, self.values, self.extra).raised(self.bias)
    }

    fn surface(&self) -> Self {
        *self
    }
}

impl<const CH: usize, const BITS: u32> Field for Nodes<6, CH, BITS> {
    type Value = [u32; CH];
    type Patch = Quadric<CH>;
    type Surface = Self;

    #[inline(always)]
    fn fit(&self, basis: &Basis) -> Quadric<CH> {
        Quadric::fit::<BITS>(basis, self.values, self.extra).raised(self.bias)
    }

    fn surface(&self) -> Self {
        *self
    }
}

impl<const CH: usize, const BITS: u32> Field for Nodes<10, CH, BITS> {
    type Value = [u32; CH];
    type Patch = Cubic<CH>;
    type Surface = Self;

    fn fit(&self, basis: &Basis) -> Cubic<CH> {
        Cubic::fit(basis, self.values, self.extra).raised(self.bias)
    }

    fn surface(&self) -> Self {
        *self
    }
}

impl Field for Constant {
    type Value = ();
    type Patch = Self;
    type Surface = Self;

    #[inline(always)]
    fn fit(&self, _: &Basis) -> Self {
        Self
    }

    fn surface(&self) -> Self {
        Self
    }
}

impl Surface for Constant {
    type Value = ();

    fn at(&self, _: &Point) {}
}

impl<T: Copy + Default> Field for Held<T> {
    type Value = T;
    type Patch = Self;
    type Surface = Self;

    #[inline(always)]
    fn fit(&self, _: &Basis) -> Self {
        *self
    }

    fn surface(&self) -> Self {
        *self
    }
}

impl<T: Copy> Surface for Held<T> {
    type Value = T;

    fn at(&self, _: &Point) -> T {
        self.0
    }
}

/// Two fields side by side.
impl<A: Field, B: Field> Field for (A, B) {
    type Value = (A::Value, B::Value);
    type Patch = (A::Patch, B::Patch);
    type Surface = (A::Surface, B::Surface);

    #[inline(always)]
    fn fit(&self, basis: &Basis) -> Self::Patch {
        (self.0.fit(basis), self.1.fit(basis))
    }

    fn surface(&self) -> Self::Surface {
        (self.0.surface(), self.1.surface())
    }
}

impl<A: Surface, B: Surface> Surface for (A, B) {
    type Value = (A::Value, B::Value);

    #[inline(always)]
    fn at(&self, point: &Point) -> Self::Value {
        (self.0.at(point), self.1.at(point))
    }
}

/// The field that `of` makes of each light.
#[derive(Clone, Copy, Debug)]
pub struct EachLight<'l, G> {
    /// The lights.
    pub sources: &'l [Source],
    /// The field of one.
    pub of: G,
}

impl<F: Field, G: Fn(&Source) -> F> Field for EachLight<'_, G> {
    type Value = heapless::Vec<F::Value, MAX_LIGHTS>;
    type Patch = PerLight<F::Patch>;
    type Surface = PerLight<F::Surface>;

    #[inline(always)]
    fn fit(&self, basis: &Basis) -> Self::Patch {
        PerLight::new(self.sources, F::Patch::default(), |source| (self.of)(source).fit(basis))
    }

    fn surface(&self) -> Self::Surface {
        PerLight::new(self.sources, F::Surface::default(), |source| (self.of)(source).surface())
    }
}

impl<S: Surface> Surface for PerLight<S> {
    type Value = heapless::Vec<S::Value, MAX_LIGHTS>;

    fn at(&self, point: &Point) -> Self::Value {
        self.patches.iter().take(self.lights).map(|surface| surface.at(point)).collect()
    }
}
