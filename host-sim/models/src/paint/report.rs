//! What a user learns of the colours of a mesh.

use crate::number::grouped;
use serde::Serialize;

/// The colours that a mesh has by its file, and how far they are from those of the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
    /// Number of materials whose texture is lost by colours at corners: more than 5 % of its area is farther than 24 of 255 from it.
    pub lost_materials: usize,
    /// Number of materials whose texture has holes.
    pub materials_with_holes: usize,
    /// The share of the area of these materials that is farther than 24 of 255 from the texture.
    pub lost_area: f64,
    /// The textures of the stream, if these materials were to have some.
    pub textures: Option<Textured>,
}

/// The textures that a mesh has by its file, and how far they are from those of the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Textured {
    /// Number of triangles that have a texture.
    pub triangles: usize,
    /// Width and height of each texture.
    pub sizes: Vec<[u32; 2]>,
    /// Bytes of flash of the textures with their palettes.
    pub bytes: usize,
    /// Root of the mean squared distance of all channels at all points, in 255ths.
    pub rms: f64,
    /// The share of the area that is farther than 24 of 255 from the texture of the file.
    pub lost_area: f64,
    /// Number of triangles of the same materials that keep colours at their corners, because the texture repeats itself too often.
    pub repeating: usize,
    /// Number of triangles of the same materials that keep colours at their corners, because the file multiplies the texture by colours of vertices.
    pub multiplied: usize,
}

impl Painted {
    /// Whether any triangle has colours or a texture.
    #[must_use]
    pub fn has_any(&self) -> bool {
        self.triangles > 0 || self.textures.as_ref().is_some_and(|textures| textures.triangles > 0)
    }

    /// Sentences for the user.
    pub(crate) fn sentences(&self) -> impl Iterator<Item = String> {
        let sentences = self.of_corners().into_iter().chain(self.textures.iter().flat_map(Textured::sentences));
        sentences.chain(self.of_holes())
    }

    /// A sentence on holes of textures; `None` if there are none.
    fn of_holes(&self) -> Option<String> {
        let has = counted(self.materials_with_holes, ["material has a texture with holes", "materials have textures with holes"]);
        let what = match self.textures {
            Some(_) => "a program needs the feature transparency to draw them",
            None => "they are filled in; --colours texture keeps them, for a program with the features textures and transparency",
        };
        (self.materials_with_holes > 0).then(|| format!("{has}: {what}"))
    }

    /// A sentence on colours at corners; `None` if no triangle has any.
    fn of_corners(&self) -> Option<String> {
        let Self { colours, palettes, triangles, split, far, rms, lost_materials, .. } = *self;
        let has = counted(triangles, ["triangle has", "triangles have"]);
        let colours = counted(colours, ["colour", "colours"]);
        let palettes = if palettes < 2 { String::new() } else { format!(" in {palettes} palettes") };
        let split = match split {
            0 => String::new(),
            count => format!(", {} split for it", counted(count, ["triangle was", "triangles were"])),
        };
        let distance = match far {
            0 => "none is farther than 12 of 255 from its texture or colours".to_owned(),
            1 => "1 is farther than 12 of 255 from its texture or colours".to_owned(),
            several => format!("{} are farther than 12 of 255 from their texture or colours", grouped(several)),
        };
        let lost = if lost_materials == 0 || self.textures.is_some() {
            String::new()
        } else {
            let (area, of) = (percent(self.lost_area), counted(lost_materials, ["material", "materials"]));
            format!(
                "; {area} of the area of {of} is farther than 24: --colours texture keeps the texture, for a program with the feature textures"
            )
        };
        (triangles > 0).then(|| {
            format!(
                "{has} {colours} of textures and vertices at the corners{palettes}{split}: {distance}, the root of the mean square is {rms:.1}{lost}"
            )
        })
    }
}

impl Textured {
    /// Sentences for the user.
    fn sentences(&self) -> Vec<String> {
        let Self { triangles, sizes, bytes, rms, lost_area, repeating, multiplied } = self;
        let mut sentences = Vec::new();
        if *triangles > 0 {
            let has = counted(*triangles, ["triangle has", "triangles have"]);
            let mut distinct = sizes.clone();
            distinct.sort_unstable();
            distinct.dedup();
            let names: Vec<_> = distinct.iter().rev().map(|[width, height]| format!("{width}x{height}")).collect();
            let (count, names) = (counted(sizes.len(), ["texture", "textures"]), names.join(" and "));
            let (bytes, area) = (grouped(*bytes), percent(*lost_area));
            sentences.push(format!(
                "{has} {count} of {names} texels, {bytes} bytes: {area} of the area is farther than 24 of 255 from the file, the root of the mean \
                 square is {rms:.1}"
            ));
        }
        let reasons = [
            (*repeating, "the texture repeats itself 16 times or more over it"),
            (*multiplied, "colours of vertices multiply the texture"),
        ];
        for (count, reason) in reasons.into_iter().filter(|(count, _)| *count > 0) {
            let keeps = counted(count, ["triangle keeps", "triangles keep"]);
            sentences.push(format!("{keeps} colours at the corners, because {reason}"));
        }
        sentences
    }
}

/// A number and what it counts, one of them and several.
fn counted(count: usize, [one, several]: [&str; 2]) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{} {several}", grouped(count)) }
}

/// A share of all.
fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".to_owned(),
        small if small < 0.1 => "less than 0.1 %".to_owned(),
        small if small < 10.0 => format!("{small:.1} %"),
        large => format!("{large:.0} %"),
    }
}
