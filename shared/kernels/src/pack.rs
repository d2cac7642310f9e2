//! Parts of kernels that depend on the pixel format: channels are packed, and pixels are loaded and stored. They use the names of [`crate::FormatParts`].

/// Loads or stores a pixel, as `$operation` says. A place is given in two parts, around what multiplies an index by the bytes of a pixel.
macro_rules! transfer {
    ($operation:literal, $pixel:literal, $place:literal, $end:literal) => {
        concat!(
            concat!(".if {bytes} == 4\n ", $operation, " ", $pixel, ", ", $place, ", lsl #2", $end, "\n"),
            concat!(".else\n ", $operation, "h ", $pixel, ", ", $place, ", lsl #1", $end, "\n.endif\n"),
        )
    };
}

/// Puts clamped red and green together in `$red`. Light is scaled to the channels that the display shows.
macro_rules! join {
    ($red:literal, $green:literal) => {
        concat!(
            concat!(".if {red_shown}\n sub ", $red, ", ", $red, ", ", $red, ", lsr #{red_shown}\n"),
            concat!("sub ", $green, ", ", $green, ", ", $green, ", lsr #{green_shown}\n .endif\n"),
            concat!(".if {green_at} > {red_at}\n orr ", $red, ", ", $red, ", ", $green, ", lsl #{green_at} - {red_at}\n"),
            concat!(".else\n orr ", $red, ", ", $green, ", ", $red, ", lsl #{red_at} - {green_at}\n .endif\n"),
        )
    };
}

/// Adds clamped blue to what [`join`] has put together.
macro_rules! add_blue {
    ($pixel:literal, $blue:literal) => {
        concat!(
            concat!(".if {blue_shown}\n sub ", $blue, ", ", $blue, ", ", $blue, ", lsr #{blue_shown}\n .endif\n"),
            concat!(".if {blue_at}\n orr ", $pixel, ", ", $pixel, ", ", $blue, ", lsl #{blue_at}\n"),
            concat!(".elseif {green_at} > {red_at}\n orr ", $pixel, ", ", $blue, ", ", $pixel, ", lsl #{red_at}\n"),
            concat!(".else\n orr ", $pixel, ", ", $blue, ", ", $pixel, ", lsl #{green_at}\n .endif\n"),
            concat!(".if {is_swapped}\n rev16 ", $pixel, ", ", $pixel, "\n .endif\n"),
        )
    };
}

/// The assembler of a kernel of the format `FORMAT`, whose parts have names there. All of them are used once, because a name that is not used would be an
/// error.
macro_rules! assembler {
    ([$($line:expr),* $(,)?], $($name:ident = const $value:expr,)*) => {
        core::arch::naked_asm!(
            ".if {bytes} + {red} + {green} + {blue} + {red_at} + {green_at} + {blue_at}",
            ".if {red_shown} + {green_shown} + {blue_shown} + {is_swapped}\n .endif\n .endif",
            $($line,)*
            $($name = const $value,)*
            bytes = const FormatParts::of(FORMAT).bytes,
            red = const FormatParts::of(FORMAT).bits[0],
            green = const FormatParts::of(FORMAT).bits[1],
            blue = const FormatParts::of(FORMAT).bits[2],
            red_at = const FormatParts::of(FORMAT).lowest[0],
            green_at = const FormatParts::of(FORMAT).lowest[1],
            blue_at = const FormatParts::of(FORMAT).lowest[2],
            red_shown = const FormatParts::of(FORMAT).shown[0],
            green_shown = const FormatParts::of(FORMAT).shown[1],
            blue_shown = const FormatParts::of(FORMAT).shown[2],
            is_swapped = const FormatParts::of(FORMAT).is_swapped,
        )
    };
}
