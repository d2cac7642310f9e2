//! The bunny on an ST7789 panel, 240x240, by a Raspberry Pi Pico 2: SCK at GP10, MOSI 11, CS 9, DC 8, RST 12, BL 13.
#![no_std]
#![no_main]

mod scene;

use defmt_rtt as _;
use embassy_rp::{
    gpio::{Level, Output},
    spi::{Config, Spi},
};
use embassy_time::{Delay, Instant};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_hal_bus::spi::ExclusiveDevice;
use microphong::Stream;
use mipidsi::{Builder, interface::SpiInterface, models::ST7789, options::ColorInversion};
use panic_probe as _;
use scene::LAYOUT;

defmt::timestamp!("{=u64:us}", Instant::now().as_micros());

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut MEMORY: [u64; LAYOUT.words::<Rgb565>()] = [0; LAYOUT.words::<Rgb565>()];
    static mut BAND: [Rgb565; LAYOUT.band()] = [Rgb565::BLACK; LAYOUT.band()];
    static mut BUFFER: [u8; 480] = [0; 480];

    let pins = embassy_rp::init(Default::default());
    let (data, select) = (Output::new(pins.PIN_8, Level::High), Output::new(pins.PIN_9, Level::High));
    let (reset, _light) = (Output::new(pins.PIN_12, Level::High), Output::new(pins.PIN_13, Level::High));
    let mut config = Config::default();
    config.frequency = 62_500_000;
    let bus = Spi::new_blocking_txonly(pins.SPI1, pins.PIN_10, pins.PIN_11, config);
    let Ok(bus) = ExclusiveDevice::new(bus, select, Delay);
    let builder = Builder::new(ST7789, SpiInterface::new(bus, data, BUFFER)).display_size(240, 240).reset_pin(reset);
    let display = builder.invert_colors(ColorInversion::Inverted).init(&mut Delay);
    let mut display = defmt::expect!(display.ok(), "the display's bus failed");

    let stream = defmt::expect!(Stream::parse_included(scene::MESH), "the mesh is not from include_stream!");
    let mut renderer = defmt::expect!(scene::renderer(stream, MEMORY), "the mesh cannot be drawn");
    let mut rate = None;
    for number in (0..u32::from(stream.header.frames)).cycle() {
        let start = Instant::now();
        let picture = defmt::expect!(scene::picture(&mut renderer, BAND, number, rate), "the band is too short");
        let stats = defmt::expect!(picture.draw(&mut display).ok(), "the display's bus failed");
        rate = 1_000_000_u64.checked_div(start.elapsed().as_micros());
        defmt::info!("frame {}: {} triangles, {} frames a second", number, stats.drawn, rate);
    }
    defmt::panic!("the mesh has no frames")
}
