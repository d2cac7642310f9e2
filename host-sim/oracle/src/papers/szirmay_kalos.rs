//! Quadratic interpolation of colour (Szirmay-Kalos and others 2000).

use super::{Claim, Random, Source, Topic, Verdict, centre, distant, grid, largest, polynomial, row};
use crate::{Facet, Frame, SIX, method, phong, quadratic, sum};
use anyhow::Result;
use microphong_models::{
    shapes,
    vector::{V3, add, dot, scale, sub},
};
use std::ops::{Add, Div, Mul, Sub};

const FIGURES: Source = Source(Topic::SzirmayKalos, "figures, spheres");
const SUBDIVISION: Source = Source(Topic::SzirmayKalos, "adaptive subdivision");
const WIDTH: Source = Source(Topic::SzirmayKalos, "hardware, word length");
const EDGES: Source = Source(Topic::SzirmayKalos, "forward differences");
const FIT: Source = Source(Topic::SzirmayKalos, "six-point solution");

/// Full light.
const FULL: f64 = 255.0;
/// A difference that is hardly seen: one in a hundred.
const UNSEEN: f64 = 0.01 * FULL;
/// A jump that is seen, but does not disturb.
const SLIGHT: f64 = 0.04 * FULL;

pub(super) fn claims() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for (meridians, bands) in [(12, 8), (17, 12), (23, 16)] {
        for exponent in [5.0, 50.0] {
            claims.extend(sphere(meridians, bands, exponent)?);
        }
    }
    claims.extend(centre_test());
    claims.extend([(20.0, 20), (20.0, 50), (30.0, 20), (30.0, 50), (60.0, 50)].map(|(degrees, exponent)| crack(degrees, exponent)));
    claims.push(word());
    claims.extend([320, 4096].map(bits));
    claims.extend(starts());
    claims.push(steps());
    claims.extend(solution());
    Ok(claims)
}

/// Errors on one sphere.
fn sphere(meridians: usize, bands: usize, exponent: f64) -> Result<[Claim; 3]> {
    let mesh = shapes::sphere(meridians, bands, 0.0);
    let frame = distant(&mesh, exponent);
    let [linear, linear_mean] = errors(&frame, "gouraud")?;
    let [quadratic, quadratic_mean] = errors(&frame, "six-point")?;
    let scene = format!("{} triangles, n = {exponent}", mesh.triangles.len());
    let verdict = if linear > SLIGHT {
        Verdict::Confirmed
    } else if linear > UNSEEN {
        Verdict::Close
    } else {
        Verdict::Refuted
    };
    let note = format!("Root mean square {linear_mean:.2} LSB.");
    let gouraud = FIGURES.claim(format!("{scene}: Gouraud is wrong by"), "LSB", "visible", linear, (verdict, note));
    let verdict = Verdict::at_most(quadratic, UNSEEN, SLIGHT);
    let limit = match verdict {
        Verdict::Confirmed => "below 1 % of full light nothing is seen",
        Verdict::Close => "between 1 and 4 % of full light it is seen side by side",
        _ => "beyond 4 % of full light the highlight changes its shape",
    };
    let note = format!("Root mean square {quadratic_mean:.2} LSB; {limit}.");
    let looks = FIGURES.claim(format!("{scene}: quadratic is wrong by"), "LSB", "invisible", quadratic, (verdict, note));
    let ratio = linear_mean / quadratic_mean;
    let verdict = if ratio > 1.0 { Verdict::Confirmed } else { Verdict::Refuted };
    let note = "Root mean squares, Gouraud's over the quadratic's.";
    let better = FIGURES.claim(format!("{scene}: better than Gouraud by"), "times", "> 1", ratio, (verdict, note));
    Ok([gouraud, looks, better])
}

/// Largest and root mean square difference to Phong.
fn errors(frame: &Frame, name: &str) -> Result<[f64; 2]> {
    let (mut worst, mut square, mut count) = (0f64, 0.0, 0u32);
    for facet in &frame.facets {
        let (shade, exact) = (method(name, frame, facet)?, phong(frame, facet));
        for pixel in facet.pixels(frame.size) {
            let error = shade(centre(pixel))[0] - exact(centre(pixel))[0];
            worst = worst.max(error.abs());
            square += error * error;
            count += 1;
        }
    }
    Ok([worst, (square / f64::from(count.max(1))).sqrt()])
}

/// Triangles with random normals: how many the test at the centre leaves whole although the quadratic is wrong on them.
fn centre_test() -> Vec<Claim> {
    const TRIANGLES: u32 = 16_000;
    /// Levels that the quadratic may be wrong by.
    const TOLERANCE: f64 = 2.0;
    let points: Vec<(V3, [f64; 6])> = grid(12).map(|weights| (weights, quadratic(weights))).collect();
    let mut found = Vec::new();
    let mut worst = 0f64;
    for exponent in [5, 20, 50, 100] {
        let mut random = Random(71);
        let (mut needed, mut missed) = (0, 0);
        for _ in 0..TRIANGLES {
            let axis = random.direction();
            let spread = (random.share() * 25f64.to_radians()).tan();
            let normals = [(); 3].map(|()| {
                let v = random.normals();
                let across = super::direction(sub(v, scale(axis, dot(v, axis))));
                super::direction(add(axis, scale(across, spread * random.between(0.05, 1.0))))
            });
            let mean = super::direction(add(add(normals[0], normals[1]), normals[2]));
            let away = random.share();
            let half = super::direction(add(mean, scale(random.normals(), away)));
            let light = |weights: &V3| {
                let normal = (0..3).fold([0.0; 3], |sum, k| add(sum, scale(normals[k], weights[k])));
                FULL * dot(super::direction(normal), half).max(0.0).powi(exponent)
            };
            let nodes = SIX.map(|node| light(&node));
            let miss = |(point, weights): &(V3, [f64; 6])| (sum(weights, &nodes) - light(point)).abs();
            let whole = largest(points.iter().map(miss));
            let inside = points.iter().find(|(weights, _)| weights[0] == weights[1] && weights[1] == weights[2]).map_or(0.0, miss);
            if whole > TOLERANCE {
                needed += 1;
                if inside <= TOLERANCE {
                    missed += 1;
                    worst = worst.max(whole);
                }
            }
        }
        let share = 100.0 * f64::from(missed) / f64::from(needed.max(1));
        let note = format!("Of {needed} random triangles with errors above 2 LSB, {missed} show none at the centre.");
        let verdict = Verdict::at_most(share, 1.0, 5.0);
        found.push(SUBDIVISION.claim(format!("test at the centre, n = {exponent}: left whole, wrongly"), "%", 0.0, share, (verdict, note)));
    }
    let note = "The worst of them all: highlights may lie where the centre does not see them.";
    let verdict = Verdict::at_most(worst, UNSEEN, SLIGHT);
    found.push(SUBDIVISION.claim("test at the centre: largest error overlooked", "LSB", 2.0, worst, (verdict, note)));
    found
}

/// An edge that is split on one side only: the gap between one parabola and two.
fn crack(degrees: f64, exponent: i32) -> Claim {
    let gap = largest((0..=60).map(|phase| {
        let phase = -1.0 + 3.0 * f64::from(phase) / 60.0;
        let light = |u: f64| 0.5 * FULL * (degrees * (u - phase)).to_radians().cos().max(0.0).powi(exponent);
        let parabola = |a: f64, b: f64, u: f64| {
            let t = (u - a) / (b - a);
            let ends = light(a) * (1.0 - t) * (1.0 - 2.0 * t) + light(b) * t * (2.0 * t - 1.0);
            ends + light((a + b) / 2.0) * 4.0 * t * (1.0 - t)
        };
        largest((0..=400).map(|k| {
            let u = f64::from(k) / 400.0;
            let half = if u < 0.5 { parabola(0.0, 0.5, u) } else { parabola(0.5, 1.0, u) };
            (parabola(0.0, 1.0, u) - half).abs()
        }))
    }));
    let note = "The crack: the one neighbour draws a parabola, the other two halves of it.";
    let what = format!("edge of {degrees} degrees split on one side, n = {exponent}");
    SUBDIVISION.claim(what, "LSB", 0.0, gap, (Verdict::at_most(gap, 0.5, UNSEEN), note))
}

/// A recurrence of second order in integers with `bits` fraction bits against the parabola `c + b k + a k²`.
fn recurrence([a, b, c]: [f64; 3], bits: u32, steps: i32) -> f64 {
    let one = f64::from(bits).exp2();
    let integer = |v: f64| (v * one).round() as i64;
    let (mut value, mut first, second) = (integer(c), integer(a + b), integer(2.0 * a));
    let mut worst = 0f64;
    for k in 0..=steps {
        let k = f64::from(k);
        worst = worst.max((value as f64 / one - (c + b * k + a * k * k)).abs());
        value += first;
        first += second;
    }
    worst
}

/// 320 pixels with the bits that log2 M calls for.
fn word() -> Claim {
    const M: i32 = 320;
    let bits = f64::from(M).log2().floor() as u32 + 1;
    let m = f64::from(M);
    let mut random = Random(72);
    let worst = largest((0..400).map(|_| {
        let a = random.between(-4.0, 4.0) * FULL / (m * m);
        let b = random.between(-1.0, 1.0) * FULL / m - a * m;
        recurrence([a, b, 0.0], bits, M)
    }));
    let note = format!("Half a unit in the second difference grows with M²/2: {bits} bits are not enough.");
    WIDTH.claim(
        format!("b_I > log2 M: error of {M} pixels with {bits} bits"),
        "LSB",
        "< 1",
        worst,
        (Verdict::at_most(worst, 1.0, 2.0), note),
    )
}

/// Fraction bits for an error of at most a quarter of a level over `M` pixels, all roundings as bad as can be.
fn bits(m: i32) -> Claim {
    let worst = |bits: u32| {
        // Just below half a unit, all three the same way.
        let half = (0.5 - 1e-6) * (-f64::from(bits)).exp2();
        recurrence([half / 2.0, half / 2.0, half], bits, m)
    };
    let paper = f64::from(m).log2().floor() + 1.0;
    let needed = (1..40).find(|&bits| worst(bits) <= 0.25).map_or(f64::NAN, f64::from);
    let verdict = if needed <= paper { Verdict::Confirmed } else { Verdict::Refuted };
    let note = format!("For 1/4 LSB at worst; log2(2 (1 + M + M (M - 1)/2)) = {:.2}.", {
        let m = f64::from(m);
        (2.0 * (1.0 + m + m * (m - 1.0) / 2.0)).log2()
    });
    WIDTH.claim(format!("fraction bits for M = {m} pixels"), "bits", paper, needed, (verdict, note))
}

/// Colours at the six nodes.
fn nodes(frame: &Frame, facet: &Facet) -> [f64; 6] {
    let exact = phong(frame, facet);
    SIX.map(|node| {
        let place = |k: usize| (0..3).map(|corner| node[corner] * facet.screen[corner][k]).sum::<f64>();
        exact([place(0), place(1)])[0]
    })
}

/// Rows sampled from where the edge lies instead of at pixel centres.
fn starts() -> [Claim; 2] {
    let frame = distant(&shapes::sphere(12, 8, 0.0), 50.0);
    let (mut worst, mut square, mut count) = (0f64, 0.0, 0u32);
    for facet in &frame.facets {
        let nodes = nodes(&frame, facet);
        let value = |p: [f64; 2]| sum(&quadratic(facet.weights(p)), &nodes);
        for pixel in facet.pixels(frame.size) {
            let [_, y] = centre(pixel);
            let Some([left, _]) = row(&facet.screen, y) else { continue };
            let error = value([f64::from(pixel[0]) + left - left.floor(), y]) - value(centre(pixel));
            worst = worst.max(error.abs());
            square += error * error;
            count += 1;
        }
    }
    let mean = (square / f64::from(count.max(1))).sqrt();
    let judge = |value| (Verdict::at_most(value, 0.5, UNSEEN), "The samples lie up to one pixel beside the pixels they are written to.");
    [
        EDGES.claim("sampling at X_start + k, 168 triangles, n = 50", "LSB", 0.0, worst, judge(worst)),
        EDGES.claim("sampling at X_start + k: root mean square", "LSB", 0.0, mean, judge(mean)),
    ]
}

/// The printed recurrences along rows and edges against the polynomial.
fn steps() -> Claim {
    let mut random = Random(73);
    let t @ [_, t1, t2, t3, t4, t5] = [200.0, 3.0, -2.0, 0.02, -0.03, 0.01].map(|size| size * random.between(0.5, 1.0));
    let slope = random.between(-1.0, 1.0);
    let (mut x, mut y, mut value) = (0.0, 0.0, t[0]);
    let mut first = 2.0 * t5 * x + t4 * y + t5 + t2;
    let mut edge = t5 * slope * slope + (2.0 * t5 * x + t4 * y + t4 + t2) * slope + t4 * x + 2.0 * t3 * y + t3 + t1;
    let mut worst = 0f64;
    for _ in 0..50 {
        let (mut inner, mut change) = (value, first);
        for k in 0..50 {
            worst = worst.max((inner - polynomial(t, x + f64::from(k), y)).abs() / 1e3);
            inner += change;
            change += 2.0 * t5;
        }
        value += edge;
        edge += 2.0 * (t5 * slope * slope + t4 * slope + t3);
        first += 2.0 * t5 * slope + t4;
        x += slope;
        y += 1.0;
    }
    EDGES.identity("recurrences along rows and edges", worst, "At the fractional X_start they are exact.")
}

/// Number types in which the printed solution is computed.
trait Real: Copy + From<f32> + Into<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {}
impl Real for f32 {}
impl Real for f64 {}

/// Edges 1-2 and 1-3 and six colours, in numbers that are exact in both formats.
#[derive(Clone, Copy, Debug)]
struct Sample {
    edges: [[f32; 2]; 2],
    /// 1, 2, 3, 12, 23, 13.
    nodes: [f32; 6],
}

/// T0 to T5 as printed.
fn printed<T: Real>(sample: &Sample) -> [f64; 6] {
    let [[x2, y2], [x3, y3]] = sample.edges.map(|edge| edge.map(T::from));
    let [i1, i2, i3, i12, i23, i13] = sample.nodes.map(T::from);
    let [two, three, four] = [2.0, 3.0, 4.0].map(T::from);
    let c2 = four * i12 - three * i1 - i2;
    let c12 = i1 + i2 - two * i12;
    let c3 = four * i13 - three * i1 - i3;
    let c13 = i1 + i3 - two * i13;
    let c23 = four * i1 - four * i12 - four * i13 + four * i23;
    let d = x2 * y3 - y2 * x3;
    let t1 = (c3 * x2 - c2 * x3) / d;
    let t2 = (c2 * y3 - c3 * y2) / d;
    let (p, q) = (two * x2 * x2 * y3 - two * x2 * y2 * x3, y2 * x3 * y3 - x2 * y3 * y3);
    let (r, s) = (x2 * y2 * y3 - y2 * y2 * x3, two * y2 * x3 * x3 - two * x2 * x3 * y3);
    let (u, v) = (four * c13 * y2 - c23 * y3, four * c12 * y3 - c23 * y2);
    let denominator = p * q - r * s;
    let t4 = (u * p - v * s) / denominator;
    let t5 = (v * q - u * r) / denominator;
    let t3 = (two * c12 - t5 * x2 * x2 - t4 * x2 * y2) / (y2 * y2);
    [i1, t1, t2, t3, t4, t5].map(T::into)
}

/// The six coefficients, by affine coordinates.
fn affine<T: Real>(sample: &Sample) -> [f64; 6] {
    let [[x2, y2], [x3, y3]] = sample.edges.map(|edge| edge.map(T::from));
    let [i1, i2, i3, i12, i23, i13] = sample.nodes.map(T::from);
    let [zero, two, three, four] = [0.0, 2.0, 3.0, 4.0].map(T::from);
    let det = x2 * y3 - x3 * y2;
    let [c1, c2] = [four * i12 - three * i1 - i2, four * i13 - three * i1 - i3];
    let [c3, c4, c5] = [two * (i1 + i2 - two * i12), four * (i1 - i12 - i13 + i23), two * (i1 + i3 - two * i13)];
    let [sx, sy, tx, ty] = [y3 / det, (zero - x3) / det, (zero - y2) / det, x2 / det];
    [
        i1,
        c1 * sy + c2 * ty,
        c1 * sx + c2 * tx,
        c3 * sy * sy + c4 * sy * ty + c5 * ty * ty,
        two * c3 * sx * sy + c4 * (sx * ty + tx * sy) + two * c5 * tx * ty,
        c3 * sx * sx + c4 * sx * tx + c5 * tx * tx,
    ]
    .map(T::into)
}

/// Random triangles on a screen of 320 by 240: what rounding does to the printed solution.
fn solution() -> [Claim; 4] {
    let mut random = Random(74);
    // The printed form in f64; both in f32.
    let (mut same, mut theirs, mut ours, mut bad) = (0f64, 0f64, 0f64, 0u32);
    for _ in 0..40_000 {
        let fine = |v: f64, step: f64| (v * step).round() / step;
        let screen = [(); 3].map(|()| [320.0, 240.0].map(|side| fine(random.between(0.0, side), 16.0)));
        let edges = [1, 2].map(|k| [0, 1].map(|axis| (screen[k][axis] - screen[0][axis]) as f32));
        let sample = Sample { edges, nodes: SIX.map(|_| fine(random.between(0.0, FULL), 256.0) as f32) };
        let [a, b, c] = screen;
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs();
        let longest = largest([(a, b), (b, c), (c, a)].map(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1])));
        // Slivers are another matter.
        if area < 4.0 * longest {
            continue;
        }
        let exact = affine::<f64>(&sample);
        let error = |t: [f64; 6]| {
            let [top, bottom] = [a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1])];
            let rows = [top.ceil() + 0.5, ((top + bottom) / 2.0).floor() + 0.5, bottom.floor() - 0.5];
            let points = rows.into_iter().filter_map(|y| row(&screen, y).map(|ends| (y, ends)));
            let points = points.flat_map(|(y, [left, right])| {
                [left.ceil() + 0.5, ((left + right) / 2.0).floor() + 0.5, right.floor() - 0.5].map(|x| (x - a[0], y - a[1]))
            });
            largest(points.map(|(x, y)| (polynomial(t, x, y) - polynomial(exact, x, y)).abs()).chain([0.0]))
        };
        ours = ours.max(error(affine::<f32>(&sample)));
        if edges[0][1] != 0.0 {
            same = same.max(error(printed::<f64>(&sample)));
            let rounded = error(printed::<f32>(&sample));
            theirs = theirs.max(rounded);
            bad += u32::from(rounded > UNSEEN);
        }
    }
    let flat = Sample { edges: [[100.0, 0.0], [30.0, 80.0]], nodes: [10.0, 60.0, 90.0, 40.0, 80.0, 45.0] };
    let flat = [printed::<f64>(&flat)[3], affine::<f64>(&flat)[3]];
    let undefined = if flat[0].is_finite() { Verdict::Confirmed } else { Verdict::Refuted };
    let right = if same < 1e-3 { Verdict::Confirmed } else { Verdict::Refuted };
    let note = "Where edge 1-2 is horizontal, T3 divides 0 by 0.";
    [
        FIT.claim("T1 to T5 as printed, in f64", "LSB", "exact", same, (right, "The solution is right but for rounding.")),
        FIT.claim("T1 to T5 as printed, in f32", "LSB", 0.0, theirs, {
            let note = format!("T3 divides by Y2², T4 and T5 by det³; of 40,000 triangles {bad} err by more than 1 %.");
            (Verdict::at_most(theirs, UNSEEN, SLIGHT), note)
        }),
        FIT.claim("the same quadratic by affine coordinates, in f32", "LSB", 0.0, ours, {
            (Verdict::at_most(ours, UNSEEN, SLIGHT), "Only det² divides: the error is in the form, not in the fit.")
        }),
        FIT.claim(
            "T3 where Y2 = 0",
            "",
            if flat[0].is_nan() { "0/0".into() } else { super::Value::from(flat[0]) },
            flat[1],
            (undefined, note),
        ),
    ]
}
