//! What a user may say of a mesh file, in every command that takes one.

use super::{Usage, parse};
use microphong::format::MAX_LIGHTS;
use microphong_sim::{
    backs::Sides,
    coat::TextureSize,
    convert::{AZIMUTH, DISTANCE, ELEVATION, Finish, ORBIT, Options},
    import::{Colours, Rules},
    look::{Lamp, Surface},
    mesh::{CREASE, Weld},
    render::Format,
    vector::V3,
    view::{Projection, Up, View},
};

/// Options that describe the surface, light and view of a mesh file; other scenes have their own.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Options for model files (.obj, .stl, .ply, .gltf, .glb, .3mf)")]
pub(crate) struct MeshOptions {
    /// Axis of the mesh that points up: x, y, z, -x, -y or -z.
    #[arg(long, default_value = "y", value_parser = parse::up, allow_hyphen_values = true)]
    up: Up,
    /// Turn the surface inside out, for meshes whose faces wind clockwise. Closed meshes, and faces that are wound against their neighbours, are
    /// corrected without this option.
    #[arg(long)]
    flip: bool,
    /// Draw both sides of open surfaces, such as leaves and cloth. Each triangle has a back, which takes as much flash as the front. Closed parts have no
    /// backs. Without this option only materials that the file calls double-sided (glTF) have backs.
    #[arg(long, conflicts_with = "one_sided")]
    two_sided: bool,
    /// Draw only the fronts of triangles, also of materials that the file calls double-sided.
    #[arg(long)]
    one_sided: bool,
    /// Largest angle in degrees at which an edge looks smooth: 0 shows all facets, 180 none. It applies to files without normals and smoothing
    /// groups.
    #[arg(long, value_name = "DEGREES", default_value_t = CREASE, value_parser = parse::crease)]
    crease: f64,
    /// Refuse a file with wrong elements. Without this option they are left out or mended, if the rest of the mesh can be drawn, and the command prints
    /// them: faces of fewer than three corners, vertices and normals that are not finite numbers, normals without a direction, and faces that are wound
    /// against their neighbours.
    #[arg(long)]
    strict: bool,
    /// Open files outside the folder of the model, if the model names them. Without this option only regular files in this folder are opened. Use it
    /// only for models that you trust.
    #[arg(long)]
    allow_outside: bool,
    /// What becomes of the colours of textures and vertices. With corners, triangles have colours at their corners, which take 4 bytes of flash for each
    /// triangle. With texture, materials have a texture if more than 5 % of their area would be farther than 24 of 255 from it; it takes 1 byte for each
    /// texel and 12 bytes for each triangle, and a program needs the feature textures. Other materials have colours at corners. With none, the colours of
    /// textures and vertices are left out, and images are not read.
    #[arg(long, visible_alias = "colors", default_value = "corners", value_parser = parse::Corners)]
    colours: Colours,
    /// Largest width and height of textures, in texels: 8, 16, 32, 64, 128 or 256. The default is 128. Each side of an image is reduced to the nearest
    /// power of two, or to this number. It needs --colours texture.
    #[arg(long, value_name = "TEXELS", value_parser = parse::texture_size)]
    texture_size: Option<TextureSize>,
    /// Draw transparent materials as if nothing were seen through them, and fill in the holes of textures. Without this option a program needs the feature
    /// transparency for them.
    #[arg(long)]
    opaque: bool,
    /// Merge all objects into one object without a name, which takes less flash. It has one mesh for each material.
    #[arg(long)]
    merge: bool,
    /// Colour of the whole surface, RRGGBB, instead of the file's materials. A file without materials is copper by default, or white in formats of
    /// one bit and of up to 16 greys.
    #[arg(long, visible_alias = "color", value_name = "RRGGBB", value_parser = parse::colour)]
    colour: Option<V3>,
    /// Diffuse reflection of materials that the file does not define, 0 to 2. The default is 0.5, or 0.8 in formats of one bit and of up to 16 greys.
    #[arg(long, value_name = "SHARE", value_parser = parse::share)]
    diffuse: Option<f64>,
    /// Strength of the highlight of materials that the file does not define, 0 to 2. The default is 0.32, or 0.4 in formats of one bit and of up to
    /// 16 greys.
    #[arg(long, value_name = "SHARE", value_parser = parse::share)]
    specular: Option<f64>,
    /// Ambient light, which comes from all sides, 0 to 2. The default is 0.18, or 0.15 in formats of one bit and of up to 16 greys.
    #[arg(long, value_name = "SHARE", value_parser = parse::share)]
    ambient: Option<f64>,
    /// Exponent of the highlight of materials that the file does not define, 1 to 1024. A larger exponent makes a smaller, sharper highlight. The
    /// default is 30, or 20 in formats of one bit and of up to 16 greys.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    exponent: Option<u16>,
    /// A light in the direction X,Y,Z: x points to the right, y up, z towards the viewer. The light is white, or has the colour RRGGBB. After at: it
    /// is a near light at the position X,Y,Z, relative to the centre of the mesh, whose radius is 1; near lights take longer. A near light may end at a
    /// distance, as in at:1,2,2:range=4, and may have a cone, as in at:0,3,0:shines=0,-1,0:cone=15,25 in degrees from the direction in which it
    /// shines: light is full up to the first angle and ends at the second. After sky: it is light from the half of the sky around the direction
    /// X,Y,Z, as in sky:0,1,0:8090ff. Repeat the option for up to eight lights. By default one light comes from the upper left.
    #[arg(long = "light", value_name = "[at:|sky:]X,Y,Z[:RRGGBB]", value_parser = parse::light, allow_hyphen_values = true)]
    lights: Vec<Lamp>,
    /// Make highlights white, as on plastic. Without this option they have the colour of the surface, as on metal.
    #[arg(long)]
    plastic: bool,
    /// Background colour, RRGGBB. The default is 1a1c20, or black in formats of one bit and of up to 16 greys.
    #[arg(long, value_name = "RRGGBB", value_parser = parse::bytes)]
    background: Option<[u8; 3]>,
    /// Number of frames in which the camera moves once around the mesh. With 0 the camera stands still.
    #[arg(long, value_name = "FRAMES", default_value_t = ORBIT)]
    orbit: u16,
    /// Position of the camera, in degrees to the right of the front.
    #[arg(long, value_name = "DEGREES", default_value_t = AZIMUTH, value_parser = parse::degrees)]
    azimuth: f64,
    /// Position of the camera, in degrees above the horizon.
    #[arg(long, value_name = "DEGREES", default_value_t = ELEVATION, value_parser = parse::degrees)]
    elevation: f64,
    /// Projection: perspective or parallel.
    #[arg(long, default_value = "perspective", value_parser = parse::projection)]
    projection: Projection,
    /// Compute highlights with the direction from each point to the viewer, instead of one direction for all points. This takes longer.
    #[arg(long)]
    local_viewer: bool,
    /// Reduce the mesh to at most this number of triangles. The command prints the largest distance between the result and the mesh of the file.
    /// Levels of --lod are made from the result.
    #[arg(long, value_name = "TRIANGLES", value_parser = clap::value_parser!(u32).range(1..))]
    simplify: Option<u32>,
    /// Sizes of pictures, separated by commas. For each size a coarser level of detail is added: the fewest triangles that stay within half a pixel
    /// of the mesh. A program draws the coarsest level that fits its picture. Each triangle of a level takes 30 bytes of flash. A level that saves
    /// less than a tenth of the triangles is not added.
    #[arg(long, value_name = "WxH,...", value_delimiter = ',', value_parser = parse::size)]
    lod: Vec<(u32, u32)>,
}

impl MeshOptions {
    /// Options of the conversion, for pictures in this format.
    ///
    /// # Errors
    /// When there are more lights than a scene has.
    pub(crate) fn options(&self, format: Format) -> Result<Options, Usage> {
        if self.lights.len() > MAX_LIGHTS {
            return Err(Usage(format!("{} times --light; a scene has at most {MAX_LIGHTS} lights", self.lights.len())));
        }
        if self.texture_size.is_some() && self.colours != Colours::Texture {
            return Err(Usage("--texture-size is the size of textures, which meshes have with --colours texture".to_owned()));
        }
        let view = View::orbit(self.up, self.azimuth.to_radians(), self.elevation.to_radians(), DISTANCE, self.orbit);
        let Finish { colour, shares, exponent, background } = Finish::of(format);
        let [ambient, diffuse, specular] = [self.ambient, self.diffuse, self.specular];
        let shares = [ambient.unwrap_or(shares[0]), diffuse.unwrap_or(shares[1]), specular.unwrap_or(shares[2])];
        let material = if self.plastic { Surface::plastic } else { Surface::metal };
        Ok(Options {
            weld: Weld { turn: self.flip, crease: self.crease },
            rules: Rules {
                strict: self.strict,
                allow_outside: self.allow_outside,
                sides: match (self.two_sided, self.one_sided) {
                    (true, _) => Sides::Two,
                    (_, true) => Sides::One,
                    _ => Sides::OfFile,
                },
                texture_size: self.texture_size.unwrap_or_default(),
                colours: if self.colour.is_some() { Colours::None } else { self.colours },
                opaque: self.opaque,
            },
            merge: self.merge,
            surface: material(self.colour.unwrap_or(colour), shares, self.exponent.unwrap_or(exponent)),
            repaint: self.colour.is_some(),
            ambient: shares[0],
            lamps: self.lights.clone(),
            background: self.background.unwrap_or(background),
            view: if self.projection == Projection::Orthographic { view.parallel() } else { view },
            local_viewer: self.local_viewer,
            format,
            simplify: self.simplify.map(|most| most as usize),
            levels: self.lod.clone(),
            ..Options::default()
        })
    }
}

/// Options of the conversion, for pictures in this format, where some are given and where none are.
///
/// # Errors
/// Those of [`MeshOptions::options`].
pub(crate) fn or_default(given: Option<&MeshOptions>, format: Format) -> Result<Options, Usage> {
    match given {
        Some(given) => given.options(format),
        None => Ok(Options::for_format(format)),
    }
}
