//! The bus of the emulated chip: the crate's bus, with our serial port and timer at their addresses, and the panel behind them.

use super::timer::{CLOCK, Timer};
use crate::parts::{
    alias::{self, PERIPHERAL, REGISTER},
    dma,
    panel::Panel,
    peripherals::{self, Layout, Peripherals},
    rtt::Memory,
    waiting::Waiting,
};
use anyhow::{Result, bail};
use rp2350_emu::{Bus as Chip, core::CoreBus, threaded::CoreAtomics};
use std::sync::Arc;

/// Processor cycles of a microsecond at the usual 150 MHz.
pub(super) const MICROSECOND: u32 = 150;

/// The peripherals that are ours. The crate has the serial port elsewhere, and its timer and watchdog run 12.5 times too fast.
const LAYOUT: Layout = Layout { spi1: 0x4008_8000, watchdog: 0x400D_8000, watchdog_cycles: MICROSECOND as f64, dma: &dma::RP2350 };
const TIMER: u32 = 0x400B_0000;
/// Control registers of the two PLLs, and the bit that says that they are stable. In the crate they take a time that only the crate itself can let pass.
const PLL: [u32; 2] = [0x4005_0000, 0x4005_8000];
const LOCKED: u32 = 1 << 31;
/// The control register of the clock that drives the serial ports, which the crate does not keep.
const PERIPHERAL_CLOCK: u32 = 0x4001_0048;

/// How far time goes on where the program only waits: 0.1 ms.
const CLOCK_STEP: u64 = 15_000;

/// The interrupt lines of the DMA controller start here.
const DMA_INTERRUPT: u32 = 10;

/// A peripheral that is emulated here.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Device {
    Shared(peripherals::Device),
    Timer,
    PeripheralClock,
}

/// The whole chip without its processors, and the panel that is wired to it.
pub(super) struct Bus {
    pub(super) chip: Chip,
    pub(super) peripherals: Peripherals,
    /// Processor cycles since the start.
    pub(super) cycle: u64,
    /// Since last cleared: cycles that pass while the program waits.
    pub(super) wait: u64,
    waiting: Waiting,
    timer: Timer,
    /// Contents of the register of that name.
    peripheral_clock: u32,
}

impl Bus {
    pub(super) fn new(chip: Chip, panel: Panel) -> Self {
        Self {
            chip,
            peripherals: Peripherals::new(&LAYOUT, panel),
            cycle: 0,
            wait: 0,
            waiting: Waiting::default(),
            timer: Timer::default(),
            peripheral_clock: 0,
        }
    }

    fn device(&self, address: u32) -> Option<Device> {
        match address >> 28 {
            4 if address & PERIPHERAL == TIMER => Some(Device::Timer),
            4 if address & !0x3000 == PERIPHERAL_CLOCK => Some(Device::PeripheralClock),
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
        (self.chip, self.timer, self.peripheral_clock) = (chip, Timer::default(), 0);
        self.peripherals.restart();
    }

    /// Lets time go on to `self.cycle`.
    pub(super) fn tick(&mut self) {
        self.peripherals.tick(self.cycle, &mut self.chip);
    }

    /// The picture on the panel, which must have been driven well.
    pub(super) fn picture(&self) -> Result<Vec<u32>> {
        self.check()?;
        Ok(self.peripherals.panel.picture())
    }

    /// Whether the panel shows a whole picture and was driven well, by a program that has used nothing that is not modelled.
    pub(super) fn check(&self) -> Result<()> {
        if let Some(fault) = self.timer.fault() {
            bail!("{fault}");
        }
        self.peripherals.panel.check()
    }

    /// Processor cycles in a cycle of the clock that drives the serial ports: the processors' own, or that of the PLL for USB.
    fn cycles_of_serial_clock(&mut self) -> f64 {
        /// The source of the clock, in its control register, and its value for the PLL for USB.
        const SOURCE: u32 = 7 << 5;
        const USB: u32 = 2 << 5;
        /// Frequency of the crystal.
        const CRYSTAL: f64 = 12e6;
        if self.peripheral_clock & SOURCE != USB {
            return 1.0;
        }
        let [control, _, multiplier, dividers] = [0, 4, 8, 12].map(|offset| self.chip.read32(PLL[1] + offset, 0));
        let divisor = (control & 0x3F).max(1) * (dividers >> 16 & 7) * (dividers >> 12 & 7);
        f64::from(MICROSECOND) * 1e6 / (CRYSTAL * f64::from(multiplier & 0xFFF) / f64::from(divisor))
    }

    fn read_device(&mut self, device: Device, address: u32) -> u32 {
        match device {
            Device::Shared(device) => {
                if device == peripherals::Device::Spi && self.peripherals.spi.hung {
                    self.wait += CLOCK_STEP;
                }
                self.peripherals.read(device, address)
            }
            Device::Timer => {
                if address & REGISTER == CLOCK && self.peripherals.idle() {
                    self.wait += self.waiting.look(self.cycle, CLOCK_STEP);
                }
                self.timer.read(address & REGISTER, self.cycle)
            }
            Device::PeripheralClock => self.peripheral_clock,
        }
    }

    /// True if the address is one of ours.
    fn write_device(&mut self, address: u32, written: u32) -> bool {
        let Some(device) = self.device(address) else {
            return false;
        };
        if let Device::Shared(device) = device {
            self.peripherals.write(device, address, written, self.cycle, &mut self.chip);
            return true;
        }
        let value = alias::written(address, written, || self.read_device(device, address));
        match device {
            Device::Timer => self.timer.write(address & REGISTER, value),
            _ => {
                self.peripheral_clock = value;
                self.peripherals.spi.clock = self.cycles_of_serial_clock();
            }
        }
        true
    }
}

impl peripherals::Chip for Chip {
    fn pins(&self) -> u32 {
        self.sio.gpio_out & self.sio.gpio_oe
    }

    fn load(&mut self, address: u32, width: u32) -> u32 {
        match width {
            1 => self.read8(address, 0).into(),
            2 => self.read16(address, 0).into(),
            _ => self.read32(address, 0),
        }
    }

    fn store(&mut self, address: u32, width: u32, value: u32) {
        match width {
            1 => self.write8(address, value as u8, 0),
            2 => self.write16(address, value as u16, 0),
            _ => self.write32(address, value, 0),
        }
    }

    fn interrupt(&mut self, line: usize) {
        self.atomics.assert_irq(0, DMA_INTERRUPT + line as u32);
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
        match self.device(address) {
            Some(device) => (self.read_device(device, address) >> (8 * (address & 3))) as u8,
            None => self.chip.read8(address, core),
        }
    }

    fn read16(&mut self, address: u32, core: u8) -> u16 {
        match self.device(address) {
            Some(device) => (self.read_device(device, address) >> (8 * (address & 2))) as u16,
            None => self.chip.read16(address, core),
        }
    }

    fn read32(&mut self, address: u32, core: u8) -> u32 {
        match self.device(address) {
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
