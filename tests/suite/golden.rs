//! Every built-in scene with the basic shading methods, and one scene with all of them, compared with pictures that somebody has looked at.
//!
//! `MICROPHONG_BLESS=1 cargo test -p microphong-tests golden` records the current pictures. If a picture differs, target/golden holds it and a
//! picture of the differences.

use embedded_graphics::{geometry::Size, pixelcolor::Rgb565};
use microphong::pixel::{Pixel, Rgb565Be};
use microphong_sim::{
    convert::{Converted, Options},
    image,
    mesh::Weld,
    render::{self, Format, Settings, Style},
    scene::{self, Scene},
    shader::Shader,
    verify,
};
use microphong_tests::BASIC;
use std::{
    fs::{self, File},
    io::BufReader,
    path::{Path, PathBuf},
};

/// The scene that every method draws: coarse enough to tell them apart.
const ONE: &str = "sphere-168";

pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Width, height and RGB bytes; `None` without a file.
pub(crate) fn read(path: &Path) -> Option<(u32, u32, Vec<u8>)> {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().expect("golden picture");
    let mut bytes = vec![0; reader.output_buffer_size().expect("golden picture")];
    let info = reader.next_frame(&mut bytes).expect("golden picture");
    Some((info.width, info.height, bytes))
}

/// Grey where equal, the brighter the larger the difference.
fn difference(a: &[u8], b: &[u8]) -> Vec<u8> {
    a.iter().zip(b).map(|(a, b)| if a == b { a / 8 } else { a.abs_diff(*b).saturating_mul(8).saturating_add(96) }).collect()
}

/// The difference of the picture of `name` by `shader` from the recorded one, if there is any.
fn check(name: &str, shader: Shader, bless: bool) -> Option<String> {
    let scene = scene::load(name).expect("built-in scene");
    let settings = Settings { size: scene.size.into(), style: shader.into(), band_rows: 16, format: Format::Rgb565 };
    check_picture(&format!("{name}-{}", shader.name()), &scene, &settings, bless)
}

/// The difference of the picture of a scene from the recorded one of this name, if there is any.
fn check_picture(name: &str, scene: &Scene, settings: &Settings, bless: bool) -> Option<String> {
    let drawn = render::picture(scene.stream.parse().expect("built-in scene"), settings, 0).expect("built-in scene").rgb;
    check_pixels(&root().join("golden").join(name).with_extension("png"), settings.size, &drawn, bless)
}

/// The difference of the RGB bytes `drawn` from the recorded picture `golden`, if there is any.
pub(crate) fn check_pixels(golden: &Path, Size { width, height }: Size, drawn: &[u8], bless: bool) -> Option<String> {
    let name = golden.file_stem().expect("a name").to_string_lossy();
    let file = format!("{name}.png");
    if bless {
        fs::create_dir_all(golden.parent().expect("a directory")).expect("golden directory");
        image::write_png(golden, width, height, drawn).expect("golden picture");
        return None;
    }
    let Some(expected) = read(golden) else {
        return Some(format!("{file}: no such golden picture; look at the drawing, then run with MICROPHONG_BLESS=1"));
    };
    if (expected.0, expected.1) == (width, height) && expected.2 == drawn {
        return None;
    }
    let out: PathBuf = root().join("../target/golden");
    fs::create_dir_all(&out).expect("target directory");
    image::write_png(&out.join(&file), width, height, drawn).expect("drawn picture");
    if expected.2.len() != drawn.len() {
        return Some(format!("{file}: {width}x{height}, golden {}x{}", expected.0, expected.1));
    }
    let path = out.join(format!("{name}-difference.png"));
    image::write_png(&path, width, height, &difference(drawn, &expected.2)).expect("difference picture");
    let (drawn, expected) = (drawn.as_chunks::<3>().0, expected.2.as_chunks::<3>().0);
    let count = drawn.iter().zip(expected).filter(|(a, b)| a != b).count();
    Some(format!("{file}: {count} of {} pixels differ, see {}", drawn.len(), path.display()))
}

/// The stream that firmware is built with: the teapot as `convert --crease 180` makes it.
#[test]
fn firmware_has_the_teapot() {
    let options = Options { weld: Weld::SMOOTH, ..Options::default() };
    let converted = Converted::read(&root().join("meshes/teapot.obj"), &options, &()).expect("a mesh");
    let stream = converted.stream().expect("a stream");
    let frames = stream.parse().expect("a stream").header.frames;
    let path = root().join("../firmware/teapot.tri");
    let stream = verify::prepare(stream.as_bytes(), Shader::AUTO, frames).expect("a stream");
    if bless() {
        fs::write(&path, &stream).expect("a stream for firmware");
    }
    assert!(fs::read(&path).ok() == Some(stream), "teapot.tri: not what MICROPHONG_BLESS=1 would make it");
}

/// Whether current pictures are recorded instead of compared.
pub(crate) fn bless() -> bool {
    std::env::var_os("MICROPHONG_BLESS").is_some_and(|v| v == "1")
}

#[test]
fn golden() {
    let bless = bless();
    let pairs = scene::NAMES.iter().flat_map(|&name| Shader::ALL.map(|shader| (name, shader)));
    let pairs = pairs.filter(|(name, shader)| *name == ONE || BASIC.contains(shader));
    let wrong: Vec<_> = pairs.filter_map(|(name, shader)| check(name, shader, bless)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Scripted scenes, while all of their objects move.
#[test]
fn scripted() {
    let bless = bless();
    let wrong = |name: &str| {
        let scene = scene::load(name).expect("built-in scene");
        let stream = scene.stream.parse().expect("built-in scene");
        let of = |shader: Shader| {
            let settings = Settings { size: scene.size.into(), style: shader.into(), band_rows: 16, format: Format::Rgb565 };
            let drawn = render::picture(stream, &settings, 20).expect("built-in scene").rgb;
            check_pixels(&root().join("golden").join(format!("{name}-{}.png", shader.name())), settings.size, &drawn, bless)
        };
        [Shader::FLAT, Shader::GOURAUD, Shader::PHONG, Shader::AUTO].into_iter().filter_map(of).collect::<Vec<_>>()
    };
    let wrong = scene::SCRIPTED.map(wrong).concat();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every pixel format with its default dither, on a display of 128x64.
#[test]
fn formats() {
    let bless = bless();
    let wrong = |name: &str| {
        let scene = scene::load(name).expect("built-in scene");
        let of = |format: Format| {
            let style = Style { dither: format.is_dithered(), ..Shader::PHONG.into() };
            let settings = Settings { size: Size::new(128, 64), style, band_rows: 16, format };
            check_picture(&format!("{name}-{}", format.name()), &scene, &settings, bless)
        };
        Format::ALL.into_iter().filter_map(of).collect::<Vec<_>>()
    };
    let wrong = ["torus", "sphere-168"].map(wrong).concat();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Colours for a display with the curve of sRGB, in one channel and in three.
#[test]
fn curve_of_the_display() {
    let bless = bless();
    let wrong = |name: &str| {
        let scene = scene::load(name).expect("built-in scene");
        let style = Style { srgb: true, ..Shader::AUTO.into() };
        let settings = Settings { size: scene.size.into(), style, band_rows: 16, format: Format::Rgb565 };
        check_picture(&format!("{name}-srgb"), &scene, &settings, bless)
    };
    let wrong: Vec<_> = ["teapot", "bunny"].into_iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The order of bytes of RGB565 in memory changes no picture.
#[test]
fn byte_orders() {
    let scene = scene::load("torus").expect("built-in scene");
    let (stream, size) = (scene.stream.parse().expect("built-in scene"), Size::new(128, 64));
    let (low_first, _) = render::frame::<Rgb565>(stream, size, Shader::PHONG, 16, 0).expect("built-in scene");
    let (high_first, _) = render::frame::<Rgb565Be>(stream, size, Shader::PHONG, 16, 0).expect("built-in scene");
    assert_eq!(image::rgb_bytes(&low_first), image::rgb_bytes(&high_first));
    for (low_first, high_first) in low_first.into_iter().zip(high_first) {
        assert_eq!(low_first.stored().to_be_bytes(), <[u8; 2]>::try_from(zerocopy::IntoBytes::as_bytes(&high_first)).expect("two bytes"));
    }
}
