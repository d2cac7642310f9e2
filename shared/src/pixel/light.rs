//! Light: pixels that are finer than a display can show, and the pass over a finished band that makes pixels of the display of them.
//!
//! A pixel of colour is a word with nine bits of each channel, a grey is a byte. They are scaled so that the upper bits are the display's channel, and
//! full light has zeros below it. The pass adds a threshold of less than a step of the display to each channel and takes the upper bits. So a colour
//! that the display can show exactly stays as it is, and nothing overflows.
//!
//! Colours that are drawn are rounded up by half a level of 1/255, so that the largest level, 255, becomes full when it is scaled to the display.
//! Thresholds are smaller by as much, so that black stays black.

use crate::{
    arch::SATURATES,
    format::{CHANNEL, Intensity},
    pixel::{
        Pixel, PixelFormat, Rgb332, Rgb565Be,
        dither::{HALF, threshold},
        drawn_by_kernels,
        gamma::{Gamma, LIGHT_BITS as BITS},
        ramps::Rounded,
    },
};
use core::{fmt, marker::PhantomData, slice};
use embedded_graphics_core::{
    pixelcolor::{
        Bgr565, BinaryColor, Gray2, Gray4, PixelColor, Rgb565, Rgb666, Rgb888,
        raw::{RawData, RawU8, RawU32},
    },
    primitives::Rectangle,
};
use microphong_kernels as kernels;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, transmute_mut, transmute_ref};

/// Largest value of a channel before it is scaled to the display.
const MAX: u32 = (1 << BITS) - 1;
/// The lowest bits of red, green and blue in a word. Their order and distance are such that one shift takes red and blue to their places in RGB565.
const LOWEST: [u32; 3] = [11, 20, 0];
/// This bit marks colours that are sent as they are, without the curve of the display.
const IS_FINAL: u32 = 1 << 31;

#[inline]
const fn word([r, g, b]: [u32; 3]) -> u32 {
    r << LOWEST[0] | g << LOWEST[1] | b << LOWEST[2]
}

/// Evaluates an expression in which a name is the format of light for a display. There are kernels for light of which [`Output`] makes pixels.
macro_rules! for_shown {
    ($name:ident, $shown:expr, $expression:expr) => {
        for_shown!($name, $shown, $expression, [5, 6, 5] [6, 6, 6] [8, 8, 8] [3, 3, 2])
    };
    ($name:ident, $shown:expr, $expression:expr, $($bits:tt)*) => {
        match $shown {
            $($bits => {
                const $name: u32 = kernels::format(kernels::Order::Light, $bits);
                $expression
            })*
            _ => None,
        }
    };
}

/// A pixel of light for a display with `R` bits of red, `G` bits of green and `B` bits of blue. It is finer than a pixel of the display. A pass
/// over the finished band, [`Output`], makes pixels of the display, with 8x8 ordered dither and the curve of the display. A program that draws
/// light shows smoother colours than a program that draws pixels of the display directly, and takes 7 to 11 instructions more for each pixel of
/// the picture on a Cortex-M3.
#[derive(Clone, Copy, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct Light<const R: u32, const G: u32, const B: u32>(u32);

impl<const R: u32, const G: u32, const B: u32> fmt::Debug for Light<R, G, B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Light").field(&self.fine()).finish()
    }
}

impl<const R: u32, const G: u32, const B: u32> Light<R, G, B> {
    /// Black, for example to fill a pixel buffer.
    pub const BLACK: Self = Self(IS_FINAL);

    /// Bits of each channel below those that the display shows.
    const BELOW: [u32; 3] = [BITS - R, BITS - G, BITS - B];

    /// The thresholds of each row, twice side by side, so that eight follow one another from each column on.
    const THRESHOLDS: [[u32; 16]; 8] = {
        let mut thresholds = [[0; 16]; 8];
        let mut place = 0;
        while place < 128 {
            thresholds[place / 16][place % 16] = Self::scaled(threshold(place % 8, place / 16));
            place += 1;
        }
        thresholds
    };
    /// The thresholds that round, in each row.
    const HALVES: [u32; 16] = [Self::scaled(HALF); 16];

    /// A [`threshold`] in each channel, at most a step of light less than what takes zero to the first step of the display.
    const fn scaled(threshold: u32) -> u32 {
        let [r, g, b] = Self::BELOW;
        word([(threshold * ((1 << r) - 1)) >> 7, (threshold * ((1 << g) - 1)) >> 7, (threshold * ((1 << b) - 1)) >> 7])
    }

    /// The channels.
    const fn fine(self) -> [u32; 3] {
        [self.0 >> LOWEST[0] & MAX, self.0 >> LOWEST[1] & MAX, self.0 >> LOWEST[2] & MAX]
    }

    /// The channels as the display shows them, after a threshold was added.
    #[inline]
    const fn upper(word: u32) -> [u32; 3] {
        let [r, g, b] = Self(word).fine();
        [r >> Self::BELOW[0], g >> Self::BELOW[1], b >> Self::BELOW[2]]
    }

    /// The pixel of channels of at most [`MAX`], scaled to the display.
    fn scaled_to_display([r, g, b]: [u32; 3]) -> Self {
        Self(word([r - (r >> R), g - (g >> G), b - (b >> B)]))
    }

    /// The pixel corrected by the curve of a display.
    #[inline]
    fn curved(self, gamma: &Gamma) -> Self {
        if self.0 & IS_FINAL != 0 {
            return self;
        }
        let [r, g, b] = self.fine();
        let curved = |channel: u32, depth: u32| u32::from(gamma.light(depth)[channel as usize]) << (BITS - 8);
        Self(word([curved(r, R), curved(g, G), curved(b, B)]))
    }

    /// The pixel of levels of 1/255 with `fraction` fraction bits, which include half a level.
    #[inline]
    fn of_levels([r, g, b]: [i32; 3], fraction: u32) -> Self {
        let channel = |level: i32| (level >> (fraction + 8 - BITS)).clamp(0, MAX as i32) as u32;
        Self::scaled_to_display([channel(r), channel(g), channel(b)])
    }
}

/// The pixels as numbers.
#[inline]
fn numbers<const R: u32, const G: u32, const B: u32>(pixels: &mut [Light<R, G, B>]) -> &mut [u32] {
    transmute_mut!(pixels)
}

impl<const R: u32, const G: u32, const B: u32> PixelColor for Light<R, G, B> {
    type Raw = RawU32;
}

impl<const R: u32, const G: u32, const B: u32> From<RawU32> for Light<R, G, B> {
    fn from(raw: RawU32) -> Self {
        Self(raw.into_inner())
    }
}

impl<const R: u32, const G: u32, const B: u32> PixelFormat for Light<R, G, B> {
    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [R, G, B];
    const BYTES: usize = 4;

    fn pack([r, g, b]: [u32; 3]) -> Self {
        let [below_r, below_g, below_b] = Self::BELOW;
        Self(word([r << below_r, g << below_g, b << below_b]) | IS_FINAL)
    }

    fn channels(self) -> [u8; 3] {
        Self::upper(self.0).map(|channel| channel as u8)
    }

    fn bits(self) -> u32 {
        self.0
    }
}

impl<const R: u32, const G: u32, const B: u32> Pixel for Light<R, G, B> {
    type Stored = u32;
    type Ramps = Rounded<u32>;

    const LEVELS: [u32; 3] = [8; 3];
    const IS_LIGHT: bool = true;

    fn stored(self) -> u32 {
        self.0
    }

    fn from_stored(stored: u32) -> Self {
        Self(stored)
    }

    fn tabled(channels: [u32; 3], _: u32) -> u32 {
        Self::of_levels(channels.map(|channel| channel as i32 + (1 << 7)), 8).0
    }

    #[inline]
    fn quantised(intensity: Intensity, _: u32) -> Self {
        let [r, g, b] = intensity;
        Self::of_levels([r + (1 << 7), g + (1 << 7), b + (1 << 7)], 8)
    }

    #[inline]
    fn mixed([r, g, b]: [i32; 3]) -> Self {
        // Where clamping takes several instructions, all channels are asked at once whether one needs it.
        if !SATURATES && ((r | g | b) as u32) < 256 << CHANNEL {
            let channel = |level: i32| (level >> (CHANNEL + 8 - BITS)) as u32;
            return Self::scaled_to_display([channel(r), channel(g), channel(b)]);
        }
        Self::of_levels([r, g, b], CHANNEL)
    }

    fn mixed_with(self, other: Self, share: u32, gamma: Option<&'static Gamma>) -> Self {
        // Where only one of both has been corrected by the curve of the display, the other one is corrected here.
        let are_unlike = (self.0 ^ other.0) & IS_FINAL != 0;
        let [own, other] =
            [self, other].map(|light| if let Some(gamma) = gamma.filter(|_| are_unlike) { light.curved(gamma) } else { light });
        let mixed = |own: u32, other: u32| (own * (128 - share) + other * share + 64) >> 7;
        let ([r, g, b], [red, green, blue]) = (own.fine(), other.fine());
        Self(word([mixed(r, red), mixed(g, green), mixed(b, blue)]) | (self.0 | other.0) & IS_FINAL)
    }

    fn to_mix(self) -> [u8; 3] {
        self.fine().map(|channel| (channel >> (BITS - 8)) as u8)
    }

    fn quantised_to_mix(channels: [u32; 3], _: u32) -> [u8; 3] {
        Self(Self::tabled(channels, HALF)).to_mix()
    }

    /// Mixed pixels have been corrected by the curve of the display before.
    fn mixed_from(channels: [u8; 3]) -> Self {
        Self(word(channels.map(|channel| u32::from(channel) << (BITS - 8))) | IS_FINAL)
    }

    drawn_by_kernels!(u32, 1, numbers, u32::from, for_shown, [R, G, B]);
}

// Loops in Rust draw light for displays with other bits, of which there are no kernels.
const _: () = assert!(Light::<5, 6, 5>::HAS_KERNELS == kernels::WORDS_AVAILABLE && !Light::<4, 4, 4>::HAS_KERNELS);

/// A pixel of grey light for a display with `DEPTH` bits of grey, less than eight. See [`Light`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct LightGray<const DEPTH: u32>(u8);

impl<const DEPTH: u32> LightGray<DEPTH> {
    /// Black, for example to fill a pixel buffer.
    pub const BLACK: Self = Self(0);

    /// Full light. It has zeros below the channel of the display, so that no threshold makes it overflow.
    const WHITE: u8 = (((1 << DEPTH) - 1) << (8 - DEPTH)) as u8;

    /// The thresholds of each row, twice side by side.
    const THRESHOLDS: [[u8; 16]; 8] = {
        let mut thresholds = [[0; 16]; 8];
        let mut place = 0;
        while place < 128 {
            thresholds[place / 16][place % 16] = Self::scaled(threshold(place % 8, place / 16));
            place += 1;
        }
        thresholds
    };
    /// The thresholds that round, in each row.
    const HALVES: [u8; 16] = [Self::scaled(HALF); 16];

    const fn scaled(threshold: u32) -> u8 {
        (threshold << (8 - DEPTH) >> 7) as u8
    }

    fn thresholds(row: usize, dither: bool) -> &'static [u8; 16] {
        if dither { &Self::THRESHOLDS[row % 8] } else { &Self::HALVES }
    }

    /// Eight greys as the display shows them, packed into the first `DEPTH` bytes. Thresholds of four greys are the bytes of a word.
    #[inline]
    fn packed([a, b, c, d, e, f, g, h]: &[Self; 8], [left, right]: [u32; 2]) -> [u8; 4] {
        let four = |greys: [u8; 4], thresholds: u32| {
            // No sum of a grey and its threshold reaches into the next byte.
            let sums = u32::from_le_bytes(greys).wrapping_add(thresholds);
            let upper = sums & (0x0101_0101 * u32::from(Self::WHITE));
            // The first and the third byte take the bits of the byte that follows, and then the first one those of the third.
            let pairs = upper | upper >> (8 + DEPTH);
            if DEPTH == 4 { pairs } else { pairs | pairs >> (16 + 2 * DEPTH) }
        };
        let (first, second) = (four([a.0, b.0, c.0, d.0], left), four([e.0, f.0, g.0, h.0], right));
        match DEPTH {
            4 => [first as u8, (first >> 16) as u8, second as u8, (second >> 16) as u8],
            2 => [first as u8, second as u8, 0, 0],
            _ => [(first | (second & 0xFF) >> 4) as u8, 0, 0, 0],
        }
    }

    /// The grey that the display shows.
    const fn upper(self, threshold: u8) -> u32 {
        (self.0 as u32 + threshold as u32) >> (8 - DEPTH)
    }
}

impl<const DEPTH: u32> PixelColor for LightGray<DEPTH> {
    type Raw = RawU8;
}

impl<const DEPTH: u32> From<RawU8> for LightGray<DEPTH> {
    fn from(raw: RawU8) -> Self {
        Self(raw.into_inner().min(Self::WHITE))
    }
}

impl<const DEPTH: u32> PixelFormat for LightGray<DEPTH> {
    const GRAY: bool = true;
    const DEPTH: [u32; 3] = [DEPTH; 3];
    const BYTES: usize = 1;

    fn pack([luma, ..]: [u32; 3]) -> Self {
        Self((luma << (8 - DEPTH)) as u8)
    }

    fn channels(self) -> [u8; 3] {
        [self.0 >> (8 - DEPTH); 3]
    }

    fn bits(self) -> u32 {
        self.0.into()
    }
}

/// Tables of greys hold colours after the curve of the display, so the pass need not correct them.
impl<const DEPTH: u32> Pixel for LightGray<DEPTH> {
    type Stored = u8;
    type Ramps = Rounded<u8>;

    fn stored(self) -> u8 {
        self.0
    }

    fn from_stored(stored: u8) -> Self {
        Self(stored)
    }

    fn tabled([luma, ..]: [u32; 3], _: u32) -> u8 {
        ((luma + 128) >> 8).min(255) as u8
    }

    fn to_mix(self) -> [u8; 3] {
        [self.0; 3]
    }

    fn mixed_from([luma, ..]: [u8; 3]) -> Self {
        Self(luma)
    }
}

/// The pass over a finished band that makes pixels of the display. It is for bands of [`Light`] and [`LightGray`]; other bands hold pixels of the
/// display already, which are copied. [`Frame::output`](crate::Frame::output) returns it, with the dither and the curve that the renderer is set
/// to.
///
/// ```
/// use embedded_graphics_core::primitives::Rectangle;
/// use microphong::{Frame, RenderError, pixel::{Light, Rgb565Be}};
///
/// /// Draws a frame with 8x8 dither, and sends it to a display on a serial bus.
/// fn draw(
///     mut frame: Frame<'_, Light<5, 6, 5>>,
///     band: &mut [Light<5, 6, 5>],
///     pixels: &mut [Rgb565Be],
///     mut send: impl FnMut(Rectangle, &[Rgb565Be]),
/// ) -> Result<(), RenderError> {
///     while let Some(area) = frame.next_band(band)? {
///         frame.output().convert(band, area, pixels);
///         send(area, pixels);
///     }
///     Ok(())
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Output {
    pub(crate) dither: bool,
    /// The curve of the display, which light has not been corrected by.
    pub(crate) gamma: Option<&'static Gamma>,
}

/// A pixel format of displays, made of the pixels `C` that the renderer draws. Every [`Pixel`] is made of itself, unchanged. A pass makes
/// colours of [`Light`] and greys of [`LightGray`] with as many bits.
pub trait FromDrawn<C: Pixel>: PixelFormat {
    /// What a pass adds to a pixel: a threshold in each channel.
    #[doc(hidden)]
    type Threshold: Copy + 'static;

    /// The thresholds of a row, twice side by side, so that eight follow one another from each column on.
    #[doc(hidden)]
    fn thresholds(row: usize, dither: bool) -> &'static [Self::Threshold; 16];

    /// The pixel of the display.
    #[doc(hidden)]
    fn finished(drawn: C, threshold: Self::Threshold) -> Self;

    /// The pixel corrected by the curve of the display, if it is light.
    #[doc(hidden)]
    fn curved(drawn: C, _: &Gamma) -> C {
        drawn
    }
}

/// No pass.
impl<C: Pixel> FromDrawn<C> for C {
    type Threshold = ();

    fn thresholds(_: usize, _: bool) -> &'static [(); 16] {
        &[(); 16]
    }

    fn finished(drawn: C, (): ()) -> C {
        drawn
    }
}

/// The pixels of a band as the display shows them, in row-major order. [`Output::pixels`] returns this iterator.
#[derive(Debug)]
pub struct Pixels<'b, C, F> {
    drawn: slice::Iter<'b, C>,
    format: PhantomData<F>,
    output: Output,
    left: usize,
    width: usize,
    column: usize,
    row: usize,
}

impl<C: Pixel, F: FromDrawn<C>> Iterator for Pixels<'_, C, F> {
    type Item = F;

    #[inline]
    fn next(&mut self) -> Option<F> {
        let &drawn = self.drawn.next()?;
        let drawn = self.output.gamma.map_or(drawn, |gamma| F::curved(drawn, gamma));
        let shown = F::finished(drawn, F::thresholds(self.row, self.output.dither)[self.left.wrapping_add(self.column) % 8]);
        self.column += 1;
        if self.column == self.width {
            (self.column, self.row) = (0, self.row.wrapping_add(1));
        }
        Some(shown)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.drawn.size_hint()
    }
}

impl Output {
    /// Returns the pixels of the display for a finished band as an iterator, in row-major order. It suits the method `fill_contiguous` of a
    /// draw target. `area` is the rectangle that [`Frame::next_band`](crate::Frame::next_band) has returned for the `band`.
    #[must_use]
    pub fn pixels<C: Pixel, F: FromDrawn<C>>(self, band: &[C], area: Rectangle) -> Pixels<'_, C, F> {
        let (width, left) = (area.size.width as usize, area.top_left.x as usize);
        let drawn = band.get(..width * area.size.height as usize).unwrap_or(band).iter();
        Pixels { drawn, format: PhantomData, output: self, left, width, column: 0, row: area.top_left.y as usize }
    }

    /// Converts a finished band to `pixels` of the display, in row-major order. `area` is the rectangle that
    /// [`Frame::next_band`](crate::Frame::next_band) has returned for the `band`. If `pixels` is too short, only whole rows that fit are
    /// converted.
    #[inline(never)]
    pub fn convert<C: Pixel, F: FromDrawn<C>>(self, band: &[C], area: Rectangle, pixels: &mut [F]) {
        match self.gamma {
            Some(gamma) => self.convert_by(band, area, pixels, |drawn| F::curved(drawn, gamma)),
            None => self.convert_by(band, area, pixels, |drawn| drawn),
        }
    }

    #[inline]
    fn convert_by<C: Pixel, F: FromDrawn<C>>(self, band: &[C], area: Rectangle, pixels: &mut [F], curve: impl Fn(C) -> C) {
        let width = (area.size.width as usize).max(1);
        let rows = band.chunks_exact(width).zip(pixels.chunks_exact_mut(width)).take(area.size.height as usize);
        for ((drawn, pixels), row) in rows.zip(area.top_left.y as usize..) {
            let Some(thresholds) = eight_from(F::thresholds(row, self.dither), area.top_left.x as usize) else { return };
            let ((drawn, last), (pixels, rest)) = (drawn.as_chunks::<8>(), pixels.as_chunks_mut::<8>());
            let shown = |drawn: C, threshold: F::Threshold| F::finished(curve(drawn), threshold);
            for ([a, b, c, d, e, f, g, h], [i, j, k, l, m, n, o, p]) in drawn.iter().zip(pixels) {
                let [q, r, s, t, u, v, w, x] = *thresholds;
                (*i, *j, *k, *l) = (shown(*a, q), shown(*b, r), shown(*c, s), shown(*d, t));
                (*m, *n, *o, *p) = (shown(*e, u), shown(*f, v), shown(*g, w), shown(*h, x));
            }
            last.iter().zip(rest).zip(thresholds).for_each(|((&drawn, pixel), &threshold)| *pixel = shown(drawn, threshold));
        }
    }

    /// Packs the greys of a finished band into `bytes`: two pixels of four bits in a byte, four of two, or eight of one. The first pixel is in
    /// the highest bits, and each row begins with a byte. `area` is the rectangle that [`Frame::next_band`](crate::Frame::next_band) has
    /// returned for the `band`. If `bytes` is too short, only whole rows that fit are packed.
    #[inline(never)]
    pub fn pack<const DEPTH: u32>(self, band: &[LightGray<DEPTH>], area: Rectangle, bytes: &mut [u8]) {
        const { assert!(DEPTH == 1 || DEPTH == 2 || DEPTH == 4, "only greys of one, two and four bits fill whole bytes") };
        let width = (area.size.width as usize).max(1);
        let in_row = width.div_ceil(8 / DEPTH as usize);
        let rows = band.chunks_exact(width).zip(bytes.chunks_exact_mut(in_row)).take(area.size.height as usize);
        for ((greys, bytes), row) in rows.zip(area.top_left.y as usize..) {
            let Some(thresholds) = eight_from(LightGray::<DEPTH>::thresholds(row, self.dither), area.top_left.x as usize) else { return };
            let [a, b, c, d, e, f, g, h] = *thresholds;
            let thresholds = [u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h])];
            for (eight, bytes) in greys.chunks(8).zip(bytes.chunks_mut(DEPTH as usize)) {
                let packed = match eight.first_chunk() {
                    Some(eight) => LightGray::packed(eight, thresholds),
                    None => {
                        // Black, which no threshold brightens, follows the last pixels of the row.
                        let mut padded = [LightGray(0); 8];
                        padded.iter_mut().zip(eight).for_each(|(padded, grey)| *padded = *grey);
                        LightGray::packed(&padded, thresholds)
                    }
                };
                let [a, b, c, d] = packed;
                match bytes {
                    [first, second, third, fourth] => (*first, *second, *third, *fourth) = (a, b, c, d),
                    [first, second] => (*first, *second) = (a, b),
                    rest => rest.iter_mut().zip(packed).for_each(|(byte, packed)| *byte = packed),
                }
            }
        }
    }
}

/// Eight thresholds of a row from `column` on.
fn eight_from<T>(thresholds: &[T; 16], column: usize) -> Option<&[T; 8]> {
    thresholds.get(column % 8..)?.first_chunk()
}

/// Formats of colours, from light of these depths.
macro_rules! colour {
    ($($format:ty, $r:literal, $g:literal, $b:literal;)*) => {$(
        impl FromDrawn<Light<$r, $g, $b>> for $format {
            type Threshold = u32;

            #[inline]
            fn thresholds(row: usize, dither: bool) -> &'static [u32; 16] {
                if dither { &Light::<$r, $g, $b>::THRESHOLDS[row % 8] } else { &Light::<$r, $g, $b>::HALVES }
            }

            #[inline]
            fn finished(Light(light): Light<$r, $g, $b>, threshold: u32) -> Self {
                Self::pack(Light::<$r, $g, $b>::upper(light.wrapping_add(threshold)))
            }

            #[inline]
            fn curved(light: Light<$r, $g, $b>, gamma: &Gamma) -> Light<$r, $g, $b> {
                light.curved(gamma)
            }
        }

        /// The colour exactly.
        impl From<$format> for Light<$r, $g, $b> {
            fn from(colour: $format) -> Self {
                Self::pack(colour.channels().map(u32::from))
            }
        }
    )*};
}

colour! {
    Rgb565, 5, 6, 5;
    Bgr565, 5, 6, 5;
    Rgb565Be, 5, 6, 5;
    Rgb332, 3, 3, 2;
    Rgb666, 6, 6, 6;
    Rgb888, 8, 8, 8;
}

/// Formats of greys of these bits.
macro_rules! gray {
    ($($format:ty, $depth:literal;)*) => {$(
        impl FromDrawn<LightGray<$depth>> for $format {
            type Threshold = u8;

            #[inline]
            fn thresholds(row: usize, dither: bool) -> &'static [u8; 16] {
                LightGray::<$depth>::thresholds(row, dither)
            }

            #[inline]
            fn finished(drawn: LightGray<$depth>, threshold: u8) -> Self {
                Self::pack([drawn.upper(threshold); 3])
            }
        }

        /// The grey exactly.
        impl From<$format> for LightGray<$depth> {
            fn from(grey: $format) -> Self {
                Self::pack(grey.channels().map(u32::from))
            }
        }
    )*};
}

gray! {
    Gray4, 4;
    Gray2, 2;
    BinaryColor, 1;
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::pixel::half_step;
    use embedded_graphics_core::geometry::{Point, Size};
    use std::{vec, vec::Vec};

    const SIDE: u32 = 8;
    const AREA: Rectangle = Rectangle::new(Point::new(3, 5), Size::new(SIDE, SIDE));
    const DITHERED: Output = Output { dither: true, gamma: None };

    /// A square of eight by eight pixels of one colour.
    fn shown<C: Pixel, F: FromDrawn<C>>(drawn: C, output: Output) -> Vec<[u8; 3]> {
        let band = [drawn; (SIDE * SIDE) as usize];
        let pixels: Vec<F> = output.pixels(&band, AREA).collect();
        let mut copied = vec![F::pack([0; 3]); band.len()];
        output.convert(&band, AREA, &mut copied);
        let channels = |pixels: Vec<F>| pixels.into_iter().map(F::channels).collect::<Vec<_>>();
        let pixels = channels(pixels);
        assert_eq!(pixels, channels(copied));
        pixels
    }

    /// Every colour of the display stays as it is, with dither and without, and with a curve.
    fn exact<C: Pixel + From<F>, F: FromDrawn<C>>(has_curve: bool) {
        let [r, g, b] = F::DEPTH.map(|depth| (1u32 << depth) - 1);
        for k in 0..=255 {
            let colour = F::pack([k.min(r), (k * 7 % (g + 1)).min(g), b - (k % (b + 1))]);
            for (dither, gamma) in [(false, None), (true, None), (true, has_curve.then_some(&crate::pixel::SRGB))] {
                let expected = vec![colour.channels(); 64];
                assert_eq!(shown::<C, F>(colour.into(), Output { dither, gamma }), expected);
            }
        }
    }

    #[test]
    fn colours_of_the_display_are_exact() {
        exact::<Light<5, 6, 5>, Rgb565>(true);
        exact::<Light<5, 6, 5>, Bgr565>(true);
        exact::<Light<5, 6, 5>, Rgb565Be>(true);
        exact::<Light<3, 3, 2>, Rgb332>(true);
        exact::<Light<6, 6, 6>, Rgb666>(true);
        exact::<Light<8, 8, 8>, Rgb888>(true);
        exact::<LightGray<4>, Gray4>(false);
        exact::<LightGray<2>, Gray2>(false);
        exact::<LightGray<1>, BinaryColor>(false);
    }

    /// The mean of a square is the light, to the last bit that light has, and no pixel is a step off.
    fn mean<C: Pixel, F: FromDrawn<C>>(light: impl Fn(f64) -> C) {
        for k in 0..=200 {
            let level = f64::from(k) / 200.0;
            let pixels = shown::<C, F>(light(level), DITHERED);
            for (channel, depth) in F::DEPTH.into_iter().enumerate() {
                let wanted = level * f64::from((1u32 << depth) - 1);
                let sum: f64 = pixels.iter().map(|pixel| f64::from(pixel[channel])).sum();
                let off = sum / 64.0 - wanted;
                let step = f64::from(1 << depth) / f64::from(1u32 << if C::GRAY { 8 } else { BITS });
                // Light is rounded when it is drawn and when it is scaled, and thresholds are a step smaller: 1.25 of 255 together.
                assert!(off.abs() <= 2.5 * step, "{level} in channel {channel}: off by {off} of {step}");
                assert!(pixels.iter().all(|pixel| (f64::from(pixel[channel]) - wanted).abs() < 1.0 + step));
            }
        }
    }

    /// Light of a level from 0 to 1.
    fn light<const R: u32, const G: u32, const B: u32>(level: f64) -> Light<R, G, B> {
        Light::mixed([(level * 255.0 * f64::from(1u32 << CHANNEL)) as i32 + half_step(8); 3])
    }

    #[test]
    fn means_are_those_of_the_light() {
        mean::<_, Rgb565>(light::<5, 6, 5>);
        mean::<_, Rgb666>(light::<6, 6, 6>);
        mean::<_, Rgb332>(light::<3, 3, 2>);
        let grey = |level: f64, depth: u32| (level * f64::from(((1 << depth) - 1) << (8 - depth))).round() as u8;
        mean::<_, Gray4>(|level| LightGray::<4>(grey(level, 4)));
        mean::<_, Gray2>(|level| LightGray::<2>(grey(level, 2)));
        mean::<_, BinaryColor>(|level| LightGray::<1>(grey(level, 1)));
    }

    /// Light that is too bright is full, in each channel by itself.
    #[test]
    fn too_bright_is_full() {
        for over in 0..64i32 {
            for bright in 0..8 {
                let level = |lane: u32| (if bright >> lane & 1 == 1 { 255 + 4 * over } else { 0 } << CHANNEL) + half_step(8);
                let drawn = Light::<5, 6, 5>::mixed([level(0), level(1), level(2)]);
                let expected = [0, 1, 2].map(|lane| if bright >> lane & 1 == 1 { [31, 63, 31][lane] } else { 0 });
                assert_eq!(shown::<_, Rgb565>(drawn, DITHERED), vec![expected; 64], "{over} {bright}");
            }
        }
    }

    #[test]
    fn greys_are_packed_from_the_left() {
        fn band<const DEPTH: u32>() -> [LightGray<DEPTH>; 20] {
            core::array::from_fn(|k| LightGray::pack([if k % 3 == 0 { (1 << DEPTH) - 1 } else { 0 }; 3]))
        }
        let area = Rectangle::new(Point::zero(), Size::new(10, 2));
        let mut bytes = [0; 4];
        DITHERED.pack(&band::<1>(), area, &mut bytes);
        assert_eq!(bytes, [0b1001_0010, 0b0100_0000, 0b0010_0100, 0b1000_0000]);
        let mut bytes = [0; 10];
        DITHERED.pack(&band::<4>(), area, &mut bytes);
        assert_eq!(bytes, [0xF0, 0x0F, 0x00, 0xF0, 0x0F, 0x00, 0xF0, 0x0F, 0x00, 0xF0]);
    }
}
