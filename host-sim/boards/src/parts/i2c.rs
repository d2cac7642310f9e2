//! The I2C controller (DW_apb_i2c) as a transmitter, with time: a byte arrives when its last bit has gone over the wire.

use super::oled::Oled;
use std::collections::VecDeque;

/// Entries of the queue.
const DEPTH: usize = 16;

/// Offsets of registers.
mod register {
    pub(super) const CONTROL: u32 = 0x00;
    pub(super) const TARGET: u32 = 0x04;
    pub(super) const DATA: u32 = 0x10;
    pub(super) const HIGH: u32 = 0x1C;
    pub(super) const LOW: u32 = 0x20;
    pub(super) const EVENTS: u32 = 0x34;
    pub(super) const CLEAR_ABORT: u32 = 0x54;
    pub(super) const CLEAR_STOP: u32 = 0x60;
    pub(super) const ENABLE: u32 = 0x6C;
    pub(super) const LEVEL: u32 = 0x74;
    pub(super) const HOLD: u32 = 0x7C;
    pub(super) const ABORT_SOURCE: u32 = 0x80;
    pub(super) const SPIKES: u32 = 0xA0;
}

/// The control register after a reset: a master in fast mode that may restart, and no slave.
const CONTROL: u32 = 0x65;

/// Bits of an entry of the queue above its byte. The others ask for a byte of the device, or for a second start.
mod entry {
    pub(super) const BYTE: u32 = 0xFF;
    pub(super) const STOP: u32 = 1 << 9;
}

/// Bits of the register of events.
mod event {
    pub(super) const QUEUE_EMPTY: u32 = 1 << 4;
    pub(super) const ABORT: u32 = 1 << 6;
    pub(super) const STOP: u32 = 1 << 9;
}

/// The only cause of an abort: nobody has acknowledged the address.
const ADDRESS_UNKNOWN: u32 = 1;

/// The state of the wires.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Wire {
    /// A message has ended, or none has begun.
    #[default]
    Idle,
    Address,
    Byte {
        value: u8,
        ends: bool,
    },
    /// The clock is held low, because the queue has become empty in the middle of a message.
    Held,
    Stop,
}

/// Registers and queue of the controller.
#[derive(Default)]
pub(crate) struct I2c {
    enabled: bool,
    target: u32,
    /// Cycles in which the clock is high and low.
    period: [u32; 2],
    hold: u32,
    spikes: u32,
    queue: VecDeque<u32>,
    wire: Wire,
    /// When the state of the wires ends.
    done: u64,
    stopped: bool,
    /// The address was not acknowledged. The queue takes nothing until the program has read this.
    aborted: bool,
    /// The first action of the program that the controller does not allow, or that is not modelled here.
    fault: Option<String>,
}

impl I2c {
    /// The first fault of the program.
    pub(crate) fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Whether no message is being sent.
    pub(crate) fn idle(&self) -> bool {
        self.wire == Wire::Idle
    }

    /// Remembers the first fault; later ones follow from it.
    fn fail(&mut self, fault: impl FnOnce() -> String) {
        self.fault.get_or_insert_with(fault);
    }

    /// Changes the state of the wires for a number of bits.
    fn enter(&mut self, wire: Wire, bits: u32, now: u64) {
        let [high, low] = self.period;
        (self.wire, self.done) = (wire, now + u64::from(bits * (high + low)));
    }

    /// Begins what the queue asks for, if the wires are free for it.
    fn proceed(&mut self, now: u64) {
        match self.wire {
            // A start, seven bits of the address, one for the direction, and the acknowledgement.
            Wire::Idle if !self.queue.is_empty() => self.enter(Wire::Address, 10, now),
            Wire::Held => {
                if let Some(entry) = self.queue.pop_front() {
                    self.enter(Wire::Byte { value: entry as u8, ends: entry & entry::STOP != 0 }, 9, now);
                }
            }
            _ => {}
        }
    }

    /// Lets time go on to `now`. The display is absent if the pins do not lead to it.
    pub(crate) fn tick(&mut self, now: u64, mut display: Option<&mut Oled>) {
        while !matches!(self.wire, Wire::Idle | Wire::Held) && self.done <= now {
            let done = self.done;
            match self.wire {
                Wire::Address if display.as_mut().is_some_and(|display| display.start(self.target)) => {
                    self.wire = Wire::Held;
                    self.proceed(done);
                }
                Wire::Address => {
                    self.aborted = true;
                    self.queue.clear();
                    self.enter(Wire::Stop, 1, done);
                }
                Wire::Byte { value, ends } => {
                    if let Some(display) = &mut display {
                        display.receive(value);
                    }
                    if ends {
                        self.enter(Wire::Stop, 1, done);
                    } else {
                        self.wire = Wire::Held;
                        self.proceed(done);
                    }
                }
                Wire::Stop => {
                    if let Some(display) = display.as_mut().filter(|_| !self.aborted) {
                        display.stop();
                    }
                    self.wire = Wire::Idle;
                    self.stopped = true;
                    self.proceed(done);
                }
                Wire::Idle | Wire::Held => {}
            }
        }
    }

    pub(crate) fn read(&mut self, offset: u32) -> u32 {
        match offset {
            register::CONTROL => CONTROL,
            register::TARGET => self.target,
            register::HIGH => self.period[0],
            register::LOW => self.period[1],
            register::EVENTS => {
                let bits = [
                    (event::QUEUE_EMPTY, self.enabled && self.queue.is_empty()),
                    (event::ABORT, self.aborted),
                    (event::STOP, self.stopped),
                ];
                bits.into_iter().filter(|&(_, happened)| happened).map(|(bit, _)| bit).sum()
            }
            register::CLEAR_ABORT => {
                self.aborted = false;
                0
            }
            register::CLEAR_STOP => {
                self.stopped = false;
                0
            }
            register::ENABLE => self.enabled.into(),
            register::LEVEL => self.queue.len() as u32,
            register::HOLD => self.hold,
            register::ABORT_SOURCE if self.aborted => ADDRESS_UNKNOWN,
            register::ABORT_SOURCE => 0,
            register::SPIKES => self.spikes,
            _ => {
                self.fail(|| format!("the program reads the register at {offset:#04x}, which is not modelled"));
                0
            }
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32, now: u64) {
        let is_setting = matches!(offset, register::TARGET | register::HIGH | register::LOW | register::HOLD | register::SPIKES);
        if is_setting && self.enabled {
            self.fail(|| format!("the program changes the setting at {offset:#04x} of a controller that is enabled"));
        }
        match offset {
            register::TARGET => self.target = value,
            register::HIGH => self.period[0] = value,
            register::LOW => self.period[1] = value,
            register::HOLD => self.hold = value,
            register::SPIKES => self.spikes = value,
            register::ENABLE => {
                if !self.idle() {
                    self.fail(|| "the program switches the controller while it sends a message".to_owned());
                }
                if value > 1 {
                    self.fail(|| format!("the program enables the controller by {value:#x}, which is not modelled"));
                }
                self.enabled = value & 1 == 1;
            }
            register::DATA => self.push(value, now),
            _ => self.fail(|| format!("the program writes to the register at {offset:#04x}, which is not modelled")),
        }
    }

    /// Queues a byte.
    fn push(&mut self, entry: u32, now: u64) {
        if !self.enabled {
            self.fail(|| "the program sends by a controller that is not enabled".to_owned());
        } else if entry & !(entry::BYTE | entry::STOP) != 0 {
            self.fail(|| format!("the program queues {entry:#x}: only sending is modelled, not reading or a second start"));
        } else if self.queue.len() == DEPTH {
            self.fail(|| "the program sends a byte for which the queue has no room".to_owned());
        } else if !self.aborted {
            self.queue.push_back(entry);
            self.proceed(now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BIT: u64 = 300;

    fn enabled(address: u32) -> I2c {
        let mut i2c = I2c::default();
        for (offset, value) in [(register::HIGH, 100), (register::LOW, 200), (register::TARGET, address), (register::ENABLE, 1)] {
            i2c.write(offset, value, 0);
        }
        i2c
    }

    #[test]
    fn bytes_take_their_time() {
        let (mut i2c, mut display) = (enabled(0x3C), Oled::new());
        i2c.write(register::DATA, 0x00, 0);
        i2c.write(register::DATA, 0xAE | entry::STOP, 0);
        let mut at = |i2c: &mut I2c, bits: u64| {
            i2c.tick(bits * BIT, Some(&mut display));
            (i2c.read(register::LEVEL), i2c.read(register::EVENTS))
        };
        assert_eq!(at(&mut i2c, 9), (2, 0));
        assert_eq!(at(&mut i2c, 10), (1, 0));
        assert_eq!(at(&mut i2c, 18), (1, 0));
        assert_eq!(at(&mut i2c, 19), (0, event::QUEUE_EMPTY));
        assert_eq!(at(&mut i2c, 28), (0, event::QUEUE_EMPTY));
        assert_eq!(at(&mut i2c, 29), (0, event::QUEUE_EMPTY | event::STOP));
        assert_eq!(i2c.read(register::CLEAR_STOP), 0);
        assert_eq!(at(&mut i2c, 29), (0, event::QUEUE_EMPTY));
        assert_eq!(i2c.fault(), None);
    }

    #[test]
    fn nobody_answers_at_another_address_or_by_other_pins() {
        for (address, wired) in [(0x3D, true), (0x3C, false)] {
            let (mut i2c, mut display) = (enabled(address), Oled::new());
            i2c.write(register::DATA, 0x00, 0);
            i2c.tick(11 * BIT, wired.then_some(&mut display));
            assert_eq!(i2c.read(register::EVENTS), event::QUEUE_EMPTY | event::ABORT | event::STOP);
            assert_eq!(i2c.read(register::ABORT_SOURCE), ADDRESS_UNKNOWN);
            // What is sent before the program has looked is lost.
            i2c.write(register::DATA, 0xAE, 0);
            assert_eq!((i2c.read(register::LEVEL), i2c.idle()), (0, true));
            assert_eq!([register::CLEAR_ABORT, register::ABORT_SOURCE].map(|offset| i2c.read(offset)), [0, 0]);
        }
    }

    /// What a program does wrong, and a part of the message.
    type WrongUse = (fn(&mut I2c), &'static str);

    #[test]
    fn wrong_use_is_told() {
        let uses: [WrongUse; 6] = [
            (|i2c| i2c.write(register::TARGET, 0x3D, 0), "changes the setting at 0x04"),
            (|i2c| i2c.write(register::DATA, 1 << 8, 0), "only sending is modelled"),
            (|i2c| (0..17).for_each(|_| i2c.write(register::DATA, 0, 0)), "no room"),
            (|i2c| assert_eq!(i2c.read(0x70), 0), "reads the register at 0x70"),
            (|i2c| i2c.write(0x30, 0, 0), "writes to the register at 0x30"),
            (
                |i2c| {
                    i2c.write(register::DATA, 0, 0);
                    i2c.write(register::ENABLE, 0, 0);
                },
                "while it sends",
            ),
        ];
        for (wrong, message) in uses {
            let mut i2c = enabled(0x3C);
            wrong(&mut i2c);
            assert!(i2c.fault().is_some_and(|fault| fault.contains(message)), "{message}: {:?}", i2c.fault());
        }
    }
}
