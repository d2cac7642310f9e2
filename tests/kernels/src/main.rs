//! Compares each kernel in assembler with the loop that `microphong_kernels` promises, written in Rust: pixels, depth, the memory around them, sides,
//! planes and the count, in random cases. Sides are often beyond the width, or any numbers at all.
//!
//! It prints the number of cases, and the kernel and the number of the first that differs.

#![no_std]
#![no_main]

mod lit;

use core::fmt::{self, Arguments, Write};
use cortex_m_semihosting::{debug, hio};
use microphong_kernels::{Format, MAX_FIRST, MAX_HEIGHT, MAX_WIDTH, Plane, Rows, Sides, Table, Turn, channels, ramp, solid};

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

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kernel {
    Ramp,
    Solid,
    Channels(Format),
}

/// What a kernel changes.
#[derive(Clone, PartialEq)]
struct State {
    pixels: [u16; PIXELS + 2 * GUARD],
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
    colours: [u16; 2],
    raise: i32,
}

impl Case {
    /// The count of a kernel.
    fn by_kernel(&self, state: &mut State, table: &Table) -> Option<u32> {
        let &Self { width, first, height, turn, .. } = self;
        let State { pixels, depth, sides, plane, levels } = state;
        let (pixels, depth) = (&mut pixels[GUARD..][..PIXELS], &mut depth[GUARD..][..PIXELS]);
        let rows = Rows { pixels, depth, width, first, height, sides, turn };
        let depth = if self.has_depth { Some(plane) } else { None };
        match (self.kernel, depth) {
            (Kernel::Ramp, depth) => ramp(rows, depth, &mut levels[0], table),
            (Kernel::Solid, depth) => solid(rows, depth, self.colours),
            (Kernel::Channels(Format::Rgb), Some(depth)) => channels::<{ Format::Rgb as u8 }>(rows, depth, levels, self.raise),
            (Kernel::Channels(Format::Bgr), Some(depth)) => channels::<{ Format::Bgr as u8 }>(rows, depth, levels, self.raise),
            (Kernel::Channels(Format::Swapped), Some(depth)) => channels::<{ Format::Swapped as u8 }>(rows, depth, levels, self.raise),
            (Kernel::Channels(_), None) => None,
        }
    }

    /// The loop in Rust that a kernel replaces; returns the count.
    fn by_loop(&self, state: &mut State, table: &Table) -> u32 {
        let State { pixels, depth, sides, plane, levels } = state;
        let (mut count, mut raise, planes) = (0, self.raise, if self.kernel == Kernel::Ramp { 1 } else { 3 });
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
                    let channel = |k: usize, bits: u32| {
                        let level = at(&levels[k]).wrapping_add(raise << (8 - bits));
                        (level >> (30 - bits)).clamp(0, (1 << bits) - 1) as u16
                    };
                    pixels[i] = match self.kernel {
                        Kernel::Ramp => table[(at(&levels[0]) as u32 >> 22) as usize],
                        Kernel::Solid => self.colours[row as usize % 2],
                        Kernel::Channels(Format::Rgb) => channel(0, 5) << 11 | channel(1, 6) << 5 | channel(2, 5),
                        Kernel::Channels(Format::Bgr) => channel(2, 5) << 11 | channel(1, 6) << 5 | channel(0, 5),
                        Kernel::Channels(Format::Swapped) => (channel(0, 5) << 11 | channel(1, 6) << 5 | channel(2, 5)).swap_bytes(),
                    };
                }
            }
            sides[0] = sides[0].wrapping_add(sides[1]);
            sides[2] = sides[2].wrapping_add(sides[3]);
            if self.has_depth {
                plane[0] = plane[0].wrapping_add(plane[2]);
            }
            if self.kernel != Kernel::Solid {
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
    let colours = [random.next() as u16, random.next() as u16];
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

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut random = Random(2_463_534_242);
    let table: Table = core::array::from_fn(|i| (i * 61) as u16);
    let [rgb, bgr, swapped] = [Format::Rgb, Format::Bgr, Format::Swapped].map(Kernel::Channels);
    let kernels = [
        (Kernel::Ramp, true),
        (Kernel::Ramp, false),
        (Kernel::Solid, true),
        (Kernel::Solid, false),
        (rgb, true),
        (bgr, true),
        (swapped, true),
    ];
    let (mut cases, mut pixels) = (0u32, 0u32);
    for (kernel, has_depth) in kernels {
        for number in 0..CASES {
            let case = case(&mut random, kernel, has_depth);
            let [l, r] = [line(&mut random, case.width), line(&mut random, case.width)];
            let mut state = State {
                pixels: [0x5555; PIXELS + 2 * GUARD],
                depth: [0; PIXELS + 2 * GUARD],
                sides: [l[0], l[1], r[0], r[1]],
                plane: plane(&mut random, Kernel::Ramp),
                levels: [plane(&mut random, kernel), plane(&mut random, kernel), plane(&mut random, kernel)],
            };
            let far = random.next() as u16;
            state.depth.iter_mut().step_by(3).for_each(|depth| *depth = far);
            let mut by_loop = state.clone();
            let (count, expected) = (case.by_kernel(&mut state, &table), case.by_loop(&mut by_loop, &table));
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
    let fits =
        Case { kernel: Kernel::Ramp, has_depth: true, width: 20, first: 10, height: 10, turn: Turn::default(), colours: [0; 2], raise: 0 };
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
    for (kernel, has_depth) in kernels {
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
            let count = case.by_kernel(&mut state, &table);
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
