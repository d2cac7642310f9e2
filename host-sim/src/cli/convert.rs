//! `microphong convert`.

use super::{
    Outcome, Usage,
    count::{self, Cost, Counter},
    meshes, parse, report,
};
use anyhow::{Context, Result, bail};
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use microphong::{
    Layout, Stream,
    format::{ErrorBudget, GeometricError, MAX_LIGHTS},
    stream::record,
};
use microphong_sim::{
    import::{self, Imported},
    levels,
    look::{BACKGROUND, Lamp, Look, Surface},
    mesh::{CREASE, Mesh, Weld},
    output,
    quantise::{Part, quantise},
    render,
    scene::{self, AMBIENT, COPPER, DISTANCE, MARGIN, ORBIT, SQUARE},
    shader::Shader,
    vector::{V3, add},
    view::{Projection, Up, View},
};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Convert a mesh to a stream for a board's flash: Wavefront OBJ, glTF 2.0, STL or PLY
///
/// Normals come from the file if every corner has one. Otherwise they are computed: light is smooth within the file's smoothing groups, or without
/// groups over edges that fold by no more than --crease. Polygons are cut into triangles, concave ones as well. Materials come from the .mtl file
/// beside an .obj file (Kd, Ks, Ka, Ns), or from the .gltf or .glb file (base colour, metallic, roughness). Of glTF the default scene is converted,
/// with the transformations of its nodes. The output names everything in the files that is left out.
///
/// Each object of the file keeps its name, by which a program finds it. Objects are o of OBJ (g in a file with at most one o), and the nodes of glTF.
/// An object has one mesh in the stream for each of its materials.
///
/// The mesh is centred and scaled to a sphere of radius 1. A single closed convex mesh is marked, so that it is drawn without depth test. Its picture
/// is the same.
///
/// A .toml file is a scripted scene: a text that describes objects, lights, the camera and their movements. Only --output, --board, --count and
/// --json apply to it. Three examples are in tests/scenes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Mesh file to read.
    mesh: PathBuf,
    /// Stream file to write. By default the name of the mesh file with .tri.
    #[arg(short, long, value_name = "FILE.tri")]
    output: Option<PathBuf>,
    /// Axis of the mesh that points up: x, y, z, -x, -y or -z.
    #[arg(long, default_value = "y", value_parser = parse::up, allow_hyphen_values = true)]
    up: Up,
    /// Turn the surface inside out, for meshes whose faces wind clockwise. Closed meshes are turned without this option.
    #[arg(long)]
    flip: bool,
    /// Largest angle in degrees at which an edge looks smooth, for files without normals and smoothing groups: 0 shows all facets, 180 none.
    #[arg(long, value_name = "DEGREES", default_value_t = CREASE, value_parser = parse::crease)]
    crease: f64,
    /// Shading method that the stream asks for. By default auto, or auto-linear if the board of --board lacks auto. The board lm3s6965evb has flat,
    /// gouraud and auto-linear, the others have all.
    #[arg(long, value_parser = parse::Shaders)]
    shader: Option<Shader>,
    /// Board whose firmware shall draw the stream. A method that this firmware lacks is refused.
    #[arg(long, value_name = "NAME", value_parser = BOARDS.map(|(board, _)| board))]
    board: Option<String>,
    /// Count a frame on each board, or on the board of --board, and print instructions, and frames per second where time is modelled. Boards are
    /// emulated, which needs a build with `--features boards`.
    #[arg(long)]
    count: bool,
    /// Error budget of auto and auto-linear: the largest error of a pixel against Phong shading, in 1/255, from 0.5 to 16.
    #[arg(long, value_name = "LSB", default_value = "1", value_parser = parse::budget)]
    budget: ErrorBudget,
    /// Merge all objects into one without a name: one mesh for each material. It takes less flash.
    #[arg(long)]
    merge: bool,
    /// Colour of the whole surface, RRGGBB, instead of the file's materials. Without materials the default is copper.
    #[arg(long, visible_alias = "color", value_name = "RRGGBB", value_parser = parse::colour)]
    colour: Option<V3>,
    /// Diffuse reflection of materials that the file does not define, 0 to 2.
    #[arg(long, default_value = "0.5", value_parser = parse::share)]
    diffuse: f64,
    /// Strength of the highlight of materials that the file does not define, 0 to 2.
    #[arg(long, default_value = "0.4", value_parser = parse::share)]
    specular: f64,
    /// Ambient light, which comes from all sides, 0 to 2.
    #[arg(long, default_value_t = AMBIENT, value_parser = parse::share)]
    ambient: f64,
    /// Exponent of the highlight of materials that the file does not define, 1 to 1024. Larger ones are smaller and sharper.
    #[arg(long, default_value = "30", value_parser = clap::value_parser!(u16).range(1..=1024))]
    exponent: u16,
    /// A light in the direction X,Y,Z: x to the right, y up, z towards the eye. White unless a colour follows. With at: it is a near light at the
    /// position X,Y,Z from the centre of the mesh, whose radius is 1; near lights take longer. Repeat the option for up to eight lights. By default
    /// one light comes from the upper left.
    #[arg(long = "light", value_name = "[at:]X,Y,Z[:RRGGBB]", value_parser = parse::light, allow_hyphen_values = true)]
    lights: Vec<Lamp>,
    /// White highlights, as of plastic, instead of coloured ones, as of metal.
    #[arg(long)]
    plastic: bool,
    /// Background colour, RRGGBB.
    #[arg(long, value_name = "RRGGBB", value_parser = parse::bytes)]
    background: Option<[u8; 3]>,
    /// Number of frames of one turn of the camera around the axis that points up; 0 for a camera that stands still.
    #[arg(long, value_name = "FRAMES", default_value_t = ORBIT)]
    orbit: u16,
    /// Position of the camera, in degrees to the right of the front.
    #[arg(long, value_name = "DEGREES", default_value = "28.6", value_parser = parse::degrees, allow_negative_numbers = true)]
    azimuth: f64,
    /// Position of the camera, in degrees above the horizon.
    #[arg(long, value_name = "DEGREES", default_value = "20", value_parser = parse::degrees, allow_negative_numbers = true)]
    elevation: f64,
    /// Projection: perspective or parallel.
    #[arg(long, default_value = "perspective", value_parser = parse::projection)]
    projection: Projection,
    /// Compute highlights with the direction from each point to the eye, instead of one direction for all points. This takes longer.
    #[arg(long)]
    local_viewer: bool,
    /// Picture to fill with the mesh. By default the whole turn is seen on displays of every shape, because the mesh fits the narrower side. A
    /// picture that is wider than high can show a wide mesh larger, but narrower displays then cut its sides off.
    #[arg(long, value_name = "WxH", value_parser = parse::size)]
    size: Option<(u32, u32)>,
    /// Reduce the mesh to this number of triangles, or fewer, on some of its vertices. The output says how far the result is from the mesh of the file. Levels of
    /// --lod are made from the result.
    #[arg(long, value_name = "TRIANGLES", value_parser = clap::value_parser!(u32).range(1..))]
    simplify: Option<u32>,
    /// Sizes of pictures for which to make a level of detail: the fewest triangles that lie less than half a pixel from the mesh in this picture. A
    /// picture shows the coarsest level that fits it. Each triangle of a level takes 30 bytes of flash. A level that saves less than a tenth of the
    /// triangles is left out.
    #[arg(long, value_name = "WxH,...", value_delimiter = ',', value_parser = parse::size)]
    lod: Vec<(u32, u32)>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// The boards that there is firmware for, and their methods. A build without emulators knows them as well.
const BOARDS: [(&str, &[Shader]); 4] =
    [("pico", &Shader::ALL), ("lm3s6965evb", &Shader::SMALLEST_BOARD), ("mps2-an385", &Shader::ALL), ("mps2-an386", &Shader::ALL)];

const EXAMPLES: &str = "\
Examples:
  microphong convert teapot.obj -o teapot.tri
  microphong convert bunny.obj --lod 240x240,128x128
  microphong convert part.obj --board lm3s6965evb
  microphong convert part.obj --board pico --count
  microphong convert scan.ply --simplify 2000
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
    vertices: usize,
    triangles: usize,
    welded: usize,
    degenerate: usize,
    crossed: usize,
    own_normals: bool,
    turned: bool,
    closed_convex: bool,
    simplified: Option<Simplified>,
    levels: Vec<Level>,
    bytes: usize,
    layout: String,
    memory: usize,
    remarks: Vec<String>,
    /// Costs of frames, if they were counted.
    costs: Option<Vec<Cost>>,
}

/// Result of --simplify.
#[derive(Serialize)]
struct Simplified {
    before: usize,
    error: f64,
    /// The error in pixels, at most, in a picture of this size.
    pixels: f64,
    size: (u32, u32),
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
        return Err(Usage(format!("{} is a stream already; name an .obj, .stl, .ply, .gltf, .glb or .toml file", source.display())).into());
    }
    let shader = arguments.shader.unwrap_or(if lacking(arguments, Shader::AUTO).is_some() { Shader::AUTO_LINEAR } else { Shader::AUTO });
    if let Some(has) = lacking(arguments, shader) {
        return Err(Usage(format!("{has}: name one of them by --shader")).into());
    }
    if arguments.lights.len() > MAX_LIGHTS {
        return Err(Usage(format!("{} times --light; a scene has {MAX_LIGHTS} lights at most", arguments.lights.len())).into());
    }
    let counter = arguments.count.then(|| count::prepare(arguments.board.as_deref())).transpose()?;
    let target = arguments.output.clone().unwrap_or_else(|| source.with_extension("tri"));
    let same = |path: &std::path::Path| path.canonicalize().ok();
    if same(&target).is_some_and(|target| Some(target) == same(source)) {
        return Err(Usage(format!("{} would overwrite the mesh; name another file with -o", target.display())).into());
    }
    if scene::is_script(source) {
        return convert_script(arguments, &target, counter.as_ref());
    }
    let Imported { mut mesh, report, mut objects, mut materials, mut remarks } =
        import::file(source, Weld { turn: arguments.flip, crease: arguments.crease })?;
    if arguments.colour.is_some() && materials.iter().any(Option::is_some) {
        remarks.push(format!("--colour replaces {} materials of the file", materials.iter().flatten().count()));
        mesh.merge_materials();
        materials = vec![None];
    }
    if arguments.merge {
        mesh.merge_objects();
        objects.clear();
    }
    let (mut parts, lost) = quantise(&mesh);
    let records = records(&parts);
    let place = || source.display().to_string();
    let view = View::orbit(arguments.up, arguments.azimuth.to_radians(), arguments.elevation.to_radians(), DISTANCE, arguments.orbit);
    let view = if arguments.projection == Projection::Orthographic { view.parallel() } else { view };
    let of_arguments = surface(arguments);
    let look = Look {
        objects,
        surfaces: import::surfaces(&materials, &of_arguments, arguments.ambient),
        background: arguments.background.unwrap_or(BACKGROUND).into(),
        local_viewer: arguments.local_viewer,
        budget: arguments.budget,
        shader,
        ..Look::new(of_arguments, view.fit(&mesh.positions, arguments.size.unwrap_or(SQUARE), MARGIN))
    };
    let look = if arguments.lights.is_empty() { look } else { Look { lamps: placed(&arguments.lights, &look.view), ..look } };
    let simplified = match arguments.simplify.map(|most| most as usize) {
        None => None,
        Some(most) => {
            let bar = report::progress(parts.len() as u64, "simplifying");
            let simplified = levels::simplify(&mesh, &mut parts, most, &|| bar.inc(1)).with_context(place)?;
            bar.finish_and_clear();
            if simplified.is_none() {
                remarks.push(format!("not simplified: it has no more than {} triangles", report::grouped(most as u64)));
            }
            simplified.map(|simplified| in_pixels(simplified, &look, &parts, &arguments.lod))
        }
    };
    let errors: Vec<_> = arguments.lod.iter().map(|&size| look.tolerance(&parts, size)).collect();
    // The stream is a step as well, so that a single level has a bar.
    let bar = report::progress((parts.len() * errors.len()) as u64 + 1, "searching levels of detail");
    levels::add(&mesh, &mut parts, &errors, &|| bar.inc(1)).with_context(place)?;
    bar.finish_and_clear();
    let bytes = look.stream(&parts).with_context(place)?;
    report::leave_to(&target);
    output::write(&target, bytes.as_bytes())?;
    let stream = bytes.parse()?;
    let size = arguments.size.unwrap_or(USUAL);
    remarks.extend(unseen(&stream, size)?);
    let layout = Layout::new(size.0 as usize, ROWS).with_room_for(&stream);
    let line = Line {
        mesh: &source.to_string_lossy(),
        output: &target.to_string_lossy(),
        meshes: parts.len(),
        list: meshes::rows(&stream)?,
        by_object: by_object(mesh, records, stream.names.len()),
        materials: materials.iter().flatten().count(),
        vertices: parts.iter().map(|p| p.vertices.len()).sum(),
        triangles: parts.iter().map(|p| p.triangles.len()).sum(),
        welded: report.welded,
        degenerate: report.degenerate + lost,
        crossed: report.crossed,
        own_normals: report.own_normals,
        turned: report.turned,
        closed_convex: parts.iter().all(|part| part.closed_convex),
        simplified,
        levels: parts.iter().enumerate().flat_map(|(mesh, part)| part.coarser.iter().map(move |level| of(mesh, level))).collect(),
        bytes: bytes.as_bytes().len(),
        layout: text_of(&layout),
        memory: layout.bytes::<Rgb565>(),
        remarks,
        costs: counter.map(|counter| counter.count(&target.to_string_lossy())).transpose()?,
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

/// The saving by --merge for a mesh with these records, before it is simplified.
fn by_object(mut mesh: Mesh, [meshes, bytes]: [usize; 2], names: usize) -> Option<ByObject> {
    mesh.merge_objects();
    let [merged, fewer] = records(&quantise(&mesh).0);
    (meshes > merged).then(|| ByObject { meshes: meshes - merged, bytes: bytes - fewer + names })
}

/// The methods of the board that is asked for, if it lacks the method `shader`.
fn lacking(arguments: &Arguments, shader: Shader) -> Option<String> {
    let (board, has) = BOARDS.into_iter().find(|(board, _)| arguments.board.as_deref() == Some(*board))?;
    let names: Vec<_> = has.iter().map(|shader| shader.name()).collect();
    (!has.contains(&shader)).then(|| format!("the firmware of {board} has no {}; it has {}", shader.name(), names.join(", ")))
}

/// Output for a scripted scene.
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
    remarks: Vec<String>,
    /// Costs of frames, if they were counted.
    costs: Option<Vec<Cost>>,
}

/// Writes the stream of a scripted scene.
fn convert_script(arguments: &Arguments, target: &Path, counter: Option<&Counter>) -> Result<Outcome> {
    let scene = scene::load(&arguments.mesh.to_string_lossy())?;
    if let Some(has) = lacking(arguments, Shader::of(&scene.stream.parse()?)?) {
        bail!("{}: {has}: name one of them as `shader` in its text", arguments.mesh.display());
    }
    report::leave_to(target);
    output::write(target, scene.stream.as_bytes())?;
    let stream = scene.stream.parse()?;
    let layout = Layout::new(scene.size.0 as usize, ROWS).with_room_for(&stream);
    let line = SceneLine {
        scene: &arguments.mesh.to_string_lossy(),
        output: &target.to_string_lossy(),
        objects: stream.instances.len(),
        meshes: stream.meshes.len(),
        list: meshes::rows(&stream)?,
        triangles: stream.triangles.len(),
        frames: stream.header.frames,
        bytes: scene.stream.as_bytes().len(),
        layout: text_of(&layout),
        memory: layout.bytes::<Rgb565>(),
        remarks: unseen(&stream, scene.size)?.into_iter().collect(),
        costs: counter.map(|counter| counter.count(&target.to_string_lossy())).transpose()?,
    };
    if arguments.json {
        report::json(&line)?;
        return Ok(Outcome::Done);
    }
    let count = |n: usize| report::grouped(n as u64);
    let SceneLine { scene, output, objects, meshes, list, triangles, frames, bytes, layout, memory, remarks, costs } = line;
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
    report::line(&format!("  {layout}, {} bytes of memory for Rgb565", count(memory)))?;
    count::text(costs.as_deref())?;
    Ok(Outcome::Done)
}

/// Moves near lights, which are given from the centre of the mesh, to the space of the camera.
fn placed(lights: &[Lamp], view: &View) -> Vec<Lamp> {
    let place = |&lamp: &Lamp| match lamp {
        Lamp::Near(position, colour) => Lamp::Near(add(position, view.translation), colour),
        _ => lamp,
    };
    lights.iter().map(place).collect()
}

/// Size of the most common display, for figures that need one.
const USUAL: (u32, u32) = (320, 240);

/// The remark that no frame shows a pixel of the mesh.
fn unseen(stream: &Stream<'_>, (width, height): (u32, u32)) -> Result<Option<String>> {
    let is_seen = render::shows_a_pixel(stream, Size::new(width, height))?;
    Ok((!is_seen).then(|| {
        "no frame shows a pixel of it: its faces look away (--flip turns them over), or seen from here it is thinner than a pixel"
            .to_owned()
    }))
}

/// The error of a simplified mesh in the largest picture that `--lod` names.
fn in_pixels(levels::Simplified { before, error }: levels::Simplified, look: &Look, parts: &[Part], pictures: &[(u32, u32)]) -> Simplified {
    let size = pictures.iter().copied().max_by_key(|&(width, height)| u64::from(width) * u64::from(height)).unwrap_or(USUAL);
    // That which half a pixel is at the nearest point of the mesh. It is never more than that, so that these pixels are never too few.
    let half: f64 = look.tolerance(parts, size).max(GeometricError::DELTA).into();
    Simplified { before, error, pixels: 0.5 * error / half, size }
}

/// Largest number of lines for meshes.
const LISTED: usize = 20;

/// Rows of a band in the layout that is printed.
const ROWS: usize = 16;

/// The layout as program text.
fn text_of(layout: &Layout) -> String {
    let Layout { width, rows, vertices, triangles, materials, objects, .. } = layout;
    let several = if *objects > 1 { format!(".objects({objects})") } else { String::new() };
    format!("Layout::new({width}, {rows}).vertices({vertices}).triangles({triangles}).materials({materials}){several}")
}

fn of(mesh: usize, level: &levels::Level) -> Level {
    Level { mesh, triangles: level.triangles.len(), error: level.error.into() }
}

fn surface(arguments: &Arguments) -> Surface {
    let shares = [arguments.ambient, arguments.diffuse, arguments.specular];
    let colour = arguments.colour.unwrap_or(COPPER);
    if arguments.plastic {
        Surface::plastic(colour, shares, arguments.exponent)
    } else {
        Surface::metal(colour, shares, arguments.exponent)
    }
}

fn text(line: &Line<'_>, materials: &[Option<&str>]) -> Result<()> {
    let count = |n: usize| report::grouped(n as u64);
    let (vertices, triangles) = (report::counted(line.vertices, report::VERTICES), report::counted(line.triangles, report::TRIANGLES));
    report::line(&format!("{}: {vertices}, {triangles}, {} bytes", line.output, count(line.bytes)))?;
    let normals = if line.own_normals { "normals from the file" } else { "normals computed" };
    let turned = if line.turned { ", surface turned inside out" } else { "" };
    let (welded, degenerate) = (count(line.welded), count(line.degenerate));
    let convex = if line.closed_convex { ", closed and convex" } else { "" };
    report::line(&format!("  {welded} vertices welded, {degenerate} degenerate triangles dropped, {normals}{turned}{convex}"))?;
    match line.materials {
        0 => {}
        1 => report::line("  1 material from the file")?,
        several => report::line(&format!("  {} materials from the file", count(several)))?,
    }
    meshes::text(&line.list, materials, LISTED)?;
    if let Some(ByObject { meshes, bytes }) = line.by_object {
        let bytes = if line.simplified.is_some() { String::new() } else { format!("{} bytes of ", count(bytes)) };
        let meshes = report::counted(meshes, meshes::MESHES);
        report::line(&format!("  each object has meshes of its own; --merge saves {meshes}, {bytes}flash and some time"))?;
    }
    for remark in &line.remarks {
        report::line(&format!("  {remark}"))?;
    }
    if let Some(Simplified { before, error, pixels, size: (width, height) }) = line.simplified {
        let before = count(before);
        report::line(&format!(
            "  simplified from {before} triangles: at most {error:.4} units from the mesh, {pixels:.1} pixels in a picture of {width}x{height}"
        ))?;
    }
    for Level { triangles, error, .. } in &line.levels {
        report::line(&format!("  a level of detail of {} triangles, less than {error:.4} units from the mesh", count(*triangles)))?;
    }
    let memory = count(line.memory);
    report::line(&format!("  a program needs {memory} bytes of memory for it in Rgb565, and a band of pixels:\n    {}", line.layout))?;
    count::text(line.costs.as_deref())?;
    let crossed = match line.crossed {
        0 => return Ok(()),
        1 => "1 polygon crosses itself; split it".to_owned(),
        several => format!("{} polygons cross themselves; split them", count(several)),
    };
    report::line(&format!("  {crossed}, or check the picture"))
}
