//! A sailing boat on a piece of the sea.

use super::solid::{At, Solid, chance, hex, ramp, reach};
use crate::vector::V3;

pub(super) fn model() -> Solid {
    let boat = Solid::all([hull(), deck(), rigging(), sails()]);
    Solid::all([sea(), boat.turned(2, -4.0).at([0.0, 0.08, 0.0]), buoy()])
}

fn sea() -> Solid {
    let rings = [[0.0, -0.62], [0.7, -0.56], [1.05, -0.4], [1.2, -0.16], [1.22, 0.0], [1.0, 0.0], [0.72, 0.0], [0.42, 0.0], [0.0, 0.0]];
    let colour = |At { point, middle, normal }: At| match normal[1] > 0.5 {
        true if reach(middle) < 0.75 => ramp(&[0x1f_86a6, 0x3f_b5bd, 0x9b_e3d8], point[1] * 6.0 + 0.5),
        true => ramp(&[0x2a_9bb0, 0x4c_c0c2], chance(middle)),
        false => ramp(&[0x10_3a6c, 0x1a_6a98, 0x2a_9bb0], point[1] / 0.6 + 1.0),
    };
    let wave =
        |[x, y, z]: V3| [x, if y > -0.01 { 0.045 * libm::sin(5.0 * x + 2.0 * z) + 0.03 * libm::cos(7.0 * z - 2.0 * x) } else { y }, z];
    Solid::lathe(&rings, 18).bent(wave).faceted().painted(colour)
}

/// Half of the beam, and the heights of the gunwale and the keel, at a place from the stern (0) to the bow (1).
fn lines(place: f64) -> [f64; 3] {
    let width = 0.27 * (1.0 - libm::pow((1.55 * (place - 0.38)).abs(), 2.4)).max(0.0).sqrt();
    [if place >= 1.0 { 0.012 } else { width }, 0.2 + 0.17 * (place - 0.25).powi(2), -0.12 + 0.2 * place.powi(6)]
}

/// A place on the boat: from the stern to the bow, which points to +x.
fn along(place: f64) -> f64 {
    1.7 * place - 0.8
}

fn hull() -> Solid {
    let ring = |k: i32| {
        let place = f64::from(k) / 8.0;
        let [half, high, low] = lines(place);
        let x = along(place);
        let side = [(0.0, 0.0), (0.62, 0.25), (0.9, 0.55), (0.98, 0.85), (1.0, 1.0)].map(|(out, up)| [half * out, low + (high - low) * up]);
        let left = side[1..].iter().map(|&[z, y]| [x, y, -z]);
        let right = side.iter().rev().map(|&[z, y]| [x, y, z]);
        right.chain(left).collect::<Vec<V3>>()
    };
    let colour = |At { point, middle, normal }: At| {
        let [_, high, low] = lines((middle[0] + 0.8) / 1.7);
        let up = (middle[1] - low) / (high - low);
        if normal[1] > 0.7 {
            return ramp(&[0xb9_7a45, 0xd9_a066], (point[0] + 0.8) / 1.7);
        }
        match up {
            0.88.. => hex(0x1f_3b73),
            0.42.. => ramp(&[0xd9_e2ea, 0xff_ffff], (point[0] + 0.8) / 1.7),
            _ => hex(0xc8_3e3e),
        }
    };
    Solid::loft(&(0..=8).map(ring).collect::<Vec<_>>()).painted(colour)
}

fn deck() -> Solid {
    let roof = Solid::prism(&[[-0.28, 0.15], [0.34, 0.15], [0.2, 0.34], [-0.26, 0.36]], 0.27, 0.03);
    let cabin =
        roof.painted(|at| if at.normal[1] > 0.7 { hex(0xf7_efe0) } else { ramp(&[0xc9_b99c, 0xff_f8ea], (at.point[1] - 0.15) * 5.0) });
    let port = |x: f64| Solid::lathe(&[[0.045, 0.0], [0.045, 0.3]], 7).at([0.0, -0.15, 0.0]).turned(0, 90.0).at([x, 0.26, 0.0]);
    let ports = Solid::all([-0.15, -0.01, 0.12].map(port)).of(0x27_4c6b);
    let side = Solid::all([-0.15, 0.15].map(|z| Solid::block([0.46, 0.07, 0.04]).at([-0.52, 0.19, z]))).graded(0, &[0x7a_4a2a, 0xb8_7b48]);
    let well = Solid::block([0.44, 0.02, 0.28]).at([-0.52, 0.205, 0.0]).of(0x6b_4228);
    let bench = Solid::block([0.1, 0.05, 0.28]).at([-0.66, 0.21, 0.0]).of(0xe0_b27a);
    let rudder = Solid::prism(&[[-0.16, -0.25], [0.0, -0.2], [0.0, 0.26], [-0.06, 0.26]], 0.03, 0.0).at([-0.8, 0.0, 0.0]).of(0x8a_5632);
    let tiller = Solid::tube(&[([-0.84, 0.27, 0.0], 0.016), ([-0.6, 0.33, 0.05], 0.012)], 4).of(0xe0_b27a);
    Solid::all([cabin, ports, side, well, bench, rudder, tiller])
}

const MAST: f64 = 0.12;

fn rigging() -> Solid {
    let wood: [u32; 2] = [0x8a_5632, 0xd9_a066];
    let mast = Solid::tube(&[([MAST, 0.2, 0.0], 0.028), ([MAST, 1.0, 0.0], 0.024), ([MAST, 1.86, 0.0], 0.014)], 6).graded(1, &wood);
    let boom = Solid::tube(&[([MAST, 0.47, 0.0], 0.02), ([-0.74, 0.45, 0.2], 0.016)], 5).graded(0, &wood);
    let bow = Solid::tube(&[([0.78, 0.27, 0.0], 0.022), ([1.06, 0.36, 0.0], 0.014)], 5).graded(0, &wood);
    let rope = |from: V3, to: V3| Solid::tube(&[(from, 0.006), (to, 0.006)], 3).of(0x5a_4a3e);
    let top = [MAST, 1.78, 0.0];
    let ropes = [rope([1.04, 0.35, 0.0], top), rope([-0.78, 0.24, 0.0], top), rope([0.0, 0.2, 0.24], top), rope([0.0, 0.2, -0.24], top)];
    let ball = Solid::ball(6, 4).sized([0.03; 3]).at([MAST, 1.88, 0.0]).of(0xf0_c14b);
    let wave = |[x, y, z]: V3| [x, y, z + 0.03 * libm::sin(14.0 * x)];
    let flag = Solid::all(
        [0.0, 1.0, 2.0].map(|k| Solid::block([0.09, 0.13 - 0.03 * k, 0.012]).at([MAST - 0.06 - 0.09 * k, 1.7 + 0.015 * k, 0.0])),
    );
    let flag = flag.bent(wave).graded(0, &[0xff_b03a, 0xe8_433f]);
    Solid::all([mast, boom, bow, ball, flag]).with(Solid::all(ropes))
}

/// A sail between two corners at its foot and its head, which the wind fills. Its colour depends on the height of a row, and on the point.
fn sail(foot: [V3; 2], head: V3, belly: f64, colour: impl Fn(f64, V3) -> V3) -> Solid {
    const COLUMNS: usize = 4;
    let ring = |row: usize| {
        let up = row as f64 / 6.0;
        let edge = |k: usize, thick: f64| {
            let share = k as f64 / COLUMNS as f64;
            let foot = [0, 1, 2].map(|c| foot[0][c] + (foot[1][c] - foot[0][c]) * share);
            let round = belly * libm::pow(1.0 - up, 0.7) * libm::sin(share * std::f64::consts::PI) * (0.3 + 1.4 * up.min(0.5));
            let [x, y, z] = [0, 1, 2].map(|c| foot[c] + (head[c] - foot[c]) * up);
            [x, y, z + round + thick]
        };
        let back = (0..=COLUMNS).map(|k| edge(k, -0.008));
        let front = (0..=COLUMNS).rev().map(|k| edge(k, 0.008));
        back.chain(front).collect::<Vec<V3>>()
    };
    let mut rings: Vec<_> = (0..6).map(ring).collect();
    rings.push(vec![head; 2 * COLUMNS + 2]);
    Solid::loft(&rings).smooth().painted(|At { point, middle, .. }| colour(middle[1], point))
}

fn sails() -> Solid {
    let shade = |point: V3, colours: [u32; 2]| ramp(&colours, (point[1] - 0.4) / 1.2);
    let main = sail([[MAST - 0.03, 0.52, 0.0], [-0.72, 0.5, 0.2]], [MAST - 0.02, 1.74, 0.0], 0.16, |row, point| {
        if (0.85..1.2).contains(&row) { hex(0xe8_5a4f) } else { shade(point, [0xe6_d9c3, 0xff_fdf5]) }
    });
    let jib = sail([[0.98, 0.4, 0.0], [MAST + 0.06, 0.46, 0.14]], [MAST + 0.05, 1.62, 0.0], 0.12, |_, point| {
        shade(point, [0xf2_a65a, 0xff_e3b0])
    });
    main.with(jib)
}

fn buoy() -> Solid {
    let profile = [[0.0, -0.1], [0.1, -0.06], [0.13, 0.02], [0.05, 0.16], [0.045, 0.26], [0.0, 0.3]];
    let colour =
        |at: At| if (0.05..0.16).contains(&at.middle[1]) { hex(0xff_ffff) } else { ramp(&[0x9c_2a2a, 0xf0_5545], at.point[1] * 3.0) };
    Solid::lathe(&profile, 8).painted(colour).turned(2, 14.0).at([0.62, 0.04, 0.72])
}
