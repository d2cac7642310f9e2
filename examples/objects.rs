//! Two objects of one file, moved apart: the needle of a gauge turns, and its dial stands still.
//!
//! `cargo run --release -p microphong-tests --example objects` writes `objects.png`, or the file that is named behind `--`.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{Layout, Picture, Pose, Renderer, Shader, Stats, Stream, format::Angle, include_stream};

/// Pictures are 240 pixels wide and drawn 40 rows at a time. There is room for two objects.
const LAYOUT: Layout = Layout::new(240, 40).objects(2);

/// Draws a picture for each angle, side by side, and returns the counts of the last one.
///
/// # Errors
/// The stream has no mesh with one of the names, or the layout has too little room.
pub(crate) fn draw() -> Result<(SimulatorDisplay<Rgb565>, Stats), Box<dyn std::error::Error>> {
    let stream = Stream::parse_included(include_stream!("gauge.tri"))?;
    let (mut memory, mut band) = (vec![0; LAYOUT.words::<Rgb565>()], [Rgb565::BLACK; LAYOUT.band()]);
    let mut display = SimulatorDisplay::new(Size::new(480, 240));
    let mut renderer = Renderer::new(stream, Size::new(240, 240), &LAYOUT, &mut memory, &[Shader::AUTO])?;

    // The names come from the file: `o Dial` and `o Needle`.
    let scene = renderer.scene();
    scene.clear();
    scene.add(stream.mesh("Dial")?, Pose::IDENTITY)?;
    let needle = scene.add(stream.mesh("Needle")?, Pose::IDENTITY)?;

    let mut stats = Stats::default();
    for (turns, left) in [(0.1, 0), (0.75, 240)] {
        renderer.scene().set_pose(needle, Pose::about([0, 0, 1], Angle::from_num(turns))?)?;
        stats = Picture::of_scene(&mut renderer, &mut band)?.at(Point::new(left, 0), &display)?.draw(&mut display)?;
    }
    Ok((display, stats))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (display, stats) = draw()?;
    let file = std::env::args().nth(1).unwrap_or_else(|| "objects.png".into());
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&file)?;
    println!("{file}: {} triangles drawn", stats.drawn);
    Ok(())
}
