//! Flash, RAM and stack of whole programs, counted from the programs of the package `size`, which are built for it. They have one method, one pixel
//! format, no display driver and no log.

pub mod baseline;
mod chip;

pub use chip::{Chip, Core};

use anyhow::{Context, Result};
use microphong::{Layout, Stream, pixel::Pixel};
use microphong_boards::{build::releases, elf::Elf, stack, verify};
use microphong_models::scene::Scene;
use microphong_render::{
    render::{Format, InFormat},
    shader::Shader,
};
use rayon::prelude::*;
use serde::Serialize;

/// Methods that there are programs with.
pub const SHADERS: [Shader; 4] = [Shader::GOURAUD, Shader::AUTO_LINEAR, Shader::PHONG, Shader::AUTO];
/// Pixel formats that there are programs with.
pub const FORMATS: [Format; 2] = [Format::Rgb565, Format::Binary];
/// Frames that are drawn to measure the stack: a turn of the built-in scenes.
const FRAMES: u16 = 120;

/// A program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program {
    /// The processor that it is compiled for.
    pub core: Core,
    /// Method of the program.
    pub shader: Shader,
    /// Pixel format of the program.
    pub format: Format,
}

impl Program {
    /// All programs for these processors, methods and formats.
    #[must_use]
    pub fn all(cores: &[Core], shaders: &[Shader], formats: &[Format]) -> Vec<Self> {
        let of = |&core: &Core| formats.iter().flat_map(move |&format| shaders.iter().map(move |&shader| Self { core, shader, format }));
        cores.iter().flat_map(of).collect()
    }

    fn name(self) -> String {
        format!("{}-{}", self.shader.name(), self.format.name())
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
    /// The stack that all frames have used; unknown where no emulator is at hand.
    pub stack_bytes: Option<u64>,
}

/// Builds the `programs`, measures each with the mesh of `scene`, and calls `tick` after each.
///
/// # Errors
/// When a program does not compile, or cannot draw the scene.
pub fn measure(programs: &[Program], scene: &Scene, tick: &(dyn Fn() + Sync)) -> Result<Vec<Size>> {
    let stream = scene.stream.parse()?;
    let bytes = verify::prepare(scene.stream.as_bytes(), Shader::of(&stream)?, stream.header.frames.clamp(1, FRAMES))?;
    let mut built = Vec::new();
    for core in Core::ALL {
        let names: Vec<_> = programs.iter().filter(|program| program.core == core).map(|program| program.name()).collect();
        let names: Vec<_> = names.iter().map(String::as_str).collect();
        if !names.is_empty() {
            built.push((core, releases(&names, "", core.target(), &format!("programs for {}", core.title()))?));
        }
    }
    let measured = programs.par_iter().map(|program| {
        let (_, folder) = built.iter().find(|(core, _)| *core == program.core).context("a processor without programs")?;
        let elf = Elf::read(&folder.join(program.name()))?.with_stream(&bytes)?;
        let size = size(*program, &elf, &stream);
        tick();
        size.with_context(|| format!("{} by {} on {}", scene.name, program.shader.name(), program.core.title()))
    });
    measured.collect()
}

fn size(program: Program, elf: &Elf, stream: &Stream<'_>) -> Result<Size> {
    let (width, _, rows) = picture(program.format);
    let layout = Layout::new(width as usize, rows).with_room_for(stream);
    let mesh_bytes = u64::from(stream.header.length);
    // The program has room for any mesh.
    let room = u64::from(elf.symbol("MEMORY")?.1) + u64::from(elf.symbol("BAND")?.1);
    Ok(Size {
        flash_bytes: elf.flash_bytes()? - mesh_bytes,
        mesh_bytes,
        ram_bytes: elf.ram_bytes()? - room + program.format.run(Memory(&layout)),
        stack_bytes: program.core.machine().map(|machine| stack(machine, elf)).transpose()?,
    })
}

/// Bytes of the renderer's memory and of a band.
struct Memory<'a>(&'a Layout);

impl InFormat for Memory<'_> {
    type Output = u64;

    fn in_format<C: Pixel>(self) -> u64 {
        (self.0.bytes::<C>() + self.0.band() * size_of::<C>()) as u64
    }
}
