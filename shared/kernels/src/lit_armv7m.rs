//! Kernels that compute light at each pixel, for processors with the whole of Thumb-2.
//!
//! The state of a triangle lies on the stack: the polynomials of the row, constants, what changes from row to row, its steps, and the line that is a side
//! below the turn. `r10` counts the pixels of a row down to 1. The polynomials are functions of this count. They are evaluated only at pixels that pass the
//! depth test, so a hidden pixel takes six instructions.

use crate::{COUNTED, Fields, Format, LitJob, Plane, Sides};
use core::arch::naked_asm;

/// Bytes of the polynomials of a row: three words of the square, and two of each numerator. Constants follow: the step of the depth, the way from pixels to
/// depth, width, count, colours of this row and of the next, the tables of roots and of highlights, and the place in the latter.
const fn constants(planes: usize) -> usize {
    12 + 8 * planes
}

/// Offset of what changes from row to row: both sides, depth, the square and its slope, the place in memory. Six words of their steps follow, the step of
/// the step of the square, numerators, and steps of numerators.
const fn changing(planes: usize) -> usize {
    constants(planes) + 36
}

/// Offset of the rows below the turn: their number, the side, and the line.
const fn turn(planes: usize) -> usize {
    changing(planes) + 52 + 8 * planes
}

/// Evaluates the numerator whose value to the left of the row and whose step lie at `$from` on the stack, and multiplies it by half the reciprocal length in
/// `r3`. The result is in `$to`, and `$free` is overwritten.
macro_rules! quotient {
    ($to:literal, $free:literal, $from:literal) => {
        concat!(
            concat!("ldrd ", $to, ", ", $free, ", [sp, #", $from, "]\n"),
            concat!("mla ", $to, ", ", $free, ", r10, ", $to, "\n"),
            concat!("smull ", $free, ", ", $to, ", r3, ", $to, "\n"),
        )
    };
}

/// Replaces the quotient in `$highlight` by the highlight. `$top` is the place of a whole highlight in the table, and `r9` is the address of the table.
macro_rules! highlight {
    ($highlight:literal, $top:literal) => {
        concat!(
            concat!("sub ", $highlight, ", ", $top, ", ", $highlight, "\n"),
            concat!("usat ", $highlight, ", #12, ", $highlight, ", asr #8\n"),
            concat!("ldrh ", $highlight, ", [r9, ", $highlight, ", lsl #1]\n"),
        )
    };
}

/// Clamps a level to a cosine.
macro_rules! cosine {
    ($level:literal) => {
        concat!("usat ", $level, ", #15, ", $level, ", asr #11\n")
    };
}

/// Clamps the levels of red in `r3` and of green in `$green`, puts them together in `r3`, does the same with the level of blue in `$green`, which `$blue`
/// computes, and stores the pixel.
macro_rules! pack {
    ($green:literal, $blue:expr) => {
        concat!(
            "usat r3, #5, r3, asr #25\n",
            concat!("usat ", $green, ", #6, ", $green, ", asr #24\n"),
            ".if {format} == {bgr}\n",
            concat!("orr r3, r3, ", $green, ", lsl #5\n"),
            ".else\n",
            concat!("orr r3, ", $green, ", r3, lsl #6\n"),
            ".endif\n",
            $blue,
            concat!("usat ", $green, ", #5, ", $green, ", asr #25\n"),
            ".if {format} == {bgr}\n",
            concat!("orr r3, r3, ", $green, ", lsl #11\n"),
            ".else\n",
            concat!("orr r3, ", $green, ", r3, lsl #5\n"),
            ".endif\n",
            ".if {format} == {swapped}\n rev16 r3, r3\n .endif\n",
            "strh r3, [r0, r10, lsl #1]",
        )
    };
}

/// Defines a kernel for a number of numerators. `$pixel` makes the pixel of number `r10` and stores it at `[r0, r10, lsl #1]`. It finds half the reciprocal
/// length in `r3`, the place in the table of highlights in `r8`, this table in `r9`, the colours of the row in `r12`, and the table of roots in
/// `lr`. It may overwrite `r3` to `r7`. If it overwrites `r9` or `lr`, `$reload` loads them again before each pixel. If it overwrites `r8`, it loads `r8`
/// itself before it uses it.
macro_rules! kernel {
    ($(#[$doc:meta])* $name:ident $(<$format:ident>)?, $planes:literal, $reload:expr, $pixel:expr) => {
        $(#[$doc])*
        #[unsafe(naked)]
        pub(crate) unsafe extern "C" fn $name $(<const $format: u8>)?(
            sides: &mut Sides,
            depth: &mut Plane,
            fields: &mut Fields<'_>,
            job: &LitJob,
        ) -> u32 {
            naked_asm!(
                "push {{r0-r2, r4-r11, lr}}",
                "sub sp, #{turn} + 16",
                "ldm r0, {{r4-r7}}",
                "ldm r1, {{r8-r10}}",
                "add r12, sp, #{changing}",
                "str r9, [sp, #{constants}]",
                "strd r4, r6, [r12]",
                "str r8, [r12, #8]",
                "strd r5, r7, [r12, #24]",
                "str r10, [r12, #32]",
                "ldr r4, [r2, #16]",
                "ldm r4, {{r4-r9}}",
                "strd r4, r7, [r12, #12]",
                "strd r5, r8, [r12, #36]",
                "str r6, [r12, #48]",
                "str r9, [sp, #8]",
                "ldr r4, [r2, #0]\n ldm r4, {{r4-r6}}\n str r5, [sp, #16]\n str r4, [r12, #52]\n str r6, [r12, #52 + 4 * {planes}]",
                ".if {planes} > 1",
                "ldr r4, [r2, #4]\n ldm r4, {{r4-r6}}\n str r5, [sp, #24]\n str r4, [r12, #56]\n str r6, [r12, #56 + 4 * {planes}]",
                ".endif",
                ".if {planes} > 2",
                "ldr r4, [r2, #8]\n ldm r4, {{r4-r6}}\n str r5, [sp, #32]\n str r4, [r12, #60]\n str r6, [r12, #60 + 4 * {planes}]",
                ".endif",
                ".if {planes} > 3",
                "ldr r4, [r2, #12]\n ldm r4, {{r4-r6}}\n str r5, [sp, #40]\n str r4, [r12, #64]\n str r6, [r12, #64 + 4 * {planes}]",
                ".endif",
                "ldm r3!, {{r4-r11}}",
                "strd r4, r5, [sp, #{constants} + 16]",
                "strd r6, r7, [sp, #{constants} + 24]",
                "str r8, [sp, #{constants} + 32]",
                "str r9, [sp, #{constants} + 8]",
                "str r11, [r12, #44]",
                "mov r0, r10",
                "ldm r3, {{r4-r9}}",
                "str r4, [r12, #20]",
                "str r5, [sp, #{constants} + 4]",
                "strd r6, r7, [sp, #{turn}]",
                "strd r8, r9, [sp, #{turn} + 8]",
                "b 5f",
                // Both sides, depth, the square and its slope, the place in memory; their steps to the next row; the step of the step of the square.
                "1: add r12, sp, #{changing}",
                "ldm r12, {{r0-r11, lr}}",
                "add r6, r0",
                "add r7, r1",
                "add r8, r2",
                "add lr, r9",
                "add r9, r3",
                "add r10, r4",
                "add r11, r5",
                "stm r12!, {{r6-r11}}",
                "str lr, [r12, #12]",
                // Numerators, and their steps to the next row.
                ".if {planes} == 1",
                "ldrd r6, r7, [r12, #28]\n add r7, r6\n str r7, [r12, #28]",
                ".endif",
                ".if {planes} == 2",
                "ldrd r6, r7, [r12, #28]\n ldrd r8, r9, [r12, #36]\n add r8, r6\n add r9, r7\n strd r8, r9, [r12, #28]",
                ".endif",
                ".if {planes} == 3",
                "add r12, #28\n ldm r12, {{r6-r11}}\n add r9, r6\n add r10, r7\n add r11, r8\n stm r12, {{r9-r11}}",
                ".endif",
                ".if {planes} == 4",
                "add r12, #28\n ldm r12!, {{r6-r9}}",
                "ldrd r10, r11, [r12]\n add r10, r6\n add r11, r7\n strd r10, r11, [r12, #-16]",
                "ldrd r10, r11, [r12, #8]\n add r10, r8\n add r11, r9\n strd r10, r11, [r12, #-8]",
                ".endif",
                "lsrs r0, r0, #21",
                "lsrs r1, r1, #21",
                "subs r10, r1, r0",
                "ble 4f",
                "ldrd r11, lr, [sp, #{constants} + 8]",
                "cmp r1, r11",
                "bhi 4f",
                "add lr, r10",
                "str lr, [sp, #{constants} + 12]",
                "ldrd r11, lr, [sp, #{constants}]",
                "mla r2, r11, r1, r2",
                "sub r12, r0, #1",
                "add r0, r5, r0, lsl #1",
                "add r1, r0, lr",
                // The square at the place to the left of the row.
                "ldr lr, [sp, #8]",
                "mul lr, lr, r12",
                "add r4, lr",
                "mla r3, r4, r12, r3",
                "add r4, lr",
                "strd r3, r4, [sp]",
                "ldr r3, [sp, #16]\n mla r6, r3, r12, r6\n str r6, [sp, #12]",
                ".if {planes} > 1",
                "ldr r3, [sp, #24]\n mla r7, r3, r12, r7\n str r7, [sp, #20]",
                ".endif",
                ".if {planes} > 2",
                "ldr r3, [sp, #32]\n mla r8, r3, r12, r8\n str r8, [sp, #28]",
                ".endif",
                ".if {planes} > 3",
                "ldr r3, [sp, #40]\n mla r9, r3, r12, r9\n str r9, [sp, #36]",
                ".endif",
                "ldr r12, [sp, #{constants} + 16]",
                "ldrd lr, r9, [sp, #{constants} + 24]",
                "ldr r8, [sp, #{constants} + 32]",
                "2: sub r2, r11",
                "ldrh r3, [r1, r10, lsl #1]",
                "cmp r3, r2, lsr #16",
                "bcs 3f",
                "lsrs r3, r2, #16",
                "strh r3, [r1, r10, lsl #1]",
                "ldm sp, {{r3-r5}}",
                $reload,
                "mla r4, r5, r10, r4",
                "mla r3, r4, r10, r3",
                "lsrs r4, r3, #21",
                "ldr r4, [lr, r4, lsl #2]",
                "ubfx r3, r3, #11, #10",
                "ubfx r5, r4, #0, #10",
                "mls r3, r5, r3, r4",
                $pixel,
                "3: subs r10, #1",
                "bne 2b",
                "4: ldrd r1, r2, [sp, #{constants} + 16]",
                "ldr r0, [sp, #{constants} + 12]",
                "strd r2, r1, [sp, #{constants} + 16]",
                "5: subs r0, #{one}",
                "str r0, [sp, #{constants} + 12]",
                "bcs 1b",
                // Below the turn another line is one of the sides.
                "ldrd r2, r3, [sp, #{turn}]",
                "cbz r2, 6f",
                "ldrd r4, r5, [sp, #{turn} + 8]",
                "add r0, r2",
                "str r0, [sp, #{constants} + 12]",
                "add r3, sp",
                "str r4, [r3, #{changing}]",
                "str r5, [r3, #{changing} + 24]",
                "movs r2, #0",
                "str r2, [sp, #{turn}]",
                "b 1b",
                "6: add r0, #{one}",
                "add r12, sp, #{changing}",
                "add r1, sp, #{turn} + 16",
                "ldm r1, {{r1-r3}}",
                "ldm r12, {{r4-r11}}",
                "strd r4, r10, [r1]",
                "strd r5, r11, [r1, #8]",
                "str r6, [r2]",
                "ldr r4, [r12, #36]",
                "ldr r5, [r3, #16]",
                "strd r7, r4, [r5]",
                "str r8, [r5, #12]",
                "ldr r4, [r12, #52]\n ldr r5, [r3, #0]\n str r4, [r5]",
                ".if {planes} > 1",
                "ldr r4, [r12, #56]\n ldr r5, [r3, #4]\n str r4, [r5]",
                ".endif",
                ".if {planes} > 2",
                "ldr r4, [r12, #60]\n ldr r5, [r3, #8]\n str r4, [r5]",
                ".endif",
                ".if {planes} > 3",
                "ldr r4, [r12, #64]\n ldr r5, [r3, #12]\n str r4, [r5]",
                ".endif",
                "add sp, #{turn} + 28",
                "pop {{r4-r11, pc}}",
                planes = const $planes,
                constants = const constants($planes),
                changing = const changing($planes),
                turn = const turn($planes),
                one = const 1 << COUNTED,
                $(
                    format = const $format,
                    bgr = const Format::Bgr as u8,
                    swapped = const Format::Swapped as u8,
                )?
            )
        }
    };
}

kernel!(
    /// One light, in three channels.
    light<FORMAT>,
    1,
    "",
    concat!(
        quotient!("r4", "r5", 12),
        cosine!("r4"),
        "ldrd r3, r5, [r12]\n mla r3, r5, r4, r3\n",
        "ldrd r5, r6, [r12, #12]\n mla r5, r6, r4, r5\n",
        pack!("r5", "ldrd r5, r6, [r12, #24]\n mla r5, r6, r4, r5\n"),
    )
);

kernel!(
    /// One light with a highlight, in three channels.
    light_and_highlight<FORMAT>,
    2,
    "",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r5", "r6", 20),
        highlight!("r5", "r8"),
        cosine!("r4"),
        "ldm r12, {{r3, r6, r7}}\n mla r3, r6, r4, r3\n mla r3, r7, r5, r3\n",
        "ldrd r6, r7, [r12, #12]\n mla r6, r7, r4, r6\n ldr r7, [r12, #20]\n mla r6, r7, r5, r6\n",
        pack!("r6", "ldrd r6, r7, [r12, #24]\n mla r6, r7, r4, r6\n ldr r7, [r12, #32]\n mla r6, r7, r5, r6\n"),
    )
);

kernel!(
    /// Two lights, in three channels.
    lights<FORMAT>,
    2,
    "",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r5", "r6", 20),
        cosine!("r4"),
        cosine!("r5"),
        "ldrd r3, r6, [r12]\n mla r3, r6, r4, r3\n ldr r6, [r12, #40]\n mla r3, r6, r5, r3\n",
        "ldrd r6, r7, [r12, #12]\n mla r6, r7, r4, r6\n ldr r7, [r12, #52]\n mla r6, r7, r5, r6\n",
        pack!("r6", "ldrd r6, r7, [r12, #24]\n mla r6, r7, r4, r6\n ldr r7, [r12, #64]\n mla r6, r7, r5, r6\n"),
    )
);

kernel!(
    /// Two lights, the first with a highlight, in three channels.
    lights_and_highlight<FORMAT>,
    3,
    "ldr lr, [sp, #{constants} + 24]",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r5", "r6", 20),
        quotient!("r6", "r7", 28),
        highlight!("r5", "r8"),
        cosine!("r4"),
        cosine!("r6"),
        "ldm r12, {{r3, r7, lr}}\n mla r3, r7, r4, r3\n mla r3, lr, r5, r3\n ldr r7, [r12, #40]\n mla r3, r7, r6, r3\n",
        "ldrd lr, r7, [r12, #12]\n mla lr, r7, r4, lr\n ldr r7, [r12, #20]\n mla lr, r7, r5, lr\n",
        "ldr r7, [r12, #52]\n mla lr, r7, r6, lr\n",
        pack!(
            "lr",
            "ldrd lr, r7, [r12, #24]\n mla lr, r7, r4, lr\n ldr r7, [r12, #32]\n mla lr, r7, r5, lr\n ldr r7, [r12, #64]\n mla lr, r7, r6, lr\n"
        ),
    )
);

kernel!(
    /// Two lights with highlights, in three channels.
    lights_and_highlights<FORMAT>,
    4,
    "ldrd lr, r9, [sp, #{constants} + 24]",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r5", "r6", 20),
        quotient!("r6", "r7", 28),
        quotient!("r7", "r8", 36),
        "ldr r8, [sp, #{constants} + 32]\n",
        highlight!("r5", "r8"),
        highlight!("r7", "r8"),
        cosine!("r4"),
        cosine!("r6"),
        "ldm r12, {{r3, r8, r9}}\n mla r3, r8, r4, r3\n mla r3, r9, r5, r3\n",
        "ldrd r8, r9, [r12, #40]\n mla r3, r8, r6, r3\n mla r3, r9, r7, r3\n",
        "ldrd lr, r8, [r12, #12]\n ldr r9, [r12, #20]\n mla lr, r8, r4, lr\n mla lr, r9, r5, lr\n",
        "ldrd r8, r9, [r12, #52]\n mla lr, r8, r6, lr\n mla lr, r9, r7, lr\n",
        pack!(
            "lr",
            concat!(
                "ldrd lr, r8, [r12, #24]\n ldr r9, [r12, #32]\n mla lr, r8, r4, lr\n mla lr, r9, r5, lr\n",
                "ldrd r8, r9, [r12, #64]\n mla lr, r8, r6, lr\n mla lr, r9, r7, lr\n",
            )
        ),
    )
);

/// The colour of a level in `r4`, to which `$add` adds.
macro_rules! colour {
    ($add:literal) => {
        concat!("bic r4, r4, r4, asr #31\n", $add, "\n ubfx r4, r4, #19, #9\n ldrh r4, [r12, r4, lsl #1]\n strh r4, [r0, r10, lsl #1]")
    };
}

kernel!(
    /// One light, by a table of colours. `r8` is the level of ambient light here.
    level,
    1,
    "",
    concat!(quotient!("r4", "r5", 12), colour!("add r4, r8"))
);

kernel!(
    /// One light with a highlight, by a table of colours.
    level_and_highlight,
    2,
    "",
    concat!(quotient!("r4", "r5", 12), quotient!("r5", "r6", 20), highlight!("r5", "r8"), colour!("add r4, r4, r5, lsl #12"))
);
