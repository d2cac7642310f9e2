//! A band: some rows of the picture and their depth. Drawing writes no other memory.

use crate::{
    pixel::Pixel,
    raster::{
        active::ActiveTriangles,
        counts::Counts,
        glass::{IfTransparent, Sheet},
    },
};
use core::{hint::black_box, ops::Range};
use zerocopy::{FromBytes, IntoBytes};

/// The rows `top .. top + rows` of the picture.
#[derive(Debug)]
pub struct Band<'a, C> {
    /// All pixels, row by row.
    pub pixels: &'a mut [C],
    /// Inverse depth per pixel: 0 is infinitely far.
    pub depth: &'a mut [u16],
    /// Pixels in a row.
    pub width: usize,
    /// First row.
    pub top: i32,
    /// Number of rows.
    pub rows: i32,
    /// Active triangles that the band above has saved, and those that this band saves.
    pub active: ActiveTriangles<'a>,
    /// Counts of what was drawn.
    pub counts: Counts,
    /// How the surface that is drawn lets through what is behind it.
    pub sheet: IfTransparent<Sheet<C>>,
}

impl<C> Band<'_, C> {
    /// Sets the depth to infinity in rows that triangles can reach. The depth of other rows is never read.
    #[inline(never)]
    pub fn clear(&mut self, reached: Range<u32>) {
        let within = |row: u32| (row as i32).max(self.top).min(self.top.wrapping_add(self.rows));
        let (first, end) = (self.start(within(reached.start)), self.start(within(reached.end)));
        clear_depth(self.depth.get_mut(first..end).unwrap_or_default());
    }

    /// Whether the surface that is drawn lets light through.
    #[inline(always)]
    pub(crate) fn is_transparent(&self) -> bool {
        self.sheet.iter().any(|sheet| sheet.glass.is_some())
    }

    /// The first row, and one past the last.
    pub(crate) fn range(&self) -> [i32; 2] {
        [self.top, self.top.wrapping_add(self.rows)]
    }

    /// Index of the first pixel of `row`.
    pub fn start(&self, row: i32) -> usize {
        (row.wrapping_sub(self.top) as usize).wrapping_mul(self.width)
    }
}

/// Makes a depth buffer infinitely far, two pixels at a time.
fn clear_depth(depth: &mut [u16]) {
    match <[u32]>::mut_from_bytes(depth.as_mut_bytes()) {
        // Were the value known, the compiler would call a function that takes longer.
        Ok(pairs) => fill(pairs, [black_box(0); 2]),
        // An odd number of pixels, or half a word off.
        Err(_) => depth.fill(0),
    }
}

/// Fills pixels with one colour.
#[inline(never)]
pub fn fill_pixels<C: Pixel>(pixels: &mut [C], colour: C) {
    fill(pixels, colour.pair());
}

/// Fills a slice with two values in turns, sixteen at a time, because the compiler does not unroll `slice::fill` at opt-level "s".
#[inline(always)]
fn fill<T: Copy>(slice: &mut [T], [even, odd]: [T; 2]) {
    let (blocks, rest) = slice.as_chunks_mut::<16>();
    for [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] in blocks {
        (*a, *b, *c, *d, *e, *f, *g, *h) = (even, odd, even, odd, even, odd, even, odd);
        (*i, *j, *k, *l, *m, *n, *o, *p) = (even, odd, even, odd, even, odd, even, odd);
    }
    rest.fill(even);
}
