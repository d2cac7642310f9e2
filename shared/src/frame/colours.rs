//! The part of a frame that depends on the pixel format: colours of materials, and loops that write them.

use crate::{
    frame::context::{Context, PlacedMesh},
    mesh::Drawing,
    pixel::{Output, Pixel},
    shader::{Shader, TriangleLoops},
};

/// How light becomes pixels, from frame to frame.
#[derive(Debug)]
pub(crate) struct ColourSettings<C: Pixel> {
    pub(crate) shader: Shader<C>,
    /// Dither and the curve of the display, also for the pass that makes pixels of the display of a finished band.
    pub(crate) output: Output,
}

/// How light becomes pixels in one frame.
#[derive(Debug)]
pub(crate) struct Colours<'r, C: Pixel> {
    pub(crate) settings: &'r ColourSettings<C>,
    /// Tables of colours, one for each material.
    pub(crate) ramps: &'r [C::Ramps],
}

impl<'r, C: Pixel> Colours<'r, C> {
    /// What the triangles of `placed` have in common in a band of which these `columns` are wanted, and the loops that draw them.
    #[inline(never)]
    pub(crate) fn drawing<'s>(
        &'s self,
        context: &'s Context<'r>,
        placed: &PlacedMesh<'s>,
        columns: [u16; 2],
    ) -> Option<(Drawing<'s, C>, TriangleLoops<C>)> {
        let ColourSettings { shader, output } = self.settings;
        let (pass, ramps) = (context.pass(placed, columns)?, self.ramps.get(placed.material)?);
        let drawing = Drawing { pass, ramps, output: *output };
        let loops = shader.loops(drawing.style());
        Some((drawing, loops))
    }
}
