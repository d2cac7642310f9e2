//! Integers against the same method in 64-bit floating point: every method, every scene, all around.

use embedded_graphics::prelude::Size;
use microphong::Shader;
use microphong_sim::{
    level,
    oracle::{Frame, decides, method},
    scene,
};

/// Largest difference allowed, in 1/255.
const LIMIT: f64 = 0.5;

/// Largest difference of `shader` on a scene in some frame, before the output format rounds.
fn error(name: &str, shader: Shader, number: u32) -> Option<f64> {
    let scene = scene::load(name).unwrap();
    let stream = scene.stream.parse().unwrap();
    let frame = Frame::new(stream, scene.size, number);
    let leans: &[f64] = if decides(shader.name()) { &[-0.05, 0.0, 0.05] } else { &[0.0] };
    let shades = |lean| frame.facets.iter().map(|facet| method(shader.name(), &frame, facet, lean).ok()).collect::<Option<Vec<_>>>();
    let shades = leans.iter().map(|&lean| shades(lean)).collect::<Option<Vec<_>>>()?;
    let drawn = level::picture(stream, Size::new(scene.size.0, scene.size.1), shader, number).unwrap();
    let mut worst = 0f64;
    for (i, (levels, candidates)) in drawn.iter().zip(frame.visible()).enumerate() {
        let Some(levels) = levels else {
            assert!(candidates.is_empty(), "{name} {}: pixel {i} is not drawn", shader.name());
            continue;
        };
        let centre = [f64::from(i as u32 % scene.size.0) + 0.5, f64::from(i as u32 / scene.size.0) + 0.5];
        let one = levels[0] == levels[1] && levels[1] == levels[2];
        let difference = |exact: [f64; 3]| {
            // One level for all channels is that of the brightest.
            let all = (0..3).map(|k| (levels[k] - exact[k]).abs()).fold(0.0, f64::max);
            if one { all.min((levels[0] - exact.into_iter().fold(0.0, f64::max)).abs()) } else { all }
        };
        let nearest = candidates.iter().flat_map(|&c| shades.iter().map(move |shades| (shades, c)));
        let error = nearest.map(|(shades, c)| difference(shades[c as usize](centre))).fold(f64::MAX, f64::min);
        worst = worst.max(error);
    }
    Some(worst)
}

#[test]
fn integers_follow_their_method() {
    let step: u32 = std::env::var("STEP").ok().and_then(|s| s.parse().ok()).unwrap_or(40);
    let only = std::env::var("ONLY").unwrap_or_default();
    for shader in Shader::ALL.into_iter().filter(|s| only.is_empty() || only.split(',').any(|o| o == s.name())) {
        for name in scene::NAMES {
            let worst = (0..120).step_by(step as usize).filter_map(|number| error(name, shader, number)).fold(0.0, f64::max);
            println!("{name:12} {:16} {worst:.3} {}", shader.name(), if worst > LIMIT { "TOO MUCH" } else { "" });
        }
    }
}
