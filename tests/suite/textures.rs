//! Textures.

use crate::{
    golden::root,
    vertex_colours::{CORE, coloured, difference, lights, parts, picture},
};
use embedded_graphics::{
    pixelcolor::{Rgb565, Rgb666, Rgb888},
    prelude::Size,
};
use microphong::{
    StreamError,
    format::Gain,
    pixel::{Light, Pixel},
    stream::record::{Colour, HAS_TEXTURE, Material, Mesh, Texture, TextureCorners},
};
use microphong_sim::{
    bench::{Bench, Processor, board_styles::Program},
    board::{Board, build},
    bytes::StreamBytes,
    render::{self, Format, Settings},
    scene::{self, Scene},
    shader::Shader,
    stress::records::Records,
    verify::{self, Request},
};
use std::fs;

/// The scene `records`, all of whose meshes have a texture of these colours. `place` tells where each vertex lies in it.
pub(crate) fn textured(
    mut records: Records,
    [width, height]: [u8; 2],
    colours: &[[u8; 3]],
    place: impl Fn(u16) -> [u16; 2],
) -> StreamBytes {
    records.colours = colours.iter().map(|&channels| Colour::new(channels)).collect();
    records.texels = (0..1usize << (width + height)).map(|texel| (texel % colours.len()) as u8).collect();
    records.texels.resize(records.texels.len().next_multiple_of(4), 0);
    records.textures = vec![Texture { size: [width, height], palette: 0, has_holes: 0 }];
    records.texture_corners = records.triangles.iter().map(|triangle| TextureCorners(triangle.corners.map(&place))).collect();
    records.meshes.iter_mut().for_each(|mesh| *mesh = Mesh { flags: mesh.flags | HAS_TEXTURE, palette: 0, ..*mesh });
    records.written().unwrap()
}

/// A place that differs from vertex to vertex.
pub(crate) fn anywhere(vertex: u16) -> [u16; 2] {
    [vertex.wrapping_mul(1_237) % 9_000, vertex.wrapping_mul(3_571) % 9_000]
}

/// A texture of one colour is one colour at all corners. Light that methods interpolate is rounded otherwise.
#[test]
fn one_colour_is_that_of_corners() {
    for (kind, lights) in lights() {
        for colour in [[255; 3], [200, 90, 30], [10, 10, 20]] {
            let plain = || Records { lights: lights.clone(), ..parts("teapot") };
            let (texture, corners) = (textured(plain(), [3, 1], &[colour], anywhere), coloured(plain(), &[colour], |_, _| 0));
            for shader in CORE {
                for format in [Format::Rgb888, Format::Gray8] {
                    let most = difference(&picture(&texture, shader, format), &picture(&corners, shader, format));
                    let allowed = 1 + 2 * u8::from(shader.name().starts_with("auto"));
                    assert!(most <= allowed, "{} by {}, {kind} light: {most}", format.name(), shader.name());
                }
            }
        }
    }
}

/// A board draws the bits of this computer in a pixel format: these scenes with a texture and, if `plain`, without.
fn draws_the_same_bits<C: Pixel>(format: &str, scenes: &[&str], plain: bool) {
    let board = Board::Mps2An385;
    let elf = build::styles(board, &format!("{format},textures")).unwrap();
    let colours = [[255; 3], [0; 3], [200, 90, 30], [20, 220, 250], [90, 90, 90]];
    for scene in scenes {
        for (kind, lights) in lights() {
            let records = || Records { lights: lights.clone(), ..parts(scene) };
            let mut streams = vec![textured(records(), [5, 4], &colours, anywhere)];
            if plain {
                streams.push(records().written().unwrap());
            }
            for (stream, shader) in streams.iter().flat_map(|stream| CORE.map(|shader| (stream.as_bytes().to_vec(), shader))) {
                let scene = format!("{scene}, {kind} light, {}, {format}", shader.name());
                let request = Request { board, scene, stream, firmware_stream: None, shader, frames: 1, antialias: false };
                verify::checksums::<C>(&request, &elf).unwrap();
            }
        }
    }
}

#[test]
fn a_board_draws_the_same_bits() {
    draws_the_same_bits::<Rgb565>("rgb565", &["teapot", "dodecahedron"], false);
}

/// Kernels draw pixels of four bytes, too.
#[test]
fn a_board_draws_the_same_bits_in_other_formats() {
    draws_the_same_bits::<Rgb888>("rgb888", &["teapot"], true);
    draws_the_same_bits::<Rgb666>("rgb666", &["teapot"], true);
    draws_the_same_bits::<Light<5, 6, 5>>("light-rgb565", &["teapot"], true);
}

/// A white material with this much of highlights.
pub(crate) fn white(specular: f64) -> Material {
    let gain = |gain: f64| [Gain::from_num(gain); 3];
    Material::new(gain(0.18), gain(0.7), gain(specular), 30)
}

/// How far a figure of the guide may be from what is counted, in instructions a pixel.
const SLACK: f64 = 1.0;

#[test]
fn costs_of_textures_are_those_of_the_guide() {
    let shaders = [Shader::FLAT, Shader::GOURAUD, Shader::PHONG, Shader::AUTO];
    let processor = Processor::CortexM3;
    let [plain, with] = [Program::PLAIN, Program::TEXTURES].map(|program| Bench::of_program(&[processor], program).unwrap());
    let wanted = shaders.map(|shader| (processor, shader));
    let scene = scene::load("sphere-374").unwrap();
    let colours: Vec<_> = (0..=40).map(|k| [6 * k, 255 - 5 * k, 37 * (k % 7)]).collect();
    let found = [0.0, 0.3].map(|specular| {
        let white = || Records { materials: vec![white(specular)], ..parts("sphere-374") };
        let of = |stream| Scene { stream, ..scene.clone() };
        let scenes = [of(white().written().unwrap()), of(textured(white(), [6, 6], &colours, |vertex| [vertex << 7, vertex << 6 & 0xFFF]))];
        let size = Size::new(scene.size.0, scene.size.1);
        let settings = Settings { size, style: Shader::GOURAUD.into(), band_rows: scene.size.1, format: Format::Rgb565 };
        let pixels = f64::from(render::picture(scenes[0].stream.parse().unwrap(), &settings, 0).unwrap().stats.pixels);
        let count = |bench: &Bench, scene: &Scene| -> Vec<f64> {
            bench.count(scene, &wanted, &|| ()).unwrap().iter().map(|found| found.instructions as f64 / pixels).collect()
        };
        [count(&plain, &scenes[0]), count(&with, &scenes[1])]
    });
    let guide = fs::read_to_string(root().join("../docs/guide/costs.md")).unwrap();
    let (_, table) = guide.split_once("| more with a texture |").unwrap();
    println!("instructions a pixel: matt without a texture, more with one; glossy likewise");
    let lines: Vec<_> = shaders
        .into_iter()
        .enumerate()
        .map(|(k, shader)| {
            let [[matt, textured], [glossy, both]] = found.each_ref().map(|counts| counts.each_ref().map(|counts| counts[k]));
            let more = [textured - matt, both - glossy];
            (shader, more, format!("{:8} {matt:6.1} {:6.1} {glossy:6.1} {:6.1}", shader.name(), more[0], more[1]))
        })
        .collect();
    lines.iter().for_each(|(.., line)| println!("{line}"));
    for (shader, more, line) in lines {
        let row = table.lines().find(|row| row.starts_with(&format!("| `{}` |", shader.name()))).unwrap();
        let told = [2, 3].map(|cell| row.split('|').nth(cell).unwrap().trim().parse::<f64>().unwrap());
        assert!((0..2).all(|k| (more[k] - told[k]).abs() <= SLACK), "{line}, and {told:?} in the guide");
    }
}

/// Whatever a texture lacks is an error that names it.
#[test]
fn wrong_textures_are_refused() {
    let right = || Records::of(&textured(parts("dodecahedron"), [2, 2], &[[9; 3]; 16], anywhere).parse().unwrap());
    let found = |change: &dyn Fn(&mut Records)| {
        let mut records = right();
        change(&mut records);
        match StreamBytes::from(&records.bytes(|_| ())[..]).parse() {
            Ok(stream) => panic!("{} textures are right", stream.textures().list.len()),
            Err(StreamError::Field { name, .. }) => name,
            Err(other) => panic!("{other}"),
        }
    };
    assert!(right().written().is_some());
    assert_eq!(found(&|records| records.textures[0].size = [9, 0]), "mesh texture");
    assert_eq!(found(&|records| records.textures[0].size = [3, 2]), "mesh texture");
    let with_another = |records: &mut Records, size| {
        records.textures.insert(0, Texture { size, palette: 0, has_holes: 0 });
        records.meshes[0].palette = 1;
    };
    assert_eq!([[9, 0], [0, 0]].map(|size| found(&|records| with_another(records, size))), ["mesh texture"; 2]);
    assert_eq!(found(&|records| records.textures[0].palette = 2), "mesh texture");
    assert_eq!(found(&|records| records.meshes[0].palette = 1), "mesh texture");
    assert_eq!(found(&|records| records.texels[5] = 16), "texel of a mesh");
    assert_eq!(found(&|records| records.texture_corners.truncate(1)), "mesh texture");
    assert_eq!(found(&|records| records.texture_corners.push(TextureCorners([[0; 2]; 3]))), "texture corners");
    assert_eq!(found(&|records| records.texels.truncate(12)), "mesh texture");
    assert_eq!(found(&|records| records.meshes[0].flags |= 4), "mesh colours");
}

/// A texture is seen in perspective, whatever the interpolation of light: a checkerboard on a plane that reaches far has the same squares if the plane is
/// cut into more triangles.
#[test]
fn squares_are_seen_in_perspective() {
    let plane = |cuts: usize| {
        let mut text = String::new();
        for row in 0..=cuts {
            for column in 0..=cuts {
                let [x, z] = [column, row].map(|k| 2.0 * k as f64 / cuts as f64 - 1.0);
                text += &format!("v {x} 0 {z}\nvt {} {}\n", (x + 1.0) / 2.0, (z + 1.0) / 2.0);
            }
        }
        for row in 0..cuts {
            for column in 0..cuts {
                let a = row * (cuts + 1) + column + 1;
                let [a, b, c, d] = [a, a + cuts + 1, a + cuts + 2, a + 1];
                text += &format!("f {a}/{a} {b}/{b} {c}/{c}\nf {a}/{a} {c}/{c} {d}/{d}\n");
            }
        }
        text
    };
    let drawn = |cuts: usize| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plane.obj");
        std::fs::write(&path, plane(cuts)).unwrap();
        let scene = scene::load(path.to_str().unwrap()).unwrap();
        let records = Records::of(&scene.stream.parse().unwrap());
        let positions: Vec<[i16; 3]> = records.vertices.iter().map(|vertex| vertex.position).collect();
        let most = f64::from(positions.iter().flatten().copied().max().unwrap());
        let place = |vertex: u16| {
            let [x, _, z] = positions[usize::from(vertex)];
            [x, z].map(|c| ((f64::from(c) / most + 1.0) * 2_048.0).round().min(4_095.0) as u16)
        };
        picture(&textured(records, [3, 3], &[[255; 3], [0; 3], [200, 0, 0]], place), Shader::FLAT, Format::Rgb888)
    };
    let (coarse, fine) = (drawn(1), drawn(16));
    let apart = coarse.chunks(3).zip(fine.chunks(3)).filter(|(one, other)| difference(one, other) > 8).count();
    let dark = fine.chunks(3).filter(|pixel| pixel.iter().all(|&c| c < 8)).count();
    assert!(dark > 200 && apart < 200, "{apart} pixels apart of {dark} dark ones");
}
