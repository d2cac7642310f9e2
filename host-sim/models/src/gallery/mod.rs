//! Models such as games, views of products and mechanical design show, made of formulas.
//!
//! Each of them is polygons with colours at their corners, and becomes a mesh in the way of a file that has such polygons.

mod bracket;
mod building;
mod car;
mod cottage;
mod cupcake;
mod figure;
mod fox;
mod lighthouse;
mod nature;
mod robot;
mod rocket;
mod sailboat;
mod solid;

use crate::{
    bytes::StreamBytes,
    contents::Contents,
    convert::{DISTANCE, MARGIN, ORBIT},
    import::{self, Imported, Rules},
    look::{Lamp, Look, Surface},
    mesh::{Mesh, Soup, Weld},
    mtl::Material,
    quantise::quantise,
    vector::V3,
    view::{Up, View},
};
use anyhow::Result;
use microphong::scene::Background;
use solid::{Solid, hex};

/// The names of all models. Their scenes are built in, but they are not among [`NAMES`](crate::scene::NAMES), by which methods are judged.
pub const GALLERY: [&str; 8] = ["cottage", "sailboat", "fox", "lighthouse", "car", "cupcake", "robot", "rocket"];

/// Models of few triangles, of which about half have one colour and the others a gradient.
pub const LOW_POLY: [&str; 4] = ["cottage", "sailboat", "fox", "lighthouse"];

/// Models whose materials have the colours, of the kinds that costs are judged by: a building with hard edges, a figure of small triangles, and a
/// mechanical part with large and thin triangles.
pub const ORDINARY: [&str; 3] = ["building", "figure", "bracket"];

/// Width and height of the pictures of the gallery.
pub const SIZE: (u32, u32) = (480, 480);

/// A model with what belongs to its picture.
#[derive(Debug)]
pub struct Exhibit {
    /// The name of its scene.
    pub name: &'static str,
    description: &'static str,
    model: fn() -> Solid,
    /// Degrees of the eye to the right of the front, and above the horizon.
    eye: [f64; 2],
    /// The colours of the background at the top and the bottom.
    background: [u32; 2],
    /// Width and height of its picture.
    size: (u32, u32),
    /// Whether materials have the colours, and not corners.
    by_material: bool,
}

/// All of them, in the order of [`GALLERY`] and [`ORDINARY`].
const EXHIBITS: [Exhibit; 11] = [
    Exhibit::new(0, "a low-poly cottage in its garden", cottage::model, [32.0, 26.0], [0x8f_c7e8, 0xf3_ead2]),
    Exhibit::new(1, "a low-poly sailing boat on a piece of the sea", sailboat::model, [38.0, 18.0], [0xf6_b98f, 0xfd_ecc8]),
    Exhibit::new(2, "a low-poly fox on an autumn meadow", fox::model, [42.0, 16.0], [0x3d_6f73, 0xcf_e0c3]),
    Exhibit::new(3, "a low-poly lighthouse on an island in colours by height", lighthouse::model, [24.0, 24.0], [0x5a_8fc4, 0xf7_d9c4]),
    Exhibit::new(4, "a small car with a roof rack, in glossy paint", car::model, [38.0, 20.0], [0xf4_e4c9, 0xd8_a47f]),
    Exhibit::new(5, "a cupcake with icing, sprinkles and a cherry", cupcake::model, [20.0, 28.0], [0xfb_e3e6, 0xb9_d9d6]),
    Exhibit::new(6, "a toy robot with glowing eyes", robot::model, [26.0, 12.0], [0x2b_3350, 0x7d_6b91]),
    Exhibit::new(7, "a rocket that takes off from its cloud of smoke", rocket::model, [20.0, 10.0], [0x14_1c3c, 0x5b_5f97]),
    Exhibit::ordinary(0, "a town house of ten materials with hard edges", building::model, [30.0, 22.0], (320, 240)),
    Exhibit::ordinary(1, "a wooden figure of 2,000 small triangles, two materials", figure::model, [28.0, 8.0], (240, 240)),
    Exhibit::ordinary(2, "a steel bracket with large and with thin triangles", bracket::model, [35.0, 24.0], (320, 240)),
];

/// A warm light from the upper left, and a weak cool one from the right that fills the shadows. They go where the camera goes.
const LAMPS: [Lamp; 2] = [Lamp::distant([-0.42, 0.66, -0.7], [0.96, 0.9, 0.79]), Lamp::distant([0.9, 0.2, -0.3], [0.3, 0.34, 0.42])];

/// A background of one colour.
const PLAIN: [u32; 2] = [0x1a_1c20; 2];

/// The share of light that is everywhere.
const AMBIENT: f64 = 0.3;

/// The description of a model; empty for other names.
#[must_use]
pub(crate) fn description(name: &str) -> &'static str {
    Exhibit::named(name).map_or("", |exhibit| exhibit.description)
}

impl Exhibit {
    const fn new(number: usize, description: &'static str, model: fn() -> Solid, eye: [f64; 2], background: [u32; 2]) -> Self {
        Self { name: GALLERY[number], description, model, eye, background, size: SIZE, by_material: false }
    }

    const fn ordinary(number: usize, description: &'static str, model: fn() -> Solid, eye: [f64; 2], size: (u32, u32)) -> Self {
        Self { name: ORDINARY[number], description, model, eye, background: PLAIN, size, by_material: true }
    }

    /// The model of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        const { &EXHIBITS }.iter().find(|exhibit| exhibit.name == name)
    }

    /// The polygons of the model.
    #[must_use]
    pub fn soup(&self) -> Soup {
        (self.model)().soup()
    }

    /// The mesh, as a file with these polygons becomes one.
    ///
    /// # Errors
    /// When nothing is left to draw.
    pub fn imported(&self) -> Result<Imported> {
        if self.by_material {
            let (soup, colours) = (self.model)().soup_of_materials();
            let shiny = |colour: V3| {
                let more = Material {
                    ambient: Some(colour),
                    specular: Some([0.25; 3]),
                    exponent: Some(20.0),
                    ..Material::matt(String::new(), colour)
                };
                Some(more)
            };
            let materials = colours.into_iter().map(shiny).collect();
            return import::made_of(Contents { soup, materials, ..Contents::default() }, self.name, Weld::default(), Rules::default());
        }
        let soup = self.soup();
        // Materials that no polygon has would be written into the stream.
        let used = soup.faces.iter().map(|face| face.submesh.material + 1).max().unwrap_or_default();
        let shiny = |name: &str, specular: f64, exponent: f64| Material {
            ambient: Some([1.0; 3]),
            specular: Some([specular; 3]),
            exponent: Some(exponent),
            ..Material::matt(name.to_owned(), [0.82; 3])
        };
        let glowing = Material { emission: [0.75; 3], ..Material::matt("glowing".to_owned(), [0.25; 3]) };
        let materials = [shiny("matt", 0.06, 10.0), shiny("glossy", 0.5, 40.0), glowing].into_iter().take(used).map(Some).collect();
        import::made_of(Contents { soup, materials, ..Contents::default() }, self.name, Weld::default(), Rules::default())
    }

    /// The camera of its scene.
    #[must_use]
    pub fn view(&self, mesh: &Mesh) -> View {
        let [azimuth, elevation] = self.eye.map(f64::to_radians);
        View::orbit(Up::Y, azimuth, elevation, DISTANCE, ORBIT).fit(&mesh.positions, self.size, MARGIN)
    }

    /// The stream of its scene, with the size of its picture.
    ///
    /// # Errors
    /// When the mesh does not fit a stream.
    pub(crate) fn scene(&self) -> Result<(StreamBytes, (u32, u32))> {
        let Imported { mesh, materials, .. } = self.imported()?;
        let view = self.view(&mesh);
        let surface = Surface::plastic([1.0; 3], [0.0; 3], 1);
        let [top, bottom] = self.background.map(|colour| hex(colour).map(|c| (c * 255.0).round() as u8));
        let background = if top == bottom { Background::Colour(top) } else { Background::Gradient { top, bottom } };
        let look = Look {
            surfaces: import::surfaces(&materials, &surface, AMBIENT),
            lamps: LAMPS.to_vec(),
            background,
            ..Look::new(surface, view)
        };
        Ok((look.stream(&quantise(&mesh).0)?, self.size))
    }
}
