//! `microphong render`.

use super::{Outcome, Usage, mesh_options::MeshOptions, outlines::OutlineOptions, parse, report, scenes};
use anyhow::{Context, Result, ensure};
use embedded_graphics_core::geometry::Size;
use microphong::{Stream, format::ErrorBudget, renderer::check, stream::record::OPEN};
use microphong_sim::{
    bytes::StreamBytes,
    choices::{self, Choices, Told},
    image::{self, Film},
    legend, output,
    render::{self, Format, Picture, ROWS, Settings, Style},
    scene::Scene,
    shader::Shader,
};
use serde::Serialize;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Draw a scene to a PNG file, an animated PNG or a directory of numbered PNGs
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// A .tri, .obj, .stl, .ply, .gltf, .glb, .3mf or .toml file, or a built-in scene; `microphong scenes` lists the built-in scenes.
    scene: String,
    /// Shading method. The default is the method of the scene. `microphong compare` compares methods.
    #[arg(long, value_parser = parse::Shaders)]
    shader: Option<Shader>,
    /// Error budget of auto and auto-linear: the largest difference of a pixel from Phong shading, in 1/255, from 0.5 to 16. The default is the
    /// budget of the scene. If it has none, the pixel format decides: 1 for 8 bits a channel, 4 for 5 or 6 bits, and 8 for fewer.
    #[arg(long, value_name = "LSB", value_parser = parse::budget)]
    budget: Option<ErrorBudget>,
    /// Size of the picture. The default is the size of the scene, or 640x480 for model files.
    #[arg(long, value_name = "WxH", value_parser = parse::size)]
    size: Option<(u32, u32)>,
    /// Pixel format. light-rgb565 is rgb565 drawn as light, with 8x8 dither. The names of types in programs, such as BinaryColor, are accepted as well.
    #[arg(long, default_value = "rgb565", value_parser = parse::Formats)]
    format: Format,
    /// Number of frames to draw.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=65535))]
    frames: u32,
    /// Number of the first frame of the animation.
    #[arg(long, default_value_t = 0)]
    first: u32,
    /// Interpolate light in perspective. This is correct for triangles that reach from near to far.
    #[arg(long)]
    perspective_correct: bool,
    /// Dither, which hides the steps between few colours. It is on by default in formats of fewer than eight bits per channel.
    #[arg(long)]
    dither: bool,
    /// Round colours instead of dithering them.
    #[arg(long, conflicts_with = "dither")]
    no_dither: bool,
    /// Curve of the display: linear sends light levels unchanged; srgb corrects them for most displays, which makes pictures brighter and shadows
    /// softer.
    #[arg(long, value_enum, default_value_t = Gamma::Linear)]
    gamma: Gamma,
    /// Draw outlines jagged, as a program without `Renderer::set_antialias` does. By default they are smooth: where a surface ends, its shading jumps or
    /// two surfaces cut each other, a pixel mixes the colours of both sides in proportion to the areas that they cover.
    #[arg(long, conflicts_with_all = ["outlines", "outlines_alone"])]
    no_antialias: bool,
    #[command(flatten)]
    outlines: OutlineOptions,
    /// Number of rows to draw at a time, as a board with little memory does. It does not change the picture.
    #[arg(long, default_value_t = ROWS, value_parser = clap::value_parser!(u32).range(1..))]
    band_rows: u32,
    /// Paint each triangle in a colour that shows the method which auto chooses for it, with a legend below the picture. Dark parts of the picture
    /// stay darker.
    #[arg(long, value_name = "WHAT", conflicts_with_all = ["outlines", "dither", "band_rows"])]
    show: Option<Show>,
    /// FILE.png, FILE.apng, a directory, or - for standard output. The default is SCENE.png, or SCENE.apng for several frames, in the current directory.
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Print one JSON object per frame.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: Option<MeshOptions>,
}

const EXAMPLES: &str = "\
Examples:
  microphong render teapot
  microphong render teapot --shader gouraud --size 320x240 -o gouraud.png
  microphong render bunny --no-antialias
  microphong render sensor --outlines ffffff --outlines-alone --format binary --size 128x64
  microphong render part.obj --up z --colour 4080ff --plastic
  microphong render mesh.tri --format gray4 --no-dither
  microphong render mesh.tri --format binary --size 128x64
  microphong render bunny --frames 120 -o bunny.apng
  microphong render torus --frames 30 -o frames/
  microphong render teapot --show methods --budget 1";

/// The curve of a display.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Gamma {
    Linear,
    Srgb,
}

/// The stream of a scene with the neighbours of its triangles, from which outlines are found; `None`, with a note, if a mesh has too many triangles.
/// `lines` are an error then.
fn smooth(scene: &Scene, lines: bool) -> Result<Option<StreamBytes>> {
    let smooth = scene.smooth().with_context(|| scene.name.clone())?;
    if smooth.is_none() {
        ensure!(
            !lines,
            "{} has no lines along outlines, because one of its meshes has more than {OPEN} triangles; use --simplify",
            scene.name
        );
        report::error(&format!(
            "the outlines of {} are jagged, because one of its meshes has more than {} triangles; use --simplify for smooth ones",
            scene.name,
            report::grouped(OPEN)
        ));
    }
    Ok(smooth)
}

/// What a picture shows instead of colours.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Show {
    Methods,
}

#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    shader: &'a str,
    width: u32,
    height: u32,
    frames: u32,
    triangles: u32,
    culled: u32,
    drawn: u32,
    pixels: u32,
    crc: String,
    output: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    budget: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    choices: Option<Choices>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let frames = arguments.frames;
    let wanted = arguments.output.as_deref().map(|path| Target::of(path, frames)).transpose()?;
    let scene = scenes::with_budget(scenes::load(&arguments.scene, arguments.options.as_ref(), arguments.format)?, arguments.budget);
    let outlines = arguments.outlines.wanted();
    let wants_smooth = !arguments.no_antialias && arguments.show.is_none();
    let smooth = if wants_smooth { smooth(&scene, outlines.is_some())? } else { None };
    let stream = smooth.as_ref().unwrap_or(&scene.stream).parse().with_context(|| arguments.scene.clone())?;
    if arguments.dither && !arguments.format.is_dithered() {
        let name = arguments.format.name();
        return Err(Usage(format!(
            "--dither: {name} has eight bits a channel, which need no dither; leave it out, or choose another --format"
        ))
        .into());
    }
    let target = wanted.unwrap_or_else(|| {
        let file = PathBuf::from(format!("{}.{}", scene.name, if frames > 1 { "apng" } else { "png" }));
        Target::File(file)
    });
    let (width, height) = arguments.size.unwrap_or(scene.size);
    let shader = method(arguments, &stream).with_context(|| scene.name.clone())?;
    let usual = Settings::usual(shader, Size::new(width, height), arguments.format);
    let settings = Settings {
        style: Style {
            perspective_correct: arguments.perspective_correct,
            antialias: smooth.is_some(),
            outlines,
            dither: arguments.dither || usual.style.dither && !arguments.no_dither,
            srgb: arguments.gamma == Gamma::Srgb,
            ..usual.style
        },
        band_rows: arguments.band_rows,
        ..usual
    };
    check(&stream, settings.style.shader.facts(), settings.style.perspective_correct).with_context(|| scene.name.clone())?;
    if let Target::File(path) = &target {
        report::leave_to(path);
    }
    let below = if arguments.show.is_some() { legend::HEIGHT } else { 0 };
    let mut writer = Writer::start(&target, Size::new(width, height + below), frames)?;
    let bar = report::progress(frames.into(), "drawing frames");
    let mut lines = Vec::new();
    for number in 0..frames {
        let drawn = draw(arguments.show, stream, &settings, arguments.first.wrapping_add(number));
        let (picture, told) = drawn.with_context(|| scene.name.clone())?;
        let output = writer.add(number, &picture.rgb)?;
        let stats = picture.stats;
        bar.inc(1);
        lines.push(Line {
            scene: &scene.name,
            shader: settings.style.shader.name(),
            width,
            height,
            frames,
            triangles: stats.triangles,
            culled: stats.culled,
            drawn: stats.drawn,
            pixels: stats.pixels,
            crc: format!("{:08x}", picture.crc),
            output: output.to_string_lossy().into_owned(),
            budget: told.as_ref().map(|told| told.budget),
            choices: told.map(|told| told.choices),
        });
    }
    writer.finish()?;
    bar.finish_and_clear();
    if arguments.json {
        lines.iter().try_for_each(report::json)?;
    } else if let Some(line) = lines.last() {
        text(line)?;
    }
    Ok(Outcome::Done)
}

/// The method that is asked for: where choices are shown, the one that chooses.
fn method(arguments: &Arguments, stream: &Stream<'_>) -> Result<Shader> {
    match (arguments.show, arguments.shader) {
        (None, None) => Shader::of(stream),
        (None, Some(shader)) => Ok(shader),
        (Some(Show::Methods), Some(shader)) if !shader.keeps_budget() => {
            Err(Usage(format!("--show methods needs auto or auto-linear as --shader; {} does not choose methods", shader.name())).into())
        }
        (Some(Show::Methods), shader) => Ok(shader.unwrap_or(Shader::AUTO)),
    }
}

/// Draws frame `number`, or what is to be shown in its place.
fn draw(show: Option<Show>, stream: Stream<'_>, settings: &Settings, number: u32) -> Result<(Picture, Option<Told>)> {
    let Some(Show::Methods) = show else { return Ok((render::picture(stream, settings, number)?, None)) };
    let (mut picture, told) = choices::painted(stream, settings, number)?;
    legend::add(&mut picture.rgb, settings.size.width, &told.choices);
    Ok((picture, Some(told)))
}

/// Where pictures are written.
enum Target {
    File(PathBuf),
    Directory(PathBuf),
}

impl Target {
    /// The target that `path` names by its ending, or the device or pipe that exists there.
    fn of(path: &Path, frames: u32) -> Result<Self, Usage> {
        let slash = path.to_string_lossy().ends_with(std::path::is_separator);
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            _ if slash || path.is_dir() => Ok(Self::Directory(path.to_owned())),
            _ if path.exists() && !path.is_file() || output::is_stdout(path) => Ok(Self::File(path.to_owned())),
            Some("apng") => Ok(Self::File(path.to_owned())),
            Some("png") if frames == 1 => Ok(Self::File(path.to_owned())),
            Some("png") => {
                Err(Usage(format!("{}: a .png file cannot hold {frames} frames; name an .apng file or a directory", path.display())))
            }
            None => Ok(Self::Directory(path.to_owned())),
            Some(other) => Err(Usage(format!("{}: cannot write .{other}; name a .png or .apng file or a directory", path.display()))),
        }
    }
}

/// Writes pictures as they are finished.
enum Writer {
    Film(Film, PathBuf),
    Numbered(PathBuf, Size),
}

impl Writer {
    fn start(target: &Target, size: Size, frames: u32) -> Result<Self> {
        match target {
            Target::File(path) => Ok(Self::Film(Film::create(path, size.width, size.height, frames)?, path.clone())),
            Target::Directory(path) => {
                fs::create_dir_all(path).with_context(|| format!("cannot create the directory {}", path.display()))?;
                Ok(Self::Numbered(path.clone(), size))
            }
        }
    }

    /// Writes a picture and says where.
    fn add(&mut self, number: u32, rgb: &[u8]) -> Result<PathBuf> {
        match self {
            Self::Film(film, path) => film.add(rgb).map(|()| path.clone()),
            Self::Numbered(directory, size) => {
                let path = directory.join(format!("{number:04}.png"));
                image::write_png(&path, size.width, size.height, rgb)?;
                Ok(path)
            }
        }
    }

    fn finish(self) -> Result<()> {
        match self {
            Self::Film(film, _) => film.finish(),
            Self::Numbered(..) => Ok(()),
        }
    }
}

fn text(line: &Line<'_>) -> Result<()> {
    let several = if line.frames > 1 { format!("{} frames, ", line.frames) } else { String::new() };
    report::line(&format!("{}: {}, {}, {several}{}x{}", line.output, line.scene, line.shader, line.width, line.height))?;
    let last = if line.frames > 1 { "last frame: " } else { "" };
    let [culled, drawn, pixels] = [line.culled, line.drawn, line.pixels].map(report::grouped);
    let triangles = report::counted(line.triangles, report::TRIANGLES);
    report::line(&format!("  {last}{triangles}, {culled} culled, {drawn} drawn on {pixels} pixels, checksum {}", line.crc))?;
    line.budget.zip(line.choices).iter().try_for_each(report::choices)
}
