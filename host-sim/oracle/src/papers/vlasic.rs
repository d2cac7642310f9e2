//! Higher-order interpolation and highlights by texture (Vlasic 2002).

use super::{Claim, Random, Source, Topic, Verdict, direction, frame, grey, largest, polynomial};
use crate::{Facet, Frame, Levels, Place, SIX, TEN, cubic, method, phong, quadratic, sum};
use anyhow::Result;
use microphong_models::{
    scene,
    shapes::bulged_triangle,
    vector::{V3, add, cross, dot, scale, sub},
};

const TRIANGLE: Source = Source(Topic::Vlasic, "table 6.1, triangle");
const TEAPOT: Source = Source(Topic::Vlasic, "table 6.1, teapot");
const FORMULAS: Source = Source(Topic::Vlasic, "4.2, 4.3, appendix A");
const FORWARD: Source = Source(Topic::Vlasic, "forward differencing");
const MAPS: Source = Source(Topic::Vlasic, "5, texture maps");
const APPENDIX: Source = Source(Topic::Vlasic, "appendix B");

/// A column of table 6.1.
struct Column {
    title: &'static str,
    /// Name of the method in rankings.
    short: &'static str,
    /// The oracle's name.
    method: &'static str,
    triangle: f64,
    teapot: f64,
}

const TABLE: [Column; 6] = [
    Column { title: "Gouraud", short: "G", method: "gouraud", triangle: 0.7644, teapot: 0.9870 },
    Column { title: "quadratic", short: "Q", method: "six-point", triangle: 0.8970, teapot: 0.9939 },
    Column { title: "cubic", short: "C", method: "cubic", triangle: 0.9058, teapot: 0.9949 },
    Column { title: "environment map", short: "E", method: "environment", triangle: 0.5589, teapot: 0.9872 },
    Column { title: "Blinn map", short: "B", method: "blinn", triangle: 0.8205, teapot: 0.9886 },
    Column { title: "quadratic Blinn map", short: "QB", method: "quadratic-blinn", triangle: 0.9311, teapot: 0.9888 },
];

/// Exponent of the highlight of our triangle.
const EXPONENT: f64 = 20.0;

pub(super) fn claims() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    let triangle = triangle(EXPONENT);
    let pixels: Vec<_> = triangle.facets[0].pixels(triangle.size).map(|pixel| (0, pixel)).collect();
    let ours = correctness(&triangle, &pixels)?;
    claims.extend(table(TRIANGLE, "his normals, light and exponent are not printed", TABLE.map(|c| c.triangle), ours));
    claims.push(exponents()?);

    let teapot = scene::load("teapot")?;
    let frame = Frame::new(teapot.stream.parse()?, teapot.size, 0);
    let width = frame.size.0;
    let mut pixels: Vec<_> = (0..)
        .zip(frame.visible())
        .filter_map(|(at, sights): (u32, _)| Some((*sights.iter().flatten().next()? as usize, [at % width, at / width])))
        .collect();
    pixels.sort_unstable();
    let ours = correctness(&frame, &pixels)?;
    claims.extend(table(TEAPOT, "his mesh, light and colours are not printed", TABLE.map(|c| c.teapot), ours));

    claims.extend([nodes(), cubic_monomials(), forward()]);
    claims.extend([10.0, 30.0, 60.0, 90.0].map(spherical));
    claims.push(matcap());
    claims.push(axis());
    Ok(claims)
}

/// A flat triangle with a light close in front of it, with the highlight only: the prototypes' `vtri_flat_spec`.
fn triangle(exponent: f64) -> Frame {
    const SIDE: u32 = 256;
    let mesh = bulged_triangle();
    let corners = [0, 2, 1];
    let screen = corners.map(|k| {
        let [x, y, _] = mesh.positions[k];
        [x, -y].map(|c| f64::from(SIDE) * (0.5 + 0.45 * c))
    });
    let facet = Facet::new(screen, corners, [[0.0, 0.0, 1.0]; 3], corners.map(|k| mesh.positions[k]));
    frame(SIDE, vec![facet], Place::Near([0.1, -0.15, 1.0]), Place::Near([0.0, 0.0, 3.0]), grey(0.0, 1.0, exponent))
}

/// Colour correctness of each method: one minus the mean difference to Phong over all channels of the pixels given,
/// which come with their facets, facet by facet.
fn correctness(frame: &Frame, pixels: &[(usize, [u32; 2])]) -> Result<[f64; 6]> {
    let mut sums = [0.0; 6];
    for part in pixels.chunk_by(|a, b| a.0 == b.0) {
        let Some(facet) = part.first().and_then(|first| frame.facets.get(first.0)) else { continue };
        let exact = phong(frame, facet);
        let exact: Vec<Levels> = part.iter().map(|pixel| exact(super::centre(pixel.1))).collect();
        for (sum, column) in sums.iter_mut().zip(&TABLE) {
            let shade = method(column.method, frame, facet)?;
            for ((_, pixel), exact) in part.iter().zip(&exact) {
                let levels = shade(super::centre(*pixel));
                *sum += levels.iter().zip(exact).map(|(a, b)| (a.round() - b.round()).abs()).sum::<f64>();
            }
        }
    }
    Ok(sums.map(|sum| 1.0 - sum / (3.0 * 255.0 * pixels.len().max(1) as f64)))
}

/// A scene of table 6.1, and the order of the methods in it.
fn table(source: Source, unknown: &str, paper: [f64; 6], ours: [f64; 6]) -> Vec<Claim> {
    let mut claims: Vec<_> = (0..6)
        .map(|k| {
            // The share of the light that is wrong says more than the share that is right.
            let (theirs, found) = (1.0 - paper[k], 1.0 - ours[k]);
            let ratio = (found / theirs).max(theirs / found);
            let judged = if ratio <= 1.05 {
                (Verdict::Confirmed, "The errors are the same within 5 %.".to_owned())
            } else if ratio <= 2.0 {
                (Verdict::Close, format!("The errors differ by a factor of {ratio:.2}; {unknown}."))
            } else {
                (Verdict::NotReproducible, format!("The errors differ by a factor of {ratio:.2}; {unknown}."))
            };
            source.claim(format!("colour correctness of {} ({})", TABLE[k].title, TABLE[k].short), "", paper[k], ours[k], judged)
        })
        .collect();
    let pairs = swapped(paper, ours);
    let judged = match pairs.len() {
        0 => (Verdict::Confirmed, "The same order.".to_owned()),
        1..=2 => (Verdict::Close, format!("Of 15 pairs all but {} are in the same order.", pairs.join(", "))),
        _ => (Verdict::NotReproducible, format!("Of 15 pairs {} are the other way round; {unknown}.", pairs.join(", "))),
    };
    claims.push(source.claim("order, best first", "", ranking(paper), ranking(ours), judged));
    claims
}

/// The pairs of methods that two rankings have in different order.
fn swapped(paper: [f64; 6], ours: [f64; 6]) -> Vec<String> {
    let pairs = (0..6).flat_map(|i| (0..i).map(move |j| (i, j)));
    let swapped = pairs.filter(|&(i, j)| (paper[i] < paper[j]) != (ours[i] < ours[j]));
    swapped.map(|(i, j)| format!("{}/{}", TABLE[j].short, TABLE[i].short)).collect()
}

/// The triangle's order for other highlights.
fn exponents() -> Result<Claim> {
    let mut best: Option<(Vec<String>, f64)> = None;
    for exponent in [3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 32.0, 64.0] {
        let frame = triangle(exponent);
        // Every seventh pixel in both directions is enough for an order.
        let pixels: Vec<_> =
            (frame.facets[0].pixels(frame.size)).filter(|[x, y]| x % 7 == 3 && y % 7 == 3).map(|pixel| (0, pixel)).collect();
        let pairs = swapped(TABLE.map(|c| c.triangle), correctness(&frame, &pixels)?);
        if best.as_ref().is_none_or(|(fewest, _)| pairs.len() < fewest.len()) {
            best = Some((pairs, exponent));
        }
    }
    let (pairs, exponent) = best.unwrap_or_default();
    let verdict = if pairs.is_empty() { Verdict::Confirmed } else { Verdict::Close };
    let note = format!("The order depends on the exponent, which is not printed: at n = {exponent} only {} differs.", pairs.join(", "));
    Ok(TRIANGLE.claim("pairs out of order, best n of 3 to 64", "", 0.0, pairs.len() as f64, (verdict, note)))
}

/// The methods, best first.
fn ranking(values: [f64; 6]) -> String {
    let mut order = [0, 1, 2, 3, 4, 5];
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    order.map(|k| TABLE[k].short).join(">")
}

/// His quadratic in s and t, from values at v0, mid s, v1, mid hypotenuse, v2, mid t.
fn quadratic_in([r0, r1, r2, r3, r4, r5]: [f64; 6]) -> [f64; 6] {
    [
        r0,
        -3.0 * r0 - r4 + 4.0 * r5,
        -3.0 * r0 + 4.0 * r1 - r2,
        2.0 * r0 + 2.0 * r4 - 4.0 * r5,
        4.0 * r0 - 4.0 * r1 + 4.0 * r3 - 4.0 * r5,
        2.0 * r0 - 4.0 * r1 + 2.0 * r2,
    ]
}

/// The printed quadratic against Lagrange's form.
fn nodes() -> Claim {
    let mut random = Random(61);
    let values = [(); 6].map(|()| random.between(0.0, 255.0));
    // The corners v0, v1, v2, then the midpoints 01, 12, 20.
    let [v0, v1, v2, v01, v12, v20] = values;
    let t = quadratic_in([v0, v01, v1, v12, v2, v20]);
    let difference = largest((0..100).map(|_| {
        let (x, y) = (random.share(), random.share());
        (polynomial(t, x, y) - sum(&quadratic([1.0 - x - y, x, y]), &values)).abs()
    }));
    FORMULAS.identity("quadratic through six values, in s and t", difference, "It meets its six nodes and so is Lagrange's quadratic.")
}

/// The monomials of the cubic against Lagrange's form.
fn cubic_monomials() -> Claim {
    let mut random = Random(62);
    let values = TEN.map(|_| random.between(0.0, 255.0));
    let [v0, v1, v2, a1, a2, b1, b2, c1, c2, m] = values;
    let printed = |s: f64, t: f64| {
        let along = |v: f64, near: f64, far: f64, u: f64| {
            (-5.5 * v0 + v + 9.0 * near - 4.5 * far) * u
                + (9.0 * v0 - 4.5 * v - 22.5 * near + 18.0 * far) * u * u
                + 4.5 * (v - v0 + 3.0 * near - 3.0 * far) * u.powi(3)
        };
        let across = 18.0 * v0 - 22.5 * (a1 + c2) + 4.5 * (a2 + c1) - 4.5 * (b1 + b2) + 27.0 * m;
        let st2 = -13.5 * v0 + 27.0 * c2 - 13.5 * c1 + 13.5 * b2 + 13.5 * a1 - 27.0 * m;
        let s2t = -13.5 * v0 + 27.0 * a1 - 13.5 * a2 + 13.5 * b1 + 13.5 * c2 - 27.0 * m;
        v0 + along(v1, a1, a2, s) + along(v2, c2, c1, t) + across * s * t + s2t * s * s * t + st2 * s * t * t
    };
    let difference = largest((0..100).map(|_| {
        let (s, t) = (random.share(), random.share());
        (printed(s, t) - sum(&cubic([1.0 - s - t, s, t]), &values)).abs()
    }));
    FORMULAS.identity("cubic through ten values, in s and t", difference, "It meets its ten nodes and so is Lagrange's cubic.")
}

/// A quadratic in affine s, t, walked along a row by two additions per pixel.
fn forward() -> Claim {
    let mut random = Random(63);
    let mut point = || [random.between(0.0, 256.0), random.between(0.0, 256.0)];
    let facet = Facet::new([point(), point(), point()], [0, 1, 2], [[0.0, 0.0, 1.0]; 3], [[0.0; 3]; 3]);
    let values = SIX.map(|_| random.between(0.0, 255.0));
    let at = |x: f64| sum(&quadratic(facet.weights([x, 100.5])), &values);
    let (mut value, mut first) = (at(0.5), at(1.5) - at(0.5));
    let second = at(2.5) - 2.0 * at(1.5) + at(0.5);
    let mut worst = 0f64;
    for x in 0..256 {
        worst = worst.max((value - at(f64::from(x) + 0.5)).abs() / (1.0 + value.abs()));
        value += first;
        first += second;
    }
    let verdict = if worst < super::SAME { Verdict::Refuted } else { Verdict::Confirmed };
    let note = "With s and t affine on the screen two additions per pixel give the quadratic, but for this rounding error.";
    FORWARD.claim("in s and t: relative error over 256 pixels", "", "impossible", worst, (verdict, note))
}

/// Largest distance of a great circle's (u, v) from the parabola through start, middle and end.
fn spherical(degrees: f64) -> Claim {
    let arc = degrees.to_radians();
    // A coordinate along the arc runs as a cosine with some phase.
    let deviation = largest((0..180).flat_map(|phase| {
        let f = move |t: f64| (arc * t + f64::from(phase).to_radians()).cos();
        let parabola = move |t: f64| f(0.0) * (1.0 - t) * (1.0 - 2.0 * t) + f(0.5) * 4.0 * t * (1.0 - t) + f(1.0) * t * (2.0 * t - 1.0);
        (0..=100).map(move |k| (f(f64::from(k) / 100.0) - parabola(f64::from(k) / 100.0)).abs())
    }));
    let verdict = if deviation < super::SAME { Verdict::Confirmed } else { Verdict::Refuted };
    let note = format!(
        "On a sphere (u,v) run along an arc of an ellipse, not a parabola: the deviation is {:.4} times the angle cubed.",
        deviation / arc.powi(3)
    );
    MAPS.claim(format!("quadratic Blinn, arc of {degrees} degrees: (u,v) off by"), "", "identical", deviation, (verdict, note))
}

/// With a far viewer the coordinates in the sphere map are the normal's.
fn matcap() -> Claim {
    let mut random = Random(64);
    let difference = largest((0..1000).map(|_| {
        let [x, y, z] = random.direction();
        let (n, v) = ([x, y, z.abs()], [0.0, 0.0, 1.0]);
        let w = sub(scale(n, 2.0 * dot(n, v)), v);
        let m = (w[0] * w[0] + w[1] * w[1] + (w[2] + 1.0).powi(2)).sqrt();
        (w[0] / m - n[0]).abs().max((w[1] / m - n[1]).abs())
    }));
    let verdict = if difference < super::SAME { Verdict::Refuted } else { Verdict::Confirmed };
    let note = "With a far viewer the map's (u,v) are the normal's x and y, so it can hold any N·H; this is their difference.";
    MAPS.claim("environment maps cannot hold Blinn's highlight", "", "impossible", difference, (verdict, note))
}

/// cos² of the angle to H from Blinn-map coordinates, the axis left as long as it comes.
fn axis() -> Claim {
    let (half, normal): (V3, V3) = (direction([0.3, 0.6, 0.8]), direction([0.1, 0.9, 0.5]));
    let up = [0.0, 1.0, 0.0];
    let raw = sub(up, scale(half, dot(up, half)));
    let cosine = |x: V3| {
        let y = cross(half, x);
        let across = add(normal, scale(half, -dot(normal, half)));
        1.0 - dot(x, across).powi(2) - dot(y, across).powi(2)
    };
    let values = [cosine(raw), cosine(direction(raw)), dot(normal, half).powi(2)];
    APPENDIX.formula("(N·H)² from u and v, u not normalised", values, "u = up - (up·H)H must be normalised, as the text says")
}
