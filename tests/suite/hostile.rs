//! Any bytes in a board's flash instead of a stream: the firmware draws the host's picture, bit for bit, or reports why there is none, on its display
//! and in its log. It never hangs.
//!
//! The streams are the fuzzers' corpus, random ones of `microphong stress` with damaged bytes, and some whose values are the largest and smallest of
//! the format, or one beyond. Each replaces the stream in the one program of a board.

use microphong::{
    format::{MAX_LIGHTS, Share},
    stream::{
        self, MAX_EXPONENT, MAX_FOCAL, MAX_GAIN, MAX_LENGTH, MIN_FOCAL, MIN_NEAR,
        record::{
            Header, LABEL_TEXT, Label, Light, Material, ORTHOGRAPHIC, OUTLINES_ALONE, OUTLINES_OVER_SURFACES, POINT, RIGHT, Triangle,
        },
    },
};
use microphong_sim::{
    board::{self, Board, Recording, Until, elf::Elf},
    bytes::StreamBytes,
    records, scene,
    shader::Shader,
    stress::records::Records,
    stress::{case::Case, fuzz, hostile, random::Random},
    verify,
};
use microphong_tests::{cases, message, seed};
use std::{error::Error, fs, path::Path};

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

/// Random streams that are damaged; `MICROPHONG_CASES` multiplies it.
const DAMAGED: u64 = 24;

/// Bytes in place of a stream, and what they are.
type Named = (String, Vec<u8>);

/// The corpus of the fuzzers that make streams.
fn corpus(board: Board) -> Result<Vec<Named>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus");
    let mut streams = Vec::new();
    for target in ["raw", "structured"] {
        for entry in fs::read_dir(folder.join(target))? {
            let path = entry?.path();
            let bytes = fs::read(&path)?;
            let bytes = if target == "raw" { bytes } else { fuzz::sealed(&bytes).map(|case| drawable(board, case)).unwrap_or(bytes) };
            streams.push((path.display().to_string(), bytes));
        }
    }
    Ok(streams)
}

/// Damaged streams of random scenes.
fn damaged(board: Board) -> Vec<Named> {
    let seed = seed();
    let numbered = (0..).filter_map(|number| Some((number, hostile::damaged(&mut Random::new(seed, number))?)));
    // The plain firmware lacks the feature `light-shapes`, and would refuse these streams.
    let is_plain = |case: &Case| !case.stream.parse().is_ok_and(|stream| stream.lights.iter().any(Light::has_shape));
    let numbered = numbered.filter(|(_, case)| is_plain(case));
    let named = numbered.map(|(number, case)| (format!("hostile {number} of seed {seed}"), drawable(board, case)));
    named.take(cases(DAMAGED) as usize).collect()
}

/// The case's stream, to be drawn by the case's method if it can be drawn and the board has that method. It has no colours at corners, which the plain
/// firmware does not draw.
fn drawable(board: Board, case: Case) -> Vec<u8> {
    let plain = case.stream.parse().ok().and_then(|stream| Records::of(&stream).without_colours().written());
    let case = Case { stream: plain.unwrap_or(case.stream), ..case };
    let shader = if board.has(case.style.shader) { case.style.shader } else { Shader::AUTO };
    let prepared = case.stream.parse().ok().and_then(|stream| verify::prepare(case.stream.as_bytes(), shader, stream.header.frames).ok());
    prepared.unwrap_or_else(|| case.stream.as_bytes().to_vec())
}

/// A label in the middle of the picture, as long as can be.
fn label(colour: [u8; 3]) -> Label {
    records::label([Share::ZERO; 2], Share::from_bits(300), colour, 1, b"0123456789\xB0C \xA0\xFF abcdefghijklmno")
}

/// A name and a change.
type Change<T> = (&'static str, fn(&mut T));

/// Values at the ends of their ranges, and beyond them.
const LIMITS: [Change<Records>; 28] = [
    ("least focal length", |parts| parts.header.camera.focal = MIN_FOCAL),
    ("largest focal length", |parts| parts.header.camera.focal = MAX_FOCAL),
    ("too large a focal length", |parts| parts.header.camera.focal = MAX_FOCAL + 1),
    ("camera in the middle of the mesh", |parts| {
        parts.header.camera.translation = [0; 3];
        parts.header.camera.near = MIN_NEAR;
    }),
    ("mesh as far as can be", |parts| parts.header.camera.translation = [-MAX_LENGTH, MAX_LENGTH, MAX_LENGTH]),
    ("mesh too far", |parts| parts.header.camera.translation[2] = MAX_LENGTH + 1),
    ("parallel rays, farthest plane", |parts| {
        let camera = &mut parts.header.camera;
        (camera.projection, camera.near, camera.far) = (ORTHOGRAPHIC, MIN_NEAR, 2 * MAX_LENGTH);
    }),
    ("broadest highlight", |parts| parts.materials[0].exponent = 1),
    ("sharpest highlight", |parts| parts.materials[0].exponent = MAX_EXPONENT),
    ("too sharp a highlight", |parts| parts.materials[0].exponent = MAX_EXPONENT + 1),
    ("all as bright as can be, under near lights", |parts| {
        let bright = [MAX_GAIN; 3];
        parts.header.ambient = bright;
        parts.materials[0] = Material { ambient: bright, diffuse: bright, specular: bright, ..parts.materials[0] };
        let light = Light { vector: [MAX_LENGTH, 0, -MAX_LENGTH], colour: bright, kind: POINT, ..parts.lights[0] };
        parts.lights = vec![light; MAX_LIGHTS];
    }),
    ("too many lights", |parts| parts.lights = vec![parts.lights[0]; MAX_LIGHTS + 1]),
    ("more materials than any board has room for", |parts| parts.materials = vec![parts.materials[0]; 100]),
    ("an unknown method", |parts| parts.header.shader = u16::MAX),
    ("no light", |parts| parts.lights.clear()),
    ("no triangle", |parts| {
        parts.triangles.clear();
        parts.meshes[0].triangles = 0;
    }),
    ("a gradient", |parts| parts.header.background_bottom = [0, 255, 80]),
    ("as many labels as can be, everywhere", |parts| {
        let places = [i16::MIN, -2000, 0, 900, i16::MAX];
        let label = |k: usize| {
            let label = Label { height: [1, 150, 4000, i16::MAX][k % 4], ..label([90, 255, 60]) };
            Label { position: [places[k % 5], places[k / 5 % 5]], alignment: (k % 3) as u8, ..label }
        };
        parts.labels = (0..255).map(label).collect();
    }),
    ("a label of no characters", |parts| parts.labels = vec![Label { text: [0; LABEL_TEXT], ..label([0; 3]) }]),
    ("a label with a control character", |parts| parts.labels = vec![Label { text: [b'\n'; LABEL_TEXT], ..label([0; 3]) }]),
    ("a label of no height", |parts| parts.labels = vec![Label { height: 0, ..label([0; 3]) }]),
    ("a label that is aligned in no way", |parts| parts.labels = vec![Label { alignment: RIGHT + 1, ..label([0; 3]) }]),
    ("lines along outlines of no kind", |parts| parts.header.outlines = OUTLINES_ALONE + 1),
    ("a colour of no lines along outlines", |parts| parts.header.outline_colour = [0, 0, 1]),
    ("lines along outlines without neighbours", |parts| parts.header.outlines = OUTLINES_OVER_SURFACES),
    ("a name", |parts| parts.names = b"\x06needle".to_vec()),
    ("a name that no program can read", |parts| parts.names = b"\xFF\xFE".to_vec()),
    ("no mesh", |parts| {
        (parts.meshes, parts.vertices, parts.triangles) = (Vec::new(), Vec::new(), Vec::new());
    }),
];

/// False values in a header.
const LIES: [Change<Header>; 6] = [
    ("a length of 4 GiB", |header| header.length = u32::MAX),
    ("a length of nothing", |header| header.length = 0),
    ("too many vertices", |header| header.vertices = u32::MAX),
    ("a triangle more", |header| header.triangles += 1),
    ("a triangle and its bytes more", |header| {
        header.triangles += 1;
        header.length += size_of::<Triangle>() as u32;
    }),
    ("another version", |header| header.version += 1),
];

/// Streams at the limits of the format.
fn limits() -> Result<Vec<Named>> {
    let base = scene::load("dodecahedron")?.stream;
    let frames = base.parse()?.header.frames;
    let base = StreamBytes::from(&verify::prepare(base.as_bytes(), Shader::AUTO, frames)?[..]);
    let mut streams = vec![("no bytes".to_owned(), Vec::new()), ("a lone magic".to_owned(), stream::record::MAGIC.to_vec())];
    for (name, change) in LIMITS {
        let mut parts = Records::of(&base.parse()?);
        change(&mut parts);
        streams.push((name.to_owned(), parts.bytes(|_| ())));
    }
    for (name, lie) in LIES {
        streams.push((format!("header that claims {name}"), Records::of(&base.parse()?).bytes(lie)));
    }
    Ok(streams)
}

/// Pictures and log of a board with `bytes` for a stream.
fn run(board: Board, elf: &Elf, bytes: &[u8]) -> Result<Recording> {
    Ok(board::run(board, &elf.with_stream(bytes)?, Until::FirstFrame)?)
}

/// Whether the board drew a picture. An error if that was wrong.
fn judge(board: Board, elf: &Elf, bytes: &[u8], Recording { pictures, log }: &Recording) -> Result<bool> {
    let mut flash = vec![board.blank(); elf.stream_memory()?.len()];
    flash[..bytes.len()].copy_from_slice(bytes);
    let [shown] = &pictures[..] else { return Err(format!("{} pictures; {log:?}", pictures.len()).into()) };
    match verify::first_frame(board, &flash) {
        Ok(expected) if log.contains(&expected.line(0)) && *shown == expected.pixels => Ok(true),
        Ok(expected) => Err(format!("not the host's picture, {}: {log:?}", expected.line(0)).into()),
        Err(message) if log.contains(&format!("error: {message}")) && message::is_shown(board, shown, &message) => Ok(false),
        Err(message) => Err(format!("not the message `{message}`: {log:?}").into()),
    }
}

/// Runs all streams on one board.
fn board(board: Board) -> Result {
    let elf = Elf::read(&verify::build(board, false)?)?;
    let (mut drawn, mut refused, mut wrong) = (0, 0, Vec::new());
    for (name, bytes) in corpus(board)?.into_iter().chain(damaged(board)).chain(limits()?) {
        match run(board, &elf, &bytes).and_then(|recording| judge(board, &elf, &bytes, &recording)) {
            Ok(true) => drawn += 1,
            Ok(false) => refused += 1,
            Err(error) => wrong.push(format!("{name}: {error:#}")),
        }
    }
    println!("{board}: {drawn} streams drawn, {refused} refused");
    assert!(wrong.is_empty(), "{board}:\n{}", wrong.join("\n"));
    assert!(drawn > 30 && refused > 15, "{board}: {drawn} drawn, {refused} refused: too few of a kind");
    Ok(())
}

/// A picture of another stream, or the message of another error, is wrong.
#[test]
fn what_belongs_to_another_stream_is_noticed() -> Result {
    let board = Board::Mps2An385;
    let elf = Elf::read(&verify::build(board, false)?)?;
    let scene = |name| -> Result<Vec<u8>> { Ok(scene::load(name)?.stream.as_bytes().to_vec()) };
    let mut short = scene("triangle")?;
    short[8] = 0xFF;
    let streams = [scene("dodecahedron")?, scene("triangle")?, Vec::new(), short];
    let recordings = streams.iter().map(|bytes| run(board, &elf, bytes)).collect::<Result<Vec<_>>>()?;
    for (i, bytes) in streams.iter().enumerate() {
        for (k, recording) in recordings.iter().enumerate() {
            assert_eq!(judge(board, &elf, bytes, recording).ok(), (i == k).then_some(i < 2), "stream {i}, recording {k}");
        }
    }
    Ok(())
}

#[test]
fn pico() -> Result {
    board(Board::Pico)
}

#[test]
fn pico2() -> Result {
    board(Board::Pico2)
}

#[test]
fn lm3s6965evb() -> Result {
    board(Board::Lm3s6965evb)
}

#[test]
fn mps2_an385() -> Result {
    board(Board::Mps2An385)
}

#[test]
fn mps2_an386() -> Result {
    board(Board::Mps2An386)
}

#[test]
fn mps2_an500() -> Result {
    board(Board::Mps2An500)
}

#[test]
fn mps2_an505() -> Result {
    board(Board::Mps2An505)
}

#[test]
fn riscv_virt() -> Result {
    board(Board::RiscvVirt)
}
