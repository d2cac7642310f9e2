//! Model files of every kind, as programs write them: the command converts them, and says what it left out, or what else the file is.

use microphong::stream::record::Material;
use microphong_sim::bytes::StreamBytes;
use microphong_tests::program;
use serde_json::Value;
use std::{
    fs,
    io::Write,
    path::Path,
    process::{Command, Output},
};
use tempfile::TempDir;

/// A scratch directory in which the command runs.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("scratch directory"))
    }

    fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> &Self {
        let path = self.0.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, contents).expect("a file");
        self
    }

    fn run(&self, arguments: &[&str]) -> Output {
        Command::new(program()).args(arguments).current_dir(self.0.path()).output().expect("the program")
    }

    /// The output of `convert`, which must succeed.
    #[track_caller]
    fn converts(&self, arguments: &[&str]) -> String {
        let output = self.run(&[&["convert", "-o", "out.tri"], arguments].concat());
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    }

    /// What `convert` counts.
    #[track_caller]
    fn counts(&self, file: &str) -> Value {
        serde_json::from_str(&self.converts(&[file, "--json"])).expect("JSON")
    }

    /// The error of a command, which must fail with code 1 and write nothing.
    #[track_caller]
    fn fails(&self, arguments: &[&str]) -> String {
        let _ = fs::remove_file(self.0.path().join("out.tri"));
        let output = self.run(arguments);
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {stderr}");
        assert!(!stderr.contains("panicked") && output.stdout.is_empty(), "{arguments:?}: {stderr}");
        assert!(!Path::new(&self.0.path().join("out.tri")).exists(), "{arguments:?}");
        stderr
    }

    /// The error of `convert` for a file.
    #[track_caller]
    fn refuses(&self, file: &str) -> String {
        self.fails(&["convert", file, "-o", "out.tri"])
    }

    /// The colours of all palettes of the last stream.
    fn palette(&self) -> Vec<[u8; 3]> {
        let bytes = StreamBytes::read(&self.0.path().join("out.tri")).expect("a stream");
        bytes.parse().expect("a stream").colours.iter().map(|colour| colour.channels).collect()
    }

    /// The diffuse colours of the last stream.
    fn colours(&self) -> Vec<[f32; 3]> {
        let bytes = StreamBytes::read(&self.0.path().join("out.tri")).expect("a stream");
        let stream = bytes.parse().expect("a stream");
        stream.materials.iter().map(|material: &Material| material.diffuse().map(|gain| gain.to_num::<f32>())).collect()
    }
}

/// The corners of a cube.
const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
const SIDES: [&str; 6] = ["f 1 3 4 2\n", "f 5 6 8 7\n", "f 1 2 6 5\n", "f 3 7 8 4\n", "f 1 5 7 3\n", "f 2 4 8 6\n"];

/// A cube of which three sides have each of two materials.
fn of_two_materials([one, other]: [&str; 2], library: &str) -> String {
    format!("mtllib {library}\n{CORNERS}usemtl {one}\n{}usemtl {other}\n{}", SIDES[..3].concat(), SIDES[3..].concat())
}

#[test]
fn materials_are_found_by_names_of_every_kind() {
    let place = Place::new();
    let names: [[&[u8]; 2]; 6] = [
        [b"Material__#25", b"Material__#26"],
        [b"Material #112", b"Material #113"],
        [b"Material # 1", b"Material # 2"],
        [b"Rot\xE4", b"Rot\xF6"],
        ["Rotä".as_bytes(), "Rotö".as_bytes()],
        // Shift JIS, in which the last byte is that of a backslash.
        [b"\x95\x5C", b"\x90\x5C"],
    ];
    for [one, other] in names {
        // The bytes of a name take the place of words that are the same in every encoding.
        let with = |text: &str| {
            let mut bytes = Vec::new();
            for part in text.split_inclusive(['<', '>']) {
                bytes.extend(part.trim_end_matches(['<', '>']).bytes());
                bytes.extend(if part.ends_with('<') {
                    one
                } else if part.ends_with('>') {
                    other
                } else {
                    b""
                });
            }
            bytes
        };
        place.file("a.mtl", with("newmtl <\nKd 1 0 0\nNEWMTL >\nKD 0 0 1\n")).file("a.obj", with(&of_two_materials(["<", ">"], "a.mtl")));
        let said = place.converts(&["a.obj"]);
        assert!(said.contains("2 materials from the file") && !said.contains("no file defines"), "{said}");
        let [[red, ..], [.., blue]] = place.colours()[..] else { panic!("{said}") };
        assert!(red > 0.9 && blue > 0.9, "{said}");
    }
    // As Windows writes the name of the file, and finds it.
    place
        .file("Textures/Two Words.MTL", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 0 1\n")
        .file("b.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 0 1\n");
    for library in [".\\b.mtl", "B.MTL", "\"b.mtl\"", "C:\\Users\\me\\b.mtl", "textures\\two words.mtl", "none.mtl b.mtl", "/home/me/b.mtl"]
    {
        place.file("a.obj", of_two_materials(["a", "b"], library));
        let said = place.converts(&["a.obj"]);
        assert!(said.contains("2 materials from the file"), "{library}: {said}");
    }
    place.file("a.obj", of_two_materials(["a", "b"], "c.mtl")).file("c.mtl", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
    let said = place.converts(&["a.obj"]);
    assert!(said.contains("the materials are missing: ") && said.contains("a pointer of Git LFS"), "{said}");
}

/// Single wrong elements are left out and said, by all commands; `--strict` refuses them.
#[test]
fn single_faults_are_said_and_strict_refuses_them() {
    let place = Place::new();
    let normals: String = ["0 0 -1", "0 0 1", "0 -1 0", "0 1 0", "-1 0 0", "0 0 0"].map(|normal| format!("vn {normal}\n")).concat();
    let with_normals: String = SIDES
        .iter()
        .zip(1..)
        .map(|(side, normal)| {
            let corners: String = side.split_whitespace().skip(1).map(|corner| format!(" {corner}//{normal}")).collect();
            format!("f{corners}\n")
        })
        .collect();
    let good = format!("{CORNERS}{}", SIDES.concat());
    let reversed = good.replace("f 1 3 4 2", "f 2 4 3 1").replace("f 2 4 8 6", "f 6 8 4 2");
    let cases = [
        (format!("{good}f 1 2\n"), "1 face has fewer than three corners and is left out: line 15"),
        (format!("vn nan nan nan\n{good}"), "1 normal is not three finite numbers and is left out, because no face uses it: line 1"),
        (format!("{good}v 1 2 1.#INF\n"), "1 vertex is not three finite numbers and is left out, because no face uses it: line 15"),
        (
            format!("{CORNERS}{normals}{with_normals}"),
            "4 corners have normals without a direction; they are computed, and the others are those of the file; the first: face 6",
        ),
        (
            reversed.clone(),
            "2 faces were wound against their neighbours, or their closed parts were inside out, and are turned; the first: face 1",
        ),
    ];
    for (text, said) in cases {
        place.file("a.obj", text);
        assert!(place.converts(&["a.obj"]).contains(&format!("  {said}\n")), "{said}");
        let counts = place.counts("a.obj");
        assert_eq!((&counts["closed_convex"], &counts["triangles"]), (&true.into(), &12.into()), "{said}");
        let error = place.fails(&["convert", "a.obj", "--strict", "-o", "out.tri"]);
        assert!(error.contains(&format!("a.obj: {said}; --strict refuses it: repair the file")), "{error}");
        // A command that draws the file says it as well.
        let inspected = place.run(&["inspect", "a.obj"]);
        let stderr = String::from_utf8_lossy(&inspected.stderr);
        assert!(inspected.status.success() && stderr.contains(&format!("warning: a.obj: {said}")), "{stderr}");
    }
    place.file("a.obj", &good).converts(&["a.obj", "--strict"]);
    // What is mended is the same stream as what was right.
    let stream = |place: &Place| fs::read(place.0.path().join("out.tri")).expect("a stream");
    let right = stream(&place);
    for (text, mended) in [(reversed, 2), (good.clone(), 0), (good.replace("f 1 3 4 2", "f 1 2 4 3"), 1)] {
        place.file("a.obj", text);
        assert_eq!(place.counts("a.obj")["mended"], mended);
        assert_eq!(stream(&place).len(), right.len());
    }
    // A mesh file of a scene is told with the scene.
    place.file("a.obj", format!("{good}f 1 2\n"));
    place.file("a.toml", "frames = 1\n[camera]\nat = [0, 0, 5]\n[[mesh]]\nname = \"a\"\nfile = \"a.obj\"\n[[object]]\nmesh = \"a\"\n");
    let output = place.run(&["convert", "a.toml", "-o", "out.tri"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("warning: a.toml: a.obj: 1 face has fewer than three corners"));
}

#[test]
fn edges_of_open_and_crowded_surfaces_are_counted() {
    let place = Place::new();
    let counts = |text: &str| {
        place.file("a.obj", text);
        let counts = place.counts("a.obj");
        ["open_edges", "opposed_edges", "crowded_edges"].map(|kind| counts[kind].as_u64().expect("a number"))
    };
    let closed = format!("{CORNERS}{}", SIDES.concat());
    assert_eq!(counts(&closed), [0; 3]);
    assert!(!place.converts(&["a.obj"]).contains("edge"));
    assert_eq!(counts(&closed.replace(SIDES[5], "")), [4, 0, 0]);
    let said = place.converts(&["a.obj"]);
    assert!(said.contains("  4 edges have one face only: the surface is open") && said.contains("--flip"), "{said}");
    assert_eq!(counts(&format!("{closed}v 5 5 5\nf 1 2 9\n")), [2, 0, 1]);
    let said = place.converts(&["a.obj"]);
    assert!(said.contains("  1 edge has more than two faces") && said.contains("remove doubled and inner faces"), "{said}");
    let band = "v 1 0 0\nv 1 0 1\nv -1 1 0\nv -1 1 1\nv -1 -1 0\nv -1 -1 1\nf 1 3 4 2\nf 3 5 6 4\nf 5 2 1 6\n";
    assert_eq!(counts(band), [6, 1, 0]);
    let said = place.converts(&["a.obj"]);
    assert!(said.contains("  1 edge has two faces that disagree about the front"), "{said}");
}

/// A surface whose normals point to its back may be inside out, which only the user can tell where it is open.
#[test]
fn normals_that_point_backwards_are_counted() {
    let place = Place::new();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1 4//1\n";
    let said = place.file("a.obj", square).converts(&["a.obj"]);
    assert!(
        said.contains("  2 triangles have normals of the file that point backwards; if the picture is inside out, use --flip"),
        "{said}"
    );
    assert_eq!(place.counts("a.obj")["backward_normals"], 2);
    let flipped = place.converts(&["a.obj", "--flip"]);
    assert!(!flipped.contains("backwards") && flipped.contains("surface turned inside out"), "{flipped}");
    place.file("a.obj", square.replace("0 0 -1", "0 0 1"));
    assert_eq!(place.counts("a.obj")["backward_normals"], 0);
}

/// What is no model says what it is, whatever its name is, and no words of libraries come through.
#[test]
fn other_files_say_what_they_are_and_what_helps() {
    let place = Place::new();
    let iges = format!("{:72}S{:>7}\n", "a part", 1);
    let cases: [(&[u8], [&str; 2]); 15] = [
        (b"../meshes/a.obj\n", ["the path of another file, as Git stores a link", "name that file"]),
        (b"ISO-10303-21;\nHEADER;\n", ["STEP, a CAD format", "export it as STL, OBJ or glTF"]),
        (iges.as_bytes(), ["IGES, a CAD format", "FreeCAD"]),
        (b"Kaydara FBX Binary  \0", ["the format FBX", "assimp export"]),
        (b"; FBX 7.3.0 project file\n", ["the format FBX", "assimp export"]),
        (b"BLENDER-v402", ["the format Blender", "assimp export"]),
        (b"PK\x03\x04\x14\0\0\0 3D/3dmodel.model", ["3MF: the archive is damaged or cut off", "get the file again"]),
        (b"PK\x03\x04\x14\0\0\0 a.obj", ["compressed by zip", "unzip"]),
        (b"\x1F\x8B\x08\0", ["compressed by gzip", "gunzip -c"]),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n", ["a pointer of Git LFS", "git lfs pull"]),
        (b"\n<!DOCTYPE html><html>", ["a web page", "download the model itself"]),
        (b"<?xml version=\"1.0\"?>\n<COLLADA>", ["the format COLLADA", "assimp export"]),
        (b"\x89PNG\r\n\x1a\n", ["a picture (PNG)", "name the file of a model"]),
        (b"mTRI\x01\0\0\0", ["a stream of microphong", "converted already"]),
        (&[0; 99], ["all its 99 bytes are zero", "get the file again"]),
    ];
    for (bytes, words) in cases {
        for file in ["a.obj", "a.stl", "a.ply", "a.glb", "a.gltf", "a"] {
            let error = place.file(file, bytes).refuses(file);
            assert!(error.contains(&format!("{file}: ")) && words.iter().all(|word| error.contains(word)), "{error}");
        }
        let drawn = place.fails(&["render", "a.obj"]);
        assert!(words.iter().all(|word| drawn.contains(word)), "{drawn}");
    }
    // Files that were cut off, and nothing at all.
    let binary: Vec<u8> = [&[b' '; 80][..], &2u32.to_le_bytes(), &[0; 99]].concat();
    for (file, bytes, words) in [
        ("a.stl", &binary[..], "binary STL, cut off: it has 183 bytes, in which 1 of 2 triangles are whole"),
        ("b.stl", b"\0\x01", "binary STL, cut off"),
        ("c.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "triangle 1, line 2: the file ends before its facet does"),
        ("d.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n", "PLY, line 4: Unexpected end of file"),
        ("j.ply", b"a letter\n", "j.ply: PLY, line 1: the magic number `ply` is missing"),
        ("k.stl", b"{\"message\": \"Not Found\"}", "text in JSON and no glTF"),
        ("l.ply", b"ply\nformat ascii 1.0\nelement vertex three\n", "PLY, line 3: Couldn't parse line: a header has lines with `format`"),
        ("e.glb", b"glTF\x02\0\0\0\xFF\0\0\0", "GLB: the file is shorter than its head says; it was cut off"),
        ("f.gltf", b"{\"asset\": {\"version\": \"2.0\"}", "it was cut off"),
        ("m.3mf", b"v 0 0 0\n", "m.3mf: 3MF: the file is no zip archive, as 3MF is"),
        ("n.3mf", b"PK\x05\x06", "n.3mf: 3MF: the archive is damaged or cut off"),
        ("g.obj", b"", "the file is empty"),
        ("h.obj", b"Dear reader,\nthis is a letter.\n", "nothing in the file is OBJ, glTF, STL, PLY or 3MF"),
        ("i.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "the mesh has no faces; export it with polygons"),
    ] {
        let error = place.file(file, bytes).refuses(file);
        assert!(error.contains(file) && error.contains(words), "{error}");
        for innards in ["ParseError", "failed to fill", "expected one of", "Nan", "Some(", "location"] {
            assert!(!error.contains(innards), "{error}");
        }
    }
}

/// A model opens no file outside its folder, and no device, and no file is read without end.
#[test]
fn models_open_only_files_beside_them() {
    let place = Place::new();
    place.file("secret.mtl", "newmtl a\nKd 1 0 0\n");
    let mesh = |library: &str| place.file("in/a.obj", format!("mtllib {library}\nusemtl a\n{CORNERS}{}", SIDES.concat()));
    for library in ["../secret.mtl".to_owned(), place.0.path().join("secret.mtl").display().to_string(), "..\\secret.mtl".to_owned()] {
        mesh(&library);
        let said = place.converts(&["in/a.obj"]);
        let words = [
            "the materials are missing: ",
            "lies outside the folder of the model; put it at in/secret.mtl, or allow such files with --allow-outside",
        ];
        assert!(words.iter().all(|word| said.contains(word)) && !said.contains("1 material"), "{said}");
        assert!(place.converts(&["in/a.obj", "--allow-outside"]).contains("1 material from the file"), "{library}");
    }
    let endless = |uri: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":"{uri}"}}]}}"#
        )
    };
    let error = place.file("a.gltf", endless("/dev/zero")).refuses("a.gltf");
    assert!(error.contains("a.gltf: glTF, buffer 0: \"/dev/zero\" lies outside the folder of the model"), "{error}");
    #[cfg(unix)]
    {
        let error = place.fails(&["convert", "a.gltf", "--allow-outside", "-o", "out.tri"]);
        assert!(error.contains("/dev/zero is no regular file"), "{error}");
        std::os::unix::fs::symlink("/dev/zero", place.0.path().join("zero.bin")).expect("a link");
        let error = place.file("a.gltf", endless("zero.bin")).refuses("a.gltf");
        assert!(error.contains("zero.bin is a link out of the folder of the model"), "{error}");
    }
}

/// A PNG of pixels in one row.
fn row_of(pixels: &[[u8; 3]]) -> Vec<u8> {
    image_of(pixels, pixels.len())
}

/// A PNG of rows of this width, of red, green and blue, and maybe of opacity.
fn image_of<const CHANNELS: usize>(pixels: &[[u8; CHANNELS]], width: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, (pixels.len() / width) as u32);
    encoder.set_color(if CHANNELS == 4 { png::ColorType::Rgba } else { png::ColorType::Rgb });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().expect("a header").write_image_data(pixels.as_flattened()).expect("pixels");
    bytes
}

/// A cube whose sides are each in the middle of one of `count` patches of a texture.
fn of_patches(count: usize, library: &str) -> String {
    let places: String = (0..count).map(|patch| format!("vt {} 0.5\n", (patch as f64 + 0.5) / count as f64)).collect();
    let sides = SIDES.iter().enumerate().map(|(number, side)| {
        let corners = side[2..].split_whitespace().map(|corner| format!(" {corner}/{}", number % count + 1));
        format!("f{}\n", corners.collect::<String>())
    });
    format!("mtllib {library}\n{CORNERS}{places}usemtl paint\n{}", sides.collect::<String>())
}

/// The colours of a texture that is a palette, and of vertices, become colours at corners under the material of the file.
#[test]
fn faces_have_the_colours_of_textures_and_vertices() {
    let place = Place::new();
    let patches = [[255, 0, 0], [0, 255, 0], [0, 0, 255]];
    place.file("a.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd a.png\n").file("a.png", row_of(&patches)).file("a.obj", of_patches(3, "a.mtl"));
    let said = place.converts(&["a.obj"]);
    assert!(said.contains("12 triangles have 3 colours of textures and vertices at the corners: none is farther than 12 of 255"), "{said}");
    assert!(said.contains("mesh 0: material 0 \"paint\", 12 triangles with 3 colours, 12 of them of one colour"), "{said}");
    // Equally frequent colours come in the order of their channels.
    assert_eq!((place.palette(), place.colours()), ([patches[2], patches[1], patches[0]].to_vec(), vec![[1.0; 3]]));
    let colours = &place.counts("a.obj")["colours"];
    assert_eq!(["colours", "palettes", "triangles", "of_one_colour", "split", "far"].map(|field| &colours[field]), [3, 1, 12, 12, 0, 0]);
    let inspected = String::from_utf8(place.run(&["inspect", "out.tri"]).stdout).expect("text");
    assert!(inspected.contains("3 colours") && inspected.contains("12 triangles with 3 colours, 12 of them of one colour"), "{inspected}");
    let said = place.converts(&["a.obj", "--colours", "none"]);
    assert!(said.contains("left out: texture coordinates, textures") && place.colours() == [[1.0; 3]], "{said}");
    assert!(place.palette().is_empty() && place.counts("a.obj")["colours"] != Value::Null);
    // In JPEG, colours are nearly the same.
    place.file("a.png", include_bytes!("../data/red.jpg"));
    place.converts(&["a.obj"]);
    let [[red, green, blue]] = place.palette()[..] else { panic!("{:?}", place.palette()) };
    assert!(red > 247 && green < 8 && blue < 8, "{red} {green} {blue}");
    // A damaged image and one of another kind are said, and the mesh has its material. Without colours, nobody reads them.
    for (bytes, what) in [(row_of(&patches)[..40].to_vec(), "the image is damaged"), (b"GIF89a".to_vec(), "neither PNG nor JPEG")] {
        let said = place.file("a.png", bytes).converts(&["a.obj"]);
        assert!(said.contains("the texture a.png is left out: ") && said.contains(what) && place.colours() == [[1.0; 3]], "{said}");
        assert!(!place.converts(&["a.obj", "--colours", "none"]).contains(what));
    }
    // One colour for the whole mesh takes the place of all.
    place.file("a.png", row_of(&patches)).converts(&["a.obj", "--colour", "00ff00", "--diffuse", "1"]);
    assert!(place.palette().is_empty() && place.colours() == [[0.0, 1.0, 0.0]]);
    // One dark vertex does not change what is full.
    let of_bytes: String =
        CORNERS.lines().enumerate().map(|(k, line)| format!("{line} {}\n", if k == 0 { "1 1 1" } else { "0 128 255" })).collect();
    place.file("c.obj", of_bytes + &SIDES.concat()).converts(&["c.obj"]);
    assert_eq!(place.palette(), [[0, 128, 255], [1; 3]]);
    let coloured: String = CORNERS.lines().map(|line| format!("{line} 0 0.5 1\n")).collect();
    let said = place.file("b.obj", coloured + &SIDES.concat()).converts(&["b.obj"]);
    assert!(place.palette() == [[0, 128, 255]] && place.colours() == [[1.0; 3]] && !said.contains("from the file\n"), "{said}");
    let vertices: String = CORNERS.lines().map(|line| format!("{} 0 128 255\n", &line[2..])).collect();
    let faces: String = SIDES
        .iter()
        .map(|side| {
            let corners = side[2..].split_whitespace().map(|corner| format!(" {}", corner.parse::<u32>().expect("a number") - 1));
            format!("4{}\n", corners.collect::<String>())
        })
        .collect();
    let head = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
    place.file("b.ply", format!("{head}{vertices}{faces}")).converts(&["b.ply"]);
    assert_eq!(place.palette(), [[0, 128, 255]]);
    // A scene of several models has the palettes of all, and a mesh that the scene gives a colour has none.
    let mesh = |name: &str, file: &str, more: &str| {
        format!("[[mesh]]\nname = \"{name}\"\nfile = \"{file}\"\n{more}[[object]]\nmesh = \"{name}\"\n")
    };
    let meshes = [
        mesh("a", "a.obj", ""),
        mesh("b", "b.ply", ""),
        mesh("c", "c.obj", "colour = \"ff0000\"\n"),
        mesh("d", "a.obj", "size = [0.5, 1, 1]\n"),
    ];
    place.file("a.toml", format!("frames = 1\n[camera]\nat = [0, 0, 5]\n{}", meshes.concat())).converts(&["a.toml"]);
    let bytes = StreamBytes::read(&place.0.path().join("out.tri")).expect("a stream");
    let stream = bytes.parse().expect("a stream");
    let of = |mesh| stream.colours_of(mesh).map(|colours| colours.palette[usize::from(colours.corners[0].colours[0])].channels);
    let seen: Vec<_> = stream.meshes.iter().map(of).collect();
    assert_eq!(seen, [Some(patches[0]), Some([0, 128, 255]), None, Some(patches[0])]);
    // Equal palettes are one.
    assert!(stream.colours.len() == 17 && stream.meshes[0].palette == stream.meshes[3].palette && stream.materials.len() == 4);
}

/// Transparent materials and holes of textures are told, drawn with the feature `transparency`, and left out by `--opaque`.
#[test]
fn what_is_seen_through_surfaces_is_told() {
    let place = Place::new();
    let glass = format!("mtllib a.mtl\n{CORNERS}usemtl glass\n{}\nusemtl air\n{}\n", SIDES[..3].join("\n"), SIDES[3..].join("\n"));
    place.file("a.mtl", "newmtl glass\nKd 1 1 1\nd 0.375\nnewmtl air\nKd 1 1 1\nTr 1\n").file("a.obj", glass);
    let transparency = || {
        let bytes = StreamBytes::read(&place.0.path().join("out.tri")).expect("a stream");
        bytes.parse().expect("a stream").meshes.iter().map(microphong::stream::record::Mesh::transparency).collect::<Vec<_>>()
    };
    let said = place.converts(&["a.obj"]);
    assert_eq!(transparency(), [10, 15]);
    for words in [
        "the file makes these materials invisible, and they are drawn with an opacity of 1/16: air; --opaque draws them whole",
        "mesh 0: material 0 \"glass\", 6 triangles, lets through 10/16 of what is behind it",
        "features = [\"transparency\"]",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert_eq!(place.counts("a.obj")["list"][1]["transparency"], 15);
    let compared = place.run(&["compare", "a.obj", "--shader", "gouraud", "--json"]);
    let figures: Value = serde_json::from_slice(&compared.stdout).expect("a line");
    assert!(figures["arithmetic_lsb"].as_f64().is_some_and(|error| error < 0.1) && figures["unmatched"] == 0, "{figures}");
    let said = place.converts(&["a.obj", "--opaque"]);
    assert!(transparency() == [0, 0] && !said.contains("transparency") && !said.contains("invisible"), "{said}");

    let pixels: Vec<_> = (0..64).map(|k| [200, 100, 0, if k % 8 < 4 { 0 } else { 255 }]).collect();
    let leaf = "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl leaf\nf 1/1 2/2 3/3 4/4\n";
    place.file("b.obj", leaf).file("b.png", image_of(&pixels, 8));
    place.file("b.mtl", "newmtl leaf\nKd 1 1 1\nmap_Kd b.png\n");
    let said = place.converts(&["b.obj"]);
    assert!(said.contains("left out: opacity of textures of colour that no map_d names") && !said.contains("holes"), "{said}");
    place.file("b.mtl", "newmtl leaf\nKd 1 1 1\nmap_Kd b.png\nmap_d b.png\n");
    let said = place.converts(&["b.obj"]);
    let filled = "1 material has a texture with holes: they are filled in; --colours texture keeps them, for a program with the features textures \
                  and transparency";
    assert!(said.contains(filled) && !said.contains("left out"), "{said}");
    let said = place.converts(&["b.obj", "--colours", "texture"]);
    for words in [
        "1 material has a texture with holes: a program needs the feature transparency to draw them",
        "2 triangles with a texture of 8x8 that has holes",
        "features = [\"textures\", \"transparency\"]",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let bytes = StreamBytes::read(&place.0.path().join("out.tri")).expect("a stream");
    let stream = bytes.parse().expect("a stream");
    let texture = stream.texture_of(&stream.meshes[0]).expect("a texture");
    let holes: Vec<bool> = texture.texels.iter().map(|&texel| texture.palette[usize::from(texel)].hole == 1).collect();
    assert_eq!(holes, (0..64).map(|k| k % 8 < 4).collect::<Vec<_>>());
    let said = place.converts(&["b.obj", "--colours", "texture", "--opaque"]);
    assert!(!said.contains("holes") && !said.contains("transparency"), "{said}");
    // A mask has its own size, and its brightness counts where it has no opacity. Without a texture of colour, the rest is white.
    let mask: Vec<_> = (0..16 * 16).map(|k| if k / 16 < 4 { [0; 3] } else { [255; 3] }).collect();
    place.file("mask.png", image_of(&mask, 16)).file("b.mtl", "newmtl leaf\nKd 0.5 1 0\nmap_d mask.png\n");
    place.converts(&["b.obj", "--colours", "texture"]);
    let bytes = StreamBytes::read(&place.0.path().join("out.tri")).expect("a stream");
    let stream = bytes.parse().expect("a stream");
    let texture = stream.texture_of(&stream.meshes[0]).expect("a texture");
    let seen: Vec<_> = texture.texels.iter().map(|&texel| texture.palette[usize::from(texel)]).collect();
    let holes = seen.iter().filter(|colour| colour.hole == 1).count();
    assert!(
        texture.size == [4, 4] && holes == 64 && seen.iter().filter(|colour| colour.hole == 0).all(|colour| colour.channels == [255; 3])
    );
    assert_eq!(place.colours(), [[0.5, 1.0, 0.0]]);
}

/// A texture that colours at corners do not give is recommended, and becomes one of the stream with `--colours texture`.
#[test]
fn faces_have_textures_where_colours_at_corners_do_not_suffice() {
    let place = Place::new();
    let checkerboard: Vec<_> = (0..64).map(|k| if (k / 8 + k % 8) % 2 == 0 { [255, 0, 0] } else { [0, 0, 255] }).collect();
    // All sides of a cube have the whole texture.
    let sides: String = SIDES
        .iter()
        .map(|side| {
            let corners = side[2..].split_whitespace().enumerate().map(|(k, corner)| format!(" {corner}/{}", k + 1));
            format!("f{}\n", corners.collect::<String>())
        })
        .collect();
    let cube = format!("mtllib a.mtl\n{CORNERS}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl paint\n{sides}");
    place.file("a.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd a.png\n").file("a.png", image_of(&checkerboard, 8)).file("a.obj", cube);
    let said = place.converts(&["a.obj"]);
    let words =
        " % of the area of 1 material is farther than 24: --colours texture keeps the texture, for a program with the feature textures";
    assert!(said.contains(words) && !said.contains("\"textures\""), "{said}");
    let colours = &place.counts("a.obj")["colours"];
    assert!(colours["lost_materials"] == 1 && colours["lost_area"].as_f64().is_some_and(|area| area > 0.5), "{colours}");
    assert_eq!(colours["textures"], Value::Null);
    let with_texture = ["a.obj", "--colours", "texture"];
    let said = place.converts(&with_texture);
    for words in [
        "12 triangles have 1 texture of 8x8 texels, 76 bytes: 0 % of the area is farther than 24 of 255 from the file, the root of the mean square is 0.0",
        "mesh 0: material 0 \"paint\", 12 triangles with a texture of 8x8",
        "features = [\"textures\"]",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert_eq!((place.palette(), place.colours()), (vec![[0, 0, 255], [255, 0, 0]], vec![[1.0; 3]]));
    let counts: Value = serde_json::from_str(&place.converts(&[&with_texture[..], &["--json"]].concat())).expect("JSON");
    let textures = &counts["colours"]["textures"];
    let fields = ["triangles", "bytes", "repeating", "multiplied"].map(|field| &textures[field]);
    assert_eq!(
        (fields, &textures["sizes"], &textures["lost_area"]),
        ([&12.into(), &76.into(), &0.into(), &0.into()], &serde_json::json!([[8, 8]]), &0.0.into())
    );
    assert_eq!((&counts["colours"]["triangles"], &counts["list"][0]["texture"]), (&0.into(), &serde_json::json!([8, 8])));
    let inspected = String::from_utf8(place.run(&["inspect", "out.tri"]).stdout).expect("text");
    for words in
        ["1 textures          4 bytes", "64 texels           64 bytes", "12 places          144 bytes", "2 colours           8 bytes"]
    {
        assert!(inspected.contains(words), "{words}: {inspected}");
    }
    assert!(!inspected.contains("corners  "), "{inspected}");
    let inspected: Value = serde_json::from_slice(&place.run(&["inspect", "out.tri", "--json"]).stdout).expect("JSON");
    assert_eq!(["textures", "texels", "texture_corners"].map(|field| &inspected[field]), [1, 64, 12]);
    // Neighbours are found as without a texture, and one colour takes the place of all.
    let plain = ["a.obj", "--antialias", "--colours", "none"];
    let neighbours = |arguments: &[&str]| {
        place.converts(arguments);
        let bytes = StreamBytes::read(&place.0.path().join("out.tri")).expect("a stream");
        bytes.parse().expect("a stream").neighbours.to_vec()
    };
    assert_eq!(neighbours(&[&with_texture[..], &["--antialias"]].concat()), neighbours(&plain));
    place.converts(&[&with_texture[..], &["--colour", "00ff00"]].concat());
    assert!(place.palette().is_empty());
    // Sizes are powers of two.
    for (arguments, words) in [
        (&["--colours", "texture", "--texture-size", "100"][..], "one of 8, 16, 32, 64, 128, 256 is needed"),
        (&["--texture-size", "64"], "--texture-size is the size of textures, which meshes have with --colours texture"),
        (&["--colours", "textures"], "corners, texture"),
    ] {
        let output = place.run(&[&["convert", "a.obj"], arguments].concat());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && stderr.contains(words), "{arguments:?}: {stderr}");
    }
    // A scene chooses for each mesh.
    let mesh = |name: &str, more: &str| format!("[[mesh]]\nname = \"{name}\"\nfile = \"a.obj\"\n{more}[[object]]\nmesh = \"{name}\"\n");
    let scene = |more: &str| {
        let meshes = [mesh("one", "colours = \"texture\"\n"), mesh("two", more), mesh("plain", "colours = \"none\"\n")].concat();
        place.file("a.toml", format!("frames = 1\n[camera]\nat = [0, 0, 5]\n{meshes}"));
    };
    scene("colours = \"texture\"\ntexture-size = 8\n");
    place.converts(&["a.toml"]);
    let bytes = StreamBytes::read(&place.0.path().join("out.tri")).expect("a stream");
    let stream = bytes.parse().expect("a stream");
    let seen: Vec<_> = stream.meshes.iter().map(|mesh| stream.texture_of(mesh).map(|texture| texture.corners.len())).collect();
    assert_eq!((seen, stream.textures().list.len(), stream.textures().texels.len()), (vec![Some(12), Some(12), None], 1, 64));
    scene("texture-size = 9\n");
    assert!(place.refuses("a.toml").contains("9 is not possible; use one of 8, 16, 32, 64, 128, 256"));
    scene("colours = \"all\"\n");
    assert!(place.refuses("a.toml").contains("there is no \"all\"; use one of none, corners, texture"));
}

/// Colours of glTF: a texture that its transform moves, times colours of vertices, which are linear.
#[test]
fn gltf_has_the_colours_of_textures_and_vertices() {
    let place = Place::new();
    let floats = |numbers: &[f32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    let positions = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let places = floats(&[0.1, 0.5, 0.1, 0.5, 0.1, 0.5]);
    // As bytes, of which each is a share; linear light of 0.214 is half of sRGB.
    let colours = [[255u8, 55, 255, 255]; 3].concat();
    let image = row_of(&[[255, 0, 0], [0, 255, 255]]);
    let mut bytes = [positions, places, colours, image.clone()].concat();
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let document = serde_json::json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "extensionsUsed": ["KHR_texture_transform"],
        "buffers": [{"byteLength": bytes.len()}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
            {"buffer": 0, "byteOffset": 60, "byteLength": 12}, {"buffer": 0, "byteOffset": 72, "byteLength": image.len()}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4"}
        ],
        "images": [{"bufferView": 3}], "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1, "baseColorTexture":
            {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "material": 0}]}]
    });
    let mut text = document.to_string();
    text.push_str(&" ".repeat(text.len().next_multiple_of(4) - text.len()));
    let chunk = |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), &kind[..], bytes].concat();
    let chunks = [chunk(b"JSON", text.as_bytes()), chunk(b"BIN\0", &bytes)].concat();
    let glb = [&b"glTF"[..], &2u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat();
    let said = place.file("a.glb", glb).converts(&["a.glb"]);
    assert!(said.contains("1 triangle has 1 colour of textures and vertices") && !said.contains("left out"), "{said}");
    let [[0, 127..=128, 255]] = place.palette()[..] else { panic!("{:?}", place.palette()) };
    assert_eq!(place.colours(), [[1.0; 3]]);
}

/// A 3MF file as a slicer writes it: the mesh and its colours in a part of their own, and a plate on which it stands twice.
#[test]
fn a_3mf_file_is_converted_whatever_its_name_is() {
    let place = Place::new();
    let coordinates =
        |line: &str| line[2..].split(' ').zip(["x", "y", "z"]).map(|(c, axis)| format!(" {axis}=\"{c}\"")).collect::<String>();
    let vertices: String = CORNERS.lines().map(|line| format!("<vertex{}/>", coordinates(line))).collect();
    let triangles: String = SIDES
        .iter()
        .enumerate()
        .flat_map(|(side, face)| {
            let [a, b, c, d] =
                [0, 1, 2, 3].map(|k| face[2..].split_whitespace().nth(k).and_then(|c| c.parse::<u32>().ok()).expect("a corner") - 1);
            let colour = side % 3;
            [[a, b, c], [a, c, d]].map(|[a, b, c]| format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\" pid=\"2\" p1=\"{colour}\"/>\n"))
        })
        .collect();
    let model = |resources: &str, build: &str| {
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" requiredextensions=\"p\">\n<resources>{resources}</resources>\n<build>{build}</build>\n</model>\n"
        )
    };
    let colours =
        "<m:colorgroup id=\"2\"><m:color color=\"#FF0000\"/><m:color color=\"#00FF00\"/><m:color color=\"#0000FF\"/></m:colorgroup>";
    let mesh =
        format!("{colours}<object id=\"1\"><mesh><vertices>{vertices}</vertices><triangles>\n{triangles}</triangles></mesh></object>");
    let plate =
        "<object id=\"8\" name=\"cube\"><components><component p:path=\"/3D/Objects/a.model\" objectid=\"1\"/></components></object>";
    let items = "<item objectid=\"8\"/><item objectid=\"8\" transform=\"1 0 0 0 1 0 0 0 1 4 0 0\"/>";
    let parts = |mesh: &str| packed(&[("3D/3dmodel.model", &model(plate, items)), ("3D/Objects/a.model", &model(mesh, ""))]);
    for file in ["a.3mf", "a.zip", "a.obj", "a"] {
        let said = place.file(file, parts(&mesh)).converts(&[file]);
        assert!(said.contains("24 triangles have 3 colours of textures and vertices at the corners: none is farther"), "{said}");
        assert!(said.contains("objects of the same name have numbers: \"cube 2\"") && !said.contains("left out"), "{said}");
        assert_eq!(place.counts(file)["triangles"], 24);
    }
    assert_eq!((place.palette(), place.colours()), (vec![[0, 0, 255], [0, 255, 0], [255, 0, 0]], vec![[1.0; 3]]));
    place.converts(&["a.3mf", "--colour", "ff0000", "--merge"]);
    assert!(place.run(&["render", "a.3mf"]).status.success());
    let error = place.file("b.3mf", parts(&mesh.replace("v3=\"7\"", "v3=\"8\""))).refuses("b.3mf");
    let words = "b.3mf: 3MF: 3D/Objects/a.model: line 6: object 1, triangle 3: v3: vertex 8 is out of range; they count from 0, and the object has 8";
    assert!(error.contains(words), "{error}");
    let error = place.file("c.3mf", packed(&[("notes.txt", "v 0 0 0")])).refuses("c.3mf");
    assert!(error.contains("c.3mf: 3MF: the archive has no model") && error.contains("unpack it, or else export it again"), "{error}");
    // The same archive under another name is one that somebody has to unpack.
    assert!(place.file("c.zip", packed(&[("a.obj", "v 0 0 0")])).refuses("c.zip").contains("compressed by zip"));
}

/// An archive of these parts, which are not compressed.
fn packed(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, part) in parts {
        let (mut entry, config) = archive.new_file(*name).start().expect("a part");
        let mut writer = config.wrap(&mut entry);
        writer.write_all(part.as_bytes()).expect("bytes");
        let (_, descriptor) = writer.finish().expect("bytes");
        entry.finish(descriptor).expect("a part");
    }
    archive.finish().expect("an archive");
    bytes
}
