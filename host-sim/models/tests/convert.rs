//! Promises of a converted mesh to the renderer.

use microphong::{
    Stream,
    stream::record::{CLOSED_CONVEX, Triangle},
};
use microphong_models::{
    import,
    look::{Look, Surface},
    mesh::{self, Mesh, Weld},
    obj,
    quantise::{normal, quantise},
    scene,
    vector::{V3, add, cross, dot, length, scale, sub, unit},
    view::{Up, View},
};
use microphong_render::shader::Shader;
use std::{
    collections::{HashMap, HashSet},
    fs,
};

fn wide(v: [i16; 3]) -> V3 {
    v.map(|c| f64::from(c) / 16384.0)
}

/// Calls `check` with every built-in scene's stream, a triangle, and the positions and unit normals of its corners.
fn each_triangle(mut check: impl FnMut(&str, &Stream<'_>, &Triangle, [V3; 3], [V3; 3])) {
    for name in scene::NAMES {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        for mesh in stream.meshes {
            let vertices = stream.vertices_of(mesh).unwrap();
            for triangle in stream.triangles_of(mesh).unwrap() {
                let corners = triangle.corners.map(|c| vertices[usize::from(c)]);
                let normals = corners.map(|c| unit(wide(c.normal)).unwrap());
                check(name, &stream, triangle, corners.map(|c| wide(c.position)), normals);
            }
        }
    }
}

/// A deterministic stand-in for chance, in [-1, 1).
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Half a unit in the last place: near an axis the lattice has nothing better.
const WORST: f64 = 0.5 / 16384.0 + 1e-9;

#[test]
fn normals_have_unit_length() {
    let (mut seed, mut over, count) = (1, 0, 100_000);
    for _ in 0..count {
        let Some(exact) = unit([0, 1, 2].map(|_| noise(&mut seed))) else { continue };
        let quantised = normal(exact).map(f64::from);
        let error = (length(quantised) - 1.0).abs();
        assert!(error <= WORST, "{exact:?}: {error:e}");
        assert!(length(sub(quantised, exact)) < 2.6 / 16384.0);
        over += usize::from(error > 2e-5);
    }
    assert!(over * 500 < count, "{over} of {count} normals are off by more than 2e-5");
}

#[test]
fn normals_of_scenes_have_unit_length() {
    for name in scene::NAMES {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let errors = stream.vertices.iter().map(|v| (length(wide(v.normal)) - 1.0).abs());
        let worst = errors.fold(0.0, f64::max);
        assert!(worst <= WORST, "{name}: {worst:e}");
    }
}

#[test]
fn edge_constants_follow_their_definition() {
    each_triangle(|name, _, triangle, _, normals| {
        let mut least: f64 = 1.0;
        for k in 0..3 {
            let (a, b) = (normals[k], normals[(k + 1) % 3]);
            let sum = length(add(a, b));
            let inverse_sum_length = ((1.0 / sum - 0.5) * 131_072.0).min(65535.0);
            assert!((f64::from(triangle.inverse_sum_length[k]) - inverse_sum_length).abs() <= 0.5001, "{name}");
            let haversine = ((1.0 - (sum / 2.0).powi(2)) * 65_536.0).min(65535.0);
            assert!((f64::from(triangle.haversine[k]) - haversine).abs() <= 0.5001, "{name}");
            least = least.min(dot(a, b));
        }
        // It is a bound, no point of the triangle has a shorter normal; and it is the largest one.
        let stored = f64::from(triangle.min_normal_length) / 32768.0;
        let mut shortest: f64 = 1.0;
        for (u, v) in (0..=40).flat_map(|u| (0..=40 - u).map(move |v| (f64::from(u) / 40.0, f64::from(v) / 40.0))) {
            shortest = shortest.min(length(add(add(scale(normals[0], u), scale(normals[1], v)), scale(normals[2], 1.0 - u - v))));
        }
        assert!(stored <= shortest + 1e-9, "{name}: {stored}, a normal has the length {shortest}");
        // Between two points of the grid the length rises by no more than the square of their distance.
        let missed = (1.0 - least) / 800.0 + 2.0 / 32768.0;
        assert!(stored >= shortest - missed, "{name}: {stored}, the shortest normal has the length {shortest}");
    });
}

#[test]
fn culling_never_removes_a_front() {
    let mut seed = 7;
    let mut removed = 0;
    each_triangle(|name, _, triangle, [a, b, c], _| {
        let plane = cross(sub(b, a), sub(c, a));
        for distance in [1.1, 3.0, 16.0] {
            for _ in 0..20 {
                let eye = scale([0, 1, 2].map(|_| noise(&mut seed)), distance);
                // Near the plane, where it is close: moved onto it, and a little to the front.
                let height = dot(plane, sub(eye, a)) / dot(plane, plane);
                for eye in [eye, sub(eye, scale(plane, height * (1.0 - 1e-9)))] {
                    let culled = dot(wide(triangle.normal), eye) < f64::from(triangle.offset) / 16384.0;
                    assert!(!culled || dot(plane, sub(eye, a)) <= 0.0, "{name}: {triangle:?} from {eye:?}");
                    removed += usize::from(culled);
                }
            }
        }
    });
    assert!(removed > 0);
}

#[test]
fn backs_are_culled() {
    each_triangle(|name, _, triangle, [a, b, c], _| {
        let front = unit(cross(sub(b, a), sub(c, a))).unwrap();
        assert!(dot(front, wide(triangle.normal)) > 0.999, "{name}");
        let eye = add(a, scale(front, -0.02));
        assert!(dot(wide(triangle.normal), eye) < f64::from(triangle.offset) / 16384.0, "{name}");
    });
}

#[test]
fn closed_meshes_face_outward() {
    let mut volumes: HashMap<String, f64> = HashMap::new();
    each_triangle(|name, stream, triangle, [a, b, c], _| {
        *volumes.entry(name.to_owned()).or_default() += dot(a, cross(b, c)) / 6.0;
        if stream.meshes[0].flags & CLOSED_CONVEX != 0 {
            assert!(dot(wide(triangle.normal), add(a, add(b, c))) > 0.0, "{name}");
        }
    });
    for name in ["bunny", "sphere-168", "sphere-374", "sphere-690", "peer-sphere", "sphere-40", "dodecahedron", "torus"] {
        assert!(volumes[name] > 0.0, "{name}");
    }
}

#[test]
fn convex_scenes_are_known() {
    for name in scene::NAMES.into_iter().chain(scene::VARIANTS) {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        let convex = stream.meshes.iter().all(|m| m.flags & CLOSED_CONVEX != 0);
        let expected = name == scene::CONVEX || name.starts_with("sphere") || name == "dodecahedron";
        assert_eq!(convex, expected, "{name}");
    }
}

#[test]
fn corners_turn_counter_clockwise_on_the_screen() {
    // Right is +x and up is +y for an eye in front: the sign of the whole chain from object space to the screen.
    let view = View::orbit(Up::Y, 0.0, 0.0, 4.0, 0);
    let near = |a: V3, b: V3| length(sub(a, b)) < 1e-12;
    assert!(near(view.eye_space([1.0, 0.0, 0.0], 0.0), [1.0, 0.0, 4.0]));
    assert!(near(view.eye_space([0.0, 1.0, 0.0], 0.0), [0.0, 1.0, 4.0]));
    assert!(near(view.eye_space([0.0, 0.0, 1.0], 0.0), [0.0, 0.0, 3.0]));
    let view = View::orbit(Up::Z, 0.0, 0.0, 4.0, 0);
    assert!(near(view.eye_space([0.0, 0.0, 1.0], 0.0), [0.0, 1.0, 4.0]));
    assert!(near(view.eye_space([0.0, -1.0, 0.0], 0.0), [0.0, 0.0, 3.0]));
    // Whichever axis is up, it is up on the screen, and no view mirrors.
    for up in Up::ALL {
        let axis = ["x", "y", "z"].map(|axis| f64::from(u8::from(up.name().ends_with(axis))));
        let axis = if up.name().starts_with('-') { scale(axis, -1.0) } else { axis };
        let view = View::orbit(up, 0.0, 0.0, 4.0, 0);
        assert!(near(view.eye_space(axis, 0.0), [0.0, 1.0, 4.0]), "{up:?}");
        let [right, top, away] = view.rotation;
        assert!(near(cross(right, top), scale(away, -1.0)), "{up:?}");
    }
}

#[test]
fn peer_sphere_is_the_measured_one() {
    let scene = scene::load("peer-sphere").unwrap();
    let stream = scene.stream.parse().unwrap();
    assert_eq!((stream.vertices.len(), stream.triangles.len(), scene.size), (362, 720, (320, 240)));
    let near = |a: V3, b: V3| length(sub(a, b)) < 1e-4;
    assert!(near(wide(stream.vertices[0].position), [0.0, 0.852_524_5, 0.522_687_2]));
    assert!(near(wide(stream.vertices[1].position), [0.057_653_1, 0.738_726_7, 0.671_534_8]));
    assert!(near(wide(stream.vertices[25].position), [0.113_090_7, 0.596_54, 0.794_575_7]));
    let mut fronts = 0;
    each_triangle(|name, _, _, [a, b, c], _| {
        let front = dot(cross(sub(b, a), sub(c, a)), sub([0.0, 0.0, 3.0], a)) > 0.0;
        fronts += usize::from(name == "peer-sphere" && front);
    });
    assert_eq!(fronts, 242);
}

#[test]
fn doubled_vertices_weld_and_inside_out_surfaces_turn() {
    // A tetrahedron, each face with vertices of its own, wound clockwise; one face twice as a line.
    let points = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
    let mut text = String::new();
    for face in [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2], [1, 1, 2]] {
        face.iter().for_each(|&p| text += &format!("v {}\n", points[p]));
        text += "f -3 -2 -1\n";
    }
    let (mesh, report) = mesh::weld(&obj::parse(&text).unwrap().soup, Weld::SMOOTH).unwrap();
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4, 4));
    assert_eq!((report.welded, report.degenerate, report.own_normals, report.turned), (11, 1, false, true));
    let (parts, dropped) = quantise(&mesh);
    assert_eq!((parts.len(), dropped, parts[0].closed_convex), (1, 0, true));
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(dot(*p, *n) > 0.0);
    }
}

/// A beam with the section of a C, whose concave ends would cover its gap as fans. Wherever the outline begins, with normals or without.
#[test]
fn concave_polygons_keep_their_gaps() {
    let outline = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [3, 2], [3, 3], [0, 3]];
    for (first, normals) in (0..outline.len()).flat_map(|first| [(first, false), (first, true)]) {
        let corner = |k: usize, top: bool| {
            let index = 2 * ((k + first) % 8) + usize::from(top) + 1;
            if normals { format!(" {index}//1") } else { format!(" {index}") }
        };
        let mut text = "vn 0 0 1\n".to_owned();
        outline.iter().for_each(|[x, y]| text += &format!("v {x} {y} 0\nv {x} {y} 1\n"));
        text += &format!("f{}\n", (0..8).map(|k| corner(k, true)).collect::<String>());
        text += &format!("f{}\n", (0..8).rev().map(|k| corner(k, false)).collect::<String>());
        for k in 0..8 {
            text += &format!("f{}{}{}{}\n", corner(k, false), corner(k + 1, false), corner(k + 1, true), corner(k, true));
        }
        let (mesh, report) = mesh::weld(&obj::parse(&text).unwrap().soup, Weld::SMOOTH).unwrap();
        assert_eq!((report.crossed, report.degenerate, report.turned, report.own_normals), (0, 0, false, normals));
        assert_eq!(mesh.triangles.len(), 2 * 6 + 16);
        let corners = |t: &[usize; 3]| t.map(|v| mesh.positions[v]);
        let doubled = |[a, b, c]: [V3; 3]| length(cross(sub(b, a), sub(c, a)));
        let scale = length([1.5, 1.5, 0.5]);
        // Two ends of 7 each, and an outline of 16 times 1.
        let area: f64 = mesh.triangles.iter().map(|t| doubled(corners(t)) / 2.0).sum::<f64>() * scale * scale;
        let volume: f64 = mesh.triangles.iter().map(corners).map(|[a, b, c]| dot(a, cross(b, c)) / 6.0).sum::<f64>() * scale.powi(3);
        assert!((area - 30.0).abs() < 1e-9 && (volume - 7.0).abs() < 1e-9, "{first}: area {area}, volume {volume}");
    }
}

/// A mesh of a stream has at most 65,535 vertices, because 16 bits count them. A surface with one vertex more becomes two meshes and stays the same.
#[test]
fn one_vertex_too_many_makes_another_mesh() {
    // Triangles that share no vertex, one in each cell of a grid.
    let (count, side) = (usize::from(u16::MAX) / 3, 150);
    let mut mesh = mesh::Mesh::default();
    for k in 0..=count {
        let [x, y] = [k % side, k / side].map(|c| 1.4 * c as f64 / side as f64 - 0.7);
        mesh.triangles.push([0, 1, 2].map(|corner| 3 * k + corner));
        mesh.positions.extend([[x, y, 0.0], [x + 0.005, y, 0.0], [x, y + 0.005, 0.0]]);
        mesh.normals.extend([[0.0, 0.0, 1.0]; 3]);
    }
    let look = Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 20), View::orbit(Up::Y, 0.0, 0.0, 4.0, 8));
    for (triangles, expected) in [(count + 1, &[65_535, 3][..]), (count, &[65_535])] {
        mesh.triangles.truncate(triangles);
        let stream = look.stream(&quantise(&mesh).0).unwrap();
        let stream = stream.parse().unwrap();
        let vertices: Vec<_> = stream.meshes.iter().map(|mesh| mesh.vertices).collect();
        assert_eq!(vertices, expected);
        let corners = stream.meshes.iter().flat_map(|mesh| {
            let vertices = stream.vertices_of(mesh).unwrap();
            stream.triangles_of(mesh).unwrap().iter().map(|triangle| triangle.corners.map(|c| wide(vertices[usize::from(c)].position)))
        });
        let exact = mesh.triangles.iter().map(|corners| corners.map(|corner| mesh.positions[corner]));
        assert!(corners.clone().count() == triangles);
        assert!(corners.zip(exact).all(|(found, exact)| (0..3).all(|k| length(sub(found[k], exact[k])) < 1e-4)), "another surface");
    }
}

#[test]
fn large_meshes_are_split() {
    let side = 300;
    let mut mesh = mesh::Mesh::default();
    for y in 0..side {
        for x in 0..side {
            let place = |i: usize| i as f64 / side as f64 - 0.5;
            mesh.positions.push([place(x), place(y), 0.0]);
            mesh.normals.push([0.0, 0.0, 1.0]);
            if x + 1 < side && y + 1 < side {
                let at = y * side + x;
                mesh.triangles.extend([[at, at + 1, at + side + 1], [at, at + side + 1, at + side]]);
            }
        }
    }
    let (parts, dropped) = quantise(&mesh);
    assert_eq!((parts.len(), dropped), (2, 0));
    assert_eq!(parts.iter().map(|p| p.triangles.len()).sum::<usize>(), mesh.triangles.len());
    let view = View::orbit(Up::Y, 0.0, 0.0, 4.0, 8);
    let stream = Look { shader: Shader::PHONG, ..Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 20), view) }.stream(&parts).unwrap();
    assert_eq!(Shader::by_id(stream.parse().unwrap().header.shader), Some(Shader::PHONG));
}

/// The corners of a cube, and its faces, each with what stands before it.
fn cube(before: [&str; 6]) -> String {
    let corners = (0..8).map(|k| format!("v {} {} {}\n", k & 1, k >> 1 & 1, k >> 2));
    let faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"];
    corners.chain(before.into_iter().zip(faces).map(|(before, face)| format!("{before}\nf {face}\n"))).collect()
}

fn welded(text: &str, crease: f64) -> Mesh {
    mesh::weld(&obj::parse(text).unwrap().soup, Weld { turn: false, crease }).unwrap().0
}

/// Edges that fold by more than the crease angle are seen: all faces on one side of them have a normal of their own.
#[test]
fn creases_divide_normals() {
    let vertices = |text: &str, crease| welded(text, crease).positions.len();
    let text = cube([""; 6]);
    assert_eq!([0.0, 30.0, 89.9, 90.0, 180.0].map(|crease| vertices(&text, crease)), [24, 24, 24, 8, 8]);
    let sharp = welded(&text, 30.0);
    for triangle in &sharp.triangles {
        let [a, b, c] = triangle.map(|v| sharp.positions[v]);
        let face = unit(cross(sub(b, a), sub(c, a))).unwrap();
        assert!(triangle.iter().all(|&v| dot(sharp.normals[v], face) > 1.0 - 1e-12));
    }
    // A pyramid of 24 sides, each of which folds by 11 degrees over its neighbours and by 135 over the base. Its tip is smooth, although what lies
    // opposite folds by 90.
    let rim: String =
        (0..24).map(|k| f64::from(k) * 0.261_799_387_799).map(|a| format!("v {} {} 0\n", libm::cos(a), libm::sin(a))).collect();
    let sides: String = (0..24).map(|k| format!("f {} {} 25\n", k + 1, (k + 1) % 24 + 1)).collect();
    let base: String = (1..=24).rev().map(|k| format!(" {k}")).collect();
    let pyramid = format!("{rim}v 0 0 1\n{sides}f{base}\n");
    assert_eq!([5.0, 30.0, 140.0].map(|crease| vertices(&pyramid, crease)), [3 * 24 + 24, 24 + 1 + 24, 24 + 1]);
    let round = welded(&pyramid, 30.0);
    let highest = round.positions.iter().map(|p| p[2]).fold(f64::MIN, f64::max);
    let tips: Vec<_> = round.positions.iter().zip(&round.normals).filter(|(p, _)| p[2] == highest).map(|(_, normal)| normal).collect();
    assert!(tips.len() == 1 && tips[0][2] > 1.0 - 1e-9, "{tips:?}");
}

/// Smoothing groups of a file count more than angles.
#[test]
fn smoothing_groups_divide_normals() {
    let vertices = |before| welded(&cube(before), 30.0).positions.len();
    assert_eq!(vertices(["s 1", "", "", "", "", ""]), 8);
    assert_eq!(vertices(["s off", "", "", "", "", ""]), 24);
    // The lid is apart.
    assert_eq!(vertices(["s 1", "s 2", "s 1", "", "", ""]), 12);
}

/// Each material of a file becomes a mesh of the stream, as the file beside it says; borders between them have no gaps.
#[test]
fn materials_become_meshes() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("cube.obj");
    let text = cube(["mtllib a.mtl\nusemtl red", "usemtl blue", "usemtl nowhere", "usemtl red", "", "usemtl blue"]);
    fs::write(&path, text).unwrap();
    let remarks = import::file(&path, Weld::SMOOTH).unwrap().remarks;
    assert!(remarks[0].contains("a.mtl cannot be read") && remarks[1].ends_with("red, blue, nowhere"), "{remarks:?}");
    fs::write(directory.path().join("a.mtl"), "newmtl blue\nKd 0.1 0.2 0.9\nNs 50\nnewmtl red\nKd 0.9 0 0\nKs 0.25 0.25 0.25\nd 0.5")
        .unwrap();
    let imported = import::file(&path, Weld::SMOOTH).unwrap();
    assert_eq!(imported.remarks, ["materials that no file defines have the colour of the command line: nowhere"]);
    // A line may name several files, of which one is missing here.
    fs::write(&path, fs::read_to_string(&path).unwrap().replace("a.mtl", "b.mtl a.mtl")).unwrap();
    let several = import::file(&path, Weld::SMOOTH).unwrap();
    assert!(several.materials == imported.materials && several.remarks[0].contains("b.mtl cannot be read"), "{:?}", several.remarks);
    let (parts, dropped) = quantise(&imported.mesh);
    assert_eq!(
        (dropped, parts.iter().map(|part| (part.material, part.triangles.len())).collect::<Vec<_>>()),
        (0, vec![(0, 6), (1, 4), (2, 2)])
    );
    let other = Surface::metal([1.0, 0.5, 0.25], [0.5, 0.5, 0.5], 7);
    let look =
        Look { surfaces: import::surfaces(&imported.materials, &other, 0.5), ..Look::new(other, View::orbit(Up::Y, 0.0, 0.0, 4.0, 8)) };
    let bytes = look.stream(&parts).unwrap();
    let stream = bytes.parse().unwrap();
    let materials: Vec<_> = stream.materials.iter().map(|m| (m.diffuse().map(|gain| gain.to_num::<f64>() as f32), m.exponent)).collect();
    assert_eq!(materials.len(), 3);
    for ((diffuse, exponent), (expected, sharp)) in
        materials.iter().zip([([0.9, 0.0, 0.0], 30), ([0.1, 0.2, 0.9], 50), ([0.5, 0.25, 0.125], 7)])
    {
        assert!(diffuse.iter().zip(expected).all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-3) && *exponent == sharp, "{materials:?}");
    }
    // All corners of the cube have the same place in every mesh that has them.
    let places: HashSet<_> = stream.vertices.iter().map(|vertex| vertex.position).collect();
    assert_eq!(places.len(), 8);
}

/// A file may have as many materials and objects as faces. Names are found at once, and not by comparing each with each.
#[test]
fn very_many_names_take_no_long_time() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.obj");
    let count = 150_000;
    let faces: String = (0..count).map(|k| format!("usemtl m # {k}\nf 1 2 3\n")).collect();
    let materials: String = (0..count).map(|k| format!("newmtl m # {k}\nKd 1 0 0\n")).collect();
    fs::write(&path, format!("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{faces}")).unwrap();
    fs::write(place.path().join("a.mtl"), materials).unwrap();
    let start = std::time::Instant::now();
    assert_eq!(import::file(&path, Weld::default()).unwrap().materials.iter().flatten().count(), count);
    // It takes about a second. Comparing each with each takes more than a minute.
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}
