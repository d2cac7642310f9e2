//! What dither, antialiasing and interpolation in perspective cost: instructions of whole frames on x86-64, by the program that `stress`
//! counts with, which draws in every style.

use crate::{Processor, callgrind::Counters};
use anyhow::{Context, Result};
use embedded_graphics_core::geometry::Size;
use microphong::pixel::Rgb565Be;
use microphong_render::{
    render::{self, Format, Style},
    scene::Scene,
    shader::Shader,
};
use microphong_stress::{case::Case, cost::Count};
use rayon::prelude::*;
use serde::Serialize;

/// Names of the styles, the plain one first.
pub const NAMES: [&str; 4] = ["plain", "dither", "antialias", "perspective-correct"];

/// A scene by one method in all styles.
#[derive(Clone, Debug, Serialize)]
pub struct StyleCosts {
    /// Name of the scene.
    pub scene: String,
    /// Name of the method.
    pub shader: &'static str,
    /// Pixels of all drawn triangles, in the plain style.
    pub pixels: u32,
    /// Instructions of the frame, clearing included, in the order of [`NAMES`]; `None` where the method cannot draw the style.
    pub instructions: [Option<u64>; 4],
}

/// Counts frame 0 of `scene` by `shaders`; `tick` is called for each of them.
///
/// # Errors
/// When this is no x86-64 computer, valgrind is missing, or the scene cannot be drawn.
pub fn measure(counters: &Counters, scene: &Scene, shaders: &[Shader], tick: &(dyn Fn() + Sync)) -> Result<Vec<StyleCosts>> {
    let (width, height) = Processor::X86_64.size();
    let stream = scene.stream.parse().with_context(|| scene.name.clone())?;
    let costs = shaders.par_iter().map(|&shader| {
        let plain = Style::from(shader);
        let styles =
            [plain, Style { dither: true, ..plain }, Style { antialias: true, ..plain }, Style { perspective_correct: true, ..plain }];
        let (_, stats) = render::frame::<Rgb565Be>(stream, Size::new(width, height), plain, height, 0)?;
        let mut instructions = [None; 4];
        for (count, style) in instructions.iter_mut().zip(styles) {
            let case =
                Case { stream: scene.stream.clone(), size: [width, height], frame: 0, style, format: Format::Rgb565, band_rows: height };
            *count = counters.count(&case)?;
        }
        tick();
        Ok(StyleCosts { scene: scene.name.clone(), shader: shader.name(), pixels: stats.pixels, instructions })
    });
    costs.collect()
}
