//! The models of the gallery: closed, of few triangles, drawn as the reference draws them, and shown in `docs/gallery.png`.
//!
//! `MICROPHONG_BLESS=1 cargo test -p microphong-tests gallery` records the picture.

use crate::golden::{bless, check_pixels, root};
use embedded_graphics::prelude::Size;
use microphong::{
    format::{ErrorBudget, Gain},
    stream::record::{HAS_COLOURS, Material, Triangle},
};
use microphong_sim::{
    bench::{Bench, Processor, board_styles::Program},
    compare::Reference,
    gallery::{Exhibit, GALLERY, LOW_POLY, ORDINARY},
    mesh::{Coloured, Report},
    render::{self, Format, Settings, Style},
    scene::{self, Scene},
    shader::Shader,
    stress::records::Records,
    vector::{cross, dot, sub},
};

fn exhibit(name: &str) -> &'static Exhibit {
    Exhibit::named(name).unwrap()
}

/// Welding finds nothing to mend: surfaces are closed, their fronts are outside, and no polygon crosses itself.
#[test]
fn models_are_closed_and_have_few_triangles() {
    for name in GALLERY.into_iter().chain(ORDINARY) {
        let imported = exhibit(name).imported().unwrap();
        let count = imported.mesh.triangles.len();
        assert_eq!(imported.report, Report { welded: imported.report.welded, ..Report::default() }, "{name}");
        assert!(imported.faults.is_empty() && imported.backs == 0, "{name}");
        println!("{name}: {count} triangles, {} of one colour, {} colours", imported.painted.of_one_colour, imported.painted.colours);
        assert_eq!(imported.painted.triangles, if GALLERY.contains(&name) { count } else { 0 }, "{name}");
        let most = if LOW_POLY.contains(&name) { 1200 } else { 2500 };
        assert!((300..=most).contains(&count), "{name}: {count} triangles");
    }
}

/// The scenes by which costs are judged are of the kinds that they are to be: a building of ten materials all of whose sides are flat, a figure of about
/// 2,000 triangles, and a mechanical part of which many triangles are thin.
#[test]
fn ordinary_models_are_of_their_kinds() {
    let mesh = |name| exhibit(name).imported().unwrap().mesh;
    let stream = scene::load("building").unwrap().stream;
    let building = stream.parse().unwrap();
    assert_eq!((building.meshes.len(), building.materials.len()), (10, 10));
    for mesh in building.meshes {
        let vertices = building.vertices_of(mesh).unwrap();
        let is_flat = |triangle: &Triangle| {
            let [a, b, c] = triangle.corners.map(|corner| vertices[usize::from(corner)].normal);
            a == b && b == c
        };
        assert!(building.triangles_of(mesh).unwrap().iter().all(is_flat));
    }
    assert!((1_800..=2_200).contains(&mesh("figure").triangles.len()));
    let bracket = mesh("bracket");
    let thin = bracket.triangles.iter().filter(|corners| {
        let [a, b, c] = corners.map(|corner| bracket.positions[corner]);
        let edges = [sub(b, a), sub(c, b), sub(a, c)].map(|edge| dot(edge, edge));
        let normal = cross(sub(b, a), sub(c, a));
        // The longest edge over the height above it.
        edges.into_iter().fold(0.0, f64::max) > 4.0 * dot(normal, normal).sqrt()
    });
    let thin = thin.count();
    println!("bracket: {thin} of {} triangles are thin", bracket.triangles.len());
    assert!(thin * 4 > bracket.triangles.len());
}

/// The share counts both of all triangles, and of those whose fronts the first frame shows.
#[test]
fn half_of_a_low_poly_model_has_triangles_of_one_colour() {
    for name in LOW_POLY {
        let mesh = exhibit(name).imported().unwrap().mesh;
        let view = exhibit(name).view(&mesh);
        let is_front = |triangle: &usize| {
            let [a, b, c] = mesh.triangles[*triangle].map(|vertex| view.eye_space(mesh.positions[vertex], 0.0));
            // Eye space is left-handed.
            dot(cross(sub(b, a), sub(c, a)), a) > 0.0
        };
        let share = |triangles: Vec<usize>| {
            let is_flat = |triangle: &&usize| mesh.coloured(**triangle).is_some_and(|Coloured { corners: [a, b, c], .. }| a == b && b == c);
            triangles.iter().filter(is_flat).count() as f64 / triangles.len() as f64
        };
        let all = 0..mesh.triangles.len();
        let shares = [share(all.clone().collect()), share(all.filter(is_front).collect())];
        println!("{name}: {shares:.3?} of one colour");
        assert!(shares.iter().all(|share| (0.4..=0.6).contains(share)), "{name}: {shares:.3?}");
    }
}

/// The integer arithmetic stays as close to the methods in f64 as in other scenes.
#[test]
fn pictures_are_those_of_the_reference() {
    for name in GALLERY {
        let scene = scene::load(name).unwrap();
        let reference = Reference::new(scene.stream.parse().unwrap(), (120, 120), 0).unwrap();
        for shader in [Shader::GOURAUD, Shader::PHONG, Shader::AUTO] {
            let found = reference.compare(shader).unwrap();
            println!("{name} by {}: arithmetic {:?}, all {:?}", shader.name(), found.arithmetic, found.total);
            assert!(found.arithmetic.max < 1.0 && found.unmatched == 0, "{name} by {}: {:?}", shader.name(), found.arithmetic);
            assert!(shader == Shader::GOURAUD || found.total.max < 2.0, "{name} by {}: {:?}", shader.name(), found.total);
        }
    }
}

/// All models side by side, as `render --format rgb888` draws them at 240x240.
#[test]
fn the_documents_show_the_gallery() {
    const COLUMNS: usize = 4;
    const SIDE: usize = 240;
    let size = Size::new((COLUMNS * SIDE) as u32, (GALLERY.len() / COLUMNS * SIDE) as u32);
    let style = Style { antialias: true, ..Shader::AUTO.into() };
    let settings = Settings { size: Size::new_equal(SIDE as u32), style, band_rows: SIDE as u32, format: Format::Rgb888 };
    let pictures = GALLERY.map(|name| render::picture(scene::load(name).unwrap().stream.parse().unwrap(), &settings, 0).unwrap().rgb);
    let rows = pictures.chunks(COLUMNS).flat_map(|pictures| (0..SIDE).flat_map(|row| pictures.iter().map(move |picture| (picture, row))));
    let sheet: Vec<u8> = rows.flat_map(|(picture, row)| &picture[3 * SIDE * row..3 * SIDE * (row + 1)]).copied().collect();
    assert_eq!(check_pixels(&root().join("../docs/gallery.png"), size, &sheet, bless()), None);
}

/// The scene in the light of the first lamps, in its colours and in one colour for all of it, with an error budget of 1.
fn in_colours_and_in_one(scene: &Scene, lamps: usize) -> [Scene; 2] {
    let mut records = Records::of(&scene.stream.parse().unwrap());
    assert!(records.meshes.iter().all(|mesh| mesh.flags & HAS_COLOURS != 0));
    records.lights.truncate(lamps);
    let mut plain = records.clone().without_colours();
    for material in &mut plain.materials {
        let by = |colour: [Gain; 3]| [0, 1, 2].map(|k| Gain::from_num(colour[k].to_num::<f64>() * [0.8, 0.35, 0.12][k]));
        *material = Material::new(by(material.ambient()), by(material.diffuse()), material.specular(), material.exponent);
    }
    let of = |records: Records| Scene { stream: records.written().unwrap().with_budget(ErrorBudget::ONE), ..scene.clone() };
    [records, plain].map(of)
}

/// A frame on a Cortex-M3 takes at most this many times the instructions of a frame in one colour. The aim of `phong` and `auto` is 1.25. Their kernels for
/// colours that change from pixel to pixel take three walks and three products more.
const LIMITS: [(Shader, f64); 3] = [(Shader::GOURAUD, 1.15), (Shader::PHONG, 1.49), (Shader::AUTO, 1.36)];
/// Under two lights `auto` takes at most this many times the instructions of `gouraud` in one colour, for each of [`LOW_POLY`]. It is not compared with
/// itself, because in one colour it draws flat sides as one colour, which sides of several colours cannot have.
const UNDER_TWO: [f64; 4] = [1.08, 1.95, 1.18, 1.48];

#[test]
fn costs_of_colours_at_corners_keep_to_their_limits() {
    let processor = Processor::CortexM3;
    let [plain, coloured] = [Program::PLAIN, Program::VERTEX_COLOURS].map(|program| Bench::of_program(&[processor], program).unwrap());
    let wanted = LIMITS.map(|(shader, _)| (processor, shader));
    println!(
        "instructions in one colour by the program with colours at corners, and by the one without; with colours: ratio; what is limited, limit"
    );
    for ((name, under_two), lamps) in LOW_POLY.into_iter().zip(UNDER_TWO).flat_map(|model| [(model, 2), (model, 1)]) {
        let [scene, one] = in_colours_and_in_one(&scene::load(name).unwrap(), lamps);
        let count = |bench: &Bench, scene| bench.count(scene, &wanted, &|| ()).unwrap().iter().map(|found| found.instructions).collect();
        let [same, least, with]: [Vec<u64>; 3] = [count(&coloured, &one), count(&plain, &one), count(&coloured, &scene)];
        for (k, (shader, most)) in LIMITS.into_iter().enumerate() {
            let times = |other: usize| with[k] as f64 / same[other].min(least[other]) as f64;
            let (ratio, most) = if shader == Shader::AUTO && lamps == 2 { (times(0), under_two) } else { (times(k), most) };
            let own = times(k);
            let line = format!(
                "{name:10} lights {lamps} {:8} {:9} {:9} {:9}: {own:.3}; {ratio:.3}, {most}",
                shader.name(),
                same[k],
                least[k],
                with[k]
            );
            println!("{line}");
            assert!(ratio < most, "{line}");
        }
    }
}
