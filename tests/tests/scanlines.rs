//! The scanline methods against their definition in 64-bit floating point, before any pixel format rounds them.

use embedded_graphics::geometry::Size;
use microphong::{Shader, Stream};
use microphong_sim::{level, oracle, scene};

/// Largest difference in 1/255, root mean square difference, and pixels above the limit.
fn errors(stream: Stream<'_>, (width, height): (u32, u32), shader: Shader, number: u32, limit: f64) -> Option<(f64, f64, usize)> {
    let pixels = level::picture(stream, Size::new(width, height), shader, number).ok()?;
    let frame = oracle::Frame::new(stream, (width, height), number);
    let shades: Vec<_> = frame.facets.iter().map(|facet| oracle::method(shader.name(), &frame, facet, 0.0).unwrap()).collect();
    let (mut worst, mut at, mut square, mut count, mut over) = (0f64, (0, 0), 0f64, 0, 0);
    for (i, (drawn, near)) in pixels.iter().zip(frame.visible()).enumerate() {
        let Some(drawn) = drawn else { continue };
        let (x, y) = (i as u32 % width, i as u32 / width);
        let one = drawn[0] == drawn[1] && drawn[1] == drawn[2];
        let error = near
            .iter()
            .map(|&facet| {
                let exact = shades[facet as usize]([f64::from(x) + 0.5, f64::from(y) + 0.5]);
                if one {
                    // Walked in one channel, that of the brightest one.
                    (drawn[0] - exact.into_iter().fold(0.0, f64::max)).abs()
                } else {
                    (0..3).map(|k| (drawn[k] - exact[k]).abs()).fold(0.0, f64::max)
                }
            })
            .fold(f64::MAX, f64::min);
        if error == f64::MAX {
            continue;
        }
        if error > worst {
            (worst, at) = (error, (x, y));
        }
        square += error * error;
        count += 1;
        over += usize::from(error > limit);
    }
    let rmse = (square / f64::from(count.max(1))).sqrt();
    println!("frame {number:3}: max {worst:7.3} at {at:?}, rmse {rmse:.4} LSB, {over} of {count} pixels above {limit}");
    Some((worst, rmse, over))
}

#[test]
fn scanlines_are_what_they_are_defined_to_be() {
    let methods = [Shader::Goldman, Shader::Slerp, Shader::Angular, Shader::AngularOriginal, Shader::Hybrid, Shader::HybridOriginal];
    let mut failed = Vec::new();
    for name in scene::NAMES {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for shader in methods {
            for number in [0, 17, 75] {
                print!("{name:12} {:16} ", shader.name());
                match errors(stream, scene.size, shader, number, 0.5) {
                    Some((worst, ..)) if worst > 0.5 => failed.push((name, shader, number, worst)),
                    Some(_) => {}
                    None => {
                        println!("refused");
                        break;
                    }
                }
            }
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}
