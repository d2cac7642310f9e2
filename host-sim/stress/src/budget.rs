//! The method that keeps to an error budget against Phong shading in 64-bit floating point, on every pixel.

use crate::{
    Family, Verdict, arithmetic,
    case::Case,
    random::Random,
    scenes::{self, Wishes},
};
use microphong::format::ErrorBudget;
use microphong_render::{render::Style, shader::Shader};

/// Random scenes, by `auto` with a random budget.
pub struct Budget;

/// What arithmetic may add to the budget, in 1/255.
pub const ARITHMETIC: f64 = arithmetic::LIMIT;

impl Family for Budget {
    fn name(&self) -> &'static str {
        "budget"
    }

    fn about(&self) -> &'static str {
        "auto is off from Phong shading by no more than its budget"
    }

    fn limit(&self) -> Option<(f64, &'static str)> {
        Some((ARITHMETIC, "of 255 beyond the budget"))
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let wishes = Wishes { closed: false, unclipped: true, triangles: 200 };
        let Some(case) = scenes::case(random, wishes) else { return Verdict::skipped() };
        let budget = ErrorBudget::from_num(random.octaves(0.5, 16.0));
        let style = Style { shader: Shader::AUTO, antialias: false, dither: false, ..case.style };
        let case = Case { style, stream: case.stream.with_budget(budget), ..case };
        match excess(&case) {
            Some(error) => Verdict::of(error, ARITHMETIC, Some(case)),
            None => Verdict::skipped(),
        }
    }

    fn fails(&self, case: &Case) -> bool {
        excess(case).is_some_and(|error| error > ARITHMETIC)
    }
}

/// How much more than its budget a frame is off, in 1/255; `None` if the oracle cannot tell.
fn excess(case: &Case) -> Option<f64> {
    let budget = f64::from(case.stream.parse().ok()?.header.budget());
    Some((arithmetic::excess_over(case, Shader::PHONG)? - budget).max(0.0))
}
