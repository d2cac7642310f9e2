//! Draws the teapot with an STM32F411 on an ILI9341 panel, 320x240: SCK at PA5, MOSI at PA7, CS at PA4, DC at PA3, RST at PA2.
#![no_std]
#![no_main]

mod scene;

use cortex_m::peripheral::DWT;
use defmt_rtt as _;
use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_hal_bus::spi::ExclusiveDevice;
use microphong::Stream;
use mipidsi::{
    Builder,
    interface::SpiInterface,
    models::ILI9341Rgb565,
    options::{ColorOrder, Orientation, Rotation},
};
use panic_probe as _;
use scene::LAYOUT;
use stm32f4xx_hal::{hal::spi::MODE_0, pac, prelude::*, rcc::Config, spi::Spi};

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut MEMORY: [u64; LAYOUT.words::<Rgb565>()] = [0; LAYOUT.words::<Rgb565>()];
    static mut BAND: [Rgb565; LAYOUT.band()] = [Rgb565::BLACK; LAYOUT.band()];
    static mut BUFFER: [u8; 640] = [0; 640];

    let mut core = defmt::unwrap!(pac::CorePeripherals::take());
    let device = defmt::unwrap!(pac::Peripherals::take());
    let mut rcc = device.RCC.freeze(Config::hsi().sysclk(96.MHz()));
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    let mut delay = core.SYST.delay(&rcc.clocks);
    let pins = device.GPIOA.split(&mut rcc);

    let bus = Spi::new(device.SPI1, (Some(pins.pa5), pac::SPI1::NoMiso, Some(pins.pa7)), MODE_0, 24.MHz(), &mut rcc);
    let bus = defmt::expect!(ExclusiveDevice::new_no_delay(bus, pins.pa4.into_push_pull_output()).ok(), "no chip select");
    let display = Builder::new(ILI9341Rgb565, SpiInterface::new(bus, pins.pa3.into_push_pull_output(), BUFFER))
        .reset_pin(pins.pa2.into_push_pull_output())
        .color_order(ColorOrder::Bgr)
        .orientation(Orientation::new().rotate(Rotation::Deg90).flip_horizontal())
        .init(&mut delay);
    let mut display = defmt::expect!(display.ok(), "the display's bus failed");

    let stream = defmt::expect!(Stream::parse_included(scene::MESH), "the mesh is not from include_stream!");
    let mut renderer = defmt::expect!(scene::renderer(stream, MEMORY), "the mesh cannot be drawn");
    for number in (0..u32::from(stream.header.frames)).cycle() {
        let start = DWT::cycle_count();
        let picture = defmt::expect!(scene::picture(&mut renderer, BAND, number), "the band is too short");
        let stats = defmt::expect!(picture.draw(&mut display).ok(), "the display's bus failed");
        let cycles = DWT::cycle_count().wrapping_sub(start);
        defmt::info!("frame {}: {} triangles, {} ms", number, stats.drawn, cycles / (rcc.clocks.sysclk().raw() / 1000));
    }
    defmt::panic!("the mesh has no frames")
}
