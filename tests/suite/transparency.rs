//! Transparent surfaces, and holes in textures.

use crate::{
    textures::white,
    vertex_colours::{CORE, lights, parts},
};
use embedded_graphics::{pixelcolor::*, prelude::Size};
use microphong::{
    Layout, Renderer, Stream, StreamError,
    pixel::{Light, LightGray, Pixel},
    renderer,
    stream::record::{self, Colour, HAS_TEXTURE, Mesh, TRANSPARENCY_SHIFT, Texture, TextureCorners},
};
use microphong_literature as literature;
use microphong_sim::{
    bench::{Bench, Processor, board_styles::Program},
    board::{Board, build},
    bytes::StreamBytes,
    render::{self, Format, Settings, Style},
    scene::{self, Scene},
    shader::Shader,
    stress::records::Records,
    verify::{self, Request},
};
use std::cmp::Reverse;

const SIZE: Size = Size::new(96, 72);

/// The pixels of a scene of which these objects are visible.
fn drawn<C: Pixel>(stream: Stream<'_>, shader: Shader, rows: usize, visible: &[usize]) -> Vec<C> {
    let layout = Layout::new(SIZE.width as usize, rows).vertices(stream.vertices.len()).triangles(1_000).materials(8).objects(16);
    let mut memory = vec![0; layout.words::<C>()];
    let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, shader.on()).unwrap();
    for object in 0..renderer.scene().objects().len() {
        renderer.scene().set_visible(object, visible.contains(&object)).unwrap();
    }
    let (mut pixels, mut band) = (Vec::new(), vec![C::pack([0; 3]); layout.band()]);
    let mut frame = renderer.frame(0);
    while let Some(area) = frame.next_band(&mut band).unwrap() {
        pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
    }
    pixels
}

/// The board with pieces of glass: pawns and rooks, which are convex. It has two lights, and `more`.
fn glass(transparency: [u8; 2], ambient: u16, more: &[record::Light]) -> StreamBytes {
    let mut records = parts("board");
    records.lights.extend(more);
    for (mesh, transparency) in records.meshes.iter_mut().skip(1).zip(transparency) {
        mesh.flags |= transparency << TRANSPARENCY_SHIFT;
        records.materials[usize::from(mesh.material)].ambient[0] += ambient;
    }
    records.written().unwrap()
}

/// A pixel keeps its share of what is behind each surface, from the farthest to the nearest: exactly the colours that are drawn without transparency, mixed
/// one by one. Objects without transparency are drawn first, wherever they lie.
fn assert_mixed<C: Pixel>(shader: Shader, more: &[record::Light]) {
    let mixed = [5, 11];
    let stream = glass(mixed, 0, more);
    let stream = stream.parse().unwrap();
    // What an object covers is seen by the change of another ambient light.
    let [opaque, brighter] = [0, 6_000].map(|ambient| glass([0, 0], ambient, more));
    let [opaque, brighter] = [&opaque, &brighter].map(|stream| stream.parse().unwrap());
    let mesh_of = |object: usize| usize::from(stream.instances[object].first_mesh);
    let (clear, solid): (Vec<usize>, Vec<usize>) = (0..stream.instances.len()).partition(|&object| (1..3).contains(&mesh_of(object)));
    let far_first = {
        let layout = render::layout(&stream, SIZE, SIZE.height);
        let mut memory = vec![0; layout.words::<C>()];
        let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, shader.on::<C>()).unwrap();
        let _ = renderer.frame(0);
        // The camera looks from (0, 0.72, 4.2) at (0, 0.5, 0). Of equally far objects the earlier one is nearer.
        let nearness = |&object: &usize| {
            let [_, y, z] = renderer.scene().objects()[object].pose().position().map(|length| i64::from(length.to_bits()));
            (22 * y + 420 * z, Reverse(object))
        };
        let mut order = clear.clone();
        order.sort_by_key(nearness);
        order
    };
    let mut expected = drawn::<C>(opaque, shader, 24, &solid);
    let empty = expected.clone();
    for object in far_first {
        let visible = [&solid[..], &[object]].concat();
        let [alone, other] = [opaque, brighter].map(|stream| drawn::<C>(stream, shader, 24, &visible));
        let share = u32::from(mixed[mesh_of(object) - 1]) * 8;
        let mut covered = 0;
        for (k, pixel) in expected.iter_mut().enumerate() {
            if [&alone, &other].iter().any(|picture| picture[k].bits() != empty[k].bits()) {
                *pixel = alone[k].mixed_with(*pixel, share, None);
                covered += 1;
            }
        }
        assert!(covered > 40, "object {object} covers {covered} pixels");
    }
    for rows in [1, 7, 24, 72] {
        let found = drawn::<C>(stream, shader, rows, &(0..stream.instances.len()).collect::<Vec<_>>());
        let unequal = found.iter().zip(&expected).filter(|(found, expected)| found.bits() != expected.bits());
        assert_eq!(unequal.count(), 0, "{}, bands of {rows} rows", shader.name());
    }
}

/// A light in addition. Loops for three lights and more walk each of them by itself.
fn third() -> [record::Light; 1] {
    [record::Light::directional([0, -1, -1], [0.2, 0.1, 0.1]).unwrap().with_camera()]
}

#[test]
fn glass_shows_a_share_of_what_is_behind_it() {
    for more in [&[][..], &third()] {
        for shader in CORE {
            assert_mixed::<Rgb565>(shader, more);
            assert_mixed::<Rgb888>(shader, more);
            assert_mixed::<Gray8>(shader, more);
            assert_mixed::<Light<5, 6, 5>>(shader, more);
            assert_mixed::<LightGray<4>>(shader, more);
        }
        for method in literature::ALL {
            if let Some(shader) = Shader::ALL.into_iter().find(|shader| shader.name() == method.facts().name) {
                assert_mixed::<Rgb565>(shader, more);
            }
        }
    }
}

/// Five colours, of which two are holes.
const COLOURS: [[u8; 3]; 5] = [[255; 3], [200, 90, 30], [20, 220, 250], [90, 90, 90], [250, 200, 0]];

/// Gives meshes from `first` on a texture, in which colours that `is_hole` are holes. Without holes, their colour is `filled`.
pub(crate) fn pierced(mut records: Records, first: usize, is_hole: impl Fn(usize) -> bool, filled: Option<[u8; 3]>) -> StreamBytes {
    let hole = |k: usize| u8::from(filled.is_none() && is_hole(k));
    let channels = |k: usize| filled.filter(|_| is_hole(k)).unwrap_or(COLOURS[k]);
    records.colours = (0..COLOURS.len()).map(|k| Colour { channels: channels(k), hole: hole(k) }).collect();
    records.texels = (0..64).map(|texel| (texel % COLOURS.len()) as u8).collect();
    records.textures = vec![Texture { size: [4, 2], palette: 0, has_holes: u8::from(filled.is_none()) }];
    let place = |vertex: u16| [vertex.wrapping_mul(1_237) % 9_000, vertex.wrapping_mul(3_571) % 9_000];
    for mesh in &mut records.meshes[first..] {
        *mesh = Mesh { flags: mesh.flags | HAS_TEXTURE, palette: 0, ..*mesh };
        let triangles = &records.triangles[mesh.first_triangle as usize..][..mesh.triangles as usize];
        records.texture_corners.extend(triangles.iter().map(|triangle| TextureCorners(triangle.corners.map(place))));
    }
    // Ambient light shows every colour.
    records.materials.iter_mut().for_each(|material| material.ambient = [8_000; 3]);
    records.written().unwrap()
}

/// What is seen through holes of a convex mesh is the background, and all else is drawn as without them.
fn assert_pierced<C: Pixel>(shader: Shader, kind: &str, records: &dyn Fn() -> Records) {
    let is_hole = |k| k == 1 || k == 4;
    let picture = |filled, visible: &[usize]| drawn::<C>(pierced(records(), 0, is_hole, filled).parse().unwrap(), shader, 24, visible);
    let [white, black] = [[255; 3], [0; 3]].map(|filled| picture(Some(filled), &[0]));
    let (found, empty) = (picture(None, &[0]), picture(None, &[]));
    let (mut holes, mut wrong) = (0, 0);
    for k in 0..found.len() {
        let is_hole = white[k].bits() != black[k].bits();
        holes += u32::from(is_hole);
        let expected = if is_hole { empty[k] } else { white[k] };
        wrong += u32::from(found[k].bits() != expected.bits());
    }
    assert!(holes > 300 && wrong == 0, "{} under {kind} light: {wrong} pixels of {holes} holes are wrong", shader.name());
}

#[test]
fn holes_show_what_is_behind_them() {
    for (kind, lights) in lights() {
        let records = || Records { lights: lights.clone(), ..parts("dodecahedron") };
        for shader in CORE {
            assert_pierced::<Rgb565>(shader, kind, &records);
            assert_pierced::<Gray8>(shader, kind, &records);
            assert_pierced::<Light<5, 6, 5>>(shader, kind, &records);
        }
        for method in literature::ALL {
            let known = Shader::ALL.into_iter().find(|shader| shader.name() == method.facts().name);
            // Some methods draw one constant light only.
            let stream = records().written().unwrap();
            let can_draw = |shader: &Shader| renderer::check(&stream.parse().unwrap(), shader.facts(), false).is_ok();
            if let Some(shader) = known.filter(can_draw) {
                assert_pierced::<Rgb565>(shader, kind, &records);
            }
        }
    }
}

/// A surface that is all hole hides nothing, whatever lies behind it.
#[test]
fn holes_hide_nothing() {
    let stream = pierced(parts("board"), 1, |_| true, None);
    let stream = stream.parse().unwrap();
    let all: Vec<usize> = (0..stream.instances.len()).collect();
    let boards: Vec<usize> = all.iter().copied().filter(|&object| stream.instances[object].first_mesh == 0).collect();
    for shader in CORE {
        assert!(drawn::<Rgb565>(stream, shader, 24, &all) == drawn::<Rgb565>(stream, shader, 24, &boards), "{}", shader.name());
    }
}

/// Edges of glass are smooth: against the mean of 16 pixels of a larger picture, the error is less than without antialiasing.
#[test]
fn edges_of_glass_are_smooth() {
    let stream = glass([5, 11], 0, &[]);
    let stream = stream.parse().unwrap();
    let picture = |factor: u32, antialias: bool| {
        let size = Size::new(SIZE.width * factor, SIZE.height * factor);
        let style = Style { antialias, ..Shader::FLAT.into() };
        render::picture(stream, &Settings { size, style, band_rows: 24, format: Format::Rgb888 }, 0).unwrap().rgb
    };
    let fine = picture(4, false);
    let (width, row) = (SIZE.width as usize, SIZE.width as usize * 4 * 3);
    let mean = |k: usize| {
        let (channel, x, y) = (k % 3, k / 3 % width, k / 3 / width);
        let of = |i: usize| f64::from(fine[(4 * y + i / 4) * row + (4 * x + i % 4) * 3 + channel]);
        (0..16).map(of).sum::<f64>() / 16.0
    };
    let rms = |picture: &[u8]| {
        let squares = picture.iter().enumerate().map(|(k, &channel)| (f64::from(channel) - mean(k)).powi(2));
        (squares.sum::<f64>() / picture.len() as f64).sqrt()
    };
    let [jagged, smooth] = [false, true].map(|antialias| rms(&picture(1, antialias)));
    println!("root of the mean square, of 255: {jagged:.2} jagged, {smooth:.2} smooth");
    assert!(smooth < 0.7 * jagged, "{smooth} {jagged}");
}

/// A board draws the bits of this computer.
#[test]
fn a_board_draws_the_same_bits() {
    let board = Board::Mps2An385;
    let elf = build::styles(board, "rgb565,textures,transparency").unwrap();
    let scenes = [
        ("glass", glass([5, 11], 0, &[])),
        ("glass under three lights", glass([5, 11], 0, &third())),
        ("holes", pierced(parts("teapot"), 0, |k| k < 3, None)),
    ];
    for (name, stream) in scenes {
        for shader in CORE {
            let (scene, stream) = (format!("{name}, {}", shader.name()), stream.as_bytes().to_vec());
            let request = Request { board, scene, stream, firmware_stream: None, shader, frames: 1, antialias: false };
            verify::checksums::<Rgb565>(&request, &elf).unwrap();
        }
    }
}

/// A hole in a texture that is said to have none, and levels of detail that differ, are errors.
#[test]
fn wrong_transparency_is_refused() {
    let found = |records: &Records| match StreamBytes::from(&records.bytes(|_| ())[..]).parse() {
        Ok(_) => "right",
        Err(StreamError::Field { name, .. }) => name,
        Err(other) => panic!("{other}"),
    };
    let right = || Records::of(&pierced(parts("dodecahedron"), 0, |k| k == 2, None).parse().unwrap());
    assert_eq!(found(&right()), "right");
    let with = |change: &dyn Fn(&mut Records)| {
        let mut records = right();
        change(&mut records);
        found(&records)
    };
    assert_eq!(with(&|records| records.textures[0].has_holes = 0), "texel of a mesh");
    assert_eq!(with(&|records| records.textures[0].has_holes = 2), "mesh texture");
    assert_eq!(with(&|records| records.colours[0].hole = 2), "texel of a mesh");
}

/// Instructions that a pixel on a Cortex-M3 may take more than without the feature: where all is opaque, through glass, with a texture without holes, and
/// with holes, each with all pixels of triangles that face the viewer; the last two on copper and on a white material.
const LIMITS: [(Shader, [f64; 6]); 4] = [
    (Shader::FLAT, [0.5, 21.0, 0.5, 0.0, 0.5, 0.0]),
    (Shader::GOURAUD, [0.5, 21.0, 0.5, 0.0, 0.5, 0.0]),
    (Shader::PHONG, [0.5, 23.0, 3.0, 0.0, 1.0, 0.0]),
    (Shader::AUTO, [0.5, 22.0, 2.0, 0.0, 1.0, 0.0]),
];

#[test]
fn costs_of_transparency_keep_to_their_limits() {
    let processor = Processor::CortexM3;
    let programs = [Program::PLAIN, Program::TRANSPARENCY, Program::TEXTURES, Program::HOLES];
    let [plain, glass, textures, holes] = programs.map(|program| Bench::of_program(&[processor], program).unwrap());
    let wanted = LIMITS.map(|(shader, _)| (processor, shader));
    let teapot = scene::load("teapot").unwrap();
    let of = |stream| Scene { stream, ..teapot.clone() };
    let mut records = parts("teapot");
    records.meshes[0].flags |= 8 << TRANSPARENCY_SHIFT;
    let clear = of(records.written().unwrap());
    let textured = |is_white: bool, is_hole: bool| {
        let mut records = parts("teapot");
        if is_white {
            records.materials.fill(white(0.3));
        }
        of(pierced(records, 0, |k| is_hole && k < 2, (!is_hole).then_some([0; 3])))
    };
    let drawn = |scene: &Scene| {
        let settings = Settings {
            size: Size::new(teapot.size.0, teapot.size.1),
            style: Shader::GOURAUD.into(),
            band_rows: 240,
            format: Format::Rgb565,
        };
        f64::from(render::picture(scene.stream.parse().unwrap(), &settings, 0).unwrap().stats.pixels)
    };
    let pixels = drawn(&teapot);
    let count = |bench: &Bench, scene: &Scene| -> Vec<f64> {
        bench.count(scene, &wanted, &|| ()).unwrap().iter().map(|found| found.instructions as f64 / pixels).collect()
    };
    let of_textures = [false, true].map(|is_white| count(&textures, &textured(is_white, false)));
    let with_holes =
        [[false, false], [false, true], [true, false], [true, true]].map(|[is_white, is_hole]| count(&holes, &textured(is_white, is_hole)));
    let (base, opaque, through) = (count(&plain, &teapot), count(&glass, &teapot), count(&glass, &clear));
    println!(
        "instructions a pixel: plain, with textures on copper and white; more of opaque surfaces, glass, and on both materials without holes and with them"
    );
    for (k, (shader, most)) in LIMITS.into_iter().enumerate() {
        let of_plain = [&opaque, &through].map(|found| found[k] - base[k]);
        let of_holes = [0, 1, 2, 3].map(|way: usize| with_holes[way][k] - of_textures[way / 2][k]);
        let more: Vec<f64> = of_plain.into_iter().chain(of_holes).collect();
        let line = format!("{:8} {:6.1} {:6.1} {:6.1}: {more:.2?}, {most:?}", shader.name(), base[k], of_textures[0][k], of_textures[1][k]);
        println!("{line}");
        assert!(more.iter().zip(most).all(|(more, most)| *more <= most), "{line}");
    }
}
