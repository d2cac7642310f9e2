//! Fits of cubics to a triangle on the screen.

use super::terms::Terms;
use microphong::{
    format::{FINE, SPLITS, SUBPIXEL},
    math::wide::Wide,
    method::{GUARD, Gradients, MAX_THINNESS, Slopes},
};

/// The terms of the cubic through ten nodes in a range of 2^15, at the anchor; by powers of x, then of y.
///
/// In 128 bits all steps are exact, except the gradients and one rounding of each coefficient.
#[must_use]
pub fn fit(gradients: &Gradients, nodes: [i32; 10], extra: u32) -> Terms<i64> {
    let (nodes, fraction) = (nodes.map(Wide::from), extra + GUARD as u32);
    let [x, y] = gradients.shift().map(Wide::from);
    let thin = if gradients.is_thinner_than(MAX_THINNESS) { Sliver::new(gradients) } else { None };
    let terms = if let Some(sliver) = thin {
        sliver.fit(nodes, fraction).moved_across(|a, b| a + b * x).moved_down(|a, b| a + b * y)
    } else {
        // With three mantissas terms stay below 2^114, moved below 2^124.
        let Slopes { s, t, exponent } = gradients.slopes();
        let terms = Terms::of(nodes, s.map(Wide::from), t.map(Wide::from));
        let scaled = terms.map(|c, degree| scaled(c, degree as i32 * exponent + 2 - fraction as i32));
        // From the corner to the anchor.
        let [ox, oy] = gradients.offset.map(Wide::from);
        let by = |way: Wide| move |a: Wide, b: Wide| a + Wide((b * way).0 >> FINE);
        scaled.moved_across(by(ox + x.shifted(FINE))).moved_down(by(oy + y.shifted(FINE)))
    };
    terms.map(|c, _| scaled(c, GUARD).0 as i64)
}

/// A thin triangle, whose gradients cancel one another so much that nothing is rounded before the last division.
struct Sliver {
    /// Fraction bits of all coordinates.
    bits: u32,
    /// Vectors from corner 0 to corner 1, to corner 2, and to the centre of its pixel.
    edges: [[Wide; 2]; 2],
    offset: [Wide; 2],
    /// Twice the area.
    area: Wide,
}

impl Sliver {
    /// `None` if twice the area does not fit a word; such a triangle is thousands of pixels long, and not thin.
    fn new(gradients: &Gradients) -> Option<Self> {
        let edges @ [[x1, y1], [x2, y2]] = gradients.edges.map(|edge| edge.map(Wide::from));
        let area = x1 * y2 - x2 * y1;
        let level = gradients.level();
        let offset = gradients.offset.map(|c| Wide::from(c >> (SPLITS - level)));
        (1..=u32::MAX.into()).contains(&area.0).then_some(Self { bits: SUBPIXEL + level, edges, offset, area })
    }

    /// The terms at the centre of the pixel, with `extra` more bits than the nodes.
    ///
    /// Every coefficient is exact before it is rounded down, modulo 2^128.
    #[cold]
    #[inline(never)]
    fn fit(&self, nodes: [Wide; 10], extra: u32) -> Terms<Wide> {
        let ([[x1, y1], [x2, y2]], [ox, oy], det) = (self.edges, self.offset, self.area);
        // det is below 2^28, as slivers have less than 1/128 of their square; all together below 2^105.
        let common = Terms::of(nodes, [y2, -x2], [-y1, x1]).map(|c, degree| (degree..3).fold(c, |c, _| c * det));
        let divisor = 4 * det * det * det;
        let over = |numerator: Wide, bits: u32| {
            // Long division, 35 bits at a time.
            let (whole, rest) = divided(numerator, divisor);
            let (upper, rest) = divided(rest.shifted(bits / 2), divisor);
            let (lower, _) = divided(rest.shifted(bits - bits / 2), divisor);
            whole.shifted(bits) + upper.shifted(bits - bits / 2) + lower
        };
        let at_centre = common.moved_across(|a, b| a + b * ox).moved_down(|a, b| a + b * oy);
        at_centre.map(|c, degree| over(c, extra + degree * self.bits))
    }
}

/// `(quotient, remainder)`: the quotient is rounded down, so the remainder is not negative. Domain: the divisor is positive; for
/// others the result is zeros. Exact (tests::divisions).
#[inline(never)]
fn divided(Wide(number): Wide, Wide(divisor): Wide) -> (Wide, Wide) {
    if divisor <= 0 {
        return (Wide(0), Wide(0));
    }
    // One division: the remainder follows from the quotient.
    let quotient = number.checked_div(divisor).unwrap_or(0);
    let rest = number.wrapping_sub(quotient.wrapping_mul(divisor));
    if rest < 0 { (Wide(quotient.wrapping_sub(1)), Wide(rest.wrapping_add(divisor))) } else { (Wide(quotient), Wide(rest)) }
}

/// `value / 2^bits`, rounded to nearest, halves up; for negative `bits` a left shift that wraps modulo 2^128.
///
/// Domain: `bits` is -127 to 126, and `value + 2^(bits - 1)` fits 128 bits. Exact (tests::scaling).
#[inline(never)]
fn scaled(Wide(value): Wide, bits: i32) -> Wide {
    if bits > 0 {
        let bits = bits.unsigned_abs().min(126);
        Wide(value.wrapping_add(1 << (bits - 1)) >> bits)
    } else {
        Wide(value.wrapping_shl(bits.unsigned_abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn divisions(value: i128, divisor in 1..i128::MAX, bits in 0..127u32) {
            let divisor = (divisor >> bits).max(1);
            let (Wide(quotient), Wide(rest)) = divided(Wide(value), Wide(divisor));
            prop_assert!(0 <= rest && rest < divisor);
            prop_assert_eq!(quotient.wrapping_mul(divisor).wrapping_add(rest), value);
            prop_assert_eq!(divided(Wide(value), Wide(-divisor)), (Wide(0), Wide(0)));
        }
    }

    #[test]
    fn scaling() {
        for value in [0i128, 1, -1, 5, -5, 0x1234_5678_9ABC, -0x1234_5678_9ABC, (1 << 62) - 1, -(1 << 62)] {
            for bits in 1..63 {
                let nearest = (value + (1 << (bits - 1))).div_euclid(1 << bits);
                assert_eq!(scaled(Wide(value), bits).0, nearest, "{value} {bits}");
                assert_eq!(scaled(Wide(value << 63), bits + 63).0, nearest, "{value} {bits}");
            }
            for bits in 0..64 {
                assert_eq!(scaled(Wide(value), -bits).0, value << bits, "{value} -{bits}");
            }
        }
    }
}
