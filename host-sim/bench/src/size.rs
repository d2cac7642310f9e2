//! Flash, RAM and stack of whole programs, counted from the programs of the package `size`, which are built for it. They have one method, one pixel
//! format, no display driver and no log.

pub mod baseline;

use anyhow::{Context, Result};
use embedded_graphics_core::geometry;
use microphong::Stream;
use microphong_boards::{Board, build::releases, check, elf::Elf, stack, verify};
use microphong_models::scene::Scene;
use microphong_render::{
    chip::Core,
    program::{Features, Program},
    render::{self, Format},
    shader::Shader,
};
use rayon::prelude::*;
use serde::Serialize;

/// Frames that are drawn to measure the stack: a turn of the built-in scenes.
const FRAMES: u16 = 120;

/// The board on which programs for a processor are executed; a Cortex-M3 executes code for a Cortex-M0+ as well.
const fn board(core: Core) -> Board {
    match core {
        Core::CortexM0Plus | Core::CortexM3 => Board::Mps2An385,
        Core::CortexM4F => Board::Mps2An386,
        Core::CortexM33 => Board::Mps2An505,
        Core::RiscV => Board::RiscvVirt,
    }
}

/// Width and height of the display of this format whose memory is counted, and rows of a band.
#[must_use]
pub const fn picture(format: Format) -> (u32, u32, usize) {
    if matches!(format, Format::Binary) { (128, 64, 8) } else { (240, 240, 16) }
}

/// Bytes that a program takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Size {
    /// Code, constants and initial values, without a mesh.
    pub flash_bytes: u64,
    /// The mesh.
    pub mesh_bytes: u64,
    /// Static variables: the memory of the renderer with room for all of the mesh, a band and the rest.
    pub ram_bytes: u64,
    /// The stack that all frames have used.
    pub stack_bytes: u64,
}

/// Builds the `programs`, measures each with the mesh of `scene`, and calls `tick` after each.
///
/// # Errors
/// When an emulator is missing, or a program does not compile or cannot draw the scene.
pub fn measure(programs: &[Program], scene: &Scene, tick: &(dyn Fn() + Sync)) -> Result<Vec<Size>> {
    let stream = scene.stream.parse()?;
    let bytes = verify::prepare(scene.stream.as_bytes(), Shader::of(&stream)?, stream.header.frames.clamp(1, FRAMES))?;
    programs.iter().try_for_each(|program| check(board(program.core)))?;
    let mut built = Vec::new();
    for (core, features) in Core::ALL.into_iter().flat_map(|core| Features::ALL.map(|features| (core, features))) {
        let of = programs.iter().filter(|program| (program.core, program.features) == (core, features));
        let names: Vec<_> = of.clone().map(|program| program.name()).collect();
        let names: Vec<_> = names.iter().map(String::as_str).collect();
        if names.is_empty() {
            continue;
        }
        let (flags, what) = match features {
            Features::Default => ("full", ""),
            Features::None => ("", " without features"),
        };
        let folder = releases(&["-p", "size"], &names, flags, core.target(), &format!("programs for {}{what}", core.title()))?;
        // Programs with other features take the place of these files.
        for program in of {
            built.push((*program, Elf::read(&folder.join(program.name()))?.with_stream(&bytes)?));
        }
    }
    let measured = programs.par_iter().map(|program| {
        let (_, elf) = built.iter().find(|(built, _)| built == program).context("a program that is not built")?;
        let size = size(*program, elf, &stream);
        tick();
        size.with_context(|| format!("{} by {} on {}", scene.name, program.shader.name(), program.core.title()))
    });
    measured.collect()
}

/// Bytes of the shapes of all lights, for each object.
const SHAPES_OF_LIGHTS: u64 = 128;

fn size(program: Program, elf: &Elf, stream: &Stream<'_>) -> Result<Size> {
    let (width, height, rows) = picture(program.format);
    let layout = render::program_layout(stream, program.shader, geometry::Size::new(width, height), rows as u32)?;
    let mesh_bytes = u64::from(stream.header.length);
    // The program has room for any mesh.
    let room = u64::from(elf.symbol("MEMORY")?.1) + u64::from(elf.symbol("BAND")?.1);
    // This computer's core has the feature `light-shapes`, which the program lacks.
    let shapes = SHAPES_OF_LIGHTS * layout.objects as u64;
    Ok(Size {
        flash_bytes: elf.flash_bytes()? - mesh_bytes,
        mesh_bytes,
        ram_bytes: elf.ram_bytes()? - room + program.format.bytes(&layout).into_iter().sum::<usize>() as u64 - shapes,
        stack_bytes: stack(board(program.core), elf)?,
    })
}
