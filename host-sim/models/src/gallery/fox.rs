//! A fox on an autumn meadow.

use super::{
    nature::{meadow, sprout, stone},
    solid::{At, Solid, chance, circle, hex, ramp},
};
use crate::vector::V3;

const FUR: [u32; 3] = [0xb4_4a1c, 0xe0_6f26, 0xf7_9a45];
const WHITE: u32 = 0xff_f4e3;
const DARK: [u32; 2] = [0x2c_1c1a, 0x5e_3222];

pub(super) fn model() -> Solid {
    let fox = Solid::all([body(), legs(), head().turned(0, 6.0).turned(1, 16.0).at([0.0, 1.02, 0.74]), tail()]);
    Solid::all([fox.at([0.0, 0.0, -0.05]), ground()])
}

/// A part of the animal along z. Each of its rings has a place along z, a height, and halves of its own width and height.
fn limb(rings: &[[f64; 4]], colour: impl Fn(At) -> V3) -> Solid {
    let ring = |&[z, y, width, height]: &[f64; 4]| circle(8).map(|[sin, cos]| [width * cos, y + height * sin, z]).collect::<Vec<V3>>();
    Solid::loft(&rings.iter().map(ring).collect::<Vec<_>>()).faceted().painted(colour)
}

/// Fur is white below and lighter on the back.
fn fur(At { point, middle, normal }: At) -> V3 {
    if normal[1] < -0.55 { hex(WHITE) } else { ramp(&FUR, 0.35 + 0.5 * normal[1] + 0.35 * (point[1] - middle[1]) + 0.1 * chance(middle)) }
}

fn body() -> Solid {
    let rings = [
        [-0.72, 0.74, 0.02, 0.03],
        [-0.68, 0.74, 0.17, 0.19],
        [-0.45, 0.74, 0.25, 0.27],
        [-0.1, 0.72, 0.22, 0.24],
        [0.2, 0.71, 0.24, 0.27],
        [0.42, 0.75, 0.24, 0.29],
        [0.6, 0.86, 0.17, 0.23],
        [0.7, 0.98, 0.12, 0.14],
        [0.74, 1.02, 0.02, 0.03],
    ];
    // The chest is white, too.
    limb(&rings, |at| if at.normal[2] > 0.35 && at.middle[1] < 0.95 { hex(WHITE) } else { fur(at) })
}

fn legs() -> Solid {
    let leg = |x: f64, z: f64, step: f64, thick: f64| {
        let path = [
            ([0.8 * x, 0.68, z], thick),
            ([x, 0.5, z - 0.02 + 0.3 * step], 0.95 * thick),
            ([x, 0.3, z + 0.02 + 0.6 * step], 0.62 * thick),
            ([x, 0.1, z + step], 0.55 * thick),
            ([x, 0.0, z + 0.02 + step], 0.66 * thick),
        ];
        let paw = Solid::ball(6, 3).sized([0.075, 0.05, 0.11]).at([x, 0.035, z + 0.06 + step]);
        let stocking = |at: At| ramp(&[DARK[0], DARK[1], FUR[0], FUR[1]], at.point[1] * 1.45);
        Solid::tube(&path, 6).faceted().painted(stocking).with(paw.faceted().of(DARK[0]))
    };
    Solid::all([leg(0.13, 0.38, 0.12, 0.1), leg(-0.13, 0.38, -0.1, 0.1), leg(0.14, -0.48, -0.12, 0.12), leg(-0.14, -0.48, 0.1, 0.12)])
}

/// The head, whose place on the neck is the origin.
fn head() -> Solid {
    let rings = [
        [-0.2, 0.1, 0.02, 0.03],
        [-0.16, 0.1, 0.16, 0.15],
        [0.0, 0.12, 0.26, 0.2],
        [0.14, 0.1, 0.25, 0.17],
        [0.26, 0.05, 0.12, 0.1],
        [0.48, 0.01, 0.055, 0.055],
        [0.52, 0.01, 0.02, 0.02],
    ];
    // Cheeks and chin are white.
    let colour = |at: At| {
        if at.normal[1] < -0.15 && at.middle[2] > -0.02 {
            hex(WHITE)
        } else {
            fur(At { middle: [at.middle[0], at.middle[1] - 0.1, at.middle[2]], ..at })
        }
    };
    let skull = limb(&rings, colour);
    let nose = Solid::ball(5, 3).sized([0.045, 0.04, 0.04]).at([0.0, 0.045, 0.51]).of(DARK[0]);
    let ear =
        Solid::lathe(&[[0.11, 0.0], [0.09, 0.1], [0.0, 0.3]], 4).sized([1.0, 1.0, 0.5]).faceted().graded(1, &[FUR[1], FUR[1], DARK[0]]);
    let inner = Solid::lathe(&[[0.07, 0.0], [0.0, 0.2]], 4).sized([1.0, 1.0, 0.4]).faceted().at([0.0, 0.02, 0.035]).of(WHITE);
    let ears = ear.with(inner).turned(2, -16.0).at([0.15, 0.25, -0.02]).paired();
    let eye = Solid::ball(5, 3).sized([0.03, 0.04, 0.02]).of(0x1d_1210).turned(1, 25.0).at([0.125, 0.135, 0.215]).paired();
    Solid::all([skull, nose, ears, eye])
}

fn tail() -> Solid {
    let path = [
        ([0.0, 0.78, -0.62], 0.06),
        ([0.02, 0.72, -0.82], 0.12),
        ([0.06, 0.66, -1.02], 0.19),
        ([0.1, 0.7, -1.22], 0.2),
        ([0.12, 0.84, -1.38], 0.13),
        ([0.12, 0.98, -1.46], 0.01),
    ];
    let colour = |at: At| if at.middle[2] < -1.27 { hex(WHITE) } else { ramp(&FUR, (at.point[1] - 0.5) * 2.2) };
    Solid::tube(&path, 8).faceted().painted(colour)
}

fn ground() -> Solid {
    let meadow = meadow(1.45, 12, [0xa9_8f3f, 0xc4_a94e], |p| 0.04 * (chance(p) - 0.5)).at([0.0, 0.0, -0.15]);
    let mushroom = |scale: f64, at: V3| sprout(0.16, [0.12, 0.11], [0xf3_e3cc, 0xc9_4236]).sized([scale; 3]).at(at);
    let leaf = |k: i32| {
        let (turn, far) = (f64::from(k) * 67.0, 0.55 + 0.6 * chance([f64::from(k), 1.0, 2.0]));
        let leaf = Solid::prism(&[[-0.07, 0.0], [0.0, -0.04], [0.08, 0.0], [0.0, 0.04]], 0.012, 0.0).turned(0, -90.0);
        leaf.at([far, 0.035, 0.0]).turned(1, turn).of([0xd9_5f28, 0xf0_b23c, 0xb8_3b2a][k as usize % 3])
    };
    let grass = |k: i32| {
        let blade = |turn: f64| Solid::lathe(&[[0.03, -0.03], [0.0, 0.24]], 3).sized([1.0, 1.0, 0.4]).turned(2, 16.0).turned(1, turn);
        let tuft = Solid::all([0.0, 120.0, 230.0].map(blade)).graded(1, &[0x5e_6b2a, 0xd8_cf72]);
        tuft.at([0.7 + 0.45 * chance([f64::from(k), 5.0, 2.0]), 0.0, 0.0]).turned(1, f64::from(k) * 77.0 + 20.0)
    };
    let stones = stone([0.2, 0.14, 0.16], 1.0).at([-0.78, 0.03, -0.35]);
    let mushrooms = Solid::all([mushroom(1.0, [0.72, 0.0, 0.42]), mushroom(0.65, [0.88, 0.0, 0.3]), mushroom(0.5, [0.7, 0.0, 0.24])]);
    Solid::all([meadow, stones, mushrooms]).with(Solid::all((0..7).map(leaf))).with(Solid::all((0..6).map(grass)))
}
