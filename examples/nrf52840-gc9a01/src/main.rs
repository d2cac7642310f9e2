//! A watch on a round GC9A01 panel, 240x240, by an nRF52840: SCK at P1.15, MOSI P1.13, CS P1.12, DC P1.11, RST P1.10. The orientation
//! comes from a sensor BNO055: SDA at P0.26, SCL P0.27.
#![no_std]
#![no_main]

mod scene;

use defmt_rtt as _;
use embassy_nrf::gpio::{Level::High, Output, OutputDrive::Standard};
use embassy_nrf::{bind_interrupts, peripherals, spim, twim};
use embassy_time::{Delay, Duration, Instant, block_for};
use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use embedded_hal_bus::spi::ExclusiveDevice;
use microphong::{Pose, Stream, format::Rotation};
use mipidsi::options::{ColorInversion, ColorOrder};
use mipidsi::{Builder, interface::SpiInterface, models::GC9A01};
use panic_probe as _;
use scene::LAYOUT;

bind_interrupts!(struct Interrupts {
    SPIM3 => spim::InterruptHandler<peripherals::SPI3>;
    TWISPI0 => twim::InterruptHandler<peripherals::TWISPI0>;
});
/// The sensor's address.
const SENSOR: u8 = 0x28;

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut MEMORY: [u64; LAYOUT.words::<Rgb565>()] = [0; LAYOUT.words::<Rgb565>()];
    static mut BAND: [Rgb565; LAYOUT.band()] = [Rgb565::BLACK; LAYOUT.band()];
    static mut BUFFER: [u8; 480] = [0; 480];
    static mut COMMAND: [u8; 2] = [0; 2];

    let pins = embassy_nrf::init(Default::default());
    let data = Output::new(pins.P1_11, High, Standard);
    let (select, reset) = (Output::new(pins.P1_12, High, Standard), Output::new(pins.P1_10, High, Standard));
    let mut config = spim::Config::default();
    config.frequency = spim::Frequency::M32;
    let bus = spim::Spim::new_txonly(pins.SPI3, Interrupts, pins.P1_15, pins.P1_13, config);
    let Ok(bus) = ExclusiveDevice::new(bus, select, Delay);
    let builder = Builder::new(GC9A01, SpiInterface::new(bus, data, BUFFER)).color_order(ColorOrder::Bgr).reset_pin(reset);
    let display = builder.invert_colors(ColorInversion::Inverted).init(&mut Delay);
    let mut display = defmt::expect!(display.ok(), "the display's bus failed");
    let mut sensor = twim::Twim::new(pins.TWISPI0, Interrupts, pins.P0_26, pins.P0_27, Default::default(), COMMAND);
    // The sensor needs this time to start. Its mode 8 makes orientations of gyroscope and accelerometer.
    block_for(Duration::from_millis(650));
    defmt::expect!(sensor.blocking_write(SENSOR, &[0x3d, 0x08]), "the sensor does not answer");
    let stream = defmt::expect!(Stream::parse_included(scene::MESH), "the mesh is not from include_stream!");
    let mut renderer = defmt::expect!(scene::renderer(stream, MEMORY), "the mesh cannot be drawn");
    loop {
        // A quaternion w, x, y, z, in 16 bits each. Without the last six of them, noise moves nothing: a step is half a degree.
        let mut bytes = [0; 8];
        defmt::expect!(sensor.blocking_write_read(SENSOR, &[0x20], &mut bytes), "the sensor does not answer");
        let component = |k| i32::from(i16::from_le_bytes([bytes[k], bytes[k + 1]]) & !63);
        let quaternion = [0, 2, 4, 6].map(|k| Rotation::from_bits(component(k) << 16));
        // All four are zero until the sensor has measured.
        let Ok(tilt) = Pose::from_quaternion(quaternion) else { continue };
        // It is nine minutes past ten when the program starts.
        let seconds = (10 * 60 + 9) * 60 + Instant::now().as_secs() as u32;
        defmt::expect!(scene::set(&mut renderer, &tilt, seconds), "the stream has no hands");
        let picture = defmt::expect!(scene::picture(&mut renderer, BAND, seconds), "the band is too short");
        let stats = defmt::expect!(picture.draw(&mut display).ok(), "the display's bus failed");
        defmt::info!("{} triangles", stats.drawn);
    }
}
