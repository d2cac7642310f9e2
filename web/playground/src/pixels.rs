//! Pixel formats of the page. Each has loops of its own in the module, so formats that few displays have are left out.

use anyhow::{Result, bail};
use embedded_graphics_core::pixelcolor::{BinaryColor, Gray4, Rgb565, Rgb666, Rgb888};
use microphong::{Stream, pixel::LightGray};
use microphong_render::render::{Format, Picture, Settings, picture_in};

/// The formats that the page offers.
pub(crate) const FORMATS: [Format; 5] = [Format::Rgb565, Format::Rgb888, Format::Rgb666, Format::Gray4, Format::Binary];

/// Draws frame `number` as `microphong render` does.
///
/// # Errors
/// When the size is out of range, or the page does not offer the format.
pub(crate) fn picture(stream: Stream<'_>, settings: &Settings, number: u32) -> Result<Picture> {
    match settings.format {
        Format::Rgb565 => picture_in::<Rgb565, Rgb565>(stream, settings, number),
        Format::Rgb888 => picture_in::<Rgb888, Rgb888>(stream, settings, number),
        Format::Rgb666 => picture_in::<Rgb666, Rgb666>(stream, settings, number),
        Format::Gray4 => picture_in::<LightGray<4>, Gray4>(stream, settings, number),
        Format::Binary => picture_in::<LightGray<1>, BinaryColor>(stream, settings, number),
        format => bail!("this page does not draw {}; microphong render does", format.name()),
    }
}
