//! A strip of the picture and its depth: the only memory that drawing writes.

/// Rows `top .. top + rows` of the viewport.
#[derive(Debug)]
pub struct Band<'a, C> {
    /// Row by row.
    pub pixels: &'a mut [C],
    /// Nearness per pixel: 0 is infinitely far.
    pub depth: &'a mut [u16],
    /// Pixels in a row, at least 1.
    pub width: usize,
    /// First row.
    pub top: i32,
    /// Number of rows.
    pub rows: i32,
}

impl<C> Band<'_, C> {
    /// Background everywhere, infinitely far.
    pub fn clear(&mut self, background: C)
    where
        C: Copy,
    {
        self.pixels.fill(background);
        self.depth.fill(0);
    }

    /// Pixels and depth of rows `from .. to`; rows outside the band are left out.
    #[inline(always)]
    pub fn rows_between(&mut self, from: i32, to: i32) -> impl Iterator<Item = (&mut [C], &mut [u16])> {
        let first = from.wrapping_sub(self.top).max(0) as usize;
        let count = to.wrapping_sub(from).max(0) as usize;
        let width = self.width.max(1);
        let start = first.saturating_mul(width);
        let pixels = self.pixels.get_mut(start..).unwrap_or_default().chunks_exact_mut(width);
        let depth = self.depth.get_mut(start..).unwrap_or_default().chunks_exact_mut(width);
        pixels.zip(depth).take(count)
    }
}
