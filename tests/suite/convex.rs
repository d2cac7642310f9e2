//! A closed convex mesh is drawn without depth test where that cannot matter, and looks the same, pixel by pixel. No other mesh is drawn so.

use embedded_graphics::{pixelcolor::Rgb888, prelude::Size};
use microphong::{Counts, Stats, renderer::check, stream::record::CLOSED_CONVEX};
use microphong_sim::{
    bytes::StreamBytes,
    look::{Lamp, Look, Surface},
    mesh::Mesh,
    quantise::quantise,
    render::{self, Style},
    scene,
    shader::Shader,
    shapes,
    vector::{V3, add, cross, dot, length, product, rotation, scale, sub, unit},
    view::{Up, View},
};
use microphong_tests::{runner, unmarked};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Number of pixels that differ with and without the mark, in bands of `rows` rows.
fn difference(stream: &StreamBytes, size: Size, style: impl Into<Style>, rows: u32, frames: impl Iterator<Item = u32>) -> usize {
    let (style, plain) = (style.into(), unmarked(stream));
    let differing = frames.map(|number| {
        let picture = |stream: &StreamBytes| render::frame::<Rgb888>(stream.parse().unwrap(), size, style, rows, number).unwrap();
        let ((a, stats), (b, expected)) = (picture(stream), picture(&plain));
        // What the mark is for is all that differs.
        assert_eq!(Stats { counts: Counts { without_depth: 0, ..stats.counts }, ..stats }, expected, "frame {number}");
        a.iter().zip(&b).filter(|(a, b)| a != b).count()
    });
    differing.sum()
}

fn is_marked(stream: &StreamBytes) -> bool {
    stream.parse().unwrap().meshes[0].flags & CLOSED_CONVEX != 0
}

fn convex_scenes() -> impl Iterator<Item = (&'static str, StreamBytes)> {
    let names = ["sphere-168", "sphere-374", "sphere-690", scene::CONVEX, "sphere-40", "dodecahedron"];
    names.into_iter().map(|name| (name, scene::load(name).unwrap().stream))
}

#[test]
fn convex_scenes_look_the_same() {
    for (name, stream) in convex_scenes() {
        assert!(is_marked(&stream), "{name}");
        for (width, height, rows) in [(320, 240, 240), (47, 61, 1), (16, 16, 5), (640, 480, 20), (1001, 200, 64)] {
            // Flat shading shows best which triangle a pixel has.
            let differing = difference(&stream, Size::new(width, height), Shader::FLAT, rows, (0..120).step_by(7));
            assert_eq!(differing, 0, "{name} at {width}x{height}");
        }
    }
}

#[test]
fn every_method_looks_the_same() {
    for (name, stream) in convex_scenes() {
        let parsed = stream.parse().unwrap();
        for shader in Shader::ALL {
            for (perspective_correct, antialias, dither) in
                [(false, false, false), (false, false, true), (true, false, false), (false, true, false)]
            {
                if check(&parsed, shader.facts(), perspective_correct).is_ok() {
                    let style = Style { perspective_correct, antialias, dither, ..Style::from(shader) };
                    assert_eq!(difference(&stream, Size::new(120, 90), style, 16, [3, 62].into_iter()), 0, "{name}, {style:?}");
                }
            }
        }
    }
}

/// A mesh that would be convex but for a coordinate of one vertex, which is off by `by` units of the last place.
fn dented(mut mesh: Mesh, vertex: usize, by: f64) -> Mesh {
    let vertex = vertex % mesh.positions.len();
    let p = mesh.positions[vertex];
    mesh.positions[vertex] = scale(p, 1.0 - by / (length(p) * 16384.0));
    mesh
}

/// A sphere around each centre, all in the unit sphere.
fn balls(centres: &[V3], radius: f64) -> Mesh {
    let mut all = Mesh::default();
    for &centre in centres {
        let ball = shapes::sphere(8, 6, 0.1);
        let first = all.positions.len();
        all.positions.extend(ball.positions.iter().map(|&p| add(scale(p, radius), centre)));
        all.normals.extend(ball.normals);
        all.triangles.extend(ball.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    all
}

/// A prism on a polygon with corners at these angles, `height` high.
fn prism(angles: &[f64], height: f64) -> Mesh {
    let radius = (1.0 - height * height).sqrt() * 0.999;
    let ring = |z: f64| angles.iter().map(move |a| [radius * a.cos(), radius * a.sin(), z]);
    let positions: Vec<V3> = ring(height).chain(ring(-height)).collect();
    let n = angles.len();
    let mut triangles = Vec::new();
    for k in 1..n - 1 {
        triangles.push([0, k, k + 1]);
        triangles.push([n, n + k + 1, n + k]);
    }
    for k in 0..n {
        let next = (k + 1) % n;
        triangles.push([k, n + k, n + next]);
        triangles.push([k, n + next, next]);
    }
    Mesh { normals: positions.iter().filter_map(|&p| unit(p)).collect(), positions, triangles, ..Mesh::default() }
}

fn marked(mesh: &Mesh) -> bool {
    quantise(mesh).0.iter().any(|part| part.closed_convex)
}

#[test]
fn nothing_else_is_marked() {
    let corners: Vec<f64> = (0..8).map(|k| TAU * f64::from(k) / 8.0).collect();
    let (sphere, plate) = (shapes::sphere(12, 8, 0.0), prism(&corners, 0.2));
    assert!(marked(&sphere) && marked(&plate) && marked(&shapes::dodecahedron()));
    assert!(!marked(&shapes::torus(12, 8)) && !marked(&shapes::cushion(4)) && !marked(&shapes::bulged_triangle()));

    // Dents by one unit, on an edge, in a flat face that is cut to triangles, and where only a pole knows.
    for vertex in 0..16 {
        assert!(!marked(&dented(plate.clone(), vertex, 1.0)) && !marked(&dented(plate.clone(), vertex, -1.0)), "vertex {vertex}");
    }
    for (mesh, is_flat) in [(&sphere, false), (&plate, true)] {
        // An inner point of a triangle: level with it, in a dent, on a bump. One on part of a flat face has a dent around it.
        let [a, b, c] = mesh.triangles[0];
        let mut cut = mesh.clone();
        let [p, q, r] = [a, b, c].map(|v| mesh.positions[v]);
        let front = unit(cross(sub(q, p), sub(r, p))).unwrap();
        let inner = mesh.positions.len();
        cut.triangles[0] = [a, b, inner];
        cut.triangles.extend([[b, c, inner], [c, a, inner]]);
        cut.normals.push(front);
        let middle = scale(add(p, add(q, r)), 1.0 / 3.0);
        let at =
            |height: f64| Mesh { positions: [&mesh.positions[..], &[add(middle, scale(front, height / 16384.0))]].concat(), ..cut.clone() };
        assert!(marked(&at(0.0)) && !marked(&at(-1.0)) && marked(&at(1.0)) != is_flat);
        // Too high, and the neighbours are below it no more.
        assert!(!marked(&at(3_000.0)));
    }

    // Several bodies: beside, within, and upon one another.
    assert!(marked(&balls(&[[0.0; 3]], 0.4)));
    for centres in [[[0.0; 3], [0.5, 0.0, 0.0]], [[0.0; 3], [0.0; 3]], [[0.0; 3], [0.2 / 16384.0, 0.0, 0.0]]] {
        assert!(!marked(&balls(&centres, 0.4)), "{centres:?}");
    }
    // Twice around with each side in between: closed, all planes nearly below all corners, but wound up.
    let twice: Vec<f64> = (0..16).map(|k| TAU * f64::from(k) / 8.0 + f64::from(k) * 1e-7).collect();
    assert!(!marked(&prism(&twice, 0.2)));

    // Open, inside out, one triangle turned, one twice, one without an area.
    let open = Mesh { triangles: sphere.triangles[1..].to_vec(), ..sphere.clone() };
    let inside_out = Mesh { triangles: sphere.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(), ..sphere.clone() };
    let mut turned = sphere.clone();
    turned.triangles[5].swap(0, 1);
    let mut twice = sphere.clone();
    twice.triangles.push(sphere.triangles[5]);
    let mut flat = sphere.clone();
    flat.triangles.push([1, 2, 2]);
    for mesh in [open, inside_out, turned, twice, flat] {
        assert!(!marked(&mesh));
    }
    // Vertices of their own on both sides of an edge, as hard edges have them, are no gap.
    let mut hard = Mesh::default();
    for triangle in &plate.triangles {
        hard.triangles.push([0, 1, 2].map(|k| k + hard.positions.len()));
        hard.positions.extend(triangle.map(|v| plate.positions[v]));
        hard.normals.extend(triangle.map(|v| plate.normals[v]));
    }
    assert!(marked(&hard));

    // Triangles as thin as rounding: their planes may lean anywhere.
    assert!(!marked(&prism(&[0.7, 0.7001, 2.0, 4.0], 0.2)));
    assert!(!marked(&prism(&corners, 0.2 / 16384.0)));
    // Outside of the unit sphere.
    assert!(!marked(&Mesh { positions: sphere.positions.iter().map(|&p| add(p, [0.1, 0.0, 0.0])).collect(), ..sphere.clone() }));
    // Many meshes.
    assert!(!marked(&shapes::sphere(300, 300, 0.0)));
}

/// The convex hull of points on a sphere, no four of them in one plane.
fn hull(points: &[V3]) -> Mesh {
    let mut triangles = Vec::new();
    for a in 0..points.len() {
        for b in a + 1..points.len() {
            for c in b + 1..points.len() {
                let normal = cross(sub(points[b], points[a]), sub(points[c], points[a]));
                let side = |p: &V3| dot(normal, sub(*p, points[a]));
                let others = || (0..points.len()).filter(|k| ![a, b, c].contains(k)).map(|k| side(&points[k]));
                if others().all(|side| side < 0.0) {
                    triangles.push([a, b, c]);
                } else if others().all(|side| side > 0.0) {
                    triangles.push([a, c, b]);
                }
            }
        }
    }
    Mesh { positions: points.to_vec(), normals: points.to_vec(), triangles, ..Mesh::default() }
}

/// Squeezed along the axes, turned, and moved to where the sphere around it is the unit sphere.
fn placed(mut mesh: Mesh, squeeze: V3, turn: V3) -> Mesh {
    for (position, normal) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        *position = [0, 1, 2].map(|k| position[k] * squeeze[k]);
        *normal = unit([0, 1, 2].map(|k| normal[k] / squeeze[k])).unwrap();
    }
    shapes::turned(mesh, &product(&rotation([1.0, 0.0, 0.0], turn[0]), &rotation([0.0, 1.0, 0.0], turn[1])))
}

fn directions(count: impl Into<proptest::collection::SizeRange>) -> impl Strategy<Value = Vec<V3>> {
    proptest::collection::vec(prop::array::uniform3(-1.0..1.0f64), count).prop_map(|all| all.into_iter().filter_map(unit).collect())
}

/// Bodies with triangles of all shapes: globes, hulls of points, prisms whose flat ends are cut to slivers.
fn bodies() -> impl Strategy<Value = Mesh> {
    let globe = (3usize..40, 2usize..40, 0.0..7.0f64).prop_map(|(sides, bands, turn)| shapes::sphere(sides, bands, turn));
    let random = directions(5..16usize).prop_map(|points| hull(&points));
    let steps = proptest::collection::vec(prop_oneof![0.02..0.1f64, 0.1..1.0], 3..30);
    let slivers = (steps, 0.005..0.3f64).prop_map(|(steps, height)| {
        let sum: f64 = steps.iter().sum();
        let angles: Vec<f64> = steps.iter().scan(0.0, |angle, step| Some(std::mem::replace(angle, *angle + step / sum * TAU))).collect();
        prism(&angles, height)
    });
    let squeeze = (prop_oneof![0.01..0.1f64, 0.1..1.0f64], prop_oneof![Just(1.0), 0.1..1.0f64], 0.3..1.0f64);
    (prop_oneof![globe, random, slivers], squeeze, prop::array::uniform3(0.0..7.0f64))
        .prop_map(|(mesh, (x, y, z), turn)| placed(mesh, [x, y, z], turn))
}

/// Views from so near that the mesh is clipped to far away, straight at it or past it.
fn views() -> impl Strategy<Value = View> {
    let aside = (-0.5..0.5f64, -0.5..0.5f64, any::<bool>());
    let planes = (prop_oneof![Just(None), (0.02..2.0f64).prop_map(Some)], -0.5..2.0f64);
    (0.3..6.0f64, 0.3..8.0f64, any::<bool>(), -1.5..1.5f64, aside, planes).prop_map(
        |(distance, focal, parallel, elevation, (x, y, aside), (near, far))| {
            let mut view = View::orbit(Up::Y, 0.3, elevation, distance, 50).focal(focal);
            if aside {
                (view.translation[0], view.translation[1]) = (x, y);
            }
            view.near = near.unwrap_or(view.near);
            view.far = (distance + far).max(view.near + 0.1);
            if parallel { view.parallel() } else { view }
        },
    )
}

#[test]
fn convex_bodies_look_the_same() {
    let mut runner = runner(3_000);
    let (all, without_depth) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    let sizes = (8u32..400, 8u32..400, 1u32..100);
    runner
        .run(&(bodies(), views(), sizes, 0u32..50), |(mesh, view, (width, height, rows), number)| {
            let (parts, _) = quantise(&mesh);
            let mut look = Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 20), view);
            look.lamps = vec![Lamp::distant([0.4, 0.3, -1.0], [1.0; 3])];
            let stream = look.stream(&parts).unwrap();
            all.set(all.get() + 1);
            without_depth.set(without_depth.get() + usize::from(is_marked(&stream)));
            let frames = [number, (number + 23) % 50].into_iter();
            prop_assert_eq!(difference(&stream, Size::new(width, height), Shader::FLAT, rows, frames), 0);
            Ok(())
        })
        .unwrap();
    println!("{} of {} bodies marked", without_depth.get(), all.get());
    assert!(2 * without_depth.get() > all.get());
}
