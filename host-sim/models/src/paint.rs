//! Colours at the corners of triangles, for the colours that a file has in textures and at its vertices.
//!
//! A stream has no textures. It has colours at the corners of triangles, and the colour is linear between them. Most models of few triangles have textures
//! that are palettes: each face lies in a patch of one colour, or in a gradient, and colours at the corners come very close to that. The colours of a
//! triangle with a texture are those of least squared distance at many of its points.

mod facet;
mod fit;
mod palette;
mod split;
mod unite;

use crate::{
    mesh::{Coloured, Mesh, Soup, Source},
    mtl::Material,
    number::grouped,
    texture::Texture,
    vector::V3,
};
use facet::Facets;
use fit::{Apart, FAR, Fit, Fitting};
use palette::Colours;
pub(crate) use palette::distance;
use serde::Serialize;
use split::Piece;
use std::collections::HashMap;
use unite::united;

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
        apart = fits
            .iter()
            .enumerate()
            .map(|(triangle, fit)| Some(fitting.apart(&facets.of(mesh, triangle)?, fit.as_ref()?, &corners_of(mesh, triangle)?)))
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
