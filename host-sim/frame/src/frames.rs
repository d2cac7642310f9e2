//! Draws frames on request, in every style, for callgrind to count.
//!
//! Each line of the standard input is a frame or an animation: a stream's file, the picture's size as `320x240`, the rows of a band, a method, and
//! options. A line of the standard output answers it: counts, `refused` if the renderer cannot draw it in this style, or `failed`.

mod draw;

use draw::Wanted;
use microphong::RenderError;
use std::{error::Error, io, process::ExitCode};

fn run() -> Result<(), Box<dyn Error>> {
    for line in io::stdin().lines() {
        let line = line?;
        let words: Vec<_> = line.split(' ').collect();
        // The next frame may be one that can be drawn.
        if let Err(error) = Wanted::parse(&words).and_then(|wanted| wanted.draw()) {
            let what = if error.is::<RenderError>() { "refused" } else { "failed" };
            println!("{what}: {error}");
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
