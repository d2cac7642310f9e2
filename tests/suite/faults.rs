//! The firmware of the Pico and the Pico 2 when the board fails: it reports the fault on the panel and in the log, and stops. It never falls silent.

use microphong::stream::{MAX_LENGTH, record::Header};
use microphong_sim::{
    board::{Board, Fault, Pico, elf::Elf},
    scene,
    shader::Shader,
    verify,
};
use microphong_tests::message;
use std::error::Error;
use zerocopy::FromBytes;

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

/// Frames of the scene: the firmware checks them first, and then draws them at full speed.
const FRAMES: u16 = 2;

const BOARDS: [Board; 2] = [Board::Pico, Board::Pico2];

/// A board that has shown this number of pictures.
fn after(board: Board, pictures: usize) -> Result<Pico> {
    after_of(board, scene::load("dodecahedron")?.stream.as_bytes(), pictures)
}

/// A board that has shown this number of pictures of a stream.
fn after_of(board: Board, stream: &[u8], pictures: usize) -> Result<Pico> {
    let stream = verify::prepare(stream, Shader::SIX_POINT, FRAMES)?;
    let mut pico = Pico::new(board, &Elf::read(&verify::build(board, false)?)?.with_stream(&stream)?)?;
    for _ in 0..pictures {
        pico.next_picture()?;
    }
    Ok(pico)
}

/// Lines of the log that begin like this, without it.
fn lines<'p>(pico: &'p Pico, begin: &str) -> Vec<&'p str> {
    pico.log().iter().filter_map(|line| line.strip_prefix(begin)).collect()
}

/// The next picture is a message that is as `expected`, the only one that was logged, and it stays: the light blinks on for half a minute.
/// Returns what `expected` finds in it.
fn ends_in<T>(pico: &mut Pico, expected: impl Fn(&str) -> Option<T>) -> Result<T> {
    pico.next_picture()?;
    let message = lines(pico, "error: ").first().map(|line| (*line).to_owned()).ok_or("nothing was logged")?;
    for blink in 0..60 {
        assert_eq!(lines(pico, "error: "), [&message], "blink {blink}: {:?}", pico.log());
        assert!(message::is_shown(pico.board(), &pico.picture(), &message), "blink {blink}: the panel does not show `{message}`");
        assert!(pico.quiet(), "blink {blink}: the panel is still spoken to");
        pico.next_picture()?;
    }
    Ok(expected(&message).ok_or_else(|| format!("another message was expected: {message}"))?)
}

#[test]
fn dma_that_never_ends_is_reported() -> Result {
    // Before the first band, between frames that are checked, and when frames are only drawn. Which of the processors sends next, and how many
    // rows, is up to them: at most a band's 24. A row takes 62 us on the wire.
    for (board, shown) in BOARDS.into_iter().flat_map(|board| [0, 1, usize::from(FRAMES) + 2].map(|shown| (board, shown))) {
        let mut pico = after(board, shown)?;
        pico.inject(Fault::DmaStalls);
        let bytes = ends_in(&mut pico, |message| {
            let bytes: u32 = message.strip_prefix("display: ")?.split(' ').next()?.parse().ok()?;
            let limit = 2 * (8 * bytes / 62) + 1000;
            (message == format!("display: {bytes} bytes were not sent within {limit} us; switch the board off and on")).then_some(bytes)
        })?;
        assert!((1..=24).any(|rows| bytes == rows * 240 * 2), "{bytes} bytes");
        assert_eq!(lines(&pico, "no picture: "), lines(&pico, "error: "));
    }
    Ok(())
}

/// No command reaches the panel any more. The watchdog restarts the board, which mends the port here.
#[test]
fn a_port_that_hangs_is_reported_after_a_reset() -> Result {
    for board in BOARDS {
        let mut pico = after(board, 1)?;
        pico.inject(Fault::SpiHangs);
        let expected = "watchdog: the program hung and was started anew; switch the board off and on";
        ends_in(&mut pico, |message| (message == expected).then_some(()))?;
    }
    Ok(())
}

/// The watchdog does not bite who works: a board that nothing happens to shows frames and no message.
#[test]
fn a_sound_board_is_left_alone() -> Result {
    for board in BOARDS {
        let mut pico = after(board, 20)?;
        pico.next_picture()?;
        assert!(lines(&pico, "error: ").is_empty() && lines(&pico, "no picture: ").is_empty(), "{board}: {:?}", pico.log());
    }
    Ok(())
}

/// Frames that leave nothing to draw or to send are complete all the same: the light says so, and the panel keeps the background.
#[test]
fn nothing_in_view_is_shown() -> Result {
    let mut stream = scene::load("dodecahedron")?.stream.as_bytes().to_vec();
    let (header, _) = Header::mut_from_prefix(&mut stream).map_err(|_| "the stream is shorter than its header")?;
    // Beyond the right edge.
    header.camera.translation[0] = MAX_LENGTH;
    let mut pico = after_of(Board::Pico, &stream, 1)?;
    let background = pico.picture();
    assert!(background.iter().all(|pixel| *pixel == background[0]));
    for frame in 1..20 {
        pico.next_picture()?;
        assert!(pico.picture() == background, "picture {frame}");
    }
    assert!(lines(&pico, "error: ").is_empty(), "{:?}", pico.log());
    Ok(())
}
