//! Registers of the DMA controller; the bus moves the data.

/// Channels of the chip.
pub(super) const CHANNELS: usize = 12;

/// Control register of a channel.
mod control {
    pub(super) const ENABLE: u32 = 1 << 0;
    pub(super) const SIZE_SHIFT: u32 = 2;
    pub(super) const STEP_READ: u32 = 1 << 4;
    pub(super) const STEP_WRITE: u32 = 1 << 5;
    pub(super) const PACE_SHIFT: u32 = 15;
    pub(super) const QUIET: u32 = 1 << 21;
    pub(super) const BUSY: u32 = 1 << 24;
}

/// The request number of the second serial port's transmitter, which sets the pace of a channel.
pub(super) const PACED_BY_SPI1: u32 = 18;
pub(super) const UNPACED: u32 = 63;

/// Offsets of the registers behind the channels'.
mod register {
    pub(super) const RAW: u32 = 0x400;
    pub(super) const ENABLE: [u32; 2] = [0x404, 0x414];
    pub(super) const STATUS: [u32; 2] = [0x40C, 0x41C];
    pub(super) const ABORT: u32 = 0x444;
}

/// Bytes of registers per channel, and where they end.
const STRIDE: u32 = 0x40;
const CHANNELS_END: u32 = STRIDE * CHANNELS as u32;

/// A channel. Its four registers appear in four orders.
#[derive(Clone, Copy, Default)]
pub(super) struct Channel {
    pub(super) read: u32,
    pub(super) write: u32,
    /// Transfers to go.
    pub(super) count: u32,
    reload: u32,
    control: u32,
}

/// Field of a channel by its offset: in each of the four groups another one comes last and starts the channel.
enum Field {
    Read,
    Write,
    Count,
    Control,
}

impl Field {
    fn at(offset: u32) -> Self {
        match offset % STRIDE {
            0x00 | 0x14 | 0x28 | 0x3C => Self::Read,
            0x04 | 0x18 | 0x2C | 0x34 => Self::Write,
            0x08 | 0x1C | 0x24 | 0x38 => Self::Count,
            _ => Self::Control,
        }
    }

    const fn starts(offset: u32) -> bool {
        offset & 0xF == 0xC
    }
}

impl Channel {
    pub(super) fn busy(&self) -> bool {
        self.control & control::BUSY != 0
    }

    /// Bytes of one transfer.
    pub(super) fn width(&self) -> u32 {
        1 << (self.control >> control::SIZE_SHIFT & 3)
    }

    pub(super) fn pace(&self) -> u32 {
        self.control >> control::PACE_SHIFT & 0x3F
    }

    /// Counts a transfer that has been made.
    pub(super) fn advance(&mut self) {
        let width = self.width();
        if self.control & control::STEP_READ != 0 {
            self.read = self.read.wrapping_add(width);
        }
        if self.control & control::STEP_WRITE != 0 {
            self.write = self.write.wrapping_add(width);
        }
        self.count -= 1;
    }
}

/// The controller.
#[derive(Default)]
pub(super) struct Dma {
    pub(super) channels: [Channel; CHANNELS],
    /// Channels that have ended, one bit each.
    ended: u32,
    /// Channels whose end raises each of the two interrupts, one bit each.
    enabled: [u32; 2],
    /// Whether a fault is simulated: transfers neither move data nor end.
    pub(super) stalled: bool,
}

impl Dma {
    /// No channel has anything to do.
    pub(super) fn idle(&self) -> bool {
        !self.channels.iter().any(Channel::busy)
    }

    /// A channel has made all its transfers. Tells which interrupts that raises.
    pub(super) fn end(&mut self, index: usize) -> [bool; 2] {
        let channel = &mut self.channels[index];
        channel.control &= !control::BUSY;
        if channel.control & control::QUIET != 0 {
            return [false; 2];
        }
        self.ended |= 1 << index;
        self.enabled.map(|enabled| enabled >> index & 1 == 1)
    }

    pub(super) fn read(&self, offset: u32) -> u32 {
        if offset < CHANNELS_END {
            let channel = &self.channels[(offset / STRIDE) as usize];
            return match Field::at(offset) {
                Field::Read => channel.read,
                Field::Write => channel.write,
                Field::Count => channel.count,
                Field::Control => channel.control,
            };
        }
        let of = |registers: [u32; 2]| registers.iter().position(|&register| register == offset);
        match offset {
            register::RAW => self.ended,
            _ => match (of(register::ENABLE), of(register::STATUS)) {
                (Some(line), _) => self.enabled[line],
                (_, Some(line)) => self.ended & self.enabled[line],
                _ => 0,
            },
        }
    }

    /// Writes a register. `value` is the register's new content, `written` what the program wrote: they differ where it set or cleared
    /// single bits. True when a channel has been started.
    pub(super) fn write(&mut self, offset: u32, value: u32, written: u32) -> bool {
        if offset < CHANNELS_END {
            let channel = &mut self.channels[(offset / STRIDE) as usize];
            match Field::at(offset) {
                Field::Read => channel.read = value,
                Field::Write => channel.write = value,
                Field::Count => channel.reload = value,
                Field::Control => channel.control = channel.control & control::BUSY | value & !control::BUSY,
            }
            let started = Field::starts(offset) && channel.control & control::ENABLE != 0;
            if started {
                channel.count = channel.reload;
                channel.control |= control::BUSY;
            }
            return started;
        }
        match offset {
            register::ABORT => {
                for (index, channel) in self.channels.iter_mut().enumerate() {
                    if written >> index & 1 == 1 {
                        channel.control &= !control::BUSY;
                    }
                }
            }
            _ if offset == register::RAW || register::STATUS.contains(&offset) => self.ended &= !written,
            _ => {
                if let Some(line) = register::ENABLE.iter().position(|&register| register == offset) {
                    self.enabled[line] = value;
                }
            }
        }
        false
    }
}
