//! `microphong growth`.

use super::{
    Outcome,
    parse::{self, Several},
    report,
};
use anyhow::Result;
use microphong_sim::{
    bench::{
        callgrind,
        growth::{Point, Step, Sweep},
    },
    shader::Shader,
};

/// Count the instructions of a frame for growing numbers of triangles, pixels, lights and bands
///
/// Callgrind counts the instructions exactly, on this computer, because no emulated board has enough memory. Triangles, pixels and lights are varied on a
/// flat square with the normals of a cushion: it covers the same pixels with any number of triangles. Bands are varied on the scene peer-sphere.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Quantities to vary: triangles, pixels, lights and bands, separated by commas, or all.
    #[arg(default_value = "all", value_name = "WHAT,...", value_parser = sweeps)]
    sweep: Several<Sweep>,
    /// Shading methods, separated by commas, or all.
    #[arg(long, default_value = "gouraud,six-point,sqrt6,phong", value_name = "S,...", value_parser = parse::SeveralShaders)]
    shader: Several<Shader>,
    /// Print one JSON object per frame.
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  microphong growth
  microphong growth bands --shader all
  microphong growth triangles,pixels --shader six-point,phong --json

triangles  100 to 100,000 triangles on 40,000 pixels
pixels     1,000 to 1,000,000 pixels with 512 triangles
lights     1 to 8 lights with 968 triangles on 40,000 pixels
bands      1 to 24 bands for one picture";

/// What grows, by name.
fn sweeps(text: &str) -> Result<Several<Sweep>, String> {
    parse::several(text, &Sweep::ALL, |text| parse::among(text, &Sweep::ALL, Sweep::name))
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    let points = count(&arguments.sweep.values, &arguments.shader.values)?;
    if arguments.json {
        points.iter().try_for_each(report::json)?;
    } else {
        arguments.sweep.values.iter().try_for_each(|&sweep| text(sweep, &arguments.shader.values, &points))?;
    }
    Ok(Outcome::Done)
}

/// Counts these sweeps, with a bar.
pub(crate) fn count(sweeps: &[Sweep], shaders: &[Shader]) -> Result<Vec<Point>> {
    let program = callgrind::build()?;
    let steps: Vec<Step> = sweeps.iter().map(|sweep| sweep.steps()).collect::<Result<Vec<_>>>()?.concat();
    let bar = report::progress(steps.len() as u64, "counting growth");
    let mut points = Vec::new();
    for step in steps {
        points.extend(step.count(&program, shaders)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(points)
}

/// A table: a row for each amount, a column for each method.
fn text(sweep: Sweep, shaders: &[Shader], points: &[Point]) -> Result<()> {
    let of = |shader| points.iter().filter(move |point| point.sweep == sweep && point.shader == shader);
    let unit = match sweep {
        Sweep::Triangles | Sweep::Pixels => "instructions per pixel",
        Sweep::Lights => "thousand instructions",
        Sweep::Bands => "thousand instructions, and their ratio to one band",
    };
    report::line(&format!("{sweep}: {unit}"))?;
    report::line(&format!("  {:>9}{}", "", shaders.iter().map(|shader| format!("{:>20}", shader.name())).collect::<String>()))?;
    let Some(&first) = shaders.first() else { return Ok(()) };
    for (row, head) in of(first).enumerate() {
        let mut line = format!("  {:>9}", report::grouped(head.amount));
        for &shader in shaders {
            let (Some(point), Some(one)) = (of(shader).nth(row), of(shader).next()) else { continue };
            let all = point.instructions as f64;
            let figure = match sweep {
                Sweep::Triangles | Sweep::Pixels => format!("{:.1}", all / point.pixels as f64),
                Sweep::Lights => report::grouped(point.instructions / 1000),
                Sweep::Bands => format!("{} {:>6.3}", report::grouped(point.instructions / 1000), all / one.instructions as f64),
            };
            line.push_str(&format!("{figure:>20}"));
        }
        report::line(&line)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use microphong_sim::bench::growth::SHADERS;

    #[test]
    fn the_default_is_the_librarys() {
        let default = parse::shaders("gouraud,six-point,sqrt6,phong").expect("methods");
        assert_eq!(default.values, SHADERS);
    }
}
