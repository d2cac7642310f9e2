//! Recorded costs of frames, in a file that is kept with the sources.
//!
//! Each line is a frame: board, scene, method, instructions, bytes of flash. In a file of styles the name of the style follows the method. The lines
//! choose what is measured. To add a frame, add a line with zeros and renew the file.

use super::{
    Bench, Measurement, Processor,
    board_styles::{BoardStyle, PLAIN},
};
use anyhow::{Context, Result, ensure};
use microphong_models::scene::{self, Scene};
use microphong_render::{output, shader::Shader};
use std::{fmt, fs, path::Path};

/// Growth of instructions or flash that is let pass, in percent. A shrinkage of more asks to renew the file, or it would hide later growth.
pub const TOLERANCE: f64 = 0.2;

const HEAD: &str = "board,scene,shader,instructions,flash_bytes";
/// The first line of a file of styles.
const STYLED_HEAD: &str = "board,scene,shader,style,instructions,flash_bytes";

/// A line of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The processor that executes the frame.
    pub processor: Processor,
    /// The scene's name.
    pub scene: String,
    /// The method.
    pub shader: Shader,
    /// The style.
    pub style: &'static BoardStyle,
    /// Instructions of the frame, without clearing and transfer.
    pub instructions: u64,
    /// Flash of the method, in bytes; see [`Measurement::flash_bytes`].
    pub flash_bytes: u64,
}

impl Entry {
    pub(super) fn parse(line: &str) -> Result<Self> {
        let words: Vec<_> = line.split(',').map(str::trim).collect();
        let (board, scene, shader, style, instructions, flash_bytes) = match words[..] {
            [board, scene, shader, instructions, flash_bytes] => (board, scene, shader, PLAIN.name, instructions, flash_bytes),
            [board, scene, shader, style, instructions, flash_bytes] => (board, scene, shader, style, instructions, flash_bytes),
            _ => anyhow::bail!("{} words instead of those of `{HEAD}` or `{STYLED_HEAD}`", words.len()),
        };
        let processor = Processor::ALL.into_iter().find(|processor| processor.board_name() == board);
        let shader = Shader::ALL.into_iter().find(|other| other.name() == shader).with_context(|| format!("no method {shader}"))?;
        Ok(Self {
            processor: processor.with_context(|| format!("no board {board}"))?,
            scene: scene.to_owned(),
            shader,
            style: BoardStyle::named(style).with_context(|| format!("no style {style}"))?,
            instructions: instructions.parse().with_context(|| format!("`{instructions}` is no number"))?,
            flash_bytes: flash_bytes.parse().with_context(|| format!("`{flash_bytes}` is no number"))?,
        })
    }

    /// The entry of a frame that is not measured yet.
    #[must_use]
    pub fn unmeasured(processor: Processor, scene: &str, shader: Shader, style: &'static BoardStyle) -> Self {
        Self { processor, scene: scene.to_owned(), shader, style, instructions: 0, flash_bytes: 0 }
    }

    /// Whether both entries are for one frame.
    #[must_use]
    pub fn same_frame(&self, other: &Self) -> bool {
        (self.processor, &self.scene, self.shader, self.style) == (other.processor, &other.scene, other.shader, other.style)
    }

    /// The entry for this frame with the figures that were measured now.
    #[must_use]
    fn renewed(&self, now: &Measurement) -> Self {
        Self { instructions: now.instructions, flash_bytes: now.flash_bytes.unwrap_or(0), ..self.clone() }
    }

    /// The line of the entry. In a file of styles it names the style.
    fn line(&self, is_styled: bool) -> String {
        let Self { processor, scene, shader, style, instructions, flash_bytes } = self;
        let style = if is_styled { format!("{},", style.name) } else { String::new() };
        format!("{},{scene},{},{style}{instructions},{flash_bytes}", processor.board_name(), shader.name())
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line(self.style != PLAIN))
    }
}

/// A figure that has changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The entry of the frame.
    pub entry: Entry,
    /// The unit of the figure: instructions or bytes of flash.
    pub what: &'static str,
    /// The recorded figure.
    pub was: u64,
    /// The measured figure.
    pub is: u64,
}

impl Change {
    /// Percent; positive is growth.
    #[must_use]
    pub fn percent(&self) -> f64 {
        (self.is as f64 - self.was as f64) / self.was.max(1) as f64 * 100.0
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Entry { processor, scene, shader, style, .. } = &self.entry;
        let style = if *style == PLAIN { String::new() } else { format!(" in the style {}", style.name) };
        let (shader, cpu, Self { what, was, is, .. }) = (shader.name(), processor.name(), self);
        write!(f, "{shader} on {cpu}, {scene}{style}: {what} {was} -> {is} ({:+.2} %)", self.percent())
    }
}

/// Changes between lines and what was measured for them.
#[must_use]
pub fn changed(recorded: &[Entry], measured: &[Entry]) -> Vec<Change> {
    let pairs = recorded.iter().zip(measured).flat_map(|(entry, now)| {
        let instructions = ("instructions", entry.instructions, now.instructions);
        let flash = ("bytes of flash", entry.flash_bytes, now.flash_bytes);
        [instructions, flash].map(|(what, was, is)| Change { entry: entry.clone(), what, was, is })
    });
    pairs.filter(|change| change.is != change.was).collect()
}

/// Figures that differ from their record by more than the [`TOLERANCE`].
#[must_use]
pub fn changes(recorded: &[Entry], measured: &[Entry]) -> Vec<Change> {
    changed(recorded, measured).into_iter().filter(|change| change.percent().abs() > TOLERANCE).collect()
}

/// Reads a file.
///
/// # Errors
/// Names file and line.
pub fn read(path: &Path) -> Result<Vec<Entry>> {
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty() && ![HEAD, STYLED_HEAD].contains(line));
    let entry = |(number, line)| Entry::parse(line).with_context(|| format!("{}, line {number}", path.display()));
    let entries = lines.map(entry).collect::<Result<Vec<_>>>()?;
    ensure!(!entries.is_empty(), "{} lists no frames", path.display());
    Ok(entries)
}

/// Writes a file.
///
/// # Errors
/// When it cannot be written.
pub fn write(path: &Path, entries: &[Entry]) -> Result<()> {
    let is_styled = entries.iter().any(|entry| entry.style != PLAIN);
    let head = if is_styled { STYLED_HEAD } else { HEAD };
    let lines: Vec<_> = std::iter::once(head.to_owned()).chain(entries.iter().map(|entry| entry.line(is_styled))).collect();
    output::write(path, (lines.join("\n") + "\n").as_bytes())
}

/// Measures again what the lines say, in their order.
///
/// # Errors
/// When a scene is unknown or a board fails.
pub fn measure(entries: &[Entry], tick: &(dyn Fn() + Sync)) -> Result<Vec<Entry>> {
    measure_with(entries, &scene::load, tick)
}

/// Measures as [`measure`] does, scenes that `load` knows by their names.
///
/// # Errors
/// When a scene is unknown or a board fails.
pub fn measure_with(entries: &[Entry], load: &dyn Fn(&str) -> Result<Scene>, tick: &(dyn Fn() + Sync)) -> Result<Vec<Entry>> {
    let mut measured = entries.to_vec();
    let mut frames = Vec::new();
    for (name, style) in distinct(entries.iter().map(|entry| (&entry.scene, entry.style.name))) {
        let style = BoardStyle::named(style).context("a style that was not there")?;
        let scene = style.of(&load(name)?)?;
        frames.push((style.program_for(&scene.stream)?, name, style, scene));
    }
    for program in distinct(frames.iter().map(|&(program, ..)| program)) {
        let drawn: Vec<_> = frames.iter().filter(|(of, ..)| *of == program).collect();
        let is_drawn = |entry: &&Entry| drawn.iter().any(|(_, name, style, _)| (&entry.scene, entry.style) == (*name, *style));
        let bench = Bench::of_program(&distinct(entries.iter().filter(is_drawn).map(|entry| entry.processor)), program)?;
        for (_, name, style, scene) in drawn {
            let is_it = |entry: &Entry| (&entry.scene, entry.style) == (*name, *style);
            let (places, wanted): (Vec<_>, Vec<_>) =
                (0..).zip(entries).filter(|(_, entry)| is_it(entry)).map(|(place, entry)| (place, (entry.processor, entry.shader))).unzip();
            let now = bench.count(scene, &wanted, tick)?;
            for (place, now) in places.into_iter().zip(&now) {
                let entry: &mut Entry = measured.get_mut::<usize>(place).context("a line that was not there")?;
                *entry = entry.renewed(now);
            }
        }
    }
    Ok(measured)
}

/// Each value once, in order.
fn distinct<T: Ord>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut values: Vec<_> = values.collect();
    values.sort_unstable();
    values.dedup();
    values
}

#[cfg(test)]
mod tests {
    use super::{Entry, changes};

    #[test]
    fn growth_beyond_the_tolerance_is_named() {
        let old = Entry::parse("mps2-an385,teapot,flat,1000,2000").unwrap();
        assert_eq!(old.to_string(), "mps2-an385,teapot,flat,1000,2000");
        let changes = |instructions, flash_bytes| {
            let now = Entry { instructions, flash_bytes, ..old.clone() };
            changes(std::slice::from_ref(&old), &[now]).iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert!(changes(1002, 2004).is_empty());
        let styled = Entry::parse("mps2-an385,teapot,flat,8-lights,1000,2000").unwrap();
        assert_eq!(styled.to_string(), "mps2-an385,teapot,flat,8-lights,1000,2000");
        assert!(!styled.same_frame(&old) && styled.same_frame(&styled));
        let change = super::changed(std::slice::from_ref(&styled), &[Entry { instructions: 1001, ..styled.clone() }]);
        assert_eq!(change[0].to_string(), "flat on cortex-m3, teapot in the style 8-lights: instructions 1000 -> 1001 (+0.10 %)");
        assert_eq!(changes(1003, 2004), ["flat on cortex-m3, teapot: instructions 1000 -> 1003 (+0.30 %)"]);
        assert_eq!(changes(1002, 1995), ["flat on cortex-m3, teapot: bytes of flash 2000 -> 1995 (-0.25 %)"]);
    }

    #[test]
    fn damaged_lines_say_what_is_wrong() {
        for (line, message) in [
            ("pico,teapot,flat,1", "4 words"),
            ("pico,teapot,flat,round,1,1", "no style round"),
            ("pico,teapot,flat,x,1", "`x` is no number"),
            ("pi,teapot,flat,1,1", "no board pi"),
        ] {
            let error = format!("{:#}", Entry::parse(line).unwrap_err());
            assert!(error.contains(message), "{error}");
        }
    }
}
