//! Figures in rows.

use super::axis::short;
use crate::{
    Measurement, Processor,
    break_even::{AREAS, BreakEven, Costs, RATIOS, break_even, crossing},
    growth::{Point, Sweep},
    peers::table::{self, Table},
};
use maud::{Markup, html};
use microphong_compare::document::choices::{key, shares};
use microphong_render::shader::Shader;

/// The method that others are to be cheaper than.
const PHONG: &str = "phong";
/// The method that papers compare times with.
const GOURAUD: &str = "gouraud";

/// Pixels of 320 x 240.
const PICTURE: f64 = 76_800.0;

fn find<'m>(measurements: &[&'m Measurement], processor: Processor, shader: &str) -> Option<&'m Measurement> {
    measurements.iter().copied().find(|m| m.board == processor && m.shader == shader)
}

/// The area from which on a method is cheaper than per-pixel Phong shading, in words.
fn words(found: BreakEven) -> (String, Option<f64>) {
    match found {
        // Triangles of less than a twentieth of a pixel draw nothing.
        // Larger than the picture.
        BreakEven::From(area) if area > PICTURE => words(BreakEven::Never),
        BreakEven::Below(area) if area > PICTURE => words(BreakEven::Always),
        BreakEven::From(area) if area < 0.05 => words(BreakEven::Always),
        BreakEven::Below(area) if area < 0.05 => words(BreakEven::Never),
        BreakEven::Always => ("always".to_owned(), Some(0.0)),
        BreakEven::From(area) => (format!("{area:.1}"), Some(area)),
        BreakEven::Below(area) => (format!("below {area:.1}"), None),
        BreakEven::Never => ("never".to_owned(), None),
    }
}

/// The counted triangle size at which a method's curve crosses Phong's when a mesh is refined.
fn counted(points: &[Point], shader: &str) -> Option<String> {
    let curve = |name: &str| {
        let points = points.iter().filter(|p| p.sweep == Sweep::Triangles && p.shader.name() == name && p.triangles > 0);
        let mut curve: Vec<_> = points.map(|p| (p.pixels as f64 / p.amount as f64, p.instructions as f64 / p.pixels as f64)).collect();
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
        curve
    };
    let (method, phong) = (curve(shader), curve(PHONG));
    let (first, reference) = (method.first()?, phong.first()?);
    Some(match crossing(&method, &phong) {
        Some(area) => format!("{area:.1}"),
        None if first.1 < reference.1 => "always".to_owned(),
        None => "never".to_owned(),
    })
}

/// The size of triangles from which methods are cheaper than Phong shading.
pub(super) fn break_evens(measurements: &[&Measurement], processors: &[Processor], growth: &[Point]) -> Markup {
    let costs = |processor, shader| find(measurements, processor, shader).and_then(Costs::of);
    let methods: Vec<_> =
        Shader::ALL.into_iter().map(Shader::name).filter(|name| *name != PHONG && measurements.iter().any(|m| m.shader == *name)).collect();
    html! {
        div.scroll tabindex="0" role="region" aria-label="Break-even with Phong shading" {
            table.sortable.narrow {
                caption { "Break-even with Phong shading, pixels per triangle" }
                thead { tr {
                    th scope="col" data-sort="text" { "method" }
                    @for processor in processors { th scope="col" data-sort="number" { (processor.name()) } }
                    th.first scope="col" data-sort="number" title="where the curves of the plot cross" { "counted, x86-64" }
                    th.first scope="col" data-sort="number" { "paper" }
                } }
                tbody {
                    @for name in &methods {
                        tr {
                            th scope="row" { (name) }
                            @for &processor in processors {
                                @match costs(processor, name).zip(costs(processor, PHONG)) {
                                    Some((method, phong)) => {
                                        @let (text, value) = words(break_even(method, phong));
                                        td data-value=[value] { (text) }
                                    }
                                    None => { td {} }
                                }
                            }
                            @let found = counted(growth, name);
                            td.first data-value=[found.as_deref().map(|found| if found == "always" { "0" } else { found })] { (found.as_deref().unwrap_or("")) }
                            @match AREAS.iter().find(|(shader, ..)| shader == name) {
                                Some((_, area, source)) => { td.first data-value=(area) title=(source) { (area) " (" (source) ")" } }
                                None => { td.first {} }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Frames over Gouraud's, beside what papers print.
pub(super) fn ratios(measurements: &[&Measurement], processors: &[Processor]) -> Markup {
    let ratio = |processor, shader, of: fn(&Measurement) -> u64| {
        let [method, gouraud] = [shader, GOURAUD].map(|name| find(measurements, processor, name).map(of));
        Some(method? as f64 / gouraud.filter(|gouraud| *gouraud > 0)? as f64)
    };
    let cell = |ratio: Option<f64>| ratio.map_or(String::new(), |ratio| format!("{ratio:.2}"));
    html! {
        div.scroll tabindex="0" role="region" aria-label="Costs over Gouraud shading" {
            table.narrow {
                caption { "Costs over Gouraud shading" }
                thead {
                    tr {
                        th rowspan="2" scope="col" { "method" }
                        th rowspan="2" scope="col" { "paper" }
                        th.group colspan=(processors.len()) scope="colgroup" { "frame" }
                        th.group colspan=(processors.len()) scope="colgroup" { "inner loop" }
                    }
                    tr { @for _ in 0..2 { @for (index, processor) in processors.iter().enumerate() { th.first[index == 0] scope="col" { (processor.name()) } } } }
                }
                tbody {
                    @for printed in &RATIOS {
                        tr {
                            th scope="row" { (printed.shader) }
                            td { (format!("{:.2}", printed.ratio)) " " span.note { (printed.source) } }
                            @for (index, &processor) in processors.iter().enumerate() { td.first[index == 0] { (cell(ratio(processor, printed.shader, |m| m.instructions))) } }
                            @for (index, &processor) in processors.iter().enumerate() { td.first[index == 0] { (cell(ratio(processor, printed.shader, |m| m.by_stage.pixel))) } }
                        }
                    }
                }
            }
        }
    }
}

/// Other renderers beside ours.
pub(super) fn peers(table: &Table) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label={ "Beside other renderers, " (table.scene) } {
            table.sortable.narrow {
                caption { (table.scene) }
                thead { tr {
                    th scope="col" data-sort="text" { "renderer, method" }
                    @for processor in &table.processors { th scope="col" data-sort="number" { (processor.name()) } }
                    th.first scope="col" data-sort="text" {}
                } }
                tbody {
                    @for row in &table.rows {
                        tr {
                            th scope="row" { (row.name) }
                            @for figure in &row.figures { td data-value=[*figure] { @if let Some(figure) = figure { (table::short(*figure)) } } }
                            td.text.first { (row.note) }
                        }
                    }
                }
            }
        }
    }
}

/// A column: heading, meaning, value and number of decimals.
type Column = (&'static str, &'static str, usize, fn(&Measurement) -> Option<f64>);

/// The columns that are printed of a measurement.
const COLUMNS: [Column; 18] = [
    ("per pixel", "instructions per pixel", 2, |m| Some(m.instr_per_pixel)),
    ("max LSB", "largest error", 2, |m| m.max_lsb),
    ("rms LSB", "root mean square of errors", 3, |m| m.rmse_lsb),
    ("frame", "instructions of the frame, without clearing and transfer", 0, |m| Some(m.instructions as f64)),
    ("cycles", "cycles of the frame, approximate", 0, |m| m.cycles.map(|n| n as f64)),
    ("camera", "instructions once a frame", 0, |m| Some(m.by_stage.frame as f64)),
    ("vertex", "instructions for vertices", 0, |m| Some(m.by_stage.vertex as f64)),
    ("cull, bin", "instructions for culling and binning", 0, |m| Some(m.by_stage.cull as f64)),
    ("set-up", "instructions for setting up triangles", 0, |m| Some(m.by_stage.setup as f64)),
    ("span", "instructions for rows of triangles", 0, |m| Some(m.by_stage.span as f64)),
    ("pixel", "instructions in inner loops", 0, |m| Some(m.by_stage.pixel as f64)),
    ("clear", "instructions for clearing", 0, |m| Some(m.by_stage.clear as f64)),
    ("transfer", "instructions for the transfer to the display", 0, |m| Some(m.by_stage.transfer as f64)),
    ("triangles", "triangles drawn", 0, |m| Some(m.triangles as f64)),
    ("spans", "rows of triangles", 0, |m| Some(m.spans as f64)),
    ("pixels", "pixels drawn", 0, |m| Some(m.pixels as f64)),
    ("RAM", "bytes of variables and stack", 0, |m| m.ram_bytes.map(|n| n as f64)),
    ("flash", "bytes that nothing but the method needs", 0, |m| m.flash_bytes.map(|n| n as f64)),
];

/// Everything measured of a scene.
pub(super) fn measurements(scene: &str, measurements: &[&Measurement]) -> Markup {
    let chosen = measurements.iter().any(|m| m.choices.is_some());
    html! {
        @if chosen { (key()) }
        div.scroll tabindex="0" role="region" aria-label={ "Measurements of " (scene) } {
            table.sortable {
                caption { "All measurements of " (scene) }
                thead { tr {
                    th scope="col" data-sort="text" { "method" }
                    th scope="col" data-sort="text" { "processor" }
                    @for (heading, meaning, ..) in COLUMNS { th scope="col" data-sort="number" title=(meaning) { (heading) } }
                    @if chosen {
                        th scope="col" data-sort="number" title="how far a pixel may be off, in 1/255" { "budget" }
                        th.first title="triangles above, their pixels below, by what shades them" { "chosen" }
                    }
                } }
                tbody {
                    @for m in measurements {
                        tr data-method=(m.shader) {
                            th scope="row" { (m.shader) }
                            td.text { (m.cpu) }
                            @for (_, _, places, value) in COLUMNS {
                                @let value = value(m);
                                td data-value=[value] { @if let Some(value) = value { (number(value, places)) } }
                            }
                            @if chosen {
                                td data-value=[m.budget] { @if let Some(budget) = m.budget { (budget) } }
                                td.first { @if let Some(choices) = &m.choices { (shares(choices)) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Thousands from ten of them on.
fn number(value: f64, places: usize) -> String {
    if value >= 1e4 {
        format!("{:.0}\u{202f}k", value / 1e3)
    } else if places == 0 {
        short(value)
    } else {
        format!("{value:.places$}")
    }
}
