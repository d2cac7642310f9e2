//! A cupcake on a plate.

use super::solid::{At, Solid, chance, hex, ramp, reach};
use crate::vector::{V3, add, dot, scale, sub};
use std::f64::consts::TAU;

pub(super) fn model() -> Solid {
    Solid::all([plate(), cup(), icing(), sprinkles(), cherry().at([0.02, 1.33, 0.0])])
}

fn plate() -> Solid {
    let profile = [[0.0, -0.12], [0.55, -0.12], [0.6, -0.1], [1.05, 0.0], [1.08, 0.03], [1.04, 0.04], [0.66, -0.05], [0.0, -0.05]];
    let colour = |at: At| {
        if reach(at.middle) > 1.0 { hex(0xe7_b65c) } else { ramp(&[0xc4_dcd9, 0xee_f3f0], (at.point[1] + 0.12) * 6.0) }
    };
    Solid::lathe(&profile, 28).smooth().glossy().painted(colour)
}

/// The pleats of the paper are every other of its corners.
fn cup() -> Solid {
    const PLEATS: usize = 20;
    let pleated = |[x, y, z]: V3| {
        let pleat = (libm::atan2(x, z) / TAU * 2.0 * PLEATS as f64).round() as i64;
        let out = if pleat % 2 == 0 { 1.0 } else { 0.93 };
        if y > 0.55 && libm::hypot(x, z) < 0.6 { [x, y, z] } else { [out * x, y, out * z] }
    };
    let colour = |at: At| {
        let pleat = (reach(at.point) / (0.46 + 0.31 * (at.point[1] + 0.05)) - 0.93) / 0.07;
        let [r, g, b] = ramp(&[0xa4_5a9a, 0xf0_a6da], pleat);
        scale([r, g, b], 0.82 + 0.25 * at.point[1].clamp(0.0, 0.7))
    };
    let paper = Solid::lathe(&[[0.44, -0.06], [0.46, -0.04], [0.66, 0.62], [0.6, 0.62]], 2 * PLEATS).bent(pleated).painted(colour);
    let cake = Solid::lathe(&[[0.0, 0.45], [0.55, 0.5], [0.7, 0.6], [0.72, 0.68], [0.64, 0.76], [0.0, 0.8]], 18).smooth();
    paper.with(cake.graded(1, &[0x8a_5428, 0xc8_8a48, 0xe0_a860]))
}

/// The middle of the strand of icing at a place from its lower end to its tip, and its radius.
fn strand(place: f64) -> (V3, f64) {
    let turn = 3.4 * TAU * place;
    let out = 0.5 * libm::pow(1.0 - place, 0.8);
    let radius = 0.215 * (1.0 - 0.72 * place) * (24.0 * place).clamp(0.01, 1.0).sqrt();
    ([out * libm::sin(turn), 0.78 + 0.52 * libm::pow(place, 0.9), out * libm::cos(turn)], radius)
}

fn icing() -> Solid {
    const STEPS: usize = 56;
    let mut path: Vec<_> = (0..=STEPS).map(|k| strand(0.86 * k as f64 / STEPS as f64)).collect();
    path.push((strand(0.885).0, 0.01));
    let inner = Solid::lathe(&[[0.0, 0.7], [0.5, 0.72], [0.3, 1.02], [0.0, 1.26]], 12).smooth();
    let colours = [0xf2_7fa5, 0xfb_b3c6, 0xff_e6e6, 0xff_f6ee];
    let rope = Solid::tube(&path, 8).smooth().glossy();
    rope.painted(|at| ramp(&colours, (at.point[1] - 0.62) * 1.35)).with(inner.of(0xf7_9ab6))
}

/// Small rods that lie on the outside of the icing.
fn sprinkles() -> Solid {
    let sprinkle = |k: usize| {
        let random = |salt: f64| chance([k as f64, salt, 3.0]);
        let place = (k as f64 + 0.7 * random(1.0)) / 26.0 * 0.82 + 0.05;
        let (centre, radius) = strand(place);
        let outward = scale([centre[0], 0.0, centre[2]], 1.0 / reach(centre));
        let lean = (10.0 + 60.0 * random(2.0)).to_radians();
        let normal = add(scale(outward, libm::cos(lean)), [0.0, libm::sin(lean), 0.0]);
        let along = [4.0, 5.0, 6.0].map(|salt| random(salt) - 0.5);
        let rod = Solid::lathe(&[[0.0, -0.055], [0.022, -0.04], [0.022, 0.04], [0.0, 0.055]], 4).smooth().glossy();
        let colour = [0x4f_c3d9, 0xff_d447, 0x7b_d389, 0xf2_5f5c, 0xff_ffff, 0x9b_6bd1][k % 6];
        rod.of(colour).towards(sub(along, scale(normal, dot(along, normal)))).at(add(centre, scale(normal, radius)))
    };
    Solid::all((0..26).map(sprinkle))
}

fn cherry() -> Solid {
    let dented = |p: V3| sub(p, [0.0, 0.28 * p[1].max(0.0).powi(3) * (1.0 - reach(p)).max(0.0), 0.0]);
    let fruit = Solid::ball(12, 8).bent(dented).sized([0.19, 0.18, 0.19]);
    let stem = [([0.0, 0.1, 0.0], 0.018), ([0.02, 0.25, 0.0], 0.014), ([0.07, 0.37, 0.02], 0.013), ([0.16, 0.47, 0.04], 0.02)];
    let stem = Solid::tube(&stem, 6).smooth().graded(1, &[0x3d_5a26, 0x7a_9a3c, 0x8a_6a3a]);
    fruit.smooth().glossy().graded(1, &[0x6e_0b1e, 0xc4_1830, 0xe6_2c3e]).with(stem)
}
