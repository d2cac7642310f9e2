//! Costs of styles on boards: smooth outlines, lines, perspective, lights of all kinds, colours, textures, transparency, the curve of a display, and pixel
//! formats.
//!
//! A style is a change of the stream, a program, or both. The plain firmware draws what needs no optional feature, so a figure tells what a program
//! pays that uses the style.

mod coats;
mod program;

use crate::{Processor, baseline::Entry, baseline::measure_with, styles::StyleCosts};
use anyhow::{Context, Result};
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use microphong::{Light, Outlines, SceneError, format::Angle, renderer::check, stream::record::Header};
use microphong_models::{bytes::StreamBytes, scene::Scene};
use microphong_render::{render, shader::Shader};
pub use program::Program;

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

    /// A style of a program that draws the stream as it is.
    const fn of_program(name: &'static str, program: Program) -> Self {
        Self::new(name, program, |stream| Ok(stream.clone()))
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

    /// The least program that draws in this style what [`Self::of`] has made.
    ///
    /// # Errors
    /// When the stream is not valid.
    pub fn program_for(&self, stream: &StreamBytes) -> Result<Program> {
        Ok(self.program.and(Program::needed_by(&stream.parse()?)))
    }

    /// Asks whether `processor` draws `scene` in this style by a method.
    ///
    /// # Errors
    /// Why it does not.
    fn check(&self, processor: Processor, scene: &Scene, shader: Shader) -> Result<()> {
        let stream = (self.change)(&scene.stream)?;
        let program = self.program_for(&stream)?;
        processor.board().map_or(Ok(()), |board| program.check(board))?;
        Ok(check(&stream.parse()?, shader.facts(), program.has(Program::PERSPECTIVE))?)
    }
}

impl PartialEq for BoardStyle {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for BoardStyle {}

/// The style without anything more.
pub const PLAIN: &BoardStyle = &STYLES[0];

/// All styles, the plain one first. Pixel formats stand last, in the order of [`render::Format::ALL`]; the first of them is that of all other styles.
pub static STYLES: [BoardStyle; 27] = [
    BoardStyle::of_program("plain", Program::PLAIN),
    BoardStyle::new("antialias", Program::ANTIALIAS, StreamBytes::with_neighbours),
    BoardStyle::new("outlines", Program::ANTIALIAS, |stream| stream.with_outlines(Outlines::new([255; 3]))),
    BoardStyle::of_program("perspective-correct", Program::PERSPECTIVE),
    BoardStyle::new("near-light", Program::PLAIN, |stream| lit(stream, |header| Ok(vec![near(header)?]))),
    BoardStyle::new("near-light-range", Program::ANTIALIAS, |stream| lit(stream, |header| Ok(vec![near(header)?.with_range(6)?]))),
    BoardStyle::new("near-light-cone", Program::ANTIALIAS, |stream| lit(stream, |header| Ok(vec![spot(header)?]))),
    BoardStyle::new("2-lights", Program::PLAIN, |stream| lit(stream, |_| distant(2))),
    BoardStyle::new("3-lights", Program::PLAIN, |stream| lit(stream, |_| distant(3))),
    BoardStyle::new("4-lights", Program::PLAIN, |stream| lit(stream, |_| distant(4))),
    BoardStyle::new("8-lights", Program::PLAIN, |stream| lit(stream, |_| distant(8))),
    BoardStyle::new("hemisphere", Program::ANTIALIAS, |stream| {
        lit(stream, |_| Ok(Light::hemisphere([0, 1, 0], [0.8; 3], [0.3; 3])?.into()))
    }),
    BoardStyle::new("colours", Program::VERTEX_COLOURS, coats::coloured),
    BoardStyle::new("texture", Program::TEXTURES, |stream| coats::textured(stream, false)),
    BoardStyle::new("texture-perspective", Program::TEXTURES.and(Program::PERSPECTIVE), |stream| coats::textured(stream, false)),
    BoardStyle::new("holes", Program::HOLES, |stream| coats::textured(stream, true)),
    BoardStyle::new("glass", Program::TRANSPARENCY, coats::glass),
    BoardStyle::of_program("gamma", Program::GAMMA),
    BoardStyle::of_program("rgb888", Program::in_format(0)),
    BoardStyle::of_program("gray8", Program::in_format(1)),
    BoardStyle::of_program("gray4", Program::in_format(2)),
    BoardStyle::of_program("gray2", Program::in_format(3)),
    BoardStyle::of_program("binary", Program::in_format(4)),
    BoardStyle::of_program("bgr565", Program::in_format(5)),
    BoardStyle::of_program("rgb666", Program::in_format(6)),
    BoardStyle::of_program("rgb332", Program::in_format(7)),
    BoardStyle::of_program("light-rgb565", Program::in_format(8)),
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

/// Counts frame 0 of `scenes`, each by the `wanted` methods, on a board in all [`STYLES`] that it draws; `tick` is called for each frame.
///
/// # Errors
/// When a program does not compile, or the board fails.
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
                match style.check(processor, scene, shader) {
                    Ok(()) => entries.push(Entry::unmeasured(processor, &scene.name, shader, style)),
                    Err(_) => tick(),
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
                obstacles: STYLES
                    .iter()
                    .map(|style| style.check(processor, scene, shader).err().map(|error| format!("{error:#}")))
                    .collect(),
            });
        }
    }
    Ok(costs)
}

#[cfg(test)]
mod tests {
    use super::{BoardStyle, STYLES};
    use crate::Processor;
    use microphong::stream::record::{Key, LIGHT_TRACK, Track};
    use microphong_models::scene::{self, Scene};
    use microphong_render::{render::Format, shader::Shader};
    use microphong_stress::records::Records;

    #[test]
    fn every_pixel_format_is_a_style() {
        let [drawn_in, others @ ..] = Format::ALL;
        let formats = STYLES.len() - others.len();
        assert!(STYLES[formats..].iter().map(|style| style.name).eq(others.map(Format::name)));
        assert!(STYLES[..formats].iter().all(|style| style.name != drawn_in.name()));
        for (style, format) in STYLES[formats..].iter().zip(others) {
            assert_eq!(style.program.features(), format.name());
        }
    }

    /// A style that a board, a scene or a method cannot have says why, and hinders no other. A light that moves has no place among fewer lights.
    #[test]
    fn obstacles_are_named() {
        let obstacle = |processor, scene: &Scene, shader, style: &str| {
            let style = BoardStyle::named(style).unwrap();
            style.check(processor, scene, shader).err().map(|error| format!("{error:#}"))
        };
        let [teapot, fox] = ["teapot", "fox"].map(|name| scene::load(name).unwrap());
        let mut records = Records::of(&teapot.stream.parse().unwrap());
        records.lights = vec![records.lights[0]; 2];
        records.tracks = vec![Track { kind: LIGHT_TRACK, index: 1, first_key: 0, keys: 1 }];
        records.keys = vec![Key { frame: 0, rotation: [1 << 30, 0, 0, 0], position: [0, 1 << 14, 0], scale: 1 << 16 }];
        let moving = Scene { stream: records.written().unwrap(), ..teapot.clone() };
        let of = |scene, style| obstacle(Processor::CortexM3, scene, Shader::GOURAUD, style);
        for style in &STYLES {
            assert_eq!(of(&teapot, style.name), None, "{}", style.name);
            let is_plain = style.program == super::Program::PLAIN;
            assert_eq!(obstacle(Processor::CortexM0Plus, &teapot, Shader::GOURAUD, style.name).is_none(), is_plain, "{}", style.name);
        }
        assert_eq!(["plain", "2-lights", "glass"].map(|style| of(&moving, style)), [None, None, None]);
        assert!(of(&moving, "near-light").is_some_and(|why| why.contains("track")), "{:?}", of(&moving, "near-light"));
        assert_eq!(["plain", "antialias", "glass"].map(|style| of(&fox, style)), [None, None, None]);
        assert_eq!(of(&fox, "texture").as_deref(), Some("the scene has colours of its own"));
        let gouraud4 = Shader::ALL.into_iter().find(|shader| shader.name() == "gouraud4").unwrap();
        assert!(obstacle(Processor::CortexM3, &teapot, gouraud4, "perspective-correct").is_some_and(|why| why.contains("perspective")));
        assert_eq!(
            obstacle(Processor::CortexM0Plus, &fox, Shader::GOURAUD, "plain").as_deref(),
            Some("pico has too little memory for the program with vertex-colours")
        );
    }
}
