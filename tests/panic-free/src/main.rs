//! The whole core, from bytes to pixels, with a panic handler that cannot be linked.
//!
//! `cargo build --release --target thumbv7m-none-eabi` fails with *undefined symbol: a_panic_can_be_reached*
//! if the optimised code holds a panic.
#![no_std]
#![no_main]

use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Gray4, Rgb565},
};
use microphong::{Renderer, Shader, Stats, Stream, Workspace, pixel::Pixel};

unsafe extern "C" {
    safe fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    a_panic_can_be_reached()
}

fn draw<C: Pixel>(
    bytes: &[u8],
    workspace: &mut Workspace<C, 600, 600, 9600, 2, 40, 2400>,
    pixels: &mut [C],
    size: u32,
    options: u32,
) -> Option<Stats> {
    let mut renderer = Renderer::new(Stream::parse(bytes).ok()?, Size::new(size, size), workspace.memory()).ok()?;
    renderer.set_shader(*Shader::ALL.get(options as usize & 31)?).ok()?;
    renderer.set_dither(options & 32 != 0);
    renderer.set_antialias(options & 64 != 0).ok()?;
    renderer.set_perspective_correct(options & 128 != 0).ok()?;
    let mut frame = renderer.frame(options >> 8);
    while frame.next_band(pixels).is_some() {}
    Some(frame.stats())
}

/// Arguments come from outside, so nothing is known at compile time.
#[unsafe(no_mangle)]
pub extern "C" fn _start(
    bytes: &'static &'static [u8],
    colour: &'static mut Workspace<Rgb565, 600, 600, 9600, 2, 40, 2400>,
    grey: &'static mut Workspace<Gray4, 600, 600, 9600, 2, 40, 2400>,
    pixels: &'static mut ([Rgb565; 9600], [Gray4; 9600]),
    size: u32,
    options: u32,
) -> u32 {
    if cfg!(feature = "with-a-panic") {
        return u32::from(bytes[size as usize]);
    }
    let a = draw(bytes, colour, &mut pixels.0, size, options).map_or(0, |stats| stats.pixels);
    a + draw(bytes, grey, &mut pixels.1, size, options).map_or(0, |stats| stats.pixels)
}
