//! Integers against the same method in 64-bit floating point: every method, every pixel of every scene, all around.

use embedded_graphics::prelude::Size;
use microphong::stream::{
    record::{Light, Material},
    seal,
};
use microphong_sim::{
    bytes::StreamBytes,
    level,
    oracle::{Frame, Shade, decides, method},
    scene::{self, Scene},
    shader::Shader,
};
use std::{sync::Mutex, thread};
use zerocopy::IntoBytes;

/// Largest difference of a method without decisions, in 1/255: the table of highlights, above all.
const ERROR: f64 = 0.30;
/// Largest difference of a method that decides by a threshold, in 1/255.
const DECIDING_ERROR: f64 = 0.48;
/// Largest difference of any method on materials that are lifted above white, in 1/255.
const BRIGHT_ERROR: f64 = 0.30;
/// Frames of the orbit. Errors differ more from pixel to pixel than from frame to frame, so all pixels of few frames are compared.
const FRAMES: u32 = 18;
/// Frames of the orbit if `MICROPHONG_ALL=1`.
const ALL_FRAMES: u32 = 36;
/// How far integers may be off where a method compares levels with a threshold, at most twice the error of the table of
/// highlights. Several decisions shape a triangle, and each may fall its own way.
const LEANS: [f64; 9] = [0.0, -0.01, 0.01, -0.03, 0.03, -0.07, 0.07, -0.14, 0.14];
/// A larger difference, in 1/255, of a method that decides is compared with what it makes of other decisions.
const UNDECIDED: f64 = 0.25;
/// Where a pixel's centre lies on the border of two parts of a triangle, either may show.
const NUDGE: f64 = 1e-6;

/// All of a method's triangles in one frame, in floating point; `None` if the method cannot shade them.
fn shades<'f>(frame: &'f Frame, shader: Shader, lean: f64) -> Option<Vec<Shade<'f>>> {
    frame.facets.iter().map(|facet| method(shader.name(), frame, facet, lean).ok()).collect()
}

/// Difference of levels; one level for all channels is that of the brightest.
fn difference(drawn: [f64; 3], exact: [f64; 3]) -> f64 {
    let all = (0..3).map(|k| (drawn[k] - exact[k]).abs()).fold(0.0, f64::max);
    let one = drawn[0] == drawn[1] && drawn[1] == drawn[2];
    if one { all.min((drawn[0] - exact.into_iter().fold(0.0, f64::max)).abs()) } else { all }
}

/// Largest difference in one frame of each method, before the output format rounds.
fn errors(scene: &Scene, number: u32) -> Vec<f64> {
    let stream = scene.stream.parse().unwrap();
    let frame = Frame::new(stream, scene.size, number);
    let visible = frame.visible();
    Shader::ALL.iter().map(|&shader| error(scene, &frame, &visible, shader, number)).collect()
}

fn error(scene: &Scene, frame: &Frame, visible: &[Vec<u32>], shader: Shader, number: u32) -> f64 {
    let leans: &[f64] = if decides(shader.name()) { &LEANS } else { &[0.0] };
    let shades: Option<Vec<_>> = leans.iter().map(|&lean| shades(frame, shader, lean)).collect();
    let Some(shades) = shades else { return 0.0 };
    let size = Size::new(scene.size.0, scene.size.1);
    let drawn = level::picture(scene.stream.parse().unwrap(), size, shader, number).unwrap();
    let (mut worst, mut missing) = (0f64, 0);
    for (i, (levels, candidates)) in drawn.iter().zip(visible).enumerate() {
        missing += usize::from(levels.is_none() && !candidates.is_empty());
        let Some(levels) = *levels else { continue };
        assert!(!candidates.is_empty(), "{} {}: pixel {i}", scene.name, shader.name());
        let centre = [i as u32 % scene.size.0, i as u32 / scene.size.0].map(|c| f64::from(c) + 0.5);
        let at = |x: f64, y: f64, leans: usize| {
            let point = [centre[0] + x, centre[1] + y];
            let all = candidates.iter().flat_map(|&c| shades.iter().take(leans).map(move |shades| &shades[c as usize]));
            all.map(|shade| difference(levels, shade(point))).fold(f64::MAX, f64::min)
        };
        let mut error = at(0.0, 0.0, 1);
        if error > UNDECIDED && decides(shader.name()) {
            let around = [(0.0, 0.0), (NUDGE, NUDGE), (NUDGE, -NUDGE), (-NUDGE, NUDGE), (-NUDGE, -NUDGE)];
            error = around.map(|(x, y)| at(x, y, leans.len())).into_iter().fold(error, f64::min);
        }
        worst = worst.max(error);
    }
    assert!(missing == 0, "{} {}: {missing} pixels are missing", scene.name, shader.name());
    worst
}

#[test]
fn integers_follow_their_method() {
    let frames = if std::env::var_os("MICROPHONG_ALL").is_some_and(|v| v == "1") { ALL_FRAMES } else { FRAMES };
    let scenes: Vec<Scene> = scene::NAMES.iter().map(|name| scene::load(name).unwrap()).collect();
    let jobs = Mutex::new(scenes.iter().flat_map(|scene| (0..frames).map(move |k| (scene, k))));
    let worst = Mutex::new(vec![(0.0, ""); Shader::ALL.len()]);
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let job = jobs.lock().unwrap().next();
                    let Some((scene, k)) = job else { break };
                    let period = scene.stream.parse().unwrap().header.camera.period.max(1);
                    let errors = errors(scene, k * u32::from(period) / frames);
                    for (worst, error) in worst.lock().unwrap().iter_mut().zip(errors) {
                        if error > worst.0 {
                            *worst = (error, &scene.name);
                        }
                    }
                }
            });
        }
    });
    let worst = worst.into_inner().unwrap();
    for (shader, (error, place)) in Shader::ALL.iter().zip(&worst) {
        println!("{:20} {error:.3} LSB at most, on {place}", shader.name());
    }
    for (shader, (error, place)) in Shader::ALL.iter().zip(&worst) {
        let limit = if decides(shader.name()) { DECIDING_ERROR } else { ERROR };
        assert!(*error <= limit, "{}: {error} LSB on {place}, at most {limit} are allowed", shader.name());
    }
}

/// A light brighter than full, on a material that it lifts above white.
#[test]
fn bright_lights_are_clamped_at_the_end() {
    let mut scene = scene::load("sphere-168").unwrap();
    let mut bytes = scene.stream.as_bytes().to_vec();
    let stream = scene.stream.parse().unwrap();
    let place = |record: *const u8| record as usize - scene.stream.as_bytes().as_ptr() as usize;
    for light in stream.lights {
        let bright = Light { colour: light.colour.map(|c| (u32::from(c) * 8 / 5) as u16), ..*light };
        bytes[place((&raw const *light).cast())..][..size_of::<Light>()].copy_from_slice(bright.as_bytes());
    }
    for material in stream.materials {
        let matte = Material {
            diffuse: material.diffuse.map(|c| (u32::from(c) * 8 / 5) as u16),
            specular: material.specular.map(|c| c / 10),
            ..*material
        };
        bytes[place((&raw const *material).cast())..][..size_of::<Material>()].copy_from_slice(matte.as_bytes());
    }
    seal(&mut bytes);
    scene.stream = StreamBytes::from(&bytes[..]);
    for (shader, error) in Shader::ALL.iter().zip(errors(&scene, 7)) {
        println!("{:20} {error:.3} LSB at most", shader.name());
        assert!(error <= BRIGHT_ERROR, "{}: {error} LSB", shader.name());
    }
}
