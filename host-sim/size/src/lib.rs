//! A whole program with one method and one pixel format, and nothing else: it has no log and no display driver. Its display is one register, like
//! the bus of a real one.
#![no_std]

#[path = "../../../firmware/src/stream.rs"]
mod stream;

use core::{convert::Infallible, marker::PhantomData, panic::PanicInfo};
use embedded_graphics_core::{pixelcolor::PixelColor, prelude::*, primitives::Rectangle};
use microphong::{
    Layout, Picture, Renderer, Shader, Stream,
    pixel::{FromDrawn, Pixel},
};
use semihosting::sys::arm_compat::{sys_readc, sys_writec};

#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

/// Room for any mesh. The command subtracts this memory, and adds the memory of the mesh and picture in question.
pub const ROOM: Layout = Layout::new(240, 240).vertices(16384).triangles(32768).materials(16).objects(64);

struct Panel<C>(PhantomData<C>);

impl<C> OriginDimensions for Panel<C> {
    fn size(&self) -> Size {
        Size::new(240, 240)
    }
}

impl<C: PixelColor> DrawTarget for Panel<C> {
    type Color = C;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = embedded_graphics_core::Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        pixels.into_iter().for_each(|pixel| send(pixel.1));
        Ok(())
    }

    fn fill_contiguous<I: IntoIterator<Item = C>>(&mut self, _: &Rectangle, colours: I) -> Result<(), Infallible> {
        colours.into_iter().for_each(send);
        Ok(())
    }
}

fn send<C: PixelColor>(colour: C) {
    static mut REGISTER: u32 = 0;
    // SAFETY: nothing else names the register, and no pixel of these programs is larger.
    unsafe { (&raw mut REGISTER).cast::<C>().write_volatile(colour) }
}

/// Draws all frames of the stream, and tells the host whether they are drawn.
pub fn run<C: Pixel + From<F>, F: FromDrawn<C> + PixelColor>(memory: &mut [u64], band: &mut [C], shader: Shader<C>) -> ! {
    let drawn = draw::<C, F>(memory, band, shader).is_some();
    loop {
        tell(if drawn { b'd' } else { b'f' });
    }
}

fn draw<C: Pixel + From<F>, F: FromDrawn<C> + PixelColor>(memory: &mut [u64], band: &mut [C], shader: Shader<C>) -> Option<()> {
    let stream = Stream::parse_included(stream::bytes()).ok()?;
    let mut display = Panel(PhantomData::<F>);
    let mut renderer = Renderer::with_shader(stream, display.size(), &ROOM, memory, shader).ok()?;
    for number in 0..u32::from(stream.header.frames) {
        let Ok(_) = Picture::new(&mut renderer, band, number).ok()?.shown_as::<F>().draw(&mut display);
    }
    Some(())
}

/// Hands the host a byte, and waits until it has looked at the stack.
fn tell(byte: u8) {
    sys_writec(byte);
    let _ = sys_readc();
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}

/// A program that draws by one method pixels of one type for a display with one pixel format. The host finds memory and band by their names.
#[macro_export]
macro_rules! program {
    ($drawn:ty, $format:ident, $shader:ident) => {
        use ::embedded_graphics_core::pixelcolor::*;
        use ::microphong::{Shader, pixel::*};
        use ::size::ROOM;

        #[unsafe(no_mangle)]
        static mut MEMORY: [u64; ROOM.words::<$drawn>()] = [0; ROOM.words::<$drawn>()];
        #[unsafe(no_mangle)]
        static mut BAND: [$drawn; ROOM.band()] = [<$drawn>::BLACK; ROOM.band()];

        /// Draws.
        #[::size::entry]
        fn main() -> ! {
            // SAFETY: nothing else in the program names them, and `main` runs once.
            let (memory, band) = unsafe { (&mut *(&raw mut MEMORY), &mut *(&raw mut BAND)) };
            ::size::run::<$drawn, $format>(memory, band, Shader::$shader)
        }
    };
}
