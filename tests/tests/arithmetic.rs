//! Integers against the same method in 64-bit floating point: every method, every scene, all around.

use embedded_graphics::prelude::Size;
use microphong::Shader;
use microphong_sim::{
    level,
    oracle::{Frame, Shade, decides, method},
    scene::{self, Scene},
};
use std::{sync::Mutex, thread};

/// Largest difference allowed, in 1/255.
const LIMIT: f64 = 0.5;
/// Frames of the orbit.
const FRAMES: u32 = 36;
/// One in so many pixels is compared, other ones in each frame; all of them if `MICROPHONG_ALL=1`.
const SAMPLE: usize = 5;
/// How far integers may be off where a method compares a level with a threshold: the error of the table of highlights.
const LEAN: f64 = 0.12;
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

/// Largest difference of `shader` in one frame, before the output format rounds.
fn error(scene: &Scene, shader: Shader, number: u32, every: usize) -> f64 {
    let stream = scene.stream.parse().unwrap();
    let frame = Frame::new(stream, scene.size, number);
    let leans: &[f64] = if decides(shader.name()) { &[0.0, -LEAN, LEAN] } else { &[0.0] };
    let shades: Option<Vec<_>> = leans.iter().map(|&lean| shades(&frame, shader, lean)).collect();
    let Some(shades) = shades else { return 0.0 };
    let drawn = level::picture(stream, Size::new(scene.size.0, scene.size.1), shader, number).unwrap();
    let mut worst = 0f64;
    for (i, (levels, candidates)) in drawn.iter().zip(frame.visible()).enumerate() {
        assert_eq!(levels.is_none(), candidates.is_empty(), "{} {}: pixel {i}", scene.name, shader.name());
        let Some(levels) = levels.filter(|_| (i + number as usize).is_multiple_of(every)) else { continue };
        let centre = [i as u32 % scene.size.0, i as u32 / scene.size.0].map(|c| f64::from(c) + 0.5);
        let at = |x: f64, y: f64| {
            let point = [centre[0] + x, centre[1] + y];
            let all = candidates.iter().flat_map(|&c| shades.iter().map(move |shades| &shades[c as usize]));
            all.map(|shade| difference(levels, shade(point))).fold(f64::MAX, f64::min)
        };
        let mut error = at(0.0, 0.0);
        if error > LIMIT && decides(shader.name()) {
            let around = [(NUDGE, NUDGE), (NUDGE, -NUDGE), (-NUDGE, NUDGE), (-NUDGE, -NUDGE)];
            error = around.map(|(x, y)| at(x, y)).into_iter().fold(error, f64::min);
        }
        worst = worst.max(error);
    }
    worst
}

#[test]
fn integers_follow_their_method() {
    let every = if std::env::var_os("MICROPHONG_ALL").is_some_and(|v| v == "1") { 1 } else { SAMPLE };
    let scenes: Vec<Scene> = scene::NAMES.iter().map(|name| scene::load(name).unwrap()).collect();
    let jobs = Mutex::new(Shader::ALL.iter());
    let wrong = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let Some(&shader) = jobs.lock().unwrap().next() else { break };
                    let worst = scenes.iter().map(|scene| {
                        let period = scene.stream.parse().unwrap().header.camera.period.max(1);
                        let frames = (0..FRAMES).map(|k| k * u32::from(period) / FRAMES);
                        (frames.map(|number| error(scene, shader, number, every)).fold(0.0, f64::max), scene.name.as_str())
                    });
                    let worst: Vec<_> = worst.collect();
                    let (most, place) = worst.iter().copied().fold((0.0, ""), |a, b| if b.0 > a.0 { b } else { a });
                    println!("{:20} {most:.3} LSB at most, on {place}", shader.name());
                    wrong
                        .lock()
                        .unwrap()
                        .extend(worst.iter().filter(|w| w.0 > LIMIT).map(|w| format!("{} {}: {}", shader.name(), w.1, w.0)));
                }
            });
        }
    });
    let wrong = wrong.into_inner().unwrap();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
