//! The report: run time against error, growth and break-even on one page, and the chart alone as a drawing.

mod axis;
mod label;
mod lines;
mod scatter;
mod tables;

use super::{
    Measurement, Processor,
    family::Family,
    growth::{Point, Sweep},
    peers::table::Table,
};
use anyhow::{Context, Result};
use maud::{Markup, PreEscaped, html};
use microphong_compare::document::{COLOURS, document};
use microphong_models::scene::PEER;
use microphong_render::output::Output;
use scatter::{Axes, Error};
use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
};

const CHART: &str = include_str!("chart.css");
const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");
/// The scene that other renderers were measured with stands in front.
const FIRST: &str = PEER;

/// A report under construction: `index.html` and `chart.svg`.
#[derive(Debug)]
pub struct Page {
    page: Output,
    chart: Output,
}

impl Page {
    /// Starts both files in `directory`, which is made if it is not there.
    ///
    /// # Errors
    /// When the directory cannot be made or written.
    pub fn create(directory: &Path) -> Result<Self> {
        fs::create_dir_all(directory).with_context(|| format!("cannot create the directory {}", directory.display()))?;
        Ok(Self { page: Output::create(&directory.join("index.html"))?, chart: Output::create(&directory.join("chart.svg"))? })
    }

    /// Writes them and returns where the page is.
    ///
    /// # Errors
    /// When they cannot be written; then there are none.
    pub fn finish(self, measurements: &[Measurement], peers: &[Table], growth: &[Point]) -> Result<PathBuf> {
        let path = self.page.path().to_owned();
        let style = format!("{CHART}{STYLE}");
        for (mut file, text) in [(self.page, page(measurements, peers, growth, &style)), (self.chart, chart(measurements))] {
            file.write_all(text.into_string().as_bytes()).with_context(|| format!("cannot write {}", file.path().display()))?;
            file.finish()?;
        }
        Ok(path)
    }
}

/// Names of the scenes, in order.
fn scenes(measurements: &[Measurement]) -> Vec<&str> {
    let mut scenes: Vec<&str> = Vec::new();
    for m in measurements {
        if !scenes.contains(&m.scene.as_str()) {
            scenes.push(&m.scene);
        }
    }
    scenes.sort_by_key(|scene| *scene != FIRST);
    scenes
}

/// Processors that have measured anything of these.
fn processors(measurements: &[&Measurement]) -> Vec<Processor> {
    let mut processors: Vec<_> = measurements.iter().map(|m| m.board).collect();
    processors.sort();
    processors.dedup();
    processors
}

fn of_scene<'m>(measurements: &'m [Measurement], scene: &str) -> Vec<&'m Measurement> {
    measurements.iter().filter(|m| m.scene == scene).collect()
}

fn of_processor<'m>(measurements: &[&'m Measurement], processor: Processor) -> Vec<&'m Measurement> {
    measurements.iter().copied().filter(|m| m.board == processor).collect()
}

fn page(measurements: &[Measurement], peers: &[Table], growth: &[Point], style: &str) -> Markup {
    let scenes = scenes(measurements);
    let head = html! {
        p {
            "What a frame costs by each shading method, in instructions, and how far its picture is from Phong shading in 64-bit floating "
            "point, in LSB, steps of which 255 are full level. Both are of the same frame. Clearing and transfer are not counted."
        }
        p {
            "The line joins the methods that no other beats: whatever is cheaper is less exact. Point at a method to find it everywhere."
        }
        form.choice {
            @if scenes.len() > 1 {
                label { "Scene " select id="scene" { @for scene in &scenes { option { (scene) } } } }
            }
            fieldset {
                legend { "Error" }
                label { input type="radio" name="error" value="rms" checked; "root mean square" }
                label { input type="radio" name="error" value="max"; "largest" }
            }
        }
        (legend())
    };
    let main = scenes.first().map_or(Vec::new(), |scene| of_scene(measurements, scene));
    let chips = processors(&main);
    let body = html! {
        @for scene in &scenes { (section(scene, &of_scene(measurements, scene))) }
        @if !peers.is_empty() {
            section.scene {
                h2 { "Beside other renderers" }
                p.facts { "Instructions per pixel, clearing and transfer excluded, everything else included." }
                @for table in peers {
                    @if let Some(note) = table.note() { p.facts { (note) } }
                    (tables::peers(table))
                }
            }
        }
        @if !growth.is_empty() {
            section.scene {
                h2 { "How cost grows" }
                p.facts {
                    "Instructions of x86-64. Triangles, pixels and lights on a flat square with the normals of a cushion, which covers the same pixels "
                    "however fine its mesh is."
                }
                div.charts { @for sweep in Sweep::ALL { (lines::plot(sweep, growth)) } }
            }
        }
        @if let Some(scene) = scenes.first() {
            section.scene {
                h2 { "Break-even with Phong shading" }
                p.facts {
                    "Pixels per triangle from which on a method is cheaper than Phong shading at each pixel. A triangle of a pixels costs t + s √a + p a: "
                    "what its frame of " (scene) " took per triangle, per span and per pixel, with spans of triangles of that shape."
                    @if !growth.is_empty() { " Counted: where the curves of the plot of triangles cross, between two counted frames." }
                }
                (tables::break_evens(&main, &chips, growth))
                h2 { "Costs over Gouraud shading" }
                p.facts { "Instructions of the whole frame and of its inner loops, scene " (scene) ", over those of Gouraud shading; the papers' are times of frames." }
                (tables::ratios(&main, &chips))
            }
        }
    };
    document("Run time against error", [style, SCRIPT], &head, &body)
}

fn section(scene: &str, measurements: &[&Measurement]) -> Markup {
    let first = measurements.first();
    let chips = processors(measurements);
    html! {
        section.scene data-scene=(scene) {
            h2 { (scene) }
            @if let Some(m) = first {
                p.facts { (m.triangles) " triangles on " (m.pixels) " pixels of " (m.board.size().0) "×" (m.board.size().1) }
            }
            @for error in Error::ALL {
                @let axes = Axes::new(measurements, error);
                div class={ "charts " (error.class()) } {
                    @for &processor in &chips { (scatter::panel(processor, &of_processor(measurements, processor), &axes)) }
                }
            }
            details {
                summary { "All figures" }
                (tables::measurements(scene, measurements))
            }
        }
    }
}

fn legend() -> Markup {
    html! {
        ul.legend {
            @for family in Family::ALL {
                li class=(family.class()) { svg.dot viewBox="0 0 10 10" aria-hidden="true" { circle cx="5" cy="5" r="4" {} } (family.label()) }
            }
        }
    }
}

/// The panels of the first scene as one drawing, with its own style: for the guide.
fn chart(measurements: &[Measurement]) -> Markup {
    const GAP: f64 = 24.0;
    const HEAD: f64 = 46.0;
    let scene = scenes(measurements).first().copied().unwrap_or_default();
    let measurements = of_scene(measurements, scene);
    let chips = processors(&measurements);
    let axes = Axes::new(&measurements, Error::Rms);
    let columns = chips.len().clamp(1, 2);
    let rows = chips.len().div_ceil(columns);
    let (width, height) = scatter::SIZE;
    let width_of_all = columns as f64 * (width + GAP) - GAP;
    let height_of_all = HEAD + rows as f64 * (height + GAP) - GAP;
    let step = width_of_all / 3.0;
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox={ "-12 -8 " (width_of_all + 24.0) " " (height_of_all + 16.0) } font-family="system-ui, -apple-system, Segoe UI, Roboto, Helvetica Neue, Arial, sans-serif" {
            title { "Instructions per pixel against error of all shading methods, scene " (scene) }
            style { (PreEscaped(COLOURS)) (PreEscaped(CHART)) }
            rect.paper x="-12" y="-8" width=(width_of_all + 24.0) height=(height_of_all + 16.0) {}
            @for (index, family) in Family::ALL.into_iter().enumerate() {
                @let (x, y) = ((index % 3) as f64 * step, 6.0 + (index / 3) as f64 * 15.0);
                g class={ "point best " (family.class()) } {
                    circle cx=(format!("{:.1}", x + 4.0)) cy=(y) r="4" {}
                    text x=(format!("{:.1}", x + 13.0)) y=(y + 4.0) { (family.label()) }
                }
            }
            @for (index, &processor) in chips.iter().enumerate() {
                g transform={ "translate(" ((index % columns) as f64 * (width + GAP)) " " (HEAD + (index / columns) as f64 * (height + GAP)) ")" } {
                    (scatter::drawing(processor, &of_processor(&measurements, processor), &axes))
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stages;
    use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
    use microphong_models::scene;
    use microphong_render::{choices, shader::Shader};

    fn measured() -> Vec<Measurement> {
        let frame = |scene: &str, board: Processor, shader: Shader, index: u64| {
            let by_stage = Stages { vertex: 10, cull: 20, setup: 300 + index, span: 400, pixel: 1000 * (index + 1), ..Stages::default() };
            Measurement {
                board,
                cpu: board.name(),
                scene: scene.to_owned(),
                shader: shader.name(),
                instructions: by_stage.drawing(),
                cycles: None,
                pixels: 1000,
                triangles: 10,
                spans: 100,
                instr_per_pixel: by_stage.drawing() as f64 / 1000.0,
                by_stage,
                ram_bytes: None,
                flash_bytes: None,
                max_lsb: Some(40.0 / (index + 1) as f64),
                rmse_lsb: Some(10.0 / (index + 1) as f64),
                budget: None,
                choices: None,
                flash_own_bytes: None,
                firmware_bytes: None,
                timing: None,
            }
        };
        let processors = [Processor::CortexM3, Processor::X86_64];
        let scenes = ["teapot", "peer-sphere"];
        let all = || Shader::ALL.into_iter().zip(0..);
        scenes
            .iter()
            .flat_map(|scene| {
                processors.into_iter().flat_map(move |cpu| all().map(move |(shader, index)| frame(scene, cpu, shader, index)))
            })
            .collect()
    }

    #[test]
    fn every_panel_shows_each_point_once() {
        let measurements = measured();
        let text = page(&measurements, &[], &[], "").into_string();
        // Two scenes, two processors, two errors.
        assert_eq!(text.matches("<svg class=\"chart\"").count(), 8);
        for shader in Shader::ALL {
            let points = text.matches(&format!("\" data-method=\"{}\"><title>", shader.name())).count();
            assert_eq!(points, 8, "{}", shader.name());
        }
        assert_eq!(chart(&measurements).into_string().matches("<title>").count(), 1 + 2 * Shader::ALL.len(), "the drawing shows one scene");
    }

    #[test]
    fn several_budgets_are_a_curve() {
        let auto = |m: &Measurement| m.shader.starts_with("auto").then(|| m.clone());
        let mut measurements = measured();
        assert!(!page(&measurements, &[], &[], "").into_string().contains("class=\"curve\""));
        let more = measurements.iter().filter_map(auto).map(|m| Measurement { budget: Some(4.0), instructions: m.instructions / 2, ..m });
        let one = measurements.iter().map(|m| Measurement { budget: auto(m).map(|_| 1.0), ..m.clone() });
        measurements = one.chain(more).collect();
        let text = page(&measurements, &[], &[], "").into_string();
        // Two methods, two scenes, two processors, two errors.
        assert_eq!(text.matches("class=\"curve\"").count(), 16);
        assert_eq!([">auto 1<", ">auto 4<", ">auto-linear 1<", ">auto-linear 4<"].map(|name| text.matches(name).count()), [8; 4]);
    }

    #[test]
    fn what_auto_chooses_is_shown() {
        assert!(!page(&measured(), &[], &[], "").into_string().contains("class=\"shares\""));
        let scene = scene::load(PEER).expect("a built-in scene");
        let told = choices::by::<Rgb565>(Shader::AUTO, scene.stream.parse().expect("a stream"), Size::new(320, 240), false, 0);
        let told = told.expect("a picture").expect("what auto chooses");
        let chosen = |m: Measurement| match m.shader {
            "auto" => Measurement { budget: Some(told.budget), choices: Some(told.choices), ..m },
            _ => m,
        };
        let text = page(&measured().into_iter().map(chosen).collect::<Vec<_>>(), &[], &[], "").into_string();
        // Two scenes, two processors, triangles and pixels.
        assert_eq!(text.matches("class=\"shares\"").count(), 8);
        assert_eq!(text.matches("<td data-value=\"4\">4</td>").count(), 4, "budgets of RGB565");
    }

    #[test]
    fn the_frame_of_the_peers_comes_first() {
        assert_eq!(scenes(&measured()), ["peer-sphere", "teapot"]);
    }

    #[test]
    fn nothing_is_fetched() {
        let text = page(&measured(), &[], &[], CHART).into_string();
        assert!(!text.contains("http://") && !text.contains("https://") && !text.contains(" src="));
    }
}
