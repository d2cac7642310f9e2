//! Antialiasing by the exact area that a triangle covers of each pixel (after Disselkoen 1991, section 9).
//!
//! A triangle is drawn in two parts. Pixels wholly inside are shaded at their centres, as without antialiasing. Pixels on its *edge* are shaded at
//! the centroid of the part that it covers. For an intensity that is linear over the pixel, coverage times the value there *is* the integral. To
//! reach centroids with polynomials that stand on pixels, the method shades a copy of the triangle on a grid up to 2^[`FINER`] times finer. No method
//! needs code for antialiasing.
//!
//! Coverage is exact to less than three units of 2^-16 of a pixel, and the sum of coverages over a closed patch to the last bit (see
//! [`crate::coverage::area`]). The centroid is rounded to half a place of the finer grid, and the intensity with it. The curvature of the intensity
//! within a pixel is left out: I''/24 in a whole pixel. A triangle that is too thin for the finer grid is shaded beyond its edge by at most a quarter
//! of its own width, or at its nearest corner.
//!
//! Cost: one layer of a [`Sample`](crate::coverage::sample::Sample) for an inner pixel. An edge pixel takes one to three divisions of 64 bits for
//! each edge in it, two for the centroid, and entering the patch there. Set-up and lights are computed twice.

use crate::{
    coverage::{area::TriangleCoverage, sample::Layer},
    format::{CENTRE, DEPTH, FINER, Intensity, SUBPIXEL},
    geometry::projection::ScreenVertex,
    raster::{
        canvas::{Canvas, EachPixel, SpanShader},
        triangle::ScreenTriangle,
    },
};

/// Which pixels of a triangle are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelSet {
    /// All pixels whose centres lie inside, without antialiasing.
    Centres,
    /// All pixels that the triangle covers wholly.
    Inner,
    /// All pixels that the triangle covers in part, shaded on a grid that is finer by 2 to this power.
    Edge(u32),
}

impl PixelSet {
    /// The power of 2 by which the grid is finer than that of the pixels.
    #[must_use]
    pub fn finer(self) -> u32 {
        if let Self::Edge(finer) = self { finer } else { 0 }
    }
}

/// Base-2 logarithm of the fineness of the grid on which a triangle's edge pixels are shaded. Larger triangles have coarser grids, because
/// polynomials lose precision far from their anchor.
#[must_use]
pub fn finer(corners: [&ScreenVertex; 3]) -> u32 {
    let extent = |[a, b, c]: [i32; 3]| a.max(b).max(c).abs_diff(a.min(b).min(c));
    let size = (extent(corners.map(|c| c.x)) + extent(corners.map(|c| c.y))) >> SUBPIXEL;
    // 2^11 places: an error of 2^-24 (2^10)²/2 = 1/32 LSB at most for levels.
    (7 + FINER).saturating_sub(32 - size.leading_zeros()).min(FINER)
}

/// Converts `corner` to a grid that is finer by 2 to the power `finer`. Centres of pixels stay centres.
#[must_use]
pub fn refined(corner: &ScreenVertex, finer: u32) -> ScreenVertex {
    let place = |c: i32| (c << finer) + CENTRE - (CENTRE << finer);
    ScreenVertex { x: place(corner.x), y: place(corner.y), ..*corner }
}

/// The inverse of [`refined`], with `more` fraction bits.
pub fn coarse(corner: [i32; 2], finer: u32, more: u32) -> [i32; 2] {
    let centre = CENTRE << more;
    corner.map(|c| (c - centre + (centre << finer)) >> finer)
}

/// Smallest and largest inverse depth of a triangle within a pixel.
struct DepthRange {
    /// Inverse depth at corner 0 and its derivatives per pixel, Q0.32.
    start: i64,
    dx: i64,
    dy: i64,
    corner: [i64; 2],
    /// Smallest and largest inverse depth of the corners.
    range: [i64; 2],
}

/// Fraction bits of inverse depth here beyond [`DEPTH`].
const MORE: u32 = 32 - DEPTH;

impl DepthRange {
    fn new([[x0, y0], [x1, y1], [x2, y2]]: [[i32; 2]; 3], depth: [i32; 3]) -> Self {
        let [x1, y1, x2, y2] = [x1 - x0, y1 - y0, x2 - x0, y2 - y0].map(i64::from);
        let [z0, z1, z2] = depth.map(i64::from);
        let (z1, z2) = (z1 - z0, z2 - z0);
        let det = (x1 * y2 - x2 * y1).max(1);
        // A slope of the whole depth range per pixel is as good as any steeper one.
        let slope = |numerator: i64| ((numerator << (MORE + SUBPIXEL)) / det).clamp(-1 << 32, 1 << 32);
        Self {
            start: z0 << MORE,
            dx: slope(y2 * z1 - y1 * z2),
            dy: slope(x1 * z2 - x2 * z1),
            corner: [x0, y0].map(i64::from),
            range: [z0 + z1.min(z2).min(0), z0 + z1.max(z2).max(0)].map(|z| z << MORE),
        }
    }

    /// The nearest and the farthest inverse depth in a pixel, in the format of a depth buffer, one unit wider on each side for rounding.
    fn range(&self, column: i32, row: i32) -> [u16; 2] {
        let [x, y] = [column, row].map(|c| i64::from((c << SUBPIXEL) + CENTRE));
        let half = (self.dx.abs() + self.dy.abs()) >> 1;
        let [least, most] = self.range;
        let [near, far] = if half >= 1 << 31 {
            [most, least]
        } else {
            let along = self.dx * (x - self.corner[0]) + self.dy * (y - self.corner[1]);
            let centre = self.start + (along >> SUBPIXEL);
            [centre + half, centre - half].map(|z| z.max(least).min(most))
        };
        [((near >> 16) + 1).clamp(0, 0xFFFF) as u16, ((far >> 16) - 1).clamp(0, 0xFFFF) as u16]
    }
}

/// A triangle, or a part of one, to be antialiased.
pub struct Shape<'o> {
    /// The triangle.
    pub screen: &'o ScreenTriangle,
    /// The pixels that are drawn.
    pub pixels: PixelSet,
    /// The part of the triangle that is drawn; `None` for the whole triangle.
    pub part: Option<TriangleCoverage>,
    /// Corners of the part that is drawn, on the finer grid.
    pub corners: [[i32; 2]; 3],
    /// Fraction bits of these corners.
    pub bits: u32,
}

/// Where polynomials of a thin triangle may be evaluated.
struct Inside {
    corners: [[i64; 2]; 3],
    bits: u32,
    /// Twice the area.
    area: i64,
}

impl Inside {
    fn new(corners: [[i32; 2]; 3], bits: u32) -> Self {
        let corners = corners.map(|corner| corner.map(i64::from));
        let [a, b, c] = corners;
        Self { corners, bits, area: side(a, b, c) }
    }

    /// Whether the centre of a place lies inside, or beyond an edge by less than a quarter of the triangle.
    fn takes(&self, [row, column]: [i32; 2]) -> bool {
        let [x, y] = [column, row].map(|c| (i64::from(c) << self.bits) + (1 << (self.bits - 1)));
        let [a, b, c] = self.corners;
        [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| 4 * side(from, to, [x, y]) + self.area >= 0)
    }

    /// The nearest place where the polynomials may be evaluated: `at` itself, a neighbour of it, or the place of the nearest corner.
    fn nearest(&self, at: [i32; 2]) -> [i32; 2] {
        const BESIDE: [[i32; 2]; 9] = [[0, 0], [0, -1], [0, 1], [-1, 0], [1, 0], [-1, -1], [-1, 1], [1, -1], [1, 1]];
        let beside = BESIDE.iter().map(|[y, x]| [at[0] + y, at[1] + x]).find(|&place| self.takes(place));
        let corners = self.corners.map(|[x, y]| [(y >> self.bits) as i32, (x >> self.bits) as i32]);
        let far = |corner: &[i32; 2]| corner[0].abs_diff(at[0]).saturating_add(corner[1].abs_diff(at[1]));
        beside.or(corners.into_iter().min_by_key(far)).unwrap_or(at)
    }
}

/// How far `p` lies inside of an edge, times its length.
fn side(from: [i64; 2], to: [i64; 2], p: [i64; 2]) -> i64 {
    (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0])
}

/// The place of a span: row and column on the grid of the patch, first column and number of pixels on the screen.
struct PixelRun {
    at: [i32; 2],
    column: i32,
    count: i32,
}

impl Shape<'_> {
    /// Adds the pixels of the shape's [`PixelSet`] to `canvas` and returns how many there are. Inner pixels are drawn only within the
    /// columns that `owned` gives for a row. `shader` stands on row `anchor` of its grid.
    #[cold]
    #[inline(never)]
    pub fn draw(&self, anchor: i32, shader: &mut dyn SpanShader, canvas: &mut dyn Canvas, owned: &mut dyn FnMut(i32) -> [i32; 2]) -> u32 {
        let [width, top, bottom] = canvas.bounds();
        let (inner, finer) = (self.pixels == PixelSet::Inner, self.pixels.finer());
        let corners = self.screen.corners.map(|corner| coarse(corner, finer, 0));
        let whole = TriangleCoverage::new(corners, SUBPIXEL);
        let drawn = self.part.unwrap_or(whole);
        let depth = DepthRange::new(corners, self.screen.depth);
        let inside = Inside::new(self.corners, self.bits);
        let [first, end] = drawn.rows();
        let mut pixels = 0;
        // Shades the pixels of a place and hands them to the closure with their columns.
        let mut shade = |place: PixelRun, put: &mut dyn FnMut(i32, Intensity)| {
            let end = place.at[1].wrapping_add(place.count);
            let mut target = EachPixel { column: place.column, put };
            shader.span(place.at[0].wrapping_sub(anchor), end, place.count as usize, &mut target);
        };
        for row in first.max(top)..end.min(bottom) {
            let mut covered = drawn.row(row);
            let [start, stop] = if self.part.is_some() { whole.row(row).inner } else { covered.inner };
            if inner {
                let [from, to] = owned(row);
                let (from, to) = (start.max(from).max(0), stop.min(to).min(width));
                if from < to {
                    shade(PixelRun { at: [row, from], column: from, count: to - from }, &mut |column, intensity| {
                        let colour = canvas.to_mix(intensity, row);
                        canvas.add(column, row, Layer::whole(depth.range(column, row), colour));
                    });
                    pixels += (to - from) as u32;
                }
                continue;
            }
            let [left, right] = [covered.columns[0].max(0), covered.columns[1].min(width)];
            for [from, to] in [[left, right.min(start)], [left.max(stop), right]] {
                if from < to {
                    covered.enter(from);
                }
                for column in from..to {
                    let fragment = covered.step(column);
                    let Ok(coverage @ 1..) = u32::try_from(fragment.coverage) else { continue };
                    // The nearest place of the finer grid.
                    let place = |pixel: i32, offset: i32| (pixel << finer) + ((offset + (1 << (15 - finer))) >> (16 - finer));
                    let at = inside.nearest([place(row, fragment.centroid[1]), place(column, fragment.centroid[0])]);
                    shade(PixelRun { at, column, count: 1 }, &mut |column, intensity| {
                        let colour = canvas.to_mix(intensity, row);
                        canvas.add(column, row, Layer::new(depth.range(column, row), coverage, fragment.mask, colour));
                    });
                    pixels += 1;
                }
            }
        }
        pixels
    }
}
