//! Compares each kernel in assembler with the loop that `microphong_kernels` promises, written in Rust: pixels, depth, the memory around them, sides,
//! planes and the count, in random cases. Sides are often beyond the width, or any numbers at all.
//!
//! It prints the number of cases, and the kernel and the number of the first that differs.

#![no_std]
#![no_main]

mod lit;

use core::fmt::{self, Arguments, Write};
use cortex_m_semihosting::{debug, hio};
use microphong_kernels::{
    MAX_FIRST, MAX_HEIGHT, MAX_WIDTH, Order, Plane, Rows, Sides, Turn, WORDS_AVAILABLE, channels, format, ramp, solid,
};

/// Cases for each kernel.
const CASES: u32 = 20_000;

/// Pixels of a band, and untouched pixels before and behind it.
const PIXELS: usize = 600;
const GUARD: usize = 16;

/// Numbers that seem random (Marsaglia, Xorshift RNGs, 2003).
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    fn below(&mut self, end: u32) -> u32 {
        (self.next() >> 8) % end
    }
}

/// Pixel formats.
const RGB565: u32 = format(Order::Rgb, [5, 6, 5]);
const BGR565: u32 = format(Order::Bgr, [5, 6, 5]);
const SWAPPED: u32 = format(Order::Swapped, [5, 6, 5]);
const RGB666: u32 = format(Order::Rgb, [6; 3]);
const RGB888: u32 = format(Order::Rgb, [8; 3]);
const LIGHT565: u32 = format(Order::Light, [5, 6, 5]);
const LIGHT332: u32 = format(Order::Light, [3, 3, 2]);

/// Evaluates an expression, in which `FORMAT` is a constant, for a format.
macro_rules! for_format {
    ($format:expr, $expression:expr) => {
        for_format!($format, $expression, RGB565 BGR565 SWAPPED RGB666 RGB888 LIGHT565 LIGHT332)
    };
    ($format:expr, $expression:expr, $($name:ident)*) => {
        match $format {
            $(crate::$name => {
                const FORMAT: u32 = crate::$name;
                $expression
            })*
            _ => None,
        }
    };
}
use for_format;

/// Bytes of a pixel.
fn bytes(format: u32) -> u8 {
    if matches!(format, RGB565 | BGR565 | SWAPPED) { 2 } else { 4 }
}

/// The pixel of levels with 22 fraction bits.
fn packed(format: u32, levels: [i32; 3]) -> u32 {
    let clamped = |bits: [u32; 3]| [0, 1, 2].map(|k: usize| (levels[k] >> (30 - bits[k])).clamp(0, (1 << bits[k]) - 1) as u32);
    let light = |[red, green, blue]: [u32; 3]| {
        let [r, g, b] = clamped([9; 3]);
        (r - (r >> red)) << 11 | (g - (g >> green)) << 20 | (b - (b >> blue))
    };
    let narrow = || clamped([5, 6, 5]);
    match format {
        BGR565 => narrow()[2] << 11 | narrow()[1] << 5 | narrow()[0],
        RGB666 => clamped([6; 3]).into_iter().fold(0, |pixel, channel| pixel << 6 | channel),
        RGB888 => clamped([8; 3]).into_iter().fold(0, |pixel, channel| pixel << 8 | channel),
        LIGHT565 => light([5, 6, 5]),
        LIGHT332 => light([3, 3, 2]),
        _ => {
            let pixel = narrow()[0] << 11 | narrow()[1] << 5 | narrow()[2];
            if format == SWAPPED { u32::from((pixel as u16).swap_bytes()) } else { pixel }
        }
    }
}

/// Pixels between their guards.
fn within<T>(pixels: &mut [T; PIXELS + 2 * GUARD]) -> &mut [T] {
    &mut pixels[GUARD..][..PIXELS]
}

/// Calls `fill` with pixels of two bytes.
fn as_halfwords<C>(pixels: &mut Padded, fill: impl FnOnce(&mut [u16]) -> C) -> C {
    let mut halfwords = pixels.map(|pixel| pixel as u16);
    let count = fill(within(&mut halfwords));
    *pixels = halfwords.map(u32::from);
    count
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kernel {
    /// Bytes of a pixel, and bits of an index.
    Ramp(u8, u32),
    Solid(u8),
    Channels(u32),
}

impl Kernel {
    fn bytes(self) -> u8 {
        match self {
            Self::Ramp(bytes, _) | Self::Solid(bytes) => bytes,
            Self::Channels(format) => bytes(format),
        }
    }
}

/// Pixels, with guards around them.
type Padded = [u32; PIXELS + 2 * GUARD];

/// What a kernel changes.
#[derive(Clone, PartialEq)]
struct State {
    pixels: Padded,
    depth: [u16; PIXELS + 2 * GUARD],
    sides: Sides,
    plane: Plane,
    levels: [Plane; 3],
}

/// What it does not.
#[derive(Clone, Copy)]
struct Case {
    kernel: Kernel,
    has_depth: bool,
    width: usize,
    first: u32,
    height: u32,
    turn: Turn,
    colours: [u32; 2],
    raise: i32,
}

impl Case {
    /// The count of a kernel.
    fn by_kernel(&self, state: &mut State) -> Option<u32> {
        let &Self { width, first, height, turn, .. } = self;
        let State { pixels, depth, sides, plane, levels } = state;
        let (depth, plane) = (within(depth), if self.has_depth { Some(plane) } else { None });
        let rows = Rows { depth, width, first, height, sides, turn };
        let (level, colours, raise) = (&mut levels[0], self.colours, self.raise);
        match (self.kernel, plane) {
            (Kernel::Ramp(2, _), plane) => as_halfwords(pixels, |pixels| ramp(pixels, rows, plane, level, &HALFWORDS)),
            (Kernel::Ramp(_, 9), plane) => ramp(within(pixels), rows, plane, level, WORDS.first_chunk::<512>().unwrap()),
            (Kernel::Ramp(..), plane) => ramp(within(pixels), rows, plane, level, &WORDS),
            (Kernel::Solid(2), plane) => as_halfwords(pixels, |pixels| solid(pixels, rows, plane, colours)),
            (Kernel::Solid(_), plane) => solid(within(pixels), rows, plane, colours),
            (Kernel::Channels(format), Some(plane)) if bytes(format) == 2 => as_halfwords(
                pixels,
                |pixels| for_format!(format, channels::<FORMAT, _>(pixels, rows, plane, levels, raise), RGB565 BGR565 SWAPPED),
            ),
            (Kernel::Channels(format), Some(plane)) => {
                for_format!(format, channels::<FORMAT, _>(within(pixels), rows, plane, levels, raise), RGB666 RGB888 LIGHT565 LIGHT332)
            }
            (Kernel::Channels(_), None) => None,
        }
    }

    /// The loop in Rust that a kernel replaces; returns the count.
    fn by_loop(&self, state: &mut State) -> u32 {
        let State { pixels, depth, sides, plane, levels } = state;
        let (mut count, mut raise, planes) = (0, self.raise, if matches!(self.kernel, Kernel::Ramp(..)) { 1 } else { 3 });
        for row in 0..self.height + self.turn.height {
            if row == self.height {
                let side = 2 * usize::from(self.turn.is_right);
                sides[side..side + 2].copy_from_slice(&self.turn.line);
            }
            let (left, right) = ((sides[0] >> 21) as usize, (sides[2] >> 21) as usize);
            let start = GUARD + (self.first + row) as usize * self.width;
            if left < right && right <= self.width {
                count += (right - left) as u32;
                for column in (left..right).rev() {
                    let at = |plane: &Plane| plane[0].wrapping_add(plane[1].wrapping_mul(column as i32));
                    let (i, inv_depth) = (start + column, (at(plane) as u32 >> 16) as u16);
                    if self.has_depth && inv_depth <= depth[i] {
                        continue;
                    }
                    if self.has_depth {
                        depth[i] = inv_depth;
                    }
                    pixels[i] = match self.kernel {
                        Kernel::Ramp(2, bits) => HALFWORDS[(at(&levels[0]) as u32 >> (32 - bits)) as usize].into(),
                        Kernel::Ramp(_, bits) => WORDS[(at(&levels[0]) as u32 >> (32 - bits)) as usize],
                        Kernel::Solid(_) => self.colours[row as usize % 2],
                        Kernel::Channels(format) => {
                            // Dither is relative to the step of a channel. Light has none.
                            let steps = match format {
                                LIGHT565 | LIGHT332 => [0; 3],
                                RGB888 => [1; 3],
                                RGB666 => [4; 3],
                                _ => [8, 4, 8],
                            };
                            packed(format, [0, 1, 2].map(|k: usize| at(&levels[k]).wrapping_add(raise.wrapping_mul(steps[k]))))
                        }
                    };
                }
            }
            sides[0] = sides[0].wrapping_add(sides[1]);
            sides[2] = sides[2].wrapping_add(sides[3]);
            if self.has_depth {
                plane[0] = plane[0].wrapping_add(plane[2]);
            }
            if !matches!(self.kernel, Kernel::Solid(_)) {
                levels.iter_mut().take(planes).for_each(|[value, _, down]| *value = value.wrapping_add(*down));
            }
            raise = -raise;
        }
        count
    }
}

/// A line that often lies within `width` columns.
fn line(random: &mut Random, width: usize) -> [u32; 2] {
    if random.below(16) == 0 {
        return [random.next(), random.next()];
    }
    let x = random.below(width as u32 + 2) << 21 | random.next() >> 11;
    [x, (random.next() as i32 >> 8) as u32]
}

fn plane(random: &mut Random, kernel: Kernel) -> Plane {
    let any = random.below(8) == 0 || !matches!(kernel, Kernel::Channels(_));
    // Most levels of channels lie between 0 and 255, and some beside.
    let (value, steps) = if any { (random.next() as i32, 0) } else { ((random.next() >> 2) as i32, 8) };
    [value, random.next() as i32 >> steps, random.next() as i32 >> steps]
}

fn case(random: &mut Random, kernel: Kernel, has_depth: bool) -> Case {
    let width = random.below(40) as usize + 1;
    let rows = (PIXELS / width) as u32;
    let first = random.below(rows.min(8) + 1);
    let height = random.below((rows - first).min(9) + 1);
    let below = random.below((rows - first - height).min(9) + 1);
    let turn = Turn { height: below, is_right: random.below(2) == 1, line: line(random, width) };
    let mask = if kernel.bytes() == 2 { 0xFFFF } else { u32::MAX };
    let colours = [random.next() & mask, random.next() & mask];
    Case { kernel, has_depth, width, first, height, turn, colours, raise: (random.below(3) as i32 - 1) << 20 }
}

/// A line of text in RAM.
struct Line([u8; 240], usize);

impl Write for Line {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.1 + text.len();
        self.0.get_mut(self.1..end).ok_or(fmt::Error)?.copy_from_slice(text.as_bytes());
        self.1 = end;
        Ok(())
    }
}

/// Prints a line on the host, from RAM, because QEMU shows the host no flash of a Cortex-M33. There is nobody to tell if that fails.
fn say(text: Arguments<'_>) {
    let mut line = Line([0; 240], 0);
    let _ = writeln!(line, "{text}");
    let _ = hio::hstdout().map(|mut host| host.write_all(&line.0[..line.1]));
}

static HALFWORDS: [u16; 1024] = {
    let mut table = [0; 1024];
    let mut i = 0;
    while i < table.len() {
        table[i] = (i * 61) as u16;
        i += 1;
    }
    table
};

static WORDS: [u32; 1024] = {
    let mut table = [0; 1024];
    let mut i = 0;
    while i < table.len() {
        table[i] = (i as u32).wrapping_mul(0x3456_789B);
        i += 1;
    }
    table
};

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut random = Random(2_463_534_242);
    let kernels = [
        (Kernel::Ramp(2, 10), true),
        (Kernel::Ramp(2, 10), false),
        (Kernel::Solid(2), true),
        (Kernel::Solid(2), false),
        (Kernel::Channels(RGB565), true),
        (Kernel::Channels(BGR565), true),
        (Kernel::Channels(SWAPPED), true),
        (Kernel::Ramp(4, 9), true),
        (Kernel::Ramp(4, 9), false),
        (Kernel::Ramp(4, 10), true),
        (Kernel::Ramp(4, 10), false),
        (Kernel::Solid(4), true),
        (Kernel::Solid(4), false),
        (Kernel::Channels(RGB666), true),
        (Kernel::Channels(RGB888), true),
        (Kernel::Channels(LIGHT565), true),
        (Kernel::Channels(LIGHT332), true),
    ];
    let kernels = || kernels.into_iter().filter(|(kernel, _)| kernel.bytes() == 2 || WORDS_AVAILABLE);
    let (mut cases, mut pixels) = (0u32, 0u32);
    for (kernel, has_depth) in kernels() {
        for number in 0..CASES {
            let case = case(&mut random, kernel, has_depth);
            let [l, r] = [line(&mut random, case.width), line(&mut random, case.width)];
            let mut state = State {
                pixels: [0x5555; PIXELS + 2 * GUARD],
                depth: [0; PIXELS + 2 * GUARD],
                sides: [l[0], l[1], r[0], r[1]],
                plane: plane(&mut random, Kernel::Solid(2)),
                levels: [plane(&mut random, kernel), plane(&mut random, kernel), plane(&mut random, kernel)],
            };
            let far = random.next() as u16;
            state.depth.iter_mut().step_by(3).for_each(|depth| *depth = far);
            let mut by_loop = state.clone();
            let (count, expected) = (case.by_kernel(&mut state), case.by_loop(&mut by_loop));
            if count != Some(expected) || state != by_loop {
                say(format_args!("{kernel:?} {has_depth} differs in case {number}: count {count:?} {expected}"));
                say(format_args!("{} {} {} {:?}", case.width, case.first, case.height, case.turn));
                say(format_args!("{:x?} {:x?} {:x?} {:x?}", state.sides, by_loop.sides, state.plane, by_loop.plane));
                debug::exit(debug::EXIT_FAILURE);
            }
            cases += 1;
            pixels += expected;
        }
    }
    // Rows that do not fit change nothing: too few pixels, too little depth, and more than each limit.
    let fits = Case {
        kernel: Kernel::Solid(2),
        has_depth: true,
        width: 20,
        first: 10,
        height: 10,
        turn: Turn::default(),
        colours: [0; 2],
        raise: 0,
    };
    let turn = |height| Turn { height, is_right: true, line: [0, 0] };
    let others = [
        Case { width: 21, first: 19, ..fits },
        Case { height: 21, ..fits },
        Case { turn: turn(11), ..fits },
        Case { first: u32::MAX, ..fits },
        Case { height: u32::MAX - 9, ..fits },
        Case { turn: turn(u32::MAX - 19), ..fits },
        Case { width: 0, height: MAX_HEIGHT + 1, ..fits },
        Case { width: 0, turn: turn(MAX_HEIGHT + 1), ..fits },
        Case { width: 0, first: MAX_FIRST + 1, ..fits },
        Case { width: MAX_WIDTH + 1, first: 0, height: 0, ..fits },
        Case { width: usize::MAX / 20 + 1, first: 10, height: 10, ..fits },
    ];
    for (kernel, has_depth) in kernels() {
        for (number, case) in others.iter().enumerate() {
            let case = Case { kernel, has_depth, ..*case };
            let before = State {
                pixels: [0x5555; PIXELS + 2 * GUARD],
                depth: [0; PIXELS + 2 * GUARD],
                sides: [1 << 21, 1 << 20, 12 << 21, 1 << 20],
                plane: [1 << 30, 0, 1],
                levels: [[1 << 29, 1, 1]; 3],
            };
            let mut state = before.clone();
            let count = case.by_kernel(&mut state);
            if count != Some(0) || state != before {
                say(format_args!("{kernel:?} {has_depth} draws rows that do not fit: {number}, count {count:?}"));
                debug::exit(debug::EXIT_FAILURE);
            }
        }
    }
    if microphong_kernels::LIT_AVAILABLE {
        let (lit, lit_pixels) = lit::compare(&mut random);
        (cases, pixels) = (cases + lit, pixels + lit_pixels);
    }
    say(format_args!("{cases} cases of {pixels} pixels are equal"));
    debug::exit(debug::EXIT_SUCCESS);
    loop {
        core::hint::spin_loop();
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    say(format_args!("{info}"));
    debug::exit(debug::EXIT_FAILURE);
    loop {
        core::hint::spin_loop();
    }
}
