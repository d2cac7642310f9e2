//! Draws the mesh files that are named, by each method in some pixel formats. Prints a line for each: a checksum, or the error.

use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Rgb565, RgbColor},
};
use microphong::{
    Layout, Renderer, Shader, Stream,
    pixel::{LightGray, PictureCrc, Pixel},
    stream::Aligned,
};

const LAYOUT: Layout = Layout::new(96, 20).vertices(4096).triangles(8192).materials(8).objects(64).antialias(true);
/// Frames that are drawn.
const FRAMES: [u32; 2] = [0, 7];

/// The largest file in bytes.
const ROOM: usize = 1 << 18;

fn main() {
    for file in std::env::args().skip(1) {
        let bytes = std::fs::read(&file).expect("a file");
        let mut aligned = Box::new(Aligned([0; ROOM]));
        aligned.0[..bytes.len()].copy_from_slice(&bytes);
        let stream = Stream::parse(&aligned.0[..bytes.len()]).expect("a stream");
        draw(&file, stream, "rgb565", Rgb565::BLACK);
        draw(&file, stream, "binary", LightGray::<1>::BLACK);
    }
}

fn draw<C: Pixel>(file: &str, stream: Stream<'_>, format: &str, black: C) {
    let mut memory = vec![0; LAYOUT.words::<C>()];
    let mut band = vec![black; LAYOUT.band()];
    for shader in Shader::ALL {
        let result = match Renderer::with_shader(stream, Size::new(96, 96), &LAYOUT, &mut memory, shader) {
            Ok(mut renderer) => {
                let mut crc = PictureCrc::default();
                for number in FRAMES {
                    let mut frame = renderer.frame(number);
                    while let Some(area) = frame.next_band(&mut band).expect("a band") {
                        crc.update(&band[..(area.size.width * area.size.height) as usize]);
                    }
                }
                format!("{:08x}", crc.finish())
            }
            Err(error) => error.to_string(),
        };
        println!("{file}\t{format}\t{}\t{result}", shader.facts().name);
    }
}
