//! The OLED of the LM3S6965 evaluation board: an SSD0323 on the first serial port, 128x64 pixels of 4 bits.

use crate::{Display, Failure, budget::LM3S6965EVB, error_picture, semihosting};
use core::convert::Infallible;
use embedded_graphics::{
    pixelcolor::{Gray4, GrayColor},
    prelude::*,
    primitives::Rectangle,
};
use microphong::pixel::{LightGray, Output};

const WIDTH: usize = LM3S6965EVB.layout.width;
const HEIGHT: usize = LM3S6965EVB.height;

/// Registers, by address; names as in the chip's data sheet.
mod register {
    /// Clock gates of the serial ports (bit 4: SSI0).
    pub(super) const RCGC1: usize = 0x400F_E104;
    /// Clock gates of the ports (bits 0, 2, 3: A, C, D).
    pub(super) const RCGC2: usize = 0x400F_E108;
    pub(super) const GPIO_A: usize = 0x4000_4000;
    pub(super) const GPIO_C: usize = 0x4000_6000;
    pub(super) const GPIO_D: usize = 0x4000_7000;
    pub(super) const DIRECTION: usize = 0x400;
    pub(super) const ALTERNATE: usize = 0x420;
    pub(super) const DIGITAL: usize = 0x51C;
    pub(super) const SSI0_CR0: usize = 0x4000_8000;
    pub(super) const SSI0_CR1: usize = 0x4000_8004;
    pub(super) const SSI0_DR: usize = 0x4000_8008;
    pub(super) const SSI0_SR: usize = 0x4000_800C;
    pub(super) const SSI0_CPSR: usize = 0x4000_8010;

    pub(super) fn read(address: usize) -> u32 {
        // SAFETY: only the addresses above are passed; they are registers of this chip.
        unsafe { (address as *const u32).read_volatile() }
    }

    pub(super) fn write(address: usize, value: u32) {
        // SAFETY: as for `read`; nothing else in the program uses these peripherals.
        unsafe { (address as *mut u32).write_volatile(value) }
    }

    pub(super) fn set(address: usize, bits: u32) {
        write(address, read(address) | bits);
    }

    /// A port's pins have their mask in the address, so that one write leaves the others alone.
    pub(super) const fn pins(port: usize, mask: usize) -> usize {
        port + (mask << 2)
    }
}

use register::*;

/// Status bits of the serial port.
const TRANSMIT_NOT_FULL: u32 = 1 << 1;
const RECEIVE_NOT_EMPTY: u32 = 1 << 2;
const BUSY: u32 = 1 << 4;

/// Pin of port C that tells data from commands.
const DATA: usize = 1 << 7;
/// Pin of port D that selects the SD card on the display's bus. High means not selected.
const CARD: usize = 1 << 0;

/// The display and a copy of its memory.
#[derive(Debug)]
pub struct Ssd0323 {
    /// Two pixels a byte, the left one in the high half.
    picture: &'static mut [u8; Self::BYTES],
}

impl Ssd0323 {
    /// Bytes of a picture.
    pub const BYTES: usize = WIDTH * HEIGHT / 2;

    /// Sets up pins, serial port and controller.
    pub fn start(picture: &'static mut [u8; Self::BYTES]) -> Self {
        set(RCGC1, 1 << 4);
        set(RCGC2, 1 << 3 | 1 << 2 | 1 << 0);
        // A clock needs some cycles before its peripheral answers.
        read(RCGC2);
        let serial = 1 << 5 | 1 << 3 | 1 << 2;
        set(GPIO_A + ALTERNATE, serial);
        set(GPIO_A + DIGITAL, serial);
        for (port, pin) in [(GPIO_C, DATA), (GPIO_D, CARD)] {
            set(port + DIRECTION, pin as u32);
            set(port + DIGITAL, pin as u32);
        }
        write(pins(GPIO_D, CARD), CARD as u32);
        write(SSI0_CR1, 0);
        write(SSI0_CPSR, 2);
        // Eight bits, clock idle high, sampled on its second edge.
        write(SSI0_CR0, 0xC7);
        write(SSI0_CR1, 1 << 1);

        let mut display = Self { picture };
        // Off; nibbles and rows in the order of this board's glass; no offset; 64 rows; normal; full contrast; on.
        display.commands(&[0xAE, 0xA0, 0x50, 0xA1, 0, 0xA2, 0, 0xA8, 63, 0xA4, 0x81, 0x7F, 0xAF]);
        display
    }

    fn byte(byte: u8) {
        while read(SSI0_SR) & TRANSMIT_NOT_FULL == 0 {}
        write(SSI0_DR, byte.into());
        // Nothing comes back, but a full receive queue would stop the port.
        while read(SSI0_SR) & RECEIVE_NOT_EMPTY == 0 {}
        read(SSI0_DR);
    }

    /// The pin must not change before the last byte is out.
    fn select(data: bool) {
        while read(SSI0_SR) & BUSY != 0 {}
        write(pins(GPIO_C, DATA), if data { DATA as u32 } else { 0 });
    }

    fn commands(&mut self, bytes: &[u8]) {
        Self::select(false);
        bytes.iter().copied().for_each(Self::byte);
    }

    /// Sends whole rows of the picture to the controller.
    fn flush(&mut self, top: usize, rows: usize) {
        let last = (top + rows - 1) as u8;
        self.commands(&[0x15, 0, (WIDTH / 2 - 1) as u8, 0x75, top as u8, last]);
        Self::select(true);
        self.picture[top * WIDTH / 2..][..rows * WIDTH / 2].iter().copied().for_each(Self::byte);
    }

    fn set_pixel(&mut self, x: usize, y: usize, grey: Gray4) {
        let pair = &mut self.picture[(y * WIDTH + x) / 2];
        *pair = if x.is_multiple_of(2) { *pair & 0x0F | grey.luma() << 4 } else { *pair & 0xF0 | grey.luma() };
    }
}

impl OriginDimensions for Ssd0323 {
    fn size(&self) -> Size {
        Size::new(WIDTH as u32, HEIGHT as u32)
    }
}

impl DrawTarget for Ssd0323 {
    type Color = Gray4;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Gray4>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let area = self.bounding_box();
        for Pixel(point, grey) in pixels {
            if area.contains(point) {
                self.set_pixel(point.x as usize, point.y as usize, grey);
            }
        }
        Ok(())
    }

    /// Whole rows are packed two pixels at a time; other areas go the slow way.
    fn fill_contiguous<I: IntoIterator<Item = Gray4>>(&mut self, area: &Rectangle, colours: I) -> Result<(), Infallible> {
        let rows = Rectangle::new(Point::new(0, area.top_left.y), Size::new(WIDTH as u32, area.size.height));
        if *area != rows || rows.intersection(&self.bounding_box()) != rows {
            return self.draw_iter(area.points().zip(colours).map(|(point, grey)| Pixel(point, grey)));
        }
        let start = area.top_left.y as usize * WIDTH / 2;
        let mut colours = colours.into_iter();
        for pair in &mut self.picture[start..][..rows.size.height as usize * WIDTH / 2] {
            let (Some(left), Some(right)) = (colours.next(), colours.next()) else {
                break;
            };
            *pair = left.luma() << 4 | right.luma();
        }
        Ok(())
    }
}

impl Display for Ssd0323 {
    type Color = LightGray<4>;

    fn size(&self) -> Size {
        OriginDimensions::size(self)
    }

    fn send(&mut self, area: Rectangle, band: &'static mut [LightGray<4>], output: Output) -> &'static mut [LightGray<4>] {
        let Ok(()) = self.fill_contiguous(&area, output.pixels(band, area));
        self.flush(area.top_left.y as usize, area.size.height as usize);
        band
    }

    fn finish(&mut self) -> Result<(), Failure> {
        semihosting::wait_for_host();
        Ok(())
    }

    fn end(&mut self) {
        semihosting::exit(0);
    }

    fn fail(&mut self, message: &str) {
        let Ok(()) = error_picture(self, Gray4::WHITE, Gray4::BLACK, message);
        self.flush(0, HEIGHT);
    }

    fn halt(&mut self) -> ! {
        semihosting::wait_for_host();
        semihosting::exit(1)
    }
}
