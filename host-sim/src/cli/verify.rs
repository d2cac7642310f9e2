//! `microphong verify`.

use super::{
    Outcome,
    mesh_options::MeshOptions,
    parse::{self, Several},
    report, scenes,
};
use anyhow::{Context, Result, bail, ensure};
use microphong::{format::ErrorBudget, renderer::check};
use microphong_sim::{
    board::Board,
    scene::Scene,
    shader::Shader,
    verify::{self, Report, Request},
};
use serde::Serialize;
use std::path::PathBuf;

/// Draw scenes with the firmware of emulated boards, and compare every pixel with this computer
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// .tri, .obj, .stl, .ply, .gltf, .glb, .3mf and .toml files, names of built-in scenes, or `all` for every built-in scene.
    #[arg(value_name = "SCENE", default_value = "teapot")]
    scenes: Vec<String>,
    #[arg(long, value_parser = boards, help = format!("Boards, separated by commas: {}; or all", Board::names(Board::ALL)))]
    board: Several<Board>,
    /// Shading methods, separated by commas, or `all` for every method of the firmware.
    #[arg(long, default_value = "all", value_parser = parse::SeveralShaders)]
    shader: Several<Shader>,
    /// Error budget of auto and auto-linear: the largest difference of a pixel from Phong shading, in 1/255, from 0.5 to 16. The default is the
    /// budget of the scene. If it has none, the pixel format decides: 1 for 8 bits a channel, 4 for 5 or 6 bits, and 8 for fewer.
    #[arg(long, value_name = "LSB", value_parser = parse::budget)]
    budget: Option<ErrorBudget>,
    #[arg(long, help = format!("Draw smooth outlines, on boards that have the memory for them: {}", Board::names(smooth())))]
    antialias: bool,
    /// Number of frames to compare, starting with the first.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    frames: u16,
    /// Directory for pictures that differ.
    #[arg(long, value_name = "DIR", default_value = "differences")]
    artefacts: PathBuf,
    /// Print one JSON object per comparison.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: Option<MeshOptions>,
}

const EXAMPLES: &str = "\
Examples:
  microphong verify bunny torus --board pico --shader six-point
  microphong verify all --board all --json
  microphong verify teapot board --board mps2-an385 --antialias

Exit codes: 0 all pixels are equal; 1 some pixels differ, or a board failed; 2 wrong usage.";

/// Boards that have the memory for smooth outlines.
fn smooth() -> impl Iterator<Item = Board> {
    Board::ALL.into_iter().filter(|board| board.smooths())
}

/// Boards by name.
fn boards(text: &str) -> Result<Several<Board>, String> {
    parse::several(text, &Board::ALL, |text| parse::among(text, &Board::ALL, Board::name))
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let scenes = scenes::load_all(&arguments.scenes, arguments.options.as_ref(), arguments.budget)?;
    // Of all boards those that can draw it.
    let boards = arguments.board.values.iter().filter(|board| !arguments.antialias || !arguments.board.all || board.smooths());
    let boards: Vec<_> = boards.copied().collect();
    let shaders = &arguments.shader;
    // Of all methods those that the board has and that can shade the scene.
    let wanted = |board: Board, scene: &Scene, shader: Shader| {
        let possible = scene.stream.parse().is_ok_and(|stream| check(&stream, shader.facts(), false).is_ok());
        if shaders.all { board.has(shader) && possible } else { board.has(shader) || !arguments.board.all }
    };
    if arguments.board.all && !shaders.all {
        for (board, shader) in boards.iter().flat_map(|&board| shaders.values.iter().map(move |&shader| (board, shader))) {
            if !board.has(shader) {
                lacking(board, shader, arguments.json)?;
            }
        }
    }
    let mut runs = Vec::new();
    for &board in &boards {
        for scene in &scenes {
            runs.extend(shaders.values.iter().filter(|&&shader| wanted(board, scene, shader)).map(|&shader| (board, scene, shader)));
        }
    }
    let count = runs.len();
    ensure!(count > 0, "nothing to compare: no board has a method that can draw one of these scenes");
    let bar = report::progress(count as u64 + 1, "verifying pictures");
    let (mut differ, mut failed) = (0, 0);
    let mut built: Option<(Board, PathBuf)> = None;
    for (board, scene, shader) in runs {
        let elf = match &built {
            Some((of, elf)) if *of == board => elf.clone(),
            _ => verify::build(board, arguments.antialias).with_context(|| format!("cannot build the firmware of {board}"))?,
        };
        built = Some((board, elf.clone()));
        let request = Request {
            board,
            scene: scene.name.clone(),
            stream: if arguments.antialias {
                scene.stream.with_neighbours()?.as_bytes().to_vec()
            } else {
                scene.stream.as_bytes().to_vec()
            },
            firmware_stream: None,
            shader,
            frames: arguments.frames,
            antialias: arguments.antialias,
        };
        let artefacts = arguments.artefacts.join(format!("{board}-{}-{}", scene.name, shader.name()));
        bar.inc(1);
        match verify::run(&request, &elf, &artefacts) {
            Ok(result) => {
                differ += usize::from(result.differing > 0);
                bar.suspend(|| if arguments.json { report::json(&result) } else { text(&result, &artefacts) })?;
            }
            // With several comparisons one failure should not hide the others.
            Err(error) if count > 1 => {
                failed += 1;
                bar.suspend(|| report::failure(&error));
            }
            Err(error) => return Err(error),
        }
    }
    bar.finish_and_clear();
    if failed > 0 {
        bail!("{failed} of {count} comparisons failed");
    }
    Ok(if differ > 0 { Outcome::Differences } else { Outcome::Done })
}

/// A method that the board lacks.
#[derive(Serialize)]
struct Lacking {
    board: Board,
    shader: &'static str,
    lacking: bool,
}

/// Reports that a board is left out.
fn lacking(board: Board, shader: Shader, json: bool) -> Result<()> {
    if json {
        return report::json(&Lacking { board, shader: shader.name(), lacking: true });
    }
    let has: Vec<_> = Shader::ALL.into_iter().filter(|&shader| board.has(shader)).map(Shader::name).collect();
    report::line(&format!("{board} is skipped, because it has no {}; it has {}", shader.name(), has.join(", ")))
}

fn text(result: &Report, artefacts: &std::path::Path) -> Result<()> {
    let [pixels, differing, ram, flash, stack] =
        [result.pixels, result.differing, result.ram_bytes, result.flash_bytes, result.stack_bytes].map(report::grouped);
    let frames = report::counted(result.frames, report::FRAMES);
    let verdict = if result.differing == 0 { "all equal".to_owned() } else { format!("{differing} differ, see {}", artefacts.display()) };
    let Report { board, scene, shader, .. } = result;
    report::line(&format!("{board}, {scene}, {}: {frames}, {pixels} pixels, {verdict}", shader.name()))?;
    report::line(&format!("  {ram} bytes of RAM, {flash} of flash, {stack} of stack"))
}
