//! Recorded sizes of programs, in a file that is kept with the sources. It has one line for each program, with the mesh of the teapot.

use super::{Core, FORMATS, Program, SHADERS, Size, measure};
use crate::{
    baseline::TOLERANCE,
    renewal::{mean, with_reason},
};
use anyhow::{Context, Result, ensure};
use microphong_models::scene;
use microphong_render::output;
use std::{
    fmt, fs,
    path::{Path, PathBuf},
};

/// The scene whose mesh the programs have room for.
pub const SCENE: &str = "teapot";

const HEAD: &str = "core,format,shader,flash_bytes,ram_bytes,stack_bytes";
const REASONS: &str = "\
# Why sizes were renewed

A line for each renewal, the newest last, which `microphong size --renew` adds: the change of all programs together in percent, their
geometric mean, and the reason.

| flash | RAM | stack | reason |
|---|---|---|---|
";

/// A line of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The program.
    pub program: Program,
    /// Bytes of flash, without the mesh.
    pub flash: u64,
    /// Bytes of static variables.
    pub ram: u64,
    /// Bytes of stack; 0 where they are unknown.
    pub stack: u64,
}

impl Entry {
    fn parse(line: &str) -> Result<Self> {
        let words: Vec<_> = line.split(',').map(str::trim).collect();
        let [core, format, shader, flash, ram, stack] = words[..] else {
            anyhow::bail!("{} words instead of those of `{HEAD}`", words.len());
        };
        let number = |word: &str| word.parse::<u64>().with_context(|| format!("`{word}` is no number"));
        let core = Core::ALL.into_iter().find(|other| other.name() == core).with_context(|| format!("no processor {core}"))?;
        let format = FORMATS.into_iter().find(|other| other.name() == format).with_context(|| format!("no pixel format {format}"))?;
        let shader = SHADERS.into_iter().find(|other| other.name() == shader).with_context(|| format!("no method {shader}"))?;
        Ok(Self { program: Program { core, shader, format }, flash: number(flash)?, ram: number(ram)?, stack: number(stack)? })
    }

    const fn figures(&self) -> [(&'static str, u64); 3] {
        [("flash", self.flash), ("RAM", self.ram), ("stack", self.stack)]
    }

    /// Figures that are more than the tolerance from the `recorded` ones, in words, and whether they are larger.
    #[must_use]
    pub fn changes(&self, recorded: &Self) -> Vec<(String, bool)> {
        let Program { core, shader, format } = self.program;
        let change = |((what, is), (_, was)): ((&str, u64), (&str, u64))| {
            let percent = (is as f64 - was as f64) / was.max(1) as f64 * 100.0;
            let text = format!("{} in {} on {}: {what} {was} -> {is} ({percent:+.2} %)", shader.name(), format.name(), core.name());
            (percent.abs() > TOLERANCE).then_some((text, is > was))
        };
        self.figures().into_iter().zip(recorded.figures()).filter_map(change).collect()
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { program: Program { core, shader, format }, flash, ram, stack } = self;
        write!(f, "{},{},{},{flash},{ram},{stack}", core.name(), format.name(), shader.name())
    }
}

/// Reads a file.
///
/// # Errors
/// Names file and line.
pub fn read(path: &Path) -> Result<Vec<Entry>> {
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty() && *line != HEAD);
    let entries = lines.map(|(number, line)| Entry::parse(line).with_context(|| format!("{}, line {number}", path.display())));
    let entries = entries.collect::<Result<Vec<_>>>()?;
    ensure!(!entries.is_empty(), "{} has no line: `{HEAD}` and a program in each line are needed", path.display());
    Ok(entries)
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
        stack: stack_bytes.unwrap_or(0),
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
        let old = Entry::parse("cortex-m3,binary,gouraud,1000,2000,0").unwrap();
        assert_eq!(old.to_string(), "cortex-m3,binary,gouraud,1000,2000,0");
        assert!(Entry { flash: 1002, ram: 1996, ..old }.changes(&old).is_empty());
        let changes = Entry { flash: 1003, ram: 1995, ..old }.changes(&old);
        let named =
            ["flash 1000 -> 1003 (+0.30 %)", "RAM 2000 -> 1995 (-0.25 %)"].map(|text| format!("gouraud in binary on cortex-m3: {text}"));
        assert_eq!(changes, named.into_iter().zip([true, false]).collect::<Vec<_>>());
    }

    #[test]
    fn damaged_lines_say_what_is_wrong() {
        for (line, message) in [
            ("cortex-m3,binary,gouraud,1", "4 words"),
            ("cortex-m3,binary,gouraud,1,x,1", "`x` is no number"),
            ("m3,binary,gouraud,1,1,1", "no processor m3"),
            ("cortex-m3,gray4,gouraud,1,1,1", "no pixel format gray4"),
            ("cortex-m3,binary,flat,1,1,1", "no method flat"),
        ] {
            let error = format!("{:#}", Entry::parse(line).unwrap_err());
            assert!(error.contains(message), "{error}");
        }
    }
}
