//! Costs of styles on boards: smooth outlines, lines, perspective, lights of all kinds, the curve of a display, and pixel formats.
//!
//! A style is a change of the stream, a program, or both. The plain firmware draws what needs no optional feature, so a figure tells what a program
//! pays that uses the style.

use crate::{Processor, baseline::Entry, baseline::measure_with, styles::StyleCosts};
use anyhow::{Context, Result};
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use microphong::{Light, Outlines, SceneError, format::Angle, renderer::check, stream::record::Header};
use microphong_boards::{Board, build, verify};
use microphong_models::{bytes::StreamBytes, scene::Scene};
use microphong_render::{render, shader::Shader};
use std::path::PathBuf;

/// A program of a board with a frame buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Program {
    /// The firmware of the board.
    Plain,
    /// The firmware that draws smooth outlines, lines, and all lights.
    Antialias,
    /// The program `styles` with these cargo features.
    Styles(&'static str),
}

impl Program {
    /// The program that draws colours at corners.
    pub const VERTEX_COLOURS: Self = Self::Styles("rgb565,vertex-colours");
    /// The program that draws textures.
    pub const TEXTURES: Self = Self::Styles("rgb565,textures");
    /// The program that draws transparent surfaces.
    pub const TRANSPARENCY: Self = Self::Styles("rgb565,transparency");
    /// The program that draws textures with holes.
    pub const HOLES: Self = Self::Styles("rgb565,textures,transparency");

    /// Builds it for `board`, and returns the ELF's path.
    ///
    /// # Errors
    /// When the program does not compile, or the board has too little memory for it.
    pub fn build(self, board: Board) -> Result<PathBuf> {
        match self {
            Self::Plain | Self::Antialias => verify::build(board, self == Self::Antialias),
            Self::Styles(features) => build::styles(board, features),
        }
    }
}

/// A style of drawing.
#[derive(Debug)]
pub struct BoardStyle {
    /// The name in tables and files.
    pub name: &'static str,
    /// The program that draws it.
    pub program: Program,
    /// What becomes of the stream.
    change: fn(&StreamBytes) -> Result<StreamBytes>,
}

impl BoardStyle {
    const fn new(name: &'static str, program: Program, change: fn(&StreamBytes) -> Result<StreamBytes>) -> Self {
        Self { name, program, change }
    }

    /// A style of a program with a cargo feature, which draws the stream as it is.
    const fn of_program(name: &'static str, features: &'static str) -> Self {
        Self::new(name, Program::Styles(features), |stream| Ok(stream.clone()))
    }

    /// The style of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        STYLES.iter().find(|style| style.name == name)
    }

    /// The scene in this style.
    ///
    /// # Errors
    /// When the scene cannot have this style.
    pub fn of(&self, scene: &Scene) -> Result<Scene> {
        let stream = (self.change)(&scene.stream).with_context(|| format!("{} in the style {}", scene.name, self.name))?;
        Ok(Scene { stream, ..scene.clone() })
    }

    /// Whether a method draws this scene in this style.
    fn is_possible(&self, scene: &Scene, shader: Shader) -> Result<bool> {
        let scene = self.of(scene)?;
        Ok(check(&scene.stream.parse()?, shader.facts(), self.name == PERSPECTIVE).is_ok())
    }
}

impl PartialEq for BoardStyle {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for BoardStyle {}

const PERSPECTIVE: &str = "perspective-correct";

/// The style without anything more.
pub const PLAIN: &BoardStyle = &STYLES[0];

/// All styles, the plain one first. Pixel formats stand last, in the order of [`render::Format::ALL`]; the first of them is that of all other styles.
pub static STYLES: [BoardStyle; 22] = [
    BoardStyle::new("plain", Program::Plain, |stream| Ok(stream.clone())),
    BoardStyle::new("antialias", Program::Antialias, StreamBytes::with_neighbours),
    BoardStyle::new("outlines", Program::Antialias, |stream| stream.with_outlines(Outlines::new([255; 3]))),
    BoardStyle::of_program(PERSPECTIVE, "rgb565,perspective"),
    BoardStyle::new("near-light", Program::Plain, |stream| lit(stream, |header| Ok(vec![near(header)?]))),
    BoardStyle::new("near-light-range", Program::Antialias, |stream| lit(stream, |header| Ok(vec![near(header)?.with_range(6)?]))),
    BoardStyle::new("near-light-cone", Program::Antialias, |stream| lit(stream, |header| Ok(vec![spot(header)?]))),
    BoardStyle::new("2-lights", Program::Plain, |stream| lit(stream, |_| distant(2))),
    BoardStyle::new("3-lights", Program::Plain, |stream| lit(stream, |_| distant(3))),
    BoardStyle::new("4-lights", Program::Plain, |stream| lit(stream, |_| distant(4))),
    BoardStyle::new("8-lights", Program::Plain, |stream| lit(stream, |_| distant(8))),
    BoardStyle::new("hemisphere", Program::Antialias, |stream| {
        lit(stream, |_| Ok(Light::hemisphere([0, 1, 0], [0.8; 3], [0.3; 3])?.into()))
    }),
    BoardStyle::of_program("gamma", "rgb565,gamma"),
    BoardStyle::of_program("rgb888", "rgb888"),
    BoardStyle::of_program("gray8", "gray8"),
    BoardStyle::of_program("gray4", "gray4"),
    BoardStyle::of_program("gray2", "gray2"),
    BoardStyle::of_program("binary", "binary"),
    BoardStyle::of_program("bgr565", "bgr565"),
    BoardStyle::of_program("rgb666", "rgb666"),
    BoardStyle::of_program("rgb332", "rgb332"),
    BoardStyle::of_program("light-rgb565", "light-rgb565"),
];

/// The stream in the light of `lights`.
fn lit(stream: &StreamBytes, lights: impl FnOnce(&Header) -> Result<Vec<Light>, SceneError>) -> Result<StreamBytes> {
    stream.with_lights(&lights(stream.parse()?.header)?)
}

/// The position of a near light from the middle of the mesh, as the camera sees it: to the left, above, and towards the viewer.
const OFFSET: [f32; 3] = [-0.9, 1.0, 2.0];

/// A white near light, which goes where the camera goes.
fn near(header: &Header) -> Result<Light, SceneError> {
    let [x, y, z] = header.camera.translation.map(|c| c as f32 / 16_384.0);
    Ok(Light::near([x + OFFSET[0], y + OFFSET[1], OFFSET[2] - z], [1.0; 3])?.with_camera())
}

/// This light in a cone that shines on a part of the mesh.
fn spot(header: &Header) -> Result<Light, SceneError> {
    let degrees = |degrees: f32| Angle::from_num(degrees / 360.0);
    near(header)?.with_cone(OFFSET.map(|c| -c), degrees(12.0), degrees(20.0))
}

/// White lights that are infinitely far: one from the upper left, and weaker ones all around.
fn distant(count: u8) -> Result<Vec<Light>, SceneError> {
    let light = |number: u8| {
        let turn = std::f32::consts::TAU * f32::from(number) / f32::from(count);
        let strength = if number == 0 { 0.7 } else { 0.4 / f32::from(count - 1) };
        Ok(Light::directional([turn.sin() - 0.5, 0.6, turn.cos()], [strength; 3])?.with_camera())
    };
    (0..count).map(light).collect()
}

/// Whether a processor draws styles by programs of its board.
#[must_use]
pub fn possible(processor: Processor) -> bool {
    processor.board().is_some_and(Board::smooths)
}

/// Counts frame 0 of `scenes`, each by the `wanted` methods, on a board in all [`STYLES`]; `tick` is called for each frame.
///
/// # Errors
/// When a program does not compile, a scene cannot be drawn, or the board fails.
pub fn measure(
    processor: Processor,
    scenes: &[Scene],
    wanted: &dyn Fn(&Scene) -> Vec<Shader>,
    tick: &(dyn Fn() + Sync),
) -> Result<Vec<StyleCosts>> {
    let mut entries = Vec::new();
    for scene in scenes {
        for shader in wanted(scene) {
            for style in &STYLES {
                if style.is_possible(scene, shader)? {
                    entries.push(Entry::unmeasured(processor, &scene.name, shader, style));
                } else {
                    tick();
                }
            }
        }
    }
    let load = |name: &str| scenes.iter().find(|scene| scene.name == name).cloned().with_context(|| format!("no scene {name}"));
    let measured = measure_with(&entries, &load, tick)?;
    let (width, height) = processor.size();
    let mut costs = Vec::new();
    for scene in scenes {
        let stream = scene.stream.parse().with_context(|| scene.name.clone())?;
        for shader in wanted(scene) {
            let (_, stats) = render::frame::<Rgb565>(stream, Size::new(width, height), shader, height, 0)?;
            let of = |style: &BoardStyle| {
                let is_it = |entry: &&Entry| (&entry.scene, entry.shader, entry.style) == (&scene.name, shader, style);
                measured.iter().find(is_it).map(|entry| entry.instructions)
            };
            costs.push(StyleCosts {
                board: processor.board_name(),
                scene: scene.name.clone(),
                shader: shader.name(),
                pixels: stats.pixels,
                styles: STYLES.iter().map(|style| style.name.to_owned()).collect(),
                instructions: STYLES.iter().map(of).collect(),
            });
        }
    }
    Ok(costs)
}

#[cfg(test)]
mod tests {
    use super::STYLES;
    use microphong_render::render::Format;

    #[test]
    fn every_pixel_format_is_a_style() {
        let [drawn_in, others @ ..] = Format::ALL;
        let formats = STYLES.len() - others.len();
        assert!(STYLES[formats..].iter().map(|style| style.name).eq(others.map(Format::name)));
        assert!(STYLES[..formats].iter().all(|style| style.name != drawn_in.name()));
    }
}
