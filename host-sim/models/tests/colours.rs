//! Colours of textures and vertices become colours at the corners of triangles, also in simplified meshes.

mod common;

use common::{MTL, png, square, textured};
use microphong::format::GeometricError;
use microphong_models::{
    coat::{Coat, Paint},
    import::{self, Colours, Imported, Rules},
    levels,
    look::{Look, Surface},
    mesh::{Coloured, Mesh, Rgb, Weld},
    number::nearest,
    quantise::{Part, quantise},
    shapes,
    vector::{V3, add, length, scale, sub},
    view::{Up, View},
};
use serde_json::json;
use std::{collections::HashMap, fmt::Write, fs};
use tempfile::TempDir;

fn read(name: &str, files: &[(&str, &[u8])]) -> Imported {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    import::file(&folder.path().join(name), Weld::default()).unwrap()
}

/// The number of a colour in its palette.
fn index(paint: Paint) -> u8 {
    let Paint::Colour(index) = paint else { panic!("{paint:?}") };
    index
}

/// The colour at each corner of a triangle, with the position of the corner.
fn corners(mesh: &Mesh) -> Vec<[(V3, Rgb); 3]> {
    let of = |(triangle, vertices): (usize, &[usize; 3])| {
        let Coloured { coat, corners } = mesh.coloured(triangle).unwrap();
        [0, 1, 2].map(|k| (mesh.positions[vertices[k]], mesh.coats[usize::from(coat)].palette()[usize::from(index(corners[k]))]))
    };
    mesh.triangles.iter().enumerate().map(of).collect()
}

fn distance(a: Rgb, b: Rgb) -> u8 {
    (0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap()
}

/// Each directed edge between positions of the stream has its partner.
fn is_watertight(parts: &[Part]) -> bool {
    let mut edges: HashMap<[[i16; 3]; 2], i32> = HashMap::new();
    for part in parts {
        for triangle in &part.triangles {
            let at = |k: usize| part.vertices[usize::from(triangle.corners[k % 3])].position;
            for k in 0..3 {
                *edges.entry([at(k), at(k + 1)]).or_default() += 1;
                *edges.entry([at(k + 1), at(k)]).or_default() -= 1;
            }
        }
    }
    edges.values().all(|&count| count == 0)
}

/// A gradient across a face has its colours at the ends, and a patch has its one colour exactly.
#[test]
fn gradients_and_patches_are_right() {
    let gradient: Vec<Rgb> = (0..=255).map(|k| [k, 255 - k, 100]).collect();
    let files = |faces: &[Vec<(V3, [f64; 2])>]| textured(faces).into_bytes();
    let image = png(&[gradient]);
    let imported = read("a.obj", &[("a.obj", &files(&[square()])), ("a.mtl", MTL), ("a.png", &image)]);
    let painted = imported.painted;
    assert!(painted.triangles == 2 && painted.far == 0 && painted.rms < 1.0 && painted.split == 0 && painted.colours == 2, "{painted:?}");
    assert_eq!((imported.materials.len(), painted.materials), (1, 0));
    for (position, colour) in corners(&imported.mesh).concat() {
        let expected = if position[0] > 0.0 { [255, 0, 100] } else { [0, 255, 100] };
        assert!(distance(colour, expected) <= 2, "{position:?} {colour:?}");
    }
    let patches = png(&[vec![[10, 20, 30], [200, 100, 50]]]);
    let patch = |u: f64| square().into_iter().map(|(position, _)| (position, [u, 0.5])).collect::<Vec<_>>();
    let [one, mut other] = [patch(0.25), patch(0.75)];
    other.iter_mut().for_each(|(position, _)| position[0] += 1.0);
    let imported = read("a.obj", &[("a.obj", &files(&[one, other])), ("a.mtl", MTL), ("a.png", &patches)]);
    assert_eq!(imported.mesh.coats, [Coat::Palette(vec![[10, 20, 30], [200, 100, 50]])]);
    assert!(imported.painted.of_one_colour == 4 && imported.painted.rms < 1e-9, "{:?}", imported.painted);
}

/// A cube of which the first sides have a texture with a border in the middle, and the others are in one of its patches.
fn bordered_cube(sides: usize) -> Imported {
    let faces = (0..6).map(|side| {
        let (axis, high) = (side / 2, f64::from(side as u8 % 2));
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]: [f64; 2]| {
            let mut position = [0.0; 3];
            (position[axis], position[(axis + 1) % 3], position[(axis + 2) % 3]) = (high, u, v);
            (position, if side < sides { [u, v] } else { [0.25, 0.5] })
        });
        if high > 0.0 { corners.to_vec() } else { corners.into_iter().rev().collect() }
    });
    let image = png(&[vec![[200, 0, 0], [0, 0, 200]]]);
    read("a.obj", &[("a.obj", textured(&faces.collect::<Vec<_>>()).as_bytes()), ("a.mtl", MTL), ("a.png", &image)])
}

/// A border along the middles of edges is right after a split, which leaves no gap to neighbours and no edge in their shading.
#[test]
fn triangles_with_a_border_inside_are_split_without_gaps() {
    for sides in 0..=6 {
        let imported = bordered_cube(sides);
        let painted = imported.painted;
        assert_eq!((painted.far, painted.split), (0, 2 * sides), "{painted:?}");
        let (parts, dropped) = quantise(&imported.mesh);
        let [part] = &parts[..] else { panic!("{} parts", parts.len()) };
        assert!(dropped == 0 && is_watertight(&parts) && part.closed_convex, "{sides}");
        assert_eq!(part.triangles.len(), if sides == 6 { 48 } else { part.colours.len() });
        // All of a flat side has its normal.
        for triangle in &part.triangles {
            assert!(triangle.corners.iter().all(|&corner| part.vertices[usize::from(corner)].normal == triangle.normal), "{triangle:?}");
        }
        for corners in corners(&imported.mesh) {
            assert!(corners.iter().all(|(_, colour)| [[200, 0, 0], [0, 0, 200]].contains(colour)), "{corners:?}");
        }
    }
}

/// A split round surface stays closed, and its new normals are those in the middle of two. Where the border lies elsewhere, nothing is split.
#[test]
fn round_surfaces_are_split_at_their_middles() {
    let ball = shapes::sphere(12, 8, 0.0);
    for (border, is_split) in [(0.5, true), (0.4, false)] {
        // Along each triangle runs the whole texture, with a border where both edges have their middle.
        let faces: Vec<_> = ball
            .triangles
            .iter()
            .enumerate()
            .map(|(number, corners)| {
                let places = if number % 7 == 0 { [[0.0, 0.5], [1.0, 0.5], [1.0, 0.5]] } else { [[0.1, 0.5]; 3] };
                [0, 1, 2].map(|k| (ball.positions[corners[k]], places[k])).to_vec()
            })
            .collect();
        let row = (0..100).map(|k| if f64::from(k) < 100.0 * border { [250, 250, 0] } else { [0, 90, 90] }).collect();
        let imported = read("a.obj", &[("a.obj", textured(&faces).as_bytes()), ("a.mtl", MTL), ("a.png", &png(&[row]))]);
        let (painted, count) = (imported.painted, ball.triangles.len().div_ceil(7));
        assert_eq!((painted.split, painted.far), if is_split { (count, 0) } else { (0, count) }, "{painted:?}");
        let (parts, dropped) = quantise(&imported.mesh);
        assert!(dropped == 0 && is_watertight(&parts));
        for (position, normal) in imported.mesh.positions.iter().zip(&imported.mesh.normals) {
            assert!((length(*normal) - 1.0).abs() < 1e-9);
            // Light is smooth over the ball, and normals point outwards, also in the middles of edges.
            assert!(length(sub(*normal, scale(*position, 1.0 / length(*position)))) < 0.1, "{position:?} {normal:?}");
        }
    }
}

/// Corners have the colours of vertices, in every format.
#[test]
fn colours_of_vertices_are_those_of_corners() {
    let (positions, colours) = ([[0, 0, 0], [4, 0, 0], [0, 4, 0], [4, 4, 0]], [[255, 0, 0], [0, 255, 0], [0, 0, 255], [51, 102, 153]]);
    let words = |numbers: [i32; 3]| numbers.map(|n| n.to_string()).join(" ");
    let faces = [[0, 1, 2], [1, 3, 2]];
    let mut obj = String::new();
    let mut ply = String::from(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n",
    );
    for (position, colour) in positions.into_iter().zip(colours) {
        writeln!(obj, "v {} {}", words(position), colour.map(|c: i32| (f64::from(c) / 255.0).to_string()).join(" ")).unwrap();
        writeln!(ply, "{} {}", words(position), words(colour)).unwrap();
    }
    faces.iter().for_each(|face| writeln!(obj, "f {}", words(face.map(|k| k + 1))).unwrap());
    faces.iter().for_each(|face| writeln!(ply, "3 {}", words(*face)).unwrap());
    let linear = |c: i32| {
        libm::pow((f64::from(c) / 255.0 + 0.055) / 1.055, 2.4).max(f64::from(c) / 255.0 / 12.92 * f64::from(u8::from(c < 11))) as f32
    };
    let floats = |lists: [[f32; 3]; 4]| lists.as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect::<Vec<u8>>();
    let bytes = [
        floats(positions.map(|p| p.map(|c| c as f32))),
        floats(colours.map(|colour| colour.map(|c| if c == 0 { 0.0 } else { linear(c) }))),
        vec![0, 1, 2, 1, 3, 2],
    ]
    .concat();
    let uri = format!("data:application/octet-stream;base64,{}", base64(&bytes));
    let gltf = json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "buffers": [{"byteLength": bytes.len(), "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48}, {"buffer": 0, "byteOffset": 96, "byteLength": 6}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [4, 4, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR"}
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2}]}]
    });
    for (name, text) in [("a.obj", obj), ("a.ply", ply), ("a.gltf", gltf.to_string())] {
        let imported = read(name, &[(name, text.as_bytes())]);
        let painted = imported.painted;
        assert!(painted.triangles == 2 && painted.far == 0 && painted.rms < 1e-3 && painted.of_one_colour == 0, "{name}: {painted:?}");
        // The mesh has no material of its own: its own colour is white, and not that of the command line.
        let [Some(material)] = &imported.materials[..] else { panic!("{name}: {:?}", imported.materials) };
        assert_eq!((material.diffuse, painted.materials), (Some([1.0; 3]), 1), "{name}");
        for (number, triangle) in corners(&imported.mesh).into_iter().enumerate() {
            assert_eq!(triangle.map(|(_, colour)| colour), faces[number].map(|k| colours[k as usize].map(|c| c as u8)), "{name}");
        }
        let (parts, _) = quantise(&imported.mesh);
        let other = Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 30);
        let look = Look {
            surfaces: import::surfaces(&imported.materials, &other, 0.1),
            ..Look::new(other, View::orbit(Up::Y, 0.5, 0.35, 4.0, 8))
        };
        let bytes = look.stream(&parts).unwrap();
        let stream = bytes.parse().unwrap();
        let of_mesh = stream.colours_of(&stream.meshes[0]).unwrap();
        let written: Vec<[Rgb; 3]> =
            of_mesh.corners.iter().map(|corner| corner.colours.map(|colour| of_mesh.palette[usize::from(colour)].channels)).collect();
        assert_eq!(written, faces.map(|face| face.map(|k| colours[k as usize].map(|c| c as u8))), "{name}");
        assert!(of_mesh.corners.iter().all(|corner| corner.range == 255));
    }
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let of_three = |three: &[u8]| {
        let number = three.iter().chain(&[0; 2]).take(3).fold(0u32, |number, &byte| number << 8 | u32::from(byte));
        let digits = [18, 12, 6, 0].map(|shift| char::from(DIGITS[(number >> shift & 63) as usize]));
        digits.iter().enumerate().map(|(k, &digit)| if k <= three.len() { digit } else { '=' }).collect::<String>()
    };
    bytes.chunks(3).map(of_three).collect()
}

/// A texture of four patches, which a texture transform scales, turns and moves.
#[test]
fn texture_transforms_are_applied() {
    let patches = [[200, 0, 0], [0, 200, 0], [0, 0, 200], [200, 200, 200]];
    let image = base64(&png(&[patches[..2].to_vec(), patches[2..].to_vec()]));
    let floats = |numbers: &[f32]| numbers.iter().flat_map(|c| c.to_le_bytes()).collect::<Vec<u8>>();
    for (transform, place, patch) in [
        (json!({}), [0.25, 0.25], 0),
        (json!({"offset": [0.5, 0.0]}), [0.25, 0.25], 1),
        (json!({"scale": [1.0, 3.0]}), [0.25, 0.25], 2),
        // Turned about the upper left corner: u becomes v, and v becomes -u.
        (json!({"rotation": std::f64::consts::FRAC_PI_2, "offset": [0.0, 1.0]}), [0.25, 0.75], 3),
        (json!({"rotation": std::f64::consts::FRAC_PI_2, "offset": [0.0, 1.0]}), [0.25, 0.25], 2),
        (json!({"texCoord": 1}), [0.25, 0.25], 3),
    ] {
        let bytes = [floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]), floats(&[place; 3].concat()), floats(&[0.75; 6])].concat();
        let document = json!({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "extensionsUsed": ["KHR_texture_transform"],
            "buffers": [{"byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{}", base64(&bytes))}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}, {"buffer": 0, "byteOffset": 60, "byteLength": 24}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
                {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"}
            ],
            "images": [{"uri": format!("data:image/png;base64,{image}")}], "textures": [{"source": 0}],
            "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1, "baseColorFactor": [1, 1, 0, 1],
                "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": transform}}}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2}, "material": 0}]}]
        });
        let imported = read("a.gltf", &[("a.gltf", document.to_string().as_bytes())]);
        assert_eq!(imported.mesh.coats, [Coat::Palette(vec![patches[patch]])], "{transform}");
        // The colour of the material is not multiplied into those of corners, and the material stays matt.
        let [Some(material)] = &imported.materials[..] else { panic!("{:?}", imported.materials) };
        let is_yellow = material.diffuse.is_some_and(|own| length(sub(own, [1.0, 1.0, 0.0])) < 1e-9);
        assert!(is_yellow && material.specular == Some([0.0; 3]), "{material:?}");
    }
}

/// A smooth ball of many colours, one at each vertex.
fn colourful(colour: impl Fn(V3) -> V3) -> Imported {
    let ball = shapes::sphere(120, 80, 0.0);
    let mut text = String::new();
    for position in &ball.positions {
        let [x, y, z] = *position;
        let [r, g, b] = colour(*position);
        writeln!(text, "v {x} {y} {z} {r} {g} {b}").unwrap();
    }
    ball.triangles.iter().for_each(|t| writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1).unwrap());
    read("a.obj", &[("a.obj", text.as_bytes())])
}

/// Thousands of colours along a surface in the cube of colours fit one palette well enough; when they fill the cube, the mesh is divided.
#[test]
fn many_colours_have_the_nearest_palettes() {
    let imported = colourful(|[x, y, z]| [0.5 + 0.2 * x, 0.5 + 0.2 * y, 0.4 + 0.1 * z]);
    let painted = imported.painted;
    assert!(painted.palettes == 1 && painted.colours == 256 && painted.far == 0 && painted.rms < 3.0, "{painted:?}");
    let imported = colourful(|[x, y, z]| [x, y, z].map(|c| 0.5 + 0.5 * libm::sin(9.0 * c + 3.0 * x * y)));
    let painted = imported.painted;
    assert!(painted.palettes > 1 && painted.palettes <= 8 && painted.rms < 6.0, "{painted:?}");
    let (parts, _) = quantise(&imported.mesh);
    assert_eq!(parts.len(), painted.palettes);
    assert!(is_watertight(&parts) && parts.iter().all(|part| part.material == 0 && part.object == 0 && part.palette().len() <= 256));
    assert!((painted.far as f64) < 0.12 * painted.triangles as f64, "{painted:?}");
}

const RED: Rgb = [200, 0, 0];
const BLUE: Rgb = [0, 0, 200];

/// A ball that is red above and blue below.
fn two_colours() -> Mesh {
    let mut ball = shapes::sphere(40, 30, 0.0);
    let height = |t: &[usize; 3]| t.iter().map(|&v| ball.positions[v][2]).sum::<f64>();
    ball.colours =
        ball.triangles.iter().map(|t| Some(Coloured { coat: 0, corners: [Paint::Colour(u8::from(height(t) < 0.0)); 3] })).collect();
    ball.coats = vec![Coat::Palette(vec![RED, BLUE])];
    ball
}

/// Checks that triangles of a ball of two colours have one of them, the right one.
#[track_caller]
fn keep_their_colours(part: &Part, triangles: &[microphong::stream::record::Triangle], colours: &[[Paint; 3]]) {
    assert_eq!(triangles.len(), colours.len());
    for (triangle, colours) in triangles.iter().zip(colours) {
        let heights = triangle.corners.map(|corner| part.vertices[usize::from(corner)].position[2]);
        assert!(colours[0] == colours[1] && colours[1] == colours[2], "{colours:?}");
        assert!(heights.iter().all(|&height| if index(colours[0]) == 0 { height >= -1 } else { height <= 1 }), "{heights:?} {colours:?}");
    }
}

/// A change of colour across an edge is a border, which simplified meshes and levels of detail keep.
#[test]
fn simplified_meshes_keep_borders_of_colours() {
    let mesh = two_colours();
    let (mut parts, _) = quantise(&mesh);
    levels::simplify(&mesh, &mut parts, 600, &|| ()).unwrap().unwrap();
    let [part] = &parts[..] else { panic!("{} parts", parts.len()) };
    assert!((500..=600).contains(&part.triangles.len()) && part.palette() == [RED, BLUE]);
    keep_their_colours(part, &part.triangles, &part.colours);
    let (mut parts, _) = quantise(&mesh);
    levels::add(&mesh, &mut parts, &[0.01, 0.05].map(nearest::<GeometricError>), &|| ()).unwrap();
    let [part] = &parts[..] else { panic!("{} parts", parts.len()) };
    assert_eq!(part.coarser.len(), 2);
    for level in &part.coarser {
        keep_their_colours(part, &level.triangles, &level.colours);
    }
    let look = Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 30), View::orbit(Up::Y, 0.5, 0.35, 4.0, 8));
    let bytes = look.stream(&parts).unwrap();
    let stream = bytes.parse().unwrap();
    assert!(stream.meshes.len() == 3 && stream.corner_colours.len() == stream.triangles.len());
    assert!(
        stream.meshes.iter().all(|mesh| stream.colours_of(mesh).is_some_and(|colours| colours.corners.len() == mesh.triangles as usize))
    );
}

/// A gradient is no border: it is simplified as one surface, and its corners keep their own colours.
#[test]
fn simplified_gradients_keep_the_colours_of_corners() {
    let imported = colourful(|[x, ..]| [0.5 + 0.4 * x, 0.3, 0.5]);
    let (mut parts, _) = quantise(&imported.mesh);
    levels::simplify(&imported.mesh, &mut parts, 400, &|| ()).unwrap().unwrap();
    let [part] = &parts[..] else { panic!("{} parts", parts.len()) };
    assert!(part.triangles.len() <= 400 && is_watertight(&parts));
    for (triangle, colours) in part.triangles.iter().zip(&part.colours) {
        for (corner, colour) in triangle.corners.iter().zip(colours) {
            let x = f64::from(part.vertices[usize::from(*corner)].position[0]) / 16384.0;
            let [red, ..] = part.palette()[usize::from(index(*colour))];
            assert!((f64::from(red) / 255.0 - 0.5 - 0.4 * x).abs() < 5.0 / 255.0, "{x} {red}");
        }
    }
}

/// Without colours a mesh keeps its materials, and no image is read.
#[test]
fn colours_can_be_left_out() {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in [("a.obj", textured(&[square()]).as_bytes()), ("a.mtl", MTL), ("a.png", b"no image")] {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let rules = Rules { colours: Colours::None, ..Rules::default() };
    let imported = import::file_by(&folder.path().join("a.obj"), Weld::default(), rules).unwrap();
    assert!(imported.mesh.colours.is_empty() && imported.painted.triangles == 0);
    assert_eq!(imported.remarks, ["left out: texture coordinates, textures"]);
    let middle = imported.mesh.positions.iter().fold([0.0; 3], |sum, &position| add(sum, position));
    assert!(length(middle) < 1e-9);
}
