//! A cottage in its garden.

use super::{
    nature::{foliage, meadow, sprout, stone},
    solid::{Solid, chance},
};

pub(super) fn model() -> Solid {
    let ground = meadow(1.5, 12, [0x6f_a84a, 0x8c_bf57], |p| 0.03 * (chance(p) - 0.5));
    Solid::all([ground, house().at([-0.1, 0.0, -0.2]), fence(), garden()])
}

fn house() -> Solid {
    let walls = Solid::prism(&[[-0.55, -0.06], [0.55, -0.06], [0.55, 0.5], [0.0, 1.02], [-0.55, 0.5]], 0.9, 0.0);
    let walls = walls.graded(1, &[0xc9_a988, 0xf4_e6cb, 0xff_f6e4]);
    let base = Solid::block([1.16, 0.14, 0.96]).at([0.0, -0.06, 0.0]).of(0x8b_8a86);
    let chimney = Solid::block([0.17, 0.5, 0.17]).at([0.3, 0.68, -0.18]).graded(1, &[0x8a_4a38, 0xb5_6a4c]);
    let cap = Solid::block([0.22, 0.05, 0.22]).at([0.3, 1.18, -0.18]).of(0x6a_6560);
    let door = Solid::prism(&[[-0.12, 0.0], [0.12, 0.0], [0.12, 0.34], [0.0, 0.42], [-0.12, 0.34]], 0.06, 0.0).of(0x3d_7a86);
    let frame = Solid::prism(&[[-0.16, 0.0], [0.16, 0.0], [0.16, 0.36], [0.0, 0.47], [-0.16, 0.36]], 0.03, 0.0).of(0xff_f3dd);
    let knob = Solid::ball(4, 2).sized([0.025; 3]).at([0.07, 0.18, 0.04]).of(0xf0_c14b);
    let step = Solid::block([0.42, 0.06, 0.2]).at([0.0, -0.02, 0.06]).of(0xa5_a29c);
    let front = Solid::all([door, frame, knob, step]).at([-0.2, 0.03, 0.45]);
    let places = [(0.0, [0.24, 0.2, 0.45]), (90.0, [0.55, 0.2, 0.0]), (-90.0, [-0.55, 0.2, 0.0]), (180.0, [0.0, 0.2, -0.45])];
    let windows = Solid::all(places.map(|(turn, at)| window().turned(1, turn).at(at)));
    let disc = |radius: f64, thick: f64| Solid::lathe(&[[radius, 0.0], [radius, thick]], 6).turned(0, 90.0).at([0.0, 0.72, 0.44]);
    let attic = disc(0.12, 0.04).of(0xff_f3dd).with(disc(0.085, 0.06).graded(1, &[0x8f_d0e6, 0x3c_6f9c]));
    Solid::all([base, walls, roof(), chimney, cap, front, windows, attic])
}

/// Three rows of shingles on each side. A row lies on the one below it.
fn roof() -> Solid {
    let row = |(colour, k): (u32, f64)| Solid::block([0.32, 0.05, 1.1]).turned(2, -4.0).at([0.14 + 0.27 * k, 0.0, 0.0]).of(colour);
    let rows = [0xe0_744f, 0xcb_5d40, 0xb3_4934].into_iter().zip([0.0, 1.0, 2.0]).map(row);
    let side = Solid::all(rows).turned(2, -43.4).at([-0.02, 1.03, 0.0]);
    let ridge = Solid::prism(&[[-0.07, 0.0], [0.07, 0.0], [0.0, 0.08]], 1.12, 0.0).at([0.0, 1.03, 0.0]).of(0xe5_835c);
    side.paired().with(ridge)
}

fn window() -> Solid {
    let frame = Solid::block([0.28, 0.28, 0.05]).of(0xff_f3dd);
    let glass = |x: f64| Solid::block([0.095, 0.2, 0.07]).at([x, 0.04, 0.0]).graded(1, &[0x9a_dcf0, 0x3c_6f9c]);
    let flowers = Solid::block([0.28, 0.09, 0.09]).at([0.0, -0.03, 0.05]).ruffled(0.02).graded(1, &[0x5f_8b3c, 0xe8_5d75]);
    Solid::all([frame, glass(-0.06), glass(0.06), flowers])
}

/// Pickets and a rail, around the front but for a gate.
fn fence() -> Solid {
    let post = |k: i32| {
        let picket = Solid::prism(&[[-0.035, 0.0], [0.035, 0.0], [0.035, 0.24], [0.0, 0.3], [-0.035, 0.24]], 0.04, 0.0);
        let rail = Solid::block([0.42, 0.05, 0.02]).at([0.21, 0.13, -0.03]).turned(1, 8.5);
        let field = if k == -2 || k == 4 { picket } else { picket.with(rail) };
        field.graded(1, &[0xc9_b8a0, 0xff_ffff]).at([0.0, -0.02, 1.3]).turned(1, 18.5 * f64::from(k))
    };
    Solid::all((-5..=-2).chain(1..=4).map(post))
}

fn garden() -> Solid {
    let flag = |k: i32| {
        let k = f64::from(k);
        let slab = Solid::lathe(&[[0.14, -0.05], [0.12, 0.035]], 5).turned(1, 40.0 * k).faceted();
        slab.at([-0.28 + 0.03 * libm::sin(2.3 * k), 0.0, 0.52 + 0.23 * k]).of([0xb9_b2a6, 0xc9_c3b6, 0xad_a69b][k as usize % 3])
    };
    let trunk = Solid::tube(&[([0.0, -0.05, 0.0], 0.09), ([0.0, 0.62, 0.02], 0.05)], 5).graded(1, &[0x4f_3423, 0x86_5c3c]);
    let green: [u32; 3] = [0x2f_6b3a, 0x5f_a345, 0xa9_cf5c];
    let crown = [([0.34, 0.3, 0.34], [0.0, 0.86, 0.0]), ([0.24, 0.2, 0.24], [0.2, 0.68, 0.14]), ([0.22, 0.2, 0.22], [-0.2, 0.72, -0.1])];
    let crown = Solid::all(crown.map(|(size, at)| foliage(size, at[0] * 7.0, &green).at(at)));
    let tree = trunk.with(crown).at([1.0, 0.0, -0.2]);
    let bushes = [([0.17, 0.15, 0.16], [0.36, 0.08, 0.46]), ([0.2, 0.18, 0.2], [-0.95, 0.1, -0.45])];
    let bushes = Solid::all(bushes.map(|(size, at)| foliage(size, at[0] * 5.0, &green).at(at)));
    let flower = |k: i32| {
        let colours = [0xf2_5f5c, 0xff_e066, 0xf7_f7ff, 0xb5_6bd1];
        let k = f64::from(k);
        let at = [-0.72 + 0.13 * (k % 3.0), 0.0, 0.56 + 0.12 * (k / 3.0).floor() + 0.05 * libm::sin(k * 2.0)];
        sprout(0.12, [0.05, 0.04], [0x4f_8b3c, colours[k as usize % 4]]).at(at)
    };
    let stones = stone([0.15, 0.1, 0.13], 1.0).at([0.98, 0.02, 0.42]);
    Solid::all((0..4).map(flag)).with(tree).with(bushes).with(Solid::all((0..5).map(flower))).with(stones)
}
