//! Antialiasing against exact areas, against supersampling, and its seams against nothing: there are none.

use embedded_graphics::{
    pixelcolor::{Rgb565, Rgb888},
    prelude::*,
};
use microphong::{
    Layout, RenderError, Renderer, Stats, Stream,
    coverage::area::TriangleCoverage,
    format::{BIAS, Intensity, RAMP},
    pixel::{Pixel, PixelFormat, ramps::Rounded},
};
use microphong_sim::{
    oracle::{self, Frame},
    render::{self, Style},
    scene,
    shader::Shader,
    stress::random::Random,
};
use microphong_tests::{cases, seed};
use std::collections::BTreeMap;

const WHOLE: i32 = 1 << 16;

type Corners = [[i32; 2]; 3];

fn smooth(shader: Shader) -> Style {
    Style { antialias: true, ..shader.into() }
}

/// A point in a square about the origin.
fn point(random: &mut Random, side: i32) -> [i32; 2] {
    [random.pick(-side..side), random.pick(-side..side)]
}

/// Positive clockwise, y running down.
fn area([a, b, c]: Corners) -> i64 {
    let d = |p: [i32; 2], k: usize| i64::from(p[k]) - i64::from(a[k]);
    d(b, 0) * d(c, 1) - d(b, 1) * d(c, 0)
}

/// A pixel, with its coverage and centroid (16 bits each).
type Covered = ([i32; 2], i32, [i32; 2]);

/// Every pixel that a triangle touches, by the core.
fn coverage(corners: Corners, bits: u32) -> Vec<Covered> {
    let contour = TriangleCoverage::new(corners, bits);
    let mut covered = Vec::new();
    let [top, bottom] = contour.rows();
    for y in top..bottom {
        let mut row = contour.row(y);
        row.enter(row.columns[0]);
        for x in row.columns[0]..row.columns[1] {
            let fragment = row.step(x);
            let inner = (row.inner[0]..row.inner[1]).contains(&x);
            assert!(!inner || fragment.coverage == WHOLE, "{corners:?}, {x} {y}: {fragment:?}");
            covered.push(([x, y], fragment.coverage, fragment.centroid));
        }
    }
    covered
}

/// Area and centroid of a triangle in the pixel at the origin, by clipping.
fn clipped(corners: [[f64; 2]; 3]) -> (f64, [f64; 2]) {
    let mut polygon = corners.to_vec();
    for (k, sign, limit) in [(0, 1.0, 0.0), (0, -1.0, -1.0), (1, 1.0, 0.0), (1, -1.0, -1.0)] {
        let inside = |p: [f64; 2]| sign * p[k] - limit;
        let mut cut = Vec::new();
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            let (da, db) = (inside(a), inside(b));
            if da >= 0.0 {
                cut.push(a);
            }
            if (da >= 0.0) != (db >= 0.0) {
                let t = da / (da - db);
                cut.push([a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]);
            }
        }
        polygon = cut;
    }
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for i in 1..polygon.len().saturating_sub(1) {
        let [a, b, c] = [polygon[0], polygon[i], polygon[i + 1]];
        let part = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
        area += part;
        moment = [0, 1].map(|k| moment[k] + part * (a[k] + b[k] + c[k]) / 3.0);
    }
    (area, moment.map(|m| m / area))
}

/// Triangles of every kind, tiny, thin and huge; coordinates of 4 to 10 fraction bits.
#[test]
fn coverage_is_the_exact_area() {
    let mut random = Random::new(seed(), 0);
    let (mut worst, mut apart, mut pixels) = (0f64, 0f64, 0u64);
    for i in 0..cases(30_000) {
        let bits = 4 + random.pick(0..7) as u32;
        let mut corners = match i % 5 {
            0 => [0; 3].map(|_| point(&mut random, 600)),
            1 => [0; 3].map(|_| point(&mut random, 20)),
            2 => {
                let (a, b) = (point(&mut random, 1500), point(&mut random, 1500));
                let middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
                [a, b, [middle[0] + random.pick(-9..9), middle[1] + random.pick(-9..9)]]
            }
            // Corners and crossings on borders of pixels.
            3 => [0; 3].map(|_| point(&mut random, 10).map(|c| c << bits)),
            _ => [[0; 2]; 3].map(|_| point(&mut random, if i % 1000 == 4 { 65_536 } else { 3000 })),
        };
        if area(corners) < 0 {
            corners.swap(1, 2);
        }
        let real = corners.map(|corner| corner.map(|c| f64::from(c) / f64::from(1 << bits)));
        let covered = coverage(corners, bits);
        // Of the huge ones some pixels.
        let stride = covered.len() / 4000 + 1;
        for &([x, y], got, centroid) in covered.iter().step_by(stride) {
            let (exact, place) = clipped(real.map(|[u, v]| [u - f64::from(x), v - f64::from(y)]));
            let exact = exact * 65_536.0;
            worst = worst.max((f64::from(got) - exact).abs());
            assert!((f64::from(got) - exact).abs() < 3.001, "{corners:?}/2^{bits}, {x} {y}: {got}, not {exact}");
            if exact > 1024.0 {
                let off = (0..2).map(|k| (f64::from(centroid[k]) / 65_536.0 + 0.5 - place[k]).abs()).fold(0.0, f64::max);
                apart = apart.max(off);
                assert!(off < 1.0 / 128.0, "{corners:?}/2^{bits}, {x} {y}: {centroid:?}, not {place:?}, of {exact}");
            }
            pixels += 1;
        }
        // Nothing is left out.
        let sum: i64 = covered.iter().map(|&(_, coverage, _)| i64::from(coverage)).sum();
        let whole = area(corners) as f64 / 2.0 / f64::from(1 << (2 * bits)) * 65_536.0;
        assert!((sum as f64 - whole).abs() <= 3.0 * covered.len() as f64 + 1.0, "{corners:?}/2^{bits}: {sum}, not {whole}");
    }
    println!("{pixels} pixels: coverage within {worst:.3} / 65536, centroids within {apart:.5} pixel");
}

/// Closed patches: every pixel adds up to one, to the last bit.
#[test]
fn coverages_of_a_patch_add_up_to_one() {
    let mut random = Random::new(seed(), 1);
    const PIXELS: i32 = 24;
    for i in 0..cases(200) as usize {
        // A net with jittered knots, from a quarter of a pixel to six pixels wide.
        let step = [4, 6, 12, 16, 24, 32, 48, 96][i % 8];
        let cells = PIXELS * 16 / step;
        let mut knot = BTreeMap::new();
        for y in 0..=cells {
            for x in 0..=cells {
                let mut place = [x, y].map(|c| c * step);
                for (c, k) in place.iter_mut().zip([x, y]) {
                    if k > 0 && k < cells {
                        *c += random.pick(-(step / 4)..step / 4 + 1);
                    }
                }
                knot.insert([x, y], place);
            }
        }
        let mut sums = BTreeMap::<[i32; 2], i32>::new();
        for y in 0..cells {
            for x in 0..cells {
                let [a, b, c, d] = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]].map(|k| knot[&k]);
                let halves = if random.pick(0..2) == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                for half in halves {
                    for (pixel, coverage, _) in coverage(half, 4) {
                        *sums.entry(pixel).or_default() += coverage;
                    }
                }
            }
        }
        let side = cells * step / 16;
        for y in 0..side {
            for x in 0..side {
                assert_eq!(sums[&[x, y]], WHOLE, "net {i}, pixel {x} {y}");
            }
        }
    }
}

/// A method that draws a mesh in white on black, whatever its material.
#[derive(Clone, Copy, Debug, PartialEq)]
struct White(u8);

impl PixelFormat for White {
    const GRAY: bool = true;
    const DEPTH: [u32; 3] = [8; 3];
    const BYTES: usize = 1;

    fn pack([luma, ..]: [u32; 3]) -> Self {
        Self(luma as u8)
    }

    fn channels(self) -> [u8; 3] {
        [self.0; 3]
    }

    fn bits(self) -> u32 {
        self.0.into()
    }
}

impl Pixel for White {
    type Stored = u8;
    type Ramps = Rounded<u8>;

    fn stored(self) -> u8 {
        self.0
    }

    fn from_stored(stored: u8) -> Self {
        Self(stored)
    }

    fn entry(_: &[u8; RAMP], level: u32, bits: u32) -> u8 {
        // No level is so far from what it should be that it wraps.
        assert!(i64::from(level >> bits) < i64::from(BIAS) * 4);
        255
    }

    fn quantised(_: Intensity, _: u32) -> Self {
        Self(255)
    }

    fn mixed(_: [i32; 3]) -> Self {
        Self(255)
    }
}

/// The silhouette of a frame at 16 x 16 points of each pixel: the share of points on a triangle.
fn silhouette(frame: &Frame) -> Vec<u32> {
    let (width, height) = frame.size;
    let fine = |c: f64| (c * 16.0).round() as i64;
    let mut points = vec![false; (width * height * 256) as usize];
    for facet in &frame.facets {
        let corners = facet.screen.map(|corner| corner.map(fine));
        let range = |k: usize, end: u32| {
            let (low, high) = corners.iter().fold((i64::MAX, i64::MIN), |(low, high), c| (low.min(c[k]), high.max(c[k])));
            low.max(0)..high.min(i64::from(end) * 16)
        };
        for y in range(1, height) {
            for x in range(0, width) {
                // At odd thirty-seconds no point lies on a corner.
                let inside = (0..3).all(|i| {
                    let (a, b) = (corners[i], corners[(i + 1) % 3]);
                    (b[0] - a[0]) * (2 * y + 1 - 2 * a[1]) - (b[1] - a[1]) * (2 * x + 1 - 2 * a[0]) >= 0
                });
                if inside {
                    points[(y * i64::from(width) * 16 + x) as usize] = true;
                }
            }
        }
    }
    let mut counts = vec![0; (width * height) as usize];
    for (i, _) in points.iter().enumerate().filter(|&(_, &point)| point) {
        let (x, y) = (i % (width as usize * 16), i / (width as usize * 16));
        counts[y / 16 * width as usize + x / 16] += 1;
    }
    counts
}

/// Whether the eight pixels around one are covered wholly, too.
fn surrounded(counts: &[u32], width: usize, i: usize) -> bool {
    let row = |i: usize| counts.get(i - 1..i + 2).is_some_and(|row| row == [256; 3]);
    i > width && row(i - width) && row(i) && row(i + width)
}

/// One colour over a contrasting background: no seam inside, and an outline like a supersampled one.
#[test]
fn meshes_have_no_seams_and_smooth_outlines() {
    for name in ["torus", "sphere-168", "sphere-40", "dodecahedron", "bunny", "teapot"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let size = Size::new(200, 160);
        for number in [0, 7, 23, 41] {
            let (pixels, _) = render::frame::<White>(stream, size, smooth(Shader::GOURAUD), 160, number).unwrap();
            let ground = f64::from(pixels[0].0);
            let counts = silhouette(&Frame::new(stream, (200, 160), number));
            let (mut worst, mut square, mut edge, mut seams, mut inside, mut deepest) = (0f64, 0.0, 0u32, 0, 0, 0);
            for (i, (pixel, &count)) in pixels.iter().zip(&counts).enumerate() {
                match count {
                    // An outline may cut off less than shows in any of the points.
                    256 if !surrounded(&counts, 200, i) => assert!(pixel.0 > 240),
                    256 => {
                        inside += 1;
                        seams += u32::from(pixel.0 != 255);
                        deepest = deepest.max(255 - pixel.0);
                    }
                    0 => assert!(f64::from(pixel.0) - ground < 24.0),
                    _ => {
                        let error = (f64::from(pixel.0) - ground) / (255.0 - ground) - f64::from(count) / 256.0;
                        worst = worst.max(error.abs());
                        square += error * error;
                        edge += 1;
                    }
                }
            }
            let rms = (square / f64::from(edge.max(1))).sqrt();
            println!(
                "{name:12} frame {number:2}: {seams} seams of {deepest} at most in {inside} pixels; outline, {edge} pixels: rms {rms:.4}, max {worst:.3}"
            );
        }
    }
}

/// Points of a pixel in each direction.
const SIDE: u32 = 8;

/// The facet that is seen at each of 8 x 8 points of each pixel, in 64-bit floating point.
fn seen(frame: &Frame) -> Vec<Option<usize>> {
    let (width, height) = frame.size;
    let columns = (width * SIDE) as usize;
    let mut points = vec![(f64::MIN, None); columns * (height * SIDE) as usize];
    for (number, facet) in frame.facets.iter().enumerate() {
        let range = |k: usize, end: u32| {
            let (low, high) = facet.screen.iter().fold((f64::MAX, f64::MIN), |(low, high), c| (low.min(c[k]), high.max(c[k])));
            (low * f64::from(SIDE) - 1.0) as u32..((high * f64::from(SIDE) + 1.0) as u32).min(end * SIDE)
        };
        for y in range(1, height) {
            for x in range(0, width) {
                let p = place(x, y);
                let inside = (0..3).all(|i| {
                    let (a, b) = (facet.screen[i], facet.screen[(i + 1) % 3]);
                    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0.0
                });
                let point = &mut points[y as usize * columns + x as usize];
                if inside && facet.inv_depth_at(p) > point.0 {
                    *point = (facet.inv_depth_at(p), Some(number));
                }
            }
        }
    }
    points.into_iter().map(|(_, facet)| facet).collect()
}

/// The place of a point, in pixels.
fn place(x: u32, y: u32) -> [f64; 2] {
    [x, y].map(|c| (f64::from(c) + 0.5) / f64::from(SIDE))
}

/// The mean colour of the points of each pixel, in 64-bit floating point.
fn supersampled(frame: &Frame, seen: &[Option<usize>], method: &str, ground: [f64; 3]) -> Vec<[f64; 3]> {
    let (width, height) = frame.size;
    let shades: Vec<_> = frame.facets.iter().map(|facet| oracle::method(method, frame, facet).unwrap()).collect();
    let mut pixels = vec![[0.0; 3]; (width * height) as usize];
    for (point, facet) in (0..).zip(seen) {
        let [x, y] = [point % (width * SIDE), point / (width * SIDE)];
        let levels = facet.map_or(ground, |facet| shades[facet](place(x, y)).map(|level| level.clamp(0.0, 255.0)));
        let pixel = &mut pixels[(y / SIDE * width + x / SIDE) as usize];
        *pixel = [0, 1, 2].map(|k| pixel[k] + levels[k] / f64::from(SIDE * SIDE));
    }
    pixels
}

/// Light as well as outlines, by every method that the oracle and this build have.
#[test]
fn pictures_are_like_supersampled_ones() {
    let (width, height) = (160, 120);
    for name in ["sphere-168", "torus", "teapot", "bunny", "dodecahedron"] {
        let scene = scene::load(name).unwrap();
        let stream: Stream<'_> = scene.stream.parse().unwrap();
        let frame = Frame::new(stream, (width, height), 5);
        let seen = seen(&frame);
        for shader in Shader::ALL.into_iter() {
            if oracle::method(shader.name(), &frame, &frame.facets[0]).is_err() {
                continue;
            }
            let size = Size::new(width, height);
            let Ok((plain, _)) = render::frame::<Rgb888>(stream, size, shader, height, 5) else { continue };
            let (smooth, stats) = render::frame::<Rgb888>(stream, size, smooth(shader), height, 5).unwrap();
            if stats.pixels == 0 {
                continue; // A name without a method yet.
            }
            let ground = [smooth[0].r(), smooth[0].g(), smooth[0].b()].map(f64::from);
            let exact = supersampled(&frame, &seen, shader.name(), ground);
            let errors = |pixels: &[Rgb888]| {
                let error = |(pixel, exact): (&Rgb888, &[f64; 3])| {
                    let drawn = [pixel.r(), pixel.g(), pixel.b()].map(f64::from);
                    (0..3).map(|k| (drawn[k] - exact[k]).abs()).fold(0.0, f64::max)
                };
                let mut errors: Vec<_> = pixels.iter().zip(&exact).map(error).collect();
                errors.sort_by(f64::total_cmp);
                let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
                (rms, errors[errors.len() * 999 / 1000], errors[errors.len() - 1])
            };
            let ((a, b, c), (d, e, f)) = (errors(&plain), errors(&smooth));
            println!(
                "{name:12} {:18} rms {a:6.2} -> {d:5.2}, of 999 in 1000 {b:6.1} -> {e:5.1}, max {c:6.1} -> {f:5.1} LSB",
                shader.name()
            );
            // Steep highlights of a pixel or two, and surfaces that cut each other; at the rim of its map an environment is steepest.
            let (rms, tail) = match (shader.name(), name) {
                ("environment", _) => (1.3, 20.0),
                (_, "teapot") => (1.0, 13.0),
                (_, "bunny") => (0.55, 6.0),
                _ => (0.4, 3.5),
            };
            assert!(d < rms && e < tail && d < a / 1.5, "{name}, {}: rms {d}, 999 in 1000 below {e}", shader.name());
        }
    }
}

/// A frame with room for `vertices` vertices and `triangles` triangles, in bands of `rows` rows.
fn frame(stream: Stream<'_>, shader: Shader, vertices: usize, triangles: usize, rows: u32) -> (Vec<Rgb565>, Stats) {
    let size = Size::new(150, 110);
    let layout = Layout::new(150, rows as usize).vertices(vertices).triangles(triangles).materials(stream.materials.len());
    let layout = layout.active_triangles(0).antialias(true);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, shader.on()).unwrap();
    renderer.set_antialias(true).unwrap();
    let mut band = vec![Rgb565::RED; 150 * 110];
    let mut pixels = Vec::new();
    let mut frame = renderer.frame(5);
    while let Some(area) = frame.next_band(&mut band).unwrap() {
        assert!(area.size.height <= rows);
        pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
    }
    (pixels, frame.stats())
}

#[test]
fn neither_bands_nor_overflow_change_a_pixel() {
    for name in ["teapot", "torus", "sphere-40"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let (vertices, triangles) = (stream.vertices.len(), stream.triangles.len());
        for shader in Shader::ALL.into_iter() {
            if !shader.facts().near_lights && !stream.is_constant() {
                continue;
            }
            let (whole, stats) = frame(stream, shader, vertices, triangles, 110);
            for (vertices, triangles, rows) in [(vertices, triangles, 1), (vertices, triangles, 7), (vertices / 2, 3, 16)] {
                let (pixels, tight) = frame(stream, shader, vertices, triangles, rows);
                assert!(pixels == whole, "{name}, {}: bands of {rows} rows", shader.name());
                assert_eq!((tight.drawn, tight.pixels), (stats.drawn, stats.pixels));
            }
        }
    }
}

#[test]
fn memory_that_is_missing_is_named() {
    let scene = scene::load("triangle").unwrap();
    let stream: Stream<'_> = scene.stream.parse().unwrap();
    let layout = Layout::new(32, 2).vertices(0).triangles(0).active_triangles(0);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut renderer = Renderer::<Rgb565>::new(stream, Size::new(32, 8), &layout, &mut memory, &Shader::ALL.map(Shader::on)).unwrap();
    assert_eq!(renderer.set_antialias(true), Err(RenderError::NoSamples));
    let text = renderer.set_antialias(true).unwrap_err().to_string();
    assert_eq!(text, "the layout has no memory for antialiasing; set Layout::antialias(true)");
    assert_eq!(renderer.set_antialias(false), Ok(()));
    assert_eq!(renderer.band_rows(), 2, "still without");
}

/// Pixels wholly inside one triangle are those of the ordinary picture. By three methods a few of a picture are a step of a channel off, because
/// polynomials of finer corners are rounded otherwise.
#[test]
fn inner_pixels_stay() {
    let scene = scene::load("dodecahedron").unwrap();
    let stream: Stream<'_> = scene.stream.parse().unwrap();
    for frame in 0..24 {
        let mut inner = vec![false; 160 * 120];
        for facet in &Frame::new(stream, (160, 120), frame).facets {
            let corners = facet.screen.map(|corner| corner.map(|c| (c * 16.0) as i32));
            let contour = TriangleCoverage::new(corners, 4);
            let [top, bottom] = contour.rows();
            for y in top..bottom {
                let [start, stop] = contour.row(y).inner;
                (start..stop).for_each(|x| inner[(y * 160 + x) as usize] = true);
            }
        }
        for shader in Shader::ALL {
            let size = Size::new(160, 120);
            let Ok((plain, _)) = render::frame::<Rgb565>(stream, size, shader, 120, frame) else { continue };
            let (smooth, _) = render::frame::<Rgb565>(stream, size, smooth(shader), 120, frame).unwrap();
            let changed: Vec<_> = plain.iter().zip(&smooth).zip(&inner).filter(|((a, b), inner)| **inner && a != b).collect();
            let most = match shader.name() {
                "six-point" => 5,
                "gouraud" | "taylor-finite" => 1,
                _ => 0,
            };
            let is_a_step = |(a, b): (&Rgb565, &Rgb565)| a.r().abs_diff(b.r()).max(a.g().abs_diff(b.g())).max(a.b().abs_diff(b.b())) == 1;
            assert!(
                changed.len() <= most && changed.iter().all(|(pair, _)| is_a_step(*pair)),
                "{}, frame {frame}: {changed:?}",
                shader.name()
            );
        }
    }
}
