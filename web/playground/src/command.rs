//! The native commands that make the same file and the same picture.

use crate::{
    choices::{Choices, Reading},
    edit,
};
use anyhow::Result;

/// A command of this repository.
const RUN: &str = "cargo run --release --";

/// What is drawn.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// A built-in scene.
    BuiltIn(String),
    /// A file.
    File(String),
}

impl Source {
    /// The file's name, or the name of the scene.
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::BuiltIn(name) | Self::File(name) => name,
        }
    }
}

/// The command that draws the same picture.
pub(crate) fn render(source: &Source, reading: &Reading, choices: &Choices, stem: &str, size: (u32, u32)) -> Result<String> {
    let is_changed = edit::is_changed(choices);
    let mut words = vec!["render".to_owned()];
    if is_changed {
        words.push(quoted(&format!("{stem}.tri")));
    } else {
        words.push(quoted(source.name()));
        words.extend(if matches!(source, Source::File(_)) { options(reading) } else { Vec::new() });
    }
    if let Some(method) = &choices.method {
        words.push(format!("--shader {method}"));
    }
    if let Some(budget) = choices.budget {
        words.push(format!("--budget {budget}"));
    }
    words.push(format!("--size {}x{}", size.0, size.1));
    words.push(format!("--format {}", choices.format));
    if choices.frame > 0 {
        words.push(format!("--first {}", choices.frame));
    }
    if !choices.dither && choices.format()?.is_dithered() {
        words.push("--no-dither".to_owned());
    }
    if choices.srgb {
        words.push("--gamma srgb".to_owned());
    }
    if !choices.antialias {
        words.push("--no-antialias".to_owned());
    }
    Ok(format!("{RUN} {}", words.join(" ")))
}

/// The command that makes the same stream of a mesh file; `None` where there is none, because the scene is built in or has been changed.
pub(crate) fn convert(source: &Source, reading: &Reading, choices: &Choices, stem: &str) -> Option<String> {
    let Source::File(name) = source else { return None };
    if edit::is_changed(choices) || name.ends_with(".tri") {
        return None;
    }
    let mut words = vec!["convert".to_owned(), quoted(name)];
    words.extend(options(reading));
    words.extend(choices.method.as_ref().map(|method| format!("--shader {method}")));
    words.extend(choices.budget.map(|budget| format!("--budget {budget}")));
    words.extend(choices.antialias.then(|| "--antialias".to_owned()));
    words.push(format!("-o {}", quoted(&format!("{stem}.tri"))));
    Some(format!("{RUN} {}", words.join(" ")))
}

/// Options of reading a mesh file.
fn options(reading: &Reading) -> Vec<String> {
    let mut words = Vec::new();
    words.extend(reading.up.as_ref().map(|up| format!("--up {up}")));
    words.extend(reading.flip.then(|| "--flip".to_owned()));
    words.extend(reading.simplify.map(|most| format!("--simplify {most}")));
    words
}

/// A word of a command line, in quotes if a shell would read it otherwise.
fn quoted(word: &str) -> String {
    let is_plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "-_./".contains(c)) && !word.starts_with('-');
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
