//! Plots of the growth of costs, one for each quantity.

use super::axis::{Axis, short};
use crate::{
    family::Family,
    growth::{Point, Sweep},
};
use maud::{Markup, html};
use microphong_render::shader::Shader;

const SIZE: (f64, f64) = (480.0, 300.0);
const LEFT: f64 = 44.0;
/// Right end of the lines. Names stand to the right of it.
const RIGHT: f64 = 408.0;
const TOP: f64 = 22.0;
const BOTTOM: f64 = 264.0;
/// Least distance of two names.
const NAME: f64 = 11.0;
/// Largest cost of 24 bands, relative to one.
pub(super) const BANDS: f64 = 1.15;

/// The titles of the vertical and the horizontal axis.
fn figure(sweep: Sweep) -> (&'static str, &'static str) {
    match sweep {
        Sweep::Triangles => ("instructions per frame", "triangles on 40,000 pixels"),
        Sweep::Pixels => ("instructions per frame", "pixels of 512 triangles"),
        Sweep::Lights => ("instructions per frame", "directional lights"),
        Sweep::Bands => ("times one band", "bands, peer-sphere"),
    }
}

/// The plot of a sweep; nothing if it has not been counted.
pub(super) fn plot(sweep: Sweep, points: &[Point]) -> Markup {
    let mut lines: Vec<(Shader, Vec<(f64, f64)>)> = Vec::new();
    for point in points.iter().filter(|point| point.sweep == sweep) {
        let index = lines.iter().position(|(shader, _)| *shader == point.shader).unwrap_or_else(|| {
            lines.push((point.shader, Vec::new()));
            lines.len() - 1
        });
        if let Some((_, line)) = lines.get_mut(index) {
            line.push((point.amount as f64, point.instructions as f64));
        }
    }
    if sweep == Sweep::Bands {
        for (_, line) in &mut lines {
            let one = line.first().map_or(1.0, |(_, one)| *one);
            line.iter_mut().for_each(|(_, value)| *value /= one);
        }
    }
    if lines.is_empty() {
        return html! {};
    }
    let all = || lines.iter().flat_map(|(_, line)| line.iter().copied());
    let (what, across) = figure(sweep);
    let (x, y) = match sweep {
        Sweep::Triangles | Sweep::Pixels => {
            (Axis::logarithmic(all().map(|p| p.0), [LEFT, RIGHT]), Axis::logarithmic(all().map(|p| p.1), [BOTTOM, TOP]))
        }
        Sweep::Lights | Sweep::Bands => {
            let most = |of: fn((f64, f64)) -> f64| all().map(of).fold(0.0, f64::max);
            let low = if sweep == Sweep::Bands { 1.0 } else { 0.0 };
            let high = most(|p| p.1).max(if sweep == Sweep::Bands { BANDS } else { 0.0 });
            (Axis::linear([0.0, most(|p| p.0)], [LEFT, RIGHT]), Axis::linear([low, high + (high - low) * 0.04], [BOTTOM, TOP]))
        }
    };
    html! {
        svg.chart viewBox={ "0 0 " (SIZE.0) " " (SIZE.1) } role="img" aria-label={ (what) " over " (across) } {
            text.title x=(LEFT) y="11" { (sweep) }
            text x=(RIGHT) y="11" text-anchor="end" { (what) }
            (y.grid(LEFT, RIGHT))
            @for tick in x.ticks() {
                @let at = format!("{:.1}", x.at(tick));
                line.axis x1=(at) x2=(at) y1=(BOTTOM) y2=(BOTTOM + 4.0) {}
                text x=(at) y=(BOTTOM + 17.0) text-anchor="middle" { (short(tick)) }
            }
            text x=((LEFT + RIGHT) / 2.0) y=(SIZE.1 - 3.0) text-anchor="middle" { (across) }
            @if sweep == Sweep::Bands {
                @let at = format!("{:.1}", y.at(BANDS));
                line.limit x1=(LEFT) x2=(RIGHT) y1=(at) y2=(at) {}
                text x=(RIGHT - 4.0) y=(format!("{:.1}", y.at(BANDS) + 12.0)) text-anchor="end" { "limit of 24 bands, 1.15" }
            }
            @for ((shader, line), name) in lines.iter().zip(spread(&lines.iter().map(|(_, line)| line.last().map_or(0.0, |p| y.at(p.1))).collect::<Vec<_>>())) {
                g class={ "line " (Family::of(*shader).class()) } data-method=(shader.name()) {
                    path d=(path(line, &x, &y)) {}
                    @for (amount, value) in line {
                        circle cx=(format!("{:.1}", x.at(*amount))) cy=(format!("{:.1}", y.at(*value))) r="2" {
                            title { (shader.name()) ", " (short(*amount)) " " (sweep) ": " (short(*value)) " " (what) }
                        }
                    }
                    text x=(RIGHT + 7.0) y=(format!("{:.1}", name + 3.8)) { (shader.name()) }
                }
            }
        }
    }
}

fn path(line: &[(f64, f64)], x: &Axis, y: &Axis) -> String {
    let pens = std::iter::once('M').chain(std::iter::repeat('L'));
    line.iter().zip(pens).map(|((amount, value), pen)| format!("{pen}{:.1} {:.1}", x.at(*amount), y.at(*value))).collect()
}

/// Heights of names, as close to the wanted ones as possible without overlap.
fn spread(wanted: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&a, &b| wanted[a].total_cmp(&wanted[b]));
    let mut heights = wanted.to_vec();
    // Names that touch move apart about their middle; a few rounds settle it.
    for _ in 0..4 * wanted.len() {
        for pair in order.array_windows::<2>() {
            let [above, below] = *pair;
            let missing = NAME - (heights[below] - heights[above]);
            if missing > 0.0 {
                heights[above] -= missing / 2.0;
                heights[below] += missing / 2.0;
            }
        }
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_move_apart_and_no_further_than_needed() {
        let heights = spread(&[100.0, 200.0, 101.0, 99.0]);
        assert!((heights[1] - 200.0).abs() < 1e-9);
        let near = [heights[3], heights[0], heights[2]];
        assert!(near.array_windows().all(|[a, b]| b - a > NAME - 0.5 && b - a < NAME + 0.5), "{near:?}");
    }
}
