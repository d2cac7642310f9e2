//! N·L and N·H by their second-order Taylor expansion about the centroid (Bishop and Weimer 1986, infinite eye).

use crate::{Facet, Frame, Shade};
use microphong_models::vector::{V3, dot, length, sub};

/// The expansion of `v·N / |N|` at `N = c + m`, about `c`:
///
/// `T = a/s + v·m/s - a (c·m)/s³ + 3a (c·m)²/(2 s⁵) - (v·m)(c·m)/s³ - a (m·m)/(2 s³)`, where `a = v·c`, `s = |c|`,
/// at least 1/16. Far from the centroid the expansion leaves [-1, 1]; more than 1 counts as 1.
pub(super) fn expansion(v: V3, c: V3, m: V3) -> f64 {
    let (a, s) = (dot(v, c), length(c).max(1.0 / 16.0));
    let (vm, cm, mm) = (dot(v, m), dot(c, m), dot(m, m));
    a / s + vm / s - a * cm / s.powi(3) + 3.0 * a * cm * cm / (2.0 * s.powi(5)) - vm * cm / s.powi(3) - a * mm / (2.0 * s.powi(3))
}

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let centre = facet.normal(Facet::CENTRE);
    let rays: Vec<_> = frame.lights.iter().map(|light| frame.rays(light, facet.position(Facet::CENTRE))).collect();
    Box::new(move |p| {
        let away = sub(facet.normal(facet.weights(p)), centre);
        frame.lit(facet, facet.at(p), rays.iter().map(|rays| [rays.light, rays.half].map(|v| expansion(v, centre, away).min(1.0))))
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use microphong_models::vector::{add, scale, unit};

    /// Step of the differences.
    const STEP: f64 = 1e-3;

    /// Value, gradient and second derivatives at the origin by central differences, exact for quadratics.
    fn derivatives(f: &impl Fn(f64, f64) -> f64) -> [f64; 6] {
        let (h, at) = (STEP, |x: i32, y: i32| f(f64::from(x) * STEP, f64::from(y) * STEP));
        [
            at(0, 0),
            (at(1, 0) - at(-1, 0)) / (2.0 * h),
            (at(0, 1) - at(0, -1)) / (2.0 * h),
            (at(1, 0) - 2.0 * at(0, 0) + at(-1, 0)) / (h * h),
            (at(0, 1) - 2.0 * at(0, 0) + at(0, -1)) / (h * h),
            (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4.0 * h * h),
        ]
    }

    /// Whether `polynomial` is the second-order expansion of `function` about the origin.
    pub(in crate::method) fn expands(polynomial: impl Fn(f64, f64) -> f64, function: impl Fn(f64, f64) -> f64) -> Result<(), String> {
        let (found, exact) = (derivatives(&polynomial), derivatives(&function));
        if found.iter().zip(exact).all(|(f, e)| (f - e).abs() <= 1e-5 * (1.0 + e.abs())) {
            Ok(())
        } else {
            Err(format!("1, x, y, xx, yy, xy: {found:.5?}, not {exact:.5?}"))
        }
    }

    /// A linear field of normals `c + a x + b y`, and a direction.
    const FIELD: [V3; 3] = [[0.3, -0.2, 0.85], [0.4, 0.1, -0.3], [-0.2, 0.5, 0.25]];
    const TOWARDS: V3 = [-0.4, 0.5, 0.77];

    fn at([c, a, b]: [V3; 3], x: f64, y: f64) -> V3 {
        add(c, add(scale(a, x), scale(b, y)))
    }

    fn exact(x: f64, y: f64) -> f64 {
        let n = at(FIELD, x, y);
        dot(n, TOWARDS) / length(n)
    }

    /// The paper's coefficients of `t5 x² + t4 xy + t3 y² + t2 x + t1 y + t0`, with one mistake or none.
    fn paper(mistake: &str) -> impl Fn(f64, f64) -> f64 {
        let [origin, across, down] = FIELD;
        let [a, b, c] = [across, down, origin].map(|v| dot(v, TOWARDS));
        let (d, e, f) = (dot(across, across), 2.0 * dot(across, down), dot(down, down));
        let (g, h, i) = (2.0 * dot(across, origin), 2.0 * dot(down, origin), dot(origin, origin));
        let (s, square) = (i.sqrt(), 8.0 * i * i * i.sqrt());
        let first = if mistake == "3 i g²" { 3.0 * i * g * g } else { 3.0 * c * g * g };
        let mixed = if mistake == "4 b g i" { 4.0 } else { 2.0 };
        let sign = if mistake == "+ 4 c f i" { -1.0 } else { 1.0 };
        let linear = if mistake == "3 b i" { 3.0 } else { 2.0 };
        let t = [
            c / s,
            (linear * b * i - c * h) / (2.0 * i * s),
            (2.0 * a * i - c * g) / (2.0 * i * s),
            (3.0 * c * h * h - sign * 4.0 * c * f * i - 4.0 * b * h * i) / square,
            2.0 * (3.0 * c * g * h - 2.0 * c * e * i - mixed * b * g * i - 2.0 * a * h * i) / square,
            (first - 4.0 * c * d * i - 4.0 * a * g * i) / square,
        ];
        move |x, y| t[5] * x * x + t[4] * x * y + t[3] * y * y + t[2] * x + t[1] * y + t[0]
    }

    #[test]
    fn the_expansion_is_that_of_the_cosine() {
        let found = |x, y| expansion(TOWARDS, FIELD[0], sub(at(FIELD, x, y), FIELD[0]));
        expands(found, exact).unwrap();
        expands(paper(""), exact).unwrap();
    }

    /// The check above finds what was misprinted in the paper and in quotations of it, and wrong factors.
    #[test]
    fn mistakes_are_found() {
        for mistake in ["3 i g²", "4 b g i", "+ 4 c f i", "3 b i"] {
            assert!(expands(paper(mistake), exact).is_err(), "{mistake}");
        }
        // 3 a (c·m)² without its half, and a forgotten term.
        let (c, s) = (FIELD[0], length(FIELD[0]));
        let away = |x, y| sub(at(FIELD, x, y), c);
        let wrong = |x, y| expansion(TOWARDS, c, away(x, y)) + 1.5 * dot(TOWARDS, c) * dot(c, away(x, y)).powi(2) / s.powi(5);
        assert!(expands(wrong, exact).is_err());
        let without = |x, y| expansion(TOWARDS, c, away(x, y)) + dot(TOWARDS, away(x, y)) * dot(c, away(x, y)) / s.powi(3);
        assert!(expands(without, exact).is_err());
    }

    /// The expansion that a triangle is shaded by lies about its centroid, whatever its shape.
    #[test]
    fn triangles_are_expanded_about_their_centroid() {
        let normals = [[-0.3, -0.2, 1.0], [0.35, -0.1, 1.0], [0.0, 0.4, 1.0]].map(|v| unit(v).unwrap());
        let facet = Facet::new([[10.0, 90.0], [40.0, 5.0], [95.0, 70.0]], [0, 1, 2], normals, [[0.0; 3]; 3]);
        let weights = |x: f64, y: f64| facet.weights([145.0 / 3.0 + 50.0 * x, 55.0 + 50.0 * y]);
        let centre = facet.normal(Facet::CENTRE);
        let found = |x, y| expansion(TOWARDS, centre, sub(facet.normal(weights(x, y)), centre));
        let exact = |x, y| dot(facet.normal(weights(x, y)), TOWARDS) / length(facet.normal(weights(x, y)));
        expands(found, exact).unwrap();
    }
}
