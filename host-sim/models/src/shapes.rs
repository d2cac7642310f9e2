//! Meshes from formulas, with exact normals.

use crate::{
    mesh::Mesh,
    vector::{V3, add, apply, cross, dot, scale, sub, unit},
};
use std::f64::consts::{PI, TAU};

/// A unit sphere of `meridians` times `bands` about the z axis: `2 · meridians · (bands - 1)` triangles.
///
/// `phase` turns the first meridian away from x.
#[must_use]
pub fn sphere(meridians: usize, bands: usize, phase: f64) -> Mesh {
    let mut positions = vec![[0.0, 0.0, 1.0]];
    for i in 1..bands {
        let (s, c) = libm::sincos(PI * i as f64 / bands as f64);
        positions.extend((0..meridians).map(|j| {
            let (y, x) = libm::sincos(phase + TAU * j as f64 / meridians as f64);
            [s * x, s * y, c]
        }));
    }
    positions.push([0.0, 0.0, -1.0]);
    let south = positions.len() - 1;
    let at = |i: usize, j: usize| 1 + (i - 1) * meridians + j % meridians;
    let mut triangles: Vec<[usize; 3]> = (0..meridians).map(|j| [0, at(1, j), at(1, j + 1)]).collect();
    for i in 1..bands - 1 {
        for j in 0..meridians {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    triangles.extend((0..meridians).map(|j| [south, at(bands - 1, j + 1), at(bands - 1, j)]));
    Mesh { normals: positions.clone(), positions, triangles, ..Mesh::default() }
}

/// Radius of the tube of a torus, as a fraction of its ring's.
pub const TUBE: f64 = 0.45;

/// A torus about the z axis that a unit sphere encloses: `around` times `across` quadrilaterals, its tube [`TUBE`] of the ring.
#[must_use]
pub fn torus(around: usize, across: usize) -> Mesh {
    ring(around, across, TUBE)
}

/// A torus about the z axis that a unit sphere encloses. Its tube has the radius `tube`, as a share of the ring's.
#[must_use]
pub fn ring(around: usize, across: usize, tube: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..around {
        for j in 0..across {
            let (sa, ca) = libm::sincos(TAU * i as f64 / around as f64);
            let (sb, cb) = libm::sincos(TAU * j as f64 / across as f64);
            let normal = [ca * cb, sa * cb, sb];
            mesh.normals.push(normal);
            mesh.positions.push(scale(add([ca, sa, 0.0], scale(normal, tube)), 1.0 / (1.0 + tube)));
            let at = |i: usize, j: usize| i % around * across + j % across;
            mesh.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}

/// A dodecahedron in the unit sphere with a sphere's normals: few, large, strongly curved triangles.
#[must_use]
pub fn dodecahedron() -> Mesh {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let signs = [-1.0, 1.0];
    let pairs = signs.iter().flat_map(|&a| signs.map(|b| (a, b)));
    let cube = pairs.clone().flat_map(|(a, b)| signs.map(|c| [a, b, c]));
    let rest =
        pairs.clone().flat_map(|(a, b)| [[0.0, a / golden, b * golden], [a / golden, b * golden, 0.0], [a * golden, 0.0, b / golden]]);
    let positions: Vec<V3> = cube.chain(rest).filter_map(unit).collect();
    let centres = pairs.flat_map(|(a, b)| [[a, 0.0, b * golden], [a * golden, b, 0.0], [0.0, a * golden, b]]);
    let mut triangles = Vec::new();
    for centre in centres {
        // The five corners of a face are the five nearest to its centre; then counter-clockwise about it.
        let mut corners: Vec<usize> = (0..positions.len()).collect();
        corners.sort_by(|&a, &b| dot(positions[b], centre).total_cmp(&dot(positions[a], centre)));
        corners.truncate(5);
        let start = positions[corners[0]];
        let side = cross(centre, start);
        let angle = |c: usize| {
            libm::atan2(
                dot(positions[c], side),
                dot(positions[c], sub(start, scale(centre, dot(start, centre) / dot(centre, centre)))) * dot(centre, centre).sqrt(),
            )
        };
        corners.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
        triangles.extend((1..4).map(|k| [corners[0], corners[k], corners[k + 1]]));
    }
    Mesh { normals: positions.clone(), positions, triangles, ..Mesh::default() }
}

/// A triangle with normals that make it look bulged.
#[must_use]
pub fn bulged_triangle() -> Mesh {
    let normals = [[-0.35, -0.3, 1.0], [0.35, -0.3, 1.0], [0.0, 0.4, 1.0]];
    Mesh {
        positions: vec![[-1.0, -0.8, 0.0], [1.0, -0.9, 0.0], [0.1, 1.0, 0.0]],
        normals: normals.into_iter().filter_map(unit).collect(),
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    }
}

/// A flat square in the unit sphere, made of `cells` times `cells` quadrilaterals, with the normals of a cushion. It covers the same pixels at every
/// fineness.
#[must_use]
pub fn cushion(cells: usize) -> Mesh {
    /// Slope of the normals at the middle of a side: tan 45 degrees.
    const LEAN: f64 = 1.0;
    let mut mesh = Mesh::default();
    for i in 0..=cells {
        for j in 0..=cells {
            let [y, x] = [i, j].map(|k| 2.0 * k as f64 / cells as f64 - 1.0);
            mesh.positions.push(scale([x, y, 0.0], 0.5f64.sqrt()));
            mesh.normals.extend(unit([LEAN * x, LEAN * y, 1.0]));
        }
    }
    let at = |i: usize, j: usize| i * (cells + 1) + j;
    for i in 0..cells {
        for j in 0..cells {
            mesh.triangles.push([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
            mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    mesh
}

/// A cube from -1 to 1 along each axis, with edges.
#[must_use]
pub fn cuboid() -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            // Unit vectors along the face, counter-clockwise seen from outside.
            let along = |k: usize| [0, 1, 2].map(|c| f64::from(u8::from(c == k)));
            let (normal, right) = (scale(along(axis), sign), along((axis + 1) % 3));
            let up = cross(normal, right);
            let first = mesh.positions.len();
            for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
                mesh.positions.push(add(normal, add(scale(right, x), scale(up, y))));
                mesh.normals.push(normal);
            }
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    mesh
}

/// A cylinder about the z axis, from -1 to 1 along each axis: smooth around, its ends flat.
#[must_use]
pub fn cylinder(around: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let round = |j: usize| {
        let (y, x) = libm::sincos(TAU * (j % around) as f64 / around as f64);
        [x, y]
    };
    for j in 0..around {
        for (z, [x, y]) in [-1.0, 1.0].into_iter().map(|z| (z, round(j))) {
            mesh.positions.push([x, y, z]);
            mesh.normals.push([x, y, 0.0]);
        }
        let at = |j: usize, k: usize| j % around * 2 + k;
        mesh.triangles.extend([[at(j, 0), at(j + 1, 0), at(j + 1, 1)], [at(j, 0), at(j + 1, 1), at(j, 1)]]);
    }
    for z in [-1.0, 1.0] {
        let first = mesh.positions.len();
        for [x, y] in (0..around).map(round) {
            mesh.positions.push([x, y, z]);
            mesh.normals.push([0.0, 0.0, z]);
        }
        let end = (2..around).map(|j| if z > 0.0 { [first, first + j - 1, first + j] } else { [first, first + j, first + j - 1] });
        mesh.triangles.extend(end);
    }
    mesh
}

/// The mesh as many times as large along each axis.
#[must_use]
pub fn stretched(mut mesh: Mesh, [x, y, z]: V3) -> Mesh {
    mesh.positions.iter_mut().for_each(|p| *p = [p[0] * x, p[1] * y, p[2] * z]);
    // Normals stay square to what is stretched.
    mesh.normals.iter_mut().for_each(|n| *n = unit([n[0] / x, n[1] / y, n[2] / z]).unwrap_or(*n));
    mesh
}

/// The mesh turned by a rotation with these rows.
#[must_use]
pub fn turned(mut mesh: Mesh, rows: &[V3; 3]) -> Mesh {
    mesh.positions.iter_mut().chain(&mut mesh.normals).for_each(|v| *v = apply(rows, *v));
    mesh
}
