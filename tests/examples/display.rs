//! A mesh from flash on an embedded-graphics display, here a simulated one.
//!
//! `cargo run --release -p microphong-tests --example display` writes `display.png`, or the file that is named behind `--`.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{Picture, Renderer, Stream, Workspace, include_stream};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Read in place: on a microcontroller the mesh stays in flash.
    let stream = Stream::parse(include_stream!("../../firmware/teapot.tri"))?;
    // 1024 vertices, 1024 triangles, bands of 40 rows, 1 material, 48 triangles across a border; a `static` on a microcontroller.
    let mut workspace = Box::new(Workspace::<Rgb565, 1024, 1024, { 240 * 40 }, 1, 48>::new(Rgb565::BLACK));
    let mut band = [Rgb565::BLACK; 240 * 40];

    let mut display = SimulatorDisplay::<Rgb565>::new(Size::new(240, 240));
    let mut renderer = Renderer::new(stream, display.size(), workspace.memory())?;
    let stats = Picture::new(&mut renderer, &mut band, 0).draw(&mut display)?;

    let file = std::env::args().nth(1).unwrap_or_else(|| "display.png".into());
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&file)?;
    println!("{file}: {} triangles drawn", stats.drawn);
    Ok(())
}
