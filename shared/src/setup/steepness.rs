//! Steepness of a field: how exactly it has to be fitted and walked, so that no highlight shows its errors.
//!
//! If the cosine of a highlight of exponent n has the error e, its level has an error of up to 255 n e. Three errors of a field grow with the
//! triangle: errors of first derivatives, of second derivatives, and of walking. Each has a fixed part of half a level. If a fast way would exceed
//! this, a slower one is taken. Ordinary meshes have next to no such triangles.

/// Largest error of a highlight by first derivatives, in 1/255.
pub const SLOPE: f64 = 0.06;
/// Largest error of a highlight by second derivatives, in 1/255.
pub const CURVATURE: f64 = 0.02;
/// Largest error of a highlight by walking, in 1/255.
pub const WALK: f64 = 0.07;

/// The largest `n e`, in units of 2^-`bits`, at which a highlight has an error of `share` of 1/255.
const fn limit(share: f64, bits: u32) -> u32 {
    (share / 255.0 * (1u64 << bits) as f64) as u32
}

/// Largest n S² of a quadratic that words walk: coefficients that are rounded to 2^-30 are off by 2^-31 (1 + S + S²) at a distance of S
/// columns plus rows.
const WALKED: u32 = limit(WALK, 31);
/// Largest n S of a field that words fit on a word-sized triangle: its first derivatives are off by 2^-27.
const FIRST: u32 = limit(SLOPE, 27);
/// Largest n k² that gradients of 30 bits fit: with k the length over the height, quadratics are off by 1.3 · 2^-25 k².
const THIN: u32 = limit(SLOPE, 25) * 10 / 13;
/// Largest n d k² that words fit, or gradients of 30 bits: with d the second difference of nodes, quadratics are off by 2^-25 d k².
const BEND: u32 = limit(CURVATURE, 25);

/// The largest power of two that fits `a / b`, as its logarithm. A division would take a small processor longer.
const fn log_quotient(a: u32, b: u32) -> u32 {
    let log = a.ilog2() - b.ilog2();
    if b << log <= a { log } else { log - 1 }
}

/// The largest steepness that is distinguished. If words walk a quadratic of this steepness all over a word-sized triangle, they also fit its first
/// derivatives: [`FIRST`] is the smaller limit only below 8 pixels, where it allows this much.
const MOST: u32 = FIRST >> 3;

/// How steeply light depends on a field: as a highlight of this exponent, or as exponent 0 for a field of levels. It also tells which fast ways are
/// exact enough.
///
/// It fits one word, because every triangle keeps it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(4))]
pub struct Steepness {
    exponent: u16,
    /// Bits of the longest side, in 1/16 pixel, of a word-sized triangle on which words walk a quadratic exactly enough: no distance is more than
    /// 2^(bits - 3). [`Self::ALL`] if there is no limit.
    walked: u8,
    /// Largest logarithm of d k², [`Self::LOG`] added, for which words fit second derivatives.
    bend: u8,
}

impl Steepness {
    /// The value for no limit.
    const ALL: u8 = u8::MAX;
    /// Added to logarithms, so that all are positive.
    pub(crate) const LOG: u32 = 18;
    /// The steepness of a field of levels, from which no highlight is computed.
    pub const NONE: Self = Self { exponent: 0, walked: Self::ALL, bend: Self::ALL };

    /// The steepness of quadratics that are raised to `exponent`.
    pub const fn new(exponent: u32) -> Self {
        let exponent = if exponent > MOST { MOST } else { exponent };
        if exponent == 0 {
            return Self::NONE;
        }
        Self {
            exponent: exponent as u16,
            walked: (log_quotient(WALKED << 6, exponent) / 2) as u8,
            bend: log_quotient(BEND << Self::LOG, exponent) as u8,
        }
    }

    /// The steepness of a quadratic on a large triangle, where light depends on it `2^bits` times less steeply.
    pub(crate) fn halved(self, bits: u32) -> Self {
        Self { exponent: self.exponent >> bits, ..self }
    }

    /// The steepness of planes instead of quadratics. Planes are walked exactly enough in words over any triangle.
    pub(crate) const fn of_planes(self) -> Self {
        Self { walked: Self::ALL, ..self }
    }

    /// The steepness of fields of which light is a function with this slope: a field that errs by e makes an error of e `slope` in light of full strength.
    pub(crate) fn of_slope(slope: u64) -> Self {
        Self::new(slope.min(MOST.into()) as u32)
    }

    /// The larger steepness, by which every fast way is exact enough for both.
    pub(crate) fn max(self, other: Self) -> Self {
        Self { exponent: self.exponent.max(other.exponent), walked: self.walked.min(other.walked), bend: self.bend.min(other.bend) }
    }

    /// Whether a quadratic can be walked in words as far as `span` columns plus rows from its anchor.
    pub(crate) fn walks_in_words(self, span: u32) -> bool {
        // Steepness has at most 13 bits, and no limit is above 1,023 pixels: all products fit a word.
        let span = span.min(1023);
        self.walked == Self::ALL || ((span * span) >> 4) * u32::from(self.exponent) <= WALKED >> 4
    }

    /// Whether a quadratic can be walked in words all over a word-sized triangle whose sides have this number of bits.
    #[inline]
    pub(crate) fn walks_word_sized(self, bits: u32) -> bool {
        bits <= u32::from(self.walked)
    }

    /// Base-2 logarithm of the side, in pixels, of the largest square tiles in whose middles quadratics can be anchored.
    pub(crate) fn tile(self) -> u32 {
        let mut side = 3;
        while side < 8 && self.walks_in_words(2 << side) {
            side += 1;
        }
        side
    }

    /// Whether a highlight is computed from the field.
    #[inline]
    pub(crate) fn is_steep(self) -> bool {
        self.exponent > 0
    }

    /// Whether the field makes a highlight of an exponent above 128, or above 64 if it is a root.
    pub(crate) fn is_sharp(self) -> bool {
        self.exponent > 128
    }

    /// Whether words fit first derivatives on a word-sized triangle whose sides have this number of bits.
    #[inline]
    pub(crate) fn fits_words(self, bits: u32) -> bool {
        u32::from(self.exponent) <= (FIRST << 3) >> (bits & 31)
    }

    /// Whether [`Self::bends`] is sure where d k² is below 2^(`log` - [`Self::LOG`]).
    #[inline]
    pub(crate) fn bends_little(self, log: u32) -> bool {
        log <= u32::from(self.bend)
    }

    /// Whether second derivatives can be rounded relative to the second differences, which are below 2^-`small`, on a triangle that is `thinness`
    /// times as long as high.
    pub(crate) fn bends(self, small: i32, thinness: u32) -> bool {
        let bend = u32::from(self.exponent).saturating_mul(thinness.saturating_mul(thinness));
        (if small < 0 { bend.saturating_mul(1 << -small.max(-3)) } else { bend >> small.min(31) }) <= BEND
    }

    /// Whether gradients of 30 bits do not fit a quadratic on a triangle that is `thinness` times as long as high, if second derivatives are rounded
    /// as for large second differences.
    #[inline]
    pub(crate) fn is_thin(self, thinness: u32) -> bool {
        // No limit is above 511, and steepness has at most 13 bits.
        let thinness = thinness.min(511);
        u32::from(self.exponent) * (thinness * thinness) > THIN
    }
}
