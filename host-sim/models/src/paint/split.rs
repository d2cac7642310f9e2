//! Triangles of a mesh that are split at the middles of their edges.
//!
//! No vertex may lie on an edge of another triangle, because pixels between the two would have no triangle. So the edge of a triangle that is split is
//! split for all triangles that have it. A vertex in the middle of an edge has the normal that shading had there before.

use crate::{
    mesh::Mesh,
    vector::{V3, add, cross, length, scale, sub, unit},
};
use microphong::format::UNIT;
use std::collections::HashMap;

/// The least altitude of a triangle that is split, or of its neighbours: eight steps of positions. Parts of others might lose their area when
/// positions are rounded.
const LEAST: f64 = 8.0 / (1 << UNIT) as f64;

/// Shares of the corners of a triangle at each corner of a part.
pub(super) type Part = [[f64; 3]; 3];

const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// The middle of the edge from each corner to the next one.
const MIDDLES: [[f64; 3]; 3] = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];

/// A triangle after splitting.
pub(super) struct Piece {
    /// Number of the triangle that it is, or is a part of.
    pub(super) of: usize,
    /// The part that it is; `None` for the whole triangle.
    pub(super) part: Option<Part>,
}

/// The ends of an edge, as numbers of places, the smaller one first.
type Edge = [usize; 2];

/// A mesh of which triangles are split.
pub(super) struct Split {
    /// The mesh, whose first vertices are those of the mesh before.
    pub(super) mesh: Mesh,
    /// What each of its triangles was before.
    pub(super) pieces: Vec<Piece>,
    /// Number of triangles that are split into quarters.
    pub(super) count: usize,
}

/// A copy of a mesh in which these triangles are split at the middles of their edges, if they and their neighbours are large enough, and these neighbours
/// with them. The copy has no colours.
pub(super) fn at_middles(mesh: &Mesh, wanted: &[bool]) -> Split {
    let places = mesh.places();
    let edges = |triangle: &[usize; 3]| [0, 1, 2].map(|k| edge(places[triangle[k]], places[triangle[(k + 1) % 3]]));
    let wanted = || mesh.triangles.iter().zip(wanted).filter(|(_, wanted)| **wanted).map(|(triangle, _)| triangle);
    let mut may: HashMap<Edge, bool> = wanted().flat_map(edges).map(|edge| (edge, true)).collect();
    for triangle in mesh.triangles.iter().filter(|triangle| altitude(triangle.map(|v| mesh.positions[v])) < LEAST) {
        edges(triangle).iter().for_each(|edge| {
            may.entry(*edge).and_modify(|may| *may = false);
        });
    }
    let chosen: Vec<[Edge; 3]> = wanted().map(edges).filter(|edges| edges.iter().all(|edge| may[edge])).collect();
    let count = chosen.len();
    may.values_mut().for_each(|may| *may = false);
    chosen.into_iter().flatten().for_each(|edge| {
        may.insert(edge, true);
    });
    let is_split = |edge: &Edge| may.get(edge).copied().unwrap_or(false);
    let mut middles: HashMap<[usize; 2], usize> = HashMap::new();
    let mut split = Mesh { positions: mesh.positions.clone(), normals: mesh.normals.clone(), ..Mesh::default() };
    let mut pieces = Vec::new();
    for (number, &triangle) in mesh.triangles.iter().enumerate() {
        let splits = edges(&triangle).map(|edge| is_split(&edge));
        if splits == [false; 3] {
            split.triangles.push(triangle);
            split.submeshes.push(mesh.submesh(number));
            pieces.push(Piece { of: number, part: None });
            continue;
        }
        let mut middle = |k: usize| {
            let [a, b] = edge(triangle[k], triangle[(k + 1) % 3]);
            *middles.entry([a, b]).or_insert_with(|| {
                split.positions.push(scale(add(mesh.positions[a], mesh.positions[b]), 0.5));
                split.normals.push(unit(add(mesh.normals[a], mesh.normals[b])).unwrap_or(mesh.normals[a]));
                split.positions.len() - 1
            })
        };
        let ends = [0, 1, 2].map(|k| if splits[k] { middle(k) } else { triangle[k] });
        for corners in parts(splits, triangle.map(|v| mesh.positions[v])) {
            split.triangles.push(corners.map(|corner| corner.pick(&triangle, &ends)));
            split.submeshes.push(mesh.submesh(number));
            pieces.push(Piece { of: number, part: Some(corners.map(|corner| corner.pick(&CORNERS, &MIDDLES))) });
        }
    }
    Split { mesh: split, pieces, count }
}

fn edge(a: usize, b: usize) -> Edge {
    [a.min(b), a.max(b)]
}

/// The smallest altitude of a triangle.
fn altitude([a, b, c]: [V3; 3]) -> f64 {
    let longest = [sub(b, a), sub(c, b), sub(a, c)].map(length).into_iter().fold(0.0, f64::max);
    length(cross(sub(b, a), sub(c, a))) / longest
}

/// A corner of a part.
#[derive(Clone, Copy)]
enum Corner {
    /// A corner of the triangle.
    Whole(usize),
    /// The middle of the edge from a corner to the next one.
    Middle(usize),
}

/// The parts of a triangle whose edges are all split.
const QUARTERS: [[Corner; 3]; 4] = {
    use Corner::{Middle, Whole};
    [
        [Whole(0), Middle(0), Middle(2)],
        [Middle(0), Whole(1), Middle(1)],
        [Middle(2), Middle(1), Whole(2)],
        [Middle(0), Middle(1), Middle(2)],
    ]
};

/// The parts of a triangle whose edges are all split, as shares of its corners.
pub(super) fn quarters() -> [Part; 4] {
    QUARTERS.map(|part| part.map(|corner| corner.pick(&CORNERS, &MIDDLES)))
}

impl Corner {
    fn pick<T: Copy>(self, corners: &[T; 3], middles: &[T; 3]) -> T {
        match self {
            Self::Whole(k) => corners[k],
            Self::Middle(k) => middles[k],
        }
    }
}

/// The parts of a triangle of which these edges are split, wound as it is. Two split edges leave a part of four corners, which is cut along its shorter
/// diagonal.
fn parts(splits: [bool; 3], positions: [V3; 3]) -> Vec<[Corner; 3]> {
    use Corner::{Middle, Whole};
    let next = |k: usize| (k + 1) % 3;
    match splits.iter().filter(|split| **split).count() {
        1 => {
            let first = splits.iter().position(|split| *split).unwrap_or(0);
            let (second, third) = (next(first), next(next(first)));
            vec![[Whole(first), Middle(first), Whole(third)], [Middle(first), Whole(second), Whole(third)]]
        }
        2 => {
            // The edge that is not split leads from the third corner to the first.
            let third = splits.iter().position(|split| !*split).unwrap_or(0);
            let (first, second) = (next(third), next(next(third)));
            let middle = |k: usize| scale(add(positions[k], positions[next(k)]), 0.5);
            let from_first = length(sub(positions[first], middle(second)));
            let from_third = length(sub(positions[third], middle(first)));
            let [one, other] = if from_first <= from_third {
                [[Whole(first), Middle(first), Middle(second)], [Whole(first), Middle(second), Whole(third)]]
            } else {
                [[Whole(first), Middle(first), Whole(third)], [Middle(first), Middle(second), Whole(third)]]
            };
            vec![[Middle(first), Whole(second), Middle(second)], one, other]
        }
        _ => QUARTERS.to_vec(),
    }
}
