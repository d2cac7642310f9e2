//! Whether the renderer may draw a mesh without depth: all that [`CLOSED_CONVEX`] promises.
//!
//! [`CLOSED_CONVEX`]: microphong::stream::record::CLOSED_CONVEX

use crate::{
    mesh::{Mesh, is_closed},
    records,
    vector::{V3, cross, dot, length, scale, sub, unit},
};
use microphong::{
    format::UNIT,
    stream::record::{LEAN, Triangle, Vertex},
};
use std::f64::consts::PI;

/// Amount by which a file's decimals may change a convex body, in units of the last place. The existence of an exactly convex body this close is
/// taken for granted; the renderer has a margin of 0.36.
const SLACK: f64 = 0.25;

/// Whether `mesh` is closed and convex, and its rounded copy, `vertices` and `triangles`, has all of its triangles with hardly leaning planes.
///
/// Looks at the mesh before rounding: after it, every other flat quadrilateral has a dent.
#[must_use]
pub fn is_closed_convex(mesh: &Mesh, vertices: &[Vertex], triangles: &[Triangle]) -> bool {
    let Some(faces) = solid(mesh) else { return false };
    is_closed(mesh) && is_small(mesh) && surrounds(&faces) && leans_little(&faces, vertices, triangles) && is_convex(mesh, &faces)
}

/// A triangle's corners and normal.
struct Face {
    corners: [V3; 3],
    normal: V3,
}

/// All triangles; `None` if one has no area.
fn solid(mesh: &Mesh) -> Option<Vec<Face>> {
    let faces = mesh.triangles.iter().map(|triangle| {
        let corners = triangle.map(|v| mesh.positions[v]);
        Some(Face { corners, normal: normal(corners)? })
    });
    faces.collect()
}

fn normal([a, b, c]: [V3; 3]) -> Option<V3> {
    unit(cross(sub(b, a), sub(c, a)))
}

/// Whether the mesh lies in the ball of radius 1.
fn is_small(mesh: &Mesh) -> bool {
    mesh.positions.iter().all(|&p| length(p) < 1.0 + 1e-9)
}

/// Seen from within, all triangles show their back, and cover the sphere of directions once: the surface is one, and
/// neither it nor its outside is wound up.
fn surrounds(faces: &[Face]) -> bool {
    let sum = faces.iter().flat_map(|face| face.corners).fold([0.0; 3], |sum, p| [0, 1, 2].map(|k| sum[k] + p[k]));
    let centre = scale(sum, 1.0 / (3 * faces.len()) as f64);
    let angles = faces.iter().map(|face| solid_angle(face.corners.map(|p| sub(p, centre))));
    let sum: Option<f64> = angles.map(|angle| Some(angle).filter(|&angle| angle > 0.0)).sum();
    sum.is_some_and(|sum| (sum - 4.0 * PI).abs() < 1e-3)
}

/// Under which the origin sees a triangle; positive if it sees its back. Van Oosterom and Strackee, 1983, equation 8.
fn solid_angle([a, b, c]: [V3; 3]) -> f64 {
    let [x, y, z] = [a, b, c].map(length);
    2.0 * dot(a, cross(b, c)).atan2(x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y)
}

/// Rounding has turned no plane by more than 2^-[`LEAN`] rad.
fn leans_little(faces: &[Face], vertices: &[Vertex], triangles: &[Triangle]) -> bool {
    let rounded = triangles.iter().map(|t| normal(t.corners.map(|v| records::position(&vertices[usize::from(v)]).map(f64::from))));
    faces.len() == triangles.len()
        && faces.iter().zip(rounded).all(|(face, rounded)| rounded.is_some_and(|n| length(sub(n, face.normal)) < (-f64::from(LEAN)).exp2()))
}

/// Whether all corners lie below all planes.
fn is_convex(mesh: &Mesh, faces: &[Face]) -> bool {
    let slack = SLACK / f64::from(1 << UNIT);
    faces.iter().all(|face| mesh.positions.iter().all(|&p| dot(face.normal, sub(p, face.corners[0])) <= slack))
}
