//! Colours at the corners of triangles, for the colours that a file has in textures and at its vertices.
//!
//! A stream has no textures. It has colours at the corners of triangles, and the colour is linear between them. Most models of few triangles have textures
//! that are palettes: each face lies in a patch of one colour, or in a gradient, and colours at the corners come very close to that. The colours of a
//! triangle with a texture are those of least squared distance at many of its points.

use crate::{
    mesh::{Coloured, Mesh, Rgb, Soup, Source},
    mtl::Material,
    number::grouped,
    palette::Colours,
    split::{self, Part, Piece},
    texture::Texture,
    vector::{V3, add, cross, dot, scale, sub},
};
use serde::Serialize;
use std::collections::HashMap;

/// Points along each side of a triangle at which its texture is read: the middles of equal triangles, and so not its rim.
const SIDE: usize = 7;
/// Points of a triangle at which its texture is read.
const POINTS: usize = SIDE * (SIDE + 1) / 2;
/// A triangle takes one colour if its corners differ by no more than this share of full.
const FLAT: f64 = 3.0 / 255.0;
/// Colours of corners at one position become one colour if they differ by no more than this share of full.
const ALIKE: f64 = 4.0 / 255.0;
/// A colour that differs from that of the file by more than this share of full is said to be far.
const FAR: f64 = 12.0 / 255.0;
/// The distance that colours of corners should have at most before they are rounded to 8 bits.
const AIM: f64 = 11.5 / 255.0;
/// The largest distance, in units of [`AIM`], from which other colours of corners are sought that are not far.
const REACH: f64 = 2.0;
/// How often points are weighted anew in this search.
const ROUNDS: usize = 12;
/// How often neighbours of triangles that are split are looked at anew.
const SPLITS: usize = 3;

/// The colours of corners that a mesh has by its file, and how far they are from those of the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Painted {
    /// Number of colours of all palettes.
    pub colours: usize,
    /// Number of palettes.
    pub palettes: usize,
    /// Number of triangles that have colours at their corners.
    pub triangles: usize,
    /// Number of them that have one colour.
    pub of_one_colour: usize,
    /// Number of triangles that were split at the middles of their edges, because their colours were far.
    pub split: usize,
    /// Number of triangles of which a point is farther than 12 of 255 from its colour in the file.
    pub far: usize,
    /// Root of the mean squared distance of all channels at all points, in 255ths.
    pub rms: f64,
    /// Number of materials that are made for triangles with colours.
    pub materials: usize,
}

impl Painted {
    /// A sentence for the user; `None` if no triangle has colours.
    pub(crate) fn sentence(&self) -> Option<String> {
        let Self { colours, palettes, triangles, split, far, rms, .. } = *self;
        let has = if triangles == 1 { "1 triangle has" } else { &*format!("{} triangles have", grouped(triangles)) };
        let colours = if colours == 1 { "1 colour".to_owned() } else { format!("{} colours", grouped(colours)) };
        let palettes = if palettes < 2 { String::new() } else { format!(" in {palettes} palettes") };
        let split = match split {
            0 => String::new(),
            1 => ", 1 triangle was split for it".to_owned(),
            several => format!(", {} triangles were split for it", grouped(several)),
        };
        let distance = match far {
            0 => "none is farther than 12 of 255 from its texture or colours".to_owned(),
            1 => "1 is farther than 12 of 255 from its texture or colours".to_owned(),
            several => format!("{} are farther than 12 of 255 from their texture or colours", grouped(several)),
        };
        (triangles > 0).then(|| {
            format!("{has} {colours} of textures and vertices at the corners{palettes}{split}: {distance}, the root of the mean square is {rms:.1}")
        })
    }
}

/// Gives the triangles of a mesh the colours of the soup that it was made of. `sources` says where the soup has them, and `textures` are those of the
/// materials. Triangles may be split.
pub(crate) fn paint(
    mesh: &mut Mesh,
    sources: Vec<[Source; 3]>,
    soup: &Soup,
    materials: &mut Vec<Option<Material>>,
    textures: &[Option<Texture>],
) -> Painted {
    if sources.is_empty() || soup.colours.is_empty() && textures.iter().all(Option::is_none) {
        return Painted::default();
    }
    let fitting = Fitting::new();
    let mut facets = Facets { soup, textures, sources, parts: HashMap::new() };
    let mut fits: Vec<Option<Fit>> = (0..mesh.triangles.len()).map(|triangle| Some(fitting.fit(&facets.of(mesh, triangle)?))).collect();
    if fits.iter().all(Option::is_none) {
        return Painted::default();
    }
    let split = split_far(mesh, &mut facets, &mut fits, &fitting);
    let mut is_exact = vec![false; mesh.triangles.len()];
    let mut apart = Vec::new();
    // Colours that are united become far here and there: these triangles keep their own.
    for _ in 0..2 {
        let colours = united(mesh, &fits, &is_exact);
        let material = |triangle| mesh.submesh(triangle).material;
        let reduced = Colours { triangles: &colours, is_exact: &is_exact, material: &material }.reduced();
        (mesh.palettes, mesh.colours) = (reduced.palettes, reduced.triangles);
        apart = (0..mesh.triangles.len())
            .map(|triangle| Some(fitting.apart(&facets.of(mesh, triangle)?, corners_of(mesh, triangle)?)))
            .collect();
        let mut has_new = false;
        for ((fit, apart), is_exact) in fits.iter().zip(&apart).zip(&mut is_exact) {
            let (Some(fit), Some(apart)) = (fit, apart) else { continue };
            let apart: &Apart = apart;
            *is_exact |= apart.largest > FAR && !fit.is_far;
            has_new |= *is_exact;
        }
        if !has_new || !reduced.is_close {
            break;
        }
    }
    let mut painted =
        Painted { colours: mesh.palettes.iter().map(Vec::len).sum(), palettes: mesh.palettes.len(), split, ..Painted::default() };
    let mut squares = 0.0;
    for (triangle, apart) in apart.iter().enumerate() {
        let Some(apart) = apart else { continue };
        painted.triangles += 1;
        painted.of_one_colour += usize::from(mesh.coloured(triangle).is_some_and(|Coloured { colours: [a, b, c], .. }| a == b && b == c));
        painted.far += usize::from(apart.largest > FAR);
        squares += apart.squares;
    }
    painted.rms = 255.0 * (squares / painted.triangles as f64).sqrt();
    painted.materials = with_materials(mesh, materials);
    painted
}

/// The colours at the corners of a triangle, if it has some.
fn corners_of(mesh: &Mesh, triangle: usize) -> Option<[V3; 3]> {
    let Coloured { palette, colours } = mesh.coloured(triangle)?;
    let palette = &mesh.palettes[usize::from(palette)];
    Some(colours.map(|colour| palette[usize::from(colour)].map(|c| f64::from(c) / 255.0)))
}

/// Gives triangles with colours a material whose own colour is that by which theirs is multiplied. Returns how many materials were made.
fn with_materials(mesh: &mut Mesh, materials: &mut Vec<Option<Material>>) -> usize {
    let mut has_plain = vec![false; materials.len()];
    let mut has_coloured = vec![false; materials.len()];
    for triangle in 0..mesh.triangles.len() {
        let has = if mesh.coloured(triangle).is_some() { &mut has_coloured } else { &mut has_plain };
        has[mesh.submesh(triangle).material] = true;
    }
    let mut made = 0;
    let mut numbers: Vec<usize> = (0..materials.len()).collect();
    for number in (0..numbers.len()).filter(|&number| has_coloured[number]) {
        let coloured = Some(materials[number].as_ref().map_or_else(Material::white, Material::under_colours));
        made += usize::from(materials[number].is_none() || has_plain[number] && coloured != materials[number]);
        if !has_plain[number] {
            materials[number] = coloured;
        } else if coloured != materials[number] {
            numbers[number] = materials.len();
            materials.push(coloured);
        }
    }
    let Mesh { submeshes, colours, .. } = mesh;
    for (submesh, _) in submeshes.iter_mut().zip(colours).filter(|(_, coloured)| coloured.is_some()) {
        submesh.material = numbers[submesh.material];
    }
    made
}

/// A triangle of which every point has a colour.
#[derive(Clone, Copy)]
struct Facet<'a> {
    /// The colours of the corners, by which the texture is multiplied.
    corners: [V3; 3],
    /// The texture, and the places of the corners on it.
    texture: Option<(&'a Texture, [[f64; 2]; 3])>,
}

impl<'a> Facet<'a> {
    /// The colour at a point, which has these shares of the corners.
    fn at(&self, shares: [f64; 3]) -> V3 {
        let own = mixed(&self.corners, shares);
        let Some((texture, [a, b, c])) = self.texture else { return own };
        let place = [0, 1].map(|axis| a[axis] * shares[0] + b[axis] * shares[1] + c[axis] * shares[2]);
        let texel = texture.at(place);
        [own[0] * texel[0], own[1] * texel[1], own[2] * texel[2]]
    }

    /// The part of the triangle whose corners have these shares of its corners.
    fn part(&self, corners: &Part) -> Self {
        let place = |places: &[[f64; 2]; 3], shares: [f64; 3]| [0, 1].map(|axis| (0..3).map(|k| places[k][axis] * shares[k]).sum());
        Facet {
            corners: corners.map(|shares| mixed(&self.corners, shares)),
            texture: self.texture.map(|(texture, places)| (texture, corners.map(|shares| place(&places, shares)))),
        }
    }
}

fn mixed(colours: &[V3; 3], shares: [f64; 3]) -> V3 {
    add(add(scale(colours[0], shares[0]), scale(colours[1], shares[1])), scale(colours[2], shares[2]))
}

/// The triangles of a mesh, as the soup colours them.
struct Facets<'a> {
    soup: &'a Soup,
    textures: &'a [Option<Texture>],
    /// For each triangle of the mesh, or for the triangle that it was split from.
    sources: Vec<[Source; 3]>,
    /// Triangles that are parts of the ones that they were split from.
    parts: HashMap<usize, Part>,
}

impl<'a> Facets<'a> {
    /// The colours of a triangle; `None` if it has neither a texture nor colours at its corners.
    fn of(&self, mesh: &Mesh, triangle: usize) -> Option<Facet<'a>> {
        let sources = self.sources[triangle];
        let corners = all(sources.map(|source| source.colour.map(|colour| self.soup.colours[colour as usize])));
        let places = all(sources.map(|source| source.place.map(|place| self.soup.places[place as usize])));
        let texture = self.textures.get(mesh.submesh(triangle).material).and_then(Option::as_ref).zip(places);
        if corners.is_none() && texture.is_none() {
            return None;
        }
        let facet = Facet { corners: corners.unwrap_or([[1.0; 3]; 3]), texture };
        Some(self.parts.get(&triangle).map_or(facet, |part| facet.part(part)))
    }
}

/// Three values, if there are all of them.
fn all<T>(values: [Option<T>; 3]) -> Option<[T; 3]> {
    let [Some(a), Some(b), Some(c)] = values else { return None };
    Some([a, b, c])
}

/// Colours for the corners of a triangle.
struct Fit {
    corners: [V3; 3],
    is_flat: bool,
    is_far: bool,
}

/// The solution of three equations for the colours of three corners, by Cramer's rule; `None` if there is none.
fn solved(matrix: &[V3; 3], right: &[V3; 3]) -> Option<[V3; 3]> {
    let [a, b, c] = *matrix;
    let columns = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = dot(a, columns[0]);
    let corner = |k: usize| (0..3).fold([0.0; 3], |sum, row| add(sum, scale(right[row], columns[row][k] / determinant)));
    (determinant.abs() > 1e-30).then(|| [0, 1, 2].map(corner))
}

/// The distance of two colourings of a triangle.
struct Apart {
    /// The largest difference of a channel.
    largest: f64,
    /// The mean of the squared differences of all channels.
    squares: f64,
}

/// The points at which colours are compared, and what finds the colours of least squares.
struct Fitting {
    /// Shares of the three corners.
    points: [[f64; 3]; POINTS],
    /// What a corner has of the colours times its own shares, and of the colours times those of all corners.
    inverse: [f64; 2],
}

impl Fitting {
    fn new() -> Self {
        let share = |k: usize| (k as f64 + 1.0 / 3.0) / SIDE as f64;
        let mut points = [[0.0; 3]; POINTS];
        let all = (0..SIDE).flat_map(|i| (0..SIDE - i).map(move |j| [share(i), share(j), 1.0 - share(i) - share(j)]));
        points.iter_mut().zip(all).for_each(|(point, shares)| *point = shares);
        // The corners are alike: the matrix of the normal equations has one number in its diagonal, and another one in all other places.
        let product = |one: usize, other: usize| points.iter().map(|shares| shares[one] * shares[other]).sum::<f64>();
        let (same, other) = (product(0, 0), product(0, 1));
        let difference = same - other;
        Self { points, inverse: [1.0 / difference, -other / (difference * (same + 2.0 * other))] }
    }

    /// The colours of corners that are nearest to those of a triangle.
    fn fit(&self, facet: &Facet<'_>) -> Fit {
        if facet.texture.is_none() {
            return Fit::new(facet.corners, false);
        }
        let seen = self.points.map(|shares| facet.at(shares));
        if seen.iter().all(|colour| *colour == seen[0]) {
            return Fit::new([seen[0]; 3], false);
        }
        let mut sums = [[0.0; 3]; 3];
        for (shares, &colour) in self.points.iter().zip(&seen) {
            (0..3).for_each(|k| sums[k] = add(sums[k], scale(colour, shares[k])));
        }
        let sum = add(add(sums[0], sums[1]), sums[2]);
        let [own, all] = self.inverse;
        let fitted = sums.map(|own_sum| add(scale(own_sum, own), scale(sum, all)).map(|c| c.clamp(0.0, 1.0)));
        let sampled = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|corner| facet.at(corner));
        let [by_squares, by_sample] = [fitted, sampled].map(|corners| self.apart_at(&seen, corners));
        let sample_is_better = (by_sample.largest > AIM, by_sample.squares) < (by_squares.largest > AIM, by_squares.squares);
        let (corners, apart) = if sample_is_better { (sampled, by_sample) } else { (fitted, by_squares) };
        let is_far = apart.largest > AIM;
        match self.nearest(&seen).filter(|_| is_far && apart.largest <= REACH * AIM) {
            Some(corners) => Fit::new(corners, false),
            None => Fit::new(corners, is_far),
        }
    }

    /// Colours of corners that are far at no point, if some are found: points count the more the farther they are (Lawson 1961).
    fn nearest(&self, seen: &[V3; POINTS]) -> Option<[V3; 3]> {
        let mut weights = [1.0; POINTS];
        for _ in 0..ROUNDS {
            let mut matrix = [[0.0; 3]; 3];
            let mut right = [[0.0; 3]; 3];
            for ((shares, &colour), weight) in self.points.iter().zip(seen).zip(weights) {
                for k in 0..3 {
                    matrix[k] = add(matrix[k], scale(*shares, weight * shares[k]));
                    right[k] = add(right[k], scale(colour, weight * shares[k]));
                }
            }
            let corners = solved(&matrix, &right)?.map(|corner| corner.map(|c| c.clamp(0.0, 1.0)));
            let distances = self.points.iter().zip(seen).map(|(&shares, &colour)| distance(colour, mixed(&corners, shares)));
            let mut largest = 0.0f64;
            weights.iter_mut().zip(distances).for_each(|(weight, distance)| {
                largest = largest.max(distance);
                *weight *= distance / AIM;
            });
            if largest <= AIM {
                return Some(corners);
            }
        }
        None
    }

    /// How far colours of corners are from those of a triangle.
    fn apart(&self, facet: &Facet<'_>, corners: [V3; 3]) -> Apart {
        if facet.texture.is_some() {
            return self.apart_at(&self.points.map(|shares| facet.at(shares)), corners);
        }
        // Both are linear: the difference is largest at a corner, and the integral of its square is known.
        let differences = [0, 1, 2].map(|k| sub(facet.corners[k], corners[k]));
        let [a, b, c] = differences;
        let square = |k: usize| (a[k] * (a[k] + b[k] + c[k]) + b[k] * (b[k] + c[k]) + c[k] * c[k]) / 6.0;
        Apart {
            largest: differences.as_flattened().iter().fold(0.0, |most, difference| difference.abs().max(most)),
            squares: (square(0) + square(1) + square(2)) / 3.0,
        }
    }

    fn apart_at(&self, seen: &[V3; POINTS], corners: [V3; 3]) -> Apart {
        let (mut largest, mut squares) = (0.0f64, 0.0);
        for (&shares, &colour) in self.points.iter().zip(seen) {
            for difference in sub(colour, mixed(&corners, shares)) {
                largest = largest.max(difference.abs());
                squares += difference * difference;
            }
        }
        Apart { largest, squares: squares / (3 * POINTS) as f64 }
    }
}

impl Fit {
    /// Corners that hardly differ take one colour, because a triangle of one colour is drawn faster.
    fn new(corners: [V3; 3], is_far: bool) -> Self {
        let [a, b, c] = corners;
        let is_flat = [(a, b), (b, c), (c, a)].into_iter().all(|(one, other)| distance(one, other) <= FLAT);
        let corners = if is_flat { [scale(add(add(a, b), c), 1.0 / 3.0); 3] } else { corners };
        Self { corners, is_flat, is_far }
    }
}

/// Splits triangles whose colours are far at the middles of their edges, if no part is far then. Returns how many there are, without their neighbours,
/// whose edges are split with theirs.
fn split_far(mesh: &mut Mesh, facets: &mut Facets<'_>, fits: &mut Vec<Option<Fit>>, fitting: &Fitting) -> usize {
    let quarters = split::quarters();
    let is_far = |fit: &Option<Fit>| fit.as_ref().is_some_and(|fit| fit.is_far);
    let helps = |triangle: usize| {
        let facet = facets.of(mesh, triangle);
        facet.is_some_and(|facet| quarters.iter().all(|part| !fitting.fit(&facet.part(part)).is_far))
    };
    let mut wanted: Vec<bool> = fits.iter().enumerate().map(|(triangle, fit)| is_far(fit) && helps(triangle)).collect();
    if !wanted.contains(&true) {
        return 0;
    }
    // Points of a part lie elsewhere than those of the whole triangle: parts of a neighbour may be far, and then it is split as well.
    let mut rounds = 0..SPLITS;
    let (split, of_parts) = loop {
        let split = split::at_middles(mesh, &wanted);
        let fit = |piece: &Piece| Some(fitting.fit(&facets.of(mesh, piece.of)?.part(&piece.part?)));
        let of_parts: Vec<Option<Fit>> = split.pieces.iter().map(fit).collect();
        let far = split.pieces.iter().zip(&of_parts).filter(|(_, fit)| is_far(fit)).map(|(piece, _)| piece.of);
        let more: Vec<usize> = far.filter(|&triangle| !wanted[triangle] && helps(triangle)).collect();
        if more.is_empty() || rounds.next().is_none() {
            break (split, of_parts);
        }
        more.into_iter().for_each(|triangle| wanted[triangle] = true);
    };
    let mut before = std::mem::take(fits);
    let whole = |piece: &Piece| if piece.part.is_none() { before[piece.of].take() } else { None };
    *fits = split.pieces.iter().map(whole).zip(of_parts).map(|(whole, part)| whole.or(part)).collect();
    facets.parts = split.pieces.iter().enumerate().filter_map(|(number, piece)| Some((number, piece.part?))).collect();
    facets.sources = split.pieces.iter().map(|piece| facets.sources[piece.of]).collect();
    *mesh = split.mesh;
    split.count
}

/// The colours of all corners, where colours at one position that are nearly equal have become one. Triangles of one colour keep theirs, as do those
/// that are to be exact.
fn united(mesh: &Mesh, fits: &[Option<Fit>], is_exact: &[bool]) -> Vec<Option<[Rgb; 3]>> {
    let places = mesh.places();
    let mut colours: Vec<[V3; 3]> = fits.iter().map(|fit| fit.as_ref().map_or([[0.0; 3]; 3], |fit| fit.corners)).collect();
    // The corners of triangles of several colours, by their places. Other triangles matter only there.
    let count = places.iter().max().map_or(0, |last| last + 1);
    let mut starts = vec![0; count + 1];
    let coloured = || fits.iter().enumerate().filter_map(|(triangle, fit)| Some((triangle, fit.as_ref()?)));
    let corners = || coloured().flat_map(|(triangle, fit)| (0..3).map(move |k| (triangle, k, fit.is_flat || is_exact[triangle])));
    corners().for_each(|(triangle, k, _)| starts[places[mesh.triangles[triangle][k]] + 1] += 1);
    for place in 0..count {
        starts[place + 1] += starts[place];
    }
    let mut next = starts.clone();
    let mut sorted = vec![(0, 0, false); starts[count]];
    for corner @ (triangle, k, _) in corners() {
        let next = &mut next[places[mesh.triangles[triangle][k]]];
        sorted[*next] = corner;
        *next += 1;
    }
    let mut groups: Vec<Group> = Vec::new();
    for range in starts.windows(2) {
        let here = &sorted[range[0]..range[1]];
        if here.iter().all(|&(.., is_flat)| is_flat) {
            continue;
        }
        groups.clear();
        for flat_first in [true, false] {
            for &(triangle, k, _) in here.iter().filter(|&&(.., is_flat)| is_flat == flat_first) {
                let colour = colours[triangle][k];
                let near = groups.iter_mut().filter(|group| distance(group.first, colour) <= if flat_first { 0.0 } else { ALIKE });
                match near.min_by(|one, other| distance(one.first, colour).total_cmp(&distance(other.first, colour))) {
                    Some(group) => group.add(triangle, k, colour),
                    None => groups.push(Group { first: colour, is_flat: flat_first, sum: colour, corners: vec![(triangle, k)] }),
                }
            }
        }
        for group in &groups {
            let colour = if group.is_flat { group.first } else { scale(group.sum, 1.0 / group.corners.len() as f64) };
            group.corners.iter().for_each(|&(triangle, k)| colours[triangle][k] = colour);
        }
    }
    fits.iter().zip(colours).map(|(fit, corners)| fit.as_ref().map(|_| corners.map(rounded))).collect()
}

/// Nearly equal colours at one position.
struct Group {
    first: V3,
    /// Whether it has the colour of a triangle of one colour.
    is_flat: bool,
    sum: V3,
    corners: Vec<(usize, usize)>,
}

impl Group {
    fn add(&mut self, triangle: usize, corner: usize, colour: V3) {
        self.sum = add(self.sum, colour);
        self.corners.push((triangle, corner));
    }
}

fn rounded(colour: V3) -> Rgb {
    colour.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// The largest difference of a channel.
fn distance(a: V3, b: V3) -> f64 {
    let [x, y, z] = sub(a, b);
    x.abs().max(y.abs()).max(z.abs())
}
