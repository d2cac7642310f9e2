//! The terms of a cubic in two variables.

use microphong::math::wide::Wide;

/// Coefficients of a cubic: one array for each power of the first variable, in the order of powers of the second.
#[derive(Clone, Copy, Debug, Default)]
pub struct Terms<T>(pub [T; 4], pub [T; 3], pub [T; 2], pub [T; 1]);

impl Terms<Wide> {
    /// Four times the cubic through ten nodes, see [`super::field::CubicPatch::fit`], measured from corner 0: with `s` and `t` the
    /// gradients of the barycentric coordinates of corners 1 and 2. A term of degree n has n factors of them.
    #[must_use]
    pub fn of(nodes: [Wide; 10], s: [Wide; 2], t: [Wide; 2]) -> Self {
        let [v0, v1, v2, a1, a2, b1, b2, c1, c2, m] = nodes;
        // Symmetric forms in (s, t); the linear and the cubic one are halved.
        let side = |v: Wide, near: Wide, far: Wide| 2 * v - 11 * v0 + 18 * near - 9 * far;
        let [l0, l1] = [side(v1, a1, a2), side(v2, c2, c1)];
        let side = |v: Wide, near: Wide, far: Wide| 36 * v0 - 18 * v - 90 * near + 72 * far;
        let [q0, q2] = [side(v1, a1, a2), side(v2, c2, c1)];
        let q1 = 36 * v0 - 45 * (a1 + c2) + 9 * (a2 + c1 - b1 - b2) + 54 * m;
        let side = |v: Wide, near: Wide, far: Wide| 9 * (v - v0) + 27 * (near - far);
        let mixed = |near: Wide, far: Wide, opposite: Wide, other: Wide| 9 * (2 * (near - m) - v0 - far + opposite + other);
        let [c0, c1, c2, c3] = [side(v1, a1, a2), mixed(a1, a2, b1, c2), mixed(c2, c1, b2, a1), side(v2, c2, c1)];
        // The chain rule, one factor at a time.
        let along = |k: usize| move |a: Wide, b: Wide| a * s[k] + b * t[k];
        let (x, y) = (along(0), along(1));
        let ([qx0, qx1], [qy0, qy1]) = ([x(q0, q1), x(q1, q2)], [y(q0, q1), y(q1, q2)]);
        let ([cx0, cx1, cx2], [cy0, cy1, cy2]) = ([x(c0, c1), x(c1, c2), x(c2, c3)], [y(c0, c1), y(c1, c2), y(c2, c3)]);
        let ([cxx0, cxx1], [cyy0, cyy1]) = ([x(cx0, cx1), x(cx1, cx2)], [y(cy0, cy1), y(cy1, cy2)]);
        Self(
            [4 * v0, 2 * y(l0, l1), y(qy0, qy1), 2 * y(cyy0, cyy1)],
            [2 * x(l0, l1), 2 * y(qx0, qx1), 6 * x(cyy0, cyy1)],
            [x(qx0, qx1), 6 * y(cxx0, cxx1)],
            [2 * x(cxx0, cxx1)],
        )
    }
}

impl<T: Copy> Terms<T> {
    /// `f` of each coefficient and the degree of its term.
    #[inline(always)]
    #[must_use]
    pub fn map<R>(self, f: impl Fn(T, u32) -> R) -> Terms<R> {
        let Self([c, y, yy, yyy], [x, xy, xyy], [xx, xxy], [xxx]) = self;
        Terms([f(c, 0), f(y, 1), f(yy, 2), f(yyy, 3)], [f(x, 1), f(xy, 2), f(xyy, 3)], [f(xx, 2), f(xxy, 3)], [f(xxx, 3)])
    }

    /// Moves the origin along the first variable; `step(a, b)` is `a` plus `b` times the way.
    #[inline(always)]
    #[must_use]
    pub fn moved_across(self, step: impl Fn(T, T) -> T) -> Self {
        self.transposed().moved_down(step).transposed()
    }

    /// Moves the origin along the second variable; `step(a, b)` is `a` plus `b` times the way.
    #[inline(always)]
    #[must_use]
    pub fn moved_down(self, step: impl Fn(T, T) -> T) -> Self {
        let Self(cubic, quadratic, linear, constant) = self;
        Self(moved(cubic, &step), moved_quadratic(quadratic, &step), [step(linear[0], linear[1]), linear[1]], constant)
    }

    /// The terms with the variables exchanged.
    fn transposed(self) -> Self {
        let Self([c, y, yy, yyy], [x, xy, xyy], [xx, xxy], [xxx]) = self;
        Self([c, x, xx, xxx], [y, xy, xxy], [yy, xyy], [yyy])
    }
}

/// A cubic in one variable from another origin: Horner's rule, once for each derivative.
#[inline(always)]
pub fn moved<T: Copy>([c, x, xx, xxx]: [T; 4], step: &impl Fn(T, T) -> T) -> [T; 4] {
    let xx = step(xx, xxx);
    let x = step(x, xx);
    let [x_moved, xx_moved, _] = moved_quadratic([x, xx, xxx], step);
    [step(c, x), x_moved, xx_moved, xxx]
}

/// [`moved`] of a quadratic.
#[inline(always)]
fn moved_quadratic<T: Copy>([c, x, xx]: [T; 3], step: &impl Fn(T, T) -> T) -> [T; 3] {
    let x = step(x, xx);
    [step(c, x), step(x, xx), xx]
}
