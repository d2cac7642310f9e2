//! The scene on the display. The test `examples` draws it on your computer.

use core::fmt::Write;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_9X15_BOLD};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*, text::Text};
use microphong::{Layout, Picture, RenderError, Renderer, Shader, Stats, Stream, include_stream};

/// Pictures 240 pixels wide, 40 rows at once, and all of the bunny.
pub(crate) const LAYOUT: Layout = Layout::new(240, 40).vertices(1839).triangles(3674).active_triangles(128);
/// Read in place: the mesh stays in flash.
pub(crate) static MESH: &[u8] = include_stream!("../bunny.tri");

pub(crate) fn renderer<'a>(stream: Stream<'a>, memory: &'a mut [u64]) -> Result<Renderer<'a, Rgb565>, RenderError> {
    Renderer::new(stream, Size::new(240, 240), &LAYOUT, memory, &[Shader::AUTO])
}

/// The picture with a text over it: the frames per second, if they are known.
pub(crate) fn picture<'r>(
    renderer: &'r mut Renderer<'_, Rgb565>,
    band: &'r mut [Rgb565],
    number: u32,
    rate: Option<u64>,
) -> Result<impl Drawable<Color = Rgb565, Output = Stats>, RenderError> {
    let mut text = heapless::String::<24>::new();
    // The longest number has 20 digits: there is room.
    let _ = if let Some(rate) = rate { write!(text, "{rate} fps") } else { text.write_str("-- fps") };
    Ok(Picture::new(renderer, band, number)?.over(move |band| {
        let Ok(_) = Text::new(&text, Point::new(7, 17), MonoTextStyle::new(&FONT_9X15_BOLD, Rgb565::YELLOW)).draw(band);
    }))
}
