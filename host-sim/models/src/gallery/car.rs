//! A small car.

use super::solid::{At, Point, Solid, hex, ramp, rounded};
use crate::vector::V3;

const PAINT: [u32; 3] = [0x1c_6f78, 0x2a_a3a3, 0x62_d0c4];
const CHROME: [u32; 2] = [0x7a_8088, 0xf4_f6f8];
const RUBBER: u32 = 0x2b_2b30;

pub(super) fn model() -> Solid {
    let half = Solid::all([wheel(0.66), wheel(-0.64), lights(), mirror()]).paired();
    Solid::all([body(), cabin(), half, trim(), luggage()])
}

/// A rounded rectangle across the car, at this z, with half of this width and from this height to that one.
fn section(z: f64, half: f64, [low, high]: [f64; 2], round: f64) -> Vec<V3> {
    let point = |[x, y]: Point| [x, y + (low + high) / 2.0, z];
    rounded([half, (high - low) / 2.0], round).into_iter().map(point).collect()
}

/// The paint is lighter above.
fn paint(at: At) -> V3 {
    ramp(&PAINT, (at.point[1] - 0.2) / 0.55)
}

fn body() -> Solid {
    let rings = [
        section(-1.13, 0.34, [0.36, 0.50], 0.06),
        section(-1.1, 0.46, [0.28, 0.60], 0.12),
        section(-1.0, 0.53, [0.22, 0.68], 0.16),
        section(-0.75, 0.57, [0.2, 0.74], 0.18),
        section(0.3, 0.58, [0.2, 0.74], 0.18),
        section(0.65, 0.56, [0.2, 0.7], 0.18),
        section(0.92, 0.52, [0.22, 0.62], 0.17),
        section(1.06, 0.45, [0.27, 0.54], 0.12),
        section(1.1, 0.34, [0.34, 0.48], 0.06),
    ];
    Solid::loft(&rings).smooth().glossy().painted(paint)
}

fn cabin() -> Solid {
    let glass = [
        section(-0.92, 0.40, [0.6, 0.72], 0.05),
        section(-0.78, 0.42, [0.6, 0.94], 0.1),
        section(-0.62, 0.42, [0.6, 1.08], 0.12),
        section(0.0, 0.43, [0.6, 1.12], 0.12),
        section(0.2, 0.42, [0.6, 1.07], 0.12),
        section(0.42, 0.43, [0.6, 0.86], 0.1),
        section(0.58, 0.44, [0.6, 0.70], 0.04),
    ];
    let glass = Solid::loft(&glass).smooth().glossy().graded(1, &[0x1b_2b3c, 0x2f_4a63, 0x8f_bcd6]);
    let roof = [
        section(-0.73, 0.24, [1.02, 1.06], 0.02),
        section(-0.66, 0.37, [1.02, 1.12], 0.05),
        section(-0.3, 0.42, [1.03, 1.17], 0.065),
        section(0.13, 0.38, [1.03, 1.145], 0.055),
        section(0.22, 0.24, [1.03, 1.09], 0.03),
    ];
    let roof = Solid::loft(&roof).smooth().glossy().of(0xf7_efdc);
    let pillar = |path: &[V3]| Solid::tube(&path.iter().map(|&p| (p, 0.035)).collect::<Vec<_>>(), 4).smooth().glossy().of(0xf7_efdc);
    let pillars = [
        pillar(&[[0.4, 0.68, 0.55], [0.385, 0.86, 0.4], [0.34, 1.08, 0.16]]),
        pillar(&[[0.425, 0.68, -0.14], [0.43, 0.9, -0.16], [0.38, 1.1, -0.18]]),
        pillar(&[[0.37, 0.68, -0.86], [0.37, 0.9, -0.77], [0.34, 1.06, -0.62]]),
    ];
    Solid::all([glass, roof, Solid::all(pillars).paired()])
}

/// The right wheel at this z, with the arch above it.
fn wheel(z: f64) -> Solid {
    let disc = |profile: &[[f64; 2]], sides: usize| Solid::lathe(profile, sides).turned(2, -90.0);
    let tyre = disc(&[[0.0, -0.1], [0.2, -0.1], [0.24, -0.06], [0.24, 0.05], [0.2, 0.08], [0.0, 0.06]], 12).smooth().of(RUBBER);
    let rim = disc(&[[0.0, 0.0], [0.15, 0.06], [0.13, 0.09], [0.05, 0.075], [0.0, 0.1]], 10).glossy();
    let rim = rim
        .painted(|at| if libm::hypot(at.middle[1], at.middle[2]) < 0.06 { hex(0xf7_efdc) } else { ramp(&CHROME, 0.5 + 3.0 * at.point[1]) });
    let arch = disc(&[[0.285, -0.2], [0.285, 0.05]], 12).of(0x1a_3338);
    arch.at([0.0, 0.03, 0.0]).with(tyre.with(rim).at([0.04, 0.0, 0.0])).at([0.52, 0.24, z])
}

fn lights() -> Solid {
    let ring = Solid::lathe(&[[0.115, -0.03], [0.115, 0.02], [0.09, 0.035]], 12).glossy().of(CHROME[1]);
    let glass = Solid::lathe(&[[0.09, 0.03], [0.07, 0.055], [0.0, 0.07]], 10).glossy().smooth().graded(2, &[0xff_f3c4, 0xff_ffff]);
    let head = ring.with(glass).turned(0, 90.0).at([0.33, 0.5, 1.05]);
    let pod = Solid::ball(8, 5).sized([0.13, 0.13, 0.17]).at([0.33, 0.5, 0.9]).smooth().glossy().painted(paint);
    let blink = Solid::ball(6, 4).sized([0.045, 0.03, 0.03]).at([0.4, 0.33, 1.03]).smooth().glossy().of(0xff_9a2e);
    let tail = Solid::ball(7, 4).sized([0.06, 0.09, 0.06]).at([0.37, 0.5, -1.1]).smooth().glossy().graded(1, &[0x8f_1420, 0xf5_4a42]);
    let handle = Solid::block([0.03, 0.03, 0.13]).at([0.575, 0.6, -0.02]).glossy().of(0xd8_dce0);
    Solid::all([pod, head, blink, tail, handle])
}

fn mirror() -> Solid {
    let arm = Solid::tube(&[([0.5, 0.7, 0.36], 0.016), ([0.6, 0.76, 0.34], 0.014)], 5).of(RUBBER);
    arm.with(Solid::ball(7, 4).sized([0.06, 0.05, 0.04]).at([0.63, 0.78, 0.34]).smooth().glossy().graded(1, &PAINT))
}

fn trim() -> Solid {
    let bumper = |z: f64, bow: f64| {
        let path = [-0.52, -0.38, 0.0, 0.38, 0.52].map(|x: f64| ([x, 0.27, z - bow * (x.powi(2) + 3.0 * x.powi(6))], 0.045));
        Solid::tube(&path, 5).smooth().glossy().graded(1, &CHROME)
    };
    let grille = Solid::all([0.42, 0.46, 0.5].map(|y| Solid::block([0.3, 0.02, 0.05]).at([0.0, y - 0.03, 1.085]))).glossy().of(0xc8_ccd2);
    let plate = Solid::block([0.26, 0.07, 0.02]).of(0xff_ffff);
    let plates = plate.clone().at([0.0, 0.235, 1.16]).with(plate.at([0.0, 0.4, -1.14]));
    let stripe = Solid::block([1.175, 0.025, 0.86]).at([0.0, 0.46, 0.0]).glossy().of(0xf7_efdc);
    let badge =
        Solid::lathe(&[[0.0, 0.0], [0.05, 0.0], [0.05, 0.03], [0.0, 0.04]], 8).turned(0, 62.0).at([0.0, 0.59, 0.96]).glossy().of(0xe8_b84a);
    Solid::all([bumper(1.13, 0.5), bumper(-1.16, -0.5), grille, plates, stripe, badge])
}

/// A rack on the roof with two suitcases and a rolled blanket.
fn luggage() -> Solid {
    let bar = |z: f64| Solid::tube(&[[-0.38, 1.1], [-0.36, 1.19], [0.36, 1.19], [0.38, 1.1]].map(|[x, y]| ([x, y, z], 0.018)), 4);
    let rack = Solid::all([-0.52, -0.12].map(bar)).glossy().graded(0, &CHROME);
    let tray = Solid::block([0.7, 0.02, 0.56]).at([0.0, 1.195, -0.32]).of(0xa0_6a3c);
    let case = |size: V3, colours: &[u32]| {
        let strap = |x: f64| Solid::block([0.04, size[1] + 0.015, size[2] + 0.02]).at([x * size[0], 0.0, 0.0]).of(0x4f_3423);
        Solid::block(size).graded(1, colours).with(strap(-0.28)).with(strap(0.28))
    };
    let cases = case([0.5, 0.19, 0.26], &[0x7d_4a2a, 0xc0_7c45])
        .at([-0.06, 1.21, -0.44])
        .with(case([0.36, 0.13, 0.2], &[0x8c_3a36, 0xd8_6a55]).at([0.1, 1.21, -0.16]));
    let spiral = |at: At| if at.normal[0].abs() > 0.8 { hex(0xff_efc2) } else { ramp(&[0xd9_9a2b, 0xff_d36b], (at.point[1] + 0.08) * 6.0) };
    let roll = Solid::lathe(&[[0.07, -0.2], [0.08, -0.19], [0.08, 0.19], [0.07, 0.2]], 10)
        .turned(2, 90.0)
        .painted(spiral)
        .at([-0.06, 1.475, -0.44]);
    Solid::all([rack, tray, cases, roll])
}
