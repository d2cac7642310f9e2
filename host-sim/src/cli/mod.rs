//! Command line: what the user may say, and what comes of it.

#[cfg(any(test, not(feature = "boards")))]
mod absent;
#[cfg(feature = "boards")]
mod bench;
mod boards;
mod bounds;
mod compare;
mod convert;
mod count;
mod features;
#[cfg(feature = "boards")]
mod growth;
mod inspect;
mod mesh_options;
mod meshes;
mod outlines;
mod papers;
mod parse;
mod render;
mod report;
mod room;
mod scenes;
#[cfg(feature = "boards")]
mod size;
mod stress;
#[cfg(feature = "boards")]
mod verify;

#[cfg(not(feature = "boards"))]
use absent::{bench, growth, size, verify};

use anyhow::{Context, Result};
use clap::{Parser, Subcommand};
use microphong_sim::{output::Kept, scene};
use std::{ffi::OsString, process::ExitCode};

/// Phong-quality shading for microcontrollers: convert meshes, draw them, and verify boards
#[derive(Parser)]
#[command(version, max_term_width = 100, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  microphong scenes                                list the built-in scenes
  microphong render teapot                         write teapot.png
  microphong render teapot --frames 120 -o t.apng  write an animation of one turn
  microphong convert mesh.obj -o mesh.tri          make a stream, the mesh file of a program
  microphong inspect mesh.tri                      show the contents and the size of a stream
  microphong verify teapot --board all             compare emulated boards with this computer
  microphong bench                                 count the instructions of a frame
  microphong growth                                count them for more triangles, pixels, lights
  microphong size part.obj --chip rp2040           show flash, RAM and stack of whole programs
  microphong compare teapot --report comparison    measure all methods against Phong shading
  microphong papers --only vlasic                  check the claims of a paper
  microphong stress --seconds 60                   search for scenes that are drawn wrong
  microphong bounds --check 10000                  search for errors beyond the bounds of `auto`

Exit codes: 0 success; 1 failure, or pictures differ; 2 wrong usage.";

#[derive(Subcommand)]
enum Command {
    Convert(Box<convert::Arguments>),
    Inspect(inspect::Arguments),
    Render(render::Arguments),
    Verify(verify::Arguments),
    Bench(bench::Arguments),
    Growth(growth::Arguments),
    Size(Box<size::Arguments>),
    Compare(compare::Arguments),
    Bounds(bounds::Arguments),
    Papers(papers::Arguments),
    Scenes(scenes::Arguments),
    Stress(stress::Arguments),
}

/// Wrong usage that the argument parser cannot see: exit code 2.
#[derive(Debug)]
struct Usage(String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// What a command ends with when nothing went wrong.
enum Outcome {
    Done,
    Differences,
}

/// The words of the command line. A word that begins as a negative number does, such as -1x5, is the value of the option before it, so that an option
/// is told by its range, and the value not as an unknown option.
fn words(given: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut words: Vec<OsString> = Vec::new();
    for word in given {
        let is_number = matches!(word.as_encoded_bytes(), [b'-', b'0'..=b'9' | b'.', ..]);
        match words.last_mut() {
            Some(option) if is_number && option.as_encoded_bytes().starts_with(b"--") => {
                option.push("=");
                option.push(word);
            }
            _ => words.push(word),
        }
    }
    words
}

/// Runs the command line.
pub(crate) fn main() -> ExitCode {
    report::start();
    let result = match Arguments::try_parse_from(words(std::env::args_os())) {
        Ok(arguments) => run(arguments.command),
        Err(wrong) if wrong.use_stderr() => {
            // Nobody left to tell when stderr is closed.
            let _ = wrong.print();
            return ExitCode::from(2);
        }
        Err(help) => help.print().map(|()| Outcome::Done).context("cannot write to standard output"),
    };
    let error = match result {
        Ok(Outcome::Done) => return ExitCode::SUCCESS,
        Ok(Outcome::Differences) => return ExitCode::FAILURE,
        Err(error) => error,
    };
    // A reader that has seen enough, as `head`, is no failure.
    let closed = error.chain().filter_map(|e| e.downcast_ref::<std::io::Error>()).any(|e| e.kind() == std::io::ErrorKind::BrokenPipe);
    if closed {
        return ExitCode::SUCCESS;
    }
    report::failure(&error);
    let usage = error.is::<Usage>() || error.is::<scene::Unknown>() || error.is::<scene::Misplaced>() || error.is::<Kept>();
    if usage { ExitCode::from(2) } else { ExitCode::FAILURE }
}

fn run(command: Command) -> Result<Outcome> {
    match command {
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Inspect(arguments) => inspect::run(&arguments),
        Command::Render(arguments) => render::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Growth(arguments) => growth::run(&arguments),
        Command::Size(arguments) => size::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Bounds(arguments) => bounds::run(&arguments),
        Command::Papers(arguments) => papers::run(&arguments),
        Command::Scenes(arguments) => scenes::run(&arguments),
        Command::Stress(arguments) => stress::run(&arguments),
    }
}
