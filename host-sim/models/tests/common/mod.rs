//! Model files with a texture.

use microphong_models::{mesh::Rgb, vector::V3};
use std::fmt::Write;

/// A PNG of rows of pixels.
pub(crate) fn png(rows: &[Vec<Rgb>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, rows[0].len() as u32, rows.len() as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(rows.concat().as_flattened()).unwrap();
    bytes
}

/// A material with a texture.
pub(crate) const MTL: &[u8] = b"newmtl paint\nKd 1 1 1\nmap_Kd a.png\n";

/// An OBJ file of faces whose corners have a position and a place on the texture.
pub(crate) fn textured(faces: &[Vec<(V3, [f64; 2])>]) -> String {
    let mut text = String::from("mtllib a.mtl\nusemtl paint\n");
    let mut corners = 0;
    for face in faces {
        for ([x, y, z], [u, v]) in face {
            writeln!(text, "v {x} {y} {z}\nvt {u} {v}").unwrap();
        }
        let numbers: String = (1..=face.len()).map(|k| format!(" {0}/{0}", corners + k)).collect();
        writeln!(text, "f{numbers}").unwrap();
        corners += face.len();
    }
    text
}

/// A face of which two axes are those of the texture.
pub(crate) fn square() -> Vec<(V3, [f64; 2])> {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| ([u, v, 0.0], [u, v])).into()
}
