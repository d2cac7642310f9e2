//! Kernels that compute light at each pixel, for processors with the whole of Thumb-2.
//!
//! The state of a triangle lies on the stack: the polynomials of the row, constants, what changes from row to row, its steps, and the line that is a side
//! below the turn. `r10` counts the pixels of a row down to 1. The polynomials are functions of this count. They are evaluated only at pixels that pass the
//! depth test, so a hidden pixel takes six instructions.

use crate::{COUNTED, Fields, FormatParts, LitJob, Plane, Sides};

/// Offset of the numerators, each: its slope, its value to the left of the row, its value at column 0 of the coming row, and its step to the next row. Three
/// words of each quadratic precede them: its value to the left of the row, its slope there, and half its bend.
const fn numerators(seconds: usize) -> usize {
    12 + 12 * seconds
}

/// Offset of constants: the step of the depth, the way from pixels to depth, width, count, colours of this row and of the next, the tables of roots and of
/// highlights, and the place in the latter. They follow the numerators and, if there is one, the second quadratic at column 0 of the coming row: its value, its
/// step, its slope, the step of the step, that of the slope.
const fn constants(planes: usize, seconds: usize) -> usize {
    numerators(seconds) + 16 * planes + 20 * seconds
}

/// Offset of what changes from row to row: both sides, depth, the first quadratic and its slope, the place in memory. Six words of their steps follow, and the
/// step of the step of the quadratic.
const fn changing(planes: usize, seconds: usize) -> usize {
    constants(planes, seconds) + 36
}

/// Offset of the rows below the turn: their number, the side, and the line.
const fn turn(planes: usize, seconds: usize) -> usize {
    changing(planes, seconds) + 52
}

/// Evaluates the numerator whose slope and whose value to the left of the row lie at `$from` on the stack. The result is in `$to`, and `$free` is overwritten.
macro_rules! linear {
    ($to:literal, $free:literal, $from:literal) => {
        concat!("ldrd ", $free, ", ", $to, ", [sp, #", $from, "]\n mla ", $to, ", ", $free, ", r10, ", $to, "\n")
    };
}

/// Evaluates a numerator as [`linear`] does, and multiplies it by half the reciprocal length in `r3`.
macro_rules! quotient {
    ($to:literal, $free:literal, $from:literal) => {
        concat!(linear!($to, $free, $from), "smull ", $free, ", ", $to, ", r3, ", $to, "\n")
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
            "usat r3, #{red}, r3, asr #30 - {red}\n",
            concat!("usat ", $green, ", #{green}, ", $green, ", asr #30 - {green}\n"),
            join!("r3", $green),
            $blue,
            concat!("usat ", $green, ", #{blue}, ", $green, ", asr #30 - {blue}\n"),
            add_blue!("r3", $green),
            transfer!("str", "r3", "[r0, r10", "]"),
        )
    };
}

/// Stores the depth of the pixel. `r3` is overwritten.
macro_rules! store_depth {
    () => {
        "lsrs r3, r2, #16\n strh r3, [r1, r10, lsl #1]\n"
    };
}

/// Defines a kernel of Phong shading for numerators of these numbers, and the square of a length. `$pixel` is that of [`rows`]. It finds half the reciprocal
/// length in `r3`, the place in the table of highlights in `r8`, this table in `r9`, and the table of roots in `lr`. If it overwrites `r9` or `lr`, `$reload`
/// loads them again before each pixel. `r8` is not loaded again: a pixel that overwrites it reads the place from the stack.
macro_rules! kernel {
    ($(#[$doc:meta])* $name:ident, [$($number:literal)*], $reload:expr, $pixel:expr) => {
        rows!(
            $(#[$doc])*
            $name,
            [],
            [$($number)*],
            "ldrd lr, r9, [sp, #{constants} + 24]\n ldr r8, [sp, #{constants} + 32]",
            concat!(
                store_depth!(),
                "ldm sp, {{r3-r5}}\n",
                $reload,
                "\n mla r4, r5, r10, r4\n mla r3, r4, r10, r3\n",
                "lsrs r4, r3, #21\n ldr r4, [lr, r4, lsl #2]\n",
                "ubfx r3, r3, #11, #10\n ubfx r5, r4, #0, #10\n mls r3, r5, r3, r4\n",
                $pixel,
            )
        );
    };
}

/// Defines a kernel for one quadratic and for the numerators of these numbers. `$second` is 1 if there is a second quadratic, otherwise there is none. `$enter`
/// loads what each pixel of a row needs. `$pixel` makes the pixel of number `r10`, and stores it by [`transfer`] and its depth by [`store_depth`]. It
/// goes to 3 before that if the surface has a hole there. It finds the colours of the row in `r12`. It may overwrite `r3` to `r9` and `lr`, but none of `r0`
/// to `r2` and `r10` to `r12`.
macro_rules! rows {
    (
        $(#[$doc:meta])* $name:ident, [$($second:literal)?], [$($number:literal)*], $enter:expr, $pixel:expr
    ) => {
        $(#[$doc])*
        #[unsafe(naked)]
        pub(crate) unsafe extern "C" fn $name<const FORMAT: u32>(
            sides: &mut Sides,
            depth: &mut Plane,
            fields: &mut Fields<'_>,
            job: &LitJob,
        ) -> u32 {
            assembler!(
                [
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
                "ldr r4, [r2]",
                "ldm r4, {{r4-r9}}",
                "strd r4, r7, [r12, #12]",
                "strd r5, r8, [r12, #36]",
                "str r6, [r12, #48]",
                "str r9, [sp, #8]",
                $(
                    concat!("ldr r4, [r2, #4 * ", $second, "]\n ldm r4, {{r4-r9}}\n str r9, [sp, #8 + 12 * ", $second, "]"),
                    "add r9, sp, #{constants} - 20\n strd r4, r5, [r9]\n strd r7, r6, [r9, #8]\n str r8, [r9, #16]",
                )?
                $(
                    concat!("ldr r4, [r2, #8 + 4 * ", $number, "]\n ldm r4, {{r4-r6}}"),
                    concat!("str r5, [sp, #{numerators} + 16 * ", $number, "]"),
                    concat!("strd r4, r6, [sp, #{numerators} + 8 + 16 * ", $number, "]"),
                )*
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
                // Both sides, depth, the first quadratic and its slope, the place in memory; their steps to the next row; the step of the quadratic's step.
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
                "lsrs r0, r0, #21",
                "lsrs r1, r1, #21",
                "sub r12, r0, #1",
                // Numerators to the left of the row, and on the next row.
                "add r11, sp, #{numerators}",
                $(
                    "ldm r11!, {{r6-r9}}\n mla r7, r6, r12, r8\n add r8, r9",
                    concat!("strd r7, r8, [sp, #{numerators} + 4 + 16 * ", $number, "]"),
                )*
                // The second quadratic likewise.
                $(
                    "ldm r11, {{r6-r9, lr}}\n add r9, r7\n add r7, r6\n add lr, r8\n stm r11, {{r7, r9, lr}}",
                    concat!("ldr r9, [sp, #8 + 12 * ", $second, "]\n mul r9, r9, r12\n add r8, r9\n mla r6, r8, r12, r6"),
                    concat!("add r8, r9\n strd r6, r8, [sp, #12 * ", $second, "]"),
                )?
                "subs r10, r1, r0",
                "ble 4f",
                "ldrd r11, lr, [sp, #{constants} + 8]",
                "cmp r1, r11",
                "bhi 4f",
                "add lr, r10",
                "str lr, [sp, #{constants} + 12]",
                "ldrd r11, lr, [sp, #{constants}]",
                "mla r2, r11, r1, r2",
                ".if {bytes} == 4\n add r1, r5, r0, lsl #1\n add r0, lr, r1, lsl #1",
                ".else\n add r0, r5, r0, lsl #1\n add r1, r0, lr\n .endif",
                // The first quadratic at the place to the left of the row.
                "ldr lr, [sp, #8]",
                "mul lr, lr, r12",
                "add r4, lr",
                "mla r3, r4, r12, r3",
                "add r4, lr",
                "strd r3, r4, [sp]",
                "ldr r12, [sp, #{constants} + 16]",
                $enter,
                "2: sub r2, r11",
                "ldrh r3, [r1, r10, lsl #1]",
                "cmp r3, r2, lsr #16",
                "bcs 3f",
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
                "ldr r5, [r3]",
                "strd r7, r4, [r5]",
                "str r8, [r5, #12]",
                $(
                    "add r9, sp, #{constants} - 20\n ldm r9, {{r4-r6}}",
                    concat!("ldr r7, [r3, #4 * ", $second, "]\n strd r4, r5, [r7]\n str r6, [r7, #12]"),
                )?
                $(
                    concat!("ldr r4, [sp, #{numerators} + 8 + 16 * ", $number, "]\n ldr r5, [r3, #8 + 4 * ", $number, "]\n str r4, [r5]"),
                )*
                "add sp, #{turn} + 28",
                "pop {{r4-r11, pc}}",
                ],
                numerators = const numerators(0 $(+ $second)?),
                constants = const constants([$($number),*].len(), 0 $(+ $second)?),
                changing = const changing([$($number),*].len(), 0 $(+ $second)?),
                turn = const turn([$($number),*].len(), 0 $(+ $second)?),
                one = const 1 << COUNTED,
            )
        }
    };
}

kernel!(
    /// One light, in three channels.
    light,
    [0],
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
    light_and_highlight,
    [0 1],
    "",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r5", "r6", 28),
        highlight!("r5", "r8"),
        cosine!("r4"),
        "ldm r12, {{r3, r6, r7}}\n mla r3, r6, r4, r3\n mla r3, r7, r5, r3\n",
        "ldrd r6, r7, [r12, #12]\n mla r6, r7, r4, r6\n ldr r7, [r12, #20]\n mla r6, r7, r5, r6\n",
        pack!("r6", "ldrd r6, r7, [r12, #24]\n mla r6, r7, r4, r6\n ldr r7, [r12, #32]\n mla r6, r7, r5, r6\n"),
    )
);

kernel!(
    /// Two lights, in three channels.
    lights,
    [0 1],
    "",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r5", "r6", 28),
        cosine!("r4"),
        cosine!("r5"),
        "ldrd r3, r6, [r12]\n mla r3, r6, r4, r3\n ldr r6, [r12, #40]\n mla r3, r6, r5, r3\n",
        "ldrd r6, r7, [r12, #12]\n mla r6, r7, r4, r6\n ldr r7, [r12, #52]\n mla r6, r7, r5, r6\n",
        pack!("r6", "ldrd r6, r7, [r12, #24]\n mla r6, r7, r4, r6\n ldr r7, [r12, #64]\n mla r6, r7, r5, r6\n"),
    )
);

kernel!(
    /// Two lights, the first with a highlight, in three channels.
    lights_and_highlight,
    [0 1 2],
    "ldr lr, [sp, #{constants} + 24]",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r5", "r6", 28),
        quotient!("r6", "r7", 44),
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
    lights_and_highlights,
    [0 1 2 3],
    "ldrd lr, r9, [sp, #{constants} + 24]",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r5", "r6", 28),
        quotient!("r6", "r7", 44),
        quotient!("r7", "r8", 60),
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

/// Adds the sum in `$sum` to the ambient light of the channel whose colours lie at `$at`. The level is in `$to`.
macro_rules! sum {
    ($to:literal, $sum:literal, $at:literal) => {
        concat!("ldr ", $to, ", [r12, #4 + ", $at, "]\n add ", $to, ", ", $to, ", ", $sum, ", lsl #3\n")
    };
}

/// Adds the highlight in `r7` to the level in `$to`. Its factor lies 8 bytes behind `$at`, or `$factor` bytes. `lr` is overwritten.
macro_rules! add_highlight {
    ($to:literal, $at:literal) => {
        add_highlight!(8; $to, $at)
    };
    ($factor:literal; $to:literal, $at:literal) => {
        concat!("ldr lr, [r12, #", $factor, " + ", $at, "]\n mla ", $to, ", lr, r7, ", $to, "\n")
    };
}

/// Adds the highlights in `r7` and `r8` to the level in `$to`. `$free` and `lr` are overwritten.
macro_rules! add_highlights {
    ($to:literal, $free:literal, $at:literal) => {
        concat!(
            concat!("ldrd ", $free, ", lr, [r12, #8 + ", $at, "]\n"),
            concat!("mla ", $to, ", ", $free, ", r7, ", $to, "\n mla ", $to, ", lr, r8, ", $to, "\n"),
        )
    };
}

/// Multiplies the level in `$level` by the colour whose numerator lies at `$colour` on the stack, and adds `r9`. The result is in `$to`, and `lr` is
/// overwritten.
macro_rules! paint {
    ($to:literal, $level:literal, $colour:literal) => {
        concat!(
            concat!("asr ", $level, ", ", $level, ", #15\n"),
            linear!("lr", $to, $colour),
            concat!("asr lr, lr, #14\n mla ", $to, ", ", $level, ", lr, r9\n"),
        )
    };
}

/// Adds the sum in `$sum` to ambient light, and multiplies both by a colour. `r9` and `lr` are overwritten.
macro_rules! painted_sum {
    ($to:literal, $sum:literal, $colour:literal, $at:literal) => {
        concat!(concat!("ldrd r9, lr, [r12, #", $at, "]\n add ", $sum, ", lr, ", $sum, ", lsl #3\n"), paint!($to, $sum, $colour))
    };
}

/// Adds the light of the cosine in `r4` to ambient light, and multiplies both by a colour. `r6`, `r9` and `lr` are overwritten.
macro_rules! painted_light {
    ($to:literal, $colour:literal, $at:literal) => {
        concat!(
            concat!("ldrd r9, lr, [r12, #", $at, "]\n ldr r6, [r12, #8 + ", $at, "]\n mla r6, r6, r4, lr\n"),
            paint!($to, "r6", $colour)
        )
    };
}

/// The quotients of the sums in `r4` to `r6`. `lr` is overwritten.
macro_rules! sums {
    () => {
        concat!(quotient!("r4", "lr", 12), quotient!("r5", "lr", 28), quotient!("r6", "lr", 44))
    };
}

/// The highlights of two lights in `r7` and `r8`. `lr` is overwritten.
macro_rules! two_highlights {
    ($first:literal, $second:literal) => {
        concat!(
            quotient!("r7", "lr", $first),
            quotient!("r8", "lr", $second),
            "ldr lr, [sp, #{constants} + 32]\n",
            highlight!("r7", "lr"),
            highlight!("r8", "lr"),
        )
    };
}

kernel!(
    /// Sums of lights.
    sums,
    [0 1 2],
    "ldr lr, [sp, #{constants} + 24]",
    concat!(sums!(), sum!("r3", "r4", 0), sum!("r4", "r5", 16), pack!("r4", sum!("r4", "r6", 32)))
);

kernel!(
    /// Sums of lights with a highlight.
    sums_and_highlight,
    [0 1 2 3],
    "ldr lr, [sp, #{constants} + 24]",
    concat!(
        quotient!("r7", "lr", 60),
        highlight!("r7", "r8"),
        sums!(),
        sum!("r3", "r4", 0),
        add_highlight!("r3", 0),
        sum!("r4", "r5", 16),
        add_highlight!("r4", 16),
        pack!("r4", concat!(sum!("r4", "r6", 32), add_highlight!("r4", 32))),
    )
);

kernel!(
    /// Sums of lights with two highlights.
    sums_and_highlights,
    [0 1 2 3 4],
    "ldr lr, [sp, #{constants} + 24]",
    concat!(
        two_highlights!(60, 76),
        sums!(),
        sum!("r3", "r4", 0),
        add_highlights!("r3", "r4", 0),
        sum!("r4", "r5", 16),
        add_highlights!("r4", "r5", 16),
        pack!("r4", concat!(sum!("r4", "r6", 32), add_highlights!("r4", "r6", 32))),
    )
);

kernel!(
    /// Sums of lights on a surface whose colour is walked.
    painted_sums,
    [0 1 2 3 4 5],
    "ldr lr, [sp, #{constants} + 24]",
    concat!(
        sums!(),
        painted_sum!("r3", "r4", 60, 0),
        painted_sum!("r4", "r5", 76, 16),
        pack!("r4", painted_sum!("r4", "r6", 92, 32)),
    )
);

kernel!(
    /// Sums of lights with a highlight on a surface whose colour is walked.
    painted_sums_and_highlight,
    [0 1 2 3 4 5 6],
    "ldrd lr, r9, [sp, #{constants} + 24]",
    concat!(
        quotient!("r7", "lr", 108),
        highlight!("r7", "r8"),
        sums!(),
        painted_sum!("r3", "r4", 60, 0),
        add_highlight!("r3", 0),
        painted_sum!("r4", "r5", 76, 16),
        add_highlight!("r4", 16),
        pack!("r4", concat!(painted_sum!("r4", "r6", 92, 32), add_highlight!("r4", 32))),
    )
);

kernel!(
    /// Sums of lights with two highlights on a surface whose colour is walked.
    painted_sums_and_highlights,
    [0 1 2 3 4 5 6 7],
    "ldrd lr, r9, [sp, #{constants} + 24]",
    concat!(
        two_highlights!(108, 124),
        sums!(),
        painted_sum!("r3", "r4", 60, 0),
        add_highlights!("r3", "r9", 0),
        painted_sum!("r4", "r5", 76, 16),
        add_highlights!("r4", "r9", 16),
        pack!("r4", concat!(painted_sum!("r4", "r6", 92, 32), add_highlights!("r4", "r9", 32))),
    )
);

kernel!(
    /// One light on a surface whose colour is walked.
    painted_light,
    [0 1 2 3],
    "ldr lr, [sp, #{constants} + 24]",
    concat!(
        quotient!("r4", "r5", 12),
        cosine!("r4"),
        painted_light!("r3", 28, 0),
        painted_light!("r5", 44, 16),
        pack!("r5", painted_light!("r5", 60, 32)),
    )
);

kernel!(
    /// One light with a highlight on a surface whose colour is walked.
    painted_light_and_highlight,
    [0 1 2 3 4],
    "ldrd lr, r9, [sp, #{constants} + 24]",
    concat!(
        quotient!("r4", "r5", 12),
        quotient!("r7", "r5", 28),
        highlight!("r7", "r8"),
        cosine!("r4"),
        painted_light!("r3", 44, 0),
        add_highlight!(12; "r3", 0),
        painted_light!("r5", 60, 16),
        add_highlight!(12; "r5", 16),
        pack!("r5", concat!(painted_light!("r5", 76, 32), add_highlight!(12; "r5", 32))),
    )
);

/// The colour of a level in `r4`, to which `$add` adds.
macro_rules! colour {
    ($add:literal) => {
        concat!(
            "bic r4, r4, r4, asr #31\n",
            $add,
            "\n ubfx r4, r4, #19, #9\n",
            transfer!("ldr", "r4", "[r12, r4", "]"),
            transfer!("str", "r4", "[r0, r10", "]"),
        )
    };
}

kernel!(
    /// One light, by a table of colours. `r8` is the level of ambient light here.
    level,
    [0],
    "",
    concat!(quotient!("r4", "r5", 12), colour!("add r4, r8"))
);

kernel!(
    /// One light with a highlight, by a table of colours.
    level_and_highlight,
    [0 1],
    "",
    concat!(quotient!("r4", "r5", 12), quotient!("r5", "r6", 28), highlight!("r5", "r8"), colour!("add r4, r4, r5, lsl #12"))
);

/// Finds the texel at a place in a texture, and stores the depth. It leaves out the pixel if the texel is a hole or has no colour. `$load` loads both quadratics to `r3` to `r8`, and may overwrite `r9`
/// and `lr`. The colour is then in `lr`, and what is added to levels of red, green and blue in `r5`, `r6` and `r8`. `r12` is the address of the fifth word
/// of [`crate::Texels`] here.
macro_rules! texel {
    ($load:literal) => {
        concat!(
            $load,
            "mla r4, r5, r10, r4\n mla r3, r4, r10, r3\n mla r7, r8, r10, r7\n mla r6, r7, r10, r6\n",
            "ldm r12, {{r4, r5, r7, r8, lr}}\n",
            "and r6, r6, r4\n umull r4, r6, r6, r5\n umlal r4, r6, r3, r7\n ldrb r3, [r8, r6]\n",
            "ldmdb r12, {{r4-r6, r8}}\n cmp r3, lr\n bcs 3f\n",
            "ldr lr, [r4, r3, lsl #2]\n lsrs r3, lr, #24\n bne 3f\n",
            store_depth!(),
        )
    };
}

/// A pixel under light without a hue. `$highlight` may add to `r5` and `r6`, and overwrite `r3`, `r4`, `r7` and `r8`.
macro_rules! neutral {
    ($highlight:expr) => {
        concat!(
            texel!("ldm sp, {{r3-r9, lr}}\n mla r9, r9, r10, lr\n"),
            $highlight,
            "asr r9, r9, #6\n .if {red} == {green}\n mov r7, r9\n .else\n sub r7, r9, r9, asr #6\n .endif\n",
            "ubfx r3, lr, #0, #8\n mla r3, r3, r7, r5\n ubfx r4, lr, #8, #8\n mla r4, r4, r9, r6\n",
            pack!("r4", "ubfx r4, lr, #16, #8\n mla r4, r4, r7, r5\n"),
        )
    };
}

/// What the byte of the texel from bit `$bit` on reflects of the light whose numerator lies at `$light` on the stack, and the highlight whose numerator lies
/// behind all lights, if there is one. `$more` is added. `$free` and `r9` are overwritten.
macro_rules! reflected {
    ($to:literal, $free:literal, $bit:literal, $more:literal, $light:literal $(, $highlight:literal)?) => {
        concat!(
            linear!($to, $free, $light),
            concat!("asr ", $to, ", ", $to, ", #6\n ubfx ", $free, ", lr, #", $bit, ", #8\n"),
            concat!("mla ", $to, ", ", $to, ", ", $free, ", ", $more, "\n"),
            $(linear!($free, "r9", $highlight), "add ", $to, ", ", $free, "\n",)?
        )
    };
}

rows!(
    /// A texture under light without a hue.
    neutral_texels,
    [1],
    [0],
    "add r12, #16",
    neutral!("")
);

rows!(
    /// A texture under light without a hue, with a highlight.
    neutral_texels_and_highlight,
    [1],
    [0 1],
    "add r12, #16",
    neutral!(concat!(
        "ldrd r4, r8, [sp, #40]\n mla r4, r4, r10, r8\n add r6, r4\n add r5, r4\n",
        ".if {red} != {green}\n sub r5, r5, r4, asr #6\n .endif\n",
    ))
);

rows!(
    /// A texture.
    texels,
    [1],
    [0 1 2],
    "add r12, #16",
    concat!(
        texel!("ldm sp, {{r3-r8}}\n"),
        reflected!("r3", "r4", 0, "r5", 24),
        reflected!("r4", "r7", 8, "r6", 40),
        pack!("r4", reflected!("r4", "r7", 16, "r8", 56)),
    )
);

rows!(
    /// A texture with a highlight.
    texels_and_highlight,
    [1],
    [0 1 2 3 4 5],
    "add r12, #16",
    concat!(
        texel!("ldm sp, {{r3-r8}}\n"),
        reflected!("r3", "r4", 0, "r5", 24, 72),
        reflected!("r4", "r7", 8, "r6", 40, 88),
        pack!("r4", reflected!("r4", "r7", 16, "r8", 56, 104)),
    )
);
