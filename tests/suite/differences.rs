//! Walked polynomials against exact ones, with the bounds that the documentation promises.
//!
//! Walking costs [`WALKED_QUADRATIC`] (1 + S + S²), S the columns plus rows between pixel and anchor: coefficients are rounded
//! once, there; a plane costs [`WALKED_LINEAR`] (1 + S). The anchor is the middle of what is drawn, or the top corner of triangles below
//! 128 pixels, so S is at most
//! half the width plus half the height of the screen, or 256. Set-up costs more the thinner the triangle: with k its
//! length over its height, [`QUADRATIC`] k² and [`LINEAR`] k, a part of the nodes' range; slivers' quadratics are
//! fitted exactly. Levels of three channels are walked with one bit less: the parts that come from rounding are twice as large then. On
//! triangles below 64 pixels first derivatives are rounded per 1/16 pixel, which costs up to
//! [`SMALL_QUADRATIC`] and [`SMALL_LINEAR`] times 1 + S more. Cubics are set up in 128 bits: they cost
//! [`WALKED_CUBIC`] (1 + S + S² + S³), [`CUT`] and [`CUBIC`] k.

use microphong::{
    format::{BIAS, CHANNEL, LEVEL, WALK},
    interpolate::{Patch, Walker, plane::Plane, quadric::Quadric},
    setup::{
        gradients::{Gradients, MAX_THINNESS},
        steepness::{CURVATURE, SLOPE, Steepness},
    },
};
use microphong_literature::cubic::field::CubicPatch;
use microphong_sim::stress::{coverage::side, random::Random};
use microphong_tests::{cases, seed};
use std::{f64::consts::TAU, ops::Range};

/// The unit of walked levels.
const LSB: f64 = 1.0 / (1u64 << WALK) as f64;
/// Error of a walked quadratic for each squared pixel of the way from the anchor, LSB.
const WALKED_QUADRATIC: f64 = 1.0 / (1u64 << 24) as f64;
/// Error of a walked plane for each pixel of the way from the anchor, LSB.
const WALKED_LINEAR: f64 = 1.0 / (1u64 << 23) as f64;
/// Error of a walked cubic for each cubed pixel of the way from the anchor, LSB.
const WALKED_CUBIC: f64 = 1.0 / (1u64 << 54) as f64;
/// Error of a cubic's value by the bits that are cut off, LSB.
const CUT: f64 = 1.0 / (1u64 << 23) as f64;

/// Set-up error of a quadratic on a triangle as long as high, LSB.
const QUADRATIC: f64 = 255.0 / (1u64 << 22) as f64;
/// Set-up error of a cubic on a triangle as long as high, LSB.
const CUBIC: f64 = 255.0 / (1u64 << 22) as f64;
/// Set-up error of a plane on a triangle as long as high, LSB.
const LINEAR: f64 = 255.0 / (1u64 << 28) as f64;
/// Set-up error of a plane whose nodes have 20 bits, as those of depth, on a triangle as long as high, LSB.
const LINEAR_FINER: f64 = 255.0 / (1u64 << 22) as f64;
/// Error by the first derivatives of a quadratic on a small triangle, for each pixel of the way from the anchor, LSB.
const SMALL_QUADRATIC: f64 = 1.0 / (1u64 << 14) as f64;
/// Error by the first derivatives of a plane on a small triangle, for each pixel of the way from the anchor, LSB.
const SMALL_LINEAR: f64 = 1.0 / (1u64 << 19) as f64;
/// Up to this far from its first corner, 1/16 pixel, a triangle is small.
const SMALL: i64 = 1 << 10;

/// Screen and triangle, 1/16 pixel.
struct Case {
    width: i32,
    height: i32,
    corners: [[i32; 2]; 3],
}

fn case(random: &mut Random, kind: usize) -> Case {
    let (width, height) = [(320, 240), (320, 240), (320, 240), (1920, 1080), (4096, 4096), (320, 240)][kind];
    let (w, h) = (width * 16, height * 16);
    let corners = match kind {
        // Tiny.
        1 => {
            let (x, y) = (random.pick(64..w - 64), random.pick(64..h - 64));
            [0; 3].map(|_| [x + random.pick(-48..48), y + random.pick(-48..48)])
        }
        // A full screen, corner to corner.
        4 if random.pick(0..10) == 0 => [[0, 0], [w, random.pick(0..99)], [random.pick(0..99), h]],
        // Slivers, 0.1 to 8 pixels high.
        2 => {
            let a = [random.pick(0..w), random.pick(0..h)];
            let b = [random.pick(0..w), random.pick(0..h)];
            let k = random.pick(0..1000);
            let c = [0, 1].map(|i| a[i] + (b[i] - a[i]) * k / 1000 + random.pick(-128..128));
            [a, b, c]
        }
        // Far beyond the viewport.
        5 => [0; 3].map(|_| [random.pick(-32_000..32_000), random.pick(-32_000..32_000)]),
        _ => [0; 3].map(|_| [random.pick(0..w), random.pick(0..h)]),
    };
    Case { width, height, corners }
}

/// Squared distance.
fn square(a: [i32; 2], b: [i32; 2]) -> f64 {
    f64::from(b[0] - a[0]).powi(2) + f64::from(b[1] - a[1]).powi(2)
}

/// The farthest that the other corners lie from the first one, in columns or rows.
fn reach(c: [[i32; 2]; 3]) -> i64 {
    [c[1], c[2]].as_flattened().iter().zip([c[0]; 2].as_flattened()).map(|(a, b)| i64::from((a - b).abs())).max().unwrap()
}

/// The box of a triangle, as far as it lies within the viewport; empty if none of it does.
fn visible(case: &Case) -> [i32; 4] {
    let range = |k: usize, end: i32| {
        let places = case.corners.map(|corner| corner[k] >> 4);
        (places.into_iter().fold(end, i32::min).max(0), (places.into_iter().fold(0, i32::max) + 1).min(end))
    };
    let ((left, right), (top, bottom)) = (range(0, case.width), range(1, case.height));
    [left, top, right, bottom]
}

/// Error by the move of a quadratic's coefficients from the first corner to the anchor with twelve more bits, LSB.
fn moving(gradients: &Gradients, corners: [[i32; 2]; 3]) -> f64 {
    let top = corners[0].map(|c| c >> 4);
    let moved = f64::from((gradients.column() - top[0]).abs() + (gradients.row() - top[1]).abs());
    // Half a unit of each second derivative; products with the offset are cut, which costs a first derivative three units more, and the
    // value five.
    2f64.powi(-13) * LSB * (11.0 + 7.0 * moved + moved * moved)
}

/// Barycentric coordinates of a point.
fn barycentric(c: [[i32; 2]; 3], p: [i32; 2]) -> [f64; 3] {
    let whole = side(c[0], c[1], c[2]) as f64;
    [(c[1], c[2]), (c[2], c[0]), (c[0], c[1])].map(|(a, b)| side(a, b, p) as f64 / whole)
}

/// The columns of `row` whose centres lie inside, and within the viewport.
fn span(case: &Case, row: i32) -> Range<i32> {
    let c = case.corners;
    let y = f64::from(row * 16 + 8);
    let (mut left, mut right) = (f64::from(case.width * 16), 0f64);
    for (a, b) in [(c[0], c[1]), (c[1], c[2]), (c[2], c[0])] {
        let (ay, by) = (f64::from(a[1]), f64::from(b[1]));
        if (ay <= y) != (by <= y) {
            let x = f64::from(a[0]) + (y - ay) / (by - ay) * f64::from(b[0] - a[0]);
            (left, right) = (left.min(x), right.max(x));
        }
    }
    let first = ((left.max(0.0) - 8.0) / 16.0).ceil() as i32;
    let last = ((right.min(f64::from(case.width * 16)) - 8.0) / 16.0).floor() as i32;
    first..last + 1
}

#[test]
fn quadratics_of_100_000_random_triangles_stay_within_the_bound() {
    let mut random = Random::new(seed(), 3);
    let (mut triangles, mut slivers, mut pixels, mut longest) = (0, 0, 0u64, 0);
    let mut worst = [(0f64, 0f64); 6];
    for i in 0..cases(150_000) as usize {
        let kind = i % 6;
        let mut case = case(&mut random, kind);
        if side(case.corners[0], case.corners[1], case.corners[2]) < 0 {
            case.corners.swap(1, 2);
        }
        let c = case.corners;
        let visible = visible(&case);
        if visible[0] >= visible[2] || visible[1] >= visible[3] {
            continue;
        }
        let Some(gradients) = Gradients::new(c, visible) else { continue };
        triangles += 1;
        let nodes: [i32; 6] = std::array::from_fn(|_| random.pick(0..255 << LEVEL));
        // As one channel is walked, or as one of three.
        let (walk, coarser) = if i / 6 % 2 == 0 { (WALK, 1.0) } else { (CHANNEL, 2.0) };
        let mut patch = Quadric::<1>::fit::<15>(&gradients, &[nodes], walk - LEVEL, [0]);
        // Longest edge over the height on it.
        let longest2 = (0..3).map(|k| square(c[k], c[(k + 1) % 3])).fold(0.0, f64::max);
        let thinness = longest2 / side(c[0], c[1], c[2]) as f64;
        // Gradients are measured from its first corner.
        let extent = reach(c);
        let sliver = extent * extent > side(c[0], c[1], c[2]) * MAX_THINNESS;
        slivers += u32::from(sliver);
        let setup = if sliver { 0.0 } else { QUADRATIC * thinness * thinness };
        let moving = moving(&gradients, c);
        let rows = [visible[1], visible[3] - 1, random.pick(visible[1]..visible[3])];
        let mut at = gradients.row();
        for row in rows {
            let columns = span(&case, row);
            if columns.is_empty() {
                continue;
            }
            patch.jump(row - at);
            at = row;
            longest = longest.max(columns.len());
            let mut walker = patch.enter(columns.end);
            for x in columns.rev() {
                walker.step();
                let [walked] = walker.value();
                let b = barycentric(c, [x * 16 + 8, row * 16 + 8]);
                let n = nodes.map(|node| f64::from(node) / 128.0);
                let exact = (0..3).map(|k| b[k] * (2.0 * b[k] - 1.0) * n[k]).sum::<f64>()
                    + 4.0 * (b[0] * b[1] * n[3] + b[1] * b[2] * n[4] + b[2] * b[0] * n[5]);
                let error = (f64::from(walked as i32) / f64::from(1 << walk) - exact).abs();
                // Values of one channel wrap: 341 LSB is as far from 0 as -171.
                let error = if walk == WALK { error.min((error - 512.0).abs()) } else { error };
                let distance = f64::from((x - gradients.column()).abs() + (row - gradients.row()).abs());
                let walking = WALKED_QUADRATIC * (1.0 + distance + distance * distance);
                let small = if extent <= SMALL { SMALL_QUADRATIC * (1.0 + distance) } else { 0.0 };
                let bound = coarser * (walking + moving + small) + setup;
                worst[kind] = (worst[kind].0.max(error), worst[kind].1.max(error / bound));
                assert!(error <= bound, "triangle {i} {c:?}, pixel {x},{row}: error {error}, bound {bound}");
                pixels += 1;
            }
        }
    }
    println!("{triangles} triangles, {slivers} slivers among them, {pixels} pixels, longest span {longest}");
    for (name, (error, share)) in ["320x240", "tiny", "sliver", "1920x1080", "4096x4096", "clipped"].iter().zip(worst) {
        println!("{name:10} worst error {error:.5} LSB, {share:.2} of the bound");
    }
    assert!(triangles >= 100_000 && slivers >= 1_000 && longest > 3_900);
}

#[test]
fn cubics_stay_within_the_bound() {
    let mut random = Random::new(seed(), 5);
    let mut worst = [(0f64, 0f64); 6];
    let (mut triangles, mut slivers) = (0, 0);
    for i in 0..cases(150_000) as usize {
        let kind = i % 6;
        let mut case = case(&mut random, kind);
        if side(case.corners[0], case.corners[1], case.corners[2]) < 0 {
            case.corners.swap(1, 2);
        }
        let c = case.corners;
        let visible = visible(&case);
        let [left, top, right, bottom] = visible;
        if left >= right || top >= bottom {
            continue;
        }
        let Some(gradients) = Gradients::new(c, visible) else { continue };
        triangles += 1;
        let nodes: [i32; 10] = std::array::from_fn(|_| random.pick(0..255 << LEVEL));
        let mut patch = CubicPatch::<1>::fit(&gradients, &[nodes], WALK - LEVEL, [BIAS << WALK]);
        // Longest edge over the height on it.
        let longest2 = (0..3).map(|k| square(c[k], c[(k + 1) % 3])).fold(0.0, f64::max);
        let thinness = longest2 / side(c[0], c[1], c[2]) as f64;
        let extent = reach(c);
        let sliver = extent * extent > side(c[0], c[1], c[2]) * MAX_THINNESS;
        slivers += u32::from(sliver);
        let setup = if sliver { 0.0 } else { CUBIC * thinness };
        let mut at = gradients.row();
        for row in [top, bottom - 1, random.pick(top..bottom)] {
            let columns = span(&case, row);
            if columns.is_empty() {
                continue;
            }
            patch.jump(row - at);
            at = row;
            let mut walker = patch.enter(columns.end);
            for x in columns.rev() {
                walker.step();
                let [walked] = walker.value();
                let b = barycentric(c, [x * 16 + 8, row * 16 + 8]);
                let n = nodes.map(|node| f64::from(node) / 128.0);
                let corner = |k: usize| b[k] * (3.0 * b[k] - 1.0) * (3.0 * b[k] - 2.0) / 2.0;
                let edge = |near: usize, far: usize| 4.5 * b[near] * b[far] * (3.0 * b[near] - 1.0);
                let thirds = [(0, 1), (1, 0), (1, 2), (2, 1), (2, 0), (0, 2)];
                let exact = (0..3).map(|k| corner(k) * n[k]).sum::<f64>()
                    + thirds.iter().zip(&n[3..]).map(|(&(near, far), n)| edge(near, far) * n).sum::<f64>()
                    + 27.0 * b[0] * b[1] * b[2] * n[9];
                // Clamped to what a walked level can hold.
                let exact = (exact + f64::from(BIAS)).clamp(0.0, 512.0);
                let error = (f64::from(walked) / f64::from(1 << WALK) - exact).abs();
                let distance = f64::from((x - gradients.column()).abs() + (row - gradients.row()).abs());
                // The last bits are cut off.
                let bound = CUT + WALKED_CUBIC * (1.0 + distance + distance.powi(2) + distance.powi(3)) + setup;
                worst[kind] = (worst[kind].0.max(error), worst[kind].1.max(error / bound));
                assert!(error <= bound, "triangle {i} {c:?}, pixel {x},{row}: error {error}, bound {bound}");
            }
        }
    }
    println!("{triangles} triangles, {slivers} slivers among them");
    for (name, (error, share)) in ["320x240", "tiny", "sliver", "1920x1080", "4096x4096", "clipped"].iter().zip(worst) {
        println!("{name:10} worst error {error:.7} LSB, {share:.2} of the bound");
    }
    assert!(triangles >= 100_000 && slivers >= 1_000);
}

#[test]
fn planes_stay_within_the_bound_even_on_slivers() {
    let mut random = Random::new(seed(), 4);
    let mut worst = 0f64;
    for i in 0..cases(60_000) as usize {
        let mut case = case(&mut random, [0, 1, 2, 2, 2, 5][i % 6]);
        if side(case.corners[0], case.corners[1], case.corners[2]) < 0 {
            case.corners.swap(1, 2);
        }
        let Some(gradients) = Gradients::new(case.corners, [0, 0, case.width, case.height]) else { continue };
        // Levels with as many bits as nodes have, or with four more.
        let finer = 4 * (i as u32 / 6 % 2);
        let nodes: [i32; 3] = std::array::from_fn(|_| random.pick(0..255 << (LEVEL + finer)));
        let extent = |k: usize| case.corners.iter().map(|c| c[k]).max().unwrap() - case.corners.iter().map(|c| c[k]).min().unwrap();
        let size = f64::from(extent(0).max(extent(1)));
        let thinness = size * size / side(case.corners[0], case.corners[1], case.corners[2]) as f64;
        let (mut plane, setup) = match finer {
            0 => (Plane::<1>::fit::<15>(&gradients, &[nodes], WALK - LEVEL, [0]), LINEAR),
            _ => (Plane::<1>::fit::<20>(&gradients, &[nodes], WALK - LEVEL - finer, [0]), LINEAR_FINER),
        };
        let mut at = gradients.row();
        for row in 0..case.height {
            let columns = span(&case, row);
            if columns.is_empty() {
                continue;
            }
            plane.jump(row - at);
            at = row;
            let mut walker = plane.enter(columns.end);
            for x in columns.rev() {
                walker.step();
                let [walked] = walker.value();
                let b = barycentric(case.corners, [x * 16 + 8, row * 16 + 8]);
                let exact: f64 = (0..3).map(|k| b[k] * f64::from(nodes[k] << (4 - finer)) / 2048.0).sum();
                let error = (f64::from(walked as i32) / f64::from(1 << WALK) - exact).abs();
                let distance = f64::from((x - gradients.column()).abs() + (row - gradients.row()).abs());
                let small = if reach(case.corners) <= SMALL { SMALL_LINEAR * (1.0 + distance) } else { 0.0 };
                let bound = WALKED_LINEAR * (1.0 + distance) + setup * thinness + small;
                worst = worst.max(error / bound);
                assert!(error <= bound, "triangle {i} {:?}, pixel {x},{row}: error {error}, bound {bound}", case.corners);
            }
        }
    }
    println!("worst error {worst:.2} of the bound");
}

/// Error of a field of 26 bits on a small triangle, for each pixel of the way from the anchor, in units of the walked format.
const LONG_SMALL: f64 = 16.0;
/// Set-up error of a plane of 26 bits on a triangle as long as high, in units of its nodes.
const LONG_LINEAR: f64 = 1.0 / 16.0;
/// Set-up error of a quadratic of 26 bits on a triangle as long as high, in units of its nodes.
const LONG_QUADRATIC: f64 = 2.0;
/// Ratio of length to height from which on set-up of a quadratic of 26 bits adds nothing, on a triangle that is not word-sized.
const LONG_THINNESS: i64 = 16;

#[test]
fn fields_of_26_bits_stay_within_the_bound() {
    let mut random = Random::new(seed(), 6);
    let (mut triangles, mut worst) = (0, [0f64; 2]);
    for i in 0..cases(200_000) {
        // From a pixel to 2048, and slivers among them.
        let size = 16 << (i % 12);
        let mut corners = [0; 3].map(|_| [2000 + random.pick(-size / 2..size / 2), 2000 + random.pick(-size / 2..size / 2)]);
        if random.once_in(2) {
            let (part, off) = (random.pick(0..1000), size / random.among(&[8, 32, 128]));
            corners[2] = [0, 1].map(|k| corners[0][k] + (corners[1][k] - corners[0][k]) * part / 1000 + random.pick(-off..off + 1));
        }
        if side(corners[0], corners[1], corners[2]) < 0 {
            corners.swap(1, 2);
        }
        let case = Case { width: 320, height: 240, corners };
        let visible = visible(&case);
        let Some(gradients) = Gradients::new(corners, visible) else { continue };
        triangles += 1;
        let longest2 = (0..3).map(|k| square(corners[k], corners[(k + 1) % 3])).fold(0.0, f64::max);
        let thinness = longest2 / side(corners[0], corners[1], corners[2]) as f64;
        // Nodes that differ by a lot, or by little.
        let range = 1 << random.pick(1..27);
        let least = random.pick(-(1 << 25)..(1 << 25) + 1 - range / 2);
        let nodes: [i32; 6] = std::array::from_fn(|_| least + random.pick(0..range / 2 + 1));
        let [a, b, c, ..] = nodes;
        let extra = 5 + i as u32 / 7 % 2;
        let mut plane = Plane::<1>::fit::<26>(&gradients, &[[a, b, c]], extra, [0]);
        let mut quadric = Quadric::<1>::fit::<26>(&gradients, &[nodes], extra, [0]);
        let is_word_sized = Gradients::if_word_sized(corners).is_some();
        let is_thin = reach(corners).pow(2) > side(corners[0], corners[1], corners[2]) * LONG_THINNESS;
        let bend = if is_thin && !is_word_sized { 0.0 } else { LONG_QUADRATIC };
        let moving = moving(&gradients, corners) / LSB;
        let small = if is_word_sized { LONG_SMALL } else { 0.0 };
        let [_, first, _, end] = visible;
        let mut at = gradients.row();
        for row in first..end {
            let columns = span(&case, row);
            plane.jump(row - at);
            quadric.jump(row - at);
            at = row;
            let (mut linear, mut quadratic) = (plane.enter(columns.end), quadric.enter(columns.end));
            // An error is a polynomial of the place, too: it is largest at an end of the row, or changes little from pixel to pixel there.
            let judged = |x: i32| x == columns.start || x + 1 == columns.end || (x + row) % 8 == 0;
            for x in columns.clone().rev() {
                linear.step();
                quadratic.step();
                if !judged(x) {
                    continue;
                }
                let b = barycentric(corners, [x * 16 + 8, row * 16 + 8]);
                let n = nodes.map(f64::from);
                let straight = (0..3).map(|k| b[k] * n[k]).sum::<f64>();
                let curved = (0..3).map(|k| b[k] * (2.0 * b[k] - 1.0) * n[k]).sum::<f64>()
                    + 4.0 * (b[0] * b[1] * n[3] + b[1] * b[2] * n[4] + b[2] * b[0] * n[5]);
                let distance = f64::from((x - gradients.column()).abs() + (row - gradients.row()).abs());
                let units = f64::from(1 << extra);
                for (k, walked, exact, part, far) in [
                    (0, linear.value(), straight, LONG_LINEAR * thinness, 0.0),
                    (1, quadratic.value(), curved, bend * thinness * thinness, distance * distance),
                ] {
                    let error = (f64::from(walked[0] as i32) - exact * units).abs();
                    let error = error.min((error - 2f64.powi(32)).abs());
                    let bound = 0.5 * (1.0 + distance + far) + moving + small * (1.0 + distance) + part * units;
                    worst[k] = worst[k].max(error / bound);
                    assert!(error <= bound, "triangle {i} {corners:?}, pixel {x},{row}: error {error}, bound {bound}, {thinness}, {range}");
                }
            }
        }
    }
    println!("{triangles} triangles; worst error of planes {:.2}, of quadratics {:.2} of the bound", worst[0], worst[1]);
    assert!(triangles >= 100_000);
}

/// Largest error of a white highlight by set-up, in 1/255: up to an exponent of [`SOFT`], and above, where a little of curvature joins the share of
/// slopes. See [`microphong::setup::steepness`].
const STEEP: [f64; 2] = [CURVATURE, SLOPE + 0.5 * CURVATURE];
const SOFT: u32 = 128;
/// Largest ratio of length to height at which quadratics of soft highlights are judged. They are not fitted by exact fractions.
const THIN: f64 = 16.0;
/// Largest ratio of length to height at which planes are judged. They are not fitted by exact fractions.
const THINNEST: f64 = 100.0;

#[test]
fn highlights_show_nothing_of_set_up() {
    let mut random = Random::new(seed(), 9);
    let mut worst = [0f64; 3];
    for _ in 0..cases(400_000) {
        let (size, thin, angle) = (random.octaves(2.0, 300.0), random.octaves(0.002, 1.0), random.between(0.0, TAU));
        let (sine, cosine) = angle.sin_cos();
        let mut corner = || {
            let (x, y) = (random.between(-0.5, 0.5) * size, random.between(-0.5, 0.5) * size * thin);
            [160.0 + x * cosine - y * sine, 120.0 + x * sine + y * cosine].map(|c| (c * 16.0) as i32)
        };
        let mut c = [corner(), corner(), corner()];
        let top = (0..3).min_by_key(|&k| (c[k][1], c[k][0])).unwrap();
        c.rotate_left(top);
        if side(c[0], c[1], c[2]) < 0 {
            c.swap(1, 2);
        }
        let case = Case { width: 320, height: 240, corners: c };
        let Some(gradients) = Gradients::new(c, visible(&case)) else { continue };
        let exponent = random.octaves(1.0, 2049.0) as u32;
        let gradients = gradients.steep(Steepness::new(exponent));
        // Cosines of any curvature, 24 fraction bits.
        let bend = random.octaves(1.0 / 4096.0, 0.5) * 2f64.powi(24);
        let corners = [(); 3].map(|()| random.pick(-(1 << 23)..1 << 23));
        let middles = [0, 1, 2].map(|k| {
            let mean = (f64::from(corners[k]) + f64::from(corners[(k + 1) % 3])) / 2.0;
            (mean + bend * random.between(-1.0, 1.0)) as i32
        });
        let nodes = [corners[0], corners[1], corners[2], middles[0], middles[1], middles[2]];
        let mut quadric = Quadric::<1>::fit::<26>(&gradients, &[nodes], 6, [0]);
        let mut plane = Plane::<1>::fit::<26>(&gradients, &[corners], 6, [0]);
        // A pixel of the triangle.
        let [u, v] = [random.between(0.0, 1.0), random.between(0.0, 1.0)];
        let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        let place = |k: usize| f64::from(c[0][k]) + u * f64::from(c[1][k] - c[0][k]) + v * f64::from(c[2][k] - c[0][k]);
        let pixel = [0, 1].map(|k| (place(k) / 16.0).floor() as i32);
        let b = barycentric(c, pixel.map(|c| c * 16 + 8));
        if b.iter().any(|&b| b < 0.0) {
            continue;
        }
        let f = nodes.map(f64::from);
        let linear = (0..3).map(|k| b[k] * f[k]).sum::<f64>();
        let quadratic = (0..3).map(|k| b[k] * (2.0 * b[k] - 1.0) * f[k]).sum::<f64>()
            + 4.0 * (b[0] * b[1] * f[3] + b[1] * b[2] * f[4] + b[2] * b[0] * f[5]);
        quadric.jump(pixel[1] - gradients.row());
        plane.jump(pixel[1] - gradients.row());
        let (mut quadric, mut plane) = (quadric.enter(pixel[0] + 1), plane.enter(pixel[0] + 1));
        quadric.step();
        plane.step();
        let away = f64::from((pixel[0] - gradients.column()).abs() + (pixel[1] - gradients.row()).abs());
        let levels = |walked: u32, exact: f64, walking: f64| {
            let error = (f64::from(walked as i32) / 64.0 - exact).abs() / 2f64.powi(24) - 2f64.powi(-31) * walking;
            error.max(0.0) * 255.0 * f64::from(exponent)
        };
        let extent = c.iter().map(|p| (p[0] - c[0][0]).abs().max((p[1] - c[0][1]).abs())).max().unwrap();
        let is_thinner_than = |ratio: f64| f64::from(extent).powi(2) >= ratio * side(c[0], c[1], c[2]) as f64;
        let of_quadratic = levels(quadric.value()[0], quadratic, 1.0 + away + away * away);
        let kind = usize::from(exponent > SOFT);
        if kind > 0 || !is_thinner_than(THIN) {
            worst[kind] = worst[kind].max(of_quadratic);
        }
        if !is_thinner_than(THINNEST) {
            worst[2] = worst[2].max(levels(plane.value()[0], linear, 1.0 + away));
        }
    }
    let [soft, sharp, plane] = worst;
    println!("quadratics {soft:.3} up to an exponent of {SOFT}, {sharp:.3} above; planes {plane:.3} of 1/255");
    assert!(soft <= STEEP[0] && sharp <= STEEP[1] && plane <= STEEP[1], "{worst:?}");
}
