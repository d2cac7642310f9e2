//! The scene on the display. The test `examples` draws it on your computer.

use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_5X8};
use embedded_graphics::{pixelcolor::BinaryColor, prelude::*, text::Text};
use microphong::{Layout, Picture, RenderError, Renderer, Shader, Stats, Stream, include_stream, pixel::LightGray};

/// The whole picture in one band, all of the teapot, and its outlines.
pub(crate) const LAYOUT: Layout = Layout::new(128, 64).vertices(593).triangles(992).antialias(true).edges(384);
/// The teapot, white on black: a display of one bit shows no other colours well.
pub(crate) static MESH: &[u8] = include_stream!("../teapot.tri");

/// Triangles have a few pixels here: light that is linear in between is enough. Greys are dithered when they are sent. The stream states white lines
/// along outlines, which show where dark surfaces end.
pub(crate) fn renderer<'a>(stream: Stream<'a>, memory: &'a mut [u64]) -> Result<Renderer<'a, LightGray<1>>, RenderError> {
    Renderer::with_shader(stream, Size::new(128, 64), &LAYOUT, memory, Shader::GOURAUD)
}

/// The picture with a label over it, which is drawn into each band before it is sent.
pub(crate) fn picture<'r>(
    renderer: &'r mut Renderer<'_, LightGray<1>>,
    band: &'r mut [LightGray<1>],
    number: u32,
) -> Result<impl Drawable<Color = BinaryColor, Output = Stats>, RenderError> {
    Ok(Picture::new(renderer, band, number)?.shown_as::<BinaryColor>().over(move |band| {
        let Ok(_) = Text::new("teapot", Point::new(97, 61), MonoTextStyle::new(&FONT_5X8, BinaryColor::On)).draw(band);
    }))
}
