//! The neighbours of triangles, from which the core finds outlines, and the triangles that cut each other.
//!
//! Neighbours are found by position, so doubled vertices, whose normals differ, do not separate triangles. Meshes of other materials, and other levels
//! of detail, have no common neighbours: the core treats such borders as edges whose other side it does not know.

use crate::cuts;
use anyhow::{Result, ensure};
use microphong::{
    Stream,
    stream::{
        self,
        record::{CREASE, Colour, HAS_NEIGHBOURS, Mesh, Neighbours, OPEN, Vertex},
    },
};
use std::collections::HashMap;
use zerocopy::IntoBytes;

/// The cosine of the angle between two normals from which on shading jumps visibly: 12 degrees.
const CREASE_COSINE: f64 = 0.978;

/// The difference of two colours, in the channel where it is largest, from which on a border between them is seen: 16 of 255.
const BORDER: u8 = 16;

/// The place of an end of an edge.
type Position = [i16; 3];

/// An end of an edge, as a triangle has it.
#[derive(Clone, Copy)]
struct End<'s> {
    vertex: &'s Vertex,
    /// The colour there, if the corners of triangles have colours.
    colour: Option<Colour>,
}

impl End<'_> {
    /// Whether two triangles differ visibly here.
    fn jumps(&self, other: &Self) -> bool {
        let is_border =
            |one: Colour, other: Colour| one.channels.iter().zip(other.channels).any(|(one, other)| one.abs_diff(other) > BORDER);
        cosine(self.vertex.normal, other.vertex.normal) < CREASE_COSINE
            || self.colour.zip(other.colour).is_some_and(|(one, other)| is_border(one, other))
    }
}

/// Whether a stream has the neighbours of its triangles.
#[must_use]
pub fn has_neighbours(stream: &Stream<'_>) -> bool {
    !stream.neighbours.is_empty() || stream.triangles.is_empty()
}

/// Returns a stream with the neighbours of all triangles and the pairs that cut each other, padded to whole words.
///
/// # Errors
/// When a mesh has more triangles than a table of neighbours can number.
pub fn with_neighbours(stream: &Stream<'_>) -> Result<Vec<u32>> {
    let mut header = *stream.header;
    let mut meshes = stream.meshes.to_vec();
    let mut neighbours = Vec::with_capacity(stream.triangles.len());
    for mesh in &mut meshes {
        ensure!(
            mesh.triangles <= u32::from(OPEN),
            "a mesh has more than {OPEN} triangles; simplify it, or leave out antialiasing and lines along outlines"
        );
        mesh.flags |= HAS_NEIGHBOURS;
        neighbours.extend(of_mesh(stream, mesh));
    }
    let cuts = cuts::of(stream);
    header.cuts = cuts.len() as u32;
    let before = size_of_val(stream.neighbours) + size_of_val(stream.cuts);
    header.length = header.length - before as u32 + (size_of_val(neighbours.as_slice()) + size_of_val(cuts.as_slice())) as u32;
    let textures = stream.textures();
    let mut bytes = [
        header.as_bytes(),
        meshes.as_bytes(),
        stream.materials.as_bytes(),
        stream.lights.as_bytes(),
        stream.instances.as_bytes(),
        stream.tracks.as_bytes(),
        stream.keys.as_bytes(),
        cuts.as_bytes(),
        stream.vertices.as_bytes(),
        stream.triangles.as_bytes(),
        neighbours.as_bytes(),
        stream.corner_colours.as_bytes(),
        stream.colours.as_bytes(),
        textures.list.as_bytes(),
        textures.corners.as_bytes(),
        textures.texels,
        stream.labels.as_bytes(),
        stream.names,
    ]
    .concat();
    stream::seal(&mut bytes);
    let mut words = vec![0; bytes.len().div_ceil(4)];
    words.as_mut_bytes()[..bytes.len()].copy_from_slice(&bytes);
    Ok(words)
}

/// The neighbours of the triangles of one mesh at one level.
fn of_mesh(stream: &Stream<'_>, mesh: &Mesh) -> Vec<Neighbours> {
    let (triangles, vertices) = (stream.triangles_of(mesh).unwrap_or_default(), stream.vertices_of(mesh).unwrap_or_default());
    let colours = stream.colours_of(mesh);
    let end = |triangle: usize, corner: usize| End {
        vertex: &vertices[usize::from(triangles[triangle].corners[corner])],
        colour: colours.map(|colours| colours.palette[usize::from(colours.corners[triangle].colours[corner])]),
    };
    let ends = |triangle: usize, k: usize| [end(triangle, k), end(triangle, (k + 1) % 3)];
    let places = |ends: [End<'_>; 2]| ends.map(|end| end.vertex.position);
    let mut sides: HashMap<[Position; 2], Vec<(usize, [End<'_>; 2])>> = HashMap::new();
    for triangle in 0..triangles.len() {
        for k in 0..3 {
            let ends = ends(triangle, k);
            sides.entry(places(ends)).or_default().push((triangle, ends));
        }
    }
    let neighbour = |triangle: usize, [from, to]: [End<'_>; 2]| {
        let none = &Vec::new();
        let (own, others) = (&sides[&places([from, to])], sides.get(&places([to, from])).unwrap_or(none));
        // Of three surfaces that meet at an edge, each ends there.
        let ([_], [(other, [other_to, other_from])]) = (own.as_slice(), others.as_slice()) else { return OPEN };
        let jumps = from.jumps(other_from) || to.jumps(other_to);
        if *other == triangle { OPEN } else { *other as u16 | if jumps { CREASE } else { 0 } }
    };
    (0..triangles.len()).map(|triangle| Neighbours([0, 1, 2].map(|k| neighbour(triangle, ends(triangle, k))))).collect()
}

/// The cosine of the angle between two normals.
fn cosine(a: [i16; 3], b: [i16; 3]) -> f64 {
    let dot = |a: [i16; 3], b: [i16; 3]| (0..3).map(|k| f64::from(a[k]) * f64::from(b[k])).sum::<f64>();
    dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
}
