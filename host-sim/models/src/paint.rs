//! Colours of triangles, for the colours that a file has in textures and at its vertices.
//!
//! Triangles of a stream have colours at their corners, and the colour is linear between them. Most models of few triangles have textures that are palettes:
//! each face lies in a patch of one colour, or in a gradient, and colours at the corners come very close to that. The colours of a triangle with a texture
//! are those of least squared distance at many of its points. Where they are far from too much of a texture, triangles can have the texture itself.

mod emission;
mod facet;
mod fit;
mod palette;
mod report;
mod split;
mod textures;
mod unite;

use crate::{
    coat::{Coat, Paint, TextureSize},
    mesh::{Coloured, Mesh, Soup, Source},
    mtl::Material,
    texture::Texture,
    vector::{V3, cross, length, sub},
};
pub(crate) use emission::{Emission, emit};
use facet::{Facet, Facets};
use fit::{Apart, FAR, Fit, Fitting};
pub(crate) use palette::distance;
use palette::{BLOCKS, Colours};
pub use report::{Painted, Textured};
use split::Piece;
use std::collections::HashMap;
use textures::Textures;
use unite::united;

/// How often neighbours of triangles that are split are looked at anew.
const SPLITS: usize = 3;
/// The share of the area of a material that may be far from its texture; where more is, colours at corners do not give the texture.
const LOST: f64 = 0.05;

/// Gives the triangles of a mesh the colours of the soup that it was made of. `sources` says where the soup has them, and `textures` are those of the
/// materials. Triangles may be split. If there is a size for textures, materials whose texture is lost by colours at corners have it.
pub(crate) fn paint(
    mesh: &mut Mesh,
    sources: Vec<[Source; 3]>,
    soup: &Soup,
    materials: &mut Vec<Option<Material>>,
    textures: &[Option<Texture>],
    size: Option<TextureSize>,
) -> Painted {
    if sources.is_empty() || soup.colours.is_empty() && textures.iter().all(Option::is_none) {
        return Painted::default();
    }
    let fitting = Fitting::new();
    let facets = Facets { soup, textures, sources, parts: HashMap::new() };
    let mut painting = Painting::at_corners(mesh, &facets, &fitting, (BLOCKS, &|_| false));
    let areas = painting.areas(materials.len());
    let has_holes = holes(mesh, &facets, &fitting, materials.len());
    let is_lost: Vec<bool> = areas.iter().zip(&has_holes).map(|(area, has_holes)| area.is_lost() || *has_holes).collect();
    let textured = size.filter(|_| is_lost.contains(&true)).map(|size| {
        let takes = |facet: Facet<'_>| facet.is_white && facet.places().is_some();
        let takes = |triangle: usize| is_lost[mesh.submesh(triangle).material] && facets.of(mesh, triangle).is_some_and(takes);
        let takes: Vec<bool> = (0..mesh.triangles.len()).map(takes).collect();
        let textures = Textures::of(mesh, &facets, &takes, size);
        let blocks = BLOCKS.saturating_sub(textures.blocks());
        painting = Painting::at_corners(mesh, &facets, &fitting, (blocks, &|triangle| takes[triangle]));
        painting.put_on(&textures, &fitting, &is_lost)
    });
    let all = areas.iter().copied().filter(Area::is_lost).fold(Area::default(), |sum, area| sum.with(area));
    let painted = Painted {
        lost_materials: areas.iter().filter(|area| area.is_lost()).count(),
        lost_area: all.share(),
        materials_with_holes: has_holes.iter().filter(|has_holes| **has_holes).count(),
        textures: textured,
        ..painting.report()
    };
    *mesh = painting.mesh;
    Painted { materials: with_materials(mesh, materials), ..painted }
}

/// The materials whose texture has a hole on one of their triangles.
fn holes(mesh: &Mesh, facets: &Facets<'_>, fitting: &Fitting, materials: usize) -> Vec<bool> {
    let mut has_holes = vec![false; materials];
    for triangle in 0..mesh.triangles.len() {
        let has_hole = &mut has_holes[mesh.submesh(triangle).material];
        *has_hole = *has_hole || facets.of(mesh, triangle).is_some_and(|facet| fitting.has_hole(&facet));
    }
    has_holes
}

/// An area, and how much of it is far from its texture.
#[derive(Clone, Copy, Default)]
struct Area {
    all: f64,
    lost: f64,
}

impl Area {
    /// The area of a triangle.
    fn of(mesh: &Mesh, triangle: usize, apart: &Apart) -> Self {
        let all = area(mesh, triangle);
        Self { all, lost: apart.lost * all }
    }

    fn with(self, other: Self) -> Self {
        Self { all: self.all + other.all, lost: self.lost + other.lost }
    }

    /// The share that is far.
    fn share(&self) -> f64 {
        if self.lost > 0.0 { self.lost / self.all } else { 0.0 }
    }

    fn is_lost(&self) -> bool {
        self.share() > LOST
    }
}

/// Twice the area of a triangle.
fn area(mesh: &Mesh, triangle: usize) -> f64 {
    let [a, b, c] = mesh.triangles[triangle].map(|vertex| mesh.positions[vertex]);
    length(cross(sub(b, a), sub(c, a)))
}

/// A mesh with the colours that it has.
struct Painting<'a> {
    mesh: Mesh,
    facets: Facets<'a>,
    /// How far the colours at the corners of each triangle are from those of the file; `None` if it has none.
    apart: Vec<Option<Apart>>,
    /// Number of triangles that were split.
    split: usize,
}

impl<'a> Painting<'a> {
    /// Gives triangles colours at their corners, of so many blocks of colours, but for the triangles that are left out.
    fn at_corners(mesh: &Mesh, facets: &Facets<'a>, fitting: &Fitting, (blocks, is_out): (usize, &dyn Fn(usize) -> bool)) -> Self {
        let fit = |triangle| if is_out(triangle) { None } else { Some(fitting.fit(&facets.of(mesh, triangle)?)) };
        let mut fits: Vec<Option<Fit>> = (0..mesh.triangles.len()).map(fit).collect();
        let mut painting = Self { mesh: mesh.clone(), facets: facets.clone(), apart: Vec::new(), split: 0 };
        let Self { mesh, facets, apart, split } = &mut painting;
        *split = split_far(mesh, facets, &mut fits, fitting);
        let mut is_exact = vec![false; mesh.triangles.len()];
        // Colours that are united become far here and there: these triangles keep their own.
        for _ in 0..2 {
            let colours = united(mesh, &fits, &is_exact);
            let material = |triangle| mesh.submesh(triangle).material;
            let reduced = Colours { triangles: &colours, is_exact: &is_exact, material: &material, blocks }.reduced();
            (mesh.coats, mesh.colours) = (reduced.palettes.into_iter().map(Coat::Palette).collect(), reduced.triangles);
            *apart = fits
                .iter()
                .enumerate()
                .map(|(triangle, fit)| Some(fitting.apart(&facets.of(mesh, triangle)?, fit.as_ref()?, &corners_of(mesh, triangle)?)))
                .collect();
            let mut has_new = false;
            for ((fit, apart), is_exact) in fits.iter().zip(&*apart).zip(&mut is_exact) {
                let (Some(fit), Some(apart)) = (fit, apart) else { continue };
                *is_exact |= apart.largest > FAR && !fit.is_far;
                has_new |= *is_exact;
            }
            if !has_new || !reduced.is_close {
                break;
            }
        }
        painting
    }

    /// The areas of the triangles of each material that have a texture in the file and colours at their corners.
    fn areas(&self, materials: usize) -> Vec<Area> {
        let mut areas = vec![Area::default(); materials];
        for (triangle, apart) in self.apart.iter().enumerate() {
            let has_texture = |_: &&Apart| self.facets.of(&self.mesh, triangle).is_some_and(|facet| facet.texture.is_some());
            if let Some(apart) = apart.as_ref().filter(has_texture) {
                let area = &mut areas[self.mesh.submesh(triangle).material];
                *area = area.with(Area::of(&self.mesh, triangle, apart));
            }
        }
        areas
    }

    /// Gives the triangles without colours at their corners their textures.
    fn put_on(&mut self, textures: &Textures, fitting: &Fitting, is_lost: &[bool]) -> Textured {
        let mut textured = Textured { sizes: textures.sizes(), bytes: textures.bytes(), ..Textured::default() };
        let first = self.mesh.coats.len();
        self.mesh.coats.extend(textures.coats());
        let (mut area, mut squares) = (Area::default(), 0.0);
        for (triangle, has_corners) in self.apart.iter().map(Option::is_some).enumerate() {
            let Some(facet) = self.facets.of(&self.mesh, triangle).filter(|facet| facet.texture.is_some()) else { continue };
            if has_corners {
                let is_lost = is_lost[self.mesh.submesh(triangle).material];
                textured.repeating += usize::from(is_lost && facet.is_white);
                textured.multiplied += usize::from(is_lost && !facet.is_white);
                continue;
            }
            let found = facet.texture.and_then(|(image, _)| textures.find(image)).zip(facet.places());
            let Some(((number, texels), places)) = found else { continue };
            let at = |[p, q, r]: [f64; 3]| {
                let [a, b, c] = places.map(|place| place.map(f64::from));
                texels.at([0, 1].map(|axis| a[axis] * p + b[axis] * q + c[axis] * r)).map(|c| f64::from(c) / 255.0)
            };
            let apart = fitting.apart_by(&facet, at);
            textured.triangles += 1;
            area = area.with(Area::of(&self.mesh, triangle, &apart));
            squares += apart.squares;
            self.mesh.colours[triangle] = Some(Coloured { coat: (first + number) as u16, corners: places.map(Paint::Place) });
        }
        (textured.lost_area, textured.rms) = (area.share(), root(squares, textured.triangles));
        textured
    }

    /// The colours at corners, and how far they are.
    fn report(&self) -> Painted {
        let palettes = || self.mesh.coats.iter().filter(|coat| matches!(coat, Coat::Palette(_)));
        let mut painted =
            Painted { colours: palettes().map(|coat| coat.palette().len()).sum(), palettes: palettes().count(), ..Painted::default() };
        painted.split = self.split;
        let mut squares = 0.0;
        for (triangle, apart) in self.apart.iter().enumerate() {
            let Some(apart) = apart else { continue };
            painted.triangles += 1;
            painted.of_one_colour +=
                usize::from(self.mesh.coloured(triangle).is_some_and(|Coloured { corners: [a, b, c], .. }| a == b && b == c));
            painted.far += usize::from(apart.largest > FAR);
            squares += apart.squares;
        }
        painted.rms = root(squares, painted.triangles);
        painted
    }
}

/// The root of the mean of the squares of some triangles, in 255ths.
fn root(squares: f64, triangles: usize) -> f64 {
    if triangles > 0 { 255.0 * (squares / triangles as f64).sqrt() } else { 0.0 }
}

/// The colours at the corners of a triangle, if it has some.
fn corners_of(mesh: &Mesh, triangle: usize) -> Option<[V3; 3]> {
    let Coloured { coat, corners } = mesh.coloured(triangle)?;
    let palette = mesh.coats[usize::from(coat)].palette();
    let colour = |paint| match paint {
        Paint::Colour(colour) => palette[usize::from(colour)].map(|c| f64::from(c) / 255.0),
        Paint::Place(_) => [0.0; 3],
    };
    Some(corners.map(colour))
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
        let fit = |piece: &Piece| {
            fits[piece.of].as_ref()?;
            Some(fitting.fit(&facets.of(mesh, piece.of)?.part(&piece.part?)))
        };
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
