//! What a command prints: results on stdout, errors and progress on stderr.

use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::io::Write;

/// Prints one line; a closed pipe is an error, not a panic.
pub(crate) fn line(text: &str) -> Result<()> {
    writeln!(std::io::stdout().lock(), "{text}").context("cannot write to standard output")
}

/// Prints one JSON object on a line.
pub(crate) fn json(object: &impl Serialize) -> Result<()> {
    line(&serde_json::to_string(object)?)
}

/// Prints an error with its causes.
pub(crate) fn failure(error: &anyhow::Error) {
    // Nobody left to tell when stderr is closed.
    let _ = writeln!(std::io::stderr().lock(), "error: {error:#}");
}

/// A bar on stderr for `count` steps; silent for a single step, and when stderr is no terminal.
pub(crate) fn progress(count: u64, what: &'static str) -> ProgressBar {
    if count < 2 {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(count);
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}") {
        bar.set_style(style);
    }
    bar.with_message(what)
}

/// 12345 as 12,345.
pub(crate) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
