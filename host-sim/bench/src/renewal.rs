//! History of recorded costs: their change since a release, and the reason of each renewal.
//!
//! Beside a file `costs.csv` of [`baseline`] are two others: `costs-0.1.0.csv` has these frames at that release and is never renewed, and
//! `costs-reasons.md` has a line for each renewal. A tolerance lets small growth pass each time. The first file shows the sum.

use super::{
    baseline::{self, Change, Entry, changed},
    rounded,
};
use anyhow::{Context, Result, ensure};
use microphong_render::output;
use std::{
    fmt, fs,
    path::{Path, PathBuf},
};

/// The release whose costs are kept.
pub const RELEASE: &str = "0.1.0";

/// The change of all frames together, in percent: the geometric mean, in which all frames weigh alike.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Total {
    /// Change of instructions.
    pub instructions: f64,
    /// Change of flash.
    pub flash: f64,
}

impl Total {
    /// The change from the figures `old` to the figures of these frames in `new`.
    #[must_use]
    pub fn between(old: &[Entry], new: &[Entry]) -> Self {
        let pairs = || old.iter().filter_map(|entry| Some((entry, new.iter().find(|now| entry.same_frame(now))?)));
        Self {
            instructions: mean(pairs().map(|(was, is)| (was.instructions, is.instructions))),
            flash: mean(pairs().map(|(was, is)| (was.flash_bytes, is.flash_bytes))),
        }
    }
}

/// The geometric mean of changes, in percent. Figures of zero belong to frames that are not recorded yet, and are left out.
pub(crate) fn mean(pairs: impl Iterator<Item = (u64, u64)>) -> f64 {
    let logarithms: Vec<_> = pairs.filter(|&(was, is)| was > 0 && is > 0).map(|(was, is)| (is as f64 / was as f64).ln()).collect();
    let mean = logarithms.iter().sum::<f64>() / logarithms.len().max(1) as f64;
    // As it is shown; plus zero, or almost nothing might be shown as -0.
    rounded(mean.exp_m1() * 100.0, 100.0) + 0.0
}

impl fmt::Display for Total {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "instructions {:+.2} %, flash {:+.2} %", self.instructions, self.flash)
    }
}

/// The growth since [`RELEASE`].
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    /// Number of frames of the release that are still measured.
    pub frames: usize,
    /// Change of all frames together.
    pub total: Total,
    /// The single figure that has grown the most, if any has.
    pub most: Option<Change>,
}

impl Growth {
    /// The growth from the figures of the release to today's figures.
    #[must_use]
    pub fn between(release: &[Entry], now: &[Entry]) -> Self {
        let (old, new): (Vec<_>, Vec<_>) =
            release.iter().filter_map(|old| Some((old.clone(), now.iter().find(|now| old.same_frame(now))?.clone()))).unzip();
        let grown = changed(&old, &new).into_iter().filter(|change| change.is > change.was);
        let most = grown.max_by(|a, b| a.percent().total_cmp(&b.percent()));
        Self { frames: old.len(), total: Total::between(&old, &new), most }
    }

    /// The growth of the costs in the file at `path`; `None` if no figures of the release are beside it.
    ///
    /// # Errors
    /// When the figures cannot be read.
    pub fn of(path: &Path, now: &[Entry]) -> Result<Option<Self>> {
        let release = beside(path, &format!("{RELEASE}.csv"))?;
        release.exists().then(|| Ok(Self::between(&baseline::read(&release)?, now))).transpose()
    }
}

impl fmt::Display for Growth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "since {RELEASE}, mean of {} frames: {}", self.frames, self.total)?;
        self.most.iter().try_for_each(|most| write!(f, "; most: {most}"))
    }
}

/// `costs-NAME` for `costs.csv`.
fn beside(path: &Path, name: &str) -> Result<PathBuf> {
    let stem = path.file_stem().with_context(|| format!("{} is no file", path.display()))?;
    Ok(path.with_file_name(format!("{}-{name}", stem.to_string_lossy())))
}

/// The beginning of the file of reasons.
const HEAD: &str = "\
# Why costs were renewed

A line for each renewal, the newest last, which `microphong bench --renew` adds: the change of all frames together in percent, their
geometric mean, and the reason.

| instructions | flash | reason |
|---|---|---|
";

/// Records the `new` figures in the file at `path`, and beside it why they are not the `old` ones. Returns where the reason stands.
///
/// # Errors
/// When a file cannot be written, or there is no reason.
pub fn renew(path: &Path, [old, new]: [&[Entry]; 2], reason: &str) -> Result<PathBuf> {
    let Total { instructions, flash } = Total::between(old, new);
    with_reason(path, HEAD, &[instructions, flash], reason, || baseline::write(path, new))
}

/// Lets `write` renew the file at `path`, and adds a line to the reasons beside it, which begin with `head`: changes in percent, and why. Returns
/// where the reasons stand.
///
/// # Errors
/// When a file cannot be written, or there is no reason.
pub(crate) fn with_reason(path: &Path, head: &str, changes: &[f64], reason: &str, write: impl FnOnce() -> Result<()>) -> Result<PathBuf> {
    // A line, and a cell of a table.
    let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|");
    ensure!(!reason.is_empty(), "a reason is needed");
    let target = beside(path, "reasons.md")?;
    let before = if target.exists() { fs::read_to_string(&target) } else { Ok(head.to_owned()) };
    let before = before.with_context(|| format!("cannot read {}", target.display()))?;
    let changes: String = changes.iter().map(|change| format!("{change:+.2} | ")).collect();
    let text = format!("{}\n| {changes}{reason} |\n", before.trim_end());
    write()?;
    output::write(&target, text.as_bytes())?;
    Ok(target)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(lines: &[&str]) -> Vec<Entry> {
        lines.iter().map(|line| Entry::parse(line).unwrap()).collect()
    }

    #[test]
    fn each_frame_weighs_the_same() {
        let old = entries(&["pico,teapot,flat,1000,200", "pico,teapot,phong,100000,200", "pico,bunny,flat,0,0"]);
        let new = entries(&["pico,bunny,flat,5,5", "pico,teapot,flat,2000,200", "pico,teapot,phong,50000,242"]);
        // Twice as much and half as much; once 21 % more; what was not measured before does not count.
        assert_eq!(Total::between(&old, &new).to_string(), "instructions +0.00 %, flash +10.00 %");
        assert_eq!(Total::between(&[], &new), Total::default());
    }

    #[test]
    fn growth_since_the_release_adds_up() {
        let release = entries(&["pico,teapot,flat,1000,200", "pico,gone,flat,1,1"]);
        let now = entries(&["pico,teapot,flat,1010,200", "pico,added,flat,7,7"]);
        let most = "; most: flat on cortex-m0plus, teapot: instructions 1000 -> 1010 (+1.00 %)";
        let growth = Growth::between(&release, &now).to_string();
        assert_eq!(growth, format!("since 0.1.0, mean of 1 frames: instructions +1.00 %, flash +0.00 %{most}"));
        assert_eq!(Growth::between(&release, &release).most, None);
    }

    #[test]
    fn reasons_are_added_line_by_line() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("costs.csv");
        let [first, second] = [["pico,teapot,flat,1000,200"], ["pico,teapot,flat,1100,199"]].map(|lines| entries(&lines));
        assert_eq!(Growth::of(&path, &first).unwrap(), None);
        let reasons = renew(&path, [&first, &second], "sharper a|b").unwrap();
        assert_eq!(reasons, directory.path().join("costs-reasons.md"));
        renew(&path, [&second, &first], " two\nlines ").unwrap();
        let expected = format!("{HEAD}| +10.00 | -0.50 | sharper a\\|b |\n| -9.09 | +0.50 | two lines |\n");
        assert_eq!(fs::read_to_string(reasons).unwrap(), expected);
        assert_eq!(baseline::read(&path).unwrap(), first);

        renew(&path, [&first, &second], " ").unwrap_err();
        assert_eq!(baseline::read(&path).unwrap(), first);
        baseline::write(&directory.path().join("costs-0.1.0.csv"), &first).unwrap();
        assert_eq!(Growth::of(&path, &second).unwrap(), Some(Growth::between(&first, &second)));
    }
}
