//! `microphong size`.

use super::{
    Outcome, Usage, features,
    mesh_options::MeshOptions,
    parse::{self, Several},
    report, scenes,
};
use anyhow::Result;
use microphong::features::Feature;
use microphong_sim::{
    bench::size::{Size, baseline, measure, picture},
    chip::Chip,
    program::{Entry, FORMATS, Features, Program, SHADERS},
    render::Format,
    scene::Scene,
    shader::Shader,
};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Show flash, RAM and stack of whole programs, and whether they fit into chips
///
/// The command builds a program for each method and pixel format. The programs have no display driver and no log; add their sizes. Flash and RAM are
/// the sizes of the compiled program, including the memory for the mesh. The stack is the largest one that an emulated processor used in one turn.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// A .tri, .obj, .stl, .ply, .gltf, .glb, .3mf or .toml file, or a built-in scene.
    #[arg(value_name = "SCENE", default_value = baseline::SCENE)]
    scene: String,
    /// Chips, separated by commas: stm32f103 (Cortex-M3), samd21, rp2040 (Cortex-M0+), stm32f411, nrf52840 (Cortex-M4F), rp2350 (Cortex-M33),
    /// esp32-c3 (RISC-V); or all.
    #[arg(long, value_name = "C,...", default_value = "stm32f103", value_parser = chips)]
    chip: Several<Chip>,
    /// Shading methods, separated by commas: gouraud, auto-linear, phong, auto; or all.
    #[arg(long, value_name = "S,...", default_value = "all", value_parser = shaders)]
    shader: Several<Shader>,
    /// Pixel formats, separated by commas: rgb565, at 240x240 in bands of 16 rows; binary, at 128x64 in bands of 8 rows; or all.
    #[arg(long, value_name = "F,...", default_value = "all", value_parser = formats)]
    format: Several<Format>,
    /// Cargo features of microphong in the programs, separated by commas: default; none, if the scene needs none; or all. By default these are the
    /// least that the scene needs.
    #[arg(long, value_name = "F,...", value_parser = choices)]
    features: Option<Several<Features>>,
    /// Print one JSON object per program and chip.
    #[arg(long)]
    json: bool,
    /// Measure the programs that FILE lists. Fail if a program takes over 0.2 % more than FILE records.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "MeshOptions", "chip", "shader", "format", "features", "json"])]
    check: Option<PathBuf>,
    /// Measure the programs that FILE lists, and record their sizes there. Needs --reason.
    #[arg(long, value_name = "FILE", requires = "reason", conflicts_with_all = ["scene", "MeshOptions", "chip", "shader", "format", "features", "json", "check"])]
    renew: Option<PathBuf>,
    /// The reason for the changed sizes, in a sentence. With --renew sizes.csv it is added to sizes-reasons.md.
    #[arg(long, value_name = "TEXT", requires = "renew", value_parser = parse::reason)]
    reason: Option<String>,
    #[command(flatten)]
    options: Option<MeshOptions>,
}

const EXAMPLES: &str = "\
Examples:
  microphong size                                         the teapot on an STM32F103
  microphong size part.obj --chip rp2040 --format rgb565  your own mesh
  microphong size --chip all --json                       all chips, methods and formats
  microphong size --check tests/baselines/sizes.csv       check that no program has grown";

fn chips(text: &str) -> Result<Several<Chip>, String> {
    parse::several(text, &Chip::ALL, |text| parse::among(text, &Chip::ALL, |chip| chip.name))
}

fn shaders(text: &str) -> Result<Several<Shader>, String> {
    parse::several(text, &SHADERS, |text| parse::among(text, &SHADERS, Shader::name))
}

fn formats(text: &str) -> Result<Several<Format>, String> {
    parse::several(text, &FORMATS, |text| parse::format_among(text, &FORMATS))
}

fn choices(text: &str) -> Result<Several<Features>, String> {
    parse::several(text, &Features::ALL, |text| parse::among(text, &Features::ALL, |features| features.name()))
}

/// A program on a chip.
#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    chip: &'a str,
    core: &'a str,
    features: &'a str,
    shader: &'a str,
    format: &'a str,
    width: u32,
    height: u32,
    band_rows: usize,
    #[serde(flatten)]
    size: Size,
    chip_flash_bytes: u64,
    chip_ram_bytes: u64,
    fits: bool,
}

impl<'a> Line<'a> {
    fn new(scene: &'a str, chip: &Chip, program: Program, size: Size) -> Self {
        let (width, height, band_rows) = picture(program.format);
        let fits = chip.load(size.flash_bytes + size.mesh_bytes, size.ram_bytes + size.stack_bytes) <= 1.0;
        let [chip_flash_bytes, chip_ram_bytes] = [chip.flash_bytes, chip.ram_bytes];
        let (shader, format) = (program.shader.name(), program.format.name());
        Self {
            scene,
            chip: chip.name,
            core: chip.core.name(),
            features: program.features.name(),
            shader,
            format,
            width,
            height,
            band_rows,
            size,
            chip_flash_bytes,
            chip_ram_bytes,
            fits,
        }
    }

    fn text(&self) -> Result<()> {
        let Size { flash_bytes, mesh_bytes, ram_bytes, stack_bytes } = self.size;
        let [flash, with_mesh, ram, stack] = [flash_bytes, flash_bytes + mesh_bytes, ram_bytes, stack_bytes].map(report::grouped);
        let fits = if self.fits { "yes" } else { "no" };
        report::line(&format!(
            "  {:<12} {:<7} {:<8} {flash:>9} {with_mesh:>10} {ram:>8} {stack:>8}  {fits}",
            self.shader, self.format, self.features
        ))
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    if let Some(path) = &arguments.check {
        return check(path);
    }
    if let (Some(path), Some(reason)) = (&arguments.renew, &arguments.reason) {
        return renew(path, reason);
    }
    let scene = scenes::load(&arguments.scene, arguments.options.as_ref(), Format::Rgb565)?;
    let mut cores: Vec<_> = Vec::new();
    for chip in &arguments.chip.values {
        if !cores.contains(&chip.core) {
            cores.push(chip.core);
        }
    }
    let features = features_of(&scene, arguments)?;
    let programs = Program::all(&cores, &features, &arguments.shader.values, &arguments.format.values);
    let bar = report::progress(programs.len() as u64, "building and measuring programs");
    let sizes = measure(&programs, &scene, &|| bar.inc(1))?;
    bar.finish_and_clear();
    for chip in &arguments.chip.values {
        if !arguments.json {
            let [flash, ram] = [chip.flash_bytes, chip.ram_bytes].map(report::grouped);
            report::line(&format!("{}, {} on {} ({flash} bytes of flash, {ram} of RAM)", scene.name, chip.core.title(), chip.name))?;
            report::line(&format!(
                "  {:<12} {:<7} {:<8} {:>9} {:>10} {:>8} {:>8}  fits",
                "method", "format", "features", "flash", "with mesh", "RAM", "stack"
            ))?;
        }
        for (program, size) in programs.iter().zip(&sizes).filter(|(program, _)| program.core == chip.core) {
            let line = Line::new(&scene.name, chip, *program, *size);
            if arguments.json { report::json(&line)? } else { line.text()? }
        }
    }
    Ok(Outcome::Done)
}

/// The cargo features of programs that draw `scene`.
fn features_of(scene: &Scene, arguments: &Arguments) -> Result<Vec<Features>> {
    let stream = scene.stream.parse()?;
    let mut needs: Vec<_> = arguments.format.values.iter().flat_map(|&format| features::names(&stream, format)).collect();
    needs.sort_unstable();
    needs.dedup();
    // What no measured program has.
    let lacking = [
        (Feature::LightShapes, "these lights"),
        (Feature::Antialias, "the lines along outlines"),
        (Feature::VertexColours, "the colours, by convert --colours none"),
        (Feature::Textures, "the textures, by convert --colours none"),
        (Feature::Transparency, "what is seen through surfaces, by convert --opaque"),
    ];
    for (feature, what) in lacking {
        let name = feature.name();
        if needs.contains(&name) {
            let text = format!("{} needs the cargo feature {name}, which the measured programs lack; remove {what}", scene.name);
            return Err(Usage(text).into());
        }
    }
    let least = if needs.is_empty() { Features::None } else { Features::Default };
    let Some(features) = &arguments.features else { return Ok(vec![least]) };
    if least == Features::Default && features.values.contains(&Features::None) {
        let text = format!("{} needs the cargo features {}: use --features default", scene.name, needs.join(", "));
        return Err(Usage(text).into());
    }
    Ok(features.values.clone())
}

/// What a file lists, as recorded and as measured now.
fn again(path: &Path) -> Result<[Vec<Entry>; 2]> {
    let recorded = baseline::read(path)?;
    let bar = report::progress(recorded.len() as u64, "building and measuring programs");
    let measured = baseline::again(&recorded, &|| bar.inc(1))?;
    bar.finish_and_clear();
    Ok([recorded, measured])
}

/// Changes beyond the tolerance, and whether they are growth.
fn changes([recorded, measured]: &[Vec<Entry>; 2]) -> Vec<(String, bool)> {
    recorded.iter().zip(measured).flat_map(|(was, is)| baseline::changes(is, was)).collect()
}

fn check(path: &Path) -> Result<Outcome> {
    let figures = again(path)?;
    let changes = changes(&figures);
    changes.iter().try_for_each(|(text, _)| report::line(text))?;
    let grown = changes.iter().filter(|(_, grown)| *grown).count();
    let renew = format!("if this is intended, renew the file: microphong size --renew {} --reason \"...\"", path.display());
    match (grown, changes.len()) {
        (0, 0) => report::line(&format!("the sizes of {} programs are as recorded", figures[0].len()))?,
        (0, shrunk) => report::line(&format!("{shrunk} figures have shrunk, which would hide later growth; {renew}"))?,
        (grown, _) => report::line(&format!("{grown} figures have grown; {renew}"))?,
    }
    Ok(if grown > 0 { Outcome::Differences } else { Outcome::Done })
}

fn renew(path: &Path, reason: &str) -> Result<Outcome> {
    let figures = again(path)?;
    let [recorded, measured] = &figures;
    if recorded == measured {
        report::line(&format!("the sizes of {} programs are exactly as recorded: nothing to renew", recorded.len()))?;
        return Ok(Outcome::Done);
    }
    changes(&figures).iter().try_for_each(|(text, _)| report::line(text))?;
    let reasons = baseline::renew(path, [recorded, measured], reason)?;
    report::line(&format!("{} programs recorded in {}, the reason in {}", measured.len(), path.display(), reasons.display()))?;
    Ok(Outcome::Done)
}
