//! TI LM3S6965 evaluation board (Cortex-M3): an OLED of 128x64 pixels, 16 greys.
#![no_std]
#![no_main]

use embedded_graphics::pixelcolor::{Gray4, GrayColor};
use microphong::Workspace;
use microphong_firmware::{budget::LM3S6965EVB as BUDGET, run, ssd0323::Ssd0323};

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut PICTURE: [u8; Ssd0323::BYTES] = [0; Ssd0323::BYTES];
    static mut BANDS: [[Gray4; BUDGET.band()]; 2] = [[Gray4::BLACK; BUDGET.band()]; 2];
    static mut WORKSPACE: Workspace<
        Gray4,
        { BUDGET.vertices },
        { BUDGET.triangles },
        { BUDGET.band() },
        { BUDGET.materials },
        { BUDGET.legs },
    > = Workspace::new(Gray4::BLACK);

    let [front, back] = BANDS;
    run(&mut Ssd0323::start(PICTURE), WORKSPACE.memory(), [front, back])
}
