//! Pixels as displays store them, and as PNG files want them.

use crate::output::Output;
use anyhow::{Context, Result};
use microphong::pixel::PixelFormat;
use std::{cell::RefCell, io::Write, path::Path, rc::Rc};

/// A channel of `bits` bits in 8, by repeating it: 0 stays 0 and the largest value becomes 255.
#[must_use]
pub fn replicate(value: u32, bits: u32) -> u8 {
    let first = value << (8 - bits);
    (1..8).fold(first, |wide, k| wide | first >> (k * bits).min(8)) as u8
}

/// A pixel as 8-bit red, green and blue.
#[must_use]
pub fn to_rgb<C: PixelFormat>(pixel: C) -> [u8; 3] {
    let (channels, depth) = (pixel.channels(), C::DEPTH);
    [0, 1, 2].map(|k| replicate(channels[k].into(), depth[k]))
}

/// Pixels as bytes, red, green and blue in turn.
#[must_use]
pub fn rgb_bytes<C: PixelFormat>(pixels: &[C]) -> Vec<u8> {
    pixels.iter().flat_map(|&p| to_rgb(p)).collect()
}

/// Writes 8-bit RGB as a PNG file.
///
/// # Errors
/// When the file cannot be written; then there is none.
pub fn write_png(path: &Path, width: u32, height: u32, rgb: &[u8]) -> Result<()> {
    let mut film = Film::create(path, width, height, 1)?;
    film.add(rgb)?;
    film.finish()
}

/// A PNG file of one picture or of several, shown in turn for ever.
pub struct Film {
    // Declared first and so dropped first: an abandoned writer still ends its (unnamed) file.
    writer: png::Writer<Shared>,
    output: Rc<RefCell<Output>>,
}

/// Frames per second of an animation.
const RATE: u16 = 30;

impl Film {
    /// Starts a file for `frames` pictures.
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn create(path: &Path, width: u32, height: u32, frames: u32) -> Result<Self> {
        let output = Rc::new(RefCell::new(Output::create(path)?));
        let start = || {
            let mut encoder = png::Encoder::new(Shared(Rc::clone(&output)), width, height);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_depth(png::BitDepth::Eight);
            if frames > 1 {
                encoder.set_animated(frames, 0)?;
                encoder.set_frame_delay(1, RATE)?;
            }
            encoder.write_header()
        };
        let writer = start().with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { writer, output })
    }

    /// Adds the next picture, 8-bit RGB.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn add(&mut self, rgb: &[u8]) -> Result<()> {
        self.writer.write_image_data(rgb).with_context(|| format!("cannot write {}", self.output.borrow().path().display()))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn finish(self) -> Result<()> {
        let Self { writer, output } = self;
        let path = output.borrow().path().to_owned();
        writer.finish().with_context(|| format!("cannot write {}", path.display()))?;
        // The writer was the only other owner.
        Rc::into_inner(output).with_context(|| format!("cannot close {}", path.display()))?.into_inner().finish()
    }
}

/// The encoder keeps its writer; the file needs its name afterwards.
struct Shared(Rc<RefCell<Output>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.0.borrow_mut().flush()
    }
}
