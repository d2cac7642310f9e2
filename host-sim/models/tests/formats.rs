//! A mesh becomes one and the same stream from several file formats, and damaged files are errors.

use meshoptimizer_rs::codec::{VertexEncoding, encode_vertex_buffer};
use microphong_models::{
    coat::{Coat, TextureSize},
    contents::Colours,
    import::{self, Imported, Rules},
    look::{Look, Surface},
    mesh::{Mesh, Weld},
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

    /// An archive with one model.
    fn threemf(&self) -> Vec<u8> {
        let element = |element: &str, names: [&str; 3], values: [String; 3]| {
            let values: String = names.iter().zip(values).map(|(name, value)| format!(" {name}=\"{value}\"")).collect();
            format!("<{element}{values}/>\n")
        };
        let vertices: String =
            self.positions.iter().map(|p| element("vertex", ["x", "y", "z"], p.map(|c| f64::from(c).to_string()))).collect();
        let triangles: String = self.triangles.iter().map(|t| element("triangle", ["v1", "v2", "v3"], t.map(|v| v.to_string()))).collect();
        let mesh = format!("<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>");
        let model = format!("<model><resources><object id=\"1\">{mesh}</object></resources><build><item objectid=\"1\"/></build></model>");
        let mut bytes = Vec::new();
        let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
        let (mut entry, config) = archive.new_file("3D/3dmodel.model").start().unwrap();
        let mut writer = config.wrap(&mut entry);
        std::io::Write::write_all(&mut writer, model.as_bytes()).unwrap();
        let (_, descriptor) = writer.finish().unwrap();
        entry.finish(descriptor).unwrap();
        archive.finish().unwrap();
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
        // It has no normals.
        if shape.normals.is_empty() {
            assert!(stream(&place.file("a.3mf", shape.threemf())) == expected);
        }
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

/// Materials of glTF may have two sides, and may send out light; a texture may say where, without which that light is left out.
#[test]
fn materials_have_sides_and_send_out_light() {
    let place = Place::new();
    let (mut document, bytes) = cube().gltf();
    document["meshes"][0]["primitives"][0]["material"] = 0.into();
    document["textures"] = json!([{"source": 0}]);
    document["images"] = json!([{"uri": "none.png"}]);
    let mut of = |material: Value| {
        document["materials"] = json!([material]);
        import::file(&place.file("a.glb", glb(&document, &bytes)), Weld::default()).unwrap()
    };
    let light = |imported: &import::Imported| imported.materials[0].as_ref().unwrap().emission;
    // The back of a closed surface cannot be seen.
    let cube = of(json!({"doubleSided": true, "emissiveFactor": [0.0, 0.0, 0.0]}));
    assert_eq!((cube.backs, light(&cube), cube.remarks.len()), (0, [0.0; 3], 0));
    let strength = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 4.0}});
    let lamp = of(json!({"emissiveFactor": [1.0, 0.053_51, 0.0], "extensions": strength}));
    assert!(
        light(&lamp).iter().zip([1.0, 0.5, 0.0]).all(|(light, expected): (&f64, f64)| (light - expected).abs() < 1e-3),
        "{:?}",
        light(&lamp)
    );
    let surface = lamp.materials[0].as_ref().unwrap().surface(0.25);
    assert_eq!(surface.ambient, [0, 1, 2].map(|k| 0.25 * surface.diffuse[k] + light(&lamp)[k]));
    let uneven = of(json!({"emissiveFactor": [1.0, 1.0, 1.0], "emissiveTexture": {"index": 0}}));
    assert_eq!(light(&uneven), [0.0; 3]);
    let [image, others] = &uneven.remarks[..] else { panic!("{:?}", uneven.remarks) };
    assert!(image.starts_with("the image 0 is left out: cannot read "), "{image}");
    assert_eq!(others, "left out: light that materials send out by a texture");
}

/// A cube whose vertices have places in four columns of an image, one after the other, and whose only material is not yet there.
fn placed_cube() -> (Value, Vec<u8>) {
    let (mut document, mut bytes) = cube().gltf();
    let vertices = document["accessors"][1]["count"].as_u64().unwrap() as usize;
    let before = bytes.len();
    bytes.extend((0..vertices).flat_map(|vertex| [(vertex % 4) as f32 / 4.0 + 0.125, 0.5]).flat_map(f32::to_le_bytes));
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteOffset": before, "byteLength": bytes.len() - before}));
    let view = views.len() - 1;
    let accessors = document["accessors"].as_array_mut().unwrap();
    accessors.push(json!({"bufferView": view, "componentType": 5126, "count": vertices, "type": "VEC2"}));
    let accessor = accessors.len() - 1;
    document["buffers"][0]["byteLength"] = bytes.len().into();
    document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = accessor.into();
    document["meshes"][0]["primitives"][0]["material"] = 0.into();
    document["textures"] = json!([{"source": 0}, {"source": 1}]);
    document["images"] = json!([{"uri": "a.png"}, {"uri": "b.png"}]);
    (document, bytes)
}

/// A PNG of one row.
fn row<const N: usize>(kind: png::ColorType, pixels: &[[u8; N]]) -> Vec<u8> {
    let mut image = Vec::new();
    let mut encoder = png::Encoder::new(&mut image, pixels.len() as u32, 1);
    encoder.set_color(kind);
    encoder.write_header().unwrap().write_image_data(pixels.as_flattened()).unwrap();
    image
}

/// The light of a texture becomes one, which comes nearest to it over the triangles of the material, and materials that do not have all of it are named.
#[test]
fn textures_say_where_light_is_sent_out() {
    let place = Place::new();
    let (mut document, bytes) = placed_cube();
    place.file("a.png", row(png::ColorType::Rgb, &[[255, 0, 0], [0; 3]]));
    place.file("b.png", row(png::ColorType::Rgb, &[[51; 3]]));
    let mut of = |material: Value, colours: Colours| {
        document["materials"] = json!([material]);
        document["materials"][0]["name"] = "lamp".into();
        let rules = Rules { colours, ..Rules::default() };
        let imported = import::file_by(&place.file("a.glb", glb(&document, &bytes)), Weld::default(), rules).unwrap();
        let is_near = imported.remarks.iter().any(|remark| remark.starts_with("the light that these materials send out is only near to"));
        assert!(!is_near || imported.remarks.iter().any(|remark| remark.ends_with(": lamp")), "{:?}", imported.remarks);
        let light = imported.materials.iter().flatten().map(|material| material.emission.map(|c| (1e3 * c).round())).next_back().unwrap();
        (light, is_near, imported.remarks.iter().any(|remark| remark.contains("light that materials send out by a texture")))
    };
    let full = [1.0; 3];
    let on = |texture: u8, set: u8| json!({"index": texture, "texCoord": set});
    // Two vertices of four are red: the mean over all sides of the cube.
    let (light, is_near, is_left_out) = of(json!({"emissiveFactor": full, "emissiveTexture": on(0, 0)}), Colours::Corners);
    assert!((light[0] - 500.0).abs() < 15.0 && light[1..] == [0.0; 2] && is_near && !is_left_out, "{light:?}");
    // One colour is kept as it is, and a strong light is full at most.
    for (strength, factor, expected) in [(1.0, full, [200.0; 3]), (4.0, [1.0, 0.25, 0.0], [365.0, 200.0, 0.0]), (1e38, full, [1000.0; 3])] {
        let extensions = json!({"KHR_materials_emissive_strength": {"emissiveStrength": strength}});
        let lamp = json!({"emissiveFactor": factor, "emissiveTexture": on(1, 0), "extensions": extensions});
        assert_eq!(of(lamp, Colours::Corners), (expected, false, false));
    }
    // Where light has the colours of the surface, it is all of them.
    let alike = json!({"emissiveFactor": full, "emissiveTexture": on(0, 0), "pbrMetallicRoughness": {"baseColorTexture": on(0, 0)}});
    assert_eq!(of(alike.clone(), Colours::Corners), ([1000.0, 0.0, 0.0], false, false));
    assert_eq!(of(alike, Colours::None), ([0.0; 3], false, true));
    // The light, which is 0.19 in sRGB, is there although colours of 0.2 would make it weaker.
    let even = json!({"emissiveFactor": [0.03, 0.03, 0.03], "pbrMetallicRoughness": {"baseColorTexture": on(1, 0)}});
    assert_eq!(of(even, Colours::Corners), ([949.0; 3], false, false));
    // Of a texture with other places, the mean counts, if there are places at all.
    let other = json!({"emissiveFactor": full, "emissiveTexture": on(0, 1), "pbrMetallicRoughness": {"baseColorTexture": on(0, 0)}});
    assert_eq!(of(other, Colours::Corners), ([502.0, 0.0, 0.0], true, false));
    assert_eq!(of(json!({"emissiveFactor": full, "emissiveTexture": on(0, 1)}), Colours::Corners), ([0.0; 3], false, true));
    // Without light, the texture is of no use.
    assert_eq!(of(json!({"emissiveTexture": on(0, 0)}), Colours::Corners), ([0.0; 3], false, false));
}

/// Glass lets light through, and its extensions are not said to be left out.
#[test]
fn glass_is_seen_through() {
    let place = Place::new();
    let (mut document, bytes) = placed_cube();
    place.file("a.png", row(png::ColorType::Rgb, &[[255, 0, 0], [0; 3]]));
    document["extensionsUsed"] =
        ["transmission", "ior", "volume", "emissive_strength"].map(|name| format!("KHR_materials_{name}")).to_vec().into();
    document["extensionsRequired"] = document["extensionsUsed"].clone();
    let mut of = |transmission: Value, mut material: Value, rules: Rules| {
        let volume = json!({"thicknessFactor": 0.5, "attenuationColor": [1.0, 0.5, 0.5]});
        material["extensions"] =
            json!({"KHR_materials_transmission": transmission, "KHR_materials_ior": {"ior": 1.3}, "KHR_materials_volume": volume});
        document["materials"] = json!([material]);
        let Imported { materials, remarks, .. } =
            import::file_by(&place.file("a.glb", glb(&document, &bytes)), Weld::default(), rules).unwrap();
        ((100.0 * materials[0].as_ref().unwrap().transparency).round(), remarks)
    };
    let all = Rules::default();
    let base = |colour: [f64; 4]| json!({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": colour}});
    assert_eq!(of(json!({"transmissionFactor": 1.0}), json!({}), all), (96.0, vec![]));
    assert_eq!(of(json!({"transmissionFactor": 0.5}), base([1.0, 1.0, 0.0, 1.0]), all), (32.0, vec![]));
    assert_eq!(of(json!({"transmissionFactor": 0.5}), base([1.0, 1.0, 0.0, 0.25]), all), (75.0, vec![]));
    assert_eq!(of(json!({}), json!({}), all), (0.0, vec![]));
    assert_eq!(of(json!({"transmissionFactor": 1.0}), json!({}), Rules { opaque: true, ..all }), (0.0, vec![]));
    // The red of a texture is multiplied with the factor; without the texture, nothing is known of what is glass.
    let by_texture = json!({"transmissionFactor": 1.0, "transmissionTexture": {"index": 0}});
    assert_eq!(of(by_texture.clone(), json!({}), all), (48.0, vec![]));
    let without = Rules { colours: Colours::None, ..all };
    assert_eq!(of(by_texture, json!({}), without), (0.0, vec!["left out: textures".to_owned()]));
}

/// Opacity counts where the material says so: a texture is cut at the cutoff, or at a half where it is blended, and the rest has its mean.
#[test]
fn materials_are_seen_through() {
    let place = Place::new();
    let (mut document, bytes) = placed_cube();
    place.file("a.png", row(png::ColorType::Rgba, &[[255, 0, 0, 255], [0, 255, 0, 153], [0, 0, 255, 102], [9, 9, 9, 0]]));
    let mut of = |opacity: f64, mut material: Value| {
        material["pbrMetallicRoughness"] = json!({"baseColorFactor": [1, 1, 1, opacity], "baseColorTexture": {"index": 0}});
        document["materials"] = json!([material]);
        let rules = Rules { colours: Colours::Texture, texture_size: TextureSize::of(8).unwrap(), ..Rules::default() };
        let imported = import::file_by(&place.file("a.glb", glb(&document, &bytes)), Weld::default(), rules).unwrap();
        let textures = imported.mesh.coats.iter().filter_map(|coat| match coat {
            Coat::Texture(texels) => Some(texels.indices.iter().map(|&index| texels.hole == Some(index)).collect::<Vec<_>>()),
            Coat::Palette(_) => None,
        });
        let transparency = imported.materials[0].as_ref().unwrap().transparency;
        (textures.collect::<Vec<_>>().concat(), (100.0 * transparency).round())
    };
    let last = vec![false, false, false, true];
    assert_eq!(of(0.25, json!({})).1, 0.0);
    assert_eq!(of(1.0, json!({"alphaMode": "MASK", "alphaCutoff": 0.25})), (last.clone(), 0.0));
    assert_eq!(of(0.5, json!({"alphaMode": "MASK", "alphaCutoff": 0.1})), (last, 0.0));
    let two = vec![false, false, true, true];
    assert_eq!(of(1.0, json!({"alphaMode": "MASK"})), (two.clone(), 0.0));
    // The mean of 1 and 0.6.
    assert_eq!(of(1.0, json!({"alphaMode": "BLEND"})), (two.clone(), 20.0));
    assert_eq!(of(0.5, json!({"alphaMode": "BLEND"})), (two, 60.0));
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
    let [texture, others] = &imported.remarks[..] else { panic!("{:?}", imported.remarks) };
    assert!(
        texture.starts_with("the image 0 is left out: cannot read ") && texture.ends_with("none.png; put it beside the mesh"),
        "{texture}"
    );
    assert_eq!(others, "left out: animations, lines and points");
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
            json!({"count": 99, "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 1}}),
            "accessor 1: its sparse elements do not lie in their buffer; the file is damaged",
        ),
        (
            "/accessors/1/sparse",
            json!({"count": 1, "indices": {"bufferView": 1, "componentType": 5125, "byteOffset": 12}, "values": {"bufferView": 1}}),
            "accessor 1: its sparse element 1065353216 is out of range; there are 8",
        ),
        (
            "/accessors/1/sparse",
            json!({"count": 1, "indices": {"bufferView": 9, "componentType": 5125}, "values": {"bufferView": 1}}),
            "accessors[1].sparse.indices.bufferView: there is no element of this number",
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
        (
            "/extensionsRequired",
            json!(["KHR_mesh_quantization", "XYZ_new_geometry"]),
            "it needs the extension XYZ_new_geometry, which is not read; export it without this extension",
        ),
        (
            "/meshes/0/primitives/0/extensions",
            json!({"KHR_draco_mesh_compression": {"bufferView": 1, "attributes": {"POSITION": 0}}}),
            "its mesh, compressed by Draco, cannot be read; it is damaged, or of a kind that is not read: `npx @gltf-transform/cli copy",
        ),
        (
            "/meshes/0/primitives/0/extensions",
            json!({"KHR_draco_mesh_compression": {"bufferView": 7}}),
            "its bytes, compressed by Draco, do not lie in a buffer; the file is damaged",
        ),
        (
            "/bufferViews/1/extensions",
            json!({"EXT_meshopt_compression": {"buffer": 0, "byteLength": 96, "byteStride": 12, "count": 8, "mode": "ATTRIBUTES"}}),
            "view 1 of a buffer: its bytes, compressed by meshoptimizer, cannot be read; they are damaged, or of a kind that is not read",
        ),
        (
            "/bufferViews/1/extensions",
            json!({"EXT_meshopt_compression": {"buffer": 0, "byteLength": 96, "byteStride": 12, "count": 9, "mode": "ATTRIBUTES"}}),
            "its compression has 9 elements of 12 bytes, but the view has 96 bytes; the file is damaged",
        ),
        (
            "/bufferViews/1/extensions",
            json!({"EXT_meshopt_compression": {"buffer": 0, "byteLength": 97, "byteOffset": 200, "byteStride": 12, "count": 8}}),
            "its compressed bytes do not lie in their buffer; the file is damaged",
        ),
        ("/asset/version", json!("3.0"), "glTF 3.0; export it as glTF 2.0"),
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
    let old = [&whole[..4], &[1], &whole[5..]].concat();
    assert_eq!(place.wrong("a.glb", old), "GLB: glTF 1.0; export it as glTF 2.0");
    assert_eq!(place.wrong("a.gltf", r#"{"asset": {"version": "1.0"}, "meshes": {}}"#), "glTF 1.0; export it as glTF 2.0");
    assert_eq!(place.wrong("a.glb", &whole[..whole.len() - 1]), "GLB: the file is shorter than its head says; it was cut off");
    assert!(place.wrong("a.gltf", "{\"asset\": ").starts_with("glTF: EOF while parsing"));
    assert!(place.wrong("a.gltf", "no JSON").starts_with("glTF: "));
}

/// The triangles of a mesh by the positions of their corners, in an order that does not depend on that of the file.
fn surface(mesh: &Mesh) -> Vec<[[i64; 3]; 3]> {
    let rounded = |vertex: usize| mesh.positions[vertex].map(|c| (c * 1e4).round() as i64);
    let mut triangles: Vec<_> = mesh
        .triangles
        .iter()
        .map(|triangle| {
            let mut corners = triangle.map(rounded);
            let least = (0..3).min_by_key(|&k| corners[k]).unwrap();
            corners.rotate_left(least);
            corners
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

fn bytes_of(hex: &str) -> Vec<u8> {
    (0..hex.len() / 2).map(|k| u8::from_str_radix(&hex[2 * k..2 * k + 2], 16).unwrap()).collect()
}

/// The cube as the encoder of Google compresses it, by its two methods. In the second one indices keep their order.
const DRACO: [&str; 2] = [
    "445241434f02020101000000080c000b0000035f4b1501011001ff000001000903000002010101000303012001200300b0429c2002050800000000ff3f00000000000000000000000000000000803f0e",
    "445241434f0202010000000c0801000102000203040506040607000305000504010706010602000407000701030206030605010100090300000200010100030301280118030010b2501029120000000000ff3f00000000000000000000000000000000803f0e",
];

fn of_draco(bytes: &[u8]) -> Vec<u8> {
    let extension = json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}});
    let document = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0, "extensions": extension}]}],
        "accessors": [{"componentType": 5123, "type": "SCALAR", "count": 36}, {"componentType": 5126, "type": "VEC3", "count": 8}],
        "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}], "buffers": [{"byteLength": bytes.len()}],
        "extensionsUsed": ["KHR_draco_mesh_compression"], "extensionsRequired": ["KHR_draco_mesh_compression"],
    });
    glb(&document, bytes)
}

/// The cube as the original meshoptimizer compresses it: indices, and positions of 16 bits.
const MESHOPT: &str = "e1f02030110015201620170503007687566778a9866589689801690000000000a0020034343000000000010664000001303000000304011020000001030300000304010102000000000000000000000000000000000000000000000000000000000180018001800000000000";

fn of_meshopt(bytes: &[u8]) -> Vec<u8> {
    let packed = |offset: u32, length: u32, mode: &str, stride: u32, count: u32| {
        json!({"EXT_meshopt_compression": {
            "buffer": 0, "byteOffset": offset, "byteLength": length, "mode": mode, "byteStride": stride, "count": count
        }})
    };
    let document = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [0.5, 0.5, 0.5], "scale": [0.5, 0.5, 0.5]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
        "accessors": [
            {"componentType": 5123, "type": "SCALAR", "count": 36, "bufferView": 0},
            {"componentType": 5122, "type": "VEC3", "count": 8, "bufferView": 1, "normalized": true}
        ],
        "bufferViews": [
            {"buffer": 1, "byteLength": 72, "extensions": packed(0, 29, "TRIANGLES", 2, 36)},
            {"buffer": 1, "byteOffset": 72, "byteLength": 64, "byteStride": 8, "extensions": packed(32, 73, "ATTRIBUTES", 8, 8)}
        ],
        "buffers": [{"byteLength": bytes.len()}, {"byteLength": 136, "extensions": {"EXT_meshopt_compression": {"fallback": true}}}],
        "extensionsUsed": ["EXT_meshopt_compression", "KHR_mesh_quantization"],
        "extensionsRequired": ["EXT_meshopt_compression", "KHR_mesh_quantization"],
    });
    glb(&document, bytes)
}

#[test]
fn compressed_meshes_are_the_same_surface() {
    let place = Place::new();
    let plain = place.file("plain.obj", cube().obj());
    let expected = surface(&import::file(&plain, Weld::default()).unwrap().mesh);
    for bytes in DRACO.map(|hex| of_draco(&bytes_of(hex))).into_iter().chain([of_meshopt(&bytes_of(MESHOPT))]) {
        let Imported { mesh, remarks, report, .. } = import::file(&place.file("a.glb", bytes), Weld::default()).unwrap();
        assert!(surface(&mesh) == expected && remarks.is_empty() && !report.turned, "{remarks:?}");
    }
    assert!(stream(&place.file("b.glb", of_draco(&bytes_of(DRACO[1])))) == stream(&plain));
}

/// The newer form of the extension packs views in a second way.
#[test]
fn views_that_are_packed_by_the_newer_extension_are_read() {
    let place = Place::new();
    let (mut document, bytes) = sphere().gltf();
    let expected = stream(&place.file("a.glb", glb(&document, &bytes)));
    let view = document["bufferViews"][1].clone();
    let [start, length] = ["byteOffset", "byteLength"].map(|name| view[name].as_u64().unwrap() as usize);
    let encoding = VertexEncoding::new(1, 2).unwrap();
    let packed =
        encode_vertex_buffer(&bytes[start..start + length], length / 12, 12, encoding, &mut meshoptimizer_rs::Workspace::default())
            .unwrap();
    // The positions are nowhere else.
    let mut bytes = bytes;
    bytes[start..start + length].fill(0);
    document["bufferViews"][1]["extensions"] = json!({"KHR_meshopt_compression": {
        "buffer": 0, "byteOffset": bytes.len(), "byteLength": packed.len(), "byteStride": 12, "count": length / 12, "mode": "ATTRIBUTES"
    }});
    bytes.extend(&packed);
    document["buffers"][0]["byteLength"] = bytes.len().into();
    document["extensionsRequired"] = json!(["KHR_meshopt_compression"]);
    assert!(stream(&place.file("b.glb", glb(&document, &bytes))) == expected);
    document["bufferViews"][1]["extensions"]["KHR_meshopt_compression"]["filter"] = "NEW".into();
    let error = place.wrong("c.glb", glb(&document, &bytes));
    assert!(error.contains("of a kind that is not read") && error.contains("(the filter is \"NEW\")"), "{error}");
}

/// Sparse and quantised numbers, padding, and what programs write beyond the specification make no difference.
#[test]
fn numbers_of_every_kind_are_the_same_mesh() {
    let place = Place::new();
    let shape = sphere();
    let (document, bytes) = shape.gltf();
    let expected = stream(&place.file("a.glb", glb(&document, &bytes)));
    let mut more = bytes.clone();
    let view = |more: &mut Vec<u8>, document: &mut Value, bytes: &[u8]| {
        more.resize(more.len().next_multiple_of(4), 0);
        let views = document["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": more.len(), "byteLength": bytes.len()}));
        let number = views.len() - 1;
        more.extend(bytes);
        document["buffers"][0]["byteLength"] = more.len().into();
        number
    };
    // All positions but the first are in a view; or none is.
    let count = shape.positions.len() as u16;
    for all in [false, true] {
        let mut document = document.clone();
        let which: Vec<u16> = if all { (0..count).collect() } else { vec![0] };
        let indices = view(&mut more, &mut document, &which.iter().flat_map(|k| k.to_le_bytes()).collect::<Vec<_>>());
        let values: Vec<u8> = which.iter().flat_map(|&k| shape.positions[usize::from(k)]).flat_map(f32::to_le_bytes).collect();
        let values = view(&mut more, &mut document, &values);
        let accessor = &mut document["accessors"][1];
        accessor["sparse"] =
            json!({"count": which.len(), "indices": {"bufferView": indices, "componentType": 5123}, "values": {"bufferView": values}});
        let mut damaged = more.clone();
        if all {
            accessor.as_object_mut().unwrap().remove("bufferView");
        } else {
            let start = document["bufferViews"][1]["byteOffset"].as_u64().unwrap() as usize;
            damaged[start..start + 4].copy_from_slice(&9f32.to_le_bytes());
        }
        assert!(stream(&place.file("a.glb", glb(&document, &damaged))) == expected, "{all}");
    }
    // Padding of zeros, chunks of others, numbers without a box, attributes and extensions that nobody knows.
    let mut odd = document.clone();
    odd["accessors"][1].as_object_mut().unwrap().remove("min");
    odd["meshes"][0]["primitives"][0]["attributes"]["_BATCHID"] = 0.into();
    odd["textures"] = json!([{"extensions": {"KHR_texture_basisu": {"source": 0}}}]);
    odd["extensionsUsed"] = json!(["KHR_materials_unlit", "KHR_texture_basisu", "XYZ_notes"]);
    odd["extensionsRequired"] = json!(["KHR_materials_unlit", "KHR_texture_basisu"]);
    odd["extensions"] = json!({"XYZ_notes": {"text": "none"}});
    let mut whole = glb(&odd, &bytes);
    let end = 20 + odd.to_string().len().next_multiple_of(4);
    whole[20..end].iter_mut().rev().take_while(|byte| **byte == b' ').for_each(|byte| *byte = 0);
    whole.splice(end..end, [&8u32.to_le_bytes()[..], b"NOTE", &[0; 12]].concat()[..12 + 4].iter().copied());
    let length = (whole.len() as u32).to_le_bytes();
    whole[8..12].copy_from_slice(&length);
    assert!(stream(&place.file("odd.glb", &whole)) == expected);
    place.file("odd.bin", &bytes);
    odd["buffers"][0]["uri"] = "odd.bin".into();
    assert!(stream(&place.file("odd.gltf", format!("{odd}\n\0\0\0"))) == expected);
}

/// Whole numbers stand for shares of the largest one, or for themselves, only where the file says that it is quantised.
#[test]
fn quantised_positions_are_read_where_the_file_says_so() {
    let place = Place::new();
    let expected = surface(&import::file(&place.file("a.obj", cube().obj()), Weld::default()).unwrap().mesh);
    let (document, bytes) = cube().gltf();
    let start = document["bufferViews"][1]["byteOffset"].as_u64().unwrap() as usize;
    for (component, normalized, one) in [(5120, true, 127u16), (5120, false, 1), (5121, true, 255), (5122, false, 7), (5123, true, 65535)] {
        let mut document = document.clone();
        let mut bytes = bytes[..start].to_vec();
        for position in cube().positions {
            let number = |c: f32| c as u16 * one;
            let wide = component > 5121;
            bytes.extend(position.into_iter().flat_map(|c| if wide { number(c).to_le_bytes().to_vec() } else { vec![number(c) as u8] }));
            // Each vertex begins at a multiple of four bytes.
            bytes.resize(bytes.len() + if wide { 2 } else { 1 }, 0xFF);
        }
        let stride = if component > 5121 { 8 } else { 4 };
        document["bufferViews"][1] = json!({"buffer": 0, "byteOffset": start, "byteLength": 8 * stride, "byteStride": stride});
        document["buffers"][0]["byteLength"] = bytes.len().into();
        let accessor = &mut document["accessors"][1];
        (accessor["componentType"], accessor["normalized"]) = (component.into(), normalized.into());
        let error = place.wrong("a.glb", glb(&document, &bytes));
        assert!(error.contains("but Vec3 of [F32] is needed"), "{error}");
        document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
        let imported = import::file(&place.file("a.glb", glb(&document, &bytes)), Weld::default()).unwrap();
        assert!(surface(&imported.mesh) == expected, "{component}");
    }
}

/// A mesh with a skin stands where its joints put it. Its node, and what is above it, have no effect.
#[test]
fn skinned_meshes_stand_in_the_pose_of_their_joints() {
    let place = Place::new();
    // A bar along y, of which the upper half hangs on the second joint.
    let shape = Shape {
        positions: [[0, 0, 0], [1, 0, 0], [0, 0, 1], [0, 2, 0], [1, 2, 0], [0, 2, 1]].map(|p: [u8; 3]| p.map(f32::from)).into(),
        normals: Vec::new(),
        triangles: vec![[0, 1, 2], [3, 5, 4], [0, 3, 1], [1, 3, 4], [1, 4, 2], [2, 4, 5], [2, 5, 0], [0, 5, 3]],
    };
    let (mut document, mut bytes) = shape.gltf();
    let mut add = |contents: &[u8], component: u32, kind: &str, count: usize| {
        let views = document["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": contents.len()}));
        let view = views.len() - 1;
        bytes.extend(contents);
        document["buffers"][0]["byteLength"] = bytes.len().into();
        let accessors = document["accessors"].as_array_mut().unwrap();
        accessors.push(json!({"bufferView": view, "componentType": component, "type": kind, "count": count}));
        accessors.len() - 1
    };
    let joints = add(&[[0, 0, 0, 0], [0; 4], [0; 4], [1, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]].concat(), 5121, "VEC4", 6);
    // Shares of 255. The last vertex hangs on both joints, by weights that are not 1 together.
    let weights =
        add(&[[255, 0, 0, 0], [255, 0, 0, 0], [255, 0, 0, 0], [255, 0, 0, 0], [128, 0, 0, 0], [0, 255, 0, 0]].concat(), 5121, "VEC4", 6);
    // The second joint was at (0, 1, 0) when the skin was bound.
    let matrix = |x: f32, y: f32, z: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0f32];
    let inverse: Vec<u8> = [matrix(0.0, 0.0, 0.0), matrix(0.0, -1.0, 0.0)].concat().into_iter().flat_map(f32::to_le_bytes).collect();
    let inverse = add(&inverse, 5126, "MAT4", 2);
    let attributes = &mut document["meshes"][0]["primitives"][0]["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (joints.into(), weights.into());
    document["skins"] = json!([{"joints": [2, 3], "inverseBindMatrices": inverse}]);
    // The armature lies and is small, as some programs export it; its joints make up for that. The second one turns a quarter about z.
    let lie = json!([0.707_106_77, 0, 0, 0.707_106_77]);
    let stand = json!([-0.707_106_77, 0, 0, 0.707_106_77]);
    document["nodes"] = json!([
        {"rotation": lie, "scale": [0.01, 0.01, 0.01], "children": [1, 2]},
        {"mesh": 0, "skin": 0, "translation": [7, 7, 7]},
        {"rotation": stand, "scale": [100, 100, 100], "children": [3]},
        {"translation": [0, 1, 0], "rotation": [0, 0, 0.707_106_77, 0.707_106_77]}
    ]);
    let Imported { mesh, remarks, .. } = import::file(&place.file("a.glb", glb(&document, &bytes)), Weld::default()).unwrap();
    assert!(remarks.is_empty(), "{remarks:?}");
    let posed = Shape {
        positions: [[0, 0, 0], [1, 0, 0], [0, 0, 1], [-1, 1, 0], [-1, 2, 0], [-1, 1, 1]].map(|p: [i8; 3]| p.map(f32::from)).into(),
        ..shape
    };
    let expected = surface(&import::file(&place.file("posed.obj", posed.obj()), Weld::default()).unwrap().mesh);
    let near = |a: &[[i64; 3]; 3], b: &[[i64; 3]; 3]| a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| (a - b).abs() <= 2);
    let found = surface(&mesh);
    assert!(found.len() == expected.len() && found.iter().all(|a| expected.iter().any(|b| near(a, b))), "{found:?}\n{expected:?}");
    let mut far = document.clone();
    far["skins"][0]["joints"] = json!([2]);
    assert_eq!(place.wrong("far.glb", glb(&far, &bytes)), "glTF, mesh 0, primitive 0: vertex 3: joint 1 is out of range; the skin has 1");
}

/// Targets of a morph are added by the weights of the node, or else by those of the mesh.
#[test]
fn morph_targets_have_their_default_weights() {
    let place = Place::new();
    let (mut document, mut bytes) = cube().gltf();
    // The corner (1, 1, 1) goes up by 2.
    let mut offsets = vec![0u8; 96];
    offsets[7 * 12 + 8..].copy_from_slice(&2f32.to_le_bytes());
    document["bufferViews"].as_array_mut().unwrap().push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 96}));
    bytes.extend(offsets);
    document["buffers"][0]["byteLength"] = bytes.len().into();
    document["accessors"].as_array_mut().unwrap().push(json!({"bufferView": 2, "componentType": 5126, "type": "VEC3", "count": 8}));
    document["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 2}]);
    let mesh = |document: &Value| import::file(&place.file("a.glb", glb(document, &bytes)), Weld::default()).unwrap();
    let shape = |top: f32| {
        let mut shape = cube();
        shape.positions[7][2] = top;
        surface(&import::file(&place.file("a.obj", shape.obj()), Weld::default()).unwrap().mesh)
    };
    let imported = mesh(&document);
    assert!(surface(&imported.mesh) == shape(1.0));
    assert_eq!(imported.remarks, ["left out: morph targets, but for their default weights"]);
    document["meshes"][0]["weights"] = json!([0.5]);
    assert!(surface(&mesh(&document).mesh) == shape(2.0));
    document["nodes"][0]["weights"] = json!([0.25]);
    assert!(surface(&mesh(&document).mesh) == shape(1.5));
}

#[test]
fn specular_and_glossiness_have_a_colour() {
    let place = Place::new();
    let (mut document, bytes) = cube().gltf();
    document["extensionsUsed"] = json!(["KHR_materials_pbrSpecularGlossiness"]);
    document["materials"] = json!([{"name": "orange", "extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [1, 0.214_041, 0, 1], "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.5
    }}}]);
    document["meshes"][0]["primitives"][0]["material"] = 0.into();
    let imported = import::file(&place.file("a.glb", glb(&document, &bytes)), Weld::default()).unwrap();
    let [Some(orange)] = &imported.materials[..] else { panic!("{:?}", imported.materials) };
    let [red, green, blue] = orange.diffuse.unwrap();
    assert!(red > 0.99 && (green - 0.5).abs() < 0.01 && blue < 0.01 && imported.remarks.is_empty(), "{orange:?}, {:?}", imported.remarks);
}

/// Files outside the folder of the model are not opened, unless that is allowed; devices never are.
#[test]
fn models_open_no_files_outside_their_folder() {
    let place = Place::new();
    let (mut document, bytes) = cube().gltf();
    let outside = place.file("outside.bin", &bytes);
    fs::create_dir(place.0.path().join("inside")).unwrap();
    let mut written = |uri: &str| {
        document["buffers"][0]["uri"] = uri.into();
        place.file("inside/a.gltf", document.to_string())
    };
    let rules = |allow_outside| import::Rules { allow_outside, ..import::Rules::default() };
    for uri in [outside.display().to_string(), "../outside.bin".to_owned(), "%2E%2E/outside.bin".to_owned()] {
        let path = written(&uri);
        let error = format!("{:#}", import::file(&path, Weld::default()).unwrap_err());
        assert!(error.contains("buffer 0") && error.contains("lies outside the folder of the model"), "{error}");
        import::file_by(&path, Weld::default(), rules(true)).unwrap();
    }
    let path = written("/dev/zero");
    for (allowed, words) in [(false, "lies outside the folder"), (true, "is no regular file")] {
        let error = format!("{:#}", import::file_by(&path, Weld::default(), rules(allowed)).unwrap_err());
        assert!(error.contains(words), "{error}");
    }
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

    /// Wherever compressed bytes are damaged, they are a mesh or an error.
    #[test]
    fn any_damage_of_compressed_bytes_may_come(which in 0..3usize, at in any::<prop::sample::Index>(), byte in any::<u8>(), cut in any::<prop::sample::Index>(), cuts in any::<bool>()) {
        let place = Place::new();
        let mut bytes = bytes_of([DRACO[0], DRACO[1], MESHOPT][which]);
        let at = at.index(bytes.len());
        bytes[at] = byte;
        if cuts {
            bytes.truncate(cut.index(bytes.len()));
        }
        let whole = if which < 2 { of_draco(&bytes) } else { of_meshopt(&bytes) };
        let _ = import::file(&place.file("a.glb", whole), Weld::default());
    }
}
