//! Draws by `auto` in `BinaryColor`.
#![no_std]
#![no_main]

size::program!(BinaryColor, Off, AUTO);
