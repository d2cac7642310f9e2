//! Costs of the ways to draw a triangle, by which `auto` chooses.
//!
//! Costs are set-up for each triangle, the rest of each row, and the inner loop for each pixel, as `microphong bench` counts them. The choice is the
//! same on every machine, and so are the pictures. So costs are means of three processors. An instruction counts 1 on a Cortex-M3, 0.72 on a RISC-V
//! processor, and 0.49 on a Cortex-M0+: the reciprocal of how many of them a frame takes, relative to the Cortex-M3. With these weights, the sum of frame
//! times, each divided by the usual frame time of its processor, is least. A table of the Cortex-M3 alone, which has kernels for Phong shading, would
//! save up to 9 % of its frames, and cost the Pico up to 14 %.
//!
//! Costs are also means of two scenes: one with large triangles and one with small ones. These are `peer-sphere` and `teapot` in one channel,
//! `peer-sphere-plastic` and `torus` in three, and `peer-sphere-lights` and `bunny` under two lights. `tests/suite/choices.rs` counts everything again
//! that can be drawn alone. The quadratic through cosines cannot: the method `sqrt6` takes more set-up.

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

/// Cost of finding out whether a quadratic through levels keeps to the budget, with a share of what is spent in vain.
const JUDGE_QUADRATIC: Cost = Cost::new(700, 0, 0);
/// Cost of finding out whether a quadratic through cosines keeps to the budget.
const JUDGE_COSINES: Cost = Cost::new(500, 0, 0);

/// Costs in one channel, in three, and under two lights.
pub const COSTS: [LoopCosts; 3] = [
    LoopCosts { quadratic: Cost::new(1419, 69, 15), cosines: Cost::new(1890, 89, 26), phong: Cost::new(1582, 71, 45) },
    LoopCosts { quadratic: Cost::new(1834, 92, 27), cosines: Cost::new(1650, 88, 42), phong: Cost::new(1420, 72, 58) },
    LoopCosts { quadratic: Cost::new(3099, 121, 35), cosines: Cost::new(2590, 129, 86), phong: Cost::new(1719, 94, 101) },
];

/// What the quadratics through levels and through cosines save in each of these styles, compared with Phong shading.
pub(crate) static SAVINGS: [[Cost; 2]; 3] = {
    const fn of(LoopCosts { quadratic, cosines, phong }: LoopCosts) -> [Cost; 2] {
        [phong.minus(quadratic).minus(JUDGE_QUADRATIC), phong.minus(cosines).minus(JUDGE_COSINES)]
    }
    let [one, three, two_lights] = COSTS;
    [of(one), of(three), of(two_lights)]
};
