//! Smooth outlines against supersampled pictures, and against themselves where nothing may change them.

use crate::vertex_colours;
use embedded_graphics::{
    pixelcolor::{Gray8, Rgb565, Rgb888},
    prelude::*,
};
use microphong::{
    Layout, Outlines, RenderError, Renderer, Stream,
    pixel::{LightGray, PixelFormat},
    stream::record::{CREASE, Header, NO_OUTLINES, Neighbours, OPEN, OUTLINES_ALONE},
};
use microphong_sim::{
    bytes::StreamBytes,
    compare::{
        antialias::{self, Differences, Smoothing},
        supersampled::Supersampled,
    },
    convert::Options,
    look::{Look, Surface},
    mesh::Mesh,
    quantise::quantise,
    render::{self, Style},
    scene,
    shader::Shader,
    shapes,
    vector::{cross, unit},
    verify,
    view::{Up, View},
};
use std::{iter::zip, thread};

/// The side of the picture that is compared.
const SIDE: u32 = 240;

fn smooth(shader: Shader) -> Style {
    Style { antialias: true, ..shader.into() }
}

/// A built-in scene whose stream has neighbours.
fn load(name: &str) -> StreamBytes {
    scene::load(name).unwrap().stream.with_neighbours().unwrap()
}

/// A frame by Gouraud shading with smooth outlines and without, and means of many samples of it.
fn smoothing(stream: Stream<'_>, number: u32) -> Smoothing {
    let samples = Supersampled::new(stream, (SIDE, SIDE), number, false).unwrap();
    antialias::compare(stream, &samples, Shader::GOURAUD, number, &|| ()).unwrap()
}

/// In pixels that contain an edge, a smooth picture is nearer to the mean of 256 samples than a plain one and its error is below the limit
/// of each scene. In all other pixels the error grows by at most 0.08 of 255.
#[test]
fn outlines_are_like_supersampled_ones() {
    let scenes =
        [("peer-sphere", 2.1, 1), ("torus", 4.2, 3), ("bunny", 6.3, 3), ("teapot", 6.2, 3), ("sensor", 4.0, 3), ("board", 10.5, 2)];
    for (name, most, frames) in scenes {
        let stream = load(name);
        let stream = stream.parse().unwrap();
        for number in [0, 13, 26].into_iter().take(frames) {
            let Smoothing { smooth, plain, .. } = smoothing(stream, number);
            let [[plain, plain_elsewhere], [smooth, elsewhere]] = [plain, smooth].map(|of: Differences| [of.edges_rmse, of.elsewhere_rmse]);
            println!("{name:12} frame {number:2}: {plain:5.2} -> {smooth:5.2}, elsewhere {plain_elsewhere:4.2} -> {elsewhere:4.2}");
            assert!(smooth < most && smooth < 0.8 * plain, "{name}, frame {number}: {smooth}, in place of {plain}");
            assert!(elsewhere <= plain_elsewhere + 0.08, "{name}, frame {number}: {elsewhere}, in place of {plain_elsewhere}");
        }
    }
}

/// A picture in bands of `layout.rows` rows, by two processors if they have a row between them.
fn draw(stream: Stream<'_>, size: Size, layout: Layout, style: Style, number: u32, between: Option<u32>) -> Vec<Rgb565> {
    let layout = layout.antialias(true).materials(stream.materials.len()).objects(stream.instances.len().max(1));
    let mut memory = vec![u64::MAX / 3; layout.words::<Rgb565>()];
    let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, style.shader.on()).unwrap();
    renderer.set_antialias(style.antialias).unwrap();
    renderer.scene().set_outlines(style.outlines).unwrap();
    let mut frame = renderer.frame(number);
    let mut pixels = Vec::new();
    let Some(row) = between else {
        let mut band = vec![Rgb565::RED; layout.band()];
        while let Some(area) = frame.next_band(&mut band).unwrap() {
            assert!(area.size.height as usize <= layout.rows, "a band has more rows than its buffer");
            pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
        }
        return pixels;
    };
    let mut frame = frame.in_two(row);
    let parts = thread::scope(|threads| {
        let draw = |mut part: microphong::FramePart<'_, '_, Rgb565>| {
            let (mut band, mut pixels) = (vec![Rgb565::RED; layout.band()], Vec::new());
            while let Some(area) = part.next_band(&mut band).unwrap() {
                pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
            }
            pixels
        };
        frame.parts().map(|part| threads.spawn(move || draw(part))).map(|thread| thread.join().unwrap())
    });
    parts.into_iter().for_each(|part| pixels.extend(part));
    pixels
}

/// A torus so near that the near plane and the sides of the picture cut it.
fn near() -> StreamBytes {
    let mesh = shapes::torus(30, 20);
    let (parts, _) = quantise(&mesh);
    let look = Look::new(Options::default().surface, View::orbit(Up::Y, 0.5, 0.35, 1.1, 120));
    look.stream(&parts).unwrap().with_neighbours().unwrap()
}

/// Neither bands nor lists without room change a pixel, and two processors draw what one draws.
#[test]
fn neither_bands_nor_overflow_change_a_pixel() {
    let size = Size::new(150, 110);
    let scenes = ["teapot", "torus", "sensor", "board"].map(|name| (name, load(name)));
    for (name, stream) in scenes.iter().map(|(name, stream)| (*name, stream)).chain([("near", &near())]) {
        let stream = stream.parse().unwrap();
        let lines = |shader: Shader, alone| Style { outlines: Some(Outlines::new([200, 0, 90]).alone(alone)), ..shader.into() };
        let styles = [
            (smooth(Shader::GOURAUD), 5),
            (smooth(Shader::AUTO), 20),
            (lines(Shader::GOURAUD, false), 11),
            (lines(Shader::FLAT, true), 17),
        ];
        for (style, number) in styles {
            let name = format!("{name}, {}, {:?}", style.shader.name(), style.outlines);
            let room = |rows: usize| Layout::new(150, rows).with_room_for(&stream).edges(3 * stream.triangles.len());
            let whole = draw(stream, size, room(110), style, number, None);
            assert_eq!(whole.len(), 150 * 110);
            let (plain, _) = render::frame::<Rgb565>(stream, size, Style { dither: true, ..style.shader.into() }, 110, number).unwrap();
            assert!(plain != whole, "{name}: outlines are drawn");
            for rows in [1, 2, 7, 16, 40] {
                assert!(draw(stream, size, room(rows), style, number, None) == whole, "{name}: bands of {rows} rows");
            }
            for layout in [room(16).edges(5), room(7).triangles(30), room(16).vertices(40), room(16).vertices(40).triangles(20).edges(0)] {
                assert!(draw(stream, size, layout, style, number, None) == whole, "{name}: {layout:?}");
            }
            let triangles = 2 * stream.triangles.len();
            for (rows, between) in [(8, 55), (16, 1), (1, 40), (40, 109)] {
                let layout = room(rows).triangles(triangles).processors(2);
                let parts = draw(stream, size, layout, style, number, Some(between));
                assert!(parts == whole, "{name}: divided above row {between}, bands of {rows} rows");
            }
        }
    }
}

/// Where more pixels of a band are marked than it has room for, the picture is the same. A mesh of tiny triangles with normals of their own has an
/// edge in almost every pixel.
#[test]
fn marks_without_room_change_no_pixel() {
    let mesh = shapes::torus(120, 60);
    let flat = Mesh {
        positions: mesh.triangles.iter().flatten().map(|&corner| mesh.positions[corner]).collect(),
        normals: mesh
            .triangles
            .iter()
            .enumerate()
            .flat_map(|(k, corners)| corners.map(|c| if k % 2 == 0 { mesh.normals[c] } else { [0.0, 1.0, 0.0] }))
            .collect(),
        triangles: (0..mesh.triangles.len()).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect(),
        ..Mesh::default()
    };
    let (parts, _) = quantise(&flat);
    let stream = Look::new(Options::default().surface, View::orbit(Up::Y, 0.5, 0.35, 3.0, 120)).stream(&parts).unwrap();
    let stream = stream.with_neighbours().unwrap();
    let stream = stream.parse().unwrap();
    let creases = stream.neighbours.iter().flat_map(|Neighbours(edges)| edges).filter(|&&edge| edge & CREASE != 0).count();
    assert!(creases > stream.triangles.len(), "{creases}");
    let size = Size::new(120, 100);
    let room = |rows: usize| Layout::new(120, rows).with_room_for(&stream).edges(3 * stream.triangles.len());
    let whole = draw(stream, size, room(100), smooth(Shader::GOURAUD), 0, None);
    for rows in [1, 9, 50] {
        assert!(draw(stream, size, room(rows), smooth(Shader::GOURAUD), 0, None) == whole, "bands of {rows} rows");
    }
}

/// Borders between colours of one smooth mesh are smoothed, as borders between materials are: they differ from means of many samples by less than half as
/// much as jagged ones do. A step of 16 of 255 is no border.
#[test]
fn borders_of_colours_are_smooth() {
    let stripes = |colours: [[u8; 3]; 2]| {
        let striped = |triangle: usize, _| u8::from((triangle / 25).is_multiple_of(2));
        vertex_colours::coloured(vertex_colours::parts("torus"), &colours, striped).with_neighbours().unwrap()
    };
    let creases = |stream: &StreamBytes| {
        stream
            .parse()
            .unwrap()
            .neighbours
            .iter()
            .flat_map(|Neighbours(edges)| edges)
            .filter(|&&edge| edge & CREASE != 0 && edge != OPEN)
            .count()
    };
    let stream = stripes([[200, 30, 20], [230, 220, 200]]);
    assert_eq!([creases(&stream), creases(&stripes([[200; 3], [216, 200, 184]]))], [450, 0]);
    let stream = stream.parse().unwrap();
    let Smoothing { means, pictures, .. } = smoothing(stream, 7);
    let [smooth, jagged] = pictures.map(|pixels| {
        let squares =
            zip(&pixels, &means).flat_map(|(pixel, mean)| zip(pixel, mean.levels).map(|(one, other)| (f64::from(*one) - other).powi(2)));
        (squares.sum::<f64>() / (3 * pixels.len()) as f64).sqrt()
    });
    println!("jagged {jagged:.2} smooth {smooth:.2}");
    assert!(smooth < jagged / 2.0, "{smooth} {jagged}");
}

/// A pixel that no outline touches stays: on a sphere those whose eight neighbours are covered, too.
#[test]
fn inner_pixels_stay() {
    let stream = load("sphere-168");
    let stream = stream.parse().unwrap();
    let size = Size::new(160, 120);
    for shader in Shader::ALL {
        let Ok((plain, _)) = render::frame::<Rgb888>(stream, size, shader, 120, 3) else { continue };
        let (smooth, _) = render::frame::<Rgb888>(stream, size, smooth(shader), 120, 3).unwrap();
        let ground = |at: usize| plain[at / 160 * 160];
        let is_covered = |at: usize| plain[at] != ground(at);
        let (mut inner, mut changed) = (0, 0);
        for at in 161..plain.len() - 161 {
            if [0, 1, 2].iter().all(|row| (at + row * 160 - 161..at + row * 160 - 158).all(is_covered)) {
                inner += 1;
                assert_eq!(plain[at], smooth[at], "{}: pixel {at}", shader.name());
            }
            changed += usize::from(plain[at] != smooth[at]);
        }
        assert!(inner > 2000 && changed > 100, "{}: {inner} inside, {changed} changed", shader.name());
    }
}

/// Lines are drawn along a straight edge as wide as a pixel, whatever its slope, and nowhere else. Alone they leave the background, and what surfaces
/// hide stays hidden.
#[test]
fn lines_are_as_wide_as_a_pixel() {
    let size = Size::new_equal(120);
    let white = Some(Outlines::new([255; 3]).alone(true));
    let light = |pixels: &[Rgb888]| -> f64 { pixels.iter().map(|pixel| f64::from(pixel.r()) / 255.0).sum() };
    let black = |mesh: &Mesh, number: u32| {
        let mut look = Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 20), View::orbit(Up::Y, 0.5, 0.35, 4.0, 120));
        look.background = [0; 3].into();
        let stream = look.stream(&quantise(mesh).0).unwrap().with_neighbours().unwrap();
        let draw = |outlines| {
            let style = Style { outlines, ..Shader::FLAT.into() };
            render::frame::<Rgb888>(stream.parse().unwrap(), size, style, 120, number).unwrap().0
        };
        (draw(None), draw(white))
    };
    for number in 0..12 {
        // Around a ball, the sum of all light is the length of the outline.
        let (plain, lines) = black(&shapes::sphere(60, 30, 0.0), number * 5);
        let area = plain.iter().filter(|&&pixel| pixel != Rgb888::BLACK).count() as f64;
        let length = 2.0 * (std::f64::consts::PI * area).sqrt();
        // Along diagonals a line is thinner than a pixel.
        let share = light(&lines) / length;
        assert!((0.8..1.05).contains(&share), "frame {number}: {share}");
        let inner = |at: usize| [1, 2, 120, 240].iter().all(|d| [at - d, at + d].iter().all(|&near| plain[near] != Rgb888::BLACK));
        for at in (241..plain.len() - 241).filter(|&at| inner(at)) {
            assert_eq!(lines[at], Rgb888::BLACK, "frame {number}: a line within the ball");
        }
    }
}

/// A board hides what is behind it: the outlines of a floor and a wall, and the line along which they cut each other. Both reach far, so the depths of
/// each span those of the board.
#[test]
fn lines_are_hidden_by_what_is_in_front() {
    let quad = |corners: [[f64; 3]; 4]| {
        let [a, b, _, d] = corners;
        let edge = |to: [f64; 3]| [0, 1, 2].map(|k| to[k] - a[k]);
        let normal = unit(cross(edge(b), edge(d))).unwrap();
        (corners, normal)
    };
    let floor = quad([[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]]);
    let wall = quad([[0.2, -0.6, -0.9], [0.2, -0.6, 0.9], [0.2, 0.6, 0.9], [0.2, 0.6, -0.9]]);
    let board = quad([[-0.2, -0.3, 1.1], [0.6, -0.3, 1.1], [0.6, 0.4, 1.1], [-0.2, 0.4, 1.1]]);
    let draw = |quads: &[([[f64; 3]; 4], [f64; 3])], style: Style| {
        let mut mesh = Mesh::default();
        for (k, (corners, normal)) in quads.iter().enumerate() {
            mesh.positions.extend(corners);
            mesh.normals.extend([*normal; 4]);
            mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners: [usize; 3]| corners.map(|corner| corner + 4 * k)));
        }
        let mut look = Look::new(Surface::metal([1.0; 3], [0.5, 0.5, 0.0], 1), View::orbit(Up::Y, 0.0, 0.45, 2.6, 0));
        look.background = [0; 3].into();
        let stream = look.stream(&quantise(&mesh).0).unwrap().with_neighbours().unwrap();
        let pixels = render::frame::<Rgb888>(stream.parse().unwrap(), Size::new_equal(160), style, 16, 0).unwrap().0;
        (pixels, stream.parse().unwrap().cuts.len())
    };
    let lines = Style { outlines: Some(Outlines::new([255; 3]).alone(true)), ..Shader::FLAT.into() };
    let lit = |pixels: &[Rgb888]| pixels.iter().map(|pixel| pixel.r() > 60).collect::<Vec<_>>();
    let (both, cuts) = draw(&[floor, wall], lines);
    assert!(cuts > 0);
    let (alone, both) = (lit(&draw(&[wall], lines).0), lit(&both));
    let in_front: Vec<bool> = draw(&[board], Shader::FLAT.into()).0.iter().map(|&pixel| pixel != Rgb888::BLACK).collect();
    let inside = |at: usize| [1, 2, 3, 160, 320, 480].iter().all(|d| [at - d, at + d].iter().all(|&near| in_front[near]));
    let all = lit(&draw(&[floor, wall, board], lines).0);
    let (mut seen, mut hidden) = (0, 0);
    for at in 480..all.len() - 480 {
        let is_line = both[at] && !alone[at];
        if inside(at) {
            hidden += usize::from(is_line);
            assert!(!all[at], "a line at {}, {} on the board", at % 160, at / 160);
        } else {
            seen += usize::from(is_line && all[at]);
        }
    }
    assert!(hidden > 5 && seen > 30, "{hidden} pixels of lines are hidden, {seen} are not");
}

/// Two triangles have a line in common where one goes through the other. It counts from a length of 1/512 on.
#[test]
fn triangles_that_cut_each_other_are_found() {
    let floor = [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.5], [1.5, 0.0, -1.0]];
    let wall = |x: f64, low: f64, high: f64| [[x, low, 0.0], [x + 1.0, low, 0.0], [x, high, 0.0]];
    let cuts = |triangle: [[f64; 3]; 3]| {
        let mut mesh = Mesh::default();
        for (k, [a, b, c]) in [floor, triangle].into_iter().enumerate() {
            let edge = |to: [f64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
            mesh.positions.extend([a, b, c]);
            mesh.normals.extend([unit(cross(edge(b), edge(c))).unwrap(); 3]);
            mesh.triangles.push([0, 1, 2].map(|corner: usize| corner + 3 * k));
        }
        let look = Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 20), View::orbit(Up::Y, 0.0, 0.45, 2.6, 0));
        look.stream(&quantise(&mesh).0).unwrap().with_neighbours().unwrap().parse().unwrap().cuts.len()
    };
    assert_eq!([wall(0.0, -1.0, 1.0), wall(0.0, -0.02, 1.0)].map(cuts), [1; 2]);
    // The tip of a wall that is one unit wide and deep is above the floor. The line is so long.
    let tip = |length: f64| wall(0.0, -1.0, length / (1.0 - length));
    assert_eq!([1.1 / 512.0, 0.9 / 512.0].map(|length| cuts(tip(length))), [1, 0]);
    // The wall stands on the floor, is above it, or beside it.
    assert_eq!([wall(0.0, 0.0, 1.0), wall(0.0, 0.1, 1.0), wall(0.6, -1.0, 1.0)].map(cuts), [0; 3]);
    // In one plane, and with a common corner.
    let touching = [[[0.0; 3], [0.5, 0.0, 0.0], [0.0, 0.0, 0.5]], [[-1.0, 0.0, -1.0], [0.5, -1.0, 0.0], [0.5, 1.0, 0.0]]].map(cuts);
    assert_eq!(touching, [0; 2]);
}

/// A display of one bit shows a line without gaps: each of its pixels has all of the colour, and they are as many as the light of smooth lines.
#[test]
fn lines_of_one_bit_have_no_gaps() {
    let size = Size::new(128, 64);
    let style = Style { outlines: Some(Outlines::new([255; 3]).alone(true)), dither: true, ..Shader::FLAT.into() };
    for (name, mesh) in
        [("sphere", shapes::sphere(60, 30, 0.0)), ("torus", shapes::torus(60, 40)), ("coarse sphere", shapes::sphere(8, 5, 0.0))]
    {
        let mut look = Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 20), View::orbit(Up::Y, 0.5, 0.35, 4.0, 120));
        look.background = [0; 3].into();
        let stream = look.stream(&quantise(&mesh).0).unwrap().with_neighbours().unwrap();
        let stream = stream.parse().unwrap();
        let (crisp, _) = render::frame::<LightGray<1>>(stream, size, style, 64, 0).unwrap();
        let (smooth, _) = render::frame::<Gray8>(stream, size, style, 64, 0).unwrap();
        let white = LightGray::pack([1; 3]);
        assert!(crisp.iter().all(|&pixel| pixel == LightGray::BLACK || pixel == white), "{name}: shares of the colour");
        let drawn = crisp.iter().filter(|&&pixel| pixel == white).count() as f64;
        let share = drawn / smooth.iter().map(|pixel| f64::from(pixel.luma()) / 255.0).sum::<f64>();
        println!("{name}: {drawn} pixels, {share:.3} of the light of smooth lines");
        assert!((0.9..1.1).contains(&share), "{name}: {share}");
    }
}

/// Frames without antialiasing are the same, whether the stream has neighbours or not.
#[test]
fn neighbours_change_no_plain_picture() {
    for name in ["teapot", "sensor"] {
        let (plain, smooth) = (scene::load(name).unwrap().stream, load(name));
        let cuts = smooth.parse().unwrap().cuts.len();
        println!("{name}: {cuts} pairs of triangles cut each other");
        assert!(cuts > 20, "{name}: {cuts}");
        assert_eq!(smooth.as_bytes().len(), plain.as_bytes().len() + 6 * plain.parse().unwrap().triangles.len() + 12 * cuts);
        let draw = |stream: &StreamBytes| render::frame::<Rgb565>(stream.parse().unwrap(), Size::new(90, 70), Shader::AUTO, 16, 7).unwrap();
        assert!(draw(&plain) == draw(&smooth), "{name}");
    }
}

/// Neighbours are each other's neighbours over the same edge, and a closed mesh has no open edge.
#[test]
fn neighbours_are_mutual() {
    for name in ["torus", "bunny", "teapot", "dodecahedron"] {
        let stream = load(name);
        let stream = stream.parse().unwrap();
        for mesh in stream.meshes {
            let (triangles, neighbours) = (stream.triangles_of(mesh).unwrap(), stream.neighbours_of(mesh));
            assert_eq!(triangles.len(), neighbours.len());
            for (index, Neighbours(edges)) in neighbours.iter().enumerate() {
                for &other in edges {
                    assert!(other & OPEN != OPEN || !["torus", "dodecahedron"].contains(&name), "{name}: triangle {index} is open");
                    if other & OPEN != OPEN {
                        let Neighbours(back) = neighbours[usize::from(other & OPEN)];
                        assert!(back.contains(&(index as u16 | other & CREASE)), "{name}: {index} and {other}");
                    }
                }
            }
        }
    }
}

/// A stream with lines gives the picture of a program that asks for them, over the surfaces and alone. A program can remove or replace them.
#[test]
fn streams_state_lines() {
    let (size, layout) = (Size::new(120, 90), Layout::new(120, 17).vertices(4096).triangles(4096).edges(4096));
    for name in ["teapot", "sensor"] {
        let smooth = load(name);
        let [over, alone] = [Outlines::new([200, 0, 90]), Outlines::new([10, 255, 40]).alone(true)];
        for outlines in [over, alone] {
            let with_lines = smooth.with_outlines(outlines).unwrap();
            let draw = |stream: &StreamBytes, style: Style| {
                let (pixels, _) = render::frame::<Rgb565>(stream.parse().unwrap(), size, style, 17, 3).unwrap();
                pixels
            };
            let style = |outlines| Style { outlines, antialias: true, ..Shader::GOURAUD.into() };
            let expected = draw(&smooth, style(Some(outlines)));
            assert!(draw(&with_lines, style(None)) == expected, "{name}, {outlines:?}");
            let plain = draw(&smooth, style(None));
            assert!(draw(&with_lines.clone().without_outlines(), style(None)) == plain && plain != expected, "{name}, {outlines:?}");
            let other = Outlines::new([0, 0, 255]);
            assert!(draw(&with_lines, style(Some(other))) == draw(&smooth, style(Some(other))), "{name}, {outlines:?}");
            // Between two frames.
            let parsed = with_lines.parse().unwrap();
            let layout = layout.with_room_for(&parsed);
            let mut memory = vec![u64::MAX / 3; layout.words::<Rgb565>()];
            let mut renderer = Renderer::with_shader(parsed, size, &layout, &mut memory, Shader::GOURAUD.on()).unwrap();
            renderer.set_antialias(true).unwrap();
            renderer.set_dither(false);
            assert_eq!(renderer.scene().outlines(), Some(outlines));
            let mut shown = |change: Option<Option<Outlines>>| {
                if let Some(outlines) = change {
                    renderer.scene().set_outlines(outlines).unwrap();
                    assert!(!renderer.scene().is_unchanged());
                }
                let (mut pixels, mut band) = (Vec::new(), vec![Rgb565::RED; layout.band()]);
                let mut frame = renderer.frame(3);
                while let Some(area) = frame.next_band(&mut band).unwrap() {
                    pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
                }
                pixels
            };
            assert!(
                shown(None) == expected && shown(Some(None)) == plain && shown(Some(Some(outlines))) == expected,
                "{name}, {outlines:?}"
            );
        }
    }
}

/// Fields of lines that contradict one another, or the rest of the stream, are refused.
#[test]
fn false_lines_are_refused() {
    let (plain, smooth) = (scene::load("triangle").unwrap().stream, load("triangle"));
    let fault = |stream: &StreamBytes, outlines, outline_colour| {
        let change = |header: &mut Header| (header.outlines, header.outline_colour) = (outlines, outline_colour);
        let bytes = verify::with_header(stream.as_bytes(), change).unwrap();
        StreamBytes::from(&bytes[..]).parse().err().map(|error| error.to_string())
    };
    let says = |field: &str| Some(format!("{field} of record 0 is out of range; convert the mesh again"));
    assert_eq!([0, 1, 2].map(|kind| fault(&smooth, kind, [0; 3])), [None, None, None]);
    assert_eq!(fault(&smooth, OUTLINES_ALONE + 1, [0; 3]), says("outlines"));
    assert_eq!(fault(&smooth, NO_OUTLINES, [0, 1, 0]), says("outline colour"));
    assert_eq!(fault(&plain, OUTLINES_ALONE, [0; 3]), says("neighbours for outlines"));
    // A layout has to have room for them.
    let (with_lines, layout) = (smooth.with_outlines(Outlines::new([255; 3])).unwrap(), Layout::new(32, 2));
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let refusal = Renderer::with_shader(with_lines.parse().unwrap(), Size::new(32, 8), &layout, &mut memory, Shader::FLAT.on::<Rgb565>());
    assert_eq!(refusal.err(), Some(RenderError::AntialiasMemory));
}

#[test]
fn what_is_missing_is_named() {
    let plain = scene::load("triangle").unwrap().stream;
    let smooth = plain.with_neighbours().unwrap();
    let refusal = |stream: &StreamBytes, layout: Layout| {
        let mut memory = vec![0; layout.words::<Rgb565>()];
        let shaders = Shader::ALL.map(Shader::on);
        let mut renderer = Renderer::<Rgb565>::new(stream.parse().unwrap(), Size::new(32, 8), &layout, &mut memory, &shaders).unwrap();
        let refusal = renderer.set_antialias(true).err();
        assert_eq!(renderer.set_antialias(false), Ok(()));
        let refused = renderer.scene().set_outlines(Some(Outlines::new([0; 3]))).err();
        assert_eq!(refused.map(|error| error.to_string()), refusal.map(|error| error.to_string()), "lines need the same");
        assert_eq!(renderer.scene().outlines().is_some(), refusal.is_none());
        assert_eq!(renderer.scene().set_outlines(None), Ok(()));
        assert_eq!(renderer.band_rows(), 2, "still without");
        refusal
    };
    let layout = Layout::new(32, 2).vertices(0).triangles(0).active_triangles(0);
    assert_eq!(refusal(&smooth, layout), Some(RenderError::AntialiasMemory));
    assert_eq!(refusal(&plain, layout.antialias(true)), Some(RenderError::Neighbours));
    assert_eq!(refusal(&smooth, layout.antialias(true)), None);
    let text = RenderError::AntialiasMemory.to_string();
    assert_eq!(text, "the layout has no memory for outlines; set Layout::antialias(true)");
    let text = RenderError::Neighbours.to_string();
    assert_eq!(text, "the stream has no neighbours of triangles; make it with `microphong convert --antialias`");
}
