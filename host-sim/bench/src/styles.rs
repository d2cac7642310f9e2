//! What styles cost, and what is spared by leaving out what nobody can see: instructions of whole frames on x86-64, by the program that
//! `stress` counts with, which draws in every style.

use crate::{Processor, callgrind::Counters};
use anyhow::{Context, Result};
use embedded_graphics_core::geometry::Size;
use microphong::{Skips, pixel::Rgb565Be};
use microphong_render::{
    render::{self, Format, Style},
    scene::Scene,
    shader::Shader,
};
use microphong_stress::{case::Case, cost::Count};
use rayon::prelude::*;
use serde::Serialize;

/// A way of drawing, by name.
pub type Named = (&'static str, fn(Style) -> Style);

/// The plain style, dither, antialiasing and interpolation in perspective.
pub const STYLES: &[Named] = &[
    ("plain", |plain| plain),
    ("dither", |plain| Style { dither: true, ..plain }),
    ("antialias", |plain| Style { antialias: true, ..plain }),
    ("perspective-correct", |plain| Style { perspective_correct: true, ..plain }),
];

/// The plain style, and that with each thing that nobody can see, in the order of [`Skips::ALL_BUT`].
pub const SKIPS: &[Named] = &[
    ("plain", |plain| plain),
    ("with back-faces", |plain| with(0, plain)),
    ("with between-centres", |plain| with(1, plain)),
    ("with depth", |plain| with(2, plain)),
    ("with highlights", |plain| with(3, plain)),
    ("with lights", |plain| with(4, plain)),
];

fn with(number: usize, plain: Style) -> Style {
    Style { skips: Skips::ALL_BUT[number].1, ..plain }
}

/// A scene by one method in several styles.
#[derive(Clone, Debug, Serialize)]
pub struct StyleCosts {
    /// Name of the scene.
    pub scene: String,
    /// Name of the method.
    pub shader: &'static str,
    /// Pixels of all drawn triangles, in the plain style.
    pub pixels: u32,
    /// Names of the styles, the plain one first.
    pub styles: Vec<&'static str>,
    /// Instructions of the frame, clearing included, in each of them; `None` where the method cannot draw it.
    pub instructions: Vec<Option<u64>>,
}

/// Counts frame 0 of `scene` by `shaders` in `styles`; `tick` is called for each of them.
///
/// # Errors
/// When this is no x86-64 computer, valgrind is missing, or the scene cannot be drawn.
pub fn measure(
    counters: &Counters,
    scene: &Scene,
    shaders: &[Shader],
    styles: &[Named],
    tick: &(dyn Fn() + Sync),
) -> Result<Vec<StyleCosts>> {
    let (width, height) = Processor::X86_64.size();
    let stream = scene.stream.parse().with_context(|| scene.name.clone())?;
    let names: Vec<_> = styles.iter().map(|(name, _)| *name).collect();
    let costs = shaders.par_iter().map(|&shader| {
        let plain = Style::from(shader);
        let (_, stats) = render::frame::<Rgb565Be>(stream, Size::new(width, height), plain, height, 0)?;
        let count = |(_, style): &Named| {
            let (stream, size, style) = (scene.stream.clone(), [width, height], style(plain));
            counters.count(&Case { stream, size, frame: 0, style, format: Format::Rgb565, band_rows: height })
        };
        let instructions = styles.iter().map(count).collect::<Result<_>>()?;
        tick();
        Ok(StyleCosts { scene: scene.name.clone(), shader: shader.name(), pixels: stats.pixels, styles: names.clone(), instructions })
    });
    costs.collect()
}
