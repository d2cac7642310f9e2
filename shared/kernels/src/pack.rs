//! Parts of kernels that depend on the pixel format: channels are packed, and pixels are loaded and stored. They use the names of [`crate::FormatParts`].

/// Loads a pixel from a place, which is given in two parts, around what multiplies an index by the bytes of a pixel.
macro_rules! load {
    ($pixel:literal, $place:literal, $end:literal) => {
        concat!(
            concat!(".if {bytes} == 4\n ldr ", $pixel, ", ", $place, ", lsl #2", $end, "\n"),
            concat!(".else\n ldrh ", $pixel, ", ", $place, ", lsl #1", $end, "\n.endif\n"),
        )
    };
}

/// Stores a pixel, likewise.
macro_rules! store {
    ($pixel:literal, $place:literal, $end:literal) => {
        concat!(
            concat!(".if {bytes} == 4\n str ", $pixel, ", ", $place, ", lsl #2", $end, "\n"),
            concat!(".else\n strh ", $pixel, ", ", $place, ", lsl #1", $end, "\n.endif\n"),
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

/// Uses all names, because a name that a kernel does not use would be an error.
macro_rules! uses_format {
    () => {
        ".if {bytes} + {red} + {green} + {blue} + {red_at} + {green_at} + {blue_at} + {red_shown} + {green_shown} + {blue_shown} + {is_swapped}\n .endif"
    };
}
