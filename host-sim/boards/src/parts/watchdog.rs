//! The watchdog, which restarts the chip unless the program sets its counter in time.

/// Offsets of registers. Registers behind them belong to the crate's chip.
mod register {
    pub(super) const CONTROL: u32 = 0x0;
    pub(super) const LOAD: u32 = 0x4;
    pub(super) const REASON: u32 = 0x8;
}

/// Bytes of registers.
pub(crate) const SIZE: u32 = 0xC;

const ENABLE: u32 = 1 << 30;
/// The count has 24 bits.
const COUNT: u32 = 0xFF_FFFF;
/// The reason of the last reset: time was over.
const TIME_OUT: u32 = 1;

/// Registers, and the cycle in which time is over.
pub(crate) struct Watchdog {
    /// Processor cycles in which the count runs down by one.
    cycles: f64,
    control: u32,
    count: u32,
    reason: u32,
    deadline: Option<u64>,
}

impl Watchdog {
    pub(crate) fn new(cycles: f64) -> Self {
        Self { cycles, control: 0, count: 0, reason: 0, deadline: None }
    }

    /// The watchdog after it has restarted the chip.
    pub(crate) fn restart(&mut self) {
        *self = Self { reason: TIME_OUT, ..Self::new(self.cycles) };
    }

    /// Time is over.
    pub(crate) fn expired(&self, now: u64) -> bool {
        self.deadline.is_some_and(|deadline| deadline <= now)
    }

    pub(crate) fn read(&self, offset: u32) -> u32 {
        match offset {
            register::CONTROL => self.control,
            register::REASON => self.reason,
            _ => 0,
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32, now: u64) {
        match offset {
            register::CONTROL => self.control = value & !COUNT,
            register::LOAD => self.count = value & COUNT,
            _ => return,
        }
        let end = now + (f64::from(self.count) * self.cycles) as u64;
        self.deadline = (self.control & ENABLE != 0).then_some(end);
    }
}
