//! What is particular to the RP2350.

use crate::budget::{Budget, PICO2};
use embassy_rp::{
    clocks::{ClockConfig, PeriClkSrc, PllConfig},
    config::Config,
};

/// Sizes of the program's memory.
pub(crate) const BUDGET: Budget = PICO2;

/// Bytes of the second processor's stack. Measured: the teapot by `phong` takes 5.5 KB.
pub const STACK: usize = 16 << 10;

/// Processors at their usual 150 MHz, and 125 MHz for peripherals, of which the serial port can send at the panel's 62.5 MHz: half, but not a third, of
/// a clock is what it can do. The clock of the USB port makes them, which is not used.
pub(crate) fn clocks() -> Config {
    let mut clocks = ClockConfig::crystal(12_000_000);
    if let Some(crystal) = &mut clocks.xosc {
        crystal.usb_pll = Some(PllConfig { refdiv: 1, fbdiv: 125, post_div1: 6, post_div2: 2 });
    }
    clocks.peri_clk_src = Some(PeriClkSrc::PllUsb);
    (clocks.usb_clk, clocks.adc_clk) = (None, None);
    Config::new(clocks)
}
