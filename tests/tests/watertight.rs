//! Closed meshes have no holes: each pixel whose centre lies in a triangle that shows its front on the screen is drawn.
//!
//! Corners are where the core rounds them to. Which pixels a triangle covers is decided by three edge functions in 64-bit
//! integers, and nothing is culled before. Where culling trusts the plane of a triangle that rounding has turned to the front,
//! the background shows through.

use embedded_graphics::{
    pixelcolor::Rgb888,
    prelude::{RgbColor, Size},
};
use microphong::{
    Stream,
    geometry::{pose::Pose, projection::View},
    stream::{
        record::{Header, Triangle},
        seal,
    },
};
use microphong_sim::{
    bytes::StreamBytes,
    look::Look,
    mesh::Mesh,
    quantise::quantise,
    render::{self, Style},
    scene,
    shader::Shader,
    shapes,
    view::{self, Up},
};
use std::{sync::Mutex, thread};
use zerocopy::{FromBytes, IntoBytes};

/// Frames of a whole turn.
const FRAMES: u32 = 120;

/// What no pixel of a mesh looks like.
const BACKGROUND: Rgb888 = Rgb888::MAGENTA;

/// A mesh and the side of the square that it is drawn on.
struct Case {
    name: String,
    stream: StreamBytes,
    side: u32,
}

impl Case {
    /// `stream` on [`BACKGROUND`].
    fn new(name: &str, stream: &StreamBytes, side: u32) -> Self {
        let mut bytes = stream.as_bytes().to_vec();
        let mut header = Header::read_from_prefix(&bytes).unwrap().0;
        header.background = [BACKGROUND.r(), BACKGROUND.g(), BACKGROUND.b()];
        bytes[..size_of::<Header>()].copy_from_slice(header.as_bytes());
        seal(&mut bytes);
        Self { name: name.to_owned(), stream: StreamBytes::from(&bytes[..]), side }
    }

    fn scene(name: &str, side: u32) -> Self {
        Self::new(name, &scene::load(name).unwrap().stream, side)
    }

    /// A star-shaped body, `flat` times as high as it is wide: its radius changes by up to `rough` from vertex to vertex.
    fn star(meridians: usize, bands: usize, rough: f64, flat: f64, parallel: bool, side: u32) -> Self {
        let mut mesh = shapes::sphere(meridians, bands, 0.1);
        for (i, p) in mesh.positions.iter_mut().enumerate() {
            let radius = 1.0 - rough * noise(i as u32);
            *p = [p[0] * radius, p[1] * radius, p[2] * radius * flat];
        }
        let name = format!("star of {} triangles, {rough} rough, {flat} flat", mesh.triangles.len());
        Self::new(&name, &stream(&mesh, parallel), side)
    }
}

/// Of `mesh` under a camera that sees all of it, a little from above.
fn stream(mesh: &Mesh, parallel: bool) -> StreamBytes {
    let mut camera = view::View::orbit(Up::Y, 0.3, 0.2, scene::DISTANCE, FRAMES as u16);
    if parallel {
        camera = camera.parallel();
    }
    let camera = camera.fit(&mesh.positions, (256, 256), scene::MARGIN);
    Look::new(scene::default_surface(), camera).stream(&quantise(mesh).0).unwrap()
}

/// In [0, 1), the same in every run.
fn noise(i: u32) -> f64 {
    let mixed = (i + 1).wrapping_mul(0x9E37_79B9);
    f64::from((mixed ^ mixed >> 15).wrapping_mul(0x85EB_CA6B) >> 8) / f64::from(1 << 24)
}

/// How many triangles that show their front cover the centre of each pixel.
fn covered(stream: &Stream<'_>, side: u32, number: u32) -> Vec<u8> {
    let camera = &stream.header.camera;
    let view = View::new(camera, &Pose::new(camera, number), Size::new(side, side));
    let mut counts = vec![0u8; (side * side) as usize];
    for mesh in stream.meshes {
        let places: Vec<[i64; 2]> = stream
            .vertices_of(mesh)
            .unwrap()
            .iter()
            .map(|vertex| {
                let ([x, y, _], inside) = view.project(view.to_eye(vertex.position));
                assert!(inside, "a vertex is clipped");
                [x.into(), y.into()]
            })
            .collect();
        for triangle in stream.triangles_of(mesh).unwrap() {
            // Clockwise with y down, against the stream's order.
            let [a, c, b] = triangle.corners.map(|corner| places[usize::from(corner)]);
            cover([a, b, c], side, &mut counts);
        }
    }
    counts
}

fn cover(corners: [[i64; 2]; 3], side: u32, counts: &mut [u8]) {
    let [a, b, c] = corners;
    if cross(a, b, c) <= 0 {
        return;
    }
    // Pixels whose centres, at 8/16, lie in the box.
    let range = |k: usize| {
        let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
        (low + 7).div_euclid(16).max(0)..((high - 8).div_euclid(16) + 1).min(side.into())
    };
    for y in range(1) {
        for x in range(0) {
            let centre = [x, y].map(|c| 16 * c + 8);
            let inside = (0..3).all(|k| {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                // A left edge runs up, a top edge to the right: they own their points.
                let owned = to[1] < from[1] || to[1] == from[1] && to[0] > from[0];
                cross(from, to, centre) >= i64::from(!owned)
            });
            counts[y as usize * side as usize + x as usize] += u8::from(inside);
        }
    }
}

/// Twice the area of a triangle, positive if it runs clockwise with y down.
fn cross(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Pixels of one frame that are covered and not drawn, and that are drawn and not covered.
fn differences(case: &Case, style: Style, number: u32) -> (usize, usize) {
    let stream = case.stream.parse().unwrap();
    let (pixels, _) = render::frame::<Rgb888>(stream, Size::new(case.side, case.side), style, 64, number).unwrap();
    let counts = covered(&stream, case.side, number);
    let count =
        |wanted: [bool; 2]| pixels.iter().zip(&counts).filter(|&(&pixel, &count)| [count > 0, pixel != BACKGROUND] == wanted).count();
    (count([true, false]), count([false, true]))
}

/// Covered pixels that are not drawn, in all frames of all cases; without antialiasing no others are drawn either.
fn missing(cases: &[Case], style: Style) -> usize {
    let jobs = Mutex::new(cases.iter().flat_map(|case| (0..FRAMES).map(move |number| (case, number))));
    let missing = Mutex::new(0);
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let job = jobs.lock().unwrap().next();
                    let Some((case, number)) = job else { break };
                    let (holes, extra) = differences(case, style, number);
                    if holes > 0 {
                        println!("{}, frame {number}: {holes} pixels are missing", case.name);
                    }
                    assert!(style.antialias || extra == 0, "{}, frame {number}: {extra} pixels too many", case.name);
                    *missing.lock().unwrap() += holes;
                }
            });
        }
    });
    missing.into_inner().unwrap()
}

#[test]
fn closed_meshes_have_no_holes() {
    let mut cases = vec![
        Case::scene("bunny", 480),
        Case::scene("teapot", 240),
        Case::scene("torus", 200),
        Case::scene("peer-sphere", 160),
        Case::scene("sphere-690", 97),
        Case::scene("dodecahedron", 64),
    ];
    for parallel in [false, true] {
        cases.extend([
            Case::star(40, 30, 0.0, 1.0, parallel, 50),
            Case::star(40, 30, 0.3, 1.0, parallel, 100),
            Case::star(60, 40, 0.05, 0.02, parallel, 90),
            Case::star(200, 12, 0.02, 0.3, parallel, 200),
            Case::star(120, 80, 0.01, 0.7, parallel, 250),
            Case::star(6, 200, 0.02, 1.0, parallel, 120),
        ]);
    }
    assert_eq!(missing(&cases, Shader::FLAT.into()), 0);
}

/// The holes that this is about: with the planes alone, and next to nothing for rounded corners, thin triangles are culled that
/// show their front.
#[test]
fn planes_alone_would_leave_holes() {
    let bunny = scene::load("bunny").unwrap().stream;
    let mut bytes = bunny.as_bytes().to_vec();
    let triangles = bytes.len() - size_of_val(bunny.parse().unwrap().triangles);
    for record in bytes[triangles..].chunks_mut(size_of::<Triangle>()) {
        let thick = Triangle { inverse_altitude: 1, ..Triangle::read_from_bytes(record).unwrap() };
        record.copy_from_slice(thick.as_bytes());
    }
    let case = Case::new("bunny of thick triangles", &StreamBytes::from(&bytes[..]), 480);
    assert!(differences(&case, Shader::FLAT.into(), 59).0 > 0);
}

#[test]
fn antialiasing_leaves_no_holes() {
    let cases = [Case::scene("torus", 120), Case::star(60, 40, 0.05, 0.1, false, 100), Case::star(6, 100, 0.02, 1.0, true, 60)];
    assert_eq!(missing(&cases, Style { antialias: true, ..Shader::FLAT.into() }), 0);
}
