//! The flashable firmware of every board, run on its emulated display and compared with the host, pixel by pixel.

use crate::{lights, textures, transparency, vertex_colours};
use microphong::{
    Outlines,
    method::{Canvas, Facts, Method, Shading, TriangleSetup, levels::gouraud::Gouraud},
    stream::{
        record::{Triangle, Vertex},
        seal,
    },
};
use microphong_sim::{
    board::{self, Board, Until, build, build::program, elf::Elf},
    scene::{self, SCRIPTED},
    shader::Shader,
    stress::records::Records,
    verify::{self, Request},
};
use microphong_tests::message;
use rayon::prelude::*;
use std::{error::Error, fs, mem::offset_of, path::Path};

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

/// The first frame, and one that follows another: rows that were background and still are are not sent again.
const FRAMES: u16 = 2;
/// Most RAM that variables and stack may take together with the teapot.
const RAM: [(Board, u64); 3] = [(Board::Pico, 240 << 10), (Board::Pico2, 420 << 10), (Board::Lm3s6965evb, 64 << 10)];

/// Boards whose smooth outlines are compared. The others draw them by the same program for another processor, which takes long to compile.
const SMOOTH: [Board; 2] = [Board::Mps2An385, Board::Mps2An386];

fn stream(scene: &str) -> Result<Vec<u8>> {
    Ok(scene::load(scene)?.stream.as_bytes().to_vec())
}

fn request(board: Board, scene: &str, shader: Shader) -> Result<Request> {
    Ok(Request { board, scene: scene.to_owned(), stream: stream(scene)?, firmware_stream: None, shader, frames: FRAMES, antialias: false })
}

/// All shaders and scenes on one board. The core's shaders draw all scenes, the others draw the teapot.
fn matrix(board: Board) -> Result {
    let directory = tempfile::tempdir()?;
    let elf = verify::build(board, false)?;
    let mut pictures = Vec::new();
    // The smallest board has no room for large meshes, nor for several objects.
    let is_small = board == Board::Lm3s6965evb;
    let large = if is_small { "sphere-168" } else { "bunny" };
    for scene in ["teapot", large, "sphere-690", "sphere-40", "dodecahedron", "triangle"] {
        for shader in Shader::ALL.into_iter().filter(|&shader| board.has(shader)) {
            let request = request(board, scene, shader)?;
            if Shader::CORE.contains(&shader) {
                pictures.push(request);
            } else if scene == "teapot" {
                pictures.push(Request { frames: 1, ..request });
            }
        }
    }
    let scripted = if is_small { &[] } else { &SCRIPTED[..] };
    for scene in scripted {
        pictures.push(request(board, scene, Shader::AUTO)?);
        pictures.push(request(board, scene, Shader::GOURAUD)?);
    }
    let reports: anyhow::Result<Vec<_>> = pictures.par_iter().map(|request| verify::run(request, &elf, directory.path())).collect();
    for (request, report) in pictures.iter().zip(reports?) {
        println!("{}", serde_json::to_string(&report)?);
        let name = format!("{board} {} {}", request.scene, request.shader.name());
        assert_eq!(report.differing, 0, "{name}");
        let (width, height) = board.size();
        assert_eq!(report.pixels, u64::from(width * height) * u64::from(request.frames));
        assert!(report.stack_bytes > 0 && report.ram_bytes > 0 && report.flash_bytes > 0);
        assert!(!is_small || report.flash_bytes <= 256 << 10, "{name}: {} bytes of flash", report.flash_bytes);
        if let Some((_, limit)) = RAM.iter().find(|(limited, _)| *limited == board) {
            let used = report.ram_bytes + report.stack_bytes;
            assert!(used <= *limit, "{name}: {used} bytes of RAM, more than {limit}");
        }
    }
    assert!(!directory.path().join("board.png").exists(), "pictures are kept only where they differ");
    Ok(())
}

/// Boards draw the pixels of the host, also under lights with a range and a cone and under light from the sky.
#[test]
fn all_lights() -> Result {
    let directory = tempfile::tempdir()?;
    let [sky, ground] = lights::hemisphere();
    for board in SMOOTH {
        let elf = verify::build(board, true)?;
        for shader in [Shader::FLAT, Shader::GOURAUD, Shader::SIX_POINT, Shader::SQRT6, Shader::PHONG, Shader::AUTO] {
            let stream = lights::lit("teapot", &[sky, ground, lights::spotlight()]).with_neighbours()?.as_bytes().to_vec();
            let report = verify::run(&Request { antialias: true, stream, ..request(board, "teapot", shader)? }, &elf, directory.path())?;
            assert_eq!(report.differing, 0, "{board} {}", shader.name());
        }
    }
    Ok(())
}

/// Boards draw the pixels of the host, also with colours at corners, with textures, and with holes in them.
#[test]
fn colours() -> Result {
    let directory = tempfile::tempdir()?;
    let palette = [[255; 3], [0; 3], [200, 90, 30], [20, 220, 250], [90, 90, 90]];
    // The Cortex-M3 draws more of this in tests of its own, and the lm3s6965evb has no flash for it.
    for board in [Board::Pico, Board::Mps2An386] {
        let elf = build::firmware_with(board, "vertex-colours,textures,transparency")?;
        let parts = |lights: &[_]| Records { lights: lights.to_vec(), ..vertex_colours::parts("teapot") };
        // The kernels of the Cortex-M4F have forms of their own for one light and for sums of several.
        for (kind, lights) in &vertex_colours::lights() {
            let draws_all = matches!(*kind, "two" | "near");
            if !draws_all && board == Board::Pico {
                continue;
            }
            let streams = [
                (
                    "colours",
                    vertex_colours::coloured(parts(lights), &palette, |triangle, corner| {
                        ((triangle / 9 * 2 + usize::from(corner) / 40) % 5) as u8
                    }),
                ),
                ("a texture", textures::textured(parts(lights), [5, 4], &palette, textures::anywhere)),
                ("holes", transparency::pierced(parts(lights), 0, |k| k < 3, None)),
            ];
            let streams = streams.iter().take(if draws_all { streams.len() } else { 1 });
            for ((scene, stream), shader) in streams.flat_map(|stream| vertex_colours::CORE.map(|shader| (stream, shader))) {
                let stream = stream.as_bytes().to_vec();
                let request =
                    Request { board, scene: (*scene).to_owned(), stream, firmware_stream: None, shader, frames: 1, antialias: false };
                assert_eq!(verify::run(&request, &elf, directory.path())?.differing, 0, "{board} {scene} {}", shader.name());
            }
        }
    }
    Ok(())
}

/// Smooth outlines are the same bits on boards, too.
#[test]
fn smooth_outlines() -> Result {
    let directory = tempfile::tempdir()?;
    for board in SMOOTH {
        let elf = verify::build(board, true)?;
        let scenes = ["teapot", "torus", "bunny", "dodecahedron"].iter().chain(&SCRIPTED);
        let pictures = scenes.flat_map(|scene| [Shader::GOURAUD, Shader::AUTO, Shader::PHONG].map(|shader| (scene, shader)));
        for (scene, shader) in pictures.collect::<Vec<_>>() {
            let stream = scene::load(scene)?.stream.with_neighbours()?.as_bytes().to_vec();
            let request = Request { antialias: true, stream, ..request(board, scene, shader)? };
            let report = verify::run(&request, &elf, directory.path())?;
            assert_eq!(report.differing, 0, "{board} {scene} {}", shader.name());
            // It would differ if the host drew no outlines.
            let plain = verify::run(&Request { antialias: false, ..request }, &elf, directory.path())?;
            assert!(plain.differing > 100, "{board} {scene} {}: {} pixels of outlines", shader.name(), plain.differing);
        }
    }
    assert!(verify::build(Board::Pico, true).unwrap_err().to_string().contains("smooth outlines"));
    Ok(())
}

/// A board draws the lines along outlines that a stream states, and its program says nothing of them.
#[test]
fn lines_of_a_scene() -> Result {
    let directory = tempfile::tempdir()?;
    let (board, scene) = (Board::Mps2An385, "sensor");
    let elf = verify::build(board, true)?;
    for outlines in [Outlines::new([255, 160, 0]), Outlines::new([255; 3]).alone(true)] {
        let stream = scene::load(scene)?.stream.with_outlines(outlines)?;
        let request = Request { antialias: true, stream: stream.as_bytes().to_vec(), ..request(board, scene, Shader::GOURAUD)? };
        assert_eq!(verify::run(&request, &elf, directory.path())?.differing, 0, "{outlines:?}");
        // It would differ if either drew no lines.
        let without = Some(stream.without_outlines().as_bytes().to_vec());
        let other = verify::run(&Request { firmware_stream: without, ..request }, &elf, directory.path())?;
        assert!(other.differing > 500, "{outlines:?}: {} pixels of lines", other.differing);
    }
    // The plain firmware has no code for them.
    let stream = scene::load(scene)?.stream.with_outlines(Outlines::new([255; 3]))?.as_bytes().to_vec();
    let elf = verify::build(board, false)?;
    let error = verify::run(&Request { stream, ..request(board, scene, Shader::GOURAUD)? }, &elf, directory.path()).expect_err("no lines");
    assert!(format!("{error:#}").contains("lacks the cargo feature antialias"), "{error:#}");
    Ok(())
}

/// The stream with one bit of the first vertex's normal flipped: too little for a stream to be refused.
fn bent(scene: &str) -> Result<Vec<u8>> {
    let stream = scene::load(scene)?.stream;
    let header = stream.parse()?.header;
    let triangles = header.triangles as usize * size_of::<Triangle>();
    let vertices = header.length as usize - triangles - header.vertices as usize * size_of::<Vertex>();
    let mut bytes = stream.as_bytes().to_vec();
    bytes[vertices + offset_of!(Vertex, normal)] ^= 1 << 5;
    seal(&mut bytes);
    Ok(bytes)
}

/// One flipped bit of one normal in the firmware's stream must be found, and pictures of it kept.
fn flipped_bit(board: Board) -> Result {
    let directory = tempfile::tempdir()?;
    let request = Request { firmware_stream: Some(bent("triangle")?), ..request(board, "triangle", Shader::GOURAUD)? };
    let report = verify::run(&request, &verify::build(board, false)?, directory.path())?;
    assert!(report.differing > 0, "{board}: a bent normal went unnoticed");
    for name in ["board.png", "host.png", "difference.png"] {
        assert!(directory.path().join(name).is_file(), "{board}: no {name}");
    }
    Ok(())
}

/// A damaged stream is reported in words, on the display and in the log; nothing hangs.
fn damaged_stream(board: Board) -> Result {
    let mut bytes = stream("teapot")?;
    if let Some(last) = bytes.last_mut() {
        *last ^= 1;
    }
    let elf = Elf::read(&verify::build(board, false)?)?.with_stream(&bytes)?;
    let recording = board::run(board, &elf, Until::LastFrame(1))?;
    let failure = recording.failure().expect("a line that starts with `error: `");
    assert!(failure.contains("checksum"), "{board}: {failure}");
    assert!(recording.checksums().is_empty(), "{board}: frames of a damaged stream");

    // A plain background with a little text on it.
    let picture = recording.pictures.last().expect("a picture");
    let background = picture.last().copied().expect("a pixel");
    let text = picture.iter().filter(|&&pixel| pixel != background).count();
    assert!((100..picture.len() / 4).contains(&text), "{board}: {text} pixels of text");
    Ok(())
}

/// The firmware as it is built, without another stream put into it, draws the teapot.
fn as_built(board: Board) -> Result {
    let elf = Elf::read(&verify::build(board, false)?)?;
    let recording = board::run(board, &elf, Until::FirstFrame)?;
    let stream = fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware/teapot.tri"))?;
    let expected = verify::first_frame(board, &stream)?;
    let line = expected.line(0);
    assert!(line.contains(" shader auto ") && recording.log.contains(&line), "{line}: {:?}", recording.log);
    assert!(recording.pictures.first() == Some(&expected.pixels), "{board}: not the host's teapot");
    Ok(())
}

/// A stream for which the board has no method is refused in words that say what to do.
#[test]
fn a_missing_method_is_named() -> Result {
    let board = Board::Lm3s6965evb;
    let duff = Shader::ALL.into_iter().find(|shader| shader.name() == "duff").expect("a method");
    let elf = Elf::read(&verify::build(board, false)?)?.with_stream(&verify::prepare(&stream("teapot")?, duff, 1)?)?;
    let recording = board::run(board, &elf, Until::FirstFrame)?;
    let failure = recording.failure().expect("a line that starts with `error: `");
    assert!(
        failure.contains(&format!("lacks shading method number {}", duff.facts().id)) && failure.contains("convert with another --shader"),
        "{failure}"
    );
    assert!(message::is_shown(board, recording.pictures.last().expect("a picture"), failure), "the display does not show {failure:?}");
    Ok(())
}

#[path = "../../examples/own_method.rs"]
#[expect(dead_code, reason = "the example's `main`")]
mod own_method;

/// [`own_method::Cartoon`] without its steps, under the same name and number.
struct Smooth;

impl Method for Smooth {
    fn facts(&self) -> &'static Facts {
        own_method::Cartoon.facts()
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        Gouraud.shade(setup, shading, canvas)
    }
}

/// A method that is no part of microphong draws the same on a board and here; another in its place is found.
#[test]
fn a_method_of_a_users_own_is_the_hosts() -> Result {
    let directory = tempfile::tempdir()?;
    let board = Board::Mps2An385;
    let elf = program(board, "own-method")?;
    let run = |shader| -> Result<_> { Ok(verify::run(&request(board, "teapot", shader)?, &elf, directory.path())?) };
    assert_eq!(run(Shader::new(&own_method::Cartoon))?.differing, 0);
    assert!(run(Shader::new(&Smooth))?.differing > 1000, "another method went unnoticed");
    Ok(())
}

/// A file that does not fit is refused before it runs.
#[test]
fn too_large_a_stream_is_refused() -> Result {
    let elf = Elf::read(&verify::build(Board::Lm3s6965evb, false)?)?;
    let error = elf.with_stream(&vec![0; 256 << 10]).expect_err("no such room").to_string();
    assert!(error.contains("room"), "{error}");
    Ok(())
}

macro_rules! boards {
    ($($name:ident: $board:expr;)*) => {$(
        mod $name {
            use super::*;

            #[test]
            fn every_pixel_is_the_hosts() -> Result {
                matrix($board)
            }

            #[test]
            fn a_flipped_bit_is_found() -> Result {
                flipped_bit($board)
            }

            #[test]
            fn the_built_in_stream_is_drawn() -> Result {
                as_built($board)
            }

            #[test]
            fn a_damaged_stream_is_reported() -> Result {
                damaged_stream($board)
            }
        }
    )*};
}

boards! {
    pico: Board::Pico;
    pico2: Board::Pico2;
    lm3s6965evb: Board::Lm3s6965evb;
    mps2_an385: Board::Mps2An385;
    mps2_an386: Board::Mps2An386;
    mps2_an500: Board::Mps2An500;
    mps2_an505: Board::Mps2An505;
    riscv_virt: Board::RiscvVirt;
}
