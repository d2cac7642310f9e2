//! Our pictures against those of a renderer that we have not written: [retrofire](https://crates.io/crates/retrofire), in 32-bit floating
//! point.
//!
//! Both get the same corners on the screen, in sixteenths of a pixel. Which pixels they cover, and what depth, position and normal are in
//! between, is the work of retrofire's own rasterizer and interpolation; Phong's formula is then evaluated at each pixel in 64-bit floating
//! point. The corners are checked against a camera in floating point, too.
//!
//! Three kinds of pixels are left out and counted: where an edge passes the centre so closely that 32 bits cannot tell on which side it
//! is; where a part of a triangle is exactly one row high, as retrofire then divides by zero; and, for colours, where two surfaces are so
//! equally near that 16 bits of depth cannot tell which one is seen.

use embedded_graphics::{
    pixelcolor::Rgb888,
    prelude::{RgbColor, Size},
};
use microphong::{
    Stream,
    geometry::{lens::Lens, model_view::ModelView, projection::View},
    scene::ORBIT_ERROR,
    stream::{
        record::{Header, PERSPECTIVE, Vertex},
        seal,
    },
};
use microphong_sim::{
    bytes::StreamBytes,
    level,
    render::{self, Style},
    scene,
    shader::Shader,
    stress::coverage::side,
};
use microphong_tests::phong::{V3, dot, light, real, unit};
use retrofire_core::{
    geom::vertex,
    math::{Vec3, pt3},
    render::raster::tri_fill,
};
use std::f64::consts::TAU;
use zerocopy::{FromBytes, IntoBytes};

/// Largest difference of levels before they are rounded, in 1/255: the table of highlights.
const LEVEL: f64 = 0.20;
/// Largest difference of bytes from exact levels.
const BYTE: f64 = LEVEL + 0.5;
/// Largest share of a frame's pixels that may be left out: a torus seen small, from the side, is full of edges.
const LEFT_OUT: f64 = 0.01;
/// Largest share of the pixels of all frames together that may be left out.
const LEFT_OUT_IN_ALL: f64 = 0.001;

/// Distance from an edge, in pixels along its row, within which a pixel's centre is left out.
const UNSURE: f64 = 1.0 / 1024.0;
/// Inverse depths that differ by less are a tie; the depth buffer tells steps of 1/65536 apart.
const TIE: f64 = 4.0 / 65_536.0;
/// Largest error of corners, in pixels. Half a sixteenth is rounded, and eye space has steps of 1/16384.
const CORNER: f64 = 1.0 / 16.0;

/// Frames of the orbit.
const FRAMES: [u32; 4] = [0, 17, 61, 101];

/// A frame, drawn by retrofire.
struct Frame<'s> {
    stream: Stream<'s>,
    size: Size,
    number: u32,
    /// Whether values between corners are interpolated in space and not on the screen.
    in_perspective: bool,
    /// Rows of the rotation from object to eye space.
    rotation: [V3; 3],
    /// Row by row from the top.
    pixels: Vec<Seen>,
}

/// The surface that is seen in a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    /// Inverse depths of the two nearest surfaces; 0 where there is none.
    depths: [f64; 2],
    /// Light of the nearest one, 255 is full.
    light: V3,
    /// An edge passes the centre too closely.
    unsure: bool,
    /// A surface has no depth, because retrofire has divided by zero.
    undefined: bool,
}

impl<'s> Frame<'s> {
    fn new(stream: Stream<'s>, size: Size, number: u32, in_perspective: bool) -> Self {
        let camera = &stream.header.camera;
        let pose = ModelView::new(camera, number);
        let rotation = pose.rotation.map(|row| real(row, 30));
        let exact = turned(stream, number);
        let off = (0..9).map(|k| (rotation[k / 3][k % 3] - exact[k / 3][k % 3]).abs()).fold(0.0, f64::max);
        assert!(off <= ORBIT_ERROR + 1e-6, "frame {number}: the camera is turned wrongly by {off}");

        let pixels = vec![Seen::default(); (size.width * size.height) as usize];
        let mut frame = Self { stream, size, number, in_perspective: in_perspective && stream.is_perspective(), rotation, pixels };
        let view = View::new(&Lens::new(camera, size), &pose);
        for mesh in stream.meshes {
            let vertices = stream.vertices_of(mesh).expect("a valid stream");
            for triangle in stream.triangles_of(mesh).expect("a valid stream") {
                let vertices = triangle.corners.map(|corner| vertices[usize::from(corner)]);
                let corners = vertices.map(|vertex| {
                    let (corner, inside) = view.lens.project(view.to_eye(vertex.position));
                    assert!(inside, "the scenes are wholly visible");
                    frame.check(corner, &vertex);
                    corner
                });
                let [a, b, c] = corners.map(|[x, y, _]| [x, y]);
                // Corners of front faces run counter-clockwise.
                if side(a, b, c) < 0 {
                    frame.mark([a, b, c]);
                    frame.fill(vertices, corners, mesh.material.into());
                }
            }
        }
        frame
    }

    /// A corner lies where a camera in floating point sees it, rounded to a sixteenth of a pixel.
    fn check(&self, corner: [i32; 3], vertex: &Vertex) {
        let camera = &self.stream.header.camera;
        let (position, translation) = (real(vertex.position.map(i32::from), 14), real(camera.translation, 14));
        let [x, y, z] = [0, 1, 2].map(|k| dot(self.rotation[k], position) + translation[k]);
        let [width, height] = [self.size.width, self.size.height].map(f64::from);
        let half = width.min(height) / 2.0 * f64::from(camera.focal) / 65_536.0;
        let scale = if camera.projection == PERSPECTIVE { half / z } else { half };
        let exact = [width / 2.0 + scale * x, height / 2.0 - scale * y];
        let off = [0, 1].map(|k| (f64::from(corner[k]) / 16.0 - exact[k]).abs());
        assert!(off.iter().all(|&off| off < CORNER), "frame {}: a corner is {off:?} pixels from {exact:?}", self.number);
    }

    /// Marks the pixels whose centres edges pass closely.
    fn mark(&mut self, corners: [[i32; 2]; 3]) {
        let width = self.size.width as usize;
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let [[ax, ay], [bx, by]] = [corners[from], corners[to]].map(|corner| corner.map(|c| f64::from(c) / 16.0));
            // Level edges are exact in 32 bits.
            if ay == by {
                continue;
            }
            for row in (ay.min(by) - 0.5).ceil() as usize..=(ay.max(by) - 0.5).floor() as usize {
                let x = ax + (row as f64 + 0.5 - ay) * (bx - ax) / (by - ay);
                if (x.fract() - 0.5).abs() < UNSURE {
                    self.pixels[row * width + x as usize].unsure = true;
                }
            }
        }
    }

    /// Draws a triangle.
    fn fill(&mut self, vertices: [Vertex; 3], corners: [[i32; 3]; 3], material: usize) {
        let (width, height) = (self.size.width as usize, self.size.height as usize);
        let triangle = [0, 1, 2].map(|k| {
            let [x, y, depth] = corners[k];
            let depth = depth as f32 / (1 << 28) as f32;
            // By its third coordinate it divides what is to be interpolated in space.
            let share = if self.in_perspective { depth } else { 1.0 };
            // Where centres lie on edges, retrofire draws the pixels at the right and at the bottom, and we those at the left and at the top:
            // so it draws the picture turned by half a revolution.
            let place = pt3(width as f32 - x as f32 / 16.0, height as f32 - y as f32 / 16.0, share);
            let shared = |v: [i16; 3]| -> Vec3 { v.map(|c| f32::from(c) / 16_384.0 * share).into() };
            vertex(place, ((shared(vertices[k].position), shared(vertices[k].normal)), depth))
        });
        tri_fill(triangle, |mut line| {
            let (y, columns) = (height - 1 - line.y, line.xs.clone());
            for (x, fragment) in columns.zip(line.fragments()) {
                let ((position, normal), depth) = fragment.var;
                // Depth is interpolated on the screen.
                let depth = f64::from(if self.in_perspective { fragment.pos.z() } else { depth });
                let seen = &mut self.pixels[y * width + width - 1 - x];
                seen.undefined |= depth.is_nan();
                if depth > seen.depths[0] {
                    let [position, normal] = [position, normal].map(|v| v.0.map(f64::from));
                    let light = light(&self.stream, self.rotation, material, position, unit(normal));
                    seen.light = light.map(|c| (255.0 * c).clamp(0.0, 255.0));
                    seen.depths = [depth, seen.depths[0]];
                } else if depth > seen.depths[1] {
                    seen.depths[1] = depth;
                }
            }
        });
    }
}

/// The rotation of the camera in a frame, by Rodrigues' formula.
fn turned(stream: Stream<'_>, number: u32) -> [V3; 3] {
    let camera = &stream.header.camera;
    let (sin, cos) = (TAU * f64::from(number) / f64::from(camera.period.max(1))).sin_cos();
    let axis = unit(real(camera.axis, 30));
    let [x, y, z] = axis;
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let orbit = |i: usize, j: usize| if i == j { cos } else { 0.0 } + sin * cross[i][j] + (1.0 - cos) * axis[i] * axis[j];
    camera.rotation.map(|row| {
        let row: V3 = real(row, 30);
        [0, 1, 2].map(|j| (0..3).map(|i| row[i] * orbit(i, j)).sum())
    })
}

/// Results of comparing frames.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Pixels that either has drawn.
    drawn: usize,
    /// Drawn pixels that are left out because they lie close to an edge.
    unsure: usize,
    /// Drawn pixels that are left out because of a division by zero.
    undefined: usize,
    /// Whose colour is left out because of a tie.
    ties: usize,
    /// Pixels that only one of both has drawn, and that are not left out.
    uncovered: usize,
    /// Largest difference of levels before they are rounded, in 1/255.
    level: f64,
    /// Largest difference of the picture's bytes from exact levels.
    byte: f64,
}

/// Difference of levels. If all channels have one level, it is the brightest channel's.
fn difference(drawn: V3, exact: V3) -> f64 {
    let each = (0..3).map(|k| (drawn[k] - exact[k]).abs()).fold(0.0, f64::max);
    let one = drawn[0] == drawn[1] && drawn[1] == drawn[2];
    if one { each.min((drawn[0] - exact.into_iter().fold(0.0, f64::max)).abs()) } else { each }
}

fn compare(stream: Stream<'_>, size: Size, number: u32, in_perspective: bool) -> Tally {
    let style = Style { perspective_correct: in_perspective, ..Shader::PHONG.into() };
    let levels = level::picture(stream, size, style, number).expect("a scene that phong can draw");
    let (bytes, _) = render::frame::<Rgb888>(stream, size, style, 16, number).expect("a scene that phong can draw");
    let frame = Frame::new(stream, size, number, in_perspective);
    let mut tally = Tally::default();
    for ((levels, byte), seen) in levels.iter().zip(&bytes).zip(frame.pixels) {
        let covered = seen.depths[0] > 0.0;
        if levels.is_none() && !covered {
            continue;
        }
        tally.drawn += 1;
        match levels {
            _ if seen.unsure => tally.unsure += 1,
            _ if seen.undefined => tally.undefined += 1,
            Some(_) if covered && seen.depths[0] - seen.depths[1] < TIE => tally.ties += 1,
            Some(levels) if covered => {
                tally.level = tally.level.max(difference(*levels, seen.light));
                let bytes = [byte.r(), byte.g(), byte.b()].map(f64::from);
                tally.byte = (0..3).map(|k| (bytes[k] - seen.light[k]).abs()).fold(tally.byte, f64::max);
            }
            _ => tally.uncovered += 1,
        }
    }
    tally
}

/// The scene seen from higher up and from farther away.
fn from_above(stream: &StreamBytes) -> StreamBytes {
    let mut bytes = stream.as_bytes().to_vec();
    let mut header = Header::read_from_prefix(&bytes).expect("a header").0;
    let camera = &mut header.camera;
    let (sin, cos) = 0.8f64.sin_cos();
    let [right, up, away] = camera.rotation.map(|row| row.map(f64::from));
    let mixed = |a: [f64; 3], b: [f64; 3], sin: f64| [0, 1, 2].map(|k| (cos * a[k] + sin * b[k]).round() as i32);
    camera.rotation = [right.map(|c| c as i32), mixed(up, away, sin), mixed(away, up, -sin)];
    camera.focal = camera.focal / 4 * 3;
    camera.near = camera.near.min(2 << 14);
    bytes[..size_of::<Header>()].copy_from_slice(header.as_bytes());
    seal(&mut bytes);
    StreamBytes::from(&bytes[..])
}

#[test]
fn another_renderer_draws_the_same() {
    let (mut frames, mut sum, mut sum_left_out) = (0, 0, 0);
    for name in scene::NAMES {
        let scene = scene::load(name).unwrap();
        let size = Size::new(scene.size.0, scene.size.1);
        for (camera, stream) in [("built in", scene.stream.clone()), ("above", from_above(&scene.stream))] {
            let stream = stream.parse().unwrap();
            for in_perspective in [false, true].into_iter().take(if stream.is_perspective() { 2 } else { 1 }) {
                for number in FRAMES {
                    let tally = compare(stream, size, number, in_perspective);
                    let Tally { drawn, unsure, undefined, ties, uncovered, level, byte: bytes } = tally;
                    let left_out = (unsure + undefined + ties) as f64 / drawn as f64;
                    (frames, sum, sum_left_out) = (frames + 1, sum + drawn, sum_left_out + unsure + undefined + ties);
                    println!(
                        "{name:12} {camera:8} frame {number:3}{}: {drawn:6} pixels, left out {unsure} + {undefined} + {ties} ({:.2} %); \
                         worst {level:.3} before rounding, {bytes:.3} after",
                        if in_perspective { " in perspective" } else { "" },
                        100.0 * left_out
                    );
                    assert_eq!(uncovered, 0, "{name}, {camera}, frame {number}: pixels that only one of both has drawn");
                    assert!(drawn > 5_000 && left_out <= LEFT_OUT, "{name}, {camera}, frame {number}: {left_out} left out of {drawn}");
                    assert!(level <= LEVEL && bytes <= BYTE, "{name}, {camera}, frame {number}: {level} {bytes}");
                }
            }
        }
    }
    println!("{frames} frames: {sum_left_out} of {sum} pixels left out");
    assert!(sum_left_out as f64 <= LEFT_OUT_IN_ALL * sum as f64, "{sum_left_out} of {sum} pixels left out");
}
