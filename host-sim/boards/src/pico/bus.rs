//! The bus of the emulated chip: the crate's bus, with our serial ports and DMA at their addresses, and the displays behind them.

use super::{
    Fault,
    dma::{CHANNELS, Dma, PACED_BY_SPI1, UNPACED},
    watchdog::{self, Watchdog},
};
use crate::parts::{
    alias::{self, PERIPHERAL, REGISTER},
    i2c::I2c,
    oled::Oled,
    panel::Panel,
    rtt::Memory,
    spi::Spi,
    waiting::Waiting,
};
use anyhow::{Result, bail};
use rp2040_emu::{
    Bus as Chip,
    bus::ppb::Ppb,
    core::{CoreBus, Nvic},
};
use std::mem;

/// Addresses of our peripherals; each appears four times: plain, toggling, setting and clearing bits.
const SPI1: u32 = 0x4004_0000;
const I2C0: u32 = 0x4004_4000;
const DMA: u32 = 0x5000_0000;
const WATCHDOG: u32 = 0x4005_8000;

/// The lower half of the timer's count of microseconds, and how far time goes on where the program only waits, for a time or in vain:
/// 0.1 ms.
const CLOCK: u32 = 0x4005_4028;
const CLOCK_STEP: u64 = 12_500;

/// The interrupt lines of the DMA controller start here.
const DMA_INTERRUPT: u8 = 11;

/// Pins that the panel hangs on.
const SELECT: u32 = 9;
const DATA: u32 = 8;
const LED: u32 = 25;
/// Pins that the OLED hangs on, and the function that connects them with the I2C controller.
const OLED: [usize; 2] = [4, 5];
const FUNCTION_I2C: u32 = 3;

/// A peripheral that is emulated here.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Device {
    Spi,
    I2c,
    Dma,
    Watchdog,
}

fn device(address: u32) -> Option<Device> {
    match address & PERIPHERAL {
        SPI1 => Some(Device::Spi),
        I2C0 => Some(Device::I2c),
        DMA => Some(Device::Dma),
        WATCHDOG if address & 0xFFF < watchdog::SIZE => Some(Device::Watchdog),
        _ => None,
    }
}

/// The whole chip without its processors, and the displays that are wired to it. A program uses one of them.
pub(super) struct Bus {
    pub(super) chip: Chip,
    pub(super) panel: Panel,
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
    spi: Spi,
    i2c: I2c,
    dma: Dma,
    watchdog: Watchdog,
    /// A DMA channel waits for room in the serial port.
    blocked: bool,
}

impl Bus {
    pub(super) fn new(chip: Chip, panel: Panel) -> Self {
        Self {
            chip,
            panel,
            oled: Oled::new(),
            cycle: 0,
            fast: false,
            wait: 0,
            noticed: 0,
            waiting: Waiting::default(),
            spi: Spi::default(),
            i2c: I2c::default(),
            dma: Dma::default(),
            watchdog: Watchdog::default(),
            blocked: false,
        }
    }

    /// The program has not been heard of for too long.
    pub(super) fn hangs(&self) -> bool {
        self.watchdog.expired(self.cycle)
    }

    /// Restarts the whole chip, as the watchdog does. The panel keeps its picture, and time goes on.
    pub(super) fn reset(&mut self, chip: Chip) {
        (self.chip, self.noticed, self.blocked) = (chip, self.cycle, false);
        (self.spi, self.i2c, self.dma, self.watchdog) = (Spi::default(), I2c::default(), Dma::default(), Watchdog::after_reset());
    }

    /// Breaks something.
    pub(super) fn inject(&mut self, fault: Fault) {
        match fault {
            Fault::DmaStalls => self.dma.stalled = true,
            Fault::SpiHangs => self.spi.hung = true,
        }
    }

    /// Nobody speaks to the panel.
    pub(super) fn quiet(&self) -> bool {
        self.spi.idle() && self.dma.idle() && self.pin(SELECT)
    }

    /// The picture on the OLED, which must have been driven well.
    pub(super) fn oled(&self) -> Result<Vec<u32>> {
        if let Some(fault) = self.i2c.fault() {
            bail!("the I2C controller was used wrongly: {fault}");
        }
        self.oled.check()?;
        Ok(self.oled.picture())
    }

    fn pin(&self, number: u32) -> bool {
        (self.chip.sio.gpio_out & self.chip.sio.gpio_oe) >> number & 1 == 1
    }

    /// Cycles in which the serial port was sending.
    pub(super) fn wire(&self) -> u64 {
        self.spi.busy
    }

    pub(super) fn led(&self) -> bool {
        self.pin(LED)
    }

    /// Lets time go on to `self.cycle`: words leave the serial port, and DMA refills it.
    ///
    /// The panel looks at its pins when a byte is complete, so a firmware that changes them too early is found out.
    pub(super) fn tick(&mut self) {
        while let Some((word, when)) = self.spi.sent(self.cycle) {
            let (selected, data) = (!self.pin(SELECT), self.pin(DATA));
            self.panel.receive(selected, data, word as u8);
            if self.blocked {
                self.transfer(when);
            }
        }
        if !self.i2c.idle() {
            let is_wired = OLED.iter().all(|&pin| self.chip.io_bank0.funcsel(pin) == FUNCTION_I2C);
            self.i2c.tick(self.cycle, is_wired.then_some(&mut self.oled));
        }
    }

    /// Makes the DMA transfers that can be made at cycle `now`.
    fn transfer(&mut self, now: u64) {
        self.blocked = false;
        if self.dma.stalled {
            return;
        }
        for index in 0..CHANNELS {
            while self.dma.channels[index].busy() && self.dma.channels[index].count > 0 {
                let channel = self.dma.channels[index];
                match channel.pace() {
                    UNPACED => {}
                    PACED_BY_SPI1 if self.spi.ready() => {}
                    PACED_BY_SPI1 => {
                        self.blocked = true;
                        break;
                    }
                    // Nothing else asks for data here, so such a channel never moves.
                    _ => break,
                }
                self.copy(channel.read, channel.write, channel.width(), now);
                self.dma.channels[index].advance();
            }
            if self.dma.channels[index].busy() && self.dma.channels[index].count == 0 {
                for (line, raised) in (0..).zip(self.dma.end(index)) {
                    if raised {
                        self.chip.nvics[0].set_pending(DMA_INTERRUPT + line);
                    }
                }
            }
        }
    }

    fn copy(&mut self, from: u32, to: u32, width: u32, now: u64) {
        let value = match width {
            1 => self.chip.read8(from).into(),
            2 => self.chip.read16(from).into(),
            _ => self.chip.read32(from),
        };
        match (device(to), width) {
            (Some(Device::Spi), _) => self.spi.push(value as u16, now),
            (_, 1) => self.chip.write8(to, value as u8),
            (_, 2) => self.chip.write16(to, value as u16),
            _ => self.chip.write32(to, value),
        }
    }

    fn read_device(&mut self, device: Device, address: u32) -> u32 {
        match device {
            Device::Spi => {
                if self.spi.hung {
                    self.wait += CLOCK_STEP;
                }
                self.spi.read(address & REGISTER)
            }
            Device::I2c => self.i2c.read(address & REGISTER),
            Device::Dma => self.dma.read(address & REGISTER),
            Device::Watchdog => self.watchdog.read(address & REGISTER),
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
            Device::I2c => self.i2c.write(address & REGISTER, value, self.cycle),
            Device::Watchdog => self.watchdog.write(address & REGISTER, value, self.cycle),
            Device::Dma => {
                if self.dma.write(address & REGISTER, value, written) {
                    self.transfer(self.cycle);
                }
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
            0x4 if address == CLOCK && self.spi.idle() && self.i2c.idle() && self.dma.idle() => {
                self.wait += self.waiting.look(self.cycle, CLOCK_STEP);
            }
            0x4 => self.wait += 2,
            _ => {}
        }
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
        match device(address) {
            Some(device) => (self.read_device(device, address) >> (8 * (address & 3))) as u8,
            None => self.chip.read8(address),
        }
    }

    fn read16(&mut self, address: u32) -> u16 {
        self.note(address);
        match device(address) {
            Some(device) => (self.read_device(device, address) >> (8 * (address & 2))) as u16,
            None => self.chip.read16(address),
        }
    }

    fn read32(&mut self, address: u32) -> u32 {
        self.note(address);
        match device(address) {
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
