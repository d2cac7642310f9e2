//! `microphong scenes`.

use super::{
    Outcome, Usage,
    mesh_options::{self, MeshOptions},
    report::{self, Bars},
};
use anyhow::Result;
use microphong::format::ErrorBudget;
use microphong_sim::{
    render::Format,
    scene::{self, NAMES, Scene},
};
use serde::Serialize;

/// List the built-in scenes
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Print one JSON object per scene.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Line {
    scene: &'static str,
    description: &'static str,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome> {
    for scene in scene::all() {
        let description = scene::description(scene);
        if arguments.json {
            report::json(&Line { scene, description })?;
        } else {
            report::line(&format!("{scene:19} {description}"))?;
        }
    }
    Ok(Outcome::Done)
}

/// A scene by name or from a file, for pictures in this format.
pub(super) fn load(name: &str, options: Option<&MeshOptions>, format: Format) -> Result<Scene> {
    let are_given = options.is_some();
    scene::load_with(name, &mesh_options::or_default(options, format)?, are_given, &Bars::default())
}

/// Scenes by name or from files, or all that are built in; with another error budget if one is given.
pub(super) fn load_all(names: &[String], options: Option<&MeshOptions>, budget: Option<ErrorBudget>) -> Result<Vec<Scene>> {
    let mut scenes = Vec::new();
    for name in names {
        let all = if name == "all" { &NAMES[..] } else { &[name.as_str()] };
        for name in all {
            match load(name, options, Format::Rgb565) {
                Err(error) if error.is::<scene::Unknown>() => return Err(Usage(format!("{error}, or all")).into()),
                scene => scenes.push(with_budget(scene?, budget)),
            }
        }
    }
    Ok(scenes)
}

/// Replaces the error budget of a scene, if one is given.
pub(super) fn with_budget(scene: Scene, budget: Option<ErrorBudget>) -> Scene {
    match budget {
        Some(budget) => Scene { stream: scene.stream.with_budget(budget), ..scene },
        None => scene,
    }
}
