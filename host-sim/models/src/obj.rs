//! Reads Wavefront OBJ: positions, normals, faces, smoothing groups, and which material each face has; tells what else there is.
//!
//! A reader of our own, because a bad number or index should be reported with its line.

use crate::mesh::{Corner, Face, Smoothing, Soup, Submesh};
use anyhow::{Context, Result, bail};
use std::collections::{BTreeSet, HashMap};

/// Larger coordinates would overflow when squared.
pub(crate) const LARGEST: f64 = 1e100;

/// The contents of an OBJ file.
#[derive(Clone, Debug, Default)]
pub struct Obj {
    /// The polygons of the file.
    pub soup: Soup,
    /// The names of objects by which [`Submesh::object`] counts; a name is empty where the file gives none.
    pub objects: Vec<String>,
    /// Names of materials, which [`Submesh::material`] refers to. `None` is the material of faces before the first name.
    pub materials: Vec<Option<String>>,
    /// Files that say what the materials are.
    pub libraries: Vec<String>,
    /// Contents that are left out, in words.
    pub ignored: BTreeSet<&'static str>,
}

/// Parses the text of an OBJ file. Lines end in LF, CR or both. A byte order mark is skipped.
///
/// # Errors
/// The error names the line and its fault.
pub fn parse(text: &str) -> Result<Obj> {
    let mut obj = Obj::default();
    // Faces may name vertices that follow: indices are checked at the end, by line.
    let mut lines = Vec::new();
    let (mut name, mut smoothing) = (None, Smoothing::ByAngle);
    let mut naming = Naming::default();
    for (number, line) in logical_lines(&plain(text)) {
        let mut words = line.split_whitespace();
        let soup = &mut obj.soup;
        match words.next() {
            Some("v") => soup.positions.push(vector(words).with_context(|| format!("line {number}: vertex"))?),
            Some("vn") => soup.normals.push(vector(words).with_context(|| format!("line {number}: normal"))?),
            Some("f") => {
                let corners = corners(words, soup).with_context(|| format!("line {number}: face"))?;
                let known = obj.materials.iter().position(|material| *material == name);
                let material = known.unwrap_or(obj.materials.len());
                if known.is_none() {
                    obj.materials.push(name.clone());
                }
                naming.face();
                soup.faces.push(Face { corners, submesh: Submesh { object: 0, material }, smoothing });
                lines.push(number);
            }
            // Names may have blanks in them.
            Some("usemtl") => name = Some(rest(&line)).filter(|name| !name.is_empty()),
            Some("mtllib") => obj.libraries.push(rest(&line)),
            Some("s") => smoothing = group(words.next()).with_context(|| format!("line {number}: smoothing group"))?,
            Some("vt") => drop(obj.ignored.insert("texture coordinates")),
            Some("l" | "p") => drop(obj.ignored.insert("lines and points")),
            Some("vp" | "curv" | "curv2" | "surf" | "cstype") => drop(obj.ignored.insert("curves and free-form surfaces")),
            Some("o") => naming.object(rest(&line)),
            Some("g") => naming.group(rest(&line)),
            _ => {}
        }
    }
    let soup = &obj.soup;
    let (positions, normals) = (soup.positions.len(), soup.normals.len());
    for (face, line) in soup.faces.iter().zip(lines) {
        for corner in &face.corners {
            if corner.position >= positions {
                bail!("line {line}: face: vertex {} is out of range; the file has {positions}", corner.position + 1);
            }
            if let Some(normal) = corner.normal.filter(|&n| n >= normals) {
                bail!("line {line}: face: normal {} is out of range; the file has {normals}", normal + 1);
            }
        }
    }
    let of_faces;
    (obj.objects, of_faces) = naming.objects();
    obj.soup.faces.iter_mut().zip(of_faces).for_each(|(face, object)| face.submesh.object = object);
    Ok(obj)
}

/// The objects and groups of a file, and which of them each face is in.
struct Naming {
    objects: Vec<String>,
    groups: Vec<String>,
    /// The number of each group by its name.
    known: HashMap<String, usize>,
    group: usize,
    /// Object and group of each face.
    faces: Vec<[usize; 2]>,
}

impl Default for Naming {
    /// Faces may come before any name.
    fn default() -> Self {
        let unnamed = || vec![String::new()];
        Self { objects: unnamed(), groups: unnamed(), known: HashMap::from([(String::new(), 0)]), group: 0, faces: Vec::new() }
    }
}

impl Naming {
    /// Each statement begins another object.
    fn object(&mut self, name: String) {
        self.objects.push(name);
    }

    /// A group may be continued by its name.
    fn group(&mut self, name: String) {
        self.group = *self.known.entry(name.clone()).or_insert(self.groups.len());
        if self.group == self.groups.len() {
            self.groups.push(name);
        }
    }

    fn face(&mut self) {
        self.faces.push([self.objects.len() - 1, self.group]);
    }

    /// The names of objects, and the number of each face's object. Where all faces are in one object, they are told apart by groups.
    fn objects(self) -> (Vec<String>, Vec<usize>) {
        let differs = |k: usize| self.faces.windows(2).any(|pair| pair[0][k] != pair[1][k]);
        let has_name = |names: &[String], k: usize| self.faces.first().is_some_and(|face| !names[face[k]].is_empty());
        let by_group = !differs(0) && (differs(1) || !has_name(&self.objects, 0));
        let (names, k) = if by_group { (self.groups, 1) } else { (self.objects, 0) };
        // In the order of the first faces; what has no face is no object.
        let (mut order, mut numbers) = (Vec::new(), HashMap::new());
        let faces = self.faces.iter().map(|face| {
            *numbers.entry(face[k]).or_insert_with(|| {
                order.push(names[face[k]].clone());
                order.len() - 1
            })
        });
        let faces = faces.collect();
        (order, faces)
    }
}

/// The text with LF at the ends of its lines, and no byte order mark.
pub(crate) fn plain(text: &str) -> String {
    text.strip_prefix('\u{FEFF}').unwrap_or(text).replace("\r\n", "\n").replace('\r', "\n")
}

/// The part of a line after its first word.
pub(crate) fn rest(line: &str) -> String {
    line.trim().split_once(char::is_whitespace).map_or("", |(_, rest)| rest.trim()).to_owned()
}

/// The number of a smoothing group; 0 and `off` are none.
fn group(word: Option<&str>) -> Result<Smoothing> {
    let word = word.context("a number is missing, or off")?;
    match word {
        "off" | "0" => Ok(Smoothing::Flat),
        "on" => Ok(Smoothing::Group(1)),
        _ => Ok(Smoothing::Group(word.parse().ok().with_context(|| format!("{word:?} is neither a whole number nor off"))?)),
    }
}

/// Lines without comments, with their numbers; a backslash at the end joins the next line.
pub(crate) fn logical_lines(text: &str) -> impl Iterator<Item = (usize, String)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (index, first) = lines.next()?;
        let mut line = strip(first).to_owned();
        while line.ends_with('\\') {
            line.pop();
            line.push(' ');
            line.push_str(lines.next().map_or("", |(_, next)| strip(next)));
        }
        Some((index + 1, line))
    })
}

fn strip(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim_end()
}

fn vector<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f64; 3]> {
    let mut vector = [0.0; 3];
    for (component, axis) in vector.iter_mut().zip(["x", "y", "z"]) {
        let word = words.next().with_context(|| format!("{axis} is missing; three numbers are needed"))?;
        let number: f64 = word.parse().ok().with_context(|| format!("{axis} is {word:?}, not a number"))?;
        *component = number;
        if !number.is_finite() || number.abs() > LARGEST {
            bail!("{axis} is {word}; coordinates must be finite and below {LARGEST:e}");
        }
    }
    Ok(vector)
}

fn corners<'a>(words: impl Iterator<Item = &'a str>, soup: &Soup) -> Result<Vec<Corner>> {
    let corners = words.map(|word| corner(word, soup)).collect::<Result<Vec<_>>>()?;
    if corners.len() < 3 {
        bail!("{} corners; three at least are needed", corners.len());
    }
    Ok(corners)
}

/// `position`, `position/texture`, `position/texture/normal` or `position//normal`.
fn corner(word: &str, soup: &Soup) -> Result<Corner> {
    let mut parts = word.split('/');
    let position = index(parts.next().unwrap_or_default(), soup.positions.len(), "vertex")?;
    let normal = parts.nth(1).filter(|n| !n.is_empty()).map(|n| index(n, soup.normals.len(), "normal")).transpose()?;
    Ok(Corner { position, normal })
}

/// Indices count from 1; negative ones count back from the last one so far.
fn index(word: &str, count: usize, what: &str) -> Result<usize> {
    let number: i64 = word.parse().ok().with_context(|| format!("{what} index {word:?} is not a whole number"))?;
    let index = if number > 0 { number - 1 } else { number + count as i64 };
    if number == 0 || index < 0 {
        bail!("{what} {number} is out of range; indices count from 1, and there are {count} so far");
    }
    Ok(index as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        mesh::{self, Weld},
        quantise::quantise,
    };
    use proptest::prelude::*;

    #[test]
    fn polygons_negative_indices_and_continued_lines() {
        let soup = parse("v 0 0 0\nv 1 0 0 # comment\nv 1 1 0\nv 0 1 0\nvn 0 0 2\nf -4//1 -3//1 \\\n -2//1 4//1\n").unwrap().soup;
        assert_eq!(soup.faces.len(), 1);
        assert_eq!(soup.faces[0].corners.iter().map(|c| c.position).collect::<Vec<_>>(), [0, 1, 2, 3]);
        assert!(soup.faces[0].corners.iter().all(|c| c.normal == Some(0)));
    }

    #[test]
    fn every_end_of_line_and_a_byte_order_mark() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 \\\n3\nf 1 2 4\n";
        for end in ["\n", "\r\n", "\r"] {
            let text = format!("\u{FEFF}{}", text.replace('\n', end));
            assert_eq!(format!("{:#}", parse(&text).unwrap_err()), "line 7: face: vertex 4 is out of range; the file has 3", "{end:?}");
            assert_eq!(parse(text.strip_suffix(&format!("f 1 2 4{end}")).unwrap()).unwrap().soup.positions.len(), 3, "{end:?}");
        }
    }

    #[test]
    fn faces_have_materials_and_smoothing_groups() {
        let triangle = "f 1 2 3\n";
        let text = format!(
            "mtllib two words.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n{triangle}usemtl red paint # dry\ns 2\n{triangle}usemtl b\ns off\n{triangle}usemtl red paint\n{triangle}l 1 2\n"
        );
        let obj = parse(&text).unwrap();
        assert_eq!(obj.libraries, ["two words.mtl"]);
        assert_eq!(obj.materials, [None, Some("red paint".to_owned()), Some("b".to_owned())]);
        let faces: Vec<_> = obj.soup.faces.iter().map(|face| (face.submesh.material, face.smoothing)).collect();
        assert_eq!(faces, [(0, Smoothing::ByAngle), (1, Smoothing::Group(2)), (2, Smoothing::Flat), (1, Smoothing::Flat)]);
        assert_eq!(obj.ignored.into_iter().collect::<Vec<_>>(), ["lines and points", "texture coordinates"]);
    }

    #[test]
    fn errors_name_the_line() {
        for (text, line) in [
            ("v 0 0 0\nv nan 0 0\n", "line 2"),
            ("v 0 0 0\nf 1 1 2\n", "line 2"),
            ("v 0 0\n", "line 1"),
            ("\nf 1 2\n", "line 2"),
            ("v 1 2 3\nf 0 1 1", "line 2"),
            ("v 1 2 3\nf 1//1 1//1 1//2", "line 2"),
            ("v 1e200 2 3", "line 1"),
            ("v 1 2 3\nv 0 -1e999 0", "line 2"),
            ("v 1 2 3\r\rvn 0 -inf 0", "line 3"),
            ("v 1 2 3\ns -1", "line 2"),
            ("s\n", "line 1"),
        ] {
            let error = format!("{:#}", parse(text).unwrap_err());
            assert!(error.contains(line), "{text:?}: {error}");
        }
    }

    /// Words that mean something, and some that might be taken for them.
    fn word() -> impl Strategy<Value = String> {
        let number = prop_oneof![
            (-3i64..8).prop_map(|n| n.to_string()),
            any::<f64>().prop_map(|n| n.to_string()),
            any::<i64>().prop_map(|n| n.to_string()),
            (-1.0..1.0).prop_map(|n| format!("{n:e}")),
        ];
        let known = prop::sample::select(vec![
            "v", "vn", "f", "s", "o", "g", "usemtl", "off", "#", "\\", "nan", "1e-200", "1//1", "-1/2/-3", "2//", "/", "\u{FEFF}", "é",
        ]);
        prop_oneof![3 => number, 1 => known.prop_map(str::to_owned)]
    }

    /// Lines that are mostly well formed, so that meshes of them come to be welded.
    fn line() -> impl Strategy<Value = String> {
        let words = |count| prop::collection::vec(word(), count).prop_map(|words| words.join(" "));
        let vertex = || prop::array::uniform3(-9i32..9).prop_map(|[x, y, z]| format!("{x} {y} {z}"));
        let index = prop_oneof![3 => 1i64..9, 1 => -8i64..0];
        let face = prop::collection::vec(index, 3..9).prop_map(|face| face.iter().map(i64::to_string).collect::<Vec<_>>().join(" "));
        prop_oneof![
            40 => vertex().prop_map(|vertex| format!("v {vertex}")),
            4 => vertex().prop_map(|normal| format!("vn {normal}")),
            12 => face.prop_map(|face| format!("f {face}")),
            1 => (prop::sample::select(vec!["o", "g"]), words(0..2)).prop_map(|(what, name)| format!("{what} {name}")),
            1 => words(0..6),
        ]
    }

    proptest! {
        /// Whatever is in a file, it is a mesh of finite numbers, or an error.
        #[test]
        fn no_text_is_too_much(lines in prop::collection::vec(line(), 0..40), end in prop::sample::select(vec!["\n", "\r\n", "\r"])) {
            let parsed = parse(&lines.join(end));
            if let Ok(obj) = &parsed {
                prop_assert!(obj.soup.faces.iter().all(|face| face.submesh.object < obj.objects.len()));
            }
            if let Ok((mesh, _)) = parsed.and_then(|obj| mesh::weld(&obj.soup, Weld::default())) {
                prop_assert!(mesh.positions.iter().chain(&mesh.normals).flatten().all(|c| c.abs() < 1.0 + 1e-9));
                prop_assert!(mesh.triangles.iter().flatten().all(|&v| v < mesh.positions.len()));
                let (parts, dropped) = quantise(&mesh);
                prop_assert_eq!(parts.iter().map(|part| part.triangles.len()).sum::<usize>() + dropped, mesh.triangles.len());
            }
        }

        #[test]
        fn any_characters_may_come(text in any::<String>(), words in prop::collection::vec(word(), 0..60)) {
            // An error is as good as a mesh.
            let _ = parse(&text);
            let _ = parse(&words.join(" ").replace("# ", "\n"));
        }
    }
}
