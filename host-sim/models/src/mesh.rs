//! Polygon soup to a welded mesh of triangles.

use crate::{
    coat::{Coat, Paint},
    mend::{self, Winding},
    polygon::{WELD, cut, newell},
    vector::{V3, add, cross, dot, length, scale, sub, unit},
};
use anyhow::{Result, bail};
use std::{borrow::Cow, collections::HashMap, mem};

/// The contents of a mesh file: polygons whose corners may repeat positions.
#[derive(Clone, Debug, Default)]
pub struct Soup {
    /// Positions, finite.
    pub positions: Vec<V3>,
    /// Normals of any length, finite.
    pub normals: Vec<V3>,
    /// Colours as sRGB has them, from 0 to 1.
    pub colours: Vec<V3>,
    /// Coordinates on textures.
    pub places: Vec<[f64; 2]>,
    /// Polygons.
    pub faces: Vec<Face>,
}

impl Soup {
    /// The corners of all polygons.
    fn corners(&self) -> impl Iterator<Item = &Corner> {
        self.faces.iter().flat_map(|face| &face.corners)
    }
}

/// A polygon.
#[derive(Clone, Debug)]
pub struct Face {
    /// Three or more, counter-clockwise seen from the front.
    pub corners: Vec<Corner>,
    /// Object and material of the polygon.
    pub submesh: Submesh,
    /// Over which edges light is smooth where the file gives no normals.
    pub smoothing: Smoothing,
}

/// The part of a mesh that becomes a mesh of the stream; they come in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Submesh {
    /// Number of the object.
    pub object: usize,
    /// Number of the material.
    pub material: usize,
    /// Whether it is the back of a surface that another submesh is the front of.
    pub is_back: bool,
}

/// Rules for faces around a vertex that share a normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothing {
    /// Faces share a normal where the edge between them folds by no more than the crease angle.
    ByAngle,
    /// Faces of one smoothing group share a normal.
    Group(u32),
    /// No faces share a normal.
    Flat,
}

/// A corner of a polygon.
#[derive(Clone, Copy, Debug, Default)]
pub struct Corner {
    /// Index of the position.
    pub position: usize,
    /// Index of the normal, where the file gives one.
    pub normal: Option<usize>,
    /// Index of the colour, where the file gives one.
    pub colour: Option<usize>,
    /// Index of the place on the texture, where the file gives one.
    pub place: Option<usize>,
}

/// Triangles on shared vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Position of each vertex.
    pub positions: Vec<V3>,
    /// Unit normal of each vertex.
    pub normals: Vec<V3>,
    /// Vertices, counter-clockwise seen from the front.
    pub triangles: Vec<[usize; 3]>,
    /// Object and material of each triangle. If this is empty, all triangles belong to the first object and material.
    pub submeshes: Vec<Submesh>,
    /// What colours each triangle, where something does. If this is empty, no triangle is coloured.
    pub colours: Vec<Option<Coloured>>,
    /// The palettes and textures by which `colours` counts.
    pub coats: Vec<Coat>,
}

/// A colour of sRGB with 8 bits a channel.
pub type Rgb = [u8; 3];

/// What colours a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coloured {
    /// Number of the palette or texture.
    pub coat: u16,
    /// The colour of each corner, or its place.
    pub corners: [Paint; 3],
}

impl Mesh {
    /// Object and material of a triangle.
    #[must_use]
    pub fn submesh(&self, triangle: usize) -> Submesh {
        self.submeshes.get(triangle).copied().unwrap_or_default()
    }

    /// What colours a triangle, if something does.
    #[must_use]
    pub fn coloured(&self, triangle: usize) -> Option<Coloured> {
        self.colours.get(triangle).copied().flatten()
    }

    /// The number of each vertex's position, which vertices at one position have in common.
    pub(crate) fn places(&self) -> Vec<usize> {
        let mut known: HashMap<[u64; 3], usize> = HashMap::new();
        let number = |p: &V3| {
            let next = known.len();
            *known.entry(p.map(f64::to_bits)).or_insert(next)
        };
        self.positions.iter().map(number).collect()
    }

    /// Makes one object of all.
    pub fn merge_objects(&mut self) {
        self.submeshes.iter_mut().for_each(|submesh| submesh.object = 0);
    }

    /// Gives all objects one material, and removes the colours of triangles.
    pub fn merge_materials(&mut self) {
        self.submeshes.iter_mut().for_each(|submesh| submesh.material = 0);
        self.colours.clear();
        self.coats.clear();
    }
}

/// Options for making a mesh from polygons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weld {
    /// Turn the surface inside out; closed ones are turned without asking.
    pub turn: bool,
    /// Largest angle, in degrees, at which an edge looks smooth in a file without normals and smoothing groups.
    pub crease: f64,
}

/// Facets of round things fold by less, edges of boxes by more.
pub const CREASE: f64 = 30.0;

impl Weld {
    /// Light is smooth over all edges.
    pub const SMOOTH: Self = Self { turn: false, crease: 180.0 };
}

impl Default for Weld {
    fn default() -> Self {
        Self { turn: false, crease: CREASE }
    }
}

/// A report on welding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Positions that coincided with another one.
    pub welded: usize,
    /// Triangles without an area.
    pub degenerate: usize,
    /// The file's own normals were used.
    pub own_normals: bool,
    /// Polygons whose outlines cross themselves: their triangles are an attempt.
    pub crossed: usize,
    /// The closed surface was inside out and has been turned.
    pub turned: bool,
    /// Faces that were wound against their neighbours, or of a closed part that was inside out, and have been turned.
    pub mended: usize,
    /// The number of the first of them, from 1 on.
    pub first_mended: usize,
    /// Corners whose normals have no direction: these normals were computed.
    pub computed_normals: usize,
    /// The number of the first face with such a corner, from 1 on.
    pub first_computed: usize,
    /// Corners for which the file has no normal, although others have one: these normals were computed.
    pub missing_normals: usize,
    /// Triangles to whose backs the normals of the file point.
    pub backward_normals: usize,
    /// Edges of one face.
    pub open_edges: usize,
    /// Edges over which two faces disagree, however they are turned.
    pub opposed_edges: usize,
    /// Edges of more than two faces.
    pub crowded_edges: usize,
}

/// Smaller meshes would vanish when squared.
const SMALLEST: f64 = 1e-100;
/// A smaller share of the distance from the origin has too few of the 53 bits of a coordinate left for the 15 of a stream.
const FARTHEST: f64 = 1e-11;

/// Where the colour of a corner stands in a [`Soup`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source {
    /// Index of its colour.
    pub(crate) colour: Option<u32>,
    /// Index of its place on the texture.
    pub(crate) place: Option<u32>,
}

/// The triangles of a mesh while it is made.
#[derive(Default)]
struct Draft {
    mesh: Mesh,
    /// The sources of the colours of each triangle; empty if the soup has none.
    sources: Vec<[Source; 3]>,
}

/// Welds, computes missing normals, cuts polygons into triangles, centres and scales to a sphere of radius 1.
///
/// # Errors
/// When nothing is left to draw.
pub fn weld(soup: &Soup, weld: Weld) -> Result<(Mesh, Report)> {
    let (mesh, _, report) = weld_with_sources(soup, weld)?;
    Ok((mesh, report))
}

/// Makes a mesh as [`weld`] does. Also returns the sources of the colours of each triangle; none if the soup has no colours.
///
/// # Errors
/// When nothing is left to draw.
pub(crate) fn weld_with_sources(soup: &Soup, Weld { turn, crease }: Weld) -> Result<(Mesh, Vec<[Source; 3]>, Report)> {
    if soup.faces.is_empty() {
        bail!("the mesh has no faces; export it with polygons");
    }
    let positions = fit_sphere(soup)?;
    let places = merge(&positions);
    let mut report = Report { welded: merged(soup, &places), ..Report::default() };
    let soup = &*mended(soup, &positions, &places, &mut report);
    let mut normals = with_direction(soup);
    report.own_normals = normals.iter().filter(|normal| normal.is_some()).count() * 2 >= normals.len();
    let (mut draft, crossed) = if report.own_normals {
        complete(&mut normals, soup, &positions, &places, crease, &mut report);
        with_own_normals(soup, &positions, &places, &normals)
    } else {
        smooth(soup, &positions, &places, crease)
    };
    report.crossed = crossed;
    let before = draft.mesh.triangles.len();
    drop_degenerate(&mut draft);
    let Draft { mut mesh, mut sources } = draft;
    report.degenerate = before - mesh.triangles.len();
    if mesh.triangles.is_empty() {
        bail!("all {before} triangles are degenerate (no area); nothing is left to draw");
    }
    let inside_out = is_closed(&mesh) && volume(&mesh) < 0.0;
    if inside_out != turn {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        sources.iter_mut().for_each(|sources| sources.swap(1, 2));
        // Normals from a file are right already when only the winding is wrong.
        if !report.own_normals {
            mesh.normals.iter_mut().for_each(|n| *n = scale(*n, -1.0));
        }
        report.turned = true;
    }
    drop_unused(&mut mesh);
    if report.own_normals {
        report.backward_normals = mesh.triangles.iter().filter(|triangle| is_backward(&mesh, triangle)).count();
    }
    Ok((mesh, sources, report))
}

/// Whether the normals of a triangle point to its back, and not only to the side.
fn is_backward(mesh: &Mesh, triangle: &[usize; 3]) -> bool {
    let [a, b, c] = triangle.map(|v| mesh.positions[v]);
    let normal = triangle.iter().fold([0.0; 3], |sum, &v| add(sum, mesh.normals[v]));
    let directions = unit(cross(sub(b, a), sub(c, a))).zip(unit(normal));
    directions.is_some_and(|(front, normal)| dot(front, normal) < -0.5)
}

/// Positions moved to the centre of their bounding box and scaled to radius 1. Only positions that faces use count.
fn fit_sphere(soup: &Soup) -> Result<Vec<V3>> {
    let used = || soup.corners().map(|c| soup.positions[c.position]);
    let low = used().fold([f64::INFINITY; 3], |m, p| [0, 1, 2].map(|k| f64::min(m[k], p[k])));
    let high = used().fold([f64::NEG_INFINITY; 3], |m, p| [0, 1, 2].map(|k| f64::max(m[k], p[k])));
    let across = sub(high, low).into_iter().fold(0.0, f64::max);
    let far = used().flatten().map(f64::abs).fold(0.0, f64::max);
    if across == 0.0 {
        bail!("all vertices lie in one point; nothing is left to draw");
    }
    if across < SMALLEST {
        bail!("the mesh is only {across:e} across, which is too little to compute with; scale it up, to about 1");
    }
    if across < far * FARTHEST {
        bail!("the mesh is {across:e} across and {far:e} away from the origin: its coordinates have too few digits; move it to the origin");
    }
    let centre = scale(add(low, high), 0.5);
    let inverse = 1.0 / used().map(|p| length(sub(p, centre))).fold(0.0, f64::max);
    // Positions that no face uses may lie anywhere: they are pulled in, not looked at.
    Ok(soup.positions.iter().map(|&p| scale(sub(p, centre), inverse).map(|c| c.clamp(-1.0, 1.0))).collect())
}

/// For each position the first position within [`WELD`] of it.
fn merge(positions: &[V3]) -> Vec<usize> {
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut first = Vec::with_capacity(positions.len());
    for (i, &p) in positions.iter().enumerate() {
        let cell = p.map(|c| (c / WELD).floor() as i64);
        let near = (0..27).find_map(|k| {
            let neighbour = [cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1];
            cells.get(&neighbour)?.iter().copied().find(|&j| length(sub(positions[j], p)) <= WELD)
        });
        if near.is_none() {
            cells.entry(cell).or_default().push(i);
        }
        first.push(near.unwrap_or(i));
    }
    first
}

fn merged(soup: &Soup, places: &[usize]) -> usize {
    let mut used = vec![false; places.len()];
    soup.corners().for_each(|c| used[c.position] = true);
    places.iter().enumerate().filter(|&(i, &first)| used[i] && first != i).count()
}

/// The soup with all faces wound as their neighbours are, closed parts with the outside in front.
fn mended<'a>(soup: &'a Soup, positions: &[V3], places: &[usize], report: &mut Report) -> Cow<'a, Soup> {
    let Winding { turned, faces, open, opposed, crowded } = mend::winding(soup, positions, places);
    (report.open_edges, report.opposed_edges, report.crowded_edges) = (open, opposed, crowded);
    let count = turned.iter().filter(|turned| **turned).count();
    // A surface that is inside out as a whole is turned as a whole, later.
    if count == 0 || count == faces {
        return Cow::Borrowed(soup);
    }
    report.mended = count;
    report.first_mended = turned.iter().position(|turned| *turned).map_or(0, |face| face + 1);
    let mut soup = soup.clone();
    // The first corner stays the first.
    soup.faces.iter_mut().zip(turned).filter(|(_, turned)| *turned).for_each(|(face, _)| face.corners[1..].reverse());
    Cow::Owned(soup)
}

/// The normal of each corner, in the order of faces, if the file gives one with a direction.
fn with_direction(soup: &Soup) -> Vec<Option<V3>> {
    soup.corners().map(|corner| corner.normal.and_then(|n| unit(soup.normals[n]))).collect()
}

/// Computes the normals that are missing. Corners of one place that share a normal in the file share one that is computed, too.
fn complete(normals: &mut [Option<V3>], soup: &Soup, positions: &[V3], places: &[usize], crease: f64, report: &mut Report) {
    if normals.iter().all(Option::is_some) {
        return;
    }
    let mut around: Vec<Vec<Around>> = vec![Vec::new(); positions.len()];
    let mut shared: HashMap<(usize, usize), V3> = HashMap::new();
    let areas = areas(soup, positions, places);
    for (number, face) in soup.faces.iter().enumerate() {
        for (k, corner) in face.corners.iter().enumerate() {
            let place = places[corner.position];
            around[place].push((number, k, unit(areas[number])));
            if let Some(normal) = corner.normal {
                let sum = shared.entry((place, normal)).or_default();
                *sum = add(*sum, areas[number]);
            }
        }
    }
    let mut sheets: HashMap<(usize, usize), V3> = HashMap::new();
    let mut normals = normals.iter_mut();
    for (number, face) in soup.faces.iter().enumerate() {
        for (k, (corner, normal)) in face.corners.iter().zip(&mut normals).enumerate() {
            if normal.is_some() {
                continue;
            }
            let place = places[corner.position];
            if corner.normal.is_some() {
                report.computed_normals += 1;
                if report.first_computed == 0 {
                    report.first_computed = number + 1;
                }
            } else {
                report.missing_normals += 1;
            }
            let sum = corner.normal.and_then(|normal| shared.get(&(place, normal))).copied().unwrap_or_default();
            if length(sum) > 1e-14 {
                *normal = unit(sum);
                continue;
            }
            let mut left = mem::take(&mut around[place]);
            while !left.is_empty() {
                let sheet = sheet(soup, &mut left, crease);
                let direction = direction(&sheet, &areas);
                sheets.extend(sheet.into_iter().map(|(face, k, _)| ((face, k), direction)));
            }
            *normal = sheets.get(&(number, k)).copied();
        }
    }
}

/// The area vector of each face.
fn areas(soup: &Soup, positions: &[V3], places: &[usize]) -> Vec<V3> {
    soup.faces.iter().map(|face| newell(&face.corners.iter().map(|c| positions[places[c.position]]).collect::<Vec<_>>())).collect()
}

/// The normal of faces around a place between which light is smooth: the sum of their area vectors.
fn direction(sheet: &[Around], areas: &[V3]) -> V3 {
    let sum = sheet.iter().fold([0.0; 3], |sum, &(face, ..)| add(sum, areas[face]));
    // Faces back to back cancel; then any one of them is as good as the other.
    let any = sheet.iter().find_map(|&(.., direction)| direction);
    let normal = if length(sum) > 1e-14 { unit(sum) } else { any };
    normal.unwrap_or([0.0, 0.0, 1.0])
}

/// Also counts polygons that cross themselves. Each corner has one of `normals`, in the order of faces.
fn with_own_normals(soup: &Soup, positions: &[V3], places: &[usize], normals: &[Option<V3>]) -> (Draft, usize) {
    let mut crossed = 0;
    let mut draft = Draft::default();
    let mut vertices: HashMap<(usize, [i32; 3]), usize> = HashMap::new();
    let mut normals = normals.iter();
    for face in &soup.faces {
        let corners: Vec<usize> = face
            .corners
            .iter()
            .zip(&mut normals)
            .map(|(corner, normal)| {
                let place = places[corner.position];
                let normal = normal.unwrap_or([0.0, 0.0, 1.0]);
                // Finer than a stream keeps them: equal keys become equal normals.
                let key = normal.map(|c| (c * 65536.0).round() as i32);
                let mesh = &mut draft.mesh;
                *vertices.entry((place, key)).or_insert_with(|| {
                    mesh.positions.push(positions[place]);
                    mesh.normals.push(normal);
                    mesh.positions.len() - 1
                })
            })
            .collect();
        crossed += usize::from(push(&mut draft, soup, face, &corners));
    }
    (draft, crossed)
}

/// Adds a polygon on these vertices; whether it crosses itself.
fn push(Draft { mesh, sources }: &mut Draft, soup: &Soup, face: &Face, vertices: &[usize]) -> bool {
    let points: Vec<V3> = vertices.iter().map(|&v| mesh.positions[v]).collect();
    let cut = cut(&points);
    mesh.submeshes.extend(cut.triangles.iter().map(|_| face.submesh));
    mesh.triangles.extend(cut.triangles.iter().map(|t| t.map(|k| vertices[k])));
    if !soup.colours.is_empty() || !soup.places.is_empty() {
        let narrow = |index: Option<usize>| index.and_then(|index| u32::try_from(index).ok());
        let source = |corner: &Corner| Source { colour: narrow(corner.colour), place: narrow(corner.place) };
        sources.extend(cut.triangles.iter().map(|t| t.map(|k| source(&face.corners[k]))));
    }
    cut.crossed
}

/// A corner of a polygon around a place: of which face, where in it, and the direction of the face.
type Around = (usize, usize, Option<V3>);

/// Computes one normal for all faces around a position between which light is smooth: the sum of their area vectors. Also counts polygons that cross
/// themselves.
fn smooth(soup: &Soup, positions: &[V3], places: &[usize], crease: f64) -> (Draft, usize) {
    let areas = areas(soup, positions, places);
    let mut around: Vec<Vec<Around>> = vec![Vec::new(); positions.len()];
    for (number, face) in soup.faces.iter().enumerate() {
        for (k, corner) in face.corners.iter().enumerate() {
            around[places[corner.position]].push((number, k, unit(areas[number])));
        }
    }
    let mut draft = Draft::default();
    let mesh = &mut draft.mesh;
    let mut vertices: Vec<Vec<usize>> = soup.faces.iter().map(|face| vec![0; face.corners.len()]).collect();
    for (place, mut left) in around.into_iter().enumerate() {
        while !left.is_empty() {
            let sheet = sheet(soup, &mut left, crease);
            let normal = direction(&sheet, &areas);
            for (face, k, _) in sheet {
                vertices[face][k] = mesh.positions.len();
            }
            mesh.positions.push(positions[place]);
            mesh.normals.push(normal);
        }
    }
    let crossed = soup.faces.iter().zip(&vertices).filter(|(face, vertices)| push(&mut draft, soup, face, vertices)).count();
    (draft, crossed)
}

/// Takes the first corner out of the corners around a position, and all to which light is smooth from it, directly or over others, in their order.
fn sheet(soup: &Soup, left: &mut Vec<Around>, crease: f64) -> Vec<Around> {
    // Less what rounding may take from the angle itself.
    let least = if crease < 180.0 { libm::cos(crease.to_radians()) - 1e-9 } else { f64::NEG_INFINITY };
    let smooth = |&(a, _, one): &Around, &(b, _, other): &Around| match (soup.faces[a].smoothing, soup.faces[b].smoothing) {
        (Smoothing::ByAngle, Smoothing::ByAngle) => one.zip(other).map_or(0.0, |(one, other)| dot(one, other)) >= least,
        (Smoothing::Group(one), Smoothing::Group(other)) => one == other,
        _ => false,
    };
    let mut sheet = vec![left.remove(0)];
    let mut seen = 0;
    while let Some(&from) = sheet.get(seen) {
        let (more, rest) = mem::take(left).into_iter().partition(|to| smooth(&from, to));
        sheet.extend::<Vec<_>>(more);
        *left = rest;
        seen += 1;
    }
    sheet.sort_by_key(|&(face, k, _)| (face, k));
    sheet
}

fn drop_degenerate(Draft { mesh, sources }: &mut Draft) {
    let positions = &mesh.positions;
    let has_area = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|v| positions[v]);
        // Thinner than a weld can tell apart is no area.
        let longest = [sub(b, a), sub(c, b), sub(a, c)].map(length).into_iter().fold(0.0, f64::max);
        length(cross(sub(b, a), sub(c, a))) > WELD * longest
    };
    let kept = |triangle: usize| has_area(&mesh.triangles[triangle]);
    let kept: Vec<_> = (0..mesh.triangles.len()).filter(|&triangle| kept(triangle)).collect();
    mesh.submeshes = kept.iter().map(|&triangle| mesh.submesh(triangle)).collect();
    mesh.triangles = kept.iter().map(|&triangle| mesh.triangles[triangle]).collect();
    if !sources.is_empty() {
        *sources = kept.iter().map(|&triangle| sources[triangle]).collect();
    }
}

/// Whether each edge has exactly one partner that runs the other way.
pub(crate) fn is_closed(mesh: &Mesh) -> bool {
    let ids = mesh.places();
    edges_pair_up(mesh.triangles.iter().map(|t| t.map(|v| ids[v])))
}

/// Whether each directed edge occurs once, and once the other way.
fn edges_pair_up<P: Copy + Eq + std::hash::Hash>(triangles: impl Iterator<Item = [P; 3]>) -> bool {
    let mut edges: HashMap<(P, P), usize> = HashMap::new();
    for [a, b, c] in triangles {
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    edges.iter().all(|(&(a, b), &count)| count == 1 && edges.contains_key(&(b, a)))
}

/// Six times the volume inside a closed surface; negative when it is inside out.
fn volume(mesh: &Mesh) -> f64 {
    mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v])).map(|[a, b, c]| dot(a, cross(b, c))).sum()
}

fn drop_unused(mesh: &mut Mesh) {
    let mut index = vec![None; mesh.positions.len()];
    let mut kept = Mesh {
        submeshes: mem::take(&mut mesh.submeshes),
        colours: mem::take(&mut mesh.colours),
        coats: mem::take(&mut mesh.coats),
        ..Mesh::default()
    };
    for triangle in &mesh.triangles {
        kept.triangles.push(triangle.map(|v| {
            *index[v].get_or_insert_with(|| {
                kept.positions.push(mesh.positions[v]);
                kept.normals.push(mesh.normals[v]);
                kept.positions.len() - 1
            })
        }));
    }
    *mesh = kept;
}
