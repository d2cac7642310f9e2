//! Pixel shaders, which convert walked values to pixels in loops that are compiled for one method and one pixel format.

use crate::{
    interpolate::Patch,
    pixel::{
        Pixel,
        by_rows::{ByRows, ByTurns},
        ramps::Ramps,
        steps,
    },
};
use microphong_kernels::{self as kernels, Plane};

/// Converts the value at a pixel to its colour.
pub trait PixelShader<V>: ByRows {
    /// The pixel that is stored.
    type Pixel: Pixel;

    /// Whether the shader takes so few instructions that a loop without depth test is worth its code.
    const CHEAP: bool = false;

    /// Number of the shader among the method's shaders. It is saved with an active triangle.
    const ID: u8 = 0;

    /// Whether the shader can draw transparent surfaces. It is false for a shader that exists only for kernels, which draw none. Its caller takes another
    /// shader of the same colours there.
    const TRANSPARENT: bool = true;

    /// What is added to all values of the current row; `None` if nothing is, in any row.
    #[inline(always)]
    fn raise(&self) -> Option<V> {
        None
    }

    /// The colour of a value.
    fn shade(&self, value: V) -> Self::Pixel;

    /// The [`Patch::FIELDS`] that a kernel in assembler walks for the shader; `None` if there is no kernel for it, for the pixel format or for the
    /// processor.
    const KERNEL: Option<[usize; 2]> = None;

    /// Whether the kernel also fills rows without a depth test.
    const ALONE: bool = false;

    /// The kernel for fields of which one or more are quadratic.
    #[inline(always)]
    fn lit(&self) -> Option<kernels::Lit<'_>> {
        None
    }

    /// Fills rows by the kernel for linear fields. There is no plane of `depth` without a depth test. Returns the number of pixels between the sides.
    #[inline(always)]
    fn fill<P: Patch>(&self, _pixels: &mut [Self::Pixel], _rows: kernels::Rows<'_>, _depth: &mut [Plane], _patch: &mut P) -> Option<u32> {
        None
    }
}

/// Whether there are kernels that compute light at each pixel of this format.
pub(crate) const fn has_kernels<C: Pixel>() -> bool {
    kernels::LIT_AVAILABLE && C::HAS_KERNELS
}

/// So many planes, if there are kernels for the pixel format and the processor.
const fn linear<C: Pixel>(planes: usize) -> Option<[usize; 2]> {
    if C::HAS_KERNELS { Some([planes, 0]) } else { None }
}

/// One colour for all pixels, as tables of colours hold it for even rows and for odd ones.
#[derive(Clone, Copy, Debug)]
pub struct Solid<C: Pixel>(ByTurns<C::Stored, C>);

impl<C: Pixel> Solid<C> {
    /// A colour for even rows and one for odd rows.
    #[inline(always)]
    pub fn new(colours: [C::Stored; 2]) -> Self {
        Self(ByTurns::new(colours))
    }

    /// The colours of a face, as tables of colours hold them: in even rows all channels are darker. Rows of a large face would show as stripes. So
    /// its green, which has more than half of the luminance, is brighter where red and blue are darker.
    #[inline(always)]
    pub fn face(colours: [C::Stored; 2]) -> Self {
        Self::new(if C::Ramps::CHECKERED { C::greens_exchanged(colours) } else { colours })
    }
}

impl<C: Pixel> ByRows for Solid<C> {
    #[inline(always)]
    fn step_row(&mut self) {
        self.0.step_row();
    }
}

impl<C: Pixel> PixelShader<()> for Solid<C> {
    type Pixel = C;

    const CHEAP: bool = true;

    #[inline(always)]
    fn shade(&self, (): ()) -> C {
        C::from_stored(self.0.now())
    }

    const KERNEL: Option<[usize; 2]> = linear::<C>(0);

    const ALONE: bool = true;

    #[inline(always)]
    fn fill<P: Patch>(&self, pixels: &mut [C], rows: kernels::Rows<'_>, depth: &mut [Plane], _: &mut P) -> Option<u32> {
        C::fill_solid(pixels, rows, depth.first_mut(), self.0.both())
    }
}

/// One walked level, which is the index of a table of colours. Guards at both ends of the table replace a clamp.
#[derive(Clone, Copy, Debug)]
pub struct Ramp<'a, C: Pixel>(pub &'a C::Ramps);

impl<C: Pixel> ByRows for Ramp<'_, C> {}

impl<C: Pixel> PixelShader<[u32; 1]> for Ramp<'_, C> {
    type Pixel = C;

    const CHEAP: bool = true;

    fn shade(&self, [level]: [u32; 1]) -> C {
        C::from_stored(C::walked(self.0, level))
    }

    const KERNEL: Option<[usize; 2]> = linear::<C>(1);

    const ALONE: bool = true;

    #[inline(always)]
    fn fill<P: Patch>(&self, pixels: &mut [C], rows: kernels::Rows<'_>, depth: &mut [Plane], patch: &mut P) -> Option<u32> {
        C::fill_ramp(pixels, rows, depth.first_mut(), patch.planes().first_mut()?, self.0)
    }
}

/// Three walked levels with [`crate::format::CHANNEL`] fraction bits, scaled so that their upper bits are the channels. Half a step for rounding has
/// been added.
///
/// Such channels have no table to choose for dither, and a threshold at each pixel would be three additions. So all levels of a row are raised.
#[derive(Clone, Copy, Debug)]
pub struct Rgb<C>(ByTurns<i32, C>);

impl<C: Pixel> Rgb<C> {
    /// Dithers by rows: levels of even rows are lower by `quarter`, those of odd rows higher, in units of a channel of eight bits.
    #[inline(always)]
    pub fn new(quarter: i32) -> Self {
        Self(ByTurns::new([-quarter, quarter]))
    }
}

impl<C: Pixel> ByRows for Rgb<C> {
    #[inline(always)]
    fn step_row(&mut self) {
        self.0.step_row();
    }
}

impl<C: Pixel> PixelShader<[u32; 3]> for Rgb<C> {
    type Pixel = C;

    #[inline(always)]
    fn raise(&self) -> Option<[u32; 3]> {
        C::Ramps::CHECKERED.then(|| {
            let [r, g, b] = steps(C::DEPTH, self.0.now());
            [r as u32, g as u32, b as u32]
        })
    }

    #[inline(always)]
    fn shade(&self, levels: [u32; 3]) -> C {
        let [r, g, b] = levels;
        C::mixed([r as i32, g as i32, b as i32])
    }

    const KERNEL: Option<[usize; 2]> = linear::<C>(3);

    #[inline(always)]
    fn fill<P: Patch>(&self, pixels: &mut [C], rows: kernels::Rows<'_>, depth: &mut [Plane], patch: &mut P) -> Option<u32> {
        let raise = if C::Ramps::CHECKERED { self.0.now() } else { 0 };
        C::fill_channels(pixels, rows, depth.first_mut()?, patch.planes().first_chunk_mut()?, raise)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};

    /// Rows of a face take the darker red and blue together with the brighter green.
    #[test]
    fn green_is_dithered_against_red_and_blue() {
        let [dark, bright] = [Rgb565::new(10, 20, 30), Rgb565::new(11, 21, 31)];
        let mut shader = Solid::<Rgb565>::face([dark, bright].map(Pixel::stored));
        assert_eq!(shader.shade(()), Rgb565::new(10, 21, 30));
        shader.step_row();
        assert_eq!(shader.shade(()), Rgb565::new(11, 20, 31));
    }

    /// Even rows are lower and odd rows higher, by twice as much in a channel that has one bit less.
    #[test]
    fn channels_are_raised_by_rows() {
        let mut shader = Rgb::<Rgb565>::new(6);
        let lower = [48u32, 24, 48].map(u32::wrapping_neg);
        assert_eq!(shader.raise(), Some(lower));
        shader.step_row();
        assert_eq!(shader.raise(), Some([48, 24, 48]));
        assert_eq!(Rgb::<Rgb888>::new(6).raise(), None);
    }
}
