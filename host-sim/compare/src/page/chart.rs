//! A chart of one row: its levels over those of Phong shading, and below the error.

use crate::{Comparison, Reference};
use maud::{Markup, html};

/// The drawing's size.
const SIZE: (f64, f64) = (300.0, 290.0);
/// Left and right end of both plots.
const ACROSS: [f64; 2] = [36.0, 296.0];
/// Bottom and top of the plot of levels.
const LEVELS: [f64; 2] = [170.0, 22.0];
/// Bottom and top of the plot of errors.
const ERRORS: [f64; 2] = [256.0, 198.0];

/// A linear scale.
struct Scale {
    from: [f64; 2],
    to: [f64; 2],
}

impl Scale {
    fn at(&self, value: f64) -> f64 {
        let [low, high] = self.from;
        self.to[0] + (value - low) / (high - low) * (self.to[1] - self.to[0])
    }
}

/// 1, 2 or 5 times a power of ten, at least `value`.
fn round_up(value: f64) -> f64 {
    let ten = 10f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * ten).find(|&step| step >= value * 0.999_999).unwrap_or(10.0 * ten)
}

/// A number with a proper minus sign.
pub(super) fn signed(value: f64, places: usize) -> String {
    let minus = if value < 0.0 { "−" } else { "" };
    format!("{minus}{:.places$}", value.abs())
}

/// A line through all values; broken where there is none.
fn path(columns: std::ops::Range<u32>, x: &Scale, y: &Scale, value: impl Fn(u32) -> Option<f64>) -> String {
    let mut path = String::new();
    let mut pen = 'M';
    for column in columns {
        match value(column).filter(|value| value.is_finite()) {
            Some(value) => {
                path.push_str(&format!("{pen}{:.1} {:.1}", x.at(f64::from(column) + 0.5), y.at(value)));
                pen = 'L';
            }
            None => pen = 'M',
        }
    }
    path
}

/// The row through the highlight.
pub(super) fn scanline(reference: &Reference<'_>, comparison: &Comparison) -> Markup {
    let name = comparison.shader.name();
    let (width, _) = reference.size();
    let row = reference.row();
    let columns = reference.window().columns.clone();
    let at = |column: u32| row as usize * width as usize + column as usize;
    let error = |column| comparison.errors.get(at(column)).copied().flatten();
    let largest = columns.clone().filter_map(error).map(f64::abs).fold(0.0, f64::max);
    let range = round_up(largest.max(0.01));
    let places = (-range.log10().floor()).max(0.0) as usize;
    let x = Scale { from: [columns.start, columns.end].map(f64::from), to: ACROSS };
    let levels = Scale { from: [0.0, 255.0], to: LEVELS };
    let errors = Scale { from: [-range, range], to: ERRORS };
    let step = round_up(f64::from(columns.end - columns.start) / 5.0).max(1.0);
    let ticks = (0..).map(|i| (f64::from(columns.start) / step).ceil() * step + step * f64::from(i)).take_while(|&tick| tick <= x.from[1]);
    let label = format!("Levels of {name} and of Phong shading along row {row}; the error is at most {}", super::number(largest));
    html! {
        svg.chart viewBox={ "0 0 " (SIZE.0) " " (SIZE.1) } role="img" aria-label=(label) {
            text x="2" y="10" { "level, LSB" }
            line.reference x1="88" x2="104" y1="6.5" y2="6.5" {}
            text x="108" y="10" { "Phong" }
            line.curve x1="152" x2="168" y1="6.5" y2="6.5" {}
            text x="172" y="10" { (name) }
            @for level in [0.0, 64.0, 128.0, 192.0, 255.0] { (grid(levels.at(level), &signed(level, 0))) }
            path.reference d=(path(columns.clone(), &x, &levels, |column| reference.level(column, row))) {}
            path.curve d=(path(columns.clone(), &x, &levels, |column| comparison.levels.get(at(column)).copied().flatten())) {}
            text x="2" y="189" { "error, LSB" }
            @for error in [-range, 0.0, range] { (grid(errors.at(error), &signed(error, if error == 0.0 { 0 } else { places }))) }
            path.curve d=(path(columns.clone(), &x, &errors, error)) {}
            @for tick in ticks {
                @let place = format!("{:.1}", x.at(tick));
                line.axis x1=(place) x2=(place) y1=(ERRORS[0]) y2=(ERRORS[0] + 4.0) {}
                text x=(place) y="271" text-anchor="middle" { (signed(tick, 0)) }
            }
            text x=((ACROSS[0] + ACROSS[1]) / 2.0) y="286" text-anchor="middle" { "column, pixels" }
        }
    }
}

/// A line across, and its value at the left.
fn grid(y: f64, value: &str) -> Markup {
    html! {
        line.grid x1=(ACROSS[0]) x2=(ACROSS[1]) y1=(format!("{y:.1}")) y2=(format!("{y:.1}")) {}
        text x=(ACROSS[0] - 5.0) y=(format!("{:.1}", y + 3.5)) text-anchor="end" { (value) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_numbers() {
        for (value, expected) in [(0.01, 0.01), (0.011, 0.02), (0.3, 0.5), (1.0, 1.0), (7.0, 10.0), (130.0, 200.0)] {
            assert!((round_up(value) - expected).abs() < 1e-9, "{value}");
        }
    }

    #[test]
    fn lines_break_at_gaps() {
        let scale = Scale { from: [0.0, 1.0], to: [0.0, 1.0] };
        let path = path(0..4, &scale, &scale, |column| (column != 2).then_some(1.0));
        assert_eq!(path, "M0.5 1.0L1.5 1.0M3.5 1.0");
    }
}
