//! Light as a function of an angle: along a row the normal turns evenly, and cos^s of the angle to L or H is three
//! parabolas (Kuijk and Blake 1989; Disselkoen 1991).

use crate::{
    oracle::{
        Facet, Frame, Light, Shade,
        frame::direction,
        poly::{SIX, quadratic, sum},
        scanline::{End, Span},
    },
    vector::{V3, add, cross, dot, scale},
};

/// Half widths of the parabolas for an exponent: of the middle one, and of all three.
pub(super) type Widths = fn(f64) -> [f64; 2];

/// Kuijk and Blake's fit, as printed.
pub(super) fn printed(s: f64) -> [f64; 2] {
    [(s + 5.6) / (s * (0.09 * s + 5.2)), (s + 65.0) / (5.0 * s + 31.7)]
}

/// A better one: wrong by 0.0143 at most for 8 to 512, 0.024 for 1.
pub(super) fn refitted(s: f64) -> [f64; 2] {
    if s <= 1.0 { [1.3545, 1.6861] } else { [(0.7535 + 0.55 / s) / s.sqrt(), (2.992 - 1.33 / s) / s.sqrt()] }
}

/// cos^s by three parabolas that join smoothly: `1 - θ²/(ab)` up to a, `(b - |θ|)²/(b (b - a))` up to b, then none.
pub(super) fn parabolas(angle: f64, [a, b]: [f64; 2]) -> f64 {
    let angle = angle.abs();
    if angle <= a {
        1.0 - angle * angle / (a * b)
    } else if angle < b {
        (b - angle).powi(2) / (b * (b - a))
    } else {
        0.0
    }
}

/// `cos^s` of the angle to `v`, a share `t` of the way from the normal `l` to `r`, of any lengths.
///
/// On their great circle the cosine is `Γ cos(θ - α)`, θ running from 0 to the angle between them:
/// `Γ² = (rr lv² - 2 lv lr rv + ll rv²)/(ll rr - lr²)`, `α = atan2(ll rv - lr lv, lv sqrt(ll rr - lr²))`.
fn along([l, r]: [V3; 2], v: V3, t: f64, s: f64, widths: Widths) -> f64 {
    let (ll, lr, rr, lv, rv) = (dot(l, l), dot(l, r), dot(r, r), dot(l, v), dot(r, v));
    let area = ll * rr - lr * lr;
    if area <= 1e-14 * ll * rr {
        // Hardly any angle between them: linear.
        let end = |cosine: f64, square: f64| (cosine / square.sqrt().max(1e-6)).max(0.0).powf(s);
        return end(lv, ll) * (1.0 - t) + end(rv, rr) * t;
    }
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

/// One direction for the whole triangle, and normals turned so that each corner sees it as it saw its own (Kuijk and
/// Blake). Nothing turns where the direction is constant.
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
pub(super) fn angular<'f>(frame: &'f Frame, facet: &'f Facet, widths: Widths) -> Shade<'f> {
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
            along(ends, field.direction, span.along(x), s, widths)
        };
        frame.levels(facet, lights.iter().map(|[diffuse, half]| [power(diffuse, 1.0), power(half, exponent)]))
    })
}

/// Normals linear along the edges, diffuse light by the six-point fit of N·L.
pub(super) fn hybrid<'f>(frame: &'f Frame, facet: &'f Facet, widths: Widths) -> Shade<'f> {
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
            along(ends, field.direction, span.along(x), exponent, widths)
        };
        frame.levels(facet, lights.iter().map(|(diffuse, half)| [sum(&weights, diffuse), power(half)]))
    })
}
