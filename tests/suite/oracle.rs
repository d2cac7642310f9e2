//! `phong` against per-pixel Phong shading in 64-bit floating point.
//!
//! The reference interpolates, normalises and raises to powers by itself; from the core it takes where
//! the corners of a triangle lie on the screen, and nothing else.

use embedded_graphics::{
    pixelcolor::Rgb888,
    prelude::{RgbColor, Size},
};
use microphong::{
    geometry::{lens::Lens, model_view::ModelView, projection::View},
    stream::record::Triangle,
};
use microphong_sim::{render, scene, shader::Shader};
use microphong_tests::{
    BASIC,
    phong::{V3, light, real, unit},
};

fn combine(b: V3, v: [V3; 3]) -> V3 {
    [0, 1, 2].map(|k| b[0] * v[0][k] + b[1] * v[1][k] + b[2] * v[2][k])
}

/// Largest and root mean square difference, in 1/255, of `shader` on a scene; the picture's own rounding is part of it.
fn errors(name: &str, shader: Shader, number: u32) -> (f64, f64, usize) {
    let scene = scene::load(name).unwrap();
    let stream = scene.stream.parse().unwrap();
    let size = Size::new(scene.size.0, scene.size.1);
    let (pixels, _) = render::frame::<Rgb888>(stream, size, shader, 16, number).unwrap();
    let pose = ModelView::new(&stream.header.camera, number);
    let view = View::new(&Lens::new(&stream.header.camera, size), &pose);
    let rotation = pose.rotation.map(|row| real(row, 30));
    // The nearest triangle at each pixel, by its depth there.
    let mut nearest = vec![(0.0, [0.0; 3]); pixels.len()];
    for mesh in stream.meshes {
        for triangle in stream.triangles_of(mesh).unwrap() {
            let vertices = Triangle::clone(triangle).corners.map(|c| stream.vertices[mesh.first_vertex as usize + usize::from(c)]);
            let screen = vertices.map(|v| view.lens.project(view.to_eye(v.position)).0.map(f64::from));
            let side = |a: V3, b: V3, p: V3| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            let [a, b, c] = screen;
            let area = side(a, b, c);
            if area >= 0.0 {
                continue;
            }
            let low = |k: usize| (a[k].min(b[k]).min(c[k]) / 16.0 - 1.0).max(0.0) as u32;
            let high = |k: usize, end: u32| ((a[k].max(b[k]).max(c[k]) / 16.0 + 1.0).max(0.0) as u32).min(end);
            for y in low(1)..high(1, size.height) {
                for x in low(0)..high(0, size.width) {
                    let p = [f64::from(x) * 16.0 + 8.0, f64::from(y) * 16.0 + 8.0, 0.0];
                    let weights = [side(b, c, p) / area, side(c, a, p) / area, side(a, b, p) / area];
                    if weights.iter().any(|&w| w < -1e-9) {
                        continue;
                    }
                    let depth: f64 = (0..3).map(|k| weights[k] * screen[k][2]).sum();
                    let at = &mut nearest[(y * size.width + x) as usize];
                    if depth > at.0 {
                        let normal = unit(combine(weights, vertices.map(|v| real(v.normal.map(i32::from), 14))));
                        let position = combine(weights, vertices.map(|v| real(v.position.map(i32::from), 14)));
                        *at = (depth, light(&stream, rotation, mesh.material.into(), position, normal));
                    }
                }
            }
        }
    }
    let (mut worst, mut square, mut count, mut over) = (0f64, 0f64, 0usize, 0usize);
    for (pixel, (depth, exact)) in pixels.iter().zip(nearest) {
        if depth > 0.0 {
            let drawn = [pixel.r(), pixel.g(), pixel.b()];
            let error = (0..3).map(|k| (f64::from(drawn[k]) - (exact[k] * 255.0).clamp(0.0, 255.0)).abs()).fold(0.0, f64::max);
            worst = worst.max(error);
            square += error * error;
            count += 1;
            over += usize::from(error > 1.25);
        }
    }
    let rmse = (square / count as f64).sqrt();
    println!("{name:12} {:9} frame {number}: max {worst:6.2}, rmse {rmse:.3} LSB, {over} of {count} pixels above 1.25", shader.name());
    (worst, rmse, over)
}

#[test]
fn phong_is_exact_but_for_rounding() {
    for name in scene::NAMES {
        for number in [0, 17] {
            let (_, rmse, over) = errors(name, Shader::PHONG, number);
            // Rounding alone makes 0.289 in one channel. In three the worst counts, and a coloured material that is
            // walked in one channel is rounded twice. Where two surfaces are equally near, 16 bits of depth may
            // choose the other one.
            let grey = name.starts_with("sphere-") && name != "sphere-40" || ["peer-sphere", "triangle"].contains(&name);
            let limit = if grey { 0.32 } else { 0.63 };
            assert!(rmse < limit && over <= 30, "{name}: rmse {rmse}, {over} pixels");
        }
    }
}

#[test]
fn better_methods_are_better() {
    for name in ["sphere-168", "sphere-690", "torus", "bunny"] {
        let [flat, gouraud, six, phong] = BASIC.map(|shader| errors(name, shader, 0).1);
        assert!(flat > gouraud && gouraud > six && six >= phong, "{name}: {flat} {gouraud} {six} {phong}");
    }
}
