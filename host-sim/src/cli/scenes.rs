//! `microphong scenes`.

use super::{Outcome, report};
use anyhow::Result;
use microphong_sim::scene;
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
    for scene in scene::NAMES {
        let description = scene::description(scene);
        if arguments.json {
            report::json(&Line { scene, description })?;
        } else {
            report::line(&format!("{scene:13} {description}"))?;
        }
    }
    Ok(Outcome::Done)
}
