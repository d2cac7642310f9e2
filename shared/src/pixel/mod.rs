//! Pixel formats: how a colour with 8 bits per channel is converted to the value that a display stores.

#[doc(hidden)]
pub mod by_rows;
pub(crate) mod colour;
#[doc(hidden)]
pub mod dither;
#[doc(hidden)]
pub mod gamma;
mod light;
#[doc(hidden)]
pub mod ramps;

#[doc(inline)]
pub use gamma::{Gamma, SRGB};
#[doc(inline)]
pub use light::{FromDrawn, Light, LightGray, Output, Pixels};
#[doc(inline)]
pub use ramps::{InTurn, Rounded};

use crate::{
    arch::SATURATES,
    format::{CHANNEL, ErrorBudget, Intensity, RAMP, WALK},
    pixel::{dither::quantise, ramps::Ramps},
};
use core::hint::black_box;
use embedded_graphics_core::{
    pixelcolor::{
        Bgr565, BinaryColor, Gray2, Gray4, Gray8, PixelColor, Rgb565, Rgb666, Rgb888,
        raw::{RawData, RawU1, RawU2, RawU4, RawU8, RawU16, RawU24},
    },
    prelude::RgbColor,
};
use microphong_kernels as kernels;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, transmute_mut, transmute_ref};

/// A format in which a display stores pixels. It is implemented for the colours of embedded-graphics (for example `Rgb565`, `Gray4`,
/// `BinaryColor`) and for [`Rgb565Be`] and [`Rgb332`].
pub trait PixelFormat: Copy + 'static {
    /// Whether the format has one channel (grey) instead of three.
    const GRAY: bool;
    /// The number of bits of red, green and blue, each 1 to 8. A grey format gives its number of bits three times.
    const DEPTH: [u32; 3];
    /// The number of bytes of a pixel that [`PictureCrc`] adds to the checksum of a picture: 1 to 4.
    const BYTES: usize;

    /// Creates a pixel from red, green and blue, each of as many bits as [`Self::DEPTH`] says. A grey format uses the first number.
    fn pack(channels: [u32; 3]) -> Self;

    /// Returns red, green and blue, each of as many bits as [`Self::DEPTH`] says. A grey format returns its value three times.
    fn channels(self) -> [u8; 3];

    /// Returns the value of the pixel as an integer, independent of the order of its bytes in memory. [`PictureCrc`] uses it.
    fn bits(self) -> u32;
}

/// A pixel that the renderer draws: a pixel of the display, such as `Rgb565` or `Gray8`, or [`Light`], from which a pass over the finished
/// band makes pixels of the display. Implement it for a colour type of your own to draw another format directly.
pub trait Pixel: PixelFormat {
    /// The type of a pixel in the tables that map light levels to colours: often the raw integer of the pixel, such as `u16` for RGB565.
    type Stored: FromBytes + IntoBytes + Immutable + KnownLayout + Copy + core::fmt::Debug;
    /// The tables that map light levels to colours. Choose [`InTurn`] if channels have five to seven bits: they are dithered by two tables that
    /// alternate. Choose [`Rounded`] otherwise.
    type Ramps: Ramps<Self::Stored>;

    /// Whether channels have so few bits that the light of several channels may be rounded to a level of 1/255 first.
    #[doc(hidden)]
    const COARSE: bool = {
        let [r, g, b] = Self::DEPTH;
        r < 8 && g < 8 && b < 8
    };
    /// The error budget of [`Shader::AUTO`](crate::Shader::AUTO) where neither the stream nor [`set_budget`](crate::Renderer::set_budget) states one, in
    /// units of 1/255 of full intensity. It is 1 for channels of eight bits, 4 for channels of five to seven bits, and 8 for fewer. The steps of such
    /// displays are 1, 2 to 8, and 17 to 255 of 255, so that they cannot show a smaller error.
    const BUDGET: ErrorBudget = {
        let [r, g, b] = Self::DEPTH;
        let steps = if r >= 8 || g >= 8 || b >= 8 {
            1
        } else if r >= 5 || g >= 5 || b >= 5 {
            4
        } else {
            8
        };
        ErrorBudget::from_bits(steps << ErrorBudget::FRAC_NBITS)
    };
    /// The number of bits of each channel to which levels of light are scaled and rounded.
    #[doc(hidden)]
    const LEVELS: [u32; 3] = Self::DEPTH;
    /// Whether a pass makes pixels of the display of this pixel, with dither and the curve of the display. All colours are linear until then.
    #[doc(hidden)]
    const IS_LIGHT: bool = false;

    /// Converts the pixel to [`Self::Stored`], the form in which the tables of a material keep the colour for each light level ([`Self::Ramps`]).
    fn stored(self) -> Self::Stored;

    /// Converts a colour from the tables of a material, [`Self::Stored`], back to a pixel.
    fn from_stored(stored: Self::Stored) -> Self;

    /// The entry of a table of colours: the pixel of channels in unsigned Q8.8 that are scaled to [`Self::LEVELS`], by a
    /// [`dither::threshold`].
    #[doc(hidden)]
    fn tabled(channels: [u32; 3], threshold: u32) -> Self::Stored {
        Self::pack(quantise(channels, Self::DEPTH, threshold).map(u32::from)).stored()
    }

    /// The pixel twice. A format of two bytes takes both from one word, so that some processors can store them at once.
    #[doc(hidden)]
    #[inline]
    fn pair(self) -> [Self; 2] {
        [self; 2]
    }

    /// Two colours with the green of the other.
    #[doc(hidden)]
    fn greens_exchanged([even, odd]: [Self::Stored; 2]) -> [Self::Stored; 2] {
        let ([r, g, b], [odd_r, odd_g, odd_b]) = (Self::from_stored(even).channels(), Self::from_stored(odd).channels());
        let packed = |r: u8, g: u8, b: u8| Self::pack([r.into(), g.into(), b.into()]).stored();
        [packed(r, odd_g, b), packed(odd_r, g, odd_b)]
    }

    /// Mixes the pixel with `share / 128` of `other`; for antialiasing and transparent surfaces. A pixel of light needs the curve of the display for it.
    #[doc(hidden)]
    fn mixed_with(self, other: Self, share: u32, _: Option<&'static Gamma>) -> Self {
        let mixed = |own: u8, other: u8| ((u32::from(own) * (128 - share) + u32::from(other) * share + 64) >> 7) as u8;
        let ([r, g, b], [red, green, blue]) = (self.to_mix(), other.to_mix());
        Self::mixed_from([mixed(r, red), mixed(g, green), mixed(b, blue)])
    }

    /// The channels of the pixel as antialiasing mixes them, at most eight bits each.
    #[doc(hidden)]
    fn to_mix(self) -> [u8; 3] {
        self.channels()
    }

    /// The channels, for [`Self::mixed_from`], of a colour in unsigned Q8.8 that is scaled to [`Self::LEVELS`].
    #[doc(hidden)]
    fn quantised_to_mix(channels: [u32; 3], threshold: u32) -> [u8; 3] {
        quantise(channels, Self::DEPTH, threshold)
    }

    /// The pixel of channels that antialiasing has mixed, see [`Self::to_mix`].
    #[doc(hidden)]
    fn mixed_from(channels: [u8; 3]) -> Self {
        Self::pack(channels.map(u32::from))
    }

    /// Looks up a level in a table of colours. Levels have a bias and `bits` fraction bits, and include half a step for rounding.
    #[doc(hidden)]
    #[inline]
    fn entry(ramp: &[Self::Stored; RAMP], level: u32, bits: u32) -> Self::Stored {
        ramp[(level >> (bits & 31)) as usize % RAMP]
    }

    /// Looks up a walked level in tables of colours, see [`Ramps::walked`].
    #[doc(hidden)]
    #[inline]
    fn walked(ramps: &Self::Ramps, level: u32) -> Self::Stored {
        if Self::Ramps::CHECKERED {
            ramps.walked(level)
        } else {
            let [ramp, _] = ramps.squares();
            Self::entry(ramp, level, WALK)
        }
    }

    /// The colour of a level, see [`Self::entry`].
    #[doc(hidden)]
    #[inline]
    fn ramped(ramp: &[Self::Stored; RAMP], level: u32, bits: u32) -> Self {
        Self::from_stored(Self::entry(ramp, level, bits))
    }

    /// The colour of three intensities, by a [`dither::threshold`].
    #[doc(hidden)]
    #[inline]
    fn quantised(intensity: Intensity, threshold: u32) -> Self {
        // A step of a channel is 2^(16 - depth), of which thresholds are 1/128. Armv7-M shifts and clamps by one instruction.
        let more = |depth: u32| (threshold as i32) << (9 - depth);
        let channel = |level: i32, depth: u32| ((level + more(depth)) >> (16 - depth)).clamp(0, (1 << depth) - 1) as u32;
        let ([r, g, b], [dr, dg, db]) = (intensity, Self::DEPTH);
        Self::pack([channel(r, dr), channel(g, dg), channel(b, db)])
    }

    /// The colour of three levels with [`CHANNEL`] fraction bits. Half a step for rounding, or the dither, has been added to each.
    #[doc(hidden)]
    #[inline]
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

    /// Whether kernels in assembler draw this format on this processor.
    #[doc(hidden)]
    const HAS_KERNELS: bool = false;

    /// A table of colours as a kernel reads it.
    #[doc(hidden)]
    #[inline]
    fn entries(_: &[Self::Stored; RAMP]) -> Option<kernels::Entries<'_>> {
        None
    }

    /// The kernel that computes light at each pixel, see [`kernels::Lit::new`].
    #[doc(hidden)]
    #[inline]
    fn lit<'a>(_: kernels::Colours<'a>, _highlights: usize, _: kernels::Lookup<'a>) -> Option<kernels::Lit<'a>> {
        None
    }

    /// Fills rows by this kernel, see [`kernels::Lit::fill`].
    #[doc(hidden)]
    #[inline]
    fn fill_lit(
        _: &mut [Self],
        _: kernels::Rows<'_>,
        _depth: &mut kernels::Plane,
        _: &mut kernels::Fields<'_>,
        _: &kernels::Lit<'_>,
    ) -> Option<u32> {
        None
    }

    /// Fills rows by a level and tables of colours, see [`kernels::ramp`].
    #[doc(hidden)]
    #[inline]
    fn fill_ramp(
        _: &mut [Self],
        _: kernels::Rows<'_>,
        _depth: Option<&mut kernels::Plane>,
        _level: &mut kernels::Plane,
        _: &Self::Ramps,
    ) -> Option<u32> {
        None
    }

    /// Fills rows by two colours in turn, see [`kernels::solid`].
    #[doc(hidden)]
    #[inline]
    fn fill_solid(_: &mut [Self], _: kernels::Rows<'_>, _depth: Option<&mut kernels::Plane>, _: [Self::Stored; 2]) -> Option<u32> {
        None
    }

    /// Fills rows by three levels with [`CHANNEL`] fraction bits, see [`kernels::channels`].
    #[doc(hidden)]
    #[inline]
    fn fill_channels(
        _: &mut [Self],
        _: kernels::Rows<'_>,
        _depth: &mut kernels::Plane,
        _levels: &mut [kernels::Plane; 3],
        _raise: i32,
    ) -> Option<u32> {
        None
    }
}

/// What of a [`Pixel`] is the same for all formats that kernels draw: the type of a number, the number of tables of colours, what makes numbers of pixels and
/// of an entry of a table, and what evaluates an expression in which `FORMAT` is the format.
macro_rules! drawn_by_kernels {
    ($type:ident, $tables:literal, $numbers:expr, $number:expr, $for_format:ident $(, $format:expr)?) => {
        const HAS_KERNELS: bool = $for_format!(FORMAT, $($format,)? Some(FORMAT)).is_some()
            && if size_of::<$type>() == 2 { kernels::AVAILABLE } else { kernels::WORDS_AVAILABLE };

        #[inline]
        fn entries(ramp: &[Self::Stored; $crate::format::RAMP]) -> Option<kernels::Entries<'_>> {
            let numbers: &[$type; $crate::format::RAMP] = transmute_ref!(ramp);
            Some(numbers.into())
        }

        // Where it is called, the compiler knows the colours, and leaves out all other kernels.
        #[inline(always)]
        fn lit<'a>(colours: kernels::Colours<'a>, highlights: usize, lookup: kernels::Lookup<'a>) -> Option<kernels::Lit<'a>> {
            $for_format!(FORMAT, $($format,)? kernels::Lit::new::<FORMAT>(colours, highlights, lookup))
        }

        #[inline]
        fn fill_lit(
            pixels: &mut [Self],
            rows: kernels::Rows<'_>,
            depth: &mut kernels::Plane,
            fields: &mut kernels::Fields<'_>,
            lit: &kernels::Lit<'_>,
        ) -> Option<u32> {
            Some(lit.fill($numbers(pixels), rows, depth, fields))
        }

        #[inline(always)]
        fn fill_ramp(
            pixels: &mut [Self],
            rows: kernels::Rows<'_>,
            depth: Option<&mut kernels::Plane>,
            level: &mut kernels::Plane,
            ramps: &Self::Ramps,
        ) -> Option<u32> {
            let colours: &[$type; $tables * $crate::format::RAMP] = transmute_ref!(ramps);
            kernels::ramp($numbers(pixels), rows, depth, level, colours)
        }

        #[inline(always)]
        fn fill_solid(
            pixels: &mut [Self],
            rows: kernels::Rows<'_>,
            depth: Option<&mut kernels::Plane>,
            colours: [Self::Stored; 2],
        ) -> Option<u32> {
            let [first, second] = colours;
            kernels::solid($numbers(pixels), rows, depth, [$number(first), $number(second)])
        }

        #[inline(always)]
        fn fill_channels(
            pixels: &mut [Self],
            rows: kernels::Rows<'_>,
            depth: &mut kernels::Plane,
            levels: &mut [kernels::Plane; 3],
            raise: i32,
        ) -> Option<u32> {
            $for_format!(FORMAT, $($format,)? kernels::channels::<FORMAT, $type>($numbers(pixels), rows, depth, levels, raise))
        }
    };
}
pub(crate) use drawn_by_kernels;

/// Evaluates an expression in which a name is this format.
macro_rules! for_format {
    ($name:ident, $format:expr, $expression:expr) => {{
        const $name: u32 = $format;
        $expression
    }};
}

/// Half a step of a channel of `bits` bits, as a level with [`CHANNEL`] fraction bits.
#[inline]
pub(crate) const fn half_step(bits: u32) -> i32 {
    1 << (CHANNEL + 7 - bits)
}

/// Properties of a pixel format, for code that is compiled once for all formats.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Channels {
    /// [`Pixel::LEVELS`].
    pub depth: [u32; 3],
    /// [`PixelFormat::GRAY`].
    pub is_gray: bool,
    /// [`Pixel::COARSE`].
    pub is_coarse: bool,
    /// [`Ramps::CHECKERED`].
    pub is_checkered: bool,
}

impl Channels {
    /// The properties of the pixel format `C`.
    #[must_use]
    pub const fn of<C: Pixel>() -> Self {
        Self { depth: C::LEVELS, is_gray: C::GRAY, is_coarse: C::COARSE, is_checkered: C::Ramps::CHECKERED }
    }
}

/// Multiplies `by` by the step of a channel of each of these depths, relative to the step of a channel of eight bits.
#[inline]
pub(crate) fn steps([r, g, b]: [u32; 3], by: i32) -> [i32; 3] {
    [by << (8 - r), by << (8 - g), by << (8 - b)]
}

/// Channels of 5, 6 and 5 bits, packed.
#[inline]
fn rgb565([high, middle, low]: [u32; 3]) -> u16 {
    (high << 11 | middle << 5 | low) as u16
}

/// Green in RGB565.
const GREEN: u16 = 0x3F << 5;

/// Two numbers with the bits of `mask` of the other.
#[inline]
fn exchanged([a, b]: [u16; 2], mask: u16) -> [u16; 2] {
    let differing = (a ^ b) & mask;
    [a ^ differing, b ^ differing]
}

/// Mixes a colour of 5, 6 and 5 bits with `share / 128` of another one, rounded to the nearest.
#[inline]
fn mixed_rgb565(own: u16, other: u16, share: u32) -> u16 {
    // Red, green and blue in one word, with five bits between them.
    const CHANNELS: u32 = 0x07E0_F81F;
    let spread = |colour: u16| (u32::from(colour) | u32::from(colour) << 16) & CHANNELS;
    let (own, other) = (spread(own), spread(other));
    let half = 1 << 4 | 1 << 15 | 1 << 25;
    let sum = (own << 5).wrapping_add(other.wrapping_sub(own).wrapping_mul((share + 2) >> 2)).wrapping_add(half) >> 5 & CHANNELS;
    (sum | sum >> 16) as u16
}

/// Both halves of a word, each of them `half`; the compiler must not know that they are the same.
#[inline]
fn halves(half: u16) -> [u16; 2] {
    let word = black_box(u32::from(half) * 0x1_0001);
    [word as u16, (word >> 16) as u16]
}

/// Channels of 5, 6 and 5 bits in a word; the numbers are those of the high and of the low one.
macro_rules! rgb565 {
    ($format:ty, $order:expr, $high:literal, $low:literal) => {
        impl PixelFormat for $format {
            const GRAY: bool = false;
            const DEPTH: [u32; 3] = [5, 6, 5];
            const BYTES: usize = 2;

            #[inline]
            fn pack(channels: [u32; 3]) -> Self {
                RawU16::new(rgb565([channels[$high], channels[1], channels[$low]])).into()
            }

            fn channels(self) -> [u8; 3] {
                [self.r(), self.g(), self.b()]
            }

            fn bits(self) -> u32 {
                self.stored().into()
            }
        }

        impl Pixel for $format {
            type Stored = u16;
            type Ramps = InTurn<u16>;

            #[inline]
            fn stored(self) -> u16 {
                RawU16::from(self).into_inner()
            }

            #[inline]
            fn from_stored(stored: u16) -> Self {
                RawU16::new(stored).into()
            }

            #[inline]
            fn greens_exchanged(colours: [u16; 2]) -> [u16; 2] {
                exchanged(colours, GREEN)
            }

            #[inline]
            fn pair(self) -> [Self; 2] {
                let [even, odd] = halves(self.stored());
                [Self::from_stored(even), Self::from_stored(odd)]
            }

            #[inline]
            fn mixed_with(self, other: Self, share: u32, _: Option<&'static Gamma>) -> Self {
                Self::from_stored(mixed_rgb565(self.stored(), other.stored(), share))
            }

            drawn_by_kernels!(u16, 2, kernels::numbers, u32::from, for_format, kernels::format($order, [5, 6, 5]));
        }
    };
}

rgb565!(Rgb565, kernels::Order::Rgb, 0, 2);
rgb565!(Bgr565, kernels::Order::Bgr, 2, 0);

/// Red, green and blue of equal depth.
macro_rules! rgb {
    ($format:ty, $depth:literal, $ramps:ident, $tables:literal) => {
        impl PixelFormat for $format {
            const GRAY: bool = false;
            const DEPTH: [u32; 3] = [$depth; 3];
            const BYTES: usize = 3;

            #[inline]
            fn pack([r, g, b]: [u32; 3]) -> Self {
                RawU24::new(r << (2 * $depth) | g << $depth | b).into()
            }

            fn channels(self) -> [u8; 3] {
                [self.r(), self.g(), self.b()]
            }

            fn bits(self) -> u32 {
                self.stored()
            }
        }

        impl Pixel for $format {
            type Stored = u32;
            type Ramps = $ramps<u32>;

            #[inline]
            fn stored(self) -> u32 {
                RawU24::from(self).into_inner()
            }

            #[inline]
            fn from_stored(stored: u32) -> Self {
                RawU24::new(stored).into()
            }

            drawn_by_kernels!(u32, $tables, kernels::numbers, u32::from, for_format, kernels::format(kernels::Order::Rgb, [$depth; 3]));
        }
    };
}

rgb!(Rgb666, 6, InTurn, 2);
rgb!(Rgb888, 8, Rounded, 1);

/// One channel.
macro_rules! gray {
    ($format:ty, $raw:ty, $depth:literal) => {
        impl PixelFormat for $format {
            const GRAY: bool = true;
            const DEPTH: [u32; 3] = [$depth; 3];
            const BYTES: usize = 1;

            #[inline]
            fn pack([luma, ..]: [u32; 3]) -> Self {
                <$raw>::new(luma as u8).into()
            }

            fn channels(self) -> [u8; 3] {
                [<$raw>::from(self).into_inner(); 3]
            }

            fn bits(self) -> u32 {
                <$raw>::from(self).into_inner().into()
            }
        }
    };
}

gray!(Gray8, RawU8, 8);
gray!(Gray4, RawU4, 4);
gray!(Gray2, RawU2, 2);
gray!(BinaryColor, RawU1, 1);

impl Pixel for Gray8 {
    type Stored = u8;
    type Ramps = Rounded<u8>;

    #[inline]
    fn stored(self) -> u8 {
        RawU8::from(self).into_inner()
    }

    #[inline]
    fn from_stored(stored: u8) -> Self {
        RawU8::new(stored).into()
    }
}

/// A pixel in the format RGB565 with the high byte first in memory, as displays on a serial bus expect it. The bytes of a band can be sent
/// without conversion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct Rgb565Be(u16);

impl Rgb565Be {
    /// Black, for example to fill a pixel buffer.
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

/// The pixels as numbers.
#[inline]
fn numbers(pixels: &mut [Rgb565Be]) -> &mut [u16] {
    transmute_mut!(pixels)
}

impl PixelFormat for Rgb565Be {
    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [5, 6, 5];
    const BYTES: usize = 2;

    #[inline]
    fn pack(channels: [u32; 3]) -> Self {
        Self(rgb565(channels).to_be())
    }

    fn channels(self) -> [u8; 3] {
        let bits = u16::from_be(self.0);
        [(bits >> 11) as u8, (bits >> 5 & 0x3F) as u8, (bits & 0x1F) as u8]
    }

    fn bits(self) -> u32 {
        u16::from_be(self.0).into()
    }
}

impl Pixel for Rgb565Be {
    type Stored = Self;
    type Ramps = InTurn<Self>;

    #[inline]
    fn stored(self) -> Self {
        self
    }

    #[inline]
    fn from_stored(stored: Self) -> Self {
        stored
    }

    #[inline]
    fn greens_exchanged([even, odd]: [Self; 2]) -> [Self; 2] {
        let [even, odd] = exchanged([even.0, odd.0], GREEN.to_be());
        [Self(even), Self(odd)]
    }

    #[inline]
    fn pair(self) -> [Self; 2] {
        let [even, odd] = halves(self.0);
        [Self(even), Self(odd)]
    }

    #[inline]
    fn mixed_with(self, other: Self, share: u32, _: Option<&'static Gamma>) -> Self {
        Self(mixed_rgb565(u16::from_be(self.0), u16::from_be(other.0), share).to_be())
    }

    drawn_by_kernels!(
        u16,
        2,
        numbers,
        |Self(number): Self| u32::from(number),
        for_format,
        kernels::format(kernels::Order::Swapped, [5, 6, 5])
    );
}

/// A pixel of one byte: three bits of red, three bits of green and two bits of blue. Embedded-graphics has no such format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct Rgb332(u8);

impl Rgb332 {
    /// Black, for example to fill a pixel buffer.
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

impl PixelFormat for Rgb332 {
    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [3, 3, 2];
    const BYTES: usize = 1;

    #[inline]
    fn pack([r, g, b]: [u32; 3]) -> Self {
        Self((r << 5 | g << 2 | b) as u8)
    }

    fn channels(self) -> [u8; 3] {
        [self.0 >> 5, self.0 >> 2 & 7, self.0 & 3]
    }

    fn bits(self) -> u32 {
        self.0.into()
    }
}

/// A checksum (CRC-32) of a picture: add its pixels row by row from the top. Two programs can compare what they drew without sending the
/// picture. `PictureCrc::default()` begins one.
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
    /// Begins the checksum of the lower part of a picture, for example on a second processor. [`Self::append`] joins it to that of the
    /// upper part.
    #[must_use]
    pub fn of_rest() -> Self {
        Self { digest: PICTURE.digest_with_initial(0), bytes: 0 }
    }

    /// Adds the next pixels of the picture, of format `C`.
    pub fn update<C: PixelFormat>(&mut self, pixels: &[C]) {
        for pixel in pixels {
            let bytes = pixel.bits().to_le_bytes();
            self.digest.update(&bytes[..C::BYTES]);
        }
        self.bytes += pixels.len() * C::BYTES;
    }

    /// Appends the checksum of the lower part of a picture, which began with [`Self::of_rest`], to this checksum of the upper part.
    pub fn append(&mut self, rest: Self) {
        // A checksum is linear: that of all bytes is that of the first ones, followed by zeros, plus that of the rest that follows zeros.
        (0..rest.bytes).for_each(|_| self.digest.update(&[0]));
        let register = self.clone().finish() ^ rest.digest.finalize();
        self.digest = PICTURE.digest_with_initial(register.reverse_bits());
        self.bytes += rest.bytes;
    }

    /// Returns the checksum of all pixels that were added.
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
