//! The host's processor counts: callgrind executes `host-sim/frame`, which draws frames as the firmware does on its boards.
//!
//! Not by a harness for benchmarks, as gungraun: that starts valgrind once per benchmark, which takes longer than a frame,
//! and reports a frame's sum, of which the stages are wanted.

mod counter;
mod profile;
mod split;

pub use counter::Counters;

use super::{Measurement, Processor, Stages};
use anyhow::{Context, Result, anyhow, ensure};
use microphong_boards::{
    build::{host, release},
    child::{Scratch, bound},
};
use microphong_render::shader::Shader;
use profile::Profile;
use std::{
    ffi::OsString,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    process::Command,
};

/// A frame to be counted.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Width and height of the picture.
    pub size: (u32, u32),
    /// Rows of a band.
    pub band_rows: u32,
    /// Method.
    pub shader: Shader,
}

/// Counts of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count {
    /// Instructions.
    pub stages: Stages,
    /// Triangles drawn.
    pub triangles: u64,
    /// Rows of triangles.
    pub spans: u64,
    /// Pixels of all drawn triangles.
    pub pixels: u64,
}

impl Count {
    /// Converts the count of frame 0 of `scene` to a measurement.
    #[must_use]
    pub fn measurement(&self, scene: &str, shader: Shader) -> Measurement {
        let instructions = self.stages.drawing();
        let instr_per_pixel = instructions as f64 / self.pixels.max(1) as f64;
        Measurement {
            board: Processor::X86_64,
            cpu: Processor::X86_64.name(),
            scene: scene.to_owned(),
            shader: shader.name(),
            instructions,
            cycles: None,
            pixels: self.pixels,
            triangles: self.triangles,
            spans: self.spans,
            instr_per_pixel: (instr_per_pixel * 100.0).round() / 100.0,
            by_stage: self.stages,
            ram_bytes: None,
            flash_bytes: None,
            max_lsb: None,
            rmse_lsb: None,
            budget: None,
            choices: None,
            flash_own_bytes: None,
            firmware_bytes: None,
            timing: None,
        }
    }
}

/// Compiles the program that draws, with the flags that the firmware is compiled with, and returns its path.
///
/// # Errors
/// When this is no x86-64 computer, or the program does not compile.
pub fn build() -> Result<PathBuf> {
    ensure!(cfg!(target_arch = "x86_64"), "instructions of x86-64 are counted on such computers only; choose another board");
    release("frame", "frame/boards", &host()?, "the program that draws for callgrind")
}

/// Draws frame 0 of `stream` in all these ways and counts.
///
/// # Errors
/// When valgrind is missing, or the scene cannot be drawn in one of these ways.
pub fn count(program: &Path, stream: &[u8], frames: &[Frame]) -> Result<Vec<Count>> {
    let stream = Scratch::new(stream)?;
    let arguments = |&Frame { size: (width, height), band_rows, shader }: &Frame| -> [OsString; 4] {
        [stream.path().into(), format!("{width}x{height}").into(), band_rows.to_string().into(), shader.name().into()]
    };
    let (stats, profiles) = profiles(program, &frames.iter().map(arguments).collect::<Vec<_>>())?;
    ensure!(stats.lines().count() == frames.len(), "callgrind has drawn {} of {} frames", stats.lines().count(), frames.len());
    let counts = stats.lines().zip(&profiles).map(|(line, profile)| {
        let (stages, spans) = split::stages(profile)?;
        let figures: Vec<u64> = line.split(' ').map(str::parse).collect::<Result<_, _>>()?;
        let [triangles, pixels] = figures[..] else { return Err(anyhow!("a frame of {line:?}")) };
        Ok(Count { stages, triangles, spans, pixels })
    });
    counts.collect()
}

/// `program` under callgrind, which writes a part into `dumps` behind each frame: what `counted_frame` does within `dumped_frame`.
fn valgrind(program: &Path, dumps: &Scratch, options: &[&str]) -> Command {
    let mut valgrind = Command::new("valgrind");
    bound(&mut valgrind)
        // Without pipes for a debugger, which it leaves where it is ended.
        .args(["--tool=callgrind", "--quiet", "--vgdb=no", "--demangle=no", "--dump-line=no", "--compress-strings=no", "--compress-pos=no"])
        .args(["--zero-before=*counted_frame*", "--dump-after=*dumped_frame*"])
        .args(["--combine-dumps=yes", &format!("--callgrind-out-file={}", dumps.path().display())])
        .args(options)
        .arg(program);
    valgrind
}

/// The error that valgrind cannot be started, with its remedy.
fn not_started(error: io::Error) -> anyhow::Error {
    match error.kind() {
        ErrorKind::NotFound => anyhow!("valgrind is not installed; `apt-get install -y --no-install-recommends valgrind`"),
        _ => anyhow!("cannot start valgrind: {error}"),
    }
}

/// Runs `program` under callgrind. Returns its output and a profile of each frame: of `counted_frame` within `dumped_frame`.
pub(super) fn profiles<const N: usize>(program: &Path, frames: &[[OsString; N]]) -> Result<(String, Vec<Profile>)> {
    let dumps = Scratch::new(&[])?;
    let mut valgrind = valgrind(program, &dumps, &["--dump-instr=yes", "--collect-jumps=yes"]);
    let output = valgrind.args(frames.as_flattened()).output().map_err(not_started)?;
    let messages = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "callgrind could not count: {}", messages.trim());
    let text = String::from_utf8(dumps.read()?).context("callgrind's profiles are no text")?;
    // Behind a common header; the last part is what came behind the last frame.
    let parts: Vec<_> = text.split("\npart: ").skip(1).collect();
    ensure!(parts.len() == frames.len() + 1, "callgrind has written {} profiles of {} frames", parts.len(), frames.len());
    let profiles = parts[..frames.len()].iter().map(|part| Profile::parse(part));
    Ok((String::from_utf8_lossy(&output.stdout).into_owned(), profiles.collect::<Result<_>>()?))
}
