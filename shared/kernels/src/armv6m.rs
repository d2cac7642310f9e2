//! Kernels for the small instruction set of Armv6-M: Cortex-M0, M0+, M1.
//!
//! All kernels are built alike. The state of a row lies on the stack: first what changes from row to row, then by how much, then what stays the same. Only
//! eight registers take part in most operations, so the others hold what is added or compared. Unless a kernel says otherwise, `r8` and `r9` hold the
//! negative steps to the next column or colours, `r10` the place behind the last row above the turn, `r11` the width, `r12` the place of the row, and `lr`
//! the number of pixels that are done.

use crate::{Channels, FormatParts, Job, Plane, Sides};
use core::arch::naked_asm;

/// Saves `r4` to `r11`, behind the given arguments.
macro_rules! save {
    ($arguments:literal) => {
        concat!("push {{", $arguments, ", r4-r7, lr}}\n mov r4, r8\n mov r5, r9\n mov r6, r10\n mov r7, r11\n push {{r4-r7}}")
    };
}

/// Reads the job at `r3` up to the band: the row to `r12`, the end of the rows above the turn to `r10`, the width to `r11`, zero to `lr`, and the colours to
/// `r6`. `r3` then points to the way from pixels to depth.
macro_rules! job {
    () => {
        "ldm r3!, {{r4-r7}}\n mov r12, r7\n lsrs r4, r4, #22\n muls r4, r5, r4\n adds r4, r7\n mov r10, r4\n lsrs r5, r5, #1\n mov r11, r5\n movs r4, #0\n mov lr, r4"
    };
}

/// Goes on with the next row. If it lies below the turn, another line takes the place of one side. At `$rest` bytes from the stack pointer lie the number
/// of rows below the turn, the side, and the line. The steps of the sides lie `$steps` bytes behind their columns.
macro_rules! next_row {
    ($rest:literal, $steps:literal) => {
        concat!(
            "5: cmp r12, r10\n bne 1b\n",
            concat!("ldr r0, [sp, #", $rest, "]\n lsrs r0, r0, #22\n beq 6f\n"),
            "mov r1, r11\n lsls r1, r1, #1\n muls r0, r1, r0\n add r10, r0\n",
            concat!("ldr r1, [sp, #", $rest, " + 4]\n add r1, sp\n ldr r2, [sp, #", $rest, " + 8]\n str r2, [r1]\n"),
            concat!("ldr r2, [sp, #", $rest, " + 12]\n str r2, [r1, #", $steps, "]\n"),
            concat!("movs r0, #0\n str r0, [sp, #", $rest, "]\n b 1b\n"),
            "6: mov r0, lr",
        )
    };
}

/// Columns of the row in `r1` and `r2`, and the number of its pixels in `$count`. A row without pixels, or with one beyond the width, is left out.
macro_rules! columns {
    ($count:literal) => {
        concat!(
            "lsrs r1, r1, #21\n lsrs r2, r2, #21\n",
            concat!("subs ", $count, ", r2, r1\n ble 4f\n cmp r2, r11\n bhi 4f\n add lr, ", $count),
        )
    };
}

/// The level in `$from`, shifted to the right by `$shift` and clamped from 0 to `$most`, in `$to`.
macro_rules! clamped {
    ($to:literal, $from:literal, $shift:literal, $most:literal) => {
        concat!(
            concat!("asrs ", $to, ", ", $from, ", #", $shift, "\n bpl 14f\n movs ", $to, ", #0\n"),
            concat!("14: cmp ", $to, ", #", $most, "\n ble 15f\n movs ", $to, ", #", $most, "\n15:"),
        )
    };
}

/// Stores the sides, whose columns are in `r4` and `r5` and whose steps lie at the stack pointer, `$saved` bytes below the saved registers.
macro_rules! stored {
    ($saved:literal) => {
        concat!(
            concat!("ldr r2, [sp]\n ldr r3, [sp, #4]\n add sp, #", $saved, "\n ldr r1, [sp, #16]\n"),
            "str r4, [r1]\n str r2, [r1, #4]\n str r5, [r1, #8]\n str r3, [r1, #12]",
        )
    };
}

/// Restores `r4` to `r11`, and returns.
macro_rules! restore {
    ($arguments:literal) => {
        concat!("pop {{r4-r7}}\n mov r8, r4\n mov r9, r5\n mov r10, r6\n mov r11, r7\n add sp, #", $arguments, "\n pop {{r4-r7, pc}}")
    };
}

/// Reads sides, one field and the job, and puts them on the stack and into registers. The field is at `r1` and the job at `r2`.
macro_rules! begin_one_field {
    () => {
        concat!(
            save!("r0, r1"),
            "\n mov r3, r2\n",
            job!(),
            "\n mov r9, r6\n ldm r3, {{r3-r7}}\n push {{r3-r7}}\n",
            "ldm r1!, {{r3-r5}}\n rsbs r4, r4, #0\n mov r8, r4\n",
            "ldr r1, [r0, #4]\n ldr r2, [r0, #12]\n push {{r1, r2, r5}}\n",
            "ldr r1, [r0]\n ldr r2, [r0, #8]\n push {{r1-r3}}\n b 5f",
        )
    };
}

/// Loads the columns of left and right, a field, and their steps to the next row, and stores all of it stepped. The field at the right column is then in
/// `r3`, the place to the left of the first pixel in `r1`, and the number of pixels in `r5`.
macro_rules! enter_one_field {
    () => {
        concat!(
            "mov r0, sp\n ldm r0!, {{r1-r6}}\n adds r4, r1\n adds r5, r2\n adds r6, r3\n mov r0, sp\n stm r0!, {{r4-r6}}\n",
            columns!("r5"),
            "\n mov r6, r8\n muls r6, r2, r6\n subs r3, r3, r6\n lsls r1, r1, #1\n add r1, r12",
        )
    };
}

/// Goes on with the next row, or stores sides and field, and returns.
macro_rules! end_one_field {
    () => {
        concat!(next_row!(28, 12), "\n pop {{r4-r6}}\n", stored!(32), "\n ldr r1, [sp, #20]\n str r6, [r1]\n", restore!(8))
    };
}

/// Fills rows by a table of 1024 colours, whose index is the upper 10 bits of a level.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn ramp<const BYTES: u8, const BITS: u8>(
    sides: &mut Sides,
    depth: &mut Plane,
    level: &mut Plane,
    job: &Job<*const ()>,
) -> u32 {
    naked_asm!(
        save!("r0-r2"),
        job!(),
        "mov r9, r6",
        "ldm r3, {{r3-r7}}",
        "push {{r3-r7}}",
        "mov r3, r9",
        "push {{r3}}",
        "ldm r2!, {{r3-r5}}",
        "ldr r6, [r1]",
        "ldr r7, [r1, #8]",
        "ldr r1, [r1, #4]",
        "rsbs r1, r1, #0",
        "mov r8, r1",
        "rsbs r4, r4, #0",
        "mov r9, r4",
        "mov r4, r7",
        "ldr r1, [r0, #4]",
        "ldr r2, [r0, #12]",
        "push {{r1, r2, r4, r5}}",
        "mov r7, r3",
        "ldr r1, [r0]",
        "ldr r2, [r0, #8]",
        "push {{r1, r2, r6, r7}}",
        "b 5f",
        // Columns of left and right, depth, level; their steps to the next row.
        "1: mov r0, sp",
        "ldm r0!, {{r1-r7}}",
        "ldr r0, [r0]",
        "adds r5, r1",
        "adds r6, r2",
        "adds r7, r3",
        "adds r0, r4",
        "str r5, [sp]",
        "str r6, [sp, #4]",
        "str r7, [sp, #8]",
        "str r0, [sp, #12]",
        columns!("r5"),
        "mov r6, r8",
        "muls r6, r2, r6",
        "subs r3, r3, r6",
        "mov r6, r9",
        "muls r6, r2, r6",
        "subs r4, r4, r6",
        "lsls r1, r1, #1",
        "add r1, r12",
        "ldr r0, [sp, #32]",
        "ldr r2, [sp, #36]",
        "adds r2, r1",
        "lsls r5, r5, #1",
        "2: add r3, r8",
        "add r4, r9",
        "ldrh r6, [r2, r5]",
        "lsrs r7, r3, #16",
        "cmp r6, r7",
        "bcs 3f",
        "strh r7, [r2, r5]",
        "lsrs r6, r4, #22",
        "lsls r6, r6, #1",
        "ldrh r6, [r0, r6]",
        "strh r6, [r1, r5]",
        "3: subs r5, #2",
        "bne 2b",
        "4: add r12, r11",
        "add r12, r11",
        next_row!(40, 16),
        "pop {{r4-r7}}",
        stored!(40),
        "ldr r1, [sp, #20]",
        "str r6, [r1]",
        "ldr r1, [sp, #24]",
        "str r7, [r1]",
        restore!(12),
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
        begin_one_field!(),
        "1:",
        enter_one_field!(),
        "mov r0, r9",
        "lsls r5, r5, #1",
        "2: add r3, r8",
        "lsrs r6, r3, #22",
        "lsls r6, r6, #1",
        "ldrh r6, [r0, r6]",
        "strh r6, [r1, r5]",
        "subs r5, #2",
        "bne 2b",
        "4: add r12, r11",
        "add r12, r11",
        end_one_field!(),
    )
}

/// Fills rows with one of two colours in turn, in the halves of a word; the lower one first.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn solid<const BYTES: u8, C>(sides: &mut Sides, depth: &mut Plane, job: &Job<C>) -> u32 {
    naked_asm!(
        begin_one_field!(),
        "1:",
        enter_one_field!(),
        "ldr r2, [sp, #24]",
        "adds r2, r1",
        "mov r0, r9",
        "lsls r5, r5, #1",
        "2: add r3, r8",
        "ldrh r6, [r2, r5]",
        "lsrs r7, r3, #16",
        "cmp r6, r7",
        "bcs 3f",
        "strh r7, [r2, r5]",
        "strh r0, [r1, r5]",
        "3: subs r5, #2",
        "bne 2b",
        "4: add r12, r11",
        "add r12, r11",
        "mov r0, r9",
        "movs r1, #16",
        "rors r0, r1",
        "mov r9, r0",
        end_one_field!(),
    )
}

/// [`solid`] without a depth test.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn solid_alone<const BYTES: u8, C>(sides: &mut Sides, job: &Job<C>) -> u32 {
    naked_asm!(
        save!("r0"),
        "mov r3, r1",
        job!(),
        "mov r9, r6",
        "ldm r3, {{r3-r7}}",
        "push {{r4-r7}}",
        "ldr r1, [r0, #4]",
        "ldr r2, [r0, #12]",
        "push {{r1, r2}}",
        "ldr r1, [r0]",
        "ldr r2, [r0, #8]",
        "push {{r1, r2}}",
        "b 5f",
        // Columns of left and right, and their steps to the next row.
        "1: mov r0, sp",
        "ldm r0!, {{r1-r4}}",
        "adds r3, r1",
        "adds r4, r2",
        "mov r0, sp",
        "stm r0!, {{r3, r4}}",
        columns!("r5"),
        "lsls r1, r1, #1",
        "add r1, r12",
        "mov r0, r9",
        "lsls r5, r5, #1",
        "2: strh r0, [r1, r5]",
        "subs r5, #2",
        "bne 2b",
        "4: add r12, r11",
        "add r12, r11",
        "mov r0, r9",
        "movs r1, #16",
        "rors r0, r1",
        "mov r9, r0",
        next_row!(16, 8),
        "pop {{r4, r5}}",
        stored!(24),
        restore!(4),
    )
}

/// Fills rows by three levels of 8 integer and 22 fraction bits, which are clamped and packed. All steps to the next column are in `r8` to `r11`, the way
/// from pixels to depth in `r12`, and the place to the left of the row in `lr`; what other kernels have there lies on the stack.
#[unsafe(naked)]
pub(crate) unsafe extern "C" fn channels<const FORMAT: u32>(
    sides: &mut Sides,
    depth: &mut Plane,
    levels: &mut [Plane; 3],
    job: &Channels,
) -> u32 {
    naked_asm!(
        save!("r0-r2"),
        // On the stack from 48 on: raise, pitch, width, row, end, done, and the line below the turn.
        "ldm r3!, {{r4-r7}}",
        "mov r9, r4",
        "mov r10, r5",
        "mov r11, r6",
        "lsrs r7, r7, #22",
        "muls r7, r4, r7",
        "ldm r3!, {{r6}}",
        "adds r7, r6",
        "mov r8, r6",
        "mov lr, r7",
        "ldm r3, {{r3-r7}}",
        "mov r12, r3",
        "push {{r4-r7}}",
        "mov r4, r8",
        "mov r5, lr",
        "movs r6, #0",
        "push {{r4-r6}}",
        "mov r4, r11",
        "mov r5, r9",
        "mov r6, r10",
        "push {{r4-r6}}",
        // Three levels, their steps to the next row, and to the next column.
        "mov r3, r2",
        "ldr r4, [r3, #8]",
        "ldr r5, [r3, #20]",
        "ldr r6, [r3, #32]",
        "push {{r4-r6}}",
        "ldr r4, [r3]",
        "ldr r5, [r3, #12]",
        "ldr r6, [r3, #24]",
        "push {{r4-r6}}",
        "ldr r4, [r3, #4]",
        "rsbs r4, r4, #0",
        "mov r9, r4",
        "ldr r4, [r3, #16]",
        "rsbs r4, r4, #0",
        "mov r10, r4",
        "ldr r4, [r3, #28]",
        "rsbs r4, r4, #0",
        "mov r11, r4",
        // Columns of left and right, depth, and their steps to the next row.
        "ldm r1!, {{r3-r5}}",
        "rsbs r4, r4, #0",
        "mov r8, r4",
        "ldr r1, [r0, #4]",
        "ldr r2, [r0, #12]",
        "push {{r1, r2, r5}}",
        "ldr r1, [r0]",
        "ldr r2, [r0, #8]",
        "push {{r1-r3}}",
        "b 5f",
        "1: ldr r0, [sp, #48]",
        "rsbs r0, r0, #0",
        "str r0, [sp, #48]",
        "mov r0, sp",
        "ldm r0!, {{r1-r3}}",
        "lsrs r1, r1, #21",
        "lsrs r2, r2, #21",
        "subs r7, r2, r1",
        "ble 4f",
        "ldr r4, [sp, #56]",
        "cmp r2, r4",
        "bhi 4f",
        "ldr r4, [sp, #68]",
        "adds r4, r7",
        "str r4, [sp, #68]",
        "adds r0, #12",
        "ldm r0!, {{r4-r6}}",
        "mov r0, r8",
        "muls r0, r2, r0",
        "subs r3, r3, r0",
        "mov r0, r9",
        "muls r0, r2, r0",
        "subs r4, r4, r0",
        "mov r0, r10",
        "muls r0, r2, r0",
        "subs r5, r5, r0",
        "mov r0, r11",
        "muls r0, r2, r0",
        "subs r6, r6, r0",
        "ldr r0, [sp, #48]",
        "lsls r0, r0, #2",
        "adds r5, r5, r0",
        "lsls r0, r0, #1",
        "adds r4, r4, r0",
        "adds r6, r6, r0",
        "ldr r0, [sp, #60]",
        "lsls r1, r1, #1",
        "adds r1, r0",
        "mov lr, r1",
        "lsls r7, r7, #1",
        "adds r7, r1",
        "2: add r3, r8",
        "add r4, r9",
        "add r5, r10",
        "add r6, r11",
        "mov r2, r12",
        "ldrh r0, [r7, r2]",
        "lsrs r1, r3, #16",
        "cmp r0, r1",
        "bcs 3f",
        "strh r1, [r7, r2]",
        "mov r0, r4",
        "orrs r0, r5",
        "orrs r0, r6",
        "lsrs r0, r0, #30",
        "bne 7f",
        "lsrs r0, r4, #25",
        "lsrs r1, r5, #24",
        "lsrs r2, r6, #25",
        "8:",
        ".if {blue_at}",
        "lsls r2, r2, #11",
        ".else",
        "lsls r0, r0, #11",
        ".endif",
        "lsls r1, r1, #5",
        "orrs r0, r1",
        "orrs r0, r2",
        ".if {is_swapped}",
        "rev16 r0, r0",
        ".endif",
        "strh r0, [r7]",
        "3: subs r7, #2",
        "cmp r7, lr",
        "bne 2b",
        "4: mov r0, sp",
        "ldm r0!, {{r1-r6}}",
        "adds r1, r4",
        "adds r2, r5",
        "adds r3, r6",
        "subs r0, #24",
        "stm r0!, {{r1-r3}}",
        "adds r0, #12",
        "ldm r0!, {{r1-r6}}",
        "adds r1, r4",
        "adds r2, r5",
        "adds r3, r6",
        "subs r0, #24",
        "stm r0!, {{r1-r3}}",
        "ldr r0, [sp, #60]",
        "ldr r1, [sp, #52]",
        "adds r0, r1",
        "str r0, [sp, #60]",
        "5: ldr r0, [sp, #60]",
        "ldr r1, [sp, #64]",
        "cmp r0, r1",
        "bne 1b",
        // Below the turn another line is one of the sides.
        "ldr r0, [sp, #72]",
        "lsrs r0, r0, #22",
        "beq 6f",
        "ldr r2, [sp, #52]",
        "muls r0, r2, r0",
        "adds r1, r0",
        "str r1, [sp, #64]",
        "ldr r1, [sp, #76]",
        "add r1, sp",
        "ldr r2, [sp, #80]",
        "str r2, [r1]",
        "ldr r2, [sp, #84]",
        "str r2, [r1, #12]",
        "movs r0, #0",
        "str r0, [sp, #72]",
        "b 1b",
        // A level above 255 or below zero.
        "7:",
        clamped!("r0", "r4", 25, 31),
        clamped!("r1", "r5", 24, 63),
        clamped!("r2", "r6", 25, 31),
        "b 8b",
        "6: ldr r0, [sp, #68]",
        "ldr r1, [sp, #104]",
        "ldr r2, [sp]",
        "str r2, [r1]",
        "ldr r2, [sp, #12]",
        "str r2, [r1, #4]",
        "ldr r2, [sp, #4]",
        "str r2, [r1, #8]",
        "ldr r2, [sp, #16]",
        "str r2, [r1, #12]",
        "ldr r1, [sp, #108]",
        "ldr r2, [sp, #8]",
        "str r2, [r1]",
        "ldr r1, [sp, #112]",
        "ldr r2, [sp, #24]",
        "str r2, [r1]",
        "ldr r2, [sp, #28]",
        "str r2, [r1, #12]",
        "ldr r2, [sp, #32]",
        "str r2, [r1, #24]",
        "add sp, #88",
        restore!(12),
        blue_at = const FormatParts::of(FORMAT).lowest[2],
        is_swapped = const FormatParts::of(FORMAT).is_swapped,
    )
}
