//! The bus of the emulated chip: the crate's bus, with our serial port and timer at their addresses, and the panel behind them.

use super::timer::{CLOCK, Timer};
use crate::parts::{
    alias::{self, PERIPHERAL, REGISTER},
    panel::Panel,
    rtt::Memory,
    spi::Spi,
    waiting::Waiting,
};
use anyhow::{Result, bail};
use rp2350_emu::{Bus as Chip, core::CoreBus, threaded::CoreAtomics};
use std::sync::Arc;

/// Addresses of our peripherals. The crate has the serial port elsewhere, and its timer runs 12.5 times too fast.
const SPI1: u32 = 0x4008_8000;
const TIMER: u32 = 0x400B_0000;
/// Control registers of the two PLLs, and the bit that says that they are stable. In the crate they take a time that only the crate itself can let pass.
const PLL: [u32; 2] = [0x4005_0000, 0x4005_8000];
const LOCKED: u32 = 1 << 31;

/// How far time goes on where the program only waits: 0.1 ms.
const CLOCK_STEP: u64 = 15_000;

/// Pins that the panel hangs on.
const SELECT: u32 = 9;
const DATA: u32 = 8;

/// A peripheral that is emulated here.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Device {
    Spi,
    Timer,
}

fn device(address: u32) -> Option<Device> {
    match address & PERIPHERAL {
        SPI1 => Some(Device::Spi),
        TIMER => Some(Device::Timer),
        _ => None,
    }
}

/// The whole chip without its processors, and the panel that is wired to it.
pub(super) struct Bus {
    pub(super) chip: Chip,
    panel: Panel,
    /// Processor cycles since the start.
    pub(super) cycle: u64,
    /// Since last cleared: cycles that pass while the program waits.
    pub(super) wait: u64,
    waiting: Waiting,
    spi: Spi,
    timer: Timer,
}

impl Bus {
    pub(super) fn new(chip: Chip, panel: Panel) -> Self {
        Self { chip, panel, cycle: 0, wait: 0, waiting: Waiting::default(), spi: Spi::default(), timer: Timer::default() }
    }

    fn pin(&self, number: u32) -> bool {
        (self.chip.sio.gpio_out & self.chip.sio.gpio_oe) >> number & 1 == 1
    }

    /// Lets time go on to `self.cycle`: words leave the serial port. The panel looks at its pins when a byte is complete.
    pub(super) fn tick(&mut self) {
        while let Some((word, _)) = self.spi.sent(self.cycle) {
            let (selected, data) = (!self.pin(SELECT), self.pin(DATA));
            self.panel.receive(selected, data, word as u8);
        }
    }

    /// The picture on the panel, which must have been driven well.
    pub(super) fn picture(&self) -> Result<Vec<u32>> {
        if let Some(fault) = self.timer.fault() {
            bail!("{fault}");
        }
        self.panel.check()?;
        Ok(self.panel.picture())
    }

    fn read_device(&mut self, device: Device, address: u32) -> u32 {
        match device {
            Device::Spi => self.spi.read(address & REGISTER),
            Device::Timer => {
                if address & REGISTER == CLOCK && self.spi.idle() {
                    self.wait += self.waiting.look(self.cycle, CLOCK_STEP);
                }
                self.timer.read(address & REGISTER, self.cycle)
            }
        }
    }

    /// True if the address is one of ours.
    fn write_device(&mut self, address: u32, written: u32) -> bool {
        let Some(device) = device(address) else {
            return false;
        };
        let value = alias::written(address, written, || self.read_device(device, address));
        match device {
            Device::Spi => self.spi.write(address & REGISTER, value, self.cycle),
            Device::Timer => self.timer.write(address & REGISTER, value),
        }
        true
    }
}

impl Memory for Chip {
    fn peek(&self, address: u32) -> u32 {
        self.memory.peek32(address)
    }

    fn poke(&mut self, address: u32, value: u32) {
        self.memory.poke32(address, value);
    }
}

impl CoreBus for Bus {
    fn read8(&mut self, address: u32, core: u8) -> u8 {
        match device(address) {
            Some(device) => (self.read_device(device, address) >> (8 * (address & 3))) as u8,
            None => self.chip.read8(address, core),
        }
    }

    fn read16(&mut self, address: u32, core: u8) -> u16 {
        match device(address) {
            Some(device) => (self.read_device(device, address) >> (8 * (address & 2))) as u16,
            None => self.chip.read16(address, core),
        }
    }

    fn read32(&mut self, address: u32, core: u8) -> u32 {
        match device(address) {
            Some(device) => self.read_device(device, address),
            None if PLL.contains(&address) => self.chip.read32(address, core) | LOCKED,
            None => self.chip.read32(address, core),
        }
    }

    // The chip repeats a narrow write over the whole word.
    fn write8(&mut self, address: u32, value: u8, core: u8) {
        if !self.write_device(address, u32::from(value) * 0x0101_0101) {
            self.chip.write8(address, value, core);
        }
    }

    fn write16(&mut self, address: u32, value: u16, core: u8) {
        if !self.write_device(address, u32::from(value) * 0x0001_0001) {
            self.chip.write16(address, value, core);
        }
    }

    fn write32(&mut self, address: u32, value: u32, core: u8) {
        if !self.write_device(address, value) {
            self.chip.write32(address, value, core);
        }
    }

    fn set_active_pc(&mut self, pc: u32, core: u8) {
        self.chip.set_active_pc(pc, core);
    }

    fn bus_fault(&self, core: u8) -> bool {
        CoreBus::bus_fault(&self.chip, core)
    }

    fn bus_fault_addr(&self, core: u8) -> u32 {
        CoreBus::bus_fault_addr(&self.chip, core)
    }

    fn clear_bus_fault(&mut self, core: u8) {
        CoreBus::clear_bus_fault(&mut self.chip, core);
    }

    fn set_burst_mode(&mut self, on: bool) {
        CoreBus::set_burst_mode(&mut self.chip, on);
    }

    fn add_extra_wait_states(&mut self, count: u32) {
        self.chip.add_extra_wait_states(count);
    }

    fn take_extra_wait_states(&mut self) -> u32 {
        self.chip.take_extra_wait_states()
    }

    fn atomics(&self) -> &Arc<CoreAtomics> {
        &self.chip.atomics
    }

    fn gpio_read_out(&self) -> u32 {
        self.chip.gpio_read_out()
    }

    fn gpio_write_out(&mut self, value: u32) {
        self.chip.gpio_write_out(value);
    }

    fn gpio_set_out(&mut self, mask: u32) {
        self.chip.gpio_set_out(mask);
    }

    fn gpio_clear_out(&mut self, mask: u32) {
        self.chip.gpio_clear_out(mask);
    }

    fn gpio_xor_out(&mut self, mask: u32) {
        self.chip.gpio_xor_out(mask);
    }

    fn gpio_read_oe(&self) -> u32 {
        self.chip.gpio_read_oe()
    }

    fn gpio_write_oe(&mut self, value: u32) {
        self.chip.gpio_write_oe(value);
    }

    fn gpio_set_oe(&mut self, mask: u32) {
        self.chip.gpio_set_oe(mask);
    }

    fn gpio_clear_oe(&mut self, mask: u32) {
        self.chip.gpio_clear_oe(mask);
    }

    fn gpio_xor_oe(&mut self, mask: u32) {
        self.chip.gpio_xor_oe(mask);
    }

    fn gpio_read_in(&self) -> u32 {
        self.chip.gpio_read_in()
    }

    fn extra_wait_states(&self) -> u32 {
        self.chip.extra_wait_states()
    }

    fn reset_extra_wait_states(&mut self) {
        self.chip.reset_extra_wait_states();
    }

    fn last_fetch_addr(&self) -> u32 {
        self.chip.last_fetch_addr()
    }

    fn set_last_fetch_addr(&mut self, address: u32) {
        self.chip.set_last_fetch_addr(address);
    }

    fn mmio_trace_enabled(&self) -> bool {
        self.chip.mmio_trace_enabled
    }

    fn emit_mmio_trace(&mut self, direction: char, size: u32, address: u32, value: u32, core: u8) {
        self.chip.emit_mmio_trace(direction, size, address, value, core);
    }
}
