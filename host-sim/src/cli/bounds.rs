//! `microphong bounds`.

use super::{Outcome, parse, report};
use anyhow::Result;
use microphong::method::auto::highlight_error::{COLUMNS, Growth, LEAST_EXPONENTS, ROWS, ROWS_BEHIND};
use microphong_sim::bounds::{Place, STEPS, Table, source, table, worst};
use serde::Serialize;

/// Search for the largest errors of interpolated highlights, and print the table that `auto` uses to choose methods
///
/// The table is a file of the core, shared/src/method/auto/highlight_error/table.rs. It holds the largest errors that were found, with a margin.
/// With --check the command prints no table. Instead it searches for triangles whose errors exceed the compiled table.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Number of triangles to try for each entry and exponent. A larger number takes longer and finds slightly larger errors.
    #[arg(long, default_value_t = 2000, value_name = "N", value_parser = clap::value_parser!(u32).range(40..))]
    effort: u32,
    /// Seed of the random triangles.
    #[arg(long, default_value_t = 1, value_name = "S", value_parser = parse::whole)]
    seed: u64,
    /// Search for larger errors at this number of places of the compiled table, and print no table.
    #[arg(long, value_name = "PLACES", value_parser = parse::count)]
    check: Option<u64>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  microphong bounds > shared/src/method/auto/highlight_error/table.rs    five minutes on two processors
  microphong bounds --check 100000 --effort 200 --seed 7            search for larger errors";

/// The kinds of error, in the order of the table.
const KINDS: [&str; 4] = ["linear, too dark", "linear, too bright", "quadratic", "cosines"];

/// The tables as they stand in the file of the core.
#[derive(Serialize)]
struct Tables {
    /// By range of exponents, column and kind: rate, base and slope.
    linear: [[[[u16; 3]; 2]; COLUMNS]; LEAST_EXPONENTS.len()],
    /// By range of exponents, row, column and kind.
    curved: [[Vec<[u16; 2]>; ROWS + ROWS_BEHIND]; LEAST_EXPONENTS.len()],
}

#[derive(Serialize)]
struct Line {
    kind: &'static str,
    places: u64,
    exponent: u16,
    size: f64,
    column: usize,
    error: f64,
    entry: f64,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let Arguments { effort, seed, check, json } = *arguments;
    if let Some(places) = check {
        return search(places, effort, seed, json);
    }
    let bar = report::progress(STEPS, "searching rows");
    let table = table(effort, seed, || bar.inc(1));
    bar.finish_and_clear();
    if json {
        report::json(&Tables {
            linear: table.linear.map(|columns| columns.map(|kinds| kinds.map(|Growth { rate, base, slope }| [rate, base, slope]))),
            curved: table.curved.map(|rows| rows.map(Vec::from)),
        })?;
    } else {
        report::line(source(&table, effort, seed).trim_end())?;
    }
    Ok(Outcome::Done)
}

/// Searches places of the compiled table for errors of each kind that are larger than it says.
fn search(places: u64, effort: u32, seed: u64, json: bool) -> Result<Outcome> {
    let mut outcome = Outcome::Done;
    for (number, kind) in KINDS.into_iter().enumerate() {
        let Some((Place { exponent, size, column, .. }, [error, entry])) = worst(&Table::compiled(), number, places, effort, seed) else {
            continue;
        };
        if error > entry {
            outcome = Outcome::Differences;
        }
        if json {
            report::json(&Line { kind, places, exponent, size, column, error, entry })?;
        } else {
            let place = format!("exponent {exponent}, n (1 - rho) {size:.5}, column {column}");
            report::line(&format!(
                "{kind}: worst of {places} places {:.4} of its entry, {:.3} LSB ({place})",
                error / entry,
                255.0 * error
            ))?;
        }
    }
    Ok(outcome)
}
