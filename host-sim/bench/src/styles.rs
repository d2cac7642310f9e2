//! Costs of styles, and savings by leaving out work that nobody can see or that has not changed. They are instructions of frames on x86-64, counted
//! by the program that `stress` uses, which draws in every style. [`super::board_styles`] counts styles on boards.

use crate::{Processor, callgrind::Counters};
use anyhow::{Context, Result, ensure};
use embedded_graphics_core::geometry::Size;
use microphong::{Outlines, Skips, pixel::Rgb565Be, renderer::check};
use microphong_models::scene::Scene;
use microphong_render::{
    render::{self, Format, Style},
    shader::Shader,
};
use microphong_stress::{case::Case, cost::Count};
use rayon::prelude::*;
use serde::Serialize;
use std::iter;

/// A way of drawing, by name.
pub type Named = (String, Style);

/// The plain style of a method, antialiasing, lines along outlines, and interpolation in perspective.
#[must_use]
pub fn styles(shader: Shader) -> Vec<Named> {
    let plain = Style::from(shader);
    let named = [
        ("plain", plain),
        ("antialias", Style { antialias: true, ..plain }),
        ("outlines", Style { outlines: Some(Outlines::new([255; 3])), ..plain }),
        ("perspective-correct", Style { perspective_correct: true, ..plain }),
    ];
    named.map(|(name, style)| (name.to_owned(), style)).into()
}

/// The plain style of a method, and that with each thing that nobody can see.
#[must_use]
pub fn skips(shader: Shader) -> Vec<Named> {
    let plain = Style::from(shader);
    let with = Skips::ALL_BUT.map(|(name, skips)| (format!("with {name}"), Style { skips, ..plain }));
    iter::once(("plain".to_owned(), plain)).chain(with).collect()
}

/// A scene by one method in several styles.
#[derive(Clone, Debug, Serialize)]
pub struct StyleCosts {
    /// The board that drew; of this computer its architecture.
    pub board: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Name of the method.
    pub shader: &'static str,
    /// Pixels of all drawn triangles, in the plain style.
    pub pixels: u32,
    /// Names of the styles, the plain one first.
    pub styles: Vec<String>,
    /// Instructions of the frame in each of them, on this computer with clearing; `None` where it cannot be drawn.
    pub instructions: Vec<Option<u64>>,
    /// Why the frame cannot be drawn in a style; `None` where it can.
    pub obstacles: Vec<Option<String>>,
}

/// Counts frame 0 of `scene` by `shaders`, each in its `styles`, the plain one first; `tick` is called for each method.
///
/// # Errors
/// When this is no x86-64 computer, valgrind is missing, or the scene cannot be drawn.
pub fn measure(
    counters: &Counters,
    scene: &Scene,
    shaders: &[Shader],
    styles: fn(Shader) -> Vec<Named>,
    tick: &(dyn Fn() + Sync),
) -> Result<Vec<StyleCosts>> {
    let (width, height) = Processor::X86_64.size();
    let stream = scene.stream.parse().with_context(|| scene.name.clone())?;
    let costs = shaders.par_iter().map(|&shader| {
        let (_, stats) = render::frame::<Rgb565Be>(stream, Size::new(width, height), Style::from(shader), height, 0)?;
        let (names, styles): (_, Vec<_>) = styles(shader).into_iter().unzip();
        let count = |style| {
            let (stream, size) = (scene.stream.clone(), [width, height]);
            counters.count(&Case { stream, size, frame: 0, style, format: Format::Rgb565, band_rows: height })
        };
        let obstacle = |style: &Style| check(&stream, shader.facts(), style.perspective_correct).err().map(|error| error.to_string());
        let obstacles = styles.iter().map(obstacle).collect();
        let instructions = styles.into_iter().map(count).collect::<Result<_>>()?;
        tick();
        Ok(StyleCosts {
            board: Processor::X86_64.board_name(),
            scene: scene.name.clone(),
            shader: shader.name(),
            pixels: stats.pixels,
            styles: names,
            instructions,
            obstacles,
        })
    });
    costs.collect()
}

/// Rows of the bands in which animations are counted: as many as the layout has that `convert` prints.
const ANIMATION_ROWS: u32 = 16;

/// Instructions of a frame of a scene's animation by one method, on average, clearing included.
#[derive(Clone, Debug, Serialize)]
pub struct RedrawCost {
    /// Name of the scene.
    pub scene: String,
    /// Name of the method.
    pub shader: &'static str,
    /// Frames that are counted: all but the first.
    pub frames: u32,
    /// Rows of a band.
    pub band_rows: u32,
    /// Whole frames.
    pub whole: u64,
    /// Whole frames with objects that others hide in the rows of a band.
    pub with_hidden_objects: u64,
    /// Only what has changed.
    pub redrawn: u64,
}

/// Counts the frames of the animation of `scene` behind the first by `shaders`; `tick` is called for each method.
///
/// # Errors
/// When the scene has one frame, this is no x86-64 computer, valgrind is missing, or the scene cannot be drawn.
pub fn redraw(counters: &Counters, scene: &Scene, shaders: &[Shader], tick: &(dyn Fn() + Sync)) -> Result<Vec<RedrawCost>> {
    let (width, height) = Processor::X86_64.size();
    let frames = u32::from(scene.stream.parse().with_context(|| scene.name.clone())?.header.frames).saturating_sub(1);
    ensure!(frames > 0, "{}: its animation has one frame, so that nothing is drawn again; choose a scene that moves", scene.name);
    let costs = shaders.par_iter().map(|&shader| {
        let plain = Style::from(shader);
        let seen = Style { skips: Skips { hidden_objects: false, ..Skips::ALL }, ..plain };
        let mean = |style, in_part| -> Result<u64> {
            let (stream, size, format) = (scene.stream.clone(), [width, height], Format::Rgb565);
            let case = Case { stream, size, frame: 0, style, format, band_rows: ANIMATION_ROWS };
            let all = counters.animation(&case, in_part)?.with_context(|| format!("{} cannot draw {}", shader.name(), scene.name))?;
            Ok(all / u64::from(frames))
        };
        let (whole, with_hidden_objects, redrawn) = (mean(plain, false)?, mean(seen, false)?, mean(plain, true)?);
        tick();
        let (scene, shader) = (scene.name.clone(), shader.name());
        Ok(RedrawCost { scene, shader, frames, band_rows: ANIMATION_ROWS, whole, with_hidden_objects, redrawn })
    });
    costs.collect()
}
