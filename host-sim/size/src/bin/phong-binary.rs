//! Draws by `phong` in `BinaryColor`.
#![no_std]
#![no_main]

size::program!(BinaryColor, Off, PHONG);
