//! Pixel formats: how a colour of 8 bits per channel becomes what a display stores.

#[doc(hidden)]
pub mod dither;

use crate::format::{BIAS, Intensity, RAMP, WALK};
use embedded_graphics_core::{
    pixelcolor::{
        Gray4, Gray8, Rgb565, Rgb888,
        raw::{RawData, RawU4, RawU8, RawU16, RawU24},
    },
    prelude::{GrayColor, RgbColor},
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// A format that the renderer can draw.
pub trait Pixel: Copy + 'static {
    /// The form in which tables of colours store a pixel.
    type Stored: FromBytes + IntoBytes + Immutable + KnownLayout + Copy + core::fmt::Debug;

    /// One channel instead of three.
    const GRAY: bool;
    /// Bits of red, green and blue (or of grey, three times).
    const DEPTH: [u32; 3];
    /// Bytes that a pixel adds to the picture's checksum.
    const BYTES: usize;

    /// Packs channel values of [`Self::DEPTH`] bits; a grey format looks at the first.
    fn pack(channels: [u8; 3]) -> Self;

    /// The pixel as tables of colours store it.
    fn stored(self) -> Self::Stored;

    /// The pixel from its stored form.
    fn from_stored(stored: Self::Stored) -> Self;

    /// The channel values that were packed.
    fn channels(self) -> [u8; 3];

    /// The value that the display is sent, independent of byte order in memory.
    fn bits(self) -> u32;

    /// The colour of a level under a table of colours. Levels are biased and have `BITS` fraction bits, rounding half included.
    #[inline(always)]
    fn ramped<const BITS: u32>(ramp: &[Self::Stored; RAMP], level: u32) -> Self {
        Self::from_stored(ramp[(level >> BITS) as usize % RAMP])
    }

    /// The colour of an intensity of three channels, rounded.
    #[inline]
    fn rounded(intensity: Intensity) -> Self {
        let channel = |level: i32, depth: u32| (((level + (1 << (15 - depth))) >> 8).min(255) >> (8 - depth)) as u8;
        let ([r, g, b], [dr, dg, db]) = (intensity, Self::DEPTH);
        Self::pack([channel(r, dr), channel(g, dg), channel(b, db)])
    }

    /// The colour of three levels, biased and with [`WALK`] fraction bits, half a step of each channel included.
    #[inline(always)]
    fn mixed([r, g, b]: [u32; 3]) -> Self {
        let channel = |level: u32, depth: u32| (((level >> WALK) as i32 - BIAS).clamp(0, 255) >> (8 - depth)) as u8;
        let [dr, dg, db] = Self::DEPTH;
        Self::pack([channel(r, dr), channel(g, dg), channel(b, db)])
    }
}

impl Pixel for Rgb565 {
    type Stored = u16;

    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [5, 6, 5];
    const BYTES: usize = 2;

    #[inline(always)]
    fn pack([r, g, b]: [u8; 3]) -> Self {
        Self::new(r, g, b)
    }

    #[inline(always)]
    fn stored(self) -> u16 {
        RawU16::from(self).into_inner()
    }

    #[inline(always)]
    fn from_stored(stored: u16) -> Self {
        RawU16::new(stored).into()
    }

    fn channels(self) -> [u8; 3] {
        [self.r(), self.g(), self.b()]
    }

    fn bits(self) -> u32 {
        u32::from(self.r()) << 11 | u32::from(self.g()) << 5 | u32::from(self.b())
    }
}

impl Pixel for Rgb888 {
    type Stored = u32;

    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [8; 3];
    const BYTES: usize = 3;

    #[inline(always)]
    fn pack([r, g, b]: [u8; 3]) -> Self {
        Self::new(r, g, b)
    }

    #[inline(always)]
    fn stored(self) -> u32 {
        RawU24::from(self).into_inner()
    }

    #[inline(always)]
    fn from_stored(stored: u32) -> Self {
        RawU24::new(stored).into()
    }

    fn channels(self) -> [u8; 3] {
        [self.r(), self.g(), self.b()]
    }

    fn bits(self) -> u32 {
        u32::from(self.r()) << 16 | u32::from(self.g()) << 8 | u32::from(self.b())
    }
}

impl Pixel for Gray8 {
    type Stored = u8;

    const GRAY: bool = true;
    const DEPTH: [u32; 3] = [8; 3];
    const BYTES: usize = 1;

    #[inline(always)]
    fn pack([luma, ..]: [u8; 3]) -> Self {
        Self::new(luma)
    }

    #[inline(always)]
    fn stored(self) -> u8 {
        RawU8::from(self).into_inner()
    }

    #[inline(always)]
    fn from_stored(stored: u8) -> Self {
        RawU8::new(stored).into()
    }

    fn channels(self) -> [u8; 3] {
        [self.luma(); 3]
    }

    fn bits(self) -> u32 {
        self.luma().into()
    }
}

impl Pixel for Gray4 {
    type Stored = u8;

    const GRAY: bool = true;
    const DEPTH: [u32; 3] = [4; 3];
    const BYTES: usize = 1;

    #[inline(always)]
    fn pack([luma, ..]: [u8; 3]) -> Self {
        Self::new(luma)
    }

    #[inline(always)]
    fn stored(self) -> u8 {
        RawU4::from(self).into_inner()
    }

    #[inline(always)]
    fn from_stored(stored: u8) -> Self {
        RawU4::new(stored).into()
    }

    fn channels(self) -> [u8; 3] {
        [self.luma(); 3]
    }

    fn bits(self) -> u32 {
        self.luma().into()
    }
}

/// RGB565 with the high byte first in memory, as serial displays want it: a band can be handed to the bus as it is, without a copy. The
/// order costs nothing, since colours come from tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct Rgb565Be(u16);

impl Rgb565Be {
    /// Black.
    pub const BLACK: Self = Self(0);
}

impl Pixel for Rgb565Be {
    type Stored = Self;

    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [5, 6, 5];
    const BYTES: usize = 2;

    #[inline(always)]
    fn pack([r, g, b]: [u8; 3]) -> Self {
        Self((u16::from(r) << 11 | u16::from(g) << 5 | u16::from(b)).to_be())
    }

    #[inline(always)]
    fn stored(self) -> Self {
        self
    }

    #[inline(always)]
    fn from_stored(stored: Self) -> Self {
        stored
    }

    fn channels(self) -> [u8; 3] {
        let bits = u16::from_be(self.0);
        [(bits >> 11) as u8, (bits >> 5 & 0x3F) as u8, (bits & 0x1F) as u8]
    }

    fn bits(self) -> u32 {
        u16::from_be(self.0).into()
    }
}

/// Checksum of a picture: CRC-32 over the pixels' values, low byte first, row by row from the top.
#[derive(Clone)]
pub struct PictureCrc(crc::Digest<'static, u32, crc::Table<1>>);

/// A table of one kilobyte, since a picture is checked every frame.
static PICTURE: crc::Crc<u32, crc::Table<1>> = crc::Crc::<u32, crc::Table<1>>::new(&crc::CRC_32_ISO_HDLC);

impl Default for PictureCrc {
    fn default() -> Self {
        Self(PICTURE.digest())
    }
}

impl PictureCrc {
    /// Adds the next pixels.
    pub fn update<C: Pixel>(&mut self, pixels: &[C]) {
        for pixel in pixels {
            let bytes = pixel.bits().to_le_bytes();
            self.0.update(&bytes[..C::BYTES]);
        }
    }

    /// The checksum of all pixels so far.
    #[must_use]
    pub fn finish(self) -> u32 {
        self.0.finalize()
    }
}
