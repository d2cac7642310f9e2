//! Break-even points: the size of triangles from which a method is cheaper than another.
//!
//! One counted frame gives the costs of a triangle (vertices, culling, set-up), of a span and of a pixel. It also gives the number of spans of
//! triangles of its shape: s · √a if they have a pixels. A frame of other triangles of this shape then takes t + r s √a + p a instructions a
//! triangle, and break-even is a root of a quadratic in √a.

use super::Measurement;
use serde::Serialize;

/// Costs of the parts of one method's frame, in instructions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// Per triangle drawn, with its share of camera, vertices and triangles not drawn.
    pub triangle: f64,
    /// Per span, times the spans of a triangle of one pixel.
    pub span: f64,
    /// Per pixel.
    pub pixel: f64,
}

impl Costs {
    /// Costs of a measured frame; `None` if it is empty.
    #[must_use]
    pub fn of(frame: &Measurement) -> Option<Self> {
        let [triangles, pixels] = [frame.triangles, frame.pixels].map(|n| n as f64);
        let stages = frame.by_stage;
        (frame.triangles > 0 && frame.pixels > 0).then(|| Self {
            triangle: (stages.frame + stages.vertex + stages.cull + stages.setup) as f64 / triangles,
            span: stages.span as f64 / (triangles * pixels).sqrt(),
            pixel: stages.pixel as f64 / pixels,
        })
    }

    /// Instructions of a triangle of `area` pixels.
    #[must_use]
    pub fn at(&self, area: f64) -> f64 {
        self.triangle + self.span * area.sqrt() + self.pixel * area
    }
}

/// Area in pixels from which a method is cheaper than another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BreakEven {
    /// Whatever the size.
    Always,
    /// The method is cheaper from this area on.
    From(f64),
    /// Only below this area.
    Below(f64),
    /// The method is cheaper at no size, or only at some sizes in between.
    Never,
}

/// When `method` is cheaper than `other`.
#[must_use]
pub fn break_even(method: Costs, other: Costs) -> BreakEven {
    // c + b x + a x², x the root of the area: what the method costs more.
    let [c, b, a] = [method.triangle - other.triangle, method.span - other.span, method.pixel - other.pixel];
    let more = |x: f64| c + b * x + a * x * x;
    let mut roots: Vec<f64> = roots(a, b, c).into_iter().filter(|x| x.is_finite() && *x > 0.0).collect();
    roots.sort_by(f64::total_cmp);
    // The sign beyond the last root and before the first.
    let cheaper = |x: f64| more(x) < 0.0;
    match roots[..] {
        [] => {
            if cheaper(1.0) {
                BreakEven::Always
            } else {
                BreakEven::Never
            }
        }
        [.., last] if cheaper(2.0 * last) => BreakEven::From(last * last),
        [first] if cheaper(first / 2.0) => BreakEven::Below(first * first),
        _ => BreakEven::Never,
    }
}

/// Real roots of `a x² + b x + c`.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    if a == 0.0 {
        return vec![-c / b];
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return Vec::new();
    }
    // Without cancellation.
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    vec![q / a, c / q]
}

/// The area at which two counted curves cross, from (area, instructions per pixel) in order of area: the last crossing from
/// dearer to cheaper, on straight lines between logarithms.
#[must_use]
pub fn crossing(method: &[(f64, f64)], other: &[(f64, f64)]) -> Option<f64> {
    let more: Vec<(f64, f64)> = method.iter().zip(other).map(|(m, o)| (m.0.ln(), (m.1 / o.1).ln())).collect();
    more.array_windows().rev().find(|[a, b]| a.1 >= 0.0 && b.1 < 0.0).map(|[a, b]| (a.0 + (b.0 - a.0) * a.1 / (a.1 - b.1)).exp())
}

/// A figure of a paper that ours stands beside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printed {
    /// Our name of the method.
    pub shader: &'static str,
    /// Cost of a frame over Gouraud's.
    pub ratio: f64,
    /// The publication with this figure.
    pub source: &'static str,
}

/// Published times of frames, divided by the time of Gouraud shading.
pub const RATIOS: [Printed; 6] = [
    Printed { shader: "taylor", ratio: 1.89, source: "Bishop & Weimer 1986, distant eye" },
    Printed { shader: "taylor-finite", ratio: 2.09, source: "Bishop & Weimer 1986, near eye" },
    Printed { shader: "duff", ratio: 6.40, source: "Bishop & Weimer 1986" },
    Printed { shader: "phong", ratio: 9.61, source: "Bishop & Weimer 1986" },
    Printed { shader: "six-point", ratio: 1.09, source: "Szirmay-Kalos et al., 250 ms : 230 ms" },
    Printed { shader: "phong", ratio: 1.96, source: "Szirmay-Kalos et al., 450 ms : 230 ms" },
];

/// Areas from which on the papers' methods are cheaper than Phong shading.
pub const AREAS: [(&str, f64, &str); 3] =
    [("taylor", 10.0, "Bishop & Weimer 1986"), ("angular", 23.0, "Disselkoen 1991"), ("hybrid", 23.0, "Disselkoen 1991")];

#[cfg(test)]
mod tests {
    use super::*;

    const PHONG: Costs = Costs { triangle: 500.0, span: 80.0, pixel: 50.0 };

    fn costs(triangle: f64, span: f64, pixel: f64) -> Costs {
        Costs { triangle, span, pixel }
    }

    #[test]
    fn dearer_set_up_and_cheaper_pixels() {
        // 300 more per triangle, 30 less per pixel: ten pixels.
        let BreakEven::From(ten) = break_even(costs(800.0, 80.0, 20.0), PHONG) else { panic!("there is a break-even") };
        assert!((ten - 10.0).abs() < 1e-9, "{ten}");
        let method = costs(900.0, 100.0, 15.0);
        let BreakEven::From(area) = break_even(method, PHONG) else { panic!("there is a break-even") };
        assert!((method.at(area) - PHONG.at(area)).abs() < 1e-9, "{area}");
        assert!(method.at(area * 1.01) < PHONG.at(area * 1.01));
    }

    #[test]
    fn always_never_and_below() {
        assert_eq!(break_even(costs(400.0, 60.0, 20.0), PHONG), BreakEven::Always);
        assert_eq!(break_even(costs(600.0, 90.0, 50.0), PHONG), BreakEven::Never);
        assert_eq!(break_even(costs(600.0, 90.0, 60.0), PHONG), BreakEven::Never);
        assert_eq!(break_even(costs(100.0, 80.0, 54.0), PHONG), BreakEven::Below(100.0));
        // Linear: 100 more per triangle, 10 less per span.
        assert_eq!(break_even(costs(600.0, 70.0, 50.0), PHONG), BreakEven::From(100.0));
        assert_eq!(break_even(PHONG, PHONG), BreakEven::Never);
    }

    #[test]
    fn curves_cross_where_they_are_equal() {
        let areas = [1.0, 4.0, 16.0, 64.0];
        let curve = |costs: Costs| areas.map(|area| (area, costs.at(area) / area));
        let method = costs(800.0, 80.0, 20.0);
        let found = crossing(&curve(method), &curve(PHONG)).expect("a crossing");
        assert!((found / 10.0 - 1.0).abs() < 0.15, "{found}");
        assert_eq!(crossing(&curve(PHONG), &curve(method)), None);
    }
}
