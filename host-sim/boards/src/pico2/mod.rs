//! The Pico 2: an RP2350 with an ST7789 panel, emulated down to the bytes on the panel's wires.
//!
//! The processors and most of the chip come from the crate `rp2350-emu`. Serial port, DMA, timer, watchdog and panel are ours, and so are instructions
//! that the crate lacks. The crate counts cycles roughly, so times are approximate.

mod bus;
mod launch;
mod machine;
mod missing;
mod timer;

pub(crate) use machine::Machine;
