//! A shading method of one's own: light in four steps, as in a cartoon.
//!
//! `cargo run --release -p microphong-tests --example own_method` writes `own_method.png`, or the file that is named behind `--`.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{
    Layout, Picture, Renderer, Shader, Stream,
    format::{BIAS, Intensity, LEVEL, WALK},
    include_stream,
    interpolate::field::Nodes,
    method::{Area, Costs, Facts, Highlight, Method, RANGE, Shading, TriangleSetup, VertexLight},
    raster::canvas::{Canvas, IntensityShader},
};

#[derive(Clone, Copy)]
struct Cartoon;

static FACTS: Facts = Facts {
    name: "cartoon",
    id: Facts::FIRST_FREE,
    source: "an example",
    vertex_light: VertexLight::Levels,
    highlight: Highlight::Half,
    highlight_levels: false,
    near_lights: true,
    perspective: true,
    costs: Costs::new(3, 3, 0, 30),
};

impl Method for Cartoon {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, _: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        // Light at the corners, linear in between, in three channels; biased, as walked levels are.
        let [a, b, c] = setup.corners.map(|corner| corner.light);
        let nodes = [0, 1, 2].map(|channel| [a[channel], b[channel], c[channel]]);
        setup.draw(&Nodes::<3, 3, RANGE>::new(nodes, WALK - LEVEL).biased([BIAS << WALK; 3]), *self, canvas)
    }
}

impl IntensityShader<[u32; 3]> for Cartoon {
    fn shade(&self, levels: [u32; 3]) -> Intensity {
        levels.map(|level| ((level >> WALK) as i32 - BIAS).clamp(0, 255) / 64 * (85 << 8))
    }
}

const LAYOUT: Layout = Layout::new(240, 40);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stream = Stream::parse(include_stream!("../../firmware/teapot.tri"))?;
    let (mut memory, mut band) = (vec![0; LAYOUT.words::<Rgb565>()], [Rgb565::BLACK; LAYOUT.band()]);
    let mut display = SimulatorDisplay::<Rgb565>::new(Size::new(240, 240));
    let mut renderer = Renderer::with_shader(stream, display.size(), &LAYOUT, &mut memory, Shader::new(&Cartoon))?;
    let stats = Picture::new(&mut renderer, &mut band, 0)?.draw(&mut display)?;
    let file = std::env::args().nth(1).unwrap_or_else(|| "own_method.png".into());
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&file)?;
    println!("{file}: {} triangles drawn", stats.drawn);
    Ok(())
}
