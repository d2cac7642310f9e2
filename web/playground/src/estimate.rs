//! Estimates of the instructions of a frame: counts of the frame times the costs of each, which are fitted to counted frames.
//!
//! The costs are in `costs.csv` and, for the methods that keep an error budget, in `costs-auto.csv`, in instructions. They are fitted to the scenes of
//! the portfolio, to spheres, and to meshes of the tests and examples under other lights and from other sides. A test compares the estimates with
//! `tests/baselines/costs.csv`. They hold for one object in `Rgb565` with jagged outlines, under up to two directional lights, whose triangles have no
//! more than `LARGEST_TRIANGLES` pixels. A Cortex-M4F and a Cortex-M33 execute the instructions of a Cortex-M3: the recorded frames of the Cortex-M4F
//! differ by 0.3 % at most. Costs of a Cortex-M0+ are those of both processors of the Pico together.

use anyhow::{Context, Result, ensure};
use microphong::{
    Stats, Stream,
    stream::record::{CLOSED_CONVEX, DIRECTIONAL, VIEWER_LOCAL},
};
use microphong_render::{
    chip::Core,
    choices::{Choices, Way},
    program::needs,
    render::Format,
    shader::Shader,
};

/// The largest error of an estimate of a recorded frame, as a share of it.
#[cfg(test)]
const LARGEST_ERROR: f64 = 0.1;

/// Costs of methods that draw all triangles in one way.
const COSTS: &str = include_str!("costs.csv");
/// Costs of `auto` and `auto-linear`, which differ in what they choose.
const AUTO: &str = include_str!("costs-auto.csv");

/// The most pixels that triangles have on average, if the costs hold for them. A larger triangle is set up in parts.
const LARGEST_TRIANGLES: f64 = 500.0;

/// The ways that take much at each pixel.
const HARD: [Way; 3] = [Way::Quadratic, Way::Cosines, Way::Phong];

/// Seconds of a frame on an RP2040 that are not spent on its instructions, and seconds of an instruction, where both processors draw. They are those of
/// the frames a second of the teapot in docs/guide/costs.md, to 5 %.
const PICO_SECONDS: [f64; 2] = [4.37e-3, 5.46e-9];

/// Whether there may be costs that hold for frames of this stream.
pub(crate) fn holds_for(stream: &Stream<'_>, format: Format) -> bool {
    stream.instances.is_empty()
        && stream.corner_colours.is_empty()
        && stream.textures().list.is_empty()
        && stream.header.camera.viewer != VIEWER_LOCAL
        && stream.lights.iter().all(|light| light.kind == DIRECTIONAL)
        && (1..=2).contains(&stream.lights.len())
        && format == Format::Rgb565
}

/// What a frame has of everything that costs instructions.
pub(crate) struct Counts {
    vertices: usize,
    stats: Stats,
    choices: Choices,
    /// The share of triangles whose material has a highlight.
    shiny: f64,
    /// 1 if pixels are drawn with depth, or 0 if the only mesh is convex.
    depth: f64,
    /// 1 if light has three channels, or else 0.
    colour: f64,
    /// Number of lights beyond the first.
    lights: f64,
}

impl Counts {
    /// The counts of a frame; `None` if the costs do not hold for it. The choices are those of its method, or of `auto` if its method chooses nothing.
    pub(crate) fn new(stream: &Stream<'_>, format: Format, stats: Stats, choices: Choices) -> Option<Self> {
        if !holds_for(stream, format) || f64::from(stats.pixels) > LARGEST_TRIANGLES * f64::from(stats.drawn) {
            return None;
        }
        let (mut all, mut shiny) = (0, 0);
        for mesh in stream.meshes {
            all += mesh.triangles;
            let material = stream.materials.get(usize::from(mesh.material));
            shiny += if material.is_some_and(|material| material.specular != [0; 3]) { mesh.triangles } else { 0 };
        }
        let is_convex = matches!(stream.meshes, [mesh] if mesh.flags & CLOSED_CONVEX != 0);
        let has_colours = needs(stream, format).iter().any(|feature| feature.name() == "colours");
        Some(Self {
            vertices: stream.vertices.len(),
            stats,
            choices,
            shiny: f64::from(shiny) / f64::from(all.max(1)),
            depth: f64::from(u8::from(!is_convex)),
            colour: f64::from(u8::from(has_colours)),
            lights: stream.lights.len() as f64 - 1.0,
        })
    }

    /// Triangles and pixels that are drawn in one of these ways.
    fn of(&self, ways: &[Way]) -> [f64; 2] {
        let counts = ways.iter().map(|&way| self.choices.count(way));
        counts.fold([0.0, 0.0], |[triangles, pixels], count| [triangles + f64::from(count.triangles), pixels + f64::from(count.pixels)])
    }

    /// The counts that the costs of this method are given for.
    fn list(&self, shader: Shader) -> Vec<f64> {
        let &Self { vertices, stats: Stats { drawn, pixels, .. }, shiny, depth, colour, lights, .. } = self;
        let [vertices, drawn, pixels] = [vertices as f64, f64::from(drawn), f64::from(pixels)];
        // Triangles are about as high as they are wide.
        let rows = (pixels * drawn).sqrt();
        // The light that there is beyond one light in one channel.
        let light = colour + lights;
        let [linear_triangles, linear] = self.of(&[Way::Linear]);
        let [hard_triangles, hard] = self.of(&HARD);
        let common = [vertices, drawn, rows, pixels, pixels * depth];
        let by_method = if shader.keeps_budget() {
            let [quadratic, cosines, phong] = HARD.map(|way| self.of(&[way])[1] * (1.0 + light));
            vec![drawn * light, linear * light, quadratic, cosines, phong, linear_triangles, hard_triangles, hard_triangles * light]
        } else {
            // `auto` draws a triangle in one colour where light is nearly the same all over it. There most methods compute less at a pixel, and also where
            // there is no highlight.
            let varied = (linear + hard) * shiny;
            vec![drawn * colour, drawn * lights, pixels * light, varied, hard * shiny * (1.0 + light)]
        };
        common.into_iter().chain(by_method).collect()
    }

    /// The instructions of the frame; `None` if there are no costs of this method on this processor.
    pub(crate) fn instructions(&self, core: Core, shader: Shader) -> Result<Option<f64>> {
        let core = match core {
            Core::CortexM4F | Core::CortexM33 => Core::CortexM3,
            core => core,
        };
        let (table, start) = if shader.keeps_budget() {
            (AUTO, format!("{},", core.name()))
        } else {
            (COSTS, format!("{},{},", core.name(), shader.name()))
        };
        let Some(costs) = table.lines().find_map(|line| line.strip_prefix(&start)) else { return Ok(None) };
        let costs = costs.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>().context("a cost is no number")?;
        let list = self.list(shader);
        ensure!(costs.len() == list.len(), "{} costs for {} counts", costs.len(), list.len());
        Ok(Some(costs.iter().zip(list).map(|(cost, count)| cost * count).sum()))
    }
}

/// Frames a second, for processors whose time is modelled.
pub(crate) fn rate(core: Core, instructions: f64) -> Option<f64> {
    let [fixed, each] = PICO_SECONDS;
    (core == Core::CortexM0Plus).then(|| 1.0 / (fixed + each * instructions))
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics_core::pixelcolor::Rgb565;
    use microphong_models::scene;
    use microphong_render::{board::Board, chip::Chip, choices, render};

    /// The counts of the first frame of a built-in scene on a board; `None` if the board has no room for all vertices. Its firmware then transforms
    /// some vertices again for each triangle, which no program does that the page offers.
    fn counted(name: &str, board: Board, shader: Shader) -> Option<Counts> {
        let bytes = scene::load(name).unwrap().stream;
        let stream = bytes.view().unwrap();
        if stream.vertices.len() > board.budget().layout.vertices {
            return None;
        }
        let size = board.size().into();
        let (_, stats) = render::frame::<Rgb565>(stream, size, Shader::FLAT, size.height, 0).unwrap();
        let chooser = if shader.keeps_budget() { shader } else { Shader::AUTO };
        let told = choices::by::<Rgb565>(chooser, stream, size, false, 0).unwrap().unwrap();
        Some(Counts::new(&stream, Format::Rgb565, stats, told.choices).expect(name))
    }

    /// The estimates of the portfolio's frames are those of `bench` to 10 %.
    #[test]
    fn estimates_are_near_the_recorded_costs() {
        let recorded = include_str!("../../../tests/baselines/costs.csv");
        let (mut count, mut worst) = (0, 0.0f64);
        // How many frames prove the costs of a method on a processor.
        let mut proven = Vec::new();
        for line in recorded.lines().skip(1) {
            let [name, scene, method, instructions, _] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
            let board = Board::ALL.into_iter().find(|board| board.name() == name).unwrap();
            let core = match board {
                Board::Mps2An385 => Core::CortexM3,
                Board::Mps2An386 => Core::CortexM4F,
                Board::Mps2An505 => Core::CortexM33,
                Board::Pico => Core::CortexM0Plus,
                Board::RiscvVirt => Core::RiscV,
                // Others have a processor of these, or draw by two that are estimated as one.
                _ => continue,
            };
            let Some(shader) = Shader::CORE.into_iter().find(|shader| shader.name() == method) else { continue };
            if !scene::PORTFOLIO.contains(&scene) {
                continue;
            }
            let Some(counts) = counted(scene, board, shader) else { continue };
            let estimate = counts.instructions(core, shader).unwrap().unwrap_or_else(|| panic!("no costs of {method} on {}", core.name()));
            let error = estimate / instructions.parse::<f64>().unwrap() - 1.0;
            assert!(error.abs() < LARGEST_ERROR, "{line}: {estimate:.0}, {:+.1} %", 100.0 * error);
            (count, worst) = (count + 1, worst.max(error.abs()));
            proven.push((core, shader));
        }
        assert!(count >= 100, "{count} frames");
        for shader in Shader::CORE {
            for core in [Core::CortexM3, Core::CortexM0Plus, Core::RiscV] {
                let frames = proven.iter().filter(|&&of| of == (core, shader)).count();
                assert!(frames >= 3, "{frames} recorded frames prove the costs of {} on {}", shader.name(), core.name());
            }
        }
        println!("{count} recorded frames, the worst estimate is off by {:.1} %", 100.0 * worst);
    }

    /// Every method of the core has an estimate on every chip.
    #[test]
    fn every_chip_has_estimates() {
        for shader in Shader::CORE {
            let counts = counted(scene::PLASTIC, Board::Mps2An385, shader).unwrap();
            for chip in Chip::ALL {
                let estimate = counts.instructions(chip.core, shader).unwrap();
                assert!(estimate.is_some_and(|instructions| instructions > 1e5), "{}, {}: {estimate:?}", chip.name, shader.name());
            }
        }
    }
}
