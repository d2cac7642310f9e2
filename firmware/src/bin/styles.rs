//! Boards with plentiful RAM, in a style that cargo features name: a pixel format, and interpolation in perspective or the curve of a display.
//! `microphong bench --styles` counts frames of it, and nobody looks at them.
#![no_std]
#![no_main]

use microphong::{Layout, pixel::PixelFormat};
use microphong_firmware::{
    OneCore, framebuffer,
    register::{Pass, Register},
    run, shaders,
};

/// By the cargo feature of the format: the pixels that are drawn, what the display takes, and a value and the pass for it.
macro_rules! formats {
    ($($feature:literal: $drawn:ty => $taken:ty = $value:expr, $pass:expr;)*) => {$(
        #[cfg(feature = $feature)]
        type Drawn = $drawn;
        #[cfg(feature = $feature)]
        type Taken = $taken;
        #[cfg(feature = $feature)]
        const VALUE: Taken = $value;
        #[cfg(feature = $feature)]
        const PASS: Pass<Drawn, Taken> = $pass;
    )*};
}

formats! {
    "rgb565": embedded_graphics::pixelcolor::Rgb565 => () = (), |_, _, _, _| {};
    "rgb888": embedded_graphics::pixelcolor::Rgb888 => () = (), |_, _, _, _| {};
    "gray8": embedded_graphics::pixelcolor::Gray8 => () = (), |_, _, _, _| {};
    "gray4": microphong::pixel::LightGray<4> => u8 = 0, |output, band, area, bytes| output.pack(band, area, bytes);
    "gray2": microphong::pixel::LightGray<2> => u8 = 0, |output, band, area, bytes| output.pack(band, area, bytes);
    "binary": microphong::pixel::LightGray<1> => u8 = 0, |output, band, area, bytes| output.pack(band, area, bytes);
    "bgr565": embedded_graphics::pixelcolor::Bgr565 => () = (), |_, _, _, _| {};
    "rgb666": embedded_graphics::pixelcolor::Rgb666 => () = (), |_, _, _, _| {};
    "rgb332": microphong::pixel::Light<3, 3, 2> => microphong::pixel::Rgb332 = microphong::pixel::Rgb332::BLACK,
        |output, band, area, pixels| output.convert(band, area, pixels);
    "light-rgb565": microphong::pixel::Light<5, 6, 5> => embedded_graphics::pixelcolor::Rgb565 = embedded_graphics::pixelcolor::RgbColor::BLACK,
        |output, band, area, pixels| output.convert(band, area, pixels);
}

const LAYOUT: Layout = framebuffer::LAYOUT;

static mut BAND: heapless::Vec<Drawn, { LAYOUT.band() }> = heapless::Vec::new();
static mut ROOM: [Taken; LAYOUT.band()] = [VALUE; LAYOUT.band()];
static mut MEMORY: [u64; LAYOUT.words::<Drawn>()] = [0; LAYOUT.words::<Drawn>()];

/// Draws the stream.
#[microphong_firmware::entry]
fn main() -> ! {
    let (band, room, memory) = (&raw mut BAND, &raw mut ROOM, &raw mut MEMORY);
    // SAFETY: nothing else in the program names them, and `main` runs once.
    let (band, room, memory) = unsafe { (&mut *band, &mut *room, &mut *memory) };
    // Not every format has a constant for black.
    let _ = band.resize(LAYOUT.band(), Drawn::pack([0; 3]));
    run(&mut Register { room, pass: PASS }, &mut OneCore { band }, &LAYOUT, memory, shaders::every())
}
