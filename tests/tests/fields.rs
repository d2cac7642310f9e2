//! Methods that walk polynomials, against the same methods in 64-bit floating point: what is left is arithmetic.

use embedded_graphics::prelude::Size;
use microphong::Shader;
use microphong_sim::{
    level,
    oracle::{Frame, decides, method},
    scene,
};

/// Methods, and the error that each may have on any pixel of any scene, LSB.
const METHODS: [(Shader, f64); 7] = [
    (Shader::HighlightTest, 0.5),
    (Shader::Taylor, 0.5),
    (Shader::TaylorFinite, 0.5),
    (Shader::Cubic, 0.5),
    (Shader::Environment, 0.5),
    (Shader::Blinn, 0.5),
    (Shader::QuadraticBlinn, 0.5),
];

/// By how many levels a threshold may lie elsewhere in integers.
const LEAN: f64 = 0.01;

/// The largest difference on a frame, and where.
fn error(stream: microphong::Stream<'_>, (width, height): (u32, u32), shader: Shader, number: u32) -> Option<(f64, u32, u32)> {
    let Ok(picture) = level::picture(stream, Size::new(width, height), shader, number) else {
        assert!(shader.needs_constant_light() && !stream.is_constant(), "{} is refused", shader.name());
        return None;
    };
    let frame = Frame::new(stream, (width, height), number);
    let leans: &[f64] = if decides(shader.name()) { &[0.0, -LEAN, LEAN] } else { &[0.0] };
    let build = |facet| leans.iter().map(|&lean| method(shader.name(), &frame, facet, lean).unwrap()).collect::<Vec<_>>();
    let shades: Vec<_> = frame.facets.iter().map(build).collect();
    let mut worst = (0f64, 0, 0);
    for (k, (contenders, levels)) in frame.visible().into_iter().zip(picture).enumerate() {
        let (x, y) = (k as u32 % width, k as u32 / width);
        let Some(levels) = levels else {
            assert!(contenders.is_empty(), "{}: nothing at {x},{y}", shader.name());
            continue;
        };
        let difference = |exact: [f64; 3]| {
            // One level for all channels is that of the brightest.
            let exact = if levels == [levels[0]; 3] { [exact.into_iter().fold(0.0, f64::max); 3] } else { exact };
            (0..3).map(|c| (levels[c] - exact[c]).abs()).fold(0.0, f64::max)
        };
        let centre = [f64::from(x) + 0.5, f64::from(y) + 0.5];
        let all = contenders.iter().flat_map(|&index| &shades[index as usize]).map(|shade| difference(shade(centre)));
        let least = all.fold(f64::MAX, f64::min);
        if least > worst.0 {
            worst = (least, x, y);
        }
    }
    Some(worst)
}

#[test]
fn integers_are_within_half_a_level() {
    let mut failures = Vec::new();
    for (shader, limit) in METHODS {
        for name in scene::NAMES {
            let scene = scene::load(name).unwrap();
            let stream = scene.stream.parse().unwrap();
            for number in [0, 17, 65] {
                if let Some((error, x, y)) = error(stream, scene.size, shader, number) {
                    println!("{:16} {name:13} frame {number:2}: {error:.3} at {x},{y}", shader.name());
                    if error > limit {
                        failures.push(format!("{} {name} frame {number}: {error} at {x},{y}", shader.name()));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
