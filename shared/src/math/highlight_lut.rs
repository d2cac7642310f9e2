//! The lookup table of the highlight's power function, x^n.

use crate::{
    arch::{
        product::{product, unsigned_product, upper_by_half_word},
        quotient::long,
    },
    format::{COSINE, PIXEL_COSINE},
};
use core::num::NonZeroU32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Number of intervals in the table. It has one entry more.
pub(crate) const SIZE: usize = 4096;

/// The highlight's power function `floor + full base^n`, unsigned Q0.16, by which a table is filled and which replaces one where there is no memory
/// for it.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct HighlightCurve {
    /// 4 max(n, 8), where n is the exponent of the argument: an index of a table is (1 - x) times 128 times this.
    scale: u32,
    /// The value at 1, less the floor, unsigned Q0.16.
    full: u32,
    /// The exponent.
    n: u16,
    /// The value where the power is 0, unsigned Q0.16.
    floor: u16,
    /// See [`Highlight`].
    base: u32,
}

/// Lookup table of the highlight's power function `floor + full x^n`, unsigned Q0.16, in 4096 intervals.
///
/// Domain: n from 1 to 1024. The table covers x in [1 - 8/n, 1], or [0, 1] for n < 8; below that x^n is less than e^-8 and taken as 0.
/// Error: [`ERROR`] with interpolation, [`NEAREST_ERROR`] for the nearest entry. Source: Bishop & Weimer (1986), whose table covers the
/// whole of [0, 1], so that its error grows with n; the restricted domain, which makes the error independent of n, is our own.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct HighlightLut {
    /// 4 max(n, 8), where n is the exponent of the argument: an index is (1 - x) times 128 times this.
    pub(crate) scale: u32,
    /// The value of entries where the power is 0, unsigned Q0.16.
    floor: u16,
    pub(crate) table: [u16; SIZE + 1],
}

/// The quantity x by which a table is looked up. A base that follows from it is raised to the exponent `n` of a material. Each is scaled so that all
/// methods give highlights of one width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Highlight {
    /// The cosine of normal and half vector: (N·H)^n (Blinn 1977). The base is x.
    Half,
    /// The square of this cosine: ((N·H)²)^(n/2). The base is the square root of x.
    HalfSquared,
    /// The cosine of reflected light and viewer: (R·V)^(n/4) (Phong 1975). The base is the fourth root of x. If L, N and V lie in a plane, the angle
    /// of R and V is twice the angle of N and H.
    Reflected,
    /// The square root z of N·H: (z²)^n. The base is x². Below 1/2 it goes on as the tangent there: x - 1/4.
    Root,
}

impl Highlight {
    /// How often the square root is taken.
    const fn roots(self) -> u32 {
        match self {
            Self::Half | Self::Root => 0,
            Self::HalfSquared => 1,
            Self::Reflected => 2,
        }
    }

    /// Smallest exponent of a material. At this exponent the base is raised to 1.
    pub const fn least_exponent(self) -> u16 {
        1 << self.roots()
    }
}

/// The base of [`Highlight::Root`] for `x`, Q2.30, rounded down.
///
/// Domain: `x` from -7/4 to just below √2, so that the result fits. Error: less than 1 unit of the last place (tests::squares).
pub fn square(x: i32) -> i32 {
    if x >= 1 << (COSINE - 1) { (product(x, x) >> COSINE) as i32 } else { x - (1 << (COSINE - 2)) }
}

/// The square root of `x`, rounded down. Exact (tests::roots_are_exact).
///
/// Source: Hacker's Delight 11-1, bit by bit, with a fifth of the library's code. Few methods take roots, and only when a table is filled.
#[inline(never)]
fn root(x: u64) -> u64 {
    let (mut rest, mut root, mut bit) = (x, 0, 1 << 62);
    while bit > 0 {
        let more = root + bit;
        root >>= 1;
        if rest >= more {
            rest -= more;
            root += bit;
        }
        bit >>= 2;
    }
    root
}

/// Four times the exponent up to which the table covers the whole of [0, 1].
const WHOLE: NonZeroU32 = NonZeroU32::new(4 * 8).unwrap();

/// One of this number of entries is computed by the power function. Straight lines give the entries between, with an error of at most 8e-6: over the
/// interval x^n is like e^-y, y in steps of 8/1024.
const COMPUTED: usize = 4;

/// `x^n` by binary exponentiation, Q1.31. Domain: `x` from 0 to 1.
fn power(mut x: u32, mut n: u16) -> u32 {
    let product = |a: u32, b: u32| (unsigned_product(a, b) >> 31) as u32;
    let mut result = 1 << 31;
    while n > 0 {
        if n & 1 == 1 {
            result = product(result, x);
        }
        x = product(x, x);
        n >>= 1;
    }
    result
}

/// Fraction bits of an entry, unsigned Q0.16.
pub const ENTRY: u32 = 16;

impl HighlightCurve {
    /// The curve `floor + full base^n`.
    ///
    /// Domain: `n` is 1 to 1024, at least 2 for [`Highlight::HalfSquared`] and 4 for [`Highlight::Reflected`]; `full` and `floor` are unsigned Q0.16,
    /// their sum at most 1.
    pub fn new(n: u16, base: Highlight, full: u32, floor: u16) -> Self {
        let n4 = u32::from(n) << 2;
        let scale = WHOLE.max(NonZeroU32::new(if base == Highlight::Root { n4 << 1 } else { n4 >> base.roots() }).unwrap_or(WHOLE));
        Self { scale: scale.get(), full, n, floor, base: base as u32 }
    }

    fn scale(&self) -> NonZeroU32 {
        NonZeroU32::new(self.scale).unwrap_or(WHOLE)
    }

    /// `1 - x` between two entries of a table, Q1.63: 8 / (4096 max(n, 8)). Products of two x fit 64 bits.
    fn step(&self) -> u64 {
        long(1 << 56, self.scale().get().into())
    }

    /// The value `i` steps below 1, where [`Self::step`] is `step`. In integers: the bits are the same on every machine.
    ///
    /// Source: binary exponentiation in Q1.31.
    fn value(&self, i: usize, step: u64) -> u32 {
        let x = (1u64 << 31).saturating_sub((i as u64 * step) >> 32);
        let roots = |roots| (0..roots).fold(x, |x, _| root(x << 31));
        let x = match self.base {
            base if base == Highlight::Root as u32 => (square((x >> 1) as i32).max(0) as u64) << 1,
            base if base == Highlight::HalfSquared as u32 => roots(Highlight::HalfSquared.roots()),
            base if base == Highlight::Reflected as u32 => roots(Highlight::Reflected.roots()),
            _ => x,
        };
        u32::from(self.floor) + ((unsigned_product(power(x as u32, self.n), self.full) + (1 << 30)) >> 31) as u32
    }

    /// [`HighlightLut::at`] without a table, bit for bit. It takes some hundred instructions.
    ///
    /// Domain: every `cosine`, Q2.30; above 1 counts as 1. Error: at most [`ERROR`] of full intensity (tests::error).
    #[inline(never)]
    pub fn at(&self, cosine: i32) -> u32 {
        let position = position(self.scale, cosine);
        let i = (position >> 12) as usize;
        if i >= SIZE {
            return 0;
        }
        let (block, k) = (i / COMPUTED, i % COMPUTED);
        let step = self.step();
        let ends = [self.value(block * COMPUTED, step), self.value((block + 1) * COMPUTED, step)];
        let entry = |k: usize| if block * COMPUTED + k < SIZE - 1 { between(ends, k) } else { self.floor };
        interpolated([entry(k), entry(k + 1)], position, self.floor)
    }

    /// The smallest value, where the power is 0; unsigned Q0.16.
    pub fn floor(&self) -> u32 {
        self.floor.into()
    }

    /// The cosine, Q2.30, at which a table ends. The powers of smaller cosines count as 0.
    pub fn highlight_threshold(&self) -> i32 {
        (1i32 << COSINE) - long(32u64 << COSINE, self.scale().get().into()) as i32
    }
}

/// Position of a cosine (Q2.30) in a table, unsigned Q20.12: 1 - cosine in steps of the table. Small cosines lie past the end.
#[inline]
fn position(scale: u32, cosine: i32) -> u32 {
    let below = (1i32 << COSINE).saturating_sub(cosine).max(0) as u32;
    // (1 - cosine) * 4 n / 32 * 4096 / 2^30, with 12 fraction bits.
    u32::try_from(unsigned_product(below, scale) >> (COSINE - 19)).unwrap_or(u32::MAX)
}

/// The entry `k` of [`COMPUTED`] from the first to the second of two computed entries.
fn between([upper, lower]: [u32; 2], k: usize) -> u16 {
    let sum = upper * (COMPUTED - k) as u32 + lower * k as u32;
    (sum / COMPUTED as u32).min(0xffff) as u16
}

/// The value at a position between two entries of a table, without the floor. It wraps only in a table that is not filled, which materials without a
/// highlight may have.
#[inline]
fn interpolated([a, b]: [u16; 2], position: u32, floor: u16) -> u32 {
    u32::from(a).wrapping_sub((u32::from(a.saturating_sub(b)) * (position & 0xfff)) >> 12).wrapping_sub(floor.into())
}

impl HighlightLut {
    /// Computes the table of a curve.
    pub fn fill(&mut self, curve: &HighlightCurve) {
        (self.scale, self.floor) = (curve.scale().get(), curve.floor);
        let step = curve.step();
        let mut upper = curve.value(0, step);
        for (i, entries) in self.table.chunks_mut(COMPUTED).enumerate() {
            let lower = curve.value((i + 1) * COMPUTED, step);
            entries.iter_mut().enumerate().for_each(|(k, entry)| *entry = between([upper, lower], k));
            upper = lower;
        }
        // Everything below the domain gets the lowest entry; in the pixel loop, the one above it.
        let [.., lower, lowest] = &mut self.table;
        (*lowest, *lower) = (curve.floor, curve.floor);
    }

    /// `full cosine^n`, unsigned Q0.16, without the floor, by linear interpolation.
    ///
    /// Domain: every `cosine`, Q2.30; above 1 counts as 1. Error: at most [`ERROR`] of full intensity (tests::error).
    pub fn at(&self, cosine: i32) -> u32 {
        let position = position(self.scale, cosine);
        let i = (position >> 12) as usize;
        match (self.table.get(i), self.table.get(i + 1)) {
            (Some(&a), Some(&b)) => interpolated([a, b], position, self.floor),
            _ => 0,
        }
    }

    /// Lookup of the nearest entry by a cosine. The entry nearest to a cosine, Q5.27, is number `((top - cosine) * factor) >> 36`.
    pub fn by_cosine(&self) -> CosineLookup<'_> {
        let scale = NonZeroU32::new(self.scale).unwrap_or(WHOLE);
        CosineLookup { table: &self.table, top: (1 << PIXEL_COSINE) + ((1 << 19) / scale) as i32, factor: (scale.get() << 16) as i32 }
    }
}

/// Lookup of the nearest entry by a cosine, for pixel loops: one product and one load.
#[derive(Clone, Copy, Debug)]
pub struct CosineLookup<'a> {
    table: &'a [u16; SIZE + 1],
    top: i32,
    factor: i32,
}

impl CosineLookup<'_> {
    /// `floor + full cosine^n`, unsigned Q0.16, from the nearest entry.
    ///
    /// Domain: `cosine` in Q5.27 such that 1 - cosine fits it. Error: at most [`NEAREST_ERROR`] (tests::error).
    #[inline]
    pub fn at(&self, cosine: i32) -> u32 {
        let fine = upper_by_half_word(self.top.wrapping_sub(cosine), self.factor);
        // One instruction shifts and clamps, and nothing is left to check.
        self.table[(fine >> 4).clamp(0, SIZE as i32 - 1) as usize].into()
    }
}

/// Largest error of [`HighlightLut::at`], as a share of full intensity: the cut at e^-8, and rounding to 16 bits. It is 0.09 of 1/255.
pub const ERROR: f64 = 3.4e-4;
/// Largest error of [`CosineLookup::at`], as a share of full intensity: half a step of the table where its slope is largest. It is 0.26
/// of 1/255.
pub const NEAREST_ERROR: f64 = 1.0e-3;

#[cfg(test)]
mod tests {
    use super::*;
    use zerocopy::FromZeros;

    #[test]
    fn roots_are_exact() {
        let numbers = (0..64).flat_map(|bits| (0..1000u64).map(move |k| k.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> bits));
        numbers.chain([u64::MAX]).for_each(|x| assert_eq!(root(x), x.isqrt(), "{x}"));
    }

    #[test]
    fn error() {
        // The largest errors are next to entries, and half way between two of them.
        let positions = || (0..SIZE + 12).flat_map(|i| [0.0, 0.498, 0.4999, 0.5001, 0.502, 0.999].map(|f| i as f64 + f));
        for n in (1..12).chain([20, 50, 127, 128, 500, 1023, 1024]) {
            for (base, (full, floor)) in [Highlight::Half, Highlight::HalfSquared, Highlight::Reflected, Highlight::Root]
                .into_iter()
                .flat_map(|base| [(1 << 16, 0), (40_000, 20_000)].map(|range| (base, range)))
            {
                if n >> base.roots() == 0 {
                    continue;
                }
                let (mut lut, curve) = (HighlightLut::new_zeroed(), HighlightCurve::new(n, base, full, floor));
                lut.fill(&curve);
                let (mut at, mut nearest) = (0f64, 0f64);
                let step = 2f64.powi(30) - f64::from(curve.highlight_threshold());
                for position in positions() {
                    let cosine = (2f64.powi(30) - (step / SIZE as f64 * position).floor()) as i32;
                    let x = f64::from(cosine) / 2f64.powi(30);
                    let x = match base {
                        Highlight::Root if x >= 0.5 => x * x,
                        Highlight::Root => (x - 0.25).max(0.0),
                        _ => x.max(0.0).powf(1.0 / f64::from(1 << base.roots())),
                    };
                    let exact = f64::from(full) * x.powi(n.into());
                    assert_eq!(curve.at(cosine), lut.at(cosine), "n = {n}, {base:?}: {cosine}");
                    at = at.max((f64::from(lut.at(cosine)) - exact).abs() / 65_536.0);
                    nearest = nearest.max((f64::from(lut.by_cosine().at(cosine >> 3)) - f64::from(floor) - exact).abs() / 65_536.0);
                }
                assert!(at <= ERROR, "n = {n}, {base:?}: {at}");
                assert!(nearest <= NEAREST_ERROR, "n = {n}, {base:?}: {nearest}");
                assert_eq!(lut.at(curve.highlight_threshold() - 1), 0, "n = {n}, {base:?}");
            }
        }
    }

    #[test]
    fn squares() {
        for x in (-(7i64 << 28)..1_518_500_249).step_by(10_007).chain([1_518_500_249]) {
            let exact = if x >= 1 << 29 { (x * x) >> COSINE } else { x - (1 << 28) };
            assert_eq!(i64::from(square(x as i32)), exact, "{x}");
        }
    }
}
