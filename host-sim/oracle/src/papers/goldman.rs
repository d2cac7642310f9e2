//! Walking normals along a row (Goldman's lecture).

use super::{Claim, Random, Source, Topic, Verdict, direction, largest};
use microphong_models::{
    polygon::newell,
    vector::{V3, add, cross, dot, length, scale, sub},
};

const LENGTH: Source = Source(Topic::Goldman, "slide of dD");
const NEWTON: Source = Source(Topic::Goldman, "slide of Newton's root");
const NORMALS: Source = Source(Topic::Goldman, "slide of N + dN");
const SLERP: Source = Source(Topic::Goldman, "slides of slerp");
const OTHERS: Source = Source(Topic::Goldman, "other slides");

pub(super) fn claims() -> Vec<Claim> {
    let mut claims = length_slide();
    claims.extend([20.0, 40.0, 60.0].map(drift));
    claims.extend([8, 32].map(newton));
    claims.extend([slerp(), reflected(), barycentric(), perspective(), polygon()]);
    claims
}

/// |N|² a share `t` of the way between unit normals whose cosine is `c`.
fn square(t: f64, c: f64) -> f64 {
    (1.0 - t).powi(2) + t * t + 2.0 * t * (1.0 - t) * c
}

/// The change of |N|² in one step: three printed forms, and what they come to along a row.
fn length_slide() -> Vec<Claim> {
    let (t, dt, c) = (0.3, 1.0 / 16.0, 60f64.to_radians().cos());
    let truth = square(t + dt, c) - square(t, c);
    let line = |sign: f64| sign * 2.0 * (1.0 - t) * dt + dt * dt + 2.0 * t * dt + dt * dt + 2.0 * (dt * (1.0 - t) - t * dt - dt * dt) * c;
    let corrected = |t: f64| 2.0 * dt * (1.0 - c) * (2.0 * t + dt - 1.0);
    let braces = 2.0 * dt * (1.0 + dt + (1.0 - 2.0 * t + dt) * c);
    let printed = |t: f64| 2.0 * dt * (1.0 + dt + (1.0 + dt) * c) - 2.0 * t * c;
    let [mut walked, mut right] = [1.0; 2];
    for k in 0..16 {
        let t = f64::from(k) * dt;
        walked += printed(t);
        right += corrected(t);
    }
    vec![
        LENGTH.formula("dD, first line (t = 0.3, dt = 1/16, 60 degrees)", [line(1.0), line(-1.0), truth], "2(1-t)dt should read -2(1-t)dt"),
        LENGTH.formula("dD = 2dt(1 + dt + (1-2t+dt)c)", [braces, corrected(t), truth], "It should read 2dt(1-c)(2t+dt-1)"),
        LENGTH.formula("dD = E - F, F = 2tc", [printed(t), corrected(t), truth], "E, F and dF follow from the wrong line"),
        LENGTH.formula("D after 16 steps of 16", [walked, right, square(1.0, c)], "Both ends are unit normals"),
    ]
}

/// Largest angle between the renormalised sum and the normal that it stands for.
fn drift(degrees: f64) -> Claim {
    const STEPS: u32 = 256;
    let (s, c) = degrees.to_radians().sin_cos();
    let (from, to): (V3, V3) = ([1.0, 0.0, 0.0], [c, s, 0.0]);
    let step = scale(sub(to, from), 1.0 / f64::from(STEPS));
    let mut normal = from;
    let worst = largest((1..=STEPS).map(|k| {
        normal = direction(add(normal, step));
        let exact = direction(add(from, scale(step, f64::from(k))));
        length(cross(normal, exact)).atan2(dot(normal, exact)).to_degrees()
    }));
    let note = "Step the sum and normalise a copy: a constant dN turns the shortened N too far.";
    let what = format!("N + dN renormalised, ends {degrees} degrees apart");
    NORMALS.claim(what, "degrees", 0.0, worst, (Verdict::at_most(worst, 0.1, 0.25), note))
}

/// One step of Newton's iteration per pixel, which starts from the neighbour's root.
fn newton(pixels: u32) -> Claim {
    let c = 60f64.to_radians().cos();
    let mut root = 1.0;
    let worst = largest((1..=pixels).map(|k| {
        let square = square(f64::from(k) / f64::from(pixels), c);
        root = (root + square / root) / 2.0;
        (root / square.sqrt() - 1.0).abs()
    }));
    let note = "The relative error of |N|; half a level is 2e-3 of full light.";
    let what = format!("one step per pixel, 60 degrees in {pixels} pixels");
    NEWTON.claim(what, "", "enough", worst, (Verdict::at_most(worst, 0.5 / 255.0, 1.0 / 255.0), note))
}

/// Spherical interpolation by adding angles, against sines.
fn slerp() -> Claim {
    const STEPS: u32 = 64;
    let angle = 70f64.to_radians();
    let (s, c) = (angle / f64::from(STEPS)).sin_cos();
    // sin((1-t)p), cos((1-t)p); sin(tp), cos(tp).
    let (mut left, mut right) = (angle.sin_cos(), (0.0, 1.0));
    let worst = largest((0..=STEPS).map(|k| {
        let t = f64::from(k) / f64::from(STEPS);
        let [a, b] = [left.0, right.0].map(|sine| sine / angle.sin());
        let unit = a * a + b * b + 2.0 * a * b * angle.cos() - 1.0;
        let off = (left.0 - ((1.0 - t) * angle).sin()).abs().max((right.0 - (t * angle).sin()).abs());
        left = (left.0 * c - left.1 * s, left.1 * c + left.0 * s);
        right = (right.0 * c + right.1 * s, right.1 * c - right.0 * s);
        off.max(unit.abs())
    }));
    SLERP.identity("slerp by adding angles over 64 steps", worst, "Right as printed, and of unit length.")
}

/// R·V from unnormalised products.
fn reflected() -> Claim {
    let mut random = Random(91);
    let worst = largest((0..100).map(|_| {
        let [light, view] = [(); 2].map(|()| random.direction());
        let long = scale(random.normals(), 0.7);
        let n = direction(long);
        let exact = dot(sub(scale(n, 2.0 * dot(n, light)), light), view);
        (2.0 * dot(light, long) * dot(view, long) / dot(long, long) - dot(light, view) - exact).abs()
    }));
    OTHERS.identity("R·V = 2(L·N)(V·N)/D - L·V", worst, "No root is needed.")
}

/// Interpolation along edges and then along the row gives the result of affine coordinates.
fn barycentric() -> Claim {
    let mut random = Random(92);
    let worst = largest((0..100).map(|_| {
        let [u, s, t] = [(); 3].map(|()| random.share());
        let [a, b, c] = random.normals();
        let row = (1.0 - u) * (a + t * (b - a)) + u * (a + s * (c - a));
        (row - (((1.0 - u) * (1.0 - t) + u * (1.0 - s)) * a + (1.0 - u) * t * b + u * s * c)).abs()
    }));
    OTHERS.identity("Gouraud along edges and rows is affine", worst, "Triangles look the same however they are turned.")
}

/// Perspective division, both ways.
fn perspective() -> Claim {
    let mut random = Random(93);
    let worst = largest((0..100).map(|_| {
        let [m1, m2] = [(); 2].map(|()| random.between(1.0, 4.0));
        let [t, i1, i2] = [(); 3].map(|()| random.share());
        let far = t * m2 / ((1.0 - t) * m1 + t * m2);
        let back = far * m1 / ((1.0 - far) * m2 + far * m1);
        let hyperbolic = ((1.0 - far) * i1 / m1 + far * i2 / m2) / ((1.0 - far) / m1 + far / m2);
        // One of the two shares belongs to space, the other to the screen.
        (back - t).abs().max((hyperbolic - ((1.0 - t) * i1 + t * i2)).abs())
    }));
    OTHERS.identity("t and t* in perspective, I/m over 1/m", worst, "Right as printed.")
}

/// Newell's normal of a hexagon.
fn polygon() -> Claim {
    let mut random = Random(94);
    let x = random.direction();
    let y = direction(cross(x, random.direction()));
    let points = [0, 1, 2, 3, 4, 5].map(|k| {
        let (s, c) = (f64::from(k) * 60f64.to_radians()).sin_cos();
        add(scale(x, 2.0 * c), scale(y, 2.0 * s))
    });
    let area = 1.5 * 3f64.sqrt() * 4.0;
    OTHERS.identity("Newell's normal is twice the area long", (length(newell(&points)) / (2.0 * area) - 1.0).abs(), "Right as printed.")
}
