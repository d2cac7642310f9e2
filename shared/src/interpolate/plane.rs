//! Linear fields.

use microphong_kernels::Fields;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::{
    interpolate::{Checkerboard, HALF_RANGE, Patch, Walker, each_channel},
    setup::gradients::Gradients,
};

/// A linear function `c + dx x + dy y` in each of `CH` channels, standing on one row.
#[derive(Clone, Copy, Debug)]
pub struct Plane<const CH: usize>([PlaneRow; CH]);

impl<const CH: usize> Default for Plane<CH> {
    fn default() -> Self {
        Self::ZERO
    }
}

/// One channel: the value at column 0 of the current row, and the derivatives.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
struct PlaneRow {
    c: i32,
    dx: i32,
    dy: i32,
}

impl PlaneRow {
    /// See [`Plane::fit`].
    #[inline(always)]
    fn fit<const BITS: u32>(gradients: &Gradients, nodes: [i32; 3], extra: u32, bias: i32) -> Self {
        Self::new(gradients, gradients.linear::<BITS>(nodes, extra), bias)
    }

    /// The linear function with these coefficients at the anchor, and `bias` added to its values.
    #[inline(always)]
    fn new(gradients: &Gradients, [c, dx, dy]: [i32; 3], bias: i32) -> Self {
        // The move from the anchor column to column 0 is exact, modulo 2^32.
        Self { c: c.wrapping_sub(dx.wrapping_mul(gradients.column())).wrapping_add(bias), dx, dy }
    }

    /// [`Self::fit`] in a function of its own, for several channels.
    #[inline(never)]
    fn fitted<const BITS: u32>(gradients: &Gradients, nodes: &[i32; 3], extra: u32, bias: i32) -> Self {
        Self::fit::<BITS>(gradients, *nodes, extra, bias)
    }
}

impl<const CH: usize> Plane<CH> {
    /// A constant, so that no loop clears one channel after the other.
    const ZERO: Self = Self([PlaneRow { c: 0, dx: 0, dy: 0 }; CH]);

    /// The linear fields of one channel each, side by side.
    #[inline(always)]
    pub(crate) fn side_by_side(fields: [Plane<1>; CH]) -> Self {
        Self(fields.map(|Plane([row])| row))
    }

    /// The linear field with the value `nodes[channel][k]` at corner `k`. Nodes lie in a range narrower than 2^`BITS`. Values are walked with `extra`
    /// more fraction bits than nodes have, and with `bias` added.
    ///
    /// Error: at most 2^-1 (1 + S) units of the walked format, S the distance in columns plus rows from the anchor (see [`Gradients`]). On
    /// triangles of up to 64 pixels: 2^4 (1 + S) units more. Set-up costs at most 2^-22 k of the nodes' range, k the length over the
    /// height.
    #[inline(always)]
    pub fn fit<const BITS: u32>(gradients: &Gradients, nodes: &[[i32; 3]; CH], extra: u32, bias: [i32; CH]) -> Self {
        let mut plane = Self::ZERO;
        if CH == 1 {
            for ((row, nodes), bias) in plane.0.iter_mut().zip(*nodes).zip(bias) {
                *row = PlaneRow::fit::<BITS>(gradients, nodes, extra, bias);
            }
        } else {
            each_channel::<CH>(|c| plane.0[c] = PlaneRow::fitted::<BITS>(gradients, &nodes[c], extra, bias[c]));
        }
        plane
    }

    /// [`Self::fit`] of nodes in any range, walked with the fraction bits that they have. It takes longer.
    #[inline(never)]
    pub(super) fn fit_any(gradients: &Gradients, nodes: &[[i32; 3]; CH]) -> Self {
        let mut plane = Self::ZERO;
        for (row, nodes) in plane.0.iter_mut().zip(nodes) {
            *row = PlaneRow::new(gradients, gradients.linear_any(*nodes, 0), 0);
        }
        plane
    }

    /// The value at column 0 of the current row, and the derivatives.
    #[inline(always)]
    pub(super) fn coefficients(&self) -> [[i32; 3]; CH] {
        self.0.map(|PlaneRow { c, dx, dy }| [c, dx, dy])
    }

    /// The plane whose values are so many bits further left, modulo 2^32.
    #[inline(always)]
    pub(crate) fn shifted(self, left: u32) -> Self {
        Self(self.0.map(|PlaneRow { c, dx, dy }| PlaneRow { c: c << left, dx: dx << left, dy: dy << left }))
    }
}

impl<const CH: usize> Patch for Plane<CH> {
    type Walker = LinearWalker<CH>;

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        for row in &mut self.0 {
            row.c = row.c.wrapping_add(row.dy.wrapping_mul(rows));
        }
    }

    #[inline(always)]
    fn step_row(&mut self) {
        if CH == 1 {
            for row in &mut self.0 {
                row.c = row.c.wrapping_add(row.dy);
            }
            return;
        }
        each_channel::<CH>(|c| self.0[c].c = self.0[c].c.wrapping_add(self.0[c].dy));
    }

    #[inline(always)]
    fn raised(mut self, by: &[u32; CH]) -> Self {
        each_channel::<CH>(|c| self.0[c].c = self.0[c].c.wrapping_add(by[c] as i32));
        self
    }

    const WORDS: usize = 3 * CH;

    const FIELDS: Option<[usize; 2]> = Some([CH, 0]);

    #[inline(always)]
    fn planes(&mut self) -> &mut [microphong_kernels::Plane] {
        <[microphong_kernels::Plane]>::mut_from_bytes(self.0.as_mut_bytes()).unwrap_or_default()
    }

    #[inline(always)]
    fn lend<'a>(&'a mut self, fields: &mut Fields<'a>) {
        for plane in self.planes() {
            fields.add_numerator(plane);
        }
    }

    #[inline(always)]
    fn save(&self, words: &mut [u32]) {
        let (rows, _) = words.as_chunks_mut::<3>();
        for (words, row) in rows.iter_mut().zip(&self.0) {
            *words = [row.c as u32, row.dx as u32, row.dy as u32];
        }
    }

    #[inline(always)]
    fn load(words: &[u32]) -> Option<Self> {
        let (rows, _) = words.as_chunks::<3>();
        let rows = rows.first_chunk::<CH>()?;
        Some(Self(rows.map(|[c, dx, dy]| PlaneRow { c: c as i32, dx: dx as i32, dy: dy as i32 })))
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> LinearWalker<CH> {
        if CH == 1 {
            return LinearWalker {
                value: self.0.map(|row| row.c.wrapping_add(row.dx.wrapping_mul(x)) as u32),
                step: self.0.map(|row| row.dx as u32),
            };
        }
        let mut walker = LinearWalker { value: [0; CH], step: [0; CH] };
        each_channel::<CH>(|c| {
            let row = &self.0[c];
            walker.value[c] = row.c.wrapping_add(row.dx.wrapping_mul(x)) as u32;
            walker.step[c] = row.dx as u32;
        });
        walker
    }
}

impl<const CH: usize> Checkerboard for Plane<CH> {
    #[inline(always)]
    fn checkered(mut self, row: i32) -> Self {
        for channel in &mut self.0 {
            channel.c = channel.c.wrapping_add(HALF_RANGE.wrapping_mul(row));
            channel.dx = channel.dx.wrapping_add(HALF_RANGE);
            channel.dy = channel.dy.wrapping_add(HALF_RANGE);
        }
        self
    }
}

/// Walks a [`Plane`] by one addition a pixel and channel.
#[derive(Clone, Copy, Debug)]
pub struct LinearWalker<const CH: usize> {
    value: [u32; CH],
    step: [u32; CH],
}

impl<const CH: usize> Walker for LinearWalker<CH> {
    type Value = [u32; CH];

    #[inline(always)]
    fn step(&mut self) {
        if CH == 1 {
            // Measured: one channel in a loop leaves the compiler a shorter pixel loop.
            for c in 0..CH {
                self.value[c] = self.value[c].wrapping_sub(self.step[c]);
            }
            return;
        }
        each_channel::<CH>(|c| self.value[c] = self.value[c].wrapping_sub(self.step[c]));
    }

    #[inline(always)]
    fn value(&self) -> [u32; CH] {
        self.value
    }
}
