//! Kernels for processors with the whole of Thumb-2: Cortex-M3, M4, M7, M33.
//!
//! All kernels are built alike. The state of a row lies on the stack: first what changes from row to row, then by how much, then what stays the same. One
//! instruction loads it, and one stores it stepped. The stack pointer addresses it, so that the pixel loop has all other registers. One word counts two numbers:
//! the rows to come in its upper 10 bits, and the pixels that are done in the bits below. It is in `r0`, and on the stack in `channels`.
//!
//! A pixel of two bytes and its depth lie equally far from the beginnings of their slices. The place of a row is that of its pixels then, and depth is the
//! sum of this place and of the way from pixels to depth. Of pixels of four bytes it is the place of depth, and pixels are the sum of twice this place and
//! of the way from twice the depth to pixels.

use crate::{COUNTED, Channels, FormatParts, Job, Plane, Sides};
use core::arch::naked_asm;

/// Counts down the rows to come. If there are none, the rows below the turn are next, and another line takes the place of one side. At `$rest` bytes from
/// the stack pointer lie the number of these rows, the side, and the line. The steps of the sides lie `$steps` bytes behind their columns.
macro_rules! next_row {
    ($rest:literal, $steps:literal) => {
        concat!(
            "5: subs r0, #{one}\n bcs 1b\n",
            concat!("ldrd r2, r3, [sp, #", $rest, "]\n cbz r2, 6f\n"),
            concat!("ldrd r4, r5, [sp, #", $rest, " + 8]\n"),
            "add r0, r2\n add r3, sp\n",
            concat!("str r4, [r3]\n str r5, [r3, #", $steps, "]\n"),
            concat!("movs r2, #0\n str r2, [sp, #", $rest, "]\n b 1b\n"),
            "6: add r0, #{one}",
        )
    };
}

/// Columns of the row in `r2` and `r3`, and the number of its pixels in `r6`. A row without pixels, or with one beyond the width, is left out. `r1` is the
/// width times two to the power of `$wide`.
macro_rules! columns {
    ($wide:literal) => {
        concat!("lsrs r2, r2, #21\n lsrs r3, r3, #21\n subs r6, r3, r2\n ble 4f\n cmp r3, r1, lsr #", $wide, "\n bhi 4f\n add r0, r6")
    };
}

/// The places to the left of the first pixel in `r2`, and of its depth in `r3`. The column is in `r2`, and the way between them in `$way`.
macro_rules! places {
    ($way:literal) => {
        concat!(
            ".if {bytes} == 4\n",
            concat!("add r3, lr, r2, lsl #1\n add r2, ", $way, ", r3, lsl #1\n"),
            ".else\n",
            concat!("add r2, lr, r2, lsl #1\n add r3, r2, ", $way, "\n"),
            ".endif"
        )
    };
}

/// Loads the columns of left and right, a field, and their steps to the next row, and stores all of it stepped. The field at the right column is then in
/// `r4`, its step to the next column in `r8`, the left column in `r2`, and the number of pixels in `r6`. For `$wide` see [`columns`].
macro_rules! enter_one_field {
    ($wide:literal) => {
        concat!("ldm sp, {{r2-r8}}\n add r5, r2\n add r6, r3\n add r7, r4\n stm sp, {{r5-r7}}\n", columns!($wide), "\n mla r4, r8, r3, r4",)
    };
}

/// Goes on with the next row, or stores sides and field, and returns.
macro_rules! end_one_field {
    () => {
        concat!(
            next_row!(28, 12),
            "\n pop {{r4, r6, r8}}\n ldrd r5, r7, [sp]\n add sp, #32\n pop {{r1, r2}}\n stm r1, {{r4-r7}}\n str r8, [r2]\n pop {{r4-r11, pc}}",
        )
    };
}

/// Fills rows by a table of colours of `BYTES` bytes each. Their number is two to the power of `BITS`, and the index is that many upper bits of a level.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn ramp<const BYTES: u8, const BITS: u8>(
    sides: &mut Sides,
    depth: &mut Plane,
    level: &mut Plane,
    job: &Job<*const ()>,
) -> u32 {
    naked_asm!(
        "push {{r0-r2, r4-r11, lr}}",
        "add r12, r3, #16",
        "ldm r12, {{r4-r8}}",
        "push {{r4-r8}}",
        "ldm r0, {{r4-r7}}",
        "ldm r1, {{r8-r10}}",
        "ldm r2, {{r11, r12, lr}}",
        "push {{r9, r12}}",
        "push {{r5, r7, r10, lr}}",
        "push {{r4, r6, r8, r11}}",
        "ldm r3, {{r0, r1, r12, lr}}",
        "b 5f",
        // Columns of left and right, depth, level; their steps to the next row; the steps of depth and level to the next column.
        "1: ldm sp, {{r2-r11}}",
        "add r6, r2",
        "add r7, r3",
        "add r8, r4",
        "add r9, r5",
        "stm sp, {{r6-r9}}",
        columns!("1"),
        "mla r4, r10, r3, r4",
        "mla r5, r11, r3, r5",
        "ldr r7, [sp, #40]",
        places!("r7"),
        "2: sub r4, r10",
        "ldrh r7, [r3, r6, lsl #1]",
        "sub r5, r11",
        "cmp r7, r4, lsr #16",
        "bcs 3f",
        "lsrs r7, r4, #16",
        "strh r7, [r3, r6, lsl #1]",
        "lsrs r7, r5, #32 - {bits}",
        transfer!("ldr", "r7", "[r12, r7", "]"),
        transfer!("str", "r7", "[r2, r6", "]"),
        "3: subs r6, #1",
        "bne 2b",
        "4: add lr, r1",
        next_row!(44, 16),
        "pop {{r4, r6, r8, r11}}",
        "ldrd r5, r7, [sp]",
        "add sp, #44",
        "pop {{r1-r3}}",
        "stm r1, {{r4-r7}}",
        "str r8, [r2]",
        "str r11, [r3]",
        "pop {{r4-r11, pc}}",
        one = const 1 << COUNTED,
        bytes = const BYTES,
        bits = const BITS,
    )
}

/// [`ramp`] without a depth test.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn ramp_alone<const BYTES: u8, const BITS: u8>(
    sides: &mut Sides,
    level: &mut Plane,
    job: &Job<*const ()>,
) -> u32 {
    naked_asm!(
        "push {{r0, r1, r4-r11, lr}}",
        "add r12, r2, #20",
        "ldm r12, {{r4-r7}}",
        "push {{r4-r7}}",
        "ldm r0, {{r4-r7}}",
        "ldm r1, {{r8-r10}}",
        "push {{r9}}",
        "push {{r5, r7, r10}}",
        "push {{r4, r6, r8}}",
        "ldm r2, {{r0, r1, r12, lr}}",
        "b 5f",
        "1:",
        enter_one_field!("{bytes} / 2"),
        "add r2, lr, r2, lsl #{bytes} / 2",
        "2: sub r4, r8",
        "lsrs r7, r4, #32 - {bits}",
        transfer!("ldr", "r7", "[r12, r7", "]"),
        transfer!("str", "r7", "[r2, r6", "]"),
        "subs r6, #1",
        "bne 2b",
        "4: add lr, r1",
        end_one_field!(),
        one = const 1 << COUNTED,
        bytes = const BYTES,
        bits = const BITS,
    )
}

/// Loads the first words of the job at `$job`: the count to `r0`, the bytes of a row to `r1`, the colour to `r12`, and the place to `lr`. Of colours of four
/// bytes the job has first the bits in which they differ, which are then in `$differing`.
macro_rules! begin_colours {
    ($job:literal, $differing:literal) => {
        concat!(
            concat!(".if {bytes} == 4\n ldm ", $job, ", {{r0, r1, ", $differing, ", r12, lr}}\n"),
            concat!(".else\n ldm ", $job, ", {{r0, r1, r12, lr}}\n .endif"),
        )
    };
}

/// Takes the other colour.
macro_rules! next_colour {
    ($differing:literal) => {
        concat!(".if {bytes} == 4\n eor r12, ", $differing, "\n .else\n ror r12, r12, #16\n .endif")
    };
}

/// Fills rows with one of two colours of `BYTES` bytes in turn. Those of two bytes are the halves of a word, the lower one first.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn solid<const BYTES: u8, C>(sides: &mut Sides, depth: &mut Plane, job: &Job<C>) -> u32 {
    naked_asm!(
        "push {{r0, r1, r4-r11, lr}}",
        "add r12, r2, #12 + 2 * {bytes}",
        "ldm r12, {{r4-r8}}",
        "push {{r5-r8}}",
        "mov r11, r4",
        "ldm r0, {{r4-r7}}",
        "ldm r1, {{r8-r10}}",
        "push {{r9}}",
        "push {{r5, r7, r10}}",
        "push {{r4, r6, r8}}",
        begin_colours!("r2", "r9"),
        "b 5f",
        "1:",
        enter_one_field!("1"),
        places!("r11"),
        "2: sub r4, r8",
        "ldrh r7, [r3, r6, lsl #1]",
        "cmp r7, r4, lsr #16",
        "bcs 3f",
        "lsrs r7, r4, #16",
        "strh r7, [r3, r6, lsl #1]",
        transfer!("str", "r12", "[r2, r6", "]"),
        "3: subs r6, #1",
        "bne 2b",
        "4: add lr, r1",
        next_colour!("r9"),
        end_one_field!(),
        one = const 1 << COUNTED,
        bytes = const BYTES,
    )
}

/// [`solid`] without a depth test.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn solid_alone<const BYTES: u8, C>(sides: &mut Sides, job: &Job<C>) -> u32 {
    naked_asm!(
        "push {{r0, r4-r7, lr}}",
        "add r12, r1, #16 + 2 * {bytes}",
        "ldm r12, {{r4-r7}}",
        "push {{r4-r7}}",
        "ldm r0, {{r4-r7}}",
        "push {{r5, r7}}",
        "push {{r4, r6}}",
        begin_colours!("r1", "r7"),
        "b 5f",
        // Columns of left and right, and their steps to the next row.
        "1: ldm sp, {{r2-r5}}",
        "add r4, r2",
        "add r5, r3",
        "strd r4, r5, [sp]",
        columns!("{bytes} / 2"),
        "add r2, lr, r2, lsl #{bytes} / 2",
        "2:",
        transfer!("str", "r12", "[r2, r6", "]"),
        "subs r6, #1",
        "bne 2b",
        "4: add lr, r1",
        next_colour!("r7"),
        next_row!(16, 8),
        "pop {{r4, r6}}",
        "ldrd r5, r7, [sp]",
        "add sp, #24",
        "pop {{r1}}",
        "stm r1, {{r4-r7}}",
        "pop {{r4-r7, pc}}",
        one = const 1 << COUNTED,
        bytes = const BYTES,
    )
}

/// Fills rows by three levels of 8 integer and 22 fraction bits, which are clamped and packed.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn channels<const FORMAT: u32>(
    sides: &mut Sides,
    depth: &mut Plane,
    levels: &mut [Plane; 3],
    job: &Channels,
) -> u32 {
    assembler!(
        [
        "push {{r0-r2, r4-r11, lr}}",
        "ldm r3, {{r4-r12, lr}}",
        // On the stack: delta, width, raise, count, and the line below the turn.
        "push {{r6, r7, r10-r12, lr}}",
        "push {{r5}}",
        "push {{r9}}",
        "mov lr, r4",
        "mov r3, r8",
        "ldm r2, {{r4-r12}}",
        "ldr r2, [r1, #4]",
        "push {{r2, r5, r8, r11}}",
        "mov r11, r3",
        "ldr r2, [r0, #4]",
        "ldr r3, [r0, #12]",
        "ldr r5, [r1, #8]",
        "push {{r2, r3, r5, r6, r9, r12, lr}}",
        "ldr r3, [r1]",
        "ldr r2, [r0, #8]",
        "ldr r1, [r0]",
        "push {{r1-r4, r7, r10, r11}}",
        "b 4f",
        // Columns of left and right, depth, three levels, the place in memory; their steps to the next row.
        "1: ldm sp, {{r0-r12, lr}}",
        "add r7, r0",
        "add r8, r1",
        "add r9, r2",
        "add r10, r3",
        "add r11, r4",
        "add r12, r5",
        "add lr, r6",
        "stm sp, {{r7-r12, lr}}",
        "lsrs r0, r0, #21",
        "lsrs r1, r1, #21",
        "subs r7, r1, r0",
        "ble 4f",
        // Steps of depth and levels to the next column, the way from pixels to depth, the width.
        "add lr, sp, #56",
        "ldm lr, {{r8-r12, lr}}",
        "cmp r1, lr",
        "bhi 4f",
        "mla r2, r8, r1, r2",
        "mla r3, r9, r1, r3",
        "mla r4, r10, r1, r4",
        "mla r5, r11, r1, r5",
        "add r6, r6, r0, lsl #1",
        ".if {bytes} == 4",
        "add r0, r12, r6, lsl #1",
        "mov r12, r6",
        "mov r6, r0",
        ".else",
        "add r12, r6",
        ".endif",
        "ldrd r0, r1, [sp, #80]",
        ".if {red_shown} == 0",
        "add r3, r3, r0, lsl #8 - {red}",
        "add r4, r4, r0, lsl #8 - {green}",
        "add r5, r5, r0, lsl #8 - {blue}",
        ".endif",
        "add r1, r7",
        "str r1, [sp, #84]",
        "2: sub r2, r8",
        "ldrh r0, [r12, r7, lsl #1]",
        "sub r3, r9",
        "sub r4, r10",
        "sub r5, r11",
        "cmp r0, r2, lsr #16",
        "bcs 3f",
        "lsrs r0, r2, #16",
        "strh r0, [r12, r7, lsl #1]",
        "usat r0, #{red}, r3, asr #30 - {red}",
        "usat r1, #{green}, r4, asr #30 - {green}",
        "usat lr, #{blue}, r5, asr #30 - {blue}",
        join!("r0", "r1"),
        add_blue!("r0", "lr"),
        transfer!("str", "r0", "[r6, r7", "]"),
        "3: subs r7, #1",
        "bne 2b",
        "4: ldrd r1, r0, [sp, #80]",
        "rsbs r1, r1, #0",
        "subs r0, #{one}",
        "strd r1, r0, [sp, #80]",
        "bcs 1b",
        // Below the turn another line is one of the sides.
        "add r2, sp, #88",
        "ldm r2, {{r2-r5}}",
        "cbz r2, 6f",
        "add r0, r2",
        "str r0, [sp, #84]",
        "add r3, sp",
        "str r4, [r3]",
        "str r5, [r3, #28]",
        "movs r2, #0",
        "str r2, [sp, #88]",
        "b 1b",
        "6: add r0, #{one}",
        "ldm sp, {{r4-r9}}",
        "ldrd r10, r11, [sp, #28]",
        "add sp, #104",
        "pop {{r1-r3}}",
        "strd r4, r10, [r1]",
        "strd r5, r11, [r1, #8]",
        "str r6, [r2]",
        "str r7, [r3]",
        "str r8, [r3, #12]",
        "str r9, [r3, #24]",
        "pop {{r4-r11, pc}}",
        ],
        one = const 1 << COUNTED,
    )
}
