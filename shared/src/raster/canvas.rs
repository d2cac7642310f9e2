//! The general loop, which draws triangles of every method and style; its code is shared by all of them.
//!
//! A [`SpanShader`] shades a row of pixels as [`Intensity`] and knows no pixel formats. A [`Canvas`] tests depth, converts intensities to colours,
//! stores them, and knows no methods. So each method and each pixel format is compiled once, and not each pair of them. The general loop draws all
//! that a method has no loop for (see [`crate::method`]): many lights, near lights, and interpolation in perspective.
//!
//! Cost: several times as much as a method's own loop if the method takes few instructions a pixel, and little more if it takes a hundred.

use crate::{
    format::{BIAS, INTENSITY, Intensity, RAMP},
    interpolate::{Patch, Walker, plane::LinearWalker},
    lighting::material_tables::MaterialTables,
    pixel::{
        Pixel,
        dither::{HALF, SQUARES},
        gamma::Gamma,
        ramps::Ramps,
    },
    raster::{
        band::Band,
        counts::Counts,
        glass::{Glass, IfTransparent},
    },
};

/// Number of pixels that are shaded at once.
pub const CHUNK: usize = 16;

/// Shades a triangle row by row. It stands on one of its rows.
pub trait SpanShader {
    /// Shades the `count` pixels to the left of column `end`, from right to left, in the row that is `rows` rows below the current one. It puts them
    /// into `target`.
    fn span(&mut self, rows: i32, end: i32, count: usize, target: &mut dyn SpanTarget);

    /// Moves down `rows` rows.
    fn jump(&mut self, rows: i32);

    /// Moves down one row.
    fn step_row(&mut self);
}

/// Receives the pixels of a span, in runs from right to left.
pub trait SpanTarget {
    /// Says which of the pixels that are tested next the surface covers: bit k is 1 for pixel `first + k`. Surfaces without holes need not say it.
    fn cover(&mut self, covered: u32);

    /// Tests the depth of `count` pixels, at most [`CHUNK`], from number `first` of the span on. Bit k of the result is 1 if pixel `first + k`
    /// passes.
    fn visible(&mut self, first: usize, count: usize) -> u32;

    /// Stores the intensities of `visible` pixels from number `first` on, as [`Self::visible`] has returned them.
    fn put(&mut self, first: usize, visible: u32, intensities: &[Intensity; CHUNK]);
}

/// The pixels of a run in which the surface has no hole: bit k is 1 if it covers pixel k. `walker` stands right of the last of `count` pixels.
#[inline]
pub(crate) fn covered<W: Walker>(walker: &W, count: usize) -> u32 {
    if !walker.may_have_holes() {
        return u32::MAX;
    }
    let mut walker = walker.clone();
    (0..count).fold(0, |covered, _| {
        walker.step();
        covered << 1 | u32::from(W::covers(&walker.value()))
    })
}

/// Converts an interpolated value to light at a pixel. Implement it for a shading method of your own; `V` is the type of the value, for
/// example `[u32; 3]` for light levels of three channels.
pub trait IntensityShader<V> {
    /// Computes the light of one pixel from its interpolated value. It is called for each visible pixel.
    fn shade(&self, value: V) -> Intensity;
}

/// A polynomial and the shader of its values.
#[derive(Clone, Copy, Debug)]
pub struct Shaded<P, S> {
    /// The polynomial that is walked.
    patch: P,
    /// The shader that converts values to intensities.
    shader: S,
    /// Memory for the intensities of a run of pixels. They are written before they are read, so they are cleared once a triangle and not once a span.
    intensities: [Intensity; CHUNK],
}

impl<P, S> Shaded<P, S> {
    /// Shades the values of `patch` by `shader`.
    pub fn new(patch: P, shader: S) -> Self {
        Self { patch, shader, intensities: [[0; 3]; CHUNK] }
    }
}

impl<P: Patch, S: IntensityShader<<P::Walker as Walker>::Value>> SpanShader for Shaded<P, S> {
    fn span(&mut self, rows: i32, end: i32, count: usize, target: &mut dyn SpanTarget) {
        let mut walker = if rows == 0 {
            self.patch.enter(end)
        } else {
            let mut patch = self.patch;
            patch.jump(rows);
            patch.enter(end)
        };
        let intensities = &mut self.intensities;
        let mut first = count;
        while first > 0 {
            let run = first.min(CHUNK);
            first -= run;
            if P::Walker::HAS_HOLES {
                target.cover(covered(&walker, run));
            }
            let visible = target.visible(first, run);
            // Counted down, and the index cut off: no bounds are left to check.
            let mut k = run;
            while k > 0 {
                k -= 1;
                walker.step();
                if visible & (1 << k) != 0 {
                    intensities[k % CHUNK] = self.shader.shade(walker.value());
                }
            }
            if visible != 0 {
                target.put(first, visible, intensities);
            }
        }
    }

    fn jump(&mut self, rows: i32) {
        self.patch.jump(rows);
    }

    fn step_row(&mut self) {
        self.patch.step_row();
    }
}

/// The target that a shading method draws to: some rows of the picture, in any pixel format. A method only passes it on to functions that
/// draw, such as [`Area::draw`](crate::method::Area::draw).
pub trait Canvas {
    /// Number of columns, first row, and one past the last row.
    #[doc(hidden)]
    fn bounds(&self) -> [i32; 3];

    /// Counts of what was drawn.
    #[doc(hidden)]
    fn counts(&mut self) -> &mut Counts;

    /// Draws the `count` pixels of `row` to the left of column `end` by `shader`, which stands on this row. Pixels whose `inv_depth`, which stands on
    /// column `end`, fails the depth test are left out.
    #[doc(hidden)]
    fn draw_row(&mut self, row: i32, end: i32, count: usize, inv_depth: LinearWalker<1>, shader: &mut dyn SpanShader);
}

/// Converts the intensities of one material to pixels.
pub struct Colourist<'c, C: Pixel> {
    /// The colours of the material.
    pub tables: MaterialTables<'c, C>,
    /// Whether rows are dithered by turns, in formats with a checkerboard. A turn at each pixel would take longer.
    dither: bool,
    /// The curve of the display, by which tables in one channel are corrected already.
    gamma: Option<&'c Gamma>,
    /// Whether colours are corrected by the curve at each pixel, because no table and no pass does it.
    corrects: bool,
}

impl<'c, C: Pixel> Colourist<'c, C> {
    /// The colours of a material, with these settings of the renderer.
    pub fn new(tables: MaterialTables<'c, C>, dither: bool, gamma: Option<&'c Gamma>) -> Self {
        let corrects = gamma.is_some() && tables.reflectance.three_channels() && !C::IS_LIGHT;
        Self { tables, dither, gamma, corrects }
    }

    /// Whether the loops of methods make these colours.
    pub fn suits_loops(&self) -> bool {
        !self.corrects
    }

    /// What is added to a colour of `row` before it is rounded down.
    fn threshold(&self, row: usize) -> u32 {
        if self.dither && C::Ramps::CHECKERED { SQUARES[row % 2] } else { HALF }
    }

    /// The colour of a material in one channel for an intensity, by a table of colours.
    fn by_table(ramp: &[C::Stored; RAMP], [level, ..]: Intensity) -> C {
        C::ramped(ramp, (level + (BIAS << INTENSITY) + (1 << (INTENSITY - 1))) as u32, INTENSITY)
    }
}

/// A band in a pixel format.
pub struct BandCanvas<'c, 'b, C: Pixel> {
    /// The band that is drawn into.
    pub band: &'c mut Band<'b, C>,
    /// What makes its pixels.
    pub colourist: &'c Colourist<'c, C>,
}

impl<C: Pixel> Canvas for BandCanvas<'_, '_, C> {
    fn bounds(&self) -> [i32; 3] {
        let [top, bottom] = self.band.range();
        [self.band.width as i32, top, bottom]
    }

    fn counts(&mut self) -> &mut Counts {
        &mut self.band.counts
    }

    fn draw_row(&mut self, row: i32, end: i32, count: usize, inv_depth: LinearWalker<1>, shader: &mut dyn SpanShader) {
        let stop = self.band.start(row).wrapping_add(end as usize);
        let start = stop.wrapping_sub(count);
        if let (Some(pixels), Some(depth)) = (self.band.pixels.get_mut(start..stop), self.band.depth.get_mut(start..stop)) {
            let seen = self.band.sheet.each_ref().map(|sheet| Seen { glass: sheet.glass, covered: u32::MAX });
            let mut target = CanvasRow { pixels, depth, inv_depth, colourist: self.colourist, row: row as usize, seen };
            shader.span(0, end, count, &mut target);
        }
    }
}

/// A span in a pixel format.
struct CanvasRow<'r, C: Pixel> {
    pixels: &'r mut [C],
    depth: &'r mut [u16],
    /// The depth, which stands on the column right of the pixels that are still to be tested.
    inv_depth: LinearWalker<1>,
    colourist: &'r Colourist<'r, C>,
    row: usize,
    seen: IfTransparent<Seen>,
}

/// What is seen through a surface.
#[derive(Clone, Copy)]
struct Seen {
    /// How the surface lets through what is behind it.
    glass: Option<Glass>,
    /// The pixels of the next run that it covers.
    covered: u32,
}

impl<C: Pixel> SpanTarget for CanvasRow<'_, C> {
    fn cover(&mut self, covered: u32) {
        self.seen.iter_mut().for_each(|seen| seen.covered = covered);
    }

    fn visible(&mut self, first: usize, count: usize) -> u32 {
        let mut visible = 0;
        let depth = self.depth.get_mut(first..first.wrapping_add(count)).unwrap_or_default();
        for (k, depth) in depth.iter_mut().enumerate().rev() {
            self.inv_depth.step();
            let [inv_depth] = self.inv_depth.value();
            let inv_depth = (inv_depth >> 16) as u16;
            visible <<= 1;
            if inv_depth > *depth && self.seen.iter().all(|seen| seen.covered >> k & 1 != 0) {
                // A transparent surface hides nothing.
                if self.seen.iter().all(|seen| seen.glass.is_none()) {
                    *depth = inv_depth;
                }
                visible |= 1;
            }
        }
        visible
    }

    fn put(&mut self, first: usize, visible: u32, intensities: &[Intensity; CHUNK]) {
        let (colourist, reflectance) = (self.colourist, &self.colourist.tables.reflectance);
        let (pixels, row, glass) =
            (self.pixels.get_mut(first..).unwrap_or_default(), self.row, self.seen.first().and_then(|seen| seen.glass));
        // One loop for each way to make a colour, so that no pixel has to ask.
        if colourist.corrects {
            let threshold = colourist.threshold(row);
            put_each(pixels, visible, intensities, glass, |intensity| {
                C::mixed_from(C::quantised_to_mix(reflectance.scaled(intensity, colourist.gamma), threshold))
            });
        } else if reflectance.three_channels() {
            let threshold = colourist.threshold(row);
            put_each(pixels, visible, intensities, glass, |intensity| C::quantised(intensity, threshold));
        } else {
            let ramp = colourist.tables.ramps.squares()[row % 2];
            put_each(pixels, visible, intensities, glass, |intensity| Colourist::by_table(ramp, intensity));
        }
    }
}

/// Stores the colours of the intensities that are `visible`, counted from the first of `pixels`.
#[inline(always)]
fn put_each<C: Pixel>(
    pixels: &mut [C],
    mut visible: u32,
    intensities: &[Intensity; CHUNK],
    glass: Option<Glass>,
    colour: impl Fn(Intensity) -> C,
) {
    for (pixel, &intensity) in pixels.iter_mut().zip(intensities) {
        if visible & 1 != 0 {
            let surface = colour(intensity);
            *pixel = glass.map_or(surface, |glass| glass.over(surface, *pixel));
        }
        visible >>= 1;
        if visible == 0 {
            return;
        }
    }
}
