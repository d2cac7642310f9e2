//! Gradients, which convert values at the nodes of a triangle to derivatives on the screen.
//!
//! With corner 0 as the origin, `s` and `t` are the barycentric coordinates of
//! corners 1 and 2. Their gradients are 30-bit mantissas with one
//! exponent, so tiny and huge triangles lose nothing. The derivatives of a
//! quadratic in (s, t) with respect to (x, y) follow by the chain rule, which is
//! well conditioned where the printed formulas divide by zero
//! (Szirmay-Kalos et al.; see their T3..T5).
//!
//! Word-sized triangles are set up faster: in words if nodes have few bits, and otherwise by mantissas of one word.

use crate::{
    arch::product::{product, rounded},
    format::{CENTRE, FINE, SPLITS, SUBPIXEL},
    math::{recip::recip, scale},
    setup::{sliver::Sliver, steepness::Steepness, word_sized, word_sized::WordSized},
};

/// Fraction bits of coefficients beyond the walked format, until they have been moved to the anchor.
pub const GUARD: i32 = 12;

/// Largest size of a triangle, in columns plus rows, whose anchor is the pixel at its first corner. The anchor of a larger triangle is the middle of
/// its visible part.
pub const NEAR: i32 = 256;

/// Length over height beyond which quadratic fields are fitted by exact fractions.
///
/// The error of the fast way grows with the square of this ratio. It is at most 2^-22 of the nodes' range at 1, and 2^-8 here.
pub const MAX_THINNESS: i64 = 128;
/// Length over height beyond which fields of more than `word_sized::LINEAR` bits, such as cosines, are fitted by exact fractions. Sharp highlights
/// need all of these bits.
///
/// The error of the fast way is 2^-25 of the nodes' range at 1, and 2^-17 here.
pub const MAX_FINE_THINNESS: i64 = 16;

/// Largest exponent of a word-sized triangle's gradients, so that no shift of a product goes to the right.
const LARGEST: u32 = 33;
/// Smallest exponent of a word-sized triangle's gradients, so that no shift to the left drops all bits.
const LEAST: i32 = 20;

/// The screen geometry of a triangle, ready to fit polynomials.
///
/// The *anchor* is the pixel to which coefficients are rounded; errors grow with
/// the distance from it. It is the pixel at corner 0 for small triangles, and the
/// middle of the visible part for large ones.
#[derive(Clone, Copy, Debug)]
pub struct Gradients {
    precision: Precision,
    /// Vector from corner 0 to the centre of its pixel, [`FINE`] fraction bits.
    pub offset: [i32; 2],
    /// The anchor.
    anchor: [i32; 2],
    /// Vectors from corner 0 to the corners 1 and 2, in 1/16 pixel, of a part of the triangle 2^[`Self::level`] times finer.
    pub edges: [[i32; 2]; 2],
    /// How steeply light depends on the fitted field.
    steepness: Steepness,
}

/// Either the reciprocal of the area, from which the gradients follow, or the gradients themselves.
#[derive(Clone, Copy, Debug)]
enum Precision {
    /// The reciprocal area of a word-sized triangle, see [`Gradients::if_word_sized`].
    WordSized(WordSized),
    /// Gradients of a part of a word-sized triangle.
    Part(Exact),
    Any(Exact),
}

/// The gradients of a triangle that is not word-sized, and its place.
#[derive(Clone, Copy, Debug)]
struct Exact {
    slopes: Slopes,
    /// Vector from the pixel at corner 0 to the anchor, in pixels.
    shift: [i32; 2],
    /// How often the triangle was split.
    level: u32,
}

/// Gradients of s and t per pixel, `[along x, along y]`: mantissas, each to be divided by 2^`exponent`.
#[derive(Clone, Copy, Debug)]
pub struct Slopes {
    /// Gradient of s.
    pub s: [i32; 2],
    /// Gradient of t.
    pub t: [i32; 2],
    /// The exponent of all mantissas.
    pub exponent: i32,
}

/// Columns and rows that are drawn, half open: `[left, top, right, bottom]`.
pub type Visible = [i32; 4];

impl Gradients {
    /// The gradients of the triangle with `corners` in 1/16 pixel, clockwise on a screen whose y runs down; `None` if it has no area or
    /// runs the other way.
    pub fn new(corners: [[i32; 2]; 3], visible: Visible) -> Option<Self> {
        Self::if_word_sized(corners).or_else(|| Self::any(corners, visible))
    }

    /// The gradients of a word-sized triangle; `None` for any other. A triangle is word-sized if it is at most 64 pixels wide and high, and
    /// far from [`MAX_THINNESS`].
    #[inline]
    pub fn if_word_sized(corners: [[i32; 2]; 3]) -> Option<Self> {
        let (_, edges) = edges(corners);
        Some(Self::from_area(corners, WordSized::new(edges)?, Steepness::NONE))
    }

    /// Gradients of a triangle on which nothing is fitted.
    pub(crate) const NONE: Self = Self {
        precision: Precision::Any(Exact { slopes: Slopes { s: [0; 2], t: [0; 2], exponent: 0 }, shift: [0; 2], level: 0 }),
        offset: [0; 2],
        anchor: [0; 2],
        edges: [[0; 2]; 2],
        steepness: Steepness::NONE,
    };

    /// The gradients of a triangle that is known to be word-sized.
    #[inline(always)]
    pub(crate) fn word_sized(corners: [[i32; 2]; 3], steepness: Steepness) -> Self {
        let (_, edges) = edges(corners);
        Self::from_area(corners, WordSized::of(edges), steepness)
    }

    #[inline]
    fn from_area(corners: [[i32; 2]; 3], area: WordSized, steepness: Steepness) -> Self {
        let ([x0, y0], edges) = edges(corners);
        let anchor = [x0 >> SUBPIXEL, (y0 + CENTRE - 1) >> SUBPIXEL];
        let offset = [((anchor[0] << SUBPIXEL) + CENTRE - x0) << SPLITS, ((anchor[1] << SUBPIXEL) + CENTRE - y0) << SPLITS];
        Self { precision: Precision::WordSized(area), offset, anchor, edges, steepness }
    }

    /// The gradients of any triangle; `None` if it has no area or runs the other way.
    #[cold]
    #[inline(never)]
    pub fn any(corners: [[i32; 2]; 3], visible: Visible) -> Option<Self> {
        let ([x0, y0], edges) = edges(corners);
        let [[x1, y1], [x2, y2]] = edges;
        let det = i64::from(x1) * i64::from(y2) - i64::from(x2) * i64::from(y1);
        if det <= 0 {
            return None;
        }
        // 1 / det = r 2^(zeros - 94), r = 2^62 / (det's upper 32 bits): relative error 2^-29.
        let zeros = det.leading_zeros() as i32;
        let r = i64::from(recip(((det << (zeros & 63)) >> 32) as u32 | 1 << 31));
        let size = x1.unsigned_abs() | y1.unsigned_abs() | x2.unsigned_abs() | y2.unsigned_abs();
        // r < 2^31, coordinates < 2^(32 - lz): mantissas below 2^30.
        let drop = 33 - size.leading_zeros() as i32;
        let mantissa = |c: i32| scale(i64::from(c) * r, drop) as i32;
        let pixel = [x0 >> SUBPIXEL, (y0 + CENTRE - 1) >> SUBPIXEL];
        let middle = [(visible[0] + visible[2]) >> 1, (visible[1] + visible[3]) >> 1];
        let shift = [middle[0].wrapping_sub(pixel[0]), middle[1].wrapping_sub(pixel[1])];
        let reach = size.min(1 << 20) as i32 >> (SUBPIXEL - 1);
        let shift = if reach <= NEAR { [0; 2] } else { shift };
        let slopes = Slopes {
            s: [mantissa(y2), mantissa(x2.wrapping_neg())],
            t: [mantissa(y1.wrapping_neg()), mantissa(x1)],
            // gradient per pixel = 16 c / det = mantissa 2^(drop + 4 + zeros - 94)
            exponent: 90 - zeros - drop,
        };
        Some(Self {
            precision: Precision::Any(Exact { slopes, shift, level: 0 }),
            offset: [(pixel[0] << SUBPIXEL) + CENTRE - x0, (pixel[1] << SUBPIXEL) + CENTRE - y0].map(|c| c << SPLITS),
            anchor: [pixel[0].wrapping_add(shift[0]), pixel[1].wrapping_add(shift[1])],
            edges,
            steepness: Steepness::NONE,
        })
    }

    /// The gradients of any triangle with this anchor; `None` if it has no area or runs the other way.
    pub fn anchored(corners: [[i32; 2]; 3], anchor: [i32; 2]) -> Option<Self> {
        let whole = Self::any(corners, [0; 4])?;
        let (from, shift) = (whole.anchor, whole.shift());
        let away = |k: usize| anchor[k].wrapping_sub(from[k]).wrapping_add(shift[k]);
        let exact = Exact { slopes: whole.slopes(), shift: [away(0), away(1)], level: 0 };
        Some(Self { precision: Precision::Any(exact), anchor, ..whole })
    }

    /// These gradients, for fields of this steepness: they are fitted as exactly as the highlights of a material need them.
    #[inline]
    pub fn steep(self, steepness: Steepness) -> Self {
        Self { steepness, ..self }
    }

    /// How steeply light follows what is fitted.
    pub fn steepness(&self) -> Steepness {
        self.steepness
    }

    /// The gradients of a part of the triangle: a copy that is 2^`level` times smaller, has corner 0 at `corner` ([`FINE`] fraction bits), and is
    /// turned by 180 degrees or not. They are exact: the triangle's gradients times ±2^`level`.
    ///
    /// A part that is not `near` its corner everywhere has the triangle's anchor.
    #[inline]
    pub fn part(&self, corner: [i32; 2], level: u32, turned: bool, near: bool) -> Self {
        let gradient = |g: [i32; 2]| if turned { g.map(i32::wrapping_neg) } else { g };
        let pixel = corner.map(|c| c >> FINE);
        let centre = |k: usize| (pixel[k] << FINE).wrapping_add(1 << (FINE - 1)).wrapping_sub(corner[k]);
        let anchor = if near { pixel } else { self.anchor };
        let Slopes { s, t, exponent } = self.slopes();
        let slopes = Slopes { s: gradient(s), t: gradient(t), exponent: exponent - level as i32 };
        let shift = [anchor[0].wrapping_sub(pixel[0]), anchor[1].wrapping_sub(pixel[1])];
        let (exact, fits_words) = (Exact { slopes, shift, level }, near && slopes.exponent >= LEAST && !self.is_any());
        Self {
            precision: if fits_words { Precision::Part(exact) } else { Precision::Any(exact) },
            offset: [centre(0), centre(1)],
            anchor,
            edges: self.edges.map(gradient),
            steepness: self.steepness,
        }
    }

    /// Converts the gradients to the form from which many parts are taken fast.
    pub fn parted(&self) -> Self {
        match self.precision {
            Precision::WordSized(area) => {
                let exact = Exact { slopes: Self::mantissas(self.edges, area), shift: [0; 2], level: 0 };
                Self { precision: Precision::Part(exact), ..*self }
            }
            _ => *self,
        }
    }

    /// Whether the triangle is not word-sized and longer than about `ratio` times its height. The measure is the square of its longest side by
    /// columns or rows from corner 0, over twice its area.
    #[inline]
    pub fn is_thinner_than(&self, ratio: i64) -> bool {
        matches!(self.precision, Precision::Any(_)) && is_longer(self.edges, ratio)
    }

    /// Whether the triangle is neither word-sized nor a part.
    #[inline]
    pub(crate) fn is_any(&self) -> bool {
        matches!(self.precision, Precision::Any(_))
    }

    /// Column of the anchor.
    #[inline]
    pub fn column(&self) -> i32 {
        self.anchor[0]
    }

    /// Row of the anchor.
    #[inline]
    pub fn row(&self) -> i32 {
        self.anchor[1]
    }

    /// Gradients of s and t.
    #[inline]
    pub fn slopes(&self) -> Slopes {
        match self.precision {
            Precision::WordSized(area) => Self::mantissas(self.edges, area),
            Precision::Part(exact) | Precision::Any(exact) => exact.slopes,
        }
    }

    /// Vector from the pixel at corner 0 to the anchor, in pixels.
    #[inline]
    pub fn shift(&self) -> [i32; 2] {
        match self.precision {
            Precision::WordSized(_) => [0; 2],
            Precision::Part(exact) | Precision::Any(exact) => exact.shift,
        }
    }

    /// How often the triangle was split.
    #[inline]
    pub fn level(&self) -> u32 {
        match self.precision {
            Precision::WordSized(_) => 0,
            Precision::Part(exact) | Precision::Any(exact) => exact.level,
        }
    }

    /// Gradients of a word-sized triangle, with an exponent of at most [`LARGEST`].
    #[inline(never)]
    fn mantissas([[x1, y1], [x2, y2]]: [[i32; 2]; 2], WordSized { zeros, bits, .. }: WordSized) -> Slopes {
        let det = x1.wrapping_mul(y2).wrapping_sub(x2.wrapping_mul(y1));
        // 1 / det = r 2^(zeros - 62); coordinates are at most 2^bits, so mantissas c r 2^(zeros - 58 + exponent) at most 2^30.
        let r = recip((det as u32) << (zeros & 31)).min(i32::MAX as u32) as i32;
        let exponent = (57 - zeros - bits).min(LARGEST);
        let up = zeros + exponent - 26;
        let mantissa = |c: i32| ((product(c << up, r) + (1 << 31)) >> 32) as i32;

        let (s, t) = ([mantissa(y2), -mantissa(x2)], [-mantissa(y1), mantissa(x1)]);
        Slopes { s, t, exponent: exponent as i32 }
    }

    /// `[c, dx, dy]` of the linear field through the corners' values in a range of 2^`BITS`, at the anchor.
    #[inline(always)]
    pub fn linear<const BITS: u32>(&self, nodes: [i32; 3], extra: u32) -> [i32; 3] {
        match self.precision {
            Precision::WordSized(area) if BITS <= word_sized::LINEAR && extra <= word_sized::MOST_EXTRA => {
                area.linear(self.edges, self.subpixels(), nodes, extra)
            }
            Precision::WordSized(area)
                if BITS <= word_sized::LONG && extra >= word_sized::LONG_EXTRA && self.steepness.fits_words(area.bits) =>
            {
                area.long_linear(self.edges, self.subpixels(), nodes, extra)
            }
            // Words would show.
            Precision::WordSized(_) if BITS > word_sized::LINEAR && self.steepness.is_steep() => self.linear_any(nodes, extra),
            _ => self.linear_otherwise(BITS, nodes, extra),
        }
    }

    /// The gradients are passed by value: if their address were taken, the fast way would keep them in memory.
    #[inline(never)]
    fn linear_otherwise(self, bits: u32, nodes: [i32; 3], extra: u32) -> [i32; 3] {
        match self.precision {
            Precision::WordSized(_) | Precision::Part(_) => self.linear_by_mantissas(bits, nodes, extra),
            Precision::Any(_) => self.linear_any(nodes, extra),
        }
    }

    /// Vector from corner 0 to the centre of its pixel, in 1/16 pixel, for a triangle that is not a part.
    #[inline]
    fn subpixels(&self) -> [i32; 2] {
        [self.offset[0] >> SPLITS, self.offset[1] >> SPLITS]
    }

    fn linear_by_mantissas(&self, bits: u32, [i0, i1, i2]: [i32; 3], extra: u32) -> [i32; 3] {
        let gradients = self.slopes();
        // Differences are below 2^bits.
        let up = 30 - bits;
        let left = extra + bits + 2 - gradients.exponent as u32;
        let [c, dx, dy] = Mantissas::new(gradients, self.offset).products((i1 - i0) << up, (i2 - i0) << up);
        [(i0 << extra).wrapping_add(rounded(c, left)), rounded(dx, left), rounded(dy, left)]
    }

    /// [`Self::linear`] for nodes in any range.
    #[inline(never)]
    pub(crate) fn linear_any(self, nodes: [i32; 3], extra: u32) -> [i32; 3] {
        let [c, dx, dy] = self.plane(nodes, extra);
        let [c, dx, dy, ..] = self.round([c, dx, dy, 0, 0, 0]);
        [c, dx, dy]
    }

    /// `[c, dx, dy]` of the linear field through the corners' values, at the anchor, with [`GUARD`] more fraction bits.
    pub fn fine(&self, nodes: [i32; 3]) -> [i64; 3] {
        let [c, dx, dy] = self.plane(nodes, 0);
        let [x, y] = self.shift().map(i64::from);
        [c.wrapping_add(dx.wrapping_mul(x)).wrapping_add(dy.wrapping_mul(y)), dx, dy]
    }

    /// The coefficients `[c, dx, dy]` of the linear field through the corners' values, at the pixel of corner 0, with `GUARD` more bits than walked.
    #[inline]
    fn plane(&self, nodes: [i32; 3], extra: u32) -> [i64; 3] {
        let (c, dx, dy) = self.derivatives(nodes[0], nodes[1].wrapping_sub(nodes[0]), nodes[2].wrapping_sub(nodes[0]), extra);
        [c.wrapping_add(along(dx, self.offset[0])).wrapping_add(along(dy, self.offset[1])), dx, dy]
    }

    /// Value at corner 0 and derivatives along x and y of `c0 + c1 s + c2 t`, with `GUARD` more bits than walked.
    #[inline]
    fn derivatives(&self, c0: i32, c1: i32, c2: i32, extra: u32) -> (i64, i64, i64) {
        let Slopes { s, t, exponent } = self.slopes();
        let bits = exponent - extra as i32 - GUARD;
        let along = |s: i32, t: i32| scale(product(c1, s) + product(c2, t), bits);
        (i64::from(c0).wrapping_shl(extra + GUARD as u32), along(s[0], t[0]), along(s[1], t[1]))
    }

    /// `[c, dx, dy, dxx, dxy, dyy]` of the quadratic through six nodes in a range of 2^`BITS`, at the anchor.
    #[inline(always)]
    pub fn quadratic<const BITS: u32>(&self, nodes: [i32; 6], extra: u32) -> [i32; 6] {
        match self.precision {
            Precision::WordSized(area) if BITS <= word_sized::QUADRATIC && extra <= word_sized::MOST_EXTRA => {
                match area.quadratic(self.edges, self.subpixels(), nodes, extra) {
                    Some(fitted) => fitted,
                    None => {
                        // Rebuild the array, so that the result of this rare path, which is returned in memory, does not force the fast
                        // path onto the stack.
                        let [c, dx, dy, dxx, dxy, dyy] = self.quadratic_any(BITS, nodes, extra);
                        [c, dx, dy, dxx, dxy, dyy]
                    }
                }
            }
            Precision::WordSized(area) if BITS <= word_sized::LONG && extra >= word_sized::LONG_EXTRA => {
                match area.long_quadratic(self.edges, self.subpixels(), nodes, extra, self.steepness) {
                    Some(fitted) => fitted,
                    None => self.quadratic_any(BITS, nodes, extra),
                }
            }
            Precision::WordSized(_) | Precision::Part(_) => self.quadratic_by_mantissas(BITS, nodes, extra),
            Precision::Any(_) => self.quadratic_any(BITS, nodes, extra),
        }
    }

    #[inline(never)]
    fn quadratic_by_mantissas(&self, bits: u32, [i0, i1, i2, i01, i12, i20]: [i32; 6], extra: u32) -> [i32; 6] {
        let gradients = self.slopes();
        let mantissas = Mantissas::new(gradients, self.offset);
        let exponent = gradients.exponent as u32;
        // First and second differences are below 2^(bits + 2).
        let up = 28 - bits;
        let (once, twice) = (extra + bits + 4 - exponent, extra + bits + 35 - 2 * exponent);
        let [c, dx, dy] = mantissas.products((4 * i01 - 3 * i0 - i1) << up, (4 * i20 - 3 * i0 - i2) << up);
        // Half the matrix of second derivatives: [[ss, st], [st, tt]].
        let half = |difference: i32| difference << (up + 1);
        let (ss, st, tt) = (half(i0 + i1 - 2 * i01), half(i0 - i01 - i20 + i12), half(i0 + i2 - 2 * i20));
        // One factor of the chain rule, then the other.
        let ([s, sx, sy], [t, tx, ty]) = (mantissas.products(ss, st), mantissas.products(st, tt));
        let [bend, bend_x, bend_y] = mantissas.products(twice_upper(s), twice_upper(t));
        let ([_, dxx, dxy], [_, _, dyy]) =
            (mantissas.products(twice_upper(sx), twice_upper(tx)), mantissas.products(twice_upper(sy), twice_upper(ty)));
        [
            (i0 << extra).wrapping_add(rounded(c, once)).wrapping_add(rounded(bend, twice)),
            rounded(dx, once).wrapping_add(rounded(bend_x, twice).wrapping_mul(2)),
            rounded(dy, once).wrapping_add(rounded(bend_y, twice).wrapping_mul(2)),
            rounded(dxx, twice),
            rounded(dxy, twice).wrapping_mul(2),
            rounded(dyy, twice),
        ]
    }

    #[cold]
    #[inline(never)]
    pub(crate) fn quadratic_any(self, range: u32, nodes: [i32; 6], extra: u32) -> [i32; 6] {
        self.round(self.quadratic_unmoved(range, nodes, extra))
    }

    /// `[c, dx, dy, dxx, dxy, dyy]` of the quadratic through six nodes in a range of 2^`range`, at the anchor, with [`GUARD`] more fraction bits than
    /// walked.
    #[cold]
    #[inline(never)]
    pub(crate) fn fine_quadratic(self, range: u32, nodes: [i32; 6], extra: u32) -> [i64; 6] {
        self.moved(self.quadratic_unmoved(range, nodes, extra))
    }

    /// The coefficients of [`Self::fine_quadratic`] at the pixel of corner 0.
    fn quadratic_unmoved(self, range: u32, nodes: [i32; 6], extra: u32) -> [i64; 6] {
        let [i0, i1, i2, i01, i12, i20] = nodes;
        let ratio = if range > word_sized::LINEAR { MAX_FINE_THINNESS } else { MAX_THINNESS };
        // Half the matrix of second derivatives: [[ss, st], [st, tt]].
        let (ss, st, tt) = (2 * (i0 + i1 - 2 * i01), 2 * (i0 - i01 - i20 + i12), 2 * (i0 + i2 - 2 * i20));
        // Second differences are below 2^(range + 2), and are shifted up to there where their products would lose too much.
        let mut up = 0;
        let mut is_exact = self.is_thinner_than(ratio);
        let steepness = self.steepness;
        if !is_exact && steepness.is_steep() {
            let thinness = self.thinness();
            if steepness.is_thin(thinness) {
                let size = (ss.unsigned_abs() | st.unsigned_abs() | tt.unsigned_abs()).leading_zeros();
                up = size.wrapping_sub(30 - range);
                // Exact fractions take most stack of all. Below, highlights are so soft that what is relative to second differences shows little.
                is_exact = steepness.is_sharp() && !steepness.bends(size as i32 + range as i32 - 33, thinness);
            }
        }
        if is_exact && let Some(sliver) = self.sliver() {
            return sliver.quadratic(nodes, extra + GUARD as u32);
        }
        let (c, dx, dy) = self.derivatives(i0, 4 * i01 - 3 * i0 - i1, 4 * i20 - 3 * i0 - i2, extra);
        // One factor of the chain rule, then the other: two products with mantissas, less these bits, stay below 2^31.
        let less = range as i32 + 2;
        let (ss, st, tt) = (ss << up, st << up, tt << up);
        let Slopes { s, t, exponent } = self.slopes();
        let sum = |a: i32, b: i32, k: usize, bits: i32| scale(product(a, s[k]) + product(b, t[k]), bits);
        let once = |a: i32, b: i32, k: usize| sum(a, b, k, less) as i32;
        let (sx, tx, sy, ty) = (once(ss, st, 0), once(st, tt, 0), once(ss, st, 1), once(st, tt, 1));
        let bits = 2 * exponent - less + up as i32 - extra as i32 - GUARD;
        let (dxx, dyy) = (sum(sx, tx, 0, bits), sum(sy, ty, 1, bits));
        let dxy = sum(sx, tx, 1, bits).wrapping_mul(2);
        // From the corner to its pixel's centre, at most a pixel away.
        let [ox, oy] = self.offset;
        let (bend_x, mixed, bend_y) = (along(dxx, ox), along(dxy, oy), along(dyy, oy));
        let c = c.wrapping_add(along(dx + bend_x + mixed, ox)).wrapping_add(along(dy + bend_y, oy));
        let dx = dx.wrapping_add(2 * bend_x).wrapping_add(mixed);
        let dy = dy.wrapping_add(2 * bend_y).wrapping_add(along(dxy, ox));
        [c, dx, dy, dxx, dxy, dyy]
    }

    /// Length over height, rounded up, where length is measured as in [`Self::is_thinner_than`].
    #[inline]
    fn thinness(&self) -> u32 {
        match self.precision {
            Precision::WordSized(area) => area.thinness(self.edges),
            _ => thinness(self.edges),
        }
    }

    /// The triangle for fits by exact fractions; `None` if it is so large that its area does not fit a word.
    fn sliver(&self) -> Option<Sliver> {
        // In 1/16 pixel, in a part of the triangle as much finer as it is smaller: all exact.
        let level = self.level();
        Sliver::new(self.edges, self.offset.map(|c| c >> (SPLITS - level)), SUBPIXEL + level)
    }

    /// Whether quadratics can be walked in words all over the triangle.
    #[inline(always)]
    pub(crate) fn walks_in_words(&self) -> bool {
        match self.precision {
            Precision::WordSized(area) if self.steepness.walks_word_sized(area.bits) => true,
            _ => walks_in_words(self.edges, self.shift(), self.steepness),
        }
    }

    /// Moves coefficients from corner 0's pixel to the anchor, exactly, and rounds them to the walked format.
    #[inline]
    fn round(&self, coefficients: [i64; 6]) -> [i32; 6] {
        let [c, dx, dy, dxx, dxy, dyy] = self.moved(coefficients);
        let done = |v: i64| scale(v, GUARD) as i32;
        [done(c), done(dx), done(dy), done(dxx), done(dxy), done(dyy)]
    }

    /// Moves coefficients from corner 0's pixel to the anchor, exactly.
    #[inline]
    fn moved(&self, [c, dx, dy, dxx, dxy, dyy]: [i64; 6]) -> [i64; 6] {
        let shift = self.shift();
        if shift == [0; 2] {
            return [c, dx, dy, dxx, dxy, dyy];
        }
        let [x, y] = shift.map(i64::from);
        let m = i64::wrapping_mul;
        let bend_x = m(dxx, x).wrapping_add(m(dxy, y));
        let bend_y = m(dyy, y);
        let c = c.wrapping_add(m(dx.wrapping_add(bend_x), x)).wrapping_add(m(dy.wrapping_add(bend_y), y));
        let dx = dx.wrapping_add(bend_x).wrapping_add(m(dxx, x));
        let dy = dy.wrapping_add(bend_y).wrapping_add(bend_y).wrapping_add(m(dxy, x));
        [c, dx, dy, dxx, dxy, dyy]
    }
}

/// See [`Gradients::walks_in_words`].
#[cold]
#[inline(never)]
fn walks_in_words([[x1, y1], [x2, y2]]: [[i32; 2]; 2], shift: [i32; 2], steepness: Steepness) -> bool {
    let extent = |a: i32, b: i32| a.max(b).max(0).wrapping_sub(a.min(b).min(0)).unsigned_abs();
    let span = (extent(x1, x2).saturating_add(extent(y1, y2)) >> SUBPIXEL) + 1;
    // The anchor of a large triangle is the middle of what is seen of it.
    steepness.walks_in_words(if shift == [0; 2] { span } else { span / 2 })
}

/// The first corner, and the edges from it to the others.
#[inline]
fn edges([[x0, y0], [x1, y1], [x2, y2]]: [[i32; 2]; 3]) -> ([i32; 2], [[i32; 2]; 2]) {
    ([x0, y0], [[x1.wrapping_sub(x0), y1.wrapping_sub(y0)], [x2.wrapping_sub(x0), y2.wrapping_sub(y0)]])
}

/// See [`Gradients::is_thinner_than`].
#[cold]
#[inline(never)]
fn is_longer(edges: [[i32; 2]; 2], ratio: i64) -> bool {
    let [square, area] = square_and_area(edges);
    square > area.saturating_mul(ratio)
}

/// See [`Gradients::thinness`].
#[cold]
#[inline(never)]
pub(super) fn thinness(edges: [[i32; 2]; 2]) -> u32 {
    // Coordinates have at most 18 bits.
    let [square, area] = square_and_area(edges).map(|c| (c >> 4) as u32);
    square.checked_div(area).unwrap_or(u32::MAX - 1) + 1
}

/// The square of the longest side by columns or rows from corner 0, and twice the area.
#[inline]
fn square_and_area(edges: [[i32; 2]; 2]) -> [i64; 2] {
    let [[x1, y1], [x2, y2]] = edges.map(|edge| edge.map(i64::from));
    let extent = x1.abs().max(y1.abs()).max(x2.abs()).max(y2.abs());
    [extent * extent, x1 * y2 - x2 * y1]
}

/// Gradients of s and t, and s and t at the anchor of a word-sized triangle, all with one exponent.
struct Mantissas {
    gradients: Slopes,
    at: [i32; 2],
}

impl Mantissas {
    /// Gradients, and s and t at the anchor; `offset` leads there from corner 0.
    #[inline]
    fn new(gradients: Slopes, offset: [i32; 2]) -> Self {
        Self { at: [at(gradients.s, offset), at(gradients.t, offset)], gradients }
    }

    /// The value of `a s + b t` at the anchor, and its derivatives along x and y; `a` and `b` are at most 2^30.
    #[inline]
    fn products(&self, a: i32, b: i32) -> [i64; 3] {
        let Slopes { s, t, .. } = self.gradients;
        let along = |s: i32, t: i32| product(a, s) + product(b, t);
        [along(self.at[0], self.at[1]), along(s[0], t[0]), along(s[1], t[1])]
    }
}

/// The upper half of a product, rounded to nearest, times 2.
#[inline]
fn twice_upper(product: i64) -> i32 {
    ((product.wrapping_add(1 << 31) >> 32) as i32) << 1
}

/// The product of `gradient` and `offset`, which is at most a pixel ([`FINE`] fraction bits).
#[inline]
fn at(gradient: [i32; 2], offset: [i32; 2]) -> i32 {
    ((product(gradient[0], offset[0]) + product(gradient[1], offset[1])) >> FINE) as i32
}

/// `gradient` times `offset`, [`FINE`] fraction bits.
#[inline]
fn along(gradient: i64, offset: i32) -> i64 {
    gradient.wrapping_mul(offset.into()) >> FINE
}
