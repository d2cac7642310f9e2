//! Draws frames for callgrind to count.
//!
//! Arguments come in groups of three, one for each frame: a stream's file, a peer's name, and the file that gets the picture, two bytes a
//! pixel.

use microphong::Stream;
use peers::{HEIGHT, Peer, WIDTH, dumped_frame, scene::Scene};
use std::{env, error::Error, fs, process::ExitCode};
use zerocopy::IntoBytes;

fn draw(stream: &str, peer: &str, picture: &str) -> Result<(), Box<dyn Error>> {
    let bytes = fs::read(stream)?;
    // Read in place, so the bytes must be aligned.
    let mut words = vec![0u32; bytes.len().div_ceil(4)];
    words.as_mut_bytes()[..bytes.len()].copy_from_slice(&bytes);
    let scene = Scene::new(&Stream::parse(&words.as_bytes()[..bytes.len()])?)
        .ok_or("other renderers draw one mesh of one material under directional lights, without a local viewer")?;
    let peer = Peer::ALL.into_iter().find(|other| other.name() == peer).ok_or("no such peer")?;
    let mut pixels = Box::new([0; WIDTH * HEIGHT]);
    let mut drawing = peer.prepare(&scene).ok_or("other renderers have no shader for these lights and materials")?;
    dumped_frame(&mut *drawing, &mut pixels);
    fs::write(picture, pixels.iter().flat_map(|pixel| pixel.to_le_bytes()).collect::<Vec<_>>())?;
    Ok(())
}

fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let (frames, []) = arguments.as_chunks::<3>() else { return Err("groups of STREAM PEER PICTURE are needed".into()) };
    frames.iter().try_for_each(|[stream, peer, picture]| draw(stream, peer, picture))
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
