//! Work that frames leave out because nobody can see the result: the picture is the same with it, and counts tell its amount.

use embedded_graphics::{pixelcolor::Rgb565, prelude::Size};
use microphong::{Counts, Layout, Renderer, Skips, Stats, Stream, format::ErrorBudget, renderer::check};
use microphong_sim::{
    bytes::StreamBytes,
    render::{self, Style},
    scene,
    shader::Shader,
};

const SIZE: Size = Size::new(200, 150);

/// Frame 5 of a stream, in bands, or in one.
fn frame(stream: &StreamBytes, shader: Shader, skips: Skips, rows: u32) -> (Vec<Rgb565>, Stats) {
    // Dithered as a renderer begins, so that a triangle that is drawn another way is seen.
    render::frame(stream.parse().unwrap(), SIZE, Style { skips, dither: true, ..Style::from(shader) }, rows, 5).unwrap()
}

/// The picture is the same with each kind of work and with all of them, in every scene, by every method.
#[test]
fn pictures_are_the_same() {
    for scene in scene::NAMES.into_iter().chain(scene::VARIANTS).map(|name| scene::load(name).unwrap()) {
        let facts = scene.stream.parse().unwrap();
        for shader in Shader::ALL.into_iter().filter(|shader| check(&facts, shader.facts(), false).is_ok()) {
            let (plain, _) = frame(&scene.stream, shader, Skips::ALL, SIZE.height);
            for (name, skips) in Skips::ALL_BUT.into_iter().chain([("everything", Skips::NONE)]) {
                let (picture, stats) = frame(&scene.stream, shader, skips, SIZE.height);
                let differing = picture.iter().zip(&plain).filter(|(a, b)| a != b).count();
                assert_eq!(differing, 0, "{} by {} with {name}, {stats:?}", scene.name, shader.name());
            }
        }
    }
}

/// Counts are not 0 where something is left out, 0 where it is not, and the same whatever the bands.
#[test]
fn counts_tell_what_is_left_out() {
    let counts = |name: &str, shader, skips, rows| frame(&scene::load(name).unwrap().stream, shader, skips, rows).1.counts;
    for (name, shader, but, count) in [
        (scene::CONVEX, Shader::PHONG, "depth", (|counts| counts.without_depth) as fn(Counts) -> u32),
        ("peer-sphere", Shader::PHONG, "highlights", |counts| counts.without_highlight),
        ("torus", Shader::PHONG, "lights", |counts| counts.without_light),
        ("bunny", Shader::PHONG, "highlights", |counts| counts.without_highlight),
        ("bunny", Shader::PHONG, "lights", |counts| counts.without_light),
    ] {
        let (_, others) = Skips::ALL_BUT.into_iter().find(|(skip, _)| *skip == but).unwrap();
        let [plain, with] = [Skips::ALL, others].map(|skips| count(counts(name, shader, skips, SIZE.height)));
        println!("{name} by {}, {but}: {plain} left out", shader.name());
        assert!(plain > 0 && with == 0, "{name}, {but}: {plain}, {with}");
        for rows in [1, 7, 40] {
            assert_eq!(count(counts(name, shader, Skips::ALL, rows)), plain, "{name}, {but}, bands of {rows}");
        }
    }
    let (_, stats) = frame(&scene::load("torus").unwrap().stream, Shader::AUTO, Skips::ALL, 7);
    println!("torus by auto: {:?} of {}", stats.counts.choices, stats.drawn);
    let shaded: u32 = stats.counts.choices.iter().sum();
    // Slivers between the centres of pixels are not shaded.
    assert!(stats.counts.choices.iter().filter(|&&count| count > 0).count() > 2 && stats.drawn - shaded < stats.drawn / 20);
}

/// Objects behind others are left out of bands; the picture is the same whatever the bands, and with all objects drawn.
#[test]
fn hidden_objects_are_left_out() {
    let board = scene::load("board").unwrap();
    let (_, others) = Skips::ALL_BUT.into_iter().find(|(skip, _)| *skip == "hidden-objects").unwrap();
    for shader in [Shader::GOURAUD, Shader::AUTO] {
        let (whole, _) = frame(&board.stream, shader, others, SIZE.height);
        for rows in [4, 10, 30] {
            let [(picture, stats), (plain, none)] = [Skips::ALL, others].map(|skips| frame(&board.stream, shader, skips, rows));
            println!(
                "{}, bands of {rows} rows: {} triangles, {} of {} pixels left out",
                shader.name(),
                stats.counts.hidden,
                none.pixels - stats.pixels,
                none.pixels
            );
            assert!(picture == whole && plain == whole, "{}, bands of {rows}", shader.name());
            assert!(stats.counts.hidden > 100 && none.counts.hidden == 0);
            assert!(stats.pixels < none.pixels / 10 * 9, "{} of {}", stats.pixels, none.pixels);
        }
    }
}

/// The renderer knows when a frame is the picture of the latest one: the camera stands still, or has come round. Settings change pictures.
#[test]
fn a_frame_like_the_latest_is_known() {
    let scene = scene::load("sphere-168").unwrap();
    let smooth = scene.stream.with_neighbours().unwrap();
    let bytes = smooth.parse().unwrap();
    let (mut standing, period) = (*bytes.header, u32::from(bytes.header.camera.period));
    standing.camera.period = 0;
    let standing = Stream { header: &standing, ..bytes };
    let layout = Layout::new(64, 48).vertices(256).triangles(256).antialias(true);
    for (stream, same, other) in [(bytes, [5 + period, 5 + 7 * period], Some(6)), (standing, [5, 6], None)] {
        let mut memory = vec![0; layout.words::<Rgb565>()];
        let mut renderer = Renderer::with_shader(stream, Size::new(64, 48), &layout, &mut memory, Shader::AUTO.on()).unwrap();
        let draw = |renderer: &mut Renderer<'_, Rgb565>, number| {
            let mut pixels = vec![Rgb565::default(); layout.band()];
            renderer.frame(number).next_band(&mut pixels).unwrap();
            pixels
        };
        assert!(!renderer.is_latest(5), "nothing has been drawn");
        let picture = draw(&mut renderer, 5);
        assert!(renderer.is_latest(5) && other.is_none_or(|other| !renderer.is_latest(other)));
        for number in same {
            assert!(renderer.is_latest(number), "{number}");
            assert!(draw(&mut renderer, number) == picture, "{number}");
        }
        let settings: [fn(&mut Renderer<'_, Rgb565>); 5] = [
            |renderer| renderer.set_shader(Shader::FLAT.on()).unwrap(),
            |renderer| renderer.set_dither(false),
            |renderer| renderer.set_antialias(true).unwrap(),
            |renderer| renderer.set_perspective_correct(true).unwrap(),
            |renderer| renderer.set_budget(ErrorBudget::from_num(3)).unwrap(),
        ];
        for set in settings {
            set(&mut renderer);
            assert!(!renderer.is_latest(5));
            draw(&mut renderer, 5);
            assert!(renderer.is_latest(5));
        }
        let _ = renderer.prepare(6, 0);
        assert!(renderer.is_latest(6));
    }
}
