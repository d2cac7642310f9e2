//! Examples for boards of Raspberry Pi, emulated as they are flashed: from start-up code over the driver of the display to what the display shows.

use crate::{Recording, elf::Elf, log, parts::machine::Machine, pico, pico2};
use anyhow::{Context, Result, bail};

/// Cycles that a picture may take: more than ten seconds of the board's time.
const PATIENCE: u64 = 2_000_000_000;
/// Number of instructions between reads of the log. Fewer than a program takes from one picture to the first byte of the next.
const LOG_INTERVAL: u64 = 1024;

/// An example that is emulated as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Example {
    /// Raspberry Pi Pico, OLED of 128x64 pixels over I2C.
    Rp2040Ssd1306,
    /// Raspberry Pi Pico 2, panel of 240x240 pixels over SPI.
    Rp2350St7789,
}

impl Example {
    /// The name of its folder and of its program.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rp2040Ssd1306 => "rp2040-ssd1306",
            Self::Rp2350St7789 => "rp2350-st7789",
        }
    }

    /// The target that it is compiled for.
    #[must_use]
    pub const fn target(self) -> &'static str {
        match self {
            Self::Rp2040Ssd1306 => "thumbv6m-none-eabi",
            Self::Rp2350St7789 => "thumbv8m.main-none-eabihf",
        }
    }
}

/// Runs `elf` until it has logged this number of frames, and records what the display shows then.
///
/// # Errors
/// When the program crashes, falls silent, or drives its display or its bus wrongly.
pub fn run(example: Example, elf: &Elf, frames: usize) -> Result<Recording> {
    let mut recording = Recording::default();
    let outcome = match example {
        Example::Rp2040Ssd1306 => pico::Oled::new(elf).and_then(|mut board| play(&mut board, elf, frames, &mut recording)),
        Example::Rp2350St7789 => pico2::Machine::new(elf).and_then(|mut board| play(&mut board, elf, frames, &mut recording)),
    };
    outcome.with_context(|| format!("{} emulated; {}", example.name(), log::tail(&recording.log)))?;
    Ok(recording)
}

fn play(board: &mut impl Machine, elf: &Elf, frames: usize, recording: &mut Recording) -> Result<()> {
    let mut decoder = log::Decoder::new(elf)?;
    let mut deadline = PATIENCE;
    for count in 1_u64.. {
        let step = board.step();
        // Also after a crash: its cause is in the log.
        if step.is_err() || count.is_multiple_of(LOG_INTERVAL) {
            let before = recording.log.len();
            decoder.push(&board.take_log(), |line| recording.log.push(line));
            let shown = recording.log[before..].iter().filter(|line| line.starts_with("frame ")).count();
            for _ in 0..shown {
                recording.pictures.push(board.picture()?);
                deadline = board.cycle() + PATIENCE;
            }
        }
        step?;
        if recording.pictures.len() >= frames {
            return Ok(());
        }
        if board.cycle() > deadline {
            let hangs = format!("the firmware has not finished a picture in {PATIENCE} cycles: it hangs");
            // The display may know why.
            board.picture().context(hangs.clone())?;
            bail!(hangs);
        }
    }
    Ok(())
}
