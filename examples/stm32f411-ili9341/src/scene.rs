//! The scene on the display. The test `examples` draws it on your computer.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use microphong::{Layout, Picture, RenderError, Renderer, Shader, Stream, include_stream};

/// Pictures 320 pixels wide, 24 rows at once; room for all vertices and triangles of the teapot, and one material.
pub(crate) const LAYOUT: Layout = Layout::new(320, 24).vertices(529).triangles(992);
/// Read in place: the mesh stays in flash.
pub(crate) static MESH: &[u8] = include_stream!("../teapot.tri");

pub(crate) fn renderer<'a>(stream: Stream<'a>, memory: &'a mut [u64]) -> Result<Renderer<'a, Rgb565>, RenderError> {
    // What `convert` asks for unless told otherwise. The program has the code of the methods in this list and of no others.
    Renderer::new(stream, Size::new(320, 240), &LAYOUT, memory, &[Shader::AUTO])
}

pub(crate) fn picture<'r, 'a>(
    renderer: &'r mut Renderer<'a, Rgb565>,
    band: &'r mut [Rgb565],
    number: u32,
) -> Result<Picture<'r, 'a, Rgb565>, RenderError> {
    Picture::new(renderer, band, number)
}
