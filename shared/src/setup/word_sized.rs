//! Set-up of word-sized triangles: sums of products stay in one word until they are multiplied by the inverse of the area.
//!
//! A triangle of up to 64 pixels has sides of few bits, and light levels have few bits too. The numerator of a first derivative is therefore an exact
//! integer of one word. The numerator of a second derivative is rounded once to a word. One product with the inverse of the area, or with its square,
//! gives the derivative. First derivatives are kept per 1/16 pixel: from corner 0 to the centre of its pixel there are whole steps of these, exact
//! modulo 2^32 however steep they are. Depth and a quadratic take eight long products, where other triangles take fifty.
//!
//! Cosines have more bits. Their differences, made as large as words allow, times sides of half a word are rounded to words as well.

use crate::{
    arch::{
        product::{product, rounded, shifted, upper_dot},
        quotient::inverse,
        zeros::leading_zeros,
    },
    format::SUBPIXEL,
    geometry::cull::fits_words,
    setup::steepness::Steepness,
};

/// Largest number of fraction bits that walked values have more than nodes.
pub(crate) const MOST_EXTRA: u32 = 16;
/// Bits of the range of nodes of a linear field.
pub(crate) const LINEAR: u32 = 20;
/// Bits of the range of nodes of a quadratic.
pub(crate) const QUADRATIC: u32 = 15;
/// Bits of the range of nodes of fields that are walked with [`LONG_EXTRA`].
pub(crate) const LONG: u32 = 26;
/// Smallest number of fraction bits that walked values of fields of [`LONG`] bits have more than nodes.
pub(crate) const LONG_EXTRA: u32 = 5;
/// Largest number of bits of a second derivative of such a field, by room for the move to the anchor.
const LONG_SECOND: u32 = 27;

/// Twice the area of a word-sized triangle, ready to divide by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WordSized {
    /// 1 / area = `inverse` 2^(`zeros` - 58).
    inverse: i32,
    /// Leading zeros of the area: 11 to 30.
    pub(crate) zeros: u32,
    /// Bits of the longest side: 1 to 10.
    pub(crate) bits: u32,
}

impl WordSized {
    /// The area of a triangle by its edges from corner 0; `None` unless it is word-sized.
    #[inline]
    pub(crate) fn new(edges: [[i32; 2]; 2]) -> Option<Self> {
        let [[x1, y1], [x2, y2]] = edges;
        let spread = |a: i32, b: i32| a.max(b).max(0).wrapping_sub(a.min(b).min(0)) as u32;
        fits_words(spread(x1, x2) | spread(y1, y2), area(edges)).then(|| Self::of(edges))
    }

    /// The area of a triangle that is known to be word-sized.
    #[inline]
    pub(crate) fn of(edges: [[i32; 2]; 2]) -> Self {
        // Negative numbers count one less than their size, so that -2^k has k bits.
        let size = |c: i32| (c ^ (c >> 31)) as u32;
        let [[x1, y1], [x2, y2]] = edges;
        let bits = 32 - leading_zeros(size(x1) | size(y1) | size(x2) | size(y2));
        let area = area(edges) as u32;
        let zeros = leading_zeros(area);
        // The area, which has at most 21 bits, shifted to 24.
        let area = area << (zeros.wrapping_sub(8) & 31);
        // 2^40 / area to 15 bits, and what is missing of its product with the area in one word: one Newton step.
        let high = inverse(area >> 8);
        let rest = high.wrapping_mul(area).wrapping_neg() as i32;
        let more = (rest >> 11).wrapping_mul(high as i32) >> 19;
        Self { inverse: ((high << 10) as i32).wrapping_add(more), zeros, bits }
    }

    /// `[c, dx, dy]` of the linear field through the corners' values, of at most [`LINEAR`] bits, at `offset` from corner 0
    /// (1/16 pixel), with up to [`MOST_EXTRA`] more fraction bits.
    #[inline]
    pub(crate) fn linear(&self, edges: [[i32; 2]; 2], offset: [i32; 2], [i0, i1, i2]: [i32; 3], extra: u32) -> [i32; 3] {
        let [dx, dy] = self.slopes(edges, [i1 - i0, i2 - i0], extra);
        // In 1/16 pixel, corner 0 and the centre of its pixel are whole steps apart, so the move is exact modulo 2^32.
        let c = (i0 << extra).wrapping_add(dx.wrapping_mul(offset[0])).wrapping_add(dy.wrapping_mul(offset[1]));
        [c, dx << SUBPIXEL, dy << SUBPIXEL]
    }

    /// `[c, dx, dy, dxx, dxy, dyy]` of the quadratic through six nodes, of at most [`QUADRATIC`] bits, at `offset` from corner 0
    /// (1/16 pixel), with `extra` more fraction bits, [`MOST_EXTRA`] or one less; `None` if a second derivative does not fit a word.
    #[inline(always)]
    pub(crate) fn quadratic(
        &self,
        edges: [[i32; 2]; 2],
        [ox, oy]: [i32; 2],
        [i0, i1, i2, i01, i12, i20]: [i32; 6],
        extra: u32,
    ) -> Option<[i32; 6]> {
        let [dx, dy] = self.slopes(edges, [4 * i01 - 3 * i0 - i1, 4 * i20 - 3 * i0 - i2], extra);
        // Half the matrix of second derivatives by s and t.
        let (ss, st, tt) = (2 * (i0 + i1 - 2 * i01), 2 * (i0 - i01 - i20 + i12), 2 * (i0 + i2 - 2 * i20));
        let [[x1, y1], [x2, y2]] = edges;
        // Sides take all of a word but its sign. Second differences take as much of one as leaves room for their products with two
        // sides, or for what then is a whole number.
        let second = (28 - QUADRATIC - self.bits).min(self.bits + 1);
        let (ss, st, tt) = (ss << second, st << second, tt << second);
        // Times the area: one factor of the chain rule, then the other, and the area once more.
        let (sx, tx) = (ss * y2 - st * y1, st * y2 - tt * y1);
        let (sy, ty) = (st * x1 - ss * x2, tt * x1 - st * x2);
        let [[x1, y1], [x2, y2]] = self.sides(edges);
        // 1 / area² = square 2^(2 zeros - 85).
        let square = (product(self.inverse, self.inverse) >> 31) as i32;
        let left = (2 * self.zeros + self.bits + extra - 44) - second;
        // Collects the bits that do not fit a word.
        let mut steep = 0;
        let mut derivative = |a: i32, b: i32, x: i32, y: i32| {
            let product = product(upper_dot([a, b], [x, y]), square);
            let upper = (product >> 32) as i32;
            steep |= (upper << (left & 31) >> (left & 31)) ^ upper;
            shifted(product, left)
        };
        let (dxx, dxy, dyy) = (derivative(sx, -tx, y2, y1), derivative(-sx, tx, x2, x1), derivative(-sy, ty, x2, x1));
        if steep != 0 {
            return None;
        }
        // Per (1/16 pixel)², for the way to the anchor.
        let fine = |c: i32| c >> (2 * SUBPIXEL);
        let (xx, xy, yy) = (fine(dxx), fine(dxy), fine(dyy));
        let (across, mixed, down) = (xx.wrapping_mul(ox), xy.wrapping_mul(oy).wrapping_mul(2), yy.wrapping_mul(oy));
        let first = dx.wrapping_add(across).wrapping_add(mixed);
        let c = (i0 << extra).wrapping_add(first.wrapping_mul(ox)).wrapping_add(dy.wrapping_add(down).wrapping_mul(oy));
        let dx = first.wrapping_add(across);
        let dy = dy.wrapping_add(down.wrapping_add(xy.wrapping_mul(ox)).wrapping_mul(2));
        Some([c, dx << SUBPIXEL, dy << SUBPIXEL, dxx, dxy.wrapping_mul(2), dyy])
    }

    /// [`Self::linear`] for nodes of at most [`LONG`] bits, walked with at least [`LONG_EXTRA`].
    #[inline(always)]
    pub(crate) fn long_linear(&self, edges: [[i32; 2]; 2], offset: [i32; 2], [i0, i1, i2]: [i32; 3], extra: u32) -> [i32; 3] {
        let [dx, dy] = self.long_slopes(edges, [i1 - i0, i2 - i0], extra);
        let c = (i0 << extra).wrapping_add(dx.wrapping_mul(offset[0])).wrapping_add(dy.wrapping_mul(offset[1]));
        [c, dx << SUBPIXEL, dy << SUBPIXEL]
    }

    /// [`Self::quadratic`] for nodes of at most [`LONG`] bits, walked with at least [`LONG_EXTRA`]; `None` if a second derivative has more
    /// than [`LONG_SECOND`] bits, or a highlight of this `steepness` would show what words round.
    #[inline(always)]
    pub(crate) fn long_quadratic(
        &self,
        edges: [[i32; 2]; 2],
        [ox, oy]: [i32; 2],
        [i0, i1, i2, i01, i12, i20]: [i32; 6],
        extra: u32,
        steepness: Steepness,
    ) -> Option<[i32; 6]> {
        // A quarter of the matrix of second derivatives by s and t, made as large as words can be added.
        let (ss, st, tt) = (i0 + i1 - 2 * i01, i0 - i01 - i20 + i12, i0 + i2 - 2 * i20);
        let most = 2 * (self.bits + self.zeros) + extra - 47;
        let room = room([ss, st, tt]);
        let up = room.min(most);
        let left = most + 1 - up;
        // Second differences are below 2^(30 - room), and 1 is 2^(LONG - 2).
        let is_exact = || {
            steepness.bends_little(left + 2 * self.bits + Steepness::LOG - 10 - extra)
                || self.is_exact(edges, room as i32 + LONG as i32 - 32, steepness)
        };
        if left > LONG_SECOND - 1 || !is_exact() {
            return None;
        }
        let (ss, st, tt) = (ss << up, st << up, tt << up);
        let [dx, dy] = self.long_slopes(edges, [4 * i01 - 3 * i0 - i1, 4 * i20 - 3 * i0 - i2], extra);
        // One factor of the chain rule, then the other, then the area twice.
        let [[x1, y1], [x2, y2]] = self.sides(edges);
        let (sx, tx) = (upper_dot([ss, -st], [y2, y1]), upper_dot([st, -tt], [y2, y1]));
        let (sy, ty) = (upper_dot([st, -ss], [x1, x2]), upper_dot([tt, -st], [x1, x2]));
        // 1 / area² = square 2^(2 zeros - 89).
        let square = (product(self.inverse, self.inverse) >> 27) as i32;
        let mut steep = 0;
        let mut derivative = |a: i32, b: i32, x: i32, y: i32| {
            let product = product(upper_dot([a, b], [x, y]), square);
            let (upper, room) = ((product >> 32) as i32, left + 32 - LONG_SECOND);
            steep |= (upper << (room & 31) >> (room & 31)) ^ upper;
            rounded(product, left)
        };
        let (dxx, dxy, dyy) = (derivative(sx, -tx, y2, y1), derivative(-sx, tx, x2, x1), derivative(-sy, ty, x2, x1));
        if steep != 0 {
            return None;
        }
        // To the anchor, less than a pixel away.
        let by = |c: i32, way: i32| c.wrapping_mul(way) >> SUBPIXEL;
        let (across, mixed, down) = (by(dxx, ox), by(dxy, oy), by(dyy, oy));
        let c = (i0 << extra)
            .wrapping_add(dx.wrapping_mul(ox))
            .wrapping_add(dy.wrapping_mul(oy))
            .wrapping_add(by(across + 2 * mixed, ox))
            .wrapping_add(by(down, oy));
        let dx = (dx << SUBPIXEL).wrapping_add(2 * (across + mixed));
        let dy = (dy << SUBPIXEL).wrapping_add(2 * (down + by(dxy, ox)));
        Some([c, dx, dy, dxx, dxy.wrapping_mul(2), dyy])
    }

    /// Whether words fit quadratics of this steepness whose second differences are below 2^-`small`.
    #[cold]
    #[inline(never)]
    fn is_exact(self, edges: [[i32; 2]; 2], small: i32, steepness: Steepness) -> bool {
        steepness.fits_words(self.bits) && steepness.bends(small, self.thinness(edges))
    }

    /// Length over height, rounded up.
    #[inline]
    pub(crate) fn thinness(&self, [[x1, y1], [x2, y2]]: [[i32; 2]; 2]) -> u32 {
        let size = |c: i32| c.unsigned_abs();
        let length = size(x1).max(size(y1)).max(size(x2)).max(size(y2));
        // By the upper 11 bits of the inverse.
        ((length * length).wrapping_mul((self.inverse >> 16) as u32) >> (41 - self.zeros) >> 1) + 1
    }

    /// [`Self::slopes`] for differences of at most [`LONG`] + 2 bits, with at least [`LONG_EXTRA`].
    #[inline]
    fn long_slopes(&self, edges: [[i32; 2]; 2], [a, b]: [i32; 2], extra: u32) -> [i32; 2] {
        // Shifted up as far as sums fit a word, since the products are rounded next.
        let most = self.bits + self.zeros + extra - 26;
        let up = room([a, b, 0]).min(most);
        let (a, b) = (a << up, b << up);
        let [[x1, y1], [x2, y2]] = self.sides(edges);
        let slope = |numerator: i32| rounded(product(numerator, self.inverse), most + 1 - up);
        [slope(upper_dot([a, -b], [y2, y1])), slope(upper_dot([b, -a], [x1, x2]))]
    }

    /// Edges shifted up to all bits of a word but the sign.
    #[inline]
    fn sides(&self, [[x1, y1], [x2, y2]]: [[i32; 2]; 2]) -> [[i32; 2]; 2] {
        let side = |c: i32| c << (31 - self.bits);
        [[side(x1), side(y1)], [side(x2), side(y2)]]
    }

    /// Derivatives along x and y of `a s + b t` per 1/16 pixel, with `extra` more fraction bits.
    #[inline]
    fn slopes(&self, [[x1, y1], [x2, y2]]: [[i32; 2]; 2], [a, b]: [i32; 2], extra: u32) -> [i32; 2] {
        // The inverse with as many bits as a shift by less than a word leaves room for.
        let inverse = self.inverse >> (MOST_EXTRA - extra);
        let slope = |numerator: i32| shifted(product(numerator, inverse), self.zeros - 10);
        [slope(a * y2 - b * y1), slope(b * x1 - a * x2)]
    }
}

/// A shift by which all three values stay within 2^30: the largest one, or nearly.
#[inline]
fn room([a, b, c]: [i32; 3]) -> u32 {
    let size = |c: i32| (c ^ (c >> 31)) as u32;
    leading_zeros((size(a) | size(b) | size(c)) >> 8) - 10
}

/// Twice the area between two edges, modulo 2^32.
#[inline]
fn area([[x1, y1], [x2, y2]]: [[i32; 2]; 2]) -> i32 {
    x1.wrapping_mul(y2).wrapping_sub(x2.wrapping_mul(y1))
}
