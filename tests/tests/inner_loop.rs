//! The inner loops stay at the limit of the machine: instructions counted in an emulated Cortex-M3.

use embedded_graphics::{pixelcolor::Rgb565, prelude::Size};
use microphong::Shader;
use microphong_sim::{
    bench::{self, Processor},
    board::elf::Elf,
    render, scene, verify,
};

/// A depth-tested quadratic takes 13 instructions a pixel, as many as written by hand; a plane one fewer, a constant 9.
#[test]
fn loops_are_as_short_as_by_hand() {
    let board = Processor::CortexM3;
    let scene = scene::load("peer-sphere").unwrap();
    let elf = Elf::read(&verify::build(board.board().unwrap()).unwrap()).unwrap();
    let limits = [
        (Shader::Flat, 9),
        (Shader::Gouraud, 12),
        (Shader::SixPoint, 13),
        // The same loops, on parts of triangles.
        (Shader::Gouraud4, 12),
        (Shader::SixPointCentre, 13),
    ];
    for (shader, limit) in limits {
        let (width, height) = board.size();
        let stream = scene.stream.parse().unwrap();
        let (_, stats) = render::frame::<Rgb565>(stream, Size::new(width, height), shader, height, 0).unwrap();
        let elf = elf.with_stream(&verify::prepare(scene.stream.as_bytes(), shader, 1).unwrap()).unwrap();
        let report = bench::measure(board, &elf, &scene.name, shader, stats.pixels.into(), stats.drawn.into()).unwrap();
        // Spans end on a branch that is not taken, so a few instructions of the loop may be counted with the span.
        let per_pixel = report.by_stage.pixel as f64 / report.pixels as f64;
        println!("{}: {per_pixel:.2} instructions in the inner loop", shader.name());
        assert!(per_pixel > f64::from(limit) - 1.0 && per_pixel <= f64::from(limit), "{}: {per_pixel}", shader.name());
    }
}
