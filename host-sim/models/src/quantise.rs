//! A welded mesh to the records of a stream.

use crate::{
    coat::{Coat, Paint},
    convex::is_closed_convex,
    levels::Level,
    mesh::{Coloured, Mesh, Rgb, Submesh},
    number::{above, below, nearest},
    records,
    vector::{V3, add, cross, dot, length, scale, sub, unit},
};
use microphong::{
    fixed::types::U0F16,
    format::{GeometricError, Haversine, InverseAltitude, NormalLength, UNIT, Unit},
    stream::record::{Triangle, Vertex},
};
use std::{
    collections::{BTreeMap, HashMap},
    iter, mem,
};

/// The number 1 as a [`microphong::format::Unit`], in units of its last place.
const ONE: f64 = (1 << UNIT) as f64;
/// Corners are 16-bit indices.
const MAX_VERTICES: usize = u16::MAX as usize;
/// Farthest eye that a stream can ask for: 16 units along each axis, of a rotation that is one only nearly.
const FARTHEST: f64 = 16.0 * 1.8;
/// Margin for the error of `offset` itself: points of the plane just beyond [`FARTHEST`] take 0.6 units in the last place.
const EYE_SLACK: f64 = 4.0 / ONE;

/// Records of one mesh, indices from 0.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Number of the object that it belongs to.
    pub object: usize,
    /// Number of the material of all triangles.
    pub material: u16,
    /// The vertices, at most 65,535.
    pub vertices: Vec<Vertex>,
    /// Their corners count from this part's first vertex.
    pub triangles: Vec<Triangle>,
    /// The palette or texture of all triangles, if they have one.
    pub coat: Option<Coat>,
    /// What the corners of each triangle have of it; empty if there is none.
    pub colours: Vec<[Paint; 3]>,
    /// Closed and convex: front faces never hide one another.
    pub closed_convex: bool,
    /// The vertex of the mesh that each of its vertices is a copy of.
    pub sources: Vec<usize>,
    /// Coarser levels, from fine to coarse, see [`crate::levels::add`].
    pub coarser: Vec<Level>,
}

impl Part {
    /// The colours of its palette or texture; none if it has neither.
    #[must_use]
    pub fn palette(&self) -> &[Rgb] {
        self.coat.as_ref().map_or(&[], Coat::palette)
    }

    /// Triangles, error, and whether they are closed and convex, of all levels from fine to coarse.
    pub fn levels(&self) -> impl Iterator<Item = (&[Triangle], GeometricError, bool)> {
        let coarser = self.coarser.iter().map(|level| (&level.triangles[..], level.error, level.closed_convex));
        iter::once((&self.triangles[..], GeometricError::ZERO, self.closed_convex)).chain(coarser)
    }

    /// What the corners of triangles have of the palette or texture, of all levels from fine to coarse.
    pub(crate) fn colours(&self) -> impl Iterator<Item = [Paint; 3]> {
        self.colours.iter().chain(self.coarser.iter().flat_map(|level| &level.colours)).copied()
    }
}

/// Rounds a mesh to a stream's formats. Each submesh becomes a part, and several if it has more than 65,535 vertices, or several palettes and textures.
/// Parts of an object follow one another.
///
/// Also counts triangles that had an area before the rounding, but not after it.
#[must_use]
pub fn quantise(mesh: &Mesh) -> (Vec<Part>, usize) {
    let vertices: Vec<Vertex> =
        mesh.positions.iter().zip(&mesh.normals).map(|(&p, &n)| records::vertex(p.map(nearest), normal(n))).collect();
    let mut parts = Vec::new();
    let mut dropped = 0;
    let mut submeshes: BTreeMap<(Submesh, Option<u16>), Vec<usize>> = BTreeMap::new();
    for number in 0..mesh.triangles.len() {
        let coat = mesh.coloured(number).map(|coloured| coloured.coat);
        submeshes.entry((mesh.submesh(number), coat)).or_default().push(number);
    }
    for ((Submesh { object, material, .. }, coat), triangles) in submeshes {
        let coat = coat.map(|coat| mesh.coats[usize::from(coat)].clone());
        // A stream refuses more materials than its numbers can count.
        let new = Part { object, material: material.try_into().unwrap_or(u16::MAX), coat, ..Part::default() };
        let mut part = new.clone();
        let mut index: HashMap<usize, u16> = HashMap::new();
        for number in triangles {
            let corners = mesh.triangles[number];
            let Some(mut triangle) = constants(corners.map(|v| vertices[v])) else {
                dropped += 1;
                continue;
            };
            if index.len() + corners.iter().filter(|v| !index.contains_key(v)).count() > MAX_VERTICES {
                parts.push(mem::replace(&mut part, new.clone()));
                index.clear();
            }
            triangle.corners = corners.map(|v| {
                *index.entry(v).or_insert_with(|| {
                    part.vertices.push(vertices[v]);
                    part.sources.push(v);
                    (part.vertices.len() - 1) as u16
                })
            });
            part.triangles.push(triangle);
            part.colours.extend(mesh.coloured(number).map(|Coloured { corners, .. }| corners));
        }
        parts.push(part);
    }
    parts.retain(|part| !part.triangles.is_empty());
    if let ([part], 0) = (&mut parts[..], dropped) {
        part.closed_convex = is_closed_convex(mesh, &part.vertices, &part.triangles);
    }
    (parts, dropped)
}

/// The grid point for a unit vector whose length is closest to one, among the 27 around it.
///
/// An error of the length enters a highlight as many times as its exponent
/// says; an error of the direction by one unit in the last place does not show.
/// Near an axis all neighbours have nearly the same length: there the error
/// can reach half a unit in the last place, 3.1e-5.
#[must_use]
pub fn normal(n: V3) -> [Unit; 3] {
    let exact = scale(n, ONE);
    let centre = exact.map(f64::round);
    let neighbours = (0..27).map(|k| add(centre, [(k % 3 - 1) as f64, (k / 3 % 3 - 1) as f64, (k / 9 - 1) as f64]));
    let cost = |p: V3| ((length(p) - ONE).abs(), length(sub(p, exact)));
    let better = |a: V3, b: V3| if cost(b) < cost(a) { b } else { a };
    scale(neighbours.fold(centre, better), 1.0 / ONE).map(nearest)
}

fn widen(v: [Unit; 3]) -> V3 {
    v.map(f64::from)
}

/// The record of a triangle on `vertices`; `None` without an area.
pub(crate) fn record(vertices: &[Vertex], corners: [u16; 3]) -> Option<Triangle> {
    Some(Triangle { corners, ..constants(corners.map(|corner| vertices[usize::from(corner)]))? })
}

/// All constants that depend on neither camera nor light; `None` for a triangle without area. Corners are left at 0.
fn constants(corners: [Vertex; 3]) -> Option<Triangle> {
    let [a, b, c] = corners.map(|v| widen(records::position(&v)));
    // Exact: 16-bit differences, and sums of a few of their products.
    let plane = unit(cross(sub(b, a), sub(c, a)))?;
    let normals = corners.map(|v| unit(widen(records::normal(&v))).unwrap_or([0.0, 0.0, 1.0]));
    let cosine = [0, 1, 2].map(|k| dot(normals[k], normals[(k + 1) % 3]).clamp(-1.0, 1.0));
    let sums = [0, 1, 2].map(|k| length(add(normals[k], normals[(k + 1) % 3])));
    let quantised = normal(plane);
    let [ab, bc, ca] = [sub(b, a), sub(c, b), sub(a, c)];
    let longest = [ab, bc, ca].map(length).into_iter().fold(0.0, f64::max);
    let altitude = length(cross(ab, ca)) / longest;
    Some(Triangle {
        corners: [0; 3],
        // Its bits are those of twice as much with one fraction bit less, for which there is a type.
        inverse_sum_length: sums.map(|s| nearest::<U0F16>(2.0 / s - 1.0).to_bits()),
        haversine: cosine.map(|c| nearest::<Haversine>((1.0 - c) / 2.0).to_bits()),
        min_normal_length: below::<NormalLength>(least_length(cosine.map(|c| 2.0 - 2.0 * c))).to_bits(),
        normal: quantised.map(Unit::to_bits),
        offset: offset(plane, dot(plane, a), quantised).to_bits(),
        // With what floating point may have rounded down.
        inverse_altitude: above::<InverseAltitude>((1.0 + 1e-12) / altitude).to_bits(),
    })
}

/// The least length of what lies between three unit vectors, of whose ends these are the squared distances: the ends lie on a sphere, and
/// the middle of the smallest circle around them is nearest to its centre.
fn least_length(mut squares: [f64; 3]) -> f64 {
    squares.sort_by(f64::total_cmp);
    let [a, b, c] = squares;
    // Around the longest side, or through all three ends.
    let radius2 = if a + b <= c { c / 4.0 } else { a * b * c / (2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c) };
    // Less what floating point may have rounded up.
    (1.0 - radius2 - 1e-12).max(0.0).sqrt()
}

/// The largest offset that never removes a triangle which faces an eye.
///
/// The rounded normal is not quite square to the plane, so `normal · eye`
/// varies over the plane itself; its least value on the part of the plane that
/// an eye can reach is what an eye in front exceeds. With the rounded normal
/// written as `along · plane + across`, that value is
/// `along · distance - |across| · sqrt(FARTHEST² - distance²)`. The
/// renderer's eye is rounded as well, which takes [`EYE_SLACK`] more.
fn offset(plane: V3, distance: f64, quantised: [Unit; 3]) -> Unit {
    let rounded = widen(quantised);
    let along = dot(rounded, plane);
    let across = length(sub(rounded, scale(plane, along)));
    let reach = (FARTHEST * FARTHEST - distance * distance).max(0.0).sqrt();
    below(along * distance - across * reach - EYE_SLACK)
}
