//! TI LM3S6965 evaluation board (Cortex-M3): an OLED of 128x64 pixels, 16 greys.
#![no_std]
#![no_main]

use microphong::{Layout, Shader, pixel::LightGray};
use microphong_firmware::{OneCore, budget::LM3S6965EVB, run, ssd0323::Ssd0323};

const LAYOUT: Layout = LM3S6965EVB.layout;

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut PICTURE: [u8; Ssd0323::BYTES] = [0; Ssd0323::BYTES];
    static mut BAND: [LightGray<4>; LAYOUT.band()] = [LightGray::BLACK; LAYOUT.band()];
    static mut MEMORY: [u64; LAYOUT.words::<LightGray<4>>()] = [0; LAYOUT.words::<LightGray<4>>()];

    run(&mut Ssd0323::start(PICTURE), &mut OneCore { band: BAND }, &LAYOUT, MEMORY, &Shader::ALL)
}
