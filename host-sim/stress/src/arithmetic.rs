//! Integers against the same method in 64-bit floating point, on every pixel.

use crate::{
    Family, Verdict,
    case::Case,
    random::Random,
    scenes::{self, Wishes},
};
use microphong_compare::{UNDECIDED, level};
use microphong_oracle::{Frame, Levels, Shade, decides, method, outcomes};
use microphong_render::{render::Style, shader::Shader};

/// Largest difference of any method, in 1/255 of full intensity.
pub const LIMIT: f64 = 0.5;
/// Where a pixel's centre lies on the border of two parts of a triangle, either may show.
const NUDGE: f64 = 1e-6;

/// Random scenes, by a random method.
pub struct Arithmetic;

impl Family for Arithmetic {
    fn name(&self) -> &'static str {
        "arithmetic"
    }

    fn about(&self) -> &'static str {
        "integers shade every pixel as the same method does in floating point"
    }

    fn limit(&self) -> Option<(f64, &'static str)> {
        Some((LIMIT, "of 255, less 0.1 for each light beyond the first"))
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let Some(case) = scenes::case(random, Wishes { closed: false, unclipped: true, triangles: 200 }) else { return Verdict::skipped() };
        let case = Case { style: Style { antialias: false, dither: false, ..case.style }, ..case };
        match excess(&case) {
            Some(error) => Verdict::of(error, LIMIT, Some(case)),
            None => Verdict::skipped(),
        }
    }

    fn fails(&self, case: &Case) -> bool {
        excess(case).is_some_and(|error| error > LIMIT)
    }
}

/// What each light beyond the first may add, in 1/255: the table of highlights is off by as much at low exponents, everywhere.
pub(crate) const PER_LIGHT: f64 = 0.1;
/// Least length of interpolated normals. Where two normals of a triangle are nearly opposite, the normal between them vanishes, and
/// rounding decides where it points: no arithmetic is exact there.
const OPPOSITE: f64 = 1.0 / 64.0;

/// Whether shading is defined on all triangles of a scene.
fn is_defined(case: &Case) -> bool {
    case.stream.parse().is_ok_and(|stream| stream.triangles.iter().all(|triangle| f64::from(triangle.min_normal_length()) >= OPPOSITE))
}

/// [`error`], less what many lights may add; `None` also where shading is not defined.
fn excess(case: &Case) -> Option<f64> {
    let lights = case.stream.parse().ok()?.lights.len().max(1);
    let error = if is_defined(case) { error(case)? } else { return None };
    Some((error - PER_LIGHT * (lights - 1) as f64).max(0.0))
}

/// All of a method's triangles in one frame, in floating point; `None` if the method cannot shade them.
fn shades(frame: &Frame, shader: Shader) -> Option<Vec<Shade<'_>>> {
    frame.facets.iter().map(|facet| method(shader.name(), frame, facet).ok()).collect()
}

/// Difference of levels; one level for all channels is that of the brightest.
pub(crate) fn difference(drawn: [f64; 3], exact: [f64; 3]) -> f64 {
    let all = (0..3).map(|k| (drawn[k] - exact[k]).abs()).fold(0.0, f64::max);
    let one = drawn[0] == drawn[1] && drawn[1] == drawn[2];
    if one { all.min((drawn[0] - exact.into_iter().fold(0.0, f64::max)).abs()) } else { all }
}

/// Largest difference of a frame from its method in floating point, in 1/255, before the output format rounds; infinite where a pixel is
/// missing. `None` if the method cannot draw it, or a triangle is clipped.
fn error(case: &Case) -> Option<f64> {
    let (stream, size) = (case.stream.parse().ok()?, (case.size[0], case.size[1]));
    let frame = if case.style.perspective_correct {
        Frame::perspective_correct(stream, size, case.frame)
    } else {
        Frame::new(stream, size, case.frame)
    };
    of(case, &frame, &frame.visible())
}

/// Largest difference of a frame from its method in floating point, if the frame is known already, and what may be seen at each of its
/// pixels.
#[must_use]
pub fn of(case: &Case, frame: &Frame, visible: &[Vec<u32>]) -> Option<f64> {
    let shader = case.style.shader;
    let stream = case.stream.parse().ok()?;
    let shades = shades(frame, shader)?;
    let drawn = level::picture(stream, case.pixels(), case.style, case.frame).ok()?;
    let mut worst = 0f64;
    for (i, (levels, candidates)) in drawn.iter().zip(visible).enumerate() {
        let levels = match *levels {
            Some(levels) if !candidates.is_empty() => levels,
            None if candidates.is_empty() => continue,
            // Coverage differs.
            _ => return Some(f64::INFINITY),
        };
        let centre = [i as u32 % case.size[0], i as u32 / case.size[0]].map(|c| f64::from(c) + 0.5);
        let mut error = candidates.iter().map(|&c| difference(levels, shades[c as usize](centre))).fold(f64::MAX, f64::min);
        if error > UNDECIDED && decides(shader.name()) {
            let around = [(0.0, 0.0), (NUDGE, NUDGE), (NUDGE, -NUDGE), (-NUDGE, NUDGE), (-NUDGE, -NUDGE)];
            let facets = candidates.iter().map(|&c| &frame.facets[c as usize]);
            for (facet, (x, y)) in facets.flat_map(|facet| around.map(|nudge| (facet, nudge))) {
                let point = [centre[0] + x, centre[1] + y];
                let outcomes: Vec<Levels> = outcomes(shader.name(), frame, facet, point, frame.undecided(facet)).ok()?;
                error = outcomes.into_iter().map(|exact| difference(levels, exact)).fold(error, f64::min);
            }
        }
        worst = worst.max(error);
    }
    Some(worst)
}
