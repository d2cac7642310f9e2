//! Random scenes: meshes, materials, lights and cameras that renderers get wrong.

use crate::{case::Case, colours, random::Random, textures};
use microphong::Skips;
use microphong_models::{
    bytes::StreamBytes,
    levels,
    look::{Cone, Lamp, LampKind, Look, Surface},
    mesh::Mesh,
    quantise::{Part, quantise},
    shapes,
    vector::{V3, add, apply, cross, length, rotation, scale, sub, unit},
    view::{Projection, View},
};
use microphong_render::{
    render::{Format, Style},
    shader::Shader,
};
use std::f64::consts::TAU;

/// Features that a random scene may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wishes {
    /// The mesh is closed: nobody may see its inside, nor through it.
    pub closed: bool,
    /// Whether all of the scene lies behind the near plane and within the guard band.
    pub unclipped: bool,
    /// Triangles at most, about.
    pub triangles: i32,
    /// Features that are hard to compute.
    pub hard: Hard,
}

/// Features that make arithmetic hard, and that a scene has for certain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hard {
    /// A material of an exponent above 256.
    pub steep: bool,
    /// Normals of a triangle that are nearly equal, or nearly opposite.
    pub normals: bool,
    /// A local viewer.
    pub local: bool,
    /// A near light.
    pub near: bool,
}

impl Hard {
    /// One or more of these features.
    pub fn random(random: &mut Random) -> Self {
        let bits = random.pick(1..16);
        Self { steep: bits & 1 != 0, normals: bits & 2 != 0, local: bits & 4 != 0, near: bits & 8 != 0 }
    }
}

/// A random scene, drawn in a random way; `None` if it would not make a valid stream.
pub fn case(random: &mut Random, wishes: Wishes) -> Option<Case> {
    let width = random.between(1.0, 160.0);
    let size = size(random, width);
    let mesh = mesh(random, wishes);
    of(random, &mesh, size, wishes)
}

/// A picture so wide, and mostly about as high, so that what fits covers it.
pub fn size(random: &mut Random, width: f64) -> [u32; 2] {
    let height = width * if random.once_in(4) { random.octaves(0.1, 4.0) } else { random.between(0.6, 1.2) };
    [width as u32, (height as u32).clamp(1, 240)]
}

/// A random mesh.
pub fn mesh(random: &mut Random, wishes: Wishes) -> Mesh {
    // Bodies have no normals but those of their shapes.
    if wishes.closed || !wishes.hard.normals && random.once_in(3) {
        body(random, wishes.triangles)
    } else {
        soup(random, wishes.triangles.min(40), wishes.hard.normals)
    }
}

/// A random scene of `mesh` on a picture of `size`.
pub fn of(random: &mut Random, mesh: &Mesh, size: [u32; 2], wishes: Wishes) -> Option<Case> {
    let look = look(random, mesh, size, wishes);
    drawn(random, mesh, size, &look)
}

/// A scene, drawn in a random way on a picture of `size`, in about an eighth of all cases with textures.
pub fn drawn(random: &mut Random, mesh: &Mesh, size: [u32; 2], look: &Look) -> Option<Case> {
    let parts = parts(random, mesh, look)?;
    let stream = look.stream(&parts).ok()?;
    // All else of a scene is the same with a texture and without it.
    let mut aside = random.aside(1 << 32);
    let textured = if aside.once_in(8) { textures::paint(&mut aside, &stream) } else { None };
    Some(styled(random, textured.unwrap_or(stream), size))
}

/// A mesh, now and then with coarser levels, and in about a fifth of all cases with colours at the corners.
pub fn parts(random: &mut Random, mesh: &Mesh, look: &Look) -> Option<Vec<Part>> {
    let (mut parts, _) = quantise(mesh);
    // Seldom, and of small meshes: to make coarser levels of large ones takes longer than all else.
    if random.once_in(8) && mesh.triangles.len() <= 128 {
        let errors = [(32, 32), (128, 96)].map(|size| look.tolerance(&parts, size));
        levels::add(mesh, &mut parts, &errors, &|| ()).ok()?;
    }
    // All else of a scene is the same with colours and without them.
    let mut aside = random.aside(0);
    if aside.once_in(4) {
        colours::paint(&mut aside, &mut parts);
    }
    Some(parts)
}

/// A stream, drawn in a random way on a picture of `size`.
pub fn styled(random: &mut Random, stream: StreamBytes, size: [u32; 2]) -> Case {
    let style = Style {
        shader: random.among(&Shader::ALL),
        perspective_correct: random.once_in(4),
        antialias: random.once_in(4),
        outlines: None,
        dither: random.once_in(4),
        srgb: false,
        skips: Skips::ALL,
    };
    Case {
        size,
        frame: if random.once_in(3) { 0 } else { random.bits() as u32 },
        style,
        format: random.among(&Format::ALL),
        band_rows: random.pick(1..64) as u32,
        ..Case::new(stream)
    }
}

/// A closed body.
fn body(random: &mut Random, triangles: i32) -> Mesh {
    let mut mesh = match random.pick(0..5) {
        0 => shapes::dodecahedron(),
        1 => {
            let around = random.pick(3..(triangles / 12).max(5)) as usize;
            shapes::torus(around, random.pick(3..8) as usize)
        }
        _ => {
            let meridians = random.pick(3..(triangles / 8).max(5)) as usize;
            shapes::sphere(meridians, random.pick(2..8) as usize, 0.1)
        }
    };
    let flat = if random.once_in(2) { 1.0 } else { random.octaves(0.01, 1.0) };
    let rough = if random.once_in(2) { 0.0 } else { random.between(0.0, 0.4) };
    for position in &mut mesh.positions {
        let radius = 1.0 - rough * random.between(0.0, 1.0);
        *position = [position[0] * radius, position[1] * radius, position[2] * radius * flat];
    }
    mesh
}

/// Triangles without a neighbour: slivers, tiny and huge ones, with normals that fit their planes or do not.
fn soup(random: &mut Random, triangles: i32, hard: bool) -> Mesh {
    let mut mesh = Mesh::default();
    // In half of the scenes no two normals of a triangle are nearly opposite, so that shading is defined everywhere.
    let wild = random.once_in(2);
    let nearly = if hard { random.octaves(3e-4, 0.02) } else { 0.0 };
    for _ in 0..random.pick(1..triangles.max(2)) {
        let centre = scale(random.direction(), random.between(0.0, 0.9));
        let size = if random.once_in(2) { random.between(0.3, 1.0) } else { random.octaves(0.001, 1.0) };
        let thin = if random.once_in(3) { random.octaves(0.001, 1.0) } else { 1.0 };
        let (along, across) = (scale(random.direction(), size), scale(random.direction(), size * thin));
        let corners = shown(random, [add(centre, along), add(centre, scale(along, -1.0)), add(centre, across)]);
        let facing = random.direction();
        let spread = match (hard, wild) {
            (true, _) => nearly,
            (_, true) => random.among(&[0.0, 0.1, 0.5, 1.0, 3.0]),
            _ => random.among(&[0.0, 0.1, 0.5, 0.8]),
        };
        let first = mesh.positions.len();
        for corner in corners {
            mesh.positions.push(corner.map(|c| c.clamp(-1.0, 1.0)));
            let normal = add(facing, scale(random.direction(), spread));
            mesh.normals.push(unit(normal).unwrap_or(facing));
        }
        // Some have normals that are opposite to one another.
        if wild && random.once_in(if hard { 3 } else { 8 }) {
            let opposite = mesh.normals[first].map(|c| -c);
            let aside = if hard { scale(random.direction(), nearly) } else { [0.0; 3] };
            mesh.normals[first + 1] = unit(add(opposite, aside)).unwrap_or(opposite);
        }
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    mesh
}

/// A triangle that mostly shows its front to where z is positive, as [`look`] mostly sees it.
pub fn shown(random: &mut Random, [a, b, c]: [V3; 3]) -> [V3; 3] {
    let is_front = cross(sub(b, a), sub(c, a))[2] > 0.0;
    if is_front || random.once_in(8) { [a, b, c] } else { [b, a, c] }
}

/// A colour of a light or a surface.
pub fn colour(random: &mut Random) -> V3 {
    match random.pick(0..4) {
        0 => [1.0; 3],
        1 => [0.0, 0.0, random.between(0.0, 1.0)],
        _ => [(); 3].map(|()| random.between(0.0, 1.0)),
    }
}

/// A material; with an exponent above 256 if it is `steep`.
pub fn surface(random: &mut Random, steep: bool) -> Surface {
    let exponent = if steep {
        random.octaves(257.0, 1025.0) as u16
    } else if random.once_in(3) {
        random.among(&[1, 2, 3, 4, 7, 8, 512, 1023, 1024])
    } else {
        random.octaves(1.0, 1025.0) as u16
    };
    let shares = [random.between(0.0, 0.3), random.between(0.0, 1.0), random.between(0.0, 1.0)];
    let colour = colour(random);
    match random.pick(0..3) {
        0 => Surface::metal([1.0; 3], shares, exponent),
        1 => Surface::metal(colour, shares, exponent),
        _ => Surface::plastic(colour, shares, exponent),
    }
}

/// The lamp, or in a third of all cases one with a range or a cone, or one from the sky. The mesh is about `centre` in eye space.
pub fn shaped(random: &mut Random, lamp: Lamp, centre: V3) -> Lamp {
    if !random.once_in(3) {
        return lamp;
    }
    if lamp.kind == LampKind::Distant {
        return Lamp { kind: LampKind::Sky, ..lamp };
    }
    let way = sub(centre, lamp.vector);
    // Up to a quarter of the distance, which leaves a spot, or far beyond it.
    let range = (length(way) * random.octaves(0.25, 8.0)).clamp(0.125, 31.0);
    let axis = add(unit(way).unwrap_or([0.0, 0.0, 1.0]), scale(random.direction(), random.between(0.0, 0.7)));
    let full = random.between(0.0, 60.0);
    let cone = Cone { axis, full, edge: full + random.octaves(2.0, 100.0) };
    let (range, cone) = random.among(&[(Some(range), None), (None, Some(cone)), (Some(range), Some(cone))]);
    Lamp { range, cone, ..lamp }
}

/// Material, lights and camera for a picture of `size`. If nothing may be clipped, most scenes fill their pictures, some are small, and some reach
/// beyond the edges.
pub fn look(random: &mut Random, mesh: &Mesh, size: [u32; 2], wishes: Wishes) -> Look {
    let axis = random.direction();
    // Mostly from where single triangles show their front.
    let turned = rotation(random.direction(), if random.once_in(4) { random.between(0.0, TAU) } else { random.between(0.0, 0.5) });
    let distance = if wishes.unclipped { random.between(2.0, 8.0) } else { random.octaves(0.2, 12.0) };
    let period = random.among(&[0, 0, 1, 7, 120, 65_535]);
    let mut view = View::facing(turned, distance, axis, period);
    // Where rays are parallel no viewer is near.
    if !wishes.hard.local && random.once_in(3) {
        view = view.parallel();
    }
    if wishes.unclipped {
        let filled = match random.pick(0..8) {
            0 => random.octaves(0.05, 1.0),
            1..4 => random.octaves(1.0, 4.0),
            _ => 1.0,
        };
        view = view.fit(&mesh.positions, size.into(), 1.0 - filled);
    } else {
        view = view.focal(random.octaves(0.1, 12.0));
        view.near = match view.projection {
            Projection::Perspective => random.octaves(1.0 / 32.0, distance.max(0.1)),
            Projection::Orthographic => view.near,
        };
    }
    let mut look = Look::new(surface(random, wishes.hard.steep), view);
    let lamps = if random.once_in(2) { 1 } else { random.pick(i32::from(wishes.hard.near)..9) };
    look.lamps = (0..lamps)
        .map(|number| {
            let colour = colour(random);
            if wishes.hard.near && number == 0 || random.once_in(3) {
                // Somewhere around the mesh, or next to one of its vertices.
                let place = if random.once_in(2) {
                    scale(random.direction(), random.octaves(0.05, 8.0))
                } else {
                    let vertex = mesh.positions[random.pick(0..mesh.positions.len() as i32) as usize];
                    add(apply(&view.rotation, vertex), scale(random.direction(), random.octaves(0.005, 0.5)))
                };
                Lamp::near(add(place, view.translation), colour)
            } else {
                Lamp::distant(random.direction(), colour)
            }
        })
        .collect();
    look.local_viewer = wishes.hard.local || random.once_in(3);
    look.lamps = look.lamps.iter().map(|&lamp| shaped(random, lamp, view.translation)).collect();
    look.background = random.among(&[[0; 3], [255; 3], [26, 28, 32]]).into();
    look
}
