//! Forward differences over the longest ways: as many steps as there are columns and rows come to what one multiplication says.

use crate::{
    Family, Verdict,
    coverage::{Corners, side},
    random::Random,
};
use microphong::{
    interpolate::{Patch, Walker, plane::Plane, quadric::Quadric},
    setup::gradients::Gradients,
};
use microphong_literature::cubic::field::CubicPatch;
use std::hint::black_box;

/// Columns that are walked.
const COLUMNS: i32 = 4096;
/// Rows that are walked.
const ROWS: i32 = 2047;

/// Polynomials on triangles of every size.
pub struct Walks;

impl Family for Walks {
    fn name(&self) -> &'static str {
        "walks"
    }

    fn about(&self) -> &'static str {
        "forward differences over 4,096 columns and 2,047 rows end at the exact value"
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let reach = random.octaves(16.0, 65_536.0) as i32;
        let mut corners: Corners = [(); 3].map(|()| [(); 2].map(|()| random.pick(-reach..reach)));
        if side(corners[0], corners[1], corners[2]) < 0 {
            corners.swap(1, 2);
        }
        let Some(gradients) = Gradients::new(corners, [0, 0, COLUMNS, ROWS]) else { return Verdict::skipped() };
        let mut nodes = || random.pick(0..255 << 7);
        let (three, six, ten) = ([(); 3].map(|()| nodes()), [(); 6].map(|()| nodes()), [(); 10].map(|()| nodes()));
        let (row, column) = (random.pick(1..ROWS + 1), random.pick(1..COLUMNS + 1));
        let wrong = [
            ("plane", drifts(Plane::<1>::fit::<15>(&gradients, &[three], 16, [0]), row, column)),
            ("quadratic", drifts(Quadric::<1>::fit::<15>(&gradients, &[six], 16, [0]), row, column)),
            ("cubic", drifts(CubicPatch::<1>::fit(&gradients, &[ten], 16, [0]), row, column)),
        ];
        let failure =
            wrong.iter().find(|(_, wrong)| *wrong).map(|(name, _)| format!("{name} on {corners:?}, {row} rows, {column} columns"));
        Verdict { failure, ..Verdict::default() }
    }
}

/// Whether steps and jumps end at different values.
pub fn drifts<P: Patch<Walker: Walker<Value: PartialEq>>>(patch: P, rows: i32, columns: i32) -> bool {
    let (mut stepped, mut jumped) = (patch, patch);
    // Each step is taken: what is known of their sum is what is to be tested.
    (0..rows).for_each(|_| black_box(&mut stepped).step_row());
    jumped.jump(rows);
    let mut walker = stepped.enter(COLUMNS);
    (0..columns).for_each(|_| black_box(&mut walker).step());
    walker.value() != jumped.enter(COLUMNS - columns).value()
}
