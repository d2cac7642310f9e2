//! `microphong inspect`.

use super::{Outcome, features, mesh_options::MeshOptions, meshes, report, scenes};
use anyhow::{Context, Result};
use embedded_graphics_core::geometry::Size;
use microphong::{
    MAX_SIDE, Outlines, Stream,
    format::{Length, NormalLength, Unit},
    geometry::detail::stream_tolerance,
    stream::record::{
        CAMERA_TRACK, CLOSED_CONVEX, EYE_SPACE, Header, LIGHT_TRACK, Light, Mesh, OBJECT_TRACK, PERSPECTIVE, POINT, SKY, Triangle,
        VIEWER_LOCAL,
    },
};
use microphong_sim::{bytes::StreamBytes, render::Format, scene::Unknown, shader::Shader};
use serde::Serialize;
use std::path::Path;

/// Show the contents of a stream, and the flash that it takes
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  microphong inspect teapot.tri --json\n  microphong inspect gauges\n  microphong inspect scan.ply --simplify 2000"
)]
pub(crate) struct Arguments {
    /// A stream from `microphong convert`, a built-in scene, or an .obj, .stl, .ply, .gltf, .glb, .3mf or .toml file.
    scene: String,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: Option<MeshOptions>,
}

#[derive(Serialize)]
struct Line<'a> {
    file: &'a str,
    version: u16,
    meshes: usize,
    /// Each mesh, without its coarser levels.
    list: Vec<meshes::Row>,
    closed_convex: usize,
    vertices: usize,
    triangles: usize,
    lights: usize,
    frames: u16,
    objects: usize,
    keys: usize,
    labels: usize,
    textures: usize,
    texels: usize,
    /// Triangles that have a texture, with those of coarser levels.
    texture_corners: usize,
    /// Lines along outlines.
    outlines: Option<Lines>,
    levels: Vec<Level>,
    bytes: u32,
    /// Cargo features of the core that a program needs for it, in `Rgb565`.
    features: Vec<&'static str>,
}

/// Lines along outlines.
#[derive(Serialize)]
struct Lines {
    /// RRGGBB.
    colour: String,
    alone: bool,
}

impl Lines {
    fn of(stream: &Stream<'_>) -> Option<Self> {
        let Outlines { colour: [r, g, b], alone, .. } = Outlines::of(stream.header)?;
        Some(Self { colour: format!("{r:02x}{g:02x}{b:02x}"), alone })
    }
}

/// A coarser level of a mesh.
#[derive(Serialize)]
struct Level {
    /// Number of the mesh, counted without coarser levels.
    mesh: usize,
    triangles: u32,
    /// Largest distance from the mesh, in units of object space.
    error: f64,
    /// Side of the largest square picture that draws this level, in pixels.
    side: u32,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let file = &arguments.scene;
    let bytes = read(file, arguments.options.as_ref())?;
    let stream = bytes.parse().with_context(|| file.clone())?;
    let list = meshes::rows(&stream).with_context(|| file.clone())?;
    let header = stream.header;
    if arguments.json {
        report::json(&Line {
            file,
            version: header.version,
            meshes: stream.meshes.len(),
            list,
            closed_convex: closed_convex(&stream),
            vertices: stream.vertices.len(),
            triangles: stream.triangles.len(),
            lights: stream.lights.len(),
            frames: header.frames,
            objects: stream.instances.len().max(1),
            keys: stream.keys.len(),
            labels: stream.labels.len(),
            textures: stream.textures().list.len(),
            texels: stream.textures().texels.len(),
            texture_corners: stream.textures().corners.len(),
            outlines: Lines::of(&stream),
            levels: levels(&stream),
            bytes: header.length,
            features: features::names(&stream, Format::Rgb565),
        })?;
    } else {
        text(file, &stream, &list)?;
    }
    Ok(Outcome::Done)
}

/// The stream of a scene; of a file with any other ending, what is in it.
fn read(name: &str, options: Option<&MeshOptions>) -> Result<StreamBytes> {
    match scenes::load(name, options, Format::Rgb565) {
        Err(error) if error.is::<Unknown>() && Path::new(name).exists() => StreamBytes::read(Path::new(name)),
        scene => Ok(scene?.stream),
    }
}

fn text(file: &str, stream: &Stream<'_>, list: &[meshes::Row]) -> Result<()> {
    let header = stream.header;
    let count = |n: usize| report::grouped(n as u64);
    report::line(&format!("{file}: triangle stream, version {}, {} bytes of flash", header.version, count(header.length as usize)))?;
    let row = |name: &str, number: usize, bytes: usize, note: &str| {
        report::line(format!("  {:>7} {name:9} {:>9} bytes  {note}", count(number), count(bytes)).trim_end())
    };
    row("header", 1, size_of::<Header>(), "")?;
    row("meshes", stream.meshes.len(), size_of_val(stream.meshes), &format!("{} closed and convex", closed_convex(stream)))?;
    row("materials", stream.materials.len(), size_of_val(stream.materials), &exponents(stream))?;
    row("lights", stream.lights.len(), size_of_val(stream.lights), &lights(stream))?;
    if !stream.instances.is_empty() {
        row("objects", stream.instances.len(), size_of_val(stream.instances), "")?;
        row("tracks", stream.tracks.len(), size_of_val(stream.tracks), "")?;
        row("keys", stream.keys.len(), size_of_val(stream.keys), &moving(stream))?;
    }
    if !stream.cuts.is_empty() {
        row("cuts", stream.cuts.len(), size_of_val(stream.cuts), "pairs of triangles that cut each other")?;
    }
    row("vertices", stream.vertices.len(), size_of_val(stream.vertices), "")?;
    row("triangles", stream.triangles.len(), size_of_val(stream.triangles), &bend(stream))?;
    if !stream.neighbours.is_empty() {
        row("neighbours", stream.neighbours.len(), size_of_val(stream.neighbours), "")?;
    }
    if !stream.colours.is_empty() {
        row("colours", stream.colours.len(), size_of_val(stream.colours), "the palettes of all meshes and textures")?;
    }
    if !stream.corner_colours.is_empty() {
        row("corners", stream.corner_colours.len(), size_of_val(stream.corner_colours), "triangles with the colours at their corners")?;
    }
    if !stream.textures().list.is_empty() {
        row("textures", stream.textures().list.len(), size_of_val(stream.textures().list), "")?;
        row("texels", stream.textures().texels.len(), stream.textures().texels.len(), "")?;
        row(
            "places",
            stream.textures().corners.len(),
            size_of_val(stream.textures().corners),
            "triangles with the places of their corners in a texture",
        )?;
    }
    if !stream.labels.is_empty() {
        row("labels", stream.labels.len(), size_of_val(stream.labels), &labels(stream))?;
    }
    if !stream.names.is_empty() {
        row("names", stream.names().count(), stream.names.len(), "")?;
    }
    meshes::text(list, &[], usize::MAX)?;
    for Level { triangles, error, side, .. } in levels(stream) {
        let (triangles, flash) = (count(triangles as usize), count(triangles as usize * size_of::<Triangle>()));
        report::line(&format!(
            "  a level of detail of {triangles} triangles, {flash} bytes, {error:.4} units from the mesh: for pictures of up to {side}x{side}"
        ))?;
    }
    let camera = &header.camera;
    let kind = if camera.projection == PERSPECTIVE { "perspective" } else { "parallel rays" };
    let orbit = if camera.period == 0 { "stands still".to_owned() } else { format!("one turn in {} frames", camera.period) };
    let viewer = if header.camera.viewer == VIEWER_LOCAL { "local" } else { "infinite" };
    let frames = report::counted(header.frames, report::FRAMES);
    let shader = Shader::by_id(header.shader).map_or_else(|| format!("number {}", header.shader), |shader| shader.name().to_owned());
    report::line(&format!("  {}", features::text(&features::names(stream, Format::Rgb565))))?;
    if let Some(Lines { colour, alone }) = Lines::of(stream) {
        let place = if alone { "on the background, without the surfaces" } else { "over the surfaces" };
        report::line(&format!("  lines of the colour {colour} along outlines, {place}"))?;
    }
    report::line(&format!("  {kind}, {viewer} viewer, {orbit}, {frames}, shader {shader}"))
}

fn levels(stream: &Stream<'_>) -> Vec<Level> {
    let mut meshes = 0usize;
    let level = |record: &Mesh| {
        meshes += usize::from(record.error == 0);
        let is_drawn = |&side: &u32| stream_tolerance(stream.header, Size::new(side, side)) >= record.error();
        let side = (1..=MAX_SIDE).rev().find(is_drawn).unwrap_or(0);
        (record.error > 0).then_some(Level {
            mesh: meshes.saturating_sub(1),
            triangles: record.triangles,
            error: record.error().into(),
            side,
        })
    };
    stream.meshes.iter().filter_map(level).collect()
}

fn closed_convex(stream: &Stream<'_>) -> usize {
    stream.meshes.iter().filter(|mesh| mesh.flags & CLOSED_CONVEX != 0).count()
}

/// How much of a scene moves.
fn moving(stream: &Stream<'_>) -> String {
    let of = |kind| stream.tracks.iter().filter(|track| track.kind == kind && track.keys > 1).count();
    let camera = if of(CAMERA_TRACK) > 0 { "the camera moves" } else { "the camera stands still" };
    let (objects, lights) =
        (report::counted(of(OBJECT_TRACK), ["object", "objects"]), report::counted(of(LIGHT_TRACK), ["light", "lights"]));
    format!("{objects} and {lights} move, {camera}")
}

/// The texts of a scene.
fn labels(stream: &Stream<'_>) -> String {
    stream.labels.iter().map(|label| label.characters().collect::<String>()).collect::<Vec<_>>().join(", ")
}

fn exponents(stream: &Stream<'_>) -> String {
    let all: Vec<_> = stream.materials.iter().map(|m| m.exponent.to_string()).collect();
    format!("exponent {}", all.join(", "))
}

fn lights(stream: &Stream<'_>) -> String {
    let kind = |light: &Light| {
        let [x, y, z] = light.vector.map(|c| f64::from(Length::from_bits(c)));
        let kind = match light.kind {
            POINT => "at",
            SKY => "sky towards",
            _ => "towards",
        };
        // Eye space has z away from the viewer; a user never sees it.
        let (z, place) = if light.space == EYE_SPACE { (0.0 - z, "as the camera sees it") } else { (z, "in the world") };
        let range = if light.range > 0 { format!(", ends at a distance of {:.2}", light.range()) } else { String::new() };
        let [edge, full] = light.cone.map(|cosine| f64::from(Unit::from_bits(cosine)).acos().to_degrees());
        let [to_x, to_y, to_z] = light.axis.map(|c| f64::from(Unit::from_bits(c)));
        let to_z = if light.space == EYE_SPACE { 0.0 - to_z } else { to_z };
        let shines = format!(", shines ({to_x:.2}, {to_y:.2}, {to_z:.2}) in a cone of {full:.0} to {edge:.0} degrees");
        let cone = if light.axis == [0; 3] { "" } else { &shines };
        format!("{kind} ({x:.2}, {y:.2}, {z:.2}) {place}{range}{cone}")
    };
    stream.lights.iter().map(kind).collect::<Vec<_>>().join("; ")
}

/// How strongly normals vary within a triangle, as the smallest length of an interpolated normal. Short ones are hard to shade.
fn bend(stream: &Stream<'_>) -> String {
    let least = stream.triangles.iter().map(|triangle| triangle.min_normal_length).min().unwrap_or_default();
    let least = NormalLength::from_bits(least);
    format!("interpolated normals at least {least:.3} long")
}
