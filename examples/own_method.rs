//! A shading method of your own: light in four steps, as in a cartoon.
//!
//! A method shades one triangle at a time. It computes light at nodes of the triangle, here its corners, has it interpolated, and makes an intensity
//! at each pixel. Clipping, depth, bands and pixel formats are not its concern.
//!
//! `cargo run --release -p microphong-tests --example own_method` writes `own_method.png`, or the file that is named behind `--`;
//! `firmware/src/bin/own-method.rs` has the same method on a board.

use microphong::method::{Area, Canvas, Facts, Intensity, IntensityShader, Method, Shading, TriangleSetup, Walked, levels_at};

/// Facts for the renderer: light is needed at the corners, and nothing special otherwise.
static FACTS: Facts = Facts { name: "cartoon", ..Facts::OWN };

/// Intensities are Q8.8: 255 << 8 is full. Of 256 levels, 64 each become one of the steps 0, 85, 170 and 255.
const STEP: i32 = 64 << 8;
const STRIDE: i32 = 85 << 8;

#[derive(Clone, Copy)]
pub(crate) struct Cartoon;

impl Method for Cartoon {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    /// Called for each triangle and band; returns how many pixels were drawn.
    fn shade(&self, setup: &TriangleSetup<'_>, _: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        setup.draw(&levels_at(setup.levels()), *self, canvas)
    }
}

/// Called for each visible pixel, with the interpolated red, green and blue.
impl IntensityShader<[u32; 3]> for Cartoon {
    fn shade(&self, levels: [u32; 3]) -> Intensity {
        Walked.shade(levels).map(|level| level / STEP * STRIDE)
    }
}

/// A board has a `main` of its own, and includes this file for the method.
#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
    use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
    use microphong::{Layout, Picture, Renderer, Shader, Stream, include_stream};
    const LAYOUT: Layout = Layout::new(240, 40);

    let stream = Stream::parse_included(include_stream!("../firmware/teapot.tri"))?;
    let (mut memory, mut band) = (vec![0; LAYOUT.words::<Rgb565>()], [Rgb565::BLACK; LAYOUT.band()]);
    let mut display = SimulatorDisplay::<Rgb565>::new(Size::new(240, 240));
    let mut renderer = Renderer::with_shader(stream, display.size(), &LAYOUT, &mut memory, Shader::new(&Cartoon))?;
    let stats = Picture::new(&mut renderer, &mut band, 0)?.draw(&mut display)?;
    let file = std::env::args().nth(1).unwrap_or_else(|| "own_method.png".into());
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&file)?;
    println!("{file}: {} triangles drawn", stats.drawn);
    Ok(())
}
