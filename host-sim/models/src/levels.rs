//! Levels of detail: coarser triangles on the vertices of a mesh, in addition or in its place.
//!
//! Edges are collapsed by a port of meshoptimizer, which moves no vertex: a level costs flash for its triangles alone. What the library says
//! of its error is an estimate; the error that a stream has is measured here, between the rounded surfaces.

use crate::{
    convex::is_closed_convex,
    distance::{Corners, farthest, hausdorff},
    mesh::{Mesh, Rgb},
    number::above,
    paint::distance,
    quantise::{self, Part},
    records,
};
use anyhow::{Result, anyhow, bail};
use embedded_graphics_core::geometry::Size;
use meshoptimizer_rs::{Attributes, Positions, SimplifyOptions, SimplifySettings, Workspace, simplify_with_attributes};
use microphong::{
    Stream,
    format::GeometricError,
    geometry::detail::stream_tolerance,
    stream::record::{self, Triangle, Vertex},
};
use std::{collections::HashMap, iter, mem};

/// A coarser level of a part.
#[derive(Clone, Debug)]
pub struct Level {
    /// Their corners count from the part's first vertex.
    pub triangles: Vec<Triangle>,
    /// For each triangle the colours of its corners as indices of the part's palette; empty if corners have none.
    pub colours: Vec<[u8; 3]>,
    /// No point of either surface lies farther from the other; more than 0, rounded up.
    pub error: GeometricError,
    /// Closed and convex: front faces never hide one another.
    pub closed_convex: bool,
}

/// A level has at most this share of the triangles of the level before; flash for a smaller gain would be wasted.
const GAIN: f64 = 0.9;
/// Weight of the difference of unit normals beside distances. Of two collapses at equal distance the one is taken that changes light less. Ten times
/// this weight takes a third more triangles for the same error.
const NORMALS: f32 = 0.05;
/// Weight of the difference of colours beside distances.
const COLOURS: f32 = 0.05;
/// Colours of corners at a vertex that differ by more than this, of 255, have a border between them. Others become one colour when a mesh is simplified.
const BORDER: u8 = 12;

/// Gives each part of a mesh a coarser level for each of some errors, of the fewest triangles that keep to it.
///
/// A level that would save less than a tenth of the triangles is left out. `tick` is called after each error of each part.
///
/// # Errors
/// When the library refuses the mesh.
pub fn add(mesh: &Mesh, parts: &mut [Part], errors: &[GeometricError], tick: &dyn Fn()) -> Result<()> {
    // Borders in common stay without gaps at whatever levels are drawn.
    let borders = borders(parts);
    // An error of 0 is that of the mesh as it is.
    let mut errors: Vec<_> = errors.iter().copied().filter(|&error| error > GeometricError::ZERO).collect();
    errors.sort();
    for (part, options) in parts.iter_mut().zip(borders) {
        for &error in &errors {
            let (finer, least) =
                part.coarser.last().map_or((part.triangles.len(), GeometricError::ZERO), |last| (last.triangles.len(), last.error));
            let found = fewest(part, finer, error, options)?;
            tick();
            let Some((Coarse { triangles, colours }, error)) = found else { continue };
            if error > least && triangles.len() as f64 <= GAIN * finer as f64 {
                let closed_convex = is_convex(mesh, part, &triangles);
                part.coarser.push(Level { triangles, colours, error, closed_convex });
            }
        }
    }
    Ok(())
}

/// For each part, whether its borders must stay: borders that other parts of its object have as well, or that touch another object.
fn borders(parts: &[Part]) -> Vec<SimplifyOptions> {
    let mut first = HashMap::new();
    let mut locked = vec![false; parts.len()];
    for (number, part) in parts.iter().enumerate() {
        let positions = part.vertices.iter().map(|vertex| (None, vertex.position));
        for place in iter::once((Some(part.object), [0; 3])).chain(positions) {
            let other = *first.entry(place).or_insert(number);
            if other != number {
                (locked[other], locked[number]) = (true, true);
            }
        }
    }
    locked.into_iter().map(|locked| if locked { SimplifyOptions::LOCK_BORDER } else { SimplifyOptions::EMPTY }).collect()
}

/// About as few triangles, up to `most`, as lie within `error` of a part, and the error that they have; `None` if there are none.
fn fewest(part: &Part, most: usize, error: GeometricError, options: SimplifyOptions) -> Result<Option<(Coarse, GeometricError)>> {
    let surface = corners(&part.vertices, &part.triangles);
    let (mut too_few, mut enough, mut found) = (0, most, None);
    while enough - too_few > 1 + enough / 64 {
        let target = too_few.midpoint(enough);
        let coarse = simplified(part, target, options)?;
        let triangles = &coarse.triangles;
        let apart = hausdorff(&surface, &corners(&part.vertices, triangles), [0.25, 1.0].map(|share| share * f64::from(error)));
        let apart = apart.filter(|_| !triangles.is_empty());
        let Some(apart) = apart else {
            too_few = target;
            continue;
        };
        // There may be more than asked for: then there cannot be fewer.
        (too_few, enough) = (if triangles.len() > target { target } else { too_few }, target);
        // Never 0, which is the error of the mesh as it is.
        found = Some((coarse, above(apart)));
    }
    Ok(found)
}

/// The result of simplifying a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simplified {
    /// Triangles before.
    pub before: usize,
    /// No measured point of either surface lies farther from the other.
    pub error: f64,
    /// Whether only some triangles were measured, so that the error may be larger.
    pub is_estimate: bool,
}

/// Smaller distances do not count: a tenth of a step of positions.
const NEAREST: f64 = 0.1 / 16384.0;

/// Triangles that an estimate measures at most. More of them would take longer than the rest of a conversion.
const MEASURED: usize = 1 << 16;

/// Reduces the parts of a mesh to at most `most` triangles together, as [`reduced`] does, and measures the [`difference`]. `None` if they have no more
/// triangles. `tick` is called after each part.
///
/// # Errors
/// When the mesh cannot be reduced so far.
pub fn simplify(mesh: &Mesh, parts: &mut Vec<Part>, most: usize, tick: &dyn Fn()) -> Result<Option<Simplified>> {
    if count(parts) <= most {
        return Ok(None);
    }
    let reduced = reduced(mesh, parts, most)?;
    let simplified = difference(parts, &reduced, tick);
    *parts = reduced;
    Ok(Some(simplified))
}

/// The difference between the parts of a mesh and the [`reduced`] ones. `tick` is called after each part.
#[must_use]
pub fn difference(parts: &[Part], reduced: &[Part], tick: &dyn Fn()) -> Simplified {
    let apart = |part: &[Corners], reduced: &[Corners]| hausdorff(part, reduced, [NEAREST, f64::INFINITY]).unwrap_or(f64::INFINITY);
    Simplified { before: count(parts), error: largest(parts, reduced, apart, tick), is_estimate: false }
}

/// The [`difference`], or of a large mesh an estimate of it: the distance of some of its triangles from the reduced ones. `tick` is called after each
/// part.
#[must_use]
pub fn estimate(parts: &[Part], reduced: &[Part], tick: &dyn Fn()) -> Simplified {
    let before = count(parts);
    let step = before.div_ceil(MEASURED);
    if step <= 1 {
        return difference(parts, reduced, tick);
    }
    let apart = |part: &[Corners], reduced: &[Corners]| {
        let some: Vec<_> = part.iter().step_by(step).copied().collect();
        farthest(&some, reduced, NEAREST)
    };
    Simplified { before, error: largest(parts, reduced, apart, tick), is_estimate: true }
}

/// The largest distance between the surface of a part and that of the reduced part.
fn largest(parts: &[Part], reduced: &[Part], apart: impl Fn(&[Corners], &[Corners]) -> f64, tick: &dyn Fn()) -> f64 {
    let surface = |part: &Part| corners(&part.vertices, &part.triangles);
    let of_part = |(part, reduced): (&Part, &Part)| {
        let apart = apart(&surface(part), &surface(reduced));
        tick();
        apart
    };
    parts.iter().zip(reduced).map(of_part).fold(0.0, f64::max)
}

/// Triangles of all parts together.
#[must_use]
pub fn count(parts: &[Part]) -> usize {
    parts.iter().map(|part| part.triangles.len()).sum()
}

/// The parts of a mesh, which have more than `most` triangles, made of at most `most` on some of their vertices; other vertices are dropped.
///
/// # Errors
/// When the mesh cannot be reduced so far.
pub fn reduced(mesh: &Mesh, parts: &[Part], most: usize) -> Result<Vec<Part>> {
    let (before, borders) = (count(parts), borders(parts));
    let reduce = |(part, options): (&Part, SimplifyOptions)| {
        // Each part has its share, which may be less than it can be made of.
        let share = (part.triangles.len() as u64 * most as u64 / before as u64) as usize;
        let Coarse { triangles, colours } = simplified(part, share, options)?;
        let mut part = Part { closed_convex: is_convex(mesh, part, &triangles), triangles, colours, ..part.clone() };
        drop_unused(&mut part);
        Ok(part)
    };
    let parts = parts.iter().zip(borders).map(reduce).collect::<Result<Vec<_>>>()?;
    let after = count(&parts);
    if after > most {
        let has_colours = parts.iter().any(|part| !part.palette.is_empty());
        let borders = match (parts.len() > 1, has_colours) {
            (true, true) => {
                ", because borders between colours, materials and objects stay as they are; give more, or one --colour and --merge"
            }
            (true, false) => {
                ", because borders between materials and between objects stay as they are; give more, or one --colour and --merge"
            }
            (false, true) => ", because borders between colours stay as they are; give more, or leave colours out by --colours none",
            (false, false) => "; give more",
        };
        bail!("the mesh cannot be made of {most} triangles, but of {after}{borders}");
    }
    if parts.iter().any(|part| part.triangles.is_empty()) {
        bail!("with {most} of {before} triangles nothing is left of the mesh, or of one of its materials or objects; give more");
    }
    Ok(parts)
}

/// Drops vertices that no triangle has; the others keep their order.
fn drop_unused(part: &mut Part) {
    let mut used = vec![false; part.vertices.len()];
    part.triangles.iter().flat_map(|triangle| triangle.corners).for_each(|corner| used[usize::from(corner)] = true);
    // A vertex's new number is how many before it are kept; all are numbers of 16 bits.
    let numbers: Vec<u16> = used
        .iter()
        .scan(0, |kept, &used| {
            let number = *kept;
            *kept += u16::from(used);
            Some(number)
        })
        .collect();
    part.triangles.iter_mut().for_each(|triangle| triangle.corners = triangle.corners.map(|corner| numbers[usize::from(corner)]));
    let mut keep = used.iter();
    part.vertices.retain(|_| keep.next() == Some(&true));
    let mut keep = used.iter();
    part.sources.retain(|_| keep.next() == Some(&true));
}

/// The meshes of a stream, each at the level that a picture of `size` pixels shows.
pub fn drawn<'a>(stream: &Stream<'a>, size: Size) -> impl DoubleEndedIterator<Item = &'a record::Mesh> + use<'a> {
    stream.meshes_within(stream_tolerance(stream.header, size))
}

/// Triangles on vertices of a part.
struct Coarse {
    triangles: Vec<Triangle>,
    /// The colours of their corners; empty if corners have none.
    colours: Vec<[u8; 3]>,
}

/// About `target` triangles on vertices of `part`.
fn simplified(part: &Part, target: usize, options: SimplifyOptions) -> Result<Coarse> {
    let refused = |error| anyhow!("the mesh cannot be simplified: {error}");
    let Wedges { wedges, corners } = Wedges::of(part);
    let vertices = || wedges.iter().map(|wedge| &part.vertices[usize::from(wedge.vertex)]);
    let positions: Vec<[f32; 3]> = vertices().map(|vertex| records::position(vertex).map(f32::from)).collect();
    let normals = vertices().map(|vertex| records::normal(vertex).map(f32::from));
    let colours = || wedges.iter().map(|wedge| part.palette[usize::from(wedge.colour)].map(|c| f32::from(c) / 255.0));
    let (attributes, weights): (Vec<f32>, _) = if part.palette.is_empty() {
        (normals.flatten().collect(), vec![NORMALS; 3])
    } else {
        (
            normals.zip(colours()).flat_map(|(normal, colour)| normal.into_iter().chain(colour)).collect(),
            [[NORMALS; 3], [COLOURS; 3]].concat(),
        )
    };
    let positions = Positions::from_packed(&positions);
    let attributes = Attributes::from_interleaved(&attributes, wedges.len(), weights.len(), weights.len(), 0).map_err(refused)?;
    // The error is one that no mesh has: the number of triangles decides.
    let settings = SimplifySettings { target_index_count: 3 * target, target_error: 1e6, options };
    let mesh = simplify_with_attributes(&corners, positions, attributes, &weights, None, settings, &mut Workspace::default());
    let mut coarse = Coarse { triangles: Vec::new(), colours: Vec::new() };
    for corners in mesh.map_err(refused)?.indices.as_chunks::<3>().0 {
        let corners = corners.map(|corner| wedges[corner as usize]);
        let Some(triangle) = quantise::record(&part.vertices, corners.map(|wedge| wedge.vertex)) else { continue };
        coarse.triangles.push(triangle);
        if !part.palette.is_empty() {
            coarse.colours.push(corners.map(|wedge| wedge.colour));
        }
    }
    Ok(coarse)
}

/// A vertex, as the triangles around it that have one colour there see it.
#[derive(Clone, Copy)]
struct Wedge {
    vertex: u16,
    /// The colour as an index of the palette; 0 if corners have none.
    colour: u8,
}

/// The vertices of a part for each of their colours. The simplifier keeps borders between wedges of one vertex.
struct Wedges {
    wedges: Vec<Wedge>,
    /// The wedge at each corner of all triangles.
    corners: Vec<u32>,
}

impl Wedges {
    fn of(part: &Part) -> Self {
        let vertices = part.triangles.iter().flat_map(|triangle| triangle.corners);
        if part.palette.is_empty() {
            let wedges = (0..part.vertices.len() as u16).map(|vertex| Wedge { vertex, colour: 0 }).collect();
            return Self { wedges, corners: vertices.map(u32::from).collect() };
        }
        let mut groups: Vec<Vec<Group>> = vec![Vec::new(); part.vertices.len()];
        let corners: Vec<(u16, usize)> = vertices
            .zip(part.colours.iter().flatten())
            .map(|(vertex, &colour)| {
                let (groups, colour) = (&mut groups[usize::from(vertex)], part.palette[usize::from(colour)]);
                let known = groups.iter().position(|group| distance(group.first, colour) <= BORDER);
                let number = known.unwrap_or_else(|| {
                    groups.push(Group { first: colour, sum: [0; 3], corners: 0 });
                    groups.len() - 1
                });
                groups[number].add(colour);
                (vertex, number)
            })
            .collect();
        let first = groups.iter().scan(0, |count, groups| Some(mem::replace(count, *count + groups.len() as u32))).collect::<Vec<_>>();
        let colour = |group: &Group| nearest(&part.palette, group.mean());
        let wedges = (0..).zip(&groups).flat_map(|(vertex, groups)| groups.iter().map(move |group| (vertex, group)));
        Self {
            wedges: wedges.map(|(vertex, group)| Wedge { vertex, colour: colour(group) }).collect(),
            corners: corners.into_iter().map(|(vertex, number)| first[usize::from(vertex)] + number as u32).collect(),
        }
    }
}

/// Colours of corners at a vertex without a border between them.
#[derive(Clone)]
struct Group {
    first: Rgb,
    sum: [u32; 3],
    corners: u32,
}

impl Group {
    fn add(&mut self, colour: Rgb) {
        self.corners += 1;
        self.sum.iter_mut().zip(colour).for_each(|(sum, c)| *sum += u32::from(c));
    }

    fn mean(&self) -> Rgb {
        self.sum.map(|sum| ((sum + self.corners / 2) / self.corners) as u8)
    }
}

fn nearest(palette: &[Rgb], colour: Rgb) -> u8 {
    let nearest = (0..=u8::MAX).zip(palette).min_by_key(|(_, other)| distance(**other, colour));
    nearest.map_or(0, |(number, _)| number)
}

fn corners(vertices: &[Vertex], triangles: &[Triangle]) -> Vec<Corners> {
    triangles
        .iter()
        .map(|triangle| triangle.corners.map(|corner| records::position(&vertices[usize::from(corner)]).map(f64::from)))
        .collect()
}

/// Whether these triangles of a part are closed and convex; vertices that they leave out are no part of them.
fn is_convex(mesh: &Mesh, part: &Part, triangles: &[Triangle]) -> bool {
    let mut kept = Mesh::default();
    let mut index = vec![None; part.vertices.len()];
    for triangle in triangles {
        kept.triangles.push(triangle.corners.map(usize::from).map(|corner| {
            *index[corner].get_or_insert_with(|| {
                kept.positions.push(mesh.positions[part.sources[corner]]);
                kept.positions.len() - 1
            })
        }));
    }
    is_closed_convex(&kept, &part.vertices, triangles)
}
