//! Reads PLY, text and binary, by the library `ply-rs-bw`: positions, normals and polygons; tells what else there is.

use crate::{
    faults::{FEW_CORNERS, Faults, UNUSED_NORMAL, UNUSED_POSITION},
    mesh::{Corner, Face, Smoothing, Soup, Submesh},
    obj::LARGEST,
};
use anyhow::{Context, Result, anyhow, bail};
use ply_rs_bw::{
    parser::{ParseError, Parser, Reader},
    ply::{ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult},
};
use std::collections::BTreeSet;

/// The contents of a PLY file.
#[derive(Clone, Debug, Default)]
pub struct Ply {
    /// The polygons of the file.
    pub soup: Soup,
    /// Contents that are left out, in words.
    pub ignored: BTreeSet<&'static str>,
    /// Wrong elements that are left out.
    pub faults: Faults,
}

/// Whether a file is PLY.
pub(crate) fn is_ply(bytes: &[u8]) -> bool {
    magic(bytes).is_some()
}

/// The end of the first line, if it is the word by which PLY begins, in any capitals.
fn magic(bytes: &[u8]) -> Option<usize> {
    let end = bytes.iter().take(16).position(|byte| matches!(byte, b'\n' | b'\r'))?;
    bytes[..end].trim_ascii().eq_ignore_ascii_case(b"ply").then_some(end)
}

/// Reads the polygons of a file, with a normal at each vertex if the file has one there.
///
/// # Errors
/// The error names the line, the vertex or the face, and its fault.
pub fn parse(bytes: &[u8]) -> Result<Ply> {
    let Some(end) = magic(bytes) else {
        bail!("PLY, line 1: the magic number `ply` is missing; the file is no PLY: give it the ending of its format, or export it again")
    };
    let bytes = &with_numbers(&bytes[end..])[..];
    let mut reader = Reader::new(bytes);
    let header = Parser::<Skipped>::new().read_header(&mut reader).map_err(|error| plain(&error, true))?;
    let mut ply = Ply { ignored: ignored(&header), ..Ply::default() };
    let (mut vertices, mut faces, mut strips) = (Vec::new(), Vec::new(), Vec::new());
    let (mut with_normals, mut with_colours) = (false, false);
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => {
                if let Some(axis) = AXES.iter().find(|axis| !element.properties.contains_key(**axis)) {
                    bail!("PLY: vertices have no property {axis}; export them with x, y and z");
                }
                with_normals = NORMALS.iter().all(|axis| element.properties.contains_key(*axis));
                with_colours = COLOURS.iter().all(|channel| element.properties.contains_key(*channel));
                vertices = elements::<Vertex>(&mut reader, element, &header)?;
            }
            "face" => faces = corners(&mut reader, element, &header, "faces")?,
            "tristrips" => strips = corners(&mut reader, element, &header, "strips of triangles")?,
            _ => drop(elements::<Skipped>(&mut reader, element, &header)?),
        }
    }
    let corner = |index: i64, place: &str| {
        let position = usize::try_from(index).ok().filter(|&index| index < vertices.len());
        let range = || format!("PLY, {place}: vertex {index} is out of range; they count from 0, and the file has {}", vertices.len());
        position.with_context(range).map(|position| Corner {
            position,
            normal: with_normals.then_some(position),
            colour: with_colours.then_some(position),
            place: None,
        })
    };
    let mut first = None;
    for (number, Corners(corners)) in (1..).zip(faces) {
        if corners.len() < 3 {
            first.get_or_insert_with(|| format!("PLY, face {number}: {} corners; three at least are needed", corners.len()));
            ply.faults.add(FEW_CORNERS, || format!("face {number}"));
            continue;
        }
        let corners = corners.into_iter().map(|index| corner(index, &format!("face {number}"))).collect::<Result<_>>()?;
        ply.soup.faces.push(Face { corners, submesh: Submesh::default(), smoothing: Smoothing::ByAngle });
    }
    for (number, Corners(strip)) in (1..).zip(strips) {
        for triangle in triangles(&strip) {
            let corners = triangle.into_iter().map(|index| corner(index, &format!("strip {number}"))).collect::<Result<_>>()?;
            ply.soup.faces.push(Face { corners, submesh: Submesh::default(), smoothing: Smoothing::ByAngle });
        }
    }
    if let Some(error) = first.filter(|_| ply.faults.count(FEW_CORNERS) > ply.soup.faces.len()) {
        bail!(error);
    }
    let mut used = vec![false; vertices.len()];
    ply.soup.faces.iter().flat_map(|face| &face.corners).for_each(|corner| used[corner.position] = true);
    let is_right = |vector: &[f64; 3]| vector.iter().all(|c| c.is_finite() && c.abs() <= LARGEST);
    for (number, (vertex, used)) in (1..).zip(vertices.iter_mut().zip(used)) {
        if !is_right(&vertex.position) {
            // Without faces nothing is used, and nothing is right.
            if used || ply.soup.faces.is_empty() {
                bail!("PLY, vertex {number}: coordinates must be finite and below {LARGEST:e}");
            }
            ply.faults.add(UNUSED_POSITION, || format!("vertex {number}"));
            vertex.position = [0.0; 3];
        }
        if with_normals && !is_right(&vertex.normal) {
            if !used {
                ply.faults.add(UNUSED_NORMAL, || format!("vertex {number}"));
            }
            // One without a direction, for which another is computed.
            vertex.normal = [0.0; 3];
        }
    }
    ply.soup.positions = vertices.iter().map(|vertex| vertex.position).collect();
    if with_normals {
        ply.soup.normals = vertices.iter().map(|vertex| vertex.normal).collect();
    }
    if with_colours {
        ply.soup.colours =
            vertices.iter().map(|vertex| vertex.colour.map(|c| if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 })).collect();
    }
    Ok(ply)
}

/// The file with the magic number as the library wants it, and in text with a number that is not finite in the place of words such as `nan`, which the
/// library does not read.
fn with_numbers(behind_magic: &[u8]) -> Vec<u8> {
    let bytes = [b"ply", behind_magic].concat();
    const END: &[u8] = b"end_header";
    let head = bytes.windows(END.len()).position(|word| word == END).map_or(bytes.len(), |start| start + END.len());
    let (head, body) = bytes.split_at(head);
    let is_text = head.windows(12).any(|words| words == b"format ascii");
    let is_word = |byte: &u8| byte.is_ascii_alphabetic() && !byte.eq_ignore_ascii_case(&b'e') || *byte == b'#';
    if !is_text || !body.iter().any(is_word) {
        return bytes;
    }
    let mut text = head.to_vec();
    for word in body.split_inclusive(u8::is_ascii_whitespace) {
        let number = word.trim_ascii_end();
        let is_not_finite = number.iter().any(is_word) && std::str::from_utf8(number).is_ok_and(is_no_number);
        text.extend_from_slice(if is_not_finite { b"1e999" } else { number });
        text.extend_from_slice(&word[number.len()..]);
    }
    text
}

/// Whether a word stands for what is not finite, as programs write it.
fn is_no_number(word: &str) -> bool {
    let word = word.trim_start_matches(['-', '+']).to_ascii_lowercase();
    ["nan", "inf", "1.#"].iter().any(|start| word.starts_with(start))
}

/// The triangles of strips, of which -1 ends each, all wound alike.
fn triangles(strips: &[i64]) -> Vec<[i64; 3]> {
    let strips = strips.split(|&index| index == -1);
    let of_strip = |strip: &[i64]| {
        let turned = |(number, corners): (usize, &[i64])| match *corners {
            [a, b, c] if number % 2 == 0 => Some([a, b, c]),
            [a, b, c] => Some([b, a, c]),
            _ => None,
        };
        strip.windows(3).enumerate().filter_map(turned).collect::<Vec<_>>()
    };
    strips.flat_map(of_strip).collect()
}

/// The lists of corners of all elements of a kind, which errors call `what`.
fn corners(reader: &mut Reader<&[u8]>, element: &ElementDef, header: &Header, what: &str) -> Result<Vec<Corners>> {
    if !CORNERS.iter().any(|list| element.properties.contains_key(*list)) {
        bail!("PLY: {what} have no property {}; export them with lists of vertices", CORNERS.join(" or "));
    }
    elements(reader, element, header)
}

const AXES: [&str; 3] = ["x", "y", "z"];
const NORMALS: [&str; 3] = ["nx", "ny", "nz"];
const COLOURS: [&str; 3] = ["red", "green", "blue"];
/// Names for the list of a face's corners; both are common.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Contents that a header announces and that are left out.
fn ignored(header: &Header) -> BTreeSet<&'static str> {
    let elements = header.elements.iter().filter(|(_, element)| element.count > 0);
    let whole = elements.clone().filter_map(|(name, _)| match name.as_str() {
        "edge" => Some("lines and points"),
        _ => None,
    });
    let has = |element: &ElementDef, channel: &&str| element.properties.contains_key(*channel);
    let is_part =
        |element: &ElementDef| COLOURS.iter().any(|channel| has(element, channel)) && !COLOURS.iter().all(|channel| has(element, channel));
    let parts_of_colours =
        elements.clone().filter_map(|(name, element)| (name == "vertex" && is_part(element)).then_some("colours of vertices"));
    let properties = elements.flat_map(|(name, element)| element.properties.keys().map(move |property| (name, property)));
    let parts = properties.filter_map(|(name, property)| match (name.as_str(), property.trim_start_matches("diffuse_")) {
        ("vertex", "alpha") => Some("transparency"),
        ("vertex", "r" | "g" | "b") => Some("colours of vertices"),
        ("vertex", "red" | "green" | "blue") if property.starts_with("diffuse_") => Some("colours of vertices"),
        ("face", "red" | "green" | "blue" | "alpha") => Some("colours of faces"),
        ("vertex", "s" | "t" | "u" | "v" | "texture_u" | "texture_v") | ("face", "texcoord") => Some("texture coordinates"),
        _ => None,
    });
    whole.chain(parts_of_colours).chain(parts).collect()
}

/// All elements of a kind. They follow the elements that have been read.
fn elements<E: PropertyAccess>(reader: &mut Reader<&[u8]>, element: &ElementDef, header: &Header) -> Result<Vec<E>> {
    let is_text = header.encoding == Encoding::Ascii;
    // They take no bytes, so that no end of the file would end them, however many the header says there are.
    if element.properties.is_empty() && !is_text {
        return Ok(Vec::new());
    }
    Parser::new().read_payload_for_element(reader, element, header).map_err(|error| plain(&error, is_text))
}

/// An error of the library in one line, without the file's own text, which may be long. Only text has lines.
fn plain(error: &ParseError, is_text: bool) -> anyhow::Error {
    let text = error.to_string();
    let (line, message) = text
        .strip_prefix("Line ")
        .and_then(|rest| rest.split_once(": "))
        .map_or((None, &text[..]), |(line, message)| (Some(line), message));
    // What the library's grammar expects is no help.
    let what = message.lines().next().unwrap_or_default().split(": ParseError").next().unwrap_or_default().trim_end_matches('.');
    // What it was that could not be read stands last.
    let why = message.lines().rev().find_map(|line| line.trim().strip_prefix("Error: ")).filter(|_| is_text);
    let why = why.map(in_words);
    let why = why.map(|why| why.chars().take(LONGEST).collect::<String>()).map_or(String::new(), |why| format!(": {why}"));
    let why = why + if what.contains("end of file") { "; it was cut off: get the file again" } else { "" };
    match line.filter(|_| is_text) {
        Some(line) => anyhow!("PLY, line {line}: {what}{why}"),
        None => anyhow!("PLY: {what}{why}"),
    }
}

/// What is wrong, where the library says what its grammar expects, or names its own types.
fn in_words(why: &str) -> &str {
    let phrases = [
        ("ParseError", "a header has lines with `format`, `comment`, `element NAME NUMBER`, `property TYPE NAME` and `end_header`"),
        ("expected one of", "numbers with blanks between them are needed"),
        ("Expected element of type", "a number is missing"),
        (
            "by the destination element",
            "the type of a property is unsupported: corners are lists of whole numbers, and coordinates are no lists",
        ),
    ];
    phrases.into_iter().find(|(innards, _)| why.contains(innards)).map_or(why, |(_, words)| words)
}

/// Characters of what a library says.
const LONGEST: usize = 120;

/// A number of whatever type; `None` for a list.
fn number(property: &Property) -> Option<f64> {
    match *property {
        Property::Char(n) => Some(n.into()),
        Property::UChar(n) => Some(n.into()),
        Property::Short(n) => Some(n.into()),
        Property::UShort(n) => Some(n.into()),
        Property::Int(n) => Some(n.into()),
        Property::UInt(n) => Some(n.into()),
        Property::Float(n) => Some(n.into()),
        Property::Double(n) => Some(n),
        _ => None,
    }
}

/// The number that stands for all of a colour in this type.
fn full(property: &Property) -> f64 {
    match property {
        Property::UShort(_) => 65_535.0,
        Property::Float(_) | Property::Double(_) => 1.0,
        _ => 255.0,
    }
}

/// Whole numbers of whatever type; `None` for all else.
fn whole_numbers(property: Property) -> Option<Vec<i64>> {
    fn wide<N: Into<i64>>(list: Vec<N>) -> Vec<i64> {
        list.into_iter().map(Into::into).collect()
    }
    match property {
        Property::ListChar(list) => Some(wide(list)),
        Property::ListUChar(list) => Some(wide(list)),
        Property::ListShort(list) => Some(wide(list)),
        Property::ListUShort(list) => Some(wide(list)),
        Property::ListInt(list) => Some(wide(list)),
        Property::ListUInt(list) => Some(wide(list)),
        _ => None,
    }
}

#[derive(Default)]
struct Vertex {
    position: [f64; 3],
    normal: [f64; 3],
    /// From 0 to 1.
    colour: [f64; 3],
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let axis = |names: [&str; 3]| names.iter().position(|&axis| axis == name);
        let (component, full) = match (axis(AXES), axis(NORMALS), axis(COLOURS)) {
            (Some(axis), ..) => (&mut self.position[axis], 1.0),
            (_, Some(axis), _) => (&mut self.normal[axis], 1.0),
            (.., Some(channel)) => (&mut self.colour[channel], full(&property)),
            _ => return PropertyAccessResult::Ignored,
        };
        let Some(number) = number(&property) else { return PropertyAccessResult::UnsupportedType };
        *component = number / full;
        PropertyAccessResult::Set
    }
}

#[derive(Default)]
struct Corners(Vec<i64>);

impl PropertyAccess for Corners {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !CORNERS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        let Some(corners) = whole_numbers(property) else { return PropertyAccessResult::UnsupportedType };
        self.0 = corners;
        PropertyAccessResult::Set
    }
}

/// An element of which nothing is kept.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }

    fn set_property(&mut self, _: &str, _: Property) -> PropertyAccessResult {
        PropertyAccessResult::Ignored
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HEAD: &str = "element vertex 3\nproperty float x\nproperty double y\nproperty short z\nproperty uchar red\nproperty list uchar float s\nelement edge 1\nproperty int vertex1\nelement face 1\nproperty list uchar uint vertex_index\nproperty uchar flags\nend_header\n";

    fn text() -> Vec<u8> {
        format!("ply\r\nformat ascii 1.0\ncomment of a modeller\n{HEAD}0 0.5 0 9 0\n1 0 -2 9 1 0.5\n0 1e0 0 9 0\n7\n3 0 1 2 4\n").into()
    }

    /// A square as binary PLY, in either order of bytes.
    fn binary(big: bool) -> Vec<u8> {
        let mut bytes = format!("ply\nformat binary_{}_endian 1.0\n{HEAD}", if big { "big" } else { "little" }).into_bytes();
        let mut push = |number: &[u8]| if big { bytes.extend(number.iter().rev()) } else { bytes.extend(number) };
        for (x, y, z, s) in [(0f32, 0.5f64, 0i16, None), (1.0, 0.0, -2, Some(0.5f32)), (0.0, 1.0, 0, None)] {
            push(&x.to_le_bytes());
            push(&y.to_le_bytes());
            push(&z.to_le_bytes());
            push(&[9]);
            push(&[s.is_some().into()]);
            s.iter().for_each(|s| push(&s.to_le_bytes()));
        }
        push(&7i32.to_le_bytes());
        push(&[3]);
        [0u32, 1, 2].iter().for_each(|corner| push(&corner.to_le_bytes()));
        push(&[4]);
        bytes
    }

    #[test]
    fn text_and_binary_are_the_same() {
        for bytes in [text(), binary(false), binary(true)] {
            assert!(is_ply(&bytes));
            let Ply { soup, ignored, faults } = parse(&bytes).unwrap();
            assert!(faults.sentences().next().is_none());
            assert_eq!(soup.positions, [[0.0, 0.5, 0.0], [1.0, 0.0, -2.0], [0.0, 1.0, 0.0]]);
            assert_eq!(
                soup.faces.iter().map(|face| face.corners.iter().map(|c| c.position).collect()).collect::<Vec<Vec<_>>>(),
                [[0, 1, 2]]
            );
            assert!(soup.normals.is_empty());
            assert_eq!(ignored.into_iter().collect::<Vec<_>>(), ["colours of vertices", "lines and points", "texture coordinates"]);
        }
    }

    #[test]
    fn errors_name_the_place() {
        let file = |vertices: &str, faces: &str| {
            let count = |lines: &str| lines.lines().count();
            format!(
                "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n{vertices}{faces}",
                count(vertices),
                count(faces)
            )
        };
        let three = "0 0 0\n1 0 0\n0 1 0\n";
        for (text, wrong) in [
            (file(three, "3 0 1 3\n"), "PLY, face 1: vertex 3 is out of range; they count from 0, and the file has 3"),
            (file(three, "3 0 1 2\n3 0 1 -1\n"), "PLY, face 2: vertex -1 is out of range"),
            (file(three, "2 0 1\n"), "PLY, face 1: 2 corners; three at least are needed"),
            (file("0 0 0\n0 1e200 0\n", ""), "PLY, vertex 2: coordinates must be finite and below 1e100"),
            (file("0 0 0\n0 1\n", ""), "PLY, line 11: Couldn't read element line"),
            (file("0 0 0\n0 one 0\n", ""), "PLY, line 11: Couldn't read element line"),
            (file(three, "3 0 1\n"), "PLY, line 13: Couldn't read element line: Expected 3 list elements, but found only 2"),
            (
                file(three, "3 0 1 2\n").replace("3 0 1 2\n", ""),
                "PLY, line 13: Unexpected end of file while reading element 'face' (expected 1, got 0); it was cut off: get the file again",
            ),
            (file(three, "").replace("property double z\n", ""), "PLY: vertices have no property z; export them with x, y and z"),
            (file(three, "").replace("vertex_indices", "corners"), "PLY: faces have no property vertex_indices or vertex_index"),
            (file(three, "3 0 1 2\n").replace("uchar int", "uchar float"), "is unsupported"),
            (file(three, "").replace("double x", "real x"), "PLY, line 4: Couldn't parse line: a header has lines with `format`"),
            (file(three, "").replace("element vertex 3", "element vertex three"), "PLY, line 3: Couldn't parse line: a header has lines"),
            (file("0 0 0\n0 1\n", ""), "PLY, line 11: Couldn't read element line: a number is missing"),
            ("ply\nformat ascii 1.0\n".to_owned(), "PLY, line 3: Unexpected end of file while reading header (missing 'end_header')"),
            ("ply\nelement vertex 0\nend_header\n".to_owned(), "PLY: No format line found"),
        ] {
            let error = format!("{:#}", parse(text.as_bytes()).unwrap_err());
            assert!(error.contains(wrong) && !error.contains('\n'), "{error}");
            // Nothing of the library's own types comes through.
            assert!(
                ["ParseError", "expected one of", "Scalar(", "List(", "destination"].iter().all(|innards| !error.contains(innards)),
                "{error}"
            );
        }
        let whole = binary(false);
        let cut = format!("{:#}", parse(&whole[..whole.len() - 3]).unwrap_err());
        assert_eq!(
            cut,
            "PLY: Unexpected end of file while reading binary element 'face' (expected 1, got 0); it was cut off: get the file again"
        );
    }

    #[test]
    fn the_first_line_may_be_in_capitals() {
        let whole = [text(), binary(false)];
        for (start, bytes) in ["PLY", "Ply ", " ply\t"].iter().flat_map(|start| whole.iter().map(move |bytes| (start, bytes))) {
            let bytes = [start.as_bytes(), &bytes[3..]].concat();
            assert!(is_ply(&bytes) && parse(&bytes).unwrap().soup.faces.len() == 1, "{start:?}");
        }
        for bytes in ["plywood\n", "ply", "", "a ply\n"] {
            let error = format!("{:#}", parse(bytes.as_bytes()).unwrap_err());
            assert!(!is_ply(bytes.as_bytes()) && error.starts_with("PLY, line 1: the magic number `ply` is missing"), "{error}");
        }
    }

    #[test]
    fn strips_are_triangles_that_are_wound_alike() {
        assert_eq!(triangles(&[0, 1, 2, 3, -1, 4, 5, 6, 7, 8]), [[0, 1, 2], [2, 1, 3], [4, 5, 6], [6, 5, 7], [6, 7, 8]]);
        assert!(triangles(&[-1, 0, 1, -1, -1, 2]).is_empty() && triangles(&[]).is_empty());
        let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n5 0 1 2 3 4\n";
        let Ply { soup, ignored, .. } = parse(text.as_bytes()).unwrap();
        assert!(soup.faces.len() == 3 && ignored.is_empty());
        for face in &soup.faces {
            let [a, b, c] = [0, 1, 2].map(|k| soup.positions[face.corners[k].position]);
            assert!((b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]), "{face:?}");
        }
        let error = format!("{:#}", parse(text.replace("5 0 1 2 3 4", "5 0 1 2 3 5").as_bytes()).unwrap_err());
        assert_eq!(error, "PLY, strip 1: vertex 5 is out of range; they count from 0, and the file has 5");
    }

    #[test]
    fn wrong_elements_that_do_not_matter_are_counted() {
        let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
        let text = format!("{head}0 0 0 0 0 1\n1 0 0 0 0 nan\n0 1 0 0 0 1\nnan 0 0 0 inf 1\n3 0 1 2\n2 0 1\n");
        let Ply { soup, faults, .. } = parse(text.as_bytes()).unwrap();
        assert_eq!((soup.faces.len(), soup.normals[1]), (1, [0.0; 3]));
        let said: Vec<_> = faults.sentences().collect();
        assert_eq!(
            said,
            [
                "1 face has fewer than three corners and is left out: face 2",
                "1 vertex is not three finite numbers and is left out, because no face uses it: vertex 4",
                "1 normal is not three finite numbers and is left out, because no face uses it: vertex 4"
            ]
        );
        let used = format!("{:#}", parse(text.replace("3 0 1 2\n", "3 0 1 3\n").as_bytes()).unwrap_err());
        assert_eq!(used, "PLY, vertex 4: coordinates must be finite and below 1e100");
        for word in ["-nan(ind)", "1.#QNAN", "NaN", "-Inf"] {
            assert_eq!(parse(text.replace("nan", word).as_bytes()).unwrap().soup.normals[1], [0.0; 3], "{word}");
        }
        let word = format!("{:#}", parse(text.replace("1 0 0 0 0 nan", "1 0 0 0 0 none").as_bytes()).unwrap_err());
        assert_eq!(word, "PLY, line 14: Couldn't read element line: numbers with blanks between them are needed");
    }

    #[test]
    fn numbers_in_the_header_are_not_believed() {
        let endless = "ply\nformat binary_little_endian 1.0\nelement nothing 18446744073709551615\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
        assert!(parse(endless.as_bytes()).unwrap().soup.faces.is_empty());
        let many = endless.replace("vertex 0", "vertex 18446744073709551615");
        assert!(format!("{:#}", parse(many.as_bytes()).unwrap_err()).contains("got 0"));
    }

    proptest! {
        #[test]
        fn any_bytes_may_come(bytes in prop::collection::vec(any::<u8>(), 0..200), format in 0..3usize, cut in 0..400usize, at in 0..400usize, byte in any::<u8>()) {
            // An error is as good as a mesh.
            let _ = parse(&[b"ply\n", &bytes[..]].concat());
            let mut good = [text(), binary(false), binary(true)][format].clone();
            let _ = parse(&good[..cut.min(good.len())]);
            let at = at % good.len();
            good[at] = byte;
            let _ = parse(&good);
        }
    }
}
