//! Vertical gradients between two colours. They are dithered in all formats: this takes eight colours a row, and without it a display of 16 bits a
//! pixel would show steps.

use crate::pixel::{PixelFormat, colour::shown, dither::threshold};
use embedded_graphics_core::primitives::Rectangle;

/// Number of columns after which thresholds of dither repeat.
const COLUMNS: usize = 8;

/// Fills the band `area` of a picture of `height` rows.
// A call, so that its instructions can be told from a frame's.
#[inline(never)]
pub(super) fn fill<C: PixelFormat>(ends: [[u8; 3]; 2], pixels: &mut [C], area: Rectangle, height: u32) {
    let ends = ends.map(shown::<C>);
    let rows = pixels.chunks_exact_mut((area.size.width as usize).max(1));
    for (pixels, row) in rows.zip(area.top_left.y.unsigned_abs()..) {
        let levels = Levels::new::<C>(ends, row, height);
        let colours: [C; COLUMNS] = core::array::from_fn(|column| levels.colour(threshold(column, row as usize)));
        // All columns of the pattern at once, from registers: 1.9 instructions a pixel on a Cortex-M3, where pairs of pixel and colour take 9.
        let (patterns, rest) = pixels.as_chunks_mut::<COLUMNS>();
        let [a, b, c, d, e, f, g, h] = colours;
        patterns.iter_mut().for_each(|pattern| *pattern = [a, b, c, d, e, f, g, h]);
        rest.iter_mut().zip(colours).for_each(|(pixel, colour)| *pixel = colour);
    }
}

/// The channels of one row, exactly: for each a level of the pixel format, and the remainder as a numerator.
struct Levels {
    channels: [(u32, u32); 3],
    denominator: u32,
}

impl Levels {
    fn new<C: PixelFormat>([[top_r, top_g, top_b], [r, g, b]]: [[u8; 3]; 2], row: u32, height: u32) -> Self {
        let last = height.saturating_sub(1).max(1);
        let (row, denominator) = (row.min(last), 255 * last);
        let channel = |top: u8, bottom: u8, depth: u32| {
            // At most 255 * 2046 * 255: no product overflows.
            let scaled = (u32::from(top) * (last - row) + u32::from(bottom) * row) * ((1 << depth) - 1);
            let level = scaled.checked_div(denominator).unwrap_or(0);
            (level, scaled - level * denominator)
        };
        let [dr, dg, db] = C::DEPTH;
        Self { channels: [channel(top_r, r, dr), channel(top_g, g, dg), channel(top_b, b, db)], denominator }
    }

    /// The colour for a threshold in 1/128 of a step.
    fn colour<C: PixelFormat>(&self, threshold: u32) -> C {
        let whole = self.denominator << 7;
        C::pack(self.channels.map(|(level, numerator)| level + u32::from((numerator << 7) + threshold * self.denominator >= whole)))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use embedded_graphics_core::{
        geometry::{Point, Size},
        pixelcolor::{Gray4, Rgb565, Rgb888},
    };
    use std::vec::Vec;

    const ENDS: [[u8; 3]; 2] = [[10, 250, 77], [200, 30, 78]];

    fn filled<C: PixelFormat>(height: u32, rows: u32) -> Vec<[u8; 3]> {
        let mut pixels = Vec::new();
        for top in (0..height).step_by(rows as usize) {
            let area = Rectangle::new(Point::new(0, top as i32), Size::new(16, rows.min(height - top)));
            let mut band = [C::pack([0; 3])].repeat(16 * area.size.height as usize);
            fill(ENDS, &mut band, area, height);
            pixels.extend(band.iter().map(|pixel| pixel.channels()));
        }
        pixels
    }

    fn gradient<C: PixelFormat>() {
        for height in [1, 2, 3, 48, 2047] {
            let dithered = filled::<C>(height, 5);
            assert_eq!(dithered, filled::<C>(height, height));
            let ends = ENDS.map(shown::<C>);
            for y in 0..height as usize {
                for k in 0..3 {
                    let share = y as f64 / f64::from(height.max(2) - 1);
                    let [top, bottom] = ends.map(|end| f64::from(end[k]));
                    let exact = (top + (bottom - top) * share) / 255.0 * f64::from((1 << C::DEPTH[k]) - 1);
                    let row = |of: &[[u8; 3]]| of[16 * y..16 * y + 16].iter().map(|pixel| f64::from(pixel[k])).collect::<Vec<_>>();
                    for level in row(&dithered) {
                        assert!((level - exact).abs() < 1.0, "row {y} of {height}: {level}, not {exact}");
                    }
                }
            }
        }
    }

    #[test]
    fn gradients_are_exact() {
        gradient::<Rgb565>();
        gradient::<Rgb888>();
        gradient::<Gray4>();
    }

    /// Dither shows what lies between two levels: the mean of a square is right.
    #[test]
    fn dithered_gradients_keep_the_mean() {
        let height = 2041;
        let dithered = filled::<Rgb565>(height, 8);
        for top in (0..height as usize - 8).step_by(8) {
            let sum: u32 = (0..8).flat_map(|y| (0..8).map(move |x| (x, y))).map(|(x, y)| u32::from(dithered[(top + y) * 16 + x][0])).sum();
            let exact = (10.0 + 190.0 * (top as f64 + 3.5) / f64::from(height - 1)) * 31.0 / 255.0;
            assert!((f64::from(sum) / 64.0 - exact).abs() < 0.08, "rows from {top}: {sum}/64, not {exact}");
        }
    }
}
