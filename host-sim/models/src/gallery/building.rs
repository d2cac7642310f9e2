//! A town house: flat sides, hard edges, and ten materials.

use super::solid::Solid;

const BRICK: u32 = 0xb8_5b42;
const STONE: u32 = 0xb9_b3a7;
const PLASTER: u32 = 0xea_dcc0;
const SLATE: u32 = 0x56_6070;
const WOOD: u32 = 0x7a_4f33;
const FRAME: u32 = 0xf5_f1e6;
const GLASS: u32 = 0x6f_a5c4;
const IRON: u32 = 0x34_3b42;
const AWNING: u32 = 0x2f_7d6b;
const PAVING: u32 = 0x9c_a09a;

/// The height of a floor, and the distances of the front and of a side from the middle.
const FLOOR: f64 = 0.5;
const FRONT: f64 = 0.5;
const SIDE: f64 = 0.62;

pub(super) fn model() -> Solid {
    let ground = Solid::block([2.1, 0.08, 1.9]).at([0.0, -0.08, 0.1]).of(PAVING);
    Solid::all([ground, walls(), floors(), roof(), shop(), balcony(), steps()])
}

fn walls() -> Solid {
    // The ground floor is a little wider: no edges of the two lie on each other.
    let ground = Solid::block([2.0 * SIDE + 0.02, FLOOR, 2.0 * FRONT + 0.02]).of(PLASTER);
    let upper = Solid::block([2.0 * SIDE, 2.0 * FLOOR, 2.0 * FRONT]).at([0.0, FLOOR, 0.0]).of(BRICK);
    let ledge = |y: f64| Solid::block([2.0 * SIDE + 0.08, 0.05, 2.0 * FRONT + 0.08]).at([0.0, y, 0.0]).of(STONE);
    let corner = Solid::all((0..6).map(|k| {
        let width = if k % 2 == 0 { 0.16 } else { 0.11 };
        Solid::block([width, 0.1, width]).at([SIDE - width / 2.0 + 0.015, 1.04 * FLOOR + 0.16 * f64::from(k), FRONT - width / 2.0 + 0.015])
    }));
    let ledges = Solid::all([1.0, 3.0].map(|floor| ledge(floor * FLOOR - 0.025)));
    Solid::all([ground, upper, ledges, corner.of(STONE).paired()])
}

/// Windows in all walls of the upper floors.
fn floors() -> Solid {
    let row = |turn: f64, out: f64, places: &[f64], floor: f64| {
        let one = |x: &f64| window().at([*x, floor * FLOOR + 0.14, out]);
        Solid::all(places.iter().map(one)).turned(1, turn)
    };
    let wide = [-0.42, 0.0, 0.42];
    let around = |floor: f64| {
        let front = if floor < 1.5 { &[-0.42, 0.42][..] } else { &wide };
        Solid::all([
            row(0.0, FRONT, front, floor),
            row(90.0, SIDE, &[-0.25, 0.25], floor),
            row(-90.0, SIDE, &[-0.25, 0.25], floor),
            row(180.0, FRONT, &wide, floor),
        ])
    };
    around(1.0).with(around(2.0))
}

fn window() -> Solid {
    let sill = Solid::block([0.3, 0.03, 0.08]).at([0.0, -0.03, 0.0]).of(STONE);
    sill.with(pane([0.24, 0.27]))
}

/// A pane in its frame.
fn pane([width, height]: [f64; 2]) -> Solid {
    let frame = Solid::block([width, height, 0.04]).of(FRAME);
    let half = Solid::block([width / 2.0 - 0.035, height - 0.05, 0.06]).at([width / 4.0 - 0.0025, 0.025, 0.0]);
    frame.with(half.of(GLASS).paired())
}

fn roof() -> Solid {
    let slope = Solid::prism(&[[-SIDE - 0.08, 0.0], [SIDE + 0.08, 0.0], [0.25, 0.42], [-0.25, 0.42]], 2.0 * FRONT + 0.16, 0.0);
    let slope = slope.at([0.0, 3.0 * FLOOR + 0.025, 0.0]).of(SLATE);
    let attic = |x: f64| pane([0.2, 0.24]).at([x, 3.0 * FLOOR + 0.08, FRONT + 0.08]);
    let chimney = Solid::block([0.18, 0.4, 0.22]).at([0.3, 3.0 * FLOOR + 0.25, -0.15]).of(BRICK);
    let pot = Solid::lathe(&[[0.05, 0.0], [0.04, 0.12]], 6).faceted().at([0.3, 3.0 * FLOOR + 0.65, -0.15]).of(STONE);
    Solid::all([slope, attic(-0.2), attic(0.2), chimney, pot])
}

/// A door, a shop window and an awning.
fn shop() -> Solid {
    let door = Solid::block([0.24, 0.4, 0.05]).at([-0.4, 0.06, FRONT]).of(WOOD);
    let knob = Solid::block([0.03, 0.03, 0.04]).at([-0.32, 0.24, FRONT + 0.03]).of(IRON);
    let frame = Solid::block([0.66, 0.36, 0.04]).at([0.2, 0.08, FRONT]).of(WOOD);
    let glass = |x: f64| Solid::block([0.19, 0.3, 0.06]).at([x, 0.11, FRONT]).of(GLASS);
    let panes = Solid::all([-0.01, 0.2, 0.41].map(glass));
    let cloth = Solid::prism(&[[0.0, 0.0], [0.3, -0.1], [0.3, -0.07], [0.0, 0.04]], 0.78, 0.0).turned(1, -90.0);
    Solid::all([door, knob, frame, panes, cloth.at([0.2, 0.46, FRONT]).of(AWNING)])
}

fn balcony() -> Solid {
    let slab = Solid::block([0.42, 0.04, 0.24]).of(STONE);
    let bar = |x: f64, z: f64| Solid::block([0.016, 0.2, 0.016]).at([x, 0.04, z]);
    let front = (-4..=4).map(|k| bar(0.05 * f64::from(k), 0.11));
    let sides = [-0.2, 0.2].into_iter().flat_map(|x| [0.0, 0.05].map(|z| bar(x, z)));
    let rail = Solid::block([0.44, 0.02, 0.02]).at([0.0, 0.24, 0.11]);
    let ends = Solid::block([0.02, 0.02, 0.22]).at([0.205, 0.24, 0.01]).paired();
    let door = Solid::block([0.24, 0.36, 0.04]).at([0.0, 0.04, -0.12]).of(FRAME);
    let panes = Solid::block([0.085, 0.3, 0.06]).at([0.055, 0.07, -0.12]).of(GLASS).paired();
    let iron = Solid::all(front.chain(sides)).with(rail).with(ends).of(IRON);
    Solid::all([slab, iron, door, panes]).at([0.0, FLOOR + 0.02, FRONT + 0.12])
}

fn steps() -> Solid {
    Solid::all([0.0, 1.0].map(|k| Solid::block([0.36 - 0.06 * k, 0.03, 0.24 - 0.1 * k]).at([-0.4, 0.03 * k, FRONT + 0.1 - 0.05 * k])))
        .of(STONE)
}
