//! The boards, each emulated down to its display, so that the very program that is flashed can be checked.

pub mod build;
pub mod child;
pub mod elf;
pub mod example;
mod log;
mod panelled;
mod parts;
mod pico;
mod pico2;
mod qemu;
pub mod sources;
pub mod verify;

use anyhow::{Context, Result};
use elf::Elf;
pub use microphong_render::board::{Board, Format, budget};
use microphong_render::shader::Shader;
pub use panelled::{FrameTime, Pico};
pub use parts::peripherals::Fault;
pub use qemu::{Blocks, INSTRUCTIONS_PER_TICK, check, clocked, stack, trace};
use std::ops::Range;

/// When a run ends, unless the firmware reports a failure before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// The first frame has been shown, however many the stream has.
    FirstFrame,
    /// All frames of the stream have been shown, in this number, and the firmware has measured its stack.
    LastFrame(usize),
}

/// Pictures and log of a board.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// Pixels of each picture, row by row from the top, as the display stores them.
    pub pictures: Vec<Vec<u32>>,
    /// The log, line by line.
    pub log: Vec<String>,
}

impl Recording {
    /// The failure that the firmware reported, if any: then the last picture shows it.
    #[must_use]
    pub fn failure(&self) -> Option<&str> {
        self.log.iter().find_map(|line| line.strip_prefix("error: "))
    }

    /// Checksums that the firmware worked out, one per frame.
    #[must_use]
    pub fn checksums(&self) -> Vec<u32> {
        let checksum = |line: &String| {
            let mut words = line.strip_prefix("frame ")?.split_whitespace();
            words.find(|&word| word == "crc")?;
            u32::from_str_radix(words.next()?, 16).ok()
        };
        self.log.iter().filter_map(checksum).collect()
    }

    /// The figure with this name that the firmware has counted in its first frame.
    ///
    /// # Errors
    /// When the firmware has not logged it.
    pub fn figure(&self, name: &str) -> Result<u64> {
        let frame = self.log.iter().find_map(|line| line.strip_prefix("frame "));
        let mut words = frame.unwrap_or_default().split_whitespace();
        let value = words.find(|&word| word == name).and_then(|_| words.next()?.parse().ok());
        value.with_context(|| format!("the firmware has not logged {name}; {}", log::tail(&self.log)))
    }

    /// Bytes of stack that the firmware has used, by its own account.
    #[must_use]
    pub fn stack_bytes(&self) -> Option<u64> {
        self.log.iter().rev().find_map(|line| line.strip_prefix("stack ")?.strip_suffix(" bytes")?.parse().ok())
    }
}

/// Runs `elf` on `board` to the end that `until` names, or until it has reported a failure.
///
/// # Errors
/// When the program crashes, falls silent or drives its display wrongly.
pub fn run(board: Board, elf: &Elf, until: Until) -> Result<Recording> {
    match board {
        Board::Pico | Board::Pico2 => panelled::run(board, elf, until),
        _ => qemu::run(board, elf, until),
    }
}

/// A frame of which every instruction was watched.
#[derive(Clone, Debug, Default)]
pub struct Watched {
    /// The log of the firmware; there are no pictures.
    pub recording: Recording,
    /// Times of the frame, where time is modelled.
    pub time: Option<FrameTime>,
}

/// An instruction that was executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Executed {
    /// The processor of the board, from 0 on.
    pub core: usize,
    /// Address of the instruction.
    pub address: u32,
    /// Cycles of the instruction, where they are modelled.
    pub cycles: u64,
}

/// Changes a stream for [`watch`]: frames are drawn by this method, and the first one is watched.
///
/// The frame of a Pico is watched when it is drawn at full speed, which does not happen while its picture is shown already. So the stream has a second
/// frame, turned by so little that it takes as long.
///
/// # Errors
/// When `stream` is shorter than its header says.
pub fn watchable(board: Board, stream: &[u8], shader: Shader) -> Result<Vec<u8>> {
    match board {
        // What has tracks moves by itself.
        Board::Pico | Board::Pico2 => verify::with_header(&verify::prepare(stream, shader, 2)?, |header| {
            if header.tracks == 0 {
                header.camera.period = u16::MAX;
            }
        }),
        _ => verify::prepare(stream, shader, 1),
    }
}

/// Runs `elf`, whose stream must be [`watchable`], and passes each instruction of its first frame to `visit`. In QEMU these are instructions in
/// `ranges`, without cycles. On a Pico these are all instructions, of a frame that follows another.
///
/// # Errors
/// When the program crashes, falls silent or drives its display wrongly.
pub fn watch(board: Board, elf: &Elf, ranges: &[Range<u32>], visit: &mut dyn FnMut(Executed)) -> Result<Watched> {
    let (recording, time) = match board {
        Board::Pico | Board::Pico2 => panelled::watch(board, elf, visit).map(|(recording, time)| (recording, Some(time)))?,
        _ => (trace(board, elf, ranges, Blocks::Whole, &mut |address| visit(Executed { core: 0, address, cycles: 0 }))?, None),
    };
    Ok(Watched { recording, time })
}
