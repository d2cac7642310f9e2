//! `microphong scenes`.

use super::{Outcome, Usage, report};
use anyhow::Result;
use microphong::format::ErrorBudget;
use microphong_sim::scene::{self, NAMES, SCRIPTED, Scene, VARIANTS};
use serde::Serialize;

/// List the built-in scenes.
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
    for scene in NAMES.into_iter().chain(VARIANTS).chain(SCRIPTED) {
        let description = scene::description(scene);
        if arguments.json {
            report::json(&Line { scene, description })?;
        } else {
            report::line(&format!("{scene:19} {description}"))?;
        }
    }
    Ok(Outcome::Done)
}

/// Loads a scene by its name or from a file, or all built-in scenes; with another error budget if one is given.
pub(super) fn load(name: &str, budget: Option<ErrorBudget>) -> Result<Vec<Scene>> {
    let load = |name| Ok(with_budget(scene::load(name)?, budget));
    if name == "all" {
        return NAMES.into_iter().map(load).collect();
    }
    match load(name) {
        Err(error) if error.is::<scene::Unknown>() => Err(Usage(format!("{error}, or all")).into()),
        other => Ok(vec![other?]),
    }
}

/// Replaces the error budget of a scene, if one is given.
pub(super) fn with_budget(scene: Scene, budget: Option<ErrorBudget>) -> Scene {
    match budget {
        Some(budget) => Scene { stream: scene.stream.with_budget(budget), ..scene },
        None => scene,
    }
}
