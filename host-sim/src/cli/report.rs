//! What a command prints: results on stdout, errors and progress on stderr.

use anyhow::{Context, Result};
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use log::{LevelFilter, Log, Metadata, Record};
pub(crate) use microphong_sim::number::grouped;
use microphong_sim::{choices::Choices, convert::Steps, output};
use serde::Serialize;
use std::{
    cell::RefCell,
    io::Write,
    path::Path,
    sync::{
        LazyLock,
        atomic::{AtomicBool, Ordering},
        mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

/// All progress bars. They make room for other output.
static BARS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// Whether standard output is the file that the command writes.
static TAKEN: AtomicBool = AtomicBool::new(false);

/// Sends results to stderr from now on if `output` is standard output, because they are not part of that file.
pub(crate) fn leave_to(output: &Path) {
    TAKEN.store(output::is_stdout(output), Ordering::Relaxed);
}

/// Prints one line; a closed pipe is an error, not a panic.
pub(crate) fn line(text: &str) -> Result<()> {
    if TAKEN.load(Ordering::Relaxed) {
        return writeln!(std::io::stderr().lock(), "{text}").context("cannot write to standard error");
    }
    writeln!(std::io::stdout().lock(), "{text}").context("cannot write to standard output")
}

/// Prints one JSON object on a line.
pub(crate) fn json(object: &impl Serialize) -> Result<()> {
    line(&serde_json::to_string(object)?)
}

/// Prints the shares of triangles and pixels that the method auto draws in each way, with its budget in 1/255.
pub(crate) fn choices((budget, choices): &(f64, Choices)) -> Result<()> {
    line(&format!("    budget {budget} LSB; {choices}"))
}

/// Prints an error with its causes.
pub(crate) fn failure(error: &anyhow::Error) {
    // Nobody left to tell when stderr is closed.
    let _ = writeln!(std::io::stderr().lock(), "error: {error:#}");
}

/// Prints a line on stderr.
pub(crate) fn error(text: &str) {
    // Nobody left to tell when stderr is closed.
    let _ = BARS.suspend(|| writeln!(std::io::stderr().lock(), "{text}"));
}

/// Work that takes less is silent.
const LONG: Duration = Duration::from_secs(1);
/// Between lines that tell how far long work is, where no bar shows it.
const SILENCE: Duration = Duration::from_secs(30);

/// Steps of work. Long work is announced on stderr: by a bar on a terminal, and by lines elsewhere.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Tells of the work until its end, which the first of them is for. A thread, because a single step may take long.
    teller: Option<(Sender<()>, JoinHandle<()>)>,
}

/// Work of `count` steps.
pub(crate) fn progress(count: u64, what: &'static str) -> Progress {
    let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::hidden());
    let (end, ended) = channel();
    let told = bar.clone();
    Progress { bar, teller: Some((end, thread::spawn(move || tell(&told, what, &ended)))) }
}

/// Tells of work when it has become long, and how far it is.
fn tell(bar: &ProgressBar, what: &'static str, ended: &Receiver<()>) {
    let goes_on = |time| ended.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
    if !goes_on(LONG) {
        return;
    }
    if !BARS.is_hidden() {
        if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {elapsed}, {eta} to go") {
            bar.set_style(style);
        }
        bar.set_message(what);
        BARS.add(bar.clone()).enable_steady_tick(LONG);
        return;
    }
    match bar.length() {
        Some(count @ 2..) => {
            log::info!("{what}, {count} steps");
            while goes_on(SILENCE) {
                log::info!("{what}, {} of {count} steps", bar.position());
            }
        }
        _ => log::info!("{what}"),
    }
}

impl Progress {
    /// More steps are done.
    pub(crate) fn inc(&self, steps: u64) {
        self.bar.inc(steps);
    }

    /// So many steps are done.
    pub(crate) fn set_position(&self, steps: u64) {
        self.bar.set_position(steps);
    }

    /// Prints something that is not part of the bar.
    pub(crate) fn suspend<T>(&self, print: impl FnOnce() -> T) -> T {
        self.bar.suspend(print)
    }

    /// All is done.
    pub(crate) fn finish_and_clear(self) {}
}

/// Work ends where nobody counts its steps any more, on errors too.
impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((end, teller)) = self.teller.take() {
            drop(end);
            // It cannot panic.
            let _ = teller.join();
        }
        self.bar.finish_and_clear();
    }
}

/// The progress of each step of a conversion, one after the other.
#[derive(Default)]
pub(crate) struct Bars(RefCell<Option<Progress>>);

impl Steps for Bars {
    fn begin(&self, what: &'static str, count: usize) {
        // The work before ends first.
        drop(self.0.take());
        self.0.replace(Some(progress(count as u64, what)));
    }

    fn step(&self) {
        self.0.borrow().iter().for_each(|bar| bar.inc(1));
    }

    fn warn(&self, what: &str) {
        error(&format!("warning: {what}"));
    }
}

/// Prints on stderr how far long work is.
struct Announcer;

impl Log for Announcer {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        // Libraries have more to say than anybody wants to know.
        metadata.target().starts_with("microphong")
    }

    fn log(&self, record: &Record<'_>) {
        if self.enabled(record.metadata()) {
            // Nobody left to tell when stderr is closed.
            let _ = BARS.suspend(|| writeln!(std::io::stderr().lock(), "{} ...", record.args()));
        }
    }

    fn flush(&self) {}
}

/// Announces long work from now on.
pub(crate) fn start() {
    // Fails where it has been called before: then it need not.
    if log::set_logger(&Announcer).is_ok() {
        log::set_max_level(LevelFilter::Info);
    }
}

/// A number with the noun for one thing or for several.
pub(crate) fn counted(number: impl TryInto<u64>, [one, many]: [&str; 2]) -> String {
    let number = number.try_into().unwrap_or(u64::MAX);
    format!("{} {}", grouped(number), if number == 1 { one } else { many })
}

/// The noun for one triangle and for several.
pub(crate) const TRIANGLES: [&str; 2] = ["triangle", "triangles"];
pub(crate) const VERTICES: [&str; 2] = ["vertex", "vertices"];
pub(crate) const FRAMES: [&str; 2] = ["frame", "frames"];
