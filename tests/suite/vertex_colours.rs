//! Colours at the corners of triangles.

use embedded_graphics::{pixelcolor::Rgb565, prelude::Size};
use microphong::{
    format::Gain,
    stream::record::{Colour, CornerColours, HAS_COLOURS, Light, Material},
};
use microphong_sim::{
    board::{Board, build},
    bytes::StreamBytes,
    render::{self, Format, Settings},
    scene,
    shader::Shader,
    stress::records::Records,
    verify::{self, Request},
};

/// The scene of this name, whose corners have colours: `index` tells the number of each in the palette by its vertex.
pub(crate) fn coloured(parts: Records, palette: &[[u8; 3]], index: impl Fn(usize, u16) -> u8) -> StreamBytes {
    let mut parts = parts;
    parts.colours = palette.iter().map(|&channels| Colour::new(channels)).collect();
    let corner = |triangle: usize, corners: [u16; 3]| {
        let colours = corners.map(|corner| index(triangle, corner));
        CornerColours::new(colours, colours.map(|colour| parts.colours[usize::from(colour)]))
    };
    parts.corner_colours = parts.triangles.iter().enumerate().map(|(triangle, record)| corner(triangle, record.corners)).collect();
    parts.meshes.iter_mut().for_each(|mesh| mesh.flags |= HAS_COLOURS);
    parts.written().unwrap()
}

pub(crate) fn parts(name: &str) -> Records {
    Records::of(&scene::load(name).unwrap().stream.parse().unwrap())
}

pub(crate) fn picture(stream: &StreamBytes, shader: Shader, format: Format) -> Vec<u8> {
    let settings = Settings { size: Size::new(160, 120), style: shader.into(), band_rows: 16, format };
    render::picture(stream.parse().unwrap(), &settings, 0).unwrap().rgb
}

/// The largest difference of two pictures.
pub(crate) fn difference(one: &[u8], other: &[u8]) -> u8 {
    one.iter().zip(other).map(|(&a, &b)| a.abs_diff(b)).max().unwrap()
}

pub(crate) const CORE: [Shader; 7] =
    [Shader::FLAT, Shader::GOURAUD, Shader::SIX_POINT, Shader::PHONG, Shader::SQRT6, Shader::AUTO, Shader::AUTO_LINEAR];

/// Lights of one kind each: one, several, near ones.
pub(crate) fn lights() -> [(&'static str, Vec<Light>); 4] {
    let one = Light::directional([1, 2, -2], [1.0, 0.9, 0.8]).unwrap().with_camera();
    let other = Light::directional([-2, 1, -1], [0.2, 0.3, 0.5]).unwrap().with_camera();
    let third = Light::directional([0, -1, -1], [0.2, 0.1, 0.1]).unwrap().with_camera();
    let near = Light::near([1.0, 1.0, -2.0], [0.9, 0.9, 1.0]).unwrap().with_camera();
    [("one", vec![one]), ("two", vec![one, other]), ("three", vec![one, other, third]), ("near", vec![near])]
}

/// White at all corners is no colour.
#[test]
fn white_changes_nothing() {
    for (kind, lights) in lights() {
        let plain = || {
            let mut parts = parts("teapot");
            parts.lights = lights.clone();
            parts
        };
        let (white, stream) = (coloured(plain(), &[[255; 3]], |_, _| 0), plain().written().unwrap());
        for shader in CORE {
            for format in [Format::Rgb888, Format::Gray8] {
                let most = difference(&picture(&white, shader, format), &picture(&stream, shader, format));
                assert!(
                    most <= 1 + u8::from(shader.name().starts_with("auto")),
                    "{} by {}, {kind} light: {most}",
                    format.name(),
                    shader.name()
                );
            }
        }
    }
}

/// One colour at all corners is a material of this colour.
#[test]
fn one_colour_is_a_material() {
    let [r, g, b] = [200u8, 90, 30];
    for (kind, lights) in lights() {
        let plain = |multiplied: bool| {
            let mut parts = parts("teapot");
            parts.lights = lights.clone();
            let by = |colour: [Gain; 3]| {
                let channels = [r, g, b].map(|c| if multiplied { f64::from(c) / 255.0 } else { 1.0 });
                [0, 1, 2].map(|k| Gain::from_num(colour[k].to_num::<f64>() * channels[k]))
            };
            let [material] = &parts.materials[..] else { panic!() };
            parts.materials = vec![Material::new(by(material.ambient()), by(material.diffuse()), material.specular(), material.exponent)];
            parts
        };
        let (colour, stream) = (coloured(plain(false), &[[r, g, b]], |_, _| 0), plain(true).written().unwrap());
        for shader in CORE {
            let (one, other) = (picture(&colour, shader, Format::Rgb888), picture(&stream, shader, Format::Rgb888));
            let most = difference(&one, &other);
            assert!(most <= 1 + u8::from(shader.name().starts_with("auto")), "{}, {kind} light: {most}", shader.name());
        }
    }
}

/// A board draws the bits of this computer: triangles of one colour and of several, small and large, under all kinds of light, by all methods of the core.
#[test]
fn a_board_draws_the_same_bits() {
    let board = Board::Mps2An385;
    let elf = build::styles(board, "rgb565,vertex-colours").unwrap();
    let palette = [[255; 3], [0; 3], [200, 90, 30], [20, 220, 250], [90, 90, 90]];
    for scene in ["teapot", "torus", "dodecahedron"] {
        for (kind, lights) in lights() {
            let mut parts = parts(scene);
            parts.lights = lights;
            let index = |triangle: usize, corner: u16| {
                (if triangle.is_multiple_of(2) { triangle / 2 } else { corner.into() } % palette.len()) as u8
            };
            let stream = coloured(parts, &palette, index).as_bytes().to_vec();
            for shader in CORE {
                let scene = format!("{scene}, {kind} light, {}", shader.name());
                let request = Request { board, scene, stream: stream.clone(), firmware_stream: None, shader, frames: 1, antialias: false };
                verify::checksums::<Rgb565>(&request, &elf).unwrap();
            }
        }
    }
}
