//! Draws by `gouraud` in `Rgb565`.
#![no_std]
#![no_main]

size::program!(Rgb565, Rgb565, GOURAUD);
