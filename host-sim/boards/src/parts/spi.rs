//! The serial port (PL022) as a transmitter, with time: a byte arrives when its last bit has gone over the wire.

use std::collections::VecDeque;

/// Entries of each queue.
const DEPTH: usize = 8;

/// Offsets of registers.
mod register {
    pub(crate) const CONTROL_0: u32 = 0x00;
    pub(crate) const CONTROL_1: u32 = 0x04;
    pub(crate) const DATA: u32 = 0x08;
    pub(crate) const STATUS: u32 = 0x0C;
    pub(crate) const PRESCALE: u32 = 0x10;
    pub(crate) const INTERRUPT_MASK: u32 = 0x14;
    pub(crate) const DMA_CONTROL: u32 = 0x24;
}

/// Registers and queues of the port.
pub(crate) struct Spi {
    /// Processor cycles in a cycle of the clock that drives the port.
    pub(crate) clock: f64,
    control: [u32; 2],
    prescale: u32,
    interrupt_mask: u32,
    dma_control: u32,
    transmit: VecDeque<u16>,
    received: VecDeque<u16>,
    /// When the word at the front of `transmit` has been sent.
    done: Option<f64>,
    /// Cycles that sending took, of all words so far.
    busy: f64,
    /// The word on the wire never ends.
    pub(crate) hung: bool,
}

impl Default for Spi {
    fn default() -> Self {
        Self {
            clock: 1.0,
            control: [0; 2],
            prescale: 0,
            interrupt_mask: 0,
            dma_control: 0,
            transmit: VecDeque::new(),
            received: VecDeque::new(),
            done: None,
            busy: 0.0,
            hung: false,
        }
    }
}

impl Spi {
    /// Whether nothing is being sent.
    pub(crate) fn idle(&self) -> bool {
        self.done.is_none()
    }

    /// Cycles in which the port was sending, up to the last complete word.
    pub(crate) fn busy(&self) -> u64 {
        self.busy as u64
    }

    /// There is room for a word.
    pub(crate) fn ready(&self) -> bool {
        self.transmit.len() < DEPTH
    }

    /// Queues a word at cycle `now`; when there is no room it is lost, as in the chip.
    pub(crate) fn push(&mut self, word: u16, now: u64) {
        if self.ready() {
            self.transmit.push_back(word);
            self.start(now as f64);
        }
    }

    /// Cycles that one word takes.
    fn duration(&self) -> f64 {
        let divisor = self.prescale.max(2) * ((self.control[0] >> 8 & 0xFF) + 1);
        let bits = (self.control[0] & 0xF) + 1;
        f64::from(divisor * bits) * self.clock
    }

    /// Puts the next word on the wire if the wire is free.
    fn start(&mut self, now: f64) {
        if self.done.is_none() && !self.transmit.is_empty() {
            self.done = Some(now + self.duration());
        }
    }

    /// The word whose last bit was sent at or before `now`, and when that was.
    pub(crate) fn sent(&mut self, now: u64) -> Option<(u16, u64)> {
        let done = self.done.filter(|&done| done <= now as f64 && !self.hung)?;
        self.done = None;
        let word = self.transmit.pop_front()?;
        self.busy += self.duration();
        // Every word sent is a word received; nobody drives the wire.
        if self.received.len() < DEPTH {
            self.received.push_back(0);
        }
        self.start(done);
        Some((word, done as u64))
    }

    pub(crate) fn read(&mut self, offset: u32) -> u32 {
        match offset {
            register::DATA => self.received.pop_front().unwrap_or(0).into(),
            register::CONTROL_0 => self.control[0],
            register::CONTROL_1 => self.control[1],
            register::STATUS => {
                let bits = [
                    self.transmit.is_empty(),
                    self.ready(),
                    !self.received.is_empty(),
                    self.received.len() == DEPTH,
                    !self.transmit.is_empty(),
                ];
                bits.iter().rev().fold(0, |status, &bit| status << 1 | u32::from(bit))
            }
            register::PRESCALE => self.prescale,
            register::INTERRUPT_MASK => self.interrupt_mask,
            register::DMA_CONTROL => self.dma_control,
            _ => 0,
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32, now: u64) {
        match offset {
            register::DATA => self.push(value as u16, now),
            register::CONTROL_0 => self.control[0] = value,
            register::CONTROL_1 => self.control[1] = value,
            register::PRESCALE => self.prescale = value & 0xFE,
            register::INTERRUPT_MASK => self.interrupt_mask = value,
            register::DMA_CONTROL => self.dma_control = value,
            _ => {}
        }
    }
}
