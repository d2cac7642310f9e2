//! The bus of the emulated chip: the crate's bus, with our serial ports and DMA at their addresses, and the displays behind them.

use crate::parts::{
    alias::{self, PERIPHERAL, REGISTER},
    dma,
    i2c::I2c,
    oled::Oled,
    panel::Panel,
    peripherals::{self, Layout, Peripherals},
    rtt::Memory,
    waiting::Waiting,
};
use anyhow::{Result, bail};
use rp2040_emu::{
    Bus as Chip,
    bus::ppb::Ppb,
    core::{CoreBus, Nvic},
};
use std::mem;

/// The chip's peripherals. The watchdog's count runs down by two in a microsecond (erratum RP2040-E1).
const LAYOUT: Layout = Layout { spi1: 0x4004_0000, watchdog: 0x4005_8000, watchdog_cycles: 125.0 / 2.0, dma: &dma::RP2040 };
/// The address of the first I2C controller.
const I2C0: u32 = 0x4004_4000;

/// The lower half of the timer's count of microseconds, and how far time goes on where the program only waits, for a time or in vain:
/// 0.1 ms.
const CLOCK: u32 = 0x4005_4028;
const CLOCK_STEP: u64 = 12_500;

/// The interrupt lines of the DMA controller start here.
const DMA_INTERRUPT: u8 = 11;

/// Pins that the OLED hangs on, and the function that connects them with the I2C controller.
const OLED: [usize; 2] = [4, 5];
const FUNCTION_I2C: u32 = 3;

/// A peripheral that is emulated here.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Device {
    Shared(peripherals::Device),
    I2c,
}

/// The whole chip without its processors, and the displays that are wired to it. A program uses one of them.
pub(super) struct Bus {
    pub(super) chip: Chip,
    pub(super) peripherals: Peripherals,
    oled: Oled,
    /// Processor cycles since the start.
    pub(super) cycle: u64,
    /// Since last cleared: an access to the fast I/O block, which takes one cycle instead of two.
    pub(super) fast: bool,
    /// Since last cleared: cycles that slow peripherals have added.
    pub(super) wait: u64,
    /// The cycle that the chip's own peripherals have reached.
    noticed: u64,
    waiting: Waiting,
    i2c: I2c,
}

impl Bus {
    pub(super) fn new(chip: Chip, panel: Panel) -> Self {
        Self {
            chip,
            peripherals: Peripherals::new(&LAYOUT, panel),
            oled: Oled::new(),
            cycle: 0,
            fast: false,
            wait: 0,
            noticed: 0,
            waiting: Waiting::default(),
            i2c: I2c::default(),
        }
    }

    fn device(&self, address: u32) -> Option<Device> {
        match address >> 28 {
            4 if address & PERIPHERAL == I2C0 => Some(Device::I2c),
            4 | 5 => self.peripherals.device(address).map(Device::Shared),
            _ => None,
        }
    }

    /// The program has not been heard of for too long.
    pub(super) fn hangs(&self) -> bool {
        self.peripherals.hangs(self.cycle)
    }

    /// Restarts the whole chip, as the watchdog does. The panel keeps its picture, and time goes on.
    pub(super) fn reset(&mut self, chip: Chip) {
        (self.chip, self.noticed, self.i2c) = (chip, self.cycle, I2c::default());
        self.peripherals.restart();
    }

    /// The picture on the OLED, which must have been driven well.
    pub(super) fn oled(&self) -> Result<Vec<u32>> {
        if let Some(fault) = self.i2c.fault() {
            bail!("the I2C controller was used wrongly: {fault}");
        }
        self.oled.check()?;
        Ok(self.oled.picture())
    }

    /// Lets time go on to `self.cycle`.
    pub(super) fn tick(&mut self) {
        self.peripherals.tick(self.cycle, &mut self.chip);
        if !self.i2c.idle() {
            let is_wired = OLED.iter().all(|&pin| self.chip.io_bank0.funcsel(pin) == FUNCTION_I2C);
            self.i2c.tick(self.cycle, is_wired.then_some(&mut self.oled));
        }
    }

    fn read_device(&mut self, device: Device, address: u32) -> u32 {
        match device {
            Device::Shared(device) => {
                if device == peripherals::Device::Spi && self.peripherals.spi.hung {
                    self.wait += CLOCK_STEP;
                }
                self.peripherals.read(device, address)
            }
            Device::I2c => self.i2c.read(address & REGISTER),
        }
    }

    /// True if the address is one of ours.
    fn write_device(&mut self, address: u32, written: u32) -> bool {
        match self.device(address) {
            None => return false,
            Some(Device::Shared(device)) => self.peripherals.write(device, address, written, self.cycle, &mut self.chip),
            Some(Device::I2c) => {
                let value = alias::written(address, written, || self.i2c.read(address & REGISTER));
                self.i2c.write(address & REGISTER, value, self.cycle);
            }
        }
        true
    }

    /// Counts what an access costs.
    fn note(&mut self, address: u32) {
        if address >> 28 == 4 {
            // The chip's own peripherals look at their time only when they are looked at.
            self.chip.advance_lazy_scheduled(self.cycle.saturating_sub(self.noticed));
            self.noticed = self.noticed.max(self.cycle);
        }
        match address >> 28 {
            0xD => self.fast = true,
            0x4 if address == CLOCK && self.i2c.idle() && self.peripherals.idle() => {
                self.wait += self.waiting.look(self.cycle, CLOCK_STEP);
            }
            0x4 => self.wait += 2,
            _ => {}
        }
    }
}

impl peripherals::Chip for Chip {
    fn pins(&self) -> u32 {
        self.sio.gpio_out & self.sio.gpio_oe
    }

    fn load(&mut self, address: u32, width: u32) -> u32 {
        match width {
            1 => self.read8(address).into(),
            2 => self.read16(address).into(),
            _ => self.read32(address),
        }
    }

    fn store(&mut self, address: u32, width: u32, value: u32) {
        match width {
            1 => self.write8(address, value as u8),
            2 => self.write16(address, value as u16),
            _ => self.write32(address, value),
        }
    }

    fn interrupt(&mut self, line: usize) {
        self.nvics[0].set_pending(DMA_INTERRUPT + line as u8);
    }
}

impl Memory for Chip {
    fn peek(&self, address: u32) -> u32 {
        self.peek32(address)
    }

    fn poke(&mut self, address: u32, value: u32) {
        self.poke32(address, value);
    }
}

impl CoreBus for Bus {
    fn read8(&mut self, address: u32) -> u8 {
        self.note(address);
        match self.device(address) {
            Some(device) => (self.read_device(device, address) >> (8 * (address & 3))) as u8,
            None => self.chip.read8(address),
        }
    }

    fn read16(&mut self, address: u32) -> u16 {
        self.note(address);
        match self.device(address) {
            Some(device) => (self.read_device(device, address) >> (8 * (address & 2))) as u16,
            None => self.chip.read16(address),
        }
    }

    fn read32(&mut self, address: u32) -> u32 {
        self.note(address);
        match self.device(address) {
            Some(device) => self.read_device(device, address),
            None => self.chip.read32(address),
        }
    }

    // The chip repeats a narrow write over the whole word.
    fn write8(&mut self, address: u32, value: u8) {
        self.note(address);
        if !self.write_device(address, u32::from(value) * 0x0101_0101) {
            self.chip.write8(address, value);
        }
    }

    fn write16(&mut self, address: u32, value: u16) {
        self.note(address);
        if !self.write_device(address, u32::from(value) * 0x0001_0001) {
            self.chip.write16(address, value);
        }
    }

    fn write32(&mut self, address: u32, value: u32) {
        self.note(address);
        if !self.write_device(address, value) {
            self.chip.write32(address, value);
        }
    }

    fn set_active_pc(&mut self, pc: u32) {
        self.chip.set_active_pc(pc);
    }

    fn bus_fault(&self) -> bool {
        self.chip.bus_fault()
    }

    fn bus_fault_addr(&self) -> u32 {
        self.chip.bus_fault_addr()
    }

    fn clear_bus_fault(&mut self) {
        self.chip.clear_bus_fault();
    }

    fn ppb(&self, core: usize) -> &Ppb {
        &self.chip.ppb[core]
    }

    fn ppb_mut(&mut self, core: usize) -> &mut Ppb {
        &mut self.chip.ppb[core]
    }

    fn nvic(&self, core: usize) -> &Nvic {
        &self.chip.nvics[core]
    }

    fn nvic_mut(&mut self, core: usize) -> &mut Nvic {
        &mut self.chip.nvics[core]
    }

    fn active_core(&self) -> usize {
        self.chip.active_core()
    }

    fn event_flag(&self, core: usize) -> bool {
        self.chip.event_flag[core]
    }

    fn consume_event_flag(&mut self, core: usize) -> bool {
        mem::replace(&mut self.chip.event_flag[core], false)
    }

    fn set_wfe_waiting(&mut self, core: usize, waiting: bool) {
        self.chip.wfe_waiting[core] = waiting;
    }

    fn signal_sev(&mut self) {
        self.chip.signal_sev();
    }
}
