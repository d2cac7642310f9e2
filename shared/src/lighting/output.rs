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
    /// Whether thresholds make the pixels, and not the tables, which can neither dither nor hold a curve of three channels.
    by_threshold: bool,
}

impl<'a, C: Pixel> Output<'a, C> {
    /// For a display with a curve or without.
    #[must_use]
    pub fn new(tables: MaterialTables<'a, C>, dither: bool, gamma: Option<&'a Gamma>) -> Self {
        Self { tables, dither, gamma, by_threshold: dither || gamma.is_some() && tables.reflectance.three_channels() }
    }

    /// Whether a pixel depends on its place or on more than the tables: [`Self::channels`] makes it then.
    #[inline(always)]
    #[must_use]
    pub fn by_threshold(&self) -> bool {
        self.by_threshold
    }

    /// The channels of an intensity at a pixel.
    #[inline]
    #[must_use]
    pub fn channels(&self, intensity: Intensity, column: usize, row: usize) -> [u8; 3] {
        if !self.by_threshold {
            return self.tables.shown(intensity).channels();
        }
        let threshold = if self.dither { threshold(column, row) } else { HALF };
        self.tables.reflectance.dithered(intensity, threshold, self.gamma)
    }
}
