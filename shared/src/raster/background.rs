//! Filling of bands with the background, before triangles are drawn.

use crate::{
    pixel::{Pixel, colour::colour},
    raster::{band::fill_pixels, gradient},
    scene::Background,
};
use embedded_graphics_core::primitives::Rectangle;

impl Background {
    /// Fills the band `area` of a picture of `height` rows.
    pub(crate) fn fill<C: Pixel>(self, pixels: &mut [C], area: Rectangle, height: u32) {
        match self {
            Self::Colour(rgb) => fill_pixels(pixels, colour(rgb)),
            Self::Gradient { top, bottom } => gradient::fill([top, bottom], pixels, area, height),
        }
    }
}
