//! Light as a function of an angle: along a row the normal turns evenly, and cos^s of the angle to L or H is three
//! parabolas (Kuijk and Blake 1989; Disselkoen 1991).

use super::Decide;
use crate::{
    Facet, Frame, Light, Shade,
    poly::{SIX, quadratic, sum},
    scanline::{End, Span},
    scene::direction,
};
use microphong_models::vector::{V3, add, cross, dot, scale};

/// Half widths of the parabolas for an exponent: of the middle one, and of all three.
pub(crate) type Widths = fn(f64) -> [f64; 2];

/// Kuijk and Blake's fit, as printed.
pub(crate) fn printed(s: f64) -> [f64; 2] {
    [(s + 5.6) / (s * (0.09 * s + 5.2)), (s + 65.0) / (5.0 * s + 31.7)]
}

/// A better one: wrong by 0.0143 at most for 8 to 512, 0.024 for 1.
pub(crate) fn refitted(s: f64) -> [f64; 2] {
    if s <= 1.0 { [1.3545, 1.6861] } else { [(0.7535 + 0.55 / s) / s.sqrt(), (2.992 - 1.33 / s) / s.sqrt()] }
}

/// cos^s by three parabolas that join smoothly: `1 - θ²/(ab)` up to a, `(b - |θ|)²/(b (b - a))` up to b, then none.
pub(crate) fn parabolas(angle: f64, [a, b]: [f64; 2]) -> f64 {
    let angle = angle.abs();
    if angle <= a {
        1.0 - angle * angle / (a * b)
    } else if angle < b {
        (b - angle).powi(2) / (b * (b - a))
    } else {
        0.0
    }
}

/// Squared sine of an angle below which two normals have no plane, 2^-18: rounded normals cannot tell it.
const SHORT: f64 = 1.0 / (1u64 << 18) as f64;

/// [`along`], or linear where there is hardly any angle between the normals, so no plane either. The parabolas differ from the power itself, so light
/// jumps where the one changes to the other. The squared sine decides. Its distance from [`SHORT`] is passed to `decide` in units of 1/255 of `SHORT`.
fn along_row([l, r]: [V3; 2], v: V3, t: f64, s: f64, widths: Widths, decide: &Decide<'_>) -> f64 {
    let (ll, lr, rr) = (dot(l, l), dot(l, r), dot(r, r));
    if decide(255.0 * ((ll * rr - lr * lr) / (SHORT * ll * rr).max(f64::MIN_POSITIVE) - 1.0)) {
        return along([l, r], v, t, s, widths);
    }
    let end = |cosine: f64, square: f64| (cosine / square.sqrt().max(1e-6)).max(0.0).powf(s);
    end(dot(l, v), ll) * (1.0 - t) + end(dot(r, v), rr) * t
}

/// `cos^s` of the angle to `v`, a share `t` of the way from the normal `l` to `r`, of any lengths.
///
/// On their great circle the cosine is `Γ cos(θ - α)`, θ running from 0 to the angle between them:
/// `Γ² = (rr lv² - 2 lv lr rv + ll rv²)/(ll rr - lr²)`, `α = atan2(ll rv - lr lv, lv sqrt(ll rr - lr²))`.
pub(crate) fn along([l, r]: [V3; 2], v: V3, t: f64, s: f64, widths: Widths) -> f64 {
    let (ll, lr, rr, lv, rv) = (dot(l, l), dot(l, r), dot(r, r), dot(l, v), dot(r, v));
    let area = ll * rr - lr * lr;
    let gamma = ((rr * lv * lv - 2.0 * lv * lr * rv + ll * rv * rv) / area).clamp(0.0, 1.0);
    let alpha = (ll * rv - lr * lv).atan2(lv * area.sqrt());
    let whole = (lr / (ll * rr).sqrt()).clamp(-1.0, 1.0).acos();
    gamma.powf(s / 2.0) * parabolas(whole * t - alpha, widths(s))
}

/// `normal` turned by the rotation that takes the unit vector `from` to `to`: `n c + k × n + k (k·n)/(1 + c)`, where
/// `k = from × to` and `c = from·to`.
fn turned(normal: V3, from: V3, to: V3) -> V3 {
    let (k, c) = (cross(from, to), dot(from, to));
    add(add(scale(normal, c), cross(k, normal)), scale(k, dot(k, normal) / (1.0 + c).max(1e-6)))
}

/// A triangle with one direction, whose normals are turned so that each corner sees this direction as it saw its own (Kuijk and Blake). Nothing turns
/// where the direction is constant.
#[derive(Clone, Copy, Debug)]
struct Turned {
    normals: [V3; 3],
    direction: V3,
}

impl Turned {
    fn new(facet: &Facet, towards: impl Fn(V3) -> V3) -> Self {
        let direction = towards(facet.position(Facet::CENTRE));
        Self { normals: [0, 1, 2].map(|k| turned(facet.normals[k], towards(facet.positions[k]), direction)), direction }
    }
}

/// Normals on great circles along the edges, diffuse light as the highlight, with the exponent 1.
pub(super) fn angular<'f>(frame: &'f Frame, facet: &'f Facet, widths: Widths, decide: &'f Decide<'f>) -> Shade<'f> {
    let exponent = frame.material(facet).exponent;
    let turn = |light: &Light| {
        let unit = |turned: Turned| Turned { normals: turned.normals.map(direction), ..turned };
        [Turned::new(facet, |p| frame.rays(light, p).light), Turned::new(facet, |p| frame.rays(light, p).half)].map(unit)
    };
    let lights: Vec<[Turned; 2]> = frame.lights.iter().map(turn).collect();
    Box::new(move |[x, y]| {
        let span = Span::new(&facet.screen, y);
        let power = |field: &Turned, s: f64| {
            let ends = [span.left, span.right].map(|end| end.slerp(&field.normals));
            along_row(ends, field.direction, span.along(x), s, widths, decide)
        };
        frame.levels(facet, facet.at([x, y]), lights.iter().map(|[diffuse, half]| [power(diffuse, 1.0), power(half, exponent)]))
    })
}

/// Normals linear along the edges, diffuse light by the six-point fit of N·L.
pub(super) fn hybrid<'f>(frame: &'f Frame, facet: &'f Facet, widths: Widths, decide: &'f Decide<'f>) -> Shade<'f> {
    let exponent = frame.material(facet).exponent;
    let prepare = |light: &Light| {
        let diffuse = SIX.map(|node| dot(facet.node(node), light.place.from(facet.position(node))));
        (diffuse, Turned::new(facet, |p| frame.rays(light, p).half))
    };
    let lights: Vec<([f64; 6], Turned)> = frame.lights.iter().map(prepare).collect();
    Box::new(move |[x, y]| {
        let (span, weights) = (Span::new(&facet.screen, y), quadratic(facet.weights([x, y])));
        let power = |field: &Turned| {
            let ends = [span.left, span.right].map(|end: End| end.lerp(&field.normals));
            along_row(ends, field.direction, span.along(x), exponent, widths, decide)
        };
        frame.levels(facet, facet.at([x, y]), lights.iter().map(|(diffuse, half)| [sum(&weights, diffuse), power(half)]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use microphong_models::vector::unit;
    use std::f64::consts::FRAC_PI_2;

    /// Largest difference of the parabolas to cos^s.
    fn worst(s: f64, widths: Widths) -> f64 {
        let angles = (0..=20_000).map(|k| FRAC_PI_2 * f64::from(k) / 20_000.0);
        angles.map(|angle| (parabolas(angle, widths(s)) - angle.cos().powf(s)).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn three_parabolas_are_almost_a_power_of_the_cosine() {
        let refit = (8..=512).map(|s| worst(s.into(), refitted)).fold(0.0, f64::max);
        assert!((0.0140..0.0145).contains(&refit), "{refit}");
        assert!((worst(1.0, refitted) - 0.024).abs() < 0.001, "{}", worst(1.0, refitted));
        for (s, error) in [(1.0, 0.0523), (2.0, 0.041), (128.0, 0.058), (512.0, 0.264)] {
            assert!((worst(s, printed) - error).abs() < 0.01 * error + 0.0005, "{s}: {}", worst(s, printed));
        }
    }

    #[test]
    fn parabolas_join_smoothly() {
        for s in [1.0, 5.0, 50.0, 1024.0] {
            for widths in [printed, refitted] {
                let [a, b] = widths(s);
                for joint in [a, b] {
                    let [before, at, after] = [-1e-6, 0.0, 1e-6].map(|step| parabolas(joint + step, [a, b]));
                    assert!((after - 2.0 * at + before).abs() < 1e-9, "{s}: {before} {at} {after}");
                }
            }
        }
    }

    /// With the exponent 1 and a cosine instead of the parabolas, the formula is exact: a great circle is walked evenly.
    #[test]
    fn angles_are_those_of_the_great_circle() {
        let [l, r, v] = [[0.2, 0.3, 1.0], [-0.5, 0.1, 0.9], [0.4, -0.3, 0.8]].map(|v| unit(v).unwrap());
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            let exact = dot(crate::scanline::slerp(l, r, t), v).powi(40);
            // Normals of any length, near a fine approximation.
            let found = along([scale(l, 0.7), scale(r, 1.3)], v, t, 40.0, refitted);
            assert!((found - exact).abs() < 0.0143 + 1e-6, "{t}: {found} {exact}");
        }
    }

    #[test]
    fn turning_takes_one_direction_to_the_other() {
        let [from, to, normal] = [[0.2, 0.3, 1.0], [-0.5, 0.1, 0.9], [0.4, -0.3, 0.8]].map(|v| unit(v).unwrap());
        let moved = turned(from, from, to);
        assert!((0..3).all(|k| (moved[k] - to[k]).abs() < 1e-12));
        // A rotation: the normal sees the new direction as it saw the old one.
        assert!((dot(turned(normal, from, to), to) - dot(normal, from)).abs() < 1e-12);
        assert!((dot(turned(normal, from, to), turned(normal, from, to)) - 1.0).abs() < 1e-12);
    }
}
