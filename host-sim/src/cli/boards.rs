//! What each board's firmware can draw. A build without emulators knows it as well.

use anyhow::{Result, bail, ensure};
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use microphong::{Light, Outlines, RenderError, Renderer, Stream};
use microphong_render::board::{Board, budget::Budget};
use microphong_sim::shader::Shader;
use std::{error::Error, fmt};

/// A board has no room for a stream, but would take a smaller one.
#[derive(Debug)]
pub(super) struct TooLarge {
    name: &'static str,
    length: usize,
    room: usize,
}

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, length, room } = self;
        write!(f, "the stream has {length} bytes, and {name} has room for {room}")
    }
}

impl Error for TooLarge {}

/// What the firmware of `board` has in place of a method that it lacks.
pub(super) fn lacks(board: Board, shader: Shader) -> Option<String> {
    let names: Vec<_> = board.shaders().iter().map(|shader| shader.name()).collect();
    (!board.has(shader)).then(|| format!("the firmware of {board} has no {}; it has {}", shader.name(), names.join(", ")))
}

/// Refuses a stream that the firmware of `board` would refuse, or that does not fit the board.
pub(super) fn check(board: Board, stream: &Stream<'_>) -> Result<()> {
    let (name, Budget { height, layout }) = (board.name(), board.budget());
    ensure!(board.has_text() || stream.labels.is_empty(), "the firmware of {name} has no fonts; remove the labels");
    ensure!(
        !stream.lights.iter().any(Light::has_shape),
        "the firmware of {name} has no lights with a range or a cone, and no light from the sky; remove them, or write a program with the cargo \
             feature light-shapes"
    );
    ensure!(
        Outlines::of(stream.header).is_none(),
        "the firmware of {name} draws no lines along outlines; remove them, or write a program with the cargo feature antialias"
    );
    ensure!(
        stream.corner_colours.is_empty(),
        "the firmware of {name} draws no colours at corners; convert the mesh with --colours none, or write a program with the cargo feature \
             vertex-colours"
    );
    ensure!(
        stream.textures().list.is_empty(),
        "the firmware of {name} draws no textures; convert the mesh with --colours none, or write a program with the cargo feature textures"
    );
    let size = Size::new(layout.width as u32, height as u32);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let shader = Shader::of(stream)?;
    let drawn = Renderer::<Rgb565>::with_shader(*stream, size, &layout, &mut memory, shader.on())
        .and_then(|mut renderer| renderer.frame(0).next_band(&mut vec![Rgb565::default(); layout.band()]));
    match drawn {
        Ok(_) => {}
        Err(RenderError::TooFewHighlightTables { need }) => bail!(
            "the scene has {need} kinds of highlights, but the firmware of {name} has room for {}; use fewer exponents, or --shader gouraud, \
                 which needs no room for them",
            layout.highlight_tables
        ),
        Err(RenderError::Materials { need }) => bail!(
            "the scene has {need} materials, but the firmware of {name} has room for {}; use fewer materials, or --colour for one",
            layout.materials
        ),
        Err(RenderError::Objects { need }) => {
            bail!("the scene has {need} objects, but the firmware of {name} has room for {}; remove some", layout.objects)
        }
        Err(error) => bail!("the firmware of {name} cannot draw it: {error}"),
    }
    let length = stream.header.length as usize;
    match board.room().filter(|&room| length > room) {
        Some(room) => Err(TooLarge { name, length, room }.into()),
        None => Ok(()),
    }
}

/// The share of the memory of `board` for streams that a stream takes.
pub(super) fn load(board: Board, stream: &Stream<'_>) -> f64 {
    board.room().map_or(0.0, |room| f64::from(stream.header.length) / room as f64)
}
