//! Draws by `gouraud` in `BinaryColor`.
#![no_std]
#![no_main]

size::program!(BinaryColor, Off, GOURAUD);
