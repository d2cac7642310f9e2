//! The proof: a board's own firmware draws a scene on the board's emulated display, and every pixel must be the host's.

use crate::{Board, Format, Recording, Until, budget::Budget, build, clocked, elf::Elf};
use anyhow::{Context, Result, anyhow, bail, ensure};
use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Gray4, Rgb565},
};
use microphong::{
    RenderError, Renderer, Stats, Stream,
    features::Feature,
    pixel::{Channels, FromDrawn, LightGray, PictureCrc, Pixel, Rgb565Be},
    stream::{record::Header, seal},
};
use microphong_models::bytes::StreamBytes;
use microphong_render::{image, shader::Shader};
use serde::{Serialize, Serializer};
use std::{
    fs,
    path::{Path, PathBuf},
};
use zerocopy::{FromBytes, IntoBytes};

/// A comparison to make.
#[derive(Clone, Debug)]
pub struct Request {
    /// The board that draws.
    pub board: Board,
    /// The scene's name in reports.
    pub scene: String,
    /// The stream that the host draws.
    pub stream: Vec<u8>,
    /// The stream that the firmware is given, if another: how tests make sure that a difference is found.
    pub firmware_stream: Option<Vec<u8>>,
    /// The method that both use.
    pub shader: Shader,
    /// Frames to compare, from the first.
    pub frames: u16,
    /// Whether both draw smooth outlines. The stream must have the neighbours of its triangles, and the firmware must be the one that [`build()`]
    /// makes for them.
    pub antialias: bool,
}

/// The result of a comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The board that drew.
    pub board: Board,
    /// The scene's name.
    pub scene: String,
    /// The method that both used.
    #[serde(serialize_with = "shader_name")]
    pub shader: Shader,
    /// Frames compared.
    pub frames: u16,
    /// Whether they had smooth outlines.
    pub antialias: bool,
    /// Pixels compared, of all frames.
    pub pixels: u64,
    /// Compared pixels that differ.
    pub differing: u64,
    /// RAM for the firmware's variables.
    pub ram_bytes: u64,
    /// Flash for code, constants, initial values and the stream.
    pub flash_bytes: u64,
    /// Stack that the firmware has used.
    pub stack_bytes: u64,
}

fn shader_name<S: Serializer>(shader: &Shader, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(shader.name())
}

/// Compiles the firmware of `board`, with smooth outlines or without, and returns the ELF's path. One ELF serves any number of runs.
///
/// # Errors
/// When the target or the compiler is missing, the firmware does not compile, or the board has no memory for smooth outlines.
pub fn build(board: Board, antialias: bool) -> Result<PathBuf> {
    if antialias { build::antialias(board) } else { build::firmware(board) }
}

/// Runs `elf` on the board with the requested stream in it, and compares what its display shows with what the host draws.
///
/// Where they differ, `board.png`, `host.png` and `difference.png` of the first such frame go to the directory `artefacts`.
///
/// # Errors
/// When the firmware does not get that far: it crashes, falls silent, reports a failure or drives its display wrongly; or when the
/// stream cannot be drawn.
pub fn run(request: &Request, elf: &Path, artefacts: &Path) -> Result<Report> {
    let context = || format!("{} on {} with {}", request.scene, request.board, request.shader.name());
    compare(request, elf, artefacts).with_context(context)
}

fn compare(request: &Request, elf: &Path, artefacts: &Path) -> Result<Report> {
    let Request { board, shader, .. } = request;
    // Programs of a user's own may have methods of their own.
    let is_known = Shader::ALL.contains(shader);
    ensure!(!is_known || board.has(*shader), "the firmware of {board} has no {} shading: there is no room for it", shader.name());
    let frames = usize::from(request.frames);
    let host_stream = StreamBytes::from(prepare(&request.stream, request.shader, request.frames)?.as_slice());
    let board_stream = prepare(request.firmware_stream.as_ref().unwrap_or(&request.stream), request.shader, request.frames)?;
    let elf = Elf::read(elf)?.with_stream(&board_stream)?;

    let stream = host_stream.parse()?;
    // Firmware without colours says so itself.
    let how = How { shaders: &[*shader], frames, antialias: request.antialias, colours: true };
    let host = draw(*board, stream, how).context("the board cannot draw this stream")?;
    let recording = crate::run(request.board, &elf, Until::LastFrame(frames))?;
    check_log(&recording, frames)?;

    let mut differing = 0;
    for (number, (picture, shown)) in host.iter().zip(&recording.pictures).enumerate() {
        ensure!(picture.pixels.len() == shown.len(), "frame {number} has {} pixels, not {}", shown.len(), picture.pixels.len());
        let wrong = picture.pixels.iter().zip(shown).filter(|(a, b)| a != b).count() as u64;
        if wrong > 0 && differing == 0 {
            keep(request.board, &picture.pixels, shown, artefacts)?;
        }
        differing += wrong;
        // Equal pixels on the display under another checksum or other counts: the firmware did not show what it drew.
        let expected = picture.line(number);
        ensure!(
            wrong > 0 || recording.log.contains(&expected),
            "frame {number} is right on the display, but the firmware did not log `{expected}`; {}",
            log_tail(&recording)
        );
    }
    Ok(Report {
        board: request.board,
        scene: request.scene.clone(),
        shader: request.shader,
        frames: request.frames,
        antialias: request.antialias,
        pixels: host.iter().map(|picture| picture.pixels.len() as u64).sum(),
        differing,
        ram_bytes: elf.ram_bytes()?,
        flash_bytes: elf.flash_bytes()?,
        stack_bytes: recording.stack_bytes().context("the firmware has not logged its use of the stack")?,
    })
}

/// The stream with the requested method and number of frames in its header.
///
/// # Errors
/// When `stream` is shorter than its header says.
pub fn prepare(stream: &[u8], shader: Shader, frames: u16) -> Result<Vec<u8>> {
    with_header(stream, |header| (header.shader, header.frames) = (shader.facts().id, frames))
}

/// The stream with something changed in its header.
///
/// # Errors
/// When `stream` is shorter than its header says.
pub fn with_header(stream: &[u8], change: impl FnOnce(&mut Header)) -> Result<Vec<u8>> {
    let (mut header, _) = Header::read_from_prefix(stream).map_err(|_| anyhow!("the stream is shorter than its header"))?;
    change(&mut header);
    let length = header.length as usize;
    let mut bytes = stream.get(..length).with_context(|| format!("the stream has {} bytes, not {length}", stream.len()))?.to_vec();
    let header = header.as_bytes();
    bytes.get_mut(..header.len()).context("the stream's length is less than its header's")?.copy_from_slice(header);
    seal(&mut bytes);
    Ok(bytes)
}

/// The firmware must have drawn all frames, and said so.
fn check_log(recording: &Recording, frames: usize) -> Result<()> {
    if let Some(failure) = recording.failure() {
        bail!("the firmware reports: {failure}");
    }
    let (shown, logged) = (recording.pictures.len(), recording.checksums().len());
    ensure!(shown == frames && logged >= frames, "the firmware has shown {shown} and logged {logged} of {frames} frames");
    Ok(())
}

/// A frame as the host draws it.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Row by row from the top, as the board stores them.
    pub pixels: Vec<u32>,
    shader: &'static str,
    checksum: u32,
    stats: Stats,
}

impl Picture {
    /// The line that the firmware must log for this frame.
    #[must_use]
    pub fn line(&self, number: usize) -> String {
        let Stats { triangles, culled, drawn, pixels, .. } = self.stats;
        let (name, crc) = (self.shader, self.checksum);
        format!("frame {number} shader {name} crc {crc:08x} triangles {triangles} culled {culled} drawn {drawn} pixels {pixels}")
    }
}

/// The last lines that the firmware logged.
fn log_tail(recording: &Recording) -> String {
    let lines = &recording.log;
    format!("its last lines: {}", lines.get(lines.len().saturating_sub(3)..).unwrap_or_default().join(" / "))
}

/// The first frame that a board must show if `bytes` fill its memory for streams, or an error.
///
/// # Errors
/// The message that the board must show instead.
pub fn first_frame(board: Board, bytes: &[u8]) -> Result<Picture, String> {
    let bytes = StreamBytes::from(bytes);
    let stream = bytes.parse().map_err(|error| format!("stream: {error}"))?;
    let shaders: Vec<_> = Shader::ALL.into_iter().filter(|&shader| board.has(shader)).collect();
    let how = How { shaders: &shaders, frames: 1, antialias: false, colours: false };
    let mut pictures = draw(board, stream, how).map_err(|error| format!("setup: {error}"))?;
    Ok(pictures.remove(0))
}

/// What a program of a board draws, and what it has.
#[derive(Clone, Copy)]
struct How<'s> {
    /// The methods that there are.
    shaders: &'s [Shader],
    frames: usize,
    /// Whether outlines are smooth.
    antialias: bool,
    /// Whether corners may have colours.
    colours: bool,
}

/// Runs `elf`, a program that shows no picture and draws colours at corners, and compares what it logs of its frames with what the host draws in this pixel
/// format.
///
/// # Errors
/// When a checksum or a count differs, the program does not get that far, or the stream cannot be drawn.
pub fn checksums<C: Pixel>(request: &Request, elf: &Path) -> Result<()> {
    let Request { board, shader, frames, .. } = request;
    let bytes = prepare(&request.stream, *shader, *frames)?;
    let stream = StreamBytes::from(bytes.as_slice());
    let how = How { shaders: &[*shader], frames: usize::from(*frames), antialias: false, colours: true };
    let host = draw_in::<C, C>(*board, stream.parse()?, how).context("the board cannot draw this stream")?;
    let log = clocked(*board, &Elf::read(elf)?.with_stream(&bytes)?, *frames)?;
    for (number, picture) in host.iter().enumerate() {
        let expected = picture.line(number);
        ensure!(log.contains(&expected), "{}: the program did not log `{expected}`, but {log:?}", request.scene);
    }
    Ok(())
}

/// Draws in the board's format.
fn draw(board: Board, stream: Stream<'_>, how: How<'_>) -> Result<Vec<Picture>, RenderError> {
    match board.format() {
        Format::Rgb565 => draw_in::<Rgb565, Rgb565>(board, stream, how),
        Format::Rgb565Be => draw_in::<Rgb565Be, Rgb565Be>(board, stream, how),
        Format::Gray4 => draw_in::<LightGray<4>, Gray4>(board, stream, how),
    }
}

/// Draws with as much memory as the firmware has, in as many bands.
fn draw_in<C: Pixel, F: FromDrawn<C>>(
    board: Board,
    stream: Stream<'_>,
    How { shaders, frames, antialias, colours }: How<'_>,
) -> Result<Vec<Picture>, RenderError> {
    let Budget { height, layout } = board.budget();
    let layout = layout.antialias(antialias);
    let size = Size::new(layout.width as u32, height as u32);
    let mut memory = vec![0; layout.words::<C>()];
    let shaders: Vec<_> = shaders.iter().map(|shader| shader.on()).collect();
    // The core has all features here.
    let has = |feature| match feature {
        Feature::Text => board.has_text(),
        Feature::Antialias | Feature::LightShapes => antialias,
        Feature::VertexColours | Feature::Textures => colours,
        _ => true,
    };
    if let Some(feature) = Feature::missing(&stream, &Channels::of::<C>(), has) {
        return Err(RenderError::Feature { name: feature.name() });
    }
    let mut renderer = Renderer::new(stream, size, &layout, &mut memory, &shaders)?;
    if antialias {
        renderer.set_antialias(true)?;
    }
    let shader = renderer.shader().facts().name;
    let mut band = vec![C::pack([0; 3]); layout.band()];
    let pictures = (0..frames as u32).map(|number| {
        let mut pixels = Vec::with_capacity(layout.width * height);
        let mut checksum = PictureCrc::default();
        let mut frame = renderer.frame(number);
        while let Some(area) = frame.next_band(&mut band)? {
            let drawn = &band[..(area.size.width * area.size.height) as usize];
            checksum.update(drawn);
            pixels.extend(frame.output().pixels::<C, F>(drawn, area).map(F::bits));
        }
        Ok(Picture { pixels, shader, checksum: checksum.finish(), stats: frame.stats() })
    });
    pictures.collect()
}

/// Writes both pictures, and white where they differ.
fn keep(board: Board, host: &[u32], shown: &[u32], directory: &Path) -> Result<()> {
    fs::create_dir_all(directory).with_context(|| format!("cannot create {}", directory.display()))?;
    let (width, height) = board.size();
    let rgb = |pixels: &[u32]| pixels.iter().flat_map(|&pixel| visible(board.format(), pixel)).collect::<Vec<_>>();
    let difference: Vec<_> = host.iter().zip(shown).flat_map(|(a, b)| [if a == b { 0 } else { 255 }; 3]).collect();
    for (name, bytes) in [("board.png", rgb(shown)), ("host.png", rgb(host)), ("difference.png", difference)] {
        image::write_png(&directory.join(name), width, height, &bytes)?;
    }
    Ok(())
}

/// A stored pixel in 8-bit red, green and blue.
fn visible(format: Format, pixel: u32) -> [u8; 3] {
    match format {
        Format::Gray4 => [image::replicate(pixel & 0xF, 4); 3],
        Format::Rgb565 | Format::Rgb565Be => {
            [(11, 5), (5, 6), (0, 5)].map(|(shift, bits)| image::replicate(pixel >> shift & ((1 << bits) - 1), bits))
        }
    }
}
