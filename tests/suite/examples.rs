//! The firmware in examples/: what its displays show is drawn here by the same code, the documents show its text, and each program is short.
//!
//! `MICROPHONG_BLESS=1 cargo test -p microphong-tests examples` makes pictures and streams the standard.

use crate::golden::{bless, check_pixels, root};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{Layout, Picture, Pose, RenderError, Renderer, Stats, Stream, format::Rotation, pixel};
use microphong_tests::program;
use std::{fmt::Debug, fs, path::PathBuf, process::Command};

#[path = "../../examples/backdrop.rs"]
#[expect(dead_code, reason = "the example's `main`")]
mod backdrop;
#[path = "../../examples/esp32c3-gc9a01/src/scene.rs"]
mod esp32c3_gc9a01;
#[path = "../../examples/nrf52840-gc9a01/src/scene.rs"]
mod nrf52840_gc9a01;
#[path = "../../examples/objects.rs"]
#[expect(dead_code, reason = "the example's `main`")]
mod objects;
#[path = "../../examples/redraw.rs"]
#[expect(dead_code, reason = "the example's `main`")]
mod redraw;
#[path = "../../examples/rp2040-ssd1306/src/scene.rs"]
mod rp2040_ssd1306;
#[path = "../../examples/rp2350-st7789/src/scene.rs"]
mod rp2350_st7789;
#[path = "../../examples/stm32f411-ili9341/src/scene.rs"]
mod stm32f411_ili9341;

const NAMES: [&str; 5] = ["esp32c3-gc9a01", "nrf52840-gc9a01", "rp2040-ssd1306", "rp2350-st7789", "stm32f411-ili9341"];

/// The path of one file of an example.
fn path(example: &str, file: &str) -> PathBuf {
    root().join("../examples").join(example).join(file)
}

/// Compares a picture with that in docs/examples.
macro_rules! shows {
    ($name:literal, $scene:ident, |$renderer:ident, $band:ident| $picture:expr) => {{
        let stream = Stream::parse($scene::MESH).expect("a stream");
        has_room(&$scene::LAYOUT, &stream);
        let mut memory = vec![0; words(&$scene::LAYOUT, $scene::renderer)];
        let mut renderer = $scene::renderer(stream, &mut memory).expect("a renderer");
        let mut display = SimulatorDisplay::new(renderer.size());
        let mut band = vec![pixel::PixelFormat::pack([0; 3]); $scene::LAYOUT.band()];
        let ($renderer, $band) = (&mut renderer, &mut band);
        let Ok(stats) = $picture.expect("a picture").draw(&mut display);
        compare(concat!("examples/", $name), &stats, &display);
    }};
}

/// Number of words that the renderer made by `make` takes.
fn words<'a, C: pixel::Pixel>(layout: &Layout, _make: fn(Stream<'a>, &'a mut [u64]) -> Result<Renderer<'a, C>, RenderError>) -> usize {
    layout.words::<C>()
}

fn has_room(layout: &Layout, stream: &Stream<'_>) {
    let room = |layout: &Layout| [layout.vertices, layout.triangles, layout.materials, layout.objects];
    assert_eq!(room(layout), room(&layout.with_room_for(stream)), "room for all of the scene, and for no more");
}

fn compare<C: PixelColor + Into<embedded_graphics::pixelcolor::Rgb888> + Debug>(name: &str, stats: &Stats, display: &SimulatorDisplay<C>) {
    assert!(stats.drawn > 0, "{name}: nothing is drawn");
    let image = display.to_rgb_output_image(&OutputSettings::default());
    let golden = root().join("../docs").join(name).with_extension("png");
    assert_eq!(check_pixels(&golden, display.size(), image.as_image_buffer().into_raw(), bless()), None);
}

#[test]
fn displays_show_what_the_documentation_shows() {
    shows!("esp32c3-gc9a01", esp32c3_gc9a01, |renderer, band| {
        esp32c3_gc9a01::set(renderer.scene(), 43.0).expect("a needle");
        Picture::of_scene(renderer, band)
    });
    shows!("nrf52840-gc9a01", nrf52840_gc9a01, |renderer, band| {
        nrf52840_gc9a01::set(renderer, &tilt(), TEN_PAST_TEN).expect("hands");
        nrf52840_gc9a01::picture(renderer, band, TEN_PAST_TEN)
    });
    shows!("rp2040-ssd1306", rp2040_ssd1306, |renderer, band| rp2040_ssd1306::picture(renderer, band, 0));
    shows!("rp2350-st7789", rp2350_st7789, |renderer, band| rp2350_st7789::picture(renderer, band, 0, None));
    shows!("stm32f411-ili9341", stm32f411_ili9341, |renderer, band| stm32f411_ili9341::picture(renderer, band, 0));
    for (name, drawn) in [("backdrop", backdrop::draw()), ("objects", objects::draw()), ("redraw", redraw::draw())] {
        let (display, stats) = drawn.expect("a picture");
        compare(name, &stats, &display);
    }
}

const TEN_PAST_TEN: u32 = (10 * 60 + 10) * 60;

/// A rotation as the sensor of the watch reports it: a quaternion w, x, y, z.
fn tilt() -> Pose {
    Pose::from_quaternion([15_488, -4_864, 2_048, 512].map(|c| Rotation::from_bits(c << 16))).expect("a rotation")
}

/// The watch that draws partially shows what one shows that begins at the same time.
#[test]
fn the_watch_sends_only_the_time_each_second() {
    use nrf52840_gc9a01::{LAYOUT, MESH, picture, renderer, set};
    let stream = Stream::parse(MESH).expect("a stream");
    let marker = Rgb565::MAGENTA;
    let watch = |times: &[u32]| {
        let (mut memory, mut band) = (vec![0; LAYOUT.words::<Rgb565>()], vec![Rgb565::BLACK; LAYOUT.band()]);
        let mut renderer = renderer(stream, &mut memory).expect("a renderer");
        let mut shown = SimulatorDisplay::<Rgb565>::new(renderer.size());
        let mut sent = Vec::new();
        for &seconds in times {
            set(&mut renderer, &tilt(), seconds).expect("hands");
            let mut display = SimulatorDisplay::with_default_color(renderer.size(), marker);
            let Ok(_) = picture(&mut renderer, &mut band, seconds).expect("a picture").draw(&mut display);
            let pixels = display.bounding_box().points().map(|at| Pixel(at, display.get_pixel(at))).filter(|pixel| pixel.1 != marker);
            let pixels: Vec<_> = pixels.collect();
            sent.push(pixels.len());
            let Ok(()) = shown.draw_iter(pixels);
        }
        (shown, sent)
    };
    let (time, all) = (80 * 20, 240 * 240);
    let (partial, sent) = watch(&[TEN_PAST_TEN - 2, TEN_PAST_TEN - 1, TEN_PAST_TEN, TEN_PAST_TEN + 1]);
    assert_eq!(sent, [all, time, all, time]);
    assert!(partial == watch(&[TEN_PAST_TEN + 1]).0);
}

/// The commands stand in examples/README.md.
#[test]
fn streams_are_what_their_commands_make() {
    let readme = fs::read_to_string(root().join("../examples/README.md")).expect("a README");
    let commands: Vec<_> = readme.lines().filter_map(|line| line.strip_prefix("cargo run --release -- convert ")).collect();
    assert_eq!(commands.len(), NAMES.len() + 1);
    let place = tempfile::tempdir().expect("scratch directory");
    for command in commands {
        let (arguments, recorded) = command.split_once(" -o ").expect("a file");
        let made = place.path().join("made.tri");
        let mut convert = Command::new(program());
        convert.current_dir(root().join("..")).arg("convert").args(arguments.split(' ')).arg("-o").arg(&made);
        assert!(convert.output().expect("the program").status.success());
        let recorded = root().join("..").join(recorded);
        if bless() {
            fs::copy(&made, &recorded).expect("a stream");
        }
        assert!(fs::read(&made).ok() == fs::read(&recorded).ok(), "{}: not what its command makes", recorded.display());
    }
}

#[test]
fn documents_show_the_programs() {
    let shown = |document: &str, text: &str| {
        let document = fs::read_to_string(root().join("..").join(document)).expect("a document");
        document.contains(&format!("\n```rust\n{text}```\n"))
    };
    for file in ["src/scene.rs", "src/main.rs"] {
        let text = fs::read_to_string(path("stm32f411-ili9341", file)).expect("a source");
        let document = "docs/guide/getting-started.md";
        assert!(shown(document, &text), "{file} of stm32f411-ili9341 has changed: copy it into {document}");
    }
    let text = fs::read_to_string(path("", "objects.rs")).expect("a source");
    let document = "docs/guide/scenes.md";
    let program = text.split_once("\n\n").map(|(_, program)| program).and_then(|program| program.split_once("\nfn main")).expect("it").0;
    assert!(shown(document, program), "examples/objects.rs has changed: copy it into {document}");
    // A reader's program has a mesh of its own beside `src`.
    let text = fs::read_to_string(path("", "display.rs")).expect("a source").replace("../firmware/teapot.tri", "../mesh.tri");
    assert!(shown("README.md", &text), "examples/display.rs has changed: copy it into the README");
}

#[test]
fn programs_are_short() {
    for name in NAMES {
        let files = fs::read_dir(path(name, "src")).expect("sources").map(|file| file.expect("a source").path());
        let lines: usize = files.map(|file| fs::read_to_string(file).expect("a source").lines().count()).sum();
        // The watch also reads a sensor and the time.
        let most = if name == "nrf52840-gc9a01" { 110 } else { 80 };
        assert!(lines <= most, "{name}: {lines} lines");
    }
}
