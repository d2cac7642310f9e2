//! The general way from a triangle to its pixels, the same code for every method and every style.
//!
//! A [`SpanShader`] shades a row of pixels in [`Intensity`], which knows nothing of pixel formats; a [`Canvas`] tests depth, turns
//! intensities into colours and stores them, and knows nothing of methods. So methods and pixel formats are compiled once each, not once
//! for each pair. Whatever a method has no loop of its own for (see [`crate::method`]) goes this way: many lights, near lights, dither,
//! antialiasing, interpolation in perspective.
//!
//! Cost: several times that of a loop of its own for a simple method, little more for one that takes a hundred instructions a pixel.

use crate::{
    coverage::sample::Layer,
    format::Intensity,
    interpolate::{Patch, Walker, plane::Linear},
    lighting::materials::MaterialTables,
    pixel::{Pixel, dither::threshold},
    raster::band::{Band, Blend},
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

/// What takes the pixels of a span, in runs from right to left.
pub trait SpanTarget {
    /// Which of the `count` pixels, at most [`CHUNK`], from number `first` of the span on are seen: bit k is that of pixel `first + k`.
    fn visible(&mut self, first: usize, count: usize) -> u32;

    /// Takes the intensities of the pixels from number `first` on that are `visible`, as the latest [`Self::visible`] has said.
    fn put(&mut self, first: usize, visible: u32, intensities: &[Intensity; CHUNK]);
}

/// Makes an intensity of what is walked.
pub trait IntensityShader<V> {
    /// The intensity of the pixel with this value.
    fn shade(&self, value: V) -> Intensity;
}

/// A polynomial and what is made of its values.
#[derive(Clone, Copy, Debug)]
pub struct Shaded<P, S> {
    /// What is walked.
    patch: P,
    /// What is made of it.
    shader: S,
    /// A run of pixels. It is written before it is read, and cleared once a triangle instead of once a span.
    intensities: [Intensity; CHUNK],
}

impl<P, S> Shaded<P, S> {
    /// `shader` makes intensities of what is walked along `patch`.
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

/// Where triangles are drawn: a band of the picture.
pub trait Canvas {
    /// Columns, first row, and the row behind the last.
    fn bounds(&self) -> [i32; 3];

    /// Draws the `count` pixels of `row` to the left of column `end` as `shader`, which stands on this row, shades them, where
    /// `inv_depth`, which stands on column `end`, is nearer than what is there.
    fn draw_row(&mut self, row: i32, end: i32, count: usize, inv_depth: Linear<1>, shader: &mut dyn SpanShader);

    /// Adds a part of a surface to a pixel, for antialiasing.
    fn add(&mut self, column: i32, row: i32, layer: Layer);

    /// The channels that an intensity has in the pixel format.
    fn channels(&self, intensity: Intensity, column: i32, row: i32) -> [u8; 3];
}

/// A band in a pixel format.
pub struct BandCanvas<'c, 'b, C: Pixel> {
    /// Where pixels go.
    pub band: &'c mut Band<'b, C>,
    /// Their colours.
    pub tables: MaterialTables<'c, C>,
    /// A threshold that changes from pixel to pixel takes the place of rounding.
    pub dither: bool,
}

impl<C: Pixel> Canvas for BandCanvas<'_, '_, C> {
    fn bounds(&self) -> [i32; 3] {
        let [top, bottom] = self.band.range();
        [self.band.width as i32, top, bottom]
    }

    fn draw_row(&mut self, row: i32, end: i32, count: usize, inv_depth: Linear<1>, shader: &mut dyn SpanShader) {
        let stop = self.band.start(row).wrapping_add(end as usize);
        let start = stop.wrapping_sub(count);
        if let (Some(pixels), Some(depth)) = (self.band.pixels.get_mut(start..stop), self.band.depth.get_mut(start..stop)) {
            let column = (end as usize).wrapping_sub(count);
            let mut target = Row { pixels, depth, inv_depth, tables: self.tables, dither: self.dither, column, row: row as usize };
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
        if self.dither {
            self.tables.reflectance.dithered(intensity, threshold(column as usize, row as usize))
        } else {
            self.tables.shown(intensity).channels()
        }
    }
}

/// A span in a pixel format.
struct Row<'r, C: Pixel> {
    pixels: &'r mut [C],
    depth: &'r mut [u16],
    /// Stands on the column behind those that are still to be tested.
    inv_depth: Linear<1>,
    tables: MaterialTables<'r, C>,
    dither: bool,
    /// Of the first pixel.
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
        let (tables, column, row) = (self.tables, self.column.wrapping_add(first), self.row);
        let pixels = self.pixels.get_mut(first..).unwrap_or_default();
        for (k, pixel) in pixels.iter_mut().enumerate().take(CHUNK) {
            if visible & (1 << k) != 0 {
                let intensity = intensities[k % CHUNK];
                *pixel = if self.dither { tables.dithered(intensity, threshold(column + k, row)) } else { tables.shown(intensity) };
            }
        }
    }
}

/// A span of antialiased pixels, all of them seen; `put` takes each with its column.
pub struct EachPixel<F> {
    /// Of the first pixel.
    pub column: i32,
    /// Takes a column and its intensity.
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
