//! A teapot in black and white on an SSD1306 OLED, 128x64, by a Raspberry Pi Pico: SDA at GP4, SCL at GP5.
#![no_std]
#![no_main]

mod scene;

use defmt_rtt as _;
use embassy_rp::{
    i2c::{Config, I2c},
    watchdog::{ResetReason, Watchdog},
};
use embassy_time::{Duration, Instant};
use embedded_graphics::prelude::*;
use microphong::{Stream, pixel::LightGray};
use panic_probe as _;
use scene::LAYOUT;
use ssd1306::{I2CDisplayInterface, Ssd1306, prelude::*};

defmt::timestamp!("{=u64:us}", Instant::now().as_micros());

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut MEMORY: [u64; LAYOUT.words::<LightGray<1>>()] = [0; LAYOUT.words::<LightGray<1>>()];
    static mut BAND: [LightGray<1>; LAYOUT.band()] = [LightGray::BLACK; LAYOUT.band()];

    let pins = embassy_rp::init(Default::default());
    // A display that holds a line of the bus low would stop the program for ever.
    let mut watchdog = Watchdog::new(pins.WATCHDOG);
    if watchdog.reset_reason() == Some(ResetReason::TimedOut) {
        defmt::error!("the display's bus hung, and the watchdog started the program anew");
    }
    watchdog.pause_on_debug(true);
    watchdog.start(Duration::from_secs(2));

    let mut config = Config::default();
    config.frequency = 400_000;
    let bus = I2CDisplayInterface::new(I2c::new_blocking(pins.I2C0, pins.PIN_5, pins.PIN_4, config));
    let mut display = Ssd1306::new(bus, DisplaySize128x64, DisplayRotation::Rotate0).into_buffered_graphics_mode();
    defmt::expect!(display.init().ok(), "no display answers at address 0x3C; look at its wires");

    let stream = defmt::expect!(Stream::parse_included(scene::MESH), "the mesh is not from include_stream!");
    let mut renderer = defmt::expect!(scene::renderer(stream, MEMORY), "the mesh cannot be drawn");
    for number in (0..u32::from(stream.header.frames)).cycle() {
        let picture = defmt::expect!(scene::picture(&mut renderer, BAND, number), "the band is too short");
        let drawn = picture.draw(&mut display).and_then(|stats| display.flush().map(|()| stats));
        let stats = defmt::expect!(drawn.ok(), "the display answers no more; look at its wires");
        defmt::info!("frame {}: {} triangles", number, stats.drawn);
        watchdog.feed(Duration::from_secs(2));
    }
    defmt::panic!("the mesh has no frames")
}
