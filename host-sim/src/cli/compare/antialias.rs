//! `microphong compare --antialias`.

use super::{super::report, Arguments};
use anyhow::{Context, Result};
use microphong::renderer::check;
use microphong_sim::{
    compare::{
        antialias::{self, Differences, Smoothing},
        page::Page,
        supersampled::Supersampled,
    },
    render::Style,
    scene::Scene,
    shader::Shader,
    stress::records::Records,
};
use serde::Serialize;

/// What is known of the outlines of one scene by one method; all figures are null if it could not be drawn, and `reason` says why.
#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    shader: &'a str,
    pixels: u32,
    edge_pixels: Option<usize>,
    smooth: Option<Differences>,
    plain: Option<Differences>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'a str>,
}

/// One method's figures, or why there are none.
type Row = (Shader, Result<Smoothing, String>);

/// Measures smooth outlines; returns the page with the results.
pub(super) fn compare(arguments: &Arguments, scenes: &[Scene], mut page: Option<Page>) -> Result<Option<Page>> {
    let size = |scene: &Scene| arguments.size.unwrap_or(scene.size);
    let methods = |scene: &Scene| -> Result<Vec<Shader>> {
        Ok(match &arguments.shader {
            Some(shaders) => shaders.values.clone(),
            None => vec![Shader::of(&scene.stream.parse()?)?],
        })
    };
    let mut rows = 0;
    for scene in scenes {
        let methods = methods(scene).with_context(|| scene.name.clone())?;
        rows += methods.len() as u64 * u64::from(size(scene).1);
    }
    let bar = report::progress(rows, "comparing outlines");
    for scene in scenes {
        let measure = || {
            // No reference draws texts.
            let records = Records { labels: Vec::new(), ..Records::of(&scene.stream.parse()?) };
            let bare = records.written().context("the scene without labels is no stream")?;
            let stream = bare.parse()?;
            let samples = Supersampled::new(stream, size(scene), arguments.frame, arguments.perspective_correct)?;
            let row = |shader: Shader| -> Result<Row> {
                let style = Style { perspective_correct: arguments.perspective_correct, ..shader.into() };
                let compared = check(&stream, shader.facts(), arguments.perspective_correct)
                    .map_err(Into::into)
                    .and_then(|()| antialias::compare(stream, &samples, style, arguments.frame, &|| bar.inc(1)));
                Ok((
                    shader,
                    match compared {
                        // Among all methods, one that cannot draw the scene does not hide the others.
                        Err(error) if arguments.shader.as_ref().is_some_and(|shaders| shaders.all) => Err(format!("{error:#}")),
                        other => Ok(other?),
                    },
                ))
            };
            methods(scene)?.into_iter().map(row).collect::<Result<Vec<_>>>()
        };
        let rows = measure().with_context(|| scene.name.clone())?;
        bar.suspend(|| if arguments.json { json(&scene.name, size(scene), &rows) } else { text(&scene.name, size(scene), &rows) })?;
        if let Some(page) = &mut page {
            let smoothings: Vec<_> = rows.iter().map(|(shader, result)| (*shader, result.as_ref().map_err(String::as_str))).collect();
            page.add_outlines(&scene.name, size(scene), &smoothings)?;
        }
    }
    bar.finish_and_clear();
    Ok(page)
}

fn json(scene: &str, (width, height): (u32, u32), rows: &[Row]) -> Result<()> {
    rows.iter().try_for_each(|(shader, result)| {
        let found = result.as_ref().ok();
        report::json(&Line {
            scene,
            shader: shader.name(),
            pixels: width * height,
            edge_pixels: found.map(|found| found.edges),
            smooth: found.map(|found| found.smooth),
            plain: found.map(|found| found.plain),
            reason: result.as_ref().err().map(String::as_str),
        })
    })
}

fn text(scene: &str, (width, height): (u32, u32), rows: &[Row]) -> Result<()> {
    report::line(&format!("{scene}: {width}x{height}; differences from means of 16x16 samples, in LSB"))?;
    report::line("method                 edge pixels   smooth: edges   else    max  at             plain: edges   else    max  at")?;
    let of = |Differences { edges_rmse, elsewhere_rmse, max, at: [x, y] }: &Differences| {
        format!("{edges_rmse:>6.2} {elsewhere_rmse:>6.2} {max:>6.1}  {:<11}", format!("{x}, {y}"))
    };
    rows.iter().try_for_each(|(shader, result)| match result {
        Err(reason) => report::line(&format!("  {:18}  {reason}", shader.name())),
        Ok(Smoothing { edges, smooth, plain, .. }) => {
            let figures = format!("{:>12}          {}          {}", report::grouped(*edges as u64), of(smooth), of(plain));
            report::line(format!("  {:18}  {figures}", shader.name()).trim_end())
        }
    })
}
