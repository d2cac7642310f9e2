//! A display that takes pixels of any format and shows nothing, like the bus of a real one.

use crate::{Display, Failure, budget::FRAMEBUFFER, framebuffer::LENGTH, painter::part, semihosting};
use core::hint::black_box;
use embedded_graphics::{prelude::*, primitives::Rectangle};
use microphong::pixel::{Output, Pixel};

/// Makes what a display takes of the pixels of an area.
pub type Pass<C, T> = fn(Output, &[C], Rectangle, &mut [T]);

/// A display for pictures that are drawn in pixels `C`, and of which a pass makes units `T`: pixels, or bytes of several pixels.
#[derive(Debug)]
pub struct Register<C, T: 'static> {
    /// Room for the units of a band.
    pub room: &'static mut [T; LENGTH],
    /// The pass.
    pub pass: Pass<C, T>,
}

impl<C: Pixel, T> Display for Register<C, T> {
    type Color = C;

    fn size(&self) -> Size {
        Size::new(FRAMEBUFFER.layout.width as u32, FRAMEBUFFER.height as u32)
    }

    fn send(&mut self, area: Rectangle, band: &'static mut [C], output: Output) -> &'static mut [C] {
        (self.pass)(output, black_box(part(band, area)), area, self.room);
        black_box(&mut *self.room);
        band
    }

    fn finish(&mut self) -> Result<(), Failure> {
        semihosting::wait_for_host();
        Ok(())
    }

    fn end(&mut self) {
        semihosting::exit(0);
    }

    fn fail(&mut self, _: &str) {}

    fn halt(&mut self) -> ! {
        semihosting::wait_for_host();
        semihosting::exit(1)
    }
}
