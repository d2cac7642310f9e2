//! Estimates of the instructions of a frame: counts of the frame times the costs of each, which are fitted to recorded frames.
//!
//! The costs are in `costs.csv` and `costs-auto.csv`, in instructions. A test compares the estimates with `tests/baselines/costs.csv`. They hold for
//! one object in `Rgb565` with jagged outlines, under up to two directional lights. A Cortex-M4F and a Cortex-M33 execute the instructions of a
//! Cortex-M3: the recorded frames of the Cortex-M4F differ by 0.3 % at most.

use anyhow::{Context, Result};
use microphong::{
    Stats, Stream,
    stream::record::{DIRECTIONAL, VIEWER_LOCAL},
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
/// Costs of `auto`.
const AUTO: &str = include_str!("costs-auto.csv");

/// Seconds of a frame on an RP2040 that are not spent on its instructions, and seconds of an instruction, where both processors draw. They are those of
/// the frames a second of the teapot in docs/guide/costs.md, to 5 %.
const PICO_SECONDS: [f64; 2] = [4.37e-3, 5.46e-9];

/// What a frame has of everything that costs instructions.
pub(crate) struct Counts {
    stats: Stats,
    choices: Option<Choices>,
    /// 1 if light has three channels, or else 0.
    colour: f64,
    /// Number of lights beyond the first.
    lights: f64,
}

impl Counts {
    /// The counts of a frame that was drawn; `None` if the costs do not hold for it.
    pub(crate) fn new(stream: &Stream<'_>, format: Format, stats: Stats, choices: Option<Choices>) -> Option<Self> {
        let is_usual = stream.instances.is_empty()
            && stream.corner_colours.is_empty()
            && stream.textures().list.is_empty()
            && stream.header.camera.viewer != VIEWER_LOCAL
            && stream.lights.iter().all(|light| light.kind == DIRECTIONAL)
            && (1..=2).contains(&stream.lights.len())
            && format == Format::Rgb565;
        let has_colours = needs(stream, format).iter().any(|feature| feature.name() == "colours");
        is_usual.then(|| Self { stats, choices, colour: f64::from(u8::from(has_colours)), lights: stream.lights.len() as f64 - 1.0 })
    }

    /// The counts that costs are given for.
    fn list(&self) -> Vec<f64> {
        let Stats { triangles, drawn, pixels, .. } = self.stats;
        let [triangles, drawn, pixels] = [triangles, drawn, pixels].map(f64::from);
        // Triangles are about as high as they are wide.
        let rows = (pixels * drawn).sqrt();
        let Some(choices) = &self.choices else {
            return vec![
                triangles,
                drawn,
                drawn * self.colour,
                drawn * self.lights,
                rows,
                pixels,
                pixels * self.colour,
                pixels * self.lights,
            ];
        };
        let of = |ways: &[Way]| {
            let counts = ways.iter().map(|&way| choices.count(way));
            counts.fold([0.0, 0.0], |[triangles, pixels], count| [triangles + f64::from(count.triangles), pixels + f64::from(count.pixels)])
        };
        let ([_, one], [linear_triangles, linear]) = (of(&[Way::OneColour]), of(&[Way::Linear]));
        let [hard_triangles, hard] = of(&[Way::Quadratic, Way::Cosines, Way::Phong]);
        vec![
            triangles,
            drawn,
            drawn * self.colour,
            rows,
            one,
            linear,
            linear * self.colour,
            hard,
            hard * (self.colour + 2.0 * self.lights),
            linear_triangles,
            hard_triangles,
            hard_triangles * (self.colour + self.lights),
        ]
    }

    /// The instructions of the frame; `None` if there are no costs of this method on this processor.
    pub(crate) fn instructions(&self, core: Core, shader: Shader) -> Result<Option<f64>> {
        let core = match core {
            Core::CortexM4F | Core::CortexM33 => Core::CortexM3,
            core => core,
        };
        let start = format!("{},{},", core.name(), shader.name());
        let table = if self.choices.is_some() { AUTO } else { COSTS };
        let Some(costs) = table.lines().find_map(|line| line.strip_prefix(&start)) else { return Ok(None) };
        let costs = costs.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>().context("a cost is no number")?;
        Ok(Some(costs.iter().zip(self.list()).map(|(cost, count)| cost * count).sum()))
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
    use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
    use microphong_models::scene;
    use microphong_render::{choices, render};

    /// The estimates of the portfolio's frames are those of `bench` to 10 %.
    #[test]
    fn estimates_are_near_the_recorded_costs() {
        let recorded = include_str!("../../../tests/baselines/costs.csv");
        let (mut count, mut worst) = (0, 0.0f64);
        for line in recorded.lines().skip(1) {
            let [board, name, method, instructions, _] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
            let (core, size) = match board {
                "mps2-an385" => (Core::CortexM3, Size::new(320, 240)),
                "mps2-an386" => (Core::CortexM4F, Size::new(320, 240)),
                "mps2-an505" => (Core::CortexM33, Size::new(320, 240)),
                "pico" => (Core::CortexM0Plus, Size::new(240, 240)),
                // Of others there are no estimates.
                _ => continue,
            };
            let Some(shader) = Shader::CORE.into_iter().find(|shader| shader.name() == method) else { continue };
            if !scene::PORTFOLIO.contains(&name) {
                continue;
            }
            let bytes = scene::load(name).unwrap().stream;
            let stream = bytes.view().unwrap();
            let (_, stats) = render::frame::<Rgb565>(stream, size, Shader::FLAT, size.height, 0).unwrap();
            let told = choices::by::<Rgb565>(shader, stream, size, false, 0).unwrap();
            let counts = Counts::new(&stream, Format::Rgb565, stats, told.map(|told| told.choices)).unwrap();
            let Some(estimate) = counts.instructions(core, shader).unwrap() else { continue };
            let error = estimate / instructions.parse::<f64>().unwrap() - 1.0;
            assert!(error.abs() < LARGEST_ERROR, "{line}: {estimate:.0}, {:+.1} %", 100.0 * error);
            (count, worst) = (count + 1, worst.max(error.abs()));
        }
        assert!(count >= 60, "{count} frames");
        println!("{count} recorded frames, the worst estimate is off by {:.1} %", 100.0 * worst);
    }
}
