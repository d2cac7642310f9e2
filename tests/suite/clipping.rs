//! Cameras inside and close to meshes, against rays in 64-bit floating point.

use embedded_graphics::{
    pixelcolor::Rgb888,
    prelude::{RgbColor, Size},
};
use microphong::{
    Stream,
    stream::{record::Header, seal},
};
use microphong_sim::{bytes::StreamBytes, render, scene, shader::Shader};
use zerocopy::{FromBytes, IntoBytes};

type V3 = [f64; 3];

/// A built-in scene under a changed camera.
fn changed(name: &str, change: impl Fn(&mut Header)) -> StreamBytes {
    let stream = scene::load(name).unwrap().stream;
    let mut bytes = stream.as_bytes().to_vec();
    let mut header = Header::read_from_prefix(&bytes).unwrap().0;
    change(&mut header);
    bytes[..size_of::<Header>()].copy_from_slice(header.as_bytes());
    seal(&mut bytes);
    StreamBytes::from(bytes.as_slice())
}

/// Pixels where a ray through the centre meets a front face behind the near plane, and pixels where that is uncertain.
fn rays(stream: &Stream<'_>, size: Size) -> (Vec<bool>, Vec<bool>) {
    let camera = &stream.header.camera;
    let rotation = camera.rotation.map(|row| row.map(|c| f64::from(c) / 2f64.powi(30)));
    let real = |c: i32| f64::from(c) / 16_384.0;
    let eye = |v: [i16; 3]| -> V3 {
        let p = v.map(|c| real(c.into()));
        [0, 1, 2].map(|k| rotation[k][0] * p[0] + rotation[k][1] * p[1] + rotation[k][2] * p[2] + real(camera.translation[k]))
    };
    let (near, focal) = (real(camera.near), f64::from(camera.focal) / 65_536.0);
    let half = f64::from(size.width.min(size.height)) / 2.0;
    let (mut hit, mut unsure) = (vec![false; (size.width * size.height) as usize], vec![false; (size.width * size.height) as usize]);
    for mesh in stream.meshes {
        for triangle in stream.triangles_of(mesh).unwrap() {
            let [a, b, c] = triangle.corners.map(|c| eye(stream.vertices[mesh.first_vertex as usize + usize::from(c)].position));
            let cross = |a: V3, b: V3| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            let dot = |a: V3, b: V3| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            // Eye space is left-handed: front faces turn the other way.
            let volume = dot(a, cross(b, c));
            if volume <= 0.0 {
                continue;
            }
            let sides = [cross(b, c), cross(c, a), cross(a, b)];
            for i in 0..size.width * size.height {
                let x = (f64::from(i % size.width) + 0.5 - f64::from(size.width) / 2.0) / (half * focal);
                let y = (f64::from(size.height) / 2.0 - f64::from(i / size.width) - 0.5) / (half * focal);
                let ray = [x, y, 1.0];
                let weights = sides.map(|side| dot(side, ray));
                let sum: f64 = weights.iter().sum();
                let depth = volume / sum;
                // A pixel's worth of the distance to an edge, or to the near plane.
                let pixel = 1.5 / (half * focal);
                let margin = sides.map(|side| pixel * (side[0].abs() + side[1].abs()));
                let near_edge = |k: usize| weights[k].abs() < margin[k];
                let close = (0..3).any(near_edge) && (0..3).all(|k| weights[k] > -margin[k]);
                let inside = sum > 0.0 && weights.iter().all(|&w| w >= 0.0) && depth >= near;
                hit[i as usize] |= inside;
                unsure[i as usize] |= sum > 0.0 && (close || (depth - near).abs() < 0.02);
            }
        }
    }
    (hit, unsure)
}

#[test]
fn what_crosses_the_near_plane_or_leaves_the_guard_band_is_cut_not_lost() {
    let size = Size::new(96, 72);
    let shift = |x: f64, y: f64, z: f64| [x, y, z].map(|c| (c * 16_384.0) as i32);
    // Distance, focal length, near plane: outside, through the surface, so close that triangles span the guard band.
    for (k, (at, focal, near)) in [
        (shift(0.0, 0.0, 3.0), 2.0, 1.5),
        (shift(0.2, 0.1, 1.2), 1.0, 0.4),
        (shift(0.3, -0.2, 1.05), 0.5, 0.1),
        (shift(0.9, 0.0, 0.6), 1.0, 0.05),
        (shift(0.0, 0.0, 1.02), 16.0, 1.0 / 64.0),
        (shift(0.95, 0.3, 0.1), 4.0, 1.0 / 64.0),
    ]
    .into_iter()
    .enumerate()
    {
        for name in ["sphere-40", "peer-sphere"] {
            let bytes = changed(name, |header| {
                header.camera.translation = at;
                header.camera.focal = (focal * 65_536.0) as u32;
                header.camera.near = (near * 16_384.0) as i32;
                header.camera.projection = 0;
                (header.background, header.background_bottom) = ([0, 0, 255], [0, 0, 255]);
            });
            let stream = bytes.parse().unwrap();
            let (hit, unsure) = rays(&stream, size);
            for shader in Shader::ALL {
                // Not all can draw near lights.
                let Ok((pixels, stats)) = render::frame::<Rgb888>(stream, size, shader, 16, 0) else { continue };
                let drawn = |p: &Rgb888| *p != Rgb888::BLUE;
                let wrong = pixels.iter().zip(&hit).zip(&unsure).filter(|((p, hit), unsure)| drawn(p) != **hit && !**unsure).count();
                let sure = unsure.iter().filter(|unsure| !**unsure).count();
                println!("camera {k}, {name}, {}: {wrong} of {sure} wrong, {} drawn", shader.name(), stats.drawn);
                assert!(wrong == 0, "camera {k}, {name}, {}: {wrong} of {sure} pixels", shader.name());
            }
        }
    }
}

#[test]
fn a_narrower_viewport_cuts_rows_off_and_changes_nothing_else() {
    let (wide, narrow) = (Size::new(300, 100), Size::new(100, 100));
    for name in ["sphere-168", "sphere-40", "teapot"] {
        // Twice as large: triangles cross both borders of the narrow one.
        let bytes = changed(name, |header| header.camera.focal *= 2);
        let stream = bytes.parse().unwrap();
        for shader in Shader::ALL {
            let Ok((whole, _)) = render::frame::<Rgb888>(stream, wide, shader, 16, 3) else { continue };
            let (part, _) = render::frame::<Rgb888>(stream, narrow, shader, 16, 3).unwrap();
            let cut = whole.chunks(300).flat_map(|row| &row[100..200]);
            assert!(part.iter().eq(cut), "{name}, {}", shader.name());
        }
    }
}
