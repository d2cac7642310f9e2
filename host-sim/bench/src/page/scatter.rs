//! Run time against error: one panel for each processor.

use super::{
    axis::{Axis, short},
    label::{self, Named},
};
use crate::{Measurement, Processor, family::Family, pareto};
use maud::{Markup, html};
use microphong_render::shader::Shader;
use std::collections::BTreeMap;

/// A panel's size.
pub(super) const SIZE: (f64, f64) = (480.0, 380.0);
const LEFT: f64 = 44.0;
const RIGHT: f64 = 474.0;
const TOP: f64 = 22.0;
const BOTTOM: f64 = 344.0;

/// The error on the vertical axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Error {
    Rms,
    Max,
}

impl Error {
    pub(super) const ALL: [Self; 2] = [Self::Rms, Self::Max];

    /// CSS class of the error in a drawing.
    pub(super) const fn class(self) -> &'static str {
        match self {
            Self::Rms => "rms",
            Self::Max => "max",
        }
    }

    pub(super) const fn label(self) -> &'static str {
        match self {
            Self::Rms => "root mean square error, LSB",
            Self::Max => "largest error, LSB",
        }
    }

    fn of(self, m: &Measurement) -> Option<f64> {
        match self {
            Self::Rms => m.rmse_lsb,
            Self::Max => m.max_lsb,
        }
    }
}

/// A method's place.
struct Point<'m> {
    measurement: &'m Measurement,
    family: Family,
    error: f64,
    /// The method's name, and its error budget if it was measured with several.
    name: String,
}

/// Axes that all panels of a scene share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    error: Error,
    x: Axis,
    y: Axis,
}

impl Axes {
    pub(super) fn new(measurements: &[&Measurement], error: Error) -> Self {
        let x = Axis::logarithmic(measurements.iter().filter_map(|m| error.of(m)), [LEFT, RIGHT]);
        let y = Axis::logarithmic(measurements.iter().map(|m| m.instr_per_pixel), [BOTTOM, TOP]);
        Self { error, x, y }
    }

    fn points<'m>(&self, measurements: &[&'m Measurement]) -> Vec<Point<'m>> {
        let point = |m: &&'m Measurement| {
            let shader = Shader::ALL.into_iter().find(|shader| shader.name() == m.shader)?;
            let error = self.error.of(m).filter(|error| *error > 0.0)?;
            let several = measurements.iter().filter(|other| other.shader == m.shader).count() > 1;
            let name = match m.budget {
                Some(budget) if several => format!("{} {budget}", m.shader),
                _ => m.shader.to_owned(),
            };
            Some(Point { measurement: m, family: Family::of(shader), error, name })
        };
        measurements.iter().filter_map(point).collect()
    }
}

/// The panel of one processor, as an `svg` element of class `chart`.
pub(super) fn panel(processor: Processor, measurements: &[&Measurement], axes: &Axes) -> Markup {
    let label = format!("Instructions per pixel of each method on {} against its {}", processor.name(), axes.error.label());
    html! {
        svg.chart viewBox={ "0 0 " (SIZE.0) " " (SIZE.1) } role="img" aria-label=(label) { (drawing(processor, measurements, axes)) }
    }
}

/// Contents of a panel.
pub(super) fn drawing(processor: Processor, measurements: &[&Measurement], axes: &Axes) -> Markup {
    let Axes { error, x, y } = *axes;
    let points = axes.points(measurements);
    let front = pareto::front(&points.iter().map(|p| (p.measurement.instr_per_pixel, p.error)).collect::<Vec<_>>());
    // Those at the front choose first where their names go.
    let order = || front.iter().copied().chain((0..points.len()).filter(|index| !front.contains(index)));
    let place = |p: &Point<'_>| (x.at(p.error), y.at(p.measurement.instr_per_pixel));
    let named = |index| {
        let point: &Point<'_> = points.get(index)?;
        Some(Named { at: place(point), name: &point.name, bold: front.contains(&index) })
    };
    let names: Vec<_> = order().filter_map(named).collect();
    let stairs = stairs(&front.iter().filter_map(|&i| points.get(i)).map(place).collect::<Vec<_>>());
    // A curve for each method that is measured by several budgets.
    let mut curves: BTreeMap<&str, Vec<_>> = BTreeMap::new();
    for point in points.iter().filter(|point| point.name != point.measurement.shader) {
        curves.entry(point.measurement.shader).or_default().push(place(point));
    }
    // From left to right, whatever the order of the budgets.
    curves.values_mut().for_each(|curve| curve.sort_by(|(one, _), (other, _)| one.total_cmp(other)));
    let steps: Vec<[(f64, f64); 2]> = stairs.array_windows().copied().collect();
    let labels = label::place(&names, &steps, [LEFT + 2.0, TOP, SIZE.0, BOTTOM - 2.0]);
    html! {
        text.title x=(LEFT) y="11" { (processor.name()) }
        (y.grid(LEFT, RIGHT))
        @for tick in x.ticks() {
            @let at = format!("{:.1}", x.at(tick));
            line.grid x1=(at) x2=(at) y1=(TOP) y2=(BOTTOM) {}
            text x=(at) y=(BOTTOM + 15.0) text-anchor="middle" { (short(tick)) }
        }
        text x=(RIGHT) y="11" text-anchor="end" { "instructions per pixel" }
        text x=((LEFT + RIGHT) / 2.0) y=(SIZE.1 - 4.0) text-anchor="middle" { (error.label()) }
        polyline.front points=(line(&stairs)) {}
        @for curve in curves.values() {
            polyline.curve points=(line(curve)) {}
        }
        @for (index, label) in order().zip(&labels) {
            @if let Some(point) = points.get(index) {
                @let (px, py) = place(point);
                @let m = point.measurement;
                g class={ "point " (point.family.class()) @if front.contains(&index) { " best" } } data-method=(m.shader) {
                    title { (tip(m)) }
                    @if let Some((lx, ly)) = label.leader {
                        line.leader x1=(format!("{px:.1}")) y1=(format!("{py:.1}")) x2=(format!("{lx:.1}")) y2=(format!("{ly:.1}")) {}
                    }
                    circle cx=(format!("{px:.1}")) cy=(format!("{py:.1}")) r="3.6" {}
                    text x=(format!("{:.1}", label.text.0)) y=(format!("{:.1}", label.text.1)) text-anchor=(label.anchor) { (point.name) }
                }
            }
        }
    }
}

/// Points of a `polyline`.
fn line(points: &[(f64, f64)]) -> String {
    points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" ")
}

/// The front as the corners of steps: each point is as exact as it gets until the next one can be paid for.
fn stairs(front: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let corners = front.array_windows().flat_map(|&[from, to]| [from, (from.0, to.1)]);
    corners.chain(front.last().copied()).collect()
}

fn tip(m: &Measurement) -> String {
    let error = |error: Option<f64>| error.map_or("not measured".to_owned(), |error| format!("{error:.2} LSB"));
    format!(
        "{}: {} instructions per pixel, {} of the frame; error {} root mean square, {} at most",
        m.shader,
        m.instr_per_pixel,
        short(m.instructions as f64),
        error(m.rmse_lsb),
        error(m.max_lsb)
    )
}

#[cfg(test)]
mod tests {
    use super::stairs;

    #[test]
    fn the_front_goes_in_steps() {
        let steps = [(90.0, 300.0), (90.0, 200.0), (50.0, 200.0), (50.0, 20.0), (10.0, 20.0)];
        assert_eq!(stairs(&[steps[0], steps[2], steps[4]]), steps);
        assert_eq!(stairs(&[]), []);
    }
}
