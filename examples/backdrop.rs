//! A teapot somewhere on a simulated display: before a gradient and an image from flash, behind a label.
//!
//! `cargo run --release -p microphong-tests --example backdrop` writes `backdrop.png`, or the file that is named behind `--`.

use embedded_graphics::{
    image::{Image, ImageRawBE},
    mono_font::{MonoTextStyle, ascii::FONT_9X15, ascii::FONT_10X20},
    pixelcolor::Rgb565,
    prelude::*,
    primitives::{Line, PrimitiveStyle},
    text::Text,
};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{Background, Layout, Picture, Renderer, Shader, Stats, Stream, include_stream};

/// Pictures 220 pixels wide, 40 rows at once; a microcontroller keeps the memory in a `static`.
const LAYOUT: Layout = Layout::new(220, 40);
/// Side of the image.
const SIDE: usize = 88;
/// A sunset in Rgb565, high bytes first. A program of its own would have `include_bytes!("sunset.raw")` here.
static SUNSET: [u8; 2 * SIDE * SIDE] = sunset();

/// Rings around the middle, the brighter the nearer.
const fn sunset() -> [u8; 2 * SIDE * SIDE] {
    let mut bytes = [0; 2 * SIDE * SIDE];
    let mut k = 0;
    while k < SIDE * SIDE {
        let (x, y) = (2 * (k % SIDE) as i32 + 1 - SIDE as i32, 2 * (k / SIDE) as i32 + 1 - SIDE as i32);
        let share = (x * x + y * y) * 8 / (SIDE * SIDE) as i32;
        let color = ((31 - share as u16) << 11) | ((44 - 2 * share as u16) << 5) | 6;
        [bytes[2 * k], bytes[2 * k + 1]] = color.to_be_bytes();
        k += 1;
    }
    bytes
}

/// Draws the picture. Returns the display and the counts of the picture.
///
/// # Errors
/// Errors of the library, if a constant of this file is wrong.
pub(crate) fn draw() -> Result<(SimulatorDisplay<Rgb565>, Stats), Box<dyn std::error::Error>> {
    // Read in place: on a microcontroller the mesh stays in flash.
    let stream = Stream::parse_included(include_stream!("../firmware/teapot.tri"))?;
    let mut memory = vec![0; LAYOUT.words::<Rgb565>()];
    let mut band = [Rgb565::BLACK; LAYOUT.band()];
    let mut display = SimulatorDisplay::<Rgb565>::new(Size::new(320, 240));
    display.clear(Rgb565::new(4, 8, 7))?;
    let title = MonoTextStyle::new(&FONT_9X15, Rgb565::new(20, 40, 20));
    Text::new("teapot\n\n992\ntriangles", Point::new(8, 24), title).draw(&mut display)?;

    // Smaller than the display: only these pixels are drawn.
    let mut renderer = Renderer::new(stream, Size::new(220, 220), &LAYOUT, &mut memory, &[Shader::AUTO])?;
    renderer.scene().set_background(Background::Gradient { top: [32, 32, 56], bottom: [200, 104, 72] });
    let corner = Point::new(92, 10);
    let pixels = ImageRawBE::<Rgb565>::new(&SUNSET, SIDE as u32);
    let image = Image::new(&pixels, corner + Point::new(20, 24));
    let horizon = Line::new(corner + Point::new(0, 150), corner + Point::new(219, 150));
    let label = Text::new("before it", corner + Point::new(64, 206), MonoTextStyle::new(&FONT_10X20, Rgb565::WHITE));
    let behind = Text::new("behind it", corner + Point::new(112, 44), MonoTextStyle::new(&FONT_10X20, Rgb565::WHITE));
    let picture = Picture::new(&mut renderer, &mut band, 0)?.at(corner, &display)?;
    let picture = picture.under(|band| {
        let Ok(()) = image.draw(band);
        let Ok(()) = horizon.into_styled(PrimitiveStyle::with_stroke(Rgb565::new(12, 20, 12), 2)).draw(band);
        let Ok(_) = behind.draw(band);
    });
    let picture = picture.over(|band| {
        let Ok(_) = label.draw(band);
    });
    let stats = picture.draw(&mut display)?;
    Ok((display, stats))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (display, stats) = draw()?;
    let file = std::env::args().nth(1).unwrap_or_else(|| "backdrop.png".into());
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&file)?;
    println!("{file}: {} triangles drawn", stats.drawn);
    Ok(())
}
