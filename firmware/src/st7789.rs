//! An ST7789 panel of 240x240 pixels on the RP2040's second serial port, fed by DMA.

use crate::{Display, Failure, budget::PICO, error_picture};
use core::{
    future::Future,
    pin::{Pin, pin},
    task::{Context, Waker},
};
use defmt_rtt as _;
use embassy_rp::{
    gpio::Output,
    peripherals::SPI1,
    spi::{Async, Spi},
    watchdog::Watchdog,
};
use embassy_time::{Delay, Duration, Instant, block_for};
use embedded_graphics::{
    pixelcolor::{Rgb565, RgbColor},
    prelude::*,
    primitives::Rectangle,
};
use embedded_hal_bus::spi::ExclusiveDevice;
use microphong::pixel::Rgb565Be;
use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use zerocopy::IntoBytes;

defmt::timestamp!("{=u64:us}", Instant::now().as_micros());

/// Commands of the display standard (MIPI DCS).
mod command {
    pub(super) const SET_COLUMNS: u8 = 0x2A;
    pub(super) const SET_ROWS: u8 = 0x2B;
    pub(super) const WRITE_MEMORY: u8 = 0x2C;
}

/// Half of the peripherals' clock, the fastest that the port can do.
pub const SPI_HZ: u32 = 62_500_000;

/// How long the program may go on without a sign of life, of which each band is one: nearly the longest that the watchdog can wait.
pub const SIGN_OF_LIFE: Duration = Duration::from_secs(8);

/// The panel's wires, and what sees to it that something is shown.
pub struct St7789 {
    /// Clock and data.
    pub bus: Spi<'static, SPI1, Async>,
    /// Low while the panel is spoken to.
    pub select: Output<'static>,
    /// High for data, low for commands.
    pub data: Output<'static>,
    /// Low resets.
    pub reset: Output<'static>,
    /// High lights the panel.
    pub backlight: Output<'static>,
    /// The board's own light: goes out when a frame begins to be drawn, and on when one is complete.
    pub led: Output<'static>,
    /// Starts the program anew that hangs.
    pub watchdog: Watchdog,
    /// What the panel has not taken, if there is anything: then nothing else is sent, and no frame shown.
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
            .display_size(PICO.layout.width as u16, PICO.height as u16)
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

    /// Returns when the bytes are on the wire, so that the data pin may change.
    fn write(&mut self, bytes: &[u8]) {
        // Sending has no failure that the driver could see.
        let _ = self.bus.blocking_write(bytes);
        let _ = self.bus.flush();
    }
}

/// The display is slower than the drawing. A call of its own, so that its time can be told from the rest. False if the time is over.
#[inline(never)]
fn wait(mut transfer: Pin<&mut impl Future>, deadline: Instant) -> bool {
    let mut context = Context::from_waker(Waker::noop());
    while transfer.as_mut().poll(&mut context).is_pending() {
        if Instant::now() > deadline {
            return false;
        }
    }
    true
}

/// Microseconds in which so many bytes must have been sent: twice as long as they are on the wire, and 1 ms.
const fn limit(bytes: u32) -> u32 {
    2 * (8 * bytes / (SPI_HZ / 1_000_000)) + 1_000
}

impl Display for St7789 {
    type Color = Rgb565Be;

    fn size(&self) -> Size {
        Size::new(PICO.layout.width as u32, PICO.height as u32)
    }

    fn begin(&mut self) {
        self.watchdog.feed(SIGN_OF_LIFE);
        self.led.set_low();
    }

    #[inline(never)]
    fn send<R>(&mut self, area: Rectangle, pixels: &[Rgb565Be], meanwhile: impl FnOnce() -> R) -> R {
        self.watchdog.feed(SIGN_OF_LIFE);
        if self.failure.is_some() {
            return meanwhile();
        }
        let range = |start: i32, length: u32| {
            let [a, b] = (start as u16).to_be_bytes();
            let [c, d] = (start as u16 + length as u16 - 1).to_be_bytes();
            [a, b, c, d]
        };
        self.select.set_low();
        self.command(command::SET_COLUMNS, &range(area.top_left.x, area.size.width));
        self.command(command::SET_ROWS, &range(area.top_left.y, area.size.height));
        self.command(command::WRITE_MEMORY, &[]);
        let bytes = size_of_val(pixels) as u32;
        let limit = limit(bytes);
        // Where the block ends, DMA is stopped that has not ended.
        let result = {
            let mut transfer = pin!(self.bus.write(pixels.as_bytes()));
            // The first poll starts the DMA; then the processor is free.
            let started = transfer.as_mut().poll(&mut Context::from_waker(Waker::noop()));
            let deadline = Instant::now() + Duration::from_micros(limit.into());
            let result = meanwhile();
            if started.is_pending() && !wait(transfer, deadline) {
                self.failure = Some(Failure::Transfer { bytes, limit });
            }
            result
        };
        self.select.set_high();
        result
    }

    fn present(&mut self) -> Result<(), Failure> {
        match self.failure {
            Some(failure) => Err(failure),
            None => {
                self.led.set_high();
                Ok(())
            }
        }
    }

    fn fail(&mut self, message: &str) {
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
