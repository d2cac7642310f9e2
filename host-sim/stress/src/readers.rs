//! Functions of the fuzz targets that read model files: each takes a file of its format from memory, on to a welded mesh with materials.
//!
//! For no bytes may anything panic, overflow, take long or take much memory, and each error names the file.

use microphong_models::{import, mesh::Weld};
use rawzip::ZipArchiveWriter;
use std::{io::Write, path::Path};

/// An image.
pub const IMAGE: &[u8] = include_bytes!("../../../tests/data/red.jpg");

/// A triangle with a texture.
const WITH_TEXTURE: &[u8] = b"mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
const ITS_MATERIAL: &[u8] = b"newmtl a\nmap_Kd a.png\n";

/// Reads a file, in which the name's ending matters where the bytes say nothing.
fn read(name: &str, bytes: &[u8], beside: &[(&str, &[u8])]) {
    // Faces are turned, so that this is done, too.
    let weld = Weld { turn: true, ..Weld::default() };
    if let Err(error) = import::bytes_by(Path::new(name), bytes, beside, weld, import::Rules::default()) {
        let error = format!("{error:#}");
        assert!(error.starts_with(name) || beside.iter().any(|(name, _)| error.starts_with(name)), "{error}");
    }
}

/// Parts of `bytes` with zeros between them; what is missing is empty.
fn parts<const N: usize>(bytes: &[u8]) -> [&[u8]; N] {
    let mut parts = bytes.splitn(N, |&byte| byte == 0);
    [(); N].map(|()| parts.next().unwrap_or_default())
}

/// `bytes` as an STL file, text or binary.
pub fn stl(bytes: &[u8]) {
    read("a.stl", bytes, &[]);
}

/// `bytes` as a PLY file, text or binary.
pub fn ply(bytes: &[u8]) {
    read("a.ply", bytes, &[]);
}

/// `bytes` as an OBJ file, and behind a zero its materials, which may name an image.
pub fn mtl(bytes: &[u8]) {
    let [obj, mtl] = parts(bytes);
    read("a.obj", obj, &[("a.mtl", mtl), ("a.png", IMAGE)]);
}

/// `bytes` as an image, PNG or JPEG, on a triangle.
pub fn image(bytes: &[u8]) {
    read("a.obj", WITH_TEXTURE, &[("a.mtl", ITS_MATERIAL), ("a.png", bytes)]);
}

/// `bytes` as GLB, or else as the text of a glTF file and, behind a zero, its binary chunk. A fuzzer would not find the lengths of chunks.
pub fn gltf(bytes: &[u8]) {
    if bytes.starts_with(b"glTF") {
        return read("a.glb", bytes, &[("a.png", IMAGE)]);
    }
    let [text, binary] = parts(bytes);
    read("a.glb", &glb(text, binary), &[("a.bin", binary), ("a.png", IMAGE)]);
}

/// A GLB of these chunks.
#[must_use]
pub fn glb(text: &[u8], binary: &[u8]) -> Vec<u8> {
    let chunk = |kind: &[u8], bytes: &[u8], filling: u8| {
        let padding = vec![filling; bytes.len().next_multiple_of(4) - bytes.len()];
        [&((bytes.len() + padding.len()) as u32).to_le_bytes(), kind, bytes, &padding].concat()
    };
    let chunks = [chunk(b"JSON", text, b' '), chunk(b"BIN\0", binary, 0)].concat();
    [b"glTF", &2u32.to_le_bytes()[..], &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

/// `bytes` as the models of a 3MF file, with a zero between the main model and another one.
///
/// # Panics
/// When the archive cannot be written.
pub fn threemf(bytes: &[u8]) {
    read("a.3mf", &of_models(bytes), &[]);
}

/// The archive of a 3MF file with these models, and an image.
///
/// # Panics
/// When it cannot be written.
#[must_use]
pub fn of_models(bytes: &[u8]) -> Vec<u8> {
    let [main, other] = parts(bytes);
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for (name, part) in [("3D/3dmodel.model", main), ("3D/a.model", other), ("3D/a.png", IMAGE)] {
        let (mut entry, config) = archive.new_file(name).start().expect("a part");
        let mut writer = config.wrap(&mut entry);
        writer.write_all(part).expect("memory");
        let (_, descriptor) = writer.finish().expect("memory");
        entry.finish(descriptor).expect("a part");
    }
    archive.finish().expect("memory")
}

/// `bytes` as the archive of a 3MF file.
pub fn archive(bytes: &[u8]) {
    read("a.3mf", bytes, &[]);
}
