//! The one loop nest: frame, band, triangle, row.

use crate::{Shader, Stream, pixel::Pixel};
use core::{fmt, marker::PhantomData};
use embedded_graphics_core::{
    geometry::{Point, Size},
    primitives::Rectangle,
};

/// STUB
#[derive(Clone, Copy, Debug)]
pub struct ScreenVertex(u32);
/// STUB
#[derive(Clone, Copy, Debug)]
pub struct Entry(u32);
/// STUB
#[derive(Clone, Copy, Debug)]
pub struct Palette<C>(PhantomData<C>);

/// The memory that rendering takes, borrowed from wherever a program keeps it.
#[derive(Debug)]
pub struct Memory<'a, C> {
    /// Transformed vertices; those that do not fit are transformed anew by each triangle.
    pub vertices: &'a mut [ScreenVertex],
    /// Triangles that face the camera; where they do not fit, each band walks the whole mesh.
    pub bins: &'a mut [Entry],
    /// Depth of one band; its length decides how many rows a band has.
    pub depth: &'a mut [u16],
    /// One per material.
    pub palettes: &'a mut [Palette<C>],
}

/// [`Memory`] in one piece, for a `static`.
#[derive(Debug)]
pub struct Workspace<C, const VERTICES: usize, const TRIANGLES: usize, const DEPTH: usize, const MATERIALS: usize> {
    vertices: [ScreenVertex; VERTICES],
    bins: [Entry; TRIANGLES],
    depth: [u16; DEPTH],
    palettes: [Palette<C>; MATERIALS],
}

impl<C: Pixel, const VERTICES: usize, const TRIANGLES: usize, const DEPTH: usize, const MATERIALS: usize>
    Workspace<C, VERTICES, TRIANGLES, DEPTH, MATERIALS>
{
    /// Empty memory.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            vertices: [ScreenVertex(0); VERTICES],
            bins: [Entry(0); TRIANGLES],
            depth: [0; DEPTH],
            palettes: [Palette(PhantomData); MATERIALS],
        }
    }

    /// Lends the memory to a [`Renderer`].
    pub fn memory(&mut self) -> Memory<'_, C> {
        Memory { vertices: &mut self.vertices, bins: &mut self.bins, depth: &mut self.depth, palettes: &mut self.palettes }
    }
}

/// Why a renderer cannot start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SetupError {
    /// The viewport is empty or larger than [`MAX_SIDE`] on a side.
    Size {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// `depth` does not hold one row.
    Depth {
        /// Entries needed at least.
        need: usize,
    },
    /// Fewer palettes than materials.
    Palettes {
        /// Palettes needed.
        need: usize,
    },
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { width, height } => write!(f, "a picture of {width}x{height} pixels; each side must be 1 to {MAX_SIDE}"),
            Self::Depth { need } => write!(f, "the depth buffer needs {need} entries at least, one row"),
            Self::Palettes { need } => write!(f, "the stream has {need} materials, and each needs a palette"),
        }
    }
}

impl core::error::Error for SetupError {}

/// Largest width and height of a viewport.
pub const MAX_SIDE: u32 = 4096;

/// What a frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stats {
    /// Triangles in the stream.
    pub triangles: u32,
    /// Triangles that face away, lie off screen or cover no pixel centre.
    pub culled: u32,
    /// Triangles that cover a pixel centre of the viewport.
    pub drawn: u32,
    /// Pixels of all drawn triangles, those hidden by depth included.
    pub pixels: u32,
    /// Walks over the mesh: 1, or one per band when the bins overflow.
    pub passes: u32,
    /// Vertices that did not fit and were transformed by each triangle that uses them.
    pub uncached: u32,
}

/// Draws the frames of one stream.
#[derive(Debug)]
pub struct Renderer<'a, C> {
    stream: Stream<'a>,
    size: Size,
    memory: Memory<'a, C>,
    shader: Shader,
    dither: bool,
}

impl<'a, C: Pixel> Renderer<'a, C> {
    /// A renderer for a viewport of `size` pixels.
    ///
    /// # Errors
    /// When `size` is out of range or `memory` too small for it.
    pub fn new(stream: Stream<'a>, size: Size, memory: Memory<'a, C>) -> Result<Self, SetupError> {
        Ok(Self { shader: stream.shader(), stream, size, memory, dither: false })
    }

    /// Uses `shader` instead of the one that the stream asks for.
    pub fn set_shader(&mut self, shader: Shader) {
        self.shader = shader;
    }

    /// The method in use.
    #[must_use]
    pub fn shader(&self) -> Shader {
        self.shader
    }

    /// 4x4 ordered dither on or off; off at first.
    pub fn set_dither(&mut self, dither: bool) {
        self.dither = dither;
    }

    /// The viewport.
    #[must_use]
    pub fn size(&self) -> Size {
        self.size
    }

    /// Rows of a band; the last one of a frame may have fewer.
    #[must_use]
    pub fn band_rows(&self) -> u32 {
        (self.memory.depth.len() as u32 / self.size.width).min(self.size.height)
    }

    /// Places camera and lights, transforms vertices, culls and bins triangles for frame `number` (modulo the orbit).
    pub fn frame(&mut self, number: u32) -> Frame<'_, 'a, C> {
        Frame { renderer: self, number, top: 0 }
    }
}

/// One frame, drawn band by band from the top.
#[derive(Debug)]
pub struct Frame<'r, 'a, C> {
    renderer: &'r mut Renderer<'a, C>,
    number: u32,
    top: u32,
}

impl<C: Pixel> Frame<'_, '_, C> {
    /// Draws the next band into the front of `pixels`, row by row, and returns the area that it fills; `None` after the last.
    ///
    /// The first `area.size.width * area.size.height` entries of `pixels` are the band.
    /// A slice shorter than a band gets fewer rows.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Option<Rectangle> {
        let size = self.renderer.size;
        let rows = self.renderer.band_rows().min(size.height - self.top).min(pixels.len() as u32 / size.width);
        if rows == 0 {
            return None;
        }
        pixels[..(rows * size.width) as usize].fill(C::pack([self.number as u8 & 3, 5, 7]));
        let area = Rectangle::new(Point::new(0, self.top as i32), Size::new(size.width, rows));
        self.top += rows;
        Some(area)
    }

    /// Counts so far; complete after the last band.
    #[must_use]
    pub fn stats(&self) -> Stats {
        Stats::default()
    }
}
