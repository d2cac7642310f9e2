//! The ways to draw a triangle, and when interpolation of the levels at its corners is one.

use crate::{
    features::PERSPECTIVE,
    format::{ErrorBudget, FULL, LARGEST_BUDGET, LEVEL},
    method::{TriangleSetup, auto::error_bound::Interval},
    raster::counts::Counts,
};

/// A way to draw a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// One colour: the mean of the extremes at the corners, raised by these levels, Q9.7.
    Solid(i32),
    /// Linear interpolation between the corners, raised by these levels, Q9.7.
    Linear(i32),
    /// Levels at six nodes, interpolated quadratically.
    Quadratic,
    /// Cosines at six nodes, interpolated quadratically; highlights are looked up at the pixel.
    Cosines,
    /// Phong shading.
    Phong,
}

impl Choice {
    /// The choice in 16 bits, not all of which are 0, for the bands below. Levels by which light is raised are at most the largest budget.
    pub(super) fn packed(self) -> u16 {
        const { assert!((LARGEST_BUDGET.to_bits() as u32) << (LEVEL - ErrorBudget::FRAC_NBITS) < 1 << 12) };
        let (kind, raise) = match self {
            Self::Solid(raise) => (1, raise),
            Self::Linear(raise) => (2, raise),
            Self::Quadratic => (3, 0),
            Self::Cosines => (4, 0),
            Self::Phong => (5, 0),
        };
        (raise << 3) as u16 | kind
    }

    /// The choice that has been packed; `None` if there is none.
    pub(super) fn unpacked(bits: u16) -> Option<Self> {
        let raise = i32::from(bits as i16 >> 3);
        match bits & 7 {
            1 => Some(Self::Solid(raise)),
            2 => Some(Self::Linear(raise)),
            3 => Some(Self::Quadratic),
            4 => Some(Self::Cosines),
            5 => Some(Self::Phong),
            _ => None,
        }
    }

    /// The count of triangles that are drawn in this way.
    pub(super) fn count(self, counts: &mut Counts) -> &mut u32 {
        let [solid, linear, quadratic, cosines, phong] = &mut counts.choices;
        match self {
            Self::Solid(_) => solid,
            Self::Linear(_) => linear,
            Self::Quadratic => quadratic,
            Self::Cosines => cosines,
            Self::Phong => phong,
        }
    }
}

/// Whether a level of the corners may have been clamped at 255.
#[inline]
pub(super) fn is_clamped(levels: &[[i32; 3]; 3]) -> bool {
    levels.as_flattened().iter().any(|&level| level >= FULL)
}

/// By how much levels are raised so that linear interpolation, whose errors lie in `interval`, keeps to the budget; `None` if it does not in
/// perspective. Levels at the corners differ by `range`.
#[inline]
pub(super) fn linear_raise(setup: &TriangleSetup<'_>, interval: Interval, budget: u32, range: impl FnOnce() -> u32) -> Option<i32> {
    if !PERSPECTIVE || !setup.perspective {
        return Some(interval.raise(budget));
    }
    let rest = budget.checked_sub(setup.plane_error(range()))?;
    (interval.half() <= rest).then(|| interval.raise(rest))
}
