//! Polynomials through values at corners, midpoints and thirds.

use microphong_models::vector::V3;

/// The corners, then the midpoints of the edges 0-1, 1-2 and 2-0.
pub(crate) const SIX: [V3; 6] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];

const THIRD: f64 = 1.0 / 3.0;
const TWO: f64 = 2.0 / 3.0;

/// The corners; on each edge the node nearer to its start, then the one nearer to its end; the centroid.
pub(crate) const TEN: [V3; 10] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [TWO, THIRD, 0.0],
    [THIRD, TWO, 0.0],
    [0.0, TWO, THIRD],
    [0.0, THIRD, TWO],
    [THIRD, 0.0, TWO],
    [TWO, 0.0, THIRD],
    [THIRD, THIRD, THIRD],
];

/// Weights of the six nodes: Lagrange's quadratic, `b (2b - 1)` for corners, `4 b b'` for midpoints.
pub(crate) fn quadratic([a, b, c]: V3) -> [f64; 6] {
    let corner = |u: f64| u * (2.0 * u - 1.0);
    [corner(a), corner(b), corner(c), 4.0 * a * b, 4.0 * b * c, 4.0 * c * a]
}

/// Weights of the ten nodes: Lagrange's cubic.
pub(crate) fn cubic([a, b, c]: V3) -> [f64; 10] {
    let corner = |u: f64| u * (3.0 * u - 1.0) * (3.0 * u - 2.0) / 2.0;
    let edge = |near: f64, far: f64| 4.5 * near * far * (3.0 * near - 1.0);
    [corner(a), corner(b), corner(c), edge(a, b), edge(b, a), edge(b, c), edge(c, b), edge(c, a), edge(a, c), 27.0 * a * b * c]
}

/// Sum of `values`, weighted.
pub(super) fn blend<const NODES: usize, const WIDTH: usize>(weights: &[f64; NODES], values: &[[f64; WIDTH]; NODES]) -> [f64; WIDTH] {
    std::array::from_fn(|k| weights.iter().zip(values).map(|(weight, value)| weight * value[k]).sum())
}

/// Sum of plain numbers, weighted.
pub(crate) fn sum<const NODES: usize>(weights: &[f64; NODES], values: &[f64; NODES]) -> f64 {
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}

/// The four triangles between corners and midpoints, as affine coordinates of their corners: one at each corner, which
/// it keeps in its place, and the middle one.
pub(super) const FOUR: [[V3; 3]; 4] =
    [[SIX[0], SIX[3], SIX[5]], [SIX[3], SIX[1], SIX[4]], [SIX[5], SIX[4], SIX[2]], [SIX[3], SIX[4], SIX[5]]];

/// The one of the [`FOUR`] that contains a point, and the point's affine coordinates there.
pub(super) fn quarter([a, b, c]: V3) -> (usize, V3) {
    if a >= 0.5 {
        (0, [2.0 * a - 1.0, 2.0 * b, 2.0 * c])
    } else if b >= 0.5 {
        (1, [2.0 * a, 2.0 * b - 1.0, 2.0 * c])
    } else if c >= 0.5 {
        (2, [2.0 * a, 2.0 * b, 2.0 * c - 1.0])
    } else {
        (3, [1.0 - 2.0 * c, 1.0 - 2.0 * a, 1.0 - 2.0 * b])
    }
}

/// Affine coordinates in the whole triangle of a point of the part with these corners.
pub(super) fn within(part: &[V3; 3], weights: V3) -> V3 {
    blend(&weights, part)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points inside and a little outside.
    fn points() -> impl Iterator<Item = V3> {
        (-2..=12).flat_map(|i| (-2..=12).map(move |j| [f64::from(i) / 10.0, f64::from(j) / 10.0])).map(|[a, b]| [a, b, 1.0 - a - b])
    }

    #[test]
    fn six_nodes_give_back_any_quadratic() {
        let f = |[s, t, _]: V3| 3.0 - 7.0 * s + 2.5 * t + 4.0 * s * s - 9.0 * s * t + 1.25 * t * t;
        let nodes = SIX.map(f);
        points().for_each(|p| assert!((sum(&quadratic(p), &nodes) - f(p)).abs() < 1e-12, "{p:?}"));
    }

    #[test]
    fn ten_nodes_give_back_any_cubic() {
        let f =
            |[s, t, _]: V3| 1.0 + 2.0 * s - t + s * t - 3.0 * t * t + 5.0 * s * s * s - 4.0 * s * s * t + 7.0 * s * t * t - 2.0 * t * t * t;
        let nodes = TEN.map(f);
        points().for_each(|p| assert!((sum(&cubic(p), &nodes) - f(p)).abs() < 1e-11, "{p:?}"));
    }

    #[test]
    fn quarters_tile_the_triangle() {
        for p in points() {
            let (which, inner) = quarter(p);
            let back = within(&FOUR[which], inner);
            assert!((0..3).all(|k| (back[k] - p[k]).abs() < 1e-12), "{p:?}: {which} {inner:?}");
            let inside = |p: V3| p.iter().all(|&w| w >= -1e-12);
            assert!(!inside(p) || inside(inner), "{p:?}: {which} {inner:?}");
        }
    }
}
