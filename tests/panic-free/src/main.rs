//! The whole core, from bytes to pixels in every format of a board, with a panic handler that cannot be linked.
//!
//! `cargo build --release -p panic-free --features all --target thumbv7m-none-eabi`, in the folder `firmware`, fails with *undefined symbol:
//! a_panic_can_be_reached* if the optimised code holds a panic.
#![no_std]
#![no_main]

use embedded_graphics_core::{
    geometry::{Point, Size},
    pixelcolor::{Gray4, Rgb565},
    primitives::Rectangle,
};
use microphong::{
    Layout, PreparationPart, Renderer, Shader, Stream,
    pixel::{FromDrawn, Light, LightGray, Output, PictureCrc, Pixel, Rgb565Be, gamma::SRGB},
};

use microphong_literature::ALL;

unsafe extern "C" {
    safe fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    a_panic_can_be_reached()
}

/// Pixels of a band.
const BAND: usize = 9600;
/// Room for a small scene, antialiased.
const LAYOUT: Layout = Layout::new(240, 40).vertices(600).triangles(600).materials(2).processors(2).antialias(cfg!(feature = "all"));
/// Number of words that suffices in every pixel format: the largest pixels take most.
const WORDS: usize = LAYOUT.words::<Light<5, 6, 5>>();

/// The memory that a board draws pictures in: of pixels `C` for a display with pixels `F`.
pub struct Buffers<C: Pixel, F> {
    memory: [u64; WORDS],
    band: [C; BAND],
    pixels: [F; BAND],
}

/// What to draw, and how. Nothing of it is known at compile time.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Request {
    stream: &'static [u8],
    size: [u32; 2],
    /// The method, by its index.
    shader: usize,
    number: u32,
    /// Name of the object.
    name: &'static str,
    /// Share of the triangles at which work is divided for two processors, in units of 1/65,536.
    share: u16,
    dither: bool,
    gamma: bool,
    antialias: bool,
    perspective: bool,
    output: Output,
}

/// One frame, band by band, as a board draws it: its checksum and its count of pixels.
fn draw<C: Pixel, F: FromDrawn<C>>(request: Request, buffers: &mut Buffers<C, F>) -> Option<u32> {
    let [width, height] = request.size;
    let literature = Shader::new(*ALL.get(request.shader / 8)?);
    let shader = Shader::ALL.get(request.shader).copied().unwrap_or(literature);
    let stream = Stream::parse(request.stream).ok()?;
    let mut renderer = Renderer::with_shader(stream, Size::new(width, height), &LAYOUT, &mut buffers.memory, shader).ok()?;
    renderer.set_dither(request.dither);
    renderer.set_gamma(request.gamma.then_some(&SRGB));
    #[cfg(feature = "all")]
    renderer.set_antialias(request.antialias).ok()?;
    renderer.set_perspective_correct(request.perspective).ok()?;
    let mut frame = renderer.frame(request.number);
    let mut crc = PictureCrc::default();
    while let Some(area) = frame.next_band(&mut buffers.band).ok()? {
        frame.output().convert(&buffers.band, area, &mut buffers.pixels);
        crc.update(&buffers.pixels);
        frame.output().pixels::<C, F>(&buffers.band, area).for_each(|pixel| crc.update(&[pixel]));
    }
    let mut preparation = renderer.prepare(request.number, request.share);
    preparation.parts().into_iter().for_each(PreparationPart::run);
    let frame = preparation.frame();
    let row = frame.row_at(request.share);
    let mut frame = frame.in_two(row);
    for mut part in frame.parts() {
        while let Some(area) = part.next_band(&mut buffers.band).ok()? {
            part.output().convert(&buffers.band, area, &mut buffers.pixels);
            crc.update(&buffers.pixels);
        }
    }
    let named = stream.mesh(request.name).map_or(0, |meshes| meshes.end.into());
    Some(crc.finish() ^ frame.stats().pixels ^ named)
}

/// Arguments come from outside, so nothing is known at compile time. The formats are those of the boards.
#[unsafe(no_mangle)]
pub extern "C" fn _start(
    request: &'static Request,
    rgb565: &'static mut Buffers<Rgb565, Rgb565>,
    rgb565_be: &'static mut Buffers<Rgb565Be, Rgb565Be>,
    light: &'static mut Buffers<Light<5, 6, 5>, Rgb565>,
    gray4: &'static mut Buffers<LightGray<4>, Gray4>,
    packed: &'static mut [u8; BAND / 2],
) -> u32 {
    if cfg!(feature = "with-a-panic") {
        return u32::from(request.stream[request.shader]);
    }
    let checksums = [draw(*request, rgb565), draw(*request, rgb565_be), draw(*request, light), draw(*request, gray4)];
    let (area, output) = (Rectangle::new(Point::zero(), request.size.into()), request.output);
    output.pack(&gray4.band, area, packed);
    checksums.into_iter().flatten().fold(0, |all, one| all ^ one)
}
