//! The program that draws a mesh, the common chips that have room for it, and how far the mesh must be simplified otherwise.

use anyhow::{Context, Result};
use embedded_graphics_core::geometry::Size;
use microphong::{Layout, Stream, format::GeometricError};
use microphong_render::board::Board;
use microphong_sim::{
    bytes::StreamBytes,
    chip::Chip,
    convert::{Converted, Largest, Options, Steps},
    levels,
    look::Look,
    program::{self, Features},
    quantise::Part,
    render::{self, Format, ROWS},
    shader::Shader,
};
use serde::Serialize;

/// The commonest display, where no other picture is named.
const USUAL: (u32, u32) = (320, 240);

/// The picture of a program.
#[derive(Clone, Copy)]
pub(super) struct Picture {
    /// Width and height.
    pub(super) size: (u32, u32),
    /// Rows of a band.
    rows: u32,
    format: Format,
}

impl Picture {
    /// The picture of this size, or else of this board, or else of the commonest display.
    pub(super) fn new(size: Option<(u32, u32)>, board: Option<Board>, format: Format) -> Self {
        let (its_size, rows) = board.map_or((USUAL, ROWS), |board| (board.size(), board.budget().layout.rows as u32));
        Self { size: size.unwrap_or(its_size), rows, format }
    }

    /// The layout for a program that draws a stream.
    pub(super) fn layout(&self, stream: &Stream<'_>) -> Result<Layout> {
        render::program_layout(stream, Shader::of(stream)?, Size::new(self.size.0, self.size.1), self.rows)
    }

    /// The common chip with the most room for a program with a stream, this layout and nothing else, and the share that the program takes of it.
    pub(super) fn roomiest(&self, stream: &Stream<'_>, layout: &Layout) -> Result<(Chip, f64)> {
        let bytes = [stream.header.length as usize, self.format.bytes(layout).into_iter().sum()];
        let loads = program::loads(Features::needed_by(stream, self.format), Shader::of(stream)?, self.format, bytes)?;
        loads.into_iter().min_by(|one, other| one.1.total_cmp(&other.1)).context("there is no chip")
    }
}

/// What --simplify does, or would do.
#[derive(Serialize)]
pub(super) struct Simplified {
    pub(super) before: usize,
    error: f64,
    /// The error in pixels, at most, in a picture of this size.
    pixels: f64,
    size: (u32, u32),
    /// Whether only some triangles were measured, so that the error may be larger.
    is_estimate: bool,
}

impl Simplified {
    /// The error of a simplified mesh in the largest picture that `--lod` names.
    pub(super) fn new(
        levels::Simplified { before, error, is_estimate }: levels::Simplified,
        look: &Look,
        parts: &[Part],
        pictures: &[(u32, u32)],
    ) -> Self {
        let size = pictures.iter().copied().max_by_key(|&(width, height)| u64::from(width) * u64::from(height)).unwrap_or(USUAL);
        // That which half a pixel is at the nearest point of the mesh. It is never more than that, so that these pixels are never too few.
        let half: f64 = look.tolerance(parts, size).max(GeometricError::DELTA).into();
        Self { before, error, pixels: 0.5 * error / half, size, is_estimate }
    }

    /// The error in words.
    pub(super) fn text(&self) -> String {
        let Self { error, pixels, size: (width, height), is_estimate, .. } = self;
        let about = if *is_estimate { "about" } else { "at most" };
        format!("{about} {error:.4} units from the mesh, {pixels:.1} pixels in a picture of {width}x{height}")
    }
}

/// The largest simplified mesh for which a board or chip has room.
#[derive(Serialize)]
pub(super) struct Remedy {
    /// Its name.
    fits: &'static str,
    /// The number of triangles for --simplify.
    triangles: usize,
    #[serde(flatten)]
    simplified: Simplified,
}

impl Remedy {
    /// Searches it for the board or chip of this name; `None` if there is room for no simplified mesh. The loads are the shares of it that the stream
    /// takes without simplification, and that another stream takes.
    pub(super) fn search(
        (converted, options): (&Converted, &Options),
        name: &'static str,
        loads: (f64, &dyn Fn(StreamBytes) -> Result<f64>),
        steps: &dyn Steps,
    ) -> Result<Option<Self>> {
        let largest = converted.largest(options, loads, steps)?;
        Ok(largest.map(|Largest { most, parts, simplified }| Self {
            fits: name,
            triangles: most,
            simplified: Simplified::new(simplified, &converted.look, &parts, &options.levels),
        }))
    }

    /// The remedy in words.
    pub(super) fn text(&self) -> String {
        format!("--simplify {} makes it fit {}: {}", self.triangles, self.fits, self.simplified.text())
    }
}
