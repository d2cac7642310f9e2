//! Interpolation in perspective (Blinn 1992; Heckbert and Moreton 1991).
//!
//! A quantity that is linear over a triangle in space is not linear on the screen, but its quotient by the distance is, and so is the
//! inverse depth w. If b are the barycentric coordinates of a point on the screen, those of the point in the triangle that is seen there
//! are b w / Σ b w. A polynomial of degree d in these is a quotient of two polynomials of that degree on the screen. The node values of its
//! numerator shrink with w^d, and its precision with them. So the three linear numerators of the barycentric coordinates are walked
//! instead, whatever is interpolated, and the polynomial is evaluated at the pixel.
//!
//! Loops of a pixel format walk them in words (`Seen`), and everything else in long words.
//!
//! Cost: 3 additions a step; at each pixel that is seen a reciprocal, 2 products, and Lagrange's weights of the
//! nodes: none for planes, 6 products for quadratics, and then a product per node and channel.
//! Set-up: three planes instead of a fit of each channel.

use crate::{
    arch::product::product,
    interpolate::{
        Patch, Walker, each_channel,
        plane::{LinearWalker, Plane},
    },
    math::{recip::recip, vector::map},
    setup::gradients::Gradients,
};

/// Fraction bits of barycentric coordinates, Q2.30.
pub const SHARE: u32 = 30;
/// One, as a barycentric coordinate.
const ONE: i64 = 1 << SHARE;

/// A point of a triangle, by its barycentric coordinates, Q2.30, whose sum is one.
#[derive(Clone, Copy, Debug)]
pub struct Point(pub [i32; 3]);

/// A quantity that can be evaluated at any point of a triangle.
pub trait Surface: Copy {
    /// The value at a point.
    type Value;

    /// The value at `point`.
    fn at(&self, point: &Point) -> Self::Value;

    /// The quantity with `by` added to its values, see [`Patch::raised`].
    #[inline]
    fn raised(self, _by: &Self::Value) -> Self {
        self
    }
}

/// A field in perspective, standing on one row.
#[derive(Clone, Copy, Debug)]
pub struct PerspectivePatch<S> {
    /// Numerators of the barycentric coordinates of corners 1 and 2, and their common denominator.
    rows: [PerspectiveRow; 3],
    surface: S,
}

/// The linear function `c + dx x + dy y`, see [`Gradients::fine`].
#[derive(Clone, Copy, Debug)]
struct PerspectiveRow {
    /// Value at column 0 of the current row.
    c: i64,
    dx: i64,
    dy: i64,
}

impl<S: Surface> PerspectivePatch<S> {
    /// The field `surface` on a triangle whose corners have this inverse depth, all positive.
    ///
    /// Error of barycentric coordinates: at most 2^-28 k / r, with k the length over the height of the triangle, and r the least inverse
    /// depth over the largest.
    pub fn new(gradients: &Gradients, inv_depth: [i32; 3], surface: S) -> Self {
        Self { rows: rows(gradients, inv_depth), surface }
    }
}

/// The linear functions whose quotients are the barycentric coordinates, for corners with this inverse depth.
#[inline(never)]
fn rows(gradients: &Gradients, inv_depth: [i32; 3]) -> [PerspectiveRow; 3] {
    let row = |nodes| {
        let [c, dx, dy] = gradients.fine(nodes);
        PerspectiveRow { c: c.wrapping_sub(dx.wrapping_mul(gradients.column().into())), dx, dy }
    };
    map(numerators(inv_depth), row)
}

/// The numerators of the barycentric coordinates 1 and 2 and their denominator at the corners, which have this inverse depth. A common factor cancels
/// out, so the largest is scaled to just below 1, Q2.30.
fn numerators(inv_depth: [i32; 3]) -> [[i32; 3]; 3] {
    let zeros = inv_depth.iter().fold(1, |m, w| m | w).leading_zeros();
    let [a, b, c] = map(inv_depth, |w| w.wrapping_shl(zeros.saturating_sub(2)));
    [[0, b, 0], [0, 0, c], [a, b, c]]
}

impl<S> PerspectivePatch<S> {
    /// Replaces the field, on this triangle.
    pub fn with<T>(&self, surface: T) -> PerspectivePatch<T> {
        PerspectivePatch { rows: self.rows, surface }
    }
}

impl<S: Surface> Patch for PerspectivePatch<S> {
    type Walker = PerspectiveWalker<S>;

    fn jump(&mut self, rows: i32) {
        for row in &mut self.rows {
            row.c = row.c.wrapping_add(row.dy.wrapping_mul(rows.into()));
        }
    }

    fn step_row(&mut self) {
        for row in &mut self.rows {
            row.c = row.c.wrapping_add(row.dy);
        }
    }

    fn enter(&self, x: i32) -> PerspectiveWalker<S> {
        let walked = self.rows.map(|row| (row.c.wrapping_add(row.dx.wrapping_mul(x.into())), row.dx));
        PerspectiveWalker { value: walked.map(|(value, _)| value), step: walked.map(|(_, step)| step), surface: self.surface }
    }
}

/// Walks a [`PerspectivePatch`].
#[derive(Clone, Copy, Debug)]
pub struct PerspectiveWalker<S> {
    value: [i64; 3],
    step: [i64; 3],
    surface: S,
}

impl<S: Surface> Walker for PerspectiveWalker<S> {
    type Value = S::Value;

    #[inline]
    fn step(&mut self) {
        for (value, step) in self.value.iter_mut().zip(self.step) {
            *value = value.wrapping_sub(step);
        }
    }

    #[inline(always)]
    fn value(&self) -> S::Value {
        let [s, t, whole] = self.value;
        self.surface.at(&Point::new(s, t, whole))
    }
}

/// [`PerspectivePatch`] in words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<S> {
    numerators: Plane<3>,
    surface: S,
}

/// Pixels of width and height, times the largest inverse depth over the least, up to which words are exact enough.
const REACH: u64 = 1 << 17;

impl<S> Seen<S> {
    /// The field `surface` on a triangle of so many pixels in width and height together, whose corners have this inverse depth, all positive; `None` if it
    /// reaches too far for words.
    ///
    /// Error of barycentric coordinates: 2^-12 besides that of [`PerspectivePatch::new`]. This is 1/16 of a level where light goes from black to white, and
    /// 1/16 of a texel where a side of the triangle is 256 texels long. Each coefficient is off by 2^-31, times the pixels that it is walked, over the
    /// least denominator, which is at least the pixels times 2^-18. A number has two coefficients, and a quotient has two numbers.
    pub(crate) fn new(gradients: &Gradients, inv_depth: [i32; 3], pixels: u32, surface: S) -> Option<Self> {
        let [a, b, c] = map(inv_depth, |w| w.max(1) as u64);
        let reaches_far = a.max(b).max(c) * u64::from(pixels) > a.min(b).min(c) * REACH;
        (!reaches_far).then(|| Self { numerators: Plane::fit_any(gradients, &numerators(inv_depth)), surface })
    }

    /// Replaces the field, on this triangle.
    pub(crate) fn with<T>(&self, surface: T) -> Seen<T> {
        Seen { numerators: self.numerators, surface }
    }
}

impl<S: Surface> Patch for Seen<S> {
    type Walker = SeenWalker<S>;

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        self.numerators.jump(rows);
    }

    #[inline]
    fn step_row(&mut self) {
        self.numerators.step_row();
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> SeenWalker<S> {
        SeenWalker { numerators: self.numerators.enter(x), surface: self.surface }
    }

    #[inline]
    fn raised(self, by: &S::Value) -> Self {
        Self { surface: self.surface.raised(by), ..self }
    }
}

/// A linear quantity for [`Seen`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slant<const CH: usize> {
    /// The value at corner 0.
    pub(super) base: [i32; CH],
    /// What corners 1 and 2 have more, 2^[`COARSER`] times as coarse, and so far to the left that the upper word of a product with a coordinate is the
    /// share of it.
    pub(super) along: [[i32; 2]; CH],
}

/// Fraction bits that a share lacks, so that products fit.
pub(super) const COARSER: u32 = 3;

impl<const CH: usize> Surface for Slant<CH> {
    type Value = [u32; CH];

    #[inline(always)]
    fn at(&self, &Point([_, s, t]): &Point) -> [u32; CH] {
        let mut values = [0; CH];
        each_channel::<CH>(|channel| {
            let [to_b, to_c] = self.along[channel];
            let shares = ((product(to_b, s) + product(to_c, t)) >> 32) as i32;
            values[channel] = self.base[channel].wrapping_add(shares << COARSER) as u32;
        });
        values
    }

    #[inline]
    fn raised(mut self, by: &[u32; CH]) -> Self {
        each_channel::<CH>(|channel| self.base[channel] = self.base[channel].wrapping_add(by[channel] as i32));
        self
    }
}

/// Walks [`Seen`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenWalker<S> {
    numerators: LinearWalker<3>,
    surface: S,
}

impl<S: Surface> Walker for SeenWalker<S> {
    type Value = S::Value;

    #[inline]
    fn step(&mut self) {
        self.numerators.step();
    }

    #[inline(always)]
    fn value(&self) -> S::Value {
        let [s, t, whole] = self.numerators.value();
        self.surface.at(&Point::in_words(s, t, whole))
    }
}

impl Point {
    /// [`Self::new`] in words.
    #[inline(always)]
    fn in_words(s: u32, t: u32, whole: u32) -> Self {
        const WHOLE: i32 = ONE as i32;
        // The denominator is less than 1, but rounding may let it reach 1 beside the nearest corner. An even one becomes odd, because 0 has no
        // reciprocal: in a triangle of less than a pixel it may be that small.
        let whole = (whole as i32).clamp(0, WHOLE - 1) as u32 | 1;
        let zeros = whole.leading_zeros() & 31;
        let inverse = recip(whole << zeros) as i32;
        let coordinate = |part: u32, most: i32| ((product((part << (zeros - 2)) as i32, inverse) >> SHARE) as i32).clamp(0, most);
        let s = coordinate(s, WHOLE);
        let t = coordinate(t, WHOLE - s);
        Self([WHOLE - s - t, s, t])
    }

    /// The point with the barycentric coordinates `s / whole` and `t / whole` of corners 1 and 2, moved into the triangle. Beside a sliver one over
    /// the distance nears zero, and quotients would grow without limit.
    #[inline]
    fn new(s: i64, t: i64, whole: i64) -> Self {
        // All are shifted up until `whole` fills 32 bits, and the numerators 30; the reciprocal of `whole` is 2^62 over it.
        let zeros = whole.max(1).leading_zeros();
        let inverse = i64::from(recip((whole.wrapping_shl(zeros) as u64 >> 32) as u32));
        let coordinate = |part: i64, most: i64| (((part.wrapping_shl(zeros.saturating_sub(2)) >> 32) * inverse) >> SHARE).clamp(0, most);
        let s = coordinate(s, ONE);
        let t = coordinate(t, ONE - s);
        Self([ONE - s - t, s, t].map(|coordinate| coordinate as i32))
    }

    /// Lagrange's weights of corners and edge midpoints, b (2b - 1) and 4 b b'.
    #[inline]
    pub(crate) fn six(&self) -> [i32; 6] {
        let [a, b, c] = self.0.map(i64::from);
        let corner = |u: i64| ((u * (2 * u - ONE)) >> SHARE) as i32;
        let edge = |u: i64, v: i64| ((u * v) >> (SHARE - 2)) as i32;
        [corner(a), corner(b), corner(c), edge(a, b), edge(b, c), edge(c, a)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpolate::field::Nodes;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// In words, too, coordinates are quotients, up to the bits that the numerators have, and no place beside a triangle is far off.
        #[test]
        fn coordinates_in_words_are_quotients(
            whole in prop_oneof![1i64 << 12..ONE, 1i64 << 12..1 << 13, ONE - 50..ONE + 50],
            s in 0.0f64..=1.0,
            t in 0.0f64..=1.0,
            off in prop::array::uniform2(-3i64..=3),
        ) {
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            let part = |share: f64, off: i64| (share * whole as f64) as i64 + off;
            let [s, t] = [part(s, off[0]), part(t, off[1])];
            let Point([at_a, at_s, at_t]) = Point::in_words(s as u32, t as u32, whole as u32);
            prop_assert_eq!(at_a + at_s + at_t, ONE as i32);
            prop_assert!(at_a >= 0 && at_s >= 0 && at_t >= 0);
            let exact = |part: i64| (part as f64 / whole as f64).clamp(0.0, 1.0);
            let off = |at: i32, exact: f64| (f64::from(at) / ONE as f64 - exact).abs();
            // The denominator becomes odd, and so is off by a unit. From 1 on it counts as less than 1, and is off by up to 50 units, and a few of rounding.
            let units = if whole < ONE { 1.0 } else { 54.0 };
            let bound = units / whole as f64 + 2f64.powi(-26);
            prop_assert!(off(at_s, exact(s)) <= bound, "{} {}", at_s, exact(s));
            prop_assert!(off(at_t, exact(t).min(1.0 - exact(s))) <= 2.0 * bound, "{} {}", at_t, exact(t));
        }

        /// The levels of a slant are those of the plane, up to the bits that it leaves out.
        #[test]
        fn slants_are_planes(
            corners in prop::array::uniform3(0i32..=255 << 7),
            bias in -1_000_000i32..1_000_000,
            s in 0..=ONE as i32,
            t in 0..=ONE as i32,
        ) {
            let (s, t) = if s > ONE as i32 - t { (ONE as i32 - s, ONE as i32 - t) } else { (s, t) };
            let nodes = Nodes::<3, 1, 15>::new([corners], 16).biased([bias]);
            let point = Point([ONE as i32 - s - t, s, t]);
            let ([slant], [plane]) = (nodes.slant().at(&point), nodes.at(&point));
            let difference = plane.wrapping_sub(slant) as i32;
            prop_assert!((-1..=1 << COARSER).contains(&difference), "{}", difference);
            let [raised] = nodes.slant().raised(&[7]).at(&point);
            prop_assert_eq!(raised, slant.wrapping_add(7));
        }
    }
}
