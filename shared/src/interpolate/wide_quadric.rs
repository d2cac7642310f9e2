//! Quadratic fields whose coefficients are double words.
//!
//! The coefficients of a [`Quadric`](crate::interpolate::quadric::Quadric) are words. Their rounding grows with the square of the distance from the
//! anchor, and shows where light is a steep function of the field. Coefficients have [`GUARD`] bits more here. They are rounded to words where a walker
//! enters a row, so that the error grows with the square of what it walks along the row.
//!
//! Cost: a quadric's at the pixel, and products of double words where a walker enters.

use crate::{
    interpolate::{
        Patch, each_channel,
        field::Nodes,
        quadric::{QuadraticWalker, quadric_row},
    },
    setup::gradients::{GUARD, Gradients},
};

quadric_row!(
    /// One channel, in double words.
    WideRow,
    i64
);

/// A quadratic function in each of `CH` channels, standing on one row. Its numbers have 32 fraction bits more than the walked format, and wrap as it
/// does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WideQuadric<const CH: usize>([WideRow; CH]);

impl<const CH: usize> WideQuadric<CH> {
    /// The quadratic through six nodes a channel.
    pub(crate) fn fit<const BITS: u32>(gradients: &Gradients, Nodes { values, extra, .. }: &Nodes<6, CH, BITS>) -> Self {
        let words_suffice = gradients.walks_in_words();
        Self(values.map(|nodes| {
            let coefficients = if words_suffice {
                gradients.quadratic::<BITS>(nodes, *extra).map(|c| i64::from(c) << 32)
            } else {
                gradients.fine_quadratic(BITS, nodes, *extra).map(|c| c << (32 - GUARD))
            };
            WideRow::new(coefficients, gradients.column().into(), 0)
        }))
    }
}

impl<const CH: usize> Patch for WideQuadric<CH> {
    type Walker = QuadraticWalker<CH>;

    fn jump(&mut self, rows: i32) {
        let rows = i64::from(rows);
        self.0.iter_mut().for_each(|row| row.jump(rows, rows * (rows - 1) / 2));
    }

    fn step_row(&mut self) {
        self.0.iter_mut().for_each(WideRow::step_row);
    }

    fn enter(&self, x: i32) -> QuadraticWalker<CH> {
        let mut walker = QuadraticWalker::ZERO;
        each_channel::<CH>(|c| walker.start(c, self.0[c].at(x.into()).map(|number| (number >> 32) as i32)));
        walker
    }
}
