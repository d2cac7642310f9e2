//! Lookup in the highlight's table by an interpolated quantity that is measured in steps of the table, see [`HighlightLut`].
//!
//! The factor from a cosine to an index is applied at the nodes of the interpolation, not at every pixel.

use crate::{
    arch::product::upper_by_half_word,
    math::{
        highlight_lut::{HighlightLut, SIZE},
        rsqrt::HalfRsqrt,
    },
};
use microphong_kernels::Lookup;

/// Fraction bits of a node, in steps of the table.
const STEP_NODE: u32 = 6;
/// Fraction bits that an interpolated numerator has beyond those of a node.
pub(crate) const NUMERATOR_EXTRA: u32 = 5;
/// Fraction bits of a quotient, in steps of the table: the reciprocal length, Q2.30, is halved, and the upper half of the product taken.
const STEP: u32 = STEP_NODE + NUMERATOR_EXTRA - 3;

/// Lookup by a quotient: the cosine is an interpolated numerator over a length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuotientLookup<'a> {
    table: &'a [u16; SIZE + 1],
    /// Steps from cosine 0 to 1, and half of one for rounding, with [`STEP`] fraction bits.
    top: i32,
    /// Steps of the table per unit of cosine, in the upper half word.
    factor: i32,
}

impl<'a> QuotientLookup<'a> {
    /// Lookup in the table of `lut`. Domain: it is not one of [`crate::math::highlight_lut::Highlight::Root`], so that nodes fit 26 bits.
    pub(crate) fn new(lut: &'a HighlightLut) -> Self {
        Self { table: &lut.table, top: ((lut.scale << 7 << STEP) + (1 << (STEP - 1))) as i32, factor: (lut.scale << 16) as i32 }
    }

    /// What a kernel needs for this lookup. It reads reciprocal lengths from `roots`.
    #[inline]
    pub(crate) fn in_kernels(&self, roots: &'a HalfRsqrt) -> Lookup<'a> {
        const { assert!(STEP == 8) };
        Lookup { roots: Some(roots.knots()), highlights: Some(self.table), top: self.top }
    }

    /// The node of a numerator, Q2.30: the numerator in steps of the table, Q20.6, rounded down. Domain: within ±2.
    #[inline]
    pub(crate) fn node(&self, cosine: i32) -> i32 {
        upper_by_half_word(cosine, self.factor) >> (23 - STEP_NODE - 16)
    }

    /// The entry nearest to a quotient, unsigned Q0.16.
    ///
    /// `quotient` is the upper half of the product of the numerator, in the format of a node with [`NUMERATOR_EXTRA`] more fraction bits, and half
    /// the reciprocal length, Q2.30. Domain: every quotient that fits; small ones take the last entry. Error: at most
    /// [`crate::math::highlight_lut::NEAREST_ERROR`] for lengths of 1/2 to 1 (tests::entries_are_the_nearest). Source: our own.
    #[inline]
    pub(crate) fn at(&self, quotient: i32) -> u32 {
        // One instruction shifts and clamps, and nothing is left to check.
        self.table[(self.top.wrapping_sub(quotient) >> STEP).clamp(0, SIZE as i32 - 1) as usize].into()
    }
}

/// Lookup by a defect, which is 1 minus the cosine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DefectLookup<'a> {
    table: &'a [u16; SIZE + 1],
    /// Fraction bits of an index in the product of a defect and the factor.
    shift: u32,
    /// The factor, 1/2 to 1, Q1.31, of which 15 bits count.
    factor: i32,
}

impl<'a> DefectLookup<'a> {
    /// Lookup in the table of `lut`.
    pub(crate) fn new(lut: &'a HighlightLut) -> Self {
        // Scales are 2^5 to 2^13.
        let up = lut.scale.max(1).leading_zeros().saturating_sub(17);
        Self { table: &lut.table, shift: 8 + up, factor: (lut.scale << up << 16) as i32 }
    }

    /// The node of a cosine, Q2.30: 1 - cosine times a factor of 1/2 to 1, Q2.24, rounded down. Domain: above -1.
    #[inline]
    pub(crate) fn node(&self, cosine: i32) -> i32 {
        upper_by_half_word((1 << 30) - cosine, self.factor) >> 5
    }

    /// Half a step of the table, Q2.30. Added to an interpolated defect, it makes the entry below the nearest one.
    #[inline]
    pub(crate) fn half(&self) -> i32 {
        1 << (self.shift - 1)
    }

    /// The entry nearest to a defect, unsigned Q0.16.
    ///
    /// `defect` is in the format of a node with 6 more fraction bits, Q2.30, with [`Self::half`] added. Domain: every `i32`; large ones
    /// take the last entry. Error: at most [`crate::math::highlight_lut::NEAREST_ERROR`] (tests::entries_are_the_nearest). Source: our own.
    #[inline]
    pub(crate) fn at(&self, defect: i32) -> u32 {
        self.table[(defect >> (self.shift & 31)).clamp(0, SIZE as i32 - 1) as usize].into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::highlight_lut::{Highlight, HighlightCurve, NEAREST_ERROR};
    use zerocopy::FromZeros;

    /// Largest error of `at` against x^n: next to entries, and half way between two of them.
    fn error(n: u16, curve: &HighlightCurve, at: impl Fn(i32) -> u32) -> f64 {
        let step = (2f64.powi(30) - f64::from(curve.highlight_threshold())) / SIZE as f64;
        let error = |position: f64| {
            let cosine = (2f64.powi(30) - (step * position).floor()) as i32;
            let exact = (f64::from(cosine) / 2f64.powi(30)).max(0.0).powi(n.into());
            (f64::from(at(cosine)) / 65_536.0 - exact).abs()
        };
        let positions = (0..SIZE + 12).flat_map(|i| [0.0, 0.498, 0.4999, 0.5001, 0.502, 0.999].map(|f| i as f64 + f));
        positions.map(error).fold(0.0, f64::max)
    }

    #[test]
    fn entries_are_the_nearest() {
        for n in (1..12).chain([20, 50, 127, 128, 500, 1023, 1024]) {
            let (mut lut, curve) = (HighlightLut::new_zeroed(), HighlightCurve::new(n, Highlight::Half, 1 << 16, 0));
            lut.fill(&curve);
            let quotients = QuotientLookup::new(&lut);
            for length in [1.0, 0.9, 0.77, 0.6, 0.5] {
                let half_reciprocal = (f64::from(1 << 29) / length) as i64;
                let numerator = |cosine: i32| (f64::from(cosine) * length).round() as i32;
                let quotient =
                    |cosine| (((i64::from(quotients.node(numerator(cosine))) << NUMERATOR_EXTRA) * half_reciprocal) >> 32) as i32;
                let worst = error(n, &curve, |cosine| quotients.at(quotient(cosine)));
                assert!(worst <= NEAREST_ERROR, "quotients, n = {n}, length {length}: {worst}");
            }
            let defects = DefectLookup::new(&lut);
            let worst = error(n, &curve, |cosine| defects.at((defects.node(cosine) << 6) + defects.half()));
            assert!(worst <= NEAREST_ERROR, "defects, n = {n}: {worst}");
        }
    }
}
