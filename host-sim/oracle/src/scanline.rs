//! Rows of a triangle: their ends on the edges, and interpolation along both.

use microphong_models::vector::{V3, add, dot, scale};

/// The point at which a row leaves the triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// Corner at which the edge begins.
    from: usize,
    /// Corner at which it ends.
    to: usize,
    /// Place along the edge, in [0, 1].
    along: f64,
    /// Column.
    pub(super) x: f64,
}

/// A row between its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// The end with the smaller x.
    pub(super) left: End,
    /// The other one.
    pub(super) right: End,
}

impl End {
    /// On the edge between two corners, at height `y`.
    fn new(screen: &[[f64; 2]; 3], from: usize, to: usize, y: f64) -> Self {
        let ([x0, y0], [x1, y1]) = (screen[from], screen[to]);
        let along = if y1 > y0 { ((y - y0) / (y1 - y0)).clamp(0.0, 1.0) } else { 0.0 };
        Self { from, to, along, x: x0 + along * (x1 - x0) }
    }

    /// Linear between the corners' values.
    pub(super) fn lerp(&self, v: &[V3; 3]) -> V3 {
        lerp(v[self.from], v[self.to], self.along)
    }

    /// On the great circle between the corners' values.
    pub(super) fn slerp(&self, v: &[V3; 3]) -> V3 {
        slerp(v[self.from], v[self.to], self.along)
    }
}

impl Span {
    /// The row of height `y`; rows above and below the triangle are its first and last.
    pub(super) fn new(screen: &[[f64; 2]; 3], y: f64) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| screen[i][1].total_cmp(&screen[j][1]));
        let [top, middle, bottom] = order;
        let y = y.clamp(screen[top][1], screen[bottom][1]);
        let long = End::new(screen, top, bottom, y);
        let short = if y < screen[middle][1] { End::new(screen, top, middle, y) } else { End::new(screen, middle, bottom, y) };
        let beside = End::new(screen, top, bottom, screen[middle][1]);
        if beside.x <= screen[middle][0] { Self { left: long, right: short } } else { Self { left: short, right: long } }
    }

    /// Place of a column between the left and the right end, in [0, 1].
    pub(super) fn along(&self, x: f64) -> f64 {
        let width = self.right.x - self.left.x;
        if width > 0.0 { ((x - self.left.x) / width).clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// (1 - t) a + t b.
pub(super) fn lerp(a: V3, b: V3, t: f64) -> V3 {
    add(scale(a, 1.0 - t), scale(b, t))
}

/// The unit vector a share `t` of the way along the great circle from `a` to `b`, both of unit length (Shoemake 1985).
pub(super) fn slerp(a: V3, b: V3, t: f64) -> V3 {
    let angle = dot(a, b).clamp(-1.0, 1.0).acos();
    let sine = angle.sin();
    // Where the circle is too short to be seen, or not one but many.
    if sine < 1e-7 {
        return lerp(a, b, t);
    }
    add(scale(a, ((1.0 - t) * angle).sin() / sine), scale(b, (t * angle).sin() / sine))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_end_on_the_edges() {
        let screen = [[0.0, 0.0], [6.0, 4.0], [-2.0, 8.0]];
        for (y, left, right) in [(0.0, 0.0, 0.0), (2.0, -0.5, 3.0), (4.0, -1.0, 6.0), (6.0, -1.5, 2.0), (9.0, -2.0, -2.0)] {
            for turn in 0..3 {
                let span = Span::new(&[0, 1, 2].map(|k| screen[(k + turn) % 3]), y);
                assert_eq!((span.left.x, span.right.x), (left, right), "{y}");
            }
        }
    }

    #[test]
    fn great_circles_are_walked_evenly() {
        let (a, b) = ([1.0, 0.0, 0.0], [0.0, 0.6, 0.8]);
        for t in [0.0, 0.25, 0.5, 1.0] {
            let v = slerp(a, b, t);
            assert!((dot(v, v) - 1.0).abs() < 1e-12);
            assert!((dot(v, a).acos() - t * std::f64::consts::FRAC_PI_2).abs() < 1e-7);
        }
    }
}
