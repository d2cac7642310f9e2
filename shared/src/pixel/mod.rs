//! Pixel formats: how a colour of 8 bits per channel becomes what a display stores.

pub(crate) mod colour;
#[doc(hidden)]
pub mod dither;
pub mod gamma;
pub mod ramps;

use crate::{
    arch::SATURATES,
    format::{CHANNEL, Intensity, RAMP, WALK},
    pixel::{
        dither::quantise,
        ramps::{InTurn, Ramps, Rounded},
    },
};
use core::hint::black_box;
use embedded_graphics_core::{
    pixelcolor::{
        Bgr565, BinaryColor, Gray2, Gray4, Gray8, PixelColor, Rgb565, Rgb666, Rgb888,
        raw::{RawData, RawU1, RawU2, RawU4, RawU8, RawU16, RawU24},
    },
    prelude::RgbColor,
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// A format that the renderer can draw.
pub trait Pixel: Copy + 'static {
    /// The form in which tables of colours store a pixel.
    type Stored: FromBytes + IntoBytes + Immutable + KnownLayout + Copy + core::fmt::Debug;
    /// The tables of colours of a material: [`InTurn`] where channels have five bits to seven, else [`Rounded`]. Colours of so few bits with
    /// [`Rounded`] are dithered the general way, which takes several times as long.
    type Ramps: Ramps<Self::Stored>;

    /// One channel instead of three.
    const GRAY: bool;
    /// Bits of red, green and blue (or of grey, three times).
    const DEPTH: [u32; 3];
    /// Whether channels have so few bits that light of several channels may be rounded to a level of 1/255 first.
    const COARSE: bool = {
        let [r, g, b] = Self::DEPTH;
        r < 8 && g < 8 && b < 8
    };
    /// Whether steps between levels are so wide that a picture needs dither.
    const DITHERED: bool = Self::DEPTH[2] < 8;
    /// Whether tables of colours hold finer steps than pixels have, so that loops dither what they take from there.
    const DITHERED_BY_TABLE: bool = Self::GRAY && Self::DITHERED && !Self::Ramps::CHECKERED;
    /// Bytes that a pixel adds to the picture's checksum.
    const BYTES: usize;

    /// Packs channel values of [`Self::DEPTH`] bits; a grey format looks at the first.
    fn pack(channels: [u32; 3]) -> Self;

    /// The pixel as tables of colours store it.
    fn stored(self) -> Self::Stored;

    /// The pixel from its stored form.
    fn from_stored(stored: Self::Stored) -> Self;

    /// What tables of colours store of channels in unsigned Q8.8 that are scaled to [`Self::DEPTH`]: a pixel by a [`dither::threshold`], or
    /// something finer where they are [`Self::DITHERED_BY_TABLE`].
    fn tabled(channels: [u32; 3], threshold: u32) -> Self::Stored {
        Self::pack(quantise(channels, Self::DEPTH, threshold).map(u32::from)).stored()
    }

    /// The pixel of what a table of colours holds, with a [`dither::threshold`] where they are [`Self::DITHERED_BY_TABLE`].
    #[inline(always)]
    fn shown(stored: Self::Stored, _threshold: u32) -> Self {
        Self::from_stored(stored)
    }

    /// The pixel twice. Formats of half a word take both from one word, which some processors then store at once.
    #[inline(always)]
    fn pair(self) -> [Self; 2] {
        [self; 2]
    }

    /// The channel values that were packed.
    fn channels(self) -> [u8; 3];

    /// The value that the display is sent, independent of byte order in memory.
    fn bits(self) -> u32;

    /// What a table of colours holds for a level. Levels are biased and have `BITS` fraction bits, rounding half included.
    #[inline(always)]
    fn entry<const BITS: u32>(ramp: &[Self::Stored; RAMP], level: u32) -> Self::Stored {
        ramp[(level >> BITS) as usize % RAMP]
    }

    /// What tables of colours hold for a walked level, see [`Ramps::walked`].
    #[inline(always)]
    fn walked(ramps: &Self::Ramps, level: u32) -> Self::Stored {
        if Self::Ramps::CHECKERED {
            ramps.walked(level)
        } else {
            let [ramp, _] = ramps.squares();
            Self::entry::<WALK>(ramp, level)
        }
    }

    /// The colour of a level, see [`Self::entry`], with a [`dither::threshold`].
    #[inline(always)]
    fn ramped<const BITS: u32>(ramp: &[Self::Stored; RAMP], level: u32, threshold: u32) -> Self {
        Self::shown(Self::entry::<BITS>(ramp, level), threshold)
    }

    /// The colour of an intensity of three channels, by a [`dither::threshold`].
    #[inline(always)]
    fn quantised(intensity: Intensity, threshold: u32) -> Self {
        // A step of a channel is 2^(16 - depth), of which thresholds are 1/128. Armv7-M shifts and clamps by one instruction.
        let more = |depth: u32| (threshold as i32) << (9 - depth);
        let channel = |level: i32, depth: u32| ((level + more(depth)) >> (16 - depth)).clamp(0, (1 << depth) - 1) as u32;
        let ([r, g, b], [dr, dg, db]) = (intensity, Self::DEPTH);
        Self::pack([channel(r, dr), channel(g, dg), channel(b, db)])
    }

    /// The colour of three levels with [`CHANNEL`] fraction bits, what rounds or dithers each channel included.
    #[inline(always)]
    fn mixed([r, g, b]: [i32; 3]) -> Self {
        let shifted = |level: i32, depth: u32| level >> (CHANNEL + 8 - depth);
        let [dr, dg, db] = Self::DEPTH;
        // Where clamping takes several instructions, all channels are asked at once whether one needs it.
        if !SATURATES && ((r | g | b) as u32) < 256 << CHANNEL {
            return Self::pack([shifted(r, dr) as u32, shifted(g, dg) as u32, shifted(b, db) as u32]);
        }
        // Armv7-M shifts and clamps by one instruction.
        let channel = |level: i32, depth: u32| shifted(level, depth).clamp(0, (1 << depth) - 1) as u32;
        Self::pack([channel(r, dr), channel(g, dg), channel(b, db)])
    }
}

/// In each channel as many steps as `by` is of channels of eight bits.
#[inline(always)]
pub(crate) fn steps<C: Pixel>(by: i32) -> [i32; 3] {
    let [r, g, b] = C::DEPTH;
    [by << (8 - r), by << (8 - g), by << (8 - b)]
}

/// Channels of 5, 6 and 5 bits, packed.
#[inline(always)]
fn rgb565([high, middle, low]: [u32; 3]) -> u16 {
    (high << 11 | middle << 5 | low) as u16
}

/// Both halves of a word, each of them `half`; the compiler must not know that they are the same.
#[inline(always)]
fn halves(half: u16) -> [u16; 2] {
    let word = black_box(u32::from(half) * 0x1_0001);
    [word as u16, (word >> 16) as u16]
}

/// Channels of 5, 6 and 5 bits in a word; the numbers are those of the high and of the low one.
macro_rules! rgb565 {
    ($format:ty, $high:literal, $low:literal) => {
        impl Pixel for $format {
            type Stored = u16;
            type Ramps = InTurn<u16>;

            const GRAY: bool = false;
            const DEPTH: [u32; 3] = [5, 6, 5];
            const BYTES: usize = 2;

            #[inline(always)]
            fn pack(channels: [u32; 3]) -> Self {
                RawU16::new(rgb565([channels[$high], channels[1], channels[$low]])).into()
            }

            #[inline(always)]
            fn stored(self) -> u16 {
                RawU16::from(self).into_inner()
            }

            #[inline(always)]
            fn from_stored(stored: u16) -> Self {
                RawU16::new(stored).into()
            }

            #[inline(always)]
            fn pair(self) -> [Self; 2] {
                let [even, odd] = halves(self.stored());
                [Self::from_stored(even), Self::from_stored(odd)]
            }

            fn channels(self) -> [u8; 3] {
                [self.r(), self.g(), self.b()]
            }

            fn bits(self) -> u32 {
                self.stored().into()
            }
        }
    };
}

rgb565!(Rgb565, 0, 2);
rgb565!(Bgr565, 2, 0);

/// Red, green and blue of equal depth.
macro_rules! rgb {
    ($format:ty, $depth:literal, $ramps:ident) => {
        impl Pixel for $format {
            type Stored = u32;
            type Ramps = $ramps<u32>;

            const GRAY: bool = false;
            const DEPTH: [u32; 3] = [$depth; 3];
            const BYTES: usize = 3;

            #[inline(always)]
            fn pack([r, g, b]: [u32; 3]) -> Self {
                RawU24::new(r << (2 * $depth) | g << $depth | b).into()
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
                self.stored()
            }
        }
    };
}

rgb!(Rgb666, 6, InTurn);
rgb!(Rgb888, 8, Rounded);

/// One channel.
macro_rules! gray {
    ($format:ty, $raw:ty, $depth:literal) => {
        impl Pixel for $format {
            type Stored = u8;
            type Ramps = Rounded<u8>;

            const GRAY: bool = true;
            const DEPTH: [u32; 3] = [$depth; 3];
            const BYTES: usize = 1;

            fn tabled([luma, ..]: [u32; 3], threshold: u32) -> u8 {
                if Self::DITHERED_BY_TABLE { dither::finer(luma) } else { quantise([luma; 3], Self::DEPTH, threshold)[0] }
            }

            #[inline(always)]
            fn shown(stored: u8, threshold: u32) -> Self {
                if Self::DITHERED_BY_TABLE {
                    Self::pack([dither::coarser(stored, $depth, threshold); 3])
                } else {
                    Self::from_stored(stored)
                }
            }

            #[inline(always)]
            fn pack([luma, ..]: [u32; 3]) -> Self {
                <$raw>::new(luma as u8).into()
            }

            #[inline(always)]
            fn stored(self) -> u8 {
                <$raw>::from(self).into_inner()
            }

            #[inline(always)]
            fn from_stored(stored: u8) -> Self {
                <$raw>::new(stored).into()
            }

            fn channels(self) -> [u8; 3] {
                [self.stored(); 3]
            }

            fn bits(self) -> u32 {
                self.stored().into()
            }
        }
    };
}

gray!(Gray8, RawU8, 8);
gray!(Gray4, RawU4, 4);
gray!(Gray2, RawU2, 2);
gray!(BinaryColor, RawU1, 1);

/// RGB565 with the high byte first in memory, as serial displays want it: a band can be handed to the bus as it is, without a copy. The
/// order costs nothing, since colours come from tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct Rgb565Be(u16);

impl Rgb565Be {
    /// Black.
    pub const BLACK: Self = Self(0);
}

impl PixelColor for Rgb565Be {
    type Raw = RawU16;
}

impl From<RawU16> for Rgb565Be {
    fn from(raw: RawU16) -> Self {
        Self(raw.into_inner().to_be())
    }
}

impl From<Rgb565Be> for RawU16 {
    fn from(Rgb565Be(bytes): Rgb565Be) -> Self {
        Self::new(u16::from_be(bytes))
    }
}

impl From<Rgb565> for Rgb565Be {
    fn from(color: Rgb565) -> Self {
        RawU16::from(color).into()
    }
}

impl Pixel for Rgb565Be {
    type Stored = Self;
    type Ramps = InTurn<Self>;

    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [5, 6, 5];
    const BYTES: usize = 2;

    #[inline(always)]
    fn pack(channels: [u32; 3]) -> Self {
        Self(rgb565(channels).to_be())
    }

    #[inline(always)]
    fn stored(self) -> Self {
        self
    }

    #[inline(always)]
    fn from_stored(stored: Self) -> Self {
        stored
    }

    #[inline(always)]
    fn pair(self) -> [Self; 2] {
        let [even, odd] = halves(self.0);
        [Self(even), Self(odd)]
    }

    fn channels(self) -> [u8; 3] {
        let bits = u16::from_be(self.0);
        [(bits >> 11) as u8, (bits >> 5 & 0x3F) as u8, (bits & 0x1F) as u8]
    }

    fn bits(self) -> u32 {
        u16::from_be(self.0).into()
    }
}

/// Red and green of three bits, blue of two, in a byte; embedded-graphics has no such format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct Rgb332(u8);

impl Rgb332 {
    /// Black.
    pub const BLACK: Self = Self(0);
}

impl PixelColor for Rgb332 {
    type Raw = RawU8;
}

impl From<RawU8> for Rgb332 {
    fn from(raw: RawU8) -> Self {
        Self(raw.into_inner())
    }
}

impl From<Rgb332> for RawU8 {
    fn from(Rgb332(byte): Rgb332) -> Self {
        Self::new(byte)
    }
}

impl Pixel for Rgb332 {
    type Stored = u8;
    type Ramps = Rounded<u8>;

    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [3, 3, 2];
    const BYTES: usize = 1;

    #[inline(always)]
    fn pack([r, g, b]: [u32; 3]) -> Self {
        Self((r << 5 | g << 2 | b) as u8)
    }

    #[inline(always)]
    fn stored(self) -> u8 {
        self.0
    }

    #[inline(always)]
    fn from_stored(stored: u8) -> Self {
        Self(stored)
    }

    fn channels(self) -> [u8; 3] {
        [self.0 >> 5, self.0 >> 2 & 7, self.0 & 3]
    }

    fn bits(self) -> u32 {
        self.0.into()
    }
}

/// Checksum of a picture: CRC-32 over the pixels' values, low byte first, row by row from the top.
#[derive(Clone)]
pub struct PictureCrc {
    digest: crc::Digest<'static, u32, crc::Table<1>>,
    bytes: usize,
}

/// A table of one kilobyte, since a picture is checked every frame.
static PICTURE: crc::Crc<u32, crc::Table<1>> = crc::Crc::<u32, crc::Table<1>>::new(&crc::CRC_32_ISO_HDLC);

impl Default for PictureCrc {
    fn default() -> Self {
        Self { digest: PICTURE.digest(), bytes: 0 }
    }
}

impl PictureCrc {
    /// The checksum of pixels that follow others, which are summed up elsewhere: see [`Self::append`].
    #[must_use]
    pub fn of_rest() -> Self {
        Self { digest: PICTURE.digest_with_initial(0), bytes: 0 }
    }

    /// Adds the next pixels.
    pub fn update<C: Pixel>(&mut self, pixels: &[C]) {
        for pixel in pixels {
            let bytes = pixel.bits().to_le_bytes();
            self.digest.update(&bytes[..C::BYTES]);
        }
        self.bytes += pixels.len() * C::BYTES;
    }

    /// Adds the pixels of a sum that began as [`Self::of_rest`].
    pub fn append(&mut self, rest: Self) {
        // A checksum is linear: that of all bytes is that of the first ones, followed by zeros, plus that of the rest that follows zeros.
        (0..rest.bytes).for_each(|_| self.digest.update(&[0]));
        let register = self.clone().finish() ^ rest.digest.finalize();
        self.digest = PICTURE.digest_with_initial(register.reverse_bits());
        self.bytes += rest.bytes;
    }

    /// The checksum of all pixels so far.
    #[must_use]
    pub fn finish(self) -> u32 {
        self.digest.finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_of_two_parts_make_that_of_the_whole() {
        let pixels: [Rgb565Be; 100] = core::array::from_fn(|i| Rgb565Be(i as u16 * 641));
        let mut whole = PictureCrc::default();
        whole.update(&pixels);
        for divided in [0, 1, 50, 99, 100] {
            let (mut first, mut rest) = (PictureCrc::default(), PictureCrc::of_rest());
            first.update(&pixels[..divided]);
            rest.update(&pixels[divided..90.max(divided)]);
            first.append(rest);
            // It can go on.
            first.update(&pixels[90.max(divided)..]);
            assert_eq!(first.finish(), whole.clone().finish(), "divided at {divided}");
        }
    }
}
