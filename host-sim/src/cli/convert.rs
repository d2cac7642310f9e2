//! `microphong convert`.

use super::{
    Outcome, Usage,
    boards::{self, TooLarge},
    count::{self, Cost, Counter},
    features,
    mesh_options::{self, MeshOptions},
    meshes,
    outlines::OutlineOptions,
    parse,
    report::{self, Bars},
    room::{Picture, Remedy, Simplified},
    scenes,
};
use anyhow::{Context, Result, anyhow, bail};
use embedded_graphics_core::geometry::Size;
use microphong::{Stream, format::ErrorBudget, stream::record};
use microphong_render::board::Board;
use microphong_sim::{
    bytes::StreamBytes,
    convert::{Converted, Options, SQUARE},
    levels,
    mesh::Mesh,
    output,
    paint::Painted,
    program,
    quantise::{Part, quantise},
    render::{self, Format},
    scene::{self, Scene},
    shader::Shader,
};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Convert a model file (OBJ, glTF 2.0, STL, PLY, 3MF) to a stream, the mesh file of a program
///
/// Normals come from the file if at least half of the corners have one. Other normals are computed: light is smooth within each smoothing group of
/// the file. If there are no groups, light is smooth across edges that fold by no more than --crease. Polygons, also concave ones, are cut into
/// triangles. Materials come from the .mtl file beside an .obj file (Kd, Ks, Ka, Ke, Ns), or from the .gltf or .glb file (base colour, metallic,
/// roughness, emission). Of a glTF file the default scene is converted, where its nodes and skins put it. Of a 3MF file the items to be built are
/// converted. The command prints everything in the file that it ignores.
///
/// A model may name other files, such as materials and buffers. They are opened only if they are regular files in the folder of the model. A file may have
/// at most 1 GiB.
///
/// Each object of the file keeps its name, and a program can find it by this name. An object is an `o` of OBJ (or a `g`, if the file has at most one
/// `o`), a node of glTF, or a mesh of 3MF. An object has one mesh in the stream for each of its materials.
///
/// The mesh is centred and scaled to a sphere of radius 1. A single closed convex mesh is marked, so that it is drawn without depth test. This does not
/// change its picture.
///
/// A .toml file is a scripted scene: it describes objects, lights, the camera and their movements. Only --output, --board, --format, --count,
/// --antialias, --outlines, --outlines-alone and --json apply to it. Three examples are in tests/scenes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Model file to read.
    mesh: PathBuf,
    /// Stream file to write, or - for standard output. The default is the name of the model file with the ending .tri.
    #[arg(short, long, value_name = "FILE.tri")]
    output: Option<PathBuf>,
    /// Shading method that the stream names. The default is auto. The board lm3s6965evb has the methods of the core, the others also those of the
    /// literature.
    #[arg(long, value_parser = parse::Shaders)]
    shader: Option<Shader>,
    /// Board that shall draw the stream. The command fails if the firmware of this board cannot draw it, for example because it lacks the method or has
    /// no room for the materials.
    #[arg(long, value_name = "NAME", value_parser = Board::ALL.map(Board::name))]
    board: Option<String>,
    /// Pixel format of the display. The default is the format of --board, or else rgb565. In formats of one bit and of up to 16 greys a mesh without
    /// materials is white on black.
    #[arg(long, value_parser = parse::Formats)]
    format: Option<Format>,
    /// Count the instructions of a frame on each board, or on the board of --board, and print the frames per second if they are known. The boards are
    /// emulated; this needs a build with `--features boards`.
    #[arg(long)]
    count: bool,
    /// Error budget of auto and auto-linear: the largest difference of a pixel from Phong shading, in 1/255, from 0.5 to 16. By
    /// default the display decides: 1 if its channels have 8 bits, 4 if they have 5 or 6, and 8 if they have fewer.
    #[arg(long, value_name = "LSB", value_parser = parse::budget)]
    budget: Option<ErrorBudget>,
    /// Size of the picture that the mesh fills. By default the mesh fits the narrower side, so that the whole turn is visible on displays of every
    /// shape. With a wide size, a wide mesh becomes larger, but narrower displays cut off its sides.
    #[arg(long, value_name = "WxH", value_parser = parse::size)]
    size: Option<(u32, u32)>,
    /// Write what a program needs to find outlines (Renderer::set_antialias, Scene::set_outlines): the neighbours of triangles, 6 bytes for each
    /// triangle, and the pairs of triangles that cut each other, 12 bytes for each pair. --outlines implies it.
    #[arg(long)]
    antialias: bool,
    #[command(flatten)]
    outlines: OutlineOptions,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: Option<MeshOptions>,
}

impl Arguments {
    /// Adds lines along outlines to a stream, or the neighbours of triangles, if they are wanted.
    fn outlined(&self, stream: StreamBytes) -> Result<StreamBytes> {
        match self.outlines.wanted() {
            Some(outlines) => stream.with_outlines(outlines),
            None if self.antialias => stream.with_neighbours(),
            None => Ok(stream),
        }
    }
}

const EXAMPLES: &str = "\
Examples:
  microphong convert teapot.obj -o teapot.tri
  microphong convert bunny.obj --lod 240x240,128x128
  microphong convert part.obj --board lm3s6965evb
  microphong convert part.obj --board pico --count
  microphong convert scan.ply --simplify 2000
  microphong convert part.obj --outlines ffffff --outlines-alone --shader flat
  microphong convert part.obj --up z --colour 4080ff --plastic --exponent 60 --orbit 240
  microphong convert car.obj --light -0.5,0.6,0.7:fff0d8 --light 1,0.1,0.2:304060
  microphong convert toy.glb --light at:-1,1,2:fff0d8
  microphong convert tests/scenes/gauges.toml -o gauges.tri";

#[derive(Serialize)]
struct Line<'a> {
    mesh: &'a str,
    output: &'a str,
    meshes: usize,
    /// Each mesh, without its coarser levels.
    list: Vec<meshes::Row>,
    /// The saving by --merge, if objects have meshes of their own.
    by_object: Option<ByObject>,
    materials: usize,
    /// Colours at the corners of triangles and textures, before the mesh is simplified, if there are any.
    colours: Option<Painted>,
    /// Triangles that are backs of others, before the mesh is simplified.
    backs: usize,
    vertices: usize,
    triangles: usize,
    welded: usize,
    degenerate: usize,
    crossed: usize,
    own_normals: bool,
    turned: bool,
    /// Faces that were turned to agree with their neighbours, or in a closed part that was inside out.
    mended: usize,
    /// Corners whose normals were computed, although the others are those of the file.
    computed_normals: usize,
    /// Triangles to whose backs the normals of the file point.
    backward_normals: usize,
    open_edges: usize,
    opposed_edges: usize,
    /// Edges of more than two faces.
    crowded_edges: usize,
    closed_convex: bool,
    simplified: Option<Simplified>,
    levels: Vec<Level>,
    bytes: usize,
    layout: String,
    memory: usize,
    /// The pixel format of that memory.
    format: &'static str,
    /// Cargo features of the core that the program needs.
    features: Vec<&'static str>,
    /// Method of the program.
    shader: &'static str,
    /// Whether a common chip or the board of --board has room for the program.
    fits: bool,
    /// What makes it fit if not.
    remedy: Option<Remedy>,
    remarks: Vec<String>,
    /// Costs of frames, if they were counted.
    costs: Option<Vec<Cost>>,
}

/// The cost of meshes for each object.
#[derive(Serialize)]
struct ByObject {
    /// Number of meshes beyond one for each material.
    meshes: usize,
    /// Bytes of flash of these meshes.
    bytes: usize,
}

/// A coarser level of a mesh.
#[derive(Serialize)]
struct Level {
    mesh: usize,
    triangles: usize,
    error: f64,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let source = &arguments.mesh;
    if source.extension().is_some_and(|e| e.eq_ignore_ascii_case("tri")) {
        return Err(
            Usage(format!("{} is already a stream; name an .obj, .stl, .ply, .gltf, .glb, .3mf or .toml file", source.display())).into()
        );
    }
    let board = Board::ALL.into_iter().find(|board| arguments.board.as_deref() == Some(board.name()));
    let shader = arguments.shader.unwrap_or(Shader::AUTO);
    if let Some(has) = board.and_then(|board| boards::lacks(board, shader)) {
        return Err(Usage(format!("{has}: use one of them as --shader")).into());
    }
    let format = arguments.format.or(board.map(|board| board.format().of_pixels())).unwrap_or(Format::Rgb565);
    let options = mesh_options::or_default(arguments.options.as_ref(), format)?;
    let counter = arguments.count.then(|| count::prepare(arguments.board.as_deref())).transpose()?;
    let target = arguments.output.clone().unwrap_or_else(|| source.with_extension("tri"));
    if scene::is_script(source) {
        return convert_script(arguments, (board, format), &target, counter.as_ref());
    }
    let picture = Picture::new(arguments.size, board, format);
    let bars = Bars::default();
    let options = Options { size: arguments.size.unwrap_or(SQUARE), ..options };
    let mut converted = Converted::read(source, &options, &bars)?;
    converted.look.budget = arguments.budget;
    converted.look.shader = shader;
    let bytes = converted.stream().and_then(|bytes| arguments.outlined(bytes)).with_context(|| source.display().to_string())?;
    let stream = bytes.view()?;
    if let Some(board) = board
        && let Err(refused) = boards::check(board, &stream)
    {
        let load = |bytes: StreamBytes| Ok(boards::load(board, &arguments.outlined(bytes)?.parse()?));
        let is_too_large = refused.is::<TooLarge>();
        let remedy = if is_too_large {
            Remedy::search((&converted, &options), board.name(), (boards::load(board, &stream), &load), &bars)?
        } else {
            None
        };
        let refused = match remedy {
            Some(remedy) => anyhow!("{refused}; {}", remedy.text()),
            None => refused,
        };
        return Err(refused.context(source.display().to_string()));
    }
    let layout = picture.layout(&stream)?;
    let (chip, whole) = picture.roomiest(&stream, &layout)?;
    let fits = board.is_some() || whole <= 1.0;
    let load = |bytes: StreamBytes| {
        let bytes = arguments.outlined(bytes)?;
        let stream = bytes.parse()?;
        Ok(picture.roomiest(&stream, &picture.layout(&stream)?)?.1)
    };
    let remedy = if fits { None } else { Remedy::search((&converted, &options), chip.name, (whole, &load), &bars)? };
    drop(bars);
    let Converted { mesh, report, materials, mut remarks, whole, parts, lost, look, simplified, painted, backs, .. } = converted;
    if let (Some(most), None) = (options.simplify, &simplified) {
        remarks.push(format!("not simplified: the mesh has no more than {} triangles", report::grouped(most as u64)));
    }
    report::leave_to(&target);
    output::write(&target, bytes.as_bytes())?;
    remarks.extend(unseen(&stream, picture.size)?);
    let name = source.display().to_string();
    let line = Line {
        mesh: &source.to_string_lossy(),
        output: &target.to_string_lossy(),
        meshes: parts.len(),
        list: meshes::rows(&stream)?,
        by_object: by_object(mesh, &whole, stream.names.len()),
        materials: materials.iter().flatten().count() - painted.materials,
        colours: Some(painted).filter(Painted::has_any),
        backs,
        vertices: parts.iter().map(|p| p.vertices.len()).sum(),
        triangles: parts.iter().map(|p| p.triangles.len()).sum(),
        welded: report.welded,
        degenerate: report.degenerate + lost,
        crossed: report.crossed,
        own_normals: report.own_normals,
        turned: report.turned,
        mended: report.mended,
        computed_normals: report.computed_normals + report.missing_normals,
        backward_normals: report.backward_normals,
        open_edges: report.open_edges,
        opposed_edges: report.opposed_edges,
        crowded_edges: report.crowded_edges,
        closed_convex: parts.iter().all(|part| part.closed_convex),
        simplified: simplified.map(|simplified| Simplified::new(simplified, &look, &parts, &options.levels)),
        levels: parts.iter().enumerate().flat_map(|(mesh, part)| part.coarser.iter().map(move |level| of(mesh, level))).collect(),
        bytes: bytes.as_bytes().len(),
        layout: program::layout_text(&layout),
        memory: format.bytes(&layout)[0],
        format: format.name(),
        features: features::names(&stream, format),
        shader: shader.name(),
        fits,
        remedy,
        remarks,
        costs: counter.map(|counter| counter.count(&Scene { name, stream: bytes.clone(), size: picture.size })).transpose()?,
    };
    if arguments.json {
        report::json(&line)?;
    } else {
        let names: Vec<_> = materials.iter().map(|material| material.as_ref().map(|material| material.name.as_str())).collect();
        text(&line, &names)?;
    }
    Ok(Outcome::Done)
}

/// Meshes of these parts, and the bytes of meshes and vertices.
fn records(parts: &[Part]) -> [usize; 2] {
    let vertices: usize = parts.iter().map(|part| part.vertices.len()).sum();
    [parts.len(), parts.len() * size_of::<record::Mesh>() + vertices * size_of::<record::Vertex>()]
}

/// What --merge would spare of a mesh that has these parts before it is simplified.
fn by_object(mut mesh: Mesh, whole: &[Part], names: usize) -> Option<ByObject> {
    // Most large models have one object, and need not be rounded a second time.
    let first = mesh.submesh(0).object;
    if mesh.submeshes.iter().all(|submesh| submesh.object == first) {
        return None;
    }
    let [meshes, bytes] = records(whole);
    mesh.merge_objects();
    let [merged, fewer] = records(&quantise(&mesh).0);
    (meshes > merged).then(|| ByObject { meshes: meshes - merged, bytes: bytes - fewer + names })
}

/// What becomes of a scripted scene.
#[derive(Serialize)]
struct SceneLine<'a> {
    scene: &'a str,
    output: &'a str,
    objects: usize,
    meshes: usize,
    /// Each mesh.
    list: Vec<meshes::Row>,
    triangles: usize,
    frames: u16,
    bytes: usize,
    layout: String,
    memory: usize,
    /// The pixel format of that memory.
    format: &'static str,
    /// Cargo features of the core that the program needs.
    features: Vec<&'static str>,
    remarks: Vec<String>,
    /// Costs of frames, if they were counted.
    costs: Option<Vec<Cost>>,
}

/// Writes the stream of a scripted scene.
fn convert_script(
    arguments: &Arguments,
    (board, format): (Option<Board>, Format),
    target: &Path,
    counter: Option<&Counter>,
) -> Result<Outcome> {
    let own = [("--shader", arguments.shader.is_some()), ("--budget", arguments.budget.is_some()), ("--size", arguments.size.is_some())];
    if let Some((option, _)) = own.into_iter().find(|(_, given)| *given) {
        let field = &option[2..];
        return Err(Usage(format!(
            "{}: {option} is for model files; write `{field}` into the text of the scene instead",
            arguments.mesh.display()
        ))
        .into());
    }
    let mut scene = scenes::load(&arguments.mesh.to_string_lossy(), arguments.options.as_ref(), format)?;
    scene.stream = arguments.outlined(scene.stream)?;
    let stream = scene.stream.parse()?;
    if let Some(board) = board {
        if let Some(has) = boards::lacks(board, Shader::of(&stream)?) {
            bail!("{}: {has}: use one of them as `shader` in the text of the scene", arguments.mesh.display());
        }
        boards::check(board, &stream).with_context(|| arguments.mesh.display().to_string())?;
    }
    report::leave_to(target);
    output::write(target, scene.stream.as_bytes())?;
    let layout = Picture::new(board.is_none().then_some(scene.size), board, format).layout(&stream)?;
    let line = SceneLine {
        scene: &arguments.mesh.to_string_lossy(),
        output: &target.to_string_lossy(),
        objects: stream.instances.len(),
        meshes: stream.meshes.len(),
        list: meshes::rows(&stream)?,
        triangles: stream.triangles.len(),
        frames: stream.header.frames,
        bytes: scene.stream.as_bytes().len(),
        layout: program::layout_text(&layout),
        memory: format.bytes(&layout)[0],
        format: format.name(),
        features: features::names(&stream, format),
        remarks: unseen(&stream, scene.size)?.into_iter().collect(),
        costs: counter.map(|counter| counter.count(&scene)).transpose()?,
    };
    if arguments.json {
        report::json(&line)?;
        return Ok(Outcome::Done);
    }
    let count = |n: usize| report::grouped(n as u64);
    let SceneLine { scene, output, objects, meshes, list, triangles, frames, bytes, layout, memory, format, features, remarks, costs } =
        line;
    report::line(&format!(
        "{output}: {} of {} and {}, {}, from {scene}",
        report::counted(objects, ["object", "objects"]),
        report::counted(meshes, meshes::MESHES),
        report::counted(triangles, report::TRIANGLES),
        report::counted(frames, report::FRAMES)
    ))?;
    meshes::text(&list, &[], LISTED)?;
    report::line(&format!("  {} bytes of flash", count(bytes)))?;
    for remark in remarks {
        report::line(&format!("  {remark}"))?;
    }
    report::line(&format!("  {layout}, {} bytes of memory in {format}", count(memory)))?;
    report::line(ACTIVE)?;
    report::line(&format!("    {}", features::text(&features)))?;
    count::text(costs.as_deref())?;
    Ok(Outcome::Done)
}

/// The remark that no frame shows a pixel of the mesh.
fn unseen(stream: &Stream<'_>, (width, height): (u32, u32)) -> Result<Option<String>> {
    let is_seen = render::shows_a_pixel(stream, Size::new(width, height))?;
    Ok((!is_seen).then(|| {
        "no frame shows a pixel of the mesh: its faces point away from the viewer (use --flip), or it is thinner than a pixel".to_owned()
    }))
}

/// Largest number of lines for meshes.
const LISTED: usize = 20;

/// What `active_triangles` of a layout means.
const ACTIVE: &str = "    active_triangles: half as many again as the frames need, for other poses; with fewer, a frame takes longer";

/// Says at which edges the surface is not as that of a solid body is, and which normals do not fit it.
fn edges(line: &Line<'_>) -> Result<()> {
    let kinds = [
        (
            line.backward_normals,
            ["triangle has", "triangles have"],
            "normals of the file that point backwards; if the picture is inside out, use --flip, or else export the file without normals",
        ),
        (
            line.open_edges,
            ["edge has", "edges have"],
            if line.backs > 0 {
                "one face only: the surface is open"
            } else {
                "one face only: the surface is open, and backs of faces are not drawn; --two-sided draws them, and --flip turns it inside out"
            },
        ),
        (
            line.opposed_edges,
            ["edge has", "edges have"],
            "two faces that disagree about the front, however they are turned; split the surface there in a modelling program",
        ),
        (
            line.crowded_edges,
            ["edge has", "edges have"],
            "more than two faces; if the picture is wrong there, remove doubled and inner faces in a modelling program",
        ),
    ];
    for (count, words, text) in kinds.into_iter().filter(|(count, ..)| *count > 0) {
        report::line(&format!("  {} {text}", report::counted(count, words)))?;
    }
    Ok(())
}

fn of(mesh: usize, level: &levels::Level) -> Level {
    Level { mesh, triangles: level.triangles.len(), error: level.error.into() }
}

fn text(line: &Line<'_>, materials: &[Option<&str>]) -> Result<()> {
    let count = |n: usize| report::grouped(n as u64);
    let (vertices, triangles) = (report::counted(line.vertices, report::VERTICES), report::counted(line.triangles, report::TRIANGLES));
    report::line(&format!("{}: {vertices}, {triangles}, {} bytes", line.output, count(line.bytes)))?;
    let normals = if line.own_normals { "normals from the file" } else { "normals computed" };
    let turned = if line.turned { ", surface turned inside out" } else { "" };
    let (welded, degenerate) = (count(line.welded), count(line.degenerate));
    let convex = if line.closed_convex { ", closed and convex" } else { "" };
    report::line(&format!("  {welded} vertices welded, {degenerate} degenerate triangles removed, {normals}{turned}{convex}"))?;
    edges(line)?;
    match line.materials {
        0 => {}
        1 => report::line("  1 material from the file")?,
        several => report::line(&format!("  {} materials from the file", count(several)))?,
    }
    meshes::text(&line.list, materials, LISTED)?;
    if let Some(ByObject { meshes, bytes }) = line.by_object {
        let bytes = if line.simplified.is_some() { String::new() } else { format!("{} bytes of ", count(bytes)) };
        let meshes = report::counted(meshes, meshes::MESHES);
        report::line(&format!("  each object has separate meshes; --merge saves {meshes}, {bytes}flash and some time"))?;
    }
    for remark in &line.remarks {
        report::line(&format!("  {remark}"))?;
    }
    if let Some(simplified) = &line.simplified {
        report::line(&format!("  simplified from {} triangles: {}", count(simplified.before), simplified.text()))?;
    }
    for Level { triangles, error, .. } in &line.levels {
        report::line(&format!("  a level of detail of {} triangles, less than {error:.4} units from the mesh", count(*triangles)))?;
    }
    let memory = count(line.memory);
    report::line(&format!("  a program needs {memory} bytes of memory in {}, and a band of pixels:\n    {}", line.format, line.layout))?;
    report::line(ACTIVE)?;
    report::line(&format!("    {}", features::text(&line.features)))?;
    count::text(line.costs.as_deref())?;
    let crossed = match line.crossed {
        0 => None,
        1 => Some("1 polygon crosses itself; split it".to_owned()),
        several => Some(format!("{} polygons cross themselves; split them", count(several))),
    };
    if let Some(crossed) = crossed {
        report::line(&format!("  {crossed}, or check the picture"))?;
    }
    if !line.fits {
        let remedy = line.remedy.as_ref().map_or_else(String::new, |remedy| format!("; {}", remedy.text()));
        let (shader, format) = (line.shader, line.format);
        report::line(&format!("  no common chip has room for a program with it by {shader} in {format}{remedy}"))?;
    }
    Ok(())
}
