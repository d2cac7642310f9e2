//! Row kernels of `microphong` in assembler.
//!
//! A kernel fills the rows of a triangle between a left and a right side that are stepped from row to row, from right to left in each row, with or
//! without a depth test. A compiler keeps much of the state of such loops in memory and loads it word by word. The kernels load the state of a row by
//! one instruction, step all of it, and store it by one instruction.
//!
//! This is the only crate of the library with `unsafe` code. [`Rows`] are checked once for each call: all of them lie within the slices. A
//! kernel compares the right side with the width in each row. So whatever the sides are, it reads and writes nothing else. On processors without
//! kernels ([`AVAILABLE`]) every function returns `None`, and `microphong` fills the rows by its loops in Rust. These store the same bits if all sides
//! lie within the width.

#![no_std]

#[cfg_attr(kernels = "armv6m", path = "armv6m.rs")]
#[cfg_attr(kernels = "armv7m", path = "armv7m.rs")]
#[cfg(kernels)]
mod processor;

use embedded_graphics_core::pixelcolor::{Bgr565, Rgb565};

/// Whether there are kernels for the processor that is compiled for.
pub const AVAILABLE: bool = cfg!(kernels);

/// The left side of a triangle and then the right one: each the column of the coming row, unsigned Q11.21, and what is added to it for the next row.
pub type Sides = [u32; 4];

/// A linear field: its value at column 0 of the coming row, and its steps to the next column and to the next row. All additions wrap.
pub type Plane = [i32; 3];

/// Colours of a table, whose index is the upper 10 bits of a level.
pub type Table = [u16; 1024];

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
    /// The pixels of the band, row by row.
    pub pixels: &'a mut [u16],
    /// The inverse depth of each of them. It is not used without a depth test.
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

/// The order of channels of 5, 6 and 5 bits in a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Red in the upper bits.
    Rgb,
    /// Blue in the upper bits.
    Bgr,
    /// Red in the upper bits, and the upper byte first in memory.
    Swapped,
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

/// A pixel of two bytes, of which each value is valid.
pub trait Halfword: sealed::Sealed {}

/// Pixels of embedded-graphics, each around one `u16`.
macro_rules! halfword {
    ($($pixel:ty),*) => {
        $(
            impl sealed::Sealed for $pixel {}
            impl Halfword for $pixel {}
            const _: () = assert!(size_of::<$pixel>() == size_of::<u16>() && align_of::<$pixel>() == align_of::<u16>());
            // A type with invalid values would store `None` as one of them.
            const _: () = assert!(size_of::<Option<$pixel>>() > size_of::<$pixel>());
        )*
    };
}

halfword!(Rgb565, Bgr565);

/// The pixels as numbers.
#[must_use]
pub fn halfwords<C: Halfword>(pixels: &mut [C]) -> &mut [u16] {
    // SAFETY: a pixel is a structure around one `u16`, in which any value is valid; size and alignment are asserted above.
    unsafe { core::slice::from_raw_parts_mut(pixels.as_mut_ptr().cast(), pixels.len()) }
}

/// A count has a number of pixels in so many lower bits, and a number of rows above. They hold twice [`MAX_HEIGHT`] rows of [`MAX_WIDTH`] pixels.
#[cfg(kernels)]
const COUNTED: u32 = 22;

/// Where the rows lie, and the line that is a side below the turn.
#[cfg(kernels)]
#[repr(C)]
struct Lines {
    /// The place to the left of the first pixel. Pixels are counted from 1.
    left: *mut u16,
    /// Bytes from a pixel to its depth.
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
    /// Bytes in a row of the band.
    pitch: usize,
    colours: T,
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
    fn lines(&mut self, has_depth: bool) -> Option<Lines> {
        let (first, above, below) = (self.first, self.height, self.turn.height);
        // If so, no sum or product below has overflowed.
        let is_small = first <= MAX_FIRST && above | below <= MAX_HEIGHT && self.width <= MAX_WIDTH;
        let end = self.width.wrapping_mul(first.wrapping_add(above).wrapping_add(below) as usize);
        let fits = end <= self.pixels.len() && (!has_depth || end <= self.depth.len());
        let (pixels, depth) = (self.pixels.as_mut_ptr(), self.depth.as_mut_ptr());
        (is_small && fits).then(|| Lines {
            left: pixels.wrapping_add(self.width.wrapping_mul(first as usize)).wrapping_sub(1),
            delta: depth.expose_provenance().wrapping_sub(pixels.expose_provenance()),
            rest: self.turn.height << COUNTED,
            side: u32::from(self.turn.is_right) << 2,
            line: self.turn.line,
        })
    }

    /// What a kernel reads.
    #[inline(always)]
    fn job<T>(&mut self, has_depth: bool, colours: T) -> Option<Job<T>> {
        let lines = self.lines(has_depth)?;
        Some(Job { count: self.height << COUNTED, pitch: 2 * self.width, colours, lines })
    }
}

/// Fills `rows` by a level and a table of colours, with a depth test if there is a plane of depth. Returns the number of pixels between the sides. If the
/// rows do not lie within the slices, or a limit is exceeded, it is 0, and nothing changes. Returns `None` if there is no kernel for this processor.
#[inline(always)]
#[must_use]
pub fn ramp(rows: Rows<'_>, depth: Option<&mut Plane>, level: &mut Plane, colours: &Table) -> Option<u32> {
    by_kernel!((rows, depth, level, colours), {
        // SAFETY: all rows lie within both slices, whose addresses are exposed; columns are compared with the width; and an index of 10 bits lies within the
        // table.
        match (rows.job(depth.is_some(), colours.as_ptr()), depth) {
            (Some(job), Some(depth)) => unsafe { processor::ramp(rows.sides, depth, level, &job) },
            (Some(job), None) => unsafe { processor::ramp_alone(rows.sides, level, &job) },
            (None, _) => 0,
        }
    })
}

/// Fills `rows` with two colours in turn, the first one in the first row, with a depth test if there is a plane of depth. Returns what [`ramp`] does.
#[inline(always)]
#[must_use]
pub fn solid(rows: Rows<'_>, depth: Option<&mut Plane>, colours: [u16; 2]) -> Option<u32> {
    by_kernel!((rows, depth, colours), {
        let [first, second] = colours;
        // SAFETY: all rows lie within both slices, whose addresses are exposed, and columns are compared with the width.
        match (rows.job(depth.is_some(), u32::from(first) | u32::from(second) << 16), depth) {
            (Some(job), Some(depth)) => unsafe { processor::solid(rows.sides, depth, &job) },
            (Some(job), None) => unsafe { processor::solid_alone(rows.sides, &job) },
            (None, _) => 0,
        }
    })
}

/// Fills `rows` by levels of red, green and blue with 22 fraction bits, with a depth test. Levels are clamped to 8 bits and rounded down to 5, 6 and 5
/// bits. In the first row 8, 4 and 8 times `raise` is added to them; in the next row it is subtracted. `FORMAT` is a [`Format`] as a number. Returns what
/// [`ramp`] does.
#[inline(always)]
#[must_use]
pub fn channels<const FORMAT: u8>(rows: Rows<'_>, depth: &mut Plane, levels: &mut [Plane; 3], raise: i32) -> Option<u32> {
    const { assert!(FORMAT <= Format::Swapped as u8) };
    by_kernel!((rows, depth, levels, raise), {
        let Some(lines) = rows.lines(true) else { return Some(0) };
        let (width, raise) = (rows.width, raise.wrapping_neg());
        let job = Channels { pitch: 2 * width, width, raise, count: rows.height << COUNTED, lines };
        // SAFETY: all rows lie within both slices, whose addresses are exposed, and columns are compared with the width.
        unsafe { processor::channels::<FORMAT>(rows.sides, depth, levels, &job) }
    })
}
