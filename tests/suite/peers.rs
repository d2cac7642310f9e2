//! Other renderers draw the frame that microphong is measured with, and need more instructions for it.

use embedded_graphics::{geometry::Size, pixelcolor::Rgb565, prelude::*};
use microphong_sim::{
    bench::{
        Processor, callgrind,
        peers::{self, PEERS, SCENE},
    },
    board::{Blocks, Board, trace},
    render, scene,
    shader::Shader,
};
use std::slice;

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
    let (ours, stats) = render::frame::<Rgb565>(stream, Size::new(width, height), Shader::PHONG, height, 0).unwrap();
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

    let (size, band_rows) = (Processor::X86_64.size(), Processor::X86_64.size().1);
    let frames = [Shader::FLAT, Shader::GOURAUD, Shader::PHONG].map(|shader| callgrind::Frame { size, band_rows, shader });
    let counts = callgrind::count(&callgrind::build().unwrap(), scene.stream.as_bytes(), &frames).unwrap();
    let ours: Vec<_> = counts.iter().zip(frames).map(|(count, frame)| count.measurement(SCENE, frame.shader)).collect();
    for peer in &host {
        // Gouraud shading is cheaper than whatever they do, and each method is cheaper than theirs of its name.
        for m in ours.iter().filter(|m| m.shader == "gouraud" || peer.shader.ends_with(m.shader)) {
            let text = format!("{}: {} instructions a pixel, our {} {}", peer.shader, peer.instr_per_pixel, m.shader, m.instr_per_pixel);
            println!("{text}");
            assert!(m.instr_per_pixel < peer.instr_per_pixel, "{text}");
        }
    }

    // They stand in lines like ours.
    let keys = |line: serde_json::Value| line.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(keys(serde_json::to_value(&host[0]).unwrap()), keys(serde_json::to_value(&ours[0]).unwrap()));
}

/// QEMU's clock tells the instructions that its log of all instructions has.
#[test]
fn the_clock_is_exact() {
    let (processor, board) = (Processor::CortexM4F, Board::Mps2An386);
    let scene = scene::load(SCENE).unwrap();
    let elf = peers::program(board, &scene).unwrap();
    let functions = elf.functions().unwrap();
    let find = |name: &str| functions.iter().find(|(function, _)| function.contains(name)).unwrap().1.clone();
    let (counted, caller) = (find("peers::counted_frame"), find("mps2::ticks"));
    let start = functions.iter().map(|(_, range)| range.start).min().unwrap();
    let end = functions.iter().map(|(_, range)| range.end).max().unwrap();
    let (mut counts, mut inside) = (Vec::new(), false);
    let mut visit = |address| {
        if address == counted.start {
            counts.push(0);
            inside = true;
        }
        inside &= !caller.contains(&address);
        if inside {
            *counts.last_mut().unwrap() += 1;
        }
    };
    trace(board, &elf, slice::from_ref(&(start..end)), Blocks::Whole, &mut visit).unwrap();
    // The first draws nothing.
    let traced: Vec<u64> = counts[1..].iter().map(|count| count - counts[0]).collect();
    let clocked: Vec<u64> = peers::measure(processor, &scene).unwrap().iter().map(|frame| frame.instructions).collect();
    println!("{traced:?} in the log, {clocked:?} by the clock");
    assert_eq!(traced, clocked);
}
