//! Vectors of three `f64`: the host measures and prepares, so it can afford them.

/// A point, direction or colour.
pub type V3 = [f64; 3];

/// a + b.
#[inline]
#[must_use]
pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a - b.
#[inline]
#[must_use]
pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a times s.
#[inline]
#[must_use]
pub fn scale(a: V3, s: f64) -> V3 {
    a.map(|c| c * s)
}

/// Scalar product.
#[inline]
#[must_use]
pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[inline]
#[must_use]
pub fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Length.
#[inline]
#[must_use]
pub fn length(a: V3) -> f64 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`; `None` for a vector without a direction.
#[inline]
#[must_use]
pub fn unit(a: V3) -> Option<V3> {
    let largest = a.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    // Scaled first: the square of a tiny component would vanish. What has no reciprocal is as good as zero.
    let inverse = Some(1.0 / largest).filter(|&inverse| inverse > 0.0 && inverse.is_finite())?;
    let a = scale(a, inverse);
    Some(scale(a, 1.0 / length(a)))
}

/// The matrix with these rows times `v`.
#[inline]
#[must_use]
pub fn apply(rows: &[V3; 3], v: V3) -> V3 {
    rows.map(|row| dot(row, v))
}

/// Rows of the rotation by `angle` about the unit vector `axis`, counter-clockwise seen against the axis.
#[must_use]
pub fn rotation(axis: V3, angle: f64) -> [V3; 3] {
    let (s, c) = libm::sincos(angle);
    let [x, y, z] = axis;
    let d = 1.0 - c;
    [
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
    ]
}

/// Rows of the product of two matrices.
#[must_use]
pub fn product(a: &[V3; 3], b: &[V3; 3]) -> [V3; 3] {
    a.map(|row| [0, 1, 2].map(|k| row[0] * b[0][k] + row[1] * b[1][k] + row[2] * b[2][k]))
}
