//! The general loop, which draws triangles of every method and style; its code is shared by all of them.
//!
//! A [`SpanShader`] shades a row of pixels in [`Intensity`], which knows nothing of pixel formats; a [`Canvas`] tests depth, turns
//! intensities into colours and stores them, and knows nothing of methods. So each method and each pixel format is compiled once, and not
//! each pair. Whatever a method has no loop for (see [`crate::method`]) is drawn this way: many lights, near lights, antialiasing,
//! interpolation in perspective, and 8x8 dither of colours.
//!
//! Cost: several times that of a method's loop for a method of few instructions a pixel, little more for one of a hundred.

use crate::{
    coverage::sample::Layer,
    format::Intensity,
    interpolate::{Patch, Walker, plane::Linear},
    lighting::output::Output,
    pixel::{Pixel, dither::HALF, ramps::Ramps},
    raster::{
        band::{Band, Blend},
        counts::Counts,
    },
};

/// Pixels that are shaded at a time.
pub const CHUNK: usize = 16;

/// Shades a triangle row by row; it stands on one row.
pub trait SpanShader {
    /// Shades the `count` pixels to the left of column `end`, from right to left, on the row that lies `rows` rows below the one it
    /// stands on, and puts them into `target`.
    fn span(&mut self, rows: i32, end: i32, count: usize, target: &mut dyn SpanTarget);

    /// Moves down `rows` rows.
    fn jump(&mut self, rows: i32);

    /// Moves down one row.
    fn step_row(&mut self);
}

/// Receives the pixels of a span, in runs from right to left.
pub trait SpanTarget {
    /// Which of `count` pixels, at most [`CHUNK`], from number `first` of the span on pass the depth test: bit k stands for pixel `first +
    /// k`.
    fn visible(&mut self, first: usize, count: usize) -> u32;

    /// Stores the intensities of the pixels from number `first` on that are `visible`, by the latest result of [`Self::visible`].
    fn put(&mut self, first: usize, visible: u32, intensities: &[Intensity; CHUNK]);
}

/// Computes an intensity from walked values.
pub trait IntensityShader<V> {
    /// The intensity of the pixel with this value.
    fn shade(&self, value: V) -> Intensity;
}

/// A polynomial and the shader of its values.
#[derive(Clone, Copy, Debug)]
pub struct Shaded<P, S> {
    /// The polynomial that is walked.
    patch: P,
    /// What turns its values into intensities.
    shader: S,
    /// The intensities of a run of pixels. They are written before they are read, and so cleared once a triangle and not once a span.
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

/// The target of drawing: a band of the picture, in some pixel format. A method passes it on to what draws, such as
/// [`crate::method::Area::draw`].
pub trait Canvas {
    /// Number of columns, first row, and one past the last row.
    #[doc(hidden)]
    fn bounds(&self) -> [i32; 3];

    /// What was drawn.
    #[doc(hidden)]
    fn counts(&mut self) -> &mut Counts;

    /// Draws the `count` pixels of `row` to the left of column `end` by `shader`, which stands on this row, where `inv_depth`, which stands
    /// on column `end`, passes the depth test.
    #[doc(hidden)]
    fn draw_row(&mut self, row: i32, end: i32, count: usize, inv_depth: Linear<1>, shader: &mut dyn SpanShader);

    /// Adds a layer to a pixel, for antialiasing.
    #[doc(hidden)]
    fn add(&mut self, column: i32, row: i32, layer: Layer);

    /// The channels of an intensity in the pixel format.
    #[doc(hidden)]
    fn channels(&self, intensity: Intensity, column: i32, row: i32) -> [u8; 3];
}

/// A band in a pixel format.
pub struct BandCanvas<'c, 'b, C: Pixel> {
    /// The band that is drawn into.
    pub band: &'c mut Band<'b, C>,
    /// The colours of the material.
    pub output: &'c Output<'c, C>,
}

impl<C: Pixel> Canvas for BandCanvas<'_, '_, C> {
    fn bounds(&self) -> [i32; 3] {
        let [top, bottom] = self.band.range();
        [self.band.width as i32, top, bottom]
    }

    fn counts(&mut self) -> &mut Counts {
        &mut self.band.counts
    }

    fn draw_row(&mut self, row: i32, end: i32, count: usize, inv_depth: Linear<1>, shader: &mut dyn SpanShader) {
        let stop = self.band.start(row).wrapping_add(end as usize);
        let start = stop.wrapping_sub(count);
        if let (Some(pixels), Some(depth)) = (self.band.pixels.get_mut(start..stop), self.band.depth.get_mut(start..stop)) {
            let column = (end as usize).wrapping_sub(count);
            let mut target = Row { pixels, depth, inv_depth, output: self.output, column, row: row as usize };
            shader.span(0, end, count, &mut target);
        }
    }

    fn add(&mut self, column: i32, row: i32, layer: Layer) {
        let index = self.band.start(row).wrapping_add(column as usize);
        if cfg!(feature = "antialias")
            && let Some(Blend { samples }) = &mut self.band.blend
            && let Some(sample) = samples.get_mut(index)
        {
            sample.add(layer);
        }
    }

    fn channels(&self, intensity: Intensity, column: i32, row: i32) -> [u8; 3] {
        self.output.channels(intensity, column as usize, row as usize)
    }
}

/// A span in a pixel format.
struct Row<'r, C: Pixel> {
    pixels: &'r mut [C],
    depth: &'r mut [u16],
    /// The depth, which stands on the column right of the pixels that are still to be tested.
    inv_depth: Linear<1>,
    output: &'r Output<'r, C>,
    /// Column of the first pixel.
    column: usize,
    row: usize,
}

impl<C: Pixel> SpanTarget for Row<'_, C> {
    fn visible(&mut self, first: usize, count: usize) -> u32 {
        let mut visible = 0;
        let depth = self.depth.get_mut(first..first.wrapping_add(count)).unwrap_or_default();
        for depth in depth.iter_mut().rev() {
            self.inv_depth.step();
            let [inv_depth] = self.inv_depth.value();
            let inv_depth = (inv_depth >> 16) as u16;
            visible <<= 1;
            if inv_depth > *depth {
                *depth = inv_depth;
                visible |= 1;
            }
        }
        visible
    }

    fn put(&mut self, first: usize, visible: u32, intensities: &[Intensity; CHUNK]) {
        let (output, column, row) = (self.output, self.column.wrapping_add(first), self.row);
        let pixels = self.pixels.get_mut(first..).unwrap_or_default();
        let threshold = |k| output.threshold(column.wrapping_add(k), row);
        // One loop for each way to make a colour: no pixel asks for it. The table of colours has the curve in it already.
        if output.by_threshold() {
            let colour = |k, intensity| C::pack(output.quantised(intensity, threshold(k)).map(u32::from));
            put_each(pixels, visible, intensities, colour);
        } else if output.tables.reflectance.three_channels() {
            let threshold = if C::Ramps::CHECKERED { threshold(0) } else { HALF };
            put_each(pixels, visible, intensities, |_, intensity| C::quantised(intensity, threshold));
        } else {
            let ramp = output.ramp(row);
            put_each(pixels, visible, intensities, |k, intensity| Output::by_table(ramp, intensity, threshold(k)));
        }
    }
}

/// Stores the colours of the intensities that are `visible`, counted from the first of `pixels`.
#[inline(always)]
fn put_each<C>(pixels: &mut [C], mut visible: u32, intensities: &[Intensity; CHUNK], colour: impl Fn(usize, Intensity) -> C) {
    for (k, (pixel, &intensity)) in pixels.iter_mut().zip(intensities).enumerate() {
        if visible & 1 != 0 {
            *pixel = colour(k, intensity);
        }
        visible >>= 1;
        if visible == 0 {
            return;
        }
    }
}

/// A span of antialiased pixels, all visible; `put` takes each with its column.
pub struct EachPixel<F> {
    /// Column of the first pixel.
    pub column: i32,
    /// Receives a column and its intensity.
    pub put: F,
}

impl<F: FnMut(i32, Intensity)> SpanTarget for EachPixel<F> {
    fn visible(&mut self, _: usize, count: usize) -> u32 {
        (1 << count) - 1
    }

    fn put(&mut self, first: usize, visible: u32, intensities: &[Intensity; CHUNK]) {
        for (k, &intensity) in intensities.iter().enumerate() {
            if visible & (1 << k) != 0 {
                (self.put)(self.column.wrapping_add((first + k) as i32), intensity);
            }
        }
    }
}
