//! `microphong scenes`.

use super::{Outcome, Usage, report};
use anyhow::Result;
use microphong_sim::scene::{self, NAMES, Scene, VARIANTS};
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
    for scene in NAMES.into_iter().chain(VARIANTS) {
        let description = scene::description(scene);
        if arguments.json {
            report::json(&Line { scene, description })?;
        } else {
            report::line(&format!("{scene:19} {description}"))?;
        }
    }
    Ok(Outcome::Done)
}

/// A scene by name or from a file, or all that are built in.
pub(super) fn load(name: &str) -> Result<Vec<Scene>> {
    if name == "all" {
        return NAMES.iter().map(|name| scene::load(name)).collect();
    }
    match scene::load(name) {
        Err(error) if error.is::<scene::Unknown>() => Err(Usage(format!("{error}, or all")).into()),
        other => Ok(vec![other?]),
    }
}
