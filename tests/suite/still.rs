//! A picture that the display shows already: the Pico's firmware neither draws nor sends it, and goes on all the same.

use microphong_sim::{
    board::{Board, Pico, elf::Elf},
    scene,
    shader::Shader,
    verify,
};
use std::error::Error;

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

/// A frame that is left out takes fewer cycles, even if the firmware looks before how much stack was used; one that is drawn takes more.
const DRAWN: u64 = 200_000;

/// A Pico that has checked `frames` frames of a turn of `period` frames.
fn checked(period: u16, frames: u16) -> Result<Pico> {
    let stream = verify::prepare(scene::load("dodecahedron")?.stream.as_bytes(), Shader::GOURAUD, frames)?;
    let stream = verify::with_header(&stream, |header| header.camera.period = period)?;
    let mut pico = Pico::new(Board::Pico, &Elf::read(&verify::build(Board::Pico, false)?)?.with_stream(&stream)?)?;
    for _ in 0..frames {
        pico.next_picture()?;
    }
    Ok(pico)
}

/// For each of the next frames, whether it is sent. The others must take next to no time and leave the picture unchanged.
fn sent(pico: &mut Pico, frames: usize) -> Result<Vec<bool>> {
    let mut sent = Vec::new();
    for number in 0..frames {
        let (picture, wire, start) = (pico.picture(), pico.wire_cycles(), pico.cycles());
        pico.next_picture()?;
        let (is_sent, cycles) = (pico.wire_cycles() > wire, pico.cycles() - start);
        assert!((cycles > DRAWN) == is_sent, "frame {number}, sent: {is_sent}, takes {cycles} cycles");
        assert!((pico.picture() != picture) == is_sent, "frame {number}, sent: {is_sent}, is another picture or not");
        sent.push(is_sent);
    }
    Ok(sent)
}

/// A camera that stands still, whether the stream says so or has one frame: nothing is sent any more, and the firmware goes on.
#[test]
fn a_still_picture_is_sent_once() -> Result {
    for (period, frames) in [(0, 1), (0, 3), (1, 3), (120, 1)] {
        let mut pico = checked(period, frames)?;
        let start = pico.cycles();
        let sent = sent(&mut pico, 1000)?;
        let cycles = pico.cycles() - start;
        println!("{frames} frames of a turn of {period}: {cycles} cycles for 1,000 pictures");
        assert!(sent.iter().all(|sent| !sent) && cycles < 1_000_000, "{frames} frames of a turn of {period}: {cycles} cycles");
        assert!(pico.log().iter().any(|line| line.starts_with("0 frames drawn in ")), "{:?}", pico.log());
    }
    Ok(())
}

/// A camera that turns: a frame is left out only if it is the picture of the one before.
#[test]
fn a_turning_picture_is_sent_when_it_changes() -> Result {
    for (period, frames, expected) in [(4, 4, &[true; 4][..]), (2, 4, &[true; 4]), (2, 3, &[false, true, true])] {
        let mut pico = checked(period, frames)?;
        let drawn = expected.iter().filter(|sent| **sent).count();
        for turn in 0..3 {
            assert_eq!(sent(&mut pico, frames.into())?, expected, "turn {turn} of {period} frames");
        }
        assert!(pico.log().iter().any(|line| line.starts_with(&format!("{drawn} frames drawn in "))), "{:?}", pico.log());
    }
    Ok(())
}
