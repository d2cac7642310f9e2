//! What a program with a scene takes on common chips: estimates, from recorded sizes of whole programs and recorded costs of frames.

use crate::{
    estimate::{self, Counts},
    program,
};
use anyhow::{Context, Result};
use microphong::Stream;
use microphong_render::{
    chip::Chip,
    program::{self as recorded, Features, Program},
    render::Settings,
};
use serde::Serialize;

/// Estimates for all chips.
#[derive(Serialize)]
pub(crate) struct Boards {
    rows: Vec<Row>,
    note: &'static str,
}

/// Estimates for a chip.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Row {
    title: String,
    instructions: Option<f64>,
    /// Frames a second.
    rate: Option<f64>,
    flash: u64,
    flash_room: u64,
    ram: u64,
    ram_room: u64,
}

/// What the page says of the figures.
const NOTE: &str = "All figures are estimates. Instructions are those of a frame with jagged outlines in RGB565, for one object of one or a few materials, \
                    under one or two far lights, of triangles that are not large. They are within 10 % of counted instructions for the ordinary \
                    built-in scenes, and further off for some other meshes. Frames a second are known for the RP2040 alone, on which both processors \
                    draw. Flash and RAM are those of a whole program without the driver of the display.";

/// Estimates what a picture takes.
pub(crate) fn estimated(stream: &Stream<'_>, settings: &Settings, counts: Option<&Counts>) -> Result<Boards> {
    let layout = program::layout(stream, settings)?;
    let memory: usize = settings.format.bytes(&layout).into_iter().sum();
    let sizes = recorded::recorded()?;
    let row = |chip: Chip| {
        let wanted = Program {
            core: chip.core,
            features: Features::needed_by(stream, settings.format),
            shader: settings.style.shader,
            format: settings.format,
        };
        let entry = sizes.iter().find(|entry| entry.program == wanted.recorded()).with_context(|| format!("no size of {wanted:?}"))?;
        let instructions = counts.map(|counts| counts.instructions(chip.core, settings.style.shader)).transpose()?.flatten();
        Ok(Row {
            title: format!("{}, {}", chip.name, chip.core.title()),
            instructions,
            rate: instructions.and_then(|instructions| estimate::rate(chip.core, instructions)),
            flash: entry.flash + u64::from(stream.header.length),
            flash_room: chip.flash_bytes,
            ram: entry.stack + memory as u64,
            ram_room: chip.ram_bytes,
        })
    };
    Ok(Boards { rows: Chip::ALL.into_iter().map(row).collect::<Result<_>>()?, note: NOTE })
}
