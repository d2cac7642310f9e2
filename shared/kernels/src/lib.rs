//! Row kernels of `microphong` in assembler.
//!
//! A kernel fills the rows of a triangle between a left and a right side that are stepped from row to row, from right to left in each row, with or
//! without a depth test. A compiler keeps much of the state of such loops in memory and loads it word by word. The kernels load the state of a row by
//! one instruction or by a few, step all of it, and store it likewise.
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

#[cfg(kernels = "armv7m")]
#[path = "lit_armv7m.rs"]
mod lit;

use embedded_graphics_core::pixelcolor::{Bgr565, Rgb565};

/// Whether there are kernels for the processor that is compiled for.
pub const AVAILABLE: bool = cfg!(kernels);

/// Whether [`lit`] and [`lit_ramp`] are among them.
pub const LIT_AVAILABLE: bool = cfg!(kernels = "armv7m");

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

/// What [`lit`] and [`lit_ramp`] read besides sides, depth and fields.
#[cfg(kernels = "armv7m")]
#[repr(C)]
struct LitJob {
    /// For the first row and for the second.
    colours: [*const (); 2],
    roots: *const u32,
    highlights: *const u16,
    /// The place of a whole highlight in their table; for a table of colours without highlights, the level of ambient light.
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

/// Halves of reciprocal roots, Q2.30, by the upper 11 bits of a square. The lower 10 bits of an entry are also a number of their own: how much the value falls
/// in 1/1024 of the way to the next entry.
pub type Roots = [u32; 2048];

/// Highlights, by their place in steps of the table.
pub type Highlights = [u16; 4097];

/// Levels of one light in red, green and blue: ambient light with 22 fraction bits, and the factors of a cosine, Q1.15, and of a highlight.
pub type Sums = [[i32; 3]; 3];

/// Where light at a pixel is looked up.
#[derive(Clone, Copy, Debug)]
pub struct Lookup<'a> {
    /// Half the reciprocal length of a normal by its square.
    pub roots: &'a Roots,
    /// Highlights, if the material has any.
    pub highlights: Option<&'a Highlights>,
    /// The place where a highlight is whole, with 8 fraction bits, from which a quotient is subtracted.
    pub top: i32,
}

/// A quadratic field: its value at column 0 of the coming row, its step to the next row, the step of that step, its slope, the step of the slope to the
/// next row, and half its bend. All sums and products wrap.
pub type Quadric = [i32; 6];

/// Linear numerators in their order, and the quadratic square of the length by which they are divided.
#[derive(Debug, Default)]
#[repr(C)]
pub struct Fields<'a> {
    /// The numerators.
    pub planes: [Option<&'a mut Plane>; 4],
    /// The square.
    pub square: Option<&'a mut Quadric>,
}

#[cfg(kernels = "armv7m")]
impl Fields<'_> {
    /// Whether there are a square and so many numerators.
    #[inline(always)]
    fn has(&self, numerators: usize) -> bool {
        // The test has no loop, so that the compiler decides it.
        let [a, b, c, d] = &self.planes;
        let is_lent = |plane: &Option<&mut Plane>, number| plane.is_some() || numerators < number;
        self.square.is_some() && is_lent(a, 1) && is_lent(b, 2) && is_lent(c, 3) && is_lent(d, 4)
    }
}

#[cfg(kernels = "armv7m")]
impl LitJob {
    /// What a kernel reads; `None` if rows do not lie within the slices.
    #[inline(always)]
    fn new<T>(rows: &mut Rows<'_>, lookup: Lookup<'_>, colours: [*const T; 2]) -> Option<Self> {
        let lines = rows.lines(true)?;
        let Lookup { roots, highlights, top } = lookup;
        let highlights = highlights.map_or(core::ptr::null(), |table| table.as_ptr());
        let (width, count) = (rows.width, rows.height << COUNTED);
        Some(Self { colours: colours.map(<*const T>::cast), roots: roots.as_ptr(), highlights, top, width, count, pitch: 2 * width, lines })
    }
}

/// Fills `rows` by numerators over the root of a square, with a depth test, under one light or two. The numerator of a light comes first. Its quotient is a
/// level with 19 fraction bits, and a cosine of 1 is the level 2^7. If the light has a highlight, the numerator of the highlight follows. Its quotient is a
/// place in the table of highlights. If only one of two lights has a highlight, it is the first. `sums` has colours for the first row and for the second,
/// in turn. `FORMAT` is a [`Format`] as a number. Returns what [`ramp`] does. It is also `None` if fields or highlights are missing.
#[inline(always)]
#[must_use]
pub fn lit<const FORMAT: u8, const LIGHTS: usize, const HIGHLIGHTS: usize>(
    rows: Rows<'_>,
    depth: &mut Plane,
    mut fields: Fields<'_>,
    lookup: Lookup<'_>,
    sums: [&[Sums; LIGHTS]; 2],
) -> Option<u32> {
    const { assert!(FORMAT <= Format::Swapped as u8 && (LIGHTS == 1 || LIGHTS == 2) && HIGHLIGHTS <= LIGHTS) };
    #[cfg(kernels = "armv7m")]
    {
        let mut rows = rows;
        if !fields.has(LIGHTS + HIGHLIGHTS) || HIGHLIGHTS > 0 && lookup.highlights.is_none() {
            return None;
        }
        let Some(job) = LitJob::new(&mut rows, lookup, sums.map(core::ptr::from_ref)) else { return Some(0) };
        // SAFETY: all rows lie within both slices, whose addresses are exposed, and columns are compared with the width; an index of 11 bits lies within the
        // roots, and one of 12 bits within the highlights; there are all fields that the kernel steps, and factors of all lights.
        unsafe {
            Some(match (LIGHTS, HIGHLIGHTS) {
                (1, 0) => lit::light::<FORMAT>(rows.sides, depth, &mut fields, &job),
                (1, 1) => lit::light_and_highlight::<FORMAT>(rows.sides, depth, &mut fields, &job),
                (2, 0) => lit::lights::<FORMAT>(rows.sides, depth, &mut fields, &job),
                (2, 1) => lit::lights_and_highlight::<FORMAT>(rows.sides, depth, &mut fields, &job),
                (2, 2) => lit::lights_and_highlights::<FORMAT>(rows.sides, depth, &mut fields, &job),
                _ => return None,
            })
        }
    }
    #[cfg(not(kernels = "armv7m"))]
    {
        let _ = (rows, depth, &mut fields, lookup, sums);
        None
    }
}

/// Fills `rows` as [`lit`] does, under one light of one channel. A negative level counts as 0. With a highlight, 2^12 times the entry of the table is added to
/// the level; entries include ambient light. Without one, [`Lookup::top`] is added, which is the level of ambient light. Bits 19 to 27 of the sum are the
/// index of a colour in `ramps`, which are for the first row and for the second, in turn.
#[inline(always)]
#[must_use]
pub fn lit_ramp<const HIGHLIGHTS: usize>(
    rows: Rows<'_>,
    depth: &mut Plane,
    mut fields: Fields<'_>,
    lookup: Lookup<'_>,
    ramps: [&[u16; 512]; 2],
) -> Option<u32> {
    const { assert!(HIGHLIGHTS <= 1) };
    #[cfg(kernels = "armv7m")]
    {
        let mut rows = rows;
        if !fields.has(1 + HIGHLIGHTS) || HIGHLIGHTS > 0 && lookup.highlights.is_none() {
            return None;
        }
        let Some(job) = LitJob::new(&mut rows, lookup, ramps.map(|ramp| ramp.as_ptr())) else { return Some(0) };
        // SAFETY: as in `lit`; an index of 9 bits lies within a table of colours.
        unsafe {
            Some(if HIGHLIGHTS == 0 {
                lit::level(rows.sides, depth, &mut fields, &job)
            } else {
                lit::level_and_highlight(rows.sides, depth, &mut fields, &job)
            })
        }
    }
    #[cfg(not(kernels = "armv7m"))]
    {
        let _ = (rows, depth, &mut fields, lookup, ramps);
        None
    }
}
