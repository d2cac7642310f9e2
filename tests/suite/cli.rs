//! Wrong input of every kind: the message names the file and the place, the exit code says whose fault it is, nothing is left behind.

use embedded_graphics::geometry::Size;
use microphong::{Stream, StreamError, renderer::check, stream};
use microphong_sim::{
    board::Board,
    bytes::StreamBytes,
    convert::{Converted, Options},
    levels,
    program::{self, Features},
    render::{self, Format, Settings, Style},
    scene,
    shader::Shader,
    verify,
};
use microphong_tests::{only_announces, program};
use std::{
    fs,
    io::Write as _,
    path::Path,
    process::{Command, Output, Stdio},
    thread,
    time::Duration,
};
use tempfile::TempDir;

/// A scratch directory in which the command runs.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("scratch directory"))
    }

    fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> &Self {
        fs::write(self.0.path().join(name), contents).expect("scratch file");
        self
    }

    fn run(&self, arguments: &[&str]) -> Output {
        Command::new(program()).args(arguments).current_dir(self.0.path()).output().expect("the program")
    }

    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("scratch directory");
        let mut names: Vec<_> = entries.map(|e| e.expect("entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs the command, which must fail with `code`, say each of `words` on stderr, and leave the directory as it was.
    #[track_caller]
    fn fails(&self, arguments: &[&str], code: i32, words: &[&str]) {
        let before = self.files();
        let output = self.run(arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
        assert!(!stderr.contains("panicked"), "{arguments:?}: {stderr}");
        assert!(stderr.len() < 4_000, "{arguments:?}: {} bytes", stderr.len());
        for word in words {
            assert!(stderr.contains(word), "{arguments:?}: {word:?} is not in {stderr:?}");
        }
        assert!(output.stdout.is_empty(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stdout));
        assert_eq!(self.files(), before, "{arguments:?}");
    }

    /// Runs the command, which must succeed, and returns its stdout.
    #[track_caller]
    fn succeeds(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {stderr}");
        assert!(only_announces(&stderr), "{arguments:?}: {stderr}");
        String::from_utf8(output.stdout).expect("text")
    }
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn bad_meshes_are_refused_with_their_line() {
    let cases = [
        ("v 0 0 0\nv 1 NaN 0\n", "line 2"),
        ("v 0 0 0\nv 1 inf 0\n", "line 2"),
        ("v 0 0 0\nv 1 0\n", "line 2"),
        ("v 0 0 zero\n", "line 1"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "line 4"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "line 4"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "line 4"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\n", "line 4"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", "line 4"),
        ("", "no faces"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no faces"),
        ("v 1 1 1\nf 1 1 1\n", "one point"),
        ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "degenerate"),
        ("v 0 0 0\nv 1 1 1\nv 3 3 3\nv 2 2 2\nf 1 2 3 4\n", "degenerate"),
        ("v 0 0 0\rv 1 0 0\rv 0 1e999 0\rf 1 2 3\r", "line 3"),
        ("\u{FEFF}v 0 0\r\n", "line 1"),
        ("v 0 0 0\nv 1e-200 0 0\nv 0 1e-200 0\nf 1 2 3\n", "only 1e-200 across"),
        ("v 0 0 0\nv 5e-324 0 0\nv 0 5e-324 0\nf 1 2 3\n", "scale it up"),
        ("v 1e9 0 0\nv 1000000000.0001 0 0\nv 1e9 1e-4 0\nf 1 2 3\n", "move it to the origin"),
    ];
    let place = Place::new();
    for (text, words) in cases {
        place.file("bad.obj", text);
        place.fails(&["convert", "bad.obj", "-o", "out.tri"], 1, &["bad.obj", words]);
        place.fails(&["render", "bad.obj"], 1, &["bad.obj", words]);
    }
    place.file("bad.obj", [0xFF, 0, b'\n', b'f', b' ', 0x80]);
    place.fails(&["convert", "bad.obj"], 1, &["bad.obj", "line 2"]);
}

/// STL is read as OBJ is, whatever the file is called. An error names the triangle.
#[test]
fn stl_is_converted() {
    let corners = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
    let facet = |face: [usize; 3]| {
        let corners: String = face.iter().map(|&k| format!("vertex {}\n", corners[k])).collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let facets: String = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(facet).concat();
    let place = Place::new();
    for file in ["a.stl", "a.obj", "a"] {
        place.file(file, format!("solid a\n{facets}endsolid a\n"));
        let said = place.succeeds(&["convert", file, "--crease", "180", "-o", "stl.tri"]);
        assert!(said.contains("4 vertices, 4 triangles") && said.contains("8 vertices welded"), "{said}");
    }
    place.file("good.obj", TETRAHEDRON).succeeds(&["convert", "good.obj", "--crease", "180"]);
    let [stl, obj] = ["stl.tri", "good.tri"].map(|file| fs::read(place.0.path().join(file)).expect("a stream"));
    assert!(stl == obj, "the same mesh in another format is the same stream");
    place.succeeds(&["render", "a.stl"]);
    place.file("cut.stl", "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n");
    place.fails(&["convert", "cut.stl"], 1, &["cut.stl", "STL", "triangle 1"]);
}

/// PLY is read as OBJ is, whatever the file is called. An error names the place.
#[test]
fn ply_is_converted() {
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
    let text = format!("{head}0 0 0 9\n1 0 0 9\n0 1 0 9\n0 0 1 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    let place = Place::new();
    for file in ["a.ply", "a.PLY", "a.obj", "a"] {
        let said = place.file(file, &text).succeeds(&["convert", file, "-o", "ply.tri"]);
        assert!(said.contains("12 vertices, 4 triangles") && said.contains("left out: colours of vertices"), "{said}");
    }
    place.file("good.obj", TETRAHEDRON).succeeds(&["convert", "good.obj"]);
    let [ply, obj] = ["ply.tri", "good.tri"].map(|file| fs::read(place.0.path().join(file)).expect("a stream"));
    assert!(ply == obj, "the same mesh in another format is the same stream");
    place.file("cut.ply", text.replace("3 1 2 3\n", "")).fails(&["convert", "cut.ply"], 1, &["cut.ply", "PLY", "line 18", "'face'"]);
    place.file("far.ply", text.replace("3 1 2 3", "3 1 2 4")).fails(&["convert", "far.ply"], 1, &["far.ply", "face 4", "vertex 4"]);
    place.file("not.ply", TETRAHEDRON).fails(&["convert", "not.ply"], 1, &["not.ply", "line 1", "magic number"]);
    let points = text.replace("element face 4", "element face 0");
    place.file("points.ply", points).fails(&["convert", "points.ply"], 1, &["points.ply", "no faces"]);
}

/// Whatever takes a mesh file takes its options: the picture is that of the stream that `convert` makes with these options.
#[test]
fn mesh_files_take_options_everywhere() {
    let place = Place::new();
    place.file("part.obj", bowl(8, true).replace("usemtl", "#"));
    let json = |arguments: &[&str]| -> serde_json::Value { serde_json::from_str(place.succeeds(arguments).trim()).expect("JSON") };
    let options: [&[&str]; 5] = [
        &[],
        &["--up", "z", "--colour", "4080ff", "--plastic", "--exponent", "60", "--background", "102030"],
        &["--flip", "--crease", "0", "--light", "-1,1,1", "--light", "at:1,1,2:ff8000", "--ambient", "0.3"],
        &["--azimuth", "-40", "--elevation", "70", "--projection", "parallel", "--orbit", "7", "--diffuse", "0.7", "--specular", "0.1"],
        &["--simplify", "60", "--lod", "48x48", "--merge", "--local-viewer"],
    ];
    let mut seen = Vec::new();
    for options in options {
        place.succeeds(&[&["convert", "part.obj", "-o", "part.tri"], options].concat());
        let drawn =
            |scene: &str, options: &[&str]| json(&[&["render", scene, "--size", "64x48", "--first", "3", "--json"], options].concat());
        let crc = drawn("part.tri", &[])["crc"].clone();
        assert_eq!(drawn("part.obj", options)["crc"], crc, "{options:?}");
        assert!(!seen.contains(&crc), "{options:?} change nothing");
        seen.push(crc);
        let bytes = |scene: &str, options: &[&str]| json(&[&["inspect", scene, "--json"], options].concat())["bytes"].clone();
        assert_eq!(bytes("part.obj", options), bytes("part.tri", &[]), "{options:?}");
    }
    let simplified = &options[4][..4];
    let compare =
        |scene: &str, options: &[&str]| json(&[&["compare", scene, "--size", "64x48", "--shader", "gouraud", "--json"], options].concat());
    place.succeeds(&[&["convert", "part.obj", "-o", "part.tri"], simplified].concat());
    assert_eq!(compare("part.obj", simplified), compare("part.tri", &[]));
    let bench = |scene: &str, options: &[&str]| {
        json(&[&["bench", scene, "--board", "x86-64", "--shader", "gouraud", "--json"], options].concat())["instructions"].clone()
    };
    assert_eq!(bench("part.obj", simplified), bench("part.tri", &[]));
}

/// Other scenes have their own surface, light and view: options for mesh files are refused, not ignored.
#[test]
fn options_for_mesh_files_are_refused_elsewhere() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON).succeeds(&["convert", "good.obj"]);
    place.file("good.toml", "frames = 1\n[camera]\nat = [0, 0, 4]\n[[mesh]]\nname = \"a\"\nshape = \"sphere\"\n[[object]]\nmesh = \"a\"\n");
    let kinds: [(&str, &[&str]); 4] = [
        ("good.tri", &["good.tri is a finished stream", "`microphong convert`"]),
        ("good.toml", &["good.toml is a scripted scene", "into its text"]),
        ("teapot", &["teapot is a built-in scene", "leave them out"]),
        ("gauges", &["gauges is a built-in scene"]),
    ];
    for (scene, words) in kinds {
        let commands: [&[&str]; 6] =
            [&["render"], &["inspect"], &["size"], &["compare", "good.obj"], &["bench"], &["verify", "--board", "pico"]];
        for command in commands {
            place.fails(&[command, &[scene, "--up", "z"]].concat(), 2, &[words, &["--up"]].concat());
        }
    }
    // As given, and not as it differs: this is the axis without the option.
    place.fails(&["render", "teapot", "--up", "y"], 2, &["teapot is a built-in scene"]);
    place.fails(&["convert", "good.toml", "--plastic", "-o", "no.tri"], 2, &["good.toml is a scripted scene"]);
    for option in [["--shader", "phong"], ["--budget", "2"], ["--size", "64x48"]] {
        place.fails(&[&["convert", "good.toml", "-o", "no.tri"], &option[..]].concat(), 2, &["good.toml", option[0], "into the text"]);
    }
    place.fails(&["bench", "--check", "none.csv", "--up", "z"], 2, &["--check", "--up"]);
    place.fails(&["bench", "--up", "z"], 2, &["peer-sphere is a built-in scene"]);
    let nine = ["--light", "1,0,0"].repeat(9);
    place.fails(&[&["render", "good.obj"], &nine[..]].concat(), 2, &["9 times --light", "8 lights"]);
}

/// A grid of so many cells along a side, on a bowl; the half to the right has a material of its own if `two`.
fn bowl(side: usize, two: bool) -> String {
    let mut text = String::new();
    for k in 0..(side + 1) * (side + 1) {
        let [x, y] = [k % (side + 1), k / (side + 1)].map(|c| c as f64 / side as f64 - 0.5);
        text += &format!("v {x} {y} {}\n", x * x + y * y);
    }
    for k in 0..side * side {
        let at = k / side * (side + 1) + k % side + 1;
        let material = if two && k % side >= side / 2 { "usemtl b" } else { "usemtl a" };
        text += &format!("{material}\nf {} {} {} {}\n", at, at + 1, at + side + 2, at + side + 1);
    }
    text
}

/// A mesh is reduced to a number of triangles, and the output tells the error.
#[test]
fn meshes_are_simplified() {
    let place = Place::new();
    place.file("bowl.obj", bowl(20, false)).file("two.obj", bowl(20, true)).file("good.obj", TETRAHEDRON);
    let json = |arguments: &[&str]| -> serde_json::Value {
        serde_json::from_str(&place.succeeds(&[&["convert"], arguments, &["--json"]].concat())).expect("JSON")
    };
    let whole = json(&["bowl.obj"]);
    assert_eq!((&whole["triangles"], &whole["simplified"]), (&800.into(), &serde_json::Value::Null));
    let mut last = 0.0;
    for most in [400, 100, 50] {
        let line = json(&["bowl.obj", "--simplify", &most.to_string()]);
        let [triangles, vertices, bytes] = ["triangles", "vertices", "bytes"].map(|field| line[field].as_u64().expect("a number"));
        assert!(triangles <= most && triangles > most / 2 && vertices < triangles && bytes < 38 * triangles + 500, "{line}");
        let [error, pixels] = ["error", "pixels"].map(|field| line["simplified"][field].as_f64().expect("a number"));
        assert!(error > last && pixels > 100.0 * error && pixels < 250.0 * error && line["simplified"]["before"] == 800, "{line}");
        last = error;
    }
    let said = place.succeeds(&["convert", "bowl.obj", "--simplify", "100"]);
    assert!(said.contains("simplified from 800 triangles") && said.contains("pixels in a picture of 320x240"), "{said}");
    let said = place.succeeds(&["convert", "bowl.obj", "--simplify", "400", "--lod", "64x64,320x240"]);
    assert!(said.contains("pixels in a picture of 320x240") && said.contains("a level of"), "{said}");
    for most in ["800", "4000000000"] {
        assert!(place.succeeds(&["convert", "bowl.obj", "--simplify", most]).contains("not simplified: the mesh has no more than"));
    }
    assert!(json(&["two.obj", "--simplify", "300"])["triangles"].as_u64() <= Some(300));
    place.fails(
        &["convert", "two.obj", "--simplify", "20", "-o", "no.tri"],
        1,
        &["two.obj", "cannot be made of 20 triangles", "borders", "--colour"],
    );
    place.fails(&["convert", "good.obj", "--simplify", "1", "-o", "no.tri"], 1, &["good.obj", "give more"]);
}

/// A near light is where it was put, from the centre of the mesh.
#[test]
fn lights_may_be_near() {
    use microphong::stream::record::{DIRECTIONAL, POINT};
    let place = Place::new();
    let lights = ["--light", "at:-1,0.5,2:ff0000", "--light", "0,0,1"];
    place.file("good.obj", TETRAHEDRON).succeeds(&[&["convert", "good.obj"], &lights[..]].concat());
    let bytes = StreamBytes::read(&place.0.path().join("good.tri")).expect("a stream");
    let stream = bytes.parse().expect("a stream");
    let [near, far] = stream.lights else { panic!("two lights") };
    assert_eq!((near.kind, far.kind), (POINT, DIRECTIONAL));
    let away: Vec<_> = near.vector.iter().zip(stream.header.camera.translation).map(|(light, centre)| light - centre).collect();
    // Lengths have 16 bits of a fraction at most: what the second coordinate is says how many.
    let half = away[1];
    assert!(half > 0 && away == [-2 * half, half, -4 * half], "{away:?}");
}

/// A near light may have a range and a cone, and light may come from the sky. What is wrong of them is named.
#[test]
fn lights_may_have_shapes() {
    use microphong::stream::record::{POINT, SKY};
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    let lights = ["--light", "at:0,2,0:ffc080:range=4:shines=0,-1,0:cone=30,60", "--light", "sky:0,3,0"];
    place.succeeds(&[&["convert", "good.obj"], &lights[..]].concat());
    let bytes = StreamBytes::read(&place.0.path().join("good.tri")).expect("a stream");
    let [spot, sky] = bytes.parse().expect("a stream").lights else { panic!("two lights") };
    assert_eq!((spot.kind, spot.axis, spot.cone), (POINT, [0, -16_384, 0], [8192, 14_189]));
    assert_eq!((sky.kind, sky.vector), (SKY, [0, 16_384, 0]));
    let said = place.succeeds(&["inspect", "good.tri"]);
    assert!(said.contains("ends at a distance of 4.00, shines (0.00, -1.00, 0.00) in a cone of 30 to 60 degrees"), "{said}");
    assert!(said.contains("sky towards (0.00, 1.00, 0.00)"), "{said}");
    for (light, message) in [
        ("0,0,1:range=4", "only a near light"),
        ("at:0,0,1:range=0", "a range is a number from 0.0625 to 31.9"),
        ("at:0,0,1:cone=10,20", "needs both shines="),
        ("at:0,0,1:shines=0,0,1:cone=20,10", "two angles from 0 to 180 degrees"),
        ("at:0,0,1:shines=0,0,0:cone=10,20", "shines= needs a direction"),
        ("at:0,0,1:width=7", "there is no width="),
        ("at:0,0,1:ff0000:00ff00", "a colour is given twice"),
        ("sky:0,0,0", "0,0,0 is not a direction"),
    ] {
        place.fails(&["convert", "good.obj", "--light", light], 2, &[message]);
    }
    place.fails(&[&["convert", "good.obj", "--board", "pico"], &lights[..]].concat(), 1, &["no lights with a range or a cone"]);
}

/// A glTF file with its buffer inside is converted. An error names the place.
#[test]
fn gltf_is_converted() {
    let text = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "metallicFactor": 0}, "doubleSided": true}],
        "buffers": [{"byteLength": 44, "uri": "data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA="}],
        "bufferViews": [{"buffer": 0, "byteLength": 6}, {"buffer": 0, "byteOffset": 8, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]}"#;
    let place = Place::new();
    for file in ["a.gltf", "a.glb", "a.obj"] {
        let said = place.file(file, text).succeeds(&["convert", file, "-o", "out.tri"]);
        let back =
            "1 triangle of an open surface has a back, which takes as much flash as the front; the file calls the material double-sided";
        for words in ["6 vertices, 2 triangles, ", "1 material from the file", back] {
            assert!(said.contains(words), "{said}");
        }
        let said = place.succeeds(&["convert", file, "--one-sided", "-o", "out.tri"]);
        for words in ["3 vertices, 1 triangle, ", "backs of faces are not drawn; --two-sided draws them"] {
            assert!(said.contains(words), "{said}");
        }
    }
    place.file("cut.gltf", text.replace("AACAPwAAAAA=", "AAA=")).fails(&["convert", "cut.gltf"], 1, &["cut.gltf", "buffer 0", "cut off"]);
    place.file("far.gltf", text.replace("\"mesh\": 0", "\"mesh\": 7")).fails(&["convert", "far.gltf"], 1, &["far.gltf", "nodes[0].mesh"]);
    let beside = text.replace("data:application/octet-stream;base64,", "http://");
    place.file("beside.gltf", beside).fails(&["convert", "beside.gltf"], 1, &["beside.gltf", "buffer 0", "beside the mesh"]);
    place.file("cut.glb", b"glTF\x02\0\0\0").fails(&["convert", "cut.glb"], 1, &["cut.glb", "GLB", "cut off"]);
    place.file("not.gltf", TETRAHEDRON).fails(&["convert", "not.gltf"], 1, &["not.gltf", "glTF", "line 1"]);
}

/// From behind, a surface with two sides is what the surface is when it is turned inside out; from the front it is what it was.
#[test]
fn open_surfaces_may_have_two_sides() {
    let place = Place::new();
    place.file("leaf.obj", "v -1 -1 0\nv 1 -1 0.5\nv 1 1 0\nv -1 1 0.5\nf 1 2 3\nf 1 3 4\n");
    place.file("leaf.toml", "frames = 1\n[camera]\nat = [0, 0, 4]\nlooks-at = [0, 0, 0]\nview = 45\nnear = 2\n[[mesh]]\nname = \"leaf\"\nfile = \"leaf.obj\"\ntwo-sided = true\n[[object]]\nmesh = \"leaf\"\n");
    let json = |text: String| serde_json::from_str::<serde_json::Value>(&text).unwrap();
    let picture = |options: &[&str]| {
        let said = json(place.succeeds(&[&["render", "leaf.obj", "--json", "-o", "leaf.png"], options].concat()));
        (said["checksum"].clone(), said["pixels"].clone())
    };
    for azimuth in ["0", "40", "180", "220"] {
        let [one, two, other] = [&[][..], &["--two-sided"], &["--flip"]].map(|option| picture(&[&["--azimuth", azimuth], option].concat()));
        let (seen, unseen) = if azimuth.len() < 3 { (one, other) } else { (other, one) };
        assert_eq!(two, seen, "{azimuth}");
        assert_eq!(unseen.1, 0, "{azimuth}");
    }
    let triangles = |arguments: &[&str]| json(place.succeeds(&[arguments, &["-o", "out.tri", "--json"]].concat()))["triangles"].clone();
    assert_eq!(triangles(&["convert", "leaf.obj", "--two-sided"]), 4);
    assert_eq!(triangles(&["convert", "leaf.toml"]), 4);
    place.fails(&["convert", "leaf.obj", "--two-sided", "--one-sided"], 2, &["--two-sided", "--one-sided"]);
}

/// Files of other formats are refused with the remedy, whatever they are called.
#[test]
fn other_formats_are_named() {
    let place = Place::new();
    let cases: [(&str, &[u8]); 3] = [("FBX", b"Kaydara FBX Binary  \0"), ("Blender", b"BLENDER-v300"), ("UTF-16", b"\xFF\xFEv\0 \x000\0")];
    for (format, bytes) in cases {
        for file in ["in.obj", "in.mesh", "in"] {
            place.file(file, bytes);
            let remedy = if format == "UTF-16" { "UTF-8".to_owned() } else { format!("assimp export {file} ") };
            place.fails(&["convert", file, "-o", "out.tri"], 1, &[file, format, &remedy]);
            place.fails(&["render", file], 1, &[file, format, &remedy]);
        }
    }
    for (file, format, remedies) in [
        ("a.dae", "COLLADA", ["assimp export a.dae a.obj", "Blender"]),
        // 3MF is read, and a wrong file is told what it should be.
        ("a.3mf", "3MF", ["zip archive", "export it again"]),
    ] {
        let [of_convert, of_compare] = remedies;
        place.file(file, "of this we know the ending alone");
        place.fails(&["convert", file], 1, &[file, format, of_convert]);
        place.fails(&["compare", file], 1, &[file, format, of_compare]);
    }
    place.file("a.txt", TETRAHEDRON).fails(&["render", "a.txt"], 2, &["unknown scene", "a.txt", ".obj"]);
    place.fails(&["render", "none.3ds"], 2, &["none.3ds", ".obj"]);
}

/// Ends of lines and a byte order mark make no difference.
#[test]
fn text_of_every_kind_is_the_same_mesh() {
    let place = Place::new();
    place.file("plain.obj", TETRAHEDRON).succeeds(&["convert", "plain.obj"]);
    let stream = |name: &str| fs::read(place.0.path().join(name)).expect("stream");
    for end in ["\n", "\r\n", "\r"] {
        place.file("other.obj", format!("\u{FEFF}{}", TETRAHEDRON.replace('\n', end))).succeeds(&["convert", "other.obj"]);
        assert_eq!(stream("other.tri"), stream("plain.tri"), "{end:?}");
    }
}

#[test]
fn polygons_that_cross_themselves_are_told() {
    let place = Place::new();
    place.file("tie.obj", "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\n");
    assert!(place.succeeds(&["convert", "tie.obj"]).contains("1 polygon crosses itself"));
    let line = place.succeeds(&["convert", "tie.obj", "--json"]);
    assert_eq!(serde_json::from_str::<serde_json::Value>(&line).expect("JSON")["crossed"], 1);
    assert!(!place.file("good.obj", TETRAHEDRON).succeeds(&["convert", "good.obj"]).contains("cross"));
}

#[test]
fn missing_files_and_unwritable_outputs() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    fs::create_dir(place.0.path().join("taken.tri")).expect("directory");
    place.fails(&["convert", "none.obj"], 1, &["none.obj"]);
    place.fails(&["inspect", "none.tri"], 1, &["none.tri"]);
    place.fails(&["render", "none.tri"], 1, &["none.tri"]);
    place.fails(&["render", "none.obj"], 1, &["none.obj"]);
    place.fails(&["inspect", "."], 1, &["."]);
    for same in ["good.obj", "./good.obj"] {
        place.fails(&["convert", "good.obj", "-o", same], 2, &["good.obj", "overwrite"]);
    }
    place.fails(&["convert", "good.obj", "-o", "no/such/out.tri"], 1, &["no/such/out.tri", "directory"]);
    place.fails(&["convert", "good.obj", "-o", "taken.tri"], 1, &["taken.tri", "directory"]);
    place.fails(&["render", "triangle", "-o", "no/such/out.png"], 1, &["no/such/out.png", "directory"]);
    place.fails(&["render", "triangle", "-o", "good.obj/frames/"], 1, &["good.obj/frames"]);
}

/// A picture has the name of its model, and so has many a texture, which lies beside the model. No file that is read is replaced.
#[test]
fn files_of_a_model_are_never_overwritten() {
    let place = Place::new();
    let texture = fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("data/red.jpg")).expect("an image");
    let places = "vt 0 0\nvt 1 0\nvt 0 1\n";
    place.file("fox.obj", format!("mtllib fox.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{places}usemtl fur\nf 1/1 2/2 3/3\n"));
    place.file("fox.mtl", "newmtl fur\nmap_Kd fox.png\n").file("fox.png", &texture);
    place.file(
        "scene.toml",
        "frames = 1\n[camera]\nat = [0, 0, 4]\n[[mesh]]\nname = \"fox\"\nfile = \"fox.obj\"\n[[object]]\nmesh = \"fox\"\n",
    );
    let model = ["fox.obj", "fox.mtl", "fox.png"].map(|name| (name, fs::read(place.0.path().join(name)).expect("a file of the model")));
    for (name, _) in &model {
        place.fails(&["convert", "fox.obj", "-o", name], 2, &[name, "overwrite", "-o"]);
        place.fails(&["convert", "scene.toml", "-o", name], 2, &[name, "overwrite", "-o"]);
    }
    place.fails(&["render", "fox.obj"], 2, &["fox.png", "overwrite", "-o"]);
    place.fails(&["render", "fox.obj", "-o", "./fox.png"], 2, &["fox.png", "overwrite", "-o"]);
    for (name, bytes) in model {
        assert!(fs::read(place.0.path().join(name)).expect("a file of the model") == bytes, "{name}");
    }
    place.succeeds(&["render", "fox.obj", "--size", "32x24", "-o", "picture.png"]);
    place.succeeds(&["render", "fox.obj", "--size", "32x24", "-o", "picture.png"]);
    // The texture is not read.
    place.succeeds(&["render", "fox.obj", "--size", "32x24", "--colours", "none"]);
}

/// Links, devices and pipes stay what they are.
#[cfg(unix)]
#[test]
fn only_regular_files_are_replaced() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    let at = |name: &str| place.0.path().join(name);
    place.succeeds(&["convert", "good.obj", "-o", "real.tri"]);
    let stream = fs::read(at("real.tri")).expect("stream");

    // A link to a link to a file that is there, or not there yet; in a folder of its own, to which paths in links are relative.
    fs::create_dir(at("folder")).expect("folder");
    symlink("folder/next", at("link")).expect("link");
    symlink("../far.tri", at("folder/next")).expect("link");
    for before in [None, Some("old")] {
        before.iter().for_each(|old| fs::write(at("far.tri"), old).expect("scratch file"));
        place.succeeds(&["convert", "good.obj", "-o", "link"]);
        assert!(at("link").is_symlink() && at("folder/next").is_symlink() && !at("far.tri").is_symlink());
        assert_eq!(fs::read(at("far.tri")).expect("stream"), stream);
    }
    symlink("no/such.tri", at("astray")).expect("link");
    symlink("circle", at("circle")).expect("link");
    place.fails(&["convert", "good.obj", "-o", "astray"], 1, &["astray", "No such file or directory"]);
    place.fails(&["convert", "good.obj", "-o", "circle"], 1, &["circle", "symbolic links"]);
    symlink("good.obj", at("same")).expect("link");
    place.fails(&["convert", "good.obj", "-o", "same"], 2, &["same", "overwrite"]);

    // By a link, so that a mistake does not replace the computer's own device.
    symlink("/dev/full", at("full")).expect("link");
    for command in [["convert", "good.obj", "-o", "full"], ["render", "good.obj", "-o", "full"]] {
        place.fails(&command, 1, &["cannot write full", "No space left"]);
        assert!(at("full").is_symlink() && fs::metadata(at("full")).expect("device").file_type().is_char_device());
    }

    assert!(Command::new("mkfifo").arg(at("pipe")).status().expect("mkfifo").success());
    let read = std::thread::spawn({
        let pipe = at("pipe");
        move || fs::read(pipe)
    });
    place.succeeds(&["convert", "good.obj", "-o", "pipe"]);
    assert_eq!(read.join().expect("a reader").expect("the pipe"), stream);
    assert!(fs::metadata(at("pipe")).expect("pipe").file_type().is_fifo());
}

/// A private file stays private, and a new one has the permissions that new files have.
#[cfg(unix)]
#[test]
fn permissions_of_a_replaced_file_stay() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON).file("other", "");
    let at = |name: &str| place.0.path().join(name);
    let mode = |name: &str| fs::metadata(at(name)).expect("a file").permissions().mode() & 0o777;
    for (command, file) in [(&["convert", "good.obj"][..], "out.tri"), (&["render", "good.obj", "--size", "33x17"], "out.png")] {
        let write = || place.succeeds(&[command, &["-o", file]].concat());
        write();
        assert_eq!(mode(file), mode("other"), "{file}");
        for private in [0o600, 0o640, 0o400] {
            fs::write(at(file), "old").expect("scratch file");
            fs::set_permissions(at(file), fs::Permissions::from_mode(private)).expect("permissions");
            write();
            assert_eq!(mode(file), private, "{file}");
            assert!(fs::metadata(at(file)).expect("a file").len() > 3, "{file} is replaced");
            fs::set_permissions(at(file), fs::Permissions::from_mode(0o600)).expect("permissions");
        }
    }
    assert_eq!(place.files(), ["good.obj", "other", "out.png", "out.tri"]);
}

/// Then what is said of the file goes to stderr.
#[cfg(target_os = "linux")]
#[test]
fn standard_output_may_be_the_file() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON).succeeds(&["convert", "good.obj"]);
    for name in ["-", "/proc/self/fd/1"] {
        let output = place.run(&["convert", "good.obj", "-o", name]);
        assert!(output.status.success());
        assert_eq!(output.stdout, fs::read(place.0.path().join("good.tri")).expect("stream"), "{name}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("4 triangles"), "{name}");
    }
    assert_eq!(place.files(), ["good.obj", "good.tri"]);
    let counted = place.run(&["convert", "good.obj", "-o", "-", "--board", "mps2-an385", "--count"]);
    assert_eq!(counted.stdout, fs::read(place.0.path().join("good.tri")).expect("stream"));
    assert!(String::from_utf8_lossy(&counted.stderr).contains("a frame on mps2-an385"), "{counted:?}");
    let picture = place.run(&["render", "good.obj", "--size", "33x17", "-o", "-"]).stdout;
    assert!(picture.starts_with(b"\x89PNG"), "a picture");
    place.succeeds(&["render", "good.obj", "--size", "33x17", "-o", "good.png"]);
    let file = fs::File::create(place.0.path().join("redirected.png")).expect("scratch file");
    let render = ["render", "good.obj", "--size", "33x17", "-o", "/proc/self/fd/1", "--json"];
    let status = Command::new(program()).args(render).current_dir(place.0.path()).stdout(file).stderr(std::process::Stdio::null()).status();
    assert!(status.expect("the program").success());
    assert_eq!(fs::read(place.0.path().join("redirected.png")).ok(), fs::read(place.0.path().join("good.png")).ok());
    assert_eq!(fs::read(place.0.path().join("good.png")).ok(), Some(picture));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_a_failure() {
    let place = Place::new();
    for arguments in
        [&["scenes"][..], &["scenes", "--json"], &["papers", "--only", "goldman"], &["--help"], &["render", "--help"], &["--version"]]
    {
        let full = fs::File::options().write(true).open("/dev/full").expect("device");
        let output = Command::new(program()).args(arguments).current_dir(place.0.path()).stdout(full).output().expect("the program");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {stderr}");
        assert!(stderr.contains("cannot write to standard output: No space left"), "{arguments:?}: {stderr}");
    }
}

/// The program, which signals end also where the tests run in the background and are deaf to some.
#[cfg(target_os = "linux")]
fn interruptible() -> Command {
    let mut command = Command::new("env");
    command.arg("--default-signal").arg(program());
    command
}

/// Whatever ends it: a file has no name before it is complete.
#[cfg(target_os = "linux")]
#[test]
fn interrupted_commands_leave_nothing_behind() {
    use std::io::{BufRead, BufReader};
    let place = Place::new();
    place.file("old.apng", "old");
    for (signal, name) in ["INT", "TERM", "HUP", "KILL"].into_iter().flat_map(|signal| [(signal, "old.apng"), (signal, "new.apng")]) {
        let before = place.files();
        let mut command = interruptible();
        command.args(["render", "torus", "--frames", "65535", "-o", name]).current_dir(place.0.path()).stderr(std::process::Stdio::piped());
        let mut child = command.spawn().expect("the program");
        let mut line = String::new();
        BufReader::new(child.stderr.as_mut().expect("stderr")).read_line(&mut line).expect("a line");
        assert!(line.starts_with("drawing frames"), "{line}");
        std::thread::sleep(std::time::Duration::from_millis(50));
        assert_eq!(child.try_wait().expect("a state"), None, "it still draws");
        assert!(Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().expect("kill").success());
        assert_eq!(child.wait().expect("an end").code(), None, "SIG{signal}");
        assert_eq!(place.files(), before, "SIG{signal}");
        assert_eq!(fs::read(place.0.path().join("old.apng")).expect("the old file"), b"old");
    }
}

/// Name and parent of a process that runs.
#[cfg(target_os = "linux")]
fn running(process: u32) -> Option<(String, u32)> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // `17 (name) R 1 ...`; a process that has ended and is not forgotten yet has the state Z.
    let (name, rest) = stat.split_once('(')?.1.rsplit_once(") ")?;
    let (state, rest) = rest.split_once(' ')?;
    let parent = rest.split(' ').next()?.parse().ok()?;
    (state != "Z").then(|| (name.to_owned(), parent))
}

/// Neither the emulators that they have started nor files for them.
#[cfg(target_os = "linux")]
#[test]
fn interrupted_emulations_leave_nothing_behind() {
    use std::{
        process::Stdio,
        thread::sleep,
        time::{Duration, Instant},
    };
    let commands: [(&[&str], &str); 3] = [
        (&["verify", "--board", "lm3s6965evb", "triangle", "--shader", "flat", "--frames", "2000"], "qemu-system-arm"),
        (&["bench", "bunny", "--board", "mps2-an385", "--shader", "phong"], "qemu-system-arm"),
        (&["bench", "bunny", "--board", "x86-64", "--shader", "phong"], "callgrind-amd64"),
    ];
    for (arguments, emulator) in commands {
        for signal in ["INT", "TERM", "HUP", "KILL"] {
            let place = Place::new();
            let mut command = interruptible();
            command.args(arguments).current_dir(place.0.path()).env("TMPDIR", place.0.path());
            let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program");
            let wanted = Some((emulator.to_owned(), child.id()));
            let found = loop {
                assert_eq!(child.try_wait().expect("a state"), None, "{arguments:?} has not started {emulator}");
                let processes = fs::read_dir("/proc").expect("processes");
                let mut numbers = processes.filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
                match numbers.find(|&process| running(process) == wanted) {
                    Some(process) => break process,
                    None => sleep(Duration::from_millis(2)),
                }
            };
            sleep(Duration::from_millis(50));
            assert!(child.try_wait().expect("a state").is_none() && running(found) == wanted, "{arguments:?}: it still runs");
            assert!(Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().expect("kill").success());
            assert_eq!(child.wait().expect("an end").code(), None, "{arguments:?}, SIG{signal}");
            let end = Instant::now() + Duration::from_secs(10);
            while running(found).is_some_and(|(name, _)| name == emulator) {
                assert!(Instant::now() < end, "{arguments:?}, SIG{signal}: {emulator} still runs");
                sleep(Duration::from_millis(2));
            }
            assert_eq!(place.files(), Vec::<String>::new(), "{arguments:?}, SIG{signal}");
        }
    }
}

#[test]
fn wrong_usage_is_told_from_failure() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    place.fails(&["render", "teapott"], 2, &["teapott", "teapot, bunny"]);
    place.fails(&["render", "triangle", "--shader", "fong"], 2, &["fong", "phong"]);
    place.fails(&["render", "triangle", "--format", "rgb8"], 2, &["rgb8", "rgb888"]);
    for size in ["0x0", "0x10", "10x0", "10", "x", "-1x5", "5000000000x1", "10x10x10"] {
        place.fails(&["render", "triangle", &format!("--size={size}")], 2, &[size, "WIDTHxHEIGHT"]);
    }
    place.fails(&["papers", "--only", "vlasic,newton"], 2, &["newton", "vlasic, szirmay-kalos, bishop-weimer, disselkoen, goldman"]);
    place.fails(&["render", "triangle", "--frames", "0"], 2, &["--frames"]);
    place.fails(&["render", "triangle", "--band-rows", "0"], 2, &["--band-rows"]);
    place.fails(&["render", "triangle", "--frames", "2", "-o", "a.png"], 2, &["a.png", ".apng"]);
    place.fails(&["render", "triangle", "-o", "a.jpg"], 2, &["a.jpg", ".png"]);
    place.fails(&["convert", "good.obj", "--exponent", "0"], 2, &["--exponent"]);
    place.fails(&["convert", "good.obj", "--exponent", "1025"], 2, &["--exponent"]);
    place.fails(&["convert", "good.obj", "--colour", "red"], 2, &["red", "hexadecimal"]);
    place.fails(&["convert", "good.obj", "--up", "w"], 2, &["--up", "-z"]);
    place.fails(&["convert", "good.obj", "--crease", "181"], 2, &["--crease", "0 to 180"]);
    place.fails(&["convert", "good.obj", "--light", "1,2"], 2, &["--light", "three numbers"]);
    place.fails(&["convert", "good.obj", "--light", "0,0,0"], 2, &["--light", "direction"]);
    place.fails(&["convert", "good.obj", "--light", "at:1,2"], 2, &["--light", "three numbers", "at:"]);
    place.fails(&["convert", "good.obj", "--light", "at:1,2,9"], 2, &["--light", "from -8 to 8", "direction"]);
    place.fails(&["convert", "good.obj", "--light", "at:1,2,3:red"], 2, &["--light", "hexadecimal"]);
    place.fails(&["convert", "good.obj", "--light", "by:1,2,3"], 2, &["--light", "three numbers"]);
    for most in ["0", "-1", "many", "1.5"] {
        place.fails(&["convert", "good.obj", &format!("--simplify={most}")], 2, &["--simplify", most]);
    }
    let nine = ["--light", "1,0,0"].repeat(9);
    place.fails(&[&["convert", "good.obj"], &nine[..]].concat(), 2, &["9 times --light", "8 lights"]);
    place.fails(&["convert", "good.obj", "--light", "1,0,0:red"], 2, &["--light", "hexadecimal"]);
    place.fails(&["convert", "good.obj", "--diffuse", "nan"], 2, &["--diffuse"]);
    place.fails(&["convert", "good.obj", "-o", "good.obj"], 2, &["overwrite"]);
    place.fails(&["verify", "--board", "uno"], 2, &["uno", "pico"]);
    place.fails(&["verify", "triangle", "none", "--board", "pico"], 2, &["none", "teapot"]);
    place.fails(&["bench", "--renew", "costs.csv"], 2, &["--reason <TEXT>"]);
    place.fails(&["bench", "--renew", "costs.csv", "--reason", " "], 2, &["--reason", "a reason is needed"]);
    place.fails(&["bench", "--reason", "none"], 2, &["--renew <FILE>"]);
    place.fails(&["bench", "--styles", "--board", "uno"], 2, &["uno", "pico"]);
    place.fails(&["verify", "triangle", "--board", "pico", "--antialias"], 1, &["pico", "smooth outlines", "memory"]);
    place.fails(&["bench", "--redraw", "--skips"], 2, &["--redraw", "--skips"]);
    for what in ["--styles", "--skips", "--redraw"] {
        place.fails(&["bench", what, "--budget", "1,2"], 2, &[what, "one --budget"]);
    }
    place.fails(&["paint"], 2, &["paint"]);
    place.fails(&[], 2, &["Usage"]);
}

/// A number below its range is told by the range, and not as an option that nobody knows.
#[test]
fn negative_numbers_are_told_by_their_range() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    let cases: [(&[&str], &str, &str); 14] = [
        (&["convert", "good.obj"], "--crease", "from 0 to 180"),
        (&["convert", "good.obj"], "--exponent", "1..=1024"),
        (&["convert", "good.obj"], "--diffuse", "from 0 to 2"),
        (&["render", "good.obj"], "--ambient", "from 0 to 2"),
        (&["render", "good.obj"], "--orbit", "0..=65535"),
        (&["render", "good.obj"], "--budget", "from 0.5 to 16"),
        (&["render", "good.obj"], "--frames", "1..=65535"),
        (&["render", "good.obj"], "--band-rows", "1..=4294967295"),
        (&["compare", "good.obj"], "--frame", "0..=4294967295"),
        (&["verify", "--board", "pico"], "--frames", "1..=65535"),
        (&["stress"], "--seconds", "more than 0 seconds"),
        (&["stress"], "--cases", "from 1 to 18446744073709551615"),
        (&["stress"], "--seed", "from 0 to 18446744073709551615"),
        (&["bounds"], "--check", "from 1 to 18446744073709551615"),
    ];
    for (command, option, range) in cases {
        place.fails(&[command, &[option, "-1"]].concat(), 2, &["'-1'", option, range]);
    }
    let lists: [(&[&str], &str, &str, &str); 4] = [
        (&["convert", "good.obj"], "--size", "-1x5", "each side from 1"),
        (&["convert", "good.obj"], "--lod", "-1x5,64x64", "each side from 1"),
        (&["compare", "good.obj"], "--budget", "-1", "from 0.5 to 16"),
        (&["render", "good.obj"], "--diffuse", "-.5", "from 0 to 2"),
    ];
    for (command, option, list, range) in lists {
        let first = list.split(',').next().expect("a value");
        place.fails(&[command, &[option, list]].concat(), 2, &[&format!("'{first}'"), option, range]);
    }
    place.succeeds(&["render", "good.obj", "--azimuth", "-30.5", "--elevation", "-10", "--size", "33x17"]);
}

/// Nothing is all right of which nothing was looked at.
#[test]
fn nothing_judged_is_not_all_right() {
    let place = Place::new();
    place.fails(&["stress", "--cases", "0"], 2, &["--cases", "from 1"]);
    place.fails(&["bounds", "--check", "0"], 2, &["--check", "from 1"]);
    let output = place.run(&["stress", "--only", "budget", "--seed", "1", "--seconds", "1e-9"]);
    let (told, wrong) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(told.contains("nothing to judge") && !told.contains("all right"), "{told}");
    assert!(output.status.code() == Some(1) && wrong.contains("no case was judged"), "{wrong}");
    place.file("costs.csv", "\n").fails(&["bench", "--check", "costs.csv"], 1, &["costs.csv lists no frames"]);
}

/// A pixel format has one name, in the command and in what it prints; names of types are understood as well.
#[test]
fn formats_have_the_same_names_everywhere() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    let names = Format::ALL.map(Format::name).join(", ");
    for command in ["render", "convert"] {
        let help = place.succeeds(&[command, "--help"]).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(help.contains(&format!("[possible values: {names}]")), "{command}: {help}");
    }
    for format in Format::ALL {
        assert!(place.succeeds(&["convert", "good.obj", "--format", format.name()]).contains(&format!(" in {}, ", format.name())));
        // Of the type `BinaryColor`, `Gray4` and so on.
        let of_type = if format == Format::Binary { "BinaryColor".to_owned() } else { format!("{format:?}") };
        let crc = |name: &str| place.succeeds(&["render", "good.obj", "--size", "33x17", "--format", name, "--json"]);
        assert_eq!(crc(&of_type), crc(format.name()), "{of_type}");
    }
    place.fails(&["convert", "good.obj", "--format", "rgb8"], 2, &["rgb8", "rgb888"]);
    place.fails(&["render", "good.obj", "--format", "rgb888", "--dither"], 2, &["--dither", "rgb888", "eight bits"]);
    // `size` knows two of them, by the same names.
    place.fails(&["size", "--format", "BinaryColor,Gray8"], 2, &["Gray8", "one of rgb565, binary is needed"]);
}

/// A mesh without materials is white on black in one bit and few greys: its lit side is bright, and half of it is not lost.
#[test]
fn few_greys_get_a_material_that_can_be_read() {
    let place = Place::new();
    let teapot = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/teapot.obj")).expect("a mesh");
    place.file("teapot.obj", teapot);
    /// The share of light pixels of those that a mesh covers.
    fn lit(place: &Place, arguments: &[&str]) -> f64 {
        let common = ["render", "--size", "128x128", "--first", "10", "-o", "out.png", "--json"];
        let line = place.succeeds(&[&common, arguments].concat());
        let covered = serde_json::from_str::<serde_json::Value>(&line).expect("JSON")["pixels"].as_f64().expect("a number");
        let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(place.0.path().join("out.png")).expect("a picture")));
        let mut reader = decoder.read_info().expect("a picture");
        let mut rgb = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut rgb).expect("a picture");
        rgb.chunks_exact(3).map(|pixel| f64::from(pixel[1]) / 255.0).sum::<f64>() / covered
    }
    for format in ["binary", "gray2", "gray4"] {
        let own = lit(&place, &["teapot.obj", "--format", format]);
        let copper = lit(
            &place,
            &["teapot.obj", "--format", format, "--colour", "ff9e54", "--diffuse", "0.5", "--ambient", "0.1", "--background", "000000"],
        );
        println!("{format}: {own:.2}, copper {copper:.2}");
        assert!(own > 0.5 && own > 1.5 * copper, "{format}: {own}, copper {copper}");
        // `convert` takes the format of the display for that.
        place.succeeds(&["convert", "teapot.obj", "--format", format]);
        assert!((lit(&place, &["teapot.tri", "--format", format]) - own).abs() < 1e-9, "{format}");
    }
    place.succeeds(&["convert", "teapot.obj", "--board", "lm3s6965evb", "-o", "board.tri"]);
    assert_eq!(lit(&place, &["board.tri", "--format", "gray4"]), lit(&place, &["teapot.obj", "--format", "gray4"]));
}

/// What is not asked for otherwise is `auto`, with the budget of the display.
#[test]
fn auto_is_the_default() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON).succeeds(&["convert", "good.obj"]);
    let bytes = StreamBytes::read(&place.0.path().join("good.tri")).expect("a stream");
    let header = bytes.parse().expect("a stream").header;
    assert_eq!((header.shader, header.budget()), (Shader::AUTO.facts().id, None));
    for file in ["good.obj", "good.tri", "teapot"] {
        let line = place.succeeds(&["render", file, "--size", "33x17", "--json"]);
        assert_eq!(serde_json::from_str::<serde_json::Value>(&line).expect("JSON")["shader"], "auto", "{file}");
    }
    assert!(place.succeeds(&["inspect", "good.tri"]).contains("shader auto"));
}

/// One budget for the family that has one, and none where it is left out.
#[test]
fn stress_takes_a_budget() {
    let place = Place::new();
    let line = place.succeeds(&["stress", "--only", "budget", "--budget", "4", "--cases", "3", "--seed", "1", "--json"]);
    let summary = serde_json::from_str::<serde_json::Value>(&line).expect("JSON");
    assert_eq!(summary["cases"], 3);
    assert!(summary["counts"]["triangles"].as_u64() > Some(3), "{line}");
    place.fails(&["stress", "--budget", "0.4"], 2, &["--budget", "0.5 to 16"]);
    place.fails(&["stress", "--only", "coverage", "--budget", "1"], 2, &["--budget", "--only"]);
}

/// The help of commands names all methods, and the help of `convert` the methods of the small board.
#[test]
fn help_names_the_methods_of_boards() {
    let help = Place::new().succeeds(&["convert", "--help"]).split_whitespace().collect::<Vec<_>>().join(" ");
    let names = Shader::ALL.map(Shader::name).join(", ");
    assert!(help.contains(&format!("[possible values: {names}]")), "{help}");
    for command in ["compare", "verify", "bench", "growth"] {
        let help = Place::new().succeeds(&[command, "--help"]).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(help.contains(&format!("[possible values: {names}, all]")), "{command}: {help}");
    }
    for board in Board::ALL {
        let has = Shader::ALL.into_iter().filter(|&shader| board.has(shader));
        let names: Vec<_> = has.map(Shader::name).collect();
        if board == Board::Lm3s6965evb {
            assert_eq!(names, Shader::CORE.map(Shader::name));
            assert!(
                help.contains(&format!("The board {board} has the methods of the core, the others also those of the literature")),
                "{help}"
            );
        } else {
            assert_eq!(names.len(), Shader::ALL.len(), "{board}");
        }
    }
}

/// The command works wherever it lies; what compiles firmware says where it looked for the sources.
#[test]
fn the_command_can_be_moved() {
    let place = Place::new();
    let moved = place.0.path().join("moved");
    // By another process: one that is started meanwhile, by another test, would hold the copy open for writing, and it could not run.
    assert!(Command::new("cp").arg(program()).arg(&moved).status().expect("cp").success());
    let run = |arguments: &[&str]| {
        let mut command = Command::new(&moved);
        command.args(arguments).current_dir(place.0.path()).env("MICROPHONG_SOURCES", "nowhere").output().expect("the program")
    };
    assert!(run(&["render", "teapot", "--size", "64x48"]).status.success());
    for arguments in [&["verify", "--board", "pico"][..], &["bench"], &["growth"], &["size"], &["bench", "--peers", "--board", "x86-64"]] {
        let output = run(arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {stderr}");
        assert!(stderr.contains("nowhere, which MICROPHONG_SOURCES names"), "{arguments:?}: {stderr}");
    }
}

/// A small valid stream.
fn good() -> Vec<u8> {
    scene::load("sphere-40").expect("built-in scene").stream.as_bytes().to_vec()
}

fn parse(bytes: &[u8]) -> Result<(), StreamError> {
    StreamBytes::from(bytes).parse().map(|_: Stream<'_>| ())
}

#[test]
fn streams_cut_anywhere_are_refused() {
    let good = good();
    assert_eq!(parse(&good), Ok(()));
    for length in 0..good.len() {
        assert!(matches!(parse(&good[..length]), Err(StreamError::Truncated { have, .. }) if have as usize == length), "{length}");
    }
    let place = Place::new();
    for length in [0, 1, 15, 63, good.len() / 2, good.len() - 1] {
        place.file("cut.tri", &good[..length]);
        place.fails(&["inspect", "cut.tri"], 1, &["cut.tri", "truncated", &format!("{length} bytes")]);
        place.fails(&["render", "cut.tri"], 1, &["cut.tri", "truncated"]);
    }
}

#[test]
fn any_flipped_bit_is_noticed() {
    let good = good();
    for at in 0..good.len() {
        for bit in 0..8 {
            let mut bad = good.clone();
            bad[at] ^= 1 << bit;
            assert!(parse(&bad).is_err(), "byte {at}, bit {bit}");
        }
    }
    let place = Place::new();
    let cases: [(usize, u8, &[&str]); 4] = [
        (0, 0xFF, &["offset 0", "magic", "microphong convert"]),
        (4, 0xFF, &["offset 4", "version"]),
        (12, 0x01, &["offset 12", "checksum", "damaged"]),
        (good.len() - 1, 0x80, &["offset 12", "checksum"]),
    ];
    for (at, flip, words) in cases {
        let mut bad = good.clone();
        bad[at] ^= flip;
        place.file("bad.tri", &bad);
        place.fails(&["inspect", "bad.tri"], 1, &[&["bad.tri"], words].concat());
        place.fails(&["render", "bad.tri"], 1, &[&["bad.tri"], words].concat());
    }
}

#[test]
fn sealed_nonsense_is_refused_or_drawn_but_never_crashes() {
    let good = good();
    let place = Place::new();
    let (mut refused, mut drawn) = (0, 0);
    for at in 16..good.len() {
        for flip in [0x01, 0x40, 0x80, 0xFF] {
            let mut bad = good.clone();
            bad[at] ^= flip;
            stream::seal(&mut bad);
            let bytes = StreamBytes::from(bad.as_slice());
            let Ok(stream) = bytes.parse() else {
                refused += 1;
                if refused % 100 == 0 {
                    place.file("bad.tri", &bad);
                    place.fails(&["render", "bad.tri"], 1, &["bad.tri"]);
                }
                continue;
            };
            drawn += 1;
            // Header, material and light concern every method; of the many vertices and triangles each meets one.
            let all = at < stream.header.length as usize - size_of_val(stream.vertices) - size_of_val(stream.triangles);
            let shaders = if all { &Shader::ALL[..] } else { &Shader::ALL[at % Shader::ALL.len()..][..1] };
            // A bit may have made a far light near, which some methods refuse.
            for &shader in shaders.iter().filter(|&&shader| check(&stream, shader.facts(), false).is_ok()) {
                let style = Style { dither: true, antialias: at % 2 == 0, ..shader.into() };
                let settings = Settings { size: (40, 30).into(), style, band_rows: 8, format: Format::Rgb565 };
                let picture = render::picture(stream, &settings, 1).expect("a stream that passed the check can be drawn");
                assert_eq!(picture.rgb.len(), 40 * 30 * 3, "byte {at}, flip {flip:02x}, {}", shader.name());
            }
        }
    }
    assert!(refused > 100 && drawn > 100, "{refused} refused, {drawn} drawn");
}

/// Scenes are named as `bench` names them.
#[test]
fn verify_takes_several_scenes() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    let lines = place.succeeds(&["verify", "triangle", "good.obj", "--board", "mps2-an385", "--shader", "flat", "--frames", "1", "--json"]);
    let lines: Vec<serde_json::Value> = lines.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let told: Vec<_> = lines.iter().map(|line| (line["scene"].as_str(), line["differing"].as_u64())).collect();
    assert_eq!(told, [(Some("triangle"), Some(0)), (Some("good"), Some(0))]);
    place.fails(&["verify", "--board", "pico", "--scene", "teapot"], 2, &["--scene"]);
}

/// A board that lacks a method is told and left out where all are asked for.
#[test]
fn verify_leaves_out_boards_without_a_method() {
    let place = Place::new();
    let lines = place.succeeds(&["verify", "triangle", "--board", "all", "--shader", "duff", "--frames", "1", "--json"]);
    let lines: Vec<serde_json::Value> = lines.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((lines.len(), &lines[0]["board"], &lines[0]["lacking"]), (Board::ALL.len(), &"lm3s6965evb".into(), &true.into()));
    assert!(lines[1..].iter().all(|line| line["differing"] == 0), "{lines:?}");
}

/// A stream is not made for a board whose firmware lacks its method.
#[test]
fn convert_refuses_methods_that_a_board_lacks() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    for (board, shader) in Board::ALL.into_iter().flat_map(|board| Shader::ALL.map(|shader| (board, shader))) {
        let arguments = ["convert", "good.obj", "--board", board.name(), "--shader", shader.name(), "-o", "out.tri"];
        if board.has(shader) {
            place.succeeds(&arguments);
            fs::remove_file(place.0.path().join("out.tri")).expect("a stream");
        } else {
            let words = [board.name(), "has no", shader.name(), "it has flat, gouraud, six-point, phong", "--shader"];
            place.fails(&arguments, 2, &words);
        }
    }
    for board in Board::ALL {
        place.succeeds(&["convert", "good.obj", "--board", board.name(), "-o", "out.tri"]);
        assert!(place.succeeds(&["inspect", "out.tri"]).ends_with("shader auto\n"), "{board}");
    }
    let scene =
        "frames = 1\nshader = \"duff\"\n[camera]\nat = [0, 0, 5]\n[[mesh]]\nname = \"box\"\nshape = \"box\"\n[[object]]\nmesh = \"box\"\n";
    place.file("scene.toml", scene).succeeds(&["convert", "scene.toml", "--board", "pico"]);
    place.fails(&["convert", "scene.toml", "--board", "lm3s6965evb", "-o", "no.tri"], 1, &["scene.toml", "no duff", "`shader`"]);
    place.fails(&["convert", "good.obj", "--board", "uno"], 2, &["uno", "lm3s6965evb"]);
}

/// `convert --board` refuses what the firmware of that board would refuse, and nothing else.
#[test]
fn convert_refuses_what_a_board_would_refuse() {
    let place = Place::new();
    let materials = |count: usize| -> String {
        let faces = (0..count).map(|k| format!("usemtl m{k}\nf {} {} {}\n", 3 * k + 1, 3 * k + 2, 3 * k + 3));
        (0..count).map(|k| format!("v {k} 0 0\nv {k} 1 0\nv {k} 0 1\n")).collect::<String>() + &faces.collect::<String>()
    };
    let scene = |objects: usize, more: &str| -> String {
        let head = "frames = 1\nshader = \"gouraud\"\n[camera]\nat = [0, 0, 5]\n[[mesh]]\nname = \"box\"\nshape = \"box\"\n";
        format!("{head}{}{more}", "[[object]]\nmesh = \"box\"\n".repeat(objects))
    };
    let model = |name: &str, count: usize, highlight: &dyn Fn(usize) -> String| {
        let colours: String = (0..count).map(|k| format!("newmtl m{k}\nKd 0.{} 0.5 0.5\n{}", k + 10, highlight(k))).collect();
        place.file(&format!("{name}{count}.mtl"), colours);
        place.file(&format!("{name}{count}.obj"), format!("mtllib {name}{count}.mtl\n{}", materials(count)));
    };
    for count in [2, 3, 12, 13, 16, 17] {
        model("m", count, &|_| String::new());
    }
    for count in [4, 5] {
        model("glossy", count, &|k| format!("Ks 0.5 0.5 0.5\nNs {}\n", 10 * k + 10));
    }
    for count in [1, 2, 12, 13, 64, 65] {
        place.file(&format!("o{count}.toml"), scene(count, ""));
    }
    place.file("label.toml", scene(1, "[[label]]\ntext = \"5\"\nat = [0, 0]\n")).file("large.obj", bowl(50, false));
    place.file("lines.toml", scene(1, "[outlines]\n"));
    let (mut refused, mut taken) = (0, 0);
    for file in place.files().iter().filter(|file| !file.ends_with("mtl")) {
        for board in Board::ALL {
            let shader = match file {
                file if file.ends_with("toml") => &[][..],
                file if file.starts_with("glossy") => &["--shader", "phong"],
                _ => &["--shader", "gouraud"],
            };
            place.succeeds(&[&["convert", file, "-o", "out.tri"], shader].concat());
            let bytes = fs::read(place.0.path().join("out.tri")).expect("a stream");
            let fits = board != Board::Lm3s6965evb || bytes.len() <= 48 << 10;
            let arguments = [&["convert", file, "--board", board.name(), "-o", "no.tri"], shader].concat();
            fs::remove_file(place.0.path().join("out.tri")).expect("a stream");
            match verify::first_frame(board, &bytes) {
                Ok(_) if fits => {
                    taken += 1;
                    place.succeeds(&arguments);
                    fs::remove_file(place.0.path().join("no.tri")).expect("a stream");
                }
                _ => {
                    refused += 1;
                    place.fails(&arguments, 1, &[file, board.name()]);
                }
            }
        }
    }
    // Refused by the Pico 8 of 17, by the smallest board 15, by each of the six others 3.
    assert_eq!((taken, refused), (95, 41));
    place.fails(&["convert", "m13.obj", "--board", "pico", "-o", "no.tri"], 1, &["13 materials", "room for 12", "--colour"]);
    place.succeeds(&["convert", "m13.obj", "--board", "pico", "--colour", "ff8000"]);
    place.fails(&["convert", "glossy5.obj", "--board", "pico", "-o", "no.tri"], 1, &["5 kinds of highlights", "room for 4", "gouraud"]);
    place.succeeds(&["convert", "glossy5.obj", "--board", "pico", "--shader", "gouraud"]);
    place.fails(&["convert", "o13.toml", "--board", "pico", "-o", "no.tri"], 1, &["13 objects", "room for 12"]);
    place.fails(&["convert", "label.toml", "--board", "lm3s6965evb", "-o", "no.tri"], 1, &["no fonts", "labels"]);
    place.fails(&["convert", "lines.toml", "--board", "pico", "-o", "no.tri"], 1, &["no lines along outlines", "feature antialias"]);
    place.fails(&["convert", "large.obj", "--board", "lm3s6965evb", "-o", "no.tri"], 1, &["room for 49152", "--simplify"]);
}

/// A mesh for which there is no room ends with the number for --simplify for which there is, and with the error that --simplify then reports.
#[test]
fn convert_says_how_far_to_simplify() {
    let place = Place::new();
    place.file("large.obj", bowl(50, false)).file("larger.obj", bowl(84, false));
    // The number and the error of `--simplify N makes it fit WHOM: ERROR`, at the end of the text.
    let remedy = |text: &str, whom: &str| {
        let (_, remedy) = text.trim_end().rsplit_once("; --simplify ").unwrap_or_else(|| panic!("no remedy in {text}"));
        let (most, error) = remedy.split_once(&format!(" makes it fit {whom}: ")).unwrap_or_else(|| panic!("not for {whom}: {text}"));
        assert!(error.starts_with("at most 0.") && error.ends_with("pixels in a picture of 320x240"), "{error}");
        (most.parse::<u64>().expect("a number"), error.to_owned())
    };

    let arguments = ["convert", "large.obj", "--board", "lm3s6965evb", "-o", "large.tri"];
    let output = place.run(&arguments);
    let (most, error) = remedy(&String::from_utf8_lossy(&output.stderr), "lm3s6965evb");
    assert_eq!((output.status.code(), place.files()), (Some(1), vec!["large.obj".to_owned(), "larger.obj".to_owned()]));
    let said = place.succeeds(&[&arguments[..], &["--simplify", &most.to_string()]].concat());
    assert!(said.contains(&error), "{said}");
    let too_many = (most + most / 32).to_string();
    fs::remove_file(place.0.path().join("large.tri")).expect("a stream");
    place.fails(&[&arguments[..], &["--simplify", &too_many]].concat(), 1, &["lm3s6965evb has room for", "; --simplify"]);

    // A wide picture leaves less RAM for the mesh.
    let arguments = ["convert", "larger.obj", "--size", "2040x240", "--format", "rgb888"];
    let said = place.succeeds(&arguments);
    let last = said.lines().last().expect("a line");
    assert!(last.starts_with("  no common chip has room for a program with it by auto in rgb888; --simplify "), "{said}");
    let (most, error) = remedy(last, "rp2350");
    let said = place.succeeds(&[&arguments[..], &["--simplify", &most.to_string()]].concat());
    assert!(said.contains(&error) && !said.contains("no common chip"), "{said}");
    let said = place.succeeds(&["convert", "large.obj"]);
    assert!(!said.contains("no common chip") && !said.contains("--simplify"), "{said}");
}

/// Advice for a large mesh is true, although its error is an estimate, and so is advice for a stream with neighbours: the simplified mesh fits the chip.
#[test]
fn convert_says_how_far_to_simplify_large_meshes() {
    let place = Place::new();
    place.file("large.obj", bowl(190, false)).file("smooth.obj", bowl(102, false));
    for (name, options, about) in [("large.obj", &[][..], true), ("smooth.obj", &["--antialias"], false)] {
        let said = place.succeeds(&[&["convert", name, "--json"], options].concat());
        let remedy = &serde_json::from_str::<serde_json::Value>(&said).expect("JSON")["remedy"];
        assert_eq!((&remedy["fits"], &remedy["is_estimate"]), (&"rp2350".into(), &about.into()), "{remedy}");
        assert!((1e-5..0.01).contains(&remedy["error"].as_f64().expect("an error")), "{remedy}");

        let whole = Converted::read(&place.0.path().join(name), &Options::default(), &()).expect("a mesh");
        let most = remedy["triangles"].as_u64().expect("a number") as usize;
        let parts = levels::reduced(&whole.mesh, &whole.whole, most).expect("a simplified mesh");
        let bytes = whole.look.stream(&parts).expect("a stream");
        let bytes = if options.is_empty() { bytes } else { bytes.with_neighbours().expect("neighbours") };
        let stream = bytes.parse().expect("a stream");
        let layout = render::program_layout(&stream, Shader::AUTO, Size::new(320, 240), 16).expect("a layout");
        let taken = [bytes.as_bytes().len(), Format::Rgb565.bytes(&layout).iter().sum()];
        let needed = Features::needed_by(&stream, Format::Rgb565);
        let loads = program::loads(needed, Shader::AUTO, Format::Rgb565, taken).expect("loads");
        let (_, load) = loads.into_iter().find(|(chip, _)| chip.name == "rp2350").expect("the chip");
        assert!((0.9..=1.0).contains(&load), "{name}: {load}");
    }
}

/// `convert` ends with what a frame takes on boards where that is asked for, and refuses a board that it cannot count on before it writes.
#[test]
fn convert_counts_on_boards() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    assert!(place.succeeds(&["convert", "good.obj", "-o", "out.tri"]).contains("--count"));
    let arguments = ["convert", "good.obj", "--board", "pico", "--count", "-o", "out.tri"];
    let told = place.succeeds(&arguments);
    assert!(told.contains("a frame on pico (cortex-m0plus, emulated), 240x240: ") && told.ends_with(" frames/s\n"), "{told}");
    let line: serde_json::Value = serde_json::from_str(&place.succeeds(&[&arguments[..], &["--json"]].concat())).expect("JSON");
    let bench = place.succeeds(&["bench", "out.tri", "--board", "pico", "--shader", "auto", "--json"]);
    let bench: serde_json::Value = serde_json::from_str(&bench).expect("JSON");
    assert_eq!(line["costs"][0]["instructions"], bench["instructions"], "as bench counts");
    place.fails(&["convert", "good.obj", "--board", "lm3s6965evb", "--count", "-o", "no.tri"], 2, &["lm3s6965evb", "mps2-an385"]);
    assert!(!place.0.path().join("no.tri").exists());
}

/// Whatever `render` draws can be looked into: streams of any ending, built-in scenes, scripted ones, meshes.
#[test]
fn inspect_takes_scenes() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON).succeeds(&["convert", "good.obj"]);
    fs::copy(place.0.path().join("good.tri"), place.0.path().join("good.bin")).expect("a copy");
    for name in ["good.obj", "good.tri", "good.bin", "triangle"] {
        assert!(place.succeeds(&["inspect", name]).starts_with(&format!("{name}: triangle stream")), "{name}");
    }
    let gauges = serde_json::from_str::<serde_json::Value>(&place.succeeds(&["inspect", "gauges", "--json"])).expect("JSON");
    assert_eq!((&gauges["file"], &gauges["objects"]), (&"gauges".into(), &12.into()));
    place.fails(&["inspect", "gauge"], 2, &["\"gauge\"", "gauges", ".tri"]);
}

/// Materials are told, and what a file has besides; a colour of the command line takes their place. Errors name the file of the materials.
#[test]
fn convert_takes_materials() {
    let place = Place::new();
    let two = TETRAHEDRON.replacen("\nf", "\nmtllib paint.mtl\nusemtl red\nf", 1) + "usemtl blue\nf 1 2 3\nvt 0 0\n";
    place.file("two.obj", two).file("paint.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nmap_Kd blue.png\n");
    let said = place.succeeds(&["convert", "two.obj"]);
    assert!(said.contains("2 materials") && said.contains("left out: texture coordinates"), "{said}");
    assert!(said.contains("the texture blue.png is left out: cannot read blue.png; put it beside the mesh"), "{said}");
    assert!(said.contains("Layout::new(320, 16).vertices(15).triangles(5).materials(2)"), "{said}");
    let json = |arguments: &[&str]| serde_json::from_str::<serde_json::Value>(place.succeeds(arguments).trim()).expect("JSON");
    let line = json(&["convert", "two.obj", "--json"]);
    assert_eq!((&line["materials"], &line["meshes"]), (&2.into(), &2.into()));
    let line = json(&["convert", "two.obj", "--color", "ff8000", "--json"]);
    assert_eq!((&line["materials"], &line["meshes"]), (&0.into(), &1.into()));
    let remarks = line["remarks"].as_array().expect("remarks");
    assert!(remarks.iter().any(|remark| remark.as_str().expect("text").contains("--colour")), "{line}");
    place.succeeds(&["convert", "two.obj", "--up", "-z", "--light", "-0.5,0.6,0.7:fff0d8", "--light", "1,0,0.2", "-o", "lit.tri"]);
    assert!(place.succeeds(&["inspect", "lit.tri"]).contains("2 lights"));
    place.file("paint.mtl", "newmtl red\nKd 1 0\n").fails(
        &["convert", "two.obj", "-o", "out.tri"],
        1,
        &["paint.mtl", "line 2", "Kd", "\"red\""],
    );
}

#[test]
fn convert_inspect_and_render_work_together() {
    let place = Place::new();
    place.file("good.obj", TETRAHEDRON);
    let json = |text: String| serde_json::from_str::<serde_json::Value>(text.lines().last().expect("a line")).expect("JSON");
    let converted = json(place.succeeds(&["convert", "good.obj", "--orbit", "7", "--crease", "180", "--shader", "phong", "--json"]));
    assert_eq!(converted["triangles"], 4);
    let inspected = json(place.succeeds(&["inspect", "good.tri", "--json"]));
    let size = fs::metadata(place.0.path().join("good.tri")).expect("stream").len();
    assert_eq!(inspected["bytes"], size);
    assert_eq!((&inspected["vertices"], &inspected["frames"]), (&4.into(), &7.into()));
    let drawn = json(place.succeeds(&["render", "good.tri", "--size", "33x17", "--json"]));
    assert_eq!((&drawn["shader"], &drawn["output"]), (&"phong".into(), &"good.png".into()));
    // What takes no second is silent.
    for lod in [&[][..], &["--lod", "64x64"]] {
        let output = place.run(&[&["convert", "good.obj", "-o", "lod.tri"], lod].concat());
        assert!(output.status.success() && output.stderr.is_empty(), "{lod:?}: {output:?}");
    }
    assert_eq!(place.succeeds(&["render", "good.tri", "--size", "33x17", "--frames", "3", "-o", "f/", "--json"]).lines().count(), 3);
    assert_eq!(place.succeeds(&["render", "good.tri", "--size", "33x17", "--frames", "3", "-o", "f.apng"]).lines().count(), 2);
    let numbered = |name: &str| Path::new("f").join(name);
    for file in [numbered("0000.png"), numbered("0002.png"), "good.png".into(), "f.apng".into()] {
        assert!(place.0.path().join(&file).is_file(), "{}", file.display());
    }
    let count = scene::NAMES.len() + scene::VARIANTS.len() + scene::ORDINARY.len() + scene::GALLERY.len() + scene::SCRIPTED.len();
    assert_eq!(place.succeeds(&["scenes"]).lines().count(), count);
    assert_eq!(place.succeeds(&["scenes", "--json"]).lines().count(), count);
}

/// What takes longer than a second announces itself, a single step too.
#[test]
fn long_work_is_announced() {
    let place = Place::new();
    // Waves of 7,200 triangles: the search for a level takes several seconds.
    let side = 60;
    let points = (0..=side).flat_map(|y| (0..=side).map(move |x| [x, y].map(|c| f64::from(c) / f64::from(side))));
    let vertices = points.map(|[x, y]| format!("v {x} {:.5} {y}\n", 0.1 * (9.0 * x).sin() * (7.0 * y).cos()));
    let squares = (0..side).flat_map(|y| (0..side).map(move |x| y * (side + 1) + x + 1));
    let triangles = squares.map(|a| format!("f {a} {c} {b}\nf {b} {c} {d}\n", b = a + 1, c = a + side + 1, d = a + side + 2));
    place.file("waves.obj", vertices.chain(triangles).collect::<String>());
    let output = place.run(&["convert", "waves.obj", "-o", "out.tri", "--lod", "120x120"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("searching levels of detail ...\n"), "{output:?}");

    // A file that arrives late takes long to read on every machine.
    std::os::unix::fs::symlink("/dev/stdin", place.0.path().join("late.obj")).expect("a link");
    let mut command = Command::new(program());
    command.args(["convert", "late.obj", "-o", "out.tri"]).current_dir(place.0.path());
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program");
    let mut input = child.stdin.take().expect("its input");
    thread::sleep(Duration::from_secs(3));
    input.write_all(TETRAHEDRON.as_bytes()).expect("a pipe");
    drop(input);
    let output = child.wait_with_output().expect("its end");
    assert!(output.status.success(), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("reading the file ...\n"), "{output:?}");
}

/// A material that few greys do not show is said, and what helps.
#[test]
fn dark_materials_are_told_where_there_are_few_greys() {
    let place = Place::new();
    place.file("paint.mtl", "newmtl coal\nKd 0.02 0.02 0.02\nnewmtl chalk\nKd 0.9 0.9 0.9\n");
    for material in ["coal", "chalk"] {
        place.file(&format!("{material}.obj"), format!("mtllib paint.mtl\nusemtl {material}\n{TETRAHEDRON}"));
    }
    let told = |mesh: &str, options: &[&str]| {
        let output = place.run(&[&["render", mesh, "-o", "out.png", "--size", "33x17"], options].concat());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    for format in ["binary", "gray2", "gray4"] {
        let told = told("coal.obj", &["--format", format]);
        assert!(["warning: coal.obj", format, "\"coal\"", "--colour"].iter().all(|part| told.contains(part)), "{told}");
    }
    for (mesh, options) in [
        ("coal.obj", &["--format", "gray8"][..]),
        ("coal.obj", &["--format", "binary", "--colour", "ffffff"]),
        ("chalk.obj", &["--format", "binary"]),
    ] {
        assert_eq!(told(mesh, options), "", "{mesh} {options:?}");
    }
}

/// A text that is not a scene is refused with the place and the fault, and leaves no file.
#[test]
fn texts_that_are_no_scenes_are_refused() {
    let place = Place::new();
    let good = "frames = 10\n[camera]\nat = [0, 0, 4]\n[[mesh]]\nname = \"a\"\nshape = \"sphere\"\n[[object]]\nmesh = \"a\"\n";
    place.file("good.toml", good);
    place.succeeds(&["convert", "good.toml", "-o", "good.tri"]);
    let said = place.succeeds(&["inspect", "good.tri"]);
    assert!(said.contains("1 objects") && said.contains("0 objects and 0 lights move, the camera stands still"), "{said}");
    assert!(place.succeeds(&["inspect", "good.tri", "--json"]).contains("\"objects\":1"));
    place.succeeds(&["render", "good.toml", "-o", "good.png"]);
    place.fails(&["compare", "board"], 1, &["board", "several objects"]);
    let with = |old: &str, new: &str| good.replacen(old, new, 1);
    let label = |lines: &str| format!("{good}[[label]]\n{lines}\n");
    let cases = [
        (with("frames = 10", "frames = 0"), "line 1: frames: 0 is not possible; it must be a whole number from 1 to 65535"),
        (with("frames = 10", "frames = ten"), "line 1"),
        (with("shape", "shap"), "unknown field `shap`"),
        (format!("{good}positon = [1, 0, 0]\n"), "unknown field `positon`"),
        (format!("{good}keys = [{{ frame = 1, agnle = 3 }}]\n"), "unknown field `agnle`"),
        (with("sphere", "cone"), "there is no shape \"cone\"; use box, cylinder, sphere or torus"),
        (with("shape = \"sphere\"", "file = \"none.obj\""), "none.obj"),
        (with("shape = \"sphere\"\n", ""), "a mesh needs either `file`, or `shape`"),
        (with("mesh = \"a\"", "mesh = \"b\""), "line 8: object 1: mesh: there is no mesh \"b\"; write a [[mesh]] of this name"),
        (with("at = [0, 0, 4]", "at = [0, 0, 0]"), "line 3: camera: at: the camera must not look at the point where it is"),
        (with("at = [0, 0, 4]", "at = [0, 3, 0]"), "line 3: camera: at: the camera must not look along its `up`"),
        (
            with("at = [0, 0, 4]", "at = [0, 0, 4]\nview = 0"),
            "line 4: camera: view: 0 is not possible; it must be a number from 1 to less than 170",
        ),
        (format!("{good}scale = 9\n"), "line 9: object 1: scale: 9 is not possible; it must be a number from 0.0625 to 8"),
        (format!("{good}at = [17, 0, 0]\n"), "line 9: object 1: at: 17 is not possible; it must be a number from -16 to 16"),
        (format!("{good}angle = 3\n"), "line 9: object 1: angle: a rotation needs either"),
        (format!("{good}quaternion = [0, 0, 0, 0]\n"), "quaternion: it must not be zero"),
        (format!("{good}keys = [{{ frame = 3 }}, {{ frame = 3 }}]\n"), "line 9: object 1: key 2: frame: the frames of keys must rise"),
        (format!("{good}[[light]]\ntowards = [0, 0, 0]\n"), "light 1"),
        (format!("{good}[[light]]\ntowards = [1, 0, 0]\nat = [1, 0, 0]\n"), "a light needs one of `towards`"),
        (format!("{good}[[light]]\ntowards = [1, 0, 0]\ncolour = \"red\"\n"), "\"red\" is not a colour; write it as RRGGBB"),
        (format!("background = 7\n{good}"), "a background is a colour, as \"203040\", or a gradient"),
        (format!("background = {{ top = \"red\", bottom = \"000000\" }}\n{good}"), "line 1: background: top: \"red\" is not a colour"),
        (format!("outlines = true\n{good}"), "line 1: outlines: true is not possible; it must be a table"),
        (format!("{good}[outlines]\ncolour = \"red\"\n"), "line 10: outlines: colour: \"red\" is not a colour; write it as RRGGBB"),
        (format!("{good}[outlines]\nalone = 1\n"), "line 10: outlines: alone: 1 is not possible; it must be true or false"),
        (format!("{good}[outlines]\nwidth = 2\n"), "outlines: unknown field `width`"),
        (label("text = \"\"\nat = [0, 0]"), "line 10: label 1: text: it has 0 characters; it can have 1 to 30"),
        (label("text = \"0123456789012345678901234567890\"\nat = [0, 0]"), "it has 31 characters"),
        (label("text = \"5 \u{3a9}\"\nat = [0, 0]"), "its characters must be those of ISO 8859-1, in one line"),
        (label("text = \"a\\nb\"\nat = [0, 0]"), "ISO 8859-1, in one line"),
        (label("text = \"a\"\nat = [9000, 0]"), "at: it is too far from the picture"),
        (
            label("text = \"a\"\nat = [0, 0]\nheight = 5.9"),
            "line 12: label 1: height: 5.9 is not possible; it must be a number from 6 to less than 1920",
        ),
        (label("text = \"a\"\nat = [0, 0]\nalign = \"top\""), "there is no \"top\"; use left, middle or right"),
        (label("text = \"a\"\nat = [0, 0]\ncolour = \"red\""), "line 12: label 1: colour: \"red\" is not a colour"),
        (format!("shader = \"none\"\n{good}"), "there is no method \"none\""),
        (format!("{good}[[mesh]]\nname = \"a\"\nshape = \"box\"\n"), "two meshes of the name"),
        (
            with("shape = \"sphere\"", "shape = \"torus\"\ntube = 1"),
            "line 7: mesh 1: tube: 1 is not possible; it must be a number from 0.01 to 0.99",
        ),
        (with("shape = \"sphere\"", "shape = \"sphere\"\nsize = [3, 1, 1]"), "it must be a number from 0.001 to less than 2"),
        (with("shape = \"sphere\"", "shape = \"sphere\"\nsize = [1.9, 1, 1]\ncentre = [1, 0, 0]"), "less than 2 are possible"),
        (with("shape = \"sphere\"", "shape = \"sphere\"\ncentre = [\n0, nan, 0]"), "line 8: mesh 1: centre: nan is not possible"),
        (
            with("shape = \"sphere\"", "shape = \"sphere\"\ncrease = nan"),
            "line 7: mesh 1: crease: nan is not possible; it must be a number from 0 to 180",
        ),
        (with("shape = \"sphere\"", "shape = \"sphere\"\ncrease = -500"), "crease: -500 is not possible"),
        (with("shape = \"sphere\"", "shape = \"sphere\"\nexponent = 1025"), "a whole number from 1 to 1024"),
        (format!("size = [0, 240]\n{good}"), "line 1: size: 0 is not possible; it must be a whole number from 1 to 2047"),
        (format!("size = [99999, 240]\n{good}"), "size: 99999 is not possible"),
        (format!("budget = 17\n{good}"), "a number from 0.5 to 16"),
        (with("at = [0, 0, 4]", "at = [0, 0, 4, 0]"), "line 3: camera: at: [0, 0, 4, 0] is not possible; it must be a list of 3 numbers"),
        (
            with("at = [0, 0, 4]", "at = [0, 0, 4]\nnear = 0"),
            "line 4: camera: near: 0 is not possible; it must be a number from 0.015625 to less than 16",
        ),
        (with("at = [0, 0, 4]", "at = [0, 0, 4]\nview = 170"), "view: 170 is not possible; it must be a number from 1 to less than 170"),
        (with("at = [0, 0, 4]", "at = [12, 12, 0]"), "camera: at: it is 16.97 units from the origin; at most 16 are possible"),
        (format!("{good}[[light]]\nat = [nan, 0, 0]\n"), "line 10: light 1: at: nan is not possible"),
        (
            format!("{good}keys = [\n{{ frame = 3 }},\n{{ frame = 4, at = [0, 0, inf] }}]\n"),
            "line 11: object 1: key 2: at: inf is not possible",
        ),
        (
            format!(
                "{good}[[light]]\ntowards = [1, 0, 0]\nkeys = [{{ frame = 0, towards = [0, 0, 1] }}, {{ frame = 9, towards = [0, 0, -2] }}]\n"
            ),
            "line 11: light 1: key 2: towards: it is opposite to the key before",
        ),
        (good.replace("frames", "frame"), "line 1: `frames` is missing"),
        (format!("{good}x = \"{}", "y".repeat(10_000_000)), "line 9"),
        (with("\"sphere\"", &format!("\"{}\"", "y".repeat(10_000_000))), "line 6: mesh 1: shape: there is no shape \"yyyy"),
    ];
    for (text, words) in cases {
        place.file("bad.toml", &text);
        place.fails(&["convert", "bad.toml", "-o", "bad.tri"], 1, &["bad.toml: line ", words]);
        assert!(!place.0.path().join("bad.tri").exists(), "{words}");
    }
}

#[test]
fn formats_and_bands_keep_their_promises() {
    let place = Place::new();
    let mut sums = Vec::new();
    for rows in ["1", "7", "4096"] {
        let line = place.succeeds(&["render", "torus", "--size", "64x48", "--band-rows", rows, "--json"]);
        sums.push(serde_json::from_str::<serde_json::Value>(&line).expect("JSON")["crc"].clone());
    }
    assert!(sums.windows(2).all(|w| w[0] == w[1]), "{sums:?}");
    for format in ["rgb565", "light-rgb565", "rgb332", "gray4"] {
        let lines = ["--dither", "--no-antialias"].map(|choice| {
            let line = place.succeeds(&["render", "torus", "--size", "64x48", "--format", format, choice, "--json"]);
            serde_json::from_str::<serde_json::Value>(&line).expect("JSON")["crc"].clone()
        });
        assert_ne!(lines[0], lines[1], "{format}: outlines are smooth by default");
    }
}

/// Lines along outlines belong to a scene: its text or an option of `convert` states them, `inspect` shows them, and `render` draws them or others.
#[test]
fn lines_along_outlines_are_part_of_a_scene() {
    let place = Place::new();
    let text = "frames = 1\n[camera]\nat = [1, 2, 4]\n[[mesh]]\nname = \"box\"\nshape = \"box\"\n[[object]]\nmesh = \"box\"\n";
    place.file("plain.toml", text).file("white.toml", format!("{text}[outlines]\n"));
    place.file("drawing.toml", format!("{text}[outlines]\ncolour = \"ff8000\"\nalone = true\n"));
    let lines = |stream: &str| {
        let line = place.succeeds(&["inspect", stream, "--json"]);
        let line = serde_json::from_str::<serde_json::Value>(&line).expect("JSON");
        let needs = line["features"].as_array().expect("features").contains(&"antialias".into());
        (line["outlines"]["colour"].as_str().map(str::to_owned), line["outlines"]["alone"].as_bool(), needs)
    };
    let of = |colour: &str, alone| (Some(colour.to_owned()), Some(alone), true);
    assert_eq!(
        (lines("plain.toml"), lines("white.toml"), lines("drawing.toml")),
        ((None, None, false), of("ffffff", false), of("ff8000", true))
    );
    // The option takes the place of what the text says.
    place.succeeds(&["convert", "drawing.toml", "--outlines", "#0040ff", "-o", "blue.tri"]);
    assert_eq!(lines("blue.tri"), of("0040ff", false));
    let said = place.succeeds(&["convert", "plain.toml", "--outlines", "ff8000", "--outlines-alone", "-o", "drawing.tri"]);
    assert!(said.contains(".antialias(true)") && said.contains("\"antialias\""), "{said}");
    let said = place.succeeds(&["inspect", "drawing.tri"]);
    assert!(said.contains("lines of the colour ff8000 along outlines, on the background, without the surfaces"), "{said}");
    place.file("box.obj", TETRAHEDRON);
    place.succeeds(&["convert", "box.obj", "--outlines", "112233", "-o", "box.tri"]);
    assert_eq!(lines("box.tri"), of("112233", false));
    // What is drawn: the picture of a stream is that of the text, and that of the option of `render`.
    let drawn = |arguments: &[&str]| {
        let line = place.succeeds(&[&["render", "--size", "64x48", "--json", "-o", "out.png"], arguments].concat());
        serde_json::from_str::<serde_json::Value>(&line).expect("JSON")["crc"].clone()
    };
    let drawing = drawn(&["drawing.toml"]);
    assert_eq!(drawing, drawn(&["drawing.tri"]));
    assert_eq!(drawing, drawn(&["plain.toml", "--outlines", "ff8000", "--outlines-alone"]));
    assert_eq!(drawing, drawn(&["blue.tri", "--outlines", "ff8000", "--outlines-alone"]));
    assert_ne!(drawing, drawn(&["plain.toml"]));
    let usage = [
        &["convert", "plain.toml", "--outlines", "red"][..],
        &["convert", "plain.toml", "--outlines-alone"],
        &["render", "plain.toml", "--outlines-alone"],
        &["render", "plain.toml", "--no-antialias", "--outlines-alone"],
        &["size", "white.toml"],
    ];
    usage.into_iter().for_each(|arguments| place.fails(arguments, 2, &["outlines"]));
}

#[test]
fn perspective_is_corrected_or_refused() {
    let place = Place::new();
    let words = ["goldman cannot interpolate light in perspective"];
    place.fails(&["render", "teapot", "--shader", "goldman", "--perspective-correct"], 1, &words);
    place.fails(&["compare", "teapot", "--size", "64x48", "--shader", "duff,goldman", "--perspective-correct"], 1, &words);
    let compare = ["compare", "teapot", "--size", "64x48", "--shader", "all", "--perspective-correct", "--json"];
    assert_eq!(place.succeeds(&compare).lines().filter(|line| line.contains(&words[0][7..])).count(), 10);
    for more in [&[][..], &["--perspective-correct"]] {
        let line = place.succeeds(&[&["render", "torus", "--size", "64x48", "--json"], more].concat());
        let other = place.succeeds(&["render", "torus", "--size", "64x48", "--json"]);
        assert_eq!(line, other, "parallel rays make no difference");
    }
}

#[test]
fn cameras_that_mirror_or_skew_are_refused() {
    use microphong::stream::record::Header;
    use zerocopy::{FromBytes, IntoBytes};
    let changes: [fn(&mut Header); 3] = [
        |header| header.camera.rotation[0] = header.camera.rotation[0].map(|c| -c),
        |header| header.camera.rotation[1] = header.camera.rotation[0],
        |header| header.camera.rotation[2][0] /= 2,
    ];
    for change in changes {
        let mut bad = good();
        let mut header = Header::read_from_prefix(&bad).expect("a header").0;
        change(&mut header);
        bad[..size_of::<Header>()].copy_from_slice(header.as_bytes());
        stream::seal(&mut bad);
        assert_eq!(parse(&bad), Err(StreamError::Field { name: "camera rotation", record: 0 }));
    }
}

/// Streams may name methods that other programs have.
#[test]
fn methods_that_are_not_here_are_named() {
    use microphong::stream::record::Header;
    use zerocopy::{FromBytes, IntoBytes};
    let mut other = good();
    let mut header = Header::read_from_prefix(&other).expect("a header").0;
    header.shader = 40_000;
    other[..size_of::<Header>()].copy_from_slice(header.as_bytes());
    stream::seal(&mut other);
    let place = Place::new();
    place.file("other.tri", &other);
    place.fails(&["render", "other.tri"], 1, &["other", "40000", "--shader"]);
    assert!(place.succeeds(&["inspect", "other.tri"]).contains("shader number 40000"));
    let line = place.succeeds(&["render", "other.tri", "--shader", "phong", "--size", "33x17", "--json"]);
    assert_eq!(serde_json::from_str::<serde_json::Value>(&line).expect("JSON")["shader"], "phong");
}

/// A table that fits 100 columns, or one object per claim of the papers asked for.
#[test]
fn papers_are_told_as_table_and_as_json() {
    let place = Place::new();
    let table = place.succeeds(&["papers"]);
    assert!(table.lines().all(|line| line.chars().count() <= 100), "{table}");
    assert!(table.contains("cannot be reproduced"));
    let objects = place.succeeds(&["papers", "--only", "goldman,vlasic", "--json"]);
    for line in objects.lines() {
        let claim: serde_json::Value = serde_json::from_str(line).expect("an object");
        assert!(["vlasic", "goldman"].contains(&claim["topic"].as_str().expect("a topic")), "{line}");
        for key in ["source", "what", "unit", "paper", "ours", "verdict", "note"] {
            assert!(!claim[key].is_null(), "{key}: {line}");
        }
    }
}
