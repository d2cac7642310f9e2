//! A bearing bracket, as programs for mechanical design export it: large flat sides, bores and fillets of many thin triangles, one material.

use super::solid::{Point, Solid, circle};

const STEEL: u32 = 0x8f_a3b5;
/// Points around a bore.
const AROUND: usize = 48;

pub(super) fn model() -> Solid {
    let base = plate([1.1, 0.42], 0.13, 0.14).turned(0, -90.0).at([0.0, 0.0, 0.06]);
    let upright = bearing().at([0.0, 0.0, -0.28]);
    let rib = Solid::prism(&[[0.0, 0.0], [0.5, 0.0], [0.0, 0.55]], 0.09, 0.0).turned(1, -90.0).at([0.0, 0.12, -0.2]);
    let ribs = Solid::all([rib.clone().at([-0.4, 0.0, 0.0]), rib.at([0.4, 0.0, 0.0])]);
    Solid::all([base, upright, ribs, flange()]).of(STEEL)
}

/// A plate with a bore through it: half its width and height, the radius of the bore, and the thickness, half of it on each side of the plane of x
/// and y.
fn plate([x, y]: Point, bore: f64, thick: f64) -> Solid {
    // Eighths of the way around are corners.
    let edge = |[c, s]: Point| [x * c / c.abs().max(s.abs()), y * s / c.abs().max(s.abs())];
    pierced(edge, bore, thick)
}

/// The upright plate, round about its bore.
fn bearing() -> Solid {
    let edge = |[c, s]: Point| {
        let side = c.abs().max(s.abs());
        if s > 0.0 { [0.55 * c, 0.55 * s] } else { [0.55 * c / side, 0.6 * s / side] }
    };
    pierced(edge, 0.3, 0.16).at([0.0, 0.62, 0.0])
}

/// A plate between an edge, which is told by its direction from the middle of the bore, and the bore.
fn pierced(edge: impl Fn(Point) -> Point, bore: f64, thick: f64) -> Solid {
    // From y towards x, as circles are, would be clockwise.
    let directions: Vec<Point> = circle(AROUND).map(|[s, c]| [c, s]).collect();
    let ring = |z: f64, point: &dyn Fn(Point) -> Point| directions.iter().map(|&d| point(d)).map(|[x, y]| [x, y, z]).collect::<Vec<_>>();
    let (half, chamfer) = (thick / 2.0, 0.02);
    let round = |radius: f64| move |[c, s]: Point| [c * radius, s * radius];
    Solid::closed_loft(&[
        ring(-half, &edge),
        ring(half, &edge),
        ring(half, &round(bore + chamfer)),
        ring(half - chamfer, &round(bore)),
        ring(chamfer - half, &round(bore)),
        ring(-half, &round(bore + chamfer)),
    ])
}

/// The sleeve of the bearing, with a fillet where it leaves the plate.
fn flange() -> Solid {
    let fillet = (0..=4).map(|k| {
        let (s, c) = libm::sincos((22.5 * f64::from(k)).to_radians());
        [0.5 - 0.1 * s, 0.09 + 0.1 - 0.1 * c]
    });
    let outer = [[0.5, -0.05]].into_iter().chain(fillet).chain([[0.4, 0.42], [0.38, 0.44]]);
    let profile: Vec<Point> = outer.chain([[0.32, 0.44], [0.3, 0.42], [0.3, -0.05]]).collect();
    let ring = |&[radius, height]: &Point| circle(AROUND).map(|[x, z]| [radius * x, height, radius * z]).collect::<Vec<_>>();
    Solid::closed_loft(&profile.iter().map(ring).collect::<Vec<_>>()).turned(0, 90.0).at([0.0, 0.62, -0.28])
}
