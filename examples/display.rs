//! A mesh from flash on an embedded-graphics display, here a simulated one, and a label over it.
//!
//! `cargo run --release -p microphong-tests --example display` writes `display.png`, or the file that is named behind `--`.

use embedded_graphics::{
    mono_font::{MonoTextStyle, ascii::FONT_10X20},
    pixelcolor::Rgb565,
    prelude::*,
    text::Text,
};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{Layout, Picture, Renderer, Shader, Stream, include_stream};

/// Pictures 240 pixels wide, 40 rows at once; a microcontroller keeps the memory in a `static`.
const LAYOUT: Layout = Layout::new(240, 40);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Read in place: on a microcontroller the mesh stays in flash.
    let stream = Stream::parse(include_stream!("../firmware/teapot.tri"))?;
    let mut memory = vec![0; LAYOUT.words::<Rgb565>()];
    let mut band = [Rgb565::BLACK; LAYOUT.band()];

    let mut display = SimulatorDisplay::<Rgb565>::new(Size::new(240, 240));
    let mut renderer = Renderer::new(stream, display.size(), &LAYOUT, &mut memory, &[Shader::AUTO])?;
    let label = Text::new("teapot", Point::new(8, 24), MonoTextStyle::new(&FONT_10X20, Rgb565::WHITE));
    // Drawn into each band before it is sent: nothing flickers.
    let picture = Picture::new(&mut renderer, &mut band, 0)?.over(|band| {
        let Ok(_) = label.draw(band);
    });
    let stats = picture.draw(&mut display)?;

    let file = std::env::args().nth(1).unwrap_or_else(|| "display.png".into());
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&file)?;
    println!("{file}: {} triangles drawn", stats.drawn);
    Ok(())
}
