//! Other renderers draw the frame that microphong is measured with, and need more instructions for it.

use embedded_graphics::{geometry::Size, pixelcolor::Rgb565, prelude::*};
use microphong::Shader;
use microphong_sim::{
    bench::{
        Processor, callgrind,
        peers::{self, PEERS, SCENE},
    },
    render, scene,
};

/// Mean of the green of what is not `background`, 1 is full.
fn brightness(pixels: &[Rgb565], background: Rgb565) -> f64 {
    let lit: Vec<_> = pixels.iter().filter(|&&pixel| pixel != background).map(|pixel| f64::from(pixel.g()) / 63.0).collect();
    lit.iter().sum::<f64>() / lit.len() as f64
}

/// The same pixels, as bright as ours: embedded-3dgfx a little darker, as it has no highlights.
#[test]
fn they_draw_the_same_frame() {
    let scene = scene::load(SCENE).unwrap();
    let stream = scene.stream.parse().unwrap();
    let (width, height) = scene.size;
    let (ours, stats) = render::frame::<Rgb565>(stream, Size::new(width, height), Shader::Phong, height, 0).unwrap();
    // The sphere touches no corner.
    let level = brightness(&ours, ours[0]);
    for ((_, picture), peer) in peers::draw(&scene).unwrap().iter().zip(PEERS) {
        let (covered, theirs) = (picture.covered() as f64 / f64::from(stats.pixels), brightness(&picture.0, Rgb565::BLACK));
        println!("{peer}: covers {covered:.4} of our pixels, mean brightness {theirs:.3}, ours {level:.3}");
        assert!((covered - 1.0).abs() < 0.02, "{peer} covers {covered} of our pixels");
        assert!((theirs / level - 1.0).abs() < 0.15, "{peer} is {theirs} bright, we are {level}");
    }
}

/// On the host and on two boards: to the bit the same pictures, and none as cheap as ours.
#[test]
fn ours_costs_less() {
    let scene = scene::load(SCENE).unwrap();
    let host = peers::measure(Processor::X86_64, &scene).unwrap();
    for processor in [Processor::CortexM3, Processor::CortexM4F] {
        let board = peers::measure(processor, &scene).unwrap();
        assert_eq!(peers::measure(processor, &scene).unwrap(), board, "two runs");
        for (there, here) in board.iter().zip(&host) {
            assert_eq!((there.shader, there.checksum), (here.shader, here.checksum), "{} and the host", processor.name());
        }
    }
    let program = callgrind::build().unwrap();
    let (size, band_rows) = (Processor::X86_64.size(), Processor::X86_64.size().1);
    for method in [Shader::Flat, Shader::Gouraud, Shader::Phong] {
        let frame = callgrind::Frame { size, band_rows, shader: method };
        let count = &callgrind::count(&program, scene.stream.as_bytes(), &[frame]).unwrap()[0];
        let ours = count.measurement(SCENE, method).instr_per_pixel;
        for peer in host.iter().filter(|peer| peer.shader.ends_with(method.name())) {
            println!("{}: {} instructions a pixel, ours {ours}", peer.shader, peer.instr_per_pixel);
            assert!(ours < peer.instr_per_pixel, "{}: {} instructions a pixel, ours {ours}", peer.shader, peer.instr_per_pixel);
        }
    }
}

/// They stand in the same lines as ours, so they have the same keys.
#[test]
fn lines_have_the_keys_of_ours() {
    let scene = scene::load(SCENE).unwrap();
    let keys = |line: serde_json::Value| line.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let count = callgrind::Count { stages: Default::default(), triangles: 0, spans: 0, pixels: 0 };
    let ours = keys(serde_json::to_value(count.measurement(SCENE, Shader::Flat)).unwrap());
    for frame in peers::measure(Processor::X86_64, &scene).unwrap() {
        assert_eq!(keys(serde_json::to_value(frame).unwrap()), ours);
    }
}
