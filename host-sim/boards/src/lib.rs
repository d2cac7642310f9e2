//! The boards, each emulated down to its display, so that the very program that is flashed can be checked.

// The firmware's own file: the numbers exist once.
#[path = "../../../firmware/src/budget.rs"]
pub mod budget;
pub mod build;
pub mod child;
pub mod elf;
mod log;
mod pico;
mod qemu;
pub mod sources;
pub mod verify;

use anyhow::{Context, Result};
use budget::Budget;
use elf::Elf;
use microphong_render::shader::Shader;
pub use pico::{Fault, FrameTime, Pico};
pub use qemu::{Blocks, INSTRUCTIONS_PER_TICK, Machine, clocked, stack, trace};
use serde::{Serialize, Serializer};
use std::{fmt, ops::Range};

/// A board that the firmware runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Board {
    /// Raspberry Pi Pico, ST7789 panel of 240x240 pixels.
    Pico,
    /// TI LM3S6965 evaluation board, OLED of 128x64 pixels with 16 greys.
    Lm3s6965evb,
    /// Arm MPS2 with a Cortex-M3, frame buffer of 320x240 pixels.
    Mps2An385,
    /// Arm MPS2 with a Cortex-M4F, frame buffer of 320x240 pixels.
    Mps2An386,
}

/// Pixel formats of boards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Five, six and five bits of red, green and blue.
    Rgb565,
    /// Five, six and five bits of red, green and blue, the high byte first in memory.
    Rgb565Be,
    /// Sixteen greys.
    Gray4,
}

impl Board {
    /// All boards.
    pub const ALL: [Self; 4] = [Self::Pico, Self::Lm3s6965evb, Self::Mps2An385, Self::Mps2An386];

    /// The name on the command line, of the firmware's feature and of its program.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pico => "pico",
            Self::Lm3s6965evb => "lm3s6965evb",
            Self::Mps2An385 => "mps2-an385",
            Self::Mps2An386 => "mps2-an386",
        }
    }

    /// The target that its firmware is compiled for.
    #[must_use]
    pub const fn target(self) -> &'static str {
        match self {
            Self::Pico => "thumbv6m-none-eabi",
            Self::Lm3s6965evb | Self::Mps2An385 => "thumbv7m-none-eabi",
            Self::Mps2An386 => "thumbv7em-none-eabihf",
        }
    }

    /// The sizes that its firmware is built with.
    #[must_use]
    pub const fn budget(self) -> Budget {
        match self {
            Self::Pico => budget::PICO,
            Self::Lm3s6965evb => budget::LM3S6965EVB,
            Self::Mps2An385 | Self::Mps2An386 => budget::MPS2,
        }
    }

    /// Width and height of its display.
    #[must_use]
    pub const fn size(self) -> (u32, u32) {
        let budget = self.budget();
        (budget.layout.width as u32, budget.height as u32)
    }

    /// Whether its firmware has room for the method.
    #[must_use]
    pub fn has(self, shader: Shader) -> bool {
        self != Self::Lm3s6965evb || Shader::CORE.contains(&shader)
    }

    /// Whether its firmware has room for labels: for fonts.
    #[must_use]
    pub fn has_text(self) -> bool {
        self != Self::Lm3s6965evb
    }

    /// Whether it has memory for smooth outlines, so that there is a firmware that draws them.
    #[must_use]
    pub const fn smooths(self) -> bool {
        matches!(self, Self::Mps2An385 | Self::Mps2An386)
    }

    /// The value of a byte of the memory for streams before anything is written there: erased flash, but QEMU begins with zeros.
    #[must_use]
    pub const fn blank(self) -> u8 {
        match self {
            Self::Pico => 0xFF,
            Self::Lm3s6965evb | Self::Mps2An385 | Self::Mps2An386 => 0,
        }
    }

    /// The board's pixel format.
    #[must_use]
    pub const fn format(self) -> Format {
        match self {
            Self::Pico => Format::Rgb565Be,
            Self::Lm3s6965evb => Format::Gray4,
            Self::Mps2An385 | Self::Mps2An386 => Format::Rgb565,
        }
    }
}

impl fmt::Display for Board {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Serialize for Board {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

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
        Board::Pico => pico::run(elf, until),
        Board::Lm3s6965evb | Board::Mps2An385 | Board::Mps2An386 => qemu::run(board, elf, until),
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
/// The Pico's frame is watched when it is drawn at full speed, which does not happen while its picture is shown already. So the stream has a second
/// frame, turned by so little that it takes as long.
///
/// # Errors
/// When `stream` is shorter than its header says.
pub fn watchable(board: Board, stream: &[u8], shader: Shader) -> Result<Vec<u8>> {
    match board {
        // What has tracks moves by itself.
        Board::Pico => verify::with_header(&verify::prepare(stream, shader, 2)?, |header| {
            if header.tracks == 0 {
                header.camera.period = u16::MAX;
            }
        }),
        Board::Lm3s6965evb | Board::Mps2An385 | Board::Mps2An386 => verify::prepare(stream, shader, 1),
    }
}

/// Runs `elf`, whose stream must be [`watchable`], and passes each instruction of its first frame to `visit`. In QEMU these are instructions in
/// `ranges`, without cycles. On the Pico these are all instructions, of a frame that follows another.
///
/// # Errors
/// When the program crashes, falls silent or drives its display wrongly.
pub fn watch(board: Board, elf: &Elf, ranges: &[Range<u32>], visit: &mut dyn FnMut(Executed)) -> Result<Watched> {
    let (recording, time) = match board {
        Board::Pico => pico::watch(elf, visit).map(|(recording, time)| (recording, Some(time)))?,
        Board::Lm3s6965evb | Board::Mps2An385 | Board::Mps2An386 => {
            (trace(board, elf, ranges, Blocks::Whole, &mut |address| visit(Executed { core: 0, address, cycles: 0 }))?, None)
        }
    };
    Ok(Watched { recording, time })
}
