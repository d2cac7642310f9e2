//! Conversion of intensities to pixels where no loop does it by a table: with rounding or dither, and the curve of a display.

use crate::{
    format::{BIAS, INTENSITY, Intensity, RAMP},
    lighting::material_tables::MaterialTables,
    pixel::{
        Pixel,
        dither::{HALF, SQUARES, threshold},
        gamma::Gamma,
        ramps::Ramps,
    },
};

/// Converts the intensities of one material to pixels.
pub struct Output<'a, C: Pixel> {
    /// The colours of the material.
    pub tables: MaterialTables<'a, C>,
    dither: bool,
    gamma: Option<&'a Gamma>,
    /// Whether pixels are made from intensities. They are where tables have no dither, or no curve, which tables hold for one channel only.
    by_threshold: bool,
}

impl<'a, C: Pixel> Output<'a, C> {
    /// The output for a display, with a curve or without.
    #[must_use]
    pub fn new(tables: MaterialTables<'a, C>, dither: bool, gamma: Option<&'a Gamma>) -> Self {
        let by_tables = C::DITHERED_BY_TABLE || C::Ramps::CHECKERED;
        let by_threshold = dither && !by_tables || gamma.is_some() && tables.reflectance.three_channels();
        Self { tables, dither, gamma, by_threshold }
    }

    /// Whether methods' own loops may draw. They dither by tables only, and always where tables have finer steps than pixels.
    #[must_use]
    pub fn suits_loops(&self) -> bool {
        !self.by_threshold && (self.dither == C::DITHERED_BY_TABLE || C::Ramps::CHECKERED)
    }

    /// The threshold at a pixel. If the format has a checkerboard for loops, rows take turns here, because a turn at each pixel would take longer.
    #[inline(always)]
    #[must_use]
    pub fn threshold(&self, column: usize, row: usize) -> u32 {
        match (self.dither, C::Ramps::CHECKERED) {
            (false, _) => HALF,
            (true, false) => threshold(column, row),
            (true, true) => SQUARES[row % 2],
        }
    }

    /// Whether a pixel depends on more than the tables. Then [`Self::quantised`] makes it.
    #[inline(always)]
    #[must_use]
    pub fn by_threshold(&self) -> bool {
        self.by_threshold
    }

    /// The channels of an intensity at a pixel.
    #[inline]
    #[must_use]
    pub fn channels(&self, intensity: Intensity, column: usize, row: usize) -> [u8; 3] {
        let threshold = self.threshold(column, row);
        if self.by_threshold {
            return self.quantised(intensity, threshold);
        }
        let colour = if self.tables.reflectance.three_channels() {
            C::quantised(intensity, threshold)
        } else {
            Self::by_table(self.ramp(row), intensity, threshold)
        };
        colour.channels()
    }

    /// The channels of an intensity by a threshold. Domain: [`Self::by_threshold`].
    #[inline]
    #[must_use]
    pub fn quantised(&self, intensity: Intensity, threshold: u32) -> [u8; 3] {
        self.tables.reflectance.dithered(intensity, threshold, self.gamma)
    }

    /// The table of colours of a row.
    #[inline(always)]
    #[must_use]
    pub fn ramp(&self, row: usize) -> &'a [C::Stored; RAMP] {
        self.tables.ramps.squares()[row % 2]
    }

    /// The colour of a material in one channel for an intensity, by a table of colours and a threshold. Domain: not [`Self::by_threshold`].
    #[inline(always)]
    #[must_use]
    pub fn by_table(ramp: &[C::Stored; RAMP], [level, ..]: Intensity, threshold: u32) -> C {
        C::ramped(ramp, (level + (BIAS << INTENSITY) + (1 << (INTENSITY - 1))) as u32, INTENSITY, threshold)
    }
}
