//! The triangles that cut each other, between which the core smooths the line.
//!
//! Pairs are looked for where objects stand in the first frame. The core computes each line from where the two triangles are, so a pair that has moved
//! apart has none.

use crate::vector::{V3, add, cross, dot, scale, sub};
use microphong::{
    Stream,
    format::{Length, Rotation, Scale, Unit},
    stream::record::{Cut, OBJECT_TRACK},
};
use std::ops::Range;

/// The length, in units of the world, below which a common line is too short to be seen: about a sixth of a pixel in a picture of 240 pixels.
const SHORTEST: f64 = 1.0 / 512.0;

/// A triangle in the world.
struct Placed {
    corners: [V3; 3],
    normal: V3,
    /// The least and the largest coordinates.
    least: V3,
    most: V3,
    number: u32,
    object: u16,
}

impl Placed {
    fn new(corners: [V3; 3], number: u32, object: u16) -> Self {
        let [a, b, c] = corners;
        let extreme = |of: fn(f64, f64) -> f64| [0, 1, 2].map(|axis| of(of(a[axis], b[axis]), c[axis]));
        Self { corners, normal: cross(sub(b, a), sub(c, a)), least: extreme(f64::min), most: extreme(f64::max), number, object }
    }
}

/// All pairs of full triangles that cut each other, in order.
pub(crate) fn of(stream: &Stream<'_>) -> Vec<Cut> {
    let mut triangles = placed(stream);
    triangles.sort_by(|a, b| a.least[0].total_cmp(&b.least[0]));
    let mut cuts = Vec::new();
    // Triangles whose extents along x overlap are neighbours in this order.
    for (i, one) in triangles.iter().enumerate() {
        for other in triangles[i + 1..].iter().take_while(|other| other.least[0] <= one.most[0]) {
            let overlap = |axis: usize| one.least[axis] <= other.most[axis] && other.least[axis] <= one.most[axis];
            if overlap(1) && overlap(2) && common(one, other) > SHORTEST {
                cuts.push(Cut { triangles: [one.number, other.number], objects: [one.object, other.object] });
            }
        }
    }
    cuts.sort_by_key(|cut| (cut.objects, cut.triangles));
    cuts
}

/// The full triangles of all objects.
fn placed(stream: &Stream<'_>) -> Vec<Placed> {
    let mut triangles = Vec::new();
    let mut place = |object: u16, meshes: Range<usize>, to_world: &dyn Fn(V3) -> V3| {
        for mesh in stream.meshes.get(meshes).unwrap_or_default().iter().filter(|mesh| mesh.error == 0) {
            let vertices = stream.vertices_of(mesh).unwrap_or_default();
            let corner = |index: u16| to_world(vertices[usize::from(index)].position.map(|c| f64::from(Unit::from_bits(c))));
            for (number, triangle) in (mesh.first_triangle..).zip(stream.triangles_of(mesh).unwrap_or_default()) {
                triangles.push(Placed::new(triangle.corners.map(corner), number, object));
            }
        }
    };
    if stream.instances.is_empty() {
        place(0, 0..stream.meshes.len(), &|position| position);
    }
    for (index, instance) in (0..).zip(stream.instances) {
        let track = stream.tracks.iter().find(|track| track.kind == OBJECT_TRACK && track.index == index);
        let key = track.and_then(|track| stream.keys_of(track)?.first());
        let first = usize::from(instance.first_mesh);
        let meshes = first..first + usize::from(instance.meshes);
        let Some(key) = key else {
            place(index, meshes, &|position| position);
            continue;
        };
        let [w, x, y, z] = key.rotation.map(|c| f64::from(Rotation::from_bits(c)));
        let (axis, size) = ([x, y, z], f64::from(Scale::from_bits(key.scale)));
        let origin = key.position.map(|c| f64::from(Length::from_bits(c)));
        // v + 2 q × (q × v + w v).
        let turned = |v: V3| add(v, scale(cross(axis, add(cross(axis, v), scale(v, w))), 2.0));
        place(index, meshes, &|position| add(origin, scale(turned(position), size)));
    }
    triangles
}

/// The length of the line that two triangles have in common: 0 if they touch, share a corner, or lie in one plane.
fn common(one: &Placed, other: &Placed) -> f64 {
    if one.corners.iter().any(|corner| other.corners.contains(corner)) {
        return 0.0;
    }
    let line = cross(one.normal, other.normal);
    let length = dot(line, line).sqrt();
    let (Some(a), Some(b)) = (cut(one, other, line), cut(other, one, line)) else { return 0.0 };
    (a[1].min(b[1]) - a[0].max(b[0])) / length.max(f64::MIN_POSITIVE)
}

/// The part of the line of both planes that lies in the triangle `one`, along the vector `line`.
fn cut(one: &Placed, other: &Placed, line: V3) -> Option<[f64; 2]> {
    let distances = one.corners.map(|corner| dot(other.normal, sub(corner, other.corners[0])));
    let along = one.corners.map(|corner| dot(line, corner));
    let crossings = [0, 1, 2].map(|k| {
        let (a, b) = (distances[k], distances[(k + 1) % 3]);
        ((a < 0.0) != (b < 0.0)).then(|| along[k] + (along[(k + 1) % 3] - along[k]) * a / (a - b))
    });
    let mut found = crossings.into_iter().flatten();
    let (a, b) = (found.next()?, found.next()?);
    Some([a.min(b), a.max(b)])
}
