//! The lists that the page offers: it has none of its own.

use crate::{
    measure::SCALE,
    panel::{PANELS, Panel},
    pixels::FORMATS,
};
use microphong_models::{scene, view::Up};
use microphong_render::{choices::Way, render::Format, shader::Shader};
use serde::Serialize;

/// Everything that can be chosen.
#[derive(Serialize)]
pub(crate) struct Catalogue {
    scenes: Vec<Named>,
    methods: Vec<Named>,
    formats: Vec<FormatEntry>,
    panels: [Panel; PANELS.len()],
    ups: [&'static str; Up::ALL.len()],
    ways: [WayEntry; Way::ALL.len()],
    /// Colours of the error map.
    errors: [(f64, [u8; 3]); SCALE.len()],
    /// Error budgets, in 1/255.
    budgets: [f64; 6],
}

/// A name on the command line, and what it is.
#[derive(Serialize)]
struct Named {
    name: &'static str,
    title: &'static str,
    /// Whether it takes an error budget.
    has_budget: bool,
}

/// A pixel format.
#[derive(Serialize)]
struct FormatEntry {
    name: &'static str,
    title: &'static str,
    /// Whether dither changes its pictures.
    is_dithered: bool,
}

/// A way of shading that `auto` chooses, with its colour in pictures.
#[derive(Serialize)]
struct WayEntry {
    name: &'static str,
    colour: [u8; 3],
}

impl Catalogue {
    pub(crate) fn new() -> Self {
        let format = |format: Format| FormatEntry { name: format.name(), title: format_title(format), is_dithered: format.is_dithered() };
        let method = |shader: Shader| Named { name: shader.name(), title: method_title(shader), has_budget: shader.keeps_budget() };
        Self {
            scenes: scene::all().map(|name| Named { name, title: scene::description(name), has_budget: false }).collect(),
            methods: Shader::CORE.map(method).into(),
            formats: FORMATS.map(format).into(),
            panels: PANELS,
            ups: Up::ALL.map(Up::name),
            ways: Way::ALL.map(|way| WayEntry { name: way.name(), colour: way.colour() }),
            errors: SCALE,
            budgets: [0.5, 1.0, 2.0, 4.0, 8.0, 16.0],
        }
    }
}

/// What a method does, in a few words.
fn method_title(shader: Shader) -> &'static str {
    match shader.name() {
        "flat" => "flat: one colour for each triangle",
        "gouraud" => "gouraud: light at corners",
        "six-point" => "six-point: light at six points",
        "sqrt6" => "sqrt6: sharper highlights",
        "phong" => "phong: light at each pixel",
        "auto" => "auto: the cheapest way within a budget",
        "auto-linear" => "auto-linear: auto in less flash",
        name => name,
    }
}

/// What a pixel format stores, in a few words.
const fn format_title(format: Format) -> &'static str {
    match format {
        Format::Rgb565 => "RGB565: 65,536 colours",
        Format::Rgb888 => "RGB888: all colours",
        Format::Gray8 => "Gray8: 256 greys",
        Format::Gray4 => "Gray4: 16 greys",
        Format::Gray2 => "Gray2: four greys",
        Format::Binary => "one bit: black and white",
        Format::Bgr565 => "BGR565: 65,536 colours, blue first",
        Format::Rgb666 => "RGB666: 262,144 colours",
        Format::Rgb332 => "RGB332: 256 colours",
        Format::LightRgb565 => "RGB565, drawn as light",
    }
}
