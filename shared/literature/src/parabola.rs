//! Powers of a cosine as three parabolas (Kuijk and Blake, Faster Phong shading via angular interpolation, 1989).
//!
//! Along an arc the cosine between normal and light is G cos(x - x0), x the angle from the arc's start, and
//! its power s comes to G^s K(x - x0): K = 1 - u²/a within a, (1 - u)²/(1 - a) up to 1, nothing beyond, where
//! u = |x - x0| / b and a, 1/b depend on s. The parabolas meet smoothly.

use crate::{angle::polar, arc::Arc, scanline::Span};
use core::num::NonZeroU64;
use microphong::{
    math::{highlight_lut::HighlightLut, vector::dot},
    method::Walker,
};

/// Fraction bits of angles in units of b: Q8.24.
const PLACE: u32 = 24;
const ONE: i32 = 1 << PLACE;

/// The parabolas for one exponent, at most 1024.
#[derive(Clone, Copy)]
pub struct Parabolas {
    /// Half the width of the middle one, in units of b.
    a: i32,
    /// 1/b, Q6.26.
    narrow: i32,
    /// 1/a and 1/(1 - a), Q8.24.
    middle: i32,
    outer: i32,
}

/// `numerator / denominator` with `bits` fraction bits.
fn ratio(numerator: u64, denominator: u64, bits: u32) -> i32 {
    let quotient = (numerator << bits) / NonZeroU64::new(denominator).unwrap_or(NonZeroU64::MIN);
    quotient.min(i32::MAX as u64) as i32
}

impl Parabolas {
    /// The parabolas with these a and 1/b.
    fn new(a: i32, narrow: i32) -> Self {
        let a = a.clamp(1, ONE - 1);
        let inverse = |x: i32| ratio(1 << PLACE, u64::from(x.unsigned_abs()), PLACE);
        Self { a, narrow, middle: inverse(a), outer: inverse(ONE - a) }
    }

    /// The constants as printed in the paper: a b = (s + 5.6)/(s (0.09 s + 5.2)), b = (s + 65)/(5 s + 31.7). They are wrong by up to 0.26, at s =
    /// 512.
    pub fn printed(exponent: u16) -> Self {
        let s = u64::from(exponent.max(1));
        let a = ratio((10 * s + 56) * (50 * s + 317), s * (9 * s + 520) * (s + 65), PLACE);
        Self::new(a, ratio(50 * s + 317, 10 * (s + 65), 26))
    }

    /// Constants of our own fit: a b = (0.7535 + 0.55/s)/sqrt s, b = (2.992 - 1.33/s)/sqrt s; 1.3545 and 1.6861 for s = 1. They are wrong by at most
    /// 0.024.
    pub fn refitted(exponent: u16) -> Self {
        if exponent <= 1 {
            return Self::new(ratio(13_545, 16_861, PLACE), ratio(10_000, 16_861, 26));
        }
        let s = u64::from(exponent);
        let below = 29_920 * s - 13_300;
        // The root with 12 fraction bits more than it needs below: 26 in all.
        let root = (s << 44).isqrt();
        Self::new(ratio(7_535 * s + 5_500, below, PLACE), ratio(10_000 * s * root, below, 4))
    }
}

/// The power of the cosine between a normal and one direction.
#[derive(Clone, Copy)]
pub struct Lobe<'f> {
    /// L or H, Q2.30.
    pub direction: [i32; 3],
    /// The parabolas that stand for the power.
    pub parabolas: &'f Parabolas,
    /// The lookup table of the power; `None` for the cosine itself.
    pub lut: Option<&'f HighlightLut>,
}

impl Lobe<'_> {
    /// The power of a cosine, Q0.16.
    fn biased(&self, cosine: i32) -> i32 {
        match self.lut {
            Some(lut) => lut.at(cosine) as i32,
            None => cosine.clamp(0, 1 << 30) >> 14,
        }
    }

    /// Along the arc of a row, whose right end is `end`.
    pub fn along(&self, arc: &Arc, end: [i32; 3], span: &Span) -> PiecewiseQuadratic {
        let cosine = |v| (dot(v, self.direction) >> 30) as i32;
        // Hardly any angle between them, so no direction of it either: linear.
        if arc.sine < SHORT {
            let [l, r] = [arc.start, end].map(|v| i64::from(self.biased(cosine(v))) << 14);
            let times = |t: i32| (((r - l) * i64::from(t)) >> 30) as i32;
            let first = -times(span.step);
            let value = (l as i32).wrapping_add(times(span.last)).wrapping_sub(first);
            return PiecewiseQuadratic { value, first, ..PiecewiseQuadratic::FLAT };
        }
        let [radius, peak] = polar([cosine(arc.start), cosine(arc.across)]);
        let narrow = |angle: i32| ((i64::from(angle) * i64::from(self.parabolas.narrow)) >> 30) as i32;
        let times = |t: i32| ((i64::from(arc.angle) * i64::from(t)) >> 30) as i32;
        let step = narrow(times(span.step));
        let height = self.biased(radius);
        let bent = |curvature: i32| ((i64::from(height) * i64::from(curvature)) >> 20) as i32;
        PiecewiseQuadratic {
            place: narrow(times(span.last).wrapping_sub(peak)).wrapping_add(step),
            step,
            // Whatever comes first starts a piece.
            limit: i32::MAX,
            height: height << 14,
            a: self.parabolas.a,
            middle: bent(self.parabolas.middle),
            outer: bent(self.parabolas.outer),
            ..PiecewiseQuadratic::FLAT
        }
    }
}

/// Arcs whose sine (Q2.30) is less, 2^-9, have no plane: the rounding of their ends would turn it so far that a sharp highlight shows it. A
/// power of the exponent 1024 is linear along them to 0.13 of 1/255.
const SHORT: i32 = 1 << 21;

/// Walks three parabolas from right to left by two additions a pixel.
#[derive(Clone, Copy)]
pub struct PiecewiseQuadratic {
    /// The angle from the peak in units of b, Q8.24, and what a pixel adds to it.
    place: i32,
    step: i32,
    /// The place to the left of which another piece begins.
    limit: i32,
    /// Q2.30, and its differences.
    value: i32,
    first: i32,
    second: i32,
    /// The value at the peak, Q2.30.
    height: i32,
    /// Half the width of the middle piece.
    a: i32,
    /// Curvatures, Q12.20.
    middle: i32,
    outer: i32,
}

impl PiecewiseQuadratic {
    /// A piece of value 0.
    const FLAT: Self = Self { place: 0, step: 0, limit: i32::MIN, value: 0, first: 0, second: 0, height: 0, a: 0, middle: 0, outer: 0 };

    /// Starts the piece at the current place.
    #[inline(never)]
    fn turn(&mut self) {
        let Self { place, step, a, .. } = *self;
        // Height of the vertex, curvature, and from the vertex to here and on to the next pixel.
        let (limit, vertex, curvature, from, on) = if place >= ONE {
            (ONE, 0, 0, 0, 0)
        } else if place >= a {
            (a, 0, self.outer, ONE - place, step)
        } else if place >= -a {
            (-a, self.height, -self.middle, place, -step)
        } else if place >= -ONE {
            (-ONE, 0, self.outer, ONE + place, -step)
        } else {
            (i32::MIN, 0, 0, 0, 0)
        };
        // Curvature, Q12.20, times two lengths: 34 fraction bits after the first, 30 after both. It wraps only
        // where a pixel is wider than a piece, and its differences go unused.
        let bent = |u: i32, v: i32| {
            let once = (i64::from(curvature) * i64::from(u)) >> (20 + PLACE - 34);
            (once.wrapping_mul(i64::from(v)).wrapping_add(1 << (PLACE + 3)) >> (PLACE + 4)) as i32
        };
        self.limit = limit;
        self.value = vertex.wrapping_add(bent(from, from));
        self.first = bent(on, from.wrapping_mul(2).wrapping_add(on));
        self.second = bent(on, on).wrapping_mul(2);
    }
}

impl Walker for PiecewiseQuadratic {
    /// Q2.30; not less than 0.
    type Value = i32;

    #[inline(always)]
    fn step(&mut self) {
        self.place = self.place.wrapping_sub(self.step);
        if self.place < self.limit {
            self.turn();
        } else {
            self.value = self.value.wrapping_add(self.first);
            self.first = self.first.wrapping_add(self.second);
        }
    }

    #[inline(always)]
    fn value(&self) -> i32 {
        self.value.max(0)
    }
}
