//! The method that keeps to an error budget against Phong shading in 64-bit floating point, on every pixel.

use crate::{
    Family, Verdict, arithmetic,
    case::Case,
    random::Random,
    scenes::{self, Hard, Wishes},
    tiles,
};
use embedded_graphics_core::geometry::Size;
use microphong::format::ErrorBudget;
use microphong_compare::{
    UNDECIDED,
    level::{self, Walked},
};
use microphong_models::vector::length;
use microphong_oracle::{Frame, Shade, phong};
use microphong_render::{render::Style, shader::Shader};
use std::collections::HashMap;

/// Random scenes, by `auto` with this budget, or random ones.
pub struct Budget(pub Option<ErrorBudget>);

/// The largest error that is allowed under this number of lights, in 1/255: the budget, plus the error that arithmetic may add to Phong shading.
fn allowed(budget: f64, lights: usize) -> f64 {
    budget + arithmetic::LIMIT + arithmetic::PER_LIGHT * lights.saturating_sub(1) as f64
}

/// Length of interpolated normals below which `auto` is compared with the core's own Phong shading, for the shorter they are, the more rounding
/// decides where they point. Where `auto` may choose anything else, no two normals are more than 60 degrees apart, and none in between is
/// shorter than 0.816.
pub const SHORT: f64 = 0.8;

impl Family for Budget {
    fn name(&self) -> &'static str {
        "budget"
    }

    fn about(&self) -> &'static str {
        "auto differs from Phong shading by no more than its budget"
    }

    fn limit(&self) -> Option<(f64, &'static str)> {
        Some((1.0, "of the budget and 0.5 of 255, and 0.1 for each light beyond the first"))
    }

    fn counts(&self) -> &'static [&'static str] {
        &["triangles", "of them not by phong"]
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let Some(case) = case(random) else { return Verdict::skipped() };
        let budget = ErrorBudget::from_num(random.octaves(0.5, 16.0));
        let case = Case { stream: case.stream.with_budget(self.0.unwrap_or(budget)), ..case };
        match judge(&case) {
            Some(found) => Verdict { counts: vec![found.triangles, found.cheaper], ..Verdict::of(found.share, 1.0, Some(case)) },
            None => Verdict::skipped(),
        }
    }

    fn fails(&self, case: &Case) -> bool {
        judge(case).is_some_and(|found| found.share > 1.0)
    }
}

/// Triangles side by side, or a scene of any kind that fills its picture; `None` if it would not make a valid stream.
pub fn case(random: &mut Random) -> Option<Case> {
    let case = if random.once_in(8) {
        scenes::case(random, Wishes { closed: false, unclipped: true, triangles: 200, hard: Hard::default() })
    } else {
        tiles::case(random, Hard::default())
    }?;
    Some(Case { style: Style { shader: Shader::AUTO, antialias: false, dither: false, ..case.style }, ..case })
}

/// The result of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The largest error, as a share of the one that is allowed. It is infinite where coverage differs, or where `auto` has to be `phong` and is not.
    pub share: f64,
    /// The largest error, in 1/255.
    pub error: f64,
    /// Triangles of which a pixel was judged.
    pub triangles: u64,
    /// Judged triangles that `auto` draws otherwise than `phong`.
    pub cheaper: u64,
}

/// Compares a frame by `auto` with Phong shading. Where normals are [`SHORT`], it has to be what the core's `phong` draws. What `phong` draws under near
/// lights or for a near viewer is right, because the family of arithmetic judges it. `None` if the frame cannot be drawn.
#[must_use]
pub fn judge(case: &Case) -> Option<Found> {
    let (stream, [width, height], number) = (case.stream.parse().ok()?, case.size, case.frame);
    let of = if case.style.perspective_correct { Frame::perspective_correct } else { Frame::new };
    let frame = of(stream, (width, height), number);
    let picture = |shader| level::picture(stream, Size::new(width, height), Style { shader, ..case.style }, number).ok();
    let (drawn, by_phong) = (picture(case.style.shader)?, picture(Shader::PHONG)?);
    let right = allowed(level::budget(&stream), frame.lights.len());
    let walked = Walked::of(&stream, case.style.shader.facts());
    let mut shades: HashMap<u32, (Shade<'_>, bool)> = HashMap::new();
    let mut worst = 0f64;
    for (pixel, sights) in (0..).zip(frame.visible()) {
        let candidates = sights.concat();
        let (levels, phongs) = match (drawn[pixel as usize], by_phong[pixel as usize]) {
            (Some(levels), Some(phongs)) if !candidates.is_empty() => (levels, phongs),
            (None, None) if candidates.is_empty() => continue,
            _ => return Some(Found { share: f64::INFINITY, error: f64::INFINITY, triangles: 0, cheaper: 0 }),
        };
        let point = [pixel % width, pixel / width].map(|c| f64::from(c) + 0.5);
        let same = levels == phongs;
        // Which of several facets is seen may be a matter of rounding.
        let mut error = f64::INFINITY;
        for &candidate in &candidates {
            let facet = &frame.facets[candidate as usize];
            let (shade, _) = shades.entry(candidate).or_insert_with(|| (phong(&frame, facet), false));
            // The centre of a pixel may lie a little outside of a thin triangle, where normals are shorter than anywhere on it.
            let length = length(facet.normal(facet.weights(point))).max(facet.min_normal_length);
            let (is_clear, is_judged) = (length >= SHORT, frame.is_constant());
            error = error.min(match (is_clear, same) {
                (true, _) if is_judged || !same => {
                    let off = |light| arithmetic::difference(levels, walked.shown(&frame, facet, light));
                    let exactly = off(shade(point));
                    let beside = || facet.within(point).into_iter().map(|facet| off(phong(&frame, &facet)(point)));
                    if exactly <= UNDECIDED { exactly } else { beside().fold(exactly, f64::min) }
                }
                (_, true) => 0.0,
                (_, false) => f64::INFINITY,
            });
        }
        if let Some((_, cheaper)) = candidates.first().and_then(|nearest| shades.get_mut(nearest)) {
            *cheaper |= !same;
        }
        worst = worst.max(error);
    }
    let cheaper = shades.values().filter(|(_, cheaper)| *cheaper).count() as u64;
    Some(Found { share: worst / right, error: worst, triangles: shades.len() as u64, cheaper })
}
