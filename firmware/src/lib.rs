//! The firmware's one frame loop, and what the boards need to take part in it.
//!
//! A board is a [`Display`], memory, a [`Painter`] and a `main` that hands them to [`run`].
#![no_std]

pub mod budget;
#[cfg(feature = "raspberry-pi")]
#[cfg_attr(feature = "pico", path = "rp2040.rs")]
#[cfg_attr(feature = "pico2", path = "rp2350.rs")]
mod chip;
mod failure;
mod painter;
mod picture;
#[cfg_attr(target_arch = "arm", path = "cortex_m.rs")]
#[cfg_attr(target_arch = "riscv32", path = "riscv.rs")]
mod processor;
#[cfg(feature = "semihosting")]
mod semihosting;
#[cfg(feature = "literature")]
pub mod shaders;
mod stack;
mod stream;

#[cfg(feature = "framebuffer")]
pub mod framebuffer;
#[cfg(feature = "raspberry-pi")]
pub mod pico;
#[cfg(feature = "styles")]
pub mod register;
#[cfg(feature = "raspberry-pi")]
pub mod second_core;
#[cfg(feature = "lm3s6965evb")]
pub mod ssd0323;
#[cfg(feature = "raspberry-pi")]
pub mod st7789;

pub use failure::Failure;
pub use painter::{OneCore, Painter};
pub use picture::error_picture;
pub use processor::entry;

use embedded_graphics::{prelude::*, primitives::Rectangle};
use microphong::{
    Counts, Layout, Renderer, Shader, Stream,
    pixel::{Output, PictureCrc, Pixel, gamma::SRGB},
};

/// A board as the frame loop needs it.
pub trait Display {
    /// The pixel that the renderer draws.
    type Color: Pixel;

    /// The picture's size.
    fn size(&self) -> Size;

    /// A frame begins to be drawn; the last band of the one before may still be on its way.
    ///
    /// # Errors
    /// When the display has not taken what was sent before.
    fn begin(&mut self) -> Result<(), Failure> {
        Ok(())
    }

    /// Begins to show the pixels of `area`, row by row, which are at the front of `band`. Returns memory for the next band. It may be the memory of
    /// an earlier band, because a board can send one band while the next one is drawn. `output` makes pixels of the display if the renderer draws
    /// others.
    fn send(&mut self, area: Rectangle, band: &'static mut [Self::Color], output: Output) -> &'static mut [Self::Color];

    /// Called when all of a frame has been handed over.
    fn present(&mut self) {}

    /// Microseconds since some time, if the board has a clock.
    fn now(&self) -> Option<u64> {
        None
    }

    /// Returns when all that was handed over is shown.
    ///
    /// # Errors
    /// When the display has not taken all of it.
    fn finish(&mut self) -> Result<(), Failure>;

    /// Called when all frames of the stream have been shown. They start again when it returns.
    fn end(&mut self) {}

    /// There is no picture to draw: shows `message` instead.
    fn fail(&mut self, message: &str);

    /// The message stays.
    fn halt(&mut self) -> !;
}

/// Draws the frames of the stream in flash, again and again. `shaders` are the methods that the board has.
pub fn run<D: Display>(
    display: &mut D,
    painter: &mut impl Painter<D>,
    layout: &Layout,
    memory: &mut [u64],
    shaders: &[Shader<D::Color>],
) -> ! {
    let Err(failure) = animate(display, painter, layout, memory, shaders);
    stop(display, failure)
}

/// Shows and logs why there is no picture. A call of its own, so that drawing needs no stack for it.
#[inline(never)]
pub fn stop<D: Display>(display: &mut D, failure: Failure) -> ! {
    let message = failure.message();
    // Should the display hang, too, the log has it all the same.
    defmt::warn!("no picture: {=str}", message.as_str());
    display.fail(&message);
    // The host reads this line, and then the display: in this order.
    defmt::error!("error: {=str}", message.as_str());
    display.halt()
}

/// Returns only if it cannot start or go on.
fn animate<D: Display>(
    display: &mut D,
    painter: &mut impl Painter<D>,
    layout: &Layout,
    memory: &mut [u64],
    shaders: &[Shader<D::Color>],
) -> Result<core::convert::Infallible, Failure> {
    let stream = Stream::parse(stream::bytes())?;
    let mut renderer = Renderer::new(stream, display.size(), layout, memory, shaders)?;
    #[cfg(feature = "antialias")]
    if !stream.neighbours.is_empty() {
        renderer.set_antialias(true)?;
    }
    if cfg!(feature = "perspective") {
        renderer.set_perspective_correct(true)?;
    }
    if cfg!(feature = "gamma") {
        renderer.set_gamma(Some(&SRGB));
    }
    let mut counts = Counts::default();
    for number in 0..u32::from(stream.header.frames) {
        let mut crc = PictureCrc::default();
        display.begin()?;
        let frame = painter.prepare(&mut renderer, number);
        let stats = painter.draw(display, frame, Some(&mut crc))?;
        counts = counts.and(stats.counts);
        // The host reads this line: keep its form.
        defmt::info!(
            "frame {=u32} shader {=str} crc {=u32:08x} triangles {=u32} culled {=u32} drawn {=u32} pixels {=u32}",
            number,
            renderer.shader().facts().name,
            crc.finish(),
            stats.triangles,
            stats.culled,
            stats.drawn,
            stats.pixels
        );
        display.present();
        display.finish()?;
    }
    painter.report();
    if cfg!(feature = "skips") {
        let Counts { without_depth, without_highlight, without_light, hidden, choices: [one, linear, quadratic, cosines, phong] } = counts;
        defmt::info!("triangles without depth {=u32}, highlights {=u32}, lights {=u32}", without_depth, without_highlight, without_light);
        defmt::info!("triangles of hidden objects {=u32}", hidden);
        defmt::info!(
            "budget {=u8}/8 of 255: triangles in one colour {=u32}, linear {=u32}, quadratic {=u32}, cosines {=u32}, Phong {=u32}",
            renderer.budget().to_bits(),
            one,
            linear,
            quadratic,
            cosines,
            phong
        );
    }
    // The host reads this line: keep its form.
    defmt::info!("stack {=usize} bytes", stack::used());
    display.end();
    // All has been checked: from now on at full speed. A frame that is the picture shown is neither drawn nor sent, nor is what no moving
    // object touches. Outside of the rows `shown` the display shows nothing but background: what is so in this frame too is not drawn either.
    renderer.set_partial_redraw(true);
    let mut shown = 0..display.size().height;
    let mut start = display.now();
    loop {
        let mut drawn = 0_u16;
        for number in 0..u32::from(stream.header.frames) {
            display.begin()?;
            if !renderer.is_latest(number) {
                let mut frame = painter.prepare(&mut renderer, number);
                let rows = frame.rows();
                let reached = rows.start.min(shown.start)..rows.end.max(shown.end);
                frame.limit(reached.clone());
                shown = if frame.is_whole() { rows } else { reached };
                painter.draw(display, frame, None)?;
                drawn += 1;
            }
            display.present();
        }
        // Once: what follows takes as long.
        if let Some((start, end)) = start.take().zip(display.now()) {
            defmt::info!("{=u16} frames drawn in {=u64} us", drawn, end - start);
        }
    }
}

/// A call of its own, so that its instructions can be told from a frame's.
#[inline(never)]
fn check<C: Pixel>(crc: &mut PictureCrc, pixels: &[C]) {
    crc.update(pixels);
}
