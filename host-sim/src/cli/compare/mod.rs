//! `microphong compare`.

mod antialias;

use super::{
    Outcome,
    mesh_options::MeshOptions,
    parse::{self, Several},
    report, scenes,
};
use anyhow::{Context, Result};
use microphong::{format::ErrorBudget, renderer::check};
use microphong_sim::{
    bytes::StreamBytes,
    choices::Choices,
    compare::{
        Comparison, Reference,
        exponent::with_exponent,
        operations::Operations,
        page::{self, Page},
    },
    scene::Scene,
    shader::Shader,
};
use rayon::prelude::*;
use serde::Serialize;
use std::path::PathBuf;

/// Measure shading methods against Phong shading in 64-bit floating point
///
/// The command compares light levels before a pixel format rounds them. One LSB is 1/255 of full intensity.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// .tri, .obj, .stl, .ply, .gltf, .glb, .3mf and .toml files, names of built-in scenes, or `all` for every built-in scene.
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Shading methods by name, separated by commas, or all. The default is all; with --antialias it is the method of the scene, because outlines
    /// hardly depend on it.
    #[arg(long, value_name = "S,...", value_parser = parse::SeveralShaders)]
    shader: Option<Several<Shader>>,
    /// Measure smooth outlines instead of shading: compare each method's picture with smooth outlines, and its plain picture, with means of 16x16 samples
    /// per pixel of the same method in 64-bit floating point. This includes scenes of several objects.
    #[arg(long)]
    antialias: bool,
    /// Error budget of auto and auto-linear: the largest difference of a pixel from Phong shading, in 1/255, from 0.5 to 16. The default is the
    /// budget of the scene. If it has none, the budget is 1, as on displays with 8 bits a channel.
    #[arg(long, value_name = "LSB", value_parser = parse::budget)]
    budget: Option<ErrorBudget>,
    /// Exponent of all highlights, 1 to 1024, in scenes of every kind. The default is the exponent of each material.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    override_exponent: Option<u16>,
    /// Size of the picture. The default is the size of the scene, or 640x480 for model files.
    #[arg(long, value_name = "WxH", value_parser = parse::size)]
    size: Option<(u32, u32)>,
    /// Interpolate in perspective, in Phong shading and in all methods.
    #[arg(long)]
    perspective_correct: bool,
    /// Number of the frame of the animation.
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
    /// Write DIR/index.html: pictures, errors and charts of all methods on one page.
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Print one JSON object per scene and method.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: Option<MeshOptions>,
}

const EXAMPLES: &str = "\
Examples:
  microphong compare teapot
  microphong compare sphere-168 torus --override-exponent 50 --report comparison
  microphong compare all --shader six-point,renq --json
  microphong compare board --antialias --size 240x240 --frame 13

Columns:
  error       error of the integer picture: largest, 99th percentile, root mean square
  method      error of the method's formula, in floating point
  arithmetic  largest difference between the integer picture and the method in floating point
  colour      1 minus the mean difference of 8-bit pixels; psnr is computed from the same pixels, in dB
  alike       similarity of structure and colour to the eye; 1 means equal
  edge, mach  largest jump of the light level, and of its slope (LSB per pixel), across an edge between two
              triangles, in floating point; for auto, with the methods that it chooses for the two
  + * load    additions, multiplications and table look-ups per pixel, without those for perspective
  set-up      operations per triangle, and per row if there are any

Columns with --antialias, for the smooth picture and then for the plain one, of 8 bits per channel:
  edges       root mean square of the differences in pixels that contain an edge: their samples differ by more than 24 LSB
  else        the same in all other pixels; there smooth outlines should change nothing
  max, at     the largest difference, and its column and row";

/// What is known of one method on one scene; all figures are null if it could not be drawn, and `reason` says why.
#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    shader: &'a str,
    exponent: Option<u16>,
    max_lsb: Option<f64>,
    p99_lsb: Option<f64>,
    rmse_lsb: Option<f64>,
    color_correctness: Option<f64>,
    psnr: Option<f64>,
    similarity: Option<f64>,
    edge_jump_lsb: Option<f64>,
    mach_jump_lsb: Option<f64>,
    arithmetic_lsb: Option<f64>,
    arithmetic_rmse_lsb: Option<f64>,
    method_max_lsb: Option<f64>,
    method_rmse_lsb: Option<f64>,
    adds: u32,
    multiplies: u32,
    loads: u32,
    setup: u32,
    setup_row: u32,
    budget: Option<f64>,
    choices: Option<Choices>,
    pixels: Option<usize>,
    unmatched: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'a str>,
}

/// One method's figures, or why there are none.
struct Row {
    shader: Shader,
    result: Result<Comparison, String>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let scenes = chosen(arguments)?;
    if let Some(Several { values: shaders, all: false }) = &arguments.shader {
        for scene in &scenes {
            let stream = scene.stream.parse().with_context(|| scene.name.clone())?;
            shaders
                .iter()
                .try_for_each(|&shader| check(&stream, shader.facts(), arguments.perspective_correct))
                .with_context(|| scene.name.clone())?;
        }
    }
    let about = if arguments.antialias { page::OUTLINES } else { page::SHADING };
    let page = arguments.report.as_deref().map(|directory| Page::create(directory, about)).transpose()?;
    let page = if arguments.antialias { antialias::compare(arguments, &scenes, page)? } else { shading(arguments, &scenes, page)? };
    if let Some(page) = page {
        let path = page.finish()?;
        if !arguments.json {
            report::line(&format!("report: {}", path.display()))?;
        }
    }
    Ok(Outcome::Done)
}

/// Measures shading; returns the page with the results.
fn shading(arguments: &Arguments, scenes: &[Scene], mut page: Option<Page>) -> Result<Option<Page>> {
    let Several { values: shaders, all } = &arguments.shader.clone().unwrap_or_else(|| Several { values: Shader::ALL.to_vec(), all: true });
    let bar = report::progress((scenes.len() * shaders.len()) as u64, "comparing methods");
    for scene in scenes {
        let stream = scene.stream.parse().with_context(|| scene.name.clone())?;
        let size = arguments.size.unwrap_or(scene.size);
        let reference = if arguments.perspective_correct { Reference::perspective_correct } else { Reference::new };
        let reference = reference(stream, size, arguments.frame).with_context(|| scene.name.clone())?;
        let exponent = same(stream.materials.iter().map(|material| material.exponent));
        let row = |&shader: &Shader| {
            let compared =
                check(&stream, shader.facts(), arguments.perspective_correct).map_err(Into::into).and_then(|()| reference.compare(shader));
            let result = match compared {
                // Among all methods, one that cannot draw the scene does not hide the others.
                Err(error) if *all => Err(format!("{error:#}")),
                other => Ok(other?),
            };
            bar.inc(1);
            Ok(Row { shader, result })
        };
        let rows: Vec<Row> = shaders.par_iter().map(row).collect::<Result<_>>().with_context(|| scene.name.clone())?;
        bar.suspend(|| if arguments.json { json(scene, exponent, &rows) } else { text(scene, exponent, &reference, &rows) })?;
        if let Some(page) = &mut page {
            let results: Vec<_> = rows.iter().map(|row| (row.shader, row.result.as_ref().map_err(String::as_str))).collect();
            page.add(&scene.name, exponent, &reference, &results)?;
        }
    }
    bar.finish_and_clear();
    Ok(page)
}

/// The scenes with the exponent that was asked for.
fn chosen(arguments: &Arguments) -> Result<Vec<Scene>> {
    let scenes = scenes::load_all(&arguments.scenes, arguments.options.as_ref(), arguments.budget)?;
    // Lines would hide errors of shading.
    let mut scenes: Vec<_> = scenes.into_iter().map(|scene| Scene { stream: scene.stream.without_outlines(), ..scene }).collect();
    if let Some(exponent) = arguments.override_exponent {
        for scene in &mut scenes {
            let bytes = with_exponent(scene.stream.as_bytes(), exponent).with_context(|| scene.name.clone())?;
            scene.stream = StreamBytes::from(bytes.as_slice());
        }
    }
    Ok(scenes)
}

/// The number that all are; `None` if they differ.
fn same(mut numbers: impl Iterator<Item = u16>) -> Option<u16> {
    let first = numbers.next()?;
    numbers.all(|number| number == first).then_some(first)
}

fn json(scene: &Scene, exponent: Option<u16>, rows: &[Row]) -> Result<()> {
    for Row { shader, result } in rows {
        let found = result.as_ref().ok();
        let figure = |of: fn(&Comparison) -> f64| found.map(of);
        let operations = Operations::of(shader.name());
        report::json(&Line {
            scene: &scene.name,
            shader: shader.name(),
            exponent,
            max_lsb: figure(|c| c.total.max),
            p99_lsb: figure(|c| c.total.p99),
            rmse_lsb: figure(|c| c.total.rmse),
            color_correctness: figure(|c| c.colour_correctness),
            psnr: figure(|c| c.psnr),
            similarity: figure(|c| c.similarity),
            edge_jump_lsb: figure(|c| c.jumps.level),
            mach_jump_lsb: figure(|c| c.jumps.slope),
            arithmetic_lsb: figure(|c| c.arithmetic.max),
            arithmetic_rmse_lsb: figure(|c| c.arithmetic.rmse),
            method_max_lsb: figure(|c| c.method.max),
            method_rmse_lsb: figure(|c| c.method.rmse),
            adds: operations.adds,
            multiplies: operations.multiplies,
            loads: operations.loads,
            setup: operations.setup,
            setup_row: operations.row,
            budget: found.and_then(|c| c.budget),
            choices: found.and_then(|c| c.choices),
            pixels: found.map(|c| c.pixels),
            unmatched: found.map(|c| c.unmatched),
            reason: result.as_ref().err().map(String::as_str),
        })?;
    }
    Ok(())
}

fn text(scene: &Scene, exponent: Option<u16>, reference: &Reference<'_>, rows: &[Row]) -> Result<()> {
    let (width, height) = reference.size();
    let exponent = exponent.map_or("several exponents".to_owned(), |exponent| format!("exponent {exponent}"));
    let pixels = rows.iter().find_map(|row| row.result.as_ref().ok()).map(|c| (c.pixels, c.unmatched));
    let compared = pixels.map_or(String::new(), |(pixels, unmatched)| {
        let only = if unmatched > 0 { format!(", {} in one picture only", report::grouped(unmatched as u64)) } else { String::new() };
        format!(", {} pixels compared{only}", report::grouped(pixels as u64))
    });
    report::line(&format!("{}: {width}x{height}, {exponent}{compared}; errors in LSB", scene.name))?;
    report::line(
        "method                error: max     p99    rmse   method: max  rmse  arith.  colour   psnr  alike    edge    mach   +  *  load  set-up",
    )?;
    rows.iter().try_for_each(|Row { shader, result }| match result {
        Err(reason) => report::line(&format!("  {:18}  {reason}", shader.name())),
        Ok(c) => {
            let row = if c.operations.row > 0 { format!(" + {}/row", c.operations.row) } else { String::new() };
            report::line(&format!(
                "  {:18}  {:>10.2} {:>7.2} {:>7.3}   {:>11.2} {:>5.2}  {:>6.2}  {:>6.4} {:>6.1} {:>6.4} {:>7.2} {:>7.2}  {:>2} {:>2}  {:>4}  {:>6}{row}",
                shader.name(),
                c.total.max,
                c.total.p99,
                c.total.rmse,
                c.method.max,
                c.method.rmse,
                c.arithmetic.max,
                c.colour_correctness,
                c.psnr,
                c.similarity,
                c.jumps.level,
                c.jumps.slope,
                c.operations.adds,
                c.operations.multiplies,
                c.operations.loads,
                c.operations.setup,
            ))?;
            c.budget.zip(c.choices).iter().try_for_each(report::choices)
        }
    })
}
