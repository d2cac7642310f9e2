//! Coverage against the exact rule, and meshes without gaps or pixels drawn twice.
//!
//! The oracle decides each pixel by itself with three edge functions in 64-bit integers; it shares no code with
//! the rasterizer, which walks edges.

use microphong::{
    geometry::{
        cull::Extent,
        projection::{ScreenVertex, State},
        viewport::Bounds,
    },
    interpolate::Constant,
    raster::{active::ActiveTriangles, band::Band, pixel_shader::Solid, triangle::ScreenTriangle},
    setup::gradients::Gradients,
};
use proptest::{
    prelude::Rng,
    test_runner::{RngAlgorithm, TestRng},
};
use std::ops::Range;

const WIDTH: usize = 96;
const HEIGHT: usize = 80;

type Corners = [[i32; 2]; 3];

/// Random numbers, the same in every run.
struct Random(TestRng);

impl Random {
    fn new(seed: u8) -> Self {
        Self(TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]))
    }

    fn pick(&mut self, range: Range<i32>) -> i32 {
        range.start + (self.0.next_u64() % (range.end - range.start) as u64) as i32
    }

    fn point(&mut self, x: Range<i32>, y: Range<i32>) -> [i32; 2] {
        [self.pick(x), self.pick(y)]
    }

    /// One of the kinds of triangle that rasterizers get wrong.
    fn triangle(&mut self, kind: usize) -> Corners {
        let (w, h) = (WIDTH as i32 * 16, HEIGHT as i32 * 16);
        match kind {
            // Within the viewport.
            0 => [0; 3].map(|_| self.point(0..w, 0..h)),
            // Tiny.
            1 => {
                let [x, y] = self.point(0..w, 0..h);
                [[x, y], self.point(x - 40..x + 40, y - 40..y + 40), self.point(x - 40..x + 40, y - 40..y + 40)]
            }
            // Across the viewport's border.
            2 => [0; 3].map(|_| self.point(-w..2 * w, -h..2 * h)),
            // Huge, to the ends of the guard band.
            3 => [0; 3].map(|_| self.point(-65_536..65_536, -65_536..65_536)),
            // Slivers: the third corner close to the middle of the long side.
            4 => {
                let (a, b) = (self.point(-100..w + 100, -100..h + 100), self.point(-100..w + 100, -100..h + 100));
                let [x, y] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
                [a, b, self.point(x - 9..x + 9, y - 9..y + 9)]
            }
            // Corners on pixel centres.
            _ => [0; 3].map(|_| self.point(-4..WIDTH as i32 + 4, -4..HEIGHT as i32 + 4).map(|c| c * 16 + 8)),
        }
    }
}

fn vertex([x, y]: [i32; 2]) -> ScreenVertex {
    ScreenVertex { x, y, depth: 1 << 27, light: [0; 3], state: State::READY }
}

/// Adds to `counts` the pixels that the core draws for a triangle, band by band; returns how many it says they are.
fn draw(corners: Corners, band_rows: usize, counts: &mut [u8]) -> u32 {
    let vertices = corners.map(vertex);
    let corners = [&vertices[0], &vertices[1], &vertices[2]];
    let mut drawn = 0;
    for top in (0..HEIGHT).step_by(band_rows) {
        let rows = band_rows.min(HEIGHT - top);
        let mut pixels = vec![0u8; rows * WIDTH];
        let mut depth = vec![0u16; rows * WIDTH];
        let mut band = Band {
            pixels: &mut pixels,
            depth: &mut depth,
            width: WIDTH,
            top: top as i32,
            rows: rows as i32,
            blend: None,
            active: ActiveTriangles::default(),
        };
        let screen = ScreenTriangle::new(corners, [WIDTH, top, top + rows].map(|side| side as i32));
        let visible = Bounds::new(&Extent::new(screen.corners)).clipped(WIDTH as i32, HEIGHT as i32).sides();
        let Some(gradients) = Gradients::new(screen.corners, visible) else { return 0 };
        drawn += screen.draw(&gradients, Constant, Solid(1), &mut band);
        for (count, pixel) in counts[top * WIDTH..].iter_mut().zip(&pixels) {
            *count += pixel;
        }
    }
    drawn
}

/// The cross product of two sides; positive to the right of `a` to `b`, y running down.
fn side(a: [i32; 2], b: [i32; 2], p: [i32; 2]) -> i64 {
    let d = |p: [i32; 2], k: usize| i64::from(p[k]) - i64::from(a[k]);
    d(b, 0) * d(p, 1) - d(b, 1) * d(p, 0)
}

/// Whether a point belongs to the triangle: inside, or on a top or left edge.
fn covers(corners: Corners, point: [i32; 2]) -> bool {
    (0..3).all(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        // Clockwise with y down: a left edge goes up, a top edge goes right.
        let owned = b[1] < a[1] || (b[1] == a[1] && b[0] > a[0]);
        let side = side(a, b, point);
        side > 0 || (side == 0 && owned)
    })
}

fn centre(pixel: usize) -> [i32; 2] {
    [(pixel % WIDTH) as i32 * 16 + 8, (pixel / WIDTH) as i32 * 16 + 8]
}

#[test]
fn coverage_of_100_000_random_triangles_is_exact() {
    let mut random = Random::new(1);
    let (mut triangles, mut pixels) = (0, 0u64);
    for i in 0..100_000 {
        let mut corners = random.triangle(i % 6);
        if side(corners[0], corners[1], corners[2]) < 0 {
            corners.swap(1, 2);
        }
        if side(corners[0], corners[1], corners[2]) == 0 {
            continue;
        }
        let mut counts = vec![0u8; WIDTH * HEIGHT];
        let drawn = draw(corners, [HEIGHT, 7, 16, 1][i % 4], &mut counts);
        let mut expected = 0;
        for (k, &count) in counts.iter().enumerate() {
            let inside = covers(corners, centre(k));
            expected += u32::from(inside);
            assert_eq!(count, u8::from(inside), "triangle {i} {corners:?}, pixel {},{}", k % WIDTH, k / WIDTH);
        }
        assert_eq!(drawn, expected, "triangle {i} {corners:?}");
        triangles += 1;
        pixels += u64::from(drawn);
    }
    println!("{triangles} triangles, {pixels} pixels, 0 differ");
    assert!(triangles > 99_000);
}

#[test]
fn fans_are_watertight() {
    let mut random = Random::new(2);
    for _ in 0..2_000 {
        // A rectangle cut into a fan around an inner point: each centre within it belongs to exactly one triangle.
        let [l, t] = random.point(-300..300, -300..300);
        let (r, b) = (l + random.pick(40..1600), t + random.pick(40..1300));
        let hub = random.point(l + 1..r, t + 1..b);
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
        header.background = [255, 0, 255];
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
    use microphong::geometry::{pose::Pose, projection::View};
    use microphong_sim::scene;

    for name in ["torus", "sphere-690", "peer-sphere", "sphere-40", "dodecahedron"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for number in [0, 11, 50, 93] {
            let camera = &stream.header.camera;
            let view = View::new(camera, &Pose::new(camera, number), Size::new(WIDTH as u32, HEIGHT as u32));
            let [mut front, mut back] = [0; 2].map(|_| vec![0u8; WIDTH * HEIGHT]);
            let mut pixels = 0;
            for mesh in stream.meshes {
                let vertices = stream.vertices_of(mesh).unwrap();
                for triangle in stream.triangles_of(mesh).unwrap() {
                    let corners = triangle.corners.map(|corner| {
                        let ([x, y, _], inside) = view.project(view.to_eye(vertices[usize::from(corner)].position));
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
