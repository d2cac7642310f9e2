//! Draws by `phong` in `BinaryColor`.
#![no_std]
#![no_main]

size::program!(LightGray<1>, BinaryColor, PHONG);
