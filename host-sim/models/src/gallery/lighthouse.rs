//! A lighthouse on an island, whose colours tell its heights.

use super::{
    nature::{conifer, foliage, stone},
    solid::{At, Solid, chance, hex, ramp, reach},
};
use crate::vector::V3;

pub(super) fn model() -> Solid {
    let tower = tower().at([-0.28, height([-0.28, 0.0, -0.1]) - 0.06, -0.1]);
    Solid::all([sea(), land(), tower, keeper(), trees(), pier()])
}

/// The height of the land.
fn height([x, _, z]: V3) -> f64 {
    let hill = |cx: f64, cz: f64, size: f64, high: f64| high * libm::exp(-((x - cx).powi(2) + (z - cz).powi(2)) / (size * size));
    let edge = 0.9 + 0.1 * libm::sin(3.0 * libm::atan2(x, z)) + 0.06 * libm::cos(5.0 * libm::atan2(x, z) + 1.0);
    let shore = (1.0 - (reach([x, 0.0, z]) / edge).powi(4)).max(-0.6);
    0.16 * shore + hill(-0.28, -0.1, 0.42, 0.34) * shore.max(0.0) + hill(0.4, 0.12, 0.3, 0.1) * shore.max(0.0)
}

fn sea() -> Solid {
    let rings = [[0.0, -0.5], [0.8, -0.46], [1.16, -0.3], [1.3, -0.08], [1.32, 0.0], [1.1, 0.0], [0.9, 0.0], [0.0, 0.0]];
    let colour = |At { point, middle, normal }: At| {
        if normal[1] > 0.6 {
            ramp(&[0x86_d8cf, 0x3f_b0c0, 0x2b_8fb3], 3.2 * (reach(point) - 0.9))
        } else {
            ramp(&[0x12_3a68, 0x1e_6c9a, 0x2b_8fb3], point[1] * 2.0 + 1.0 + 0.1 * chance(middle))
        }
    };
    Solid::lathe(&rings, 15).faceted().painted(colour)
}

fn land() -> Solid {
    let rings = [[0.0, -0.2], [0.98, -0.2], [1.0, 0.0], [0.86, 0.0], [0.68, 0.0], [0.46, 0.0], [0.22, 0.0], [0.0, 0.0]];
    let ruffle = |p: V3| 0.035 * (chance(p) - 0.5) * f64::from(u8::from(reach(p) < 0.85));
    let lifted = |p: V3| [p[0], if p[1] < -0.1 { p[1] } else { height(p) + ruffle(p) }, p[2]];
    let colour = |At { point, middle, normal }: At| {
        let by_height = |y: f64| ramp(&[0xc9_b27c, 0xef_dca6, 0x8f_bf5f, 0x5f_a04c, 0x4c_8a46, 0x6f_8a55], y * 2.1 + 0.1);
        if normal[1] < 0.72 && middle[1] > 0.1 { ramp(&[0x77_7c86, 0xa7_a9a8], chance(middle)) } else { by_height(point[1]) }
    };
    Solid::lathe(&rings, 15).sized([0.98, 1.0, 0.98]).bent(lifted).faceted().painted(colour)
}

fn tower() -> Solid {
    let (bottom, top, rise) = (0.21, 0.13, 1.02);
    let section = |k: usize| {
        let share = k as f64 / 6.0;
        [bottom + (top - bottom) * share, rise * share]
    };
    let profile: Vec<_> = (0..=6).map(section).collect();
    let band = |at: At| if (at.middle[1] / rise * 6.0) as usize % 2 == 1 { hex(0xd8_3b36) } else { hex(0xfb_f5ea) };
    let shaft = Solid::lathe(&profile, 8).smooth().painted(band);
    let gallery = Solid::lathe(&[[0.12, 0.98], [0.21, 1.03], [0.21, 1.06], [0.1, 1.07]], 8).graded(1, &[0x3a_4456, 0x5b_677d]);
    let rail = |k: i32| {
        let rod = |from: V3, to: V3| Solid::tube(&[(from, 0.01), (to, 0.01)], 3);
        let bars = rod([0.0, 1.05, 0.195], [0.0, 1.16, 0.195]).with(rod([0.0, 1.16, 0.195], [0.138, 1.16, 0.138]));
        bars.turned(1, 45.0 * f64::from(k))
    };
    let rails = Solid::all((0..8).map(rail)).of(0x2c_3444);
    let lamp = Solid::lathe(&[[0.095, 1.05], [0.1, 1.16], [0.095, 1.27]], 6).graded(1, &[0xff_a62b, 0xff_e27a, 0xff_f8d0]);
    let roof = Solid::lathe(&[[0.0, 1.25], [0.15, 1.25], [0.05, 1.38], [0.0, 1.42]], 8).graded(1, &[0x9c_2626, 0xe8_5046]);
    let tip = Solid::ball(5, 3).sized([0.03; 3]).at([0.0, 1.43, 0.0]).of(0xf0_c14b);
    let door =
        Solid::prism(&[[-0.06, 0.0], [0.06, 0.0], [0.06, 0.15], [0.0, 0.2], [-0.06, 0.15]], 0.1, 0.0).at([0.0, 0.03, 0.17]).of(0x2f_5d73);
    let window = |turn: f64, y: f64, out: f64| Solid::block([0.06, 0.09, 0.06]).at([0.0, y, out]).turned(1, turn).of(0x2b_4560);
    let windows = Solid::all([window(12.0, 0.42, 0.15), window(120.0, 0.58, 0.135), window(230.0, 0.74, 0.12)]);
    Solid::all([shaft, gallery, rails, lamp, roof, tip, door, windows])
}

/// The keeper's house.
fn keeper() -> Solid {
    let walls = Solid::prism(&[[-0.17, -0.2], [0.17, -0.2], [0.17, 0.16], [0.0, 0.3], [-0.17, 0.16]], 0.3, 0.0)
        .graded(1, &[0xb8_a083, 0xe9_dcc2, 0xff_f8e8]);
    let slab = Solid::block([0.27, 0.03, 0.36])
        .at([0.1, 0.0, 0.0])
        .turned(2, -39.5)
        .at([-0.005, 0.305, 0.0])
        .graded(0, &[0x5a_7f9f, 0x37_546e])
        .paired();
    let door = Solid::block([0.08, 0.15, 0.04]).at([0.0, 0.0, 0.14]).of(0xa0_4a32);
    let windows = Solid::block([0.04, 0.09, 0.08]).at([0.16, 0.04, 0.0]).of(0x2b_4560).paired();
    let chimney = Solid::block([0.05, 0.2, 0.05]).at([0.07, 0.2, -0.08]).of(0x9a_5a44);
    let house = Solid::all([walls, slab, door, windows, chimney]);
    house.turned(1, 24.0).at([0.36, height([0.36, 0.0, 0.0]), 0.0])
}

fn trees() -> Solid {
    let tree = |&[x, z, size]: &[f64; 3]| conifer(size).turned(1, 90.0 * x).at([x, height([x, 0.0, z]) - 0.02, z]);
    let places = [[0.16, -0.5, 0.44], [0.38, -0.42, 0.34], [-0.62, 0.12, 0.34]];
    let bush = foliage([0.09, 0.08, 0.09], 0.1, &[0x2f_6b3a, 0x8f_c05a]).at([0.1, height([0.1, 0.0, 0.22]) + 0.02, 0.22]);
    let rock = |&[x, z, size]: &[f64; 3]| stone([size, 0.8 * size, size], x).at([x, height([x, 0.0, z]).max(0.0), z]);
    let rocks = [[-0.85, 0.35, 0.13], [-0.72, 0.52, 0.08], [0.86, -0.42, 0.14]];
    Solid::all(places.iter().map(tree)).with(bush).with(Solid::all(rocks.iter().map(rock)))
}

fn pier() -> Solid {
    let plank = |k: i32| Solid::block([0.17, 0.025, 0.085]).at([0.0, 0.07, 0.1 * f64::from(k)]).of([0xa8_7a4e, 0xbd_8f60][k as usize % 2]);
    let post = |z: f64| Solid::lathe(&[[0.02, -0.2], [0.02, 0.14]], 3).at([0.08, 0.0, z]).graded(1, &[0x4f_3423, 0x8a_6242]).paired();
    Solid::all((0..4).map(plank)).with(Solid::all([0.04, 0.28].map(post))).at([0.0, 0.0, 0.74]).turned(1, 22.0)
}
