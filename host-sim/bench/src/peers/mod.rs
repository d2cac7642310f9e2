//! What other renderers need for the frame `peer-sphere`.
//!
//! Those of crates.io are drawn by `host-sim/peers`, which nothing depends on, and counted here: on the host by callgrind as microphong is,
//! on boards by QEMU's instruction clock. Figures of others were measured once.

pub mod table;

use super::{Processor, callgrind, rounded};
use anyhow::{Context, Result, ensure};
use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Rgb565, RgbColor, raw::RawU16},
};
use microphong_boards::{
    Board, INSTRUCTIONS_PER_TICK,
    build::{host, release},
    child::Scratch,
    clocked,
    elf::Elf,
};
use microphong_render::{render, scene::Scene, shader::Shader};
use serde::Serialize;
use std::{ffi::OsString, path::PathBuf};

/// The scene that is drawn: its mesh, camera and light are theirs.
pub const SCENE: &str = "peer-sphere";

/// Renderers and methods, by the names that `host-sim/peers` has for them.
pub const PEERS: [&str; 4] = ["retrofire gouraud", "retrofire phong", "embedded-3dgfx flat", "embedded-3dgfx gouraud"];

/// By how much a picture may cover more or fewer pixels than ours, a share of ours.
const COVERAGE: f64 = 0.02;

/// One frame drawn by another renderer: a line of `bench --json`, with the same keys as a [`super::Measurement`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// The board that drew; of the host its architecture.
    pub board: &'static str,
    /// Its processor.
    pub cpu: &'static str,
    /// [`SCENE`].
    pub scene: &'static str,
    /// One of [`PEERS`].
    pub shader: &'static str,
    /// Instructions of the frame, without clearing and transfer.
    pub instructions: u64,
    /// Pixels of the picture that are not background.
    pub pixels: u64,
    /// Instructions per pixel, to a hundredth.
    pub instr_per_pixel: f64,
    #[serde(flatten)]
    unknown: Unknown,
    /// Checksum of the picture.
    #[serde(skip)]
    pub checksum: u32,
}

/// What only our own firmware tells: null.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
struct Unknown {
    cycles: (),
    triangles: (),
    spans: (),
    by_stage: (),
    ram_bytes: (),
    flash_bytes: (),
    max_lsb: (),
    rmse_lsb: (),
    flash_own_bytes: (),
    firmware_bytes: (),
    timing: (),
}

impl Frame {
    fn new(processor: Processor, shader: &'static str, instructions: u64, pixels: u64, checksum: u32) -> Self {
        Self {
            board: processor.board_name(),
            cpu: processor.name(),
            scene: SCENE,
            shader,
            instructions,
            pixels,
            instr_per_pixel: rounded(instructions as f64 / pixels.max(1) as f64, 100.0),
            unknown: Unknown::default(),
            checksum,
        }
    }
}

/// Whether other renderers can be measured on it.
#[must_use]
pub fn possible(processor: Processor) -> bool {
    matches!(processor.board(), None | Some(Board::Mps2An385 | Board::Mps2An386))
}

/// Has all [`PEERS`] draw `scene` on one processor, which must be a [`possible`] one.
///
/// # Errors
/// When something does not compile or run, or a picture covers other pixels than ours.
pub fn measure(processor: Processor, scene: &Scene) -> Result<Vec<Frame>> {
    let frames = match processor.board() {
        None => {
            let drawn = draw(scene)?.into_iter().zip(PEERS);
            drawn.map(|((instructions, p), peer)| Frame::new(processor, peer, instructions, p.covered(), p.checksum())).collect()
        }
        Some(board) => on_board(processor, board, scene)?,
    };
    let (width, height) = processor.size();
    let (_, ours) = render::frame::<Rgb565>(scene.stream.parse()?, Size::new(width, height), Shader::FLAT, height, 0)?;
    for frame in &frames {
        let more = frame.pixels as f64 / f64::from(ours.pixels) - 1.0;
        ensure!(more.abs() < COVERAGE, "{} covers {} pixels, microphong {}: not the same frame", frame.shader, frame.pixels, ours.pixels);
    }
    Ok(frames)
}

/// A picture on black.
#[derive(Clone, Debug)]
pub struct Picture(pub Vec<Rgb565>);

impl Picture {
    /// Pixels that are not black.
    #[must_use]
    pub fn covered(&self) -> u64 {
        self.0.iter().filter(|&&pixel| pixel != Rgb565::BLACK).count() as u64
    }

    fn checksum(&self) -> u32 {
        render::crc(&self.0)
    }
}

/// Compiles a program of `host-sim/peers`, which has a feature of its own, and returns its path.
fn build(program: &str, target: &str) -> Result<PathBuf> {
    release(program, &format!("peers/{program}"), target, "the program with other renderers")
}

/// Has all [`PEERS`] draw `scene` on the host: instructions and picture of each.
///
/// # Errors
/// When something does not compile or run.
pub fn draw(scene: &Scene) -> Result<Vec<(u64, Picture)>> {
    ensure!(cfg!(target_arch = "x86_64"), "instructions of x86-64 are counted on such computers only; choose another board");
    let program = build("host", &host()?)?;
    let stream = Scratch::new(scene.stream.as_bytes())?;
    let pictures = PEERS.iter().map(|_| Scratch::new(&[])).collect::<Result<Vec<_>>>()?;
    let frames =
        PEERS.iter().zip(&pictures).map(|(peer, file)| -> [OsString; 3] { [stream.path().into(), peer.into(), file.path().into()] });
    let (_, profiles) = callgrind::profiles(&program, &frames.collect::<Vec<_>>())?;
    let drawn = profiles.iter().zip(&pictures).map(|(profile, file)| {
        let bytes = file.read().context("no picture by another renderer")?;
        let (pixels, _) = bytes.as_chunks::<2>();
        let pixels = pixels.iter().map(|&pixel| RawU16::new(u16::from_le_bytes(pixel)).into());
        Ok((profile.total, Picture(pixels.collect())))
    });
    drawn.collect()
}

/// The program that has all [`PEERS`] draw `scene` on `board`.
///
/// # Errors
/// When it does not compile.
pub fn program(board: Board, scene: &Scene) -> Result<Elf> {
    Elf::read(&build("mps2", board.target())?)?.with_stream(scene.stream.as_bytes())
}

fn on_board(processor: Processor, board: Board, scene: &Scene) -> Result<Vec<Frame>> {
    ensure!(possible(processor), "other renderers are not measured on {board}");
    let lines = clocked(board, &program(board, scene)?)?;
    PEERS
        .into_iter()
        .map(|peer| {
            let line =
                lines.iter().find_map(|line| line.strip_prefix("frame ")?.strip_prefix(peer)).context("a renderer has logged nothing")?;
            let figure =
                |name| line.split_whitespace().skip_while(|&word| word != name).nth(1).with_context(|| format!("no {name} in {line}"));
            let instructions = (figure("ticks")?.parse::<f64>()? * INSTRUCTIONS_PER_TICK).round() as u64;
            Ok(Frame::new(processor, peer, instructions, figure("pixels")?.parse()?, u32::from_str_radix(figure("crc")?, 16)?))
        })
        .collect()
}
