//! Other renderers draw the frames that microphong is measured with, and need more instructions for them.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use microphong::stream::{
    self,
    record::{Header, Light, Material, Mesh},
};
use microphong_sim::{
    bench::{
        Measurement, Processor, baseline, callgrind,
        peers::{self, Frame, PEERS, Picture, Program, lack::Lack},
    },
    board::{Blocks, Board, trace},
    scene::{self, COMPARED, PEER, Scene},
    shader::Shader,
};
use rayon::prelude::*;
use std::{collections::BTreeSet, iter, path::Path, slice};
use zerocopy::FromBytes;

const PROCESSORS: [Processor; 3] = [Processor::X86_64, Processor::CortexM3, Processor::CortexM4F];

/// Means of red, green and blue of all pixels but the background, where 1 is full intensity.
fn brightness(picture: &Picture) -> [f64; 3] {
    let mean = |channel: fn(&Rgb565) -> u8, max: u8| {
        picture.object().map(|pixel| f64::from(channel(&pixel))).sum::<f64>() / picture.covered() as f64 / f64::from(max)
    };
    [mean(Rgb565::r, Rgb565::MAX_R), mean(Rgb565::g, Rgb565::MAX_G), mean(Rgb565::b, Rgb565::MAX_B)]
}

/// A scene without the lights and highlights that a peer leaves out.
fn without(scene: &Scene, lacks: &[Lack]) -> Scene {
    let mut bytes = scene.stream.as_bytes().to_vec();
    let (header, _) = Header::read_from_prefix(&bytes).unwrap();
    let materials = size_of::<Header>() + usize::from(header.meshes) * size_of::<Mesh>();
    let (material, rest) = Material::mut_from_prefix(&mut bytes[materials..]).unwrap();
    for lack in lacks {
        match lack {
            Lack::Highlights => material.specular = [0; 3],
            Lack::ColouredHighlights => material.specular = [material.specular[1]; 3],
            Lack::OtherLights => {
                let (lights, _) = <[Light]>::mut_from_prefix_with_elems(rest, header.lights.into()).unwrap();
                lights[1..].iter_mut().for_each(|light| light.colour = [0; 3]);
            }
            Lack::ParallelRays | Lack::Ambient => {}
        }
    }
    stream::seal(&mut bytes);
    Scene { stream: bytes.as_slice().into(), ..scene.clone() }
}

/// Checks that a peer covers the pixels that we cover, in the colours that we draw. What the peer leaves out is removed from the scene. `peer-sphere`
/// is compared with its highlight, too, because that is small.
fn check_picture(scene: &Scene, frame: &Frame) {
    let name = format!("{}, {}", scene.name, frame.shader);
    let ours = |scene: &Scene| Picture::ours(scene, Processor::X86_64, Shader::PHONG).unwrap().0;
    let picture = frame.picture.as_ref().unwrap();
    let theirs = brightness(picture);
    let whole = ours(scene);
    let covered = picture.covered() as f64 / whole.covered() as f64;
    assert!((covered - 1.0).abs() < 0.02, "{name}: {covered} of our pixels are covered");
    let ours = brightness(&ours(&without(scene, &frame.lacks)));
    println!("{name}: covers {covered:.4} of our pixels, mean brightness {theirs:.3?}, ours {ours:.3?}");
    assert!(theirs.iter().zip(ours).all(|(theirs, ours)| (theirs - ours).abs() < 0.05), "{name}: {theirs:?} bright, we are {ours:?}");
    let also = (scene.name == PEER).then(|| brightness(&whole));
    for ours in iter::once(ours).chain(also) {
        assert!((theirs[1] / ours[1] - 1.0).abs() < 0.15, "{name}: {theirs:?} bright, we are {ours:?}");
    }
}

const SHADERS: [Shader; 3] = [Shader::FLAT, Shader::GOURAUD, Shader::PHONG];

/// Our frames on this computer.
fn counted(program: &Path, scene: &Scene) -> Vec<Measurement> {
    let (size, band_rows) = (Processor::X86_64.size(), Processor::X86_64.size().1);
    let frames = SHADERS.map(|shader| callgrind::Frame { size, band_rows, shader });
    let counts = callgrind::count(program, scene.stream.as_bytes(), &frames).unwrap();
    counts.iter().zip(SHADERS).map(|(count, shader)| count.measurement(&scene.name, shader)).collect()
}

/// Methods and instructions of our frames: on this computer counted, on boards as recorded, which the tests of `bench` check.
fn costs_of_ours(processor: Processor, ours: &[Measurement]) -> Vec<(&'static str, u64)> {
    if processor == Processor::X86_64 {
        return ours.iter().map(|m| (m.shader, m.instructions)).collect();
    }
    let recorded = baseline::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("baselines/costs.csv")).unwrap();
    let of_frame = |m: &Measurement| {
        let entry = recorded.iter().find(|e| e.processor == processor && e.scene == m.scene && e.shader.name() == m.shader);
        let entry = entry.unwrap_or_else(|| panic!("{}, {}, {} is not recorded", processor.name(), m.scene, m.shader));
        (m.shader, entry.instructions)
    };
    ours.iter().map(of_frame).collect()
}

/// Ours is cheaper: Gouraud shading than whatever they do, and each method than theirs of its name.
fn check_costs(frames: &[Frame], ours: &[(&str, u64)]) {
    for frame in frames {
        let (_, method) = frame.shader.rsplit_once(' ').unwrap();
        for (shader, instructions) in ours.iter().filter(|(shader, _)| *shader == "gouraud" || *shader == method) {
            let per_pixel = *instructions as f64 / frame.pixels as f64;
            let text = format!(
                "{}, {}, {}: {} instructions a pixel, our {shader} {per_pixel:.2}",
                frame.cpu, frame.scene, frame.shader, frame.instr_per_pixel
            );
            println!("{text}");
            assert!(*instructions < frame.instructions, "{text}");
        }
    }
}

/// Peers draw ordinary scenes. On three processors the pictures agree to the bit, and peers take more instructions for each.
#[test]
fn they_draw_the_same_frames_and_ours_cost_less() {
    let programs = PROCESSORS.map(|processor| (processor, Program::build(processor).unwrap()));
    let program = callgrind::build().unwrap();
    COMPARED.into_par_iter().for_each(|name| {
        let scene = scene::load(name).unwrap();
        let drawn = programs.par_iter().map(|(processor, program)| (*processor, program.measure(&scene).unwrap()));
        let drawn: Vec<_> = drawn.collect();
        let (_, host) = &drawn[0];
        host.iter().for_each(|frame| check_picture(&scene, frame));
        let ours = counted(&program, &scene);
        for (processor, frames) in &drawn {
            let checksums = |frames: &[Frame]| frames.iter().map(|frame| frame.checksum).collect::<Vec<_>>();
            assert_eq!(checksums(frames), checksums(host), "{name}, {} and the host", processor.name());
            check_costs(frames, &costs_of_ours(*processor, &ours));
        }
        if name == PEER {
            for ((_, program), (_, frames)) in programs.iter().zip(&drawn).skip(1) {
                assert_eq!(program.measure(&scene).unwrap(), *frames, "two runs");
            }
            // They stand in lines like ours, with what is left out.
            let keys = |line: serde_json::Value| line.as_object().unwrap().keys().cloned().collect::<BTreeSet<_>>();
            let mut expected = keys(serde_json::to_value(&ours[0]).unwrap());
            assert!(expected.insert("lacks".to_owned()));
            assert_eq!(keys(serde_json::to_value(&host[0]).unwrap()), expected);
        }
    });
}

/// The output says what peers leave out, and why they cannot draw a scene at all.
#[test]
fn what_they_cannot_draw_is_said() {
    let scene = |name| scene::load(name).unwrap().stream;
    let lacks =
        |name, peer: usize| PEERS[peer].lacks(&scene(name).parse().unwrap()).iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let [retrofire, flat, blinn_phong] = [1, 2, 3];
    assert_eq!([PEER, "bunny", "torus"].map(|name| lacks(name, retrofire)), ["", "", "parallel rays"]);
    assert_eq!(lacks("bunny", flat), "lights but the first, the given ambient light, highlights");
    assert_eq!(lacks("teapot", blinn_phong), "the given ambient light, coloured highlights");
    assert_eq!(lacks("torus", blinn_phong), "parallel rays, the given ambient light");

    let obstacle = |name| peers::obstacle(&scene(name).parse().unwrap()).unwrap();
    assert!(COMPARED.into_iter().all(|name| obstacle(name).is_none()));
    assert!(obstacle("triangle").is_some_and(|why| why.contains("local viewer")));
    assert!(obstacle("sphere-168").is_some_and(|why| why.contains("no ordinary scene")));
}

/// QEMU's clock tells the instructions that its log of all instructions has.
#[test]
fn the_clock_is_exact() {
    let (processor, board) = (Processor::CortexM4F, Board::Mps2An386);
    let scene = scene::load(PEER).unwrap();
    let program = Program::build(processor).unwrap();
    let elf = program.elf(&scene).unwrap();
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
    let clocked: Vec<u64> = program.measure(&scene).unwrap().iter().map(|frame| frame.instructions).collect();
    println!("{traced:?} in the log, {clocked:?} by the clock");
    assert_eq!(traced, clocked);
}
