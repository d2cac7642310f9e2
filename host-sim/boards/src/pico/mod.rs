//! The Pico: an RP2040 with an ST7789 panel or an SSD1306 OLED, emulated down to the bytes on the display's wires.
//!
//! The processor core and most of the chip come from the `rp2040-emu` crate; serial ports, DMA and displays are ours, as the crate's do not
//! send. Time is counted with the Cortex-M0+ table of cycles, flash as if always in the cache: close to the truth, not exact.

mod bus;
mod cycles;
mod machine;

use crate::{Executed, elf::Elf, parts};
use anyhow::Result;
pub(crate) use machine::Machine;

/// A Pico whose program uses the OLED.
pub(super) struct Oled(Machine);

impl Oled {
    /// A board with `elf` in its flash, just switched on.
    pub(super) fn new(elf: &Elf) -> Result<Self> {
        Machine::new(elf).map(Self)
    }
}

impl parts::machine::Machine for Oled {
    fn step(&mut self) -> Result<Executed> {
        self.0.step()
    }

    fn take_log(&mut self) -> Vec<u8> {
        self.0.take_log()
    }

    fn cycle(&self) -> u64 {
        self.0.cycle()
    }

    fn picture(&self) -> Result<Vec<u32>> {
        self.0.oled()
    }
}
