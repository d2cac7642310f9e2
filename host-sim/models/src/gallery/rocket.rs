//! A rocket that takes off.

use super::solid::{At, Solid, chance, hex, ramp, reach};
use crate::vector::V3;

pub(super) fn model() -> Solid {
    Solid::all([hull(), Solid::all((0..4).map(fin)), windows(), nozzle(), flame(), smoke()])
}

/// The radius of the hull at a height, which is less than 2.2.
fn radius(y: f64) -> f64 {
    let place = y / 2.0;
    0.42 * libm::pow((1.0 - libm::pow((1.35 * (place - 0.36)).abs(), 2.2)).max(0.0), 0.75)
}

const RED: [u32; 2] = [0xa8_1f2d, 0xf0_4a48];

fn hull() -> Solid {
    const BANDS: usize = 17;
    let mut profile: Vec<_> =
        (0..=BANDS).map(|k| 2.2 * k as f64 / BANDS as f64).map(|y| [radius(y), y]).take_while(|[r, _]| *r > 0.02).collect();
    profile.push([0.0, 2.205]);
    let colour = |At { point, middle, .. }: At| match middle[1] {
        y if y > 1.65 => ramp(&RED, (point[1] - 1.6) * 2.2),
        y if !(0.12..1.53).contains(&y) => hex(0x2f_3b5c),
        y if (0.26..0.4).contains(&y) => hex(0xf0_4a48),
        _ => ramp(&[0xc9_c9d2, 0xf4_f1ea, 0xff_ffff], (point[1] - 0.1) / 1.3),
    };
    Solid::lathe(&profile, 18).smooth().glossy().painted(colour)
}

fn fin(k: i32) -> Solid {
    let outline = [[0.26, 0.1], [0.52, -0.12], [0.72, -0.42], [0.78, -0.4], [0.76, -0.02], [0.62, 0.3], [0.3, 0.66]];
    let shape = Solid::prism(&outline, 0.09, 0.03).glossy().graded(0, &[RED[1], RED[1], RED[0]]);
    shape.turned(1, 45.0 + 90.0 * f64::from(k))
}

/// Two windows, each a pane in a ring.
fn windows() -> Solid {
    let window = |size: f64, y: f64| {
        let ring = Solid::lathe(&[[0.0, -0.06], [1.0, -0.06], [1.0, 0.025], [0.9, 0.05], [0.72, 0.02], [0.0, 0.02]], 14);
        let ring = ring.sized([size, 1.0, size]).turned(0, 90.0).glossy().graded(1, &[0x8a_6a2a, 0xff_d978]);
        let glass = Solid::ball(12, 4).sized([0.74 * size, 0.74 * size, 0.045]).at([0.0, 0.0, 0.012]).smooth().glossy();
        let glass = glass.graded(1, &[0x12_3a6b, 0x3f_9ad6, 0xc4_f1ff]);
        let lean = (radius(y + 0.01) - radius(y - 0.01)) / 0.02;
        ring.with(glass).turned(0, libm::atan(lean).to_degrees()).at([0.0, y, radius(y)])
    };
    Solid::all([window(0.19, 1.2), window(0.12, 0.74)])
}

fn nozzle() -> Solid {
    let bell = Solid::lathe(&[[0.14, 0.08], [0.13, 0.0], [0.2, -0.16], [0.25, -0.22]].map(|[r, y]| [r, -y]), 14);
    bell.turned(0, 180.0).glossy().graded(1, &[0x3a_4258, 0x9a_a3b5])
}

fn flame() -> Solid {
    let profile = [[0.0, -0.98], [0.06, -0.86], [0.14, -0.66], [0.2, -0.44], [0.2, -0.3], [0.14, -0.18], [0.0, -0.12]];
    Solid::lathe(&profile, 12).smooth().glowing().graded(1, &[0xe8_3f1f, 0xff_7a1f, 0xff_b52e, 0xff_f0a8])
}

fn smoke() -> Solid {
    let puff = |k: i32| {
        let random = |salt: f64| chance([f64::from(k), salt, 9.0]);
        let (turn, far) = (f64::from(k) * 2.399, 0.2 + 0.16 * f64::from(k).sqrt());
        let size = 0.34 - 0.03 * f64::from(k).sqrt() + 0.06 * random(1.0);
        let centre: V3 = [far * libm::sin(turn), -1.0 - 0.08 * random(2.0), far * libm::cos(turn)];
        // The flame lights it from the middle.
        let colour = |at: At| {
            let glow = (1.0 - reach(at.point) / 0.62).clamp(0.0, 1.0) * (1.6 + at.point[1]).clamp(0.0, 1.0);
            let grey = ramp(&[0x9d_9bb5, 0xdc_d8e6, 0xff_fdfa], (at.point[1] + 1.3) * 1.7);
            let warm = hex(0xff_b15c);
            [0, 1, 2].map(|k| grey[k] + glow * (warm[k] - grey[k]))
        };
        Solid::ball(9, 6).smooth().sized([size, 0.82 * size, size]).at(centre).painted(colour)
    };
    Solid::all((0..11).map(puff))
}
