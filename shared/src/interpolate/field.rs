//! Fields: quantities that a method interpolates over a triangle, on the screen or in perspective.
//!
//! A field has values at nodes of a triangle, and does not know where they lie on the screen. [`Field::fit`] makes a polynomial in screen
//! coordinates, to be walked by additions. In perspective the field itself is evaluated at barycentric coordinates, as a [`Surface`].

use crate::{
    interpolate::{
        Constant, Patch, Walker, each_channel,
        perspective::{COARSER, Point, SHARE, Slant, Surface},
        plane::Plane,
        quadric::Quadric,
    },
    setup::gradients::Gradients,
};

/// A quantity that varies over a triangle.
pub trait Field: Surface {
    /// The field as a polynomial on the screen, without perspective.
    type Patch: Patch<Walker: Walker<Value = Self::Value> + Copy>;

    /// Fits the polynomial on the screen, on the triangle of `gradients`.
    fn fit(&self, gradients: &Gradients) -> Self::Patch;
}

/// A polynomial through three or six nodes in each of `CH` channels: see [`Plane::fit`] and [`Quadric::fit`], which explain `BITS`.
#[derive(Clone, Copy, Debug)]
pub struct Nodes<const N: usize, const CH: usize, const BITS: u32 = 32> {
    pub(crate) values: [[i32; N]; CH],
    pub(crate) extra: u32,
    pub(crate) bias: [i32; CH],
}

impl<const N: usize, const CH: usize, const BITS: u32> Nodes<N, CH, BITS> {
    /// The polynomial through `values[channel][k]` at node `k`, walked with `extra` more fraction bits than the values have.
    #[inline(always)]
    pub fn new(values: [[i32; N]; CH], extra: u32) -> Self {
        Self { values, extra, bias: [0; CH] }
    }

    /// Adds `bias` to every channel.
    #[inline(always)]
    pub fn biased(self, bias: [i32; CH]) -> Self {
        Self { bias, ..self }
    }
}

impl<const CH: usize, const BITS: u32> Field for Nodes<3, CH, BITS> {
    type Patch = Plane<CH>;

    #[inline(always)]
    fn fit(&self, gradients: &Gradients) -> Plane<CH> {
        Plane::fit::<BITS>(gradients, &self.values, self.extra, self.bias)
    }
}

impl<const CH: usize, const BITS: u32> Field for Nodes<6, CH, BITS> {
    type Patch = Quadric<CH>;

    #[inline(always)]
    fn fit(&self, gradients: &Gradients) -> Quadric<CH> {
        Quadric::fit::<BITS>(gradients, &self.values, self.extra, self.bias)
    }
}

impl Field for Constant {
    type Patch = Self;

    #[inline(always)]
    fn fit(&self, _: &Gradients) -> Self {
        Self
    }
}

impl Surface for Constant {
    type Value = ();

    fn at(&self, _: &Point) {}
}

/// Two fields side by side.
impl<A: Field, B: Field> Field for (A, B) {
    type Patch = (A::Patch, B::Patch);

    #[inline(always)]
    fn fit(&self, gradients: &Gradients) -> Self::Patch {
        (self.0.fit(gradients), self.1.fit(gradients))
    }
}

impl<A: Surface, B: Surface> Surface for (A, B) {
    type Value = (A::Value, B::Value);

    #[inline(always)]
    fn at(&self, point: &Point) -> Self::Value {
        (self.0.at(point), self.1.at(point))
    }
}

impl<const N: usize, const CH: usize, const BITS: u32> Nodes<N, CH, BITS> {
    /// The sum of the nodes with these weights, Q2.30.
    #[inline(always)]
    fn blend(&self, weights: [i32; N]) -> [i64; CH] {
        let mut values = self.bias.map(i64::from);
        for (value, nodes) in values.iter_mut().zip(&self.values) {
            let sum = nodes.iter().zip(weights).map(|(&node, weight)| i64::from(node) * i64::from(weight)).sum::<i64>();
            *value += sum >> SHARE.saturating_sub(self.extra);
        }
        values
    }
}

impl<const CH: usize, const BITS: u32> Nodes<3, CH, BITS> {
    /// The plane through the nodes, for loops. Domain: the range of the nodes and the fraction bits that they are walked with have 32 bits together. Error:
    /// 2^[`COARSER`] units of a walked value, besides what the coordinates are off.
    #[inline(always)]
    pub(crate) fn slant(&self) -> Slant<CH> {
        let left = self.extra + (32 - SHARE) - COARSER;
        let mut plane = Slant { base: self.bias, along: [[0; 2]; CH] };
        each_channel::<CH>(|channel| {
            let [a, b, c] = self.values[channel];
            plane.base[channel] = plane.base[channel].wrapping_add(a << self.extra);
            plane.along[channel] = [(b - a) << left, (c - a) << left];
        });
        plane
    }
}

impl<const CH: usize, const BITS: u32> Surface for Nodes<3, CH, BITS> {
    type Value = [u32; CH];

    #[inline(always)]
    fn at(&self, point: &Point) -> [u32; CH] {
        self.blend(point.0).map(|value| value as u32)
    }
}

impl<const CH: usize, const BITS: u32> Surface for Nodes<6, CH, BITS> {
    type Value = [u32; CH];

    #[inline(always)]
    fn at(&self, point: &Point) -> [u32; CH] {
        self.blend(point.six()).map(|value| value as u32)
    }
}
