//! The firmware's one frame loop, and what the boards need to take part in it.
//!
//! A board is a [`Display`], memory and a `main` that hands both to [`run`].
#![no_std]

pub mod budget;
mod failure;
mod picture;
#[cfg(feature = "semihosting")]
mod semihosting;
#[cfg(feature = "literature")]
pub mod shaders;
mod stack;
mod stream;

#[cfg(any(feature = "mps2-an385", feature = "mps2-an386"))]
pub mod framebuffer;
#[cfg(feature = "lm3s6965evb")]
pub mod ssd0323;
#[cfg(feature = "pico")]
pub mod st7789;

pub use failure::Failure;
pub use picture::error_picture;

use core::ops::Range;
use embedded_graphics::{prelude::*, primitives::Rectangle};
use microphong::{
    Frame, Layout, Renderer, Shader, Stats, Stream,
    pixel::{PictureCrc, Pixel},
};
use panic_probe as _;

/// What the frame loop needs of a board.
pub trait Display {
    /// What the renderer should produce.
    type Color: Pixel;

    /// The picture's size.
    fn size(&self) -> Size;

    /// A new frame begins to be drawn; the last band of the one before may still be to be sent.
    fn begin(&mut self) {}

    /// Shows the pixels of `area`, row by row, and does `meanwhile`, at the same time if the board can. [`Self::present`] tells what fails.
    fn send<R>(&mut self, area: Rectangle, pixels: &[Self::Color], meanwhile: impl FnOnce() -> R) -> R;

    /// All of a frame has been sent.
    ///
    /// # Errors
    /// When the display has not taken all of it.
    fn present(&mut self) -> Result<(), Failure>;

    /// All frames of the stream have been shown; they start again when this returns.
    fn end(&mut self) {}

    /// There is no picture to draw: shows `message` instead.
    fn fail(&mut self, message: &str);

    /// The message stays.
    fn halt(&mut self) -> !;
}

/// Draws the frames of the stream in flash, again and again. Two pixel buffers, so that one can be drawn while the other is sent.
/// `shaders` are the methods that the board has.
pub fn run<D: Display>(
    display: &mut D,
    layout: &Layout,
    memory: &mut [u64],
    bands: [&mut [D::Color]; 2],
    shaders: &[Shader<D::Color>],
) -> ! {
    let Err(failure) = animate(display, layout, memory, bands, shaders);
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
    layout: &Layout,
    memory: &mut [u64],
    mut bands: [&mut [D::Color]; 2],
    shaders: &[Shader<D::Color>],
) -> Result<core::convert::Infallible, Failure> {
    let stream = Stream::parse(stream::bytes())?;
    let mut renderer = Renderer::new(stream, display.size(), layout, memory, shaders)?;
    for band in &bands {
        renderer.check_band(band)?;
    }
    let whole = 0..display.size().height;
    for number in 0..u32::from(stream.header.frames) {
        let mut crc = PictureCrc::default();
        let (stats, last) = draw(display, &mut renderer, number, &mut bands, None, &mut whole.clone(), |pixels| check(&mut crc, pixels))?;
        if let Some(area) = last {
            let pixels = part(bands[0], area);
            display.send(area, pixels, || check(&mut crc, pixels));
        }
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
        display.present()?;
    }
    // The host reads this line: keep its form.
    defmt::info!("stack {=usize} bytes", stack::used());
    display.end();
    // All has been checked: from now on at full speed.
    let (mut last, mut shown) = (None, whole);
    loop {
        for number in 0..u32::from(stream.header.frames) {
            (_, last) = draw(display, &mut renderer, number, &mut bands, last, &mut shown, |_| ())?;
        }
    }
}

/// A call of its own, so that its instructions can be told from a frame's.
#[inline(never)]
fn check<C: Pixel>(crc: &mut PictureCrc, pixels: &[C]) {
    crc.update(pixels);
}

/// Draws one frame: while a band is on its way to the display, `look` sees it and the next one is drawn.
///
/// `last` is the band of the frame before that is still to be sent; the last one of this frame is returned likewise. Both lie in
/// the first of the `bands`. The display shows nothing but background outside the rows `shown`: what is so in this frame too is not drawn.
fn draw<D: Display>(
    display: &mut D,
    renderer: &mut Renderer<'_, D::Color>,
    number: u32,
    bands: &mut [&mut [D::Color]; 2],
    last: Option<Rectangle>,
    shown: &mut Range<u32>,
    mut look: impl FnMut(&[D::Color]),
) -> Result<(Stats, Option<Rectangle>), Failure> {
    display.begin();
    let [front, back] = bands;
    let (mut frame, mut next) = match last {
        Some(area) => {
            let started = display.send(area, part(front, area), move || start(renderer, number, shown, back));
            display.present()?;
            started
        }
        None => start(renderer, number, shown, back),
    };
    loop {
        bands.swap(0, 1);
        let [front, back] = bands;
        match next {
            Some(area) if !frame.is_complete() => {
                let pixels = part(front, area);
                next = display.send(area, pixels, || {
                    look(pixels);
                    draw_next(&mut frame, back)
                });
            }
            _ => return Ok((frame.stats(), next)),
        }
    }
}

/// Begins a frame and draws its first band; `shown` is as for [`draw`], and becomes what it will be after this frame.
fn start<'r, C: Pixel>(
    renderer: &'r mut Renderer<'_, C>,
    number: u32,
    shown: &mut Range<u32>,
    band: &mut [C],
) -> (Frame<'r, C>, Option<Rectangle>) {
    let mut frame = renderer.frame(number);
    let rows = frame.rows();
    frame.limit(rows.start.min(shown.start)..rows.end.max(shown.end));
    *shown = rows;
    let area = draw_next(&mut frame, band);
    (frame, area)
}

/// Draws the next band; bands have been checked before the first frame.
fn draw_next<C: Pixel>(frame: &mut Frame<'_, C>, band: &mut [C]) -> Option<Rectangle> {
    frame.next_band(band).unwrap_or_default()
}

/// The pixels of `area` in a band.
fn part<C>(band: &[C], area: Rectangle) -> &[C] {
    &band[..(area.size.width * area.size.height) as usize]
}
