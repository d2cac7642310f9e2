//! Transparent surfaces: a pixel keeps a part of the colour that it had before.
//!
//! The loops of pixels know nothing of it. They draw a transparent row in runs of 16 pixels into a buffer, with a copy of the depth. Where the depth has
//! changed, the pixels of the buffer are mixed with those of the band. The depth of the band stays, so that a surface behind a transparent one can be drawn
//! later. All transparent triangles are drawn after the others.

use crate::{
    features::TRANSPARENT,
    pixel::{Pixel, gamma::Gamma},
};

/// Number of pixels that are drawn at once.
pub(crate) const RUN: usize = 16;

/// A value for transparent surfaces: there is room for none in a program without the feature.
pub type IfTransparent<T> = [T; TRANSPARENT];

/// How a surface lets through what is behind it.
#[derive(Clone, Copy, Debug)]
pub struct Glass {
    /// The part of the light from behind that it lets through, in units of 1/128.
    share: u32,
    /// The curve of the display.
    gamma: Option<&'static Gamma>,
}

impl Glass {
    /// A surface that lets through so many sixteenths of the light from behind.
    pub(crate) fn new(sixteenths: u8, gamma: Option<&'static Gamma>) -> Self {
        Self { share: u32::from(sixteenths) * 8, gamma }
    }

    /// The colour of the surface in front of a colour.
    #[inline(always)]
    pub(crate) fn over<C: Pixel>(self, surface: C, behind: C) -> C {
        surface.mixed_with(behind, self.share, self.gamma)
    }
}

/// The surface that is drawn, and room for a run of its pixels.
#[derive(Debug)]
pub struct Sheet<C> {
    /// `None` if nothing is seen through it.
    pub(crate) glass: Option<Glass>,
    pixels: [C; RUN],
    depth: [u16; RUN],
}

impl<C: Pixel> Default for Sheet<C> {
    fn default() -> Self {
        Self { glass: None, pixels: [C::pack([0; 3]); RUN], depth: [0; RUN] }
    }
}

impl<C: Pixel> Sheet<C> {
    /// Copies the depth of a run. There are none if depth is not tested.
    #[inline]
    pub(crate) fn put_depth(&mut self, depth: &[u16]) {
        self.depth.iter_mut().zip(depth).for_each(|(to, &from)| *to = from);
    }

    /// Room for the pixels of a run, and the copy of its depth.
    #[inline]
    pub(crate) fn run(&mut self) -> (&mut [C], &mut [u16]) {
        (&mut self.pixels, &mut self.depth)
    }

    /// Mixes the run that has been drawn with the `pixels` of the band, which have this `depth`.
    #[inline(never)]
    pub(crate) fn show(&self, pixels: &mut [C], depth: &[u16]) {
        let Some(glass) = self.glass else { return };
        let surface = self.pixels.iter().zip(pixels);
        // Loops without a test draw every pixel: none of them has holes.
        if depth.is_empty() {
            surface.for_each(|(&surface, pixel)| *pixel = glass.over(surface, *pixel));
            return;
        }
        for ((&surface, pixel), (new, old)) in surface.zip(self.depth.iter().zip(depth)) {
            // A pixel that passes the test changes its depth.
            if new != old {
                *pixel = glass.over(surface, *pixel);
            }
        }
    }
}
