//! `microphong bench`.

use super::{
    Outcome,
    parse::{self, Several},
    report,
    verify::load,
};
use anyhow::{Context, Result};
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use microphong::Shader;
use microphong_sim::{
    bench::{self, Measurement, Processor},
    board::elf::Elf,
    render, verify,
};

/// Count the instructions that a board's firmware takes for one frame, stage by stage.
///
/// Exact: QEMU executes the firmware and logs every instruction. Instructions are not cycles. Clearing,
/// checksum and transfer are left out.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// A .tri or .obj file, a built-in scene, or all built-in scenes.
    #[arg(default_value = "peer-sphere")]
    scene: String,
    /// Shading methods, separated by commas, or all.
    #[arg(long, default_value = "flat,gouraud,six-point,phong", value_parser = parse::shaders)]
    shader: Several<Shader>,
    /// mps2-an385 (Cortex-M3) or mps2-an386 (Cortex-M4F).
    #[arg(long, default_value = "mps2-an385", value_parser = board)]
    board: Processor,
    /// Print one JSON object per frame.
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  microphong bench                                   the frame that other renderers are measured with
  microphong bench teapot --shader six-point --json
  microphong bench sphere-690 --board mps2-an386";

/// Boards whose every instruction can be logged.
const BOARDS: [Processor; 3] = [Processor::CortexM3, Processor::CortexM4F, Processor::X86_64];

fn board(text: &str) -> Result<Processor, String> {
    parse::among(text, &BOARDS, Processor::board_name)
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let scenes = load(&arguments.scene)?;
    let board = arguments.board;
    let shaders = &arguments.shader.values;
    if board == Processor::X86_64 {
        let program = bench::callgrind::build()?;
        for scene in &scenes {
            let shaders: Vec<_> =
                shaders.iter().copied().filter(|&s| microphong::render::check(&scene.stream.parse().unwrap(), s, false).is_ok()).collect();
            let frames: Vec<_> =
                shaders.iter().map(|&shader| bench::callgrind::Frame { size: board.size(), band_rows: board.size().1, shader }).collect();
            for (count, &shader) in bench::callgrind::count(&program, scene.stream.as_bytes(), &frames)?.iter().zip(&shaders) {
                let result = count.measurement(&scene.name, shader);
                if arguments.json { report::json(&result) } else { text(&result) }?;
            }
        }
        return Ok(Outcome::Done);
    }
    let bar = report::progress((scenes.len() * shaders.len()) as u64 + 1, "counting");
    let elf = Elf::read(&verify::build(board.board().context("no board")?)?)?;
    let (width, height) = board.size();
    for scene in &scenes {
        for &shader in shaders {
            bar.inc(1);
            let size = Size::new(width, height);
            let (_, stats) = render::frame::<Rgb565>(scene.stream.parse()?, size, shader, height, 0)?;
            let elf = elf.with_stream(&verify::prepare(scene.stream.as_bytes(), shader, 1)?)?;
            let result = bench::measure(board, &elf, &scene.name, shader, stats.pixels.into(), stats.drawn.into())?;
            bar.suspend(|| if arguments.json { report::json(&result) } else { text(&result) })?;
        }
    }
    bar.finish_and_clear();
    Ok(Outcome::Done)
}

fn text(result: &Measurement) -> Result<()> {
    let stages = result.by_stage;
    let [all, vertex, cull, setup, span, pixel] =
        [result.instructions, stages.vertex, stages.cull, stages.setup, stages.span, stages.pixel].map(report::grouped);
    let board = result.board.board_name();
    let Measurement { scene, shader, pixels, triangles, spans, instr_per_pixel, .. } = result;
    report::line(&format!("{board}, {scene}, {shader}: {all} instructions, {instr_per_pixel} per pixel"))?;
    report::line(&format!("  vertex {vertex}, cull and bin {cull}, set-up {setup}, span {span}, pixel {pixel}"))?;
    let inner = stages.pixel as f64 / (*pixels).max(1) as f64;
    report::line(&format!("  {triangles} triangles, {spans} spans, {} pixels of {inner:.1} in the inner loop", report::grouped(*pixels)))
}
