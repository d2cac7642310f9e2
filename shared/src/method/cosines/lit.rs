//! Pixel shaders under constant lights: a method computes light from walked values, and a material has colours for it.
//!
//! What a method does at a pixel is one [`AtPixel`], and one [`FromValues`] for a light with a highlight and one for a light without. All else is
//! here: one light or two, and colours from a table or from sums.

use crate::{
    lighting::constant_lights::{Coloured, KERNEL_BITS, Shades, SurfaceColour},
    pixel::by_rows::ByRows,
    raster::pixel_shader::{PixelShader, has_kernels},
};
use core::marker::PhantomData;
use microphong_kernels as kernels;

/// What a method computes at a pixel for all lights together, such as a reciprocal length.
pub(super) trait AtPixel<V>: Copy {
    /// What it has computed.
    type Common;
    /// The values of the lights.
    type Values;

    /// Fraction bits of a diffuse level.
    const BITS: u32;

    /// Divides walked values into what all lights have in common and the values of the lights.
    fn at(&self, value: V) -> (Self::Common, Self::Values);

    /// Whether walked values are planes, and the square of the length by which light is divided. Kernels in assembler walk such values.
    const IS_QUOTIENT: bool = false;

    /// Where kernels look up light.
    #[inline]
    fn lookup(&self) -> Option<kernels::Lookup<'_>> {
        None
    }
}

/// A light that a method makes of its values `V` at a pixel, and of `M`, which all lights have in common there.
pub(super) trait FromValues<M, V>: Copy {
    /// Number of the loop, see [`PixelShader::ID`].
    const ID: u8 = 0;

    /// Computes the light. `full` is the level of diffuse light at cosine 1, see
    /// [`LitColours::diffuse`](crate::lighting::constant_lights::LitColours::diffuse).
    fn from_values(common: &M, full: u16, values: V) -> Self;
}

/// Two lights.
impl<M, A: FromValues<M, V>, B: FromValues<M, W>, V, W> FromValues<M, (V, W)> for (A, B) {
    fn from_values(common: &M, full: u16, (one, two): (V, W)) -> Self {
        (A::from_values(common, full, one), B::from_values(common, full, two))
    }
}

/// Light on a surface whose colour is walked beside it.
impl<M, L: FromValues<M, V>, V, S: SurfaceColour> FromValues<M, (V, S)> for Coloured<L> {
    #[inline(always)]
    fn from_values(common: &M, full: u16, (values, colour): (V, S)) -> Self {
        Self(L::from_values(common, full, values), colour.shares())
    }
}

/// Light `L` that a method computes at the pixel, in the colours of a material.
#[derive(Clone, Copy)]
pub(super) struct LitShader<T, K, L> {
    colours: T,
    at: K,
    light: PhantomData<L>,
}

impl<T, K> LitShader<T, K, ()> {
    /// A shader for lights with highlights where `L` is [`WithHighlight`](crate::lighting::constant_lights::WithHighlight), and for lights without
    /// where it is [`DiffuseOnly`](crate::lighting::constant_lights::DiffuseOnly). For two lights it is a pair.
    pub(super) fn of<L>(colours: T, at: K) -> LitShader<T, K, L> {
        LitShader { colours, at, light: PhantomData }
    }
}

impl<T: ByRows, K: Copy, L: Copy> ByRows for LitShader<T, K, L> {
    fn step_row(&mut self) {
        self.colours.step_row();
    }
}

impl<V, T: Shades<L>, K: AtPixel<V>, L: FromValues<K::Common, K::Values>> PixelShader<V> for LitShader<T, K, L> {
    type Pixel = T::Pixel;

    const CHEAP: bool = T::TABLED;

    const TRANSPARENT: bool = T::TRANSPARENT;

    const ID: u8 = L::ID;

    #[inline(always)]
    fn shade(&self, value: V) -> T::Pixel {
        let (common, values) = self.at.at(value);
        self.colours.colour(K::BITS, L::from_values(&common, self.colours.diffuse(), values))
    }

    const KERNEL: Option<[usize; 2]> = if has_kernels::<T::Pixel>() && K::IS_QUOTIENT && K::BITS == KERNEL_BITS && T::NUMERATORS > 0 {
        Some([T::NUMERATORS, 1])
    } else {
        None
    };

    #[inline]
    fn lit(&self) -> Option<kernels::Lit<'_>> {
        self.colours.lit(self.at.lookup()?)
    }
}
