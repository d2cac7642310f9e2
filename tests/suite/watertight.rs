//! Closed meshes have no holes: each pixel whose centre lies in a triangle that shows its front on the screen is drawn.
//!
//! Corners are where the core rounds them to. Which pixels a triangle covers is decided by three edge functions in 64-bit
//! integers, and nothing is culled before. Where culling trusts the plane of a triangle that rounding has turned to the front,
//! the background shows through.

use microphong_sim::{
    bytes::StreamBytes,
    convert::{self, Options},
    look::Look,
    mesh::Mesh,
    quantise::quantise,
    render::Style,
    scene,
    shader::Shader,
    shapes,
    stress::{self, random::Random, watertight},
    view::{self, Up},
};
use microphong_tests::{cases, seed, thick};
use std::{sync::Mutex, thread};

/// Frames of a whole turn.
const FRAMES: u32 = 120;

/// A mesh and the side of the square that it is drawn on.
struct Case {
    name: String,
    stream: StreamBytes,
    side: u32,
}

impl Case {
    fn new(name: &str, stream: &StreamBytes, side: u32) -> Self {
        Self { name: name.to_owned(), stream: watertight::on_background(stream), side }
    }

    fn scene(name: &str, side: u32) -> Self {
        Self::new(name, &scene::load(name).unwrap().stream, side)
    }

    /// A star-shaped body, `flat` times as high as it is wide: its radius changes by up to `rough` from vertex to vertex.
    fn star(random: &mut Random, [meridians, bands]: [usize; 2], [rough, flat]: [f64; 2], parallel: bool, side: u32) -> Self {
        let mut mesh = shapes::sphere(meridians, bands, 0.1);
        for p in &mut mesh.positions {
            let radius = 1.0 - rough * random.between(0.0, 1.0);
            *p = [p[0] * radius, p[1] * radius, p[2] * radius * flat];
        }
        let name = format!("star of {} triangles, {rough} rough, {flat} flat", mesh.triangles.len());
        Self::new(&name, &stream(&mesh, parallel), side)
    }
}

/// A stream of `mesh` under a camera that sees all of it, a little from above.
fn stream(mesh: &Mesh, parallel: bool) -> StreamBytes {
    let mut camera = view::View::orbit(Up::Y, 0.3, 0.2, convert::DISTANCE, FRAMES as u16);
    if parallel {
        camera = camera.parallel();
    }
    let camera = camera.fit(&mesh.positions, (256, 256), convert::MARGIN);
    Look::new(Options::default().surface, camera).stream(&quantise(mesh).0).unwrap()
}

/// Pixels of one frame that are covered and not drawn, and that are drawn and not covered.
fn differences(case: &Case, style: Style, number: u32) -> (u64, u64) {
    let stream = case.stream.clone();
    let frame = stress::case::Case { size: [case.side; 2], frame: number, style, band_rows: 64, ..stress::case::Case::new(stream) };
    let found = watertight::judge(&frame).expect("no vertex is clipped");
    (found.missing, found.extra)
}

/// Covered pixels that are not drawn, in all frames of all cases; without antialiasing no others are drawn either.
fn missing(cases: &[Case], style: Style) -> u64 {
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
    let mut all = vec![
        Case::scene("bunny", 480),
        Case::scene("teapot", 240),
        Case::scene("torus", 200),
        Case::scene("peer-sphere", 160),
        Case::scene("sphere-690", 97),
        Case::scene("dodecahedron", 64),
    ];
    let random = &mut Random::new(seed(), 0);
    for parallel in (0..cases(2)).map(|k| k % 2 == 1) {
        all.extend([
            Case::star(random, [40, 30], [0.0, 1.0], parallel, 50),
            Case::star(random, [40, 30], [0.3, 1.0], parallel, 100),
            Case::star(random, [60, 40], [0.05, 0.02], parallel, 90),
            Case::star(random, [200, 12], [0.02, 0.3], parallel, 200),
            Case::star(random, [120, 80], [0.01, 0.7], parallel, 250),
            Case::star(random, [6, 200], [0.02, 1.0], parallel, 120),
        ]);
    }
    assert_eq!(missing(&all, Shader::FLAT.into()), 0);
}

/// The holes that this is about: with the planes alone, and next to nothing for rounded corners, thin triangles are culled that
/// show their front.
#[test]
fn planes_alone_would_leave_holes() {
    let case = Case::new("bunny of thick triangles", &thick(&scene::load("bunny").unwrap().stream), 480);
    assert!((0..120).any(|frame| differences(&case, Shader::FLAT.into(), frame).0 > 0));
}

#[test]
fn antialiasing_leaves_no_holes() {
    let random = &mut Random::new(seed(), 1);
    let mut all = vec![Case::scene("torus", 120)];
    for _ in 0..cases(1) {
        all.push(Case::star(random, [60, 40], [0.05, 0.1], false, 100));
        all.push(Case::star(random, [6, 100], [0.02, 1.0], true, 60));
    }
    assert_eq!(missing(&all, Style { antialias: true, ..Shader::FLAT.into() }), 0);
}
