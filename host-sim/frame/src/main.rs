//! Draws frames for callgrind to count: what the firmware is to a board, this program is to the host's processor.
//!
//! Arguments come in groups of four, one for each frame: a stream's file, the picture's size as `320x240`, the rows of a
//! band, and a method. Only [`counted_frame`] is counted.

use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use microphong::{Memory, Renderer, Shader, Stats, Stream, Workspace, pixel::Pixel, relay::Leg};
use std::{env, error::Error, fs, hint::black_box, process::ExitCode};
use zerocopy::IntoBytes;

/// Callgrind knows it by its name, and starts from zero where it begins.
#[inline(never)]
fn counted_frame(renderer: &mut Renderer<'_, Rgb565>, band: &mut [Rgb565]) -> Stats {
    let mut frame = renderer.frame(0);
    while frame.next_band(band).is_some() {}
    frame.stats()
}

/// Callgrind writes down what it has counted where this ends.
#[inline(never)]
fn dumped_frame(renderer: &mut Renderer<'_, Rgb565>, band: &mut [Rgb565]) -> Stats {
    black_box(counted_frame(renderer, band))
}

/// Prints triangles drawn and pixels.
fn draw(path: &str, size: Size, rows: u32, shader: &str) -> Result<(), Box<dyn Error>> {
    let bytes = fs::read(path)?;
    // Read in place, so the bytes must be aligned.
    let mut words = vec![0u32; bytes.len().div_ceil(4)];
    words.as_mut_bytes()[..bytes.len()].copy_from_slice(&bytes);
    let stream = Stream::parse(&words.as_bytes()[..bytes.len()])?;
    let shader = Shader::ALL.into_iter().find(|method| method.name() == shader).ok_or("no such method")?;

    // One entry of each kind, to fill the memory with.
    let mut blank = Workspace::<Rgb565, 1, 1, 1, 1>::new(Rgb565::pack([0; 3]));
    let blank = blank.memory();
    let pixels = size.width as usize * rows as usize;
    let mut vertices = vec![blank.vertices[0]; stream.vertices.len()];
    let mut bins = vec![blank.bins[0]; stream.triangles.len()];
    let mut palettes = vec![blank.palettes[0]; stream.materials.len()];
    let mut depth = vec![0; pixels];
    let mut band = vec![Rgb565::pack([0; 3]); pixels];
    let mut legs = vec![Leg::EMPTY; stream.triangles.len()];
    let memory =
        Memory { vertices: &mut vertices, bins: &mut bins, depth: &mut depth, palettes: &mut palettes, samples: &mut [], legs: &mut legs };
    let stats = dumped_frame(&mut Renderer::with_shader(stream, size, memory, shader)?, &mut band);
    println!("{} {}", stats.drawn, stats.pixels);
    Ok(())
}

fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let (frames, []) = arguments.as_chunks::<4>() else { return Err("groups of FILE WIDTHxHEIGHT ROWS METHOD are needed".into()) };
    for [path, size, rows, shader] in frames {
        let (width, height) = size.split_once('x').ok_or("a size is WIDTHxHEIGHT")?;
        draw(path, Size::new(width.parse()?, height.parse()?), rows.parse()?, shader)?;
    }
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
