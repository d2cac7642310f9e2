//! Upper bounds for the error of cheaper methods against Phong shading on one triangle, under constant lights.
//!
//! The light on a triangle depends on the interpolated normal N, which is linear and shorter than the corners' unit normals: by the diffuse cosine
//! N·L/|N| and the highlight (N·H/|N|)^n. The stream has the smallest length ρ of N on each triangle.
//!
//! - What interpolation is off from highlights stands in a table, [`crate::method::auto::highlight_error`].
//! - Diffuse light that is interpolated linearly is N·L instead of N·L/|N|: too dark by N·L (1/|N| - 1), at most by N·L (1/ρ - 1).
//! - The quadratic through six points is off from diffuse light by its third derivative along lines, at most 3.01, times (e/ρ)³
//!   `REMAINDER`. Here e is the longest distance between two corners' normals; with h = e²/4, the haversine, (e/ρ)² is at most
//!   12 h / (3 - 4 h). Source: remainders of interpolation (Kowalewski 1932); the derivative is computed on a grid.
//! - Diffuse light is clamped where N·L changes its sign, from p to -q. Linear interpolation of a clamped line is too bright by at most
//!   p q/(p + q), no more than either of them or a fourth of their sum; the quadratic is off by at most 4/3 of the least of them over ρ, and
//!   by `KINK` of their sum over ρ.
//! - Normals of corners are unit vectors to 2^-15, and so are not those of Phong shading: highlights of large exponents tell.
//! - Light above 255 has no bound.

use crate::{
    arch::product::unsigned_product,
    format::{COSINE, FULL, HAVERSINE, NORMAL_LENGTH},
    lighting::{albedo::SHARE, reflectance::LitMaterial},
    method::{
        CornerCosines,
        auto::highlight_error::{self, TablePlace, USUAL_EXPONENT},
        largest,
    },
    stream::record::Triangle,
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Largest remainder of the quadratic through six points, over the third derivative and (e/ρ)³: 0.0253.
const REMAINDER: f64 = 0.0254;

/// (e/ρ)³ is at most 8 h^1.5 (1 + this h): by a chord to h = 1/3, where (e/ρ)² = 12 h/(3 - 4 h) is 2.4.
const CHORD: f64 = 4.25;

/// Largest error of the quadratic against clamped diffuse light, over ρ and the range of N·L: 0.0952 on a grid.
const KINK: f64 = 0.1;

/// Largest amount by which interpolated normals may be shorter than 1 if bounds are finite, Q1.15: 1 - ρ of three normals that are 60 degrees from
/// one another. Chords of convex functions below reach to here.
const SHORTEST: u32 = 6013;
/// The haversine of the longest edge of such a triangle is at most (1 - ρ²) = 1/3, Q0.16.
const WIDEST: u32 = (1 << HAVERSINE) / 3 + 1;

/// Most lights of a frame for which there are bounds.
pub const MAX_LIGHTS: usize = 2;

/// Levels of one light on a material, in the channel where it is strongest.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
struct LightBounds {
    /// The diffuse level at cosine 1, Q9.7.
    diffuse: u32,
    /// The level of a whole highlight, Q9.7.
    specular: u32,
    /// The level of a whole highlight times [`USUAL_EXPONENT`] over the exponent, rounded up.
    narrowed: u32,
}

/// Values that bounds on all triangles of one material need.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct ErrorBounds {
    lights: [LightBounds; MAX_LIGHTS],
    /// The level of ambient light, Q9.7.
    ambient: u32,
    /// N·H, Q1.15, below which no highlight can be seen.
    threshold: u32,
    exponent: u16,
    /// The part of the table of errors for this exponent.
    part: u8,
    /// Not 0 if all lights together may exceed 255.
    may_saturate: u8,
}

/// Fraction bits of cosines that bounds are computed from.
const BOUND: u32 = 15;

/// A number in Q16, rounded up.
pub(super) const fn share(x: f64) -> u32 {
    (x * 65_536.0) as u32 + 1
}

/// `x` times a number in Q16, rounded up.
#[inline]
pub(super) fn times(x: u32, share: u32) -> u32 {
    (unsigned_product(x, share) >> 16) as u32 + 1
}

/// `x` times a number in Q0.32, rounded up.
#[inline]
fn fraction(x: u32, share: u32) -> u32 {
    (unsigned_product(x, share) >> 32) as u32 + 1
}

impl ErrorBounds {
    /// Error bounds for a material of this `exponent` under `lights` lights.
    pub fn new(reflectance: LitMaterial<'_>, exponent: u16, lights: usize) -> Self {
        let light = |light| {
            let [diffuse, specular] = if light < lights { reflectance.largest_gains(light) } else { [0; 2] };
            let narrowed = specular * u32::from(USUAL_EXPONENT) / u32::from(exponent.max(1)) + 1;
            LightBounds { diffuse, specular, narrowed }
        };
        let lights = [light(0), light(1)];
        let [r, g, b] = reflectance.ambient;
        let ambient = r.max(g).max(b) as u32;
        let sum = lights.iter().fold(ambient, |sum, light| sum + light.diffuse + light.specular);
        Self {
            lights,
            ambient,
            threshold: reflectance.highlight_threshold.max(0) as u32 >> (COSINE - BOUND),
            exponent,
            part: highlight_error::part(exponent),
            may_saturate: u8::from(sum > FULL as u32),
        }
    }
}

/// How far the normals of a triangle are apart.
#[derive(Clone, Copy)]
pub(crate) struct Curvature {
    /// Largest amount by which normals between the corners are shorter than 1: 1 - ρ, Q1.15, rounded up.
    short: u32,
    /// 1/ρ - 1, Q1.15, rounded up.
    longer: u32,
}

impl Curvature {
    /// The curvature of a triangle; `None` if it is too large for any bound.
    #[inline]
    pub(crate) fn of(triangle: &Triangle) -> Option<Self> {
        let short = (1u32 << NORMAL_LENGTH).wrapping_sub(triangle.min_normal_length.into());
        // 1/ρ - 1 = s + s²/(1 - s) for s = 1 - ρ, and 1/(1 - s) is at most 5/4 here.
        let longer = short.wrapping_add(short.wrapping_mul(short).wrapping_mul(5) >> (NORMAL_LENGTH + 2)).wrapping_add(1);
        (short <= SHORTEST).then_some(Self { short, longer })
    }

    /// The longest distance between two corners' normals over ρ, Q0.16, rounded up.
    #[inline]
    pub(super) fn turn(self, triangle: &Triangle) -> u32 {
        let [ab, bc, ca] = triangle.haversine;
        let distance = 2 * rooted((u32::from(ab.max(bc).max(ca)) + 1).min(WIDEST));
        distance + ((distance * self.longer) >> BOUND) + 1
    }

    /// The remainder of the quadratic through six points over the third derivative of what is interpolated, Q0.32.
    #[inline]
    fn remainder(triangle: &Triangle) -> u32 {
        let [ab, bc, ca] = triangle.haversine;
        // Haversines are rounded to the nearest.
        let h = (u32::from(ab.max(bc).max(ca)) + 1).min(WIDEST);
        // 8 h^1.5 (1 + `CHORD` h) times the remainder, by a chord, Q0.32; h^1.5 is in Q0.32 as well.
        let shape = share(8.0 * REMAINDER) + ((h * share(8.0 * REMAINDER * CHORD)) >> 16) + 1;
        times(h * rooted(h), shape)
    }

    /// An upper bound of a cosine whose numerator is linear and largest at a corner with this value, which is not negative; Q1.15.
    #[inline]
    fn cosine(self, corner: u32) -> u32 {
        // Normals are unit vectors to 2^-15.
        corner + ((corner * self.longer) >> BOUND) + 2
    }
}

/// A cosine (Q2.30) that is not negative, or 0, as bounds are computed from it, Q1.15, rounded up.
#[inline]
fn above_zero(cosine: i32) -> u32 {
    (cosine.max(-1) + (1 << (COSINE - BOUND))) as u32 >> (COSINE - BOUND)
}

/// Range of the error of linear interpolation, in 1/255 of full intensity, Q9.7.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval {
    /// Largest amount by which it is too dark.
    pub(crate) below: u32,
    /// Largest amount by which it is too bright.
    pub(crate) above: u32,
}

impl Interval {
    /// How far light may be from the middle of the interval.
    #[inline]
    pub(crate) fn half(self) -> u32 {
        ((self.below + self.above) >> 1) + 1
    }

    /// The middle of the interval.
    #[inline]
    pub(crate) fn middle(self) -> i32 {
        (self.below as i32 - self.above as i32) >> 1
    }

    /// Amount by which levels have to be raised to keep to the budget; 0 if they do. The budget is at least [`Self::half`].
    #[inline]
    pub(crate) fn raise(self, budget: u32) -> i32 {
        let beyond = |error: u32| (error as i32 - budget as i32).max(0);
        beyond(self.below) - beyond(self.above)
    }

    /// The interval with this much more on both sides.
    #[inline]
    pub(crate) fn widened(self, by: u32) -> Self {
        Self { below: self.below + by, above: self.above + by }
    }

    /// Linear interpolation of diffuse light that is `s` before it is divided by |N|, where s is linear and at the corners between these levels, Q9.7, at
    /// most four times 255: the error is s (1/|N| - 1).
    #[inline]
    pub(crate) fn of_sum(curvature: Curvature, [least, most]: [i32; 2]) -> Self {
        let off = |level: i32| ((level.max(0) as u32 * curvature.longer) >> BOUND) + 1;
        Self { below: off(most) + 2, above: off(least.wrapping_neg()) + 2 }
    }

    /// The interval with as much below as above.
    #[inline]
    pub(crate) fn centred(self) -> Self {
        let most = self.below.max(self.above);
        Self { below: most, above: most }
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self { below: self.below + other.below, above: self.above + other.above }
    }
}

impl LightBounds {
    /// Error of the quadratic through diffuse light that is not clamped; see [`Curvature::remainder`].
    #[inline]
    fn remainder(&self, of_triangle: u32) -> u32 {
        fraction(times(self.diffuse, share(3.01)), of_triangle)
    }

    /// Linear interpolation of diffuse light: bounds, and the brightest level at a corner.
    #[inline]
    fn diffuse(&self, curvature: Curvature, towards: &[i32; 3]) -> (Interval, u32) {
        let mut interval = Interval { below: 0, above: 0 };
        let most = largest(towards);
        if most <= 0 {
            return (interval, 0);
        }
        let most = above_zero(most);
        let level = ((self.diffuse * most) >> BOUND) + 1;
        interval.below = ((level * curvature.longer) >> BOUND) + 1;
        if let Some([light_side, dark_side]) = terminator(curvature, towards, most) {
            let gap = light_side.min(dark_side).min((light_side + dark_side + 3) >> 2);
            interval.above = ((self.diffuse * gap) >> BOUND) + 1;
        }
        (interval, level)
    }
}

/// How far N·L reaches above zero (`most`, Q1.15) and below it on a triangle, Q1.15, rounded up; `None` unless it does both.
#[inline]
fn terminator(curvature: Curvature, &[a, b, c]: &[i32; 3], most: u32) -> Option<[u32; 2]> {
    let least = a.min(b).min(c);
    (least < 0).then(|| [curvature.cosine(most), above_zero(0i32.wrapping_sub(least))])
}

/// The brightest light for which there are bounds on a surface with colours at its corners, Q9.7: 512 of 255.
pub(crate) const MOST_LIGHT: u32 = 1 << SHARE;

/// A bound of the difference between the product of two values that are linear over the triangle and what is interpolated linearly between the products
/// at the corners: a quarter of the product of their ranges. The colour of the surface, Q0.16, and the level of light, Q9.7, differ by these ranges
/// between the corners. Domain: a level of at most [`MOST_LIGHT`].
///
/// Proof: at a point with the weights w of the corners the difference is the covariance of the two values at the corners, where these have the
/// probabilities w. It is at most the root of the product of their variances (Cauchy and Schwarz), and a variance at most a quarter of the squared
/// range (Popoviciu).
#[inline]
pub(crate) fn of_product(colour: u32, level: u32) -> u32 {
    ((colour * level) >> (SHARE + 2)) + 1
}

/// Bounds of linear interpolation between the corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinearBound {
    /// Range of the error.
    pub(crate) interval: Interval,
    /// The brightest level, in 1/255 of full intensity, Q9.7.
    pub(crate) brightest: u32,
    /// Whether a highlight can be seen.
    pub(crate) has_highlight: bool,
}

impl ErrorBounds {
    /// The place in the table of errors of the highlight of a light with these N·H at the corners; `None` where it cannot be seen.
    #[inline]
    fn highlight(&self, curvature: Curvature, half: &[i32; 3]) -> Option<TablePlace> {
        let cosine = curvature.cosine(above_zero(largest(half)));
        (cosine >= self.threshold).then(|| TablePlace::new(self.part, curvature.short, cosine, self.exponent))
    }

    /// Bounds of linear interpolation between the corners under `N` lights; `None` if it exceeds the budget wherever in its interval light is.
    ///
    /// Diffuse light is judged first, because that is soon done.
    #[inline(always)]
    pub(crate) fn linear<const N: usize>(&self, budget: u32, curvature: Curvature, cosines: [CornerCosines; N]) -> Option<LinearBound> {
        let rounding = Interval { below: 2, above: 2 };
        let mut bounds = LinearBound { interval: rounding, brightest: self.ambient, has_highlight: false };
        // Written out: a loop would keep all of it in memory.
        self.add_diffuse(0, curvature, &cosines, &mut bounds);
        self.add_diffuse(1, curvature, &cosines, &mut bounds);
        if bounds.interval.half() > budget {
            return None;
        }
        self.add_highlight(0, curvature, &cosines, &mut bounds);
        self.add_highlight(1, curvature, &cosines, &mut bounds);
        (bounds.interval.half() <= budget).then_some(bounds)
    }

    #[inline]
    fn add_diffuse(&self, light: usize, curvature: Curvature, cosines: &[CornerCosines], bounds: &mut LinearBound) {
        if let (Some(light), Some([towards, _])) = (self.lights.get(light), cosines.get(light)) {
            let (interval, level) = light.diffuse(curvature, towards);
            bounds.interval = bounds.interval.plus(interval);
            bounds.brightest += level;
        }
    }

    #[inline]
    fn add_highlight(&self, light: usize, curvature: Curvature, cosines: &[CornerCosines], bounds: &mut LinearBound) {
        if let (Some(light), Some([_, half])) = (self.lights.get(light), cosines.get(light)) {
            self.add_linear_highlight(curvature, half, light.specular, bounds);
        }
    }

    /// Adds a highlight of this level, Q9.7, with these N·H at the corners, where it can be seen.
    #[inline]
    pub(crate) fn add_linear_highlight(&self, curvature: Curvature, half: &[i32; 3], specular: u32, bounds: &mut LinearBound) {
        if let Some(place) = self.highlight(curvature, half) {
            let [below, above] = place.linear(specular);
            let corners = place.rounding(self.exponent, specular);
            bounds.interval = bounds.interval.plus(Interval { below: below + corners, above: above + corners });
            bounds.brightest += place.brightest(specular);
            bounds.has_highlight = true;
        }
    }

    /// A bound of what the quadratic through six nodes is farther off where the colour of the surface differs by `range`, Q0.16, between corners: a
    /// third of the range times the largest difference m of diffuse light from its linear interpolation at the middles of the edges.
    ///
    /// Proof: let b be the quadratic of light less its linear interpolation. It is the sum of 4 m u v over the edges, where u and v are the weights of
    /// their ends. A quadratic is exact for a linear colour times linear light. For the colour c times b, it has at each edge the mean of the colours
    /// at its ends in place of c. So it is off by at most 4 m times the sum of u v |c - mean|. That is convex in each colour at a corner, so it is
    /// largest where one corner has a colour that differs from both others by the range. With the weight t of this corner, it is at most
    /// 4 t (1 - t) |t - 1/2| + t (1 - t)², whose largest value is 0.329.
    #[inline(never)]
    pub(crate) fn of_cubic(&self, range: u32, curvature: Curvature, cosines: &[CornerCosines]) -> u32 {
        let mut most = 2;
        for (light, [towards, _]) in self.lights.iter().zip(cosines) {
            let (Interval { below, above }, _) = light.diffuse(curvature, towards);
            most += below.max(above);
        }
        ((range * most.min(1 << SHARE)) >> SHARE) / 3 + 1
    }

    /// A bound of the quadratic through corners and midpoints of edges, in 1/255 of full intensity, Q9.7.
    #[inline(never)]
    pub(crate) fn quadratic(&self, triangle: &Triangle, curvature: Curvature, cosines: &[CornerCosines]) -> u32 {
        let remainder = Curvature::remainder(triangle);
        let mut bound = 0u32;
        for (light, [towards, half]) in self.lights.iter().zip(cosines) {
            let most = largest(towards);
            if most > 0 {
                bound += light.remainder(remainder);
                let most = above_zero(most);
                if let Some([light_side, dark_side]) = terminator(curvature, towards, most) {
                    // Over ρ, which is at least 0.81.
                    let gap =
                        times(light_side.min(dark_side), share(4.0 / 3.0 / 0.81)).min(times(light_side + dark_side, share(KINK / 0.81)));
                    bound += ((light.diffuse * gap) >> 15) + 1;
                }
            }
            if let Some(place) = self.highlight(curvature, half) {
                bound += place.rounding(self.exponent, light.specular) + place.error_of_quadratic(light.specular);
            }
        }
        bound
    }

    /// A bound of the quadratics through cosines at corners and midpoints of edges, whose highlights are looked up at each pixel, in 1/255 of
    /// full intensity, Q9.7. What is clamped at the pixel is no farther off than what is not.
    #[inline(never)]
    pub(crate) fn cosines(&self, triangle: &Triangle, curvature: Curvature, cosines: &[CornerCosines]) -> u32 {
        let remainder = Curvature::remainder(triangle);
        self.lights.iter().zip(cosines).fold(0u32, |bound, (light, [_, half])| {
            let highlight = self
                .highlight(curvature, half)
                .map_or(0, |place| place.rounding(self.exponent, light.specular) + place.error_of_cosines(light.specular, light.narrowed));
            bound.saturating_add(light.remainder(remainder) + highlight)
        })
    }

    /// Whether light may exceed 255 somewhere on the triangle: what is clamped at nodes is not clamped between them.
    #[inline(never)]
    pub(crate) fn saturates(&self, curvature: Curvature, cosines: &[CornerCosines], reflectance: LitMaterial<'_>) -> bool {
        let mut sum = self.ambient as i32;
        for (light, [towards, half]) in self.lights.iter().zip(cosines) {
            let [towards, half] = [towards, half].map(|cosines| curvature.cosine(above_zero(largest(cosines))).min(1 << BOUND));
            sum += (((light.diffuse * towards) >> BOUND) + 1) as i32;
            if half >= self.threshold {
                let entry = reflectance.highlight_at((half as i32) << (COSINE - BOUND));
                let level = if reflectance.holds_levels() { entry } else { (light.specular * entry) >> 16 };
                // The table of highlights is right to 2^-7 of the brightest.
                sum += (level + (light.specular >> 7) + 2) as i32;
            }
        }
        sum > FULL
    }

    /// The diffuse level of a light for a difference of cosines, Q2.30; the level is Q9.7, rounded up.
    #[inline]
    pub(crate) fn diffuse_level(&self, light: usize, cosine: i32) -> u32 {
        let diffuse = self.lights.get(light).map_or(0, |light| light.diffuse);
        ((diffuse * (cosine as u32 >> (COSINE - BOUND))) >> BOUND) + 2
    }

    /// The level of the first light's highlight for a difference of powers, unsigned Q0.16; the level is Q9.7, rounded up.
    #[inline]
    pub(crate) fn highlight_level(&self, highlight: i32) -> u32 {
        let [LightBounds { specular, .. }, _] = &self.lights;
        ((specular * highlight as u32) >> 16) + 1
    }

    /// The brightest level of the first light at this cosine and highlight, Q9.7, rounded up.
    #[inline]
    pub(crate) fn brightest(&self, cosine: i32, highlight: i32) -> i32 {
        (self.ambient + self.diffuse_level(0, cosine) + self.highlight_level(highlight)) as i32
    }

    /// Whether light may exceed 255 anywhere.
    #[inline]
    pub(crate) fn may_saturate(&self) -> bool {
        self.may_saturate != 0
    }
}

/// The root of `x`, Q0.16, rounded up. Domain: 1 to 2^17. Error: 6 %.
#[inline]
pub(super) fn rooted(x: u32) -> u32 {
    // x moved up by an even number of bits, to 2^30 at least: its root is below the entry.
    let zeros = x.leading_zeros() & 30;
    let root = ROOTS[(((x << zeros) >> 27) as usize).saturating_sub(8) % ROOTS.len()];
    // The root of 2^16 x is that of x times 2^8.
    ((u32::from(root) << 8) >> (zeros >> 1)) + 1
}

/// Roots of (k + 9) 2^27, rounded down from just below.
static ROOTS: [u16; 24] = {
    let mut roots = [0; 24];
    let mut k = 0;
    while k < 24 {
        roots[k] = (((k as u64 + 9) << 27) - 1).isqrt() as u16;
        k += 1;
    }
    roots
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        format::{LEVEL, UNIT},
        lighting::{lights::vertex_cosine, reflectance::Reflectance},
        math::{highlight_lut::Highlight, vector::wide},
        method::auto::highlight_error::EXACT,
        pixel::Channels,
        stream::record::{Light, Material},
    };
    use embedded_graphics_core::pixelcolor::Gray8;
    use zerocopy::FromZeros;

    /// Barycentric coordinates of the points where errors are taken are multiples of one over this.
    const GRID: i32 = 12;

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    fn unit(v: [f64; 3]) -> [f64; 3] {
        let length = dot(v, v).sqrt();
        v.map(|c| c / length)
    }

    /// Random numbers from -1 to 1.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        fn direction(&mut self) -> [f64; 3] {
            loop {
                let v = [self.next(), self.next(), self.next()];
                if (0.01..1.0).contains(&dot(v, v)) {
                    return unit(v);
                }
            }
        }
    }

    /// By how much linear interpolation of what lights reflect is too dark and too bright, and the largest errors of quadratic interpolation of
    /// it and of the cosines that they reflect it by; each `[L, H]` with its levels at cosine 1 and of a whole highlight.
    fn errors(normals: [[f64; 3]; 3], lights: &[([[f64; 3]; 2], [f64; 2])], exponent: u16) -> [f64; 4] {
        let of = |cosine: &dyn Fn([f64; 3]) -> f64| -> f64 {
            let light = |&([light, half], [diffuse, specular]): &([[f64; 3]; 2], [f64; 2])| {
                diffuse * cosine(light).max(0.0) + specular * cosine(half).clamp(0.0, 1.0).powi(exponent.into())
            };
            lights.iter().map(light).sum()
        };
        let lit = |normal: [f64; 3]| of(&|direction| dot(normal, direction));
        let between = |[u, v, w]: [f64; 3]| unit([0, 1, 2].map(|k| u * normals[0][k] + v * normals[1][k] + w * normals[2][k]));
        let middles = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]].map(between);
        let through = |b: [f64; 3], at: &dyn Fn([f64; 3]) -> f64| -> f64 {
            let corners: f64 = (0..3).map(|k| b[k] * (2.0 * b[k] - 1.0) * at(normals[k])).sum();
            corners + 4.0 * (0..3).map(|k| b[k] * b[(k + 1) % 3] * at(middles[k])).sum::<f64>()
        };
        let mut errors = [0f64; 4];
        for (i, j) in (0..=GRID).flat_map(|i| (0..=GRID - i).map(move |j| (i, j))) {
            let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(GRID));
            let b = [u, v, 1.0 - u - v];
            let linear: f64 = (0..3).map(|k| b[k] * lit(normals[k])).sum();
            let by_cosines = of(&|direction| through(b, &|normal| dot(normal, direction)));
            let exact = lit(between(b));
            let found = [exact - linear, linear - exact, (through(b, &lit) - exact).abs(), (by_cosines - exact).abs()];
            for (error, found) in errors.iter_mut().zip(found) {
                *error = error.max(found);
            }
        }
        errors
    }

    /// A triangle of these unit normals.
    fn triangle(normals: [[f64; 3]; 3]) -> Triangle {
        let haversine = |i: usize, j: usize| ((0.5 - 0.5 * dot(normals[i], normals[j])) * 65_536.0).round() as u16;
        let haversine = [haversine(0, 1), haversine(1, 2), haversine(2, 0)];
        let mut shortest = 1f64;
        for (i, j) in (0..=GRID).flat_map(|i| (0..=GRID - i).map(move |j| (i, j))) {
            let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(GRID));
            let normal = [0, 1, 2].map(|k| u * normals[0][k] + v * normals[1][k] + (1.0 - u - v) * normals[2][k]);
            shortest = shortest.min(dot(normal, normal).sqrt());
        }
        Triangle { haversine, min_normal_length: (shortest * 32_768.0) as u16, ..Triangle::new_zeroed() }
    }

    /// Materials and lights as bright as a stream may have them, lit from the front and across the terminator: no product overflows, and the
    /// answers are no.
    #[test]
    fn brightest_materials_overflow_nothing() {
        let mut reflectance = Reflectance::new_zeroed();
        let bright = [2 << UNIT; 3];
        let material = Material { ambient: bright, diffuse: bright, specular: bright, exponent: 1024 };
        let light = Light { colour: bright, ..Light::new_zeroed() };
        reflectance.fill(Channels::of::<Gray8>(), bright, &material, &[light; 2], (Highlight::Half, false), [false; 2]);
        let reflectance = LitMaterial::new(&reflectance, None);
        let bounds = ErrorBounds::new(reflectance, 1024, 2);
        let one = (1 << COSINE) + (1 << (COSINE - UNIT));
        for angle in [0.0f64, 0.01, 0.5, 0.615] {
            // As far from one another as from the axis.
            let around = |turn: f64| [angle.sin() * turn.cos(), angle.sin() * turn.sin(), angle.cos()];
            let triangle = triangle([0.0, 2.0, 4.0].map(|turn| around(turn * core::f64::consts::FRAC_PI_3)));
            let curvature = Curvature::of(&triangle).unwrap();
            for towards in [[one; 3], [one, one, -one], [one, -one, -one], [-one; 3]] {
                let cosines = [[towards, [one; 3]]; 2];
                let _ = (bounds.linear(1 << 20, curvature, cosines), bounds.quadratic(&triangle, curvature, &cosines));
                let _ = bounds.cosines(&triangle, curvature, &cosines);
                assert!(bounds.saturates(curvature, &cosines, reflectance));
                assert!(bounds.linear(1 << 20, curvature, cosines).is_none_or(|linear| linear.brightest as i32 >= FULL));
            }
        }
    }

    /// Random triangles under one light and under two, exponents 1 to 1024: no error exceeds its bound, and bounds are not far off.
    #[test]
    fn errors_stay_within_their_bounds() {
        let mut random = Random(1);
        let mut ratios = [const { heapless::Vec::<f64, 20_000>::new() }; 3];
        for case in 0..20_000 {
            let lights = 1 + case % 2;
            let exponent = (1024f64.powf(0.5 + 0.5 * random.next()).max(1.0) as u16).min(1024);
            let gain = |x: f64| [(x * f64::from(1 << UNIT)) as u16; 3];
            let shares = [0.2 + 0.2 * random.next(), 0.2 + 0.2 * random.next()];
            let material = Material { ambient: [0; 3], diffuse: gain(shares[0]), specular: gain(shares[1]), exponent };
            let mut reflectance = Reflectance::new_zeroed();
            let white = Light { colour: [1 << UNIT; 3], ..Light::new_zeroed() };
            reflectance.fill(
                Channels::of::<Gray8>(),
                [1 << UNIT; 3],
                &material,
                &[white; 2][..lights],
                (Highlight::Half, false),
                [false; 2],
            );
            let reflectance = LitMaterial::new(&reflectance, None);
            let bounds = ErrorBounds::new(reflectance, exponent, lights);
            let (facing, spread) = (random.direction(), 0.6f64.powf(1.0 + 4.0 * random.next().abs()));
            // As long as a mesh has them.
            let fixed = [(); 3].map(|()| {
                loop {
                    let aside = random.direction();
                    let exact = unit([0, 1, 2].map(|k| facing[k] + spread * aside[k])).map(|c| c * f64::from(1 << UNIT));
                    let rounded = exact.map(|c| c.round() as i16);
                    let real = rounded.map(f64::from);
                    if (dot(real, real).sqrt() - f64::from(1 << UNIT)).abs() <= 0.5 {
                        break rounded;
                    }
                }
            });
            let stored = fixed.map(|normal| normal.map(|c| f64::from(c) / f64::from(1 << UNIT)));
            let normals = stored.map(unit);
            let triangle = triangle(normals);
            let Some(curvature) = Curvature::of(&triangle) else { continue };
            let directions = [(); 2].map(|()| {
                let (light, aside) = (random.direction(), random.direction());
                // Near the normals, where highlights are.
                let near = 3.0 / f64::from(exponent).sqrt();
                [light, unit([0, 1, 2].map(|k| facing[k] + near * aside[k]))]
            });
            let q30 = |v: [f64; 3]| v.map(|c| (c * f64::from(1 << COSINE)) as i32);
            let cosines = directions.map(|pair| pair.map(|direction| fixed.map(|normal| vertex_cosine(wide(normal), q30(direction)))));
            let gains = [0, 1].map(|light| reflectance.largest_gains(light).map(|level| f64::from(level) / f64::from(1 << LEVEL)));
            let lit = [(directions[0], gains[0]), (directions[1], gains[1])];
            // Up to that exponent, what rounding of normals does is left to arithmetic.
            let exact = errors(if exponent > EXACT { stored } else { normals }, &lit[..lights], exponent);
            let linear = match lights {
                1 => bounds.linear(1 << 20, curvature, [cosines[0]]),
                _ => bounds.linear(1 << 20, curvature, cosines),
            };
            let Interval { below, above } = linear.unwrap().interval;
            let cosines = &cosines[..lights];
            let bound = [below, above, bounds.quadratic(&triangle, curvature, cosines), bounds.cosines(&triangle, curvature, cosines)];
            // Highlights below e^-8 are not drawn, and nodes are rounded.
            let dark: f64 = gains[..lights].iter().map(|[_, specular]| 4.0 / 3.0 * specular * f64::exp(-8.0)).sum();
            let bound = bound.map(|bound| f64::from(bound) / f64::from(1 << LEVEL) + dark + 0.01);
            for k in 0..4 {
                assert!(exact[k] <= bound[k], "case {case}, exponent {exponent}, error {k}: {} of {}, {normals:?}", exact[k], bound[k]);
            }
            // The larger error of linear interpolation, and the others.
            let largest = |[below, above, quadratic, cosines]: [f64; 4]| [below.max(above), quadratic, cosines];
            for (ratios, (bound, exact)) in ratios.iter_mut().zip(largest(bound).into_iter().zip(largest(exact))) {
                if (0.2..8.0).contains(&exact) {
                    ratios.push(bound / exact).unwrap();
                }
            }
        }
        // Of cosines, half of these triangles are wider than the table knows: there a bound is the whole highlight.
        for (ratios, most) in ratios.iter_mut().zip([4.0, 8.0, 20.0]) {
            ratios.sort_by(f64::total_cmp);
            assert!(ratios.len() > 2_000 && ratios[ratios.len() / 2] < most, "{} of {}", ratios[ratios.len() / 2], ratios.len());
        }
    }
}
