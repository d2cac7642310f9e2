//! Floating point to the numbers of a stream, and numbers as messages say them.

use microphong::fixed::traits::Fixed;

/// The number of a stream's format that is nearest to `x`. A number that does not fit becomes the smallest or largest that does; the check of the
/// stream finds it where it is not allowed. NaN becomes 0.
#[must_use]
pub fn nearest<F: Fixed>(x: f64) -> F {
    if x.is_nan() { F::ZERO } else { F::saturating_from_num(x) }
}

/// The largest number of the format that is not above `x`; saturates likewise.
#[must_use]
pub fn below<F: Fixed>(x: f64) -> F {
    nearest((x / last_place::<F>()).floor() * last_place::<F>())
}

/// The least number of the format that is not below `x`; saturates likewise.
#[must_use]
pub fn above<F: Fixed>(x: f64) -> F {
    nearest((x / last_place::<F>()).ceil() * last_place::<F>())
}

/// The smallest step of a format, a power of two.
fn last_place<F: Fixed>() -> f64 {
    F::DELTA.to_num()
}

/// 12345 as 12,345.
#[must_use]
pub fn grouped(number: impl TryInto<u64>) -> String {
    let digits = number.try_into().unwrap_or(u64::MAX).to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use microphong::format::{Gain, Unit};

    #[test]
    fn numbers_are_rounded_and_saturate() {
        assert_eq!(nearest::<Unit>(-0.7).to_bits(), -11_469);
        assert_eq!(below::<Unit>(-0.7).to_bits(), -11_469);
        assert_eq!(above::<Unit>(-0.7).to_bits(), -11_468);
        assert_eq!([below::<Unit>(0.25), above::<Unit>(0.25)].map(Unit::to_bits), [1 << 12; 2]);
        assert_eq!(nearest::<Unit>(7.0), Unit::MAX);
        assert_eq!(nearest::<Gain>(-7.0), Gain::ZERO);
        assert_eq!(nearest::<Gain>(f64::INFINITY), Gain::MAX);
        assert_eq!(nearest::<Gain>(f64::NAN), Gain::ZERO);
    }
}
