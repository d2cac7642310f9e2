//! Compares integers with floating point in 64 bits, by the same method, at every pixel.
//!
//! Where shading is well-conditioned, every pixel keeps to [`LIMIT`]. Elsewhere rounding is magnified, and a pixel may be off by an additional
//! amount: the change of its light if cosines change by their rounding, times their condition number, see [`Frame::sensitivity`].

use crate::{
    Family, Verdict,
    case::Case,
    random::Random,
    scenes::{self, Hard, Wishes},
    tiles, transparency,
};
use embedded_graphics_core::pixelcolor::{Gray8, GrayColor};
use microphong::{Stream, renderer};
use microphong_compare::{UNDECIDED, level};
use microphong_oracle::{Facet, Frame, Levels, MOST_OUTCOMES, Shade, Sight, chosen, decides, method, outcomes};
use microphong_render::{
    choices::{self, Chosen, Way},
    render::{self, Format, Style},
    shader::Shader,
};

/// Largest difference of any method, in 1/255 of full intensity.
pub const LIMIT: f64 = 0.5;
/// Distance, in affine coordinates, at which a pixel's centre counts as on the border of two parts of a triangle. Either part may show there.
const NUDGE: f64 = 1e-6;

/// Random scenes, by a random method.
pub struct Arithmetic;

impl Family for Arithmetic {
    fn name(&self) -> &'static str {
        "arithmetic"
    }

    fn about(&self) -> &'static str {
        "the integer version of each method gives the light of its floating-point version"
    }

    fn limit(&self) -> Option<(f64, &'static str)> {
        Some((LIMIT, "of 255, less 0.1 for each light beyond the first and what ill-conditioned pixels are sensitive to"))
    }

    fn counts(&self) -> &'static [&'static str] {
        &["pixels", "of them leniently", "pixels not judged"]
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let Some(case) = case(random) else { return Verdict::skipped() };
        let kind = case.style.shader.name();
        match judge(&case) {
            Some(found) => {
                let counts = vec![found.strictly + found.leniently, found.leniently, found.not_judged];
                Verdict { kind, counts, ..Verdict::of(found.error, LIMIT, Some(case)) }
            }
            None => Verdict::skipped(),
        }
    }

    fn fails(&self, case: &Case) -> bool {
        judge(case).is_some_and(|found| found.error > LIMIT)
    }
}

/// Triangles side by side, of all of which something is seen, or a scene of any kind, two of three of them hard, by a method that can draw it. Half
/// of all textures have holes. `None` if it would not make a valid stream.
pub fn case(random: &mut Random) -> Option<Case> {
    let hard = if random.once_in(3) { Hard::default() } else { Hard::random(random) };
    let case = if random.once_in(2) {
        tiles::case(random, hard)
    } else {
        scenes::case(random, Wishes { closed: false, unclipped: true, triangles: 200, hard })
    }?;
    let case = Case { stream: transparency::sometimes_pierced(random, case.stream), ..case };
    let style = Style { antialias: false, dither: false, ..case.style };
    let stream = case.stream.parse().ok()?;
    let can_draw = |shader: &Shader| renderer::check(&stream, shader.facts(), style.perspective_correct).is_ok();
    let fitting: Vec<_> = Shader::ALL.into_iter().filter(can_draw).collect();
    let shader = if can_draw(&style.shader) { style.shader } else { random.among(&fitting) };
    Some(Case { style: Style { shader, ..style }, ..case.clone() })
}

/// Additional error for each light beyond the first, in 1/255: the error of the table of highlights at low exponents.
pub(crate) const PER_LIGHT: f64 = 0.1;
/// Pixels that are less sensitive, in 1/255, are judged strictly.
const STRICT: f64 = 0.25;
/// Pixels that are more sensitive are not judged: where two normals of a triangle are nearly opposite, rounding decides where the normal
/// between them points.
const UNDEFINED: f64 = 64.0;

/// The result of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// The largest error in 1/255, less what many lights may add, and less the sensitivity of pixels that are judged leniently; infinite
    /// where coverage differs.
    pub error: f64,
    /// Pixels that have to keep to [`LIMIT`].
    pub strictly: u64,
    /// Pixels that may be off by their sensitivity as well.
    pub leniently: u64,
    /// Pixels that may be anything.
    pub not_judged: u64,
}

/// Places at which a method divides by lengths that may vanish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Divides {
    /// The method interpolates light and divides nowhere.
    Nowhere,
    /// The method divides at each pixel.
    AtPixels,
    /// The method divides at nodes or ends of rows, and interpolates cosines, lengths or angles between them.
    AtNodes,
}

impl Divides {
    /// A method that is not listed is judged strictly everywhere.
    fn of(name: &str, is_constant: bool) -> Self {
        match name {
            // Near lights are no quotients of linear functions: it interpolates cosines.
            "duff" if !is_constant => Self::AtNodes,
            // Under near lights it is Phong shading.
            "renq-newton" if !is_constant => Self::AtPixels,
            "auto" | "auto-linear" | "duff" | "highlight-test" | "phong" | "phong-rv" => Self::AtPixels,
            "angular" | "angular-original" | "goldman" | "hybrid" | "hybrid-original" | "renq" | "renq-newton" | "slerp" => Self::AtNodes,
            _ => Self::Nowhere,
        }
    }
}

/// Whether a method interpolates light, which it computes at nodes with the strength that lights have there. All others weaken lights at each pixel, by
/// a walked distance.
fn interpolates_light(name: &str) -> bool {
    matches!(name, "flat" | "gouraud" | "gouraud4" | "six-point" | "six-point-adaptive" | "six-point-centre" | "cubic")
}

/// Judges each pixel of a frame by its sensitivity; `None` if the method cannot draw it, or if a surface is transparent.
#[must_use]
pub fn judge(case: &Case) -> Option<Found> {
    let (stream, size) = (case.stream.parse().ok()?, (case.size[0], case.size[1]));
    let of = if case.style.perspective_correct { Frame::perspective_correct } else { Frame::new };
    let frame = of(stream, size, case.frame);
    let frame = if is_gray(case) { frame.in_greys() } else { frame };
    let lights = PER_LIGHT * frame.lights.len().saturating_sub(1) as f64;
    let divides = Divides::of(case.style.shader.name(), frame.is_constant());
    let mirrors = case.style.shader.name() == "phong-rv";
    let interpolates_light = interpolates_light(case.style.shader.name());
    let mut found = Found::default();
    for pixel in pixels(case, &frame, &frame.visible())? {
        let facets = pixel.errors.iter().map(|&(facet, _)| &frame.facets[facet as usize]);
        let weakening =
            if interpolates_light { 0.0 } else { facets.clone().map(|facet| frame.weakening(facet, pixel.centre)).fold(0.0, f64::max) };
        let sensitivity = match divides {
            _ if pixel.is_undecidable && pixel.least() > LIMIT => f64::INFINITY,
            _ if mirrors && facets.clone().any(|facet| frame.is_at_horizon(facet, pixel.centre)) => f64::INFINITY,
            Divides::Nowhere => 0.0,
            _ => facets.clone().map(|facet| frame.sensitivity(facet, pixel.centre, divides == Divides::AtNodes)).fold(0.0, f64::max),
        };
        let sensitivity = sensitivity + weakening;
        let more = if sensitivity < STRICT { 0.0 } else { sensitivity };
        match sensitivity {
            ..STRICT => found.strictly += 1,
            STRICT..UNDEFINED => found.leniently += 1,
            _ => {
                found.not_judged += 1;
                continue;
            }
        }
        found.error = found.error.max(pixel.least() - lights - more);
    }
    Some(found)
}

/// The ways that a method with a choice takes for the triangles of a stream; none for other methods. `None` if it cannot draw them.
fn ways(case: &Case, stream: Stream<'_>) -> Option<Vec<Option<Chosen>>> {
    let Style { shader, perspective_correct, .. } = case.style;
    let told = if is_gray(case) {
        choices::by::<Gray8>(shader, stream, case.pixels(), perspective_correct, case.frame)
    } else {
        level::choices(stream, case.pixels(), case.style, case.frame)
    };
    Some(told.ok()?.map(|told| told.ways).unwrap_or_default())
}

/// The shading of a facet by a method in floating point, in the way that it chose. `None` if the method cannot shade it.
fn shade<'f>(case: &Case, frame: &'f Frame, facet: &'f Facet, ways: &[Option<Chosen>]) -> Option<Shade<'f>> {
    match ways.get(facet.id as usize).copied().flatten() {
        Some(way) => Some(chosen(frame, facet, way)),
        None => method(case.style.shader.name(), frame, facet).ok(),
    }
}

/// Difference of levels of a facet. A material of one hue has one level for all channels, its brightest channel's. Approximation may lift this above
/// 255 later than others. A facet with colours has three levels.
pub(crate) fn difference(frame: &Frame, facet: &Facet, drawn: [f64; 3], exact: [f64; 3]) -> f64 {
    let all = (0..3).map(|k| (drawn[k] - exact[k]).abs()).fold(0.0, f64::max);
    let one = facet.albedos.is_none() && drawn[0] == drawn[1] && drawn[1] == drawn[2];
    let brightest = || frame.only_channel(facet).map_or(exact.into_iter().fold(0.0, f64::max), |channel| exact[channel]);
    if one { all.min((drawn[0] - brightest()).abs()) } else { all }
}

/// Difference of what is `drawn` from the light of a facet at a point, which is exactly this. The place in a texture may be off, so that the texel is
/// another one: `beside` shades the facet in the colours of these.
pub(crate) fn error(
    frame: &Frame,
    facet: &Facet,
    drawn: [f64; 3],
    (point, exact): ([f64; 2], Levels),
    beside: impl Fn(&Facet) -> Option<Levels>,
) -> f64 {
    let error = difference(frame, facet, drawn, exact);
    if facet.texture.is_none() || error <= UNDECIDED {
        return error;
    }
    let others = facet.within(point).into_iter();
    others.filter_map(|facet| Some(difference(frame, &facet, drawn, beside(&facet)?))).fold(error, f64::min)
}

/// Largest difference of a frame from its method in floating point, in 1/255, before the output format rounds; infinite where a pixel is missing. The
/// frame is known already, and what may be seen at each of its pixels. `None` if the method cannot draw it, or if a surface is transparent.
#[must_use]
pub fn of(case: &Case, frame: &Frame, visible: &[Vec<Sight>]) -> Option<f64> {
    Some(pixels(case, frame, visible)?.iter().map(Pixel::least).fold(0.0, f64::max))
}

/// A pixel that is drawn or should be.
struct Pixel {
    /// On the screen.
    centre: [f64; 2],
    /// The facets that may be seen there, and how far the pixel is off from each, in 1/255; none where coverage differs.
    errors: Vec<(u32, f64)>,
    /// Whether the method takes so many close decisions that not all of its results are known.
    is_undecidable: bool,
}

impl Pixel {
    /// The error, if the facet is shown that fits best.
    fn least(&self) -> f64 {
        self.errors.iter().map(|&(_, error)| error).fold(f64::INFINITY, f64::min)
    }
}

/// Whether a case is judged in greys. All other formats are judged in three channels.
fn is_gray(case: &Case) -> bool {
    case.format == Format::Gray8
}

/// The levels of a frame, pixel by pixel; none where nothing is drawn. Greys are those of pixels, which are rounded. They count as drawn unless they
/// are those of the background, where it may be `visible`. `None` if the method cannot draw it.
fn levels(case: &Case, frame: &Frame, stream: Stream<'_>, visible: &[Vec<Sight>]) -> Option<Vec<Option<[f64; 3]>>> {
    if !is_gray(case) {
        return level::picture(stream, case.pixels(), case.style, case.frame).ok();
    }
    let (pixels, _) = render::frame::<Gray8>(stream, case.pixels(), case.style, case.size[1], case.frame).ok()?;
    let level = |((k, pixel), sights): ((u32, &Gray8), &Vec<Sight>)| {
        let level = [f64::from(pixel.luma()); 3];
        let is_background = sights.iter().any(Vec::is_empty) && (level[0] - frame.background(k / case.size[0])[0]).abs() < 0.5;
        (!is_background).then_some(level)
    };
    Some((0..).zip(&pixels).zip(visible).map(level).collect())
}

/// Compares all pixels of a frame with its method in floating point. `None` if the method cannot draw it, or if a surface is transparent: this judges
/// one facet in a pixel.
fn pixels(case: &Case, frame: &Frame, visible: &[Vec<Sight>]) -> Option<Vec<Pixel>> {
    if frame.facets.iter().any(|facet| facet.transparency > 0.0) {
        return None;
    }
    let shader = case.style.shader;
    let stream = case.stream.parse().ok()?;
    let ways = ways(case, stream)?;
    let shades: Vec<Shade<'_>> = frame.facets.iter().map(|facet| shade(case, frame, facet, &ways)).collect::<Option<_>>()?;
    let drawn = levels(case, frame, stream, visible)?;
    let rounding = if is_gray(case) { 0.5 } else { 0.0 };
    let mut pixels = Vec::new();
    for (i, (levels, sights)) in drawn.iter().zip(visible).enumerate() {
        let centre = [i as u32 % case.size[0], i as u32 / case.size[0]].map(|c| f64::from(c) + 0.5);
        let Some(levels) = *levels else {
            if !sights.iter().any(Vec::is_empty) {
                pixels.push(Pixel { centre, errors: Vec::new(), is_undecidable: false });
            }
            continue;
        };
        let errors = sights
            .iter()
            .flatten()
            .map(|&c| {
                let facet = &frame.facets[c as usize];
                let beside = |facet: &Facet| Some(shade(case, frame, facet, &ways)?(centre));
                let mut error = error(frame, facet, levels, (centre, shades[c as usize](centre)), beside);
                // In perspective, `auto` may interpolate on the screen: what that is off by counts in its budget.
                let is_linear = ways.get(facet.id as usize).copied().flatten().is_some_and(|chosen| chosen.way == Way::Linear);
                if error > UNDECIDED && is_linear && facet.shares != [1.0; 3] {
                    let on_screen = Facet { shares: [1.0; 3], ..facet.clone() };
                    error = beside(&on_screen).map_or(error, |exact| error.min(difference(frame, facet, levels, exact)));
                }
                (c, error - rounding)
            })
            .collect();
        let mut pixel = Pixel { centre, errors, is_undecidable: false };
        if pixel.least() > UNDECIDED && decides(shader.name()) {
            for (facet, error) in &mut pixel.errors {
                let facet = &frame.facets[*facet as usize];
                for [x, y] in [[0.0, 0.0], [NUDGE, NUDGE], [NUDGE, -NUDGE], [-NUDGE, NUDGE], [-NUDGE, -NUDGE]] {
                    let point = [centre[0] + x, centre[1] + y];
                    let outcomes: Vec<Levels> = outcomes(shader.name(), frame, facet, point, frame.undecided(facet)).ok()?;
                    pixel.is_undecidable |= outcomes.len() == MOST_OUTCOMES;
                    *error = outcomes.into_iter().map(|exact| difference(frame, facet, levels, exact) - rounding).fold(*error, f64::min);
                }
            }
        }
        pixels.push(pixel);
    }
    Some(pixels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::records::Records;
    use microphong_models::bytes::StreamBytes;

    /// The stream with all holes filled in.
    fn filled(stream: &StreamBytes) -> StreamBytes {
        let mut records = Records::of(&stream.parse().unwrap());
        records.textures.iter_mut().for_each(|texture| texture.has_holes = 0);
        records.colours.iter_mut().for_each(|colour| colour.hole = 0);
        records.written().unwrap()
    }

    /// Random scenes have holes. All of their pixels are right. In many scenes some would be wrong if the holes were filled in; in others texels are
    /// so small that rounding decides everywhere.
    #[test]
    fn holes_are_judged() {
        let (mut pierced, mut seen) = (0, 0);
        for number in 0..1_500 {
            let Some(case) = case(&mut Random::new(8, number)) else { continue };
            if !case.stream.parse().unwrap().textures().list.iter().any(|texture| texture.has_holes != 0) {
                continue;
            }
            let Some(found) = judge(&case) else { continue };
            assert!(found.error <= LIMIT, "case {number}: {found:?}");
            let other = Case { stream: filled(&case.stream), ..case.clone() };
            pierced += 1;
            seen += u32::from(is_wrong(&other, &case));
        }
        println!("{pierced} scenes with holes, of which {seen} show them");
        assert!(pierced > 40 && 4 * seen > pierced, "{seen} of {pierced}");
    }

    /// Whether a pixel of `drawn` covers what is a hole in the scene that is `right`, or the other way round.
    fn is_wrong(drawn: &Case, right: &Case) -> bool {
        let (stream, size) = (right.stream.parse().unwrap(), (right.size[0], right.size[1]));
        let frame = Frame::new(stream, size, right.frame);
        let frame = if is_gray(right) { frame.in_greys() } else { frame };
        of(drawn, &frame, &frame.visible()).is_some_and(|error| error == f64::INFINITY)
    }
}
