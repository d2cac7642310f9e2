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
use microphong_compare::{
    UNDECIDED,
    level::{self, Walked},
};
use microphong_oracle::{Facet, Frame, Levels, MOST_MIXTURES, MOST_OUTCOMES, Shade, Sight, chosen, decides, method, outcomes};
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

/// Triangles side by side, of all of which something is seen, or a scene of any kind, two of three of them hard, by a method that can draw it. One of
/// eight has transparent triangles among others. Half of all textures have holes. `None` if it would not make a valid stream.
pub fn case(random: &mut Random) -> Option<Case> {
    let hard = if random.once_in(3) { Hard::default() } else { Hard::random(random) };
    // All other scenes are the same as without transparent ones.
    let mut aside = random.aside(1 << 35);
    let case = if aside.once_in(8) {
        transparency::sheets(&mut aside, hard)
    } else if random.once_in(2) {
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

/// What a pixel has of a quantity of the facets that are seen in it: of each as much as is seen.
fn through(frame: &Frame, sight: &[u32], quantity: impl Fn(&Facet) -> f64) -> f64 {
    let facets = sight.iter().map(|&facet| &frame.facets[facet as usize]);
    facets.fold(0.0, |behind, facet| facet.over([quantity(facet); 3], [behind; 3])[0])
}

/// What a case shows; `None` if its stream is not valid.
fn frame(case: &Case) -> Option<Frame> {
    let of = if case.style.perspective_correct { Frame::perspective_correct } else { Frame::new };
    let frame = of(case.stream.parse().ok()?, (case.size[0], case.size[1]), case.frame);
    Some(if is_gray(case) { frame.in_greys() } else { frame })
}

/// Judges each pixel of a frame by its sensitivity; `None` if the method cannot draw it.
#[must_use]
pub fn judge(case: &Case) -> Option<Found> {
    let frame = frame(case)?;
    let lights = PER_LIGHT * frame.lights.len().saturating_sub(1) as f64;
    let divides = Divides::of(case.style.shader.name(), frame.is_constant());
    let mirrors = case.style.shader.name() == "phong-rv";
    let interpolates_light = interpolates_light(case.style.shader.name());
    let mut found = Found::default();
    for pixel in pixels(case, &frame, &frame.visible())? {
        let weakening = |facet: &Facet| if interpolates_light { 0.0 } else { frame.weakening(facet, pixel.centre) };
        let sensitivity = |facet: &Facet| match divides {
            _ if mirrors && frame.is_at_horizon(facet, pixel.centre) => f64::INFINITY,
            Divides::Nowhere => 0.0,
            _ => frame.sensitivity(facet, pixel.centre, divides == Divides::AtNodes),
        };
        let sensitivity = if pixel.is_undecidable && pixel.least() > LIMIT {
            f64::INFINITY
        } else {
            let of = |sight: &[u32]| through(&frame, sight, |facet| sensitivity(facet) + weakening(facet));
            pixel.errors.iter().map(|&(sight, _)| of(sight)).fold(0.0, f64::max)
        };
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

/// Largest difference of the levels of a pixel.
pub(crate) fn difference(drawn: Levels, exact: Levels) -> f64 {
    (0..3).map(|k| (drawn[k] - exact[k]).abs()).fold(0.0, f64::max)
}

/// Largest difference of a frame from its method in floating point, in 1/255, before the output format rounds; infinite where a pixel is missing. The
/// frame is known already, and what may be seen at each of its pixels. `None` if the method cannot draw it.
#[must_use]
pub fn of(case: &Case, frame: &Frame, visible: &[Vec<Sight>]) -> Option<f64> {
    Some(pixels(case, frame, visible)?.iter().map(Pixel::least).fold(0.0, f64::max))
}

/// A pixel that is drawn or should be.
struct Pixel<'v> {
    /// On the screen.
    centre: [f64; 2],
    /// What may be seen there, and how far the pixel is off from each, in 1/255; none where coverage differs.
    errors: Vec<(&'v [u32], f64)>,
    /// Whether the method takes so many close decisions that not all of its results are known.
    is_undecidable: bool,
}

impl Pixel<'_> {
    /// The error, if what is shown fits best.
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

/// What a method in floating point makes of a frame.
struct Exact<'f> {
    case: &'f Case,
    frame: &'f Frame,
    /// The ways that a method with a choice takes for the triangles of the stream.
    ways: &'f [Option<Chosen>],
    /// The shading of each facet.
    shades: Vec<Shade<'f>>,
    walked: Walked,
}

impl<'f> Exact<'f> {
    /// `None` if the method cannot draw the frame.
    fn of(case: &'f Case, frame: &'f Frame, stream: &Stream<'_>, ways: &'f [Option<Chosen>]) -> Option<Self> {
        let shades = frame.facets.iter().map(|facet| shade(case, frame, facet, ways)).collect::<Option<_>>()?;
        Some(Self { case, frame, ways, shades, walked: Walked::of(stream, case.style.shader.facts()) })
    }

    /// The light of a facet at a point.
    fn light(&self, facet: u32, point: [f64; 2]) -> Vec<Levels> {
        vec![self.shades[facet as usize](point)]
    }

    /// The lights that it may have if its place in a texture, or the way of `auto`, is rounded.
    fn beside(&self, facet: u32, point: [f64; 2]) -> Vec<Levels> {
        let facet = &self.frame.facets[facet as usize];
        let shaded = |facet: &Facet| Some(shade(self.case, self.frame, facet, self.ways)?(point));
        let mut lights: Vec<_> = facet.within(point).iter().filter_map(shaded).collect();
        // In perspective, `auto` may interpolate on the screen: what that is off by counts in its budget.
        let is_linear = self.ways.get(facet.id as usize).copied().flatten().is_some_and(|chosen| chosen.way == Way::Linear);
        if is_linear && facet.shares != [1.0; 3] {
            lights.extend(shaded(&Facet { shares: [1.0; 3], ..facet.clone() }));
        }
        lights
    }

    /// The lights that it may have if the method takes close decisions in another way, and whether these are more than are known.
    fn decided(&self, facet: u32, [x, y]: [f64; 2]) -> (Vec<Levels>, bool) {
        let (facet, name) = (&self.frame.facets[facet as usize], self.case.style.shader.name());
        let around = [[0.0, 0.0], [NUDGE, NUDGE], [NUDGE, -NUDGE], [-NUDGE, NUDGE], [-NUDGE, -NUDGE]];
        let margin = self.frame.undecided(facet);
        let outcomes = around.map(|[dx, dy]| outcomes(name, self.frame, facet, [x + dx, y + dy], margin).unwrap_or_default());
        let are_more = outcomes.iter().any(|outcomes| outcomes.len() == MOST_OUTCOMES);
        (outcomes.concat(), are_more)
    }

    /// How far levels that are pixels are off by their rounding. A grey is rounded when a surface is drawn, and again when it is mixed with what is
    /// behind it.
    fn rounding(&self, sight: &[u32]) -> f64 {
        if !is_gray(self.case) {
            return 0.0;
        }
        let facets = sight.iter().map(|&facet| &self.frame.facets[facet as usize]);
        facets.fold(0.0, |behind, facet| facet.over([0.5; 3], [behind; 3])[0] + if facet.transparency > 0.0 { 0.5 } else { 0.0 })
    }

    /// How far what is `drawn` at a point is off from what is seen there, if each facet has one of several lights, and whether these have more
    /// mixtures than are known.
    fn off(&self, drawn: Levels, sight: &[u32], [_, y]: [f64; 2], lights: impl FnMut(u32) -> Vec<Levels>) -> (f64, bool) {
        let shown = |(&facet, lights): (&u32, Vec<Levels>)| {
            let shown = |light| self.walked.shown(self.frame, &self.frame.facets[facet as usize], light);
            (facet, lights.into_iter().map(shown).collect())
        };
        let mixtures = self.frame.mixtures(y as u32, sight.iter().zip(sight.iter().copied().map(lights)).map(shown));
        let are_more = mixtures.len() == MOST_MIXTURES;
        (mixtures.into_iter().map(|light| difference(drawn, light)).fold(f64::INFINITY, f64::min), are_more)
    }

    /// Compares a pixel with all that may be seen there.
    fn pixel<'v>(&self, drawn: Levels, sights: &'v [Sight], centre: [f64; 2]) -> Pixel<'v> {
        let mut pixel = Pixel { centre, errors: Vec::new(), is_undecidable: false };
        for sight in sights.iter().filter(|sight| !sight.is_empty()) {
            let rounding = self.rounding(sight);
            let (mut off, mut are_more) = self.off(drawn, sight, centre, |facet| self.light(facet, centre));
            if off - rounding > UNDECIDED {
                (off, are_more) = self.off(drawn, sight, centre, |facet| [self.light(facet, centre), self.beside(facet, centre)].concat());
            }
            pixel.is_undecidable |= are_more;
            pixel.errors.push((&sight[..], off - rounding));
        }
        if pixel.least() > UNDECIDED && decides(self.case.style.shader.name()) {
            for (sight, error) in &mut pixel.errors {
                let rounding = self.rounding(sight);
                let (off, are_more) = self.off(drawn, sight, centre, |facet| {
                    let (decided, are_more) = self.decided(facet, centre);
                    pixel.is_undecidable |= are_more;
                    [self.light(facet, centre), self.beside(facet, centre), decided].concat()
                });
                pixel.is_undecidable |= are_more;
                *error = error.min(off - rounding);
            }
        }
        pixel
    }
}

/// Compares all pixels of a frame with its method in floating point. `None` if the method cannot draw it.
fn pixels<'v>(case: &Case, frame: &Frame, visible: &'v [Vec<Sight>]) -> Option<Vec<Pixel<'v>>> {
    let stream = case.stream.parse().ok()?;
    let ways = ways(case, stream)?;
    let exact = Exact::of(case, frame, &stream, &ways)?;
    let drawn = levels(case, frame, stream, visible)?;
    let pixel = |((i, levels), sights): ((u32, &Option<Levels>), &'v Vec<Sight>)| {
        let centre = [i % case.size[0], i / case.size[0]].map(|c| f64::from(c) + 0.5);
        match levels {
            Some(levels) => Some(exact.pixel(*levels, sights, centre)),
            None if sights.iter().any(Vec::is_empty) => None,
            None => Some(Pixel { centre, errors: Vec::new(), is_undecidable: false }),
        }
    };
    Some((0..).zip(&drawn).zip(visible).filter_map(pixel).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::records::Records;
    use microphong::stream::record::{Mesh, TRANSPARENCY_SHIFT};
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

    /// Random scenes have transparent triangles in front of others. All of their pixels are right. In most scenes some would be wrong if
    /// nothing were seen through them.
    #[test]
    fn glass_is_judged() {
        let (mut scenes, mut seen) = (0, 0);
        for number in 0..1_500 {
            let Some(case) = case(&mut Random::new(8, number)) else { continue };
            let mut records = Records::of(&case.stream.parse().unwrap());
            if !records.meshes.iter().any(Mesh::is_transparent) {
                continue;
            }
            let Some(found) = judge(&case) else { continue };
            assert!(found.error <= LIMIT, "case {number}: {found:?}");
            records.meshes.iter_mut().for_each(|mesh| mesh.flags &= (1 << TRANSPARENCY_SHIFT) - 1);
            let frame = frame(&case).unwrap();
            let opaque = Case { stream: records.written().unwrap(), ..case.clone() };
            scenes += 1;
            seen += u32::from(of(&opaque, &frame, &frame.visible()).is_none_or(|error| error > 4.0 * LIMIT));
        }
        println!("{scenes} scenes with transparent triangles, of which {seen} show them");
        assert!(scenes > 100 && 4 * seen > 3 * scenes, "{seen} of {scenes}");
    }

    /// Whether a pixel of `drawn` covers what is a hole in the scene that is `right`, or the other way round.
    fn is_wrong(drawn: &Case, right: &Case) -> bool {
        let frame = frame(right).unwrap();
        of(drawn, &frame, &frame.visible()).is_some_and(|error| error == f64::INFINITY)
    }
}
