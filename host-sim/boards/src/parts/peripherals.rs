//! What the boards with a panel have in common: a serial port that DMA fills, the panel behind it, and a watchdog.

use super::{
    alias::{self, PERIPHERAL, REGISTER},
    dma::{self, Dma, Transfer, UNPACED},
    panel::Panel,
    spi::Spi,
    watchdog::{self, Watchdog},
};

/// The DMA controller's address in all chips.
const DMA: u32 = 0x5000_0000;

/// Pins that the panel hangs on, and the board's light.
const SELECT: u32 = 9;
const DATA: u32 = 8;
const LED: u32 = 25;

/// Faults that can be simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// DMA moves no more data, so no transfer ends.
    DmaStalls,
    /// The serial port is busy with a word for ever. A reset mends it.
    SpiHangs,
}

/// What is different in two chips.
#[derive(Debug)]
pub(crate) struct Layout {
    /// Address of the second serial port.
    pub(crate) spi1: u32,
    /// Address of the watchdog, and the processor cycles in which it counts down by one.
    pub(crate) watchdog: u32,
    pub(crate) watchdog_cycles: f64,
    pub(crate) dma: &'static dma::Layout,
}

/// The chip that they belong to.
pub(crate) trait Chip {
    /// The levels of the pins that the program drives, one bit each.
    fn pins(&self) -> u32;
    /// Reads one, two or four bytes of memory.
    fn load(&mut self, address: u32, width: u32) -> u32;
    /// Writes one, two or four bytes of memory.
    fn store(&mut self, address: u32, width: u32, value: u32);
    /// DMA raises its first or second interrupt.
    fn interrupt(&mut self, line: usize);
}

/// A peripheral that is emulated here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Device {
    Spi,
    Dma,
    Watchdog,
}

/// All of them, and the panel.
pub(crate) struct Peripherals {
    layout: &'static Layout,
    pub(crate) spi: Spi,
    dma: Dma,
    watchdog: Watchdog,
    pub(crate) panel: Panel,
    /// A DMA channel waits for room in the serial port.
    blocked: bool,
}

impl Peripherals {
    pub(crate) fn new(layout: &'static Layout, panel: Panel) -> Self {
        let (dma, watchdog) = (Dma::new(layout.dma), Watchdog::new(layout.watchdog_cycles));
        Self { layout, spi: Spi::default(), dma, watchdog, panel, blocked: false }
    }

    /// The peripheral at an address.
    pub(crate) fn device(&self, address: u32) -> Option<Device> {
        match address & PERIPHERAL {
            DMA => Some(Device::Dma),
            at if at == self.layout.spi1 => Some(Device::Spi),
            at if at == self.layout.watchdog && address & 0xFFF < watchdog::SIZE => Some(Device::Watchdog),
            _ => None,
        }
    }

    /// The program has not been heard of for too long.
    pub(crate) fn hangs(&self, now: u64) -> bool {
        self.watchdog.expired(now)
    }

    /// Restarts them, as the watchdog does. The panel keeps its picture.
    pub(crate) fn restart(&mut self) {
        (self.spi, self.dma, self.blocked) = (Spi::default(), Dma::new(self.layout.dma), false);
        self.watchdog.restart();
    }

    /// Breaks something.
    pub(crate) fn inject(&mut self, fault: Fault) {
        match fault {
            Fault::DmaStalls => self.dma.stalled = true,
            Fault::SpiHangs => self.spi.hung = true,
        }
    }

    /// Neither the serial port nor DMA has anything to do.
    pub(crate) fn idle(&self) -> bool {
        self.spi.idle() && self.dma.idle()
    }

    /// Nobody speaks to the panel.
    pub(crate) fn quiet(&self, chip: &impl Chip) -> bool {
        self.idle() && chip.pins() >> SELECT & 1 == 1
    }

    /// The board's light is on.
    pub(crate) fn led(chip: &impl Chip) -> bool {
        chip.pins() >> LED & 1 == 1
    }

    /// Lets time go on to `now`: words leave the serial port, and DMA refills it.
    ///
    /// The panel looks at its pins when a byte is complete, so a firmware that changes them too early is found out.
    pub(crate) fn tick(&mut self, now: u64, chip: &mut impl Chip) {
        while let Some((word, when)) = self.spi.sent(now) {
            let pins = chip.pins();
            self.panel.receive(pins >> SELECT & 1 == 0, pins >> DATA & 1 == 1, word as u8);
            if self.blocked {
                self.transfer(when, chip);
            }
        }
    }

    /// Makes the DMA transfers that can be made at cycle `now`.
    fn transfer(&mut self, now: u64, chip: &mut impl Chip) {
        self.blocked = false;
        for index in 0..self.layout.dma.channels as usize {
            while let Some(transfer) = self.dma.next(index) {
                match transfer.pace {
                    UNPACED => {}
                    pace if pace == self.layout.dma.spi1 && self.spi.ready() => {}
                    // Nothing else asks for data here, so another channel never moves.
                    pace => {
                        self.blocked |= pace == self.layout.dma.spi1;
                        break;
                    }
                }
                self.copy(transfer, now, chip);
                for (line, raised) in self.dma.advance(index).into_iter().enumerate() {
                    if raised {
                        chip.interrupt(line);
                    }
                }
            }
        }
    }

    fn copy(&mut self, Transfer { from, to, width, .. }: Transfer, now: u64, chip: &mut impl Chip) {
        let value = chip.load(from, width);
        if self.device(to) == Some(Device::Spi) {
            self.spi.push(value as u16, now);
        } else {
            chip.store(to, width, value);
        }
    }

    pub(crate) fn read(&mut self, device: Device, address: u32) -> u32 {
        let register = address & REGISTER;
        match device {
            Device::Spi => self.spi.read(register),
            Device::Dma => self.dma.read(register),
            Device::Watchdog => self.watchdog.read(register),
        }
    }

    /// Writes a word, or a narrower one repeated over a whole word.
    pub(crate) fn write(&mut self, device: Device, address: u32, written: u32, now: u64, chip: &mut impl Chip) {
        let (register, value) = (address & REGISTER, alias::written(address, written, || self.read(device, address)));
        match device {
            Device::Spi => self.spi.write(register, value, now),
            Device::Watchdog => self.watchdog.write(register, value, now),
            Device::Dma => {
                if self.dma.write(register, value, written) {
                    self.transfer(now, chip);
                }
            }
        }
    }
}
