//! Raspberry Pi Pico (RP2040) with the common 1.3 inch ST7789 panel plugged on.
#![no_std]
#![no_main]

use microphong_firmware::pico::{Memory, SecondStack, start};

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut MEMORY: Memory = Memory::NEW;
    static mut SECOND_STACK: SecondStack = SecondStack::NEW;
    start(MEMORY, SECOND_STACK)
}
