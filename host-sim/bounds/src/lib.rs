//! Search for the largest errors of interpolated highlights, for the table by which the method `auto` chooses.
//!
//! The error of interpolating a highlight (N·H/|N|)^n on a triangle depends on its three unit normals, seen from the half vector. For all exponents n
//! it is about the same function of n (1 - ρ) and n (1 - w), where ρ is the smallest length of N on the triangle, and w the largest N·H at a corner
//! over ρ. [`microphong::method::auto::highlight_error`] describes the table.
//!
//! An entry is the largest error found on any triangle that is at most as large and at least as far from the peak. Random triangles are tried, and
//! triangles of neighbouring entries, which are moved as long as the error grows. This is a maximum of what was tried, not a proof. So margins are
//! added, and [`worst`] searches again with another seed and other exponents for errors that exceed the table.

mod triangle;

use microphong::method::auto::highlight_error::{
    COLUMNS, COLUMNS_A_UNIT, CURVED, Curved, Growth, KINDS, Kind, LEAST_EXPONENTS, LEAST_SIZE, LINEAR, LINEAR_SIZE, LinearTable, RATE,
    ROWS, ROWS_BEHIND, SHARE,
};
use microphong_stress::random::Random;
use rayon::prelude::*;
use std::fmt::Write;
pub use triangle::Triangle;

/// Errors of each kind for one range of exponents, over the whole highlight.
type Found = [[[f64; COLUMNS]; SEARCHED]; KINDS];

/// The tables, as the core has them, by range of exponents.
#[derive(Clone, Debug)]
pub struct Table {
    /// Errors of linear interpolation.
    pub linear: [LinearTable; LEAST_EXPONENTS.len()],
    /// Errors of quadratic interpolation.
    pub curved: [Curved; LEAST_EXPONENTS.len()],
}

impl Table {
    /// The tables of the core.
    #[must_use]
    pub fn compiled() -> Self {
        Self { linear: LINEAR, curved: CURVED }
    }
}

/// Number of kinds of error of linear interpolation. The kinds after them belong to quadratics.
const LINEAR_KINDS: usize = Kind::Quadratic as usize;

/// Number of rows that are searched: the table's rows and the ones half-way between them.
const SEARCHED: usize = 2 * ROWS - 1;

/// Factors for what a search has not found: another one finds up to 1 % more of linear interpolation, and 8 % more of quadratics.
const MARGINS: [f64; KINDS] = [1.03, 1.03, 1.12, 1.12];

/// Additional margin for quadratics, as a part of the whole highlight, by range of exponents. At exponents below 5 a longer search finds up to 0.1 of
/// 255 more, where triangles reach to the end of a highlight.
const MORE: [f64; LEAST_EXPONENTS.len()] = [1.0 / 2048.0, 0.0, 0.0];

/// Exponents that stand for a range.
const EXPONENTS: [&[u16]; LEAST_EXPONENTS.len()] = [&[1, 2, 3, 4], &[5, 6, 7, 8, 10, 12, 15], &[16, 18, 24, 32, 50, 128, 1024]];

/// Rounds of the search.
const ROUNDS: u64 = 3;

/// Steps of [`table`], of which `done` is told.
pub const STEPS: u64 = (LEAST_EXPONENTS.len() * SEARCHED) as u64 * ROUNDS;

/// n (1 - ρ) of the largest triangles of a row that is searched.
fn size_of(row: usize) -> f64 {
    LEAST_SIZE * f64::powf(2.0, row as f64 / 2.0)
}

/// n (1 - w) of the triangles of a column that are nearest to the peak.
fn depth_of(column: usize) -> f64 {
    column as f64 / f64::from(COLUMNS_A_UNIT)
}

/// The worst triangle that was found for an entry and a kind of error.
#[derive(Clone, Copy)]
struct Worst {
    error: f64,
    triangle: Triangle,
}

impl Worst {
    const NONE: Self = Self { error: 0.0, triangle: Triangle([[0.0; 2]; 3]) };

    /// Fits `triangle` to size and depth, and keeps it if its error is larger. Returns whether it is.
    fn consider(&mut self, triangle: Triangle, kind: usize, exponent: u16, (size, depth): (f64, f64)) -> bool {
        let Some(triangle) = triangle.fitted(exponent, size, depth) else { return false };
        let error = triangle.errors(exponent)[kind];
        let worse = error > self.error;
        if worse {
            *self = Self { error, triangle };
        }
        worse
    }

    /// Moves the triangle as long as that makes it worse, `tries` times.
    fn climb(&mut self, random: &mut Random, tries: u32, kind: usize, exponent: u16, limits: (f64, f64)) {
        let largest = 0.5 * limits.0.sqrt();
        let mut step = largest;
        for _ in 0..tries {
            let moved = self.triangle.moved(random, step);
            step *= if self.consider(moved, kind, exponent, limits) { 1.5 } else { 0.93 };
            if step < 1e-3 * largest {
                step = largest;
            }
        }
    }

    /// The worst of `tries` random triangles.
    fn of_random(random: &mut Random, tries: u32, kind: usize, exponent: u16, limits: (f64, f64)) -> Self {
        let mut worst = Self::NONE;
        for _ in 0..tries {
            let (size, depth) = (limits.0 * random.between(0.5, 1.0), limits.1 + random.between(-0.2, 0.5));
            worst.consider(Triangle::random(random, size, depth), kind, exponent, limits);
        }
        worst
    }
}

/// Searches one range of exponents, with about `effort` triangles for an entry, a kind of error and an exponent.
fn search(part: usize, effort: u32, seed: u64, done: &(impl Fn() + Sync)) -> Found {
    let mut worst = vec![[[Worst::NONE; COLUMNS]; KINDS]; SEARCHED];
    // Once from nothing, then from what neighbours have found.
    for round in 0..ROUNDS {
        let before = worst.clone();
        worst.par_iter_mut().enumerate().for_each(|(row, entries)| {
            let mut random = Random::new(seed, (part * SEARCHED + row) as u64 * ROUNDS + round);
            let around = row.saturating_sub(1)..(row + 2).min(SEARCHED);
            for (kind, entries) in entries.iter_mut().enumerate() {
                for (column, entry) in entries.iter_mut().enumerate() {
                    let limits = (size_of(row), depth_of(column));
                    let beside = column.saturating_sub(1)..(column + 2).min(COLUMNS);
                    for &exponent in EXPONENTS[part] {
                        let mut found = Worst::NONE;
                        if round == 0 {
                            found = Worst::of_random(&mut random, effort / 4, kind, exponent, limits);
                        }
                        for neighbour in before[around.clone()].iter().flat_map(|row| &row[kind][beside.clone()]) {
                            found.consider(neighbour.triangle, kind, exponent, limits);
                        }
                        found.climb(&mut random, effort / 4, kind, exponent, limits);
                        if found.error > entry.error {
                            *entry = found;
                        }
                    }
                }
            }
            done();
        });
    }
    let mut errors = [[[0.0; COLUMNS]; SEARCHED]; KINDS];
    for (kind, errors) in errors.iter_mut().enumerate() {
        for row in 0..SEARCHED {
            for column in (0..COLUMNS).rev() {
                // No smaller than that of smaller triangles, or of those farther from the peak.
                let smaller = if row > 0 { errors[row - 1][column] } else { 0.0 };
                let farther = errors[row].get(column + 1).copied().unwrap_or(0.0);
                errors[row][column] = worst[row][kind][column].error.max(smaller).max(farther);
            }
        }
    }
    errors
}

/// The tables with their margins, from `effort` triangles for an entry, a kind of error and an exponent.
#[must_use]
pub fn table(effort: u32, seed: u64, done: impl Fn() + Sync) -> Table {
    let mut table = Table {
        linear: [[[Growth { rate: 0, base: 0, slope: 0 }; 2]; COLUMNS]; LEAST_EXPONENTS.len()],
        curved: [[[[0; 2]; COLUMNS]; ROWS + ROWS_BEHIND]; LEAST_EXPONENTS.len()],
    };
    for (part, quadratic_more) in MORE.into_iter().enumerate() {
        let found = search(part, effort, seed, &done);
        for (kind, column) in (0..KINDS).flat_map(|kind| (0..COLUMNS).map(move |column| (kind, column))) {
            let more = if kind == Kind::Quadratic as usize { quadratic_more } else { 0.0 };
            let found = |row: usize| found[kind][row][column] * MARGINS[kind] + more;
            if kind < LINEAR_KINDS {
                table.linear[part][column][kind] = growth(found);
                continue;
            }
            for (row, entry) in table.curved[part].iter_mut().zip(entries(found)) {
                row[column][kind - LINEAR_KINDS] = ((entry * f64::from(1 << SHARE)).ceil() as u16).saturating_add(1);
            }
        }
    }
    table
}

/// Two lines no less than what was `found` in rows: one through zero, and of all through two of the errors the one that is nearest to them.
fn growth(found: impl Fn(usize) -> f64) -> Growth {
    let errors: Vec<[f64; 2]> = (0..SEARCHED).map(|row| [size_of(row), found(row)]).filter(|[size, _]| *size <= LINEAR_SIZE).collect();
    let rate = errors.iter().map(|[size, error]| error / size).fold(0.0, f64::max);
    let mut best = ([0.0, 0.0], f64::INFINITY);
    for (number, [size, error]) in errors.iter().enumerate() {
        for [larger, more] in &errors[number + 1..] {
            let slope = (more - error) / (larger - size);
            let base = errors.iter().map(|[size, error]| error - slope * size).fold(0.0, f64::max);
            let excess = |[size, error]: &[f64; 2]| ((rate * size).min(base + slope * size) / error.max(LEAST_ERROR)).ln().max(0.0);
            let excess = errors.iter().map(excess).sum();
            if excess < best.1 {
                best = ([base, slope], excess);
            }
        }
    }
    let ([base, slope], _) = best;
    let bits = |value: f64, bits: u32| (value * f64::from(1 << bits)).ceil() as u16;
    Growth { rate: bits(rate, RATE), base: bits(base, SHARE).saturating_add(1), slope: bits(slope, RATE) }
}

/// Smaller errors, of the whole highlight, need no line that is near to them.
const LEAST_ERROR: f64 = 1.0 / 4096.0;

/// The entries of one column, such that a straight line between two rows does not pass below what was `found` between them.
fn entries(found: impl Fn(usize) -> f64) -> [f64; ROWS + ROWS_BEHIND] {
    // Behind the rows that are searched nothing is judged by the table.
    let all = f64::INFINITY;
    let mut entries: [f64; ROWS + ROWS_BEHIND] = std::array::from_fn(|row| if row < ROWS { found(2 * row) } else { all });
    for row in 0..ROWS - 1 {
        let line = entries[row] + (f64::sqrt(2.0) - 1.0) * (entries[row + 1] - entries[row]);
        let lacking = (found(2 * row + 1) - line).max(0.0);
        entries[row] += lacking;
        entries[row + 1] += lacking;
    }
    // Raised entries may exceed the next ones.
    for row in 0..ROWS + ROWS_BEHIND - 1 {
        entries[row + 1] = entries[row + 1].max(entries[row]);
    }
    entries
}

/// A place of the table.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The exponent.
    pub exponent: u16,
    /// The kind of error.
    pub kind: usize,
    /// n (1 - ρ).
    pub size: f64,
    /// The column.
    pub column: usize,
}

impl Place {
    fn random(random: &mut Random, kind: usize) -> Self {
        let part = random.pick(0..LEAST_EXPONENTS.len() as i32) as usize;
        let end = LEAST_EXPONENTS.get(part + 1).copied().unwrap_or(1025);
        let exponent = random.octaves(LEAST_EXPONENTS[part].into(), end.into()) as u16;
        let largest = if kind < LINEAR_KINDS { LINEAR_SIZE } else { size_of(SEARCHED - 1) };
        Self {
            exponent,
            kind,
            size: random.octaves(LEAST_SIZE, largest.min(f64::from(exponent) * (1.0 - Triangle::LEAST_LENGTH))),
            column: random.pick(0..COLUMNS as i32) as usize,
        }
    }

    /// The error there according to a table.
    #[must_use]
    pub fn entry(&self, table: &Table) -> f64 {
        let part = LEAST_EXPONENTS.iter().rposition(|&least| self.exponent >= least).unwrap_or(0);
        let share = |entry: u16| f64::from(entry) / f64::from(1 << SHARE);
        if self.kind < LINEAR_KINDS {
            let Growth { rate, base, slope } = table.linear[part][self.column][self.kind];
            let of_size = |rate: u16| f64::from(rate) / f64::from(1 << RATE) * self.size;
            return of_size(rate).min(share(base) + of_size(slope));
        }
        let octaves = (self.size / LEAST_SIZE).log2();
        let row = (octaves as usize).min(ROWS - 2);
        let [less, more] = [row, row + 1].map(|row| share(table.curved[part][row][self.column][self.kind - LINEAR_KINDS]));
        less + (more - less) * (f64::powf(2.0, octaves - row as f64) - 1.0)
    }

    /// The largest error there of about `effort` triangles, over the whole highlight.
    #[must_use]
    pub fn search(&self, effort: u32, random: &mut Random) -> f64 {
        let Self { exponent, kind, size, column } = *self;
        let limits = (size, depth_of(column));
        let mut found = Worst::of_random(random, effort / 2, kind, exponent, limits);
        found.climb(random, effort / 2, kind, exponent, limits);
        found.error
    }
}

/// The place of `tries` random ones for a kind of error where a search by another seed than the table's finds the largest error over the entry, with the error and
/// the entry.
#[must_use]
pub fn worst(table: &Table, kind: usize, tries: u64, effort: u32, seed: u64) -> Option<(Place, [f64; 2])> {
    let search = |number: u64| {
        let mut random = Random::new(seed, number);
        let place = Place::random(&mut random, kind);
        (place, [place.search(effort, &mut random), place.entry(table)])
    };
    let ratio = |(_, [error, entry]): &(Place, [f64; 2])| error / entry;
    (0..tries).into_par_iter().map(search).max_by(|a, b| ratio(a).total_cmp(&ratio(b)))
}

/// The tables as a file of the core.
#[must_use]
pub fn source(table: &Table, effort: u32, seed: u64) -> String {
    let mut text = format!(
        "//! The tables of `highlight_error`, written by `microphong bounds --effort {effort} --seed {seed}`.\n\n\
         use super::{{Curved, Growth, LEAST_EXPONENTS, LinearTable}};\n\n\
         const fn growth(rate: u16, base: u16, slope: u16) -> Growth {{\n    Growth {{ rate, base, slope }}\n}}\n\n\
         /// For each range of exponents: columns by the distance from the peak, and how errors of both kinds grow there.\n\
         #[rustfmt::skip]\n\
         pub static LINEAR: [LinearTable; LEAST_EXPONENTS.len()] = [\n"
    );
    // A String takes all that is written.
    for part in &table.linear {
        text.push_str("    [\n");
        for columns in part.chunks(4) {
            let columns: Vec<_> = columns
                .iter()
                .map(|kinds| {
                    let [below, above] = kinds.map(|Growth { rate, base, slope }| format!("growth({rate}, {base}, {slope})"));
                    format!("[{below}, {above}]")
                })
                .collect();
            let _ = writeln!(text, "        {},", columns.join(", "));
        }
        text.push_str("    ],\n");
    }
    text.push_str(
        "];\n\n\
         /// For each range of exponents: rows by size, columns by the distance from the peak, and errors of both kinds there.\n\
         #[rustfmt::skip]\n\
         pub static CURVED: [Curved; LEAST_EXPONENTS.len()] = [\n",
    );
    for part in &table.curved {
        text.push_str("    [\n");
        for row in part {
            text.push_str("        [\n");
            for columns in row.chunks(8) {
                let columns: Vec<_> = columns.iter().map(|kinds| format!("{kinds:?}")).collect();
                let _ = writeln!(text, "            {},", columns.join(", "));
            }
            text.push_str("        ],\n");
        }
        text.push_str("    ],\n");
    }
    text.push_str("];\n");
    text
}
