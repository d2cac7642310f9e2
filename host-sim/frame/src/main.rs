//! Draws frames for callgrind to count: what the firmware is to a board, this program is to the host's processor.
//!
//! Arguments come in groups of four, one for each frame: a stream's file, the picture's size as `320x240`, the rows of a
//! band, and a method. Only [`counted_frame`] is counted.

use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Rgb565, RgbColor},
};
use microphong::{Layout, Renderer, Shader, Stats, Stream};
use microphong_literature::ALL;
use std::{env, error::Error, fs, hint::black_box, process::ExitCode};
use zerocopy::IntoBytes;

/// Callgrind knows it by its name, and starts from zero where it begins.
#[inline(never)]
fn counted_frame(renderer: &mut Renderer<'_, Rgb565>, band: &mut [Rgb565]) -> Stats {
    let mut frame = renderer.frame(0);
    while let Ok(Some(_)) = frame.next_band(band) {}
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
    let literature = ALL.into_iter().map(Shader::new);
    let shader = Shader::ALL.into_iter().chain(literature).find(|method| method.facts().name == shader).ok_or("no such method")?;
    let layout = Layout::new(size.width as usize, rows as usize)
        .vertices(stream.vertices.len())
        .triangles(stream.triangles.len())
        .materials(stream.materials.len())
        .active_triangles(stream.triangles.len());
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut band = vec![Rgb565::BLACK; layout.band()];
    let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, shader)?;
    renderer.check_band(&band)?;
    let stats = dumped_frame(&mut renderer, &mut band);
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
