//! A mesh file becomes a stream, for commands that write it and for commands that draw it at once.

use crate::{
    bytes::StreamBytes,
    fields::quoted,
    files::Files,
    import::{self, Imported, Rules},
    levels::{self, Simplified},
    look::{BACKGROUND, Lamp, LampKind, Look, Surface},
    mesh::{Mesh, Report, Weld},
    mtl::Material,
    paint::Painted,
    quantise::{Part, quantise},
    vector::{V3, add},
    view::{Up, View},
};
use anyhow::{Context, Result};
use microphong_render::render::Format;
use std::path::Path;

/// The look of a mesh without materials.
#[derive(Clone, Copy, Debug)]
pub struct Finish {
    /// Colour of the surface.
    pub colour: V3,
    /// Shares of light: ambient, diffuse and specular.
    pub shares: [f64; 3],
    /// Exponent of the highlight.
    pub exponent: u16,
    /// Colour behind the mesh.
    pub background: [u8; 3],
}

/// Copper, a little towards gold.
pub const COPPER: V3 = [1.0, 0.62, 0.33];

impl Finish {
    /// Copper on a dark neutral colour, with so much ambient light that the dark side can be told from it. All shares together are 1, so that
    /// the brightest point is just full.
    const COLOUR: Self = Self { colour: COPPER, shares: [0.18, 0.5, 0.32], exponent: 30, background: BACKGROUND };
    /// White on black: one bit and few greys have no steps to spare.
    const GREY: Self = Self { colour: [1.0; 3], shares: [0.15, 0.8, 0.4], exponent: 20, background: [0; 3] };

    /// The look that can be read in a pixel format.
    #[must_use]
    pub const fn of(format: Format) -> Self {
        if format.has_few_greys() { Self::GREY } else { Self::COLOUR }
    }
}

/// Degrees of the eye to the right of the front.
pub const AZIMUTH: f64 = 28.6;
/// Degrees of the eye above the horizon.
pub const ELEVATION: f64 = 20.0;
/// Distance of the eye from an object of radius 1.
pub const DISTANCE: f64 = 4.0;
/// Frames in which a scene turns once.
pub const ORBIT: u16 = 120;
/// A picture of this size fits displays of every shape, because the field of view is that of the narrower side.
pub const SQUARE: (u32, u32) = (256, 256);
/// Free border, a share of the picture.
pub const MARGIN: f64 = 0.06;

/// What a user may choose about a mesh file.
#[derive(Clone, Debug)]
pub struct Options {
    /// How polygons become a surface.
    pub weld: Weld,
    /// What is passed of a file.
    pub rules: Rules,
    /// Whether all objects become one without a name.
    pub merge: bool,
    /// The material where the file has none.
    pub surface: Surface,
    /// Whether the surface takes the place of the file's materials as well.
    pub repaint: bool,
    /// Share of light that is everywhere.
    pub ambient: f64,
    /// Lights in eye space; near ones count from the centre of the mesh. Empty for the key light.
    pub lamps: Vec<Lamp>,
    /// Colour behind the mesh.
    pub background: [u8; 3],
    /// Camera, before the mesh is fitted into the picture.
    pub view: View,
    /// Whether highlights see the eye where it is, not infinitely far.
    pub local_viewer: bool,
    /// Pixel format of the pictures.
    pub format: Format,
    /// Size of the picture that the turn fills.
    pub size: (u32, u32),
    /// Most triangles.
    pub simplify: Option<usize>,
    /// Sizes of pictures that get a level of detail.
    pub levels: Vec<(u32, u32)>,
}

impl Default for Options {
    fn default() -> Self {
        Self::for_format(Format::Rgb565)
    }
}

impl Options {
    /// What nobody has chosen otherwise, for pictures in this format.
    #[must_use]
    pub fn for_format(format: Format) -> Self {
        let Finish { colour, shares, exponent, background } = Finish::of(format);
        Self {
            weld: Weld::default(),
            rules: Rules::default(),
            merge: false,
            surface: Surface::metal(colour, shares, exponent),
            repaint: false,
            ambient: shares[0],
            lamps: Vec::new(),
            background,
            view: View::orbit(Up::Y, AZIMUTH.to_radians(), ELEVATION.to_radians(), DISTANCE, ORBIT),
            local_viewer: false,
            format,
            size: SQUARE,
            simplify: None,
            levels: Vec::new(),
        }
    }
}

impl Options {
    /// The usual camera, for a mesh whose axis `up` points up.
    #[must_use]
    pub fn with_up(self, up: Up) -> Self {
        Self { view: View::orbit(up, AZIMUTH.to_radians(), ELEVATION.to_radians(), DISTANCE, ORBIT), ..self }
    }
}

/// Steps of long work.
pub trait Steps {
    /// Begins `count` steps of work that has this name, and ends the work before.
    fn begin(&self, what: &'static str, count: usize);
    /// A step is done.
    fn step(&self);
    /// Says what a user should know of the file, at once.
    fn warn(&self, what: &str);
}

/// Work that nobody watches.
impl Steps for () {
    fn begin(&self, _: &'static str, _: usize) {}
    fn step(&self) {}
    fn warn(&self, _: &str) {}
}

/// A mesh file that is ready to become a stream.
#[derive(Clone, Debug)]
pub struct Converted {
    /// The mesh, not simplified.
    pub mesh: Mesh,
    /// What welding did.
    pub report: Report,
    /// The file's materials, by which parts count; `None` where the file does not say what a material is.
    pub materials: Vec<Option<Material>>,
    /// Wrong elements of the file that are left out or mended, in sentences.
    pub faults: Vec<String>,
    /// What a user should know of the file, in sentences; wrong elements are among it.
    pub remarks: Vec<String>,
    /// The meshes before simplification, without coarser levels.
    pub whole: Vec<Part>,
    /// The meshes of the stream, with coarser levels.
    pub parts: Vec<Part>,
    /// Triangles that vanish when positions are rounded.
    pub lost: usize,
    /// Everything else of the stream.
    pub look: Look,
    /// What simplification did.
    pub simplified: Option<Simplified>,
    /// The colours and textures that triangles had before simplification.
    pub painted: Painted,
    /// Number of triangles that were backs of others before simplification.
    pub backs: usize,
}

impl Converted {
    /// Reads a mesh file.
    ///
    /// # Errors
    /// Names the file, and what is wrong with it.
    pub fn read(path: &Path, options: &Options, steps: &dyn Steps) -> Result<Self> {
        Self::read_from(&Files::OnDisk, path, options, steps)
    }

    /// Reads a mesh file of these files.
    ///
    /// # Errors
    /// Names the file, and what is wrong with it.
    pub fn read_from(files: &Files, path: &Path, options: &Options, steps: &dyn Steps) -> Result<Self> {
        let place = || path.display().to_string();
        steps.begin("reading the file", 1);
        let Imported { mut mesh, report, mut objects, mut materials, faults, mut remarks, painted, backs } =
            import::file_from(files, path, options.weld, options.rules)?;
        if options.repaint && materials.iter().any(Option::is_some) {
            remarks.push(format!("{} materials of the file have the one colour of --colour", materials.iter().flatten().count()));
            mesh.merge_materials();
            materials = vec![None];
        }
        let is_dark = |material: &&Material| is_dark(&material.surface(options.ambient), options.format);
        let dark: Vec<_> = materials.iter().flatten().filter(is_dark).collect();
        if let [first, others @ ..] = &dark[..] {
            let more = if others.is_empty() { String::new() } else { format!(" and {} more", others.len()) };
            steps.warn(&format!(
                "{}: the material \"{}\"{more} is too dark for the few greys of {}; --colour ffffff makes the whole mesh white",
                place(),
                quoted(&first.name),
                options.format.name()
            ));
        }
        if options.merge {
            mesh.merge_objects();
            objects.clear();
        }
        let (whole, lost) = quantise(&mesh);
        let mut parts = whole.clone();
        let view = options.view.fit(&mesh.positions, options.size, MARGIN);
        let mut look = Look {
            objects,
            surfaces: import::surfaces(&materials, &options.surface, options.ambient),
            background: options.background.into(),
            local_viewer: options.local_viewer,
            ..Look::new(options.surface, view)
        };
        if !options.lamps.is_empty() {
            look.lamps = options.lamps.iter().map(|&lamp| placed(lamp, &view)).collect();
        }
        let mut simplified = None;
        if let Some(most) = options.simplify {
            steps.begin("simplifying", parts.len());
            simplified = levels::simplify(&mesh, &mut parts, most, &|| steps.step()).with_context(place)?;
        }
        let errors = look.tolerances(&parts, &options.levels);
        steps.begin("searching levels of detail", parts.len() * errors.len());
        levels::add(&mesh, &mut parts, &errors, &|| steps.step()).with_context(place)?;
        Ok(Self { mesh, report, materials, faults, remarks, whole, parts, lost, look, simplified, painted, backs })
    }

    /// The largest simplified mesh, to within a 64th, for whose stream there is room; `None` if there is none. `whole_load` is the share of the room
    /// that the stream takes without simplification, and must be more than 1. `load` is the share of another stream.
    ///
    /// # Errors
    /// When `load` fails, or no stream can be made.
    pub fn largest(
        &self,
        options: &Options,
        (whole_load, load): (f64, &dyn Fn(StreamBytes) -> Result<f64>),
        steps: &dyn Steps,
    ) -> Result<Option<Largest>> {
        /// The load to aim at, a little less than all.
        const AIM: f64 = 1.0 - 1.0 / 256.0;
        const ENOUGH: f64 = 1.0 - 1.0 / 64.0;
        let (mut too_few, mut too_many) = (0, levels::count(&self.parts));
        let mut largest = None;
        // Loads are nearly linear in the number of triangles: the next number is where the line through the last two loads meets the aim.
        let mut last = [(0.0, 0.0), (too_many as f64, whole_load)];
        steps.begin("searching the largest mesh that fits", SEARCH);
        let mut expected = 0..SEARCH;
        while too_many - too_few > 1 + too_few / 64 {
            let [(first, first_load), (second, second_load)] = last;
            let guess = (first + (AIM - first_load) * (second - first) / (second_load - first_load)) as usize;
            let most = if guess > too_few && guess < too_many { guess } else { too_few.midpoint(too_many) };
            // Some meshes cannot be made of so few.
            let Ok(parts) = levels::reduced(&self.mesh, &self.whole, most) else {
                too_few = most;
                continue;
            };
            let mut with_levels = parts.clone();
            levels::add(&self.mesh, &mut with_levels, &self.look.tolerances(&parts, &options.levels), &|| ())?;
            let load = load(self.look.stream(&with_levels)?)?;
            last = [last[1], (most as f64, load)];
            if expected.next().is_some() {
                steps.step();
            }
            if load > 1.0 {
                too_many = most;
                continue;
            }
            too_few = most;
            largest = Some((most, parts));
            if load >= ENOUGH {
                break;
            }
        }
        let measured = |(most, parts): (usize, Vec<Part>)| {
            steps.begin("measuring how far it is from the whole mesh", self.whole.len());
            Largest { most, simplified: levels::estimate(&self.whole, &parts, &|| steps.step()), parts }
        };
        Ok(largest.map(measured))
    }

    /// The stream.
    ///
    /// # Errors
    /// When the mesh does not fit a stream, or a value lies outside its range.
    pub fn stream(&self) -> Result<StreamBytes> {
        self.look.stream(&self.parts)
    }
}

/// Simplified meshes that a search for the largest one looks at, as a rule.
const SEARCH: usize = 4;

/// The largest simplified mesh for which there is room.
#[derive(Clone, Debug)]
pub struct Largest {
    /// The number of triangles that it was asked to have at most.
    pub most: usize,
    /// The parts of the mesh, without levels of detail.
    pub parts: Vec<Part>,
    /// What simplification did.
    pub simplified: Simplified,
}

/// Level, of 1, below which a picture of few greys shows no form.
const READABLE: f64 = 0.25;

/// Whether a surface in full light, without its highlight, is too dark for the few greys of a format.
fn is_dark(surface: &Surface, format: Format) -> bool {
    let [r, g, b] = add(surface.ambient, surface.diffuse);
    format.has_few_greys() && 0.3 * r + 0.59 * g + 0.11 * b < READABLE
}

/// A near light counts from the centre of the mesh; in a stream it counts from the eye.
fn placed(lamp: Lamp, view: &View) -> Lamp {
    match lamp.kind {
        LampKind::Near => Lamp { vector: add(lamp.vector, view.translation), ..lamp },
        LampKind::Distant | LampKind::Sky => lamp,
    }
}
