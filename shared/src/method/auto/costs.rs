//! Costs of the ways to draw a triangle, by which `auto` chooses.
//!
//! Costs are instructions on a Cortex-M3, as `microphong bench` counts them: set-up for each triangle, the rest of each row, and the inner loop for
//! each pixel. They are means of two scenes, one with large triangles and one with small ones: `peer-sphere` and `teapot` in one channel,
//! `peer-sphere-plastic` and `torus` in three, `peer-sphere-lights` and `bunny` under two lights. `tests/suite/choices.rs` counts everything again
//! that can be drawn alone: all but the quadratic through cosines.
//!
//! The choice is the same on every machine, and so are the pictures. A table measured on the Cortex-M0+ would not help: with it, frames of `bunny`,
//! `torus`, `teapot` and `peer-sphere-plastic` take 0 to 1 % more cycles of the Pico.

/// Cost of drawing a triangle by a method, in instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Instructions for the triangle.
    pub triangle: i32,
    /// Instructions for each row.
    pub row: i32,
    /// Instructions for each pixel.
    pub pixel: i32,
}

impl Cost {
    const fn new(triangle: i32, row: i32, pixel: i32) -> Self {
        Self { triangle, row, pixel }
    }

    const fn minus(self, other: Self) -> Self {
        Self::new(self.triangle - other.triangle, self.row - other.row, self.pixel - other.pixel)
    }

    /// Cost of a triangle of this number of rows and pixels, in instructions.
    #[inline]
    #[must_use]
    pub(crate) fn of(self, [rows, pixels]: [i32; 2]) -> i32 {
        self.triangle + rows * self.row + pixels * self.pixel
    }
}

/// Costs of the ways to draw a triangle that linear interpolation does not keep within the budget.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoopCosts {
    /// Cost of the quadratic through levels.
    pub quadratic: Cost,
    /// Cost of the quadratic through cosines.
    pub cosines: Cost,
    /// Cost of Phong shading.
    pub phong: Cost,
}

/// Savings of quadratics compared with Phong shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Savings {
    /// Saving by the quadratic through levels.
    pub(crate) quadratic: Cost,
    /// Saving by the quadratic through cosines.
    pub(crate) cosines: Cost,
}

impl Savings {
    const fn of(LoopCosts { quadratic, cosines, phong }: LoopCosts) -> Self {
        Self { quadratic: phong.minus(quadratic).minus(JUDGE_QUADRATIC), cosines: phong.minus(cosines).minus(JUDGE_COSINES) }
    }
}

/// Cost of finding out whether a quadratic through levels keeps to the budget, with a share of what is spent in vain.
const JUDGE_QUADRATIC: Cost = Cost::new(500, 0, 0);
/// Cost of finding out whether a quadratic through cosines keeps to the budget.
const JUDGE_COSINES: Cost = Cost::new(350, 0, 0);

/// Costs in one channel, in three, and under two lights.
pub const COSTS: [LoopCosts; 3] = [
    LoopCosts { quadratic: Cost::new(1016, 66, 13), cosines: Cost::new(1276, 83, 21), phong: Cost::new(1030, 85, 32) },
    LoopCosts { quadratic: Cost::new(1309, 80, 23), cosines: Cost::new(1118, 81, 32), phong: Cost::new(941, 85, 42) },
    LoopCosts { quadratic: Cost::new(2149, 96, 31), cosines: Cost::new(1678, 97, 64), phong: Cost::new(1193, 96, 70) },
];

/// What quadratics save in each of these styles.
pub(crate) static SAVINGS: [Savings; 3] = {
    let [one, three, two_lights] = COSTS;
    [Savings::of(one), Savings::of(three), Savings::of(two_lights)]
};
