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

use super::{Board, Recording, Until, elf::Elf, log};
use anyhow::{Context, Result, bail, ensure};
use machine::Machine;

/// Cycles that a run may take: 16 s of the board's time for the set-up, and as many for every frame.
const PATIENCE: u64 = 2_000_000_000;

/// Runs the firmware until it has shown its first frame; or all frames, measured its stack and shown the first frame again.
pub(super) fn run(elf: &Elf, until: Until) -> Result<Recording> {
    let mut machine = Machine::new(elf)?;
    let mut decoder = log::Decoder::new(elf)?;
    let mut recording = Recording::default();
    let outcome = play(&mut machine, &mut decoder, until, &mut recording);
    outcome.with_context(|| format!("{} emulated; {}", Board::Pico, log::tail(&recording.log)))?;
    Ok(recording)
}

fn play(machine: &mut Machine, decoder: &mut log::Decoder, until: Until, recording: &mut Recording) -> Result<()> {
    let (mut led, mut again) = (false, false);
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
            match recording.pictures.first() {
                // All have been checked, and the first one has been drawn again at full speed: only where it changes.
                Some(first) if until == Until::LastFrame(recording.pictures.len()) => {
                    again = true;
                    ensure!(machine.picture() == *first, "the first picture is another one when it is drawn at full speed");
                }
                _ => recording.pictures.push(machine.picture()),
            }
            deadline = machine.cycle() + PATIENCE;
        }
        led = lit;

        let failed = !recording.pictures.is_empty() && recording.failure().is_some();
        let ended = match until {
            Until::FirstFrame => !recording.pictures.is_empty(),
            Until::LastFrame(_) => again && recording.stack_bytes().is_some(),
        };
        if failed || ended {
            return Ok(());
        }
        ensure!(
            machine.cycle() < deadline,
            "the firmware has not finished a frame in {PATIENCE} cycles (at {:#010x}): it hangs",
            machine.pc()
        );
    }
}

/// Cycles of one frame; 125 of them are a microsecond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameTime {
    /// From the end of the one before to its own.
    pub all: u64,
    /// While bits went over the wire to the panel.
    pub wire: u64,
}

/// Runs the firmware until it has checked all frames, and on through the next one, whose instructions and their cycles go to `visit`.
pub(super) fn watch(elf: &Elf, mut visit: impl FnMut(u32, u64)) -> Result<(Recording, FrameTime)> {
    let mut machine = Machine::new(elf)?;
    let mut decoder = log::Decoder::new(elf)?;
    let mut recording = Recording::default();
    let outcome = follow(&mut machine, &mut decoder, &mut recording, &mut visit);
    let time = outcome.with_context(|| format!("{} emulated; {}", Board::Pico, log::tail(&recording.log)))?;
    Ok((recording, time))
}

fn follow(
    machine: &mut Machine,
    decoder: &mut log::Decoder,
    recording: &mut Recording,
    visit: &mut impl FnMut(u32, u64),
) -> Result<FrameTime> {
    let mut start = None;
    let mut led = false;
    let mut shown = 0;
    let deadline = 2 * PATIENCE;
    while machine.cycle() < deadline {
        let step = machine.step();
        if step.is_err() || machine.log_is_due() {
            decoder.push(&machine.take_log(), |line| recording.log.push(line));
            if let Some(failure) = recording.failure() {
                bail!("the firmware reports: {failure}");
            }
        }
        let (address, cycles) = step?;
        // The light goes on when a frame is complete, and its next one begun.
        let completes = !led && machine.led();
        led = machine.led();
        shown += u32::from(completes);
        match start {
            Some(FrameTime { all, wire }) if completes => {
                return Ok(FrameTime { all: machine.cycle() - all, wire: machine.wire() - wire });
            }
            Some(_) => visit(address, cycles),
            // The first frame is checked, while the second one is drawn nothing is on its way yet.
            None if completes && shown == 2 => start = Some(FrameTime { all: machine.cycle(), wire: machine.wire() }),
            None => {}
        }
    }
    bail!("the firmware has not shown three frames in {deadline} cycles: it hangs")
}
