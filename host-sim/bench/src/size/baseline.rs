//! Recorded sizes of programs, in a file that is kept with the sources. It has one line for each program, with the mesh of the teapot.

use super::{Size, measure};
use crate::{
    baseline::TOLERANCE,
    renewal::{mean, with_reason},
};
use anyhow::{Context, Result};
use microphong_models::scene;
use microphong_render::{
    output,
    program::{Entry, HEAD, Program},
};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// The scene whose mesh the programs have room for.
pub const SCENE: &str = "teapot";

const REASONS: &str = "\
# Why sizes were renewed

A line for each renewal, the newest last, which `microphong size --renew` adds: the change of all programs together in percent, their
geometric mean, and the reason.

| flash | RAM | stack | reason |
|---|---|---|---|
";

/// Reads a file.
///
/// # Errors
/// Names file and line.
pub fn read(path: &Path) -> Result<Vec<Entry>> {
    let place = || path.display().to_string();
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", place()))?;
    Entry::all(&text).with_context(place)
}

/// Figures that are more than the tolerance from the `recorded` ones, in words, and whether they are larger.
#[must_use]
pub fn changes(measured: &Entry, recorded: &Entry) -> Vec<(String, bool)> {
    let Program { core, features, shader, format } = measured.program;
    let change = |(what, is, was): (&str, u64, u64)| {
        let percent = (is as f64 - was as f64) / was.max(1) as f64 * 100.0;
        let program = format!("{} in {} on {}, features {}", shader.name(), format.name(), core.name(), features.name());
        let text = format!("{program}: {what} {was} -> {is} ({percent:+.2} %)");
        (percent.abs() > TOLERANCE).then_some((text, is > was))
    };
    let figures =
        [("flash", measured.flash, recorded.flash), ("RAM", measured.ram, recorded.ram), ("stack", measured.stack, recorded.stack)];
    figures.into_iter().filter_map(change).collect()
}

/// Measures again what the lines say, in their order.
///
/// # Errors
/// When a program does not compile or cannot be run.
pub fn again(recorded: &[Entry], tick: &(dyn Fn() + Sync)) -> Result<Vec<Entry>> {
    let programs: Vec<_> = recorded.iter().map(|entry| entry.program).collect();
    let sizes = measure(&programs, &scene::load(SCENE)?, tick)?;
    let entry = |(program, Size { flash_bytes, ram_bytes, stack_bytes, .. })| Entry {
        program,
        flash: flash_bytes,
        ram: ram_bytes,
        stack: stack_bytes,
    };
    Ok(programs.into_iter().zip(sizes).map(entry).collect())
}

/// Records the `new` figures in the file at `path`, and beside it why they are not the `old` ones. Returns where the reason stands.
///
/// # Errors
/// When a file cannot be written, or there is no reason.
pub fn renew(path: &Path, [old, new]: [&[Entry]; 2], reason: &str) -> Result<PathBuf> {
    let change = |figure: fn(&Entry) -> u64| mean(old.iter().zip(new).map(|(old, new)| (figure(old), figure(new))));
    let changes = [change(|entry| entry.flash), change(|entry| entry.ram), change(|entry| entry.stack)];
    with_reason(path, REASONS, &changes, reason, || {
        let lines: Vec<_> = std::iter::once(HEAD.to_owned()).chain(new.iter().map(Entry::to_string)).collect();
        output::write(path, (lines.join("\n") + "\n").as_bytes())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_beyond_the_tolerance_is_named() {
        let line = "cortex-m3,none,binary,gouraud,1000,2000,100";
        let old = Entry::all(line).unwrap()[0];
        assert_eq!(old.to_string(), line);
        assert!(changes(&Entry { flash: 1002, ram: 1996, ..old }, &old).is_empty());
        let changes = changes(&Entry { flash: 1003, ram: 1995, ..old }, &old);
        let named = ["flash 1000 -> 1003 (+0.30 %)", "RAM 2000 -> 1995 (-0.25 %)"]
            .map(|text| format!("gouraud in binary on cortex-m3, features none: {text}"));
        assert_eq!(changes, named.into_iter().zip([true, false]).collect::<Vec<_>>());
    }
}
