//! The smallest scene that still fails.

use crate::{
    case::Case,
    records::{Painted, Records},
};
use microphong::stream::record::Colour;
use microphong_models::bytes::StreamBytes;
use microphong_render::render::Format;

/// Makes `case` smaller as long as it `fails`.
#[must_use]
pub fn smallest(mut case: Case, fails: &dyn Fn(&Case) -> bool) -> Case {
    let smaller = |other: Case, case: &mut Case| {
        let fails = other.stream.parse().is_ok() && fails(&other);
        if fails {
            *case = other;
        }
        fails
    };
    if let Some(stream) = without_colours(&case.stream) {
        smaller(Case { stream, ..case.clone() }, &mut case);
    }
    // Triangles: halves, quarters, and so on down to single ones are left out.
    let count = |case: &Case| case.stream.parse().map_or(0, |stream| stream.triangles.len());
    let mut part = count(&case);
    while part > 0 {
        let mut first = 0;
        while first < count(&case) {
            let without = triangles(&case.stream, |k| !(first..first + part).contains(&k));
            if !without.is_some_and(|stream| smaller(Case { stream, ..case.clone() }, &mut case)) {
                first += part;
            }
        }
        part /= 2;
    }
    let mut light = 0;
    while case.stream.parse().is_ok_and(|stream| light < stream.lights.len()) {
        let without = lights(&case.stream, light);
        if !without.is_some_and(|stream| smaller(Case { stream, ..case.clone() }, &mut case)) {
            light += 1;
        }
    }
    if let Some(stream) = without_colours(&case.stream) {
        smaller(Case { stream, ..case.clone() }, &mut case);
    }
    colours(&mut case, &smaller);
    for simpler in [
        |case: &mut Case| case.frame = 0,
        |case: &mut Case| case.style.antialias = false,
        |case: &mut Case| case.style.outlines = None,
        |case: &mut Case| case.style.perspective_correct = false,
        |case: &mut Case| case.style.dither = false,
        |case: &mut Case| case.format = Format::Rgb888,
        |case: &mut Case| case.band_rows = case.size[1],
    ] {
        let mut other = case.clone();
        simpler(&mut other);
        smaller(other, &mut case);
    }
    for side in [0, 1] {
        while case.size[side] > 1 {
            let mut other = case.clone();
            other.size[side] /= 2;
            if !smaller(other, &mut case) {
                break;
            }
        }
    }
    case
}

/// The stream without all triangles whose numbers are not `kept`; `None` if no triangle is left.
fn triangles(bytes: &StreamBytes, kept: impl Fn(usize) -> bool) -> Option<StreamBytes> {
    let mut records = Records::of(&bytes.parse().ok()?);
    records.keep_triangles(kept);
    if records.triangles.is_empty() { None } else { records.written() }
}

/// The stream without light number `light`.
fn lights(bytes: &StreamBytes, light: usize) -> Option<StreamBytes> {
    let mut records = Records::of(&bytes.parse().ok()?);
    records.lights.remove(light);
    records.written()
}

/// The stream without colours; `None` if it has none.
fn without_colours(bytes: &StreamBytes) -> Option<StreamBytes> {
    let stream = bytes.parse().ok()?;
    if stream.corner_colours.is_empty() { None } else { Records::of(&stream).without_colours().written() }
}

/// Makes the colours of a case simpler: meshes without colours, triangles of one colour, white, and extremes.
fn colours(case: &mut Case, smaller: &dyn Fn(Case, &mut Case) -> bool) {
    let Ok(stream) = case.stream.parse() else { return };
    let (records, mut painted) = (Records::of(&stream), Records::painted(&stream));
    let is_level: Vec<bool> = stream.meshes.iter().map(|mesh| mesh.error > 0).collect();
    let mut attempt = |painted: &mut Painted, change: &dyn Fn(&mut Painted)| {
        let mut other = painted.clone();
        change(&mut other);
        if other == *painted {
            return false;
        }
        let stream = records.clone().paint(&other).and_then(|records| records.written());
        let fails = stream.is_some_and(|stream| smaller(Case { stream, ..case.clone() }, case));
        if fails {
            *painted = other;
        }
        fails
    };
    for mesh in (0..is_level.len()).filter(|&mesh| !is_level[mesh]) {
        let levels = is_level[mesh + 1..].iter().take_while(|&&is_level| is_level).count();
        attempt(&mut painted, &|painted| painted[mesh..=mesh + levels].fill(None));
    }
    let triangles: Vec<[usize; 2]> =
        (0..painted.len()).flat_map(|mesh| (0..painted[mesh].as_ref().map_or(0, Vec::len)).map(move |triangle| [mesh, triangle])).collect();
    for &[mesh, triangle] in &triangles {
        attempt(&mut painted, &|painted| {
            if let Some(mesh) = &mut painted[mesh] {
                mesh[triangle] = [mesh[triangle][0]; 3];
            }
        });
    }
    for old in distinct(&painted) {
        let mut now = old;
        for channels in [[255; 3], [0; 3]] {
            let new = Colour { channels, ..old };
            if now == old && attempt(&mut painted, &|painted| replace(painted, old, new)) {
                now = new;
            }
        }
        for (k, level) in [0, 1, 2].into_iter().flat_map(|k| [(k, 255), (k, 0)]) {
            let mut new = now;
            new.channels[k] = level;
            let is_rough = [0, 255].contains(&now.channels[k]);
            if !is_rough && attempt(&mut painted, &|painted| replace(painted, now, new)) {
                now = new;
            }
        }
    }
}

/// All colours, each once.
fn distinct(painted: &Painted) -> Vec<Colour> {
    let mut found = Vec::new();
    for &colour in painted.iter().flatten().flatten().flatten() {
        if !found.contains(&colour) {
            found.push(colour);
        }
    }
    found
}

/// Puts a colour in place of another at all corners.
fn replace(painted: &mut Painted, old: Colour, new: Colour) {
    painted.iter_mut().flatten().flatten().flatten().filter(|colour| **colour == old).for_each(|colour| *colour = new);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        random::Random,
        scenes::{self, Hard, Wishes},
    };
    use microphong::stream::Mesh;

    /// The smallest case of the first random scene that fails.
    fn found(fails: &dyn Fn(&Case) -> bool) -> Case {
        let wishes = Wishes { closed: true, unclipped: true, triangles: 60, hard: Hard::default() };
        let case = (0..).filter_map(|number| scenes::case(&mut Random::new(3, number), wishes)).find(fails);
        smallest(case.expect("a scene"), fails)
    }

    /// The largest range of a case's colours.
    fn range(case: &Case) -> u8 {
        case.stream.parse().map_or(0, |stream| stream.corner_colours.iter().map(|corner| corner.range).max().unwrap_or(0))
    }

    /// Where colours do not matter, there are none in the end. Where they matter, one triangle of extreme colours is left.
    #[test]
    fn colours_are_made_simple() {
        let plain = found(&|case| range(case) < 200 && case.stream.parse().is_ok_and(|stream| stream.colours.len() != 1));
        let stream = plain.stream.parse().expect("a valid stream");
        assert!(stream.corner_colours.is_empty() && stream.colours.is_empty(), "{} colours", stream.colours.len());
        let gradient = found(&|case| (20..=255).contains(&range(case)));
        let stream = gradient.stream.parse().expect("a valid stream");
        let levels: Vec<u8> = stream.colours.iter().flat_map(|colour| colour.channels).collect();
        assert_eq!((stream.triangles.len(), stream.corner_colours.len(), stream.colours.len()), (1, 1, 2), "{:?}", stream.colours);
        assert!(levels.iter().all(|level| [0, 255].contains(level)), "{levels:?}");
    }

    /// A scene keeps its picture when its colours are written anew, and without half of its triangles each of the others keeps its colours.
    #[test]
    fn triangles_keep_their_colours() {
        let mut judged = 0;
        for number in 0..200 {
            let wishes = Wishes { closed: false, unclipped: true, triangles: 60, hard: Hard::default() };
            let Some(case) = scenes::case(&mut Random::new(4, number), wishes) else { continue };
            let stream = case.stream.parse().expect("a valid stream");
            let painted = Records::painted(&stream);
            if stream.colours.is_empty() || stream.triangles.len() < 2 {
                continue;
            }
            let again = Records::of(&stream).paint(&painted).expect("few colours").written().expect("a valid stream");
            assert_eq!(Records::painted(&again.parse().expect("a valid stream")), painted);
            let half = triangles(&case.stream, |k| k % 2 == 1).expect("a valid stream");
            let half = half.parse().expect("a valid stream");
            let of = |(mesh, painted): (&Mesh, &Option<Vec<_>>)| {
                let numbers = mesh.first_triangle as usize..;
                painted.as_ref().map(|painted| numbers.zip(painted).filter(|(k, _)| k % 2 == 1).map(|(_, &corners)| corners).collect())
            };
            let expected: Painted = stream.meshes.iter().zip(&painted).map(of).collect();
            assert_eq!(Records::painted(&half), expected);
            judged += 1;
        }
        assert!(judged > 20, "{judged}");
    }
}
