//! Palettes: few colours for many.
//!
//! A mesh or a texture of a stream has at most 256 colours, and a stream has room for 256 blocks of 16 colours. If colours that differ by no more than two steps of 255
//! are one colour, the colours of most models fit into one palette. All meshes of the model without a texture share it. Otherwise each material has a palette of its own. A
//! material with more colours has the 256 that are nearest to all of them. If too many colours are far from these, it has several palettes, and so several
//! meshes.

use crate::{
    coat::Paint,
    mesh::{Coloured, Rgb},
};
use microphong::stream::record::PALETTE;
use std::collections::{BTreeMap, HashMap};

/// Largest number of colours of a palette.
pub(super) const MOST: usize = 256;
/// Largest number of blocks of colours of a stream.
pub(super) const BLOCKS: usize = 256;
/// Colours that differ by no more than this are one colour.
const SAME: u8 = 2;
/// A colour that differs by more than this from the one that stands for it is far.
const FAR: u8 = 12;
/// The share of corners whose colours may be far from those of one palette.
const FEW: f64 = 0.01;
/// How often the triangles of a material are divided into two meshes with palettes of their own.
const DIVISIONS: usize = 3;
/// How often each colour of a palette moves to the middle of those that it stands for.
const ROUNDS: usize = 4;

/// Colours at the corners of triangles.
pub(super) struct Colours<'a> {
    /// The colours of each triangle, if it has some.
    pub(super) triangles: &'a [Option<[Rgb; 3]>],
    /// Triangles whose colours stay as they are, if one palette has room for them.
    pub(super) is_exact: &'a [bool],
    /// The number of each triangle's material.
    pub(super) material: &'a dyn Fn(usize) -> usize,
    /// Number of blocks of colours that the palettes may take, at least those of one palette.
    pub(super) blocks: usize,
}

/// Palettes of a mesh.
pub(super) struct Reduced {
    /// The palettes, each of at most 256 colours.
    pub(super) palettes: Vec<Vec<Rgb>>,
    /// For each triangle its colours in one of them.
    pub(super) triangles: Vec<Option<Coloured>>,
    /// Whether all colours are nearly equal to those that they stand for.
    pub(super) is_close: bool,
}

impl Colours<'_> {
    /// Palettes that have these colours, or colours near to them.
    pub(super) fn reduced(&self) -> Reduced {
        let coloured: Vec<usize> = (0..self.triangles.len()).filter(|&triangle| self.triangles[triangle].is_some()).collect();
        let counts = self.counts(&coloured);
        let groups = match Palette::of_few(&counts, MOST) {
            _ if coloured.is_empty() => Vec::new(),
            Some(palette) => vec![(coloured, palette)],
            None => self.by_materials(coloured, &counts),
        };
        let mut triangles = vec![None; self.triangles.len()];
        for (number, (group, palette)) in (0..).zip(&groups) {
            for &triangle in group {
                let of =
                    |corners: [Rgb; 3]| Coloured { coat: number, corners: corners.map(|colour| Paint::Colour(palette.index[&colour])) };
                triangles[triangle] = self.triangles[triangle].map(of);
            }
        }
        let is_close = groups.iter().all(|(_, palette)| palette.is_close);
        Reduced { palettes: groups.into_iter().map(|(_, palette)| palette.colours).collect(), triangles, is_close }
    }

    /// A palette for each material, or several, as far as a stream has room for them. `counts` are of all these triangles.
    fn by_materials(&self, coloured: Vec<usize>, counts: &Counts) -> Vec<(Vec<usize>, Palette)> {
        let mut materials: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        coloured.iter().for_each(|&triangle| materials.entry((self.material)(triangle)).or_default().push(triangle));
        let groups = |divisions: usize| materials.values().flat_map(|group| self.divided(group.clone(), divisions)).collect::<Vec<_>>();
        let blocks = |groups: &[(Vec<usize>, Palette)]| -> usize { groups.iter().map(|(_, palette)| blocks(&palette.colours)).sum() };
        let groups = (0..=DIVISIONS).rev().map(groups).find(|groups| blocks(groups) <= self.blocks);
        groups.unwrap_or_else(|| vec![(coloured, Palette::of_many(counts, MOST))])
    }

    /// Triangles with a palette, or several groups of them with a palette each.
    fn divided(&self, group: Vec<usize>, divisions: usize) -> Vec<(Vec<usize>, Palette)> {
        let counts = self.counts(&group);
        if let Some(palette) = Palette::of_few(&counts, MOST) {
            return vec![(group, palette)];
        }
        let palette = Palette::of_many(&counts, MOST);
        let is_far = |colour: Rgb| distance(colour, palette.colours[usize::from(palette.index[&colour])]) > FAR;
        let far: usize = counts.0.iter().filter(|count| is_far(count.colour)).map(|count| count.number).sum();
        if divisions == 0 || far as f64 <= FEW * (3 * group.len()) as f64 {
            return vec![(group, palette)];
        }
        let sum = |triangle: usize| {
            let corners = self.triangles[triangle].unwrap_or_default();
            [0, 1, 2].map(|channel| corners.iter().map(|colour| f64::from(colour[channel])).sum::<f64>())
        };
        let mut all = Cluster::default();
        group.iter().for_each(|&triangle| all.add(sum(triangle), 1.0));
        let (channel, middle) = (all.widest(), all.mean());
        let (one, other): (Vec<_>, Vec<_>) = group.iter().partition(|&&triangle| sum(triangle)[channel] <= middle[channel]);
        if one.is_empty() || other.is_empty() {
            return vec![(group, palette)];
        }
        [one, other].into_iter().flat_map(|half| self.divided(half, divisions - 1)).collect()
    }

    /// The colours of these triangles.
    fn counts(&self, group: &[usize]) -> Counts {
        let corners = |&triangle: &usize| self.triangles[triangle].unwrap_or_default().map(|colour| (colour, self.is_exact[triangle]));
        Counts::of(group.iter().flat_map(corners))
    }
}

/// A palette of at most `most` of colours, and which of its colours stands for each of them.
pub(super) fn indexed(colours: &[Rgb], most: usize) -> (Vec<Rgb>, Vec<u8>) {
    let counts = Counts::of(colours.iter().map(|&colour| (colour, true)));
    let palette = Palette::of_few(&counts, most).unwrap_or_else(|| Palette::of_many(&counts, most));
    let indices = colours.iter().map(|colour| palette.index[colour]).collect();
    (palette.colours, indices)
}

/// The number of blocks that a palette takes.
pub(super) fn blocks(palette: &[Rgb]) -> usize {
    palette.len().div_ceil(PALETTE)
}

/// How many corners or texels have a colour.
struct Count {
    colour: Rgb,
    number: usize,
    /// Whether they keep their colour.
    is_exact: bool,
}

/// The colours of corners or texels, the ones that are kept first, and then the most frequent ones.
struct Counts(Vec<Count>);

impl Counts {
    /// Colours, and whether they are kept.
    fn of(colours: impl Iterator<Item = (Rgb, bool)>) -> Self {
        let mut colours: Vec<u32> = colours.map(|([r, g, b], is_exact)| u32::from_be_bytes([u8::from(!is_exact), r, g, b])).collect();
        colours.sort_unstable();
        let count = |equal: &[u32]| {
            let [is_plain, r, g, b] = equal[0].to_be_bytes();
            Count { colour: [r, g, b], number: equal.len(), is_exact: is_plain == 0 }
        };
        let mut counts: Vec<Count> = colours.chunk_by(|one, other| one == other).map(count).collect();
        counts.sort_by_key(|count| (!count.is_exact, usize::MAX - count.number));
        Self(counts)
    }
}

/// Colours, and which of them stands for another one.
struct Palette {
    colours: Vec<Rgb>,
    index: HashMap<Rgb, u8>,
    /// Whether all colours are nearly equal to those that they stand for.
    is_close: bool,
}

impl Palette {
    /// A palette of the most frequent colours, which stand for all that are nearly equal to them; `None` if there are more than `most`.
    fn of_few(counts: &Counts, most: usize) -> Option<Self> {
        Self::of_few_within(counts, most, 0).or_else(|| Self::of_few_within(counts, most, SAME))
    }

    /// A palette as [`Self::of_few`] makes it, in which colours that are kept differ by no more than `exact` from those that stand for them.
    fn of_few_within(Counts(counts): &Counts, most: usize, exact: u8) -> Option<Self> {
        let mut palette = Self { colours: Vec::new(), index: HashMap::new(), is_close: true };
        for count in counts {
            if palette.index.contains_key(&count.colour) {
                continue;
            }
            let same = if count.is_exact { exact } else { SAME };
            let nearest = nearest(&palette.colours, count.colour).filter(|&(_, distance)| distance <= same);
            let number = nearest.map_or(palette.colours.len(), |(number, _)| number);
            if number == most {
                return None;
            }
            if number == palette.colours.len() {
                palette.colours.push(count.colour);
            }
            palette.index.insert(count.colour, number as u8);
        }
        Some(palette)
    }

    /// The palette of `most` colours that is about nearest to all of these: boxes of colours are divided until there are enough of them (Heckbert 1982; Wu
    /// 1992 chooses the box of the largest squared error), and then each colour moves to the middle of those that are nearest to it (Lloyd 1982).
    fn of_many(Counts(counts): &Counts, most: usize) -> Self {
        let mut points: Vec<([f64; 3], f64)> = cells(counts);
        let mut ranges = vec![(0..points.len(), Cluster::of(&points))];
        while ranges.len() < most {
            let worst = (0..ranges.len()).max_by(|&one, &other| ranges[one].1.error().total_cmp(&ranges[other].1.error()));
            let Some(worst) = worst.filter(|&worst| ranges[worst].1.error() > 0.0) else { break };
            let (range, all) = ranges.swap_remove(worst);
            let (channel, middle) = (all.widest(), all.mean());
            let inside = &mut points[range.clone()];
            inside.sort_by(|one, other| one.0[channel].total_cmp(&other.0[channel]));
            let at = inside.partition_point(|point| point.0[channel] <= middle[channel]).clamp(1, inside.len() - 1);
            for part in [range.start..range.start + at, range.start + at..range.end] {
                let inside = Cluster::of(&points[part.clone()]);
                ranges.push((part, inside));
            }
        }
        let mut colours: Vec<[f64; 3]> = ranges.iter().map(|(_, inside)| inside.mean()).collect();
        let sort = |colours: &mut Vec<[f64; 3]>| colours.sort_by(|one, other| one[1].total_cmp(&other[1]));
        sort(&mut colours);
        for _ in 0..ROUNDS {
            let mut sums = vec![Cluster::default(); colours.len()];
            for &(point, weight) in &points {
                let nearest = nearest_of(&colours, point);
                sums[nearest].add(point, weight);
            }
            for (colour, sum) in colours.iter_mut().zip(&sums).filter(|(_, sum)| sum.weight > 0.0) {
                *colour = sum.mean();
            }
            sort(&mut colours);
        }
        let index = counts.iter().map(|count| (count.colour, nearest_of(&colours, count.colour.map(f64::from)) as u8)).collect();
        Self { colours: colours.iter().map(|colour| colour.map(|c| c.round() as u8)).collect(), index, is_close: false }
    }
}

/// Means of colours that differ by less than four steps, with the roots of their counts. The roots keep rare colours from being lost beside large areas
/// of others.
fn cells(counts: &[Count]) -> Vec<([f64; 3], f64)> {
    let mut cells: BTreeMap<Rgb, Cluster> = BTreeMap::new();
    for count in counts {
        cells.entry(count.colour.map(|c| c / 4)).or_default().add(count.colour.map(f64::from), count.number as f64);
    }
    cells.values().map(|cell| (cell.mean(), cell.weight.sqrt())).collect()
}

/// Sums of weighted points.
#[derive(Clone, Copy, Default)]
struct Cluster {
    weight: f64,
    sum: [f64; 3],
    squares: [f64; 3],
}

impl Cluster {
    fn of(points: &[([f64; 3], f64)]) -> Self {
        let mut all = Self::default();
        points.iter().for_each(|&(point, weight)| all.add(point, weight));
        all
    }

    fn add(&mut self, point: [f64; 3], weight: f64) {
        self.weight += weight;
        for ((sum, square), c) in self.sum.iter_mut().zip(&mut self.squares).zip(point) {
            *sum += weight * c;
            *square += weight * c * c;
        }
    }

    fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| sum / self.weight)
    }

    /// The weighted sum of squared distances from the mean along an axis.
    fn spread(&self, axis: usize) -> f64 {
        (self.squares[axis] - self.sum[axis] * self.sum[axis] / self.weight).max(0.0)
    }

    /// The axis along which the points differ most.
    fn widest(&self) -> usize {
        (0..3).max_by(|&one, &other| self.spread(one).total_cmp(&self.spread(other))).unwrap_or(0)
    }

    fn error(&self) -> f64 {
        // What rounding leaves of equal points is none.
        let error: f64 = (0..3).map(|axis| self.spread(axis)).sum();
        if error < 1e-6 * self.weight { 0.0 } else { error }
    }
}

/// The number of the nearest of these colours, which are sorted by green. The search begins at the same green, and ends where the difference of green
/// alone is too large.
fn nearest_of(colours: &[[f64; 3]], point: [f64; 3]) -> usize {
    let mut high = colours.partition_point(|colour| colour[1] < point[1]);
    let (mut low, mut best) = (high, (f64::INFINITY, 0));
    let green =
        |number: Option<usize>| number.and_then(|number| colours.get(number)).map_or(f64::INFINITY, |colour| (colour[1] - point[1]).abs());
    loop {
        let [below, above] = [green(low.checked_sub(1)), green(Some(high))];
        if below.min(above) * below.min(above) >= best.0 {
            return best.1;
        }
        let number = if below < above { low - 1 } else { high };
        (low, high) = if below < above { (number, high) } else { (low, number + 1) };
        let [r, g, b] = colours[number];
        let square = (r - point[0]) * (r - point[0]) + (g - point[1]) * (g - point[1]) + (b - point[2]) * (b - point[2]);
        if square < best.0 {
            best = (square, number);
        }
    }
}

/// The nearest of these colours, and its distance.
fn nearest(colours: &[Rgb], colour: Rgb) -> Option<(usize, u8)> {
    colours.iter().map(|&other| distance(other, colour)).enumerate().min_by_key(|&(_, distance)| distance)
}

/// The largest difference of a channel.
pub(crate) fn distance(one: Rgb, other: Rgb) -> u8 {
    let [r, g, b] = [0, 1, 2].map(|k| one[k].abs_diff(other[k]));
    r.max(g).max(b)
}
