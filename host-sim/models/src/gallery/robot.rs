//! A toy robot.

use super::solid::{At, Solid, hex, ramp, rounded};
use crate::vector::V3;

const SHELL: [u32; 2] = [0xc9_c3b4, 0xff_fbef];
const ORANGE: [u32; 2] = [0xb8_4a1e, 0xff_8f3f];
const STEEL: [u32; 2] = [0x45_4f63, 0x9a_a7ba];
const SCREEN: [u32; 2] = [0x0f_1626, 0x2a_3b5c];

pub(super) fn model() -> Solid {
    let side = Solid::all([arm(), leg(), ear()]).paired();
    Solid::all([head(), body(), side, base()])
}

/// A box with round edges: a superellipsoid, whose sides bulge less the larger the power is.
fn pebble(size: V3, power: f64, [sides, bands]: [usize; 2]) -> Solid {
    let round = |p: V3| {
        let norm = libm::pow(p.iter().map(|c| libm::pow(c.abs(), power)).sum::<f64>(), 1.0 / power);
        p.map(|c| c / norm)
    };
    Solid::ball(sides, bands).bent(round).sized(size.map(|c| c / 2.0)).smooth()
}

fn head() -> Solid {
    let skull = pebble([0.98, 0.74, 0.8], 4.0, [16, 8]).glossy().graded(1, &SHELL);
    let face = Solid::prism(&rounded([0.4, 0.26], 0.13), 0.3, 0.04).at([0.0, -0.01, 0.275]).glossy().graded(1, &SCREEN);
    let glow = |At { point: [x, y, _], .. }: At| ramp(&[0xff_ffff, 0xb4_fbff, 0x2f_d6e8, 0x0e_8fb0], 10.5 * libm::hypot(x - 0.2, y - 0.05));
    let eye =
        Solid::lathe(&[[0.0, -0.08], [0.105, -0.08], [0.105, 0.0], [0.06, 0.02], [0.0, 0.03]], 10).turned(0, 90.0).at([0.2, 0.05, 0.425]);
    let eyes = eye.glowing().painted(glow).paired();
    let smile = [-2.0f64, -1.0, 0.0, 1.0, 2.0].map(|k| ([0.065 * k, -0.16 + 0.012 * k * k, 0.43], 0.016));
    let smile = Solid::tube(&smile, 4).glowing().of(0x5c_ecf5);
    let rod = Solid::tube(&[([0.0, 0.34, 0.0], 0.03), ([0.0, 0.55, 0.0], 0.02)], 6).smooth().glossy().graded(1, &STEEL);
    let bulb = Solid::ball(8, 5).sized([0.085; 3]).at([0.0, 0.61, 0.0]).smooth().glossy().graded(1, &[0xd8_2f2f, 0xff_8a6b]);
    let neck = Solid::lathe(&[[0.17, -0.5], [0.2, -0.43], [0.17, -0.36]], 12).glossy().graded(1, &STEEL);
    Solid::all([skull, face, eyes, smile, rod, bulb, neck]).at([0.0, 1.72, 0.0])
}

fn ear() -> Solid {
    let disc = Solid::lathe(&[[0.0, 0.0], [0.17, 0.0], [0.17, 0.07], [0.13, 0.1], [0.0, 0.11]], 10).turned(2, -90.0);
    disc.glossy().graded(1, &ORANGE).at([0.46, 1.72, 0.0])
}

fn body() -> Solid {
    let shell = pebble([0.9, 0.84, 0.66], 3.4, [16, 8]).glossy().graded(1, &ORANGE);
    let panel = Solid::prism(&rounded([0.27, 0.2], 0.06), 0.2, 0.02).at([0.0, 0.08, 0.25]).glossy().graded(1, &SHELL);
    let knob = |x: f64, y: f64, colour: u32| Solid::ball(6, 4).sized([0.045, 0.045, 0.03]).at([x, y, 0.35]).smooth().glossy().of(colour);
    let knobs = Solid::all([knob(-0.16, -0.02, 0xff_d447), knob(0.0, -0.02, 0x4f_c36a), knob(0.16, -0.02, 0x3f_8fe0)]);
    let dial = Solid::lathe(&[[0.0, -0.05], [0.1, -0.05], [0.1, 0.02], [0.085, 0.03], [0.0, 0.03]], 12).turned(0, 90.0);
    let dial = dial
        .painted(|at| if libm::hypot(at.middle[0], at.middle[1]) < 0.08 { hex(0xff_ffff) } else { hex(0x45_4f63) })
        .at([-0.12, 0.15, 0.345]);
    let needle = Solid::block([0.018, 0.08, 0.012]).turned(2, -35.0).at([-0.12, 0.14, 0.38]).of(0xd8_2f2f);
    let slots = Solid::all([0.11, 0.16, 0.21].map(|y| Solid::block([0.17, 0.024, 0.03]).at([0.13, y - 0.02, 0.34]))).of(0x45_4f63);
    let belt = Solid::lathe(&[[0.3, -0.46], [0.36, -0.4], [0.3, -0.33]], 14).sized([1.0, 1.0, 0.78]).glossy().graded(1, &STEEL);
    Solid::all([shell, panel, knobs, dial, needle, slots, belt]).at([0.0, 0.9, 0.0])
}

fn arm() -> Solid {
    let shoulder = Solid::ball(8, 5).sized([0.15; 3]).at([0.5, 1.1, 0.0]).smooth().glossy().graded(1, &SHELL);
    let path = (0..=8).map(|k| {
        let place = f64::from(k) / 8.0;
        let turn = place * 1.5;
        let centre = [0.52 + 0.2 * libm::sin(turn), 1.08 - 0.42 * place, 0.28 * place * place];
        (centre, if k % 2 == 0 { 0.085 } else { 0.068 })
    });
    let tube = Solid::tube(&path.collect::<Vec<_>>(), 6).glossy().graded(1, &STEEL);
    let cuff = Solid::lathe(&[[0.09, -0.08], [0.13, -0.06], [0.13, 0.05], [0.09, 0.07]], 9).glossy().graded(1, &ORANGE);
    let finger = |x: f64, out: f64| {
        let path = [
            ([x, -0.04, 0.0], 0.04),
            ([x + out, -0.14, 0.0], 0.042),
            ([x + 0.8 * out, -0.24, 0.01], 0.036),
            ([x + 0.2 * out, -0.29, 0.01], 0.02),
        ];
        Solid::tube(&path, 4).smooth().glossy().graded(1, &SHELL)
    };
    let hand = Solid::all([cuff, finger(0.055, 0.05), finger(-0.055, -0.05)]).turned(0, -32.0).at([0.72, 0.63, 0.3]);
    Solid::all([shoulder, tube, hand])
}

fn leg() -> Solid {
    let knee = Solid::lathe(&[[0.09, 0.16], [0.115, 0.22], [0.09, 0.28], [0.115, 0.34], [0.09, 0.5]], 10);
    let foot = pebble([0.32, 0.26, 0.46], 3.2, [10, 5]).bent(|[x, y, z]| [x, y.max(-0.09), z]).at([0.0, 0.11, 0.05]);
    knee.glossy().graded(1, &STEEL).with(foot.glossy().graded(1, &SHELL)).at([0.22, 0.0, 0.0])
}

fn base() -> Solid {
    let disc = Solid::lathe(&[[0.0, -0.12], [0.78, -0.12], [0.84, -0.05], [0.8, 0.015], [0.0, 0.015]], 22);
    disc.painted(|at| if at.normal[1] > 0.9 { hex(0x6d_7fb3) } else { ramp(&[0x2f_3a66, 0x56_68a3], (at.point[1] + 0.12) * 7.0) })
}
