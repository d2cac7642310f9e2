//! Colours with the curve of a display, compared with colours without it and the curve in floating point.

use embedded_graphics::{
    geometry::Size,
    pixelcolor::{Gray8, Rgb888, raw::RawU8},
    prelude::*,
};
use microphong_sim::{
    render::{self, Style},
    scene::{self, Scene},
    shader::Shader,
};

/// The value that a display with the curve of sRGB is sent for a level, both in [0, 255].
fn srgb(level: f64) -> f64 {
    let level = level.clamp(0.0, 255.0) / 255.0;
    255.0 * if level <= 0.003_130_8 { 12.92 * level } else { 1.055 * level.powf(1.0 / 2.4) - 0.055 }
}

fn size(scene: &Scene) -> Size {
    scene.size.into()
}

/// The pictures of a scene without the curve and with it.
fn both<C: microphong::pixel::Pixel>(scene: &Scene, shader: Shader) -> [Vec<C>; 2] {
    let stream = scene.stream.parse().expect("built-in scene");
    let draw = |srgb| render::frame(stream, size(scene), Style { srgb, ..shader.into() }, 16, 0).expect("built-in scene").0;
    [draw(false), draw(true)]
}

/// In one channel every pixel is the curve of the pixel without it, to rounding, by own loops and by the general loop.
#[test]
fn one_channel_follows_the_curve() {
    let scene = scene::load("sphere-168").expect("built-in scene");
    for shader in [Shader::FLAT, Shader::GOURAUD, Shader::PHONG, Shader::AUTO] {
        let [linear, curved] = both::<Gray8>(&scene, shader);
        let value = |pixel: Gray8| RawU8::from(pixel).into_inner();
        let (background, mut judged) = (value(linear[0]), 0);
        for (linear, curved) in linear.into_iter().map(value).zip(curved.into_iter().map(value)) {
            if linear != background {
                assert_eq!(f64::from(curved), srgb(linear.into()).round(), "{}: {linear}", shader.name());
                judged += 1;
            }
        }
        assert!(judged > 10_000, "{}: {judged} pixels", shader.name());
    }
}

/// In three channels every pixel is the curve of the pixel without it, and light is not rounded before. The background stays.
#[test]
fn three_channels_follow_the_curve() {
    let scene = scene::load("bunny").expect("built-in scene");
    for shader in [Shader::FLAT, Shader::GOURAUD, Shader::AUTO] {
        let [linear, curved] = both::<Rgb888>(&scene, shader);
        let (background, mut judged) = (linear[0], 0);
        assert_eq!(background, curved[0]);
        for (linear, curved) in linear.into_iter().zip(curved).filter(|(linear, _)| *linear != background) {
            for (linear, curved) in [(linear.r(), curved.r()), (linear.g(), curved.g()), (linear.b(), curved.b())] {
                let around = [-1.0, 1.0].map(|off| srgb(f64::from(linear) + off) + off);
                assert!((around[0]..=around[1]).contains(&f64::from(curved)), "{}: {linear} became {curved}", shader.name());
            }
            judged += 1;
        }
        assert!(judged > 1_000, "{}: {judged} pixels", shader.name());
    }
}
