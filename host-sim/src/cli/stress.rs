//! `microphong stress`.

use super::{
    Outcome, Usage,
    parse::{self, Several},
    report,
};
use anyhow::{Result, ensure};
use microphong::format::ErrorBudget;
use microphong_sim::{
    families, output,
    stress::{self, Failure, Family, Kind, Summary},
};
use std::{
    path::PathBuf,
    time::{Duration, Instant},
};

/// Search for scenes that are drawn wrong, with random cases and exact checks
///
/// A family is one kind of case. It makes random cases, and checks them without any code of the renderer. A failure does not end the run. The command
/// makes the worst failure of each method as small as possible, writes it as a stream, and prints the command that draws it. Case N of a seed is the
/// same in every run.
#[derive(clap::Args)]
#[command(after_help = after_help())]
pub(crate) struct Arguments {
    /// Seconds to run, divided between the families.
    #[arg(long, default_value_t = 10.0, value_name = "N", value_parser = seconds)]
    seconds: f64,
    /// Number of cases for each family, instead of --seconds.
    #[arg(long, value_name = "N", conflicts_with = "seconds", value_parser = parse::count)]
    cases: Option<u64>,
    /// Seed of the random cases. The default is a random seed.
    #[arg(long, value_name = "S", value_parser = parse::whole)]
    seed: Option<u64>,
    /// Number of the first case of each family. With --cases 1 only this case runs.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = parse::whole)]
    first: u64,
    /// Families, separated by commas, or all.
    #[arg(long, default_value = "all", value_name = "NAME,...", value_parser = only)]
    only: Several<&'static str>,
    /// Error budget of the family `budget`, in 1/255, from 0.5 to 16. By default each case has a random budget.
    #[arg(long, value_name = "LSB", value_parser = parse::budget)]
    budget: Option<ErrorBudget>,
    /// Directory for streams of failures.
    #[arg(long, default_value = ".", value_name = "FOLDER")]
    artefacts: PathBuf,
    /// Print one JSON object per family.
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  microphong stress                                  all families for ten seconds
  microphong stress --seconds 3600 --seed 7          all families for an hour
  microphong stress --only arithmetic,sameness       two families
  microphong stress --only budget --budget 1         auto against Phong shading, with one budget
  microphong stress --only coverage --seed 7 --first 4711 --cases 1    repeat one case

A build with overflow checks also finds overflows: cargo run --profile stress -- stress";

/// Help text of the family that this build lacks.
const WITHOUT_BOARDS: &str = "\n  cost        with --features boards: a frame needs no more instructions than documented";

/// The examples, and the assertion of each family.
fn after_help() -> String {
    let families = families(None);
    let lines: Vec<_> = families.iter().map(|family| format!("  {:11} {}", family.name(), family.about())).collect();
    let missing = if cfg!(feature = "boards") { "" } else { WITHOUT_BOARDS };
    format!("{EXAMPLES}\n\nFamilies:\n{}{missing}", lines.join("\n"))
}

/// Four months.
const LONGEST: f64 = 1e7;

fn seconds(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|&seconds: &f64| seconds > 0.0 && seconds <= LONGEST)
        .ok_or_else(|| format!("more than 0 seconds are needed, and at most {LONGEST}"))
}

fn only(text: &str) -> Result<Several<&'static str>, String> {
    let names: Vec<_> = families(None).iter().map(|family| family.name()).collect();
    parse::several(text, &names, |text| parse::among(text, &names, |name| name))
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    if !arguments.artefacts.is_dir() {
        return Err(Usage(format!("{} is not a directory; name one that exists with --artefacts", arguments.artefacts.display())).into());
    }
    if arguments.budget.is_some() && !arguments.only.values.contains(&"budget") {
        return Err(Usage("--budget needs the family budget, which --only leaves out".to_owned()).into());
    }
    let seed = arguments.seed.unwrap_or_else(|| {
        std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |time| time.as_nanos() as u64 % 1_000_000)
    });
    let families: Vec<_> = families(arguments.budget).into_iter().filter(|family| arguments.only.values.contains(&family.name())).collect();
    if !arguments.json {
        report::line(&format!("seed {seed}"))?;
    }
    let (mut failed, mut cases) = (false, 0);
    for family in &families {
        let summary = look(&**family, arguments, seed, arguments.seconds / families.len() as f64)?;
        cases += summary.cases;
        if arguments.json {
            report::json(&summary)?;
        } else {
            report::line(&text(&summary))?;
        }
        for failure in &summary.breaks {
            failed = true;
            tell(family.name(), seed, failure, arguments)?;
        }
    }
    ensure!(cases > 0, "no case was judged; use more --seconds, or more --cases");
    Ok(if failed { Outcome::Differences } else { Outcome::Done })
}

/// Runs one family, with a bar.
fn look(family: &dyn Family, arguments: &Arguments, seed: u64, seconds: f64) -> Result<Summary> {
    let begin = Instant::now();
    let bar = report::progress(arguments.cases.unwrap_or(seconds.ceil() as u64), family.name());
    let clock = |count: u64| {
        let gone = begin.elapsed();
        bar.set_position(if arguments.cases.is_some() { count } else { gone.as_secs() });
        arguments.cases.map_or(gone < Duration::from_secs_f64(seconds), |cases| count < cases)
    };
    let summary = stress::run(family, seed, arguments.first, &clock);
    bar.finish_and_clear();
    Ok(summary)
}

fn text(summary: &Summary) -> String {
    let Summary { family, cases, skipped, counts, worst, limit, unit, failures, kinds, .. } = summary;
    let counts: String = counts.iter().map(|(name, count)| format!(", {} {name}", report::grouped(*count))).collect();
    let figure = match (worst, limit) {
        (Some(worst), Some(limit)) => format!(", worst {worst:.3e} of at most {limit:.3e} {unit}"),
        _ => String::new(),
    };
    let verdict = match failures {
        0 if *cases == 0 => "nothing to judge".to_owned(),
        0 => "all right".to_owned(),
        _ => format!("{} WRONG", report::grouped(*failures)),
    };
    let (cases, skipped) = (report::grouped(*cases), report::grouped(*skipped));
    let of_kind = |kind: &Kind| {
        format!("\n  {:18} {:>9} cases, worst {:.3} in case {}", kind.name, report::grouped(kind.cases), kind.worst, kind.number)
    };
    let kinds: String = kinds.iter().filter(|kind| !kind.name.is_empty()).map(of_kind).collect();
    format!("{family:11} {cases:>12} cases ({skipped} made none){counts}: {verdict}{figure}{kinds}")
}

/// Writes the stream of a failure, and says how to see it.
fn tell(family: &str, seed: u64, failure: &Failure, arguments: &Arguments) -> Result<()> {
    let Failure { number, what, case, .. } = failure;
    report::error(&format!("{family}, case {number} of seed {seed}: {what}"));
    if let Some(case) = case {
        let file = arguments.artefacts.join(format!("{family}-{seed}-{number}.tri"));
        output::write(&file, case.stream.as_bytes())?;
        report::error(&format!("  to draw its scene, made as small as possible: {}", case.command(&file)));
    }
    let budget = arguments.budget.map_or(String::new(), |budget| format!(" --budget {budget}"));
    report::error(&format!("  to repeat it: microphong stress --only {family} --seed {seed} --first {number} --cases 1{budget}"));
    Ok(())
}
