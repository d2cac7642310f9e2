//! The timer, which counts microseconds of the processor's cycles.

use super::bus::MICROSECOND;

/// Offsets of registers.
mod register {
    pub(super) const HIGH: u32 = 0x24;
    pub(super) const LOW: u32 = 0x28;
    pub(super) const INTERRUPTS: u32 = 0x40;
}

/// A look at the lower half of the count.
pub(super) const CLOCK: u32 = register::LOW;

/// Registers of the timer.
#[derive(Default)]
pub(super) struct Timer {
    interrupts: u32,
    /// The first register that the program uses and that is not modelled.
    fault: Option<String>,
}

impl Timer {
    /// The first fault of the program.
    pub(super) fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    pub(super) fn read(&mut self, offset: u32, now: u64) -> u32 {
        let count = now / u64::from(MICROSECOND);
        match offset {
            register::HIGH => (count >> 32) as u32,
            register::LOW => count as u32,
            register::INTERRUPTS => self.interrupts,
            _ => {
                self.fault
                    .get_or_insert_with(|| format!("the program reads the register {offset:#04x} of the timer, which is not modelled"));
                0
            }
        }
    }

    /// Alarms are not modelled. A program may enable their interrupts, which never come, but may not set an alarm.
    pub(super) fn write(&mut self, offset: u32, value: u32) {
        match offset {
            register::INTERRUPTS => self.interrupts = value,
            _ => {
                self.fault
                    .get_or_insert_with(|| format!("the program writes to the register {offset:#04x} of the timer, which is not modelled"));
            }
        }
    }
}
