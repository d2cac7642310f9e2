//! How exactly a field has to be fitted and walked, so that no highlight shows an error of it.
//!
//! A highlight of exponent n that is off by e in its cosine is off by up to 255 n e levels. Fields have three errors that grow, and each of
//! them may take [`SHARE`] of a level. Where a faster way would take more, a slower one is taken. Ordinary meshes have next to no such
//! triangles.

/// What each error of a field may add to a highlight, in 1/255.
pub const SHARE: f64 = 0.1;

/// How steeply light follows a field: as a highlight of this exponent, or 0 for a field of levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steepness(u32);

/// The largest `n e` by which a highlight is off by [`SHARE`], in units of 2^-`bits`.
const fn limit(bits: u32) -> u32 {
    (SHARE / 255.0 * (1u64 << bits) as f64) as u32
}

/// Largest n S² of a quadratic that words walk: coefficients that are rounded to 2^-30 are off by 2^-31 (1 + S + S²) at a distance of S
/// columns plus rows.
const WALKED: u32 = limit(31);
/// Largest n S of a field that words fit on a word-sized triangle: its first derivatives are off by 2^-27.
const FIRST: u32 = limit(27);
/// Largest n k² that gradients of 30 bits fit: with k the length over the height, quadratics are off by 1.3 · 2^-25 k².
const THIN: u32 = limit(25) * 10 / 13;
/// Largest n d k² that words fit, or gradients of 30 bits: with d the second difference of nodes, quadratics are off by 2^-25 d k².
const BEND: u32 = limit(25);

/// The largest steepness that is told apart.
const MOST: u32 = 1 << 14;

impl Steepness {
    /// The steepness of a field of levels, of which no highlight is computed.
    pub const NONE: Self = Self(0);

    /// The steepness of a field that is raised to `exponent`.
    #[inline(always)]
    #[must_use]
    pub const fn new(exponent: u32) -> Self {
        Self(if exponent > MOST { MOST } else { exponent })
    }

    /// Whether a quadratic can be walked in words as far as `span` columns plus rows from its anchor.
    #[inline(always)]
    #[must_use]
    pub(crate) fn walks_in_words(self, span: u32) -> bool {
        // Steepness has at most 15 bits, and no limit is above 1,023 pixels: all products fit a word.
        let span = span.min(1023);
        ((span * span) >> 4).wrapping_mul(self.0) <= WALKED >> 4
    }

    /// Whether a quadratic can be walked in words all over a word-sized triangle whose sides have so many bits, in 1/16 pixel: no way is longer
    /// than 2^(bits - 3).
    #[inline(always)]
    pub(crate) fn walks_word_sized(self, bits: u32) -> bool {
        self.0 <= 1 << 11 && self.0 << ((2 * bits) & 31) <= WALKED << 6
    }

    /// The logarithm of the side of the largest square tiles in whose middles quadratics can be anchored, in pixels.
    pub(crate) fn tile(self) -> u32 {
        let mut side = 3;
        while side < 8 && self.walks_in_words(2 << side) {
            side += 1;
        }
        side
    }

    /// Whether a highlight is computed of the field.
    #[inline(always)]
    pub(crate) fn is_steep(self) -> bool {
        self != Self::NONE
    }

    /// Whether the field makes a highlight of an exponent above 128, or above 64 by a root.
    pub(crate) fn is_sharp(self) -> bool {
        self.0 > 128
    }

    /// Whether words fit first derivatives on a word-sized triangle whose sides have so many bits, in 1/16 pixel: S is below 2^(bits - 3).
    #[inline(always)]
    pub(crate) fn fits_words(self, bits: u32) -> bool {
        self.0 << (bits & 15) <= FIRST << 3
    }

    /// Whether [`Self::bends`] and [`Self::fits_words`] are sure, by the logarithm of how many times as long as high a word-sized triangle is at
    /// most.
    #[inline(always)]
    pub(crate) fn bends_little(self, small: i32, log_thinness: i32) -> bool {
        let bits = (2 * log_thinness - small).max(0) as u32;
        self.0 <= FIRST >> 7 && bits < 16 && self.0 << (bits & 15) <= BEND
    }

    /// Whether second derivatives can be rounded relative to the second differences, which are below 2^-`small`, on a triangle so many times as
    /// long as high.
    #[inline(always)]
    pub(crate) fn bends(self, small: i32, thinness: u32) -> bool {
        let bend = self.0.saturating_mul(thinness.saturating_mul(thinness));
        (if small < 0 { bend.saturating_mul(1 << -small.max(-3)) } else { bend >> small.min(31) }) <= BEND
    }

    /// Length over height beyond which gradients of 30 bits do not fit a quadratic, if second derivatives are rounded as if they were large.
    pub(crate) fn thinness(self) -> u32 {
        THIN.checked_div(self.0).unwrap_or(u32::MAX).isqrt()
    }
}
