//! The Pico: an RP2040 with an ST7789 panel, emulated down to the bytes on the panel's wires.
//!
//! The processor core and most of the chip come from the `rp2040-emu` crate; serial port, DMA and panel are ours, as the crate's do not
//! send. Time is counted with the Cortex-M0+ table of cycles, flash as if always in the cache: close to the truth, not exact.

mod bus;
mod cycles;
mod dma;
mod machine;
mod panel;
mod rtt;
mod spi;

use super::{Board, Recording, elf::Elf, log};
use anyhow::{Context, Result, ensure};
use machine::Machine;

/// Cycles that a run may take: 16 s of the board's time for the set-up, and as many for every frame.
const PATIENCE: u64 = 2_000_000_000;

/// Runs the firmware until it has shown `frames` frames and measured its stack, or has reported a failure.
pub(super) fn run(elf: &Elf, frames: usize) -> Result<Recording> {
    let mut machine = Machine::new(elf)?;
    let mut decoder = log::Decoder::new(elf)?;
    let mut recording = Recording::default();
    let outcome = play(&mut machine, &mut decoder, frames, &mut recording);
    outcome.with_context(|| format!("{} emulated; {}", Board::Pico, log::tail(&recording.log)))?;
    Ok(recording)
}

fn play(machine: &mut Machine, decoder: &mut log::Decoder, frames: usize, recording: &mut Recording) -> Result<()> {
    let mut led = false;
    let mut deadline = PATIENCE;
    loop {
        let step = machine.step();
        // Also after a crash: its cause is in the log.
        if step.is_err() || machine.log_is_due() {
            decoder.push(&machine.take_log(), |line| recording.log.push(line));
        }
        step?;

        let lit = machine.led();
        if lit && !led {
            machine.check_panel()?;
            decoder.push(&machine.take_log(), |line| recording.log.push(line));
            if recording.pictures.len() < frames {
                recording.pictures.push(machine.picture());
            }
            deadline = machine.cycle() + PATIENCE;
        }
        led = lit;

        let failed = !recording.pictures.is_empty() && recording.failure().is_some();
        if failed || recording.pictures.len() == frames && recording.stack_bytes().is_some() {
            return Ok(());
        }
        ensure!(
            machine.cycle() < deadline,
            "the firmware has not finished a frame in {PATIENCE} cycles (at {:#010x}): it hangs",
            machine.pc()
        );
    }
}
