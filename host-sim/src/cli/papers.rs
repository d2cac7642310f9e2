//! `microphong papers`.

use super::{
    Outcome,
    parse::{self, Several},
    report,
};
use anyhow::Result;
use microphong_sim::papers::{self, Claim, Topic, Verdict};

/// Check the claims of the papers by computing them again
///
/// The command computes with 64-bit floating point. It shows an error in a paper by an example. One LSB is 1/255 of full intensity.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Papers, separated by commas: vlasic, szirmay-kalos, bishop-weimer, disselkoen, goldman, or all.
    #[arg(long, value_name = "TOPIC,...", default_value = "all", value_parser = parse::topics)]
    only: Several<Topic>,
    /// Print one JSON object per claim.
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  microphong papers
  microphong papers --only vlasic,goldman
  microphong papers --json";

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let topics = &arguments.only.values;
    let bar = report::progress(topics.len() as u64 + 1, "computing claims");
    let mut counts = [0; Verdict::ALL.len()];
    for &topic in topics {
        bar.inc(1);
        let claims = papers::claims(topic)?;
        for claim in &claims {
            for (count, verdict) in counts.iter_mut().zip(Verdict::ALL) {
                *count += usize::from(claim.verdict == verdict);
            }
        }
        bar.suspend(|| if arguments.json { claims.iter().try_for_each(report::json) } else { text(&claims) })?;
    }
    bar.finish_and_clear();
    if !arguments.json {
        let parts: Vec<_> = counts.iter().zip(Verdict::ALL).map(|(count, verdict)| format!("{count} {}", verdict.name())).collect();
        report::line(&format!("{} claims: {}", counts.iter().sum::<usize>(), parts.join(", ")))?;
    }
    Ok(Outcome::Done)
}

/// What fits a line.
const WIDTH: usize = 100;

/// Columns of the claim and both figures.
const LEFT: usize = 69;

/// A table, with a heading for each place in the paper.
fn text(claims: &[Claim]) -> Result<()> {
    let mut source = "";
    for claim in claims {
        let Claim { what, unit, paper, ours, verdict, note, .. } = claim;
        if claim.source != source {
            source = &claim.source;
            report::line(&row(source, "paper", "ours"))?;
        }
        let figures = row(&format!("  {what}"), &paper.to_string(), &ours.to_string());
        report::line(format!("{figures} {unit:7} {}", verdict.name()).trim_end())?;
        for part in wrapped(note) {
            report::line(&format!("      {part}"))?;
        }
    }
    report::line("")
}

/// What the figures are, and the figures, to the right.
fn row(what: &str, paper: &str, ours: &str) -> String {
    let figures = format!("{paper:>10} {ours:>9}");
    format!("{what:0$}{figures}", LEFT.saturating_sub(figures.chars().count()))
}

/// A sentence in lines that leave room for their indentation.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let full = lines.last().is_some_and(|line| !line.is_empty() && line.chars().count() + 1 + word.chars().count() > WIDTH - 6);
        if full {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}
