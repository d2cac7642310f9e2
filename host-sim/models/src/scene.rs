//! Scenes by name or from a file.

pub use crate::gallery::{GALLERY, LOW_POLY, ORDINARY};
use crate::{
    bytes::StreamBytes,
    convert::{COPPER, Converted, DISTANCE, MARGIN, ORBIT, Options, SQUARE, Steps},
    files::Files,
    foreign, gallery,
    look::{Lamp, Look, Surface},
    mesh::{self, Mesh, Weld},
    obj,
    quantise::quantise,
    script, shapes,
    vector::{V3, product, rotation},
    view::{Up, View},
};
use anyhow::{Context, Result};
use microphong::stream::record::OPEN;
use std::{f64::consts::TAU, fmt, path::Path};

/// Something to draw.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The built-in's name, or the file's without directory and ending.
    pub name: String,
    /// Mesh, materials, lights and camera.
    pub stream: StreamBytes,
    /// Width and height that suit it.
    pub size: (u32, u32),
}

impl Scene {
    /// The stream with the neighbours of its triangles, from which outlines are found; `None` if a mesh has too many triangles for that.
    ///
    /// # Errors
    /// When the stream is not valid.
    pub fn smooth(&self) -> Result<Option<StreamBytes>> {
        let stream = self.stream.parse()?;
        let has_room = stream.meshes.iter().all(|mesh| mesh.triangles <= u32::from(OPEN));
        if has_room { self.stream.with_neighbours().map(Some) } else { Ok(None) }
    }
}

/// Names of the built-in scenes.
pub const NAMES: [&str; 10] =
    ["teapot", "bunny", "sphere-168", "sphere-374", "sphere-690", "peer-sphere", "sphere-40", "dodecahedron", "torus", "triangle"];

/// The sphere that renderers have been compared by.
pub const PEER: &str = "peer-sphere";
/// `peer-sphere`, and marked as convex: drawn without depth.
pub const CONVEX: &str = "peer-sphere-convex";
/// `peer-sphere` in blue with a white highlight.
pub const PLASTIC: &str = "peer-sphere-plastic";
/// `peer-sphere-plastic` under two coloured lights.
pub const LIGHTS: &str = "peer-sphere-lights";

/// The sphere of `peer-sphere`, drawn otherwise. Not among [`NAMES`], for other scenes show as much.
pub const VARIANTS: [&str; 3] = [CONVEX, PLASTIC, LIGHTS];

/// Scenes of several objects that move, from their texts in `tests/scenes`.
pub const SCRIPTED: [&str; 3] = ["gauges", "board", "sensor"];

/// Ordinary scenes by which other renderers are compared: each has one material, and shaders of theirs are compiled for its lights.
pub const COMPARED: [&str; 6] = [PEER, PLASTIC, LIGHTS, "teapot", "torus", "bunny"];
/// Ordinary scenes of all kinds, by which costs are judged.
pub const PORTFOLIO: [&str; 9] = {
    let ([a, b, c, d, e, f], [g, h, i]) = (COMPARED, ORDINARY);
    [a, b, c, d, e, f, g, h, i]
};

/// The names of all built-in scenes.
pub fn all() -> impl Iterator<Item = &'static str> {
    NAMES.into_iter().chain(VARIANTS).chain(ORDINARY).chain(GALLERY).chain(SCRIPTED)
}

/// A description of a built-in scene; empty for other names.
#[must_use]
pub fn description(name: &str) -> &'static str {
    match name {
        "teapot" => "Utah teapot in copper, one key light",
        "bunny" => "Stanford bunny in porcelain, a warm key light and a weak blue fill light",
        "sphere-168" => "sphere of 168 triangles, parallel rays",
        "sphere-374" => "sphere of 374 triangles, parallel rays",
        "sphere-690" => "sphere of 690 triangles, parallel rays",
        PEER => "sphere of 720 triangles on 43,800 pixels, for comparison with other renderers",
        CONVEX => "peer-sphere, drawn without depth",
        PLASTIC => "peer-sphere in blue with a white highlight",
        LIGHTS => "peer-sphere in blue with a white highlight, under a warm and a cold light",
        "sphere-40" => "sphere of 40 triangles, near point light, local viewer",
        "dodecahedron" => "dodecahedron with a sphere's normals, near point light, local viewer",
        "torus" => "torus of 3,750 triangles, blue with a white highlight",
        "triangle" => "one bulged triangle, point light close in front",
        "gauges" => "three gauges whose needles move, 2 objects each",
        "board" => "a board with 11 pieces, one of which moves",
        "sensor" => "an object with the recorded orientation of a sensor, under a moving light",
        _ => gallery::description(name),
    }
}

/// A name that is neither a built-in scene nor a file.
#[derive(Debug)]
pub struct Unknown(String);

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "unknown scene {:?}; name a .tri, .obj, .stl, .ply, .gltf, .glb, .3mf or .toml file, or one of: {}, {}, {}, {}, {}",
            self.0,
            NAMES.join(", "),
            VARIANTS.join(", "),
            ORDINARY.join(", "),
            GALLERY.join(", "),
            SCRIPTED.join(", ")
        )
    }
}

impl std::error::Error for Unknown {}

/// Size for scenes from files.
pub const SIZE: (u32, u32) = (640, 480);
/// Blue, a little towards cyan.
const BLUE: V3 = [0.25, 0.5, 0.95];

const TEAPOT: &str = include_str!("../../../tests/meshes/teapot.obj");
const BUNNY: &str = include_str!("../../../tests/meshes/bunny.obj");

/// The text of a scripted scene.
fn scripted(name: &str) -> Option<&'static str> {
    match name {
        "gauges" => Some(include_str!("../../../tests/scenes/gauges.toml")),
        "board" => Some(include_str!("../../../tests/scenes/board.toml")),
        "sensor" => Some(include_str!("../../../tests/scenes/sensor.toml")),
        _ => None,
    }
}

/// Loads a built-in scene, a stream, a mesh or the text of a scripted scene. The ending of the name decides.
///
/// # Errors
/// [`Unknown`] if `name_or_path` is none of these, otherwise the fault of the file.
pub fn load(name_or_path: &str) -> Result<Scene> {
    load_with(name_or_path, &Options::default(), false, &())
}

/// Loads what [`load`] does, mesh files with these options. `are_given` says that a user has asked for some of them.
///
/// # Errors
/// [`Misplaced`] when options are given for what is no mesh file; else the errors of [`load`].
pub fn load_with(name_or_path: &str, options: &Options, are_given: bool, steps: &dyn Steps) -> Result<Scene> {
    load_from(&Files::OnDisk, name_or_path, options, are_given, steps)
}

/// Loads as [`load_with`] does; what is not built in is one of these files.
///
/// # Errors
/// Errors of [`load_with`].
pub fn load_from(files: &Files, name_or_path: &str, options: &Options, are_given: bool, steps: &dyn Steps) -> Result<Scene> {
    let fixed = |kind, remedy| if are_given { Err(Misplaced { name: name_or_path.to_owned(), kind, remedy }) } else { Ok(()) };
    let built_in = "a built-in scene";
    if NAMES.contains(&name_or_path) || VARIANTS.contains(&name_or_path) || gallery::Exhibit::named(name_or_path).is_some() {
        fixed(built_in, LEAVE_OUT)?;
        let (stream, size) = self::built_in(name_or_path)?;
        return Ok(Scene { name: name_or_path.to_owned(), stream, size });
    }
    if let Some(script) = scripted(name_or_path) {
        fixed(built_in, LEAVE_OUT)?;
        let (stream, size) = script::stream(script, None)?;
        return Ok(Scene { name: name_or_path.to_owned(), stream, size });
    }
    let path = Path::new(name_or_path);
    let ending = path.extension().map(|e| e.to_ascii_lowercase());
    let mut size = SIZE;
    // What is drawn is not what the file says.
    let warn = |fault: &str| steps.warn(&format!("{name_or_path}: {fault}"));
    let stream = match ending.as_deref().and_then(|e| e.to_str()) {
        Some("tri") => {
            fixed("a finished stream", "give them to `microphong convert`, which makes streams")?;
            StreamBytes::read_from(files, path)?
        }
        Some("toml") => {
            fixed("a scripted scene", "write them into its text")?;
            let scene = script::of_bytes(&files.read(path)?, path.parent().map(|folder| (files, folder)), &warn)
                .with_context(|| name_or_path.to_owned())?;
            size = scene.1;
            scene.0
        }
        Some("obj" | "stl" | "ply" | "gltf" | "glb" | "3mf") => {
            let converted = Converted::read_from(files, path, options, steps)?;
            converted.faults.iter().for_each(|fault| warn(fault));
            converted.stream().with_context(|| name_or_path.to_owned())?
        }
        _ => {
            if files.has(path) {
                foreign::refuse(path, &files.read(path)?)?;
                foreign::refuse_ending(path)?;
            }
            return Err(Unknown(name_or_path.to_owned()).into());
        }
    };
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    Ok(Scene { name, stream, size })
}

const LEAVE_OUT: &str = "leave them out";

/// Options for mesh files with a scene that is none.
#[derive(Debug)]
pub struct Misplaced {
    name: String,
    kind: &'static str,
    remedy: &'static str,
}

impl fmt::Display for Misplaced {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, kind, remedy } = self;
        write!(f, "{name} is {kind}, and options such as --up and --colour are for model files; {remedy}")
    }
}

impl std::error::Error for Misplaced {}

/// Whether a file is the text of a scripted scene, by its ending.
#[must_use]
pub fn is_script(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

fn welded(text: &str) -> Result<Mesh> {
    Ok(mesh::weld(&obj::parse(text)?.soup, Weld::SMOOTH)?.0)
}

fn built_in(name: &str) -> Result<(StreamBytes, (u32, u32))> {
    if let Some(exhibit) = gallery::Exhibit::named(name) {
        return exhibit.scene();
    }
    let (mesh, look, size) = match name {
        "teapot" => teapot()?,
        "bunny" => bunny()?,
        "sphere-168" => ball(12, 8),
        "sphere-374" => ball(17, 12),
        "sphere-690" => ball(23, 16),
        PEER | CONVEX => peer_sphere(Surface::metal([1.0; 3], PEER_SHARES, PEER_EXPONENT), &[[1.0; 3]]),
        PLASTIC => peer_sphere(Surface::plastic(BLUE, PEER_SHARES, PEER_EXPONENT), &[[1.0; 3]]),
        LIGHTS => peer_sphere(Surface::plastic(BLUE, PEER_SHARES, PEER_EXPONENT), &[[1.0, 0.92, 0.8], [0.3, 0.4, 0.6]]),
        "sphere-40" => (shapes::sphere(5, 5, 0.0), near_light([0.9, 0.92, 1.0], tilted(0.5, 0.35)), SQUARE),
        "dodecahedron" => (shapes::dodecahedron(), near_light([0.75, 1.0, 0.6], tilted(0.3, 0.2)), SQUARE),
        "torus" => torus(),
        "triangle" => triangle(),
        _ => return Err(Unknown(name.to_owned()).into()),
    };
    let (mut parts, _) = quantise(&mesh);
    if name.starts_with(PEER) && name != CONVEX {
        // The other renderers test depth.
        parts.iter_mut().for_each(|part| part.closed_convex = false);
    }
    Ok((look.stream(&parts)?, size))
}

type Parts = (Mesh, Look, (u32, u32));

fn teapot() -> Result<Parts> {
    let mesh = welded(TEAPOT)?;
    let view = View::orbit(Up::Y, 0.45, 0.3, DISTANCE, ORBIT).fit(&mesh.positions, SQUARE, MARGIN);
    let mut look = Look::new(Surface::metal(COPPER, [0.1, 0.52, 0.38], 30), view);
    // Low enough that the highlight lies on the belly, not on the lid alone.
    look.lamps = vec![Lamp::distant([-0.5, 0.28, -0.8], [1.0; 3])];
    Ok((mesh, look, SIZE))
}

fn bunny() -> Result<Parts> {
    let size = (480, 480);
    let mesh = welded(BUNNY)?;
    let view = View::orbit(Up::Y, 0.25, 0.15, DISTANCE, ORBIT).fit(&mesh.positions, size, MARGIN);
    let mut look = Look::new(Surface::plastic([0.92, 0.89, 0.84], [0.1, 0.68, 0.2], 24), view);
    look.lamps = vec![Lamp::distant([-0.5, 0.6, -0.6], [1.0, 0.95, 0.86]), Lamp::distant([0.9, 0.05, -0.25], [0.16, 0.24, 0.4])];
    Ok((mesh, look, size))
}

/// The spheres of Szirmay-Kalos's comparison.
fn ball(meridians: usize, bands: usize) -> Parts {
    let view = tilted(0.5, 0.35).parallel().focal(0.92);
    let mut look = Look::new(Surface::metal([1.0; 3], [0.08, 0.47, 0.45], 20), view);
    look.lamps = vec![Lamp::distant([-0.4, 0.5, -0.77], [1.0; 3])];
    (shapes::sphere(meridians, bands, 0.0), look, SQUARE)
}

/// Shares of ambient, diffuse and specular light, and exponent, of the scene that other renderers were measured with.
const PEER_SHARES: [f64; 3] = [0.1, 0.45, 0.45];
const PEER_EXPONENT: u16 = 50;
/// The first light is theirs, too.
const PEER_LIGHTS: [V3; 2] = [[0.394_055_24, 0.472_866_29, -0.788_110_48], [-0.8, 0.1, -0.6]];

/// The scene that other renderers were measured with: geometry and camera are theirs. Up to two lights have these colours.
fn peer_sphere(surface: Surface, colours: &[V3]) -> Parts {
    // Their pole is y, the first meridian 0.3 from z towards x; the pole then leans to the eye by 0.55.
    let pole_up = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let lean = rotation([1.0, 0.0, 0.0], 0.55);
    let mesh = shapes::turned(shapes::sphere(24, 16, 0.3), &product(&lean, &pole_up));
    let mut view = View::orbit(Up::Y, 0.0, 0.0, 3.0, ORBIT).focal(2.8);
    view.near = 1.75;
    let mut look = Look::new(surface, view);
    look.lamps = PEER_LIGHTS.iter().zip(colours).map(|(&towards, &colour)| Lamp::distant(towards, colour)).collect();
    (mesh, look, (320, 240))
}

fn near_light(colour: V3, view: View) -> Look {
    let mut look = Look::new(Surface::metal(colour, [0.08, 0.47, 0.45], 20), view.focal(3.5));
    look.lamps = vec![Lamp::near([-0.9, 1.0, DISTANCE - 2.0], [1.0; 3])];
    look.local_viewer = true;
    look
}

fn torus() -> Parts {
    let size = (320, 320);
    let mesh = shapes::torus(75, 25);
    let view = tilted(0.7, 0.4).parallel().fit(&mesh.positions, size, MARGIN);
    let mut look = Look::new(Surface::plastic(BLUE, [0.12, 0.75, 0.45], 20), view);
    look.lamps = vec![Lamp::distant([-0.4, 0.5, -0.77], [1.0; 3])];
    (mesh, look, size)
}

/// Turns about the line of sight: it has no back to show.
fn triangle() -> Parts {
    let upright = rotation([0.0, 1.0, 0.0], 0.0);
    let view = View::facing(upright, 3.0, [0.0, 0.0, 1.0], ORBIT);
    let mesh = shapes::bulged_triangle();
    let view = view.fit(&mesh.positions, SQUARE, MARGIN);
    let mut look = Look::new(Surface::metal([1.0; 3], [0.06, 0.44, 0.5], 20), view);
    look.lamps = vec![Lamp::near([0.1, -0.15, 2.0], [1.0; 3])];
    look.local_viewer = true;
    (mesh, look, SQUARE)
}

/// Turned about the vertical by `turn`, then towards the eye by `tilt`.
fn tilted(tilt: f64, turn: f64) -> View {
    let rows = product(&rotation([1.0, 0.0, 0.0], tilt), &rotation([0.0, 1.0, 0.0], turn % TAU));
    View::facing(rows, DISTANCE, [0.0, 1.0, 0.0], ORBIT)
}
