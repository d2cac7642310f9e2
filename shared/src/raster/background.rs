//! What bands are filled with before triangles are drawn.

#[cfg(feature = "gradient")]
use crate::raster::gradient;
use crate::{
    pixel::{Pixel, colour::colour},
    raster::band::fill_pixels,
    scene::Background,
};
use embedded_graphics_core::primitives::Rectangle;

impl Background {
    /// Fills the band `area` of a picture of `height` rows.
    #[cfg_attr(not(feature = "gradient"), expect(unused_variables, reason = "one colour is the same everywhere"))]
    pub(crate) fn fill<C: Pixel>(self, pixels: &mut [C], area: Rectangle, height: u32) {
        match self {
            Self::Colour(rgb) => fill_pixels(pixels, colour(rgb)),
            #[cfg(feature = "gradient")]
            Self::Gradient { top, bottom } => gradient::fill([top, bottom], pixels, area, height),
        }
    }
}
