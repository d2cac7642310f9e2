//! Axes of charts.

use maud::{Markup, html};

/// Room that a number takes.
const WIDTH: f64 = 38.0;
const HEIGHT: f64 = 13.0;

/// An axis of a drawing, which converts values to places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// First and last value.
    pub(super) from: [f64; 2],
    /// The two ends of the axis in the drawing.
    pub(super) to: [f64; 2],
    pub(super) logarithmic: bool,
}

impl Axis {
    /// A logarithmic axis for these values, with some room at both ends.
    pub(super) fn logarithmic(values: impl Iterator<Item = f64>, to: [f64; 2]) -> Self {
        let [low, high] = values.filter(|value| *value > 0.0).fold([f64::MAX, 0.0], |[low, high], v| [v.min(low), v.max(high)]);
        let [low, high] = if low > high { [1.0, 10.0] } else { [low, high] };
        let room = (high / low).powf(0.06).max(1.1);
        Self { from: [low / room, high * room], to, logarithmic: true }
    }

    pub(super) fn linear(from: [f64; 2], to: [f64; 2]) -> Self {
        Self { from, to, logarithmic: false }
    }

    pub(super) fn at(&self, value: f64) -> f64 {
        let scale = |v: f64| if self.logarithmic { v.max(f64::MIN_POSITIVE).ln() } else { v };
        let [low, high] = self.from.map(scale);
        self.to[0] + (scale(value) - low) / (high - low) * (self.to[1] - self.to[0])
    }

    /// Lines across the drawing at the ticks of a vertical axis, from column `left` to `right`, and their values.
    pub(super) fn grid(&self, left: f64, right: f64) -> Markup {
        html! {
            @for tick in self.ticks() {
                @let at = format!("{:.1}", self.at(tick));
                line.grid x1=(left) x2=(right) y1=(at) y2=(at) {}
                text x=(left - 6.0) y=(format!("{:.1}", self.at(tick) + 3.8)) text-anchor="end" { (short(tick)) }
            }
        }
    }

    /// Round values on the axis: 1, 2 and 5 in each decade, 1 alone where they would touch; about five of them if it is linear.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.from;
        let inside = |value: &f64| (low * 0.999_999..=high * 1.000_001).contains(value);
        if self.logarithmic {
            let across = self.to[1] > self.to[0];
            let doubling = (self.at(2.0 * low) - self.at(low)).abs();
            let steps: &[f64] = if doubling < if across { WIDTH } else { HEIGHT } { &[1.0] } else { &[1.0, 2.0, 5.0] };
            let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
            return powers.flat_map(|power| steps.iter().map(move |step| step * 10f64.powi(power))).filter(inside).collect();
        }
        let rough = (high - low) / 5.0;
        let ten = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * ten).find(|s| *s >= rough).unwrap_or(rough);
        (0..).map(|i| ((low / step).ceil() + f64::from(i)) * step).take_while(|value| *value <= high * 1.000_001).collect()
    }
}

/// 0.5, 20, 3,000, 40 k, 2 M.
pub(super) fn short(value: f64) -> String {
    let (value, unit) = match value.abs() {
        v if v >= 0.9999e6 => (value / 1e6, "\u{202f}M"),
        v if v >= 0.9999e3 => (value / 1e3, "\u{202f}k"),
        _ => (value, ""),
    };
    let text = format!("{value:.2}");
    format!("{}{unit}", text.trim_end_matches('0').trim_end_matches('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_where_they_belong() {
        let axis = Axis { from: [1.0, 100.0], to: [0.0, 400.0], logarithmic: true };
        assert!((axis.at(10.0) - 200.0).abs() < 1e-9);
        let text = |axis: Axis| axis.ticks().into_iter().map(short).collect::<Vec<_>>();
        assert_eq!(text(axis), ["1", "2", "5", "10", "20", "50", "100"]);
        assert_eq!(text(Axis { to: [0.0, 200.0], ..axis }), ["1", "10", "100"], "no room for more");
        let axis = Axis::linear([1.0, 1.6], [200.0, 0.0]);
        assert!((axis.at(1.6)).abs() < 1e-9);
        assert_eq!(text(axis), ["1", "1.2", "1.4", "1.6"]);
    }

    #[test]
    fn numbers_are_short() {
        let text = [0.28, 0.5, 20.0, 3000.0, 40_000.0, 1_500_000.0].map(short);
        assert_eq!(text, ["0.28", "0.5", "20", "3\u{202f}k", "40\u{202f}k", "1.5\u{202f}M"]);
    }
}
