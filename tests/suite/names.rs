//! Objects keep their names from file to program: `convert` makes meshes of them, the stream carries their names, and a program finds them.

use crate::golden::root;
use embedded_graphics::{pixelcolor::Rgb565, prelude::Size};
use microphong::{Stream, stream};
use microphong_sim::{bytes::StreamBytes, render, scene, script, shader::Shader, stress::fuzz};
use microphong_tests::program;
use std::{fs, ops::Range, process::Command};
use tempfile::TempDir;

/// A folder with files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("scratch directory");
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).expect("a file"));
    folder
}

/// The output of `convert` for a file, and the stream that it makes.
fn convert(folder: &TempDir, arguments: &[&str]) -> (String, StreamBytes) {
    let output = Command::new(program()).current_dir(folder).arg("convert").args(arguments).args(["-o", "out.tri"]).output().expect("it");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    (String::from_utf8_lossy(&output.stdout).into_owned(), StreamBytes::read(&folder.path().join("out.tri")).expect("a stream"))
}

/// The names of a stream, and the meshes of each.
fn names<'a>(stream: &Stream<'a>) -> Vec<(&'a str, Range<u16>)> {
    stream.names().collect::<Result<_, _>>().expect("valid names")
}

/// Vertices of tetrahedra in a row, and their faces by `statements`: `#` is the next tetrahedron.
fn tetrahedra(statements: &str) -> String {
    let (mut text, mut count) = (String::from("mtllib colours.mtl\n"), 0);
    for line in statements.lines() {
        if line != "#" {
            text += &format!("{line}\n");
            continue;
        }
        let [x, first] = [3 * count, 4 * count];
        count += 1;
        text += &format!("v {x} 0 0\nv {} 0 0\nv {x} 1 0\nv {x} 0 1\n", x + 1);
        for face in [[1, 3, 2], [1, 2, 4], [2, 3, 4], [1, 4, 3]] {
            let [a, b, c] = face.map(|corner| first + corner);
            text += &format!("f {a} {b} {c}\n");
        }
    }
    text
}

const COLOURS: &str = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";

#[test]
fn objects_of_an_obj_file_are_meshes_with_names() {
    let two = tetrahedra("usemtl red\no dial\n#\no needle\n#");
    let folder = folder(&[("two.obj", &two), ("colours.mtl", COLOURS)]);
    let (said, bytes) = convert(&folder, &["two.obj"]);
    for words in ["mesh 0: \"dial\", material 0 \"red\", 4 triangles\n", "mesh 1: \"needle\", material 0 \"red\", 4 triangles\n"] {
        assert!(said.contains(words), "{said}");
    }
    // A record of a mesh has 20 bytes, and each name a byte more than it has letters.
    assert!(said.contains("--merge saves 1 mesh, 32 bytes of flash"), "{said}");
    let stream = bytes.parse().expect("a stream");
    assert_eq!(names(&stream), [("dial", 0..1), ("needle", 1..2)]);
    assert_eq!(stream.mesh("needle").expect("it is there"), 1..2);

    // With --merge the stream is the one of a file that names nothing.
    let (said, merged) = convert(&folder, &["two.obj", "--merge"]);
    assert!(!said.contains("dial") && !said.contains("--merge"), "{said}");
    fs::write(folder.path().join("plain.obj"), tetrahedra("usemtl red\n#\n#")).expect("a file");
    let (_, plain) = convert(&folder, &["plain.obj"]);
    assert_eq!(merged, plain);
    assert_eq!(bytes.as_bytes().len(), plain.as_bytes().len() + 32);
    let plain = plain.parse().expect("a stream");
    assert!(plain.names.is_empty() && stream::length(plain.header) == Some(plain.header.length));
    // The picture is made of the same triangles in the same order.
    let normals = |stream: &Stream<'_>| stream.triangles.iter().map(|t| (t.normal, t.offset)).collect::<Vec<_>>();
    assert_eq!(normals(&stream), normals(&plain));
}

#[test]
fn an_object_of_several_materials_and_levels_has_one_name() {
    let mixed = tetrahedra("o car\nusemtl red\n#\nusemtl blue\n#\no wheel\nusemtl blue\n#\nusemtl red\n#");
    let folder = folder(&[("mixed.obj", &mixed), ("colours.mtl", COLOURS)]);
    let (said, bytes) = convert(&folder, &["mixed.obj"]);
    assert!(said.contains("mesh 3: \"wheel\", material 1 \"blue\", 4 triangles"), "{said}");
    assert_eq!(names(&bytes.parse().expect("a stream")), [("car", 0..2), ("wheel", 2..4)]);

    let teapot = fs::read_to_string(root().join("meshes/teapot.obj")).expect("a mesh");
    fs::write(folder.path().join("teapot.obj"), format!("o pot\n{teapot}")).expect("a file");
    let (said, bytes) = convert(&folder, &["teapot.obj", "--crease", "180", "--lod", "96x96,32x32"]);
    let stream = bytes.parse().expect("a stream");
    assert!(stream.meshes.len() == 3 && said.contains("meshes 0 to 2: \"pot\", material 0, 992 triangles"), "{said}");
    assert_eq!(names(&stream), [("pot", 0..3)]);
}

#[test]
fn groups_name_what_objects_do_not() {
    let named = |statements: &str| -> Vec<String> {
        let folder = folder(&[("mesh.obj", &tetrahedra(statements)), ("colours.mtl", COLOURS)]);
        let (_, bytes) = convert(&folder, &["mesh.obj"]);
        names(&bytes.parse().expect("a stream")).into_iter().map(|(name, _)| name.to_owned()).collect()
    };
    assert_eq!(named("g front wheel\n#\ng body\n#\ng front wheel\n#"), ["front wheel", "body"]);
    assert_eq!(named("o car\ng wheel\n#\ng body\n#"), ["wheel", "body"]);
    assert_eq!(named("o car\ng wheel\n#\no lorry\ng wheel\n#"), ["car", "lorry"]);
    assert_eq!(named("g part\n#"), ["part"]);
    // Faces may come before any name.
    assert_eq!(named("#\no needle\n#"), ["object 0", "needle"]);
}

#[test]
fn names_that_cannot_be_kept_are_changed_and_said() {
    let long = "é".repeat(200);
    let folder = folder(&[("mesh.obj", &tetrahedra(&format!("o part\n#\no part\n#\no {long}\n#")))]);
    let (said, bytes) = convert(&folder, &["mesh.obj"]);
    assert!(said.contains("objects of the same name have numbers: \"part 2\"") && said.contains("cut to 255 bytes"), "{said}");
    assert_eq!(names(&bytes.parse().expect("a stream")), [("part", 0..1), ("part 2", 1..2), (&"é".repeat(127)[..], 2..3)]);
}

/// Two nodes of one mesh; the second node has no name.
#[test]
fn nodes_of_a_gltf_file_are_meshes_with_names() {
    let positions: Vec<u8> =
        [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].concat().into_iter().flat_map(f32::to_le_bytes).collect();
    let numbers: String = positions.iter().map(|byte| format!("%{byte:02X}")).collect();
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],
        "nodes":[{{"mesh":0,"name":"left wing"}},{{"mesh":0,"translation":[3,0,0]}}],
        "meshes":[{{"name":"wing","primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream,{numbers}"}}]}}"#
    );
    let folder = folder(&[("wings.gltf", &text)]);
    let (said, bytes) = convert(&folder, &["wings.gltf"]);
    assert!(said.contains("mesh 0: \"left wing\", material 0, 1 triangle\n"), "{said}");
    let stream = bytes.parse().expect("a stream");
    assert_eq!(names(&stream), [("left wing", 0..1), ("wing", 1..2)]);
    let right = stream.mesh("wing").ok().and_then(|meshes| stream.vertices_of(&stream.meshes[usize::from(meshes.start)]));
    assert!(right.expect("its vertices").iter().all(|vertex| vertex.position[0] > 0), "the second node lies to the right");
}

#[test]
fn meshes_of_a_scene_text_have_their_names() {
    let text = fs::read_to_string(root().join("scenes/gauges.toml")).expect("a scene");
    let (bytes, _) = script::stream(&text, None).expect("a stream");
    let stream = bytes.parse().expect("a stream");
    let list = names(&stream);
    assert!(text.contains(&format!("name = \"{}\"", list[0].0)) && list.last().expect("names").1.end == stream.meshes.len() as u16);
    for name in ["", &"x".repeat(256)] {
        let error = script::stream(&text.replace(&format!("name = \"{}\"", list[0].0), &format!("name = \"{name}\"")), None);
        assert!(
            format!("{:#}", error.expect_err("no such name")).contains(&format!("it has {} bytes; a name can have 1 to 255", name.len()))
        );
    }
}

#[test]
fn a_name_that_is_not_there_is_told_with_those_that_are() {
    let folder = folder(&[("two.obj", &tetrahedra("o dial\n#\no needle\n#"))]);
    let (_, bytes) = convert(&folder, &["two.obj"]);
    let stream = bytes.parse().expect("a stream");
    let said = |name| stream.mesh(name).expect_err("it is not there").to_string();
    assert_eq!(said("needel"), "the stream has no mesh \"needel\"; it has \"dial\", \"needle\"");
    let teapot = scene::load("teapot").expect("a scene").stream;
    let error = teapot.parse().expect("a stream").mesh("spout").expect_err("it is not there").to_string();
    assert_eq!(error, "the stream has no mesh \"spout\"; its meshes have no names: convert a file that names objects, without --merge");
}

#[test]
fn inspect_lists_meshes() {
    let folder = folder(&[("two.obj", &tetrahedra("o dial\n#\no needle\n#"))]);
    convert(&folder, &["two.obj"]);
    let inspect = |arguments: &[&str]| {
        let output = Command::new(program()).current_dir(&folder).args(["inspect", "out.tri"]).args(arguments).output().expect("it");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let said = inspect(&[]);
    assert!(said.contains("2 names            12 bytes") && said.contains("  mesh 1: \"needle\", material 0, 4 triangles\n"), "{said}");
    let line: serde_json::Value = serde_json::from_str(&inspect(&["--json"])).expect("JSON");
    let row = serde_json::json!({"index": 1, "end": 2, "name": "needle", "material": 0, "triangles": 4, "colours": 0, "of_one_colour": 0, "texture": null, "has_holes": false, "transparency": 0});
    assert_eq!(line["list"][1], row);
}

/// A stream with `names` behind its records.
fn ending_in(stream: &StreamBytes, names: &[u8]) -> StreamBytes {
    let mut bytes = [stream.as_bytes(), names].concat();
    let length = (bytes.len() as u32).to_le_bytes();
    bytes[8..12].copy_from_slice(&length);
    stream::seal(&mut bytes);
    StreamBytes::from(&bytes[..])
}

#[test]
fn names_that_are_not_valid_are_refused_where_they_are_read() {
    let folder = folder(&[("two.obj", &tetrahedra("o dial\n#\no needle\n#"))]);
    let (_, two) = convert(&folder, &["two.obj", "--merge", "--colour", "ff0000"]);
    let (_, teapot) = convert(&folder, &[&root().join("meshes/teapot.obj").display().to_string(), "--lod", "32x32"]);
    let cases: [(&StreamBytes, &[u8], Option<u32>); 9] = [
        (&two, b"", None),
        (&two, b"\x03pot", None),
        (&two, b"\x00", Some(0)),
        (&two, b"\x04pot", Some(0)),
        (&two, b"\x02\xC3\x28", Some(0)),
        (&two, b"\x03pot\x03lid", Some(1)),
        (&two, b"\x03pot\x00", Some(0)),
        (&teapot, b"\x03pot", Some(1)),
        // A coarser level is no object.
        (&teapot, b"\x03pot\x03lid", Some(1)),
    ];
    for (stream, names, fault) in cases {
        let bytes = ending_in(stream, names);
        let stream = bytes.parse().expect("names are left unchecked");
        fuzz::ask(&stream);
        let path = folder.path().join("named.tri");
        fs::write(&path, bytes.as_bytes()).expect("a file");
        let read = StreamBytes::read(&path).map(drop).map_err(|error| format!("{error:#}"));
        let Some(record) = fault else {
            read.expect("valid names");
            continue;
        };
        let fault = format!("mesh name of record {record} is out of range");
        assert!(read.is_err_and(|error| error.contains(&fault) && error.contains("named.tri")), "{names:?}");
        assert!(stream.mesh("spout").expect_err("it is not there").to_string().contains(&fault), "{names:?}");
        assert_eq!(stream.names().filter(Result::is_err).count(), 1, "{names:?}");
    }
}

/// Neither names nor meshes by object change a picture.
#[test]
fn pictures_are_those_of_merged_meshes() {
    let folder = folder(&[("two.obj", &tetrahedra("usemtl red\no dial\n#\no needle\n#\nusemtl blue\n#")), ("colours.mtl", COLOURS)]);
    let draw = |arguments: &[&str]| {
        let (_, bytes) = convert(&folder, &[&["two.obj"], arguments].concat());
        let stream = bytes.parse().expect("a stream");
        let frame = |number| render::frame::<Rgb565>(stream, Size::new(64, 48), Shader::AUTO, 16, number).expect("a picture");
        [0, 30, 60, 90].map(frame)
    };
    for ((by_object, stats), (merged, _)) in draw(&[]).into_iter().zip(draw(&["--merge"])) {
        assert!(by_object == merged && stats.drawn >= 3);
    }
}
