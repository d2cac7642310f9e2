//! Memory decides how a frame is drawn, and never the picture.

use crate::golden::root;
use embedded_graphics::{
    mock_display::MockDisplay,
    pixelcolor::{Gray8, Rgb565},
    prelude::*,
};
use microphong::{FramePart, Layout, MAX_SIDE, Material, Picture, RenderError, Renderer, Stats, Stream, renderer::check};
use microphong_sim::{
    convert::{AZIMUTH, Converted, DISTANCE, ELEVATION, MARGIN, ORBIT, Options},
    look::Look,
    mesh::Mesh,
    quantise::quantise,
    render::{self, Style},
    scene,
    shader::Shader,
    shapes,
    view::{Up, View},
};
use microphong_tests::named;
use std::thread;

/// A frame with room for these numbers of vertices, triangles and active triangles, in bands of `rows` rows.
fn frame(stream: Stream<'_>, size: Size, shader: Shader, [vertices, triangles, active]: [usize; 3], rows: u32) -> (Vec<Rgb565>, Stats) {
    let layout = Layout::new(size.width as usize, rows as usize).vertices(vertices).triangles(triangles);
    let layout = layout.materials(stream.materials.len()).active_triangles(active);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, shader.on()).unwrap();
    let mut band = vec![Rgb565::RED; layout.band()];
    let mut pixels = Vec::new();
    let mut frame = renderer.frame(5);
    while let Some(area) = frame.next_band(&mut band).unwrap() {
        pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
    }
    (pixels, frame.stats())
}

#[test]
fn neither_bands_nor_overflow_change_a_pixel() {
    let size = Size::new(200, 150);
    for name in ["teapot", "torus", "sphere-40"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let (vertices, triangles) = (stream.vertices.len(), stream.triangles.len());
        for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader.facts(), false).is_ok()) {
            let (whole, stats) = frame(stream, size, shader, [vertices, triangles, 0], size.height);
            assert_eq!((stats.passes, stats.uncached), (1, 0));
            for (rows, active) in [(1, triangles), (7, 40), (7, 3), (16, triangles), (16, 0), (64, 1)] {
                let (pixels, banded) = frame(stream, size, shader, [vertices, triangles, active], rows);
                assert!(pixels == whole, "{name}, {}: bands of {rows} rows, {active} active triangles", shader.name());
                assert_eq!(Stats { set_up_anew: 0, ..banded }, stats);
                assert!(active < triangles || banded.set_up_anew == 0, "there is room for all");
                assert!(active > 3 || shader != Shader::FLAT || banded.set_up_anew > 0, "the overflow is counted");
            }
            for (vertices, triangles, rows) in [(0, triangles, 50), (vertices / 2, triangles, 16), (vertices, 3, 16), (7, 0, 40)] {
                let (pixels, tight) = frame(stream, size, shader, [vertices, triangles, 10], rows);
                assert!(pixels == whole, "{name}, {}: room for {vertices} vertices, {triangles} triangles", shader.name());
                assert_eq!((tight.drawn, tight.pixels), (stats.drawn, stats.pixels), "nothing is lost");
                assert!(tight.passes > 1 || tight.uncached > 0, "the overflow is counted");
            }
        }
    }
}

/// Two threads draw both parts of a frame at the same time, wherever it is divided, and also where there is too little room to divide it.
#[test]
fn two_parts_are_the_whole() {
    let size = Size::new(200, 150);
    for name in ["teapot", "torus", "peer-sphere-convex"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let (vertices, all) = (stream.vertices.len(), stream.triangles.len());
        for shader in [Shader::FLAT, Shader::SIX_POINT, Shader::PHONG] {
            let (whole, stats) = frame(stream, size, shader, [vertices, all, 0], size.height);
            for (row, rows, triangles) in
                [(75, 30, 2 * all), (1, 7, 2 * all), (149, 2, 2 * all), (0, 40, 2 * all), (75, 30, 100), (74, 1, all)]
            {
                let layout = Layout::new(200, rows).vertices(vertices).triangles(triangles).active_triangles(40);
                // With the memory of one processor, bands are half as high.
                let layout = layout.processors(1 + row as usize % 2);
                let mut memory = vec![0; layout.words::<Rgb565>()];
                let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, shader.on()).unwrap();
                let mut frame = renderer.frame(5).in_two(row);
                let bands = thread::scope(|threads| {
                    let draw = |mut part: FramePart<'_, '_, Rgb565>| {
                        let (mut band, mut bands) = (vec![Rgb565::RED; layout.band()], Vec::new());
                        while let Some(area) = part.next_band(&mut band).unwrap() {
                            bands.push((area, band.clone()));
                        }
                        bands
                    };
                    frame.parts().map(|part| threads.spawn(move || draw(part))).map(|thread| thread.join().unwrap())
                });
                let lower = bands[1].iter().map(|(area, _)| area.size.height).sum::<u32>();
                let divides = triangles == 2 * all && rows > 1;
                assert_eq!(lower, if divides { size.height - row } else { 0 }, "the rows of the second part");
                let mut pixels = Vec::new();
                for (area, band) in bands.concat() {
                    assert_eq!(area.top_left.y as usize * 200, pixels.len());
                    pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
                }
                assert!(pixels == whole, "{name}, {}, divided at row {row} into bands of {rows} rows", shader.name());
                let counts = |stats: Stats| (stats.drawn, stats.culled, stats.pixels);
                assert_eq!(counts(frame.stats()), counts(stats));
            }
        }
    }
}

/// Frames of a stream, each prepared by two threads at the same time if there is a share for the earlier triangles.
fn prepared(stream: Stream<'_>, shader: Shader, layout: &Layout, antialias: bool, share: Option<u16>) -> Vec<(Vec<Rgb565>, Stats)> {
    let size = Size::new(layout.width as u32, 75);
    let mut memory = vec![u64::MAX; layout.words::<Rgb565>()];
    let mut renderer = Renderer::with_shader(stream, size, layout, &mut memory, shader.on()).unwrap();
    renderer.set_antialias(antialias).unwrap();
    let mut band = vec![Rgb565::RED; layout.band()];
    let numbers = (0..stream.header.frames.into()).step_by(17);
    let frames = numbers.map(|number| {
        let mut frame = match share {
            None => renderer.frame(number),
            Some(share) => {
                let mut preparation = renderer.prepare(number, share);
                thread::scope(|threads| {
                    preparation.parts().map(|part| threads.spawn(move || part.run())).map(|thread| thread.join().unwrap())
                });
                preparation.frame()
            }
        };
        let mut pixels = Vec::new();
        while let Some(area) = frame.next_band(&mut band).unwrap() {
            pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
        }
        (pixels, frame.stats())
    });
    frames.collect()
}

/// Wherever the triangles are divided, and whatever vertices they share: of all scenes, of vertices that are numbered otherwise, of several
/// meshes, with triangles that are clipped, and where there is too little room to divide anything.
#[test]
fn two_preparations_are_the_whole() {
    let mut streams: Vec<_> = scene::NAMES.iter().chain(&scene::VARIANTS).map(|name| (*name, scene::load(name).unwrap().stream)).collect();
    let mesh = shapes::torus(30, 20);
    let look = |distance| Look::new(Options::default().surface, View::orbit(Up::Y, 0.5, 0.35, distance, 120));
    let (mut parts, _) = quantise(&mesh);
    streams.extend([("far", look(4.0).stream(&parts).unwrap()), ("near", look(1.1).stream(&parts).unwrap())]);
    let count = parts[0].vertices.len();
    let at = |index: u16| usize::from(index) * 7919 % count;
    let mut shuffled = parts[0].vertices.clone();
    (0..count).for_each(|index| shuffled[at(index as u16)] = parts[0].vertices[index]);
    parts[0].vertices = shuffled;
    parts[0].triangles.iter_mut().for_each(|triangle| triangle.corners = triangle.corners.map(|corner| at(corner) as u16));
    streams.push(("shuffled", look(4.0).stream(&parts).unwrap()));
    let meshes =
        mesh.triangles.chunks(170).map(|triangles| quantise(&Mesh { triangles: triangles.to_vec(), ..mesh.clone() }).0).collect::<Vec<_>>();
    streams.push(("meshes", look(4.0).stream(&meshes.concat()).unwrap()));
    for (name, stream) in &streams {
        let smooth = stream.with_neighbours().unwrap();
        let stream = smooth.parse().unwrap();
        let (vertices, triangles) = (stream.vertices.len(), stream.triangles.len());
        let layout = Layout::new(100, 80).processors(2).materials(stream.materials.len()).active_triangles(20).antialias(true);
        for (room, fits) in [([vertices, triangles], true), ([vertices / 2, triangles], false), ([vertices, triangles / 3], false)] {
            let layout = layout.vertices(room[0]).triangles(room[1]);
            for (shader, antialias) in [(Shader::SIX_POINT, false), (Shader::FLAT, false), (Shader::GOURAUD, true)] {
                let whole = prepared(stream, shader, &layout, antialias, None);
                for share in [1 << 15, 0, 1 << 11, 20_000, u16::MAX].into_iter().take(if fits { 5 } else { 1 }) {
                    let divided = prepared(stream, shader, &layout, antialias, Some(share));
                    assert!(divided == whole, "{name}, {}, room for {room:?}, divided at {share}", shader.name());
                }
            }
        }
    }
}

/// Parts of a preparation that nobody has run are run in the end, once. Each part has its share, if there is room for all.
#[test]
fn a_preparation_is_complete() {
    let scene = scene::load("torus").unwrap();
    let stream: Stream<'_> = scene.stream.parse().unwrap();
    let layout = Layout::new(100, 75).processors(2).vertices(stream.vertices.len()).triangles(stream.triangles.len());
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut renderer = Renderer::<Rgb565>::with_shader(stream, Size::new(100, 75), &layout, &mut memory, Shader::SIX_POINT.on()).unwrap();
    let drawn = renderer.frame(3).stats();
    for runs in [[false, false], [true, false], [false, true], [true, true]] {
        let mut preparation = renderer.prepare(3, 1 << 15);
        preparation.parts().into_iter().zip(runs).filter(|(_, runs)| *runs).for_each(|(part, _)| part.run());
        assert_eq!(preparation.frame().stats(), drawn);
    }
    let share_of = |layout: Layout, share| {
        let mut memory = vec![0; layout.words::<Rgb565>()];
        let mut renderer =
            Renderer::<Rgb565>::with_shader(stream, Size::new(100, 75), &layout, &mut memory, Shader::SIX_POINT.on()).unwrap();
        let [later, earlier] = renderer.prepare(0, share).parts().map(|part| part.triangles());
        assert_eq!([earlier.start, earlier.end, later.end], [0, later.start, stream.triangles.len()]);
        earlier.len()
    };
    assert_eq!(share_of(layout, 1 << 15), stream.triangles.len() / 2);
    assert_eq!(share_of(layout, 1 << 13), stream.triangles.len() / 8);
    for small in [layout.processors(1), layout.vertices(stream.vertices.len() - 1), layout.triangles(stream.triangles.len() - 1)] {
        assert_eq!(share_of(small, 1 << 15), 0);
    }
}

#[test]
fn a_display_is_filled_once() {
    // The mock display panics on a pixel that is drawn twice or lies outside.
    let scene = scene::load("sphere-168").unwrap();
    let stream = scene.stream.parse().unwrap();
    let layout = Layout::new(64, 10).vertices(stream.vertices.len()).triangles(stream.triangles.len()).active_triangles(8);
    let mut memory = vec![0; layout.words::<Gray8>()];
    let mut renderer = Renderer::new(stream, Size::new(64, 64), &layout, &mut memory, &Shader::ALL.map(Shader::on)).unwrap();
    let mut band = [Gray8::BLACK; 64 * 10];
    let mut display = MockDisplay::<Gray8>::new();
    let stats = Picture::new(&mut renderer, &mut band, 0).unwrap().draw(&mut display).unwrap();
    assert!(stats.drawn > 50);
    assert_eq!(display.affected_area().size, Size::new(64, 64));
    let lit = (0..64 * 64).filter(|i| display.get_pixel(Point::new(i % 64, i / 64)).unwrap().luma() > 64).count();
    assert!((1000..4000).contains(&lit), "{lit}");
}

/// Continued from band to band, triangles look as if they were drawn at once: in one channel or three, dithered, without depth, in
/// perspective.
#[test]
fn active_triangles_look_the_same_in_every_style() {
    let size = Size::new(240, 180);
    for name in ["bunny", "torus", "peer-sphere-convex", "dodecahedron", "sphere-690"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for style in [false, true].into_iter().flat_map(|dither| [false, true].map(|perspective_correct| (dither, perspective_correct))) {
            let (dither, perspective_correct) = style;
            for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader.facts(), perspective_correct).is_ok()) {
                let style = Style { dither, perspective_correct, ..shader.into() };
                let draw = |rows| render::frame::<Rgb565>(stream, size, style, rows, 3).unwrap();
                let (whole, banded) = (draw(size.height), draw(11));
                assert!(whole == banded, "{name}, {style:?}");
            }
        }
    }
}

#[test]
fn rows_without_triangles_need_not_be_drawn_again() {
    let size = Size::new(200, 150);
    let (width, rows) = (size.width as usize, 16);
    for name in ["teapot", "triangle", "dodecahedron"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for triangles in [stream.triangles.len(), 3] {
            let layout = Layout::new(width, rows).vertices(stream.vertices.len()).triangles(triangles);
            let layout = layout.materials(stream.materials.len()).active_triangles(20);
            let mut memory = vec![0; layout.words::<Rgb565>()];
            let mut renderer = Renderer::new(stream, size, &layout, &mut memory, &Shader::ALL.map(Shader::on)).unwrap();
            let mut band = vec![Rgb565::RED; width * rows];
            let mut display = vec![Rgb565::RED; width * size.height as usize];
            let (mut shown, mut saved) = (0..size.height, 0);
            for number in [0, 7, 30, 31, 60] {
                let mut whole = Vec::new();
                let mut frame = renderer.frame(number);
                while let Some(area) = frame.next_band(&mut band).unwrap() {
                    whole.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
                }
                let stats = frame.stats();
                let mut frame = renderer.frame(number);
                let reached = frame.rows();
                frame.limit(reached.start.min(shown.start)..reached.end.max(shown.end));
                shown = reached;
                while !frame.is_complete() {
                    let area = frame.next_band(&mut band).unwrap().unwrap();
                    let (start, count) = (area.top_left.y as usize * width, width * area.size.height as usize);
                    display[start..start + count].copy_from_slice(&band[..count]);
                    saved += count;
                }
                assert_eq!(frame.next_band(&mut band), Ok(None));
                assert_eq!(frame.stats().pixels, stats.pixels);
                assert!(display == whole, "{name}, frame {number}");
            }
            let saved = 5 * display.len() - saved;
            assert_eq!(saved > 0, triangles >= stream.triangles.len(), "{name}, room for {triangles} triangles: {saved} pixels saved");
        }
    }
}

/// Memory may be longer than needed, and hold whatever was there before: a frame is the same, and the one after it, too.
#[test]
fn what_was_in_the_memory_does_not_matter() {
    let size = Size::new(100, 70);
    for name in ["teapot", "torus", "sphere-40"] {
        let scene = scene::load(name).unwrap();
        let smooth = scene.stream.with_neighbours().unwrap();
        let stream = smooth.parse().unwrap();
        for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader.facts(), false).is_ok()) {
            for antialias in [false, true] {
                let layout = Layout::new(100, 16).materials(stream.materials.len()).active_triangles(20).antialias(antialias);
                // Too little of it, and enough.
                for layout in [layout.vertices(50).triangles(30), layout.vertices(4096).triangles(4096)] {
                    let draw = |before: u64, more: usize| {
                        let mut memory = vec![before; layout.words::<Rgb565>() + more];
                        let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, shader.on()).unwrap();
                        renderer.set_antialias(antialias).unwrap();
                        let mut band = vec![Rgb565::RED; layout.band()];
                        let mut pixels = Vec::new();
                        for number in [3, 40] {
                            let mut frame = renderer.frame(number);
                            while let Some(area) = frame.next_band(&mut band).unwrap() {
                                pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
                            }
                        }
                        pixels
                    };
                    let clean = draw(0, 0);
                    for (before, more) in [(u64::MAX, 0), (0x0123_4567_89AB_CDEF, 5)] {
                        assert!(draw(before, more) == clean, "{name}, {}, {layout:?}: {before:x}", shader.name());
                    }
                }
            }
        }
    }
}

#[test]
fn a_slice_shorter_than_a_band_gets_fewer_rows() {
    let size = Size::new(90, 70);
    let scene = scene::load("torus").unwrap();
    let stream = scene.stream.parse().unwrap();
    let (whole, stats) = frame(stream, size, Shader::SIX_POINT, [stream.vertices.len(), stream.triangles.len(), 20], 16);
    let layout = Layout::new(90, 16).vertices(stream.vertices.len()).triangles(stream.triangles.len()).active_triangles(20);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, Shader::SIX_POINT.on()).unwrap();
    // Less than two rows, rows that do not go into a band's, and other ones each time.
    for lengths in [&[179, 179][..], &[5 * 90, 5 * 90], &[7 * 90 + 1, 90, 16 * 90]] {
        let mut frame = renderer.frame(5);
        let mut pixels = Vec::new();
        for &length in lengths.iter().cycle() {
            let mut band = vec![Rgb565::RED; length];
            let Some(area) = frame.next_band(&mut band).unwrap() else { break };
            assert!(area.top_left == Point::new(0, (pixels.len() / 90) as i32) && (area.size.width * area.size.height) as usize <= length);
            pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
        }
        assert!(pixels == whole, "{lengths:?}");
        // Shorter bands have more active triangles, and find the queue full more often.
        assert!(frame.stats().set_up_anew >= stats.set_up_anew);
        assert_eq!(Stats { set_up_anew: stats.set_up_anew, ..frame.stats() }, stats);
    }
}

/// Methods that use the light of vertices alone draw the same picture without tables of highlights. All others are refused.
#[test]
fn tables_of_highlights_change_no_pixel() {
    let size = Size::new(150, 120);
    let mut methods = [0; 2];
    for name in ["teapot", "peer-sphere-plastic", "peer-sphere-lights", "sphere-40"] {
        let scene = scene::load(name).unwrap();
        let stream: Stream<'_> = scene.stream.parse().unwrap();
        let draw = |layout: Layout, shader: Shader| {
            let mut memory = vec![u64::MAX; layout.words::<Rgb565>()];
            let mut renderer = Renderer::<Rgb565>::with_shader(stream, size, &layout, &mut memory, shader.on())?;
            let mut pixels = vec![Rgb565::RED; layout.band()];
            renderer.frame(5).next_band(&mut pixels)?;
            Ok(pixels)
        };
        let layout = Layout::new(150, 120).with_room_for(&stream);
        for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader.facts(), false).is_ok()) {
            let without = draw(layout.without_highlight_tables(), shader);
            let needs_tables = shader.on::<Rgb565>().method().needs_highlight_tables();
            methods[usize::from(needs_tables)] += 1;
            let expected =
                if needs_tables { Err(RenderError::HighlightTables { shader: shader.facts().name }) } else { draw(layout, shader) };
            assert!(without == expected, "{name}, {}: {:?}", shader.name(), without.err());
        }
    }
    assert!(methods[0] == 2 * 4 && methods[1] > 50, "{methods:?}");
    let [with, without] = [Layout::new(150, 120), Layout::new(150, 120).without_highlight_tables()].map(|layout| layout.bytes::<Gray8>());
    assert_eq!(with - without, 8200);
}

/// Materials with equal highlights share a table, also after one of them has changed. If there are too few tables, the number is named.
#[test]
fn materials_share_tables_of_highlights() {
    let size = Size::new(150, 120);
    let scene = scene::load("board").unwrap();
    let stream: Stream<'_> = scene.stream.parse().unwrap();
    let materials = stream.materials.len();
    let draw = |tables: usize, shader: Shader, exponents: [u16; 2]| {
        let layout = Layout::new(150, 120).with_room_for(&stream).highlight_tables(tables);
        let mut memory = vec![u64::MAX; layout.words::<Rgb565>()];
        let mut renderer = Renderer::<Rgb565>::with_shader(stream, size, &layout, &mut memory, shader.on())?;
        let mut pixels = vec![Rgb565::RED; layout.band()];
        for exponent in exponents {
            for index in (0..materials).rev().step_by(2) {
                renderer.scene().set_material(index, Material { exponent, ..stream.materials[index] }).expect("a material");
            }
            renderer.draw().next_band(&mut pixels)?;
        }
        Ok(pixels)
    };
    // Materials without a highlight need none.
    let matt = |index: usize| Material { specular: [0; 3], exponent: index as u16 + 8, ..stream.materials[index] };
    let draw_matt = |tables: usize, shader: Shader| {
        let layout = Layout::new(150, 120).with_room_for(&stream).highlight_tables(tables);
        let mut memory = vec![u64::MAX; layout.words::<Rgb565>()];
        let mut renderer = Renderer::<Rgb565>::with_shader(stream, size, &layout, &mut memory, shader.on())?;
        (0..materials).for_each(|index| renderer.scene().set_material(index, matt(index)).expect("a material"));
        let mut pixels = vec![Rgb565::RED; layout.band()];
        renderer.draw().next_band(&mut pixels).map(|_| pixels)
    };
    for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader.facts(), false).is_ok()) {
        let expected = draw_matt(materials, shader);
        assert!(expected.is_ok() && draw_matt(1, shader) == expected, "{}", shader.name());
    }
    for shader in [Shader::PHONG, Shader::AUTO, Shader::SQRT6] {
        let expected = draw(materials, shader, [20, 40]);
        let Err(RenderError::TooFewHighlightTables { need }) = draw(1, shader, [20, 40]) else { panic!("one table is too few") };
        assert!(need < materials, "{need} tables for {materials} materials");
        assert!(expected.is_ok() && draw(need, shader, [20, 40]) == expected, "{}", shader.name());
        assert_eq!(draw(need - 1, shader, [20, 40]), Err(RenderError::TooFewHighlightTables { need }));
    }
}

#[test]
fn what_does_not_fit_is_named() {
    let scene = scene::load("torus").unwrap();
    let stream: Stream<'_> = scene.stream.parse().unwrap();
    let near = scene::load("sphere-40").unwrap();
    let (size, layout) = (Size::new(64, 48), Layout::new(64, 10));
    let words = layout.words::<Rgb565>();
    let new = |size: Size, layout: Layout, words: usize| {
        Renderer::<Rgb565>::with_shader(stream, size, &layout, &mut vec![0; words], Shader::FLAT.on()).map(drop)
    };
    assert_eq!(new(size, layout, words), Ok(()));
    let refused = [
        (new(Size::new(0, 48), layout, words), RenderError::Size { width: 0, height: 48 }, "0x48"),
        (new(Size::new(64, 0), layout, words), RenderError::Size { width: 64, height: 0 }, "64x0"),
        (new(Size::new(64, MAX_SIDE + 1), layout, words), RenderError::Size { width: 64, height: MAX_SIDE + 1 }, "1 to"),
        (new(Size::new(63, 48), layout, words), RenderError::Layout { width: 63 }, "63 columns"),
        (new(size, Layout::new(64, 0), words), RenderError::Layout { width: 64 }, "no row"),
        (new(size, layout, words - 1), RenderError::Memory { need: words }, "Layout::words"),
        (new(size, layout, 0), RenderError::Memory { need: words }, "Layout::words"),
        (new(size, layout.materials(0), words), RenderError::Materials { need: stream.materials.len() }, "materials"),
    ];
    for (result, error, text) in refused {
        assert_eq!(result, Err(error));
        assert!(error.to_string().contains(text), "{error}");
    }

    let mut memory = vec![0; words];
    let method = stream.header.shader;
    let others: Vec<_> = Shader::ALL.into_iter().filter(|shader| shader.facts().id != method).map(Shader::on).collect();
    for shaders in [&others[..], &[]] {
        let missing = Renderer::<Rgb565>::new(stream, size, &layout, &mut memory, shaders).map(drop);
        assert_eq!(missing, Err(RenderError::UnknownMethod { method }));
        assert!(missing.unwrap_err().to_string().contains(&format!("number {method}")));
    }
    let near = near.stream.parse().unwrap();
    let mut renderer = Renderer::<Rgb565>::with_shader(near, size, &layout, &mut memory, Shader::PHONG.on()).unwrap();
    assert_eq!(renderer.set_shader(named("slerp").on()), Err(RenderError::Light { shader: "slerp" }));
    assert_eq!(renderer.shader().facts(), Shader::PHONG.facts());

    let mut pixels = [Rgb565::RED; 64];
    for length in [0, 63] {
        let short = &mut pixels[..length];
        assert_eq!(renderer.check_band(short), Err(RenderError::Band { need: 64 }));
        assert_eq!(Picture::new(&mut renderer, short, 0).map(drop), Err(RenderError::Band { need: 64 }));
        assert_eq!(renderer.frame(0).next_band(short), Err(RenderError::Band { need: 64 }));
        assert!(short.iter().all(|&pixel| pixel == Rgb565::RED));
    }
    assert_eq!(renderer.check_band(&pixels), Ok(()));
    assert_eq!(renderer.frame(0).next_band(&mut pixels).map(|area| area.map(|area| area.size)), Ok(Some(Size::new(64, 1))));
}

/// The layout that programs are advised to have holds all triangles across borders of bands: none is set up anew in any frame, whatever the method.
/// The number follows from the height of bands. Without the reserve for other poses it is the smallest.
#[test]
fn program_layouts_have_room_for_active_triangles() {
    for name in ["teapot", "torus", "bunny", "gauges"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for (width, height, rows) in [(240, 240, 16), (128, 64, 8)] {
            let size = Size::new(width, height);
            let set_up_anew = |shader: Shader, layout: &Layout| -> u32 {
                let mut memory = vec![0; layout.words::<Rgb565>()];
                let mut renderer = Renderer::with_shader(stream, size, layout, &mut memory, shader.on()).unwrap();
                let mut band = vec![Rgb565::BLACK; layout.band()];
                let frame = |number| {
                    let mut frame = renderer.frame(number);
                    while frame.next_band(&mut band).unwrap().is_some() {}
                    frame.stats().set_up_anew
                };
                (0..u32::from(stream.header.frames).min(120)).map(frame).sum()
            };
            let layout = render::program_layout(&stream, Shader::AUTO, size, rows).unwrap();
            let fewest = render::fewest_active_triangles(&stream, size, rows).unwrap();
            assert_eq!(layout.active_triangles, fewest + fewest.div_ceil(2), "{name}");
            assert!(fewest > 10 && layout.active_triangles < layout.triangles / 4, "{name}: {fewest}");
            for shader in [Shader::AUTO, Shader::PHONG, Shader::GOURAUD] {
                let anew = set_up_anew(shader, &layout.active_triangles(fewest));
                assert_eq!(anew, 0, "{name}, {width}x{height}, {}", shader.name());
            }
            assert!(set_up_anew(Shader::FLAT, &layout.active_triangles(fewest - 1)) > 0, "{name}: {fewest} are too many");
            assert_eq!(
                render::program_layout(&stream, Shader::AUTO, size, height).unwrap().active_triangles,
                0,
                "{name}: one band has no border"
            );
        }
    }
}

/// A frame of more triangles than its lists can hold keeps none from band to band, so no active triangle is of use to it.
#[test]
fn frames_of_too_many_triangles_need_no_active_ones() {
    let side = 200;
    let place = |k: usize| [k % (side + 1), k / (side + 1)].map(|c| (c as f64 / side as f64 - 0.5) * 1.4);
    let corners = |at: usize| [[at, at + 1, at + side + 2], [at, at + side + 2, at + side + 1]];
    let mesh = Mesh {
        positions: (0..(side + 1) * (side + 1)).map(|k| [place(k)[0], place(k)[1], 0.0]).collect(),
        normals: vec![[0.0, 0.0, 1.0]; (side + 1) * (side + 1)],
        triangles: (0..side * side).flat_map(|k| corners(k / side * (side + 1) + k % side)).collect(),
        ..Mesh::default()
    };
    let view = View::orbit(Up::Y, 0.0, 0.0, DISTANCE, 0).fit(&mesh.positions, (1000, 1000), MARGIN);
    let bytes = Look::new(Options::default().surface, view).stream(&quantise(&mesh).0).unwrap();
    let (stream, size) = (bytes.parse().unwrap(), Size::new(1000, 1000));
    let (_, stats) = frame(stream, size, Shader::FLAT, [stream.vertices.len(), stream.triangles.len(), 0], 100);
    assert!(stats.drawn > 65_535 && stats.passes == 10, "{stats:?}");
    assert_eq!((stats.set_up_anew, render::fewest_active_triangles(&stream, size, 100).unwrap()), (0, 0));
}

/// The reserve holds the triangles of a turn that is seen from farther above or from below.
#[test]
fn program_layouts_have_room_for_other_poses() {
    let counts = |elevation: f64| {
        let view = View::orbit(Up::Y, AZIMUTH.to_radians(), elevation.to_radians(), DISTANCE, ORBIT);
        let options = Options { view, size: (240, 240), ..Options::default() };
        let bytes = Converted::read(&root().join("meshes/teapot.obj"), &options, &()).unwrap().stream().unwrap();
        let (stream, size) = (bytes.parse().unwrap(), Size::new(240, 240));
        let layout = render::program_layout(&stream, Shader::AUTO, size, 16).unwrap();
        (layout.active_triangles, render::fewest_active_triangles(&stream, size, 16).unwrap())
    };
    let (room, fewest) = counts(ELEVATION);
    let others = [-40.0, 0.0, 40.0].map(|elevation| counts(elevation).1);
    assert!(others.iter().all(|&other| other <= room), "{others:?} of {room}");
    assert!(others.iter().any(|&other| other > fewest), "{others:?}: the reserve is needed beyond {fewest}");
}
