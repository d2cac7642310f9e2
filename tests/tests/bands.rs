//! Memory decides how a frame is drawn, never what it looks like.

use embedded_graphics::{
    mock_display::MockDisplay,
    pixelcolor::{Gray8, Rgb565},
    prelude::*,
};
use microphong::{
    Memory, Picture, Renderer, Shader, Stats, Stream, bin::Entry, palette::Palette, relay::Leg, render::check, vertex::ScreenVertex,
};
use microphong_sim::{
    render::{self, Style},
    scene,
};

/// A frame with room for so many vertices, triangles, and triangles that are handed on, in bands of so many rows.
fn frame(stream: Stream<'_>, size: Size, shader: Shader, [vertices, triangles, legs]: [usize; 3], rows: u32) -> (Vec<Rgb565>, Stats) {
    let mut vertices = vec![ScreenVertex::EMPTY; vertices];
    let mut bins = vec![Entry::EMPTY; triangles];
    let mut depth = vec![0; (size.width * rows) as usize];
    let mut palettes = vec![Palette::empty(); stream.materials.len()];
    let mut legs = vec![Leg::EMPTY; legs];
    let memory =
        Memory { vertices: &mut vertices, bins: &mut bins, depth: &mut depth, palettes: &mut palettes, samples: &mut [], legs: &mut legs };
    let mut renderer = Renderer::with_shader(stream, size, memory, shader).unwrap();
    let mut band = vec![Rgb565::RED; (size.width * rows) as usize];
    let mut pixels = Vec::new();
    let mut frame = renderer.frame(5);
    while let Some(area) = frame.next_band(&mut band) {
        pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
    }
    (pixels, frame.stats())
}

#[test]
fn neither_bands_nor_overflow_change_a_pixel() {
    let size = Size::new(200, 150);
    for name in ["teapot", "torus", "sphere-40"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let (vertices, triangles) = (stream.vertices.len(), stream.triangles.len());
        for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader, false).is_ok()) {
            let (whole, stats) = frame(stream, size, shader, [vertices, triangles, 0], size.height);
            assert_eq!((stats.passes, stats.uncached), (1, 0));
            for (rows, legs) in [(1, triangles), (7, 40), (7, 3), (16, triangles), (16, 0), (64, 1)] {
                let (pixels, banded) = frame(stream, size, shader, [vertices, triangles, legs], rows);
                assert!(pixels == whole, "{name}, {}: bands of {rows} rows, {legs} handed on", shader.name());
                assert_eq!(banded, stats);
            }
            for (vertices, triangles, rows) in [(0, triangles, 50), (vertices / 2, triangles, 16), (vertices, 3, 16), (7, 0, 40)] {
                let (pixels, tight) = frame(stream, size, shader, [vertices, triangles, 10], rows);
                assert!(pixels == whole, "{name}, {}: room for {vertices} vertices, {triangles} triangles", shader.name());
                assert_eq!((tight.drawn, tight.pixels), (stats.drawn, stats.pixels), "nothing is lost");
                assert!(tight.passes > 1 || tight.uncached > 0, "the overflow is counted");
            }
        }
    }
}

#[test]
fn a_display_is_filled_once() {
    // The mock display panics on a pixel that is drawn twice or lies outside.
    let scene = scene::load("sphere-168").unwrap();
    let stream = scene.stream.parse().unwrap();
    let mut vertices = vec![ScreenVertex::EMPTY; stream.vertices.len()];
    let mut bins = vec![Entry::EMPTY; stream.triangles.len()];
    let (mut depth, mut palettes) = ([0; 64 * 10], [Palette::<Gray8>::empty()]);
    let mut legs = [Leg::EMPTY; 8];
    let memory =
        Memory { vertices: &mut vertices, bins: &mut bins, depth: &mut depth, palettes: &mut palettes, samples: &mut [], legs: &mut legs };
    let mut renderer = Renderer::new(stream, Size::new(64, 64), memory).unwrap();
    let mut band = [Gray8::BLACK; 64 * 10];
    let mut display = MockDisplay::<Gray8>::new();
    let stats = Picture::new(&mut renderer, &mut band, 0).draw(&mut display).unwrap();
    assert!(stats.drawn > 50);
    assert_eq!(display.affected_area().size, Size::new(64, 64));
    let lit = (0..64 * 64).filter(|i| display.get_pixel(Point::new(i % 64, i / 64)).unwrap().luma() > 64).count();
    assert!((1000..4000).contains(&lit), "{lit}");
}

/// Handed on from band to band, triangles look as if they were drawn at once: in one channel or three, dithered, without depth, in
/// perspective.
#[test]
fn what_is_handed_on_looks_the_same_in_every_style() {
    let size = Size::new(240, 180);
    for name in ["bunny", "torus", "peer-sphere-convex", "dodecahedron", "sphere-690"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for style in [false, true].into_iter().flat_map(|dither| [false, true].map(|perspective_correct| (dither, perspective_correct))) {
            let (dither, perspective_correct) = style;
            for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader, perspective_correct).is_ok()) {
                let style = Style { dither, perspective_correct, ..shader.into() };
                let draw = |rows| render::frame::<Rgb565>(stream, size, style, rows, 3).unwrap();
                let (whole, banded) = (draw(size.height), draw(11));
                assert!(whole == banded, "{name}, {style:?}");
            }
        }
    }
}

#[test]
fn rows_without_triangles_need_not_be_drawn_again() {
    let size = Size::new(200, 150);
    let (width, rows) = (size.width as usize, 16);
    for name in ["teapot", "triangle", "dodecahedron"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for triangles in [stream.triangles.len(), 3] {
            let mut vertices = vec![ScreenVertex::EMPTY; stream.vertices.len()];
            let mut bins = vec![Entry::EMPTY; triangles];
            let mut legs = vec![Leg::EMPTY; 20];
            let (mut depth, mut palettes) = (vec![0; width * rows], vec![Palette::empty(); stream.materials.len()]);
            let memory = Memory {
                vertices: &mut vertices,
                bins: &mut bins,
                depth: &mut depth,
                palettes: &mut palettes,
                samples: &mut [],
                legs: &mut legs,
            };
            let mut renderer = Renderer::new(stream, size, memory).unwrap();
            let mut band = vec![Rgb565::RED; width * rows];
            let mut display = vec![Rgb565::RED; width * size.height as usize];
            let (mut shown, mut saved) = (0..size.height, 0);
            for number in [0, 7, 30, 31, 60] {
                let mut whole = Vec::new();
                let mut frame = renderer.frame(number);
                while let Some(area) = frame.next_band(&mut band) {
                    whole.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
                }
                let stats = frame.stats();
                let mut frame = renderer.frame(number);
                let reached = frame.rows();
                frame.limit(reached.start.min(shown.start)..reached.end.max(shown.end));
                shown = reached;
                while !frame.is_complete() {
                    let area = frame.next_band(&mut band).unwrap();
                    let (start, count) = (area.top_left.y as usize * width, width * area.size.height as usize);
                    display[start..start + count].copy_from_slice(&band[..count]);
                    saved += count;
                }
                assert_eq!(frame.next_band(&mut band), None);
                assert_eq!(frame.stats().pixels, stats.pixels);
                assert!(display == whole, "{name}, frame {number}");
            }
            let saved = 5 * display.len() - saved;
            assert_eq!(saved > 0, triangles >= stream.triangles.len(), "{name}, room for {triangles} triangles: {saved} pixels saved");
        }
    }
}
