//! Intensities to pixels, where no loop does it by a table: rounded or dithered, by the curve of a display.

use crate::{
    format::Intensity,
    lighting::material_tables::MaterialTables,
    pixel::{
        Pixel,
        dither::{HALF, threshold},
        gamma::Gamma,
    },
};

/// How the intensities of one material become pixels.
pub struct Output<'a, C: Pixel> {
    /// The colours of the material.
    pub tables: MaterialTables<'a, C>,
    dither: bool,
    gamma: Option<&'a Gamma>,
    /// Whether pixels are made from intensities: tables dither nothing but a few greys, and hold no curve of three channels.
    by_threshold: bool,
}

impl<'a, C: Pixel> Output<'a, C> {
    /// For a display with a curve or without.
    #[must_use]
    pub fn new(tables: MaterialTables<'a, C>, dither: bool, gamma: Option<&'a Gamma>) -> Self {
        let by_threshold = dither && !C::DITHERED_BY_TABLE || gamma.is_some() && tables.reflectance.three_channels();
        Self { tables, dither, gamma, by_threshold }
    }

    /// Whether the loops of methods make the same pixels: they dither by tables alone, and always where those are made for it.
    #[must_use]
    pub fn suits_loops(&self) -> bool {
        !self.by_threshold && self.dither == C::DITHERED_BY_TABLE
    }

    /// The threshold at a pixel.
    #[inline(always)]
    #[must_use]
    pub fn threshold(&self, column: usize, row: usize) -> u32 {
        if self.dither { threshold(column, row) } else { HALF }
    }

    /// Whether a pixel depends on more than the tables: [`Self::channels`] makes it then.
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
        if !self.by_threshold {
            return self.tables.shown(intensity, threshold).channels();
        }
        self.tables.reflectance.dithered(intensity, threshold, self.gamma)
    }
}
