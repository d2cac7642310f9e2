//! A table of all figures of a scene.

use super::Outcome;
use crate::Comparison;
use maud::{Markup, html};
use microphong_render::shader::Shader;

/// A column of numbers: heading, meaning, number of decimals, and value.
type Column = (&'static str, &'static str, usize, fn(&Comparison) -> f64);

/// The columns and the headings above them.
const GROUPS: [(&str, &[Column]); 6] = [
    (
        "error, LSB",
        &[
            ("max", "largest error of the integer picture", 2, |c| c.total.max),
            ("p99", "99 in 100 pixels are not worse", 2, |c| c.total.p99),
            ("rms", "root of the mean square", 3, |c| c.total.rmse),
        ],
    ),
    (
        "method, LSB",
        &[
            ("max", "largest error of the method in floating point", 2, |c| c.method.max),
            ("rms", "root of the mean square", 3, |c| c.method.rmse),
        ],
    ),
    ("arithmetic, LSB", &[("max", "largest difference of the integers from the method in floating point", 3, |c| c.arithmetic.max)]),
    (
        "8-bit picture",
        &[
            ("colour", "colour correctness (Vlasic 2002), 1 is the same", 4, |c| c.colour_correctness),
            ("PSNR, dB", "peak signal-to-noise ratio", 1, |c| c.psnr),
            ("alike", "structure and colour as the eye sees them, 1 is the same", 4, |c| c.similarity),
        ],
    ),
    (
        "across edges",
        &[
            ("jump, LSB", "largest jump of the level", 2, |c| c.jumps.level),
            ("slope, LSB/px", "largest jump of the slope: Mach bands", 2, |c| c.jumps.slope),
        ],
    ),
    (
        "operations",
        &[
            ("+", "additions per pixel", 0, |c| c.operations.adds.into()),
            ("×", "multiplications per pixel", 0, |c| c.operations.multiplies.into()),
            ("loads", "table look-ups per pixel", 0, |c| c.operations.loads.into()),
            ("set-up", "operations per triangle", 0, |c| c.operations.setup.into()),
            ("row", "operations per row of a triangle", 0, |c| c.operations.row.into()),
        ],
    ),
];

/// The table; names lead to their pictures.
pub(super) fn table(scene: &str, outcomes: &[Outcome<'_>], anchor: impl Fn(Shader) -> String) -> Markup {
    let width: usize = GROUPS.iter().map(|(_, columns)| columns.len()).sum();
    html! {
        p.facts {
            "Jumps are those of the method in floating point, across edges that two triangles share. Operations are counted by hand from the "
            "formulas, for one white directional light: per pixel, per triangle, per row of a triangle."
        }
        div.scroll tabindex="0" role="region" aria-label={ "Figures of " (scene) } {
            table.sortable {
                caption { "All methods on " (scene) }
                thead {
                    tr {
                        th rowspan="2" scope="col" data-sort="text" { "method" }
                        @for (heading, columns) in GROUPS { th.group colspan=(columns.len()) scope="colgroup" { (heading) } }
                    }
                    tr {
                        @for (_, columns) in GROUPS {
                            @for (index, (heading, meaning, _, _)) in columns.iter().enumerate() {
                                th.first[index == 0] scope="col" data-sort="number" title=(meaning) { (heading) }
                            }
                        }
                    }
                }
                tbody {
                    @for &(shader, result) in outcomes {
                        tr {
                            @match result {
                                Ok(comparison) => {
                                    th scope="row" { a href={ "#" (anchor(shader)) } { (shader.name()) } }
                                    @for (_, columns) in GROUPS {
                                        @for (index, (_, _, places, value)) in columns.iter().enumerate() {
                                            @let value = value(comparison);
                                            td.first[index == 0] data-value=(value) { @if value.is_finite() { (format!("{value:.places$}")) } @else { "∞" } }
                                        }
                                    }
                                }
                                Err(reason) => {
                                    th scope="row" { (shader.name()) }
                                    td.reason.first colspan=(width) { (reason) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
