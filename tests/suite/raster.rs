//! Coverage against the exact rule, and meshes without gaps or pixels drawn twice.
//!
//! The oracle decides each pixel by itself with three edge functions in 64-bit integers; it shares no code with
//! the rasterizer, which walks edges.

use microphong_sim::stress::{
    self,
    coverage::{Coverage, HEIGHT, WIDTH, centre, draw, side},
    random::Random,
};
use microphong_tests::{cases, seed};

#[test]
fn coverage_of_random_triangles_is_exact() {
    let cases = cases(100_000);
    let summary = stress::run(&Coverage, seed(), 0, &|count| count < cases);
    println!("{summary:?}");
    assert!(summary.failures == 0 && summary.cases > cases / 100 * 99, "{summary:?}");
}

#[test]
fn fans_are_watertight() {
    let mut random = Random::new(seed(), 0);
    for _ in 0..cases(2_000) {
        // A rectangle cut into a fan around an inner point: each centre within it belongs to exactly one triangle.
        let [l, t] = [(); 2].map(|()| random.pick(-300..300));
        let (r, b) = (l + random.pick(40..1600), t + random.pick(40..1300));
        let hub = [random.pick(l + 1..r), random.pick(t + 1..b)];
        let mut rim = vec![[l, t]];
        for (from, to) in [([l, t], [r, t]), ([r, t], [r, b]), ([r, b], [l, b]), ([l, b], [l, t])] {
            let mut cuts: Vec<i32> = (0..4).map(|_| random.pick(1..1000)).collect();
            cuts.sort_unstable();
            rim.extend(cuts.into_iter().map(|k| [0, 1].map(|c| from[c] + (to[c] - from[c]) * k / 1000)));
            rim.push(to);
        }
        let mut counts = vec![0u8; WIDTH * HEIGHT];
        for pair in rim.windows(2) {
            draw([hub, pair[0], pair[1]], 16, &mut counts);
        }
        for (k, &count) in counts.iter().enumerate() {
            let [x, y] = centre(k);
            let inside = (l..r).contains(&x) && (t..b).contains(&y);
            assert_eq!(count, u8::from(inside), "rectangle {l},{t} to {r},{b}, hub {hub:?}, pixel {},{}", k % WIDTH, k / WIDTH);
        }
    }
}

#[test]
fn closed_convex_meshes_cover_each_pixel_once() {
    use embedded_graphics::{pixelcolor::Rgb888, prelude::*};
    use microphong::stream::{record::Header, seal};
    use microphong_sim::{bytes::StreamBytes, render, scene, shader::Shader};
    use zerocopy::{FromBytes, IntoBytes};

    for name in ["sphere-168", "sphere-374", "sphere-690", "peer-sphere", "sphere-40", "dodecahedron"] {
        // A background that no material has tells pixels that were drawn from those that were not.
        let mut bytes = scene::load(name).unwrap().stream.as_bytes().to_vec();
        let mut header = Header::read_from_prefix(&bytes).unwrap().0;
        (header.background, header.background_bottom) = ([255, 0, 255], [255, 0, 255]);
        bytes[..size_of::<Header>()].copy_from_slice(header.as_bytes());
        seal(&mut bytes);
        let bytes = StreamBytes::from(bytes.as_slice());
        for number in [0, 7, 40] {
            let size = Size::new(320, 240);
            let (pixels, stats) = render::frame::<Rgb888>(bytes.parse().unwrap(), size, Shader::FLAT, 16, number).unwrap();
            let covered: Vec<bool> = pixels.iter().map(|&pixel| pixel != Rgb888::MAGENTA).collect();
            let count = covered.iter().filter(|&&covered| covered).count();
            assert_eq!(stats.pixels as usize, count, "{name}, frame {number}: pixels drawn twice");
            // A convex outline has no hole: in each row the covered pixels are one run.
            for (y, row) in covered.chunks(320).enumerate() {
                let runs = row.windows(2).filter(|pair| !pair[0] && pair[1]).count() + usize::from(row[0]);
                assert!(runs <= 1, "{name}, frame {number}: a gap in row {y}");
            }
        }
    }
}

/// A ray through a pixel centre enters a closed mesh as often as it leaves it: so front and back faces cover each
/// pixel equally often, unless an edge leaves a gap or draws twice.
#[test]
fn closed_meshes_are_entered_as_often_as_left() {
    use embedded_graphics::prelude::Size;
    use microphong::geometry::{lens::Lens, model_view::ModelView, projection::View};
    use microphong_sim::scene;

    for name in ["torus", "sphere-690", "peer-sphere", "sphere-40", "dodecahedron"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for number in [0, 11, 50, 93] {
            let camera = &stream.header.camera;
            let view = View::new(&Lens::new(camera, Size::new(WIDTH as u32, HEIGHT as u32)), &ModelView::new(camera, number));
            let [mut front, mut back] = [0; 2].map(|_| vec![0u8; WIDTH * HEIGHT]);
            let mut pixels = 0;
            for mesh in stream.meshes {
                let vertices = stream.vertices_of(mesh).unwrap();
                for triangle in stream.triangles_of(mesh).unwrap() {
                    let corners = triangle.corners.map(|corner| {
                        let ([x, y, _], inside) = view.lens.project(view.to_eye(vertices[usize::from(corner)].position));
                        assert!(inside, "{name}: the scenes are wholly visible");
                        [x, y]
                    });
                    let [a, b, c] = corners;
                    if side(a, b, c) > 0 {
                        pixels += draw([a, b, c], 16, &mut back);
                    } else {
                        pixels += draw([a, c, b], 16, &mut front);
                    }
                }
            }
            assert!(front == back, "{name}, frame {number}: a gap, or a pixel drawn twice");
            assert!(pixels > 2_000, "{name}: {pixels} pixels");
        }
    }
}
