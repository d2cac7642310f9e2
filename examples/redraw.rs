//! Partial redraw where one of twelve objects moves: a whole frame of `board`, and beside it the part of the next frame that is drawn.
//!
//! `cargo run --release -p microphong-tests --example redraw` writes `redraw.png`, or the file that is named behind `--`.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{Layout, Picture, Renderer, Shader, Stats};
use microphong_sim::scene;

/// Pixels of a picture.
const SIZE: Size = Size::new(320, 240);

/// Draws both pictures. Returns the display and the counts of the second picture.
///
/// # Errors
/// Errors of the library, if a constant of this file is wrong.
pub(crate) fn draw() -> Result<(SimulatorDisplay<Rgb565>, Stats), Box<dyn std::error::Error>> {
    let board = scene::load("board")?;
    let stream = board.stream.parse()?;
    let layout = Layout::new(SIZE.width as usize, 40).with_room_for(&stream);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut band = vec![Rgb565::BLACK; layout.band()];
    let beside = Point::new(SIZE.width as i32 + 8, 0);
    let mut display = SimulatorDisplay::new(Size::new(2 * SIZE.width + 8, SIZE.height));
    display.clear(Rgb565::WHITE)?;

    let mut renderer = Renderer::new(stream, SIZE, &layout, &mut memory, &[Shader::AUTO])?;
    renderer.set_partial_redraw(true);
    Picture::new(&mut renderer, &mut band, 20)?.draw(&mut display)?;
    // A program draws it at the same place, where the display shows the frame before.
    let stats = Picture::new(&mut renderer, &mut band, 21)?.at(beside, &display)?.draw(&mut display)?;
    Ok((display, stats))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (display, stats) = draw()?;
    let file = std::env::args().nth(1).unwrap_or_else(|| "redraw.png".into());
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&file)?;
    println!("{file}: {} triangles drawn", stats.drawn);
    Ok(())
}
