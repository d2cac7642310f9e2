//! `microphong compare`: its output, its refusals, and its page.

use crate::vertex_colours::parts;
use embedded_graphics::prelude::Size;
use microphong::{
    Light,
    format::{Angle, ErrorBudget},
    renderer::check,
    stream::record::{Colour, HAS_TEXTURE, TRANSPARENCY_SHIFT, Texture, TextureCorners},
};
use microphong_sim::{
    bytes::StreamBytes,
    compare::{
        Comparison, Reference,
        antialias::{self, Smoothing},
        exponent::with_exponent,
        supersampled::Supersampled,
    },
    image, oracle,
    render::{self, Format, Settings, Style},
    scene,
    shader::Shader,
    stress::records::Records,
};
use serde_json::Value;
use std::{fs, path::Path, process::Output};

fn run(directory: &Path, arguments: &[&str]) -> Output {
    microphong_tests::run(directory, &[&["compare"], arguments].concat())
}

fn succeeds(directory: &Path, arguments: &[&str]) -> String {
    microphong_tests::succeeds(directory, &[&["compare"], arguments].concat())
}

fn objects(lines: &str) -> Vec<Value> {
    lines.lines().map(|line| serde_json::from_str(line).expect("an object per line")).collect()
}

/// The figures that every method has that can draw the scene.
const FIGURES: [&str; 12] = [
    "max_lsb",
    "p99_lsb",
    "rmse_lsb",
    "color_correctness",
    "psnr",
    "similarity",
    "edge_jump_lsb",
    "mach_jump_lsb",
    "arithmetic_lsb",
    "arithmetic_rmse_lsb",
    "method_max_lsb",
    "method_rmse_lsb",
];

#[test]
fn json_has_all_figures_of_every_scene_and_method() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let lines =
        succeeds(directory.path(), &["sphere-168", "torus", "--shader", "gouraud,six-point,phong", "--override-exponent", "50", "--json"]);
    let objects = objects(&lines);
    let keys: Vec<_> = objects.iter().map(|o| (o["scene"].as_str().unwrap_or(""), o["shader"].as_str().unwrap_or(""))).collect();
    let methods = ["gouraud", "six-point", "phong"];
    let expected: Vec<_> = ["sphere-168", "torus"].iter().flat_map(|&scene| methods.map(|method| (scene, method))).collect();
    assert_eq!(keys, expected);
    for object in &objects {
        assert_eq!(object["exponent"], 50);
        for figure in FIGURES {
            assert!(object[figure].as_f64().is_some_and(|value| value >= 0.0), "{figure} of {object}");
        }
        for count in ["adds", "multiplies", "loads", "setup", "setup_row", "pixels"] {
            assert!(object[count].is_u64(), "{count} of {object}");
        }
        assert_eq!((object["unmatched"].as_u64(), object.get("reason")), (Some(0), None), "{object}");
        let [max, p99, rmse] = ["max_lsb", "p99_lsb", "rmse_lsb"].map(|figure| object[figure].as_f64().unwrap_or(f64::NAN));
        assert!(max >= p99 && max >= rmse, "{object}");
    }
    // The better a method, the better all of its figures.
    for [worse, better] in [&objects[0..2], &objects[1..3], &objects[3..5], &objects[4..6]].map(|pair| [&pair[0], &pair[1]]) {
        for figure in ["max_lsb", "rmse_lsb", "method_max_lsb"] {
            assert!(worse[figure].as_f64() > better[figure].as_f64(), "{figure} of {worse} and {better}");
        }
        for figure in ["color_correctness", "psnr", "similarity"] {
            assert!(worse[figure].as_f64() < better[figure].as_f64(), "{figure} of {worse} and {better}");
        }
    }
}

#[test]
fn an_exponent_changes_the_highlights_alone() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let figure = |exponent: &str, shader: &str| {
        let lines =
            succeeds(directory.path(), &["sphere-374", "--size", "96x96", "--shader", shader, "--override-exponent", exponent, "--json"]);
        objects(&lines)[0]["method_max_lsb"].as_f64().expect("a figure")
    };
    assert!(figure("100", "gouraud") > 2.0 * figure("5", "gouraud"));
    assert_eq!(figure("100", "phong"), 0.0);
}

#[test]
fn wrong_usage_and_impossible_methods() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let cases: [(&[&str], i32, &[&str]); 9] = [
        (&["teapott"], 2, &["teapott", "teapot, bunny"]),
        (&["teapot", "--shader", "fong"], 2, &["fong", "six-point", "or all"]),
        (&["teapot", "--shader", "phong,"], 2, &["--shader"]),
        (&["teapot", "--override-exponent", "0"], 2, &["--override-exponent"]),
        (&["teapot", "--override-exponent", "1025"], 2, &["--override-exponent"]),
        (&["teapot", "--size", "0x4"], 2, &["WIDTHxHEIGHT"]),
        (&[], 2, &["SCENE"]),
        // Before anything is drawn: nothing on stdout, though the other method and scene could be.
        (&["sphere-40", "--shader", "phong,taylor", "--json"], 1, &["sphere-40", "taylor", "directional"]),
        (&["sphere-168", "dodecahedron", "--shader", "goldman", "--report", "page"], 1, &["dodecahedron", "goldman"]),
    ];
    for (arguments, code, words) in cases {
        let output = run(directory.path(), arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
        assert!(output.stdout.is_empty() && !stderr.contains("panicked"), "{arguments:?}: {stderr}");
        for word in words {
            assert!(stderr.contains(word), "{arguments:?}: {word:?} is not in {stderr:?}");
        }
    }
    assert_eq!(fs::read_dir(directory.path()).expect("scratch directory").count(), 0);
    fs::write(directory.path().join("taken"), "").expect("scratch file");
    assert_eq!(run(directory.path(), &["triangle", "--report", "taken"]).status.code(), Some(1));
}

#[test]
fn among_all_an_impossible_method_says_why() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let objects = objects(&succeeds(directory.path(), &["sphere-40", "--size", "64x64", "--json"]));
    assert_eq!(objects.iter().map(|o| o["shader"].as_str()).collect::<Vec<_>>(), Shader::ALL.map(|s| Some(s.name())));
    for (object, shader) in objects.iter().zip(Shader::ALL) {
        if !shader.facts().near_lights {
            assert!(object["reason"].as_str().is_some_and(|reason| reason.contains("directional")), "{object}");
            assert!(FIGURES.iter().all(|figure| object[figure].is_null()), "{object}");
        }
    }
    let text = succeeds(directory.path(), &["sphere-40", "--size", "64x64"]);
    assert!(text.lines().any(|line| line.contains("taylor ") && line.contains("directional")), "{text}");
}

#[test]
fn the_report_is_one_file_that_needs_no_other() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let arguments = ["sphere-40", "torus", "--shader", "flat,renq", "--size", "80x60", "--report", "a/b"];
    let text = succeeds(directory.path(), &arguments);
    assert!(text.contains("a/b/index.html"), "{text}");
    let files: Vec<_> = fs::read_dir(directory.path().join("a/b")).expect("the report").map(|e| e.expect("entry").file_name()).collect();
    assert_eq!(files, ["index.html"]);
    let page = fs::read_to_string(directory.path().join("a/b/index.html")).expect("text");
    assert!(!page.contains("://"), "a link leads out");
    for start in ["src=\"", "href=\"", "url("] {
        for (at, _) in page.match_indices(start) {
            let target = &page[at + start.len()..];
            assert!(target.starts_with("data:image/png;base64,") || target.starts_with('#'), "{}", &target[..40]);
        }
    }
    // A reference for each scene, and three pictures of each method.
    assert_eq!(page.matches("<img ").count(), 2 * (1 + 2 * 3));
    assert_eq!(page.matches("<img ").count(), page.matches(" alt=\"").count());
    // Two legends for each scene and a curve for each method, all with a label.
    assert_eq!(page.matches("<svg ").count(), 2 * (2 + 2));
    assert_eq!(page.matches("role=\"img\" aria-label=\"").count(), page.matches("<svg ").count());
    assert_eq!(page.matches("<table").count(), 2);
}

/// The page shows the choices of `auto` as they are printed. Other methods choose nothing.
#[test]
fn the_report_shows_choices() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let text = succeeds(directory.path(), &["torus", "--shader", "gouraud,auto", "--size", "80x60", "--budget", "2", "--report", "page"]);
    let line = text.lines().find(|line| line.contains("budget 2 LSB; ")).expect("a line");
    let (triangles, pixels) = line.trim_start().trim_start_matches("budget 2 LSB; ").split_once("; ").expect("two lists");
    let page = fs::read_to_string(directory.path().join("page/index.html")).expect("text");
    for shares in [triangles, pixels] {
        // Ways that draw nothing have no part of the bar.
        let parts: Vec<_> = shares.split(", ").filter(|part| !part.ends_with(" 0.0 %")).collect();
        assert_eq!(page.matches(&format!("title=\"{}", parts.join(", "))).count(), 1, "{shares}");
    }
    assert_eq!((page.matches("class=\"shares\"").count(), page.matches("class=\"ways\"").count()), (2, 1));
}

/// Smooth outlines are nearer to the means of samples than jagged ones, which is said with the place of the largest difference, also of a scene with several
/// objects. The page shows both pictures, the means and the differences.
#[test]
fn smooth_outlines_are_measured() {
    let directory = tempfile::tempdir().expect("scratch directory");
    let arguments = ["torus", "board", "--antialias", "--size", "96x72", "--frame", "3"];
    let found = objects(&succeeds(directory.path(), &[&arguments[..], &["--json"]].concat()));
    let named: Vec<_> =
        found.iter().map(|object| [&object["scene"], &object["shader"]].map(|name| name.as_str().expect("a name"))).collect();
    assert_eq!(named, [["torus", "auto"], ["board", "auto"]], "the methods of the scenes");
    for object in &found {
        let figure = |picture: &str, figure: &str| object[picture][figure].as_f64().expect("a figure");
        assert!(figure("smooth", "edges_rmse") < 0.7 * figure("plain", "edges_rmse"), "{object}");
        assert!(figure("smooth", "max") > figure("smooth", "edges_rmse") && figure("plain", "max") <= 255.0, "{object}");
        let [x, y] = [0, 1].map(|k| object["smooth"]["at"][k].as_u64().expect("a place"));
        assert!(x < 96 && y < 72 && object["pixels"] == 96 * 72, "{object}");
        assert!((100..3_000).contains(&object["edge_pixels"].as_u64().expect("a count")), "{object}");
    }
    let text = succeeds(directory.path(), &[&arguments[..], &["--shader", "flat,gouraud", "--report", "page"]].concat());
    assert!(text.starts_with("torus: 96x72; differences from means of 16x16 samples") && text.lines().count() == 9, "{text}");
    let page = fs::read_to_string(directory.path().join("page/index.html")).expect("text");
    assert_eq!((page.matches("<img ").count(), page.matches(" alt=\"").count()), (2 * 2 * 4, 2 * 2 * 4));
    let among_all = objects(&succeeds(directory.path(), &["sphere-40", "--antialias", "--size", "40x30", "--shader", "all", "--json"]));
    assert!(
        among_all.len() == Shader::ALL.len() && among_all.iter().any(|object| object["smooth"].is_null() && object["reason"].is_string())
    );
}

/// The means are those of pictures: in pixels without an edge plain pictures differ from them by little more than rounding, whatever the scene has.
#[test]
fn means_of_samples_know_all_of_a_scene() {
    let load = |name: &str| scene::load(name).expect("a built-in scene").stream;
    let degrees = |degrees: f32| Angle::from_num(degrees / 360.0);
    let cone = Light::near([1.5, 2.0, 2.0], [1; 3]).and_then(|light| light.with_range(6));
    let cone = cone.and_then(|light| light.with_cone([-3, -4, -4], degrees(10.0), degrees(20.0))).expect("a light");
    let sky = Light::hemisphere([0, 1, 0], [0.8, 0.8, 1.0], [0.3, 0.2, 0.1]).expect("lights");
    let scenes = [
        ("lights", load("sphere-690"), 0, 1.0),
        ("a near light", load("sphere-40"), 0, 1.0),
        ("a cone", load("teapot").with_lights(&[cone]).expect("a light"), 0, 1.0),
        ("a sky", load("teapot").with_lights(&sky).expect("lights"), 5, 1.0),
        ("colours", load("fox"), 0, 1.0),
        ("objects", load("board"), 13, 1.0),
        ("objects that move", Records { labels: Vec::new(), ..parts("gauges") }.written().expect("a stream"), 20, 1.0),
        ("glass", glass(9), 0, 1.0),
        ("holes", pierced(1), 0, 1.0),
    ];
    for (kind, stream, frame, most) in scenes {
        let stream = stream.without_outlines();
        let stream = stream.parse().expect("a stream");
        for perspective_correct in [false, true] {
            let samples = Supersampled::new(stream, SEEN_THROUGH, frame, perspective_correct).expect("a frame");
            let style = Style { perspective_correct, ..Shader::PHONG.into() };
            let Smoothing { edges, smooth, plain, .. } = antialias::compare(stream, &samples, style, frame, &|| ()).expect("a comparison");
            println!("{kind:18} {edges:5} edges: {smooth:?} {plain:?}");
            assert!(plain.elsewhere_rmse < most && edges > 50, "{kind}: {plain:?}, {edges}");
        }
    }
}

/// A coloured metal is walked in one channel, other materials in three: whichever it is, that is what errors are measured in.
#[test]
fn phong_is_as_exact_in_any_material() {
    for name in ["teapot", "dodecahedron", "torus", "bunny", "peer-sphere-plastic"] {
        let scene = scene::load(name).expect("a built-in scene");
        let stream = scene.stream.parse().expect("a stream");
        let error = Reference::new(stream, (80, 60), 0).expect("something to see").total(Shader::PHONG).expect("a comparison").max;
        assert!(error < 0.5, "{name}: {error}");
    }
}

/// Under two lights, loops of methods that hold levels of light draw a coloured metal in three channels, and others in one.
#[test]
fn a_metal_is_walked_as_its_method_does_it() {
    let scene = scene::load("teapot").expect("a built-in scene");
    let mut records = Records::of(&scene.stream.parse().expect("a stream"));
    records.lights = vec![records.lights[0]; 2];
    let stream = records.written().expect("a stream");
    let reference = Reference::new(stream.parse().expect("a stream"), (80, 60), 0).expect("something to see");
    for shader in [Shader::PHONG, Shader::AUTO, Shader::SQRT6, Shader::GOURAUD] {
        let error = reference.compare(shader).expect("a comparison").arithmetic.max;
        assert!(error < 0.5, "{}: {error}", shader.name());
    }
}

#[test]
fn figures_are_those_of_pictures_compared_by_hand() {
    let scene = scene::load("triangle").expect("a built-in scene");
    let bytes = with_exponent(scene.stream.as_bytes(), 9).expect("a whole stream");
    let bytes = StreamBytes::from(bytes.as_slice());
    let stream = bytes.parse().expect("a stream");
    let (size, number) = ((120, 90), 3);
    let reference = Reference::new(stream, size, number).expect("something to see");
    let comparison = reference.compare(Shader::GOURAUD).expect("a comparison");

    // One white triangle: no pixel is in doubt, and all channels are equal.
    let frame = oracle::Frame::new(stream, size, number);
    let facet = &frame.facets[0];
    let phong = oracle::phong(&frame, facet);
    let gouraud = oracle::method("gouraud", &frame, facet).expect("a method for every scene");
    let (mut worst, mut square, mut off, mut count) = (0.0f64, 0.0, 0.0, 0.0);
    let (mut left, mut right) = (u32::MAX, 0);
    for [x, y] in facet.pixels(size) {
        let centre = [f64::from(x) + 0.5, f64::from(y) + 0.5];
        let error = gouraud(centre)[0] - phong(centre)[0];
        worst = worst.max(error.abs());
        square += error * error;
        let at = (y * size.0 + x) as usize;
        off += (f64::from(comparison.picture[at][0]) - phong(centre)[0].round()).abs();
        assert!((comparison.errors[at].expect("a pixel of the triangle") - error).abs() <= comparison.arithmetic.max + 1e-9);
        assert!((reference.level(x, y).expect("a pixel of the triangle") - phong(centre)[0]).abs() < 1e-9);
        count += 1.0;
        (left, right) = (left.min(x), right.max(x));
    }
    assert!(worst > 1.0 && comparison.arithmetic.max < 0.1, "{worst} {:?}", comparison.arithmetic);
    assert_eq!((comparison.pixels, comparison.unmatched), (count as usize, 0));
    assert!((comparison.method.max - worst).abs() < 1e-9 && (comparison.method.rmse - (square / count).sqrt()).abs() < 1e-9);
    assert!((comparison.total.max - worst).abs() <= comparison.arithmetic.max);
    assert!((comparison.colour_correctness - (1.0 - off / 255.0 / count)).abs() < 1e-12);
    // A triangle alone shares no edge.
    assert_eq!((comparison.jumps.level, comparison.jumps.slope), (0.0, 0.0));
    let columns = reference.window().columns.clone();
    assert!(columns.contains(&left) && columns.contains(&right) && columns.end - columns.start <= right - left + 9);
}

#[test]
fn jumps_of_the_prototypes() {
    let scene = scene::load("sphere-168").expect("a built-in scene");
    let reference = Reference::new(scene.stream.parse().expect("a stream"), scene.size, 0).expect("something to see");
    let jumps = |shader| reference.compare(shader).expect("a comparison").jumps;
    // Flat shading jumps and has no slope; all others are continuous, and Gouraud's slope breaks.
    let flat = jumps(Shader::FLAT);
    assert!(flat.level > 30.0 && flat.slope == 0.0, "{flat:?}");
    for shader in [Shader::GOURAUD, Shader::SIX_POINT, Shader::PHONG] {
        assert!(jumps(shader).level < 0.01, "{}", shader.name());
    }
    assert!(jumps(Shader::GOURAUD).slope > 1.0);
}

/// Neighbours that `auto` draws by different methods meet within twice the budget, as both are within it of the same Phong shading.
#[test]
fn neighbours_by_different_methods_meet_within_twice_the_budget() {
    let mut largest = 0.0;
    for name in scene::NAMES.iter().chain(&scene::VARIANTS) {
        let scene = scene::load(name).expect("a built-in scene");
        for budget in [1u8, 4] {
            let stream = scene.stream.clone().with_budget(ErrorBudget::from_num(budget));
            let reference = Reference::new(stream.parse().expect("a stream"), scene.size, 0).expect("something to see");
            let Comparison { jumps, method, .. } = reference.compare(Shader::AUTO).expect("a comparison");
            println!("{name:20} budget {budget}: jumps by {:.2} LSB, off by {:.2}", jumps.level, method.max);
            assert!(jumps.level <= f64::from(2 * budget + 1), "{name}, budget {budget}: {jumps:?}");
            largest = jumps.level.max(largest);
        }
    }
    // There is something to see.
    assert!(largest > 1.0, "{largest}");
}

#[test]
fn pictures_are_those_of_the_renderer() {
    let scene = scene::load("torus").expect("a built-in scene");
    let stream = scene.stream.parse().expect("a stream");
    let reference = Reference::new(stream, (64, 64), 0).expect("something to see");
    let comparison = reference.compare(Shader::SIX_POINT).expect("a comparison");
    let size = Size::new(64, 64);
    let (pixels, _) =
        microphong_sim::render::frame::<embedded_graphics::pixelcolor::Rgb888>(stream, size, Shader::SIX_POINT, 16, 0).expect("a picture");
    assert_eq!(comparison.picture.as_flattened(), image::rgb_bytes(&pixels));
}

const SEEN_THROUGH: (u32, u32) = (120, 90);

/// A torus that lets through so many sixteenths of the light from behind: the background, and other parts of itself.
fn glass(sixteenths: u8) -> StreamBytes {
    let mut records = parts("torus");
    records.meshes.iter_mut().for_each(|mesh| mesh.flags |= sixteenths << TRANSPARENCY_SHIFT);
    records.written().expect("a stream")
}

/// A teapot of glass and of holes, or of red glass, in turns, as squares of a texture that lies across it.
fn pierced(hole: u8) -> StreamBytes {
    let mut records = parts("teapot");
    records.colours = vec![Colour::new([255; 3]), Colour { hole, ..Colour::new([100, 20, 20]) }];
    records.texels = (0..64).map(|texel| ((texel / 8 + texel) % 2) as u8).collect();
    records.textures = vec![Texture { size: [3, 3], palette: 0, has_holes: hole }];
    let [mesh] = &mut records.meshes[..] else { panic!("one mesh") };
    mesh.flags |= HAS_TEXTURE | 3 << TRANSPARENCY_SHIFT;
    let place = |vertex: u16| {
        let [x, y, _] = records.vertices[mesh.first_vertex as usize + usize::from(vertex)].position;
        [x, y].map(|c| (i32::from(c) / 8 + 4_096) as u16)
    };
    records.texture_corners = records.triangles.iter().map(|triangle| TextureCorners(triangle.corners.map(place))).collect();
    records.written().expect("a stream")
}

/// What is seen through surfaces, and texels, are judged as exactly as all else, for each method.
#[test]
fn glass_and_holes_are_judged() {
    for (kind, stream, least) in [("glass", glass(9), 2_000), ("holes", pierced(1), 500), ("texels", pierced(0), 500)] {
        let stream = stream.parse().expect("a stream");
        let reference = Reference::new(stream, SEEN_THROUGH, 0).expect("something to see");
        let mut methods = 0;
        for shader in Shader::ALL.into_iter().filter(|shader| check(&stream, shader.facts(), false).is_ok()) {
            let Comparison { arithmetic, pixels, unmatched, .. } = reference.compare(shader).expect("a comparison");
            println!("{kind:6} {:20} {:.3} LSB, {pixels} pixels", shader.name(), arithmetic.max);
            assert!(arithmetic.max <= 0.5 && unmatched == 0 && pixels > least, "{kind}, {}: {arithmetic:?}", shader.name());
            methods += 1;
        }
        assert!(methods > 20, "{kind}: {methods}");
    }
}

/// The reference of a scene is its picture by Phong shading, and that of no scene that lets through a sixteenth more or has its holes filled in.
#[test]
fn the_reference_shows_what_is_seen_through_surfaces() {
    let apart = |one: &StreamBytes, other: &StreamBytes| {
        let reference = Reference::new(one.parse().expect("a stream"), SEEN_THROUGH, 0).expect("something to see").picture();
        let size = Size::new(SEEN_THROUGH.0, SEEN_THROUGH.1);
        let settings = Settings { size, style: Shader::PHONG.into(), band_rows: size.height, format: Format::Rgb888 };
        let drawn = render::picture(other.parse().expect("a stream"), &settings, 0).expect("a picture").rgb;
        let differences = reference.as_flattened().iter().zip(&drawn).map(|(one, other)| one.abs_diff(*other));
        differences.filter(|&difference| difference > 2).count()
    };
    assert_eq!(apart(&glass(9), &glass(9)), 0);
    assert!(apart(&glass(9), &glass(10)) > 1_000);
    // At the borders of holes rounding decides.
    let [same, filled] = [1, 0].map(|hole| apart(&pierced(1), &pierced(hole)));
    assert!(20 * same < filled && filled > 2_000, "{same} {filled}");
}

/// Several objects are measured together, each under the lights of its own space: a method is as near to the reference as on one object.
#[test]
fn several_objects_are_measured_together() {
    for name in scene::SCRIPTED {
        let bytes = scene::load(name).expect("a scene").stream.without_outlines().or_budget(ErrorBudget::from_num(4));
        let reference = Reference::of_objects(bytes.parse().expect("a stream"), (160, 120), 9).expect("something to see");
        for (shader, most) in [(Shader::PHONG, 1.0), (Shader::AUTO, 5.0)] {
            let total = reference.total(shader).expect("a picture");
            println!("{name}, {}: {total:?}", shader.name());
            assert!(total.max < most, "{name}, {}: {total:?}", shader.name());
        }
        assert!(reference.compare(Shader::PHONG).is_err_and(|error| error.to_string().contains("several objects")));
    }
}
