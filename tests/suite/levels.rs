//! Levels of detail: what coarser triangles save, and that pictures hardly show it.

use embedded_graphics::{
    geometry::Size,
    pixelcolor::{Rgb888, RgbColor},
};
use microphong::{
    Layout, Renderer, Stats, Stream,
    format::{GeometricError, Length, Radius},
    geometry::detail::stream_tolerance,
    stream::{
        record::{Header, Mesh, PERSPECTIVE},
        seal,
    },
};
use microphong_sim::{
    bytes::StreamBytes,
    convert::{DISTANCE, MARGIN},
    distance::distance,
    levels,
    look::{Look, Surface},
    obj,
    quantise::quantise,
    records::position,
    render,
    shader::Shader,
    shapes,
    vector::V3,
    view::{Up, View},
};
use std::{cell::Cell, error::Error, fs, iter};
use zerocopy::FromBytes;

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

/// Frames of a turn.
const FRAMES: u16 = 12;
const SHADER: Shader = Shader::GOURAUD;

/// A mesh of `tests/meshes` with coarser levels for pictures of these sides, and the same without.
fn streams(name: &str, sides: &[u32]) -> Result<[StreamBytes; 2]> {
    let text = fs::read_to_string(format!("{}/meshes/{name}.obj", env!("CARGO_MANIFEST_DIR")))?;
    let (mesh, _) = microphong_sim::mesh::weld(&obj::parse(&text)?.soup, microphong_sim::mesh::Weld::SMOOTH)?;
    let view = View::orbit(Up::Y, 0.5, 0.35, DISTANCE, FRAMES).fit(&mesh.positions, (64, 64), MARGIN);
    // Black behind a surface that is nowhere black: what is covered can be told.
    let surface = Surface::metal([1.0; 3], [0.3, 0.5, 0.2], 30);
    let look = Look { background: [0; 3].into(), ..Look::new(surface, view) };
    let (mut parts, _) = quantise(&mesh);
    let without = look.stream(&parts)?;
    let errors: Vec<_> = sides.iter().map(|&side| look.tolerance(&parts, (side, side))).collect();
    levels::add(&mesh, &mut parts, &errors, &|| ())?;
    Ok([look.stream(&parts)?, without])
}

/// Frame `number`, with coarser levels or without.
fn frame(stream: Stream<'_>, side: u32, number: u32, on: bool) -> Result<(Vec<Rgb888>, Stats)> {
    let size = Size::new(side, side);
    let layout = render::layout(&stream, size, side);
    let (mut memory, mut band) = (vec![0; layout.words::<Rgb888>()], vec![Rgb888::BLACK; layout.band()]);
    let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, SHADER.on())?;
    renderer.set_levels_of_detail(on);
    let mut frame = renderer.frame(number);
    while frame.next_band(&mut band)?.is_some() {}
    let stats = frame.stats();
    Ok((band, stats))
}

/// Number of pixels that only one picture covers, and of pixels among them in whose neighbourhood of 3x3 the other picture covers none.
fn differences(one: &[Rgb888], other: &[Rgb888], side: u32) -> [usize; 2] {
    let side = side as usize;
    let covered = |picture: &[Rgb888], at: usize| picture[at] != Rgb888::BLACK;
    let differ = |at: &usize| covered(one, *at) != covered(other, *at);
    let is_far = |at: &usize| {
        let around = |c: usize| c.saturating_sub(1)..(c + 2).min(side);
        let mut near = around(at / side).flat_map(|y| around(at % side).map(move |x| y * side + x));
        near.all(|neighbour| covered(other, neighbour) != covered(one, *at))
    };
    let all: Vec<usize> = (0..side * side).filter(differ).collect();
    [all.len(), all.iter().filter(|at| is_far(at)).count()]
}

/// Pictures have fewer triangles, and outlines that are nowhere off by more than a pixel. Switched off, nothing is different.
#[test]
fn coarser_levels_keep_the_outline() -> Result {
    for (name, sides) in [("bunny", [240, 128, 64]), ("teapot", [128, 64, 32])] {
        let [with, without] = streams(name, &sides)?;
        let (with, without) = (with.parse()?, without.parse()?);
        for side in sides {
            let (mut drawn, mut plain, mut differ) = (0, 0, 0);
            for number in 0..u32::from(FRAMES) {
                let (picture, stats) = frame(with, side, number, true)?;
                let (exact, expected) = frame(without, side, number, true)?;
                let (off, all) = frame(with, side, number, false)?;
                assert!(off == exact && all == expected, "{name} {side} {number}: off is not as without levels");
                assert_eq!(stats.triangles + stats.simplified, expected.triangles, "{name} {side} {number}");
                assert!(stats.simplified > 0 && expected.simplified == 0, "{name} {side} {number}: {stats:?}");
                let [all, far] = differences(&picture, &exact, side);
                assert_eq!(far, 0, "{name} {side} {number}: {far} of {all} pixels are off by more than one");
                (drawn, plain, differ) = (drawn + stats.drawn, plain + expected.drawn, differ + all);
            }
            assert!(drawn < plain);
            println!("{name} {side}x{side}: {drawn} triangles drawn in place of {plain}, {differ} pixels of {FRAMES} outlines differ");
        }
    }
    Ok(())
}

/// A level states its true error. The level that is drawn is the coarsest one whose error is less than half a pixel.
#[test]
fn errors_are_true_and_the_coarsest_is_drawn() -> Result {
    let [stream, _] = streams("teapot", &[160, 96, 64, 32, 16])?;
    let stream = stream.parse()?;
    let corners = |mesh: &Mesh| -> Vec<[V3; 3]> {
        let vertices = stream.vertices_of(mesh).unwrap_or_default();
        let triangles = stream.triangles_of(mesh).unwrap_or_default();
        triangles.iter().map(|t| t.corners.map(|c| position(&vertices[usize::from(c)]).map(f64::from))).collect()
    };
    assert!(stream.meshes.len() > 3, "{}", stream.meshes.len());
    let finest = corners(&stream.meshes[0]);
    for level in &stream.meshes[1..] {
        let triangles = corners(level);
        for (from, to) in [(&finest, &triangles), (&triangles, &finest)] {
            let apart = from.iter().flatten().map(|&p| to.iter().map(|t| distance(p, t)).fold(f64::INFINITY, f64::min)).fold(0.0, f64::max);
            assert!(apart <= f64::from(level.error()), "{apart} {level:?}");
        }
    }
    let header = stream.header;
    assert_eq!(header.camera.projection, PERSPECTIVE);
    for side in 1..400 {
        let z = (f64::from(Length::from_bits(header.camera.translation[2])) - f64::from(Radius::from_bits(header.radius)))
            .max(f64::from(header.camera.near()));
        // A way along the ray to a corner of the picture shows as well, by the slope of that ray.
        let focal = f64::from(header.camera.focal());
        let slope = 1f64.hypot(1.0) / focal;
        let pixels = |error: GeometricError| f64::from(error) / z * focal * f64::from(side) / 2.0 * slope.hypot(1.0);
        let drawn: Vec<&Mesh> = levels::drawn(&stream, Size::new(side, side)).collect();
        let [drawn] = drawn[..] else { panic!("{} levels of one mesh", drawn.len()) };
        assert!(pixels(drawn.error()) < 0.5, "{side}");
        // The next one would be too coarse, but for what is spared for rounding.
        let coarser = stream.meshes.iter().find(|mesh| mesh.error > drawn.error);
        assert!(coarser.is_none_or(|coarser| pixels(coarser.error()) > 0.45), "{side}");
        let (_, stats) = frame(stream, side.min(200), 0, true)?;
        let expected = levels::drawn(&stream, Size::new(side.min(200), side.min(200))).map(|mesh| mesh.triangles).sum::<u32>();
        assert_eq!(stats.triangles, expected);
    }
    Ok(())
}

/// A cube whose faces have many triangles is as good with two each, and is marked as convex at both levels.
#[test]
fn levels_of_a_convex_body_are_marked_where_they_are_convex() -> Result {
    let cells = 8;
    let mut mesh = microphong_sim::mesh::Mesh::default();
    for face in 0..6 {
        let first = mesh.positions.len();
        let turned = |u: f64, v: f64| {
            let sign = if face < 3 { 1.0 } else { -1.0 };
            let mut p = [0.0; 3];
            (p[face % 3], p[(face + 1) % 3], p[(face + 2) % 3]) = (sign, u * sign, v);
            // Without zeros of the other sign: corners that coincide are equal to the bit.
            p.map(|c| c * 0.5 + 0.0)
        };
        let normal = turned(0.0, 0.0).map(|c| 2.0 * c);
        for k in 0..(cells + 1) * (cells + 1) {
            let [u, v] = [k % (cells + 1), k / (cells + 1)].map(|c| 2.0 * c as f64 / cells as f64 - 1.0);
            mesh.positions.push(turned(u, v));
            mesh.normals.push(normal);
        }
        for k in 0..cells * cells {
            let a = first + k / cells * (cells + 1) + k % cells;
            mesh.triangles.extend([[a, a + 1, a + cells + 2], [a, a + cells + 2, a + cells + 1]]);
        }
    }
    let (mut parts, _) = quantise(&mesh);
    let steps = Cell::new(0);
    levels::add(&mesh, &mut parts, &[GeometricError::from_num(0.001)], &|| steps.set(steps.get() + 1))?;
    assert_eq!(steps.get(), parts.len(), "a step is a part at an error");
    let [part] = &parts[..] else { panic!("{} parts", parts.len()) };
    assert!(part.closed_convex);
    let [level] = &part.coarser[..] else { panic!("{} levels", part.coarser.len()) };
    assert!(level.closed_convex && level.triangles.len() < 60, "{} triangles", level.triangles.len());
    Ok(())
}

/// Records in which levels are not as they have to be are refused by name.
#[test]
fn streams_with_wrong_levels_are_refused() -> Result {
    let [stream, _] = streams("teapot", &[64, 32])?;
    assert!(stream.parse().is_ok_and(|stream| stream.meshes.len() == 3));
    let refused = |change: &dyn Fn(&mut [Mesh])| -> Result<String> {
        let mut bytes = stream.as_bytes().to_vec();
        let (_, rest) = Header::mut_from_prefix(&mut bytes).map_err(|_| "no header")?;
        let (meshes, _) = <[Mesh]>::mut_from_prefix_with_elems(rest, 3).map_err(|_| "no meshes")?;
        change(meshes);
        seal(&mut bytes);
        Ok(StreamBytes::from(&bytes[..]).parse().err().map(|error| error.to_string()).unwrap_or_default())
    };
    assert_eq!(refused(&|_| ())?, "");
    let level = |record: u32| format!("mesh level of record {record} is out of range; convert the mesh again");
    assert_eq!(refused(&|meshes| meshes[0].error = 1)?, level(0));
    assert_eq!(refused(&|meshes| meshes[2].error = meshes[1].error)?, level(2));
    assert_eq!(refused(&|meshes| meshes[1].error = u16::MAX)?, level(2));
    assert_eq!(refused(&|meshes| meshes[1].vertices -= 1)?, level(1));
    assert_eq!(refused(&|meshes| meshes[2].material = 1)?, level(2));
    assert_eq!(refused(&|meshes| meshes[1].first_vertex = 1)?, "mesh first vertex of record 1 is out of range; convert the mesh again");
    assert_eq!(refused(&|meshes| meshes[1].error = 0)?, "mesh first vertex of record 1 is out of range; convert the mesh again");
    assert_eq!(
        refused(&|meshes| meshes[2].first_triangle -= 1)?,
        "mesh first triangle of record 2 is out of range; convert the mesh again"
    );
    assert_eq!(refused(&|meshes| meshes[2].triangles -= 1)?, "mesh coverage of record 3 is out of range; convert the mesh again");
    Ok(())
}

/// Two processors, and memory that is too small, draw the same levels.
#[test]
fn levels_are_the_same_however_the_work_is_divided() -> Result {
    let [stream, _] = streams("bunny", &[64])?;
    let stream = stream.parse()?;
    let size = Size::new(64, 64);
    let (exact, stats) = frame(stream, 64, 3, true)?;
    let layout = render::layout(&stream, size, 64);
    let draw = |layout: Layout, share: Option<u16>| -> Result<(Vec<Rgb888>, Stats)> {
        let (mut memory, mut band) = (vec![0; layout.words::<Rgb888>()], vec![Rgb888::BLACK; layout.band()]);
        let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, SHADER.on())?;
        let mut frame = match share {
            Some(share) => {
                let mut preparation = renderer.prepare(3, share);
                let [later, earlier] = preparation.parts().map(|part| part.triangles());
                assert!(
                    earlier.end == later.start && later.end == stats.triangles as usize && !earlier.is_empty(),
                    "{earlier:?} {later:?}"
                );
                preparation.frame()
            }
            None => renderer.frame(3),
        };
        let mut pixels = Vec::new();
        while let Some(area) = frame.next_band(&mut band)? {
            pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
        }
        Ok((pixels, frame.stats()))
    };
    // As many triangles as the level has, not as the file has.
    let enough = layout.triangles(stats.triangles as usize).processors(2);
    for share in [1 << 13, 1 << 15, 7 << 13] {
        assert!(draw(enough, Some(share))? == (exact.clone(), stats), "{share}");
    }
    let (pixels, few) = draw(layout.triangles(10), None)?;
    assert!(pixels == exact && (few.drawn, few.simplified) == (stats.drawn, stats.simplified));
    Ok(())
}

/// Levels are chosen for each mesh. Meshes without levels are drawn in full.
#[test]
fn each_mesh_has_a_level_of_its_own() {
    let mesh =
        |error: u16| Mesh { first_vertex: 0, first_triangle: 0, triangles: 1, vertices: 3, material: 0, error, flags: 0, palette: 0 };
    let meshes: Vec<Mesh> = [0, 3, 9, 0, 0, 5].map(mesh).to_vec();
    let (mut parts, _) = quantise(&shapes::dodecahedron());
    parts.iter_mut().for_each(|part| part.closed_convex = false);
    let bytes = Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 30), View::orbit(Up::Y, 0.0, 0.0, DISTANCE, 0)).stream(&parts);
    let bytes = bytes.expect("a valid stream");
    let stream = Stream { meshes: &meshes, ..bytes.parse().expect("a valid stream") };
    let taken = |error: u16| -> Vec<u16> {
        let forward: Vec<u16> = stream.meshes_within(GeometricError::from_bits(error)).map(|mesh| mesh.error).collect();
        let backward: Vec<u16> = stream.meshes_within(GeometricError::from_bits(error)).rev().map(|mesh| mesh.error).collect();
        assert!(forward.iter().eq(backward.iter().rev()));
        forward
    };
    for (error, expected) in [(0, [0, 0, 0]), (2, [0, 0, 0]), (3, [3, 0, 0]), (8, [3, 0, 5]), (9, [9, 0, 5]), (u16::MAX, [9, 0, 5])] {
        assert_eq!(taken(error), expected, "{error}");
    }
    let sizes = iter::successors(Some(1), |side| Some(side * 2)).take_while(|&side| side < 2048);
    let tolerances: Vec<GeometricError> = sizes.map(|side| stream_tolerance(stream.header, Size::new(side, side))).collect();
    assert!(tolerances.is_sorted_by(|a, b| a >= b), "{tolerances:?}");
}
