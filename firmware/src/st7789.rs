//! An ST7789 panel of 240x240 pixels on the second serial port of an RP2040 or RP2350, fed by DMA.

use crate::{Display, Failure, chip::BUDGET, error_picture, painter::part};
use core::mem;
use defmt_rtt as _;
use embassy_rp::{
    dma::Channel,
    gpio::Output,
    pac::{self, dma::vals::TreqSel},
    peripherals::SPI1,
    spi::{Blocking, Spi},
    watchdog::Watchdog,
};
use embassy_time::{Delay, Duration, Instant, block_for};
use embedded_graphics::{
    pixelcolor::{Rgb565, RgbColor},
    prelude::*,
    primitives::Rectangle,
};
use embedded_hal_bus::spi::ExclusiveDevice;
use microphong::pixel::{self, Rgb565Be};
use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use zerocopy::IntoBytes;

defmt::timestamp!("{=u64:us}", Instant::now().as_micros());

/// Commands of the display standard (MIPI DCS).
mod command {
    pub(super) const SET_COLUMNS: u8 = 0x2A;
    pub(super) const SET_ROWS: u8 = 0x2B;
    pub(super) const WRITE_MEMORY: u8 = 0x2C;
}

/// Half of the peripherals' clock, the fastest that the port can do, and what the panel is made for.
pub const SPI_HZ: u32 = 62_500_000;

/// The DMA channel that sends, as its registers count it.
const CHANNEL: u16 = 0;

/// Longest time without a sign of life, of which each band is one. It is almost the longest time that the watchdog can wait.
pub const SIGN_OF_LIFE: Duration = Duration::from_secs(8);

/// The panel's wires, and what sees to it that something is shown.
pub struct St7789 {
    /// Clock and data.
    pub bus: Spi<'static, SPI1, Blocking>,
    /// The DMA channel that sends bands to the bus.
    pub channel: Channel<'static>,
    /// The band that is being sent, or was the last one to be.
    pub sent: &'static mut [Rgb565Be],
    /// Number of bytes that are being sent, and the time at which they must have been sent.
    pub sending: Option<(u32, Instant)>,
    /// Whether a band of the frame that is drawn has been sent.
    pub begun: bool,
    /// Whether the band that is sent is the last one of a frame.
    pub last: bool,
    /// Low while the panel is spoken to.
    pub select: Output<'static>,
    /// High for data, low for commands.
    pub data: Output<'static>,
    /// Low resets.
    pub reset: Output<'static>,
    /// High lights the panel.
    pub backlight: Output<'static>,
    /// The board's own light: goes on when a frame is complete, and out when another one begins to be shown.
    pub led: Output<'static>,
    /// The watchdog, which restarts the program if it hangs.
    pub watchdog: Watchdog,
    /// The transfer that the panel has not accepted, if any. Nothing else is sent then, and no frame shown.
    pub failure: Option<Failure>,
}

impl St7789 {
    /// Resets and sets up the panel, and writes `message` on it if there is one.
    pub fn start(&mut self, message: Option<&str>) {
        self.watchdog.feed(SIGN_OF_LIFE);
        let mut buffer = [0; 480];
        let Ok(device) = ExclusiveDevice::new(&mut self.bus, &mut self.select, Delay);
        let interface = SpiInterface::new(device, &mut self.data, &mut buffer);
        let builder = Builder::new(ST7789, interface)
            .display_size(BUDGET.layout.width as u16, BUDGET.height as u16)
            .invert_colors(ColorInversion::Inverted)
            .reset_pin(&mut self.reset);
        let Ok(mut panel) = builder.init(&mut Delay) else {
            defmt::error!("error: the panel's set-up was refused");
            return;
        };
        if let Some(message) = message
            && error_picture(&mut panel, Rgb565::new(20, 0, 0), Rgb565::WHITE, message).is_err()
        {
            defmt::error!("error: the panel's bus failed");
        }
        self.backlight.set_high();
    }

    /// Sends a command and its arguments; the caller holds the panel selected.
    fn command(&mut self, command: u8, arguments: &[u8]) {
        self.data.set_low();
        self.write(&[command]);
        self.data.set_high();
        self.write(arguments);
    }

    /// Returns when nothing is on its way to the panel any more.
    fn settle(&mut self) {
        let Some((bytes, deadline)) = self.sending.take() else { return };
        if wait(&self.channel, deadline) {
            // What the port still holds.
            let _ = self.bus.flush();
            if mem::take(&mut self.last) {
                self.led.set_high();
            }
        } else {
            pac::DMA.chan_abort().write(|channels| channels.set_chan_abort(1 << CHANNEL));
            // What is under way arrives first.
            while pac::DMA.chan_abort().read().chan_abort() != 0 {}
            self.failure = Some(Failure::Transfer { bytes, limit: limit(bytes) });
        }
        self.select.set_high();
    }

    /// Returns when the bytes are on the wire, so that the data pin may change.
    fn write(&mut self, bytes: &[u8]) {
        // Sending has no failure that the driver could see.
        let _ = self.bus.blocking_write(bytes);
        let _ = self.bus.flush();
    }
}

/// The display is slower than the drawing. A call of its own, so that its time can be told from the rest. False if the time is over.
#[inline(never)]
fn wait(channel: &Channel<'_>, deadline: Instant) -> bool {
    while channel.regs().ctrl_trig().read().busy() {
        if Instant::now() > deadline {
            return false;
        }
    }
    true
}

/// Time limit for sending `bytes`, in microseconds: twice the time that they take on the wire, plus 1 ms.
const fn limit(bytes: u32) -> u32 {
    2 * (8 * bytes / (SPI_HZ / 1_000_000)) + 1_000
}

impl Display for St7789 {
    type Color = Rgb565Be;

    fn size(&self) -> Size {
        Size::new(BUDGET.layout.width as u32, BUDGET.height as u32)
    }

    fn now(&self) -> Option<u64> {
        Some(Instant::now().as_micros())
    }

    fn begin(&mut self) -> Result<(), Failure> {
        self.watchdog.feed(SIGN_OF_LIFE);
        self.failure.map_or(Ok(()), Err)
    }

    #[inline(never)]
    fn send(&mut self, area: Rectangle, band: &'static mut [Rgb565Be], _: pixel::Output) -> &'static mut [Rgb565Be] {
        self.watchdog.feed(SIGN_OF_LIFE);
        self.settle();
        if self.failure.is_some() {
            return band;
        }
        self.begun = true;
        self.led.set_low();
        let range = |start: i32, length: u32| {
            let [a, b] = (start as u16).to_be_bytes();
            let [c, d] = (start as u16 + length as u16 - 1).to_be_bytes();
            [a, b, c, d]
        };
        self.select.set_low();
        self.command(command::SET_COLUMNS, &range(area.top_left.x, area.size.width));
        self.command(command::SET_ROWS, &range(area.top_left.y, area.size.height));
        self.command(command::WRITE_MEMORY, &[]);
        let pixels = part(band, area).as_bytes();
        let bytes = pixels.len() as u32;
        self.sending = Some((bytes, Instant::now() + Duration::from_micros(limit(bytes).into())));
        // SAFETY: the pixels are static and stay out of reach, in `sent`, until `settle` has seen the end of the transfer.
        let transfer = unsafe { self.channel.write(pixels, pac::SPI1.dr().as_ptr().cast::<u8>(), TreqSel::SPI1_TX, false) };
        // If dropped, it would end.
        mem::forget(transfer);
        mem::replace(&mut self.sent, band)
    }

    fn present(&mut self) {
        if mem::take(&mut self.begun) {
            self.last = true;
        } else {
            // The frame looks like the one before and is complete when that is.
            self.settle();
            self.led.set_low();
            self.led.set_high();
        }
    }

    fn finish(&mut self) -> Result<(), Failure> {
        self.settle();
        self.failure.map_or(Ok(()), Err)
    }

    fn fail(&mut self, message: &str) {
        self.settle();
        self.start(Some(message));
    }

    /// Blinks.
    fn halt(&mut self) -> ! {
        loop {
            self.watchdog.feed(SIGN_OF_LIFE);
            self.led.toggle();
            block_for(Duration::from_millis(250));
        }
    }
}
