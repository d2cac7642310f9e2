//! Functions of the fuzz targets. The tests call them with the committed corpus, without a fuzzer.
//!
//! For no bytes may anything panic, or a sum or product overflow.

use crate::{case::Case, readers, texts};
use microphong::{
    Outlines, Skips, Stream,
    stream::{
        record::{Header, MAGIC, VERSION},
        seal,
    },
};
use microphong_models::{bytes::StreamBytes, mesh, obj};
use microphong_render::{
    render::{Format, Style},
    shader::Shader,
};
use zerocopy::FromBytes;

/// A function that takes a fuzzer's bytes.
pub type Target = fn(&[u8]);

/// The targets, by name.
pub const TARGETS: [(&str, Target); 11] = [
    ("raw", raw),
    ("structured", structured),
    ("obj", obj),
    ("scene", scene),
    ("stl", readers::stl),
    ("ply", readers::ply),
    ("mtl", readers::mtl),
    ("image", readers::image),
    ("gltf", readers::gltf),
    ("threemf", readers::threemf),
    ("archive", readers::archive),
];

/// Number of the first bytes, which decide how a frame is drawn.
const CHOICES: usize = 8;

/// `bytes` as a file that somebody hands to the command: nearly all are refused.
pub fn raw(bytes: &[u8]) {
    let stream = StreamBytes::from(bytes);
    if stream.parse().is_ok() {
        draw(Case::new(stream));
    }
}

/// Draws `bytes` behind a valid header, in a stream with a valid checksum. A stream is then refused for its contents only.
pub fn structured(bytes: &[u8]) {
    if let Some(case) = case(bytes) {
        draw(case);
    }
}

/// The case that [`structured`] draws; `None` if the bytes make no valid stream.
#[must_use]
pub fn case(bytes: &[u8]) -> Option<Case> {
    sealed(bytes).filter(|case| case.stream.parse().is_ok())
}

/// The first bytes choose how to draw, the others are the stream, valid or not, behind a header that is right. `None` if they are too few.
#[must_use]
pub fn sealed(bytes: &[u8]) -> Option<Case> {
    let (choices, rest) = bytes.split_first_chunk::<CHOICES>()?;
    let mut bytes = rest.to_vec();
    // Magic, version and length are not worth a fuzzer's time.
    let length = bytes.len() as u32;
    let (header, _) = Header::mut_from_prefix(&mut bytes).ok()?;
    (header.magic, header.version, header.length) = (MAGIC, VERSION, length);
    seal(&mut bytes);
    let stream = StreamBytes::from(&bytes[..]);
    let [shader, style, format, width, height, rows, low, high] = *choices;
    let style = Style {
        shader: Shader::ALL[usize::from(shader) % Shader::ALL.len()],
        perspective_correct: style & 1 != 0,
        antialias: style & 2 != 0,
        outlines: (style & 32 != 0).then(|| Outlines::new([low, high, style]).alone(style & 64 != 0)),
        dither: style & 4 != 0,
        srgb: style & 16 != 0,
        skips: if style & 8 == 0 { Skips::ALL } else { Skips::NONE },
    };
    Some(Case {
        size: [width, height].map(|side| u32::from(side % 64) + 1),
        frame: u32::from_le_bytes([low, high, low, high]),
        style,
        format: Format::ALL[usize::from(format) % Format::ALL.len()],
        band_rows: u32::from(rows % 64) + 1,
        ..Case::new(stream)
    })
}

/// `bytes` as the text of an OBJ file, on to a mesh.
pub fn obj(bytes: &[u8]) {
    if let Ok(obj) = obj::parse(&String::from_utf8_lossy(bytes)) {
        drop(mesh::weld(&obj.soup, mesh::Weld { turn: true, ..mesh::Weld::default() }));
    }
}

/// `bytes` as the text of a scene, on to a picture.
///
/// # Panics
/// When the text is refused in words that name no line.
pub fn scene(bytes: &[u8]) {
    if let Some(stream) = texts::converted(bytes).unwrap_or_else(|what| panic!("{what}")) {
        draw(Case { frame: 7, ..Case::new(stream) });
    }
}

/// Asks a stream for each of its names, and for a name that it lacks.
///
/// # Panics
/// When it does not find a name that it lists.
pub fn ask(stream: &Stream<'_>) {
    for (name, meshes) in stream.names().flatten() {
        assert!(meshes.end <= stream.meshes.len() as u16 && stream.mesh(name).is_ok(), "{name:?}");
    }
    let unknown = stream.mesh("");
    assert!(unknown.is_err_and(|error| error.to_string().starts_with("the stream has no mesh")));
}

/// Draws a frame small enough that thousands are drawn in a second; what cannot be drawn is refused.
fn draw(case: Case) {
    // A fuzzer's million triangles show no more than its hundred.
    if case.stream.parse().inspect(ask).is_ok_and(|stream| stream.triangles.len() <= 256) {
        drop(case.draw());
    }
}

/// `structured`'s bytes for a case: seeds of the corpus.
#[must_use]
pub fn seed(case: &Case) -> Vec<u8> {
    let index = |shader: Shader| Shader::ALL.iter().position(|&other| other == shader).unwrap_or(0) as u8;
    let Style { shader, perspective_correct, antialias, outlines, dither, srgb, skips } = case.style;
    let style = u8::from(perspective_correct)
        | u8::from(antialias) << 1
        | u8::from(dither) << 2
        | u8::from(skips != Skips::ALL) << 3
        | u8::from(srgb) << 4
        | u8::from(outlines.is_some()) << 5
        | u8::from(outlines.is_some_and(|outlines| outlines.alone)) << 6;
    let format = Format::ALL.iter().position(|&other| other == case.format).unwrap_or(0) as u8;
    let [width, height] = case.size.map(|side| ((side - 1) % 64) as u8);
    let [low, high, ..] = case.frame.to_le_bytes();
    let mut bytes = vec![index(shader), style, format, width, height, ((case.band_rows - 1) % 64) as u8, low, high];
    bytes.extend_from_slice(case.stream.as_bytes());
    bytes
}
