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
    2.0 * libm::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y)
}

/// Rounding has turned no plane by more than 2^-[`LEAN`] rad.
fn leans_little(faces: &[Face], vertices: &[Vertex], triangles: &[Triangle]) -> bool {
    let rounded = triangles.iter().map(|t| normal(t.corners.map(|v| records::position(&vertices[usize::from(v)]).map(f64::from))));
    faces.len() == triangles.len()
        && faces
            .iter()
            .zip(rounded)
            .all(|(face, rounded)| rounded.is_some_and(|n| length(sub(n, face.normal)) < libm::exp2(-f64::from(LEAN))))
}

/// Whether all corners lie below all planes.
fn is_convex(mesh: &Mesh, faces: &[Face]) -> bool {
    let slack = SLACK / f64::from(1 << UNIT);
    let points = Points::new(&mut mesh.positions.clone());
    faces.iter().all(|face| points.are_below(face, slack))
}

/// Points in a box that is halved until few are left: boxes that lie below a plane as a whole spare the look at their points.
struct Points {
    low: V3,
    high: V3,
    inside: Inside,
}

enum Inside {
    Few(Vec<V3>),
    Halves(Box<[Points; 2]>),
}

/// Points at which a look takes no longer than at two boxes.
const FEW: usize = 4;

impl Points {
    /// Sorts the points of at least one.
    fn new(points: &mut [V3]) -> Self {
        let extreme = |of: fn(f64, f64) -> f64| points.iter().fold(points[0], |m, p| [0, 1, 2].map(|k| of(m[k], p[k])));
        let (low, high) = (extreme(f64::min), extreme(f64::max));
        let inside = if points.len() <= FEW {
            Inside::Few(points.to_vec())
        } else {
            let extent = |k: usize| high[k] - low[k];
            let longest = if extent(0) >= extent(1).max(extent(2)) { 0 } else { 1 + usize::from(extent(2) > extent(1)) };
            let middle = points.len() / 2;
            points.select_nth_unstable_by(middle, |a, b| a[longest].total_cmp(&b[longest]));
            let (one, other) = points.split_at_mut(middle);
            Inside::Halves(Box::new([Self::new(one), Self::new(other)]))
        };
        Self { low, high, inside }
    }

    /// Whether no point lies more than `slack` above the plane of a face.
    fn are_below(&self, face: &Face, slack: f64) -> bool {
        let height = |p: V3| dot(face.normal, sub(p, face.corners[0]));
        let highest = [0, 1, 2].map(|k| if face.normal[k] > 0.0 { self.high[k] } else { self.low[k] });
        height(highest) <= slack
            || match &self.inside {
                Inside::Few(points) => points.iter().all(|&p| height(p) <= slack),
                Inside::Halves(halves) => halves.iter().all(|half| half.are_below(face, slack)),
            }
    }
}
