//! A display that is nothing but memory: 320x240 RGB565, which the host reads while the program waits.

use crate::{Display, Failure, budget, error_picture, painter::part, semihosting};
use core::convert::Infallible;
use embedded_graphics::{
    pixelcolor::{IntoStorage, Rgb565, RgbColor},
    prelude::*,
    primitives::Rectangle,
};
use microphong::{Layout, pixel::Output};

/// The renderer's memory.
pub const LAYOUT: Layout = budget::FRAMEBUFFER.layout.antialias(cfg!(feature = "antialias"));
/// Pixels of the frame buffer.
pub const LENGTH: usize = budget::FRAMEBUFFER.layout.width * budget::FRAMEBUFFER.height;

/// Rows from the top, two bytes a pixel, little-endian.
#[derive(Debug)]
pub struct Framebuffer(&'static mut [u16; LENGTH]);

impl Framebuffer {
    /// A display in `memory`.
    pub fn new(memory: &'static mut [u16; LENGTH]) -> Self {
        Self(memory)
    }

    /// Copies pixels into the rows of `area`, which must lie inside.
    fn blit(&mut self, area: Rectangle, pixels: &[Rgb565]) {
        let (left, top) = (area.top_left.x as usize, area.top_left.y as usize);
        let width = area.size.width as usize;
        let rows = self.0.chunks_exact_mut(budget::FRAMEBUFFER.layout.width).skip(top).map(|row| &mut row[left..left + width]);
        for (row, source) in rows.zip(pixels.chunks_exact(width)) {
            for (to, from) in row.iter_mut().zip(source) {
                *to = from.into_storage();
            }
        }
    }
}

impl OriginDimensions for Framebuffer {
    fn size(&self) -> Size {
        Size::new(budget::FRAMEBUFFER.layout.width as u32, budget::FRAMEBUFFER.height as u32)
    }
}

impl DrawTarget for Framebuffer {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let area = self.bounding_box();
        for Pixel(point, colour) in pixels {
            if area.contains(point) {
                self.0[point.y as usize * budget::FRAMEBUFFER.layout.width + point.x as usize] = colour.into_storage();
            }
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, colour: Rgb565) -> Result<(), Infallible> {
        let area = area.intersection(&self.bounding_box());
        let row = [colour; budget::FRAMEBUFFER.layout.width];
        for y in area.rows() {
            let line = Rectangle::new(Point::new(area.top_left.x, y), Size::new(area.size.width, 1));
            self.blit(line, &row[..area.size.width as usize]);
        }
        Ok(())
    }
}

impl Display for Framebuffer {
    type Color = Rgb565;

    fn size(&self) -> Size {
        OriginDimensions::size(self)
    }

    fn send(&mut self, area: Rectangle, band: &'static mut [Rgb565], _: Output) -> &'static mut [Rgb565] {
        self.blit(area, part(band, area));
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
        let Ok(()) = error_picture(self, Rgb565::new(20, 0, 0), Rgb565::WHITE, message);
    }

    fn halt(&mut self) -> ! {
        semihosting::wait_for_host();
        semihosting::exit(1)
    }
}

/// Memory and start of a board with a frame buffer. It draws the stream with these methods, or shows what `|display| ...` draws. It is a macro, because the
/// sizes of statics cannot depend on a type parameter.
#[macro_export]
macro_rules! framebuffer_board {
    (|$display:ident| $show:expr) => {
        /// The host finds it by this name.
        #[unsafe(no_mangle)]
        static mut FRAMEBUFFER: [u16; ::microphong_firmware::framebuffer::LENGTH] = [0; ::microphong_firmware::framebuffer::LENGTH];

        /// Shows pictures.
        #[::microphong_firmware::entry]
        fn main() -> ! {
            let picture = &raw mut FRAMEBUFFER;
            // SAFETY: nothing else in the program names it, and `main` runs once.
            let $display = &mut ::microphong_firmware::framebuffer::Framebuffer::new(unsafe { &mut *picture });
            $show
        }
    };
    ($shaders:expr) => {
        use ::embedded_graphics::pixelcolor::{Rgb565, RgbColor};
        use ::microphong::Layout;
        use ::microphong_firmware::{OneCore, framebuffer, run};

        const LAYOUT: Layout = framebuffer::LAYOUT;

        static mut BAND: [Rgb565; LAYOUT.band()] = [Rgb565::BLACK; LAYOUT.band()];
        static mut MEMORY: [u64; LAYOUT.words::<Rgb565>()] = [0; LAYOUT.words::<Rgb565>()];

        ::microphong_firmware::framebuffer_board!(|display| {
            let (band, memory) = (&raw mut BAND, &raw mut MEMORY);
            // SAFETY: nothing else in the program names them, and `main` runs once.
            let (band, memory) = unsafe { (&mut *band, &mut *memory) };
            run(display, &mut OneCore { band }, &LAYOUT, memory, $shaders)
        });
    };
}
