//! Colours of 8 bits a channel in pixel formats.

use crate::pixel::PixelFormat;

/// A colour as the format shows it: grey formats show its luma.
pub(crate) fn shown<C: PixelFormat>([r, g, b]: [u8; 3]) -> [u8; 3] {
    let luma = (u32::from(r) * 77 + u32::from(g) * 150 + u32::from(b) * 29) >> 8;
    if C::GRAY { [luma as u8; 3] } else { [r, g, b] }
}

/// A colour of 8 bits a channel in the pixel format, whose channels keep the upper bits.
pub(crate) fn colour<C: PixelFormat>(rgb: [u8; 3]) -> C {
    let ([r, g, b], [dr, dg, db]) = (shown::<C>(rgb).map(u32::from), C::DEPTH);
    C::pack([r >> (8 - dr), g >> (8 - dg), b >> (8 - db)])
}
