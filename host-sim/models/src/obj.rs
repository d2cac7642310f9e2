//! Reads Wavefront OBJ: positions, normals, faces, smoothing groups, and which material each face has; tells what else there is.
//!
//! A reader of our own, because a bad number or index should be reported with its line.

use crate::{
    faults::{FEW_CORNERS, Faults, UNUSED_NORMAL, UNUSED_POSITION},
    fields::quoted,
    mesh::{Corner, Face, Smoothing, Soup, Submesh},
    number::grouped,
    text::{keyword, logical_lines, plain, rest, without_comment, without_comments},
};
use anyhow::{Context, Error, Result, bail};
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
    /// Wrong elements that are left out.
    pub faults: Faults,
    /// What else the user should know, in sentences.
    pub remarks: Vec<String>,
}

/// Statements that OBJ has, and that change nothing here.
const WITHOUT_EFFECT: [&str; 28] = [
    "mg",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "usemap",
    "maplib",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "deg",
    "bmat",
    "step",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "call",
    "csh",
    "bsp",
    "bzp",
    "cdc",
    "cdp",
    "res",
];

/// Vectors of a file, of which some may be wrong. These matter only if a face uses them.
#[derive(Default)]
struct Vectors {
    wrong: Vec<(usize, usize, Error)>,
}

impl Vectors {
    /// Adds a vector, or zero in the place of a wrong one.
    fn push(&mut self, vectors: &mut Vec<[f64; 3]>, vector: Result<[f64; 3]>, line: usize) {
        let vector = vector.unwrap_or_else(|error| {
            self.wrong.push((vectors.len(), line, error));
            [0.0; 3]
        });
        vectors.push(vector);
    }
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
    // The number of each material by its name: a file may have as many materials as faces.
    let mut known = HashMap::new();
    let mut naming = Naming::default();
    let (mut positions, mut normals) = (Vectors::default(), Vectors::default());
    // The first wrong element of any kind, and the first face of too few corners.
    let (mut first, mut first_face) = (None, None);
    let (mut unknown, mut first_unknown) = (0usize, None);
    let mut colours = Vec::new();
    for (number, line) in logical_lines(&plain(text)) {
        let words = || line.split_whitespace().skip(1);
        let soup = &mut obj.soup;
        match keyword(&line).as_str() {
            "v" => {
                positions.push(&mut soup.positions, vector(words()).with_context(|| format!("line {number}: vertex")), number);
                colours.push(colour(words().skip(3)));
            }
            "vn" => normals.push(&mut soup.normals, vector(words()).with_context(|| format!("line {number}: normal")), number),
            "f" => {
                let corners = corners(words(), soup).with_context(|| format!("line {number}: face"))?;
                if corners.len() < 3 {
                    let error = || format!("line {number}: face: {} corners; three at least are needed", corners.len());
                    first_face.get_or_insert_with(error);
                    first.get_or_insert_with(|| (number, error()));
                    obj.faults.add(FEW_CORNERS, || format!("line {number}"));
                    continue;
                }
                let material = match known.get(&name) {
                    Some(&known) => known,
                    None => {
                        known.insert(name.clone(), obj.materials.len());
                        obj.materials.push(name.clone());
                        obj.materials.len() - 1
                    }
                };
                naming.face();
                soup.faces.push(Face { corners, submesh: Submesh { object: 0, material, is_back: false }, smoothing });
                lines.push(number);
            }
            // Names may have blanks in them.
            "usemtl" => name = Some(rest(&line)).filter(|name| !name.is_empty()),
            "mtllib" => obj.libraries.push(without_comment(&rest(&line)).to_owned()),
            "s" => smoothing = group(words().next()).with_context(|| format!("line {number}: smoothing group"))?,
            // A place that is wrong is on no texture.
            "vt" => soup.places.push(place(words())),
            "l" | "p" => drop(obj.ignored.insert("lines and points")),
            "vp" | "curv" | "curv2" | "surf" | "cstype" => drop(obj.ignored.insert("curves and free-form surfaces")),
            "o" => naming.object(without_comment(&rest(&line)).to_owned()),
            "g" => naming.group(without_comment(&rest(&line)).to_owned()),
            word if word.is_empty() || WITHOUT_EFFECT.contains(&word) => {}
            word => {
                unknown += 1;
                first_unknown.get_or_insert_with(|| format!("`{}` in line {number}", quoted(word)));
            }
        }
    }
    for (_, line, error) in positions.wrong.iter().chain(&normals.wrong) {
        if first.as_ref().is_none_or(|(first, _)| line < first) {
            first = Some((*line, format!("{error:#}")));
        }
    }
    // Nothing is left but what is wrong.
    if let Some((_, error)) = first.filter(|_| obj.soup.faces.is_empty()) {
        bail!(error);
    }
    if let Some(error) = first_face.filter(|_| obj.faults.count(FEW_CORNERS) > obj.soup.faces.len()) {
        bail!(
            "{error}; {} faces of {} are like it",
            grouped(obj.faults.count(FEW_CORNERS)),
            grouped(lines.len() + obj.faults.count(FEW_CORNERS))
        );
    }
    if let Some(first) = first_unknown {
        obj.remarks.push(match unknown {
            1 => format!("1 line that is no statement of OBJ is left out: {first}"),
            several => format!("{} lines that are no statements of OBJ are left out; the first: {first}", grouped(several)),
        });
    }
    // All or none: a vertex without a colour would be of another kind. Numbers above 1 tell that 255 is full.
    if colours.iter().all(Option::is_some) {
        let full = if colours.iter().flatten().flatten().any(|&c| c > 1.0) { 255.0 } else { 1.0 };
        obj.soup.colours = colours.into_iter().flatten().map(|colour| colour.map(|c| c / full)).collect();
    }
    let (with_colours, places) = (!obj.soup.colours.is_empty(), obj.soup.places.len());
    for corner in obj.soup.faces.iter_mut().flat_map(|face| &mut face.corners) {
        corner.colour = with_colours.then_some(corner.position);
        corner.place = corner.place.filter(|&place| place < places);
    }
    let used = used(&obj.soup, &lines)?;
    for (index, line, error) in positions.wrong {
        if used.positions[index] {
            return Err(error);
        }
        obj.faults.add(UNUSED_POSITION, || format!("line {line}"));
    }
    // One without a direction stands for a normal that is used, and another is computed.
    for (_, line, _) in normals.wrong.iter().filter(|(index, ..)| !used.normals[*index]) {
        obj.faults.add(UNUSED_NORMAL, || format!("line {line}"));
    }
    let of_faces;
    (obj.objects, of_faces) = naming.objects();
    obj.soup.faces.iter_mut().zip(of_faces).for_each(|(face, object)| face.submesh.object = object);
    obj.merge_comments();
    Ok(obj)
}

impl Obj {
    /// Makes one material of those whose names differ only by a comment.
    fn merge_comments(&mut self) {
        let named: Vec<&str> = self.materials.iter().flatten().map(String::as_str).collect();
        let mut names = without_comments(&named).into_iter();
        let names: Vec<_> = self.materials.iter().map(|name| name.as_ref().and_then(|_| names.next())).collect();
        let mut merged: Vec<Option<String>> = Vec::new();
        let mut known = HashMap::new();
        let numbers: Vec<usize> = names
            .into_iter()
            .map(|name| {
                *known.entry(name.clone()).or_insert_with(|| {
                    merged.push(name);
                    merged.len() - 1
                })
            })
            .collect();
        self.soup.faces.iter_mut().for_each(|face| face.submesh.material = numbers[face.submesh.material]);
        self.materials = merged;
    }
}

/// Whether a face uses each of the positions and normals.
struct Used {
    positions: Vec<bool>,
    normals: Vec<bool>,
}

/// Checks indices of faces, which stand in these lines.
fn used(soup: &Soup, lines: &[usize]) -> Result<Used> {
    let (positions, normals) = (soup.positions.len(), soup.normals.len());
    let mut used = Used { positions: vec![false; positions], normals: vec![false; normals] };
    for (face, line) in soup.faces.iter().zip(lines) {
        for corner in &face.corners {
            match used.positions.get_mut(corner.position) {
                Some(used) => *used = true,
                None => bail!("line {line}: face: vertex {} is out of range; the file has {positions}", corner.position + 1),
            }
            match corner.normal.map(|normal| (normal, used.normals.get_mut(normal))) {
                Some((_, Some(used))) => *used = true,
                Some((normal, None)) => bail!("line {line}: face: normal {} is out of range; the file has {normals}", normal + 1),
                None => {}
            }
        }
    }
    Ok(used)
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

/// The number of a smoothing group; 0 and `off` are none.
fn group(word: Option<&str>) -> Result<Smoothing> {
    let word = word.context("a number is missing, or off")?;
    match word.to_ascii_lowercase().as_str() {
        "off" | "0" => Ok(Smoothing::Flat),
        "on" => Ok(Smoothing::Group(1)),
        _ => Ok(Smoothing::Group(word.parse().ok().with_context(|| format!("{:?} is neither a whole number nor off", quoted(word)))?)),
    }
}

fn vector<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f64; 3]> {
    let mut vector = [0.0; 3];
    for (component, axis) in vector.iter_mut().zip(["x", "y", "z"]) {
        let word = words.next().with_context(|| format!("{axis} is missing; three numbers are needed"))?;
        let hint = if word.contains(',') { "; write numbers with a point, as 0.5" } else { "" };
        let number: f64 = word.parse().ok().with_context(|| format!("{axis} is {:?}, not a number{hint}", quoted(word)))?;
        *component = number;
        if !number.is_finite() || number.abs() > LARGEST {
            bail!("{axis} is {}; coordinates must be finite and below {LARGEST:e}", quoted(word));
        }
    }
    Ok(vector)
}

/// The three numbers of a colour behind the coordinates of a vertex.
fn colour<'a>(words: impl Iterator<Item = &'a str>) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>().ok()?;
    let colour: [f64; 3] = numbers.try_into().ok()?;
    colour.iter().all(|c| (0.0..=255.0).contains(c)).then_some(colour)
}

/// A place on a texture.
fn place<'a>(words: impl Iterator<Item = &'a str>) -> [f64; 2] {
    let mut numbers = words.map(|word| word.parse().ok().filter(|number: &f64| number.is_finite()).unwrap_or_default());
    [numbers.next().unwrap_or_default(), numbers.next().unwrap_or_default()]
}

fn corners<'a>(words: impl Iterator<Item = &'a str>, soup: &Soup) -> Result<Vec<Corner>> {
    words.map(|word| corner(word, soup)).collect()
}

/// `position`, `position/texture`, `position/texture/normal` or `position//normal`.
fn corner(word: &str, soup: &Soup) -> Result<Corner> {
    let mut parts = word.split('/');
    let position = index(parts.next().unwrap_or_default(), soup.positions.len(), "vertex")?;
    let mut part = || parts.next().filter(|part| !part.is_empty());
    // A place that is wrong is on no texture.
    let place = part().and_then(|place| index(place, soup.places.len(), "place").ok());
    let normal = part().map(|normal| index(normal, soup.normals.len(), "normal")).transpose()?;
    Ok(Corner { position, normal, colour: None, place })
}

/// Indices count from 1; negative ones count back from the last one so far.
fn index(word: &str, count: usize, what: &str) -> Result<usize> {
    let number: i64 = word.parse().ok().with_context(|| format!("{what} index {:?} is not a whole number", quoted(word)))?;
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
        assert_eq!(obj.ignored.into_iter().collect::<Vec<_>>(), ["lines and points"]);
        assert_eq!(obj.soup.places, [[0.0; 2]]);
    }

    /// Wrong elements that no face needs are left out, and so are a few faces without three corners.
    #[test]
    fn wrong_elements_that_do_not_matter_are_counted() {
        let good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
        let said = |text: &str| {
            let obj = parse(text).unwrap();
            assert_eq!(obj.soup.faces.len(), 1, "{text:?}");
            obj.faults.sentences().chain(obj.remarks).collect::<Vec<_>>()
        };
        assert!(said(good).is_empty());
        for (more, kind) in
            [("v nan 0 0", "vertex"), ("v 1", "vertex"), ("v 1.#QNAN 0 0", "vertex"), ("vn x y z", "normal"), ("vn 1 1.#INF 0", "normal")]
        {
            let expected = format!("1 {kind} is not three finite numbers and is left out, because no face uses it: line 6");
            assert_eq!(said(&format!("{good}{more}\n")), [expected], "{more}");
        }
        assert_eq!(said(&format!("{good}f 1 2\n")), ["1 face has fewer than three corners and is left out: line 6"]);
        assert!(
            said(&format!("{good}#!x\nbevel on\nCSTYLE\nxyz 1\n"))[0]
                .ends_with("no statements of OBJ are left out; the first: `cstyle` in line 8")
        );
        // A face with such a normal gets one that is computed.
        let obj = parse(&good.replace("vn 0 0 1", "vn 0 0 nan")).unwrap();
        assert!(obj.soup.normals == [[0.0; 3]] && obj.faults.sentences().next().is_none());
        for (text, error) in [
            (good.replace("v 1 0 0", "v 1 0 1.#QNAN0"), "line 2: vertex: z is \"1.#QNAN0\", not a number"),
            (good.replace("v 1 0 0", "v 1 0 inf"), "line 2: vertex: z is inf; coordinates must be finite and below 1e100"),
            (good.replace("v 1 0 0", "v 1,5 0 0"), "line 2: vertex: x is \"1,5\", not a number; write numbers with a point, as 0.5"),
            (format!("{good}f 1\nf 2 3\n"), "line 6: face: 1 corners; three at least are needed; 2 faces of 3 are like it"),
            (format!("{good}v 0 0 nan\nf 1 2 4\n"), "line 6: vertex: z is nan; coordinates must be finite and below 1e100"),
        ] {
            assert_eq!(format!("{:#}", parse(&text).unwrap_err()), error, "{text:?}");
        }
    }

    #[test]
    fn statements_may_be_in_capitals_and_names_have_number_signs() {
        let triangle = "F 1 2 3\n";
        let text = format!(
            "MTLLIB a#1.mtl # here\nV 0 0 0\nV 1 0 0\nV 0 1 0\nUseMtl Material__#25\nS OFF\n{triangle}usemtl Material #112\n{triangle}usemtl Material__#25 # again\n{triangle}o Part #3\n{triangle}"
        );
        let obj = parse(&text).unwrap();
        assert_eq!((&obj.libraries[..], obj.objects.len()), (&["a#1.mtl".to_owned()][..], 2));
        assert_eq!(obj.objects[1], "Part #3");
        assert_eq!(obj.materials, [Some("Material__#25".to_owned()), Some("Material #112".to_owned())]);
        assert_eq!(obj.soup.faces.iter().map(|face| face.submesh.material).collect::<Vec<_>>(), [0, 1, 0, 0]);
        assert!(obj.soup.faces.iter().all(|face| face.smoothing == Smoothing::Flat) && obj.remarks.is_empty());
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
