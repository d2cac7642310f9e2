//! A mesh becomes one and the same stream from several file formats, and damaged files are errors.

use microphong_models::{
    import::{self, Imported},
    look::{Look, Surface},
    mesh::Weld,
    quantise::quantise,
    vector::{V3, add, cross, dot, length, sub},
    view::{Up, View},
};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::{
    fmt::Write,
    fs,
    path::{Path, PathBuf},
};
use tempfile::TempDir;

/// Triangles with the numbers that all formats can hold, with normals or without.
struct Shape {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

fn cube() -> Shape {
    let positions = (0..8u8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f32::from)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Shape { positions, normals: Vec::new(), triangles }
}

/// A sphere made of rings of points, with exact normals.
fn sphere() -> Shape {
    let (rings, sectors) = (8u32, 12u32);
    let mut shape = Shape { positions: Vec::new(), normals: Vec::new(), triangles: Vec::new() };
    for (ring, sector) in (0..=rings).flat_map(|ring| (0..=sectors).map(move |sector| (ring, sector))) {
        let [polar, around] =
            [ring as f32 / rings as f32, 2.0 * (sector % sectors) as f32 / sectors as f32].map(|share| share * std::f32::consts::PI);
        let normal = [polar.sin() * around.sin(), polar.cos(), polar.sin() * around.cos()];
        shape.positions.push(normal.map(|c| 2.5 * c));
        shape.normals.push(normal);
        if ring < rings && sector < sectors {
            let at = ring * (sectors + 1) + sector;
            shape.triangles.extend([[at, at + sectors + 1, at + sectors + 2], [at, at + sectors + 2, at + 1]]);
        }
    }
    shape
}

impl Shape {
    fn obj(&self) -> String {
        let mut text = String::new();
        let exact = |p: &[f32; 3]| p.map(|c| f64::from(c).to_string()).join(" ");
        self.positions.iter().for_each(|p| writeln!(text, "v {}", exact(p)).unwrap());
        self.normals.iter().for_each(|n| writeln!(text, "vn {}", exact(n)).unwrap());
        for triangle in &self.triangles {
            let corner = |index: u32| if self.normals.is_empty() { format!("{}", index + 1) } else { format!("{0}//{0}", index + 1) };
            writeln!(text, "f {}", triangle.map(corner).join(" ")).unwrap();
        }
        text
    }

    fn ply_head(&self, format: &str) -> String {
        let normals = if self.normals.is_empty() { "" } else { "property float nx\nproperty float ny\nproperty float nz\n" };
        format!(
            "ply\nformat {format} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n{normals}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            self.positions.len(),
            self.triangles.len()
        )
    }

    /// The numbers of each vertex.
    fn vertices(&self) -> impl Iterator<Item = Vec<f32>> {
        self.positions.iter().enumerate().map(|(k, position)| [&position[..], self.normals.get(k).map_or(&[], |n| &n[..])].concat())
    }

    fn ply_text(&self) -> String {
        let vertices = self.vertices().map(|v| v.iter().map(|&c| f64::from(c).to_string()).collect::<Vec<_>>().join(" ") + "\n");
        let faces = self.triangles.iter().map(|t| format!("3 {}\n", t.map(|c| c.to_string()).join(" ")));
        self.ply_head("ascii") + &vertices.chain(faces).collect::<String>()
    }

    fn ply_binary(&self) -> Vec<u8> {
        let mut bytes = self.ply_head("binary_little_endian").into_bytes();
        self.vertices().for_each(|v| bytes.extend(v.iter().flat_map(|c| c.to_le_bytes())));
        self.triangles.iter().for_each(|t| bytes.extend([3].into_iter().chain(t.iter().flat_map(|c| c.to_le_bytes()))));
        bytes
    }

    /// The document and the bytes of its only buffer.
    fn gltf(&self) -> (Value, Vec<u8>) {
        let floats = |list: &[[f32; 3]]| list.iter().flatten().flat_map(|c| c.to_le_bytes()).collect::<Vec<_>>();
        let indices = self.triangles.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
        let mut chunks =
            vec![(indices, 5125, "SCALAR", 3 * self.triangles.len()), (floats(&self.positions), 5126, "VEC3", self.positions.len())];
        let mut attributes = json!({"POSITION": 1});
        if !self.normals.is_empty() {
            chunks.push((floats(&self.normals), 5126, "VEC3", self.normals.len()));
            attributes["NORMAL"] = 2.into();
        }
        let (mut bytes, mut views, mut accessors) = (Vec::new(), Vec::new(), Vec::new());
        for (view, (chunk, component, kind, count)) in chunks.into_iter().enumerate() {
            views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": chunk.len()}));
            accessors.push(json!({"bufferView": view, "componentType": component, "type": kind, "count": count}));
            bytes.extend(chunk);
        }
        // The library wants the box of positions, as the specification does.
        let side = |pick: fn(f32, f32) -> f32| [0, 1, 2].map(|k| self.positions.iter().map(|p| p[k]).reduce(pick).unwrap());
        accessors[1]["min"] = json!(side(f32::min));
        accessors[1]["max"] = json!(side(f32::max));
        let document = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": attributes, "indices": 0}]}],
            "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": bytes.len()}],
        });
        (document, bytes)
    }
}

fn glb(document: &Value, bytes: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| [bytes, &vec![with; bytes.len().next_multiple_of(4) - bytes.len()]].concat();
    let (json, bytes) = (padded(document.to_string().as_bytes(), b' '), padded(bytes, 0));
    let length = |n: usize| (n as u32).to_le_bytes();
    [
        b"glTF",
        &length(2)[..],
        &length(28 + json.len() + bytes.len()),
        &length(json.len()),
        b"JSON",
        &json,
        &length(bytes.len()),
        b"BIN\0",
        &bytes,
    ]
    .concat()
}

/// A scratch directory with files in it.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        fs::write(&path, contents).unwrap();
        path
    }

    /// The error for a file of this name and contents.
    #[track_caller]
    fn wrong(&self, name: &str, contents: impl AsRef<[u8]>) -> String {
        let path = self.file(name, contents);
        let error = format!("{:#}", import::file(&path, Weld::default()).unwrap_err());
        error.strip_prefix(&format!("{}: ", path.display())).expect("the file's name").to_owned()
    }
}

fn stream(path: &Path) -> Vec<u8> {
    let Imported { mesh, materials, .. } = import::file(path, Weld::default()).unwrap();
    let other = Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 30);
    let look = Look { surfaces: import::surfaces(&materials, &other, 0.1), ..Look::new(other, View::orbit(Up::Y, 0.5, 0.35, 4.0, 8)) };
    look.stream(&quantise(&mesh).0).unwrap().as_bytes().to_vec()
}

#[test]
fn a_mesh_is_the_same_stream_in_every_format() {
    let place = Place::new();
    for shape in [cube(), sphere()] {
        let expected = stream(&place.file("a.obj", shape.obj()));
        let (mut document, bytes) = shape.gltf();
        assert!(stream(&place.file("text.ply", shape.ply_text())) == expected);
        assert!(stream(&place.file("binary.ply", shape.ply_binary())) == expected);
        assert!(stream(&place.file("a.glb", glb(&document, &bytes))) == expected);
        place.file("a mesh.bin", &bytes);
        document["buffers"][0]["uri"] = "a%20mesh.bin".into();
        assert!(stream(&place.file("beside.gltf", document.to_string())) == expected);
        let inside: String = bytes.iter().map(|byte| format!("%{byte:02x}")).collect();
        document["buffers"][0]["uri"] = format!("data:application/octet-stream,{inside}").into();
        assert!(stream(&place.file("inside.gltf", format!("\u{FEFF}{document:#}"))) == expected);
    }
}

/// Whatever a node does to a closed surface, its front stays outside and its normals stay square to it.
#[test]
fn nodes_move_turn_stretch_and_mirror() {
    let place = Place::new();
    let (document, bytes) = sphere().gltf();
    let cases = [
        json!({"mesh": 0, "translation": [3, 0, 0], "scale": [-1, 2, 0.5]}),
        json!({"mesh": 0, "rotation": [0, 0.6, 0, 0.8], "scale": [3, 1, 1]}),
        json!({"mesh": 0, "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, -2, 0, 7, 8, 9, 1]}),
    ];
    for node in cases {
        let mut document = document.clone();
        document["nodes"] = json!([{"children": [1], "scale": [1, 1, -1]}, node]);
        let Imported { mesh, report, .. } = import::file(&place.file("a.glb", glb(&document, &bytes)), Weld::default()).unwrap();
        assert!(report.own_normals && !report.turned, "{node}: {report:?}");
        let mut least: f64 = 1.0;
        for &corners in &mesh.triangles {
            let [a, b, c] = corners.map(|v| mesh.positions[v]);
            let front = cross(sub(b, a), sub(c, a));
            let normal: V3 = corners.iter().fold([0.0; 3], |sum, &v| add(sum, mesh.normals[v]));
            least = least.min(dot(front, normal) / (length(front) * length(normal)));
        }
        // Facets of an eighth of a circle, stretched.
        assert!(least > 0.75, "{node}: {least}");
    }
    // A child stands where its parents put it.
    let mut document = document.clone();
    document["scenes"][0]["nodes"] = json!([0, 3]);
    document["nodes"] = json!([{"children": [1], "translation": [0, 10, 0]}, {"children": [2], "scale": [2, 2, 2]}, {"mesh": 0, "translation": [0, 5, 0]}, {"mesh": 0}]);
    let Imported { mesh, .. } = import::file(&place.file("a.glb", glb(&document, &bytes)), Weld::default()).unwrap();
    // From -2.5 to 25, in a ball of radius 1: the upper sphere has twice the radius of the lower.
    let reach = |upper: bool| {
        let heights = mesh.positions.iter().filter(|p| (p[1] > 0.0) == upper).map(|p| p[1]);
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
        high - low
    };
    assert!((reach(true) / reach(false) - 2.0).abs() < 1e-6, "{} {}", reach(true), reach(false));
}

/// Each material is a mesh of the stream, and the output names what is left out.
#[test]
fn materials_become_meshes_and_the_rest_is_told() {
    let place = Place::new();
    let (mut document, bytes) = cube().gltf();
    let primitive = |material: Value, mode: u8| json!({"attributes": {"POSITION": 1}, "indices": 0, "material": material, "mode": mode});
    document["materials"] = json!([
        {"name": "never used", "doubleSided": true},
        {"name": "gold", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.1, 1], "roughnessFactor": 0.5}},
        {"name": "paint", "alphaMode": "BLEND", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.25, "baseColorTexture": {"index": 0}}}
    ]);
    document["textures"] = json!([{"source": 0}]);
    document["images"] = json!([{"uri": "none.png"}]);
    document["meshes"][0]["primitives"] = json!([primitive(1.into(), 4), primitive(2.into(), 4), primitive(1.into(), 1)]);
    document["meshes"][0]["primitives"][2]["targets"] = json!([{"POSITION": 1}]);
    document["animations"] = json!([{"channels": [], "samplers": []}]);
    let imported = import::file(&place.file("a.glb", glb(&document, &bytes)), Weld::default()).unwrap();
    assert_eq!(imported.remarks, ["left out: animations, lines and points, textures, transparency"]);
    let [Some(gold), Some(paint)] = &imported.materials[..] else { panic!("{:?}", imported.materials) };
    assert_eq!((&gold.name[..], gold.exponent, &paint.name[..], paint.exponent), ("gold", Some(30.0), "paint", Some(510.0)));
    let (parts, _) = quantise(&imported.mesh);
    assert_eq!(parts.iter().map(|part| (part.material, part.triangles.len())).collect::<Vec<_>>(), [(0, 12), (1, 12)]);
    // Strips and fans of the same square, seen from the same side.
    let square = Shape {
        positions: [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]: [u8; 2]| [x.into(), y.into(), 0.0]).into(),
        normals: Vec::new(),
        triangles: vec![[0, 1, 2], [1, 3, 2]],
    };
    let plain = stream(&place.file("square.obj", square.obj()));
    let strip = Shape { triangles: vec![[0, 1, 2], [3, 0, 0]], ..square };
    let (mut document, bytes) = strip.gltf();
    document["meshes"][0]["primitives"][0]["mode"] = 5.into();
    document["accessors"][0]["count"] = 4.into();
    assert!(stream(&place.file("strip.glb", glb(&document, &bytes))) == plain);
}

#[test]
fn errors_of_gltf_name_the_place() {
    let place = Place::new();
    let (document, bytes) = cube().gltf();
    let changed = |pointer: &str, value: Value| {
        let mut document = document.clone();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        let parent = document.pointer_mut(parent).unwrap();
        match key.parse::<usize>() {
            Ok(index) => parent[index] = value,
            Err(_) => parent[key] = value,
        }
        document
    };
    for (pointer, value, wrong) in [
        ("/accessors/0/count", json!(1000), "mesh 0, primitive 0: indices: accessor 0 does not lie in its buffer; the file is damaged"),
        ("/accessors/0/count", json!(35), "mesh 0, primitive 0: 35 corners; a multiple of three is needed"),
        ("/accessors/1/count", json!(u64::MAX), "accessor 1 does not lie in its buffer"),
        ("/accessors/1/count", json!(0), "accessor 1 is empty"),
        ("/accessors/1/count", json!(7), "mesh 0, primitive 0: vertex 7 is out of range; they count from 0, and there are 7"),
        ("/accessors/1/byteOffset", json!(u64::MAX), "accessor 1 does not lie in its buffer"),
        ("/accessors/1/type", json!("VEC2"), "accessor 1 has the type Vec2 of F32, but Vec3 of [F32] is needed"),
        ("/accessors/0/componentType", json!(5126), "indices: accessor 0 has the type Scalar of F32"),
        (
            "/accessors/1/sparse",
            json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 1}}),
            "accessor 1 is sparse; export it without sparse accessors",
        ),
        ("/bufferViews/1/byteLength", json!(5), "accessor 1 does not lie in its buffer"),
        ("/bufferViews/1/byteStride", json!(4), "accessor 1 does not lie in its buffer"),
        ("/bufferViews/1/buffer", json!(1), "bufferViews[1].buffer"),
        ("/buffers/0/byteLength", json!(100_000), "buffer 0: it has 240 bytes instead of 100000; the file was cut off"),
        ("/buffers/0/uri", json!("none.bin"), "none.bin; put it beside the mesh"),
        ("/buffers/0/uri", json!("data:;base64,A"), "buffer 0: its data URI"),
        ("/scenes", json!([]), "scene"),
        ("/nodes/0/children", json!([0]), "node 0: the scene reaches it twice; nodes must form a tree"),
        ("/nodes/0/mesh", json!(1), "nodes[0].mesh"),
        ("/nodes/0/translation", json!([1e39, 0, 0]), "glTF"),
        ("/extensionsRequired", json!(["KHR_draco_mesh_compression"]), "export it without compression and extensions"),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(9),
            "positions of a mesh are accessor 9, but there are 2; the file is damaged",
        ),
        ("/asset", json!({}), "glTF: missing field `version`"),
    ] {
        let error = place.wrong("a.glb", glb(&changed(pointer, value), &bytes));
        assert!(error.contains("glTF") && error.contains(wrong) && !error.contains('\n'), "{wrong:?} is not in {error:?}");
    }
    let mut unnamed = document.clone();
    unnamed.as_object_mut().unwrap().remove("scene");
    unnamed["scenes"] = json!([]);
    assert_eq!(place.wrong("a.glb", glb(&unnamed, &bytes)), "glTF: it has no scene; export it with one");
    let mut empty = bytes.clone();
    empty[144..148].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(
        place.wrong("a.glb", glb(&document, &empty)),
        "glTF, mesh 0, primitive 0: vertex 0: coordinates must be finite and below 1e100"
    );
    assert_eq!(place.wrong("a.gltf", document.to_string()), "glTF, buffer 0: it is the binary chunk of a GLB file, which is missing");
    let whole = glb(&document, &bytes);
    assert_eq!(place.wrong("a.glb", &whole[..whole.len() - 1]), "GLB: the file is shorter than its head says; it was cut off");
    assert!(place.wrong("a.gltf", "{\"asset\": ").starts_with("glTF: EOF while parsing"));
    assert!(place.wrong("a.gltf", "no JSON").starts_with("glTF: "));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Wherever a file is damaged, it is a mesh or an error.
    #[test]
    fn any_damage_may_come(cut in any::<prop::sample::Index>(), at in any::<prop::sample::Index>(), byte in prop_oneof![any::<u8>(), b'0'..=b'9'], digits in any::<bool>()) {
        let place = Place::new();
        let (document, bytes) = cube().gltf();
        let mut whole = glb(&document, &bytes);
        // An error is as good as a mesh.
        let _ = import::file(&place.file("cut.glb", &whole[..cut.index(whole.len())]), Weld::default());
        let places: Vec<_> = (0..whole.len()).filter(|&k| !digits || whole[k].is_ascii_digit()).collect();
        whole[places[at.index(places.len())]] = byte;
        let _ = import::file(&place.file("damaged.glb", &whole), Weld::default());
    }
}
