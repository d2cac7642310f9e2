//! A gauge of the chip's temperature on a round GC9A01 panel, 240x240, by an ESP32-C3: SCK at GPIO6, MOSI 7, CS 10, DC 2, BL 3.
#![no_std]
#![no_main]

mod scene;

use defmt_rtt as _;
use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_hal_bus::spi::ExclusiveDevice;
use esp_backtrace as _;
use esp_hal::gpio::{Level, Output, OutputConfig};
use esp_hal::spi::master::{Config, Spi};
use esp_hal::{clock::CpuClock, delay::Delay, time::Rate, tsens::TemperatureSensor};
use microphong::{Picture, Stream};
use mipidsi::options::{ColorInversion, ColorOrder};
use mipidsi::{Builder, interface::SpiInterface, models::GC9A01};
use scene::LAYOUT;
use static_cell::ConstStaticCell;

esp_bootloader_esp_idf::esp_app_desc!();

static MEMORY: ConstStaticCell<[u64; LAYOUT.words::<Rgb565>()]> = ConstStaticCell::new([0; LAYOUT.words::<Rgb565>()]);
static BAND: ConstStaticCell<[Rgb565; LAYOUT.band()]> = ConstStaticCell::new([Rgb565::BLACK; LAYOUT.band()]);
static BUFFER: ConstStaticCell<[u8; 480]> = ConstStaticCell::new([0; 480]);

#[esp_hal::main]
fn main() -> ! {
    let pins = esp_hal::init(esp_hal::Config::default().with_cpu_clock(CpuClock::max()));
    let data = Output::new(pins.GPIO2, Level::High, OutputConfig::default());
    let select = Output::new(pins.GPIO10, Level::High, OutputConfig::default());
    let _light = Output::new(pins.GPIO3, Level::High, OutputConfig::default());
    let bus = defmt::unwrap!(Spi::new(pins.SPI2, Config::default().with_frequency(Rate::from_mhz(40))));
    let Ok(bus) = ExclusiveDevice::new_no_delay(bus.with_sck(pins.GPIO6).with_mosi(pins.GPIO7), select);
    let builder = Builder::new(GC9A01, SpiInterface::new(bus, data, BUFFER.take())).color_order(ColorOrder::Bgr);
    let display = builder.invert_colors(ColorInversion::Inverted).init(&mut Delay::new());
    let mut display = defmt::expect!(display.ok(), "the display's bus failed");

    let sensor = defmt::unwrap!(TemperatureSensor::new(pins.TSENS, Default::default()).ok());
    let stream = defmt::expect!(Stream::parse_included(scene::MESH), "the mesh is not from include_stream!");
    let mut renderer = defmt::expect!(scene::renderer(stream, MEMORY.take()), "the mesh cannot be drawn");
    let (band, mut celsius) = (BAND.take(), 20.0);
    loop {
        // The sensor tells steps of half a degree, which the needle follows slowly.
        celsius += (sensor.get_temperature().to_celsius() - celsius) / 8.0;
        defmt::expect!(scene::set(renderer.scene(), celsius), "the stream has no needle");
        let picture = defmt::expect!(Picture::of_scene(&mut renderer, band), "the band is too short");
        let stats = defmt::expect!(picture.draw(&mut display).ok(), "the display's bus failed");
        defmt::info!("{} degrees Celsius: {} triangles", celsius, stats.drawn);
    }
}
