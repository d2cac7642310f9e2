//! Phong shading by Taylor's expansion (Bishop and Weimer 1986).

use super::{Claim, Random, Source, Topic, Verdict, direction, frame, grey, grid, largest, taylor};
use crate::{Facet, Place, method, phong};
use anyhow::Result;
use microphong_models::vector::{V3, add, dot, length, scale};

const TABLES: Source = Source(Topic::BishopWeimer, "table of powers");
const SPREAD: Source = Source(Topic::BishopWeimer, "range of normals");
const DUFF: Source = Source(Topic::BishopWeimer, "equation of I_diff");
const INFINITE: Source = Source(Topic::BishopWeimer, "T0 to T5, infinite eye");
const QUOTED: Source = Source(Topic::Disselkoen, "4.3, quoting Bishop & Weimer");
const FINITE: Source = Source(Topic::BishopWeimer, "T0 to T5, finite eye");

pub(super) fn claims() -> Result<Vec<Claim>> {
    let mut claims = tables();
    for degrees in [15.0, 20.0, 30.0, 45.0, 60.0] {
        claims.extend(spread(degrees)?);
    }
    claims.push(diffuse());
    claims.extend(infinite());
    claims.extend(finite());
    Ok(claims)
}

/// How a table's entry is found, and what it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Entry {
    /// The nearest, exact.
    Nearest,
    /// The one below, exact.
    Below,
    /// The nearest, in eight bits.
    Bytes,
}

/// Largest error of `x^n` on [0, 1] by a table of `steps` steps.
fn error(steps: u32, n: i32, entry: Entry) -> f64 {
    let all = f64::from(steps);
    largest((0..=steps).flat_map(|k| {
        let k = f64::from(k);
        let exact = (k / all).powi(n);
        let (held, low, high) = match entry {
            Entry::Nearest => (exact, k - 0.5, k + 0.5),
            Entry::Below => (exact, k, k + 1.0),
            Entry::Bytes => ((255.0 * exact).round() / 255.0, k - 0.5, k + 0.5),
        };
        // A power rises: within the entry's range the ends are the worst.
        [low, high].map(|x| (held - (x / all).clamp(0.0, 1.0).powi(n)).abs())
    }))
}

/// The largest exponent up to which the error stays below one in a hundred.
fn reach(steps: u32, entry: Entry) -> f64 {
    f64::from((1..400).take_while(|&n| error(steps, n, entry) < 0.01).last().unwrap_or(0))
}

fn tables() -> Vec<Claim> {
    let mut claims = Vec::new();
    for (name, steps, n) in [("1k", 1024, 20), ("8k", 8192, 164)] {
        let paper = f64::from(n);
        for (entry, title, note) in [
            (Entry::Nearest, "nearest entry", "So it is with rounded indices and entries that are not rounded."),
            (Entry::Below, "index truncated", "An index cut off errs by a whole step instead of half a step."),
        ] {
            let ours = reach(steps, entry);
            let verdict = if ours >= paper { Verdict::Confirmed } else { Verdict::Refuted };
            claims.push(TABLES.claim(format!("{name} table within 1 % up to n, {title}"), "", paper, ours, (verdict, note)));
        }
        let ours = 100.0 * error(steps, n, Entry::Bytes);
        let note = "Eight bits add half a level, two in a thousand.";
        let what = format!("{name} table, n = {n}, entries of 8 bits: error");
        claims.push(TABLES.claim(what, "%", "< 1", ours, (Verdict::at_most(ours, 1.0, 1.5), note)));
    }
    claims
}

/// Diffuse light and the highlight on a triangle whose normals lie `degrees` apart, over random lights.
fn spread(degrees: f64) -> Result<[Claim; 2]> {
    let radius = (2.0 / 3f64.sqrt() * (degrees.to_radians() / 2.0).sin()).asin();
    let normals = [90f64, 210.0, 330.0].map(|turn| {
        let (s, c) = turn.to_radians().sin_cos();
        [radius.sin() * c, radius.sin() * s, radius.cos()]
    });
    let facet = Facet::new([[50.0, 5.0], [95.0, 85.0], [5.0, 85.0]], [0, 2, 1], [0, 2, 1].map(|k| normals[k]), [[0.0; 3]; 3]);
    let points: Vec<[f64; 2]> = (grid(10))
        .map(|weights| [0, 1].map(|axis| (0..3).map(|k| weights[k] * facet.screen[k][axis]).sum()))
        .filter(|p: &[f64; 2]| p[1] > 5.1 && p[1] < 84.99)
        .collect();
    let mut random = Random(81);
    let mut worst = [0f64; 2];
    for _ in 0..150 {
        let half = direction([1.2 * radius * random.normal(), 1.2 * radius * random.normal(), 1.0]);
        for (worst, material) in worst.iter_mut().zip([grey(1.0, 0.0, 1.0), grey(0.0, 1.0, 50.0)]) {
            // Light and viewer in one direction: H is there too.
            let frame = frame(100, vec![facet.clone()], Place::Far(half), Place::Far(half), material);
            let (shade, exact) = (method("taylor", &frame, &facet)?, phong(&frame, &facet));
            *worst = worst.max(largest(points.iter().map(|&p| (shade(p)[0] - exact(p)[0]).abs())));
        }
    }
    let mut titles = ["diffuse", "n = 50"].into_iter();
    Ok(worst.map(|error| {
        let verdict = Verdict::at_most(error, 2.55, 10.2);
        let note = match verdict {
            Verdict::Confirmed => "Within 1 % of full light.",
            Verdict::Close => "Within 4 % of full light.",
            _ => "Beyond 4 % of full light: the series, cut after second order, does not reach that far.",
        };
        let what = format!("normals {degrees} degrees apart, {}: error", titles.next().unwrap_or_default());
        SPREAD.claim(what, "LSB", "usable", error, (verdict, note))
    }))
}

/// A linear field of vectors: its values per x and y, and at the origin.
#[derive(Clone, Copy, Debug)]
struct Field([V3; 3]);

impl Field {
    fn random(random: &mut Random) -> Self {
        let slope = |random: &mut Random| scale(random.normals(), 0.3);
        Self([slope(random), slope(random), add(random.direction(), scale(random.normals(), 0.1))])
    }

    fn at(&self, x: f64, y: f64) -> V3 {
        let Self([a, b, c]) = *self;
        add(add(scale(a, x), scale(b, y)), c)
    }
}

/// The equation that the series starts from, with a light that is not of unit length.
fn diffuse() -> Claim {
    let mut random = Random(82);
    let (light, field) = (scale(random.direction(), 1.7), Field::random(&mut random));
    let (x, y) = (0.4, -0.3);
    let (n, l) = (field.at(x, y), length(light));
    let [a, b, c] = field.0.map(|v| dot(v, light));
    let linear = a * x + b * y + c;
    let printed = linear / l / (l * linear).abs();
    let corrected = linear / l / length(n);
    let note = "The second denominator is |Ax + By + C|, without |L| and without L's product";
    DUFF.formula("I_diff at a point, |L| = 1.7", [printed, corrected, dot(direction(light), direction(n))], note)
}

/// The series for a far light and a far viewer, on an example.
#[derive(Clone, Copy, Debug)]
struct Infinite {
    /// Products of the light with the field.
    light: [f64; 3],
    /// Coefficients of |N|².
    square: [f64; 6],
    /// By differences.
    truth: [f64; 6],
}

impl Infinite {
    fn example() -> Self {
        let mut random = Random(83);
        let (light, field) = (random.direction(), Field::random(&mut random));
        let [x, y, z] = field.0;
        Self {
            light: field.0.map(|v| dot(light, v)),
            square: [dot(x, x), 2.0 * dot(x, y), dot(y, y), 2.0 * dot(x, z), 2.0 * dot(y, z), dot(z, z)],
            truth: taylor(|x, y| dot(light, direction(field.at(x, y)))),
        }
    }

    /// With the factor of b·i that it should have, 2, or another.
    fn t1(&self, factor: f64) -> f64 {
        let ([_, b, c], [.., h, i]) = (self.light, self.square);
        (factor * b * i - c * h) / (2.0 * i * i.sqrt())
    }

    /// With the factor of b·g·i that it should have, 2, or another.
    fn t4(&self, factor: f64) -> f64 {
        let ([a, b, c], [_, e, _, g, h, i]) = (self.light, self.square);
        (3.0 * c * g * h - 2.0 * c * e * i - factor * b * g * i - 2.0 * a * h * i) / (4.0 * i * i * i.sqrt())
    }

    /// With the factor of 3g² that it should have, c, or another.
    fn t5(&self, factor: f64) -> f64 {
        let ([a, _, c], [d, _, _, g, _, i]) = (self.light, self.square);
        (3.0 * factor * g * g - 4.0 * c * d * i - 4.0 * a * g * i) / (8.0 * i * i * i.sqrt())
    }
}

/// The series for a far light and a far viewer.
fn infinite() -> [Claim; 2] {
    let series = Infinite::example();
    let ([a, b, c], [_, _, f, g, h, i]) = (series.light, series.square);
    let s = i.sqrt();
    let t2 = (2.0 * a * i - c * g) / (2.0 * i * s);
    let t3 = (3.0 * c * h * h - 4.0 * c * f * i - 4.0 * b * h * i) / (8.0 * i * i * s);
    let printed = [c / s, series.t1(2.0), t2, t3, series.t4(2.0)];
    let difference = largest(printed.iter().zip(series.truth).map(|(printed, truth)| (printed - truth).abs()));
    [
        INFINITE.identity("T0 to T4", difference, "Right as printed: largest difference to finite differences."),
        INFINITE.formula("T5 with 3ig²", [series.t5(i), series.t5(c), series.truth[5]], "It should read 3cg²"),
    ]
}

/// The series as Disselkoen quotes it.
pub(super) fn quoted() -> [Claim; 2] {
    let series = Infinite::example();
    [
        QUOTED.formula("T4 with 4bgi", [series.t4(4.0), series.t4(2.0), series.truth[4]], "It should read 2bgi"),
        QUOTED.formula("T1 with 3bi", [series.t1(3.0), series.t1(2.0), series.truth[1]], "It should read 2bi"),
    ]
}

/// Slips in the series for a near viewer.
#[derive(Clone, Copy, Debug, Default)]
struct Slips {
    /// m = E·E.
    m: bool,
    /// o = 2D·E.
    o: bool,
    /// T4: - fjlr.
    sign: bool,
    /// T4: - 2f²nr.
    square: bool,
    /// T5: - 4ajlr².
    factor: bool,
    /// T5: 2fjlp.
    power: bool,
}

/// The series for a near viewer: normals, and vectors along H.
fn series(Field([na, nb, nc]): Field, Field([ha, hb, hc]): Field, slips: Slips) -> [f64; 6] {
    let (a, b, c) = (dot(na, ha), dot(na, hb) + dot(nb, ha), dot(nb, hb));
    let (d, e, f) = (dot(na, hc) + dot(nc, ha), dot(nb, hc) + dot(nc, hb), dot(nc, hc));
    let (g, h, i) = (dot(na, na), 2.0 * dot(na, nb), dot(nb, nb));
    let (j, k, l) = (2.0 * dot(na, nc), 2.0 * dot(nb, nc), dot(nc, nc));
    let m = if slips.m { dot(hb, hb) } else { dot(ha, ha) };
    let n = 2.0 * dot(ha, hb);
    let o = if slips.o { n } else { dot(hb, hb) };
    let (p, q, r) = (2.0 * dot(ha, hc), 2.0 * dot(hb, hc), dot(hc, hc));
    let root = (l * r).sqrt();
    let (ll, rr) = (l * l, r * r);
    let sign = if slips.sign { -f * j * l * r } else { f * j * l * q * r };
    let square = if slips.square { f * f * n * r } else { f * ll * n * r };
    let factor = if slips.factor { a } else { d };
    let power = if slips.power { 1.0 } else { r };
    [
        f / root,
        (2.0 * e * l * r - f * k * r - f * l * q) / (2.0 * l * r * root),
        (2.0 * d * l * r - f * j * r - f * l * p) / (2.0 * l * r * root),
        (8.0 * c * ll * rr - 4.0 * e * k * l * rr - 4.0 * f * i * l * rr + 3.0 * f * k * k * rr - 4.0 * e * ll * q * r
            + 2.0 * f * k * l * q * r
            - 4.0 * f * ll * o * r
            + 3.0 * f * ll * q * q)
            / (8.0 * ll * rr * root),
        (4.0 * b * ll * rr - 2.0 * d * k * l * rr - 2.0 * e * j * l * rr - 2.0 * f * h * l * rr + 3.0 * f * j * k * rr
            - 2.0 * d * ll * q * r
            + sign
            - 2.0 * e * ll * p * r
            + f * k * l * p * r
            - 2.0 * square
            + 3.0 * f * ll * p * q)
            / (4.0 * ll * rr * root),
        (8.0 * a * ll * rr - 4.0 * factor * j * l * rr - 4.0 * f * g * l * rr + 3.0 * f * j * j * rr - 4.0 * d * ll * p * r
            + 2.0 * f * j * l * p * power
            - 4.0 * f * ll * m * r
            + 3.0 * f * ll * p * p)
            / (8.0 * ll * rr * root),
    ]
}

/// The series for a near viewer.
fn finite() -> Vec<Claim> {
    let mut random = Random(84);
    let normals = Field::random(&mut random);
    let halves = Field(Field::random(&mut random).0.map(|v| scale(v, 1.6)));
    let truth = taylor(|x, y| dot(direction(normals.at(x, y)), direction(halves.at(x, y))));
    let right = series(normals, halves, Slips::default());
    let difference = largest((0..4).map(|k| (right[k] - truth[k]).abs()));
    let mut claims = vec![FINITE.identity("T0 to T3", difference, "Right as printed: largest difference to finite differences.")];
    let slip = Slips::default();
    for (what, k, slips, note) in [
        ("T5 with m = E·E", 5, Slips { m: true, ..slip }, "m should read D·D"),
        ("T3 with o = 2D·E", 3, Slips { o: true, ..slip }, "o should read E·E"),
        ("T5 with - 4ajlr²", 5, Slips { factor: true, ..slip }, "It should read - 4djlr²"),
        ("T5 with + 2fjlp", 5, Slips { power: true, ..slip }, "It should read + 2fjlpr"),
        ("T4 with - fjlr", 4, Slips { sign: true, ..slip }, "It should read + fjlqr"),
        ("T4 with - 2f²nr", 4, Slips { square: true, ..slip }, "It should read - 2fl²nr"),
    ] {
        claims.push(FINITE.formula(what, [series(normals, halves, slips)[k], right[k], truth[k]], note));
    }
    claims
}
