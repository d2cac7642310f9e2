//! What is particular to the RP2040.

use crate::budget::{Budget, PICO};
use embassy_rp::config::Config;

/// Sizes of the program's memory.
pub(crate) const BUDGET: Budget = PICO;

/// Bytes of the second processor's stack. Measured: the teapot by `auto` takes 8.8 KB; with colours at corners, `auto` takes 13 to 15 KB.
pub const STACK: usize = if cfg!(feature = "vertex-colours") { 15 << 10 } else { 10 << 10 };

/// The usual clocks: 125 MHz for processors and peripherals.
pub(crate) fn clocks() -> Config {
    Config::default()
}
