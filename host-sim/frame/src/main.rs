//! Draws frames for callgrind to count: what the firmware is to a board, this program is to the host's processor.
//!
//! Arguments come in groups of four, one for each frame: a stream's file, the picture's size as `320x240`, the rows of a
//! band, and a method.

mod draw;

use draw::Wanted;
use std::{env, error::Error, process::ExitCode};

fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let (frames, []) = arguments.as_chunks::<4>() else { return Err("groups of FILE WIDTHxHEIGHT ROWS METHOD are needed".into()) };
    frames.iter().try_for_each(|frame| Wanted::parse(&frame.each_ref().map(String::as_str))?.draw())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
