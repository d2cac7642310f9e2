//! The Rust program that draws a scene: the example of the README, with another layout, size, method and pixel format.

use anyhow::{Result, bail};
use microphong::{Layout, Stream, features::Feature};
use microphong_render::{
    program::layout_text,
    render::{self, Format, Settings},
    shader::Shader,
};

/// The program of the README.
const EXAMPLE: &str = include_str!("../../../examples/display.rs");

/// The layout that a program needs for this picture.
pub(crate) fn layout(stream: &Stream<'_>, settings: &Settings) -> Result<Layout> {
    render::program_layout(stream, settings.style.shader, settings.size, settings.band_rows)
}

/// The program that draws frame `number` of a stream of this name, which lies in the folder of the package.
pub(crate) fn text(stream: &Stream<'_>, settings: &Settings, number: u32, name: &str) -> Result<String> {
    let Settings { size, style, band_rows, format } = *settings;
    let (drawn, shown) = types(format)?;
    let layout = layout_text(&layout(stream, settings)?);
    let mut program = Program(EXAMPLE.to_owned());
    program.replace("../firmware/teapot.tri", &format!("../{name}"))?;
    program.replace("Layout::new(240, 40)", &layout)?;
    program.replace("240 pixels wide and drawn 40 rows", &format!("{} pixels wide and drawn {band_rows} rows", size.width))?;
    program.replace("Size::new(240, 240)", &format!("Size::new({}, {})", size.width, size.height))?;
    program.replace("Shader::AUTO", constant(style.shader))?;
    program.replace("&mut band, 0)", &format!("&mut band, {number})"))?;
    program.replace("[Rgb565::BLACK;", &format!("[<{drawn}>::default();"))?;
    program.replace("words::<Rgb565>", &format!("words::<{drawn}>"))?;
    program.replace("SimulatorDisplay::<Rgb565>", &format!("SimulatorDisplay::<{shown}>"))?;
    program.replace("pixelcolor::Rgb565", &format!("pixelcolor::{shown}"))?;
    if drawn != shown {
        program.replace(".draw(&mut display)", &format!(".shown_as::<{shown}>().draw(&mut display)"))?;
        let family = drawn.split('<').next().unwrap_or_default();
        program.replace("include_stream};", &format!("include_stream, pixel::{family}}};"))?;
    }
    let mut calls = String::new();
    if format.is_dithered() && !style.dither {
        calls += "    renderer.set_dither(false);\n";
    }
    if style.srgb {
        calls += "    renderer.set_gamma(Some(&microphong::pixel::gamma::SRGB));\n";
    }
    if style.antialias {
        calls += "    renderer.set_antialias(true)?;\n";
    }
    program.replace("    let stats = Picture", &format!("{calls}    let stats = Picture"))?;
    let features = features(stream, settings);
    let options = if features.is_empty() { String::new() } else { format!(" --features {}", features.join(",")) };
    let head = format!(
        "//! To run it, make a package, and put {name} into its folder:\n//!\n//!     cargo add microphong --path ../microphong/shared{options}\n\
         //!     cargo add embedded-graphics@0.8.2\n//!     cargo add embedded-graphics-simulator@0.8 --no-default-features\nuse embedded_graphics::"
    );
    program.replace("use embedded_graphics::", &format!("//!\n{head}"))?;
    Ok(program.0)
}

/// The cargo features that a program needs for this picture, by their names.
pub(crate) fn features(stream: &Stream<'_>, settings: &Settings) -> Vec<&'static str> {
    let channels = settings.format.channels();
    let is_smooth = |feature: Feature| feature == Feature::Antialias && settings.style.antialias;
    Feature::ALL.into_iter().filter(|feature| feature.is_needed_by(stream, &channels) || is_smooth(*feature)).map(Feature::name).collect()
}

/// A program that is being written.
struct Program(String);

impl Program {
    /// Replaces what the example has.
    fn replace(&mut self, what: &str, by: &str) -> Result<()> {
        if !self.0.contains(what) {
            bail!("the example program has no {what:?}");
        }
        self.0 = self.0.replace(what, by);
        Ok(())
    }
}

/// The types that a program draws, and shows, in a pixel format.
fn types(format: Format) -> Result<(&'static str, &'static str)> {
    Ok(match format {
        Format::Rgb565 => ("Rgb565", "Rgb565"),
        Format::Rgb888 => ("Rgb888", "Rgb888"),
        Format::Gray8 => ("Gray8", "Gray8"),
        Format::Gray4 => ("LightGray<4>", "Gray4"),
        Format::Gray2 => ("LightGray<2>", "Gray2"),
        Format::Binary => ("LightGray<1>", "BinaryColor"),
        Format::Bgr565 => ("Bgr565", "Bgr565"),
        Format::Rgb666 => ("Rgb666", "Rgb666"),
        Format::LightRgb565 => ("Light<5, 6, 5>", "Rgb565"),
        Format::Rgb332 => bail!("the program draws on a simulated display, which has no RGB332; choose another pixel format for it"),
    })
}

/// The constant of a method of the core.
fn constant(shader: Shader) -> &'static str {
    match shader.name() {
        "flat" => "Shader::FLAT",
        "gouraud" => "Shader::GOURAUD",
        "six-point" => "Shader::SIX_POINT",
        "phong" => "Shader::PHONG",
        "sqrt6" => "Shader::SQRT6",
        "auto-linear" => "Shader::AUTO_LINEAR",
        _ => "Shader::AUTO",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics_core::geometry::Size;
    use microphong_models::scene;

    /// Every format but one has a program, and all that the example says is replaced.
    #[test]
    fn the_program_is_that_of_the_readme_for_this_picture() {
        let scene = scene::load("torus").unwrap();
        let smooth = scene.smooth().unwrap().unwrap();
        for format in Format::ALL.into_iter().filter(|format| *format != Format::Rgb332) {
            for shader in Shader::CORE {
                let mut settings = Settings::usual(shader, Size::new(128, 64), format);
                settings.style.antialias = true;
                let text = text(&smooth.view().unwrap(), &settings, 7, "torus.tri").unwrap();
                assert!(text.contains(constant(shader)) && text.contains("Layout::new(128, 16).vertices("), "{text}");
                assert!(text.contains("set_antialias(true)") && text.contains("&mut band, 7)") && !text.contains("240"), "{text}");
                assert!(text.contains("microphong --path ../microphong/shared --features antialias"), "{text}");
            }
        }
    }
}
