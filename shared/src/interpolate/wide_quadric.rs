//! Quadratic fields whose coefficients are double words.
//!
//! The coefficients of a [`Quadric`](crate::interpolate::quadric::Quadric) are words. Their rounding grows with the square of the distance from the
//! anchor, and shows where light is a steep function of the field. Coefficients have [`GUARD`] bits more here. They are rounded to words where a walker
//! enters a row, so that the error grows with the square of what it walks along the row.
//!
//! Cost: a quadric's at the pixel, and six products of double words a channel where a walker enters.

use crate::{
    interpolate::{Patch, each_channel, field::Nodes, quadric::QuadraticWalker},
    setup::gradients::{GUARD, Gradients},
};

/// A quadratic function in each of `CH` channels, standing on one row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WideQuadric<const CH: usize>([Row; CH]);

/// One channel, with x measured from column 0: the polynomial on one row, and how it changes from row to row. All have 32 fraction bits more than the
/// walked format, and wrap as it does.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    /// Value at column 0.
    c: i64,
    /// First difference of `c` downwards, and its own difference.
    c_down: i64,
    c_down2: i64,
    /// Coefficient of x, and its difference downwards.
    dx: i64,
    dx_down: i64,
    /// Coefficient of x².
    dxx: i64,
}

impl<const CH: usize> WideQuadric<CH> {
    /// The quadratic through six nodes a channel.
    pub(crate) fn fit<const BITS: u32>(gradients: &Gradients, Nodes { values, extra, .. }: &Nodes<6, CH, BITS>) -> Self {
        let is_exact = gradients.walks_in_words();
        let x = i64::from(gradients.column());
        Self(values.map(|nodes| {
            // The move from the anchor column to column 0 is exact, modulo 2^64.
            let [c, dx, dy, dxx, dxy, dyy] = if is_exact {
                gradients.quadratic::<BITS>(nodes, *extra).map(|c| i64::from(c) << 32)
            } else {
                gradients.fine_quadratic(BITS, nodes, *extra).map(|c| c << (32 - GUARD))
            };
            Row {
                c: c.wrapping_sub(x.wrapping_mul(dx.wrapping_sub(dxx.wrapping_mul(x)))),
                c_down: dy.wrapping_add(dyy).wrapping_sub(dxy.wrapping_mul(x)),
                c_down2: dyy.wrapping_mul(2),
                dx: dx.wrapping_sub(dxx.wrapping_mul(x).wrapping_mul(2)),
                dx_down: dxy,
                dxx,
            }
        }))
    }
}

impl<const CH: usize> Patch for WideQuadric<CH> {
    type Walker = QuadraticWalker<CH>;

    fn jump(&mut self, rows: i32) {
        let rows = i64::from(rows);
        let pairs = rows * (rows - 1) / 2;
        for row in &mut self.0 {
            row.c = row.c.wrapping_add(row.c_down.wrapping_mul(rows)).wrapping_add(row.c_down2.wrapping_mul(pairs));
            row.c_down = row.c_down.wrapping_add(row.c_down2.wrapping_mul(rows));
            row.dx = row.dx.wrapping_add(row.dx_down.wrapping_mul(rows));
        }
    }

    fn step_row(&mut self) {
        for row in &mut self.0 {
            row.c = row.c.wrapping_add(row.c_down);
            row.c_down = row.c_down.wrapping_add(row.c_down2);
            row.dx = row.dx.wrapping_add(row.dx_down);
        }
    }

    fn enter(&self, x: i32) -> QuadraticWalker<CH> {
        let x = i64::from(x);
        let word = |c: i64| (c >> 32) as i32;
        let mut walker = QuadraticWalker::default();
        each_channel::<CH>(|c| {
            let row = &self.0[c];
            let quadratic = row.dxx.wrapping_mul(x);
            let value = row.c.wrapping_add(row.dx.wrapping_add(quadratic).wrapping_mul(x));
            // V(x - 1) - V(x) = dxx - dx - 2 dxx x.
            let step = row.dxx.wrapping_sub(row.dx).wrapping_sub(quadratic.wrapping_mul(2));
            walker.start(c, [value, step, row.dxx.wrapping_mul(2)].map(word));
        });
        walker
    }
}
