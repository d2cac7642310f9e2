//! Random colours at the corners of triangles.

use crate::random::Random;
use microphong::stream::record::{Triangle, Vertex};
use microphong_models::{
    coat::{Coat, Paint},
    quantise::Part,
    vector::{V3, dot},
};

/// How the corners of triangles take colours from a palette.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Any colour at each corner.
    Mixed,
    /// One colour for each triangle.
    Plain,
    /// Neighbours in the palette at the corners of a triangle. They differ little where the palette is a ramp.
    Close,
    /// The colour of a place, from one end of the palette to the other along this direction. Triangles meet in equal colours.
    Along(V3),
    /// Some triangles mixed, some plain.
    Both,
}

/// Largest number of colours in a palette.
const MOST: i32 = 256;

/// Gives most of the parts random palettes and random colours of these at all corners. Some parts have one palette in common.
pub(crate) fn paint(random: &mut Random, parts: &mut [Part]) {
    let mut colours = palette(random);
    for part in parts {
        if random.once_in(8) {
            continue;
        }
        if random.once_in(2) {
            colours = palette(random);
        }
        let kind = match random.pick(0..5) {
            0 => Kind::Mixed,
            1 => Kind::Plain,
            2 => Kind::Close,
            3 => Kind::Along(random.direction()),
            _ => Kind::Both,
        };
        part.coat = Some(Coat::Palette(colours.clone()));
        let count = colours.len() as i32;
        part.colours = corners(random, kind, count, &part.vertices, &part.triangles);
        for level in &mut part.coarser {
            level.colours = corners(random, kind, count, &part.vertices, &level.triangles);
        }
    }
}

/// A palette of one colour, of few or of many: any ones, extremes, greys, a ramp, or colours that hardly differ.
pub(crate) fn palette(random: &mut Random) -> Vec<[u8; 3]> {
    let count = match random.pick(0..4) {
        0 => random.pick(1..4),
        1 => random.pick(2..17),
        2 => random.pick(2..MOST + 1),
        _ => MOST,
    };
    let mut any = || [(); 3].map(|()| random.bits() as u8);
    let (first, last) = (any(), any());
    let kind = random.pick(0..6);
    let colour = |number| match kind {
        0 | 1 => [(); 3].map(|()| random.bits() as u8),
        2 => [(); 3].map(|()| random.among(&[0, 255])),
        3 => [random.bits() as u8; 3],
        4 => [0, 1, 2].map(|k| {
            let (from, to) = (i32::from(first[k]), i32::from(last[k]));
            (from + (to - from) * number / count.max(2)) as u8
        }),
        _ => first.map(|channel| channel.saturating_add(random.pick(0..6) as u8)),
    };
    (0..count).map(colour).collect()
}

/// For each triangle the colours of its corners, as indices of a palette of so many colours.
fn corners(random: &mut Random, kind: Kind, count: i32, vertices: &[Vertex], triangles: &[Triangle]) -> Vec<[Paint; 3]> {
    let mut of = |triangle: &Triangle| {
        let kind = match kind {
            Kind::Both => random.among(&[Kind::Mixed, Kind::Plain]),
            kind => kind,
        };
        match kind {
            Kind::Plain => [random.pick(0..count); 3],
            Kind::Close => {
                let first = random.pick(0..count);
                [0, 1, 2].map(|next| (first + next).min(count - 1))
            }
            Kind::Along(direction) => triangle.corners.map(|corner| {
                let position = vertices[usize::from(corner)].position.map(|c| f64::from(c) / f64::from(1 << 14));
                let share = (0.5 + 0.5 * dot(direction, position)).clamp(0.0, 1.0);
                (share * f64::from(count - 1)) as i32
            }),
            Kind::Mixed | Kind::Both => [(); 3].map(|()| random.pick(0..count)),
        }
    };
    triangles.iter().map(|triangle| of(triangle).map(|index| Paint::Colour(index as u8))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{self, Hard, Wishes};

    /// About a fifth of all random scenes have colours. Some triangles have one colour, and some have equal colours by different numbers, close ones, or
    /// the most different ones. Some palettes have one colour and some 256, and some meshes have levels of detail.
    #[test]
    fn a_fifth_of_all_scenes_have_colours() {
        let (mut scenes, mut coloured, mut levels, mut one, mut full) = (0, 0, 0, 0, 0);
        let (mut ranges, mut equal) = ([0; 4], 0);
        for number in 0..600 {
            let wishes = Wishes { closed: false, unclipped: true, triangles: 60, hard: Hard::default() };
            let Some(case) = scenes::case(&mut Random::new(3, number), wishes) else { continue };
            let stream = case.stream.parse().expect("a valid stream");
            scenes += 1;
            let with = |mesh| stream.colours_of(mesh).is_some();
            coloured += usize::from(stream.meshes.iter().any(with));
            levels += usize::from(stream.meshes.iter().any(|mesh| with(mesh) && mesh.error > 0));
            one += usize::from(stream.colours.len() == 1);
            full += usize::from(stream.colours.len() == 256);
            for corner in stream.corner_colours {
                let [a, b, c] = corner.colours;
                equal += usize::from(corner.range == 0 && (a != b || b != c));
                ranges[usize::from(corner.range > 0) + usize::from(corner.range > 8) + usize::from(corner.range == 255)] += 1;
            }
        }
        println!("{coloured} of {scenes} scenes, {levels} with levels, {one} of one colour, {full} of 256");
        println!("ranges of 0, to 8, to 254, 255: {ranges:?}; {equal} of different numbers and equal colours");
        assert!((scenes / 6..scenes / 4).contains(&coloured) && levels > 0 && one > 5 && full > 20);
        assert!(ranges.iter().all(|&triangles| triangles > 100) && equal > 10);
    }
}
