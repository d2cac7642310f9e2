//! The program of a Raspberry Pi Pico or Pico 2 with the common 1.3 inch ST7789 panel plugged on.

#[cfg(feature = "one-core")]
use crate::OneCore;
#[cfg(not(feature = "one-core"))]
use crate::second_core::{STACK, SecondCore, TwoCores};
use crate::{
    Failure,
    chip::{BUDGET, clocks},
    run,
    shaders::every,
    st7789::{SIGN_OF_LIFE, SPI_HZ, St7789},
    stop,
};
#[cfg(not(feature = "one-core"))]
use embassy_rp::multicore::Stack;
use embassy_rp::{
    bind_interrupts,
    dma::{self, Channel},
    gpio::{Level, Output},
    peripherals::DMA_CH0,
    spi::{self, Spi},
    watchdog::{ResetReason, Watchdog},
};
use microphong::pixel::Rgb565Be;

bind_interrupts!(struct Interrupts {
    DMA_IRQ_0 => dma::InterruptHandler<DMA_CH0>;
});

/// Memory of the program.
pub struct Memory {
    /// Two processors draw one each, and one is sent.
    bands: [[Rgb565Be; BUDGET.layout.band()]; 3],
    renderer: [u64; BUDGET.layout.words::<Rgb565Be>()],
}

impl Memory {
    /// Nothing but zeros, which take no flash.
    pub const NEW: Self = Self { bands: [[Rgb565Be::BLACK; BUDGET.layout.band()]; 3], renderer: [0; BUDGET.layout.words::<Rgb565Be>()] };
}

/// Stack of the second processor, if it draws.
pub struct SecondStack(#[cfg(not(feature = "one-core"))] Stack<STACK>);

impl SecondStack {
    /// An empty stack.
    pub const NEW: Self = Self(
        #[cfg(not(feature = "one-core"))]
        Stack::new(),
    );
}

/// Draws the stream in flash. Call it first of all, and once.
pub fn start(memory: &'static mut Memory, second_stack: &'static mut SecondStack) -> ! {
    #[cfg(feature = "one-core")]
    let SecondStack() = second_stack;
    let [sent, bands @ ..] = &mut memory.bands;
    let pins = embassy_rp::init(clocks());
    let mut config = spi::Config::default();
    config.frequency = SPI_HZ;
    let mut display = St7789 {
        bus: Spi::new_blocking_txonly(pins.SPI1, pins.PIN_10, pins.PIN_11, config),
        channel: Channel::new(pins.DMA_CH0, Interrupts),
        sent,
        sending: None,
        begun: false,
        last: false,
        select: Output::new(pins.PIN_9, Level::High),
        data: Output::new(pins.PIN_8, Level::Low),
        reset: Output::new(pins.PIN_12, Level::High),
        backlight: Output::new(pins.PIN_13, Level::Low),
        led: Output::new(pins.PIN_25, Level::Low),
        watchdog: Watchdog::new(pins.WATCHDOG),
        failure: None,
    };
    let hung = display.watchdog.reset_reason() == Some(ResetReason::TimedOut);
    // Who looks at the program by a debug probe may take their time.
    display.watchdog.pause_on_debug(true);
    display.watchdog.start(SIGN_OF_LIFE);
    if hung {
        stop(&mut display, Failure::Hang);
    }
    display.start(None);
    #[cfg(not(feature = "one-core"))]
    let mut painter = TwoCores {
        bands: bands.each_mut().map(|band| &mut band[..]),
        second: SecondCore::start(pins.CORE1, &mut second_stack.0),
        share: 1 << 15,
        earlier: 1 << 15,
    };
    #[cfg(feature = "one-core")]
    let mut painter = OneCore { band: &mut bands[0] };
    run(&mut display, &mut painter, &BUDGET.layout, &mut memory.renderer, every())
}
