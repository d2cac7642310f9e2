//! The highlight's table, by what is walked as its steps: the factor that turns a cosine into an index is multiplied in at the
//! nodes, not at every pixel.

use super::{
    power::{Power, SIZE},
    product::upper_by_half_word,
};

/// Bits of a node that a step takes.
const NODE: u32 = 7;
/// Fraction bits that a walked numerator has more.
pub const EXTRA: u32 = 5;
/// Bits of a quotient that a step takes: its reciprocal length, Q2.30, is halved.
const STEP: u32 = NODE + EXTRA - 3;

/// Entries by quotients: a cosine is a walked numerator over a length.
#[derive(Clone, Copy, Debug)]
pub struct Quotients<'a> {
    table: &'a [u16; SIZE + 1],
    /// Steps from cosine 0 to 1, and half of one.
    top: i32,
    /// Steps of a node for a cosine, in the upper half.
    factor: i32,
}

impl<'a> Quotients<'a> {
    /// Those of `power`, for a base that is no square: so that nodes fit 26 bits.
    #[must_use]
    pub fn new(power: &'a Power) -> Self {
        Self { table: &power.table, top: ((power.scale << 6 << STEP) + (1 << (STEP - 1))) as i32, factor: (power.scale << 16) as i32 }
    }

    /// The node of a numerator, Q2.30: in steps, Q19.7, rounded down.
    #[inline(always)]
    #[must_use]
    pub fn node(&self, cosine: i32) -> i32 {
        upper_by_half_word(cosine, self.factor) >> (24 - NODE - 16)
    }

    /// The entry nearest to the upper half of a numerator, walked with [`EXTRA`] more bits, times half a reciprocal length (Q2.30).
    /// Error: [`super::power::NEAREST_ERROR`], and 1/100 of a step.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, quotient: i32) -> u32 {
        // One instruction shifts and clamps, and nothing is left to check.
        self.table[(self.top.wrapping_sub(quotient) >> STEP).clamp(0, SIZE as i32 - 1) as usize].into()
    }
}

/// Entries by defects: what a cosine lacks of 1.
#[derive(Clone, Copy, Debug)]
pub struct Defects<'a> {
    table: &'a [u16; SIZE + 1],
    /// A defect times the factor is an index, this many places to the left.
    shift: u32,
    /// 1/2 to 1, Q1.31: 15 bits of it.
    factor: i32,
}

impl<'a> Defects<'a> {
    /// Those of `power`.
    #[must_use]
    pub fn new(power: &'a Power) -> Self {
        // Scales are 2^5 to 2^13.
        let up = power.scale.max(1).leading_zeros().saturating_sub(17);
        Self { table: &power.table, shift: 9 + up, factor: (power.scale << up << 16) as i32 }
    }

    /// The node of a cosine, Q2.30: the defect times a factor of 1/2 to 1, Q2.24, rounded down.
    #[inline(always)]
    #[must_use]
    pub fn node(&self, cosine: i32) -> i32 {
        upper_by_half_word((1 << 30) - cosine, self.factor) >> 5
    }

    /// Half a step, added to a walked defect: the entry below is the nearest then.
    #[inline(always)]
    #[must_use]
    pub fn half(&self) -> i32 {
        1 << (self.shift - 1)
    }

    /// The entry of a walked defect, Q2.30. Error: [`super::power::NEAREST_ERROR`].
    #[inline(always)]
    #[must_use]
    pub fn at(&self, defect: i32) -> u32 {
        self.table[(defect >> (self.shift & 31)).clamp(0, SIZE as i32 - 1) as usize].into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::power::{Base, NEAREST_ERROR};

    /// Largest error of `at` against x^n, `cosines` from 1 down.
    fn error(n: u16, at: impl Fn(i32) -> u32) -> f64 {
        let error = |i: u32| {
            let cosine = (1 << 30) - (i * 5_368) as i32;
            let exact = (f64::from(cosine) / 2f64.powi(30)).max(0.0).powi(n.into());
            (f64::from(at(cosine)) / 65_536.0 - exact).abs()
        };
        (0..200_000).map(error).fold(0.0, f64::max)
    }

    #[test]
    fn entries_are_the_nearest() {
        for n in [1u16, 2, 5, 7, 8, 9, 20, 50, 128, 500, 1024] {
            let mut power = Power::EMPTY;
            power.fill(n, Base::Itself, 1 << 16, 0);
            let quotients = Quotients::new(&power);
            // Half a reciprocal length of 1/2.
            let walked = |cosine| (i64::from(quotients.node(cosine)) << EXTRA << 29 >> 32) as i32;
            let worst = error(n, |cosine| quotients.at(walked(cosine)));
            assert!(worst <= NEAREST_ERROR * 1.02, "quotients, n = {n}: {worst}");
            let defects = Defects::new(&power);
            let worst = error(n, |cosine| defects.at((defects.node(cosine) << 6) + defects.half()));
            assert!(worst <= NEAREST_ERROR * 1.01, "defects, n = {n}: {worst}");
        }
    }
}
