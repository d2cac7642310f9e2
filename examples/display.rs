//! Draws a mesh on a display of embedded-graphics. The display is simulated here, and saved as a picture.
use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{Layout, Picture, Renderer, Shader, Stream, include_stream};

/// Pictures are 240 pixels wide and drawn 40 rows at a time.
const LAYOUT: Layout = Layout::new(240, 40);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A program for a microcontroller reads the mesh from flash, and keeps `memory` and `band` in a `static`.
    let stream = Stream::parse_included(include_stream!("../firmware/teapot.tri"))?;
    let (mut memory, mut band) = (vec![0; LAYOUT.words::<Rgb565>()], [Rgb565::BLACK; LAYOUT.band()]);
    let mut display = SimulatorDisplay::<Rgb565>::new(Size::new(240, 240));

    let mut renderer = Renderer::new(stream, display.size(), &LAYOUT, &mut memory, &[Shader::AUTO])?;
    let stats = Picture::new(&mut renderer, &mut band, 0)?.draw(&mut display)?;

    let file = std::env::args().nth(1).unwrap_or_else(|| "picture.png".into());
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&file)?;
    println!("{file}: {} triangles drawn", stats.drawn);
    Ok(())
}
