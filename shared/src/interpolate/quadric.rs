//! Quadratic fields.

use crate::{
    interpolate::{Checkerboard, HALF_RANGE, Patch, Walker, each_channel, plane::Plane},
    setup::{gradients::Gradients, word_sized::QUADRATIC},
};
use microphong_kernels::Fields;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, transmute_mut};

/// A quadratic function `c + dx x + dy y + dxx x² + dxy x y + dyy y²` in each of `CH` channels, standing on one row.
#[derive(Clone, Copy, Debug)]
pub struct Quadric<const CH: usize>([QuadricRow; CH]);

impl<const CH: usize> Default for Quadric<CH> {
    fn default() -> Self {
        Self::ZERO
    }
}

/// Defines one channel, with x measured from column 0: the polynomial on one row, and how it changes from row to row. All arithmetic on its numbers wraps,
/// so that it is exact modulo their range.
macro_rules! quadric_row {
    ($(#[$attribute:meta])* $name:ident, $number:ty) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug)]
        #[repr(C)]
        pub(super) struct $name {
            /// Value at column 0.
            c: $number,
            /// First difference of `c` downwards, and its own difference.
            c_down: $number,
            c_down2: $number,
            /// Coefficient of x, and its difference downwards.
            dx: $number,
            dx_down: $number,
            /// Coefficient of x².
            dxx: $number,
        }

        impl $name {
            /// The polynomial with these coefficients at the column `x`, and `bias` added to its values.
            #[inline]
            pub(super) fn new([c, dx, dy, dxx, dxy, dyy]: [$number; 6], x: $number, bias: $number) -> Self {
                // The move to column 0 is exact.
                let bend = dxx.wrapping_mul(x);
                Self {
                    c: c.wrapping_sub(x.wrapping_mul(dx.wrapping_sub(bend))).wrapping_add(bias),
                    c_down: dy.wrapping_add(dyy).wrapping_sub(dxy.wrapping_mul(x)),
                    c_down2: dyy.wrapping_add(dyy),
                    dx: dx.wrapping_sub(bend.wrapping_add(bend)),
                    dx_down: dxy,
                    dxx,
                }
            }

            /// Moves down `rows` rows, of which there are `pairs` pairs: rows (rows - 1) / 2.
            #[inline]
            pub(super) fn jump(&mut self, rows: $number, pairs: $number) {
                self.c = self.c.wrapping_add(self.c_down.wrapping_mul(rows)).wrapping_add(self.c_down2.wrapping_mul(pairs));
                self.c_down = self.c_down.wrapping_add(self.c_down2.wrapping_mul(rows));
                self.dx = self.dx.wrapping_add(self.dx_down.wrapping_mul(rows));
            }

            /// Moves down one row.
            #[inline]
            pub(super) fn step_row(&mut self) {
                self.c = self.c.wrapping_add(self.c_down);
                self.c_down = self.c_down.wrapping_add(self.c_down2);
                self.dx = self.dx.wrapping_add(self.dx_down);
            }

            /// The value on column `x`, its difference to the next column on the left, and the difference of differences.
            #[inline]
            pub(super) fn at(&self, x: $number) -> [$number; 3] {
                let bend = self.dxx.wrapping_mul(x);
                // V(x - 1) - V(x) = dxx - dx - 2 dxx x.
                [
                    self.c.wrapping_add(self.dx.wrapping_add(bend).wrapping_mul(x)),
                    self.dxx.wrapping_sub(self.dx).wrapping_sub(bend.wrapping_add(bend)),
                    self.dxx.wrapping_add(self.dxx),
                ]
            }
        }
    };
}
pub(super) use quadric_row;

quadric_row!(
    /// One channel.
    #[derive(FromBytes, IntoBytes, Immutable, KnownLayout)]
    QuadricRow,
    i32
);

impl QuadricRow {
    /// See [`Quadric::fit`].
    #[inline(always)]
    fn fit<const BITS: u32>(gradients: &Gradients, nodes: [i32; 6], extra: u32, bias: i32) -> Self {
        let [c, dx, dy, dxx, dxy, dyy] =
            if BITS <= QUADRATIC { gradients.quadratic::<BITS>(nodes, extra) } else { long::<BITS>(gradients, nodes, extra) };
        Self::new([c, dx, dy, dxx, dxy, dyy], gradients.column(), bias)
    }

    /// [`Self::fit`] in a function of its own, for several channels.
    #[inline(never)]
    fn fitted<const BITS: u32>(gradients: &Gradients, nodes: &[i32; 6], extra: u32, bias: i32) -> Self {
        Self::fit::<BITS>(gradients, *nodes, extra, bias)
    }
}

impl<const CH: usize> Quadric<CH> {
    /// A constant, so that no loop clears one channel after the other.
    const ZERO: Self = Self([QuadricRow { c: 0, c_down: 0, c_down2: 0, dx: 0, dx_down: 0, dxx: 0 }; CH]);

    /// The quadratic through six nodes per channel: corners 0, 1, 2, then the midpoints of the edges 01, 12, 20.
    ///
    /// All nodes lie in a range narrower than 2^`BITS`; values are walked with `extra` more
    /// fraction bits, `bias` added. Error: at most 2^-1 (1 + S + S²) units of the walked format, S the distance in columns plus rows
    /// from the anchor, and for set-up 2^-22 k² of the nodes' range, k the length over the height, up to
    /// [`crate::setup::gradients::MAX_THINNESS`]; nothing beyond. For 26 bits these are 2^-25 k² and
    /// [`crate::setup::gradients::MAX_FINE_THINNESS`]. On triangles of up to 64 pixels: 2^4 (1 + S) units more, of levels 2^9 (1 + S),
    /// 0.001 LSB at 16 pixels.
    /// Source: Szirmay-Kalos et al.; Vlasic 2002, 4.2; change of basis without his divisions.
    #[inline(always)]
    pub fn fit<const BITS: u32>(gradients: &Gradients, nodes: &[[i32; 6]; CH], extra: u32, bias: [i32; CH]) -> Self {
        let mut quadric = Self::ZERO;
        if CH == 1 {
            for ((to, nodes), bias) in quadric.0.iter_mut().zip(*nodes).zip(bias) {
                *to = QuadricRow::fit::<BITS>(gradients, nodes, extra, bias);
            }
        } else {
            each_channel::<CH>(|c| quadric.0[c] = QuadricRow::fitted::<BITS>(gradients, &nodes[c], extra, bias[c]));
        }
        quadric
    }

    /// The quadratic whose values are so many bits further left, modulo 2^32.
    #[inline]
    pub(crate) fn shifted(self, left: u32) -> Self {
        Self(self.0.map(|QuadricRow { c, c_down, c_down2, dx, dx_down, dxx }| {
            let [c, c_down, c_down2, dx, dx_down, dxx] = [c, c_down, c_down2, dx, dx_down, dxx].map(|c| c << left);
            QuadricRow { c, c_down, c_down2, dx, dx_down, dxx }
        }))
    }
}

/// Fits one channel of a triangle that is not word-sized. It is a function of its own, since a call is a small share of the cost. Fields that are
/// walked in whole words are fitted fast, because a constant number of fraction bits saves instructions.
#[inline(never)]
fn long<const BITS: u32>(gradients: &Gradients, nodes: [i32; 6], extra: u32) -> [i32; 6] {
    if extra == 32 - BITS { gradients.quadratic::<BITS>(nodes, 32 - BITS) } else { gradients.quadratic_any(BITS, nodes, extra) }
}

/// A plane as a quadratic that does not bend.
impl<const CH: usize> From<Plane<CH>> for Quadric<CH> {
    #[inline]
    fn from(plane: Plane<CH>) -> Self {
        Self(plane.coefficients().map(|[c, dx, dy]| QuadricRow { c, c_down: dy, c_down2: 0, dx, dx_down: 0, dxx: 0 }))
    }
}

impl<const CH: usize> Patch for Quadric<CH> {
    type Walker = QuadraticWalker<CH>;

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        // rows (rows - 1) / 2 is an integer; wrapping multiplication keeps every later value exact.
        let pairs = (i64::from(rows) * (i64::from(rows) - 1) / 2) as i32;
        for row in &mut self.0 {
            row.jump(rows, pairs);
        }
    }

    #[inline]
    fn step_row(&mut self) {
        each_channel::<CH>(|c| self.0[c].step_row());
    }

    #[inline]
    fn raised(mut self, by: &[u32; CH]) -> Self {
        each_channel::<CH>(|c| self.0[c].c = self.0[c].c.wrapping_add(by[c] as i32));
        self
    }

    const WORDS: usize = 6 * CH;

    const FIELDS: Option<[usize; 2]> = Some([0, CH]);

    #[inline(always)]
    fn lend<'a>(&'a mut self, fields: &mut Fields<'a>) {
        for row in &mut self.0 {
            fields.add_quadratic(transmute_mut!(row));
        }
    }

    #[inline]
    fn save(&self, words: &mut [u32]) {
        let (rows, _) = words.as_chunks_mut::<6>();
        for (words, row) in rows.iter_mut().zip(&self.0) {
            *words = [row.c, row.c_down, row.c_down2, row.dx, row.dx_down, row.dxx].map(|c| c as u32);
        }
    }

    #[inline]
    fn load(words: &[u32]) -> Option<Self> {
        let (rows, _) = words.as_chunks::<6>();
        let rows = rows.first_chunk::<CH>()?;
        Some(Self(rows.map(|words| {
            let [c, c_down, c_down2, dx, dx_down, dxx] = words.map(|c| c as i32);
            QuadricRow { c, c_down, c_down2, dx, dx_down, dxx }
        })))
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> QuadraticWalker<CH> {
        if CH == 1 {
            // Measured: sums that are written out leave the compiler a shorter loop.
            return QuadraticWalker {
                value: self.0.map(|row| row.c.wrapping_add(row.dx.wrapping_add(row.dxx.wrapping_mul(x)).wrapping_mul(x)) as u32),
                d1: self.0.map(|row| row.dxx.wrapping_sub(row.dx).wrapping_sub(row.dxx.wrapping_mul(x).wrapping_mul(2)) as u32),
                d2: self.0.map(|row| row.dxx.wrapping_mul(2) as u32),
            };
        }
        let mut walker = QuadraticWalker::ZERO;
        each_channel::<CH>(|c| walker.start(c, self.0[c].at(x)));
        walker
    }
}

impl<const CH: usize> Checkerboard for Quadric<CH> {
    #[inline]
    fn checkered(mut self, row: i32) -> Self {
        for channel in &mut self.0 {
            channel.c = channel.c.wrapping_add(HALF_RANGE.wrapping_mul(row));
            channel.dx = channel.dx.wrapping_add(HALF_RANGE);
            channel.c_down = channel.c_down.wrapping_add(HALF_RANGE);
        }
        self
    }
}

/// Walks a [`Quadric`] by two additions a pixel and channel.
#[derive(Clone, Copy, Debug)]
pub struct QuadraticWalker<const CH: usize> {
    value: [u32; CH],
    d1: [u32; CH],
    d2: [u32; CH],
}

impl<const CH: usize> QuadraticWalker<CH> {
    /// A walker of zeros.
    pub(super) const ZERO: Self = Self { value: [0; CH], d1: [0; CH], d2: [0; CH] };

    /// Sets the value of a channel, its next difference, and the difference of differences.
    #[inline]
    pub(super) fn start(&mut self, channel: usize, differences: [i32; 3]) {
        let [value, d1, d2] = differences;
        (self.value[channel], self.d1[channel], self.d2[channel]) = (value as u32, d1 as u32, d2 as u32);
    }
}

impl<const CH: usize> Walker for QuadraticWalker<CH> {
    type Value = [u32; CH];

    #[inline]
    fn step(&mut self) {
        if CH == 1 {
            // Measured: one channel in a loop leaves the compiler a shorter pixel loop.
            for c in 0..CH {
                self.value[c] = self.value[c].wrapping_add(self.d1[c]);
                self.d1[c] = self.d1[c].wrapping_add(self.d2[c]);
            }
            return;
        }
        each_channel::<CH>(|c| {
            self.value[c] = self.value[c].wrapping_add(self.d1[c]);
            self.d1[c] = self.d1[c].wrapping_add(self.d2[c]);
        });
    }

    #[inline(always)]
    fn value(&self) -> [u32; CH] {
        self.value
    }
}
