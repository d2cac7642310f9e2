//! Scenes of triangles side by side, none hidden, so that each can be judged and no time goes into hidden ones.

use crate::{
    case::Case,
    random::Random,
    scenes::{self, Hard, Wishes},
};
use microphong_models::{
    look::{Lamp, LampKind, Look},
    mesh::Mesh,
    vector::{V3, add, scale, sub, unit},
    view::View,
};

/// Kinds of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Normals that differ little, as in a fine mesh.
    Gentle,
    /// Normals that differ as in a coarse mesh.
    Curved,
    /// Two normals are nearly equal and one is far off, as at a smoothed edge of a box.
    Creased,
    /// Two normals that are opposite to one another, or nearly so.
    Opposite,
    /// Hundreds of times as long as high.
    Sliver,
    /// No larger than a pixel or two.
    Tiny,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 6] = [Self::Gentle, Self::Curved, Self::Creased, Self::Opposite, Self::Sliver, Self::Tiny];
}

/// Most pixels of a picture from side to side.
const WIDTH: i32 = 200;
/// Most pixels from top to bottom.
const HEIGHT: i32 = 150;

/// Triangles side by side on a plane that faces the viewer, under one to four lights, drawn in a random way; `None` if they would not make
/// a valid stream.
pub fn case(random: &mut Random, hard: Hard) -> Option<Case> {
    let (mesh, look, size) = scene(random, hard);
    scenes::drawn(random, &mesh, size, &look)
}

/// Triangles, what they look like, and the size of their picture in pixels.
fn scene(random: &mut Random, hard: Hard) -> (Mesh, Look, [u32; 2]) {
    let tile = random.octaves(4.0, 48.0) as i32;
    let [columns, rows] = [WIDTH, HEIGHT].map(|side| random.pick(1..side / tile + 1));
    let size = [columns, rows].map(|count| (count * tile) as u32);
    // The centre of the picture is the origin, and its longer side reaches from -1 to 1, less what keeps depth within the ball.
    let unit_of = 1.8 / f64::from(columns.max(rows));
    let mut mesh = Mesh::default();
    let mut kinds = Vec::new();
    for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        // Creases and opposite normals are Phong's business; where more can go wrong, more is tried.
        let kinds_of = [Kind::ALL.as_slice(), &[Kind::Gentle, Kind::Gentle, Kind::Curved, Kind::Sliver]].concat();
        let kind = random.among(if hard.normals { &[Kind::Gentle, Kind::Gentle, Kind::Opposite] } else { &kinds_of[..] });
        let centre = [f64::from(2 * j + 1 - columns) / 2.0, f64::from(2 * i + 1 - rows) / 2.0];
        let depth = random.between(-0.2, 0.2);
        let first = mesh.positions.len();
        for [x, y] in corners(random, kind, 1.0 / f64::from(tile)) {
            mesh.positions.push([(centre[0] + x) * unit_of, (centre[1] + y) * unit_of, depth + random.between(-0.1, 0.1)]);
        }
        mesh.triangles.push([first, first + 1, first + 2]);
        kinds.push(kind);
    }
    let mut look = scenes::look(random, &mesh, size, Wishes { closed: false, unclipped: true, triangles: 1, hard });
    let view = View::facing([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], random.between(2.0, 8.0), [0.0, 0.0, 1.0], 0);
    let view = if !hard.local && random.once_in(2) { view.parallel() } else { view };
    look.view = view.fit(&mesh.positions, size.into(), 0.01);
    look.lamps = lamps(random, look.view.translation, hard.near);
    // A near viewer is seen by highlights.
    look.local_viewer = hard.local || random.once_in(8);
    for kind in kinds {
        let facing = facing(random, &look);
        mesh.normals.extend(normals(random, kind, facing, hard.normals));
    }
    (mesh, look, size)
}

/// Corners counter-clockwise in a tile from -0.5 to 0.5, of which a pixel is a share.
fn corners(random: &mut Random, kind: Kind, pixel: f64) -> [[f64; 2]; 3] {
    let mut point = |reach: f64| [random.between(-reach, reach), random.between(-reach, reach)];
    let mut corners = [point(0.5), point(0.5), point(0.5)];
    match kind {
        Kind::Sliver => {
            let ([a, b, _], [x, y]) = (corners, point(0.6 * pixel));
            corners[2] = [(a[0] + b[0]) / 2.0 + x, (a[1] + b[1]) / 2.0 + y];
        }
        Kind::Tiny => {
            // Around the centre of the tile, or of a pixel beside it.
            let reach = 1.5 * pixel.min(0.3);
            corners = [point(reach), point(reach), point(reach)];
        }
        _ => {}
    }
    let [a, b, c] = corners;
    if (b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0]) {
        corners.swap(1, 2);
    }
    corners
}

/// One to four lights, of which few are near ones.
fn lamps(random: &mut Random, object: V3, certainly_near: bool) -> Vec<Lamp> {
    let near = certainly_near || random.once_in(6);
    let count = random.among(&[1, 1, 1, 2, 2, 2, 3, 4]);
    let mut lamp = |number| {
        let (direction, colour) = (random.direction(), scenes::colour(random));
        if certainly_near && number == 0 || near && random.once_in(2) {
            Lamp::near(add(object, scale(direction, random.octaves(0.3, 8.0))), colour)
        } else {
            Lamp::distant(direction, colour)
        }
    };
    let lamps: Vec<Lamp> = (0..count).map(&mut lamp).collect();
    lamps.into_iter().map(|lamp| scenes::shaped(random, lamp, object)).collect()
}

/// A direction in object space that a triangle faces: any, or the one at which a light has its highlight.
fn facing(random: &mut Random, look: &Look) -> V3 {
    let anywhere = random.direction();
    if random.once_in(2) {
        return anywhere;
    }
    let lamp = &look.lamps[random.pick(0..look.lamps.len() as i32) as usize];
    let towards = if lamp.kind == LampKind::Near { sub(lamp.vector, look.view.translation) } else { lamp.vector };
    // The eye looks along z of its space, from where z is negative; in object space, it is turned round.
    let [x, y, z] = unit(towards).unwrap_or(anywhere);
    let half = unit([x, y, 1.0 - z]).unwrap_or(anywhere);
    let width = 1.0 / f64::from(look.surfaces[0].exponent).sqrt();
    unit(add(half, scale(anywhere, width * random.between(0.0, 5.0)))).unwrap_or(half)
}

/// Normals of a triangle that faces this direction. `nearly` makes them almost equal or opposite.
fn normals(random: &mut Random, kind: Kind, facing: V3, nearly: bool) -> [V3; 3] {
    let spread = match kind {
        _ if nearly => random.octaves(3e-4, 0.02),
        Kind::Gentle => random.octaves(0.002, 0.1),
        Kind::Curved => random.octaves(0.1, 1.0),
        Kind::Creased | Kind::Opposite => random.octaves(0.002, 0.3),
        Kind::Sliver | Kind::Tiny => random.octaves(0.002, 1.0),
    };
    let exactly = random.once_in(3);
    let mut beside = |from: V3, spread: f64| unit(add(from, scale(random.direction(), spread))).unwrap_or(facing);
    let mut normals = [(); 3].map(|()| beside(facing, spread));
    match kind {
        Kind::Creased => normals[2] = beside(facing, 3.0),
        Kind::Opposite => {
            let opposite = normals[0].map(|c| -c);
            normals[1] = if exactly { opposite } else { beside(opposite, spread) };
        }
        _ => {}
    }
    normals
}
