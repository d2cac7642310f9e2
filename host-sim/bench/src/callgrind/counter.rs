//! The counter of `stress`: one program that draws frames on request, because valgrind takes longer to start than to draw most frames.

use super::{Profile, not_started, valgrind};
use anyhow::{Context, Result, anyhow, ensure};
use microphong::Skips;
use microphong_boards::{
    build::{host, release},
    child::Scratch,
};
use microphong_stress::{case::Case, cost::Count};
use std::{
    cell::RefCell,
    fs::File,
    io::{BufRead, BufReader, Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, ChildStdout, Stdio},
    sync::OnceLock,
};

/// Programs under callgrind, one for each thread that counts. The first case compiles them.
#[derive(Debug, Default)]
pub struct Counters(OnceLock<Result<PathBuf, String>>);

thread_local! {
    static COUNTER: RefCell<Option<Counter>> = const { RefCell::new(None) };
}

impl Count for Counters {
    fn count(&self, case: &Case) -> Result<Option<u64>> {
        self.counted(case, "")
    }
}

impl Counters {
    /// Counts the frames of the animation after the frame of `case`, together. With `in_part` only changed areas are drawn. `None` if the method
    /// cannot draw the case in this style.
    ///
    /// # Errors
    /// When this is not an x86-64 computer, valgrind is missing, or the scene cannot be drawn.
    pub fn animation(&self, case: &Case, in_part: bool) -> Result<Option<u64>> {
        self.counted(case, if in_part { " animation redraw" } else { " animation" })
    }

    fn counted(&self, case: &Case, options: &str) -> Result<Option<u64>> {
        let program = self.0.get_or_init(|| build().map_err(|error| format!("{error:#}"))).as_ref().map_err(|error| anyhow!("{error}"))?;
        COUNTER.with_borrow_mut(|counter| {
            // One that has failed is not asked again.
            let mut running = counter.take().map_or_else(|| Counter::start(program), Ok)?;
            let counted = running.count(case, options)?;
            *counter = Some(running);
            Ok(counted)
        })
    }
}

/// Compiles the program that draws in every style, with the flags that the firmware is compiled with, and returns its path.
fn build() -> Result<PathBuf> {
    ensure!(cfg!(target_arch = "x86_64"), "instructions of x86-64 are counted on such computers only; name other families, with --only");
    release("frames", "frame/styles", &host()?, "the program that draws in every style for callgrind")
}

/// A running program.
#[derive(Debug)]
struct Counter {
    child: Child,
    questions: ChildStdin,
    answers: BufReader<ChildStdout>,
    /// Callgrind appends a profile of each frame.
    dumps: Scratch,
    /// Number of bytes that have been read.
    read: u64,
}

impl Counter {
    /// Starts `program`.
    fn start(program: &Path) -> Result<Self> {
        let dumps = Scratch::new(&[])?;
        let mut command = valgrind(program, &dumps, &[]);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().map_err(not_started)?;
        let (questions, answers) = (child.stdin.take().context("no standard input")?, child.stdout.take().context("no standard output")?);
        Ok(Self { child, questions, answers: BufReader::new(answers), dumps, read: 0 })
    }

    /// Draws a case, and counts; `None` if the method cannot draw it in this style.
    fn count(&mut self, case: &Case, options: &str) -> Result<Option<u64>> {
        let smooth = if case.style.has_edges() { Some(case.stream.with_neighbours()?) } else { None };
        let stream = Scratch::new(smooth.as_ref().unwrap_or(&case.stream).as_bytes())?;
        let died = "the program that draws has ended under callgrind";
        writeln!(self.questions, "{} {}{options}", stream.path().display(), words(case)).context(died)?;
        let mut answer = String::new();
        ensure!(self.answers.read_line(&mut answer).context(died)? > 0, "{died}");
        if answer.starts_with("refused") {
            return Ok(None);
        }
        ensure!(!answer.starts_with("failed"), "the program that draws {}", answer.trim_end());
        let mut dumps = File::open(self.dumps.path()).context("cannot open what callgrind writes")?;
        dumps.seek(SeekFrom::Start(self.read))?;
        let mut profile = String::new();
        self.read += dumps.read_to_string(&mut profile).context("cannot read what callgrind writes")? as u64;
        Ok(Some(Profile::parse(&profile)?.total))
    }
}

impl Drop for Counter {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A case as the program that draws understands it.
fn words(case: &Case) -> String {
    let Case { size: [width, height], frame, style, band_rows, .. } = case;
    let options = [
        (style.dither, " dither"),
        (style.antialias, " antialias"),
        (style.outlines.is_some(), " outlines"),
        (style.perspective_correct, " perspective-correct"),
    ];
    let mut options: String = options.iter().filter(|(on, _)| *on).map(|(_, word)| *word).collect();
    if let Some((name, _)) = Skips::ALL_BUT.iter().find(|(_, skips)| *skips == style.skips) {
        options += &format!(" with={name}");
    }
    format!("{width}x{height} {band_rows} {} frame={frame}{options}", style.shader.name())
}
