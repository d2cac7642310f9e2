//! Light as a function of an angle (Disselkoen 1991, after Kuijk and Blake 1989).

use super::{Claim, Random, Source, Topic, Value, Verdict, bishop_weimer, direction, largest};
use crate::angular::{Widths, along, parabolas, printed, refitted};
use microphong_models::vector::{V3, add, cross, dot, length, scale, sub};
use std::{collections::HashMap, f64::consts::FRAC_PI_2};

const ANGULAR: Source = Source(Topic::Disselkoen, "3, after Kuijk & Blake 1989");
const REFIT: Source = Source(Topic::Disselkoen, "3, our a(s) and b(s)");
const DIFFERENCES: Source = Source(Topic::Disselkoen, "2");
const PLANES: Source = Source(Topic::Disselkoen, "4");
const FAST: Source = Source(Topic::Disselkoen, "4.2");
const ALPHA: Source = Source(Topic::Disselkoen, "6");
const AREA: Source = Source(Topic::Disselkoen, "9, anti-aliasing");
const CODE: Source = Source(Topic::Disselkoen, "12, code");
const SYMBOLS: Source = Source(Topic::Disselkoen, "12, list of symbols");

pub(super) fn claims() -> Vec<Claim> {
    let mut claims = fit();
    claims.extend(refit());
    claims.extend(small());
    claims.extend(bishop_weimer::quoted());
    claims.extend(alpha());
    claims.extend(symbols());
    claims.extend(code());
    claims.extend(area());
    claims
}

/// Signed errors of the parabolas against cos^s, from -90 to 90 degrees.
fn deviations(s: u32, widths: Widths) -> impl Iterator<Item = f64> {
    const STEPS: i32 = 2000;
    let fit = widths(s.into());
    (-STEPS..=STEPS).map(move |k| {
        let angle = FRAC_PI_2 * f64::from(k) / f64::from(STEPS);
        parabolas(angle, fit) - angle.cos().max(0.0).powi(s as i32)
    })
}

/// The largest.
fn worst(s: u32, widths: Widths) -> f64 {
    largest(deviations(s, widths).map(f64::abs))
}

/// The mean over angles and exponents.
fn mean(measure: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for s in 1..=128 {
        for error in deviations(s, printed) {
            sum += measure(error);
            count += 1.0;
        }
    }
    sum / count
}

/// cos^s by three parabolas: "largest error 0.05 at s = 1, average 0.0006".
fn fit() -> Vec<Claim> {
    let paper = 0.05;
    let mut claims: Vec<_> = [1, 2, 4, 8, 16, 32, 64, 100, 128, 512]
        .map(|s| {
            let ours = worst(s, printed);
            let (text, verdict) = if s == 1 {
                (Value::from(paper), Verdict::at_most((ours - paper).abs(), 0.005, 0.01))
            } else {
                (Value::from("<= 0.05"), Verdict::at_most(ours, paper, 0.06))
            };
            let note = match (s, verdict) {
                (1, _) => "At right angles to the light, where cosine and light should be zero.",
                (512, _) => "The fit was made for smaller exponents; b tends to 1/5 instead of to zero.",
                (_, Verdict::Confirmed) => "Within his largest error.",
                _ => "The largest error is not at s = 1.",
            };
            ANGULAR.claim(format!("cos^s by three parabolas: worst at s = {s}"), "", text, ours, (verdict, note))
        })
        .into();
    let signed = mean(|error| error);
    let absolute = mean(f64::abs);
    let near = |ours: f64| Verdict::at_most((ours - 0.0006).abs(), 0.0001, 0.0003);
    let note = "With their signs the errors cancel: his average is this one.";
    claims.push(ANGULAR.claim("average error over s = 1 to 128, signed", "", 0.0006, signed, (near(signed), note)));
    let note = "Without signs it is five times what he says.";
    claims.push(ANGULAR.claim("average error over s = 1 to 128, absolute", "", 0.0006, absolute, (near(absolute), note)));
    claims
}

/// The refitted widths.
fn refit() -> [Claim; 3] {
    // Up to the last digit that is said.
    let claim = |what: &str, paper: f64, digit: f64, ours: f64| {
        let verdict = Verdict::at_most(ours - paper, digit / 2.0, digit);
        REFIT.claim(what, "", Value::from(format!("<= {paper}")), ours, (verdict, "The paper's column is our own claim."))
    };
    [
        claim("largest error at s = 1", 0.024, 0.001, worst(1, refitted)),
        claim("largest error at s = 2", 0.021, 0.001, worst(2, refitted)),
        claim("largest error for s = 8 to 512", 0.0143, 0.0001, largest((8..=512).map(|s| worst(s, refitted)))),
    ]
}

/// Slips in sections 2 to 4.2.
fn small() -> [Claim; 5] {
    let t = 3.0;
    let square = |t: f64| t * t + t;
    let second = square(t + 2.0) - 2.0 * square(t + 1.0) + square(t);
    let difference = DIFFERENCES.formula(
        "ddp = (2(t+1)+1) - (2t+1), t = 3",
        [(2.0 * (t + 1.0) + 1.0) - (2.0 * t + 1.0), (2.0 * (t + 1.0) + 2.0) - (2.0 * t + 2.0), second],
        "It should read (2(t+1)+2) - (2t+2); the slip cancels",
    );
    let cosine = 20f64.to_radians().cos();
    let power = ANGULAR.formula(
        "cos^5 at 20 degrees, s = 30",
        [cosine.powi(5), cosine.powi(30), (30.0 * cosine.ln()).exp()],
        "cos^5 should read cos^s",
    );
    // The plane through three values, its second matrix with x1, y2 in the first row.
    let mut random = Random(101);
    let corners = [(); 3].map(|()| [random.between(0.0, 100.0), random.between(0.0, 100.0)]);
    let values = random.normals();
    let row = |[x, y]: [f64; 2]| [x, y, 1.0];
    let at_first = |first: [f64; 2]| {
        let [p, q, r] = [first, corners[1], corners[2]].map(row);
        let shares = [cross(q, r), cross(r, p), cross(p, q)].map(|v| dot(v, row(corners[0])) / dot(p, cross(q, r)));
        dot(shares, values)
    };
    let [[x1, y1], [_, y2], _] = corners;
    let plane = PLANES.formula(
        "plane through three values, at the first corner",
        [at_first([x1, y2]), at_first([x1, y1]), values[0]],
        "In the second matrix x1, y2 should read x1, y1",
    );
    let (light, [a, b, c]) = (scale(random.direction(), 1.7), [(); 3].map(|()| random.normals()));
    let (x, y) = (0.4, -0.7);
    let normal = add(add(scale(a, x), scale(b, y)), c);
    let [la, lb, lc] = [a, b, c].map(|v| dot(v, light));
    let linear = FAST.formula(
        "L·N = ax + bx + c at a point",
        [la * x + lb * x + lc, la * x + lb * y + lc, dot(light, normal)],
        "It should read ax + by + c",
    );
    let product = la * x + lb * y + lc;
    let cosine = FAST.formula(
        "cosine of L and N, L in the denominator's N",
        [product / (length(light) * product.abs()), product / (length(light) * length(normal)), dot(direction(light), direction(normal))],
        "The denominator is |L| |Ax + By + C|, without L's product",
    );
    [difference, power, plane, linear, cosine]
}

/// Γ and α of a span: `Γ cos(θ - α)` is the cosine to v, θ the angle from the normal l towards r.
fn alpha() -> [Claim; 5] {
    let mut random = Random(102);
    let l = random.normals();
    let r = add(l, scale(random.normals(), 0.5));
    let v = direction(add(l, scale(random.normals(), 0.4)));
    let (ll, lr, rr, lv, rv) = (dot(l, l), dot(l, r), dot(r, r), dot(l, v), dot(r, v));
    let area = ll * rr - lr * lr;
    // Directly: v in the basis of l and the direction from there towards r.
    let x = direction(l);
    let y = direction(sub(r, scale(x, dot(r, x))));
    let angle = dot(v, y).atan2(dot(v, x));
    let gamma = (rr * lv * lv - 2.0 * lv * lr * rv + ll * rv * rv) / area;
    let exact = dot(v, x).powi(2) + dot(v, y).powi(2);
    let right = (ll * rv - lr * lv).atan2(lv * area.sqrt());
    let first = |last: f64| ((ll * rv / lv - last) / area.sqrt()).atan();
    let second = ((ll * rv - rr * lv) / (lv * area.sqrt())).atan();
    let turn = |scale: f64| (lr * scale).clamp(-1.0, 1.0).acos();
    let tau = dot(r, y).atan2(dot(r, x));
    let joints = largest([1.0, 5.0, 50.0].into_iter().flat_map(|s| {
        let [a, b] = printed(s);
        // Value and slope of both parabolas where they join.
        let value = (1.0 - a / b) - (b - a).powi(2) / (b * (b - a));
        let slope = -2.0 * a / (a * b) + 2.0 * (b - a) / (b * (b - a));
        [value.abs(), slope.abs()]
    }));
    [
        ANGULAR.identity("the three parabolas join smoothly", joints, "Right as printed."),
        ALPHA.identity("Γ² from the five products", (gamma - exact).abs(), "Right as printed."),
        ALPHA.formula("α by (ll)(rv)/(lv) - (rr)", [first(rr), first(lr), angle], "(rr) should read (lr)"),
        ALPHA.formula("α by (ll)(rv) - (rr)(lv)", [second, right, angle], "(rr)(lv) should read (lr)(lv)"),
        CODE.formula(
            "τ by cos τ = lr/sqrt(ll + rr)",
            [turn(1.0 / (ll + rr).sqrt()), turn(1.0 / (ll * rr).sqrt()), tau],
            "ll + rr should read ll rr",
        ),
    ]
}

/// Products of a linear field of normals along two edges.
#[derive(Clone, Copy, Debug)]
struct Products {
    aa: f64,
    ab: f64,
    ac: f64,
    av: f64,
    bb: f64,
    bc: f64,
    bv: f64,
    cc: f64,
    cv: f64,
}

impl Products {
    fn new([a, b, c]: [V3; 3], v: V3) -> Self {
        Self {
            aa: dot(a, a),
            ab: dot(a, b),
            ac: dot(a, c),
            av: dot(a, v),
            bb: dot(b, b),
            bc: dot(b, c),
            bv: dot(b, v),
            cc: dot(c, c),
            cv: dot(c, v),
        }
    }

    /// Coefficients of 1, y and y² of the product of the normals on two edges `x + d y`.
    fn edges(&self, [x, d]: [f64; 2], [z, e]: [f64; 2]) -> [f64; 3] {
        [
            self.aa * x * z + self.ac * (x + z) + self.cc,
            self.aa * (e * x + d * z) + 2.0 * self.bc + self.ab * (x + z) + self.ac * (d + e),
            self.aa * d * e + self.ab * (d + e) + self.bb,
        ]
    }

    /// Coefficients of 1 and y of the normal's product with v.
    fn edge(&self, [x, d]: [f64; 2]) -> [f64; 2] {
        [self.av * x + self.cv, self.av * d + self.bv]
    }
}

/// The list of symbols: products along the edges of a triangle.
fn symbols() -> [Claim; 4] {
    let mut random = Random(103);
    let field = [(); 3].map(|()| random.normals());
    let p = Products::new(field, random.direction());
    let [left, right] = [(); 2].map(|()| [random.normal(), random.normal()]);
    let ([xl, dxl], [xr, dxr]) = (left, right);
    let normal = |[x, d]: [f64; 2], y: f64| add(add(scale(field[0], x + d * y), scale(field[1], y)), field[2]);
    // A quadratic's coefficients from three of its values.
    let coefficients = |one: [f64; 2], other: [f64; 2]| {
        let at = |y: f64| dot(normal(one, y), normal(other, y));
        [at(0.0), (at(1.0) - at(-1.0)) / 2.0, (at(1.0) + at(-1.0)) / 2.0 - at(0.0)]
    };
    let off = |one, other| largest(p.edges(one, other).iter().zip(coefficients(one, other)).map(|(a, b)| (a - b).abs()));
    let (lr, exact) = (p.edges(left, right), coefficients(left, right));
    let wrong0 = p.aa * xl * xr + p.ac * (xl + xl) + p.cc;
    let wrong1 = p.aa * (dxl * xl + dxl * xr) + 2.0 * p.bc + p.ab * (xl + xr) + p.ac * (dxl + dxr);
    [
        SYMBOLS.identity("ll0 to ll2, rr0 to rr2", off(left, left).max(off(right, right)), "Right as printed."),
        SYMBOLS.formula("lr0 with ac(xl0 + xl0)", [wrong0, lr[0], exact[0]], "It should read ac(xl0 + xr0)"),
        SYMBOLS.formula("lr1 with aa(dxl xl0 + dxl xr0)", [wrong1, lr[1], exact[1]], "It should read aa(dxr xl0 + dxl xr0)"),
        SYMBOLS.identity("lr2", (lr[2] - exact[2]).abs(), "Right as printed."),
    ]
}

/// A fault of the code as printed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Slip {
    /// No fault: the corrected code.
    None,
    /// The recurrences start at y = 0, but C has not been moved there.
    Unmoved,
    /// `dtdx *= dtdx Γ`: half the second difference.
    Half,
    /// The centres of the outer parabolas on the wrong sides.
    Swapped,
    /// `first = s/2`, s the exponent.
    First,
    /// All three parts begin where the first may begin.
    Starts,
}

/// One half of a triangle: two heights, and the left and right ends there.
#[derive(Clone, Copy, Debug)]
struct Part {
    top: f64,
    bottom: f64,
    left: [f64; 2],
    right: [f64; 2],
}

/// The code of section 12 with one of its slips: light at integer pixels.
fn walk(field: [V3; 3], v: V3, s: f64, part: Part, slip: Slip) -> HashMap<[i64; 2], f64> {
    let mut picture = HashMap::new();
    let [a, b] = printed(s);
    let height = part.bottom - part.top;
    let [dxl, dxr] = [part.left, part.right].map(|[top, bottom]| (bottom - top) / height);
    let start = part.top.ceil();
    let [mut xl, mut xr] = [part.left[0] + (start - part.top) * dxl, part.right[0] + (start - part.top) * dxr];
    let moved = if slip == Slip::Unmoved { field[2] } else { add(field[2], scale(field[1], start)) };
    let p = Products::new([field[0], field[1], moved], v);
    let (left, right) = ([xl, dxl], [xr, dxr]);
    // Value, first and second difference.
    let differences = |[q0, q1, q2]: [f64; 3]| [q0, q1 + q2, 2.0 * q2];
    let mut products = [p.edges(left, left), p.edges(left, right), p.edges(right, right)].map(differences);
    let mut cosines = [p.edge(left), p.edge(right)];
    for y in start as i64..part.bottom.ceil() as i64 {
        let (x0, x1) = (xl.ceil() as i64, xr.ceil() as i64);
        let ([ll, lr, rr], [lv, rv]) = (products.map(|q| q[0]), cosines.map(|q| q[0]));
        if x1 > x0 && lv.max(rv) > 0.0 {
            let turn = (lr / (ll * rr).sqrt()).min(1.0);
            if turn > 1.0 - 1e-9 {
                let [p, q] = [lv / ll.sqrt(), rv / rr.sqrt()].map(|cosine| cosine.max(0.0).powf(s));
                for x in x0..x1 {
                    picture.insert([x, y], p + (q - p) * (x as f64 - xl) / (xr - xl));
                }
            } else {
                let area = ll * rr - lr * lr;
                let gamma = ((rr * lv * lv - 2.0 * lv * lr * rv + ll * rv * rv) / area).clamp(0.0, 1.0).powf(s / 2.0);
                let alpha = (ll * rv - lr * lv).atan2(lv * area.sqrt());
                let dtdx = turn.acos() / (xr - xl);
                let middle = xl + alpha / dtdx;
                let [inner, outer] = [a / dtdx, b / dtdx];
                let bend = if slip == Slip::Half { 1.0 } else { 2.0 } * dtdx * dtdx * gamma;
                let [p1, p2, p3, p4] = [middle - outer, middle - inner, middle + inner, middle + outer].map(|x| x.ceil() as i64);
                let mut shade = |from: i64, to: i64, second: f64, base: f64, centre: f64| {
                    let u = from as f64 - centre;
                    let half = if slip == Slip::First { s } else { second } / 2.0;
                    let (mut value, mut first) = (base + second * u * u / 2.0, half + second * u);
                    for x in from..to {
                        picture.insert([x, y], value);
                        value += first;
                        first += second;
                    }
                };
                let side = if slip == Slip::Swapped { -outer } else { outer };
                let begin = |from: i64| if slip == Slip::Starts { x0.max(p1) } else { x0.max(from) };
                shade(x0.max(p1), x1.min(p2), bend / (b * (b - a)), 0.0, middle - side);
                shade(begin(p2), x1.min(p3), -bend / (a * b), gamma, middle);
                shade(begin(p3), x1.min(p4), bend / (b * (b - a)), 0.0, middle + side);
            }
        }
        xl += dxl;
        xr += dxr;
        for [value, first, second] in &mut products {
            *value += *first;
            *first += *second;
        }
        for [value, first] in &mut cosines {
            *value += *first;
        }
    }
    picture
}

/// Largest difference of the code to the formula that it walks along, over random triangles.
fn walked(slip: Slip) -> f64 {
    let mut random = Random(104);
    let mut worst = 0f64;
    for _ in 0..100 {
        let top = random.between(0.0, 5.0);
        let bottom = top + random.between(5.0, 40.0);
        let mut ends = || {
            let (p, q) = (random.between(0.0, 100.0), random.between(0.0, 100.0));
            [p.min(q), p.max(q)]
        };
        let ([l0, r0], [l1, r1]) = (ends(), ends());
        let part = Part { top, bottom, left: [l0, l1], right: [r0, r1] };
        let field = [scale(random.normals(), 0.006), scale(random.normals(), 0.006), random.direction()];
        let v = direction(add(field[2], scale(random.normals(), 0.5)));
        let s = [5.0, 20.0, 60.0][(3.0 * random.share()) as usize % 3];
        let picture = walk(field, v, s, part, slip);
        for y in top.ceil() as i64..bottom.ceil() as i64 {
            let down = (y as f64 - top) / (bottom - top);
            let [xl, xr] = [part.left, part.right].map(|[from, to]| from + down * (to - from));
            let [l, r] = [xl, xr].map(|x| add(add(scale(field[0], x), scale(field[1], y as f64)), field[2]));
            for x in xl.ceil() as i64..xr.ceil() as i64 {
                let exact = along([l, r], v, (x as f64 - xl) / (xr - xl), s, printed);
                let found = picture.get(&[x, y]).copied().unwrap_or(0.0);
                worst = worst.max((found - exact).abs());
            }
        }
    }
    worst
}

/// The code of section 12, corrected and with each slip alone.
fn code() -> Vec<Claim> {
    let right = walked(Slip::None);
    let verdict = if right < 1e-6 { Verdict::Confirmed } else { Verdict::Refuted };
    let note = "The recurrences are exact once all slips below are mended; full light is 1.";
    let mut claims = vec![CODE.claim("all corrected: largest error", "", 0.0, right, (verdict, note))];
    for (what, slip, note) in [
        ("dtdx *= dtdx Γ: largest error", Slip::Half, "qshade wants the second difference, 2 dtdx² Γ."),
        ("centres of 1st and 3rd part: largest error", Slip::Swapped, "x-mid-b and x-mid+b have to change places."),
        ("first = s/2: largest error", Slip::First, "It should read second/2."),
        ("max(xl, xbl) in all three parts: largest error", Slip::Starts, "The 2nd and 3rd begin at their own boundaries."),
        ("C not moved to the first row: largest error", Slip::Unmoved, "The recurrences start with the values of y = 0."),
    ] {
        let ours = walked(slip);
        let verdict = if ours < 1e-6 { Verdict::Confirmed } else { Verdict::Refuted };
        claims.push(CODE.claim(what, "", 0.0, ours, (verdict, note)));
    }
    let cosine = -0.3f64;
    claims.push(CODE.formula(
        "linearshade: sgn·|cos|^s, cos = -0.3, s = 1",
        [cosine.signum() * cosine.abs(), cosine.max(0.0), parabolas(cosine.acos(), refitted(1.0))],
        "Light from behind is none: negative cosines count as 0",
    ));
    claims
}

/// A triangle's height within a row of pixels is linear between these columns.
fn breaks(corners: &[[f64; 2]; 3], row: f64) -> Vec<f64> {
    let clip = |polygon: Vec<[f64; 2]>, inside: &dyn Fn(f64) -> f64| {
        let mut clipped = Vec::new();
        for (k, p) in polygon.iter().enumerate() {
            let q = polygon[(k + 1) % polygon.len()];
            let (from, to) = (inside(p[1]), inside(q[1]));
            if from >= 0.0 {
                clipped.push(*p);
            }
            if from * to < 0.0 {
                let t = from / (from - to);
                clipped.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
            }
        }
        clipped
    };
    let band = clip(clip(corners.to_vec(), &|y| y - row), &|y| row + 1.0 - y);
    let mut columns: Vec<f64> = if band.len() < 3 { Vec::new() } else { band.iter().map(|p| p[0]).collect() };
    columns.sort_by(f64::total_cmp);
    columns.dedup();
    columns
}

/// Anti-aliasing: how many linear pieces a row has, and how many pixels lie across two of them.
fn area() -> [Claim; 2] {
    let mut random = Random(105);
    let (mut most, mut across, mut all) = (0, 0u32, 0u32);
    for _ in 0..1000 {
        let corners = [(); 3].map(|()| [random.between(0.0, 24.0), random.between(0.0, 24.0)]);
        let [a, b, c] = corners;
        if ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() < 8.0 {
            continue;
        }
        for row in 0..24 {
            let columns = breaks(&corners, row.into());
            let ([first, .., last], pieces) = (&columns[..], columns.len().saturating_sub(1)) else { continue };
            most = most.max(pieces);
            for x in first.floor() as i32..last.ceil() as i32 {
                let inside = |column: &f64| f64::from(x) < *column && *column < f64::from(x + 1);
                across += u32::from(columns.iter().any(inside));
                all += 1;
            }
        }
    }
    let share = 100.0 * f64::from(across) / f64::from(all.max(1));
    let most = most as f64;
    let verdict = if most <= 3.0 { Verdict::Confirmed } else { Verdict::Refuted };
    let note = "Three hold only for rows without a corner.";
    let pieces = AREA.claim("linear parts of a row, at most", "", 3.0, most, (verdict, note));
    let note = "On triangles of 24 pixels; there the area is no cubic, and the third differences miss it.";
    let pixels = AREA.claim("pixels with a break in them", "%", 0.0, share, (Verdict::at_most(share, 1.0, 5.0), note));
    [pieces, pixels]
}
