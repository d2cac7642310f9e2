//! Reads STL, text and binary.
//!
//! The reader is our own, because programs write text in many ways: with several solids, in capitals, without a name. Libraries read the first solid
//! only, or take text for binary. A file is binary if its length is the one that its number of triangles says. No text is.

use crate::{
    faults::{FEW_CORNERS, Faults},
    mesh::{Corner, Face, Smoothing, Soup, Submesh},
    number::grouped,
    obj::LARGEST,
    text,
};
use anyhow::{Result, bail};
use std::collections::BTreeSet;

/// Bytes before the first triangle of a binary file: a title, and the number of triangles.
const HEAD: usize = TITLE + 4;
const TITLE: usize = 80;
/// Bytes of a triangle: its normal, three corners, and two bytes in which some programs keep a colour.
const TRIANGLE: usize = 50;

/// The contents of an STL file.
#[derive(Clone, Debug, Default)]
pub struct Stl {
    /// The triangles of all solids.
    pub soup: Soup,
    /// Wrong elements that are left out.
    pub faults: Faults,
    /// Contents that are left out, in words.
    pub ignored: BTreeSet<&'static str>,
    /// What else the user should know, in sentences.
    pub remarks: Vec<String>,
}

/// How a file is written.
enum Form {
    Text,
    /// Binary, with this number of triangles, and bytes behind them.
    Binary(usize, usize),
    /// Binary, without the number of triangles; so many are there.
    Uncounted(usize),
    /// Binary, of which only so many triangles are there.
    CutOff(u32, usize),
}

/// The form of a file; `None` if it is no STL. `named` says that its name ends in `.stl`.
fn form(bytes: &[u8], named: bool) -> Option<Form> {
    let count = bytes.get(TITLE..).and_then(|rest| rest.first_chunk()).map(|&count| u32::from_le_bytes(count));
    // Wider than a length, so that no count overflows.
    let length = count.map(|count| HEAD as u64 + TRIANGLE as u64 * u64::from(count));
    let is_exact = length == Some(bytes.len() as u64);
    let start = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start();
    let begins = start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // Some programs begin binary files as text begins. Then bytes that no text has tell them apart.
    let is_text = begins && !bytes.get(..HEAD + TRIANGLE).unwrap_or(bytes).contains(&0);
    let named = named || begins;
    match (count, length) {
        (Some(count), _) if is_exact => Some(Form::Binary(count as usize, 0)),
        _ if is_text => Some(Form::Text),
        // A program that did not know the number when it wrote the head.
        (Some(0 | u32::MAX), _) if named && bytes.len() >= HEAD + TRIANGLE && (bytes.len() - HEAD).is_multiple_of(TRIANGLE) => {
            Some(Form::Uncounted((bytes.len() - HEAD) / TRIANGLE))
        }
        (Some(count), Some(length)) if named && bytes.contains(&0) => Some(if length < bytes.len() as u64 {
            Form::Binary(count as usize, bytes.len() - length as usize)
        } else {
            Form::CutOff(count, (bytes.len() - HEAD) / TRIANGLE)
        }),
        // Shorter than a head.
        (None, _) if named && bytes.contains(&0) => Some(Form::CutOff(0, 0)),
        _ => None,
    }
}

/// Whether a file is STL; `named` says that its name ends in `.stl`.
pub(crate) fn is_stl(bytes: &[u8], named: bool) -> bool {
    form(bytes, named).is_some()
}

/// Reads the triangles of a file. The normals in the file are left out, because they follow from the corners.
///
/// # Errors
/// The error names the line, or the triangle, and its fault.
pub fn parse(bytes: &[u8]) -> Result<Stl> {
    match form(bytes, true) {
        Some(Form::Binary(count, behind)) => binary(bytes, count, behind),
        Some(Form::Uncounted(count)) => binary(bytes, count, 0).map(|mut stl| {
            stl.remarks.push(format!("the head of the file does not say how many triangles it has; {} are there", grouped(count)));
            stl
        }),
        Some(Form::CutOff(count, there)) => bail!(
            "binary STL, cut off: it has {} bytes, in which {} of {} triangles are whole; get the file again",
            grouped(bytes.len()),
            grouped(there),
            grouped(count)
        ),
        Some(Form::Text) => of_text(bytes),
        None => bail!("STL is needed, which begins with the word `solid`, or has a head of 84 bytes and 50 bytes for each triangle"),
    }
}

fn binary(bytes: &[u8], count: usize, behind: usize) -> Result<Stl> {
    let mut stl = Stl::default();
    let title = &bytes[..TITLE];
    let mut coloured = title.windows(6).any(|word| word == b"COLOR=");
    for (number, triangle) in (1..).zip(bytes[HEAD..].chunks_exact(TRIANGLE).take(count)) {
        let first = stl.soup.positions.len();
        let numbers = triangle.as_chunks::<4>().0.iter().map(|&number| f64::from(f32::from_le_bytes(number))).collect::<Vec<_>>();
        for corner in numbers[3..].as_chunks::<3>().0 {
            if corner.iter().any(|c| !c.is_finite()) {
                bail!("STL, triangle {number}: coordinates must be finite");
            }
            stl.soup.positions.push(*corner);
        }
        // The highest bit says that there is a colour.
        coloured |= triangle[TRIANGLE - 1] & 0x80 != 0;
        push(&mut stl.soup, first);
    }
    if coloured {
        stl.ignored.insert("colours of faces");
    }
    if behind > 0 {
        stl.remarks.push(format!("{} bytes behind the triangles are left out", grouped(behind)));
    }
    Ok(stl)
}

/// Adds a face of the positions from `first` on.
fn push(soup: &mut Soup, first: usize) {
    let corners = (first..soup.positions.len()).map(|position| Corner { position, ..Corner::default() }).collect();
    soup.faces.push(Face { corners, submesh: Submesh::default(), smoothing: Smoothing::ByAngle });
}

/// The words of a text with the numbers of their lines. What stands behind `solid` and `endsolid` is a name, and a line that begins with `#` or `;` is a
/// comment: neither is among them.
fn words(text: &str) -> impl Iterator<Item = (usize, String)> {
    text.lines().zip(1..).flat_map(|(line, number)| {
        // Files that were joined have marks in them.
        let mut words: Vec<String> = line.trim_start_matches('\u{FEFF}').split_whitespace().map(str::to_lowercase).collect();
        if words.first().is_some_and(|word| word.starts_with(['#', ';'])) {
            words.clear();
        }
        // Some programs write these in two words.
        if let [end, what, ..] = &mut words[..]
            && end == "end"
            && ["solid", "facet", "loop"].contains(&what.as_str())
        {
            what.insert_str(0, "end");
            words.remove(0);
        }
        if words.first().is_some_and(|word| ["solid", "endsolid"].contains(&word.as_str())) {
            // Some programs write all in one line.
            let next = words.windows(2).position(|pair| pair == ["facet", "normal"]);
            words.drain(1..next.unwrap_or(words.len()));
        }
        words.into_iter().map(move |word| (number, word))
    })
}

fn of_text(bytes: &[u8]) -> Result<Stl> {
    let mut stl = Stl::default();
    let text = text::plain(&text::decoded(bytes));
    let mut words = words(&text).peekable();
    // The line at which an open facet and an open solid begin.
    let (mut facet, mut solid) = (None, None);
    let mut first = 0;
    while let Some((line, word)) = words.next() {
        match word.as_str() {
            "solid" => solid = Some(line),
            "endsolid" if facet.is_none() => solid = None,
            "facet" if facet.is_none() => {
                facet = Some(line);
                first = stl.soup.positions.len();
                // The normal follows from the corners, so that it may be missing, or no number.
                while words.next_if(|(_, word)| !["outer", "loop", "vertex", "endfacet"].contains(&word.as_str())).is_some() {}
            }
            "outer" | "loop" | "endloop" if facet.is_some() => {}
            "vertex" if facet.is_some() => {
                let mut position = [0.0; 3];
                for (component, axis) in position.iter_mut().zip(["x", "y", "z"]) {
                    let Some((_, word)) = words.next() else { break };
                    *component = coordinate(&word, axis, line)?;
                }
                stl.soup.positions.push(position);
            }
            "endfacet" if facet.is_some() => {
                if stl.soup.positions.len() - first < 3 {
                    stl.soup.positions.truncate(first);
                    stl.faults.add(FEW_CORNERS, || format!("line {line}"));
                } else {
                    push(&mut stl.soup, first);
                }
                facet = None;
            }
            // Colours that some programs add.
            "color" | "colour" => {
                stl.ignored.insert("colours of faces");
                while words.next_if(|(_, word)| word.parse::<f64>().is_ok()).is_some() {}
            }
            _ if facet.is_none() && solid.is_none() && !stl.soup.faces.is_empty() => {
                stl.remarks.push(format!("line {line}: text behind `endsolid` is left out"));
                while words.next_if(|(_, word)| !["solid", "facet"].contains(&word.as_str())).is_some() {}
            }
            _ => bail!("STL, line {line}: {:?} is not possible here{}", short(&word), hint(facet)),
        }
    }
    if let Some(line) = facet {
        bail!("STL, triangle {}, line {line}: the file ends before its facet does; it was cut off", stl.soup.faces.len() + 1);
    }
    if solid.is_some() && !stl.soup.faces.is_empty() {
        stl.remarks.push("the file ends without `endsolid`; it may have been cut off".to_owned());
    }
    let wrong = stl.faults.count(FEW_CORNERS);
    if wrong > stl.soup.faces.len() {
        bail!("STL: {}", stl.faults.sentences().collect::<Vec<_>>().join("; "));
    }
    Ok(stl)
}

/// What may stand in a facet, or outside of one.
const fn hint(facet: Option<usize>) -> &'static str {
    match facet {
        Some(_) => "; a facet has `outer loop`, three times `vertex`, `endloop` and `endfacet`",
        None => "; a solid has `facet`, and ends with `endsolid`",
    }
}

fn coordinate(word: &str, axis: &str, line: usize) -> Result<f64> {
    match word.parse::<f64>() {
        Ok(number) if number.abs() <= LARGEST => Ok(number),
        Ok(_) => bail!("STL, line {line}: vertex: {axis} is {word}; coordinates must be finite and below {LARGEST:e}"),
        Err(_) if word.contains(',') => bail!("STL, line {line}: vertex: {axis} is {:?}; write numbers with a point, as 0.5", short(word)),
        Err(_) => bail!("STL, line {line}: vertex: {axis} is {:?}, not a number", short(word)),
    }
}

/// A word as errors quote it.
fn short(word: &str) -> String {
    crate::fields::quoted(word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str =
        "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid part\n";
    const FIRST: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    fn binary(head: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = head.to_vec();
        bytes.resize(TITLE, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[track_caller]
    fn wrong(bytes: &[u8]) -> String {
        format!("{:#}", parse(bytes).unwrap_err())
    }

    #[test]
    fn text_and_binary_are_the_same() {
        for bytes in [TEXT.as_bytes().to_vec(), binary(b"made by", &[FIRST]), binary(b"solid is how some programs begin", &[FIRST])] {
            assert!(is_stl(&bytes, false));
            let Stl { soup, faults, ignored, remarks } = parse(&bytes).unwrap();
            assert_eq!(soup.positions, FIRST.map(|p| p.map(f64::from)));
            assert_eq!((soup.faces.len(), faults.sentences().count(), ignored.len(), remarks.len()), (1, 0, 0, 0));
        }
        assert_eq!(wrong(&binary(b"", &[FIRST, [[f32::NAN; 3]; 3]])), "STL, triangle 2: coordinates must be finite");
        assert!(wrong(TEXT.replace("vertex 0 1 0\nendloop\nendfacet\nendsolid part\n", "").as_bytes()).contains("triangle 1"));
    }

    /// Text is read as programs write it: in capitals, without or with any name, with several solids, in one line.
    #[test]
    fn text_may_be_written_in_many_ways() {
        let one_line = TEXT.replace('\n', " ");
        let ways = [
            TEXT.replace("solid part", "solid"),
            TEXT.replace("solid part", "solid\tpart"),
            TEXT.replace("solid part", "Solid Unity Mesh"),
            TEXT.replace("solid part", "solid facet of a vertex # 1\0").replace('\0', ""),
            TEXT.replace("solid part", "solid Gehäuse"),
            TEXT.to_uppercase(),
            TEXT.replace("end", "end "),
            format!("\u{FEFF}\n  {TEXT}"),
            TEXT.replace('\n', "\r\n\t"),
            TEXT.replace('\n', "\r"),
            TEXT.replace("normal 0 0 1", "normal nan -nan(ind) 1.#QNAN"),
            TEXT.replace("normal 0 0 1", "normal"),
            TEXT.replace("facet normal", "# a comment\n  facet normal"),
            one_line.replace("endsolid part", "endsolid"),
        ];
        for text in ways {
            for bytes in [text.clone().into_bytes(), format!("{text}\n{text}").into_bytes()] {
                let twice = bytes.len() > text.len();
                assert!(is_stl(&bytes, false), "{text:?}");
                // What stands behind a name in one line is part of the name.
                if twice && text.contains("endsolid ") && !text.contains('\n') {
                    continue;
                }
                let stl = parse(&bytes).unwrap();
                assert_eq!(stl.soup.faces.len(), if twice { 2 } else { 1 }, "{text:?}");
                assert!(stl.remarks.is_empty() && stl.faults.sentences().next().is_none(), "{text:?}: {:?}", stl.remarks);
            }
        }
        // Bytes of another encoding are part of a name.
        assert_eq!(parse(&[b"solid Geh\xE4use\n", TEXT.as_bytes()].concat()).unwrap().soup.faces.len(), 1);
        let square = TEXT.replace("endloop", "vertex -1 0 0\nendloop");
        assert_eq!(parse(square.as_bytes()).unwrap().soup.faces[0].corners.len(), 4);
        let coloured = TEXT.replace("outer", "color 0.5 0.5 1\nouter");
        assert!(parse(coloured.as_bytes()).is_ok_and(|stl| stl.soup.faces.len() == 1));
    }

    #[test]
    fn bytes_behind_the_triangles_are_told_and_missing_ones_are_an_error() {
        let whole = binary(b"solid", &[FIRST, FIRST]);
        let longer = [&whole[..], &[b'x'; 92]].concat();
        let stl = parse(&longer).unwrap();
        assert_eq!((stl.soup.faces.len(), &stl.remarks[..]), (2, &["92 bytes behind the triangles are left out".to_owned()][..]));
        // Only the name tells such a file from others.
        let mut untitled = longer;
        untitled[..5].fill(b' ');
        assert!(is_stl(&untitled, true) && !is_stl(&untitled, false) && !is_stl(TEXT.replace("solid", "shell").as_bytes(), true));
        let cut = "binary STL, cut off: it has 183 bytes, in which 1 of 2 triangles are whole; get the file again";
        assert_eq!(wrong(&whole[..whole.len() - 1]), cut);
        assert!(wrong(&whole[..HEAD]).contains("in which 0 of 2 triangles"));
        for unknown in [0, u32::MAX] {
            let mut uncounted = whole.clone();
            uncounted[TITLE..HEAD].copy_from_slice(&unknown.to_le_bytes());
            let stl = parse(&uncounted).unwrap();
            let said = "the head of the file does not say how many triangles it has; 2 are there".to_owned();
            assert_eq!((stl.soup.faces.len(), stl.remarks), (2, vec![said]));
        }
        let mut coloured = whole;
        coloured[HEAD + TRIANGLE - 1] = 0x80;
        assert!(parse(&coloured).unwrap().ignored.contains("colours of faces"));
        coloured[HEAD + 12..HEAD + 16].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert_eq!(wrong(&coloured), "STL, triangle 1: coordinates must be finite");
        coloured[HEAD + 12..HEAD + 16].fill(0);
        coloured[HEAD..HEAD + 12].copy_from_slice([f32::NAN.to_le_bytes(); 3].as_flattened());
        assert_eq!(parse(&coloured).unwrap().soup.faces.len(), 2);
    }

    #[test]
    fn errors_name_the_line() {
        for (text, error) in [
            (TEXT.replace("vertex 1 0 0", "vertex 1 nan 0"), "STL, line 5: vertex: y is nan; coordinates must be finite and below 1e100"),
            (TEXT.replace("vertex 1 0 0", "vertex 1,5 0 0"), "STL, line 5: vertex: x is \"1,5\"; write numbers with a point, as 0.5"),
            (TEXT.replace("vertex 1 0 0", "vertex 1 0"), "STL, line 5: vertex: z is \"vertex\", not a number"),
            (
                TEXT.replace("vertex 1 0 0", "corner 1 0 0"),
                "STL, line 5: \"corner\" is not possible here; a facet has `outer loop`, three times `vertex`, `endloop` and `endfacet`",
            ),
            (
                TEXT.replace("facet normal", "triangle"),
                "STL, line 2: \"triangle\" is not possible here; a solid has `facet`, and ends with `endsolid`",
            ),
            (
                TEXT.split_once("endfacet").unwrap().0.to_owned(),
                "STL, triangle 1, line 2: the file ends before its facet does; it was cut off",
            ),
            (TEXT.replace("vertex 1 0 0\n", ""), "STL: 1 face has fewer than three corners and is left out: line 7"),
        ] {
            assert_eq!(wrong(text.as_bytes()), error);
        }
        let few = format!("{TEXT}{}", TEXT.replace("vertex 1 0 0\n", ""));
        let stl = parse(few.as_bytes()).unwrap();
        assert_eq!((stl.soup.faces.len(), stl.soup.positions.len(), stl.faults.count(FEW_CORNERS)), (1, 3, 1));
        let behind = parse(format!("{TEXT}made by hand\n{TEXT}\0\0\u{1A}").as_bytes()).unwrap();
        assert_eq!((behind.soup.faces.len(), &behind.remarks[..]), (2, &["line 10: text behind `endsolid` is left out".to_owned()][..]));
        let open = parse(TEXT.replace("endsolid part", "").as_bytes()).unwrap();
        assert_eq!(open.remarks, ["the file ends without `endsolid`; it may have been cut off"]);
    }

    proptest! {
        #[test]
        fn any_bytes_may_come(bytes in prop::collection::vec(any::<u8>(), 0..400), words in "(solid|facet|normal|outer|loop|vertex|endloop|endfacet|[0-9e.-]{1,5}|[ \n]){0,60}") {
            // An error is as good as a mesh.
            let _ = parse(&bytes);
            let _ = parse(format!("solid {words}").as_bytes());
        }
    }
}
