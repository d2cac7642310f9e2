//! Row kernels of `microphong` in assembler.
//!
//! A kernel fills the rows of a triangle between a left and a right side that are stepped from row to row, from right to left in each row, with or
//! without a depth test. A compiler keeps much of the state of such loops in memory and loads it word by word. The kernels load the state of a row by
//! one instruction or by a few, step all of it, and store it likewise.
//!
//! This is the only crate of the library with `unsafe` code. [`Rows`] are checked once for each call: all of them lie within the slices. A
//! kernel compares the right side with the width in each row. So whatever the sides are, it reads and writes nothing else. On processors without
//! kernels ([`AVAILABLE`], [`LIT_AVAILABLE`]) functions return `None`, among them [`Lit::new`], and `microphong` fills the rows by its loops in Rust.
//! These store the same bits if all sides lie within the width.

#![no_std]

#[macro_use]
#[cfg(kernels = "armv7m")]
mod pack;

#[cfg_attr(kernels = "armv6m", path = "armv6m.rs")]
#[cfg_attr(kernels = "armv7m", path = "armv7m.rs")]
#[cfg(kernels)]
mod processor;

#[cfg(kernels = "armv7m")]
#[path = "lit_armv7m.rs"]
mod lit;

#[cfg(kernels = "armv7m")]
use core::mem::offset_of;
use core::{marker::PhantomData, mem::MaybeUninit};
use embedded_graphics_core::pixelcolor::{Bgr565, Rgb565, Rgb666, Rgb888};

/// Whether there are kernels for pixels of two bytes on the processor that is compiled for.
pub const AVAILABLE: bool = cfg!(kernels);

/// Whether there are kernels for pixels of four bytes.
pub const WORDS_AVAILABLE: bool = cfg!(kernels = "armv7m");

/// Whether kernels of [`Lit`] are among them.
pub const LIT_AVAILABLE: bool = cfg!(kernels = "armv7m");

/// The left side of a triangle and then the right one: each the column of the coming row, unsigned Q11.21, and what is added to it for the next row.
pub type Sides = [u32; 4];

/// A linear field: its value at column 0 of the coming row, and its steps to the next column and to the next row. All additions wrap.
pub type Plane = [i32; 3];

/// Colours of a table of [`Colours::Table`].
#[derive(Clone, Copy, Debug)]
pub enum Entries<'a> {
    /// Colours of two bytes.
    Halfwords(&'a [u16; 512]),
    /// Colours of four bytes.
    Words(&'a [u32; 512]),
}

/// Largest number of rows above the turn, and below it.
pub const MAX_HEIGHT: u32 = (1 << 9) - 1;

/// Largest number of rows of a band above the first one.
pub const MAX_FIRST: u32 = (1 << 11) - 1;

/// Largest number of columns.
pub const MAX_WIDTH: usize = (1 << 11) - 1;

/// The rows below the middle corner of a triangle, where another line takes the place of one side.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turn {
    /// Number of rows.
    pub height: u32,
    /// Whether the line is the right side.
    pub is_right: bool,
    /// The column of the line in the first of these rows, and its step, as in [`Sides`].
    pub line: [u32; 2],
}

/// The rows to fill. Pixels of a row lie from the column of the left side, rounded down, to the column before that of the right side, rounded down. A row
/// whose right column lies beyond the width is left out.
#[derive(Debug)]
pub struct Rows<'a> {
    /// The inverse depth of the pixels of the band, row by row. It is not used without a depth test.
    pub depth: &'a mut [u16],
    /// Columns of the band. If there are none, nothing is drawn, and the sides have no meaning afterwards.
    pub width: usize,
    /// Rows of the band above the first one.
    pub first: u32,
    /// The sides, which the kernel steps to the row behind the last.
    pub sides: &'a mut Sides,
    /// Number of rows above the turn.
    pub height: u32,
    /// The rows below it; none by default.
    pub turn: Turn,
}

/// The order of channels in a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Red in the upper bits, then green, then blue.
    Rgb,
    /// Blue in the upper bits, then green, then red.
    Bgr,
    /// Red in the upper bits, and the upper byte of two first in memory.
    Swapped,
    /// Nine bits of each channel: blue from bit 0 on, red from bit 11 and green from bit 20. A display shows fewer bits. All of them are ones where light is
    /// full, and the bits below are zeros.
    Light,
}

/// The format of a pixel as one number, for which kernels are compiled: the order of channels, and the bits of red, green and blue that a display
/// shows. A pixel has four bytes if the bits do not fit into two.
#[must_use]
pub const fn format(order: Order, [red, green, blue]: [u32; 3]) -> u32 {
    assert!(red <= 8 && green <= 8 && blue <= 8, "a channel has at most eight bits");
    (order as u32) << 12 | red << 8 | green << 4 | blue
}

/// What [`format`] puts together, as assembler reads it.
#[cfg(kernels)]
#[cfg_attr(kernels = "armv6m", expect(dead_code, reason = "kernels of Armv6-M draw channels of 5, 6 and 5 bits alone"))]
struct FormatParts {
    /// Bytes of a pixel.
    bytes: u32,
    /// Bits of each channel, and the lowest of them.
    bits: [u32; 3],
    lowest: [u32; 3],
    /// The bits that a display shows of light; zeros if the pixel is one of the display.
    shown: [u32; 3],
    is_swapped: u32,
}

#[cfg(kernels)]
impl FormatParts {
    const fn of(format: u32) -> Self {
        let shown @ [red, green, blue] = [format >> 8 & 15, format >> 4 & 15, format & 15];
        let order = format >> 12;
        if order == Order::Light as u32 {
            return Self { bytes: 4, bits: [9; 3], lowest: [11, 20, 0], shown, is_swapped: 0 };
        }
        let lowest = if order == Order::Bgr as u32 { [0, red, red + green] } else { [green + blue, blue, 0] };
        let bytes = if red + green + blue > 16 { 4 } else { 2 };
        Self { bytes, bits: shown, lowest, shown: [0; 3], is_swapped: (order == Order::Swapped as u32) as u32 }
    }

    /// Whether there are kernels for pixels of so many bytes on this processor.
    const fn exists(&self) -> bool {
        self.bytes == 2 || WORDS_AVAILABLE
    }
}

/// Evaluates a block on processors with kernels, otherwise it is `None`.
macro_rules! by_kernel {
    (($rows:ident, $($argument:ident),*), $block:block) => {{
        #[cfg(kernels)]
        {
            let mut $rows = $rows;
            Some($block)
        }
        #[cfg(not(kernels))]
        {
            let _ = ($rows, $($argument),*);
            None
        }
    }};
}

mod sealed {
    pub trait Sealed {}
}

/// A pixel that is a number of two bytes or four, of which each value is valid.
pub trait Number: sealed::Sealed {
    /// The number.
    type Number: Stored;
}

/// Pixels of embedded-graphics, each around one number.
macro_rules! number {
    ($($pixel:ty, $number:ty;)*) => {
        $(
            impl sealed::Sealed for $pixel {}
            impl Number for $pixel {
                type Number = $number;
            }
            const _: () = assert!(size_of::<$pixel>() == size_of::<$number>() && align_of::<$pixel>() == align_of::<$number>());
            // A type with invalid values would store `None` as one of them.
            const _: () = assert!(size_of::<Option<$pixel>>() > size_of::<$pixel>());
        )*
    };
}

number! {
    Rgb565, u16;
    Bgr565, u16;
    Rgb666, u32;
    Rgb888, u32;
}

/// The pixels as numbers.
#[must_use]
pub fn numbers<C: Number>(pixels: &mut [C]) -> &mut [C::Number] {
    // SAFETY: a pixel is a structure around one number, in which any value is valid; size and alignment are asserted above.
    unsafe { core::slice::from_raw_parts_mut(pixels.as_mut_ptr().cast(), pixels.len()) }
}

/// A pixel as kernels store it: a number of two bytes or of four.
pub trait Stored: sealed::Sealed {
    /// Its bytes.
    const BYTES: u8;
}

impl sealed::Sealed for u16 {}
impl Stored for u16 {
    const BYTES: u8 = 2;
}

impl sealed::Sealed for u32 {}
impl Stored for u32 {
    const BYTES: u8 = 4;
}

/// A count has a number of pixels in so many lower bits, and a number of rows above. They hold twice [`MAX_HEIGHT`] rows of [`MAX_WIDTH`] pixels.
#[cfg(kernels)]
const COUNTED: u32 = 22;

/// Where the rows lie, and the line that is a side below the turn.
#[cfg(kernels)]
#[repr(C)]
struct Lines {
    /// The place to the left of the first pixel, or of its depth if a pixel has four bytes and there is a depth test. Pixels are counted from 1.
    left: *mut u8,
    /// Bytes from a pixel to its depth, or to a pixel of four bytes from twice the address of its depth.
    delta: usize,
    /// Rows below the turn, from bit [`COUNTED`] on.
    rest: u32,
    /// Bytes from the column of the left side to that of the side that the line replaces.
    side: u32,
    line: [u32; 2],
}

/// What a kernel reads besides sides and planes.
#[cfg(kernels)]
#[repr(C)]
struct Job<T> {
    /// Rows above the turn, from bit [`COUNTED`] on.
    count: u32,
    /// Bytes from a row of the band to the next one, at [`Lines::left`].
    pitch: usize,
    colours: T,
    lines: Lines,
}

/// What a kernel of [`Lit`] reads besides sides, depth and fields.
#[cfg(kernels = "armv7m")]
#[repr(C)]
struct LitJob {
    /// For the first row and for the second.
    colours: [*const (); 2],
    roots: *const u32,
    highlights: *const u16,
    /// See [`Lookup::top`].
    top: i32,
    width: usize,
    /// Rows above the turn, from bit [`COUNTED`] on.
    count: u32,
    pitch: usize,
    lines: Lines,
}

/// What [`channels`] reads besides sides and planes.
#[cfg(kernels)]
#[repr(C)]
struct Channels {
    pitch: usize,
    width: usize,
    /// Added to the levels of a row 8, 4 and 8 times, and subtracted in the next one. The sign changes before each row.
    raise: i32,
    /// Rows above the turn, from bit [`COUNTED`] on.
    count: u32,
    lines: Lines,
}

#[cfg(kernels)]
impl Rows<'_> {
    /// Where the rows lie; `None` if not all of them lie within the slices, or there are too many.
    #[inline(always)]
    fn lines<T: Stored>(&mut self, pixels: &mut [T], has_depth: bool) -> Option<Lines> {
        let (first, above, below) = (self.first, self.height, self.turn.height);
        // If so, no sum or product below has overflowed.
        let is_small = first <= MAX_FIRST && above | below <= MAX_HEIGHT && self.width <= MAX_WIDTH;
        let end = self.width.wrapping_mul(first.wrapping_add(above).wrapping_add(below) as usize);
        let fits = end <= pixels.len() && (!has_depth || end <= self.depth.len());
        let (pixels, depth): (*mut u8, *mut u8) = (pixels.as_mut_ptr().cast(), self.depth.as_mut_ptr().cast());
        let (at_pixels, at_depth) = (pixels.expose_provenance(), depth.expose_provenance());
        let (start, size, delta): (_, usize, _) = if T::BYTES == 4 && has_depth {
            (depth, 2, at_pixels.wrapping_sub(at_depth.wrapping_mul(2)))
        } else {
            (pixels, T::BYTES.into(), at_depth.wrapping_sub(at_pixels))
        };
        (is_small && fits).then(|| Lines {
            left: start.wrapping_add(size.wrapping_mul(self.width.wrapping_mul(first as usize))).wrapping_sub(size),
            delta,
            rest: self.turn.height << COUNTED,
            side: u32::from(self.turn.is_right) << 2,
            line: self.turn.line,
        })
    }

    /// What a kernel reads.
    #[inline(always)]
    fn job<T: Stored, C>(&mut self, pixels: &mut [T], has_depth: bool, colours: C) -> Option<Job<C>> {
        let lines = self.lines(pixels, has_depth)?;
        let size = if has_depth { 2 } else { T::BYTES.into() };
        Some(Job { count: self.height << COUNTED, pitch: size * self.width, colours, lines })
    }
}

/// Fills `rows` of the pixels of a band by a level and a table of colours, with a depth test if there is a plane of depth. The index is as many upper bits of
/// the level as the table takes. Returns the number of pixels between the sides. If the rows do not lie within the slices, or a limit is exceeded, it is 0, and
/// nothing changes. Returns `None` if there is no kernel for this processor, or for a table of this length.
#[inline(always)]
#[must_use]
pub fn ramp<T: Stored, const N: usize>(
    pixels: &mut [T],
    rows: Rows<'_>,
    depth: Option<&mut Plane>,
    level: &mut Plane,
    colours: &[T; N],
) -> Option<u32> {
    by_kernel!((rows, pixels, depth, level, colours), {
        // SAFETY: all rows lie within both slices, whose addresses are exposed; columns are compared with the width; and an index of so many bits lies within the
        // table.
        macro_rules! fill {
            ($bytes:literal, $bits:literal) => {
                match (rows.job(pixels, depth.is_some(), colours.as_ptr().cast()), depth) {
                    (Some(job), Some(depth)) => unsafe { processor::ramp::<$bytes, $bits>(rows.sides, depth, level, &job) },
                    (Some(job), None) => unsafe { processor::ramp_alone::<$bytes, $bits>(rows.sides, level, &job) },
                    (None, _) => 0,
                }
            };
        }
        match (T::BYTES, N) {
            (2, 1024) => fill!(2, 10),
            #[cfg(kernels = "armv7m")]
            (4, 512) => fill!(4, 9),
            #[cfg(kernels = "armv7m")]
            (4, 1024) => fill!(4, 10),
            _ => return None,
        }
    })
}

/// Fills `rows` of the pixels of a band with two colours in turn, the first one in the first row, with a depth test if there is a plane of depth. Returns what
/// [`ramp`] does.
#[inline(always)]
#[must_use]
pub fn solid<T: Stored>(pixels: &mut [T], rows: Rows<'_>, depth: Option<&mut Plane>, colours: [u32; 2]) -> Option<u32> {
    by_kernel!((rows, pixels, depth, colours), {
        let [first, second] = colours;
        // SAFETY: all rows lie within both slices, whose addresses are exposed, and columns are compared with the width.
        macro_rules! fill {
            ($bytes:literal, $colours:expr) => {
                match (rows.job(pixels, depth.is_some(), $colours), depth) {
                    (Some(job), Some(depth)) => unsafe { processor::solid::<$bytes, _>(rows.sides, depth, &job) },
                    (Some(job), None) => unsafe { processor::solid_alone::<$bytes, _>(rows.sides, &job) },
                    (None, _) => 0,
                }
            };
        }
        match T::BYTES {
            2 => fill!(2, first | second << 16),
            #[cfg(kernels = "armv7m")]
            _ => fill!(4, [first ^ second, first]),
            #[cfg(not(kernels = "armv7m"))]
            _ => return None,
        }
    })
}

/// Fills `rows` of the pixels of a band by levels of red, green and blue with 22 fraction bits, with a depth test. Levels are clamped to 8 bits and rounded down
/// to the bits of a channel. In the first row `raise` is added to each of them, multiplied by the step of the channel; in the next row it is subtracted.
/// Nothing is added to light. `FORMAT` is a [`format`]. Returns what [`ramp`] does.
#[inline(always)]
#[must_use]
pub fn channels<const FORMAT: u32, T: Stored>(
    pixels: &mut [T],
    rows: Rows<'_>,
    depth: &mut Plane,
    levels: &mut [Plane; 3],
    raise: i32,
) -> Option<u32> {
    by_kernel!((rows, pixels, depth, levels, raise), {
        const { assert!(FormatParts::of(FORMAT).bytes == T::BYTES as u32) };
        if !const { FormatParts::of(FORMAT).exists() } {
            return None;
        }
        let Some(lines) = rows.lines(pixels, true) else { return Some(0) };
        let (width, raise) = (rows.width, raise.wrapping_neg());
        let job = Channels { pitch: 2 * width, width, raise, count: rows.height << COUNTED, lines };
        // SAFETY: all rows lie within both slices, whose addresses are exposed, and columns are compared with the width.
        unsafe { processor::channels::<FORMAT>(rows.sides, depth, levels, &job) }
    })
}

/// Halves of reciprocal roots, Q2.30, by the upper 11 bits of a square. The lower 10 bits of an entry are also a number of their own: how much the value falls
/// in 1/1024 of the way to the next entry.
pub type Roots = [u32; 2048];

/// Highlights, by their place in steps of the table.
pub type Highlights = [u16; 4097];

/// Levels of one light in red, green and blue: ambient light with 22 fraction bits, and the factors of a cosine, Q1.15, and of a highlight.
pub type Sums = [[i32; 3]; 3];

/// Four numbers for each of red, green and blue. The first is for rounding and dither, and the second is ambient light, both with 22 fraction bits.
/// On a surface of one colour the first is not used, and the second includes it. Factors follow, see [`Colours`].
pub type Shares = [[i32; 4]; 3];

impl<'a> From<&'a [u16; 512]> for Entries<'a> {
    #[inline(always)]
    fn from(colours: &'a [u16; 512]) -> Self {
        Self::Halfwords(colours)
    }
}

impl<'a> From<&'a [u32; 512]> for Entries<'a> {
    #[inline(always)]
    fn from(colours: &'a [u32; 512]) -> Self {
        Self::Words(colours)
    }
}

/// Where light at a pixel is looked up.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lookup<'a> {
    /// Half the reciprocal length of a normal by its square. Kernels of textures divide nothing, and have none.
    pub roots: Option<&'a Roots>,
    /// Highlights, if the material has any.
    pub highlights: Option<&'a Highlights>,
    /// The place where a highlight is whole, with 8 fraction bits, from which a quotient is subtracted. For a table of colours without highlights it is the
    /// level of ambient light.
    pub top: i32,
}

/// A texture, and what a row adds to it. Assembler reads this structure, so the order of its members matters.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Texels<'a> {
    /// Red, green, blue, and a byte that is 0 unless the texel is a hole.
    palette: *const [u8; 4],
    /// For rounding and dither, with 22 fraction bits.
    rounding: [i32; 3],
    /// The bits of the second place that the number of a row has.
    rows: u32,
    length: u32,
    width: u32,
    /// Indices of the palette.
    texels: *const u8,
    colours: u32,
    borrowed: PhantomData<&'a ()>,
}

impl<'a> Texels<'a> {
    /// A texture whose width and height have these binary logarithms, and what is added to levels of red, green and blue. `None` if it has not as many texels.
    #[inline]
    #[must_use]
    pub fn new(palette: &'a [[u8; 4]], texels: &'a [u8], [width, height]: [u8; 2], rounding: [i32; 3]) -> Option<Self> {
        let is_whole = width < 16 && height < 16 && texels.len() == 1 << (width + height);
        is_whole.then(|| Self {
            palette: palette.as_ptr(),
            rounding,
            rows: !(u32::MAX >> height),
            length: texels.len() as u32,
            width: 1 << width,
            texels: texels.as_ptr(),
            colours: palette.len() as u32,
            borrowed: PhantomData,
        })
    }

    /// What is added to levels.
    #[inline]
    #[must_use]
    pub fn rounding(&self) -> [i32; 3] {
        self.rounding
    }
}

/// The colours of light, for the first row and for the second, in turn.
///
/// A kernel divides numerators by the root of a square. Numerators are added to [`Fields`] in the order in which the text of a variant names them. The
/// quotient of a light or of a sum is a level with 19 fraction bits. In all variants but [`Self::Table`], the level of a light is 2^7 where its cosine is 1,
/// and is clamped to cosines from 0 to 1. The quotient of a highlight is a place in the table of highlights. Shares of red, green and blue are not divided.
/// They have 29 fraction bits, and both ambient and diffuse light are multiplied by them.
#[derive(Clone, Copy, Debug)]
pub enum Colours<'a> {
    /// A table of colours, for a light, and a highlight if there is one. A negative level counts as 0. With a highlight, 2^12 times the entry of the table is
    /// added to the level; entries include ambient light. Without one, [`Lookup::top`] is added. Bits 19 to 27 of the sum are the index of a colour.
    Table([Entries<'a>; 2]),
    /// One light, and its highlight if it has one.
    Light([&'a Sums; 2]),
    /// Two lights. The highlight of each follows its light. If only one of them has a highlight, it is the first.
    TwoLights([&'a [Sums; 2]; 2]),
    /// Sums of the light of several lights, in red, green and blue, and up to two highlights. The factors are those of highlights.
    Summed([&'a Shares; 2]),
    /// [`Self::Light`], followed by shares. The factors are those of the cosine and of the highlight.
    PaintedLight([&'a Shares; 2]),
    /// [`Self::Summed`], with shares between sums and highlights.
    PaintedSum([&'a Shares; 2]),
    /// A texture under light in red, green and blue, which highlights follow if there are any. Two quadratics are the place in the texture: columns and rows, as
    /// fractions of its width and height, in all bits of a word. Light is not divided. All of its bits but the lower 6 are multiplied by channels of 8 bits,
    /// and highlights are added. A texel that is a hole or has no colour is left out, and so is its depth.
    Texels([&'a Texels<'a>; 2]),
    /// [`Self::Texels`] under light without a hue, which is that of green. Red and blue take 63/64 of it if they have fewer bits, and the same number
    /// is added to both.
    NeutralTexels([&'a Texels<'a>; 2]),
}

/// A quadratic field: its value at column 0 of the coming row, its step to the next row, the step of that step, its slope, the step of the slope to the
/// next row, and half its bend. All sums and products wrap.
pub type Quadric = [i32; 6];

/// Most numerators of a kernel.
const NUMERATORS: usize = 8;

/// Most quadratics of a kernel.
const QUADRATICS: usize = 2;

/// Quadratic fields, such as the square of a length, and linear ones. A kernel walks and steps as many of them as it needs, and leaves the others unchanged.
/// Assembler reads this structure, so the order of its members matters.
#[derive(Debug)]
#[repr(C)]
pub struct Fields<'a> {
    quadratics: [MaybeUninit<&'a mut Quadric>; QUADRATICS],
    planes: [MaybeUninit<&'a mut Plane>; NUMERATORS],
    /// The numbers of planes and of quadratics.
    counts: [usize; 2],
}

impl Default for Fields<'_> {
    #[inline(always)]
    fn default() -> Self {
        let (quadratics, planes) = ([const { MaybeUninit::uninit() }; QUADRATICS], [const { MaybeUninit::uninit() }; NUMERATORS]);
        Self { quadratics, planes, counts: [0; 2] }
    }
}

impl<'a> Fields<'a> {
    /// Adds a numerator. There is room for those of every kernel, and further ones are left out.
    #[inline(always)]
    pub fn add_numerator(&mut self, plane: &'a mut Plane) {
        let [count, _] = &mut self.counts;
        if let Some(to) = self.planes.get_mut(*count) {
            *to = MaybeUninit::new(plane);
            *count += 1;
        }
    }

    /// Adds a quadratic, as [`Self::add_numerator`] does.
    #[inline(always)]
    pub fn add_quadratic(&mut self, quadratic: &'a mut Quadric) {
        let [_, count] = &mut self.counts;
        if let Some(to) = self.quadratics.get_mut(*count) {
            *to = MaybeUninit::new(quadratic);
            *count += 1;
        }
    }
}

/// A kernel.
#[cfg(kernels = "armv7m")]
type LitKernel = unsafe extern "C" fn(&mut Sides, &mut Plane, &mut Fields<'_>, &LitJob) -> u32;

// Assembler has these numbers as constants.
#[cfg(kernels = "armv7m")]
const _: () = assert!(offset_of!(Fields<'_>, quadratics) == 0 && offset_of!(Fields<'_>, planes) == 8 && size_of::<LitJob>() == 56);
#[cfg(kernels = "armv7m")]
const _: () = assert!(offset_of!(Texels<'_>, rows) == 16 && offset_of!(Texels<'_>, colours) == 32);

/// A kernel that computes light at each pixel, and what it reads. There are none for other processors.
#[derive(Clone, Copy, Debug)]
pub struct Lit<'a> {
    #[cfg(kernels = "armv7m")]
    kernel: LitKernel,
    /// The number of numerators that it steps. There is one quadratic, or two if there is no table of roots.
    #[cfg(kernels = "armv7m")]
    numerators: usize,
    #[cfg(kernels = "armv7m")]
    colours: [*const (); 2],
    /// Bytes of a pixel.
    #[cfg(kernels = "armv7m")]
    bytes: u32,
    #[cfg(kernels = "armv7m")]
    lookup: Lookup<'a>,
    #[cfg(not(kernels = "armv7m"))]
    none: (core::convert::Infallible, PhantomData<&'a ()>),
}

impl<'a> Lit<'a> {
    /// The kernel for these colours and so many highlights. `FORMAT` is a [`format`]. `None` if there is no kernel, or if it has not the tables that it
    /// needs.
    #[inline(always)]
    #[must_use]
    pub fn new<const FORMAT: u32>(colours: Colours<'a>, highlights: usize, lookup: Lookup<'a>) -> Option<Self> {
        #[cfg(kernels = "armv7m")]
        {
            let (kernel, numerators): (LitKernel, usize) = match (colours, highlights) {
                (Colours::Table(_), 0) => (lit::level::<FORMAT>, 1),
                (Colours::Table(_), 1) => (lit::level_and_highlight::<FORMAT>, 2),
                (Colours::Light(_), 0) => (lit::light::<FORMAT>, 1),
                (Colours::Light(_), 1) => (lit::light_and_highlight::<FORMAT>, 2),
                (Colours::TwoLights(_), 0) => (lit::lights::<FORMAT>, 2),
                (Colours::TwoLights(_), 1) => (lit::lights_and_highlight::<FORMAT>, 3),
                (Colours::TwoLights(_), 2) => (lit::lights_and_highlights::<FORMAT>, 4),
                (Colours::Summed(_), 0) => (lit::sums::<FORMAT>, 3),
                (Colours::Summed(_), 1) => (lit::sums_and_highlight::<FORMAT>, 4),
                (Colours::Summed(_), 2) => (lit::sums_and_highlights::<FORMAT>, 5),
                (Colours::PaintedLight(_), 0) => (lit::painted_light::<FORMAT>, 4),
                (Colours::PaintedLight(_), 1) => (lit::painted_light_and_highlight::<FORMAT>, 5),
                (Colours::PaintedSum(_), 0) => (lit::painted_sums::<FORMAT>, 6),
                (Colours::PaintedSum(_), 1) => (lit::painted_sums_and_highlight::<FORMAT>, 7),
                (Colours::PaintedSum(_), 2) => (lit::painted_sums_and_highlights::<FORMAT>, 8),
                (Colours::Texels(_), 0) => (lit::texels::<FORMAT>, 3),
                (Colours::Texels(_), 1) => (lit::texels_and_highlight::<FORMAT>, 6),
                (Colours::NeutralTexels(_), 0) => (lit::neutral_texels::<FORMAT>, 1),
                (Colours::NeutralTexels(_), 1) => (lit::neutral_texels_and_highlight::<FORMAT>, 2),
                _ => return None,
            };
            fn address<T>(colours: [&T; 2]) -> [*const (); 2] {
                colours.map(|colours| core::ptr::from_ref(colours).cast())
            }
            let bytes = const { FormatParts::of(FORMAT).bytes };
            let has_tables = match colours {
                Colours::Texels(_) | Colours::NeutralTexels(_) => lookup.roots.is_none(),
                _ => lookup.roots.is_some() && (highlights == 0 || lookup.highlights.is_some()),
            };
            let colours = match colours {
                Colours::Table([Entries::Halfwords(even), Entries::Halfwords(odd)]) if bytes == 2 => address([even, odd]),
                Colours::Table([Entries::Words(even), Entries::Words(odd)]) if bytes == 4 => address([even, odd]),
                Colours::Table(_) => return None,
                Colours::Light(sums) => address(sums),
                Colours::TwoLights(sums) => address(sums),
                Colours::Summed(shares) | Colours::PaintedLight(shares) | Colours::PaintedSum(shares) => address(shares),
                Colours::Texels(texels) | Colours::NeutralTexels(texels) => address(texels),
            };
            has_tables.then_some(Self { kernel, numerators, colours, bytes, lookup })
        }
        #[cfg(not(kernels = "armv7m"))]
        {
            let _ = (colours, highlights, lookup);
            None
        }
    }

    /// The kernel that begins with the colours of the second row.
    #[must_use]
    pub fn from_second_row(self) -> Self {
        #[cfg(kernels = "armv7m")]
        {
            let [first, second] = self.colours;
            Self { colours: [second, first], ..self }
        }
        #[cfg(not(kernels = "armv7m"))]
        self
    }

    /// Fills `rows` of the pixels of a band, with a depth test. The numerators of `fields` are those that [`Colours`] tells. Returns the number of pixels between
    /// the sides. If the rows do not lie within the slices, a limit is exceeded, a field is missing, or pixels have another number of bytes than those of the
    /// format, it is 0, and nothing changes.
    #[must_use]
    pub fn fill<T: Stored>(&self, pixels: &mut [T], rows: Rows<'_>, depth: &mut Plane, fields: &mut Fields<'_>) -> u32 {
        #[cfg(kernels = "armv7m")]
        {
            let mut rows = rows;
            let &Self { kernel, numerators, colours, bytes, lookup: Lookup { roots, highlights, top } } = self;
            let has_all = fields.counts[0] >= numerators && fields.counts[1] > usize::from(roots.is_none());
            let Some(lines) = rows.lines(pixels, true).filter(|_| has_all && bytes == u32::from(T::BYTES)) else { return 0 };
            let roots = roots.map_or(core::ptr::null(), |table| table.as_ptr());
            let highlights = highlights.map_or(core::ptr::null(), |table| table.as_ptr());
            let (width, count) = (rows.width, rows.height << COUNTED);
            let job = LitJob { colours, roots, highlights, top, width, count, pitch: 2 * width, lines };
            // SAFETY: all rows lie within both slices, whose addresses are exposed, and columns are compared with the width; an index of 11 bits lies within
            // the roots, one of 12 bits within the highlights, and one of 9 bits within a table of colours; the numbers of row and column are less than
            // height and width of a texture, whose product is the number of texels, and an index is compared with the number of colours; the colours are
            // those of the kernel, and so are the tables; there are all fields that it steps.
            unsafe { kernel(rows.sides, depth, fields, &job) }
        }
        #[cfg(not(kernels = "armv7m"))]
        {
            let _ = (pixels, rows, depth, fields);
            match self.none.0 {}
        }
    }
}
