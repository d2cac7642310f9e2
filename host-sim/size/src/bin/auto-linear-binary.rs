//! Draws by `auto-linear` in `BinaryColor`.
#![no_std]
#![no_main]

size::program!(BinaryColor, Off, AUTO_LINEAR);
