//! The largest errors of interpolated highlights, found by search: the table by which the method `auto` judges others.
//!
//! What interpolation is off from a highlight (N·H/|N|)^n on a triangle depends on its three unit normals, seen from the half vector. Errors
//! of all exponents n are about the same function of n e² and of n (1 - w), where e is the longest distance between two normals, and w the
//! largest N·H at a corner over the least length of N. [`microphong::method::highlight_error`] says how the table is laid out.
//!
//! An entry is the largest error that was found on any triangle that is at most as large and at least as far from the peak: of random ones,
//! and of those found for neighbouring entries, moved as long as that makes the error larger. It is a maximum over what was tried, not a
//! proof: margins are added, and [`worst`] searches again, by another seed and at other exponents, for what exceeds the table.

mod triangle;

use microphong::method::highlight_error::{COLUMNS, COLUMNS_A_UNIT, Errors, KINDS, Kind, LEAST_EXPONENTS, LEAST_SIZE, ROWS, SHARE};
use microphong_stress::random::Random;
use rayon::prelude::*;
use std::fmt::Write;
pub use triangle::Triangle;

/// Errors of each kind for one range of exponents, over the whole highlight.
type Found = [[[f64; COLUMNS]; SEARCHED]; KINDS];

/// The table, as the core has it.
pub type Table = [[Errors; KINDS]; LEAST_EXPONENTS.len()];

/// Rows that are searched: half-way between those of the table, too.
const SEARCHED: usize = 2 * ROWS - 1;

/// Factors for what a search has not found: another one finds up to 1 % more of linear interpolation, and 8 % more of quadratics.
const MARGINS: [f64; KINDS] = [1.03, 1.03, 1.12, 1.12];

/// Exponents that stand for a range.
const EXPONENTS: [&[u16]; LEAST_EXPONENTS.len()] = [&[1, 2, 3, 4], &[5, 6, 7, 8, 10, 12, 15], &[16, 18, 24, 32, 50, 128, 1024]];

/// Rounds of the search.
const ROUNDS: u64 = 3;

/// Steps of [`table`], of which `done` is told.
pub const STEPS: u64 = (LEAST_EXPONENTS.len() * SEARCHED) as u64 * ROUNDS;

/// n e² of the largest triangles of a row that is searched.
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

    /// Takes `triangle` in its place, fitted to size and depth, if it is worse; whether it is.
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
        let largest = 0.2 * limits.0.sqrt();
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

/// The table with its margins, from `effort` triangles for an entry, a kind of error and an exponent.
#[must_use]
pub fn table(effort: u32, seed: u64, done: impl Fn() + Sync) -> Table {
    let mut table = [[[[0; COLUMNS]; ROWS + 1]; KINDS]; LEAST_EXPONENTS.len()];
    for (part, kinds) in table.iter_mut().enumerate() {
        let found = search(part, effort, seed, &done);
        for (kind, rows) in kinds.iter_mut().enumerate() {
            for column in 0..COLUMNS {
                let entries = entries(column, kind, |row| found[kind][row][column] * MARGINS[kind]);
                for (row, entry) in rows.iter_mut().zip(entries) {
                    row[column] = ((entry * f64::from(1 << SHARE)).ceil() as u16).saturating_add(1);
                }
            }
        }
    }
    table
}

/// The entries of one column, such that a straight line between two rows does not pass below what was `found` between them.
fn entries(column: usize, kind: usize, found: impl Fn(usize) -> f64) -> [f64; ROWS + 1] {
    // What larger triangles are off at most: the brightest highlight, by the quadratic 4/3 of it. Cosines are not judged there.
    let all = match kind {
        kind if kind == Kind::Cosines as usize => f64::INFINITY,
        kind if kind == Kind::Quadratic as usize => 4.0 / 3.0 * f64::exp(-depth_of(column)),
        _ => f64::exp(-depth_of(column)),
    };
    let mut entries: [f64; ROWS + 1] = std::array::from_fn(|row| if row < ROWS { found(2 * row) } else { all });
    for row in 0..ROWS - 1 {
        let line = entries[row] + (f64::sqrt(2.0) - 1.0) * (entries[row + 1] - entries[row]);
        let lacking = (found(2 * row + 1) - line).max(0.0);
        entries[row] += lacking;
        entries[row + 1] += lacking;
    }
    // Raised entries may exceed the next ones.
    for row in 0..ROWS {
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
    /// n e².
    pub size: f64,
    /// The column.
    pub column: usize,
}

impl Place {
    fn random(random: &mut Random, kind: usize) -> Self {
        let part = random.pick(0..LEAST_EXPONENTS.len() as i32) as usize;
        let end = LEAST_EXPONENTS.get(part + 1).copied().unwrap_or(1025);
        Self {
            exponent: random.octaves(LEAST_EXPONENTS[part].into(), end.into()) as u16,
            kind,
            size: random.octaves(LEAST_SIZE, size_of(SEARCHED - 1)),
            column: random.pick(0..COLUMNS as i32) as usize,
        }
    }

    /// The error there according to a table.
    #[must_use]
    pub fn entry(&self, table: &Table) -> f64 {
        let part = LEAST_EXPONENTS.iter().rposition(|&least| self.exponent >= least).unwrap_or(0);
        let octaves = (self.size / LEAST_SIZE).log2();
        let row = (octaves as usize).min(ROWS - 2);
        let [less, more] = [row, row + 1].map(|row| f64::from(table[part][self.kind][row][self.column]) / f64::from(1 << SHARE));
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

/// The table as a file of the core.
#[must_use]
pub fn source(table: &Table, effort: u32, seed: u64) -> String {
    let mut text = format!(
        "//! The table of `highlight_error`, written by `microphong bounds --effort {effort} --seed {seed}`.\n\n\
         use super::{{Errors, KINDS, LEAST_EXPONENTS}};\n\n\
         /// For each range of exponents, and each kind of error: rows by size, columns by the distance from the peak.\n\
         #[rustfmt::skip]\n\
         pub static ERRORS: [[Errors; KINDS]; LEAST_EXPONENTS.len()] = [\n"
    );
    for part in table {
        text.push_str("    [\n");
        for kind in part {
            text.push_str("        [\n");
            for row in kind {
                let row: Vec<_> = row.iter().map(u16::to_string).collect();
                let (one, two) = row.split_at(COLUMNS / 2);
                // A String takes all that is written.
                let _ = write!(
                    text,
                    "            [\n                {},\n                {},\n            ],\n",
                    one.join(", "),
                    two.join(", ")
                );
            }
            text.push_str("        ],\n");
        }
        text.push_str("    ],\n");
    }
    text.push_str("];\n");
    text
}
