//! The firmware in examples/: what its displays show is drawn here by the same code and on emulated processors, two programs run as a whole, the
//! documents show their text, and each program is short.
//!
//! `MICROPHONG_BLESS=1 cargo test -p microphong-tests examples` makes pictures and streams the standard.

use crate::golden::{bless, check_pixels, root};
use embedded_graphics::{
    pixelcolor::{IntoStorage, Rgb565},
    prelude::*,
    primitives::Rectangle,
};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use microphong::{Layout, RenderError, Renderer, Stats, Stream, pixel};
use microphong_sim::board::{
    self, Board, Until, build,
    elf::Elf,
    example::{self, Example},
};
use microphong_tests::program;
use scenes::{TEN_PAST_TEN, esp32c3_gc9a01, nrf52840_gc9a01, rp2350_st7789, stm32f411_ili9341, tilt};
use std::{fmt::Debug, fs, path::PathBuf, process::Command};

#[path = "../../examples/backdrop.rs"]
#[expect(dead_code, reason = "the example's `main`")]
mod backdrop;
#[path = "../../examples/objects.rs"]
#[expect(dead_code, reason = "the example's `main`")]
mod objects;
#[path = "../../examples/redraw.rs"]
#[expect(dead_code, reason = "the example's `main`")]
mod redraw;
#[path = "../../examples/rp2040-ssd1306/src/scene.rs"]
mod rp2040_ssd1306;
// The firmware's own file: its programs draw the same.
#[macro_use]
#[path = "../../firmware/src/scenes.rs"]
mod scenes;

const NAMES: [&str; 5] = ["esp32c3-gc9a01", "nrf52840-gc9a01", "rp2040-ssd1306", "rp2350-st7789", "stm32f411-ili9341"];

/// The path of one file of an example.
fn path(example: &str, file: &str) -> PathBuf {
    root().join("../examples").join(example).join(file)
}

/// Draws a picture of a scene.
macro_rules! drawn {
    ($scene:ident, |$renderer:ident, $band:ident| $picture:expr) => {{
        let stream = Stream::parse($scene::MESH).expect("a stream");
        has_room(&$scene::LAYOUT, &stream);
        let mut memory = vec![0; words(&$scene::LAYOUT, $scene::renderer)];
        let mut renderer = $scene::renderer(stream, &mut memory).expect("a renderer");
        let mut band = vec![pixel::PixelFormat::pack([0; 3]); $scene::LAYOUT.band()];
        let ($renderer, $band) = (&mut renderer, &mut band);
        let mut display = SimulatorDisplay::new($renderer.size());
        let Ok(stats) = $picture.expect("a picture").draw(&mut display);
        (display, stats)
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
    macro_rules! shows {
        ($name:literal, $scene:ident, $($picture:tt)*) => {
            let (display, stats) = drawn!($scene, $($picture)*);
            compare(concat!("examples/", $name), &stats, &display);
        };
    }
    each_scene!(shows);
    shows!("rp2040-ssd1306", rp2040_ssd1306, |renderer, band| rp2040_ssd1306::picture(renderer, band, 0));
    for (name, drawn) in [("backdrop", backdrop::draw()), ("objects", objects::draw()), ("redraw", redraw::draw())] {
        let (display, stats) = drawn.expect("a picture");
        compare(name, &stats, &display);
    }
}

/// Processors of the classes that the examples are for: RISC-V as an ESP32-C3, Cortex-M4F as nRF52840 and STM32F411, Cortex-M33 as an RP2350.
const PROCESSORS: [Board; 3] = [Board::RiscvVirt, Board::Mps2An386, Board::Mps2An505];

/// All scenes in colours on each processor, pixel by pixel. The RP2040 draws its scene in its whole program, below.
#[test]
fn emulated_processors_draw_the_scenes() {
    let mut expected = Vec::new();
    macro_rules! draws {
        ($name:literal, $scene:ident, $($picture:tt)*) => {
            let (display, stats) = drawn!($scene, $($picture)*);
            expected.push((format!("frame {} triangles {}", $name, stats.drawn), in_the_corner(&display)));
        };
    }
    each_scene!(draws);
    for board in PROCESSORS {
        let elf = Elf::read(&build::program(board, "scenes").expect("a program")).expect("a program");
        let recording = board::run(board, &elf, Until::LastFrame(expected.len())).expect("pictures");
        assert_eq!(recording.pictures.len(), expected.len(), "{board}");
        for ((line, pixels), (logged, shown)) in expected.iter().zip(recording.log.iter().zip(&recording.pictures)) {
            assert_eq!(logged, line, "{board}");
            assert_eq!(differing(pixels, shown), 0, "{board}: {line}");
        }
    }
}

/// Pixels of a board's display that shows a picture in its corner, on black.
fn in_the_corner(picture: &SimulatorDisplay<Rgb565>) -> Vec<u32> {
    let (width, height) = Board::Mps2An386.size();
    let pixel = |at| if picture.bounding_box().contains(at) { picture.get_pixel(at) } else { Rgb565::BLACK };
    Rectangle::new(Point::zero(), Size::new(width, height)).points().map(|at| pixel(at).into_storage().into()).collect()
}

/// The number of pixels in which two pictures differ.
fn differing(one: &[u32], other: &[u32]) -> usize {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).filter(|(a, b)| a != b).count()
}

/// Frames of a program that runs as a whole: the first, and one that follows another.
const FRAMES: u32 = 2;

/// Runs the program of an example on its emulated board. Returns its log, and the pictures that its display has shown.
fn whole(example: Example) -> (Vec<String>, Vec<Vec<u32>>) {
    let elf = Elf::read(&build::example(example).expect("a program")).expect("a program");
    let recording = example::run(example, &elf, FRAMES as usize).expect("pictures");
    (recording.log, recording.pictures)
}

/// Everything between start-up code and the light of the OLED: driver, I2C and the display's commands.
#[test]
fn the_rp2040_runs_its_whole_program() {
    let (log, pictures) = whole(Example::Rp2040Ssd1306);
    for (number, shown) in (0..FRAMES).zip(pictures) {
        let (display, stats) = drawn!(rp2040_ssd1306, |renderer, band| rp2040_ssd1306::picture(renderer, band, number));
        let pixels: Vec<u32> = display.bounding_box().points().map(|at| display.get_pixel(at).is_on().into()).collect();
        assert_eq!(log[number as usize], format!("frame {number}: {} triangles", stats.drawn));
        assert_eq!(differing(&pixels, &shown), 0, "frame {number}");
    }
}

/// Everything between start-up code and the panel's memory: driver, SPI and the panel's commands. The picture shows how many frames a second the emulated
/// board draws, which is in the log as well.
#[test]
fn the_rp2350_runs_its_whole_program() {
    let (log, pictures) = whole(Example::Rp2350St7789);
    let mut rate = None;
    for (number, shown) in (0..FRAMES).zip(pictures) {
        let (display, stats) = drawn!(rp2350_st7789, |renderer, band| rp2350_st7789::picture(renderer, band, number, rate));
        let pixels: Vec<u32> = display.bounding_box().points().map(|at| display.get_pixel(at).into_storage().into()).collect();
        let told = log[number as usize].strip_prefix(&format!("frame {number}: {} triangles, Some(", stats.drawn));
        rate = told.and_then(|told| told.split(')').next()?.parse::<u64>().ok());
        assert!(rate.is_some_and(|rate| (1..100).contains(&rate)), "{}", log[number as usize]);
        assert_eq!(differing(&pixels, &shown), 0, "frame {number}");
    }
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
