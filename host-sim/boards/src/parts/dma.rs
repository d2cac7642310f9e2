//! Registers of the DMA controller; [`super::peripherals`] moves the data.

/// What the controllers of two chips have in other places.
#[derive(Debug)]
pub(crate) struct Layout {
    pub(crate) channels: u32,
    /// Bits of a channel's control register: the write address goes on, no interrupt at the end, and the channel is busy.
    step_write: u32,
    quiet: u32,
    busy: u32,
    /// The place of the pace in that register.
    pace_shift: u32,
    /// Bits of a channel's count that are a number.
    count: u32,
    /// Offset of the register that aborts transfers.
    abort: u32,
    /// The request number of the second serial port's transmitter, which sets the pace of a channel.
    pub(crate) spi1: u32,
}

/// The controller of the RP2040.
pub(crate) const RP2040: Layout =
    Layout { channels: 12, step_write: 1 << 5, quiet: 1 << 21, busy: 1 << 24, pace_shift: 15, count: !0, abort: 0x444, spi1: 18 };

/// The controller of the RP2350.
pub(crate) const RP2350: Layout =
    Layout { channels: 16, step_write: 1 << 6, quiet: 1 << 23, busy: 1 << 26, pace_shift: 17, count: !(0xF << 28), abort: 0x464, spi1: 26 };

/// Control register of a channel.
mod control {
    pub(super) const ENABLE: u32 = 1 << 0;
    pub(super) const SIZE_SHIFT: u32 = 2;
    pub(super) const STEP_READ: u32 = 1 << 4;
}

/// The pace of a channel that waits for nobody.
pub(crate) const UNPACED: u32 = 63;

/// Offsets of the registers behind the channels'.
mod register {
    pub(super) const RAW: u32 = 0x400;
    pub(super) const ENABLE: [u32; 2] = [0x404, 0x414];
    pub(super) const STATUS: [u32; 2] = [0x40C, 0x41C];
}

/// Bytes of registers per channel.
const STRIDE: u32 = 0x40;

/// A channel. Its four registers appear in four orders.
#[derive(Clone, Copy, Default)]
struct Channel {
    read: u32,
    write: u32,
    /// Transfers to go.
    count: u32,
    reload: u32,
    control: u32,
    is_busy: bool,
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

/// A transfer that a channel makes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Transfer {
    pub(crate) from: u32,
    pub(crate) to: u32,
    /// Bytes.
    pub(crate) width: u32,
    /// The request number that it waits for.
    pub(crate) pace: u32,
}

/// The controller.
pub(crate) struct Dma {
    layout: &'static Layout,
    channels: Vec<Channel>,
    /// Channels that have ended, one bit each.
    ended: u32,
    /// Channels whose end raises each of the two interrupts, one bit each.
    enabled: [u32; 2],
    /// Whether a fault is simulated: transfers neither move data nor end.
    pub(crate) stalled: bool,
}

impl Dma {
    pub(crate) fn new(layout: &'static Layout) -> Self {
        Self { layout, channels: vec![Channel::default(); layout.channels as usize], ended: 0, enabled: [0; 2], stalled: false }
    }

    /// No channel has anything to do.
    pub(crate) fn idle(&self) -> bool {
        !self.channels.iter().any(|channel| channel.is_busy)
    }

    /// The next transfer of a channel, if it has any.
    pub(crate) fn next(&self, index: usize) -> Option<Transfer> {
        let Channel { read: from, write: to, control, .. } = self.channels[index];
        let is_left = self.channels[index].is_busy && self.channels[index].count > 0 && !self.stalled;
        let (width, pace) = (1 << (control >> control::SIZE_SHIFT & 3), control >> self.layout.pace_shift & 0x3F);
        is_left.then_some(Transfer { from, to, width, pace })
    }

    /// Counts the channel's next transfer, which has been made. Tells which interrupts that raises.
    pub(crate) fn advance(&mut self, index: usize) -> [bool; 2] {
        let channel = &mut self.channels[index];
        let width = 1 << (channel.control >> control::SIZE_SHIFT & 3);
        if channel.control & control::STEP_READ != 0 {
            channel.read = channel.read.wrapping_add(width);
        }
        if channel.control & self.layout.step_write != 0 {
            channel.write = channel.write.wrapping_add(width);
        }
        channel.count -= 1;
        if channel.count > 0 { [false; 2] } else { self.end(index) }
    }

    /// A channel has made all its transfers. Tells which interrupts that raises.
    fn end(&mut self, index: usize) -> [bool; 2] {
        let channel = &mut self.channels[index];
        channel.is_busy = false;
        if channel.control & self.layout.quiet != 0 {
            return [false; 2];
        }
        self.ended |= 1 << index;
        self.enabled.map(|enabled| enabled >> index & 1 == 1)
    }

    fn channel(&self, offset: u32) -> Option<usize> {
        (offset < STRIDE * self.layout.channels).then_some((offset / STRIDE) as usize)
    }

    pub(crate) fn read(&self, offset: u32) -> u32 {
        if let Some(index) = self.channel(offset) {
            let channel = &self.channels[index];
            return match Field::at(offset) {
                Field::Read => channel.read,
                Field::Write => channel.write,
                Field::Count => channel.count,
                Field::Control => channel.control | if channel.is_busy { self.layout.busy } else { 0 },
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
    pub(crate) fn write(&mut self, offset: u32, value: u32, written: u32) -> bool {
        if let Some(index) = self.channel(offset) {
            let channel = &mut self.channels[index];
            match Field::at(offset) {
                Field::Read => channel.read = value,
                Field::Write => channel.write = value,
                Field::Count => channel.reload = value & self.layout.count,
                Field::Control => channel.control = value & !self.layout.busy,
            }
            let started = Field::starts(offset) && channel.control & control::ENABLE != 0;
            if started {
                (channel.count, channel.is_busy) = (channel.reload, channel.reload > 0);
            }
            return started;
        }
        if offset == self.layout.abort {
            for (index, channel) in self.channels.iter_mut().enumerate() {
                channel.is_busy &= written >> index & 1 == 0;
            }
        } else if offset == register::RAW || register::STATUS.contains(&offset) {
            self.ended &= !written;
        } else if let Some(line) = register::ENABLE.iter().position(|&register| register == offset) {
            self.enabled[line] = value;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both chips copy bytes, from another control word each, and say when they are done.
    #[test]
    fn bits_lie_where_the_data_sheets_say() {
        // Enabled, bytes, both addresses go on, chained to itself (channel 0), at the pace of the second serial port.
        for (layout, control, abort) in [(&RP2040, 1 | 1 << 4 | 1 << 5 | 18 << 15, 0x444), (&RP2350, 1 | 1 << 4 | 1 << 6 | 26 << 17, 0x464)]
        {
            let mut dma = Dma::new(layout);
            dma.write(0x404, 1, 1);
            dma.write(0x00, 0x2000_0000, 0);
            dma.write(0x04, 0x2000_1000, 0);
            dma.write(0x08, 2, 0);
            assert!(dma.idle() && dma.next(0).is_none());
            assert!(dma.write(0x0C, control, control));
            assert_eq!(dma.read(0x0C), control | layout.busy);
            assert_eq!(dma.next(0), Some(Transfer { from: 0x2000_0000, to: 0x2000_1000, width: 1, pace: layout.spi1 }));
            assert_eq!(dma.advance(0), [false; 2]);
            assert_eq!(dma.next(0), Some(Transfer { from: 0x2000_0001, to: 0x2000_1001, width: 1, pace: layout.spi1 }));
            assert_eq!(dma.advance(0), [true, false]);
            assert!(dma.idle());
            assert_eq!((dma.read(0x0C), dma.read(0x40C)), (control, 1));
            dma.write(0x40C, 1, 1);
            assert_eq!(dma.read(0x40C), 0);
            // Started anew, it is aborted.
            dma.write(0x0C, control, control);
            dma.write(abort, 1, 1);
            assert!(dma.idle());
        }
        // The upper bits of the RP2350's count are a mode.
        let mut dma = Dma::new(&RP2350);
        dma.write(0x08, 1 << 28 | 5, 0);
        dma.write(0x0C, 1, 1);
        assert_eq!(dma.read(0x08), 5);
    }
}
