//! Tiles of large triangles under sharp highlights.
//!
//! The coefficients of a polynomial are rounded at its anchor, and their error grows with the square of the distance from there. Where a highlight
//! would show this, the triangle is drawn in square tiles, each with its own anchor in the middle. The grid of tiles begins at the triangle's first
//! corner, so neither bands nor the size of the picture change a pixel. Depth is walked over the whole triangle, as always.

use crate::{
    format::SUBPIXEL,
    interpolate::{
        Patch,
        plane::{LinearWalker, Plane},
    },
    method::TriangleSetup,
    raster::{
        canvas::{Canvas, SpanShader},
        counts::Counts,
    },
    setup::{gradients::Gradients, steepness::Steepness},
};

/// The part of a canvas that lies in a tile.
struct Tile<'c> {
    canvas: &'c mut dyn Canvas,
    /// Columns and rows, half open.
    columns: [i32; 2],
    rows: [i32; 2],
    /// The depth of the whole triangle, and the row on which it stands.
    depth: Plane<1>,
    row: i32,
    /// Pixels that were drawn.
    pixels: u32,
    /// What is counted for each triangle, in all tiles but the first.
    counted: Option<Counts>,
}

impl Canvas for Tile<'_> {
    fn bounds(&self) -> [i32; 3] {
        self.canvas.bounds()
    }

    fn counts(&mut self) -> &mut Counts {
        match &mut self.counted {
            Some(counts) => counts,
            None => self.canvas.counts(),
        }
    }

    fn draw_row(&mut self, row: i32, end: i32, count: usize, _: LinearWalker<1>, shader: &mut dyn SpanShader) {
        let [left, right] = self.columns;
        let (first, end) = (end.wrapping_sub(count as i32).max(left), end.min(right));
        if first < end && self.rows[0] <= row && row < self.rows[1] {
            let count = end.wrapping_sub(first) as u32;
            self.depth.jump(row.wrapping_sub(self.row));
            self.row = row;
            self.canvas.draw_row(row, end, count as usize, self.depth.enter(end), shader);
            self.pixels = self.pixels.wrapping_add(count);
        }
    }
}

/// Shades a triangle by `shade`, in tiles if they are needed. Returns the number of its pixels in `canvas`.
#[inline(always)]
pub(crate) fn shade(
    setup: &TriangleSetup<'_>,
    canvas: &mut dyn Canvas,
    mut shade: impl FnMut(&TriangleSetup<'_>, &mut dyn Canvas) -> u32,
) -> u32 {
    // Decision: tiles.
    if setup.gradients.walks_in_words() {
        return shade(setup, canvas);
    }
    in_tiles(setup, canvas, &mut shade)
}

/// Shades a triangle by fields of this steepness, in tiles if they are needed. Methods call it whose [`crate::method::HighlightField`] does not say
/// how steep they are.
pub fn shade_steeply(
    steepness: Steepness,
    setup: &TriangleSetup<'_>,
    canvas: &mut dyn Canvas,
    draw: impl FnMut(&TriangleSetup<'_>, &mut dyn Canvas) -> u32,
) -> u32 {
    let gradients = setup.gradients.steep(steepness);
    shade(&TriangleSetup { gradients: &gradients, ..*setup }, canvas, draw)
}

/// Shades a triangle in tiles.
#[cold]
#[inline(never)]
fn in_tiles(setup: &TriangleSetup<'_>, canvas: &mut dyn Canvas, shade: &mut dyn FnMut(&TriangleSetup<'_>, &mut dyn Canvas) -> u32) -> u32 {
    let (corners, whole) = (setup.screen.corners(), setup.gradients);
    let side = whole.steepness().tile();
    let [a, b, c] = corners.map(|corner| corner.map(|c| c >> SUBPIXEL));
    let [columns, top, bottom] = canvas.bounds();
    // First and last tile, counted from the first corner.
    let range = |k: usize, first: i32, last: i32| {
        let (least, most) = (a[k].min(b[k]).min(c[k]).max(first), a[k].max(b[k]).max(c[k]).min(last));
        [least.wrapping_sub(a[k]) >> side, most.wrapping_sub(a[k]) >> side]
    };
    let ([left, right], [upper, lower]) = (range(0, 0, columns - 1), range(1, top, bottom - 1));
    let mut pixels = 0u32;
    for y in upper..=lower {
        for x in left..=right {
            // A triangle that has been set up has an area.
            let place = |k: usize, tile: i32| a[k].wrapping_add(tile << side);
            let middle = [place(0, x), place(1, y)].map(|c| c.wrapping_add(1 << (side - 1)));
            let Some(gradients) = Gradients::anchored(corners, middle) else { continue };
            let gradients = gradients.steep(whole.steepness());
            let setup = TriangleSetup { gradients: &gradients, ..*setup };
            let depth = setup.screen.plane(whole, top);
            let (columns, rows) = ([place(0, x), place(0, x + 1)], [place(1, y), place(1, y + 1)]);
            let counted = ([x, y] != [left, upper]).then(Counts::default);
            let mut tile = Tile { canvas, columns, rows, depth, row: top, pixels: 0, counted };
            shade(&setup, &mut tile);
            pixels = pixels.wrapping_add(tile.pixels);
        }
    }
    pixels
}
