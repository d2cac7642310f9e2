//! The scene on the display. The test `examples` draws it on your computer.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use microphong::{Layout, Picture, RenderError, Renderer, Shader, Stream, include_stream};

/// Pictures are 320 pixels wide and drawn 24 rows at a time. There is room for all vertices and triangles of the teapot, and one material.
pub(crate) const LAYOUT: Layout = Layout::new(320, 24).vertices(529).triangles(992);
/// The mesh is read in place from flash.
pub(crate) static MESH: &[u8] = include_stream!("../teapot.tri");

pub(crate) fn renderer<'a>(stream: Stream<'a>, memory: &'a mut [u64]) -> Result<Renderer<'a, Rgb565>, RenderError> {
    // `convert` selects the method `auto` by default. The program contains only the code of the methods in this list.
    Renderer::new(stream, Size::new(320, 240), &LAYOUT, memory, &[Shader::AUTO])
}

pub(crate) fn picture<'r, 'a>(
    renderer: &'r mut Renderer<'a, Rgb565>,
    band: &'r mut [Rgb565],
    number: u32,
) -> Result<Picture<'r, 'a, Rgb565>, RenderError> {
    Picture::new(renderer, band, number)
}
