//! Materials for the colours that faces have by a texture, or by colours at their corners.
//!
//! A stream has one colour for each material. Most models of few triangles have textures that are palettes: each face lies in a patch of one colour. So
//! a face takes the mean of its colours, faces of nearly equal colours share a material, and the report says how far they are from their texture.

use crate::{
    mesh::{Face, Soup},
    mtl::Material,
    number::grouped,
    texture::Texture,
    vector::{V3, add, scale},
};
use std::collections::HashMap;

/// Points of a triangle, as shares of its corners, at which its texture is read: the middles of 28 triangles of one size, and so not its rim.
const SAMPLES: usize = 7;
/// The least distance of two colours, as a share of full, that stay two materials.
const NEAREST: f64 = 3.0 / 255.0;
/// A colour at this distance from a face's own is said to be far.
const FAR: f64 = 12.0 / 255.0;

/// A colour with 8 bits a channel.
type Colour = [u8; 3];

/// What painting did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Painted {
    /// Number of materials that faces have by their colours.
    pub(crate) materials: usize,
    /// Number of faces that have colours.
    pub(crate) faces: usize,
    /// Number of them of which a point is far from the colour of its material.
    pub(crate) far: usize,
    /// Root of the mean squared distance of all points, as a share of full.
    pub(crate) rms: f64,
}

impl Painted {
    /// A sentence for the user; `None` if no face has a colour.
    pub(crate) fn sentence(&self) -> Option<String> {
        let Self { materials, faces, far, rms } = *self;
        let several = if materials == 1 { "1 material is" } else { &*format!("{materials} materials are") };
        let distance = if far == 0 {
            "no face is farther than 12 of 255 from its colours".to_owned()
        } else {
            format!("{} of {} faces are farther than 12 of 255 from their colours", grouped(far), grouped(faces))
        };
        (faces > 0).then(|| {
            format!("{several} made for colours of textures and vertices: {distance}, the root of the mean square is {:.1}", 255.0 * rms)
        })
    }
}

/// Gives each face with colours a material of its colour, at most `most` in all. `textures` are those of the materials. Nothing happens if `most` is 0.
pub(crate) fn paint(soup: &mut Soup, materials: &mut Vec<Option<Material>>, textures: &[Option<Texture>], most: usize) -> Painted {
    if most == 0 {
        return Painted::default();
    }
    // Points are computed twice, because those of all faces would take much memory.
    let mut keys = Vec::with_capacity(soup.faces.len());
    let mut wanted: HashMap<(usize, Colour), usize> = HashMap::new();
    for face in &soup.faces {
        let points = colours(soup, face, textures);
        let key = points.as_ref().map(|points| (face.submesh.material, rounded(mean(points))));
        if let (Some(key), Some(points)) = (key, points) {
            *wanted.entry(key).or_default() += points.len();
        }
        keys.push(key);
    }
    let palette = Palette::of(&wanted, most);
    let first = materials.len();
    for (base, colour) in &palette.colours {
        let material = materials.get(*base).and_then(Option::as_ref);
        let painted =
            material.map_or_else(|| Material::matt(name_of(*colour), *colour), |material| material.painted(&name_of(*colour), *colour));
        materials.push(Some(painted));
    }
    let mut painted = Painted { materials: palette.colours.len(), ..Painted::default() };
    let (mut sum, mut count) = (0.0, 0usize);
    let indices: Vec<Option<usize>> = keys.iter().map(|key| palette.index.get(&(*key)?).copied()).collect();
    for (face, index) in soup.faces.iter().zip(&indices) {
        let (Some(index), Some(points)) = (*index, colours(soup, face, textures)) else { continue };
        let (_, colour) = palette.colours[index];
        let distances = points.iter().map(|&point| distance(point, colour));
        painted.faces += 1;
        painted.far += usize::from(distances.clone().fold(0.0, f64::max) > FAR);
        sum += distances.map(|distance| distance * distance).sum::<f64>();
        count += points.len();
    }
    for (face, index) in soup.faces.iter_mut().zip(indices) {
        face.submesh.material = index.map_or(face.submesh.material, |index| first + index);
    }
    painted.rms = if count > 0 { (sum / count as f64).sqrt() } else { 0.0 };
    drop_unused(soup, materials);
    painted
}

/// The colours of a face at some of its points, as sRGB has them: the product of its texture and of colours at its corners. `None` if it has neither.
fn colours(soup: &Soup, face: &Face, textures: &[Option<Texture>]) -> Option<Vec<V3>> {
    let of_corners: Option<Vec<V3>> = face.corners.iter().map(|corner| Some(soup.colours[corner.colour?])).collect();
    let texture = textures.get(face.submesh.material).and_then(Option::as_ref);
    let places: Option<Vec<[f64; 2]>> = texture.and_then(|_| face.corners.iter().map(|corner| Some(soup.places[corner.place?])).collect());
    if of_corners.is_none() && places.is_none() {
        return None;
    }
    let mut seen = Vec::new();
    for last in 2..face.corners.len() {
        let triangle = [0, last - 1, last];
        for weights in samples() {
            let colour = of_corners.as_ref().map_or([1.0; 3], |colours| {
                triangle.iter().zip(weights).fold([0.0; 3], |sum, (&corner, weight)| add(sum, scale(colours[corner], weight)))
            });
            let texel = texture.zip(places.as_ref()).map_or([1.0; 3], |(texture, places)| {
                let place = |axis: usize| triangle.iter().zip(weights).map(|(&corner, weight)| places[corner][axis] * weight).sum();
                texture.at([place(0), place(1)])
            });
            seen.push([0, 1, 2].map(|k| colour[k] * texel[k]));
        }
    }
    Some(seen)
}

/// Shares of three corners at evenly spread points within a triangle.
fn samples() -> impl Iterator<Item = [f64; 3]> {
    let share = |k: usize| (k as f64 + 1.0 / 3.0) / SAMPLES as f64;
    (0..SAMPLES).flat_map(move |i| (0..SAMPLES - i).map(move |j| [share(i), share(j), 1.0 - share(i) - share(j)]))
}

fn mean(points: &[V3]) -> V3 {
    scale(points.iter().fold([0.0; 3], |sum, &point| add(sum, point)), 1.0 / points.len() as f64)
}

fn rounded(colour: V3) -> Colour {
    colour.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}

fn name_of(colour: V3) -> String {
    let [r, g, b] = rounded(colour);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The largest difference of a channel.
fn distance(a: V3, b: V3) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
}

/// Few colours for many.
struct Palette {
    /// A material and the colour by which it is multiplied.
    colours: Vec<(usize, V3)>,
    /// The number of the colour that stands for another.
    index: HashMap<(usize, Colour), usize>,
}

impl Palette {
    /// A palette of at most `most` colours, or one of each material if there are more. Frequent colours come first, and take all colours around them
    /// that no other has taken. The radius grows until they are few enough.
    fn of(wanted: &HashMap<(usize, Colour), usize>, most: usize) -> Self {
        let mut wanted: Vec<_> = wanted.iter().map(|(&key, &weight)| (key, weight)).collect();
        wanted.sort_by_key(|&(key, weight)| (usize::MAX - weight, key));
        let mut radius = NEAREST;
        loop {
            // Within a radius of all colours each material has one.
            let most = if radius > 1.0 { usize::MAX } else { most };
            if let Some(palette) = Self::within(&wanted, radius, most) {
                return palette;
            }
            radius *= 1.25;
        }
    }

    /// A palette of colours that are farther apart than `radius`; `None` if there are more than `most`.
    fn within(wanted: &[((usize, Colour), usize)], radius: f64, most: usize) -> Option<Self> {
        // The sum of all colours that one stands for, and their weight.
        let mut sums: Vec<(usize, V3, V3, f64)> = Vec::new();
        let mut index = HashMap::new();
        for &((material, colour), weight) in wanted {
            let (own, weight) = (colour.map(|c| f64::from(c) / 255.0), weight as f64);
            let near = |&(_, (base, first, ..)): &(usize, &(usize, V3, V3, f64))| *base == material && distance(*first, own) <= radius;
            let nearest = sums.iter().enumerate().filter(near).min_by(|(_, a), (_, b)| distance(a.1, own).total_cmp(&distance(b.1, own)));
            let number = nearest.map_or(sums.len(), |(number, _)| number);
            if number == sums.len() {
                if number == most {
                    return None;
                }
                sums.push((material, own, [0.0; 3], 0.0));
            }
            let (_, _, sum, total) = &mut sums[number];
            (*sum, *total) = (add(*sum, scale(own, weight)), *total + weight);
            index.insert((material, colour), number);
        }
        let colours = sums.into_iter().map(|(material, _, sum, total)| (material, scale(sum, 1.0 / total))).collect();
        Some(Self { colours, index })
    }
}

/// Leaves out materials that no face has any more.
fn drop_unused(soup: &mut Soup, materials: &mut Vec<Option<Material>>) {
    let mut used = vec![false; materials.len()];
    soup.faces.iter().for_each(|face| used[face.submesh.material] = true);
    let numbers: Vec<usize> = used.iter().scan(0, |count, &used| Some(std::mem::replace(count, *count + usize::from(used)))).collect();
    soup.faces.iter_mut().for_each(|face| face.submesh.material = numbers[face.submesh.material]);
    let mut used = used.into_iter();
    materials.retain(|_| used.next().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Corner, Smoothing, Submesh};

    /// One triangle for each colour.
    fn triangles(colours: &[V3]) -> Soup {
        let corner = |colour: usize| Corner { position: 0, colour: Some(colour), ..Corner::default() };
        let face = |colour| Face { corners: vec![corner(colour); 3], submesh: Submesh::default(), smoothing: Smoothing::ByAngle };
        Soup { positions: vec![[0.0; 3]], colours: colours.to_vec(), faces: (0..colours.len()).map(face).collect(), ..Soup::default() }
    }

    #[test]
    fn faces_of_nearly_equal_colours_share_a_material() {
        let grey = |level: f64| [level / 255.0; 3];
        let mut soup = triangles(&[grey(100.0), grey(101.0), grey(200.0), grey(100.0)]);
        let mut materials = vec![None];
        let painted = paint(&mut soup, &mut materials, &[None], 32);
        assert_eq!((painted.materials, painted.faces, painted.far), (2, 4, 0));
        assert_eq!(soup.faces.iter().map(|face| face.submesh.material).collect::<Vec<_>>(), [0, 0, 1, 0]);
        let names: Vec<_> = materials.iter().flatten().map(|material| material.name.as_str()).collect();
        assert_eq!(names, ["#646464", "#c8c8c8"]);
    }

    #[test]
    fn no_more_materials_are_made_than_are_wanted() {
        let colours: Vec<V3> = (0..1000).map(|k| [k % 10, k / 10 % 10, k / 100].map(|c| f64::from(c) / 9.0)).collect();
        for most in [1, 5, 32] {
            let (mut soup, mut materials) = (triangles(&colours), vec![None]);
            let painted = paint(&mut soup, &mut materials, &[None], most);
            assert!(painted.materials <= most && materials.len() == painted.materials && painted.far > 900, "{painted:?}");
        }
        let (mut soup, mut materials) = (triangles(&colours), vec![None]);
        assert_eq!(paint(&mut soup, &mut materials, &[None], 0), Painted::default());
        assert_eq!(materials, [None]);
    }

    /// The colour of a material and that of a face are multiplied.
    #[test]
    fn materials_keep_their_highlight() {
        let mut soup = triangles(&[[0.5, 1.0, 0.0]]);
        let red = Material { diffuse: Some([0.8, 0.5, 0.5]), specular: Some([0.3; 3]), exponent: Some(50.0), ..Material::default() };
        let mut materials = vec![Some(red)];
        paint(&mut soup, &mut materials, &[None], 32);
        let [Some(material)] = &materials[..] else { panic!("{materials:?}") };
        assert!(distance(material.diffuse.unwrap(), [0.8 * 128.0 / 255.0, 0.5, 0.0]) < 1e-9, "{material:?}");
        assert_eq!((material.specular, material.exponent), (Some([0.3; 3]), Some(50.0)));
    }
}
