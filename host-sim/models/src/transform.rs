//! Transforms, by which formats with several objects say where these stand.

use crate::vector::{V3, add, apply, cross, dot, product, scale};

/// A linear map and a translation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transform {
    rows: [V3; 3],
    to: V3,
}

impl Transform {
    /// Nothing moves.
    pub(crate) const NONE: Self = Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], to: [0.0; 3] };
    /// All becomes zero.
    pub(crate) const NOTHING: Self = Self { rows: [[0.0; 3]; 3], to: [0.0; 3] };

    /// The transform of a matrix of four columns, of which the last row is 0, 0, 0, 1.
    pub(crate) fn of_columns(columns: &[[f64; 4]; 4]) -> Self {
        Self { rows: [0, 1, 2].map(|row| [0, 1, 2].map(|column| columns[column][row])), to: [0, 1, 2].map(|row| columns[3][row]) }
    }

    /// First `inner`, then this.
    pub(crate) fn then(&self, inner: &Self) -> Self {
        Self { rows: product(&self.rows, &inner.rows), to: self.point(inner.to) }
    }

    /// Adds a share of another transform.
    pub(crate) fn plus(&self, other: &Self, share: f64) -> Self {
        let sum = |a: V3, b: V3| add(a, scale(b, share));
        Self { rows: [0, 1, 2].map(|row| sum(self.rows[row], other.rows[row])), to: sum(self.to, other.to) }
    }

    /// Where a point comes to lie.
    pub(crate) fn point(&self, point: V3) -> V3 {
        add(apply(&self.rows, point), self.to)
    }

    /// Whether directions change.
    pub(crate) fn turns(&self) -> bool {
        self.rows != Self::NONE.rows
    }

    /// Turns normals: the inverse transpose, but for a factor that is not negative.
    pub(crate) fn of_normals(&self) -> [V3; 3] {
        let [a, b, c] = self.rows;
        let sign = if self.mirrors() { -1.0 } else { 1.0 };
        [cross(b, c), cross(c, a), cross(a, b)].map(|row| scale(row, sign))
    }

    /// Whether the order of corners turns around.
    pub(crate) fn mirrors(&self) -> bool {
        let [a, b, c] = self.rows;
        dot(a, cross(b, c)) < 0.0
    }
}
