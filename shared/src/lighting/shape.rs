//! How the range and the cone of a point light weaken it.
//!
//! At the distance d, a light with the range R has (1 - d²/R²)² of its strength; from R on it has none. The formula needs no division at the pixel.
//! Neither the strength nor its slope jumps at R. Let c be the cosine of the angle to the axis of a cone, e the cosine at the edge of the cone, and f the
//! cosine up to which light is full. In the cone the light has ((c - e)/(f - e))² of its strength. Source of the cone: glTF, KHR_lights_punctual.

use crate::{
    arch::product::{unsigned_product, upper},
    format::{COSINE, POSITION, UNIT},
    geometry::model_view::{FARTHEST_UNITS, ModelView},
    math::{
        recip::recip,
        vector::{dot, map, normalise, wide},
    },
    stream::record::{EYE_SPACE, Light},
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Fraction bits of the strength of a light: full light is 1 << 16.
pub const STRENGTH: u32 = 16;
/// Largest error of the strength of a light at a point, as a part of full light, in cones whose cosines differ by at least 2^-10.
pub const ERROR: f64 = 6.0 / 65_536.0;

/// The range and the cone of a point light, in object space; the axis of the cone lies beside it. All zeros if it has neither. It lies in the
/// renderer's memory.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct Shape {
    /// The cosine of the angle between the axis and the edge of the cone, Q2.30.
    edge: i32,
    /// 1 over the difference of the cone's two cosines, unsigned Q15.17; 0 if there is no cone.
    slope: u32,
    /// 1/R² is this number, of 32 bits, times 2^-`exponent`; 0 if there is no range.
    inverse_square: u32,
    exponent: i32,
}

/// Squared distances over a triangle as parts of R².
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    /// d²/R² for a distance of 1 is this number times 2^-`shift`.
    mantissa: u32,
    shift: u32,
}

impl Shape {
    /// The shape of `light` for an object at the place `model_view`, whose distance from the light has been shortened from the square root of
    /// `shortened`, as [`ModelView::shortened`] says. The axis of the cone is a unit vector from the light to where it shines, Q2.30; zero if there is
    /// no cone.
    pub(super) fn new(light: &Light, model_view: &ModelView, shortened: Option<u64>) -> (Self, [i32; 3]) {
        let axis = map(wide(light.axis), |c| c << (COSINE - UNIT));
        let axis = if light.space == EYE_SPACE { model_view.to_object(axis) } else { model_view.world_to_object(axis) };
        let [edge, full] = light.cone.map(i32::from);
        let difference = (full - edge).max(0) as u32;
        let (inverse_square, exponent) = inverse_square(light.range, model_view.scale, shortened);
        let shape = Self {
            edge: edge << (COSINE - UNIT),
            slope: (1u32 << (UNIT + SLOPE)).checked_div(difference).unwrap_or(0),
            inverse_square,
            exponent,
        };
        (shape, if difference > 0 { normalise(axis) } else { [0; 3] })
    }

    /// Whether the light is equally strong everywhere.
    #[inline]
    pub(super) fn is_even(&self) -> bool {
        self.slope == 0 && self.inverse_square == 0
    }

    /// Whether the light has a cone.
    #[inline]
    pub fn has_cone(&self) -> bool {
        self.slope != 0
    }

    /// The most that the strength of the light changes where a squared distance changes by 1, or its product with the axis of the cone. `square` is a
    /// lower bound of squared distances, Q2.30, of which the largest is 1.
    pub(crate) fn slope(&self, nearness: Nearness, square: u32) -> u64 {
        // The slope of (1 - d²/R²)², and of ((c - e)/(f - e))², where c is a product over a root.
        let range = (2 * u64::from(nearness.mantissa)) >> nearness.shift;
        let cosine = (3 << COSINE) / u64::from(square.max(1));
        range + ((u64::from(self.slope) * cosine) >> SLOPE)
    }

    /// The strength of the light at a point from which the light is `way` away, Q7.25, where its cone is about `axis`: 0 to 1 << [`STRENGTH`].
    pub(super) fn strength(&self, axis: [i32; 3], way: [i32; 3]) -> u32 {
        let half = map(way, |c| c >> 1);
        let part = self.nearness(dot(half, half) as u64).part(1 << COSINE);
        self.weaker(part, || -((dot(axis, normalise(way)) >> COSINE) as i32))
    }

    /// Squared distances as parts of R², where a distance of 1 is the root of `square`, Q14.48.
    pub fn nearness(&self, square: u64) -> Nearness {
        let (mantissa, exponent) = times(scaled(square, SQUARE), (self.inverse_square, self.exponent));
        Nearness { mantissa, shift: exponent.clamp(0, 63) as u32 }
    }

    /// The strength of the light at a point whose squared distance is `part` of R², Q2.30, and where `cosine` gives the cosine to the axis of the
    /// cone, Q2.30.
    #[inline]
    pub fn weaker(&self, part: u32, cosine: impl FnOnce() -> i32) -> u32 {
        let square = |share: u32| (unsigned_product(share, share) >> STRENGTH) as u32;
        let near = square((1u32 << COSINE).saturating_sub(part) >> (COSINE - STRENGTH));
        if self.slope == 0 || near == 0 {
            return near;
        }
        let within = cosine().saturating_sub(self.edge).max(0);
        let share = unsigned_product(within as u32, self.slope) >> (COSINE + SLOPE - STRENGTH);
        (unsigned_product(near, square(share.min(1 << STRENGTH) as u32)) >> STRENGTH) as u32
    }

    /// The shape for loops over a triangle with these squared distances; `None` if the light is too steep for them.
    pub(crate) fn coarse(&self, nearness: Nearness) -> Option<CoarseShape> {
        let nearness = if self.inverse_square == 0 { CoarseNearness { mantissa: 0, shift: 0 } } else { nearness.coarse()? };
        (self.slope <= STEEPEST).then_some(CoarseShape { nearness, edge: self.edge, slope: self.slope })
    }
}

/// Fraction bits of [`Shape::slope`].
const SLOPE: u32 = 17;
/// Fraction bits of a squared distance of halves: twice those of a position less the bit that was shifted off.
const SQUARE: i32 = 2 * (POSITION as i32 - 1);

impl Nearness {
    /// The part of R² of the squared distance `square`, unsigned Q0.32, as Q.15, rounded down. `None` where parts may not fit a word: where a distance
    /// of 1 is more than 256 R.
    #[inline]
    pub(crate) fn coarse(self) -> Option<CoarseNearness> {
        let shift = self.shift.checked_sub(COSINE - STRENGTH + 1)?;
        Some(CoarseNearness { mantissa: self.mantissa, shift: shift.min(31) })
    }

    /// The part of R², Q2.30, of the squared distance `square`, Q2.30 in [0, 2); it saturates.
    #[inline]
    pub fn part(self, square: u32) -> u32 {
        let part = unsigned_product(square, self.mantissa) >> self.shift;
        if part >> 32 == 0 { part as u32 } else { u32::MAX }
    }
}

/// [`Nearness`] for loops: what is left of the light by a few instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoarseNearness {
    mantissa: u32,
    shift: u32,
}

impl CoarseNearness {
    /// The strength of a light without a cone at the squared distance `square`, unsigned Q0.32; Q2.30. Error: 2^-14 of full light.
    #[inline]
    pub(crate) fn strength(self, square: u32) -> i32 {
        const ONE: i32 = 1 << 15;
        let part = ((unsigned_product(square, self.mantissa) >> 32) as u32) >> self.shift;
        let left = ONE - part.min(ONE as u32) as i32;
        left * left
    }
}

/// [`Shape`] for loops: what is left of a light by a few instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoarseShape {
    nearness: CoarseNearness,
    /// See [`Shape::edge`] and [`Shape::slope`].
    edge: i32,
    slope: u32,
}

/// The largest [`Shape::slope`] in loops: a cosine that errs by 4e-6 makes an error of 0.13 of 1/255.
const STEEPEST: u32 = 64 << SLOPE;

impl CoarseShape {
    /// The strength of the light at the squared distance `square`, unsigned Q0.32, where `cosine` gives the cosine to the axis of the cone, Q2.30; Q2.30.
    /// Error: 2^-13 of full light.
    #[inline]
    pub(crate) fn strength(&self, square: u32, cosine: impl FnOnce() -> i32) -> i32 {
        let near = self.nearness.strength(square);
        if self.slope == 0 {
            return near;
        }
        let within = cosine().saturating_sub(self.edge).max(0);
        // From Q2.30 and Q15.17 to Q.15.
        let share = ((unsigned_product(within as u32, self.slope) >> 32) as u32).min(1 << 15) as i32;
        upper(near, share * share) << 2
    }
}

/// A positive number: the first times 2 to the power of minus the second.
type Scaled = (u32, i32);

/// `square` with `bits` fraction bits.
fn scaled(square: u64, bits: i32) -> Scaled {
    let zeros = square.max(1).leading_zeros();
    (((square << (zeros & 63)) >> 32) as u32, bits + zeros as i32 - 32)
}

fn times((a, bits): Scaled, (b, more): Scaled) -> Scaled {
    ((unsigned_product(a, b) >> 32) as u32, bits + more - 32)
}

/// 1/R² for a `range` in units of an object of this `scale`. If the way to the light has been shortened, from the root of `shortened` (Q.38) to
/// [`FARTHEST_UNITS`], R is shortened alike.
fn inverse_square(range: u16, scale: u32, shortened: Option<u64>) -> Scaled {
    let square = u64::from(range) * u64::from(range);
    if square == 0 {
        return (0, 0);
    }
    // With r and s as the bits of range and scale, R is r/s 2^5, because r has 11 fraction bits and s has 16.
    let (square, bits) = scaled(square, -10);
    // 2^62 over a number of 32 bits.
    let inverse = times((recip(square), 62 - bits), scaled(u64::from(scale) * u64::from(scale), 0));
    let Some(length) = shortened else { return inverse };
    let (to, bits) = scaled(u64::from(FARTHEST_UNITS * FARTHEST_UNITS), 0);
    times(times(inverse, (recip(to), 62 - bits)), scaled(length, 2 * (POSITION as i32 - 6)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        format::{Angle, Length, Scale},
        scene::Pose,
        stream::record::Camera,
    };
    use zerocopy::FromZeros as _;

    fn real(v: [i32; 3], bits: u32) -> [f64; 3] {
        v.map(|c| f64::from(c) / f64::from(bits).exp2())
    }

    fn product(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|k| a[k] * b[k]).sum()
    }

    /// Lights of all ranges and cones at objects of all scales, against floating point. Lights that are so far away that they are moved are right at the
    /// centre of the object.
    #[test]
    fn strengths() {
        let camera = Camera { rotation: [[1 << 30, 0, 0], [0, 1 << 30, 0], [0, 0, -1 << 30]], ..Camera::new_zeroed() };
        let world = ModelView::new(&camera, 0);
        let (mut worst, mut in_cone, mut lit, mut moved) = (0f64, 0f64, 0, 0);
        for seed in 1..100_000u32 {
            let random = |k: u32| seed.wrapping_mul(k).wrapping_mul(seed ^ 77).wrapping_mul(2_654_435_761) >> 3;
            let signed = |k: u32, bits: u32| (random(k) >> (29 - bits)) as i32 - (1 << (bits - 1));
            let scale = [1 << 12, 1 << 16, 77_777, 8 << 16][random(3) as usize % 4];
            let range = 128 + random(5) as u16 % (1 << (8 + seed % 9).min(15));
            let vector = [signed(7, 19), signed(11, 19), signed(13, 19)];
            // Towards the object, more or less.
            let [x, y, z] = vector;
            let axis = normalise([signed(17, 15) - x, signed(19, 15) - y, signed(23, 15) - z]).map(|c| (c >> 16) as i16);
            // Cosines that differ by 2^-10 to 2.
            let cone = [16_384 - ((16u32 << (random(29) % 11)) + random(53) % 16).min(32_768) as i32, 16_384].map(|c| c as i16);
            let (range, axis, cone) = [(range, [0; 3], [0; 2]), (0, axis, cone), (range, axis, cone)][seed as usize % 3];
            let light = Light { range, axis, cone, ..Light::new(1, 0, vector.map(Length::from_bits), [crate::format::Gain::ONE; 3]) };
            let pose = Pose::about([3, -1, 2], Angle::from_bits(random(31) << 3)).unwrap();
            let view = world.of(&pose.scaled(Scale::from_bits(scale)).unwrap());
            let (shape, direction) = Shape::new(&light, &view, view.shortened(vector, false));
            let place = view.point_to_object(vector, false);
            // A point of the object, of a radius of 1; close to the light if it can be.
            let is_moved = view.shortened(vector, false).is_some();
            let vertex = if is_moved { [0; 3] } else { [signed(37, 26), signed(41, 26), signed(43, 26)] };
            let way = core::array::from_fn(|k| place[k] - vertex[k]);
            let strength = f64::from(shape.strength(direction, way)) / 65_536.0;
            let scale = f64::from(scale) / 65_536.0;
            let away = real(way, POSITION).map(|c| c * scale);
            let size = product(away, away).sqrt();
            let distance = if is_moved { product(real(vector, UNIT), real(vector, UNIT)).sqrt() } else { size };
            let range = f64::from(range) / 2048.0;
            let part = if range > 0.0 { (1.0 - (distance / range).powi(2)).max(0.0).powi(2) } else { 1.0 };
            let towards = real(direction, COSINE);
            let [edge, full] = cone.map(|c| f64::from(c) / 16_384.0);
            let within =
                if cone == [0; 2] { 1.0 } else { ((-product(towards, away) / size - edge) / (full - edge)).clamp(0.0, 1.0).powi(2) };
            moved += u32::from(is_moved && (0.01..0.99).contains(&strength));
            let error = (strength - part * within).abs();
            lit += u32::from((0.01..0.99).contains(&strength));
            if cone == [0; 2] { worst = worst.max(error) } else { in_cone = in_cone.max(error) }
        }
        assert!(lit > 10_000 && moved > 1_000, "{lit} {moved}");
        assert!(worst <= ERROR && in_cone <= ERROR, "{:.2} {:.2} of 2^-16", worst * 65_536.0, in_cone * 65_536.0);
    }
}
