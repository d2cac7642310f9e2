//! Costs of other renderers for the frames that we measure.
//!
//! Renderers of crates.io are drawn by `host-sim/peers`, which nothing depends on. They are counted as microphong is: on the host by callgrind, on
//! boards by QEMU's instruction clock. Figures of other renderers were measured once.

pub mod lack;
pub mod table;

use super::{Processor, callgrind, rounded};
use anyhow::{Context, Result, ensure};
use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Rgb565, RgbColor, raw::RawU16},
};
use lack::Lack;
use microphong::{Stream, geometry::model_view::ModelView, lighting::lights::Lighting, stream::record::Material};
use microphong_boards::{
    Board, INSTRUCTIONS_PER_TICK,
    build::{host, release},
    child::Scratch,
    clocked,
    elf::Elf,
};
use microphong_models::scene::{self, COMPARED, Scene};
use microphong_render::{render, shader::Shader};
use serde::Serialize;
use std::{array, ffi::OsString, path::PathBuf};

/// A renderer and its way to shade.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Peer {
    /// The name that `host-sim/peers` has for it.
    pub name: &'static str,
    /// Features that the renderer lacks.
    lacks: &'static [Lack],
}

/// All renderers that are measured.
pub const PEERS: [Peer; 5] = [
    Peer { name: "retrofire gouraud", lacks: &[Lack::ParallelRays] },
    Peer { name: "retrofire phong", lacks: &[Lack::ParallelRays] },
    Peer { name: "embedded-3dgfx flat", lacks: &[Lack::ParallelRays, Lack::OtherLights, Lack::Ambient, Lack::Highlights] },
    Peer {
        name: "embedded-3dgfx flat-blinn-phong",
        lacks: &[Lack::ParallelRays, Lack::OtherLights, Lack::Ambient, Lack::ColouredHighlights],
    },
    Peer { name: "embedded-3dgfx gouraud", lacks: &[Lack::ParallelRays, Lack::OtherLights, Lack::Ambient, Lack::Highlights] },
];

impl Peer {
    /// Features of a scene that the renderer leaves out.
    #[must_use]
    pub fn lacks(&self, stream: &Stream<'_>) -> Vec<Lack> {
        self.lacks.iter().copied().filter(|lack| lack.concerns(stream)).collect()
    }
}

/// Largest difference between the numbers of pixels that a renderer and ours cover, as a fraction of ours.
const COVERAGE: f64 = 0.02;

/// One frame drawn by another renderer: a line of `bench --json`, with the keys of a [`super::Measurement`] and `lacks`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// The board that drew; of the host its architecture.
    pub board: &'static str,
    /// Name of the processor.
    pub cpu: &'static str,
    /// The scene's name.
    pub scene: String,
    /// The name of one of [`PEERS`].
    pub shader: &'static str,
    /// Features of the scene that are left out.
    pub lacks: Vec<Lack>,
    /// Instructions of the frame, without clearing and transfer.
    pub instructions: u64,
    /// Pixels that microphong draws for this frame, hidden ones included. All figures of a frame are per these pixels.
    pub pixels: u64,
    /// Instructions per pixel, to a hundredth.
    pub instr_per_pixel: f64,
    #[serde(flatten)]
    unknown: Unknown,
    /// Checksum of the picture.
    #[serde(skip)]
    pub checksum: u32,
    /// The picture; boards keep theirs.
    #[serde(skip)]
    pub picture: Option<Picture>,
}

/// A figure that only our own firmware gives: null.
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
    budget: (),
    choices: (),
    flash_own_bytes: (),
    firmware_bytes: (),
    timing: (),
}

/// Counts of a frame.
struct Count {
    instructions: u64,
    /// Pixels that are not background.
    covered: u64,
    checksum: u32,
    picture: Option<Picture>,
}

/// Whether other renderers can be measured on it.
#[must_use]
pub fn possible(processor: Processor) -> bool {
    matches!(processor.board(), None | Some(Board::Mps2An385 | Board::Mps2An386))
}

/// Why other renderers cannot draw a scene, if they cannot.
///
/// # Errors
/// When a built-in scene is damaged.
pub fn obstacle(stream: &Stream<'_>) -> Result<Option<&'static str>> {
    let lighting = Lighting::new(&stream.header.camera, stream.lights, &ModelView::new(&stream.header.camera, 0));
    if !lighting.is_constant() {
        return Ok(Some("a light is near, or highlights are seen by a local viewer"));
    }
    if stream.meshes.len() != 1 || stream.materials.len() != 1 {
        return Ok(Some("it has several meshes or materials"));
    }
    for ordinary in COMPARED {
        if Shading::of(&scene::load(ordinary)?.stream.parse()?) == Shading::of(stream) {
            return Ok(None);
        }
    }
    Ok(Some("no ordinary scene has such colours, so many lights and that exponent, and shaders are compiled for ordinary scenes only"))
}

/// The kind of scene for which a shader is written.
#[derive(PartialEq)]
struct Shading {
    grey: bool,
    lights: usize,
    exponents: Vec<u16>,
}

impl Shading {
    fn of(stream: &Stream<'_>) -> Self {
        let grey = |material: &Material| {
            let ambient = reflected(material.ambient, stream.header.ambient);
            let lit =
                stream.lights.iter().flat_map(|light| [material.diffuse, material.specular].map(|share| reflected(share, light.colour)));
            lit.chain([ambient]).all(|[r, g, b]| r == g && g == b)
        };
        Self {
            grey: stream.materials.iter().all(grey),
            lights: stream.lights.len(),
            exponents: stream.materials.iter().map(|material| material.exponent).collect(),
        }
    }
}

/// Light of a colour that is reflected by a share of each channel.
fn reflected(share: [u16; 3], colour: [u16; 3]) -> [u32; 3] {
    array::from_fn(|channel| u32::from(share[channel]) * u32::from(colour[channel]))
}

/// A picture and its background.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Row by row from the top.
    pub pixels: Vec<Rgb565>,
    background: Rgb565,
}

impl Picture {
    /// Frame 0 of `scene` by microphong, in the size of a processor's display, and the pixels that it took, hidden ones among them.
    ///
    /// # Errors
    /// When the scene cannot be drawn by `shader`.
    pub fn ours(scene: &Scene, processor: Processor, shader: Shader) -> Result<(Self, u64)> {
        let (stream, (width, height)) = (scene.stream.parse()?, processor.size());
        let (pixels, stats) = render::frame(stream, Size::new(width, height), shader, height, 0)?;
        let [r, g, b] = stream.header.background;
        Ok((Self { pixels, background: Rgb565::new(r >> 3, g >> 2, b >> 3) }, stats.pixels.into()))
    }

    /// Pixels that are not background.
    pub fn object(&self) -> impl Iterator<Item = Rgb565> {
        self.pixels.iter().copied().filter(|&pixel| pixel != self.background)
    }

    /// Pixels that are not background.
    #[must_use]
    pub fn covered(&self) -> u64 {
        self.object().count() as u64
    }
}

/// A program of `host-sim/peers`, which has all [`PEERS`] draw a frame.
#[derive(Debug)]
pub struct Program {
    processor: Processor,
    path: PathBuf,
}

impl Program {
    /// Compiles it for a processor, which must be a [`possible`] one.
    ///
    /// # Errors
    /// When it does not compile, or the host's instructions cannot be counted.
    pub fn build(processor: Processor) -> Result<Self> {
        ensure!(possible(processor), "other renderers are not measured on {}", processor.board_name());
        let (program, target) = match processor.board() {
            Some(board) => ("mps2", board.target().to_owned()),
            None => {
                ensure!(cfg!(target_arch = "x86_64"), "instructions of x86-64 are counted on such computers only; choose another board");
                ("host", host()?)
            }
        };
        let path = release(program, &format!("peers/{program}"), &target, "the program with other renderers")?;
        Ok(Self { processor, path })
    }

    /// Has all [`PEERS`] draw frame 0 of `scene`, which must have no [`obstacle`].
    ///
    /// # Errors
    /// When the program does not run, or a picture covers other pixels than ours.
    pub fn measure(&self, scene: &Scene) -> Result<Vec<Frame>> {
        let processor = self.processor;
        let counts = match processor.board() {
            Some(board) => on_board(board, &self.elf(scene)?)?,
            None => self.on_host(scene)?,
        };
        let stream = scene.stream.parse()?;
        let (ours, pixels) = Picture::ours(scene, processor, Shader::FLAT)?;
        let frames = PEERS.into_iter().zip(counts).map(|(peer, Count { instructions, covered, checksum, picture })| {
            let share = covered as f64 / ours.covered() as f64;
            ensure!(
                (share - 1.0).abs() < COVERAGE,
                "{}, {}: {covered} pixels are covered, by microphong {}: not the same frame",
                scene.name,
                peer.name,
                ours.covered()
            );
            Ok(Frame {
                board: processor.board_name(),
                cpu: processor.name(),
                scene: scene.name.clone(),
                shader: peer.name,
                lacks: peer.lacks(&stream),
                instructions,
                pixels,
                instr_per_pixel: rounded(instructions as f64 / pixels.max(1) as f64, 100.0),
                unknown: Unknown::default(),
                checksum,
                picture,
            })
        });
        frames.collect()
    }

    /// The program with which a board draws `scene`.
    ///
    /// # Errors
    /// When there is no room for the stream.
    pub fn elf(&self, scene: &Scene) -> Result<Elf> {
        Elf::read(&self.path)?.with_stream(scene.stream.as_bytes())
    }

    fn on_host(&self, scene: &Scene) -> Result<Vec<Count>> {
        let stream = Scratch::new(scene.stream.as_bytes())?;
        let pictures = PEERS.iter().map(|_| Scratch::new(&[])).collect::<Result<Vec<_>>>()?;
        let frames = PEERS.iter().zip(&pictures);
        let frames = frames.map(|(peer, file)| -> [OsString; 3] { [stream.path().into(), peer.name.into(), file.path().into()] });
        let (_, profiles) = callgrind::profiles(&self.path, &frames.collect::<Vec<_>>())?;
        let counts = profiles.iter().zip(&pictures).map(|(profile, file)| {
            let bytes = file.read().context("no picture by another renderer")?;
            let (pixels, _) = bytes.as_chunks::<2>();
            let pixels: Vec<_> = pixels.iter().map(|&pixel| RawU16::new(u16::from_le_bytes(pixel)).into()).collect();
            let (checksum, picture) = (render::crc(&pixels), Picture { pixels, background: Rgb565::BLACK });
            Ok(Count { instructions: profile.total, covered: picture.covered(), checksum, picture: Some(picture) })
        });
        counts.collect()
    }
}

fn on_board(board: Board, elf: &Elf) -> Result<Vec<Count>> {
    let lines = clocked(board, elf, 0)?;
    let counts = PEERS.iter().map(|peer| {
        let of_peer = |line: &String| line.strip_prefix("frame ")?.strip_prefix(peer.name)?.strip_prefix(" ").map(str::to_owned);
        let line = lines.iter().find_map(of_peer).with_context(|| format!("{} has logged nothing", peer.name))?;
        let figure = |name| line.split_whitespace().skip_while(|&word| word != name).nth(1).with_context(|| format!("no {name} in {line}"));
        let instructions = (figure("ticks")?.parse::<f64>()? * INSTRUCTIONS_PER_TICK).round() as u64;
        Ok(Count { instructions, covered: figure("pixels")?.parse()?, checksum: u32::from_str_radix(figure("crc")?, 16)?, picture: None })
    });
    counts.collect()
}
