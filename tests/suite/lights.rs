//! Lights with a range or a cone, and light from the sky.

use crate::golden::{bless, check_pixels, root};
use embedded_graphics::prelude::Size;
use microphong::{
    Light,
    format::{Angle, Gain},
    stream::record::Material,
};
use microphong_sim::{
    bytes::StreamBytes,
    render::{self, Format, Settings},
    scene,
    shader::Shader,
    stress::records::Records,
};

/// A light in front of the teapot, whose range and cone end on it.
pub(crate) fn spotlight() -> Light {
    let degrees = |degrees: f32| Angle::from_num(degrees / 360.0);
    let light = Light::near([0.5, 0.8, -2.2], [1.0, 0.95, 0.9]).unwrap().with_camera();
    light.with_range(2.5).unwrap().with_cone([-0.2, -0.35, -1.0], degrees(10.0), degrees(24.0)).unwrap()
}

/// A blue sky, and ground of earth.
pub(crate) fn hemisphere() -> [Light; 2] {
    Light::hemisphere([0, 1, 0], [0.5, 0.6, 0.8], [0.35, 0.25, 0.15]).unwrap()
}

/// The scene of this name in the light of `lights`.
pub(crate) fn lit(name: &str, lights: &[Light]) -> StreamBytes {
    scene::load(name).unwrap().stream.with_lights(lights).unwrap()
}

#[test]
fn pictures() {
    let bless = bless();
    let [sky, ground] = hemisphere();
    let scenes = [("spotlight", vec![spotlight()]), ("hemisphere", vec![sky, ground]), ("all", vec![sky, ground, spotlight()])];
    let wrong = |(name, lights): (&str, Vec<Light>)| {
        let stream = lit("teapot", &lights);
        let of = |shader: Shader| {
            let settings = Settings { size: Size::new(160, 120), style: shader.into(), band_rows: 16, format: Format::Rgb888 };
            let drawn = render::picture(stream.parse().unwrap(), &settings, 0).unwrap().rgb;
            check_pixels(&root().join(format!("golden/teapot-{name}-{}.png", shader.name())), settings.size, &drawn, bless)
        };
        [Shader::FLAT, Shader::GOURAUD, Shader::SIX_POINT, Shader::PHONG].into_iter().filter_map(of).collect::<Vec<_>>()
    };
    let wrong = scenes.map(wrong).concat();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A white matt sphere under a white sky is (1 + y)/2 bright: full at its top, half at its equator.
#[test]
fn a_surface_gets_as_much_light_as_it_sees_of_the_sky() {
    let mut parts = Records::of(&scene::load("sphere-690").unwrap().stream.parse().unwrap());
    parts.lights = vec![Light::sky([0, 1, 0], [1, 1, 1]).unwrap().with_camera()];
    let (black, white) = ([Gain::ZERO; 3], [Gain::ONE; 3]);
    parts.materials = vec![Material::new(black, white, black, 1)];
    let stream = parts.written().unwrap();
    for shader in [Shader::GOURAUD, Shader::SIX_POINT, Shader::SQRT6, Shader::PHONG, Shader::AUTO] {
        let settings = Settings { size: Size::new(200, 200), style: shader.into(), band_rows: 16, format: Format::Rgb888 };
        let rgb = render::picture(stream.parse().unwrap(), &settings, 0).unwrap().rgb;
        let column: Vec<u8> = (0..200).map(|row| rgb[3 * (200 * row + 100)]).collect();
        let middle = column[100];
        assert!(middle.abs_diff(128) <= 3, "{}: {middle} in the middle", shader.name());
        let lit: Vec<u8> = column.iter().copied().filter(|&level| level != column[0]).collect();
        let (top, bottom) = (lit[2], lit[lit.len() - 3]);
        assert!(top > 225 && bottom < 60, "{}: {top} at the top, {bottom} at the bottom", shader.name());
    }
}

/// Where neither range nor cone of a light reaches, the picture is that of a scene without the light.
#[test]
fn lights_end_where_they_say() {
    let degrees = |degrees: f32| Angle::from_num(degrees / 360.0);
    // The light is two units in front of the teapot. Its cone points away from the teapot, or its range ends before it.
    let near = Light::near([0, 0, -1], [1, 1, 1]).unwrap().with_camera();
    let away = near.with_cone([0, 0, 1], degrees(20.0), degrees(60.0)).unwrap();
    let short = near.with_range(0.5).unwrap();
    let drawn = |lights: &[Light], shader: Shader| {
        let settings = Settings { size: Size::new(160, 120), style: shader.into(), band_rows: 16, format: Format::Rgb888 };
        render::picture(lit("teapot", lights).parse().unwrap(), &settings, 0).unwrap().rgb
    };
    for shader in Shader::CORE {
        let dark = drawn(&[], shader);
        assert!(drawn(&[near], shader) != dark, "{}", shader.name());
        for light in [away, short] {
            // Rounding of light that is not there may differ by one.
            let differing = drawn(&[light], shader).iter().zip(&dark).filter(|(a, b)| a.abs_diff(**b) > 1).count();
            assert_eq!(differing, 0, "{}", shader.name());
        }
    }
}
